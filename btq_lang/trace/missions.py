"""The overview of missions as built, with what the engine enforces of their requirements."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from btq_lang.btcpp.export import is_mission
from btq_lang.btcpp.outputs import as_xml, loaded_files
from btq_lang.checks import check_each
from btq_lang.diagnostics.rules import Severity
from btq_lang.requirements.resolve import Requirements
from btq_lang.trace import write
from btq_lang.trace.collect import collect
from btq_lang.trace.overview import Clause, Overview
from btq_lang.trace.ways import declared_ways
from btq_lang.util.record import Record, replace
from btq_lang.workspace.loader import shown
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:
    from btq_lang.trace.collect import BoxDetails, BuildsOf, VerdictsOf


class TraceTable(Record):
    """The result of `btq trace`.

    Attributes:
        overview: the rows: requirements, qualities, nodes, trees, and totals.
    """

    overview: Overview

    @property
    def errors(self) -> int:
        """How many errors the missions have; with any, rows may be missing."""
        return self.overview.errors

    def write(self, form: str = "table", *, colour: bool = False, width: int = 120) -> str:
        """Write the table as text.

        Args:
            form: `table`, `csv`, `json`, `markdown`, `html` or `needs-json`.
            colour: ANSI colours, for `table`.
            width: the columns of the terminal, for `table`.

        Raises:
            ValueError: there is no such format.
        """
        return write(self.overview, form, colour=colour, width=width)


def trace_table(workspace: Workspace, *paths: str, bundle: bool = False) -> TraceTable:
    """Which requirements hold for which nodes, how they are enforced, and what is missing.

        >>> from btq_lang import Workspace, trace_table
        >>> text = 'QualityReq rq1 "In time"\\n    takes at most 30 s\\nBehaviorTree Main\\n    Dock satisfies rq1\\n'
        >>> table = trace_table(Workspace.of({"main.btq": text}), "main.btq")
        >>> [(row.name, row.way) for row in table.overview.requirements]
        [('rq1', 'monitored')]

    Args:
        paths: the missions in the workspace, each with all its includes; none: all files.
        bundle: determine enforcement as built with each mission and its includes in one file.

    Raises:
        KeyError: there is no such file.
    """
    return trace_tables([(workspace, paths or tuple(workspace.files))], bundle)


def trace_tables(
    parts: Sequence[tuple[Workspace, Sequence[str]]],
    bundled: bool = False,
    details_of: BoxDetails | None = None,
    verdicts_of: VerdictsOf | None = None,
    builds_of: BuildsOf | None = None,
) -> TraceTable:
    """The table of missions of several workspaces.

    Args:
        parts: workspaces, each with the requested paths in it.
        bundled: they are built with all their includes.
        details_of, verdicts_of, builds_of: as in `collect`.
    """
    parts = [(workspace, loaded_files(workspace, requested) or requested) for workspace, requested in parts]
    errors = {path: number for workspace, requested in parts for path, number in _errors(workspace, requested)}
    broken = frozenset(path for path, number in errors.items() if number)

    def ways(workspace: Workspace, path: str, resolved: Requirements) -> Sequence[Sequence[Clause]]:
        if not broken.isdisjoint(workspace.closure(path)):
            return declared_ways(workspace, path, resolved, "btq build writes nothing for a mission with errors")
        is_built = is_mission(workspace, path)
        return built_ways(workspace, path, resolved, bundled) if is_built else declared_ways(workspace, path, resolved)

    overview = collect(parts, ways, shown, details_of, verdicts_of, builds_of)
    return TraceTable(replace(overview, errors=sum(errors.values())))


def built_ways(
    workspace: Workspace, path: str, resolved: Requirements, bundled: bool = False
) -> Sequence[Sequence[Clause]]:
    """How clauses are covered in the output of `btq build`, or as declared if the mission cannot be built."""
    declared = declared_ways(workspace, path, resolved)
    enforced = as_xml(workspace, path, bundled=bundled).clauses
    if not enforced:
        return declared
    # A requirement without measurable clauses has nothing to cover.
    return [
        tuple(Clause(each.clause, each.way, each.why, each.asked) for each in clauses) or otherwise
        for clauses, otherwise in zip(enforced, declared, strict=True)
    ]


def _errors(workspace: Workspace, requested: Sequence[str]) -> list[tuple[str, int]]:
    """How many errors each file has, included files too."""
    paths = dict.fromkeys(path for each in requested for path in workspace.closure(each))
    checked = zip(paths, check_each(workspace, paths), strict=True)
    return [(path, sum(each.effective_severity is Severity.ERROR for each in of_file)) for path, of_file in checked]
