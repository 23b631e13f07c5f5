"""Two versions compared by what a store has of them.

One invariant: only what chance hardly explains is called a change, whatever the number of comparisons.

    questions.py    what is asked of the store, as SQL
    chance.py       how likely a difference is without a change
    requirements.py what changed in the verdicts on requirements
    comparison.py   what changed, as data
    words.py        a change in words
    table.py, json_document.py, markdown.py   the writers
"""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from btq_lang.evidence.compare.comparison import Comparison

FORMATS: Final = ("table", "json", "markdown")


def write(found: Sequence[Comparison], by: str, sides: tuple[str, str], form: str) -> str:
    """Write what changed, in one of FORMATS.

    Args:
        by: what names the sides: `label` or `robot`.
    """
    module = import_module(f"{__name__}.{'json_document' if form == 'json' else form}")
    text: str = module.render(found, by, sides)
    return text
