"""Invalid characters: reports what they are probably meant to be, and usually skips them.

One invariant: lexing continues after each of them.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from btq_lang.diagnostics.model import Diagnostic, Fix, FixEdit, Place, replace_fix, write_fix
from btq_lang.syntax.indentation import Indentation
from btq_lang.syntax.scan import Maps, blanks_end, line_end, line_opening, line_start
from btq_lang.syntax.suggestions import ATTRIBUTES, INSTEAD, attributes_in_braces, no_token, value_meant
from btq_lang.syntax.tokens import CLOSE, ERROR, NAME, NUMBER, OPERATOR, QUANTITY, STRING
from btq_lang.util.text import Span

if TYPE_CHECKING:
    from mypy_extensions import i64


class StrangeCharacters(Indentation):
    """The tokens of a logical line so far, with the handling of invalid characters.

    Attributes:
        maps: of the text.
        kinds, starts, raws: the tokens; after the line is scanned, the last is always a NEWLINE.
    """

    def __init__(self, text: str, maps: Maps) -> None:
        super().__init__(text)
        self.maps: Final = maps
        self.kinds: list[int] = []
        self.starts: list[int] = []
        self.raws: list[str] = []
        self._brackets: list[tuple[int, str]] = []  # where each was opened, and that line's blanks
        self._block_ends: set[int] = set()  # closing braces of blocks whose opening ones were reported
        self._strange = False  # an invalid character was reported on this line

    def _invalid_character(self, start: i64, character: str) -> i64:
        """Handle an invalid character: report once a line, and usually skip it."""
        text = self.text
        if character == "]" and self._brackets and text.find("[", self._brackets[-1][0], start) < 0:
            return self._close_square(start)
        if character in "$@" and (entry := _SHELL_ENTRY.match(text, start)) and self.raws[-1:] == ["="]:
            return self._shell_entry(start, entry.end())
        if character == ";" and self._separates(start):
            fix = write_fix(",", Span(start, start + 1), safe=True)
            self._mistake(Span(start, start + 1), "expected `,` between attributes, found `;`", fix)
            return start + 1
        if character == "[" and self.raws[-1:] == ["="] and (square := _SQUARE.match(text, start)):
            fix = value_meant(text, start, square.end(), safe=False)
            self._mistake(Span(start, square.end()), "this value needs quotes", fix)
            return self._add(NAME, start, square.end())
        in_value = self._brackets and (character == "[" or character not in INSTEAD)
        if in_value and _WHOLE_WORD.match(text, start) and self._in_value(start):
            return self._quote_value(start)
        if character in "{}[]" and (end := self._block_sign(start, character)) > start:
            return end
        if character == "{" or character == "}":
            return self._half_braced(start, character)
        if self.kinds and self.kinds[-1] == STRING and has_line_end(text, self.starts[-1], start):
            return self._add(ERROR, start, start + 1)  # shows the parser that a quote is missing
        end = start + 1
        while end < self.size and text[end] == character:
            end += 1
        if not self._strange:
            self._strange = True
            self.problems.append(no_token(text, start, end, of_signal=self.raws[:1] == ["signal"]))
        return end

    def _separates(self, start: int) -> bool:
        """Whether a sign here separates two attributes, as `,` may."""
        if not self._brackets or self._strange or self.raws[-1] in ("=", ",", "("):
            return False
        return _KEY.match(self.text, start + 1) is not None

    def _shell_entry(self, start: int, end: int) -> int:
        """Handle a blackboard entry in the syntax of shell variables, `$key` or `${key}`, and `@{key}`."""
        word = self.text[start:end]
        written = f"{{{word.strip('${}').replace('{', '')}}}"
        fix = write_fix(written, Span(start, end))
        self._mistake(Span(start, end), f"a blackboard entry is written `{written}`", fix)
        return self._add(NAME, start, end)

    def _block_sign(self, start: int, character: str) -> int:
        """Handle the brace or bracket of a block, at the end of a line or alone on it; the pair is one mistake.

        Returns:
            Where it ends, or `start` if it is not one.
        """
        after = blanks_end(self.text, start + 1, self.size)
        ends_line = after == self.size or self.text[after] in "\r\n"
        is_opening = character in "{["
        if self._brackets or not ends_line or self._strange or is_opening != bool(self.raws):
            return start
        if start in self._block_ends:
            self._block_ends.remove(start)
            return start + 1
        before = start
        while self.raws and self.text[before - 1] in " \t":
            before -= 1
        changes: tuple[FixEdit, ...] = (FixEdit(Place(Span(before, start + 1)), ""),)
        closing = self._block_end(start, "}" if character == "{" else "]") if is_opening else start
        if is_opening and closing > start:
            self._block_ends.add(closing)
            end = line_end(self.text, closing)
            end += 2 if self.text.startswith("\r\n", end) else end < self.size
            changes += (FixEdit(Place(Span(line_start(self.text, start, closing), end)), ""),)
        message = f"unexpected `{character}`: a block consists of indented lines"
        self._mistake(Span(start, start + 1), message, Fix(f"Remove `{character}`", changes))
        return start + 1

    def _block_end(self, start: int, sign: str) -> int:
        """The place of the sign that closes a block, if it is alone on the first line not deeper than the current one;
        else -1.
        """
        text = self.text
        position = line_end(text, start)
        while position < self.size:
            first, position = line_opening(text, self.maps.ink, position)
            if position - first <= len(self.blanks):
                after = blanks_end(text, position + 1, self.size)
                is_alone = after >= self.size or text[after] in "\r\n"
                return position if text[position : position + 1] == sign and is_alone else -1
            position = line_end(text, position)
        return -1

    def _half_braced(self, start: int, character: str) -> int:
        """Handle an unpaired brace: `{key` or `key}`; the key remains as a word."""
        if character == "{" and (twice := _TWICE_BRACED.match(self.text, start)):
            fix = write_fix(twice[1], Span(start, twice.end()), safe=True)
            self._mistake(Span(start, twice.end()), "a blackboard entry has one pair of braces", fix)
            return self._add(NAME, start, twice.end())
        word = _WHOLE_WORD.match(self.text, start + 1) if character == "{" else None
        end = self._add(NAME, start, word.end()) if word else start + 1
        if self._strange:
            return end
        if character == "{" and not self._brackets and (mended := attributes_in_braces(self.text, start)) is not None:
            self._mistake(Span(start, start + 1), ATTRIBUTES, mended)
            return end
        other = "}" if character == "{" else "{"
        place = end
        if character == "}":
            place = self.starts[-1] if self.raws and self.starts[-1] + len(self.raws[-1]) == start else start
        fix = replace_fix(f"Add `{other}`", Span(place, place), other)
        note = "a blackboard entry is written `{key}`, on one line and without quotes in it"
        self._mistake(Span(start, start + 1), f"missing `{other}` for this `{character}`", fix, notes=(note,))
        return end

    def _close_square(self, position: int) -> int:
        span = Span(position, position + 1)
        fix = write_fix(")", span, safe=True)
        self.problems.append(Diagnostic("syntax-error", span, "expected `)`, found `]`", fixes=(fix,)))
        self._brackets.pop()
        return self._add(CLOSE, position, position + 1)

    def _quote_value(self, offset: int) -> int:
        """Report an invalid character inside a value: `a = 1;2`."""
        start, end = self._whole_word(offset)
        fixes: tuple[Fix, ...] = ()
        if _VALUE_END.match(self.text, end):
            fixes = (value_meant(self.text, start, end, safe=self._takes_strings()),)
        self._mistake(Span(start, end), "this value needs quotes", *fixes)
        return self._add(NAME, start, end)

    def _mistake(self, span: Span, message: str, *fixes: Fix, notes: tuple[str, ...] = ()) -> None:
        """Report a mistake; what is wrong on the rest of the line may be a part of it."""
        self._strange = True
        self.problems.append(Diagnostic("syntax-error", span, message, notes=notes, fixes=fixes))

    def _takes_strings(self) -> bool:
        """Whether values may be strings here: those of a requirement's parameters may not."""
        return not _WITH_PARAMETERS.intersection(self.raws)

    def _in_value(self, offset: int) -> bool:
        """Whether `offset` directly follows `key =`, or a word that follows it."""
        last = len(self.raws) - 1
        while last > 0 and self._joins(last, offset):
            offset = self.starts[last]
            last -= 1
        return last >= 0 and self.raws[last] == "="

    def _whole_word(self, offset: int) -> tuple[int, int]:
        """The range of the word around `offset`; removes the tokens already made of it."""
        word = _WHOLE_WORD.match(self.text, offset)
        assert word is not None, "a word or a sign begins here"
        while self.raws and self._joins(len(self.raws) - 1, offset):
            offset = self.starts.pop()
            self.kinds.pop()
            self.raws.pop()
        return offset, word.end()

    def _joins(self, index: int, offset: int) -> bool:
        """Whether a token forms one word with what begins at `offset`: without a blank between them, and not `=`."""
        kind, raw = self.kinds[index], self.raws[index]
        if kind not in (NAME, NUMBER, QUANTITY, OPERATOR) or raw == "=" or raw == ",":
            return False
        return self.starts[index] + len(raw) == offset

    def _add(self, kind: int, start: i64, end: i64) -> i64:
        self.kinds.append(kind)
        self.starts.append(start)
        self.raws.append(self.text[start:end])
        return end


def has_line_end(text: str, start: int, end: int) -> bool:
    """Whether a piece of a text contains a line end."""
    return text.find("\n", start, end) >= 0 or text.find("\r", start, end) >= 0


_WHOLE_WORD: Final = re.compile(r"[^\s(),\"'{}]+")
_TWICE_BRACED: Final = re.compile(r"\{(\{[^{}\r\n]*\})\}")
_SHELL_ENTRY: Final = re.compile(r"(?:\$[^\W\d]\w*|[$@]\{[^\W\d]\w*\})(?=[ \t),\r\n]|\Z)")
_KEY: Final = re.compile(r"[ \t]*[^\W\d](?:\w|-(?=\w))*[ \t]*=(?!=)")
_SQUARE: Final = re.compile(r"\[[^\[\](){}\"'\r\n]*\](?=[ \t]*(?:[),\r\n]|\Z))")
_VALUE_END: Final = re.compile(r"[ \t]*(?:[),\r\n#/]|\Z|[^\W\d](?:\w|-(?=\w))*[ \t]*=(?!=)|satisf|tags\b)")
_WITH_PARAMETERS: Final = frozenset(("satisfies", "QualityReq", "apply"))
