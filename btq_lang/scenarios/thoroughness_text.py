"""How thorough scenarios are, for people: outcomes that none has met, and changes that none notices, by line."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from btq_lang.render.cells import printable
from btq_lang.scenarios.results import CoverageReport, MutantReport, MutantResult, OutcomePlace
from btq_lang.util.grouping import grouped
from btq_lang.util.text import counted


def coverage_summary(report: CoverageReport) -> str:
    """How many outcomes have been met."""
    number = sum(len(node.outcomes) for node in report.nodes)
    met = number - sum(len(node.unmet) for node in report.nodes)
    nodes = counted(len(report.nodes), "node")
    return f"{met} of {counted(number, 'outcome')} of {nodes}"


def coverage_lines(report: CoverageReport) -> Iterator[str]:
    """How many outcomes have been met, and which have not."""
    yield f"coverage: {coverage_summary(report)}"
    rows = [(node.place, f"never {', '.join(node.unmet)}") for node in report.nodes if node.unmet]
    yield from _table([*rows, *((place, "runs in no scenario") for place in report.unused)])


def mutant_summary(report: MutantReport) -> str:
    """How many changes have been noticed."""
    number = len(report.mutants)
    of_all = f", an even sample of {report.number}" if number < report.number else ""
    return f"{sum(bool(mutant.noticed_by) for mutant in report.mutants)} of {number} noticed{of_all}"


def mutant_lines(report: MutantReport) -> Iterator[str]:
    """How many changes have been noticed, and which have not."""
    yield f"mutants: {mutant_summary(report)}"
    yield from _table((mutant.place, what_changed(mutant)) for mutant in report.mutants if not mutant.noticed_by)


def what_changed(mutant: MutantResult) -> str:
    """The change, and that nothing reaches it."""
    return mutant.what if mutant.is_reached else f"{mutant.what} (not reached)"


def _table(rows: Iterable[tuple[OutcomePlace, str]]) -> Iterator[str]:
    """Rows by file: the line, the node, a text."""
    for file, of_file in grouped((place.file, (place, text)) for place, text in rows).items():
        yield printable(file)
        width = max(len(place.node) for place, _ in of_file)
        for place, text in sorted(of_file, key=lambda row: row[0].position):
            yield printable(f"{place.line:>6}  {place.node.ljust(width)}  {text}")
