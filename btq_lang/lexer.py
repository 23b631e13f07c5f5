"""The lexer: text to tokens, one logical line at a time.

One invariant: it takes every string, moves forward with every step, and the tokens of `tokens()` joined are the text.
It knows indentation, brackets, strings, numbers with units and comments (language.md §2); it knows no grammar but the
words that begin an item, for these are where a forgotten bracket ends.

The parser pulls: `open_line` finds the next line that says something and compares its indentation, `scan` cuts it into
`kinds`, `starts` and `raws`, three flat lists that are used again for the next line.  Characters are compared one by
one and not by regular expressions because that is the form which mypyc compiles well.
"""

from __future__ import annotations

import re
from typing import Final

from btq_lang.diagnostics import Diagnostic, Place, Related, replace_fix
from btq_lang.scan import line_end, name_end, number_at, string_end, symbol_at
from btq_lang.text import Span
from btq_lang.tokens import (
    BLANK,
    BRACED,
    CLOSE,
    COMMENT,
    DEDENT,
    ERROR,
    INDENT,
    NAME,
    NEWLINE,
    NUMBER,
    OPEN,
    OPERATOR,
    QUANTITY,
    STRING,
    SYMBOL,
    Token,
)
from btq_lang.units import nearest_units


def tokens(text: str) -> tuple[Token, ...]:
    """All tokens of a text, blanks and comments included, INDENT and DEDENT where blocks open and close."""
    lexer = Lexer(text)
    found: list[Token] = []
    end = level = comment = 0

    def fill(start: int) -> None:
        """What the lexer passed over up to `start`: blanks, comments and characters that begin nothing."""
        nonlocal end, comment
        while comment < len(lexer.comments) and lexer.comments[comment][0] < start:
            comment_start, comment_end = lexer.comments[comment]
            found.extend(_pieces(text, end, comment_start))
            found.append(Token(COMMENT, comment_start, text[comment_start:comment_end]))
            end = comment_end
            comment += 1
        found.extend(_pieces(text, end, start))
        end = start

    while lexer.open_line():
        lexer.scan()
        fill(lexer.starts[0])
        step = INDENT if lexer.level > level else DEDENT
        found += [Token(step, lexer.starts[0], "")] * abs(lexer.level - level)
        level = lexer.level
        for kind, start, raw in zip(lexer.kinds, lexer.starts, lexer.raws, strict=True):
            fill(start)
            found.append(Token(kind, start, raw))
            end = start + len(raw)
    fill(len(text))
    found += [Token(DEDENT, len(text), "")] * level
    return tuple(found)


class Lexer:
    """A place in a text, and the logical line that begins there.

    Attributes:
        position: where the next thing is read.
        level: how many blocks are open around the line.
        line_start: where the line begins, its blanks included.
        kinds, starts, raws: the tokens of the line after `scan`; the last one is always a NEWLINE.
        comments: start and end of every comment so far.
        problems: what was wrong so far.
    """

    def __init__(self, text: str) -> None:
        self.text: Final = text
        self.size: Final = len(text)
        self.position = 1 if text.startswith("\ufeff") else 0
        self.level = 0
        self.line_start = self.position
        self.kinds: list[int] = []
        self.starts: list[int] = []
        self.raws: list[str] = []
        self.comments: list[tuple[int, int]] = []
        self.problems: list[Diagnostic] = []
        self._indents: list[str] = [""]  # the blanks of each open block
        self._aliases: list[tuple[str, ...]] = [()]  # other blanks taken for the same block, each reported once
        self._brackets: list[tuple[int, str]] = []  # where each was opened, and the blanks of that line
        self._strange = False  # a character that begins nothing was reported on this line
        self._last_line = 0  # where the line of text at hand begins; lines inside strings and comments do not count
        self._root_level = -1  # the level of an open Root block's items
        self._no_double = self._no_single = self.size + 1  # from here on no such quote closes anything

    # ---- lines ----

    def open_line(self) -> bool:
        """Go to the next line that says something and find its level; False at the end of the text."""
        text, size, position = self.text, self.size, self.position
        start = position
        blanks_end = -1
        while position < size:
            character = text[position]
            if character == " " or character == "\t":
                position += 1
            elif character == "\n" or character == "\r":
                position += 1
                start = position
                blanks_end = -1
            elif (character == "#" or character == "/") and (end := self._comment(position)) > position:
                if blanks_end < 0:
                    blanks_end = position
                position = end
            else:
                self.position = position
                self.line_start = start
                self._indent(text[start : blanks_end if blanks_end >= 0 else position], position)
                return True
        self.position = position
        self.level = 0
        self.line_start = size
        return False

    def _indent(self, blanks: str, position: int) -> None:
        """Open a block, close blocks, or adopt a column that no open block has."""
        indents, aliases = self._indents, self._aliases
        if blanks == indents[-1]:
            return
        level = len(indents) - 1
        while level >= 0 and blanks != indents[level] and blanks not in aliases[level]:
            level -= 1
        if level < 0:
            if _extends(blanks, indents[-1], aliases[-1]):
                indents.append(blanks)
                aliases.append(())
                level = len(indents) - 1
            else:
                level = len(indents) - 1
                while not _extends(blanks, indents[level - 1], aliases[level - 1]):
                    level -= 1
                self._report_indentation(blanks, indents[level], position)
                aliases[level] += (indents[level],)
                indents[level] = blanks
        del indents[level + 1 :], aliases[level + 1 :]
        self.level = level
        if level < self._root_level:
            self._root_level = -1

    def scan(self) -> None:
        """Cut the opened line into tokens, through all lines that its brackets join."""
        self.kinds, self.starts, self.raws = [], [], []
        self._brackets.clear()
        self._strange = False
        self._last_line = self.line_start
        position = self.position
        text, size = self.text, self.size
        while position < size:
            character = text[position]
            if character == " " or character == "\t":
                position += 1
            elif character == "\n" or character == "\r":
                if not self._brackets:
                    break
                position = self._continue(position)
                if not self._brackets:
                    break
            elif character.isalpha() or character == "_":
                position = self._name(position)
            elif character == '"' or character == "'":
                position = self._string(position, character)
            elif character == "=" or character == ",":
                position = self._operator(position)
            elif character == "(":
                self._brackets.append((position, self._blanks()))
                position = self._add(OPEN, position, position + 1)
            elif character == ")":
                position = self._close(position)
            elif (character == "#" or character == "/") and (end := self._comment(position)) > position:
                position = end
            elif "0" <= character <= "9":
                position = self._number(position)
            else:
                position = self._other(position, character)
        if self._brackets and position >= size:
            self._end_brackets(len(self._brackets), size, None)
        end = position
        if position < size and text[position] in "\r\n":
            end = position + (2 if text.startswith("\r\n", position) else 1)
        self._add(NEWLINE, position, end)
        self.position = end

    def line_end(self) -> int:
        """Where the line of text at hand ends."""
        return line_end(self.text, self.position)

    def enter_root(self) -> None:
        """The line just read opens a `Root` block: its items stand one level deeper."""
        self._root_level = self.level + 1

    # ---- tokens, each from its first character to the position behind it ----

    def _add(self, kind: int, start: int, end: int) -> int:
        self.kinds.append(kind)
        self.starts.append(start)
        self.raws.append(self.text[start:end])
        return end

    def _name(self, start: int) -> int:
        end = name_end(self.text, start)
        text = self.text
        word = text[start:end]
        kind = NAME
        if len(word) <= 3 and (symbol := symbol_at(text, start)):
            if len(symbol) >= len(word):
                kind, end = SYMBOL, start + len(symbol)
        elif end < self.size and text[end] in "#/" and _COMMENT_SIGN.match(text, end):
            return self._quote_this(start)
        return self._add(kind, start, end)

    def _operator(self, start: int) -> int:
        text = self.text
        two = text[start : start + 2]
        return self._add(OPERATOR, start, start + 2 if two in _TWO else start + 1)

    def _other(self, start: int, character: str) -> int:
        """Symbols, signs and braces; what begins nothing is reported once a line and left out."""
        text = self.text
        if symbol := symbol_at(text, start):
            return self._add(SYMBOL, start, start + len(symbol))
        if (
            character == "-"
            and start + 1 < self.size
            and "0" <= text[start + 1] <= "9"
            and not self._after_operand(start)
        ):
            return self._number(start)
        if character == "{" and (braced := _BRACED.match(text, start)):
            return self._add(BRACED, start, braced.end())
        if character in "#/" and _COMMENT_SIGN.match(text, start):
            return self._quote_this(start)
        if text[start : start + 2] in _TWO or character in ":.<>+-*/%^":
            return self._operator(start)
        end = start + 1
        while end < self.size and text[end] == character:
            end += 1
        if not self._strange:
            self._strange = True
            notes = (_INSTEAD[character],) if character in _INSTEAD else ()
            shown = repr(character) if not character.isprintable() or character.isspace() else f"`{character}`"
            self._report("syntax-error", start, end, f"{shown} means nothing here", notes)
        return end

    def _after_operand(self, position: int) -> bool:
        """Whether a `-` here subtracts: it does behind an operand on the same line (language.md §2, NUMBER)."""
        if not self.kinds or self.kinds[-1] not in (NAME, NUMBER, QUANTITY, STRING, CLOSE):
            return False
        return not _has_line_end(self.text, self.starts[-1] + len(self.raws[-1]), position)

    def _number(self, start: int) -> int:
        kind, end = number_at(self.text, start)
        return self._add(kind, start, end) if kind != ERROR else self._unknown_unit(start, end)

    def _unknown_unit(self, start: int, unit: int) -> int:
        end = name_end(self.text, unit)
        word = self.text[unit:end]
        number = self.text[start:unit]
        fixes = tuple(
            replace_fix(f"Replace `{word}` by `{symbol}`", Span(unit, end), f" {symbol}")
            for symbol in nearest_units(word)
        )
        notes = () if fixes else (f'a name that begins with a digit is written in quotes: "{number}{word}"',)
        self.problems.append(
            Diagnostic("unknown-unit", Span(unit, end), f"`{word}` is no unit", notes=notes, fixes=fixes)
        )
        return self._add(QUANTITY, start, end)

    def _string(self, start: int, quote: str) -> int:
        """A string runs to its closing quote, however many lines; if there is none, to the end of its line."""
        text = self.text
        end = -1
        if start < (self._no_double if quote == '"' else self._no_single):
            end = string_end(text, start + 1, quote)
            if end < 0:
                if quote == '"':
                    self._no_double = start
                else:
                    self._no_single = start
        if end < 0:
            end = line_end(text, start)
            self._report(
                "unclosed-string", start, end, f"this string has no closing {quote}",
                ("it is read to the end of its line",),
            )  # fmt: skip
        elif "\n" in (raw := text[start:end]) or "\r" in raw:
            self._check_lines(start, end)
        if "\\" in (raw := text[start:end]):
            self._check_escapes(start, raw)
        return self._add(STRING, start, end)

    def _check_lines(self, start: int, end: int) -> None:
        for line in _LINE_START.finditer(self.text, start, end):
            if item := _TOP_LINE.match(self.text, line.end()):
                place = Place(Span(item.start(), item.end()))
                self.problems.append(
                    Diagnostic(
                        "string-over-items",
                        Span(start, start + 1),
                        "this string runs past a line that looks like the start of an item",
                        related=(Related(place, "this line is inside the string"),),
                        notes=("if that is not meant, a closing quote is missing",),
                    )
                )
                return

    def _check_escapes(self, start: int, raw: str) -> None:
        index = raw.find("\\")
        while 0 <= index < len(raw) - 1:
            if raw[index + 1] not in "\"'\\nt":
                at = start + index
                fix = replace_fix("Write `\\\\`", Span(at, at + 1), "\\\\", safe=True)
                message = f"`{raw[index : index + 2]}` is no escape: it stands for both its characters"
                self.problems.append(Diagnostic("unknown-escape", Span(at, at + 2), message, fixes=(fix,)))
                return
            index = raw.find("\\", index + 2)

    def _quote_this(self, start: int) -> int:
        """A comment sign inside a word or value: take all of it for one name, and say that it needs quotes."""
        text = self.text
        end = _WORD_WITH_SIGN.match(text, start).end()  # type: ignore[union-attr]  # it matches the sign at least
        fix = replace_fix("Put quotes around it", Span(start, end), f'"{text[start:end]}"', safe=True)
        sign = _COMMENT_SIGN.search(text, start)
        assert sign is not None, "there is a sign: that is why we are here"
        message = f"`{sign[0]}` begins a comment only behind a blank: quote this"
        self.problems.append(Diagnostic("misplaced-comment", Span(start, end), message, fixes=(fix,)))
        return self._add(NAME, start, end)

    def _comment(self, start: int) -> int:
        """The end of the comment that begins here, or `start` where none may begin."""
        text = self.text
        sign = _COMMENT_SIGN.match(text, start)
        if sign is None:
            return start
        if start > 0 and text[start - 1] not in " \t\r\n(),\ufeff" and not text.startswith("*/", start - 2):
            return start
        if self.raws and self.raws[-1] == "=":
            return start
        if sign[0] == "/*":
            closing = text.find("*/", start + 2)
            end = closing + 2 if closing >= 0 else line_end(text, start)
            if closing < 0:
                self._report("unclosed-comment", start, start + 2, "this comment has no closing */",
                             ("it is read to the end of its line",))  # fmt: skip
        else:
            end = line_end(text, start)
        self.comments.append((start, end))
        return end

    # ---- brackets ----

    def _close(self, position: int) -> int:
        if not self._brackets:
            self._report("syntax-error", position, position + 1, "this `)` closes nothing")
            return position + 1
        self._brackets.pop()
        return self._add(CLOSE, position, position + 1)

    def _blanks(self) -> str:
        """The blanks at the start of the line at hand."""
        return _BLANKS.match(self.text, self._last_line)[0]  # type: ignore[index]  # it matches nothing at least

    def _continue(self, position: int) -> int:
        """Behind a line end in brackets: the next line, or `position` where the line ends the brackets early."""
        text, size = self.text, self.size
        start = at = position
        while at < size and text[at] in " \t\r\n":
            if text[at] in "\r\n":
                start = at + 1
            at += 1
        self._last_line = start
        if at >= size or text[at] == ")" or _COMMENT_SIGN.match(text, at):
            return at
        blanks = text[start:at]
        if (blanks == "" or self._at_root_column(blanks)) and _TOP_LINE.match(text, at):
            self._end_brackets(len(self._brackets), position, at)
            return position
        ended = 0
        for _, opened in reversed(self._brackets):
            if len(blanks) < len(opened) and opened.startswith(blanks):
                ended += 1
            else:
                break
        if not ended:
            return at
        self._end_brackets(ended, position, at)
        return at if self._brackets else position

    def _at_root_column(self, blanks: str) -> bool:
        level = self._root_level
        return 0 < level < len(self._indents) and blanks == self._indents[level]

    def _end_brackets(self, count: int, position: int, because: int | None) -> None:
        """Close `count` brackets where no `)` is, so that the parser sees them closed; report the outermost."""
        opened = self._brackets[-count][0]
        related: tuple[Related, ...] = ()
        if because is not None:
            end = line_end(self.text, because)
            related = (Related(Place(Span(because, end)), "the brackets end before this line"),)
        self.problems.append(
            Diagnostic("unclosed-bracket", Span(opened, opened + 1), "this `(` has no `)`", related=related)
        )
        del self._brackets[-count:]
        end = self.starts[-1] + len(self.raws[-1])
        for _ in range(count):
            self._add(CLOSE, end, end)

    # ---- reports ----

    def _report(self, rule: str, start: int, end: int, message: str, notes: tuple[str, ...] = ()) -> None:
        self.problems.append(Diagnostic(rule, Span(start, end), message, notes=notes))

    def _report_indentation(self, blanks: str, expected: str, position: int) -> None:
        if set(blanks) - set(expected) or set(expected) - set(blanks):
            message = "tabs and blanks are mixed: this indentation cannot be compared with the block's"
        else:
            message = "this indentation fits no open block"
        note = f"it is read as the block indented by {_shown(expected)}"
        span = Span(position - len(blanks), position)
        fix = replace_fix("Indent it like that block", span, expected)
        self.problems.append(Diagnostic("inconsistent-indentation", span, message, notes=(note,), fixes=(fix,)))


# ---- pieces ----


def _has_line_end(text: str, start: int, end: int) -> bool:
    return text.find("\n", start, end) >= 0 or text.find("\r", start, end) >= 0


def _extends(blanks: str, outer: str, aliases: tuple[str, ...]) -> bool:
    return any(len(blanks) > len(column) and blanks.startswith(column) for column in (outer, *aliases))


def _shown(blanks: str) -> str:
    if not blanks:
        return "nothing"
    tabs = blanks.count("\t")
    parts = [
        f"{count} {word}{'s' * (count > 1)}" for count, word in ((tabs, "tab"), (len(blanks) - tabs, "blank")) if count
    ]
    return " and ".join(parts)


def _pieces(text: str, start: int, end: int) -> list[Token]:
    return [
        Token(BLANK if piece[1] else ERROR, piece.start(), piece[0]) for piece in _PIECES.finditer(text, start, end)
    ]


# ---- tables ----

_TWO: Final = frozenset(("==", "!=", "<=", ">=", "::"))
_INSTEAD: Final = {
    "&": "write `and`",
    "|": "write `or`; `||` is the symbol of Parallel",
    "!": "write `not`",
    ";": "a line ends without a sign",
    "[": "attributes stand in `( … )`",
    "{": "a blackboard entry is written `{key}`, on one line and without quotes",
    "\xa0": "this is a no-break space: use an ordinary blank",
    "\ufeff": "a byte order mark belongs at the start of a file",
}
_BLANKS: Final = re.compile(r"[ \t]*")
_PIECES: Final = re.compile(r"([ \t\r\n\ufeff]+)|[^ \t\r\n\ufeff]+")
_LINE_START: Final = re.compile(r"\r\n|\n|\r")
_BRACED: Final = re.compile(r"\{[^{}\"'\r\n]*\}")
_COMMENT_SIGN: Final = re.compile(r"#|//|/\*")
_WORD_WITH_SIGN: Final = re.compile(r"[^\s(),]+")
# The words that begin an item, and what must follow for a line to end a forgotten bracket (language.md §2, Brackets).
_TOP_LINE: Final = re.compile(
    r"""
    BehaviorTree [ \t]+ ID [ \t]* = (?!=)
    | (?:BehaviorTree|Root|TreeNodesModel) [ \t]* (?= [\r\n(] | \Z )
    | (?:BehaviorTree|Root|TreeNodesModel|include|signal|context|apply|quality|qualities|QualityReq)
      (?: [ \t]+ (?= (?P<name> [^\W\d] (?:\w|-(?=\w))* [?!]? ) ) (?P=name)
        | [ \t]* (?: "(?:[^"\\\r\n]|\\.)*" | '(?:[^'\\\r\n]|\\.)*' ) )
      (?! [ \t]* = )
    """,
    re.VERBOSE,
)
