"""The kinds of tokens: plain integers, which are cheap to compare.

`Token` is for tools; the parser works on the lexer's flat lists and creates none.
"""

from __future__ import annotations

from typing import Final

from btq_lang.util.record import Record

# Words and values.
NAME: Final = 0  # MoveBase, satisfies, BatteryLow?
STRING: Final = 1  # "…" or '…', also over several lines
NUMBER: Final = 2  # 6, -1, 0.25, 1e3
QUANTITY: Final = 3  # 30 s: a number and its unit
BRACED: Final = 4  # {goal}
SYMBOL: Final = 5  # ->, ?, ||, R->, …: the control nodes
# Punctuation: the raw text tells which.
OPERATOR: Final = 6  # = : :: . / * + - < > <= >= == != % ^ ,
OPEN: Final = 7  # (
CLOSE: Final = 8  # )
NEWLINE: Final = 9  # the end of a logical line
ERROR: Final = 10  # an invalid character
# Only in the full list of tokens; the parser never sees them.
BLANK: Final = 11  # blanks, and line ends without meaning
COMMENT: Final = 12
INDENT: Final = 13  # zero characters long
DEDENT: Final = 14  # zero characters long

NAMES: Final = (
    *("NAME", "STRING", "NUMBER", "QUANTITY", "BRACED", "SYMBOL", "OPERATOR", "OPEN", "CLOSE", "NEWLINE", "ERROR"),
    *("BLANK", "COMMENT", "INDENT", "DEDENT"),
)

SYMBOLS: Final = ("->", "?", "||", "All||", "R->", "R?", "M->", "A->", "A?", "→", "⇉", "R→", "M→", "A→", "All⇉")

# Words with a meaning only in certain places of the grammar.
CATEGORIES: Final = frozenset(("Action", "Condition", "Control", "Decorator", "SubTree"))
NODE_CLAUSES: Final = frozenset(("satisfices", "satisfies", "tags"))
DIRECTIONS: Final = frozenset(("input", "output", "inout"))


class Token(Record):
    """A piece of the text; the texts of all tokens of a file, joined, are the file."""

    kind: int
    start: int
    text: str

    @property
    def end(self) -> int:
        return self.start + len(self.text)

    def __str__(self) -> str:
        return f"{NAMES[self.kind]} {self.text!r}"
