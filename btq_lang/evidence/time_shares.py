"""Judges `keeps φ in at least 95 % of time`: in a run, the share of the time in which a node is active.

One invariant: time of which it is unknown whether it counts, or whether the condition holds in it, counts both ways,
and the judgement is valid only if both agree.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

from btq_lang.catalog.verbs import VERBS
from btq_lang.evidence.conditions import compared, truth
from btq_lang.evidence.model import UNKNOWN_BEGIN, UNKNOWN_END, Activation
from btq_lang.evidence.signals import UnknownValue
from btq_lang.evidence.verbs import OUT, Judgement, between
from btq_lang.requirements.model import All, Flag, Negation, ResolvedClaim

if TYPE_CHECKING:
    from btq_lang.evidence.over_run import OverRun
    from btq_lang.requirements.model import Condition


ALWAYS: Final = Flag(True)


def of_time(claim: ResolvedClaim, run: OverRun) -> Iterator[Judgement | None]:
    """`keeps φ in at least p of time`: the share of the time of a node's activations in a run in which φ is true."""
    assert claim.condition is not None, "something is kept"
    times = _Times()
    condition = Negation(claim.condition) if claim.head == "never" else claim.condition
    for activation in run.own:
        for piece in pieces(run, activation, condition):
            times.add(*piece)
    if not times.all:
        yield OUT
    elif run.is_cut_off:
        yield None
    elif not times.sure:
        yield Judgement(None, run.root.end, times.why)
    else:
        yield _judged(claim, run, times)


class _Times:
    """How much time of each kind there is in a run, in µs.

    Attributes:
        why: why some is unknown; empty if none is.
    """

    def __init__(self) -> None:
        self.why = ""
        self._by_kind: Final[dict[tuple[bool, bool | None], int]] = {}

    def add(self, time: int, counts: bool | UnknownValue, holds: bool | UnknownValue) -> None:
        """Add time that counts, or may, and in which the condition holds, does not, or may."""
        unknown = next((each.why for each in (counts, holds) if isinstance(each, UnknownValue)), "")
        self.why = self.why or unknown
        kind = counts is True, holds if isinstance(holds, bool) else None
        self._by_kind[kind] = self._by_kind.get(kind, 0) + time

    @property
    def all(self) -> int:
        return sum(self._by_kind.values())

    @property
    def sure(self) -> int:
        """How much time counts."""
        return self._sum((True, True), (True, False), (True, None))

    @property
    def least(self) -> float:
        """The smallest share that it may be."""
        kept = self._sum((True, True))
        return kept / (kept + self._sum((True, False), (True, None), (False, False), (False, None)))

    @property
    def most(self) -> float:
        """The largest share that it may be."""
        kept = self._sum((True, True), (True, None), (False, True), (False, None))
        return kept / (kept + self._sum((True, False)))

    def _sum(self, *kinds: tuple[bool, bool | None]) -> int:
        return sum(self._by_kind.get(kind, 0) for kind in kinds)


def pieces(
    run: OverRun, activation: Activation, condition: Condition = ALWAYS
) -> Iterator[tuple[int, bool | UnknownValue, bool | UnknownValue]]:
    """The time of an activation that counts or may count, from as early as it may have begun to its end: pieces in µs,
    whether each counts, and whether a condition holds in it.
    """
    observed = run.during(activation)
    starts, meanwhile = ([scope.condition for scope in run.scopes if scope.word == word] for word in ("when", "while"))
    is_about_it = truth(All(tuple(starts)), observed.in_scope, observed.begin)
    if is_about_it is False:
        return
    scope = All(tuple(meanwhile))
    begin, end = activation.begun(True), activation.ended
    before = observed.between(begin, end)
    moments = sorted({*before.moments(condition, scope), activation.started})
    for moment, following in zip(moments, [*moments[1:], end], strict=True):
        seen = observed if moment >= observed.begin else before
        counts = truth(scope, seen.in_scope, moment)
        if counts is True:
            counts = is_about_it
        if counts is True and moment < activation.started:
            counts = UnknownValue(UNKNOWN_BEGIN)
        elif counts is True and activation.timing == "latest":
            counts = UnknownValue(UNKNOWN_END)
        if counts is not False and following[0] > moment[0]:
            yield following[0] - moment[0], counts, truth(condition, seen, moment)


def _judged(claim: ResolvedClaim, run: OverRun, times: _Times) -> Judgement:
    """The judgement of a run."""
    end = run.root.end
    least, most = (compared(claim, share, run.observed, run.observed.begin) for share in (times.least, times.most))
    assert not isinstance(least, UnknownValue), "the share is a number"
    assert not isinstance(most, UnknownValue), "the share is a number"
    if least.holds is not most.holds:
        return Judgement(None, end, times.why)
    sentence = f"`{_condition(claim)}` {VERBS[claim.verb].said}"
    return between(Judgement(least.holds, end, sentence, least, run.own[0].begin), least, most)


def _condition(claim: ResolvedClaim) -> str:
    """The condition as typed."""
    text = claim.text.partition(f"{claim.head} ")[2]
    return max((text.rpartition(words)[0] for words in (" in at least ", " with probability ")), key=len)
