"""Project files that `btq check` is asked for: those that a command line names, and what is wrong with `external`.

One invariant: without a check of the whole folder of the project file nothing is reported about `external`.
"""

from __future__ import annotations

import os
from collections.abc import Collection, Iterable, Iterator

from btq_lang.catalog.name_kinds import Kind
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.diagnostics.rules import Severity
from btq_lang.projects.files import FileGroup
from btq_lang.render import Finding
from btq_lang.util.text import LineIndex, Span
from btq_lang.util.toml_places import find_key
from btq_lang.workspace.config import configured, keys_above
from btq_lang.workspace.file import SIDE_SUFFIX, SUFFIXES, XML_SUFFIXES, YAML_SUFFIXES, is_xml
from btq_lang.workspace.loader import LoadProblem, absolute, find_project, is_project_file, read

CHECKED = (*SUFFIXES, *XML_SUFFIXES, *YAML_SUFFIXES)


def named_project_files(paths: Iterable[str]) -> tuple[tuple[str, ...], tuple[LoadProblem, ...]]:
    """The project files among some paths that are no missions, and why the others are not checked."""
    named = tuple(map(absolute, paths))
    reasons = ((path, _why_unchecked(path)) for path in named)
    problems = tuple(LoadProblem(path, reason) for path, reason in reasons if reason is not None)
    refused = {problem.path for problem in problems}
    return tuple(path for path in named if is_project_file(path) and path not in refused), problems


def _why_unchecked(path: str) -> str | None:
    """Why a file is not checked, if it is neither a project file nor a mission."""
    text, problem = read(path)
    if text is None or is_xml(path, text):
        return problem.message if problem is not None else None
    if is_project_file(path):
        counts = find_project(path).path
        if counts == path:
            return None
        is_beside = counts is not None and os.path.dirname(counts) == os.path.dirname(path)
        return (
            "is not read, because btq.toml beside it is" if is_beside else "has no [tool.btq], where btq reads settings"
        )
    if path.endswith(SIDE_SUFFIX):
        return f"is what a build writes; check {os.path.basename(path).removesuffix(SIDE_SUFFIX)}.xml beside it"
    return f"cannot be checked; expected a folder, btq.toml, or a file that ends in {', '.join(CHECKED)}"


def unused_external(groups: Iterable[FileGroup], paths: Collection[str]) -> Iterator[Finding]:
    """A hint for each entry of `external` that nothing needs, in its project file; `paths`: what is checked."""
    requested = {absolute(path).rstrip("/") for path in paths}
    by_file: dict[str, list[FileGroup]] = {}
    for group in groups:
        if group.project_file is not None and group.project.external and group.project.root in requested:
            by_file.setdefault(group.project_file, []).append(group)
    for path, members in by_file.items():
        files = [group.workspace.files[requested_path] for group in members for requested_path in group.given]
        run = {name for file in files for name in file.names_used(Kind.TREE)}
        own = {name for file in files for name in file.names_of(Kind.TREE)}
        text = read(path)[0] or ""
        for name in members[0].project.external:
            if name not in run or name in own:
                position = find_key(text, (*keys_above(path), "external"), name)
                start = LineIndex(text).offset(position) if position is not None else 0
                why = "a file of the project defines it" if name in own else "no SubTree of the project runs it"
                message = f"`{name}` need not be in `external`: {why}"
                span = Span(start, start + len(name) + 2)
                hint = Diagnostic("unknown-tree", span, message, severity=Severity.HINT)
                yield from (
                    Finding(path, text, diagnostic) for diagnostic in configured(members[0].project, path, (hint,))
                )
