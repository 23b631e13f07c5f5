"""Characters as numbers: `ord(text[at])` compared with these costs the compiled parser nothing, a string a call.

One invariant: `begins_name` and `goes_on` say of every character what `[^\\W\\d]` and `\\w` say.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from mypy_extensions import i64

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
BACKSLASH: Final = 0x5C
UNDERSCORE: Final = 0x5F
SMALL_A: Final = 0x61
SMALL_S: Final = 0x73
SMALL_T: Final = 0x74
SMALL_Z: Final = 0x7A
LEFT_BRACE: Final = 0x7B
RIGHT_BRACE: Final = 0x7D
ASCII: Final = 0x80  # the first that is none


def begins_name(code: i64) -> bool:
    """A letter or `_`"""
    if code < ASCII:
        return 0x61 <= code <= 0x7A or 0x41 <= code <= 0x5A or code == UNDERSCORE
    return chr(code).isalpha()


def goes_on(code: i64) -> bool:
    """A letter, a digit or `_`"""
    if code < ASCII:
        return 0x61 <= code <= 0x7A or 0x30 <= code <= 0x39 or 0x41 <= code <= 0x5A or code == UNDERSCORE
    return chr(code).isalnum()
