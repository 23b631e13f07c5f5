"""Children that run at the same time, each independent of the others, until enough of them have ended.

Children end one at a time: those that end in the same tick, in their order.  So whenever one ends, how many of the
others have succeeded and failed by then decides what that comes to.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeAlias

from btq_lang.prediction.exact.folded import ZERO, Folded, FoldedOutcome, folded
from btq_lang.prediction.exact.times import of_masses
from btq_lang.prediction.skill import Probability
from btq_lang.simulator.nodes import FAILURE, RUNNING, SUCCESS

Ends: TypeAlias = Callable[[int, int], "int | None"]  # the result with so many successes and failures; None: it goes on


def together(children: Sequence[Folded], ends: Ends) -> Folded:
    """What all children come to.

    Args:
        ends: once it gives a result, it has one with more successes and failures too.
    """
    error = max(each.takes.error for child in children for each in child.outcomes if each.takes is not None)
    strays = sum(each.takes.strays for child in children for each in child.outcomes if each.takes is not None)
    masses = _masses(children, ends)
    totals: dict[int, Probability] = {result: sum(by_time.values()) for result, by_time in masses.items()}
    doubt = sum(child.doubt for child in children)
    if depends_on_order(len(children), ends):
        ended = float(sum(totals.values()))
        endless = max(1 - ended, 0.0) if any(child.is_endless for child in children) else 0.0
        totals = {result: total / (ended + endless) for result, total in totals.items()}
        totals[RUNNING] = endless
        doubt += strays + _doubt(children, ends, error, totals[SUCCESS])
    else:
        totals = _totals(children, ends)
    outcomes = [
        FoldedOutcome(result, totals[result], of_masses(by_time, error, strays))
        for result, by_time in masses.items()
        if by_time and totals[result]
    ]
    return folded([*outcomes, FoldedOutcome(RUNNING, totals[RUNNING], None)], doubt)


def depends_on_order(size: int, ends: Ends) -> bool:
    """Whether the result depends on which children end first."""
    counts = [(successes, size - successes) for successes in range(size + 1)]
    return any(len(_reached(ends, *each)) > 1 for each in counts)


def _reached(ends: Ends, successes: int, failures: int) -> set[int]:
    """The results that are possible on the way to so many successes and failures."""
    results = {ends(one, other) for one in range(successes + 1) for other in range(failures + 1)}
    return {result for result in results if result is not None}


def _totals(children: Sequence[Folded], ends: Ends) -> dict[int, Probability]:
    """The probabilities of the results if all children ended that ever do."""
    table: dict[tuple[int, int], Probability] = _counts(
        [(child.probability(SUCCESS), child.probability(FAILURE)) for child in children]
    )
    totals: dict[int, Probability] = dict.fromkeys((SUCCESS, FAILURE, RUNNING), ZERO)
    for counts, probability in table.items():
        totals[next(iter(_reached(ends, *counts)), RUNNING)] += probability
    return totals


def _doubt(children: Sequence[Folded], ends: Ends, error: int, success: Probability) -> float:
    """How much likelier or unlikelier it succeeds if successes come as early as they may, and failures as late, and
    the other way round.
    """
    if not error:
        return 0.0
    shifted = (_masses(children, ends, {SUCCESS: shift, FAILURE: -shift})[SUCCESS] for shift in (-error, error))
    return max(abs(sum(masses.values()) - float(success)) for masses in shifted)


def _masses(
    children: Sequence[Folded], ends: Ends, shifts: dict[int, int] | None = None
) -> dict[int, dict[int, float]]:
    """When it ends with which result, in milliseconds, with probabilities."""
    events: dict[tuple[int, int], dict[int, float]] = {}
    for number, child in enumerate(children):
        for each in child.outcomes:
            if each.takes is not None:
                shift = shifts[each.result] if shifts else 0
                for point, mass in zip(each.takes.points, each.takes.masses, strict=True):
                    event = events.setdefault((point + shift, number), {})
                    event[each.result] = event.get(each.result, 0.0) + mass * float(each.probability)
    masses: dict[int, dict[int, float]] = {SUCCESS: {}, FAILURE: {}}
    ended = [(0.0, 0.0) for _ in children]  # how likely each has succeeded and failed so far
    for (time, number), event in sorted(events.items()):
        success, failure = event.get(SUCCESS, 0.0), event.get(FAILURE, 0.0)
        for (successes, failures), likely in _counts(ended[:number] + ended[number + 1 :]).items():
            if ends(successes, failures) is not None:
                continue
            for result, mass in ((ends(successes + 1, failures), success), (ends(successes, failures + 1), failure)):
                if result is not None and mass:
                    masses[result][time] = masses[result].get(time, 0.0) + likely * mass
        ended[number] = (ended[number][0] + success, ended[number][1] + failure)
    return masses


def _counts(children: Sequence[tuple[Probability, Probability]]) -> dict[tuple[int, int], Probability]:
    """How likely so many of some children have succeeded and failed."""
    table: dict[tuple[int, int], Probability] = {(0, 0): 1}
    for success, failure in children:
        after: dict[tuple[int, int], Probability] = {}
        ways = (((1, 0), success), ((0, 1), failure), ((0, 0), 1 - success - failure))
        for (successes, failures), likely in table.items():
            for (more, others), mass in ways:
                if mass:
                    key = successes + more, failures + others
                    after[key] = after.get(key, 0) + likely * mass
        table = after
    return table
