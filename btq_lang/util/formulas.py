"""Cells of CSV that a spreadsheet would take for a formula.

They get an apostrophe prefix, as OWASP advises ("CSV Injection").
"""

from __future__ import annotations

from typing import Final


def guarded(text: str) -> str:
    """The text of a cell, as it is written."""
    return f"'{text}" if text.startswith(_FORMULA) else text


def unguarded(cell: str) -> str:
    """The text of a cell that was written so."""
    return cell[1:] if cell[:1] == "'" and cell[1:].startswith(_FORMULA) else cell


_FORMULA: Final = ("=", "+", "-", "@", "\t", "\r")
