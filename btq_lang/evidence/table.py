"""Verdicts for people at a terminal, with lines broken at its width; for other output, lines are not broken."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import zip_longest
from typing import TYPE_CHECKING, Final

from btq_lang.evidence.folding import folded, folded_sources
from btq_lang.evidence.meanings import SUSPECT
from btq_lang.evidence.node_rows import node_rows
from btq_lang.evidence.sentences import explained, headline, result, worst_violation
from btq_lang.evidence.signals import NO_SAMPLES
from btq_lang.evidence.verdicts import NEVER, OPEN, SATISFIED, UNDECIDED, UNKNOWN, VIOLATED
from btq_lang.evidence.wording import duration, first_of, period
from btq_lang.render.cells import broken, cells_of, narrowed, printable
from btq_lang.render.colour import Paint, painter
from btq_lang.util.text import counted

if TYPE_CHECKING:
    from btq_lang.evidence.verdicts import ClauseVerdict, MissionVerdicts, RequirementVerdict, Verdict, VerdictReport


def render(report: VerdictReport, colour: bool = False, verbose: bool = False, width: int | None = None) -> str:
    """The verdicts of all missions, the worst first.

    Args:
        verbose: show all that led to the worst violation of a clause, and further violations.
        width: of the terminal, at least 60 columns; None: lines are not broken.
    """
    paint = painter(colour)
    room = max(width, LEAST) if width is not None else sys.maxsize
    lines: list[str] = []
    for index, mission in enumerate(report.missions):
        notes = [printable(f"  note: {remark}") for remark in folded(report.remarks)] if index == 0 else []
        lines += _broken([*_heading(mission), *notes], room)
        rows = [*requirement_rows(mission.requirements, mission.medians, paint, verbose, room)]
        if mission.nodes and not mission.requirements:
            rows = [*rows, "", *_node_table(mission, room)]
        lines += ["", *rows, "", *_broken(_summary(mission), room), ""]
    return "\n".join(lines[:-1]) + "\n" if lines else ""


def _heading(mission: MissionVerdicts) -> Iterator[str]:
    """The mission and the logs that were read."""
    for source in folded_sources(mission.sources):
        joined_nodes = f"{source.joined} of {source.nodes} nodes"
        identity = f"{source.identity}, {joined_nodes}" if source.nodes else source.identity
        if source.joined < source.nodes:
            identity = f"{joined_nodes} joined: {source.identity}"
        runs = f"{counted(source.runs, 'run')} in {source.file}"
        if source.first_run > 1 and source.runs:
            runs += f", numbered from {source.first_run}"
        if source.begin is not None and source.end is not None:
            runs += f", {period(source.begin, source.end)}"
        yield printable(f"{runs}, mission {mission.name} ({identity})")
        if source.unjoined:
            yield printable(f"  not joined: {first_of(source.unjoined)}")
        for remark in source.remarks:
            yield printable(f"  note: {remark}")


def requirement_rows(
    requirements: Sequence[RequirementVerdict], medians: Mapping[str, float], paint: Paint, verbose: bool, room: int
) -> Iterator[str]:
    """The verdicts on requirements, in the room of some columns, the violated ones first.

    Args:
        medians: how long nodes take, in seconds by path.
        verbose: as in `render`.
    """
    rows: list[tuple[Verdict, list[str], Sequence[str]]] = []
    for requirement in sorted(requirements, key=lambda requirement: _ORDER.index(requirement.verdict)):
        title = requirement.title
        name = requirement.id
        suspect = [SUSPECT] if requirement.is_suspect else []
        for clause in sorted(requirement.clauses, key=lambda clause: _ORDER.index(clause.verdict)):
            hint = "give them with --signals FILE" if clause.why.startswith(NO_SAMPLES) else ""
            result_text = result(clause)
            if clause.idle and clause.verdict != NEVER and not _is_lone(clause, requirement):
                result_text += f", not started in {counted(clause.idle, 'run')}"
            texts = [name, title, _clause(clause, requirement), result_text, hint]
            below: Sequence[str] = [*_explanation(clause, medians, verbose)] if clause.verdict == VIOLATED else []
            rows.append((clause.verdict, [printable(text) for text in texts], [*suspect, *below]))
            name = title = ""  # shown once
            suspect.clear()
    indent = len(NEVER) + 4
    widths = [max(cells_of(row[column]) for _, row, _ in rows) if rows else 0 for column in range(4)]
    fitting = narrowed(widths, room - indent - 2 * (sum(map(bool, widths)) - 1))
    is_narrowed = fitting != widths
    for verdict, row, below in rows:
        *texts, hint = row
        cells = [broken(text, width) for text, width in zip(texts, fitting, strict=True) if width]
        if hint:
            cells[-1] = [*cells[-1], *broken(hint, fitting[-1])] if is_narrowed else [f"{cells[-1][0]}  {hint}"]
        word = paint(VERDICT_STYLES[verdict], verdict + " " * (len(NEVER) - len(verdict)))
        shown = [width for width in fitting if width]
        for number, line in enumerate(zip_longest(*cells, fillvalue="")):
            parts = [text + " " * (width - cells_of(text)) for text, width in zip(line, shown, strict=True)]
            yield f"  {' ' * len(NEVER) if number else word}  {'  '.join(parts)}".rstrip()
        yield from (f"{' ' * indent}{line}" for line in _broken(map(printable, below), room - indent))
    if not rows:
        yield "  no requirement to judge"


def _clause(clause: ClauseVerdict, requirement: RequirementVerdict) -> str:
    """The clause, with its node if the requirement has the same clause at another one."""
    return clause.text if _is_lone(clause, requirement) or not clause.path else f"{clause.text} at {clause.path}"


def _is_lone(clause: ClauseVerdict, requirement: RequirementVerdict) -> bool:
    return sum(other.text == clause.text for other in requirement.clauses) == 1


def _explanation(clause: ClauseVerdict, medians: Mapping[str, float], verbose: bool) -> Iterator[str]:
    """What to look at."""
    yield headline(clause, medians)
    if verbose and clause.violations:
        worst = worst_violation(clause)
        yield from (f"  - {link.text}" for link in worst.chain if link.kind != "self")
        others = [violation for violation in clause.violations if violation is not worst]
        yield from (explained(clause, violation, medians) for violation in others[:_FURTHER])
        if clause.violated - 1 > _FURTHER:
            yield f"… {clause.violated - 1 - _FURTHER} more; --format json has them"


def _summary(mission: MissionVerdicts) -> Iterator[str]:
    """The runs and the nodes, a line each."""
    guards = "; ".join(
        f"{number} by {'a halt' if name == '*' else f'the guard of {name}'}" for name, number in mission.ended_by
    )
    by = {"failed": f" ({guards})" if guards else ""}
    counts = (f"{number} {outcome}{by.get(outcome, '')}" for outcome, number in mission.outcomes)
    runs = [f"runs: {', '.join(counts) or 'none'}"]
    if began := sorted(mission.nodes, key=lambda node: -node.failures_began)[:_NAMED]:
        places = [f"{node.path} ({node.failures_began})" for node in began if node.failures_began]
        runs += [f"failures began at {', '.join(places)}"] if places else []
    for word, repeats in (("retries", mission.retries), ("recoveries", mission.recoveries)):
        if repeats.total:
            run = f"run {repeats.run}" if repeats.run is not None else "a run"
            runs.append(f"{word} {repeats.total}, at most {repeats.most} in {run}")
    yield " · ".join(map(printable, runs))
    yield from _nodes(mission) if mission.nodes else ()  # the summary of a store has none


def _nodes(mission: MissionVerdicts) -> Iterator[str]:
    """The nodes, in a line."""
    nodes = [f"nodes: exercised {sum(node.runs > 0 for node in mission.nodes)} of {len(mission.nodes)}"]
    if mission.contexts:
        nodes.append(f"contexts {sum(context.runs > 0 for context in mission.contexts)} of {len(mission.contexts)}")
    slowest = max((node for node in mission.nodes if node.is_leaf), key=lambda node: node.p95 or 0, default=None)
    if slowest is not None and slowest.p95 and slowest.p50 is not None:
        nodes.append(f"slowest: {slowest.path} p50 {duration(slowest.p50)}, p95 {duration(slowest.p95)}")
    blocks = max(mission.nodes, key=lambda node: node.tick_worst or 0, default=None)
    if blocks is not None and blocks.tick_p95 is not None and (worst := blocks.tick_worst or 0) >= _LONG_TICK:
        nodes.append(f"longest tick: {blocks.path} p95 {duration(blocks.tick_p95)}, worst {duration(worst)}")
    yield " · ".join(map(printable, nodes))


def _node_table(mission: MissionVerdicts, room: int) -> Iterator[str]:
    """What each node did, a line each; the paths are broken where a line has no room for them."""
    heads, rows = node_rows(mission.nodes)
    texts = [[printable(text) for text in row] for row in (heads, *rows)]
    first, *others = (max(map(cells_of, column)) for column in zip(*texts, strict=True))
    first = max(_NARROWEST, min(first, room - 2 - sum(width + 2 for width in others)))
    for path, *numbers in texts:
        *above, last = broken(path, first)
        yield from (f"  {part}" for part in above)
        cells = "".join(f"  {text.rjust(width)}" for text, width in zip(numbers, others, strict=True))
        yield f"  {last}{' ' * (first - cells_of(last))}{cells}".rstrip()


def _broken(lines: Iterable[str], room: int) -> Iterator[str]:
    return (part for line in lines for part in broken(line, room))


LEAST: Final = 60  # columns that the table needs
_NARROWEST: Final = 12  # columns of a node's path
_FURTHER: Final = 4  # violations explained in addition to the worst
_NAMED: Final = 3  # nodes where failures began
_LONG_TICK: Final = 0.01  # s, the period in which Nav2 ticks its trees
_ORDER: Final = (VIOLATED, SATISFIED, UNDECIDED, UNKNOWN, NEVER, OPEN)
VERDICT_STYLES: Final = {
    VIOLATED: "error",
    SATISFIED: "hint",
    UNDECIDED: "warning",
    UNKNOWN: "info",
    NEVER: "warning",
    OPEN: "warning",
}
