"""What each verb demands of one activation: a module a verb, named as its row in `catalog/verbs`.

One invariant: a module has `judge(claim, activation, signals)`, which answers None where the activation does not count.
It sees one activation at a time, when that has ended; runs, odds and scopes are not known here.
"""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec

from btq_lang.catalog.verbs import VERBS
from btq_lang.record import Record

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import TypeAlias

    from btq_lang.evidence.model import Activation
    from btq_lang.evidence.signals import Signals
    from btq_lang.requirements.model import Claim
    from btq_lang.units import Unit

    Judge: TypeAlias = Callable[[Claim, Activation, Signals], "Judgement | None"]


class Measure(Record):
    """What was measured, beside its bound.

    Attributes:
        unit: that of the bound, to say it in.
        bound: in SI.
        bound_text: as typed.
        excess: how far it is on the wrong side of the bound, in SI; negative on the right side.
    """

    si: float
    unit: Unit | None
    bound: float
    bound_text: str
    excess: float


class Judgement(Record):
    """Whether an activation keeps a clause.

    Attributes:
        holds: None: unknown.
        at: when that was decided.
        said: what was measured, in words, in which `{}` is the measure; where it is unknown, why.
    """

    holds: bool | None
    at: int
    said: str
    measure: Measure | None = None


def judge_of(word: str) -> Judge | None:
    """What judges clauses with a verb; None: they are not judged from logs yet.

    Args:
        word: a row of `catalog.verbs.VERBS`.
    """
    name = f"{__name__}.{VERBS[word].word}"
    judge: Judge | None = import_module(name).judge if find_spec(name) is not None else None
    return judge
