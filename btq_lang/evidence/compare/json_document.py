"""What changed, for programs: a document that `comparison.schema.json` describes."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Final

from btq_lang.evidence.compare.comparison import Comparison
from btq_lang.util.fields import as_dict

FORMAT: Final = "btq-comparison"
VERSION: Final = 1


def render(found: Sequence[Comparison], by: str, sides: tuple[str, str]) -> str:
    """Write the comparisons as JSON."""
    document = {
        "format": FORMAT,
        "version": VERSION,
        "by": by,
        "sides": sides,
        "missions": [
            {
                **as_dict(each),
                **{name: [as_dict(one) for one in getattr(each, name)] for name in _LISTS},
            }
            for each in found
        ],
    }
    return json.dumps(document, indent=1, allow_nan=False) + "\n"


_LISTS: Final = ("newly", "no_longer", "edited", "changes")
