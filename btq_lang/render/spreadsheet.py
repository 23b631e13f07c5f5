"""CSV files, which people open in spreadsheets.

They are apart from any writer: the overview and reports of verdicts share them.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping, Sequence

from btq_lang.util.formulas import guarded


def table(columns: Sequence[str], rows: Iterable[Mapping[str, str | float]]) -> str:
    """A table with a heading; a column that a row lacks is empty there, and no text is a formula."""
    out = io.StringIO()
    writer = csv.DictWriter(out, columns, restval="")
    writer.writeheader()
    texts = ({key: guarded(value) if isinstance(value, str) else value for key, value in row.items()} for row in rows)
    writer.writerows(texts)
    return out.getvalue()
