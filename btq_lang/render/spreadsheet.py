"""CSV files, which people open in spreadsheets.

They are apart from any writer: the overview and reports of verdicts share them.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping, Sequence
from typing import Final


def table(columns: Sequence[str], rows: Iterable[Mapping[str, str | float]]) -> str:
    """A table with a heading; a column that a row lacks is empty there.

    A text that a spreadsheet would take for a formula gets an apostrophe prefix, as OWASP advises ("CSV Injection").
    """
    out = io.StringIO()
    writer = csv.DictWriter(out, columns, restval="")
    writer.writeheader()
    writer.writerows({key: _plain(value) for key, value in row.items()} for row in rows)
    return out.getvalue()


def _plain(value: str | float) -> str | float:
    return f"'{value}" if isinstance(value, str) and value.startswith(_FORMULA) else value


_FORMULA: Final = ("=", "+", "-", "@", "\t", "\r")
