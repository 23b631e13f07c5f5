"""The overview of a store as one self-contained HTML page: without script, network, fonts or other files.

One invariant: the same store gives the same bytes.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Final

from btq_lang.evidence.compare.lines import BY_CHANCE, DifferenceLine, by_chance, certain, heading, remarks, untestable
from btq_lang.evidence.compare.model import WORSE, RunComparison
from btq_lang.evidence.meanings import SUSPECT
from btq_lang.evidence.report.charts import NO_NAME, bars, measure_figures
from btq_lang.evidence.sentences import explained, result, worst_violation
from btq_lang.evidence.verdicts import NEVER, OPEN, VIOLATED, WORST_FIRST, ClauseVerdict, RequirementVerdict
from btq_lang.evidence.wording import period, share
from btq_lang.render.pages import PageData, page
from btq_lang.util.record import Record, replace
from btq_lang.util.text import counted

if TYPE_CHECKING:
    from btq_lang.evidence.report.overview import MissionOverview, ReportedNode, RunGroup, StoreOverview
    from btq_lang.evidence.report.trends import Values


def render(overview: StoreOverview) -> str:
    """The whole page."""
    return page(
        "evidence/report/page.html.j2",
        title=f"What robots did: {overview.store}",
        extent=_extent(overview),
        tiles=_tiles(overview),
        changes=_changes(overview),
        missions=[_Mission(overview, mission).values() for mission in overview.missions],
    )


def _extent(overview: StoreOverview) -> str:
    """What is in the store."""
    sources = [source for mission in overview.missions for part in mission.parts for source in part.verdicts.sources]
    times = period(min(source.begin or 0 for source in sources), max(source.end or 0 for source in sources))
    labels = ", ".join(name or NO_NAME for name, _ in overview.labels[-_LABELS:])
    more = len(overview.labels) - _LABELS
    named = f"{counted(len(overview.labels), 'label')}: {f'{more} others, ' if more > 0 else ''}{labels}"
    runs = sum(source.runs for source in sources)
    return f"{runs:,} {'run' if runs == 1 else 'runs'}, {times}, {named}"


# ---- what got worse ----


def _tiles(overview: StoreOverview) -> list[tuple[str, int | str, str]]:
    """How many things got worse, where something is compared, and how many requirements are violated: class, number and
    words.
    """
    tiles: list[tuple[int | str, str]] = []
    if compared := overview.comparisons:
        findings = [line.finding for comparison in compared for line in certain(comparison)]
        tiles = [(findings.count(word), word) for word in ("newly violated", *reversed(WORSE))]
        if all(whys := [untestable(comparison) for comparison in compared if all(comparison.runs)]):
            tiles[-1] = (_NOT_TESTED, f"slower: {whys[0]}")
    last = [mission.parts[-1] for mission in overview.missions]
    requirements = counted(sum(len(part.verdicts.requirements) for part in last), "requirement")
    tiles.append((sum(part.violated for part in last), f"violated now of {requirements}"))
    return [("" if number in (0, _NOT_TESTED) else "bad", number, words) for number, words in tiles]


def _changes(overview: StoreOverview) -> PageData | None:
    """What changed between two labels; None if there is one."""
    if overview.sides is None:
        return None
    first, second = overview.sides
    sides = (first or NO_NAME, second or NO_NAME)
    began = dict(overview.labels)
    return {
        "sides": sides,
        "began_at_once": began[first] == began[second],
        "missions": [_comparison(each, sides, _keys(overview, each.mission)) for each in overview.comparisons],
    }


def _comparison(comparison: RunComparison, sides: tuple[str, str], keys: dict[str, str]) -> PageData:
    lines = certain(comparison) if all(comparison.runs) else ()
    worse, others = ([line for line in lines if line.is_worse is is_worse] for is_worse in (True, False))
    chance = BY_CHANCE.capitalize()
    folded = (
        (counted(len(others), "other change"), "Other changes", others),
        (chance, chance, by_chance(comparison) if all(comparison.runs) else ()),
    )
    return {
        "heading": heading(comparison, sides),
        "mission": comparison.mission,
        "is_compared": all(comparison.runs),
        "worse": _folded([_difference(line, keys) for line in worse]),
        "folded": [
            (summary, f"{caption} in {comparison.mission}", [_difference(line, keys) for line in lines])
            for summary, caption, lines in folded
            if lines
        ],
        "remarks": [*remarks(comparison, sides)],
    }


def _difference(line: DifferenceLine, keys: dict[str, str]) -> PageData:
    name = line.requirement or ""
    return {"line": line, "name": name, "key": keys.get(name, ""), "about": line.name.removeprefix(name)}


# ---- a mission ----


class Cell(Record):
    """What a cell of a table has, one below the other: a verdict, a text, further lines, and a bar of some width."""

    text: str = ""
    verdict: str = ""
    lines: tuple[str, ...] = ()
    share: str = ""


class _Mission:
    """The sections of a mission."""

    def __init__(self, overview: StoreOverview, mission: MissionOverview) -> None:
        self._overview: Final = overview
        self._mission: Final = mission
        self._parts: Final = mission.parts[-_LABELS:]
        self._last: Final = mission.parts[-1]
        self._names: Final = [_name(part, overview) for part in self._parts]
        self._keys: Final = _keys(overview, mission.name)

    def values(self) -> PageData:
        hidden = len(self._mission.parts) - len(self._parts)
        return {
            "name": self._mission.name,
            "earlier": counted(hidden, "earlier label") if hidden else "",
            "heads": {
                "requirements": self._heads("Requirement", f"Violations by {self._overview.steps.name}"),
                "runs": self._heads("Measure", f"Trend by {self._overview.steps.name}"),
                "nodes": self._heads("Node"),
                "coverage": self._heads("What"),
            },
            "requirements": self._requirements(),
            "measures": measure_figures(self._mission.measures, self._keys),
            "runs": self._runs(),
            "failures": self._failures(),
            "robots": self._robots(),
            "coverage": self._coverage(),
            "nodes": self._nodes(),
        }

    def _heads(self, first: str, *trend: str) -> Sequence[str]:
        return (first, *self._names, *trend)

    def _requirements(self) -> list[PageData]:
        by_part = [{requirement.id: requirement for requirement in part.verdicts.requirements} for part in self._parts]
        last = by_part[-1]
        names = dict.fromkeys(name for requirements in reversed(by_part) for name in requirements)
        rows = []
        for name in sorted(names, key=lambda name: WORST_FIRST.index(last[name].verdict) if name in last else _LATE):
            of_parts = [requirements.get(name) for requirements in by_part]
            cells = [*map(_standing, of_parts[:-1]), _standing(of_parts[-1], is_last=True)]
            head = next(verdict for verdict in reversed(of_parts) if verdict is not None)
            values = self._mission.trends.violated.get(name, ())
            rows.append({**_demand(head, self._keys), **self._row(cells, values, share)})
        return rows

    def _runs(self) -> list[PageData]:
        def row(
            head: str, value: Callable[[RunGroup], str], values: Values, shown: Callable[[float], str] = _number
        ) -> PageData:
            return {"head": head, **self._row([Cell(value(part)) for part in self._parts], values, shown)}

        trends = self._mission.trends
        return [
            row("Runs", lambda part: f"{part.runs:,}", trends.runs),
            row("Robots", lambda part: f"{part.robots:,}", ()),
            row("Failed", lambda part: _of(part.failed, part.runs), trends.failed, share),
            row("Retries per run", lambda part: _number(part.verdicts.retries.total / part.runs), trends.retries),
            row(
                "Recoveries per run",
                lambda part: _number(part.verdicts.recoveries.total / part.runs),
                trends.recoveries,
            ),
        ]

    def _failures(self) -> PageData:
        def cell(number: int, part: RunGroup) -> Cell:
            if not part.failed:
                return Cell("no failed run")
            return Cell(_of(number, part.failed), share=f"{number / part.failed:.1%}")

        return _folded([self._of_node(node, cell) for node in self._mission.failures])

    def _robots(self) -> PageData | None:
        """None if the runs are not parted by robots."""
        if "robot" not in self._overview.by:
            return None
        label = f" with {_name(self._last, self._overview)}" if "label" in self._overview.by else ""
        return {"label": label, **_folded([_robot(robot, self._keys) for robot in self._mission.robots])}

    def _coverage(self) -> list[PageData]:
        judged = [
            [requirement for requirement in part.verdicts.requirements if requirement.verdict != OPEN]
            for part in self._parts
        ]
        return [
            {"head": "Nodes", **self._row([Cell(_exercised(part)) for part in self._parts])},
            {"head": "Requirements", **self._row([*map(_covered, judged)])},
        ]

    def _nodes(self) -> list[PageData]:
        return [self._of_node(node, lambda number, part: Cell(_of(number, part.runs))) for node in self._mission.nodes]

    def _of_node(self, node: ReportedNode, cell: Callable[[int, RunGroup], Cell]) -> PageData:
        runs = node.runs[-len(self._parts) :]
        return {"head": node.name or "(unknown)", **self._row([*map(cell, runs, self._parts)])}

    def _row(
        self, cells: Sequence[Cell | None], values: Values | None = None, shown: Callable[[float], str] = str
    ) -> PageData:
        """The cells of a row, one for each part, None where nothing is judged, and with values their trend."""
        last = len(cells) - 1
        kinds = ("last" if place == last > 0 else "" for place in range(len(cells)))
        labels = self._overview.labels[-_LABELS:]
        return {
            "cells": [*zip(kinds, self._names, cells, strict=True)],
            "trend": None if values is None else bars(values, self._overview.steps, labels, shown),
        }


def _demand(requirement: RequirementVerdict, keys: dict[str, str]) -> PageData:
    texts = [*dict.fromkeys(clause.text for clause in requirement.clauses if clause.text)]
    return {
        "requirement": requirement,
        "key": keys[requirement.id],
        "clauses": texts[:_CLAUSES],
        "more": counted(len(texts) - _CLAUSES, "more clause") if len(texts) > _CLAUSES else "",
    }


def _standing(requirement: RequirementVerdict | None, is_last: bool = False) -> Cell | None:
    """A verdict with the result of the worst clause; for the last part, what to look at; None if it is not judged."""
    if requirement is None:
        return None
    clause = _worst(requirement.clauses)
    text = result(clause)
    if len(requirement.clauses) > 1:
        same = sum(other.verdict == clause.verdict for other in requirement.clauses)
        place = f"{clause.path}: " if clause.path else ""
        text = f"{place}{text}; {same} of {counted(len(requirement.clauses), 'clause')}"
    is_explained = is_last and clause.verdict == VIOLATED and clause.violations
    more = (explained(clause, worst_violation(clause), {}),) if is_explained else ()
    suspect = (SUSPECT,) if requirement.is_suspect else ()
    return Cell(verdict=clause.verdict, lines=(text, *suspect, *more))


def _worst(clauses: Sequence[ClauseVerdict]) -> ClauseVerdict:
    """The worst clause, without the number of the run in its log, which means nothing beside other logs."""

    def badness(clause: ClauseVerdict) -> tuple[int, float]:
        return WORST_FIRST.index(clause.verdict), -clause.violated / max(clause.counted, 1)

    worst = min(clauses, key=badness)
    return replace(worst, worst=replace(worst.worst, run=None)) if worst.worst is not None else worst


def _robot(robot: RunGroup, keys: dict[str, str]) -> PageData:
    violated = [requirement for requirement in robot.verdicts.requirements if requirement.verdict == VIOLATED]
    return {
        "head": robot.name or NO_NAME,
        "violated": [
            (keys[requirement.id], requirement.id, result(_worst(requirement.clauses))) for requirement in violated
        ],
        "numbers": (
            ("Runs", f"{robot.runs:,}"),
            ("Failed", _of(robot.failed, robot.runs)),
            ("Retries per run", _number(robot.verdicts.retries.total / robot.runs)),
            ("Recoveries per run", _number(robot.verdicts.recoveries.total / robot.runs)),
        ),
    }


def _exercised(part: RunGroup) -> str:
    if part.exercised is None:
        return "several trees"
    number, nodes = part.exercised
    return f"{number} of {nodes}"


def _covered(judged: Sequence[RequirementVerdict]) -> Cell:
    never = [requirement.id for requirement in judged if requirement.verdict == NEVER]
    text = f"{len(judged) - len(never)} of {len(judged)}"
    return Cell(text, lines=(f"never: {', '.join(never)}",) if never else ())


def _of(number: int, total: int) -> str:
    return f"{number:,} of {total:,}, {share(number / total)}" if total else "0 of 0"


def _name(part: RunGroup, overview: StoreOverview) -> str:
    return (part.name or NO_NAME) if "label" in overview.by else "All runs"


def _number(value: float) -> str:
    return f"{value:,.0f}" if value >= _LARGE or value == int(value) else f"{value:.3g}"


def _keys(overview: StoreOverview, mission: str) -> dict[str, str]:
    """The ids of the rows of a mission's requirements on the page."""
    names = [mission_overview.name for mission_overview in overview.missions]
    (of_name,) = (mission_overview for mission_overview in overview.missions if mission_overview.name == mission)
    ids = dict.fromkeys(requirement.id for part in of_name.parts for requirement in part.verdicts.requirements)
    return {name: f"r{names.index(mission) + 1}-{number}" for number, name in enumerate(ids, 1)}


def _folded(rows: Sequence[PageData]) -> PageData:
    """The rows of a table, the later ones folded if there are many."""
    return {"first": rows[:_ROWS], "more": rows[_ROWS:]}


_LABELS: Final = 4  # with a column of their own
_ROWS: Final = 10
_CLAUSES: Final = 3
_LARGE: Final = 1000
_NOT_TESTED: Final = "–"
_LATE: Final = len(WORST_FIRST)
