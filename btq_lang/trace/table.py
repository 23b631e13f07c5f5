"""Tables for a terminal: cells are broken into lines to fit its width.

One invariant: no line is wider than the terminal, down to 60 columns, and no printed text controls the terminal.
"""

from __future__ import annotations

import os.path
from collections.abc import Iterator, Mapping, Sequence
from itertools import zip_longest
from typing import Final

from btq_lang.evidence.table import VERDICT_STYLES
from btq_lang.render.cells import broken, cells_of, cut, narrowed, printable
from btq_lang.render.colour import Paint, painter
from btq_lang.trace.overview import At, ExternalRow, HazardRow, Overview, RequirementRow
from btq_lang.trace.wording import (
    GAPS,
    NO_LABEL,
    TOTALS,
    approval_lines,
    chain_rows,
    evidence_lines,
    remarks,
    shown_quality,
    shown_scenario,
    state_of,
    summary,
)


def render(overview: Overview, colour: bool = False, width: int = 120) -> str:
    """The overview for people at a terminal: requirements, concerns, gaps, totals, and a summary."""
    return "\n".join(_lines(overview, painter(colour), max(width, _LEAST))) + "\n"


def _lines(overview: Overview, paint: Paint, width: int) -> Iterator[str]:
    folder = _folder(overview)
    if folder:
        yield from (f"in {cut(printable(folder), 0, width - 4)}", "")
    chain = [(_end(row, remarks, folder), _mitigating(own)) for row, remarks, own in chain_rows(overview)]
    if chain:
        yield from _table(("Hazard or requirement of others", "Mitigated or refined by"), chain, paint, width)
        yield ""
    if overview.requirements:
        names = {each.key: each.name for each in overview.requirements}
        rows = [_requirement(each, folder, names) for each in overview.requirements]
        heading = ["Requirement", "Holds for", "How"]
        if overview.has_evidence:
            heading.append("Evidence")
            rows = [(*row, _evidence(each)) for row, each in zip(rows, overview.requirements, strict=True)]
        yield from _table(heading, rows, paint, width)
        yield ""
    builds = [
        ((each.name,), *((f"{verdict} (suspect)" if is_old else verdict,) for verdict, is_old in verdicts[-_BUILDS:]))
        for each, verdicts in overview.by_build
    ]
    if builds:
        labels = [build.label or NO_LABEL for build in overview.builds[-_BUILDS:]]
        yield from _table(("By build", *labels), builds, paint, width)
        yield ""
    nodes = {node.key: node for node in overview.nodes}
    concerns = [
        ((shown_quality(each),), [f"{nodes[key].name}, {_place(nodes[key].at, folder)}" for key in each.concerns])
        for each in overview.qualities
        if each.concerns
    ]
    if concerns:
        yield from _table(("Concern", "Nodes"), concerns, paint, width)
        yield ""
    gaps = {
        "unmitigated": [f"{each.name}, {_place(each.at, folder)}" for each in overview.unmitigated],
        "unenforced": [f"{each.name}, {_place(each.at, folder)}" for each in overview.unenforced],
        "unmeasured": [f"{shown_quality(each)}, {_place(each.at, folder)}" for each in overview.unmeasured],
        "unattached": [f"{each.name}, {_place(each.at, folder)}" for each in overview.unattached],
        "unjudged": [f"{each.name}, {_place(each.at, folder)}" for each in overview.unjudged],
        "not_passed": [
            f"{each.name}, {_place(each.at, folder)}: {shown_scenario(scenario)}"
            for each, scenario in overview.not_passed
        ],
        "sourceless": [f"{each.name}, {_place(each.at, folder)}" for each in overview.sourceless],
        "loose": [f"{each.name}, {_place(each.at, folder)}: {clause}" for each, clause in overview.loose],
        "bare_trees": [f"{each.name}, {_place(each.at, folder)}" for each in overview.bare_trees],
        "bare_nodes": [f"{each.name}, {_place(each.at, folder)}" for each in overview.bare_nodes],
    }
    for gap, lines in gaps.items():
        if lines:
            yield paint("warning", GAPS[gap])
            yield from (f"  {cut(printable(line), 0, width - 3)}" for line in lines)
            yield ""
    heading = [f"ISO/IEC 25010:{overview.edition}", *TOTALS]
    totals = [((each.name,), *((str(number or "-"),) for number in each.numbers)) for each in overview.totals]
    yield from _table(heading, totals, paint, width, numbers_from=1)
    yield ""
    yield from broken(summary(overview), width)


def _folder(overview: Overview) -> str:
    """The folder common to all places, which is then printed once."""
    places = [row.at for row in overview.requirements]
    places += [node.at for node in overview.nodes]
    places += [quality.at for quality in overview.qualities]
    folders = [at.path.rpartition("/")[0] for at in places]
    are_below = all(each and not each.startswith(("/", "..")) and ":" not in each for each in folders)
    return os.path.commonpath(folders).replace(os.sep, "/") if folders and are_below else ""


def _place(place: At, folder: str) -> str:
    return str(place).removeprefix(f"{folder}/") if folder else str(place)


def _end(row: HazardRow | ExternalRow, remarks: Sequence[str], folder: str) -> Sequence[str]:
    """A hazard or a requirement of another tool, and what is known of it."""
    return f"{row.name}, {_place(row.at, folder)}", *(f"  {line}" for line in (row.title, *remarks) if line)


def _mitigating(requirements: Sequence[RequirementRow]) -> Sequence[str]:
    return [f"{each.name}: {state_of(each)}" for each in requirements] or ("nothing",)


def _requirement(requirement: RequirementRow, folder: str, names: Mapping[str, str]) -> tuple[Sequence[str], ...]:
    subjects = [
        ", ".join((f"{use.subject}{use.arguments}", _place(use.at, folder), *remarks(requirement, use)))
        for use in requirement.uses
    ]
    lines = [
        f"{requirement.name}, {_place(requirement.at, folder)}",
        *([requirement.title] if requirement.title else []),
        *requirement.clauses,
    ]
    qualities = " and ".join((requirement.quality, *requirement.further_qualities)) if requirement.quality else ""
    lines += [f"for {qualities}"] if qualities else []
    refining = ", ".join(names[key] for key in requirement.refined_by)
    lines += [f"refined by {refining}"] if refining else []
    lines += approval_lines(requirement)
    lines[1:] = [f"  {line}" for line in lines[1:]]
    scenarios = [f"{shown_scenario(each)}, {_place(each.at, folder)}" for each in requirement.scenarios if each.at]
    return lines, subjects or ("nothing",), (*requirement.ways_in_words, *requirement.whys, *scenarios)


def _evidence(requirement: RequirementRow) -> Sequence[str]:
    lines = [line for verdict, text in evidence_lines(requirement) for line in (verdict, f"  {text}")]
    return lines or ("none",)


def _table(
    heading: Sequence[str], rows: Sequence[Sequence[Sequence[str]]], paint: Paint, width: int, numbers_from: int = 99
) -> Iterator[str]:
    """A table whose cells are lines; the first line of the first cell is the row's subject."""
    cells = [[[printable(line) for line in cell] for cell in row] for row in rows]
    widths = [
        max(cells_of(title), *(cells_of(line) for row in cells for line in row[index]))
        for index, title in enumerate(heading)
    ]
    widths = narrowed(widths, width - _BETWEEN * (len(widths) - 1))
    titles = [
        title if cells_of(title) <= room else cut(title, 0, room - 1)
        for title, room in zip(heading, widths, strict=True)
    ]
    yield _row(titles, widths, numbers_from, paint, "message")
    yield paint("gutter", _row(["-" * room for room in widths], widths, numbers_from, paint))
    for row in cells:
        in_lines = [
            [part for line in cell for part in broken(line, room)] for cell, room in zip(row, widths, strict=True)
        ]
        for index, line in enumerate(zip_longest(*in_lines, fillvalue="")):
            yield _row(line, widths, numbers_from, paint, "message" if index == 0 else "")


def _row(cells: Sequence[str], widths: Sequence[int], numbers_from: int, paint: Paint, style: str = "") -> str:
    """A line of cells; style: of its first cell."""
    parts = []
    for index, (cell, room) in enumerate(zip(cells, widths, strict=True)):
        blanks = " " * (room - cells_of(cell))
        by_people = _WAYS["reviewed"] if cell.startswith("by ") else ""
        own = _WAYS.get(cell, by_people)
        shown = paint(own or "message", cell) if own or (style and index == 0) else cell
        parts.append(blanks + shown if index >= numbers_from else shown + blanks)
    return (" " * _BETWEEN).join(parts).rstrip()


_LEAST: Final = 60
_BUILDS: Final = 5  # the last ones
_BETWEEN: Final = 2  # blanks between columns
_WAYS: Final = {
    **{"enforced": "hint", "monitored": "info", "reviewed": "warning", "not attached": "error"},
    **VERDICT_STYLES,
}
