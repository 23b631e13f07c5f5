"""How words of a `.btq` file are spelt in XML: attribute values, texts, comments, names.

One invariant: a line end and a tab in the source stay as they are, and the escapes `\\n` and `\\t` become `&#10;` and
`&#9;`: readers that follow the XML standard distinguish them, the engine does not.
"""

from __future__ import annotations

import re
from typing import Final

from btq_lang.btcpp.document import escape, escape_text
from btq_lang.catalog.units import convert, parse_unit
from btq_lang.syntax.quantities import parse_quantity
from btq_lang.syntax.tokens import QUANTITY, STRING
from btq_lang.syntax.tree import Word, unquote


def spelt(word: Word) -> str:
    """A word as it is spelt between the quotes of an attribute."""
    raw = word.raw
    if word.kind != STRING:
        return escape_text(raw).replace('"', "&quot;") if _SPECIAL(raw) else raw  # a tab in `{a	b}` stays
    inside = raw[1:-1]
    if _SPECIAL(inside) is None and len(raw) > 1 and raw[-1] == raw[0]:
        return inside
    if len(raw) == 1 or raw[-1] != raw[0] or (len(inside) - len(inside.rstrip("\\"))) % 2:
        return escape(word.text)  # it has no closing quote
    return _IN_STRING.sub(lambda match: _SPELT[match[0]], inside)


def in_unit(word: Word, unit: str | None) -> str | None:
    """A quantity as the number that a port in `unit` takes; None if its unit is another or unknown."""
    if word.kind != QUANTITY or unit is None:
        return None
    quantity, wanted = parse_quantity(word.raw), parse_unit(unit)
    if quantity is None or wanted is None or quantity[1].dimension != wanted.dimension:
        return None
    number = convert(quantity[0], quantity[1], wanted)
    if not -_LARGE < number < _LARGE:
        return None
    return str(round(number)) if abs(number - round(number)) < _TINY * max(1.0, abs(number)) else repr(number)


def as_comment(text: str) -> str:
    """A text as it is spelt in an XML comment, which must not contain `--` or end with `-`."""
    if "-" in text:
        text = text.replace("--", "- -").replace("--", "- -")
        text = f"{text} " if text.endswith("-") else text
    return text


# Characters that XML 1.0 allows in no spelling.
FORBIDDEN: Final = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")

_LARGE: Final = 1e300
_TINY: Final = 1e-9  # the rounding error of a conversion; the checks call such a number whole, too
_SPECIAL: Final = re.compile(r'[&<>"\\\r]').search
_IN_STRING: Final = re.compile(r'\\["\'\\nt]|[&<>"]|\r\n?')
_SPELT: Final = {
    **{each: escape(unquote(f'"{each}"')) for each in ('\\"', "\\'", "\\\\", "\\n", "\\t")},
    **{each: escape(each) for each in '&<>"'},
    **dict.fromkeys(("\r\n", "\r"), "\n"),
}
