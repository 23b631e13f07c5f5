"""Requirements in CSV with a heading: a row each, or several whose texts are then joined."""

from __future__ import annotations

import csv
import io
from typing import Final

from btq_lang.requirements.external.fields import IDS, ImportProblem, id_among, requirement
from btq_lang.util.formulas import unguarded
from btq_lang.util.record import replace
from btq_lang.workspace.external_requirements import ExternalRequirement


def read_requirements(path: str, text: str) -> list[ExternalRequirement]:
    """The requirements of the rows that have an id, each once, in order.

    Raises:
        ImportProblem: the text is not CSV, or no column has ids.
    """
    separator = max(_SEPARATORS, key=text.partition("\n")[0].count)
    rows = csv.reader(io.StringIO(text, newline=""), delimiter=separator, strict=True)
    by_id: dict[str, ExternalRequirement] = {}
    try:
        names = [name.strip().lower() for name in next(rows, [])]
        id_name = id_among(names)
        if id_name is None:
            raise ImportProblem(f"no column has ids; expected one that is named {', '.join(IDS)}", 1)
        line = rows.line_num + 1
        for row in rows:
            values = {name: unguarded(value) for name, value in zip(names, row, strict=False)}
            if id_ := values.pop(id_name, "").strip():
                one = requirement(id_, values, path, line)
                by_id[id_] = _joined(by_id[id_], one) if id_ in by_id else one
            line = rows.line_num + 1
    except csv.Error as error:
        raise ImportProblem(f"not CSV: {error}", max(rows.line_num, 1)) from error
    return [*by_id.values()]


def _joined(first: ExternalRequirement, other: ExternalRequirement) -> ExternalRequirement:
    """A requirement with what another row has about it."""
    texts = dict.fromkeys(text for text in (*first.text.split("\n"), other.text) if text)
    return replace(first, text="\n".join(texts), status=first.status or other.status, url=first.url or other.url)


_SEPARATORS: Final = (",", ";", "\t")  # spreadsheets write `;` where a comma is the decimal mark
