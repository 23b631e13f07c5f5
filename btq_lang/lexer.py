"""The lexer: text to tokens, one logical line at a time.

One invariant: it takes every string, and moves forward with every step.
It knows indentation, brackets, strings, numbers with units and comments (docs/language.md); it knows no grammar but the
words that begin an item, for these are where a forgotten bracket ends.

The parser pulls: `open_line` finds the next line that says something and compares its indentation, `scan` cuts it into
`kinds`, `starts` and `raws`, three flat lists.  Characters are compared as numbers, one by one, because mypyc compiles
that well; words and blanks are long, so two maps of the text say where they end, which is quick in both forms.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from typing import TYPE_CHECKING, Final, TypeAlias

from btq_lang.diagnostics.model import Change, Diagnostic, Fix, Place, Related, replace_fix
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
    begins_name,
    blanks_end,
    braced_end,
    ink_map,
    line_end,
    line_opening,
    line_start,
    name_end,
    number_at,
    string_end,
    symbol_end,
    unit_run,
    word_map,
)
from btq_lang.syntax.suggestions import (
    ATTRIBUTES,
    INSTEAD,
    attributes_in_braces,
    close_string,
    no_token,
    unknown_escapes,
    unknown_unit,
    value_meant,
)
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
    found: list[Token] = []
    end = level = told = 0
    while lexer.open_line():
        lexer.scan()
        told = _fill(found, text, end, lexer.starts[0], comments, told)
        end = lexer.starts[0]
        step = INDENT if lexer.level > level else DEDENT
        found += [Token(step, end, "")] * abs(lexer.level - level)
        level = lexer.level
        for kind, start, raw in zip(lexer.kinds, lexer.starts, lexer.raws, strict=True):
            told = _fill(found, text, end, start, comments, told)
            found.append(Token(kind, start, raw))
            end = start + len(raw)
    _fill(found, text, end, len(text), comments, told)
    found += [Token(DEDENT, len(text), "")] * level
    return tuple(found)


def pieces(text: str) -> list[tuple[int, int, str]]:
    """Kind, start and text of all tokens but brackets, line ends, blanks and what begins nothing: a third of
    what `tokens` has, and quickly."""
    lexer = Lexer(text)
    comments = lexer.comments
    found: list[tuple[int, int, str]] = []
    told = 0
    while lexer.open_line():
        lexer.scan()
        of_line = [*zip(lexer.kinds, lexer.starts, lexer.raws, strict=True)]
        if told < len(comments):
            of_line += [(COMMENT, start, text[start:end]) for start, end in comments[told:]]
            of_line.sort(key=_start_of)
            told = len(comments)
        found += [piece for piece in of_line if piece[0] not in _SILENT]
    found += [(COMMENT, start, text[start:end]) for start, end in comments[told:]]
    return found


class Lexer:
    """A place in a text, and the logical line that begins there.

    Attributes:
        words, ink: the maps of the text that `scan` reads (`word_map`, `ink_map`).
        position: where the next thing is read.
        level: how many blocks are open around the line.
        line_start: where the line begins, its blanks included.
        blanks: the blanks it begins with.
        columns: the blanks of each open block.
        adopted: other blanks were taken for those of an open block.
        kinds, starts, raws: the tokens of the line after `scan`; the last one is always a NEWLINE.
        comments: start and end of every comment so far.
        problems: what was wrong so far.
        ends_early: the line ends brackets that have no `)`, and nothing follows these.
        ended_early: how many brackets ended before a line further left, while no other has opened since.
    """

    def __init__(self, text: str) -> None:
        self.text: Final = text
        self.size: Final = len(text)
        self.words: Final = word_map(text)
        self.ink: Final = ink_map(text)
        self.position = 1 if text.startswith("\ufeff") else 0
        self.level = 0
        self.line_start = self.position
        self.blanks = ""
        self.kinds: list[int] = []
        self.starts: list[int] = []
        self.raws: list[str] = []
        self.comments: list[tuple[int, int]] = []
        self.problems: list[Diagnostic] = []
        self.ends_early = False
        self.ended_early = 0
        self._cut_until = -1  # the end of the last line that ended its brackets early
        self.columns: list[str] = [""]
        self._aliases: list[tuple[str, ...]] = [()]  # other blanks taken for the same block, each reported once
        self.adopted = False
        self._brackets: list[tuple[int, str]] = []  # where each was opened, and the blanks of that line
        self._block_ends: set[int] = set()  # where braces close blocks whose opening ones are reported
        self._strange = False  # a character that begins nothing was reported on this line
        self._stray_until = -1  # the end of the last line of text where a `)` was reported
        self._wrong_units = 0  # how many were reported on this line
        self._line_blanks = ""  # of the line of text at hand, but for lines inside strings and comments
        self._root_level = -1  # the level of an open Root block's items
        self._no_double = self._no_single = self.size + 1  # from here on no such quote closes anything
        self._has_returns: Final = "\r" in text
        self._has_escapes: Final = "\\" in text
        self._no_comment_end = self.size + 1  # nor any */

    # ---- lines ----

    def open_line(self) -> bool:
        """Go to the next line that says something and find its level; False at the end of the text."""
        text, size = self.text, self.size
        start, position = line_opening(text, self.ink, self.position)
        blanks = text[start:position]
        while position < size and ord(text[position]) in (HASH, SLASH):
            end = self._comment(position)
            if end == position:
                break
            start_behind, position = line_opening(text, self.ink, end)
            if start_behind > end:
                start = start_behind
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
        """The blanks of the open blocks, what was taken for them, and the level of an open Root's items, where they and
        the text from here on are all that tells what follows; else None."""
        searched = min(self._no_double, self._no_single, self._no_comment_end) <= self.size
        if searched or self.problems or self.ended_early or self._block_ends:
            return None
        return tuple(self.columns), tuple(self._aliases) if self.adopted else (), self._root_level

    def begin_at(self, start: int, state: State) -> None:
        """Stand before the line that starts there, in such a state."""
        columns, aliases, self._root_level = state
        self.columns = list(columns)
        self._aliases = list(aliases) or [()] * len(columns)
        self.adopted = aliases != ()
        self.level = len(columns) - 1
        self.position = start

    def _indent(self, blanks: str) -> None:
        """Open a block, close blocks, or adopt a column that no open block has."""
        columns, aliases = self.columns, self._aliases
        level = len(columns) - 1
        if not self.adopted and len(blanks) > len(columns[level]):
            level = -1  # as below, for no column is longer
        while level >= 0 and blanks != columns[level] and blanks not in aliases[level]:
            level -= 1
        if level < 0:
            if _extends(blanks, columns[-1], aliases[-1]):
                columns.append(blanks)
                aliases.append(())
                self.level = len(columns) - 1
                return
            level = self._adopting_level(blanks)
            self.adopted = True
            if self._cut_until < 0 or self.text[self._cut_until : self.line_start].strip():
                self._report_indentation(blanks, columns[level])  # else it is what is left of the brackets
            if level == 0:
                aliases[0] = (*aliases[0], blanks)[-_ALIASES:]
            else:
                aliases[level] = (*aliases[level], columns[level])[-_ALIASES:]
                columns[level] = blanks
        while len(columns) > level + 1:
            columns.pop()
            aliases.pop()
        if self.adopted and level <= max(self._root_level, 0) and not any(aliases):
            self.adopted = False  # the blocks in which that was are closed
        self.level = level
        if level < self._root_level:
            self._root_level = -1

    def _adopting_level(self, blanks: str) -> int:
        """The block that a line belongs to whose indentation fits none: for an item that of the items, else the nearer
        of those between which it stands; of tabs in a file of blanks, each counts as a level."""
        columns = self.columns
        items = max(0, min(self._root_level, len(columns) - 1))  # a Root may have no block
        if _TOP_LINE.match(self.text, self.position):
            return items
        if not blanks.strip("\t") and not "".join(columns).strip(" "):
            return min(len(blanks), len(columns) - 1)
        level = len(columns) - 1
        while not _extends(blanks, columns[level - 1], self._aliases[level - 1]):
            level -= 1
        is_nearer = len(blanks) - len(columns[level - 1]) < len(columns[level]) - len(blanks)
        return level - 1 if is_nearer and level - 1 > items else level

    def scan(self) -> None:
        """Cut the opened line into tokens, through all lines that its brackets join."""
        self._begin_line()
        kinds, starts, raws, brackets = self.kinds, self.starts, self.raws, self._brackets
        text, words = self.text, self.words
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
        """NEWLINE, and what is remembered of the line"""
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
        """The NAME that the opened line begins with; else it begins with no such text."""
        return self.text[self.position : name_end(self.text, self.words, self.position)]

    def line_end(self) -> int:
        """Where the line of text at hand ends."""
        return line_end(self.text, self.position)

    def _is_root_line(self) -> bool:
        """Whether the line at hand, of which at least one token is read, begins a `Root` block."""
        return self.raws[0] == "Root" and self.kinds[0] == NAME and self.level in (0, self._root_level)

    # ---- tokens, each from its first character to the position behind it ----

    def _add(self, kind: int, start: i64, end: i64) -> i64:
        self.kinds.append(kind)
        self.starts.append(start)
        self.raws.append(self.text[start:end])
        return end

    def _other(self, start: i64, character: str) -> i64:
        """Symbols, signs, braces and comments; a tab is passed over."""
        if character == "\t":
            return start + 1
        text = self.text
        if character == "#" or character == "/":
            behind = self._comment(start)
            if behind > start:
                return behind
        if character == ")":
            return self._close_nothing(start)
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
        if character == "!" or text.startswith("&&", start):  # the parser knows whether a condition is meant
            return self._add(ERROR, start, start + (1 if character == "!" else 2))
        return self._nothing(start, character)

    def _nothing(self, start: i64, character: str) -> i64:
        """What begins nothing, reported once a line; mostly it is left out."""
        text = self.text
        if character == "]" and self._brackets and text.find("[", self._brackets[-1][0], start) < 0:
            return self._close_square(start)
        if character == "$" and (entry := _SHELL_ENTRY.match(text, start)) and self.raws[-1:] == ["="]:
            return self._shell_entry(start, entry.end())
        if character == ";" and self._separates(start):
            self._strange = True
            fix = replace_fix("Write `,`", Span(start, start + 1), ",", safe=True)
            message = "expected `,` between attributes, found `;`"
            self.problems.append(Diagnostic("syntax-error", Span(start, start + 1), message, fixes=(fix,)))
            return start + 1
        if character == "[" and self.raws[-1:] == ["="] and (square := _SQUARE.match(text, start)):
            self._strange = True
            fixes = (value_meant(text, start, square.end(), safe=self._takes_strings()),)
            span = Span(start, square.end())
            self.problems.append(Diagnostic("syntax-error", span, "this value needs quotes", fixes=fixes))
            return self._add(NAME, start, square.end())
        in_value = self._brackets and (character == "[" or character not in INSTEAD)
        if in_value and _WHOLE_WORD.match(text, start) and self._in_value(start):
            return self._quote_value(start)
        if character in "{}[]" and (end := self._block_sign(start, character)) > start:
            return end
        if character == "{" or character == "}":
            return self._half_braced(start, character)
        if self.kinds and self.kinds[-1] == STRING and _has_line_end(text, self.starts[-1], start):
            return self._add(ERROR, start, start + 1)  # the parser sees that a quote was lost
        end = start + 1
        while end < self.size and text[end] == character:
            end += 1
        if not self._strange:
            self._strange = True
            self.problems.append(no_token(text, start, end, of_signal=self.raws[:1] == ["signal"]))
        return end

    def _separates(self, start: int) -> bool:
        """Whether a sign here is between two attributes, as `,` may be."""
        if not self._brackets or self._strange or self.raws[-1] in ("=", ",", "("):
            return False
        return _KEY.match(self.text, start + 1) is not None

    def _shell_entry(self, start: int, end: int) -> int:
        """A blackboard entry as shells write a variable: `$key` or `${key}`."""
        written = f"{{{self.text[start:end].strip('${}')}}}"
        fix = replace_fix(f"Write `{written}`", Span(start, end), written)
        self._strange = True
        message = f"a blackboard entry is written `{written}`"
        self.problems.append(Diagnostic("syntax-error", Span(start, end), message, fixes=(fix,)))
        return self._add(NAME, start, end)

    def _block_sign(self, start: int, character: str) -> int:
        """The brace or bracket of somebody's block, at the end of a line or alone on it; both are one mistake.

        Returns:
            Where it ends, or `start` where it is none.
        """
        behind = blanks_end(self.text, start + 1, self.size)
        ends_line = behind == self.size or self.text[behind] in "\r\n"
        is_opening = character in "{["
        if self._brackets or not ends_line or self._strange or is_opening != bool(self.raws):
            return start
        if start in self._block_ends:
            self._block_ends.remove(start)
            return start + 1
        before = start
        while self.raws and self.text[before - 1] in " \t":
            before -= 1
        changes: tuple[Change, ...] = (Change(Place(Span(before, start + 1)), ""),)
        closing = self._block_end(start, "}" if character == "{" else "]") if is_opening else start
        if is_opening and closing > start:
            self._block_ends.add(closing)
            end = line_end(self.text, closing)
            end += 2 if self.text.startswith("\r\n", end) else end < self.size
            changes += (Change(Place(Span(line_start(self.text, start, closing), end)), ""),)
        fix = Fix(f"Remove `{character}`", changes)
        self._strange = True
        message = f"unexpected `{character}`: a block consists of indented lines"
        self.problems.append(Diagnostic("syntax-error", Span(start, start + 1), message, fixes=(fix,)))
        return start + 1

    def _block_end(self, start: int, sign: str) -> int:
        """Where the sign that closes a block is alone on the first line that is no deeper than the one at hand; else
        -1."""
        text = self.text
        at = line_end(text, start)
        while at < self.size:
            first, at = line_opening(text, self.ink, at)
            if at - first <= len(self.blanks):
                behind = blanks_end(text, at + 1, self.size)
                is_alone = behind >= self.size or text[behind] in "\r\n"
                return at if text[at : at + 1] == sign and is_alone else -1
            at = line_end(text, at)
        return -1

    def _half_braced(self, start: int, character: str) -> int:
        """A brace without the other one: `{key` or `key}`; the key is left as a word."""
        if character == "{" and (twice := _TWICE_BRACED.match(self.text, start)):
            fix = replace_fix(f"Write `{twice[1]}`", Span(start, twice.end()), twice[1], safe=True)
            message = "a blackboard entry has one pair of braces"
            self.problems.append(Diagnostic("syntax-error", Span(start, twice.end()), message, fixes=(fix,)))
            self._strange = True
            return self._add(NAME, start, twice.end())
        word = _WHOLE_WORD.match(self.text, start + 1) if character == "{" else None
        end = self._add(NAME, start, word.end()) if word else start + 1
        if self._strange:
            return end
        self._strange = True
        if character == "{" and not self._brackets and (mended := attributes_in_braces(self.text, start)) is not None:
            self.problems.append(Diagnostic("syntax-error", Span(start, start + 1), ATTRIBUTES, fixes=(mended,)))
            return end
        other = "}" if character == "{" else "{"
        at = end
        if character == "}":
            at = self.starts[-1] if self.raws and self.starts[-1] + len(self.raws[-1]) == start else start
        fix = replace_fix(f"Add `{other}`", Span(at, at), other)
        message = f"missing `{other}` for this `{character}`"
        notes = ("a blackboard entry is written `{key}`, on one line and without quotes in it",)
        span = Span(start, start + 1)
        self.problems.append(Diagnostic("syntax-error", span, message, notes=notes, fixes=(fix,)))
        return end

    def _after_operand(self, position: int) -> bool:
        """Whether a `-` here subtracts: it does behind an operand on the same line (docs/language.md, NUMBER)."""
        if not self.kinds or self.kinds[-1] not in (NAME, NUMBER, QUANTITY, STRING, CLOSE):
            return False
        return not _has_line_end(self.text, self.starts[-1] + len(self.raws[-1]), position)

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
        """A string runs to its closing quote, however many lines; -1 where there is none, or none begins."""
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
        """A quote that closes the path of an include, or one that is not closed."""
        return self._add(ERROR, start, start + 1) if self._closes_path(start) else self._unclosed_string(start, quote)

    def _closes_path(self, start: int) -> bool:
        """Whether a quote at the end of its line closes what stands behind `include` without an opening one: no string
        begins there, and the parser says what is missing."""
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
            if item := _TOP_LINE.match(self.text, line.end()):
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

    def _quote_this(self, at: int) -> int:
        """A comment sign, or a word before one, where no comment may begin: the word around it needs quotes; behind
        what is no word a blank is missing."""
        text = self.text
        start, end = self._whole_word(at)
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
        fixes = (fix,) if in_value or sign[0] == "/*" else (fix, insert)
        if sign.end() == end:  # the comment was not even begun right behind the word
            fixes = fixes[::-1]
        self.problems.append(
            Diagnostic("misplaced-comment", Span(start, end), f"{message}; put this in quotes", fixes=fixes)
        )
        return self._add(NAME, start, end)

    def _quote_value(self, at: int) -> int:
        """A character that begins nothing, inside a value: `a = 1;2`."""
        start, end = self._whole_word(at)
        self._strange = True  # more of it may follow
        fixes: tuple[Fix, ...] = ()
        if _VALUE_END.match(self.text, end):
            fixes = (value_meant(self.text, start, end, safe=self._takes_strings()),)
        self.problems.append(Diagnostic("syntax-error", Span(start, end), "this value needs quotes", fixes=fixes))
        return self._add(NAME, start, end)

    def _takes_strings(self) -> bool:
        """Whether a value may surely be a string: those of a requirement's parameters may not."""
        return not _WITH_PARAMETERS.intersection(self.raws)

    def _in_value(self, at: int) -> bool:
        """Whether what begins at `at` stands behind `key =`, or without a blank behind a word that does."""
        last = len(self.raws) - 1
        while last > 0 and self._joins(last, at):
            at = self.starts[last]
            last -= 1
        return last >= 0 and self.raws[last] == "="

    def _whole_word(self, at: int) -> tuple[int, int]:
        """Where the word around `at` begins and ends; the tokens already made of it are taken back."""
        word = _WHOLE_WORD.match(self.text, at)
        assert word is not None, "a word or a sign begins here"
        while self.raws and self._joins(len(self.raws) - 1, at):
            at = self.starts.pop()
            self.kinds.pop()
            self.raws.pop()
        return at, word.end()

    def _joins(self, index: int, at: int) -> bool:
        """Whether a token makes one word with what begins at `at`: there is no blank between, and it is no `=`."""
        kind, raw = self.kinds[index], self.raws[index]
        if kind not in (NAME, NUMBER, QUANTITY, OPERATOR) or raw == "=" or raw == ",":
            return False
        return self.starts[index] + len(raw) == at

    def _comment(self, start: int) -> int:
        """The end of the comment that begins here, or `start` where none may begin."""
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

    def _close_nothing(self, position: i64) -> i64:
        """A `)` where no bracket is open."""
        if self.ended_early:  # it is the one that was missed
            self.ended_early -= 1
        elif position > self._stray_until:
            self._report("syntax-error", position, position + 1, "unexpected `)`: no bracket is open")
            self._stray_until = line_end(self.text, position)
        return position + 1

    def _close_square(self, position: int) -> int:
        span = Span(position, position + 1)
        fix = replace_fix("Write `)`", span, ")", safe=True)
        self.problems.append(Diagnostic("syntax-error", span, "expected `)`, found `]`", fixes=(fix,)))
        self._brackets.pop()
        return self._add(CLOSE, position, position + 1)

    def _continue(self, position: i64) -> i64:
        """Behind a line end in brackets: the next line, or `position` where the line ends the brackets early."""
        text = self.text
        start, at = line_opening(text, self.ink, position)
        blanks = self._line_blanks = text[start:at]
        if at >= self.size:
            return at
        code: i64 = ord(text[at])
        if code in (CLOSING, HASH) or (code == SLASH and text.startswith(_COMMENT_SIGNS, at)):
            return at
        if self._at_top_column(blanks) and _TOP_LINE.match(text, at):
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

    def _at_top_column(self, blanks: str) -> bool:
        """Whether an item may begin there; behind `Root (` without `)` that is any column of its block to be."""
        level = self._root_level
        if blanks == "" or (0 < level < len(self.columns) and blanks == self.columns[level]):
            return True
        return self._is_root_line() and _extends(blanks, self.columns[-1], ())

    def _close_lost(self, start: int, end: int) -> None:
        """Close the brackets whose `)` is lost in a string or comment that runs to the end of its line."""
        lost = self.text.count(")", start, end) - self.text.count("(", start, end)
        for _ in range(min(lost, len(self._brackets))):
            self._brackets.pop()
            self._add(CLOSE, end, end)

    def _end_brackets(self, count: int, position: int, because: int | None) -> None:
        """Close `count` brackets where no `)` is, so that the parser sees them closed; report the outermost."""
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
        """Where a `)` was probably forgotten: at the end of a line behind which no attribute begins."""
        end = opened
        for index in range(bisect_left(self.starts, opened), len(self.starts)):
            start, raw = self.starts[index], self.raws[index]
            begins = index + 1 < len(self.raws) and _has_line_end(self.text, end, start)
            if begins and raw not in _IN_BRACKETS and self.raws[index + 1] != "=" and self.raws[index - 1] not in "=,(":
                break
            end = start + len(raw)
        return end

    # ---- reports ----

    def _report(self, rule: str, start: int, end: int, message: str, notes: tuple[str, ...] = ()) -> None:
        self.problems.append(Diagnostic(rule, Span(start, end), message, notes=notes))

    def _report_indentation(self, blanks: str, expected: str) -> None:
        if expected.startswith(blanks) or blanks.startswith(expected):
            message = f"an indentation of {_shown(blanks)} matches no open block"
        else:
            message = f"tabs and spaces are mixed: {_shown(blanks)} cannot be compared with {_shown(expected)}"
        note = f"btq reads the line as if indented by {_shown(expected)}"
        span = Span(self.line_start, self.line_start + len(blanks))
        fix = replace_fix(f"Indent it by {_shown(expected)}", span, expected)
        self.problems.append(Diagnostic("inconsistent-indentation", span, message, notes=(note,), fixes=(fix,)))


# ---- all tokens ----


def _start_of(piece: tuple[int, int, str]) -> int:
    return piece[1]


def _fill(found: list[Token], text: str, end: int, start: int, comments: list[tuple[int, int]], told: int) -> int:
    """Add what the lexer passed over between two tokens: blanks, comments and characters that begin nothing.

    Args:
        told: how many of the comments were added before.

    Returns:
        How many are now.  (A function inside of `tokens` would hold all of these, compiled, until Python looks for
        garbage.)
    """
    while told < len(comments) and comments[told][0] < start:
        comment, behind = comments[told]
        found += _gaps(text, end, comment)
        found.append(Token(COMMENT, comment, text[comment:behind]))
        end = behind
        told += 1
    found += _gaps(text, end, start)
    return told


def _gaps(text: str, start: int, end: int) -> list[Token]:
    return [Token(BLANK if piece[1] else ERROR, piece.start(), piece[0]) for piece in _GAP.finditer(text, start, end)]


# ---- blanks ----


def _has_line_end(text: str, start: int, end: int) -> bool:
    return text.find("\n", start, end) >= 0 or text.find("\r", start, end) >= 0


def _extends(blanks: str, outer: str, aliases: tuple[str, ...]) -> bool:
    if len(blanks) > len(outer) and blanks.startswith(outer):
        return True
    return any(len(blanks) > len(column) and blanks.startswith(column) for column in aliases)


def _shown(blanks: str) -> str:
    if not blanks:
        return "nothing"
    tabs = blanks.count("\t")
    parts = [
        f"{count} {word}{'s' * (count > 1)}" for count, word in ((tabs, "tab"), (len(blanks) - tabs, "space")) if count
    ]
    return " and ".join(parts)


# ---- patterns ----

# The words that begin an item, and what must follow for a line to end a forgotten bracket (docs/language.md, Brackets).
_TOP_LINE: Final = re.compile(
    r"""(?x)
        BehaviorTree [ \t]+ ID [ \t]* = (?!=)
        | (?:BehaviorTree|Root|TreeNodesModel) (?: [ \t]+ (?= \# | //? ) | [ \t]* (?= [\r\n(] | \Z ) )
        | (?:BehaviorTree|Root|TreeNodesModel|include|signal|context|apply|quality|qualities|QualityReq)
          (?: [ \t]+ (?= (?P<name> [^\W\d] (?:\w|-(?=\w))* [?!]? ) ) (?P=name)
            | [ \t]* (?: "(?:[^"\\\r\n]|\\[^\r\n])*" | '(?:[^'\\\r\n]|\\[^\r\n])*' ) )
          (?! [ \t]* = )
    """
)
_GAP: Final = re.compile(r"([ \t\r\n\ufeff]+)|[^ \t\r\n\ufeff]+")
_COMMENT_SIGN: Final = re.compile(r"#|//|/\*")
_WHOLE_WORD: Final = re.compile(r"[^\s(),\"'{}]+")
_TWICE_BRACED: Final = re.compile(r"\{(\{[^{}\r\n]*\})\}")
_SHELL_ENTRY: Final = re.compile(r"\$(?:\{[^\W\d]\w*\}|[^\W\d]\w*)(?=[ \t),\r\n]|\Z)")
_KEY: Final = re.compile(r"[ \t]*[^\W\d](?:\w|-(?=\w))*[ \t]*=(?!=)")
_SQUARE: Final = re.compile(r"\[[^\[\](){}\"'\r\n]*\](?=[ \t]*(?:[),\r\n]|\Z))")
_VALUE_END: Final = re.compile(r"[ \t]*(?:[),\r\n#/]|\Z|[^\W\d](?:\w|-(?=\w))*[ \t]*=(?!=)|satisf|tags\b)")

# ---- tables ----

_SILENT: Final = (OPEN, CLOSE, NEWLINE)
_TWO: Final = frozenset(("==", "!=", "<=", ">=", "::"))
_COMMENT_SIGNS: Final = ("#", "//", "/*")
_MANY: Final = 20  # wrong units on one line: who has so many needs no more to see what is wrong
_WITH_PARAMETERS: Final = frozenset(("satisfies", "QualityReq", "apply"))
_IN_BRACKETS: Final = frozenset(("satisfices", "satisfies", "tags", "parameters", "description", ",", "(", ")", "="))
_QUOTES: Final = ('"', "'", "{", "}")  # behind a word they mean that more went wrong than a missing quote
_ALIASES: Final = 16  # columns taken for one block; more of them would only cost time
