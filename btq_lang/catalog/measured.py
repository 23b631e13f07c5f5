"""What a number of a clause measures, as far as the words before it determine: a time after `takes`, a probability
after `in`.

One invariant: a result follows from the words of the grammar alone; what signals and parameters measure is not known
here.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from btq_lang.catalog.verbs import words


def measured(line: Sequence[str]) -> str | None:
    """The unit of what follows some words of a line, or one of its dimension; None if they do not determine it."""
    is_behind_case = False
    for word in reversed(line):
        if word in ("else", ","):
            is_behind_case = True  # `20 s if near, 30 s if slow else …`: the verb precedes all the cases
        elif word in _UNITS and not (word == "if" and is_behind_case):
            return _UNITS[word]
    return None


_UNITS: Final[dict[str, str | None]] = {
    **dict.fromkeys((*words(operands=("duration",)), "within", "every", "per"), "s"),
    **dict.fromkeys(("in", "probability", "confidence"), "%"),
    **dict.fromkeys(words(operands=("condition", "use", "count", "rate"))),
    **dict.fromkeys(("while", "when", "if", "context", "over", "goal", "initially")),
}
