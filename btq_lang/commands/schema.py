"""`btq schema`: schemas by which other tools complete and check the XML of a project, its btq.toml, and predictions."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from importlib import resources

from btq_lang import prediction
from btq_lang.btcpp.xsd import xsd
from btq_lang.catalog.versions import VERSIONS
from btq_lang.catalog.versions import targets as engine_lines
from btq_lang.checks import check
from btq_lang.checks.engines import declared_engines
from btq_lang.commands.output import form_problem, write_output
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.diagnostics.rules import UNREADABLE, Severity
from btq_lang.projects.files import FileGroup, Files, no_mission_below, usage_problem
from btq_lang.projects.messages import CommandOutput
from btq_lang.projects.options import refuse
from btq_lang.util.record import Record, replace
from btq_lang.workspace.engine_version import written_for
from btq_lang.workspace.file import File
from btq_lang.workspace.loader import find_project, shown
from btq_lang.workspace.project_schema import project_schema
from btq_lang.workspace.workspace import Workspace


class SchemaOptions(Record):
    """The options of `btq schema`.

    Attributes:
        format: `xsd`, `project` or `simulate`.
        target: the version of the engine; None: the newest of the project.
    """

    format: str
    paths: Sequence[str]
    target: str | None
    output: str | None


def run(options: SchemaOptions, messages: CommandOutput) -> int:
    """Write a schema."""
    problem = usage_problem(options.paths) or form_problem(options.format, options.output, (options.format,))
    if options.format != "xsd" and options.paths:
        problem = f"`{options.format}` takes no path: its schema is the same for every project"
    refuse(problem)
    if options.format == "simulate":
        write_output(
            messages, options.output, resources.files(prediction).joinpath("simulate.schema.json").read_text("utf-8")
        )
        return 0
    if options.format == "project":
        write_output(messages, options.output, f"{json.dumps(project_schema(), indent=2)}\n")
        return 0
    return _write_xsd(options, messages)


def _write_xsd(options: SchemaOptions, messages: CommandOutput) -> int:
    """Write the schema of a project's nodes; of files with errors, those that can be read."""
    paths = options.paths or ["."]
    groups, problems = Files().groups(paths, with_xml=True)
    messages.problems(problems)
    if problems:
        return 2
    if empty := no_mission_below(paths, groups, "no .btq file and no BehaviorTree.CPP XML"):
        messages.remark(f"btq schema: {empty}; the schema has only the nodes of the engine")
    target = options.target or _target(groups, paths)
    # A schema is of version 4, also for files that are not.
    groups = tuple(replace(group, workspace=_of_version_4(group.workspace)) for group in groups)
    checked = [(group, path, check(group.workspace, path)) for group in groups for path in group.given]
    unknown = frozenset().union(
        *(unknown_nodes(group.workspace.files[path], diagnostics) for group, path, diagnostics in checked)
    )
    text = xsd([group.workspace for group in groups], target, unknown)
    write_output(messages, options.output, text)
    unread = [
        path for _, path, diagnostics in checked if any(diagnostic.rule in UNREADABLE for diagnostic in diagnostics)
    ]
    for path in unread:
        messages.remark(f"btq schema: {shown(path)} has errors, so nodes may be missing; run btq check")
    return int(bool(unread))


def _of_version_4(workspace: Workspace) -> Workspace:
    return workspace.with_project(replace(workspace.project, original_engines=workspace.project.engines))


def _target(groups: Iterable[FileGroup], paths: Sequence[str]) -> str:
    """The newest version of the engine that the files are written for, if it has a schema."""
    asked = [group.workspace.store.ask(declared_engines, path) for group in groups for path in group.given]
    if not asked:
        asked = [written_for(find_project(paths[0]).project, None, None)]
    targets = {(engines or VERSIONS)[-1] for engines in asked}
    return next(version for version in reversed(engine_lines()) if version in targets or version == engine_lines()[0])


def unknown_nodes(file: File, diagnostics: Iterable[Diagnostic]) -> frozenset[str]:
    """The names in a file that the checks call unknown nodes."""
    return frozenset(
        file.source[diagnostic.span.start : diagnostic.span.end].strip("\"'")
        for diagnostic in diagnostics
        if diagnostic.rule in _UNKNOWN and diagnostic.effective_severity in (Severity.ERROR, Severity.WARNING)
    )


_UNKNOWN = ("unknown-node", "not-an-engine-node")
