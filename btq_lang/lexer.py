"""The lexer: text to tokens, one logical line at a time.

One invariant: it accepts every string, and every step advances.  It knows indentation, brackets, strings, numbers with
units and comments (docs/language.md); of the grammar it knows only the words that begin an item, because a forgotten
bracket ends there.

The parser pulls: `open_line` finds the next line with tokens and compares its indentation, `scan` splits it into
`kinds`, `starts` and `raws`, three flat lists.  Characters are compared as numbers, one by one, because mypyc compiles
that well; words and blanks are long, so two maps of the text show where they end, which is fast interpreted and
compiled.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from operator import itemgetter
from typing import TYPE_CHECKING, Final, TypeAlias

from btq_lang.diagnostics.model import Diagnostic, Fix, Place, Related, replace_fix
from btq_lang.syntax.indentation import TOP_LINE, extends
from btq_lang.syntax.scan import (
    APOSTROPHE,
    CAPITAL_A,
    CAPITAL_Z,
    CLOSING,
    COMMA,
    EQUALS,
    HASH,
    LINE_FEED,
    NINE,
    OPENING,
    QUOTE,
    RETURN,
    SLASH,
    SMALL_A,
    SMALL_Z,
    SPACE,
    ZERO,
    Maps,
    begins_name,
    blanks_end,
    braced_end,
    line_end,
    line_opening,
    maps_of,
    name_end,
    number_at,
    string_end,
    symbol_end,
    unit_run,
)
from btq_lang.syntax.strange import StrangeCharacters, has_line_end
from btq_lang.syntax.suggestions import close_string, unknown_escapes, unknown_unit
from btq_lang.syntax.tokens import (
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
from btq_lang.syntax.tree import quote as quoted
from btq_lang.util.text import LINE_END, Span

if TYPE_CHECKING:
    from mypy_extensions import i64

State: TypeAlias = "tuple[tuple[str, ...], tuple[tuple[str, ...], ...], int]"


def tokens(text: str) -> tuple[Token, ...]:
    """All tokens of a text, blanks and comments included, INDENT and DEDENT where blocks open and close."""
    lexer = Lexer(text)
    comments = lexer.comments
    result: list[Token] = []
    end = level = added = 0
    while lexer.open_line():
        lexer.scan()
        added = _fill(result, text, end, lexer.starts[0], comments, added)
        end = lexer.starts[0]
        step = INDENT if lexer.level > level else DEDENT
        result += [Token(step, end, "")] * abs(lexer.level - level)
        level = lexer.level
        for kind, start, raw in zip(lexer.kinds, lexer.starts, lexer.raws, strict=True):
            added = _fill(result, text, end, start, comments, added)
            result.append(Token(kind, start, raw))
            end = start + len(raw)
    _fill(result, text, end, len(text), comments, added)
    result += [Token(DEDENT, len(text), "")] * level
    return tuple(result)


def pieces(text: str) -> list[tuple[int, int, str]]:
    """Kind, start and text of all tokens except brackets, line ends, blanks and invalid characters: a third of
    `tokens`, and faster.
    """
    lexer = Lexer(text)
    comments = lexer.comments
    result: list[tuple[int, int, str]] = []
    added = 0
    while lexer.open_line():
        lexer.scan()
        of_line = [*zip(lexer.kinds, lexer.starts, lexer.raws, strict=True)]
        if added < len(comments):
            of_line += [(COMMENT, start, text[start:end]) for start, end in comments[added:]]
            of_line.sort(key=itemgetter(1))
            added = len(comments)
        result += [piece for piece in of_line if piece[0] not in _SILENT]
    result += [(COMMENT, start, text[start:end]) for start, end in comments[added:]]
    return result


class Lexer(StrangeCharacters):
    """A place in a text, and the logical line that begins there.

    Attributes:
        comments: start and end of every comment so far.
        ends_early: the line ends brackets that have no `)`, and nothing follows them.
        ended_early: how many brackets ended before a line with less indentation, if no other has opened since.
    """

    def __init__(self, text: str, maps: Maps | None = None) -> None:
        super().__init__(text, maps or maps_of(text))
        self.comments: list[tuple[int, int]] = []
        self.ends_early = False
        self.ended_early = 0
        self._stray_until = -1  # the end of the last physical line with a reported `)`
        self._wrong_units = 0  # how many were reported on this line
        self._line_blanks = ""  # of the current physical line, except inside strings and comments
        self._no_double = self._no_single = self.size + 1  # from here on there is no such closing quote
        self._has_returns: Final = "\r" in text
        self._has_escapes: Final = "\\" in text
        self._no_comment_end = self.size + 1  # nor any */

    # ---- lines ----

    def open_line(self) -> bool:
        """Go to the next line with tokens and find its level; False at the end of the text."""
        text, size = self.text, self.size
        start, position = line_opening(text, self.maps.ink, self.position)
        blanks = text[start:position]
        while position < size and ord(text[position]) in (HASH, SLASH):
            end = self._comment(position)
            if end == position:
                break
            start_after, position = line_opening(text, self.maps.ink, end)
            if start_after > end:
                start = start_after
                blanks = text[start:position]
        self.position = position
        if position == size:
            self.level = 0
            self.line_start = size
            return False
        self.line_start = start
        self.blanks = blanks
        if blanks != self.columns[-1]:
            self._indent(blanks)
        return True

    def state(self) -> State | None:
        """The blanks of the open blocks, their aliases, and the level of an open Root's items, if these and the rest of
        the text determine what follows; else None.
        """
        searched = min(self._no_double, self._no_single, self._no_comment_end) <= self.size
        if searched or self.problems or self.ended_early or self._block_ends:
            return None
        return tuple(self.columns), tuple(self._aliases) if self.adopted else (), self._root_level

    def begin_at(self, start: int, state: State) -> None:
        """Go to the line that starts there, in this state."""
        columns, aliases, self._root_level = state
        self.columns = list(columns)
        self._aliases = list(aliases) or [()] * len(columns)
        self.adopted = aliases != ()
        self.level = len(columns) - 1
        self.position = start

    def scan(self) -> None:
        """Tokenize the opened line, through all lines that its brackets join."""
        self._begin_line()
        kinds, starts, raws, brackets = self.kinds, self.starts, self.raws, self._brackets
        text, words = self.text, self.maps.words
        size: i64 = self.size
        position: i64 = self.position
        while position < size:
            code: i64 = ord(text[position])
            if code == SPACE:
                position += 1
                continue
            end = position + 1
            if code >= CAPITAL_A and (SMALL_A <= code <= SMALL_Z or code <= CAPITAL_Z or begins_name(code)):
                kind = NAME
                end = name_end(text, words, position)
                if code < SMALL_A and end <= position + 3 and (further := symbol_end(text, position)) >= end:
                    kind = SYMBOL
                    end = further
            elif code == EQUALS:
                kind = OPERATOR
                if end < size and ord(text[end]) == EQUALS:
                    end += 1
            elif code in (QUOTE, APOSTROPHE):
                kind = STRING
                end = self._string_end(position, text[position])
                if end < 0:
                    position = self._no_string(position, text[position])
                    continue
            elif code == OPENING:
                kind = OPEN
                brackets.append((position, self._line_blanks))
                self.ended_early = 0
            elif code == CLOSING and brackets:
                kind = CLOSE
                brackets.pop()
            elif code == COMMA:
                kind = OPERATOR
            elif code in (LINE_FEED, RETURN):
                position = self._continue(position) if brackets else position
                if not brackets:
                    break
                continue
            else:
                is_digit = ZERO <= code <= NINE
                position = self._number(position) if is_digit else self._other(position, text[position])
                continue
            kinds.append(kind)
            starts.append(position)
            raws.append(text[position:end])
            position = end
        self._end_line(position)

    def _begin_line(self) -> None:
        self.kinds = []
        self.starts = []
        self.raws = []
        self._strange = False
        self._wrong_units = 0
        self._line_blanks = self.blanks

    def _end_line(self, position: i64) -> None:
        """Add NEWLINE, and store what later lines need"""
        if self._brackets:
            self._end_brackets(len(self._brackets), position, None)
        raws = self.raws
        self.ends_early = len(raws) > 0 and raws[-1] == ""
        end = position
        if position < self.size:
            end += 2 if self._has_returns and self.text.startswith("\r\n", position) else 1
        self._add(NEWLINE, position, end)
        self.position = end
        if self.ends_early:
            self._cut_until = end
        if raws[0] == "Root" and self._is_root_line():
            self._root_level = self.level + 1

    def first_word(self) -> str:
        """The NAME that the opened line begins with; any other text if it begins with none."""
        return self.text[self.position : name_end(self.text, self.maps.words, self.position)]

    def line_end(self) -> int:
        """The end of the current physical line."""
        return line_end(self.text, self.position)

    def _is_root_line(self) -> bool:
        """Whether the current line begins a `Root` block; its first token must have been read."""
        return self.raws[0] == "Root" and self.kinds[0] == NAME and self.level in (0, self._root_level)

    # ---- tokens, each from its first character to the position after it ----

    def _other(self, start: i64, character: str) -> i64:
        """Symbols, signs, braces and comments; a tab is skipped."""
        if character == "\t":
            return start + 1
        text = self.text
        if character == "#" or character == "/":
            after = self._comment(start)
            if after > start:
                return after
        if character == ")":
            return self._stray_closing(start)
        if (end := symbol_end(text, start)) > start:
            return self._add(SYMBOL, start, end)
        if (
            character == "-"
            and start + 1 < self.size
            and "0" <= text[start + 1] <= "9"
            and not self._after_operand(start)
        ):
            return self._number(start)
        if character == "{" and (braced := braced_end(text, start)) > start:
            return self._add(BRACED, start, braced)
        if character in "#/" and text.startswith(_COMMENT_SIGNS, start):
            return self._quote_this(start)
        if (two := text[start : start + 2]) in _TWO or character in ":.<>+-*/%^":
            return self._add(OPERATOR, start, start + 2 if two in _TWO else start + 1)
        if character == "!" or text.startswith("&&", start):  # the parser decides whether it is a condition
            return self._add(ERROR, start, start + (1 if character == "!" else 2))
        return self._invalid_character(start, character)

    def _after_operand(self, position: int) -> bool:
        """Whether a `-` here subtracts: it does after an operand on the same line (docs/language.md, NUMBER)."""
        if not self.kinds or self.kinds[-1] not in (NAME, NUMBER, QUANTITY, STRING, CLOSE):
            return False
        return not has_line_end(self.text, self.starts[-1] + len(self.raws[-1]), position)

    def _number(self, start: i64) -> i64:
        kind, end = number_at(self.text, start)
        if kind == ERROR:
            unit = blanks_end(self.text, end, self.size)
            kind, end = QUANTITY, unit_run(self.text, unit)
            self._wrong_units += 1
            if self._wrong_units <= _MANY:
                self.problems.append(unknown_unit(self.text, unit, end))
        return self._add(kind, start, end)

    def _string_end(self, start: i64, quote: str) -> i64:
        """The end of a string, which may span lines; -1 if it has no closing quote, or no string begins here."""
        if start >= (self._no_double if quote == '"' else self._no_single):
            return -1
        text = self.text
        end: i64 = string_end(text, start + 1, quote)
        if end < 0:
            if quote == '"':
                self._no_double = start
            else:
                self._no_single = start
            return -1
        if text.find("\n", start, end) >= 0 or (self._has_returns and text.find("\r", start, end) >= 0):
            if self._closes_path(start):
                return -1
            self._check_lines(start, end)
        if self._has_escapes and text.find("\\", start, end) >= 0:
            self.problems += unknown_escapes(start, text[start:end])
        return end

    def _no_string(self, start: i64, quote: str) -> i64:
        """Handle a quote that closes the path of an include, or that is not closed."""
        return self._add(ERROR, start, start + 1) if self._closes_path(start) else self._unclosed_string(start, quote)

    def _closes_path(self, start: int) -> bool:
        """Whether a quote at the end of its line closes the path after `include`, which lacks the opening one: no
        string begins there, and the parser reports what is missing.
        """
        if len(self.raws) < 2 or self.raws[0] != "include" or self.kinds[-1] == STRING:
            return False
        end = blanks_end(self.text, start + 1, self.size)
        is_last = end == self.size or self.text[end] in "\r\n#/"
        return is_last and self.starts[-1] + len(self.raws[-1]) == start

    def _unclosed_string(self, start: int, quote: str) -> int:
        end = line_end(self.text, start)
        message = f"missing closing {quote} for this string"
        notes = ("btq reads it to the end of its line",)
        fixes = (close_string(self.text, start),)
        self.problems.append(Diagnostic("unclosed-string", Span(start, end), message, notes=notes, fixes=fixes))
        self._add(STRING, start, end)
        self._close_lost(start, end)
        return end

    def _check_lines(self, start: int, end: int) -> None:
        for line in LINE_END.finditer(self.text, start, end):
            if item := TOP_LINE.match(self.text, line.end()):
                place = Place(Span(item.start(), item.end()))
                self.problems.append(
                    Diagnostic(
                        "string-over-items",
                        Span(start, start + 1),
                        "this string runs past a line that looks like the start of an item",
                        related=(Related(place, "this line is inside the string"),),
                        notes=("if you did not intend that, add the closing quote",),
                        fixes=(close_string(self.text, start),),
                    )
                )
                return

    def _quote_this(self, offset: int) -> int:
        """Report a comment sign, or a word before one, where no comment may begin: the word around it needs quotes;
        after anything but a word a blank is missing.
        """
        text = self.text
        start, end = self._whole_word(offset)
        sign = _COMMENT_SIGN.search(text, start)
        assert sign is not None, "there is a sign: that is why we are here"
        message = f"`{sign[0]}` begins a comment only after a space"
        insert = replace_fix(f"Put a space before `{sign[0]}`", Span(sign.start(), sign.start()), " ")
        in_value = bool(self.raws) and self.raws[-1] == "="
        if start == sign.start() and not in_value:
            fix = Fix(insert.title, insert.changes, safe=True)
            self.problems.append(Diagnostic("misplaced-comment", Span(start, sign.end()), message, fixes=(fix,)))
            return self._read_comment(start)
        safe = in_value and text[end : end + 1] not in _QUOTES and self._takes_strings()
        fix = replace_fix("Put quotes around it", Span(start, end), quoted(text[start:end]), safe=safe)
        fixes: tuple[Fix, ...] = (fix,) if in_value or sign[0] == "/*" else (fix, insert)
        notes: tuple[str, ...] = ()
        if self.raws[:1] == ["apply"] and sign[0] == "/*":
            notes = (f"the nodes below another are selected with `every <node> under {text[start : sign.start()]}`",)
            fixes = ()
        if sign.end() == end:  # the word ends with the sign: probably a comment
            fixes = fixes[::-1]
        self.problems.append(
            Diagnostic("misplaced-comment", Span(start, end), f"{message}; put this in quotes", (), notes, fixes)
        )
        return self._add(NAME, start, end)

    def _comment(self, start: int) -> int:
        """The end of the comment that begins here, or `start` if none may begin."""
        text = self.text
        if ord(text[start]) != HASH and text[start : start + 2] not in ("//", "/*"):
            return start
        before = text[start - 1 : start]
        if before not in " \t\r\n()," and before != "\ufeff" and not text.startswith("*/", start - 2):
            return start
        if self.raws and self.raws[-1] == "=":
            return start
        return self._read_comment(start)

    def _read_comment(self, start: int) -> int:
        text = self.text
        closes = text[start : start + 2] == "/*"
        if closes and start < self._no_comment_end:
            closing = text.find("*/", start + 2)
            if closing >= 0:
                self.comments.append((start, closing + 2))
                return closing + 2
            self._no_comment_end = start
        end = line_end(text, start)
        self.comments.append((start, end))
        if closes:
            fix = replace_fix("Close it at the end of the line", Span(end, end), " */")
            message = "missing closing `*/` for this comment"
            notes = ("btq reads it to the end of its line",)
            span = Span(start, start + 2)
            self.problems.append(Diagnostic("unclosed-comment", span, message, notes=notes, fixes=(fix,)))
            self._close_lost(start, end)
        return end

    # ---- brackets ----

    def _stray_closing(self, position: i64) -> i64:
        """Handle a `)` without an open bracket."""
        if self.ended_early:  # it closes brackets that ended early
            self.ended_early -= 1
        elif position > self._stray_until:
            message = "unexpected `)`: no bracket is open"
            self.problems.append(Diagnostic("syntax-error", Span(position, position + 1), message))
            self._stray_until = line_end(self.text, position)
        return position + 1

    def _continue(self, position: i64) -> i64:
        """After a line end in brackets: go to the next line, or return `position` if that line ends the
        brackets early.
        """
        text = self.text
        start, next_word = line_opening(text, self.maps.ink, position)
        blanks = self._line_blanks = text[start:next_word]
        if next_word >= self.size:
            return next_word
        code: i64 = ord(text[next_word])
        if code in (CLOSING, HASH) or (code == SLASH and text.startswith(_COMMENT_SIGNS, next_word)):
            return next_word
        if self._at_top_column(blanks) and TOP_LINE.match(text, next_word):
            self._end_brackets(len(self._brackets), position, next_word)
            return position
        ended = 0
        for _, opened in reversed(self._brackets):
            if len(blanks) < len(opened) and opened.startswith(blanks):
                ended += 1
            else:
                break
        if not ended:
            return next_word
        self._end_brackets(ended, position, next_word)
        return next_word if self._brackets else position

    def _at_top_column(self, blanks: str) -> bool:
        """Whether an item may begin at this indentation; after `Root (` without `)`, at any that its block may have."""
        level = self._root_level
        if blanks == "" or (0 < level < len(self.columns) and blanks == self.columns[level]):
            return True
        return self._is_root_line() and extends(blanks, self.columns[-1], ())

    def _close_lost(self, start: int, end: int) -> None:
        """Close the brackets whose `)` is inside a string or comment that runs to the end of its line."""
        lost = self.text.count(")", start, end) - self.text.count("(", start, end)
        for _ in range(min(lost, len(self._brackets))):
            self._brackets.pop()
            self._add(CLOSE, end, end)

    def _end_brackets(self, count: int, position: int, because: int | None) -> None:
        """Close `count` brackets without a `)`, so that the parser sees them closed; report the outermost."""
        opened = self._brackets[-count][0]
        related: tuple[Related, ...] = ()
        if because is not None:
            end = line_end(self.text, because)
            related = (Related(Place(Span(because, end)), "the brackets end before this line"),)
        del self._brackets[-count:]
        self.ended_early = count
        end = self.starts[-1] + len(self.raws[-1])
        for _ in range(count):
            self._add(CLOSE, end, end)
        missed = self._missed_at(opened) if count == 1 else end
        fix = replace_fix("Add `)`", Span(missed, missed), ")" * count)
        message = "missing `)` for this `(`"
        span = Span(opened, opened + 1)
        self.problems.append(Diagnostic("unclosed-bracket", span, message, related=related, fixes=(fix,)))

    def _missed_at(self, opened: int) -> int:
        """The place of a probably forgotten `)`: the end of a line after which no attribute begins."""
        end = opened
        for index in range(bisect_left(self.starts, opened), len(self.starts)):
            start, raw = self.starts[index], self.raws[index]
            begins = index + 1 < len(self.raws) and has_line_end(self.text, end, start)
            if begins and raw not in _IN_BRACKETS and self.raws[index + 1] != "=" and self.raws[index - 1] not in "=,(":
                break
            end = start + len(raw)
        return end


# ---- all tokens ----


def _fill(result: list[Token], text: str, end: int, start: int, comments: list[tuple[int, int]], added: int) -> int:
    """Add what the lexer skipped between two tokens: blanks, comments and invalid characters.

    Args:
        added: how many comments were added before.

    Returns:
        How many are added now.  (Not nested in `tokens`: a compiled closure would retain all of these until garbage
        collection.)
    """
    while added < len(comments) and comments[added][0] < start:
        comment, after = comments[added]
        result += _gaps(text, end, comment)
        result.append(Token(COMMENT, comment, text[comment:after]))
        end = after
        added += 1
    result += _gaps(text, end, start)
    return added


def _gaps(text: str, start: int, end: int) -> list[Token]:
    return [Token(BLANK if piece[1] else ERROR, piece.start(), piece[0]) for piece in _GAP.finditer(text, start, end)]


# ---- patterns ----

_GAP: Final = re.compile(r"([ \t\r\n\ufeff]+)|[^ \t\r\n\ufeff]+")
_COMMENT_SIGN: Final = re.compile(r"#|//|/\*")

# ---- tables ----

_SILENT: Final = (OPEN, CLOSE, NEWLINE)
_TWO: Final = frozenset(("==", "!=", "<=", ">=", "::"))
_COMMENT_SIGNS: Final = ("#", "//", "/*")
_MANY: Final = 20  # wrong units reported on one line: more would not help
_IN_BRACKETS: Final = frozenset(("satisfices", "satisfies", "tags", "parameters", "description", ",", "(", ")", "="))
_QUOTES: Final = ('"', "'", "{", "}")  # after a word they indicate more than a missing quote
