"""What changed between two sides of a store, by requirement and by node.

One invariant: what is loaded are counts of each run, group of runs or robot; the quantiles are those of all values.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from math import lcm
from typing import TYPE_CHECKING, Any, Final, Literal, TypeAlias

from btq_lang.catalog.units import parse_unit
from btq_lang.evidence.compare import questions
from btq_lang.evidence.compare.chance import LEVEL, Shuffles, exact, expected, holm, is_too_few, least, shuffles_for
from btq_lang.evidence.compare.requirements import edited, turned, verdicts
from btq_lang.evidence.store.tables import quoted
from btq_lang.evidence.verdicts import VIOLATED
from btq_lang.util.record import Record, replace

if TYPE_CHECKING:
    from btq_lang.evidence.compare.chance import Failures
    from btq_lang.evidence.compare.requirements import Edited, Newly, Verdicts

    Ask: TypeAlias = Callable[[str], Sequence[Mapping[str, Any]]]
    Key: TypeAlias = tuple[str, str, str]  # requirement, clause, node
    Unit: TypeAlias = tuple[str, str, Any]  # side, stratum, and which of these
    Over: TypeAlias = Literal["runs", "runs of each robot", "robots"]
    Finding: TypeAlias = Literal["", "slower", "faster", "higher", "lower", "less reliable", "more reliable"]


class Change(Record):
    """A number that is compared.

    Attributes:
        requirement, clause: empty where it is about the node alone.
        what: `median` and `p95` of a measure; `failures`: the share of runs with a failure or a violation.
        unit: that the measure is shown in; values are in SI.
        before, after: the number on each side.
        counts: how many values, or runs, each side has.
        failed: in how many of these runs it failed, or was violated; None for a measure.
        p: the probability of such a difference by chance, after Holm.
        too_few: so few runs or robots cannot show any change.
        finding: what is certain enough to be called a change; else empty.
    """

    requirement: str
    clause: str
    node: str
    what: Literal["median", "p95", "failures"]
    unit: str
    before: float
    after: float
    counts: tuple[int, int]
    failed: tuple[int, int] | None
    p: float
    too_few: bool
    finding: Finding


class Comparison(Record):
    """What changed in a mission; nothing is compared of one that only one side ran.

    Attributes:
        runs, robots: how many each side has.
        labels: how many runs of each label each side has, if robots are compared that ran several; else empty.
        over: what is shuffled.  Where a side has several robots, `runs of each robot`, as far as they ran both sides;
            `robots` where each side has some of its own.
        group: how many runs are shuffled together; 1 without groups.
        least_p: the least p that a change of a median or p95 can have, by the number of shuffles.
        one_sided: how many nodes were active on each side and not on the other, so that nothing compares them.
        newly, no_longer: the requirements that only the second side violates, and only the first.
        only: the requirements that only the first side has, and only the second.
        edited: the clauses whose bounds differ, so that their verdicts are no changes.
        changes: all that was compared.
    """

    mission: str
    runs: tuple[int, int]
    robots: tuple[int, int]
    labels: tuple[Mapping[str, int], ...]
    over: Over
    group: int
    least_p: float
    one_sided: tuple[int, int]
    newly: tuple[Newly, ...]
    no_longer: tuple[Newly, ...]
    only: tuple[tuple[str, ...], tuple[str, ...]]
    edited: tuple[Edited, ...]
    changes: tuple[Change, ...]

    @property
    def is_worse(self) -> bool:
        """Whether something is slower, less reliable or newly violated."""
        return bool(self.newly) or any(each.finding in WORSE for each in self.changes)


class Unknown(Exception):
    """A side has no runs; the message says which there are."""


def compare(ask: Ask, by: str, sides: tuple[str, str]) -> tuple[Comparison, ...]:
    """Compare two labels or robots, in every mission that both have run; what only one has run comes last.

    Raises:
        Unknown: a side has no runs, or no mission in common with the other.
    """
    known = [str(row["name"]) for row in ask(questions.NAMES.format(by=by))]
    for side in sides:
        if side not in known:
            named = ", ".join(filter(None, known)) or f"no {by}s"
            raise Unknown(f"no run has the {by} {side}; there are {named}")
    words = {"by": by, "sides": ", ".join(map(quoted, sides))}
    runs: dict[str, dict[str, Mapping[str, Any]]] = {}
    for row in ask(questions.RUNS.format(**words)):
        runs.setdefault(row["mission"], {})[row["side"]] = row
    before, after = (verdicts(ask, by, side) for side in sides)
    missions = [
        _Mission(ask, words, sides, name, rows, (before[name], after[name]))
        for name, rows in runs.items()
        if len(rows) == len(sides)
    ]
    if not missions:
        raise Unknown(f"no mission was run with both {sides[0]} and {sides[1]}")
    number = sum(mission.comparisons for mission in missions)
    found = [mission.changes(number) for mission in missions]
    adjusted = iter(holm([each.p for changes in found for each in changes]))
    judged = [tuple(_judged(each, next(adjusted)) for each in changes) for changes in found]
    alone = [_alone(name, [rows.get(side) for side in sides]) for name, rows in runs.items() if len(rows) < len(sides)]
    least_p = least(number, sum(mission.shuffled for mission in missions))
    return (
        *(mission.result(changes, least_p) for mission, changes in zip(missions, judged, strict=True)),
        *alone,
    )


def _alone(mission: str, rows: Sequence[Mapping[str, Any] | None]) -> Comparison:
    """A mission that only one side ran."""
    first, second = ((row["runs"], len(row["robots"])) if row is not None else (0, 0) for row in rows)
    runs, robots = zip(first, second, strict=True)
    return Comparison(mission, runs, robots, (), "runs", 1, 1.0, (0, 0), (), (), ((), ()), (), ())


class _Mission:
    """The numbers of a mission."""

    def __init__(
        self,
        ask: Ask,
        words: Mapping[str, str],
        sides: tuple[str, str],
        name: str,
        runs: Mapping[str, Mapping[str, Any]],
        judged: tuple[Verdicts, Verdicts],
    ) -> None:
        self._name: Final = name
        self._edited: Final = edited(*judged)
        self._turned: Final = turned(*judged, self._edited)
        self._only: Final = tuple(sorted(judged[0].keys() - judged[1])), tuple(sorted(judged[1].keys() - judged[0]))
        self._sides: Final = sides
        self._runs: Final = (runs[sides[0]]["runs"], runs[sides[1]]["runs"])
        robots = set(runs[sides[0]]["robots"]), set(runs[sides[1]]["robots"])
        self._robots: Final = (len(robots[0]), len(robots[1]))
        labels = [dict(sorted(runs[side]["labels"].items())) for side in sides]
        is_mixed = words["by"] == "robot" and len({*labels[0], *labels[1]}) > 1
        self._labels: Final = tuple(labels) if is_mixed else ()
        self._over: Final = _over(*robots)
        self._size: Final = 1 if self._over == "robots" else -(-min(self._runs) // _MOST_UNITS)
        stratum = "robot" if self._over == "runs of each robot" else "''"
        by_run = questions.BY_RUN.format(by=words["by"], stratum=stratum, size=self._size)
        unit = "robot" if self._over == "robots" else by_run
        words = {**words, "mission": quoted(name), "stratum": stratum, "unit": unit}
        words["robots"] = "robot" if robots[0] & robots[1] else "''"
        words["clause"] = questions.clause_of(self._edited)

        def asked(question: str) -> Sequence[Mapping[str, Any]]:
            return ask(question.format(**words))

        self._measures: Final = self._of_both(asked(questions.QUANTILES))
        self._failures: Final = self._failures_of_both(asked(questions.FAILURES))
        self._units: Final = {_key(row): row["unit"] or "1" for row in asked(questions.UNITS)}
        self._scores: Final[dict[Key, dict[Unit, Mapping[str, Any]]]] = {}
        for row in asked(questions.SCORES):
            self._scores.setdefault(_key(row), {})[row["side"], row["stratum"], row["unit"]] = row
        alone = {row["side"]: row["number"] for row in asked(questions.ONE_SIDED)}
        self._one_sided: Final = (alone.get(sides[0], 0), alone.get(sides[1], 0))
        self.shuffled: Final = 2 * len(self._measures)
        self.comparisons: Final = self.shuffled + len(self._failures)

    def changes(self, comparisons: int) -> list[Change]:
        """All that is compared, with p-values before Holm.

        Args:
            comparisons: how many there are in all missions.
        """
        ids = [sorted({at for rows in self._scores.values() for at in rows if at[0] == side}) for side in self._sides]
        strata = [[stratum for _, stratum, _ in side] for side in ids]
        shuffles = Shuffles(strata[0], strata[1], shuffles_for(comparisons))
        units = [*ids[0], *ids[1]]
        found = []
        for key, (before, after) in self._measures.items():
            counts = before["number"], after["number"]
            too_few = is_too_few(self._sizes(self._scores[key]), comparisons)
            for what in ("median", "p95"):
                scores = _centred(self._scores[key], units, what)
                # Robots of different speed may move the quantiles of all values in the other direction than their own.
                agrees = (sum(scores[: len(ids[0])]) < 0) == (after[what] > before[what])
                p = shuffles.probability(scores) if agrees else 1.0
                unit = self._units.get(key, "s") if key[0] else "s"
                found.append(Change(*key, what, unit, before[what], after[what], counts, None, p, too_few, ""))
        found += [_failed(key, strata, comparisons) for key, strata in self._failures.items()]
        return found

    def result(self, changes: tuple[Change, ...], least_p: float) -> Comparison:
        """The comparison, with p-values after Holm."""
        tested: dict[str, float] = {}
        for change in changes:
            if change.failed is not None:
                tested[change.requirement] = min(change.p, tested.get(change.requirement, 1.0))
        found = [replace(each, may_be_chance=tested.get(each.id, 0.0) > LEVEL) for each in self._turned]
        return Comparison(
            mission=self._name,
            runs=self._runs,
            robots=self._robots,
            labels=self._labels,
            over=self._over,
            group=self._size,
            least_p=least_p,
            one_sided=self._one_sided,
            newly=tuple(each for each in found if each.after == VIOLATED),
            no_longer=tuple(each for each in found if each.after != VIOLATED),
            only=self._only,
            edited=self._edited,
            changes=changes,
        )

    def _failures_of_both(self, rows: Sequence[Mapping[str, Any]]) -> dict[Key, list[Failures]]:
        """Of what both sides have, how many runs of each side failed, of how many, in each stratum."""
        found: dict[Key, dict[str, dict[str, tuple[int, int]]]] = {}
        for row in rows:
            of = found.setdefault(_key(row), {}).setdefault(row["stratum"], {})
            of[row["side"]] = row["failed"], row["number"]
        first, second = self._sides
        return {
            key: [(of.get(first, (0, 0)), of.get(second, (0, 0))) for of in strata.values()]
            for key, strata in found.items()
            if all(any(side in of for of in strata.values()) for side in self._sides)
        }

    def _sizes(self, units: Iterable[Unit]) -> list[tuple[int, int]]:
        """How many units each side has in each stratum."""
        found = Counter((side, stratum) for side, stratum, _ in units)
        first, second = self._sides
        return [(found[first, each], found[second, each]) for each in {stratum for _, stratum in found}]

    def _of_both(self, rows: Sequence[Mapping[str, Any]]) -> dict[Key, tuple[Mapping[str, Any], Mapping[str, Any]]]:
        """The rows of what both sides have."""
        found: dict[Key, dict[str, Mapping[str, Any]]] = {}
        for row in rows:
            found.setdefault(_key(row), {})[row["side"]] = row
        first, second = self._sides
        return {key: (rows[first], rows[second]) for key, rows in found.items() if len(rows) == len(self._sides)}


def _over(first: set[str], second: set[str]) -> Over:
    """What is shuffled, for the robots of the two sides."""
    if max(len(first), len(second)) == 1:
        return "runs"
    return "runs of each robot" if first <= second or second <= first else "robots"


def _failed(key: Key, strata: Sequence[Failures], comparisons: int) -> Change:
    """The failures of a node, or the violations of a clause."""
    (failed, before), (other, after) = (
        [sum(numbers) for numbers in zip(*of, strict=True)] for of in zip(*strata, strict=True)
    )
    shares = failed / before, other / after
    # Robots that fail more often may have run more on one side: then the shares differ the other way than their own.
    agrees = (failed < expected(strata)) == (shares[0] < shares[1])
    p = exact(strata) if agrees else 1.0
    too_few = is_too_few([(one[1], two[1]) for one, two in strata], comparisons)
    return Change(*key, "failures", "%", *shares, (before, after), (failed, other), p, too_few, "")


def _key(row: Mapping[str, Any]) -> Key:
    return row["requirement"], row["clause"], row["node"]


def _centred(rows: Mapping[Unit, Mapping[str, Any]], units: Sequence[Unit], what: str) -> list[int]:
    """The scores of all units, less what each would have with the average of its stratum; as integers, exact."""
    number, total = Counter[str](), Counter[str]()
    for (_, stratum, _), row in rows.items():
        number[stratum] += row["number"]
        total[stratum] += row[what]
    scale = lcm(*number.values())
    found = [(unit[1], rows.get(unit)) for unit in units]
    return [
        (row[what] * number[stratum] - row["number"] * total[stratum]) * (scale // number[stratum]) if row else 0
        for stratum, row in found
    ]


def _judged(change: Change, p: float) -> Change:
    finding: Finding = ""
    if p <= LEVEL and change.before != change.after:
        is_more = change.after > change.before
        if change.what == "failures":
            finding = "less reliable" if is_more else "more reliable"
        elif is_time(change.unit):
            if abs(change.after - change.before) > _RESOLUTION:
                finding = "slower" if is_more else "faster"
        else:
            finding = "higher" if is_more else "lower"
    return replace(change, p=p, finding=finding)


def is_time(symbol: str) -> bool:
    """Whether a unit is one of time."""
    unit, second = parse_unit(symbol), parse_unit("s")
    return unit is not None and second is not None and unit.dimension == second.dimension


WORSE: Final = ("slower", "less reliable")
_RESOLUTION: Final = 1.5e-6  # s: the times of a log differ by it if nothing has changed
_MOST_UNITS: Final = 256  # of the smaller side: more show hardly more, and each shuffle takes as much longer
