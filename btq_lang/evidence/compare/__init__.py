"""Two versions compared by the verdicts and durations in a store.

One invariant: only what chance hardly explains is called a change, whatever the number of comparisons.

    questions.py    the questions to the store, as SQL
    mission_numbers.py  the answers, of a mission
    measures.py     durations and other measures by run, and how they differ
    failures.py     in how many runs nodes failed and clauses were violated
    rates.py        failure rates
    chance.py       how likely a difference is without a change
    requirements.py what changed in the verdicts on requirements
    causes.py       which differences have one cause
    comparison.py   what changed; model.py has it as data
    lines.py        the comparison in words
    table.py, json_document.py, markdown.py   the writers
"""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from btq_lang.evidence.compare.model import RunComparison

FORMATS: Final = ("table", "json", "markdown")


def write(comparisons: Sequence[RunComparison], by: str, sides: tuple[str, str], form: str) -> str:
    """Write what changed, in one of FORMATS.

    Args:
        by: what names the sides: `label` or `robot`.
    """
    module = import_module(f"{__name__}.{'json_document' if form == 'json' else form}")
    text: str = module.render(comparisons, by, sides)
    return text
