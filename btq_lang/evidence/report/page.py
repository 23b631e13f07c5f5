"""The overview of a store as one self-contained HTML page: without script, network, fonts or other files.

One invariant: the same store gives the same bytes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from html import escape
from typing import TYPE_CHECKING, Final

from btq_lang.evidence.compare.lines import Line, by_chance, certain
from btq_lang.evidence.compare.model import WORSE, Comparison
from btq_lang.evidence.compare.words import BY_CHANCE, heading, remarks, untestable
from btq_lang.evidence.report.charts import bars, measure_charts
from btq_lang.evidence.report.parts import DOTTED, NO_NAME, REPORT_STYLE
from btq_lang.evidence.sentences import explained, result, worst_violation
from btq_lang.evidence.verdicts import NEVER, OPEN, VIOLATED, WORST_FIRST, ClauseVerdict, RequirementVerdict
from btq_lang.evidence.wording import period, share
from btq_lang.render.page_style import PAGE_STYLE
from btq_lang.util.record import replace
from btq_lang.util.text import counted

if TYPE_CHECKING:
    from btq_lang.evidence.report.overview import MissionOverview, Node, Overview, Part
    from btq_lang.evidence.report.trends import Values


def render(overview: Overview) -> str:
    """The whole page."""
    return "\n".join(_lines(overview)) + "\n"


def _lines(overview: Overview) -> Iterator[str]:
    title = escape(f"What robots did: {overview.store}")
    yield "<!DOCTYPE html>"
    yield '<html lang="en">'
    yield '<head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">'
    yield f"<title>{title}</title>"
    yield f"<style>\n{PAGE_STYLE}{REPORT_STYLE}</style></head>"
    yield "<body>"
    yield f"<header><h1>{title}</h1><p>{escape(_extent(overview))}</p></header>"
    yield "<main>"
    yield from _changes(overview)
    for mission in overview.missions:
        yield from _Mission(overview, mission).lines()
    yield "</main></body></html>"


def _extent(overview: Overview) -> str:
    """What is in the store."""
    sources = [source for mission in overview.missions for part in mission.parts for source in part.verdicts.sources]
    times = period(min(each.begin or 0 for each in sources), max(each.end or 0 for each in sources))
    labels = ", ".join(name or NO_NAME for name, _ in overview.labels[-_LABELS:])
    more = len(overview.labels) - _LABELS
    named = f"{counted(len(overview.labels), 'label')}: {f'{more} others, ' if more > 0 else ''}{labels}"
    runs = sum(each.runs for each in sources)
    return f"{runs:,} {'run' if runs == 1 else 'runs'}, {times}, {named}"


# ---- what got worse ----


def _changes(overview: Overview) -> Iterator[str]:
    sides = overview.sides
    if sides is None:
        yield f'<section id="changes"><h2>What got worse</h2>{_tiles(overview)}'
        yield "<p>All runs have the same label, so there is nothing to compare.</p></section>"
        return
    names = (sides[0] or NO_NAME, sides[1] or NO_NAME)
    first, second = map(escape, names)
    yield f'<section id="changes"><h2>What got worse from {first} to {second}</h2>{_tiles(overview)}'
    began = dict(overview.labels)
    if began[sides[0]] == began[sides[1]]:
        yield "<p>Both labels began at the same time; <code>--sides A B</code> sets their order.</p>"
    if not overview.comparisons:
        yield f"<p>No mission was run with both {first} and {second}.</p>"
    for each in overview.comparisons:
        yield from _comparison(each, names, _keys(overview, each.mission))
    yield "</section>"


def _tiles(overview: Overview) -> str:
    """The numbers of what got worse, where something is compared, and of what is violated."""
    tiles: list[tuple[str, int | str, str]] = []
    if found := overview.comparisons:
        words = [line.finding for each in found for line in certain(each)]
        tiles = [(word, words.count(word), "") for word in ("newly violated", *reversed(WORSE))]
        if all(whys := [untestable(each) for each in found if all(each.runs)]):
            tiles[-1] = (f"slower: {whys[0]}", _NOT_TESTED, "")
    last = [mission.parts[-1] for mission in overview.missions]
    requirements = sum(len(part.verdicts.requirements) for part in last)
    tiles.append(("violated now", sum(part.violated for part in last), f" of {counted(requirements, 'requirement')}"))
    items = [
        f"<li{_class('' if number in (0, _NOT_TESTED) else 'bad')}><strong>{number}</strong> {word}{of}</li>"
        for word, number, of in tiles
    ]
    return f'<ul class="tiles">{"".join(items)}</ul>'


def _comparison(comparison: Comparison, sides: tuple[str, str], keys: dict[str, str]) -> Iterator[str]:
    yield f"<p>{escape(heading(comparison, sides))}</p>"
    if not all(comparison.runs):
        return
    worse, others = ([each for each in certain(comparison) if each.is_worse is is_worse] for is_worse in (True, False))
    heads = ("Finding", "Of", "Change")
    if worse:
        rows = [_difference(each, keys) for each in worse]
        yield from _folded("changes", f"What got worse in {comparison.mission}", heads, rows)
    else:
        yield f"<p>Nothing that chance does not explain got worse in {escape(comparison.mission)}.</p>"
    for summary, caption, lines in (
        (counted(len(others), "other change"), "Other changes", others),
        (BY_CHANCE.capitalize(), BY_CHANCE.capitalize(), by_chance(comparison)),
    ):
        if lines:
            yield f"<details><summary>{summary}</summary>"
            rows = [_difference(each, keys) for each in lines]
            yield from _table("changes", f"{caption} in {comparison.mission}", heads, rows)
            yield "</details>"
    yield "<details><summary>What else was compared</summary>"
    yield from (f"<p><small>{escape(line)}</small></p>" for line in remarks(comparison, sides))
    yield "</details>"


def _difference(line: Line, keys: dict[str, str]) -> str:
    about = escape(line.name)
    if line.requirement:
        about = f"{_link(line.requirement, keys)}{about.removeprefix(escape(line.requirement))}"
    text = escape(line.text) + (f" <small>{escape(line.more)}</small>" if line.more else "")
    head = f'<th scope="row"{_class("worse" if line.is_worse else "")}>{line.finding}</th>'
    return f"<tr>{head}<td>{about}</td><td>{text}</td></tr>"


# ---- a mission ----


class _Mission:
    """The sections of a mission."""

    def __init__(self, overview: Overview, mission: MissionOverview) -> None:
        self._overview: Final = overview
        self._mission: Final = mission
        self._parts: Final = mission.parts[-_LABELS:]
        self._last: Final = mission.parts[-1]
        self._names: Final = [_name(part, overview) for part in self._parts]
        self._keys: Final = _keys(overview, mission.name)

    def lines(self) -> Iterator[str]:
        name = escape(self._mission.name)
        yield f"<section><h2>Mission {name}</h2>"
        if left := len(self._mission.parts) - len(self._parts):
            earlier = counted(left, "earlier label")
            yield f"<p>{earlier} not shown here; <code>btq verify --store DIR --by label</code> shows all.</p>"
        yield from self._requirements()
        yield from measure_charts(self._mission.measures, self._keys)
        yield from self._runs()
        yield from self._failures()
        yield from self._robots()
        yield from self._coverage()
        yield "</section>"

    def _requirements(self) -> Iterator[str]:
        yield "<h3>Requirements</h3>"
        known = [{each.id: each for each in part.verdicts.requirements} for part in self._parts]
        names = dict.fromkeys(name for found in reversed(known) for name in found)
        if not names:
            yield "<p>No requirement to judge.</p>"
            return
        last = known[-1]
        rows = []
        for name in sorted(names, key=lambda each: WORST_FIRST.index(last[each].verdict) if each in last else _LATE):
            found = [requirements.get(name) for requirements in known]
            head = next(each for each in reversed(found) if each is not None)
            values = self._mission.trends.violated.get(name, ())
            row = [_demand(head, self._keys), *map(_standing, found[:-1]), _standing(found[-1], is_last=True)]
            rows.append(self._row(row, values, share, key=self._keys[name]))
        caption = f"Verdicts, and the share of violations; {DOTTED}"
        yield from self._of_parts(caption, "Requirement", rows, "Violations")

    def _runs(self) -> Iterator[str]:
        def numbers(value: Callable[[Part], str]) -> list[str]:
            return [escape(value(part)) for part in self._parts]

        trends = self._mission.trends
        rows = [
            self._row(["Runs", *numbers(lambda part: f"{part.runs:,}")], trends.runs, _number),
            self._row(["Robots", *numbers(lambda part: f"{part.robots:,}")], (), _number),
            self._row(["Failed", *numbers(lambda part: _of(part.failed, part.runs))], trends.failed, share),
            self._row(
                ["Retries per run", *numbers(lambda part: _number(part.verdicts.retries.total / part.runs))],
                trends.retries,
                _number,
            ),
            self._row(
                ["Recoveries per run", *numbers(lambda part: _number(part.verdicts.recoveries.total / part.runs))],
                trends.recoveries,
                _number,
            ),
        ]
        yield "<h3>Runs</h3>"
        yield from self._of_parts(f"What happened in runs; {DOTTED}", "Measure", rows, "Trend")

    def _failures(self) -> Iterator[str]:
        yield "<h3>Where failures begin</h3>"
        if not self._mission.failures:
            yield "<p>No run failed.</p>"
            return

        def cells(node: Node) -> list[str]:
            runs = node.runs[-len(self._parts) :]
            return [_share(number, part.failed) for number, part in zip(runs, self._parts, strict=True)]

        rows = [self._row([_node(node), *cells(node)]) for node in self._mission.failures]
        caption = "Nodes where failures began, with their share of the failed runs"
        yield from _folded("parts", caption, self._heads("Node", ""), rows)

    def _robots(self) -> Iterator[str]:
        if "robot" not in self._overview.by:
            return
        robots = self._mission.robots
        label = f" with {_name(self._last, self._overview)}" if "label" in self._overview.by else ""
        yield f"<h3>Robots{escape(label)}</h3>"
        rows = [_robot(each, self._keys) for each in robots]
        heads = ("Robot", "Violated", "Runs", "Failed", "Retries per run", "Recoveries per run")
        yield from _folded("robots", "Robots, those with the most violated requirements first", heads, rows)

    def _coverage(self) -> Iterator[str]:
        yield "<h3>Coverage</h3>"
        judged = [[each for each in part.verdicts.requirements if each.verdict != OPEN] for part in self._parts]
        never = [[each.id for each in requirements if each.verdict == NEVER] for requirements in judged]
        rows = [
            self._row(["Nodes", *(_exercised(part) for part in self._parts)]),
            self._row(
                ["Requirements", *(_covered(len(all_), found) for all_, found in zip(judged, never, strict=True))]
            ),
        ]
        yield from self._of_parts("What was exercised", "What", rows)

        def cells(node: Node) -> list[str]:
            runs = node.runs[-len(self._parts) :]
            return [_of(number, part.runs) for number, part in zip(runs, self._parts, strict=True)]

        nodes = [self._row([_node(node), *cells(node)]) for node in self._mission.nodes]
        yield "<details><summary>In how many runs each node was active</summary>"
        yield from self._of_parts("Nodes, those that were active in the fewest runs first", "Node", nodes)
        yield "</details>"

    def _of_parts(self, caption: str, first: str, rows: Sequence[str], trend: str = "") -> Iterator[str]:
        yield from _table("parts", caption, self._heads(first, trend), rows)

    def _heads(self, first: str, trend: str) -> Sequence[str]:
        return (first, *self._names, *((f"{trend} by {self._overview.steps.name}",) if trend else ()))

    def _row(
        self,
        cells: Sequence[str],
        values: Values | None = None,
        shown: Callable[[float], str] = str,
        key: str = "",
    ) -> str:
        """A row: its head, a cell for each part, and with values their trend."""
        head, *others = cells
        last = len(others) - 1
        parts = [f'<tr id="{key}">' if key else "<tr>", f'<th scope="row">{head}</th>']
        for place, (cell, name) in enumerate(zip(others, self._names, strict=True)):
            kind = _class("last" if place == last > 0 else "")
            parts.append(f'<td{kind} data-of="{escape(name)}">{cell}</td>')
        if values is not None:
            parts.append(f"<td>{bars(values, self._overview.steps, self._overview.labels[-_LABELS:], shown)}</td>")
        return "".join((*parts, "</tr>"))


def _demand(requirement: RequirementVerdict, keys: dict[str, str]) -> str:
    texts = dict.fromkeys(clause.text for clause in requirement.clauses if clause.text)
    clauses = "".join(f"<p><code>{escape(text)}</code></p>" for text in [*texts][:_CLAUSES])
    more = f"<p>{counted(len(texts) - _CLAUSES, 'more clause')}</p>" if len(texts) > _CLAUSES else ""
    return f"{_link(requirement.id, keys)} {escape(requirement.title)}{clauses}{more}"


def _standing(requirement: RequirementVerdict | None, is_last: bool = False) -> str:
    """A verdict with the result of the worst clause; for the last part, what to look at."""
    if requirement is None:
        return '<span class="empty">not judged</span>'
    clause = _worst(requirement.clauses)
    text = escape(result(clause))
    lines = [f'<span class="verdict {clause.verdict.replace(" ", "-")}">{clause.verdict}</span>']
    if len(requirement.clauses) > 1:
        same = sum(each.verdict == clause.verdict for each in requirement.clauses)
        at = f"{escape(clause.path)}: " if clause.path else ""
        text = f"{at}{text}; {same} of {counted(len(requirement.clauses), 'clause')}"
    lines.append(f"<small>{text}</small>")
    if is_last and clause.verdict == VIOLATED and clause.violations:
        lines.append(f"<small>{escape(explained(clause, worst_violation(clause), {}))}</small>")
    return "".join(lines)


def _worst(clauses: Sequence[ClauseVerdict]) -> ClauseVerdict:
    """The worst clause, without the number of the run in its log, which means nothing beside other logs."""

    def badness(clause: ClauseVerdict) -> tuple[int, float]:
        return WORST_FIRST.index(clause.verdict), -clause.violated / max(clause.counted, 1)

    found = min(clauses, key=badness)
    return replace(found, worst=replace(found.worst, run=None)) if found.worst is not None else found


def _robot(robot: Part, keys: dict[str, str]) -> str:
    violated = [each for each in robot.verdicts.requirements if each.verdict == VIOLATED]
    items = "".join(
        f"<li>{_link(each.id, keys)} <small>{escape(result(_worst(each.clauses)))}</small></li>" for each in violated
    )
    cells = {
        "Violated": f"<ul>{items}</ul>" if items else "nothing",
        "Runs": f"{robot.runs:,}",
        "Failed": _of(robot.failed, robot.runs),
        "Retries per run": _number(robot.verdicts.retries.total / robot.runs),
        "Recoveries per run": _number(robot.verdicts.recoveries.total / robot.runs),
    }
    row = "".join(f'<td data-of="{head}">{cell}</td>' for head, cell in cells.items())
    return f'<tr><th scope="row">{escape(robot.name or NO_NAME)}</th>{row}</tr>'


def _exercised(part: Part) -> str:
    if part.exercised is None:
        return "several trees"
    number, nodes = part.exercised
    return f"{number} of {nodes}"


def _covered(number: int, never: Sequence[str]) -> str:
    text = f"{number - len(never)} of {number}"
    return f"{text}<small>never: {escape(', '.join(never))}</small>" if never else text


def _share(number: int, total: int) -> str:
    if not total:
        return "no failed run"
    width = f"{number / total:.1%}"
    return f'{_of(number, total)}<span class="share" style="width: {width}"></span>'


def _of(number: int, total: int) -> str:
    return f"{number:,} of {total:,}, {share(number / total)}" if total else "0 of 0"


def _node(node: Node) -> str:
    return f"<code>{escape(node.name or '(unknown)')}</code>"


def _name(part: Part, overview: Overview) -> str:
    return (part.name or NO_NAME) if "label" in overview.by else "All runs"


def _number(value: float) -> str:
    return f"{value:,.0f}" if value >= _LARGE or value == int(value) else f"{value:.3g}"


def _keys(overview: Overview, mission: str) -> dict[str, str]:
    """The ids of the rows of a mission's requirements on the page."""
    names = [each.name for each in overview.missions]
    (found,) = (each for each in overview.missions if each.name == mission)
    ids = dict.fromkeys(each.id for part in found.parts for each in part.verdicts.requirements)
    return {name: f"r{names.index(mission) + 1}-{number}" for number, name in enumerate(ids, 1)}


def _link(name: str, keys: dict[str, str]) -> str:
    return f'<a class="name" href="#{keys[name]}">{escape(name)}</a>'


def _folded(kind: str, caption: str, heads: Sequence[str], rows: Sequence[str]) -> Iterator[str]:
    """A table, whose later rows are folded if there are many."""
    yield from _table(kind, caption, heads, rows[:_ROWS])
    if more := rows[_ROWS:]:
        yield f"<details><summary>{len(more)} more</summary>"
        yield from _table(kind, f"{caption}, continued", heads, more)
        yield "</details>"


def _table(kind: str, caption: str, heads: Sequence[str], rows: Sequence[str]) -> Iterator[str]:
    yield f'<table class="{kind}"><caption>{escape(caption)}</caption>'
    cells = "".join(f'<th scope="col">{escape(head)}</th>' for head in heads)
    yield f"<thead><tr>{cells}</tr></thead><tbody>"
    yield from rows
    yield "</tbody></table>"


def _class(name: str) -> str:
    return f' class="{name}"' if name else ""


_LABELS: Final = 4  # with a column of their own
_ROWS: Final = 10
_CLAUSES: Final = 3
_LARGE: Final = 1000
_NOT_TESTED: Final = "–"
_NOTHING: Final = 1e-9
_LATE: Final = len(WORST_FIRST)
