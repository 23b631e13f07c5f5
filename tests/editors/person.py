"""A person who types a text: in an editor that closes quotes and brackets and indents by itself, one types the closing
ones as well, which it then types over, looks where Enter has put the cursor, and types what is still missing there."""

from __future__ import annotations

import re
from collections.abc import Callable

LEVEL = 4  # blanks that Tab and Backspace write and delete where a line begins


def type_text(text: str, press: Callable[[str], None], blanks: Callable[[], int], think: Callable[[], None]) -> None:
    """Type a text.

    Args:
        press: gives a key to the editor: Enter, Tab, Backspace, or what its character is; a word's at once.
        blanks: looks how many blanks the line of the cursor begins with.
        think: is what goes before Enter, Tab, a blank, and a quote that closes.
    """
    lines = text.split("\n")
    for number, line in enumerate(lines):
        body = line.lstrip(" ")
        keys = re.findall(r"\w+|.", body)
        if number:
            think()
            press("Enter")
            if body or number == len(lines) - 1:  # the editor takes blanks back itself when Enter leaves them alone
                missing = (len(line) - len(body) - blanks()) // LEVEL
                keys = ["Tab" if missing > 0 else "Backspace"] * abs(missing) + keys
        is_quoted = False
        for key in keys:
            if key in ("Tab", " ") or (key == '"' and is_quoted):
                think()
            is_quoted ^= key == '"'
            press(key)
