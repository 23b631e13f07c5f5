"""What each verb demands: a module a verb, named as its row in `catalog/verbs`; of `takes`, `span` and `total` judge
the time between events and sums.

One invariant: a module has one of two functions.  `judge(claim, activation, observed)` sees one activation when that
has ended, and answers None where it does not count.  `judge_run(claim, run)` sees what the nodes did in a run that has
ended, and answers None for what the end of the log cuts off.  Odds and windows are not known here.
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
        since: of a clause that is judged over a run, when the time began that it is about.
        starts: of such a clause, the activations that it counts or adds up.
    """

    holds: bool | None
    at: int
    said: str
    measure: Measure | None = None
    since: int | None = None
    starts: Sequence[Activation] = ()


def judges_of(claim: Claim, subject: Subject | None) -> tuple[Judge | None, RunJudge | None]:
    """What judges a clause: each activation, or a run; neither where nothing does.

    Args:
        subject: what it holds for.
    """
    name: str = claim.verb
    if isinstance(subject, Span | Total):
        if VERBS[claim.verb].limits != "completion":
            return None, None
        name = "span" if isinstance(subject, Span) else "total"
    module = import_module(f"{__name__}.{name}")
    return getattr(module, "judge", None), getattr(module, "judge_run", None)
