"""Text to tokens of a script.

One invariant: every character but a blank is in exactly one token, in order.  A mistake with a certain correction
(`and`, `"text"`, `.5`, `&lt;`) becomes the intended token and a problem with its fix, so that the parser continues as
if it were corrected; any other invalid text is an ERROR token, which the parser reports if it reaches it.
"""

from __future__ import annotations

import re
from typing import Final

from btq_lang.diagnostics.model import Diagnostic, replace_fix
from btq_lang.syntax.script import mistakes
from btq_lang.syntax.script.tree import ASSIGNMENT, RANK
from btq_lang.util.text import Span

# A token's kind is one of these; an operator's is the operator itself, corrected if misspelt.
NAME: Final = "name"
NUMBER: Final = "number"
TEXT: Final = "text"
BOOL: Final = "bool"
ERROR: Final = "error"
END: Final = "end"

OPERANDS: Final = frozenset((NAME, NUMBER, TEXT, BOOL))
# What may begin an operand, besides a `-`, which may also be an operator between two.
BEGINS: Final = OPERANDS | {"(", "!", "~"}

# Names with a special reading; to the engine, the operators of other languages are ordinary keys.
_WORDS: Final = {"true": BOOL, "false": BOOL, **dict.fromkeys(("and", "AND", "or", "OR", "not", "NOT"), NAME)}
_HEXADECIMAL: Final = ("0x", "0X")
_LARGEST: Final = 2**63 - 1


class Tokens:
    """The tokens of a script, the last one an END.

    Attributes:
        kinds, starts, ends: one entry a token.
        meant: by index, the corrected form of a name, number or text that the engine does not accept.
        problems: the mistakes that were read as what they mean.
    """

    __slots__ = ("ends", "kinds", "meant", "problems", "starts")

    def __init__(self) -> None:
        self.kinds: list[str] = []
        self.starts: list[int] = []
        self.ends: list[int] = []
        self.meant: dict[int, str] = {}
        self.problems: list[Diagnostic] = []


def tokenize(text: str) -> Tokens:
    """The tokens of a script."""
    tokens = Tokens()
    kinds, starts, ends = tokens.kinds, tokens.starts, tokens.ends
    words = False
    for match in _TOKEN.finditer(text):
        start, end = match.span()
        kind = match.lastgroup or ""
        if kind == "operator":
            kind = text[start:end]
        elif kind == NAME:
            name = text[start:end]
            if name in _WORDS:
                kind = _WORDS[name]
                words = words or kind == NAME
            elif not name.isascii():
                tokens.problems.append(mistakes.foreign_name(Span(start, end), name))
        elif kind == NUMBER:
            _check_number(tokens, text, match)
        elif kind == "blank":
            fix = replace_fix("Write a space", Span(start, end), " ", safe=True)
            message = "the engine does not accept this character as a space"
            tokens.problems.append(mistakes.error(Span(start, end), message, fix))
            continue
        elif kind != TEXT:
            kind = _slip(tokens, text, match)
        kinds.append(kind)
        starts.append(start)
        ends.append(end)
        if kind == ERROR and text[start] in "'\"":  # tokens after an open quote are unknown
            ends[-1] = len(text)
            break
    kinds.append(END)
    starts.append(len(text))
    ends.append(len(text))
    if words:
        _read_words(tokens, text)
    return tokens


# One token (BehaviorTree.CPP 4.10, src/script_tokenizer.cpp); a catch-all is last, and nothing matches blanks.
_TOKEN: Final = re.compile(
    r"""(?xs)
          (?P<name>      [^\W\d]\w* | @\w+ )
        | (?P<number>    (?: 0[xX][0-9a-fA-F]+ | [0-9]+ (?:\.[0-9]+)? (?:[eE][+-]?[0-9]+)? )
                         (?P<garbage> (?: \w | \.(?!\.) )+ )? )
        | (?P<text>      '[^']*' )
        | (?P<quoted>    "[^"]*" | “[^“”]*” | ‘[^‘’]*’ | &quot;.*?&quot; | &apos;.*?&apos; )
        | (?P<misspelt>  => | =< | <> | [!=]== | &(?:lt|gt);=? | &amp;&amp; | &amp; | [≤≥≠∧∨¬×÷−] )
        | (?P<none>      \*\* | // | << | >> )
        | (?P<operator>  [:=!<>+*/-]= | && | \|\| | \.\. | [-+*/&|^~!<>=?:();] )
        | (?P<fraction>  \.[0-9]+ (?:[eE][+-]?[0-9]+)? (?: \w | \.(?!\.) )* )
        | (?P<braced>    \{ [ \t]* (?: [^\W\d]\w* | @\w+ ) [ \t]* \} )
        | (?P<blank>     [^\S \t\r\n]+ )
        | (?P<other>     [^ \t\r\n] )
    """
)
_NUMBER: Final = re.compile(r"[0-9]+(\.[0-9]+)?([eE][+-]?[0-9]+)?")


def _check_number(tokens: Tokens, text: str, match: re.Match[str]) -> None:
    raw, garbage, span = match["number"], match["garbage"], Span(*match.span())
    if garbage is not None:
        meant = _mended_number(raw)
        tokens.problems.append(mistakes.number(span, raw, meant))
        tokens.meant[len(tokens.kinds)] = meant or raw[: -len(garbage)]
    elif raw[:2] in _HEXADECIMAL and text.startswith(".", span.end):
        fix = replace_fix("Put a space between them", Span(span.end, span.end), " ", safe=True)
        message = "a hexadecimal number and the `..` after it need a space between them"
        tokens.problems.append(mistakes.error(span, message, fix))
    elif not _fits(raw):
        tokens.problems.append(mistakes.too_large(span, raw))


def _mended_number(raw: str) -> str | None:
    """`.5`, `1.` and `1_000` in the engine's form."""
    if not raw.isascii():
        return None
    meant = f"0{raw}" if raw[0] == "." else f"{raw}0" if raw[-1] == "." else raw
    if raw.replace("_", "").isdecimal() and raw[-1] != "_" and "__" not in raw:
        meant = raw.replace("_", "")
    return meant if _NUMBER.fullmatch(meant) and _fits(meant) else None


def _fits(raw: str) -> bool:
    """Whether the engine can represent a number: an integer in 64 bits, any other in a double without becoming 0 or
    infinity.
    """
    hexadecimal = raw[:2] in _HEXADECIMAL
    if hexadecimal or raw.isdecimal():
        digits = (raw[2:] if hexadecimal else raw).lstrip("0")
        # The length first: Python refuses to parse integers of thousands of digits.
        return len(digits) < 16 or (len(digits) < 20 and int(digits, 16 if hexadecimal else 10) <= _LARGEST)
    value = float(raw)
    return value != float("inf") and (value != 0 or not raw.lower().partition("e")[0].strip("0."))


def _slip(tokens: Tokens, text: str, match: re.Match[str]) -> str:
    """The kind of text that is not a token of the engine; ERROR if it has no certain correction."""
    kind, raw, span = match.lastgroup, match[0], Span(*match.span())
    index = len(tokens.kinds)
    if kind == "misspelt":
        tokens.problems.append(mistakes.misspelt(text, span))
        return mistakes.MEANT[raw]
    if kind == "quoted":
        width = len("&quot;") if raw[0] == "&" else 1
        content = raw[width:-width].replace("&apos;", "'").replace("&quot;", '"')
        tokens.problems.append(mistakes.wrong_quotes(span, content))
        tokens.meant[index] = content
        return TEXT
    if kind == "braced":
        name = raw[1:-1].strip(" \t")
        if name in _WORDS:
            return ERROR
        tokens.problems.append(mistakes.braced(text, span, name))
        if not name.isascii():
            tokens.problems.append(mistakes.foreign_name(span, name))
        tokens.meant[index] = name
        return NAME
    glued = index > 0 and tokens.ends[-1] == span.start and tokens.kinds[-1] in OPERANDS | {ERROR}
    if kind == "fraction" and not glued:  # `a.5` is not a number after a name
        meant = _mended_number(raw)
        tokens.problems.append(mistakes.number(span, raw, meant))
        tokens.meant[index] = meant or "0"
        return NUMBER
    return ERROR


def _read_words(tokens: Tokens, text: str) -> None:
    """Turn `and`, `or`, `not` into operators where an operator must be; elsewhere they are ordinary names."""
    kinds, starts, ends = tokens.kinds, tokens.starts, tokens.ends
    closing = _closing_brackets(kinds)
    for index, kind in enumerate(kinds):
        word = text[starts[index] : ends[index]] if kind == NAME else ""
        if word not in _WORDS or index in tokens.meant:
            continue
        span, after = Span(starts[index], ends[index]), kinds[index + 1]
        after_operand = index > 0 and (kinds[index - 1] in OPERANDS or kinds[index - 1] == ")")
        if word in ("not", "NOT"):
            if not after_operand and after in BEGINS:
                end_of_operand = closing.get(index + 1, index + 1) + 1
                if _ends_condition(kinds[end_of_operand], text[starts[end_of_operand] : ends[end_of_operand]]):
                    kinds[index] = "!"
                    tokens.problems.append(mistakes.misspelt(text, Span(span.start, starts[index + 1])))
                else:  # `not a == b` negates the comparison, but `!a == b` compares `!a`
                    kinds[index] = ERROR
        elif after_operand and after != ERROR and RANK.get(after) != ASSIGNMENT:
            kinds[index] = mistakes.MEANT[word.lower()]
            tokens.problems.append(mistakes.misspelt(text, span))


def _closing_brackets(kinds: list[str]) -> dict[int, int]:
    """The index of the `)` for that of each `(`."""
    opened: list[int] = []
    closing: dict[int, int] = {}
    for index, kind in enumerate(kinds):
        if kind == "(":
            opened.append(index)
        elif kind == ")" and opened:
            closing[opened.pop()] = index
    return closing


def _ends_condition(kind: str, word: str) -> bool:
    """Whether no operator follows that binds more tightly than the `not` of other languages."""
    return kind in (END, ";", ")", "&&", "||", "?", ":") or word.lower() in ("and", "or")
