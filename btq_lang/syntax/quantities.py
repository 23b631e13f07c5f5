"""Quantities in a file: a number and its unit."""

from __future__ import annotations

import re

from btq_lang.catalog.units import Unit, parse_unit

_QUANTITY = re.compile(r"(-?[0-9]+(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?)[ \t]*(\S+)")


def parse_quantity(text: str) -> tuple[float, Unit, str] | None:
    """The number, the unit and the unit's text of a quantity such as `30 s`; None if it is not one."""
    number, _, word = text.partition(" ")
    if not _is_usual(number, word):
        match = _QUANTITY.fullmatch(text)
        if match is None:
            return None
        number, word = match[1], match[2]
    unit = parse_unit(word)
    return (float(number), unit, word) if unit else None


def _is_usual(number: str, word: str) -> bool:
    """Whether it is digits, perhaps with a point, a blank and a word, as nearly all are: compiling the pattern takes as
    long as parsing four nodes.
    """
    digits = number.removeprefix("-").split(".", 1)
    return number.isascii() and all(part.isdecimal() for part in digits) and word.split() == [word]
