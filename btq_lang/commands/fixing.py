"""The safe fixes of `btq check --fix`, written to the files or shown as a diff."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Final

from btq_lang.btcpp.opening import with_source
from btq_lang.checks import check_each
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.projects.files import FileGroup
from btq_lang.projects.messages import CommandOutput
from btq_lang.render.colour import painter
from btq_lang.util.record import replace
from btq_lang.workspace.file import File
from btq_lang.workspace.fixes import fixed
from btq_lang.workspace.loader import LoadProblem, shown, write_whole
from btq_lang.workspace.workspace import Workspace

_ROUNDS: Final = 10  # of fixing: a fix may enable another


def fix(groups: Iterable[FileGroup], is_wanted: Callable[[Diagnostic], bool]) -> tuple[tuple[FileGroup, ...], int]:
    """The groups with the safe fixes of the requested files applied, and the number of fixes; nothing is written."""
    fixed_groups: list[FileGroup] = []
    count = 0
    finished: dict[str, File] = {}  # of earlier groups: a file may be in several factories
    for group in groups:
        workspace = _with_files(group.workspace, finished) if finished else group.workspace
        writable = tuple(path for path in group.given if path not in group.damaged and path not in finished)
        for _ in range(_ROUNDS):
            checked = zip(writable, check_each(workspace, writable), strict=True)
            texts, applied = fixed(
                workspace, {path: tuple(filter(is_wanted, diagnostics)) for path, diagnostics in checked}
            )
            if not applied:
                break
            count += applied
            for path, text in texts.items():
                workspace = with_source(workspace, path, text)
        finished.update((path, workspace.files[path]) for path in group.given)
        fixed_groups.append(replace(group, workspace=workspace))
    return tuple(fixed_groups), count


def write_fixes(
    before: Iterable[FileGroup], after: Iterable[FileGroup], stdin: str | None, messages: CommandOutput
) -> tuple[tuple[FileGroup, ...], tuple[LoadProblem, ...]]:
    """Write files that differ, and the new text of standard input to standard output; returns the groups after
    that."""
    written: list[FileGroup] = []
    trouble: list[LoadProblem] = []
    finished: dict[str, File] = {}
    for old, new in zip(before, after, strict=True):
        files = {**new.workspace.files}
        files.update((path, finished[path]) for path in files.keys() & finished.keys())
        for path in new.given:
            if path in finished:
                continue
            text = files[path].source
            if path == stdin and path not in new.damaged:
                messages.add(text, "document")
            elif text != old.workspace.files[path].source:
                try:
                    write_whole(path, text)
                except OSError as error:
                    trouble.append(LoadProblem(path, f"cannot be written: {error.strerror}"))
                    files[path] = old.workspace.files[path]  # the file on the disk still has its findings
            finished[path] = files[path]
        written.append(replace(new, workspace=_with_files(new.workspace, files)) if trouble else new)
    return tuple(written), tuple(trouble)


def show_fixes(
    before: Iterable[FileGroup], after: Iterable[FileGroup], is_coloured: bool, messages: CommandOutput
) -> bool:
    """Print the changes as a unified diff; returns whether there are any."""

    is_changed = False
    seen: set[str] = set()
    for old, new in zip(before, after, strict=True):
        for path in (path for path in new.given if path not in seen):
            seen.add(path)
            texts = old.workspace.files[path].source, new.workspace.files[path].source
            for line in text_diff(shown(path), *texts, is_coloured=is_coloured):
                messages.add(line, "document")
                is_changed = True
    return is_changed


def _with_files(workspace: Workspace, files: Mapping[str, File]) -> Workspace:
    """The workspace with some files replaced by others of the same paths."""
    replaced = {path: files.get(path, file) for path, file in workspace.files.items()}
    return Workspace(replaced, workspace.project, workspace.factory)


def text_diff(path: str, old: str, new: str, *, is_coloured: bool = False) -> Iterator[str]:
    """The lines of the unified diff of a file, each with its end, which `git apply -p0` and `patch` can apply.

    Lines end at `\\n` alone, so a change of line ends shows and the diff has the bytes of the files.
    """
    from difflib import unified_diff  # fixes need none

    paint = painter(is_coloured)
    for line in unified_diff(_lines(old), _lines(new), path, path):
        body = line.removesuffix("\n")
        yield (paint(body[:1], body) if body[:1] in ("+", "-") else body) + "\n"
        if body == line:
            yield "\\ No newline at end of file\n"


def _lines(text: str) -> list[str]:
    return re.findall(r"[^\n]*\n|[^\n]+", text)
