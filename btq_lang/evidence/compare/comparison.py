"""What changed between two sides of a store, by requirement and by node."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Final, TypeVar

from btq_lang.evidence.compare import questions
from btq_lang.evidence.compare.causes import chains, with_causes
from btq_lang.evidence.compare.chance import LEVEL, exact, expected, holm, is_too_few, shuffles_for
from btq_lang.evidence.compare.failures import totals
from btq_lang.evidence.compare.measures import difference, probability, sizes
from btq_lang.evidence.compare.mission_numbers import Numbers
from btq_lang.evidence.compare.model import AT_LEAST, ComparedNumber, Key, RunComparison, is_time
from btq_lang.evidence.compare.requirements import edited, turned, verdicts
from btq_lang.evidence.store.tables import quoted
from btq_lang.evidence.verdicts import UNKNOWN, VIOLATED
from btq_lang.util.record import replace

if TYPE_CHECKING:
    from btq_lang.evidence.compare.failures import FailedRuns
    from btq_lang.evidence.compare.rates import ComparedRate
    from btq_lang.evidence.compare.requirements import Newly, Verdicts
    from btq_lang.evidence.store.queries import Ask, Row

T = TypeVar("T")


class UnknownSide(Exception):
    """A side has no runs; the message says which there are."""


def compare(ask: Ask, by: str, sides: tuple[str, str], at_least: float = AT_LEAST) -> tuple[RunComparison, ...]:
    """Compare two labels or robots, in every mission that both have run; what only one has run comes last.

    Args:
        at_least: which share of the first side's number a difference must have to be called a change.

    Raises:
        Unknown: a side has no runs, or no mission in common with the other.
    """
    names = [str(row["name"]) for row in ask(questions.NAMES.format(by=by))]
    for side in sides:
        if side not in names:
            named = ", ".join(filter(None, names)) or f"no {by}s"
            raise UnknownSide(f"no run has the {by} {side}; there are {named}")
    runs: dict[str, dict[str, Row]] = {}
    for row in ask(questions.RUNS.format(by=by, sides=", ".join(map(quoted, sides)))):
        runs.setdefault(row["mission"], {})[row["side"]] = row
    before, after = (verdicts(ask, by, side) for side in sides)
    missions = [
        _Mission(ask, by, sides, name, (rows[sides[0]], rows[sides[1]]), (before[name], after[name]))
        for name, rows in runs.items()
        if len(rows) == len(sides)
    ]
    if not missions:
        raise UnknownSide(f"no mission was run with both {sides[0]} and {sides[1]}")
    number = sum(mission.comparisons for mission in missions)
    compared = [[*mission.changes(number)] for mission in missions]
    adjusted = iter(holm([change.p for changes in compared for change in changes]))
    judged = [[_judged(change, next(adjusted), at_least) for change in changes] for changes in compared]
    alone = [_alone(name, [rows.get(side) for side in sides]) for name, rows in runs.items() if len(rows) < len(sides)]
    return (*(mission.result(changes, at_least) for mission, changes in zip(missions, judged, strict=True)), *alone)


def _judged(change: ComparedNumber, p: float, at_least: float) -> ComparedNumber:
    is_change = p <= LEVEL and change.is_at_least(at_least)
    if change.what == "mean" and is_time(change.unit) and abs(change.difference) <= _RESOLUTION:
        is_change = False
    return replace(change, p=p, finding=change.direction if is_change else "")


def _alone(mission: str, rows: Sequence[Row | None]) -> RunComparison:
    """A mission that only one side ran."""
    first, second = ((row["runs"], len(row["robots"])) if row is not None else (0, 0) for row in rows)
    runs, robots = zip(first, second, strict=True)
    before, after = ((row["first_us"], row["last_us"]) if row is not None else None for row in rows)
    return RunComparison(
        mission, runs, robots, (before, after), (), "runs", 1, 0.0, (0, 0), (), (), ((), ()), (), (), ()
    )


class _Mission:
    """A mission that both sides ran.

    Attributes:
        comparisons: how many there are.
    """

    def __init__(
        self,
        ask: Ask,
        by: str,
        sides: tuple[str, str],
        name: str,
        runs: tuple[Row, Row],
        judged: tuple[Verdicts, Verdicts],
    ) -> None:
        """
        Args:
            runs: of each side, the answer to `questions.RUNS`.
            judged: the verdicts of each side.
        """
        self._name: Final = name
        self._runs: Final = runs
        self._by: Final = by
        self._edited: Final = edited(*judged)
        self._turned: Final = turned(*judged, self._edited)
        self._only: Final = tuple(sorted(judged[0].keys() - judged[1])), tuple(sorted(judged[1].keys() - judged[0]))
        self._unknown: Final = tuple(
            name
            for name, requirement in judged[1].items()
            if name in judged[0] and {requirement.verdict, judged[0][name].verdict} == {UNKNOWN}
        )
        self._numbers: Final = Numbers(ask, by, sides, name, runs, self._edited)
        durations = {key: measure for key, measure in self._numbers.measures.items() if self._numbers.is_duration(key)}
        others = [[key] for key in self._numbers.measures if key not in durations]
        self._measures: Final = [*chains(durations, self._numbers.leaves), *others]
        self.comparisons: Final = len(self._measures) + len(self._numbers.failures) + len(self._numbers.rates)

    def changes(self, comparisons: int) -> Iterator[ComparedNumber]:
        """All comparisons, with p-values before Holm.

        Args:
            comparisons: how many there are in all missions.
        """
        numbers = self._numbers
        for key, *same in self._measures:
            measure = numbers.measures[key]
            means = difference(measure, numbers.sides)
            p = probability(
                measure, numbers.units, numbers.shuffles, means.after > means.before, shuffles_for(comparisons)
            )
            units = sizes(measure, numbers.sides)
            yield ComparedNumber(
                *key,
                what="mean",
                unit=numbers.symbol(key),
                before=means.before,
                after=means.after,
                interval=means.interval,
                counts=_pair(
                    sum(values.number for unit, values in measure.items() if unit.side == side)
                    for side in numbers.sides
                ),
                units=_pair(map(sum, zip(*units, strict=True))),
                failed=None,
                p_alone=p,
                p=p,
                too_few=is_too_few(units, comparisons),
                finding="",
                same=tuple(same),
                cause=None,
            )
        yield from (_failed(failed_runs, comparisons) for failed_runs in numbers.failures)
        yield from (_rate(rate, numbers.symbol(rate.key), numbers.periods[rate.key]) for rate in numbers.rates)

    def result(self, changes: Sequence[ComparedNumber], at_least: float) -> RunComparison:
        """The comparison, with p-values after Holm."""
        numbers = self._numbers
        labels = [dict(sorted(row["labels"].items())) for row in self._runs]
        is_mixed = self._by == "robot" and len({*labels[0], *labels[1]}) > 1
        tested = [self._tested(turned, changes) for turned in self._turned]
        return RunComparison(
            mission=self._name,
            runs=_pair(row["runs"] for row in self._runs),
            robots=_pair(len(row["robots"]) for row in self._runs),
            times=_pair((row["first_us"], row["last_us"]) for row in self._runs),
            labels=tuple(labels) if is_mixed else (),
            over=numbers.over,
            group=numbers.group,
            at_least=at_least,
            one_sided=numbers.one_sided(),
            newly=tuple(requirement for requirement in tested if requirement.after == VIOLATED),
            no_longer=tuple(requirement for requirement in tested if requirement.after != VIOLATED),
            only=self._only,
            unknown=self._unknown,
            edited=self._edited,
            changes=tuple(with_causes(changes, numbers, at_least)),
        )

    def _tested(self, newly: Newly, changes: Sequence[ComparedNumber]) -> Newly:
        """The requirement with the p-value of the violations of its clauses."""
        direction = "less reliable" if newly.after == VIOLATED else "more reliable"
        p = [
            change.p if change.direction == direction else 1.0
            for change in changes[len(self._measures) :]
            if newly.id in {key.requirement for key in (change.key, *change.same)}
        ]
        mean = Key(newly.id, newly.clause, newly.node)  # if it is one
        p += [change.p for change in changes[: len(self._measures)] if mean in (change.key, *change.same)]
        return replace(newly, p=min(p), may_be_chance=min(p) > LEVEL) if p else newly


def _failed(failed_runs: FailedRuns, comparisons: int) -> ComparedNumber:
    """The failures of a node, or the violations of a clause."""
    (failed, before), (other, after) = totals(failed_runs.strata)
    shares = failed / before, other / after
    # Robots that fail more often may have run more on one side: then the shares differ the other way than their own.
    agrees = (failed < expected(failed_runs.strata)) == (shares[0] < shares[1])
    p = exact(failed_runs.strata) if agrees else 1.0
    return ComparedNumber(
        *failed_runs.key,
        what="failures",
        unit="%",
        before=shares[0],
        after=shares[1],
        interval=None,
        counts=(before, after),
        units=(before, after),
        failed=(failed, other),
        p_alone=p,
        p=p,
        too_few=is_too_few([(first[1], second[1]) for first, second in failed_runs.strata], comparisons),
        finding="",
        same=failed_runs.same,
        cause=None,
    )


def _rate(rate: ComparedRate, symbol: str, period: float) -> ComparedNumber:
    """A failure rate."""
    before, after = (failed / seconds for failed, seconds in zip(rate.failures, rate.seconds, strict=True))
    return ComparedNumber(
        *rate.key,
        what="rate",
        unit=symbol,
        before=before,
        after=after,
        interval=None,
        counts=rate.runs,
        units=rate.runs,
        failed=rate.failures,
        p_alone=rate.p,
        p=rate.p,
        too_few=False,
        finding="",
        same=(),
        cause=None,
        exposures=rate.seconds,
        period=period,
    )


def _pair(values: Iterable[T]) -> tuple[T, T]:
    first, second = values
    return first, second


_RESOLUTION: Final = 1.5e-6  # s: the times of a log differ by it if nothing has changed
