"""The results of scenarios as a page: what came of each, and, line by line, how thorough they are."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from textwrap import dedent
from typing import TYPE_CHECKING, Final

from btq_lang.render.colour import painter
from btq_lang.render.pages import page
from btq_lang.scenarios.results import CoverageReport, MutantReport, Outcome, OutcomePlace, ScenarioReport
from btq_lang.scenarios.text import counts, scenario_lines
from btq_lang.scenarios.thoroughness_text import coverage_summary, mutant_summary, what_changed
from btq_lang.util.grouping import grouped

if TYPE_CHECKING:
    from btq_lang.render.pages import PageData


def render(report: ScenarioReport, colour: bool = False) -> str:
    """The page, which always has colours."""
    sections = []
    if report.coverage is not None:
        sections.append(_coverage(report.coverage))
    if report.mutants is not None:
        sections.append(_mutants(report.mutants))
    plain = painter(False)
    scenarios = [
        {
            "title": each.title,
            "where": f"{each.file}:{each.line}",
            "outcome": each.outcome,
            "style": _STYLES[each.outcome],
            "lines": dedent("\n".join([*scenario_lines(each, plain)][1:])),
        }
        for each in report.scenarios
    ]
    return page(
        "scenarios/page.html.j2", title="Scenarios", summary=counts(report), scenarios=scenarios, sections=sections
    )


def _coverage(report: CoverageReport) -> PageData:
    rows = [
        (node.place, ", ".join(node.unmet), ", ".join(each.outcome for each in node.outcomes if each.scenarios))
        for node in report.nodes
    ]
    rows += [(place, "runs in no scenario", "") for place in report.unused]
    heads = "Line", "Node", "No scenario has met", "Met"
    return {"title": "Coverage", "summary": coverage_summary(report), "heads": heads, "files": [*_by_file(rows)]}


def _mutants(report: MutantReport) -> PageData:
    rows = [
        (mutant.place, "", f"{mutant.what}: {mutant.noticed_by}")
        if mutant.noticed_by
        else (mutant.place, what_changed(mutant), "")
        for mutant in report.mutants
    ]
    heads = "Line", "Node", "No scenario notices", "Noticed by"
    return {"title": "Mutants", "summary": mutant_summary(report), "heads": heads, "files": [*_by_file(rows)]}


def _by_file(rows: Iterable[tuple[OutcomePlace, str, str]]) -> Iterator[tuple[str, list[tuple[int, str, str, str]]]]:
    in_order = sorted(rows, key=lambda row: row[0].position)
    files = grouped((place.file, (place.line, place.node, missed, met)) for place, missed, met in in_order)
    yield from files.items()


_STYLES: Final[dict[Outcome, str]] = {
    "passed": "satisfied",
    "failed": "violated",
    "unknown": "unknown",
    "error": "violated",
}
