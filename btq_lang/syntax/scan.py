"""Scanning: the end of the word, string, number or unit that begins at an offset.

One invariant: a function depends only on the text from its start on, so all callers agree on words.  Lines, brackets
and grammar are unknown here, and nothing is reported.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from btq_lang.catalog.units import SYMBOLS as UNITS
from btq_lang.catalog.units import parse_unit
from btq_lang.syntax.tokens import ERROR, NUMBER, QUANTITY, SYMBOLS

if TYPE_CHECKING:
    from mypy_extensions import i64

# Characters as numbers: comparing `ord(text[at])` with these is free in the compiled parser; comparing strings is a
# call.
TAB: Final = 0x09
LINE_FEED: Final = 0x0A
RETURN: Final = 0x0D
SPACE: Final = 0x20
BANG: Final = 0x21  # !
QUOTE: Final = 0x22  # "
HASH: Final = 0x23
APOSTROPHE: Final = 0x27
OPENING: Final = 0x28  # (
CLOSING: Final = 0x29  # )
COMMA: Final = 0x2C
MINUS: Final = 0x2D
DOT: Final = 0x2E
SLASH: Final = 0x2F
ZERO: Final = 0x30
NINE: Final = 0x39
EQUALS: Final = 0x3D
QUESTION: Final = 0x3F
CAPITAL_A: Final = 0x41
CAPITAL_Z: Final = 0x5A
UNDERSCORE: Final = 0x5F
SMALL_A: Final = 0x61
SMALL_Z: Final = 0x7A
LEFT_BRACE: Final = 0x7B
RIGHT_BRACE: Final = 0x7D
ASCII: Final = 0x80  # the first character that is not ASCII


class Maps:
    """The ends of words and blanks in a text, found in one step.

    Attributes:
        words: the text with a NUL for each character but ASCII letters, digits and `_`.
        ink: with a NUL for each blank and tab, and `x` for all else.
    """

    __slots__ = ("ink", "words")

    def __init__(self, words: str, ink: str) -> None:
        self.words: Final = words
        self.ink: Final = ink

    def edited(self, start: int, end: int, text: str) -> Maps:
        """The maps after an edit that replaces the text from `start` to `end`."""
        new = maps_of(text)
        return Maps(self.words[:start] + new.words + self.words[end:], self.ink[:start] + new.ink + self.ink[end:])


def maps_of(text: str) -> Maps:
    """The maps of a text, in 2 ms for a million characters."""
    characters = text.encode("ascii", "replace")
    return Maps(characters.translate(_WORDS).decode("ascii"), characters.translate(_INK).decode("ascii"))


def name_end(text: str, words: str, start: i64) -> i64:
    """The end of the NAME that begins at `start`, which is a letter or `_`."""
    size: i64 = len(text)
    end: i64 = words.find("\0", start + 1)
    while end >= 0:
        code: i64 = ord(text[end])
        if code == SPACE:
            return end
        if (code >= ASCII and chr(code).isalnum()) or (
            code == MINUS and end + 1 < size and goes_on(ord(text[end + 1]))
        ):
            end = words.find("\0", end + 1)
        elif code in (QUESTION, BANG) and (end + 1 == size or ord(text[end + 1]) != EQUALS):
            return end + 1
        else:
            return end
    return size


def is_name(text: str) -> bool:
    """Whether a text can be written as a NAME, without quotes."""
    if text == "" or not begins_name(ord(text[0])) or text in ("R?", "A?"):
        return False
    return name_end(text, maps_of(text).words, 0) == len(text)


def begins_name(code: i64) -> bool:
    """Whether it is a letter or `_`."""
    if code < ASCII:
        return 0x61 <= code <= 0x7A or 0x41 <= code <= 0x5A or code == UNDERSCORE
    return chr(code).isalpha()


def goes_on(code: i64) -> bool:
    """Whether it is a letter, a digit or `_`, as in `\\w`."""
    if code < ASCII:
        return 0x61 <= code <= 0x7A or 0x30 <= code <= 0x39 or 0x41 <= code <= 0x5A or code == UNDERSCORE
    return chr(code).isalnum()


def blanks_end(text: str, start: i64, size: i64) -> i64:
    """The end of blanks and tabs."""
    while start < size:
        code: i64 = ord(text[start])
        if code != SPACE and code != TAB:
            break
        start += 1
    return start


def line_opening(text: str, ink: str, start: i64) -> tuple[i64, i64]:
    """Skip blank lines; returns where the line of the next word or comment begins (`start`, if it is the same line),
    and where its blanks end."""
    position: i64 = ink.find("x", start)
    while position >= 0:
        code: i64 = ord(text[position])
        if code > RETURN or code not in (LINE_FEED, RETURN):
            return start, position
        start = position + 1
        position = ink.find("x", start)
    return start, len(text)


def line_end(text: str, start: i64) -> i64:
    """The end of the physical line."""
    size: i64 = len(text)
    near: i64 = text.find("\n", start, start + _USUAL_LINE)  # bounded: the next one may be far away
    if near >= 0 and text.find("\r", start, near) < 0:
        return near
    while start < size:
        code: i64 = ord(text[start])
        if code in (LINE_FEED, RETURN):
            break
        start += 1
    return start


def line_start(text: str, lower: i64, position: i64) -> i64:
    """The start of the physical line, at least `lower`."""
    return max(text.rfind("\n", lower, position) + 1, text.rfind("\r", lower, position) + 1, lower)


def path_end(text: str, start: i64) -> i64:
    """The end of what is probably meant as a path: up to a blank, a bracket or a quote."""
    return _PATH.match(text, start).end()  # type: ignore[union-attr]  # it matches at least the empty string


def symbol_end(text: str, start: i64) -> i64:
    """The end of the longest symbol that begins at `start`; `start` if none does."""
    for symbol in _BY_FIRST.get(text[start], ()):
        if text.startswith(symbol, start):
            return start + len(symbol)
    return start


def string_end(text: str, start: i64, quote: str) -> i64:
    """The end of the string whose text begins at `start`, after its closing quote; -1 if it has none."""
    end = text.find(quote, start)
    while end >= 0:
        backslash = text.find("\\", start, end)
        if backslash < 0:
            return end + 1
        start = backslash + 2
        if start > end:
            end = text.find(quote, start)
    return -1


def braced_end(text: str, start: i64) -> i64:
    """The end of the BRACED that begins at `start`; `start` if none does."""
    size: i64 = len(text)
    if start == size or ord(text[start]) != LEFT_BRACE:
        return start
    end = start + 1
    while end < size:
        code: i64 = ord(text[end])
        end += 1
        if code == RIGHT_BRACE:
            return end
        if code in (LEFT_BRACE, QUOTE, APOSTROPHE, RETURN, LINE_FEED):
            break
    return start


def number_at(text: str, start: i64) -> tuple[i64, i64]:
    """The kind and end of the number or quantity that begins at `start` with a digit, or a `-` and a digit.

    Returns:
        NUMBER or QUANTITY and the end, or ERROR and the end of the number if a word other than a unit directly follows
        it, or units that do not combine to one.
    """
    size: i64 = len(text)
    end = number_end(text, start)
    unit = end
    while unit < size and ((code := ord(text[unit])) == SPACE or code == TAB):
        unit += 1
    if unit < size and ((character := text[unit]).isalpha() or character in "_%1°"):
        unit_end = unit_at(text, unit)
        if unit_end > unit:
            after = blanks_end(text, unit_end, size)
            if not text.startswith("(", after) and (not text.startswith("=", after) or text.startswith("==", after)):
                return (QUANTITY, unit_end) if is_unit(text[unit:unit_end]) else (ERROR, end)
        elif character == "°" or (unit == end and (character.isalpha() or character == "_")):
            return ERROR, end
    return NUMBER, end


def number_end(text: str, start: i64) -> i64:
    """The end of the number, without unit, that begins at `start` with a digit, or a `-` and a digit."""
    size: i64 = len(text)
    end = _digits_end(text, start + 1)
    if end < size and ord(text[end]) == DOT:
        further = _digits_end(text, end + 1)
        end = further if further > end + 1 else end
    if end < size and text[end] in "eE":
        power = end + 2 if text.startswith(("+", "-"), end + 1) else end + 1
        further = _digits_end(text, power)
        end = further if further > power else end
    return end


def _digits_end(text: str, start: i64) -> i64:
    size: i64 = len(text)
    while start < size and ZERO <= ord(text[start]) <= NINE:
        start += 1
    return start


def unit_at(text: str, start: i64) -> i64:
    """The end of the UNIT that begins at `start`; `start` if none does."""
    word, end = _factor(text, start)
    if word == "1":
        if not text.startswith("/", end):
            return start
    elif word not in UNITS:
        return start
    while end < len(text) and text[end] in "*/":
        word, further = _factor(text, end + 1)
        if word not in UNITS:
            break
        end = further
    return start if text[start:end] == "1" else end


def _factor(text: str, start: i64) -> tuple[str, i64]:
    """The word of a unit's factor, empty if there is none, and the end of the factor, after its exponent.

    It is a whole word: `6 m-base` and `6 m!` have none.
    """
    size: i64 = len(text)
    end = start
    while end < size and text[end].isalnum() and not text[end].isdecimal():
        end += 1
    if end == start:
        if end == size or text[end] not in "%1":
            return "", start
        end += 1
    elif end < size and (
        (text[end] == "-" and _is_of_word(text, end + 1)) or (text[end] in "?!" and not text.startswith("=", end + 1))
    ):
        return "", start
    word = text[start:end]
    if text.startswith("^", end):
        power = end + 2 if text.startswith("-", end + 1) else end + 1
        end = power
        while end < size and text[end].isdecimal():
            end += 1
        if end == power:
            return "", start
    return ("", start) if _is_of_word(text, end) or text.startswith("^", end) else (word, end)


def _is_of_word(text: str, offset: i64) -> bool:
    return offset < len(text) and (text[offset].isalnum() or text[offset] == "_")


def is_unit(word: str) -> bool:
    """Whether a whole word is a unit: `degC` and `s` are, `degC/s` is not."""
    return word in UNITS or parse_unit(word) is not None


def unit_run(text: str, start: i64) -> i64:
    """The end of what is probably meant as a unit, valid or not."""
    end = start
    while end < len(text):
        if text[end] in "*/":
            if not text[end + 1 : end + 2].isalnum() and not text.startswith(("%", "°"), end + 1):
                break
        elif text[end] == "-":
            if end == 0 or text[end - 1] != "^":
                break
        elif not text[end].isalnum() and text[end] not in "_%°·^":
            break
        end += 1
    return end


_WORDS: Final = bytes(code if code < ASCII and goes_on(code) else 0 for code in range(256))
_INK: Final = bytes(0 if code in (SPACE, TAB) else ord("x") for code in range(256))
_USUAL_LINE: Final = 200  # characters; comments are seldom longer
_PATH: Final = re.compile(r"[^\s()\"']*")
_BY_FIRST: Final = {
    first: tuple(sorted((symbol for symbol in SYMBOLS if symbol[0] == first), key=len, reverse=True))
    for first in {symbol[0] for symbol in SYMBOLS}
}
