"""Trees that a project file calls external, and that no tree of the project runs.

One invariant: without a check of the whole folder of the project file nothing is reported.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator

from btq_lang.catalog.name_kinds import Kind
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.diagnostics.rules import Severity
from btq_lang.projects.files import FileGroup
from btq_lang.render import Finding
from btq_lang.util.text import LineIndex, Span
from btq_lang.util.toml_places import find_key
from btq_lang.workspace.config import configured, keys_above
from btq_lang.workspace.loader import absolute, read


def unused_external(groups: Iterable[FileGroup], paths: Collection[str]) -> Iterator[Finding]:
    """A hint for each entry of `external` that nothing needs, in its project file; `paths`: what is checked."""
    requested = {absolute(path).rstrip("/") for path in paths}
    by_file: dict[str, list[FileGroup]] = {}
    for group in groups:
        if group.project_file is not None and group.project.external and group.project.root in requested:
            by_file.setdefault(group.project_file, []).append(group)
    for path, members in by_file.items():
        files = [each.workspace.files[given] for each in members for given in each.given]
        run = {name for file in files for name in file.names_used(Kind.TREE)}
        own = {name for file in files for name in file.names_of(Kind.TREE)}
        text = read(path)[0] or ""
        for name in members[0].project.external:
            if name not in run or name in own:
                position = find_key(text, (*keys_above(path), "external"), name)
                start = LineIndex(text).offset(position) if position is not None else 0
                why = "a file of the project defines it" if name in own else "no SubTree of the project runs it"
                message = f"`{name}` need not be in `external`: {why}"
                found = Diagnostic("unknown-tree", Span(start, start + len(name) + 2), message, severity=Severity.HINT)
                yield from (Finding(path, text, each) for each in configured(members[0].project, path, (found,)))
