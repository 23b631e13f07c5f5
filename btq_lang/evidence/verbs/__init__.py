"""Judges each verb: a module a verb, named like its row in `catalog/verbs`; for `takes`, `span` and `total` judge the
time between events, and sums.

One invariant: a module has one of two functions.  `judge(claim, activation, observed)` judges one activation that has
ended, None if it does not count.  `judge_run(claim, run)` judges a run that has ended, and yields None for what the end
of the log cuts off.  Odds and windows are unknown here.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from importlib import import_module
from typing import TYPE_CHECKING, TypeAlias

from btq_lang.catalog.verbs import VERBS
from btq_lang.requirements.model import Span, Total
from btq_lang.util.record import Record

if TYPE_CHECKING:
    from btq_lang.catalog.units import Unit
    from btq_lang.evidence.model import Activation
    from btq_lang.evidence.observed import Observed
    from btq_lang.evidence.over_run import OverRun
    from btq_lang.requirements.model import Claim, Subject

    Judge: TypeAlias = Callable[[Claim, Activation, Observed], "Judgement | None"]
    RunJudge: TypeAlias = Callable[[Claim, OverRun], Iterator["Judgement | None"]]


class Measure(Record):
    """A measured value and its bound.

    Attributes:
        unit: that of the bound, to print both in.
        bound: in SI.
        bound_text: as typed.
        excess: how far the value is on the wrong side of the bound, in SI; negative on the right side.
    """

    si: float
    unit: Unit | None
    bound: float
    bound_text: str
    excess: float


class Judgement(Record):
    """Whether an activation, or a run, satisfies a clause.

    Attributes:
        holds: None: unknown.
        at: when that was decided.
        sentence: a sentence in which `{}` is the measure; if `holds` is None, the reason.
        since: for a clause judged over a run, when the judged time began.
        starts: for such a clause, the activations that it counts or adds up.
    """

    holds: bool | None
    at: int
    sentence: str
    measure: Measure | None = None
    since: int | None = None
    starts: Sequence[Activation] = ()


def judges_of(claim: Claim, subject: Subject | None) -> tuple[Judge | None, RunJudge | None]:
    """The functions that judge a clause, by activation and by run; at most one is not None.

    Args:
        subject: what the clause holds for.
    """
    name: str = claim.verb
    if isinstance(subject, Span | Total):
        if VERBS[claim.verb].limits != "completion":
            return None, None
        name = "span" if isinstance(subject, Span) else "total"
    module = import_module(f"{__name__}.{name}")
    return getattr(module, "judge", None), getattr(module, "judge_run", None)
