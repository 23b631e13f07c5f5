"""Texts in CSV files, which people open in spreadsheets."""

from __future__ import annotations

from typing import Final


def plain(value: str | float) -> str | float:
    """A value; a text that a spreadsheet would take for a formula gets an apostrophe prefix, as OWASP advises ("CSV
    Injection").
    """
    return f"'{value}" if isinstance(value, str) and value.startswith(_FORMULA) else value


_FORMULA: Final = ("=", "+", "-", "@", "\t", "\r")
