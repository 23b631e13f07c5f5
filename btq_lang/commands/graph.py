"""`btq graph`: draw a mission's trees."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from btq_lang.checks import check
from btq_lang.commands.output import form_of, form_problem, write_output
from btq_lang.diagnostics.rules import UNREADABLE
from btq_lang.graph import FORMATS, draw
from btq_lang.graph.missions import figures
from btq_lang.projects.files import Files, no_mission_below, usage_problem
from btq_lang.projects.messages import CommandOutput
from btq_lang.projects.options import Refused, refuse
from btq_lang.render import Finding, Report, render, with_paths
from btq_lang.requirements.resolve import requirements
from btq_lang.util.record import Record
from btq_lang.workspace.loader import LoadProblem, shown

if TYPE_CHECKING:
    from btq_lang.graph.figure import Figure
    from btq_lang.projects.files import FileGroup
    from btq_lang.workspace.workspace import Workspace


class GraphOptions(Record):
    """The options of `btq graph`.

    Attributes:
        paths: the one file to draw.
        qualities: show qualities and requirements beside their nodes.
        evidence: the paths of logs, stores and files of verdicts.
        direction: the position of the children, in DIRECTIONS.
    """

    paths: Sequence[str]
    stdin_filename: str | None
    format: str | None
    qualities: bool
    evidence: Sequence[str]
    direction: str
    output: str | None


def run(options: GraphOptions, messages: CommandOutput) -> int:
    """Draw the trees of one file; of a file with errors, all valid parts."""
    refuse(usage_problem(options.paths) or form_problem(options.format, options.output, FORMATS))
    groups, problems = Files().groups(options.paths, options.stdin_filename)
    requested = [(group.workspace, path) for group in groups for path in group.given]
    if len(options.paths) == 1:  # in a folder, the scenarios of a mission are beside it
        with_trees = [
            (workspace, path) for workspace, path in requested if not workspace.files[path].has_only_scenarios
        ]
        requested = with_trees or requested
    if len(requested) > 1:
        problems += (LoadProblem(requested[1][1], "expected one file to draw, found more"),)
    messages.problems(problems)
    refuse(no_mission_below(options.paths, groups))
    if problems or not requested:
        return 2
    ((workspace, path),) = requested
    drawn = _figures(options, groups, workspace, path)
    if not drawn:
        raise Refused(f"{shown(path)} has no trees")
    form = form_of(options.format, options.output, FORMATS)
    write_output(messages, options.output, draw(drawn, form, options.direction))
    unread = [diagnostic for diagnostic in check(workspace, path) if diagnostic.rule in UNREADABLE]
    if unread:
        text = workspace.files[path].source
        report = Report(tuple([Finding(path, text, diagnostic) for diagnostic in unread]), {path: text}, (path,))
        messages.add("".join(render("concise", with_paths(report, shown))), "remark")
        messages.remark("btq graph: the picture shows only what could be read")
    return int(bool(unread))


def _figures(options: GraphOptions, groups: Sequence[FileGroup], workspace: Workspace, path: str) -> Sequence[Figure]:
    """The trees, with the verdicts on their requirements if evidence is given."""
    if not options.evidence:
        return figures(workspace, path, options.qualities)
    from btq_lang.commands.given_evidence import verdicts_for  # it imports the readers of logs
    from btq_lang.evidence.boxes import measured_by

    problems: list[str] = []
    verdicts_of = verdicts_for(options.evidence, groups, problems)
    refuse(*problems)
    assert verdicts_of is not None, "evidence is given"
    return figures(workspace, path, True, measured_by(requirements(workspace, path), verdicts_of(path)))
