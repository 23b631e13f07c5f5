"""`btq approve`: write who has approved a requirement, when, and the fingerprint of what was approved."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from datetime import date

from btq_lang.catalog.name_kinds import Kind
from btq_lang.projects.files import FileGroup, Files, usage_problem
from btq_lang.projects.messages import CommandOutput
from btq_lang.projects.options import refuse
from btq_lang.requirements.approval import approval_state
from btq_lang.requirements.approving import with_approval
from btq_lang.requirements.metadata import is_date
from btq_lang.syntax.tree import Requirement
from btq_lang.util.record import Record
from btq_lang.util.spelling import did_you_mean, near
from btq_lang.util.text import counted
from btq_lang.workspace.file import Definition
from btq_lang.workspace.loader import LoadProblem, shown, write_whole
from btq_lang.workspace.symbols import same_requirement
from btq_lang.workspace.workspace import Workspace


class ApproveOptions(Record):
    """The options of `btq approve`; date: None for today."""

    ids: Sequence[str]
    by: str
    paths: Sequence[str] | None
    date: str | None


def run(options: ApproveOptions, messages: CommandOutput) -> int:
    """Write an approval of each requirement; nothing at all if one of them cannot be approved."""
    paths = options.paths or (".",)
    on = options.date or date.today().isoformat()
    refuse(usage_problem(paths), None if options.by.strip() else "--by needs a name")
    refuse(None if is_date(on) else f"--date {on}: expected a date as 2026-11-29")
    groups, problems = Files().groups(paths)
    texts: dict[str, tuple[str, str]] = {}  # of each file: as it is on the disk, and as it will be
    approved: list[str] = []
    refused: list[str] = []
    for name in dict.fromkeys(options.ids):
        definitions = [*_definitions(groups, name)]
        if reason := _reason_against(groups, name, definitions):
            refused.append(reason)
        for workspace, definition in definitions if not reason else ():
            path = definition.path
            before, now = texts.get(path, (workspace.files[path].text,) * 2)
            edited, current = _current(workspace.with_file(path, now), path, name)
            result = with_approval(edited, current, options.by, on, keeps_date=options.date is None)
            if result is None:
                refused.append(f"{shown(path)}: `{name}` cannot be approved where it is; write its clauses in a block")
                continue
            after, replaced = result
            texts[path] = before, after
            fingerprint = edited.store.ask(approval_state, path, name).fingerprint
            state = "was approved already" if after == now else "approved"
            state += f" by {options.by}" + (f" (replaces the approval of {replaced})" if replaced else "")
            approved.append(f"{shown(path)}: `{name}` {state}, {fingerprint}")
    messages.problems(problems)
    for reason in refused:
        messages.result(reason)
    if refused or problems:
        messages.remark("nothing written")
        return 2 if problems else 1
    failures = [*_write({path: after for path, (before, after) in texts.items() if after != before})]
    messages.problems(failures)
    if not failures:
        for line in approved:
            messages.result(line)
        written = sum(before != after for before, after in texts.values())
        messages.remark(f"{counted(len(options.ids), 'requirement')}, {counted(written, 'file')} written")
    return 2 if failures else 0


def _definitions(groups: Iterable[FileGroup], name: str) -> Iterator[tuple[Workspace, Definition]]:
    """The definitions of a requirement in the files, once each."""
    seen: set[str] = set()
    for group in groups:
        for path, file in group.workspace.files.items():
            for definition in file.definitions(Kind.REQUIREMENT, name) if not file.is_foreign else ():
                place = f"{path}:{definition.span.start}"
                if place not in seen:
                    seen.add(place)
                    yield group.workspace, definition


def _reason_against(groups: Iterable[FileGroup], name: str, definitions: Sequence[tuple[Workspace, Definition]]) -> str:
    """Why a requirement cannot be approved; empty if it can."""
    if not definitions:
        names = {each for group in groups for file in group.workspace.files.values() for each in file.names_of(_KIND)}
        return f"unknown requirement `{name}`{did_you_mean(near(name, sorted(names)))}"
    places = [f"{shown(each.path)}:{_line(workspace, each)}" for workspace, each in definitions]
    targets = [each.symbol.target for _, each in definitions]
    first = targets[0]
    if any(
        isinstance(first, Requirement) and isinstance(target, Requirement) and not same_requirement(first, target)
        for target in targets
    ):
        return f"`{name}` is defined differently at {', '.join(places)}; choose with --in"
    torn = [place for place, (_, each) in zip(places, definitions, strict=True) if each.entry.diagnostics]
    return f"{torn[0]}: `{name}` has mistakes, which `btq check` shows" if torn else ""


def _line(workspace: Workspace, definition: Definition) -> int:
    return workspace.files[definition.path].lines.position(definition.span.start).line + 1


def _current(workspace: Workspace, path: str, name: str) -> tuple[Workspace, Definition]:
    """A workspace in which other requirements of a file may just have been approved, and the definition there."""
    return workspace, workspace.files[path].definitions(Kind.REQUIREMENT, name)[0]


def _write(texts: dict[str, str]) -> Iterator[LoadProblem]:
    for path, text in texts.items():
        try:
            write_whole(path, text)
        except OSError as error:
            yield LoadProblem(path, f"cannot be written: {error.strerror}")


_KIND = Kind.REQUIREMENT
