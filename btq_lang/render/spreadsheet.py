"""Texts in CSV files, which people open in spreadsheets."""

from __future__ import annotations

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from typing import Final


def plain(value: str | float) -> str | float:
    """A value; a text that a spreadsheet would take for a formula has an apostrophe before it, as OWASP advises
    ("CSV Injection")."""
    return f"'{value}" if isinstance(value, str) and value.startswith(_FORMULA) else value


_FORMULA: Final = ("=", "+", "-", "@", "\t", "\r")
