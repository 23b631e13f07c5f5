"""What changed, for programs: a document that `comparison.schema.json` describes."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any, Final

from btq_lang.evidence.compare.model import ComparedNumber, RunComparison
from btq_lang.util.record import as_dict

FORMAT: Final = "btq-comparison"
VERSION: Final = 3


def render(comparisons: Sequence[RunComparison], by: str, sides: tuple[str, str]) -> str:
    """Write the comparisons as JSON."""
    document = {
        "format": FORMAT,
        "version": VERSION,
        "by": by,
        "sides": sides,
        "missions": [
            {
                **as_dict(comparison),
                **{name: [as_dict(record) for record in getattr(comparison, name)] for name in _LISTS},
                "changes": [_change(record) for record in comparison.changes],
            }
            for comparison in comparisons
        ],
    }
    return json.dumps(document, indent=1, allow_nan=False) + "\n"


def _change(change: ComparedNumber) -> dict[str, Any]:
    cause = change.cause._asdict() if change.cause is not None else None
    return {**as_dict(change), "same": [key._asdict() for key in change.same], "cause": cause}


_LISTS: Final = ("newly", "no_longer", "edited")
