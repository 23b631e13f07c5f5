"""Judges each verb: a module a verb, named like its row in `catalog/verbs`; for `takes`, `span` and `total` judge the
time between events, and sums.

One invariant: a module has one of two functions.  `judge(claim, activation, observed)` judges one activation that has
ended, None if it does not count.  `judge_run(claim, run)` judges a run that has ended, and yields None for what the end
of the log cuts off.  Odds and windows are unknown here.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from importlib import import_module
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from btq_lang.catalog.verbs import VERBS
from btq_lang.requirements.model import Claim, Span, Subject, Total

if TYPE_CHECKING:
    from btq_lang.evidence.conditions import Reading
    from btq_lang.evidence.limits import Measure
    from btq_lang.evidence.model import Activation
    from btq_lang.evidence.observed import Observed
    from btq_lang.evidence.over_run import OverRun

    Judge: TypeAlias = Callable[[Claim, Activation, Observed], "Judgement | None"]
    RunJudge: TypeAlias = Callable[[Claim, OverRun], Iterator["Judgement | None"]]


class Judgement(NamedTuple):  # not a Record for the same reason as Measure
    """Whether an activation, or a run, satisfies a clause.

    Attributes:
        holds: None: unknown.
        at: when that was decided.
        sentence: what was observed, where `{}` is the measure, unless it holds; if `holds` is None, the reason.
        since: for a clause judged over a run, when the judged time began.
        starts: for such a clause, the activations that it counts or adds up.
    """

    holds: bool | None
    at: int
    sentence: str
    measure: Measure | Reading | None = None
    since: int | None = None
    starts: Sequence[Activation] = ()


def judges_of(claim: Claim, subject: Subject | None) -> tuple[Judge | None, RunJudge | None]:
    """The functions that judge a clause for a subject, by activation and by run; at most one is not None."""
    name: str = claim.verb
    if isinstance(subject, Span | Total):
        if VERBS[claim.verb].limits != "completion":
            return None, None
        name = "span" if isinstance(subject, Span) else "total"
    module = import_module(f"{__name__}.{name}")
    return getattr(module, "judge", None), getattr(module, "judge_run", None)
