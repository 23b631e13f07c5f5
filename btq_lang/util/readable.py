"""Text for people in an encoding that lacks some of its characters, such as cp1252 in a pipe on Windows.

In a module of its own because it is imported only when a character is missing.
"""

from __future__ import annotations

import unicodedata
from typing import Final


def replaced(error: UnicodeError) -> tuple[str, int]:
    """A replacement for the characters that cannot be encoded, and the index after them.

    An error handler for `codecs.register_error`.  Most are replaced by one character, so that columns stay aligned.
    """
    assert isinstance(error, UnicodeEncodeError), "asked only for what is written"
    character = error.object[error.start]
    plain = unicodedata.normalize("NFKD", character).encode("ascii", "ignore").decode()
    return _INSTEAD.get(character) or plain or "?", error.start + 1


_INSTEAD: Final = {
    **dict.fromkeys("–—−", "-"),
    **dict.fromkeys("‘’", "'"),
    **dict.fromkeys("“”„‟«»", '"'),
    **dict.fromkeys("µμ", "u"),
    **dict.fromkeys("×✖", "x"),
    "°": "deg",
    "·": "*",
    "÷": "/",
    "→": "->",
    "⇉": "=>",
    "≤": "<=",
    "≥": ">=",
    "≠": "!=",
    "Ω": "ohm",
}
