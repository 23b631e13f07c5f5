"""`btq diff`: what changed between two missions, or between two revisions of one."""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Callable, Collection, Iterator, Sequence

from btq_lang.btcpp.as_built import as_built
from btq_lang.btcpp.manual_edits import ADVICE
from btq_lang.btcpp.marks import DESCRIPTION_MARK, is_built_of
from btq_lang.btcpp.recognition import is_mission
from btq_lang.commands.output import is_coloured, write_output
from btq_lang.diagnostics.rules import Severity
from btq_lang.diff import DiskPlace, as_json, as_markdown, as_text
from btq_lang.diff.comparison import NOWHERE, MissionComparison, Side, UnmergedEdit, compared, without_made_models
from btq_lang.projects.files import STDIN, FileGroup, Files
from btq_lang.projects.git import Commit, revisions
from btq_lang.projects.messages import CommandOutput
from btq_lang.projects.opening import Disk
from btq_lang.projects.options import Refused, refuse
from btq_lang.render.colour import painter
from btq_lang.util.record import Record, replace
from btq_lang.workspace.file import SUFFIXES, File, is_of_package
from btq_lang.workspace.loader import LoadProblem, absolute, collect, find_project, read, shown


class DiffOptions(Record):
    """The options of `btq diff`.

    Attributes:
        git: the revisions to compare, as in `HEAD` or `main...HEAD`; None: the paths are the two missions.
    """

    paths: Sequence[str]
    stdin_filename: str | None
    git: str | None
    format: str
    color: str


def run(options: DiffOptions, messages: CommandOutput) -> int:
    """Compare; the exit code is 0: the same, 1: different, 2: the comparison failed."""
    comparisons = tuple(
        _of_revisions(options.paths, options.git)
        if options.git is not None
        else _of_paths(options.paths, options.stdin_filename)
    )
    for comparison in comparisons:
        for side in (comparison.old, comparison.new):
            _warn(side, messages)
    write_output(messages, None, "".join(f"{line}\n" for line in _rendered(comparisons, options)), options.format)
    return int(any(comparison.changes for comparison in comparisons))


def _rendered(comparisons: tuple[MissionComparison, ...], options: DiffOptions) -> Iterator[str]:
    if options.format == "json":
        return as_json.render(comparisons)
    if options.format == "markdown":
        return as_markdown.render(comparisons)
    colour = is_coloured(options.color, sys.stdout.isatty())
    return as_text.render(comparisons, painter(colour))


def _warn(side: Side, messages: CommandOutput) -> None:
    """Warn about a mission that is compared only in part."""
    for path in side.paths:
        file = side.workspace.files[path]
        for include in file.includes:
            if include.path is None or is_of_package(include):
                continue
            if side.workspace.included_by(path, include) is None:
                message = f"includes `{include.path.text}`, which does not exist: its content is not compared"
                messages.remark(f"btq: {side.shown(path)}: {message}")
        if file.is_foreign and DESCRIPTION_MARK in file.source:
            message = "its requirements are missing: `btq build` wrote them to the .qreq.json that was beside it"
            messages.remark(f"btq: {side.shown(path)}: {message}")
        if error := _first_error(file):
            messages.remark(f"btq: {side.shown(path)}:{error}; btq compares the rest")


def _first_error(file: File) -> str | None:
    diagnostics = file.source_diagnostics
    for diagnostic in diagnostics:
        if diagnostic.effective_severity is Severity.ERROR:
            line, column = file.source_lines.position(diagnostic.span.start)
            return f"{line + 1}:{column + 1}: {diagnostic.message}"
    return None


# ---- two files, two folders ----


def _of_paths(paths: Sequence[str], stdin_filename: str | None) -> Iterator[MissionComparison]:
    if len(paths) != 2:
        raise Refused(
            f"expected two missions, found {len(paths)}; to compare revisions of one: btq diff --git HEAD FILE"
        )
    if STDIN in paths:
        yield _with_stdin(paths, stdin_filename)
        return
    old, new = (None if path == os.devnull else absolute(path) for path in paths)
    # Checked before paths are normalised, so that messages name them as on the command line.
    missing = (path for path in (old, new) if path is not None and not os.path.exists(path))
    refuse(*(LoadProblem(path, f"cannot be read: {os.strerror(errno.ENOENT)}") for path in missing))
    if old is not None and new is not None and os.path.isdir(old) != os.path.isdir(new):
        # As in `diff`: a file and a folder compare with the file of that name in the folder.
        old = f"{old}/{os.path.basename(new)}" if os.path.isdir(old) else old
        new = f"{new}/{os.path.basename(old)}" if os.path.isdir(new) else new
    sides = [{} if path is None else _sides_by_name(path) for path in (old, new)]
    for before, after in _paired_paths(*sides):
        yield without_made_models(compared(sides[0].get(before, NOWHERE), sides[1].get(after, NOWHERE)))


def _with_stdin(paths: Sequence[str], stdin_filename: str | None) -> MissionComparison:
    """Compare a file with standard input."""
    other = next((path for path in paths if path != STDIN), None)
    if other is None:
        raise Refused("one of the two can be standard input, not both")
    if os.path.isdir(other):
        raise Refused(f"standard input is one file, and {other} is a folder")

    def side(path: str) -> Side:
        if path == os.devnull:
            return NOWHERE
        if path != STDIN:
            return _side_in(Disk(), absolute(path))
        (group,) = _groups([path], stdin_filename)
        (own,) = group.given
        return Side(shown(own), group.workspace, group.workspace.closure(own), shown)

    return without_made_models(compared(*map(side, paths)))


def _paired_paths(old: Collection[str], new: Collection[str]) -> list[tuple[str, str]]:
    """Pairs of files with equal names, or of an XML file and the .btq file that builds it."""
    came = set(new) - set(old)
    pairs = []
    for name in old:
        stem, ending = os.path.splitext(name)
        other = (f"{stem}{suffix}" for suffix in (SUFFIXES if ending == ".xml" else (".xml",)))
        pairs.append((name, name if name in new else next(filter(came.__contains__, other), name)))
        came.discard(pairs[-1][1])
    return sorted([*pairs, *zip(came, came, strict=True)])


def _sides_by_name(path: str) -> dict[str, Side]:
    """The mission of a file, with all its includes; or the missions of a folder, each without includes, by their names
    in it.
    """
    if not os.path.isdir(path):
        return {"": _side_in(Disk(), path)}
    sides: dict[str, Side] = {}
    for group in _groups([path, *_xml_below(path)]):
        for path_below in group.given:
            built = _built_in(Disk(), path_below)
            side = Side(shown(path_below), group.workspace, (path_below,), shown)
            sides[path_below.removeprefix(f"{path}/")] = (
                _by_itself(built, os.path.isfile) if built is not None else side
            )
    return sides


def _side_in(files: Disk | Commit, path: str, with_includes: bool = True) -> Side:
    """A file on the disk or in a commit."""
    built = _built_in(files, path)
    if built is not None:
        return built if with_includes else _by_itself(built, files.is_file)
    workspace = files.workspace(path)
    if workspace is None:
        return NOWHERE
    return Side(files.shown(path), workspace, workspace.closure(path) if with_includes else (path,), files.shown)


def _by_itself(built: Side, is_file: Callable[[str], bool]) -> Side:
    """A built file of a folder without its includes, if these are separate XML files."""
    *included, own = built.paths
    bundled = (path for path in included if not is_file(f"{os.path.splitext(path)[0]}.xml"))
    return replace(built, paths=(*bundled, own))


def _built_in(files: Disk | Commit, path: str) -> Side | None:
    """The mission from which an XML file was built, if its side file tells."""
    built = as_built(path, files, files.shown)
    if built is None:
        return None
    manual_edits = tuple(
        UnmergedEdit(edit.guard, edit.sum, f"{edit.happened}; {ADVICE}", DiskPlace(xml, edit.span))
        for xml, edit in built.manual_edits
    )
    return Side(files.shown(path), built.workspace, built.workspace.closure(built.path), built.shown, manual_edits)


def _xml_below(folder: str) -> tuple[str, ...]:
    """The XML files below a folder to compare, without those built from an existing .btq file."""
    project = find_project(folder).project
    paths, problems = collect([folder], project, (".xml", *SUFFIXES))
    refuse(*problems)
    sources = {os.path.basename(path) for path in paths if not path.endswith(".xml")}
    texts = {path: read(path)[0] or "" for path in paths if path.endswith(".xml")}
    return tuple(path for path, xml in texts.items() if is_mission(xml) and not is_built_of(xml, sources))


def _groups(paths: Sequence[str], stdin_filename: str | None = None) -> tuple[FileGroup, ...]:
    groups, problems = Files().groups(paths, stdin_filename)
    refuse(*problems)
    return groups


# ---- revisions ----


def _of_revisions(paths: Sequence[str], revision: str) -> Iterator[MissionComparison]:
    if STDIN in paths:
        raise Refused("standard input has no revisions: git show REV:FILE | btq diff - FILE")
    for path in map(absolute, paths or ["."]):
        pair = revisions(revision, path)
        if not os.path.isdir(path) and not pair.had_folder(path):
            sides = _side_in_revision(pair.old, path, True), _side_in_revision(pair.new, path, True)
            if sides == (NOWHERE, NOWHERE):
                where = pair.new.name if pair.new is not None else "here"
                raise Refused(f"{shown(path)}: no such file in {pair.old.name} or {where}")
            yield without_made_models(compared(*sides))
            continue
        for before, after in pair.changed(path):
            yield compared(_side_in_revision(pair.old, before, False), _side_in_revision(pair.new, after, False))


def _side_in_revision(commit: Commit | None, path: str | None, with_includes: bool) -> Side:
    """A file in a commit; None: in the working tree."""
    if path is None or (commit is None and not os.path.exists(path)):
        return NOWHERE
    return _side_in(commit or Disk(), path, with_includes)
