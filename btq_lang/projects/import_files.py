"""BehaviorTree.CPP XML, and the trees in logs, as .btq files on the disk.

One invariant: whatever paths the side file of a bundle names, only files that btq reads are written, and only below the
folder of the import, links followed.
"""

from __future__ import annotations

import os
import posixpath
from collections.abc import Iterable, Iterator, Mapping, Sequence
from shlex import quote

from btq_lang.btcpp.document import write
from btq_lang.btcpp.importing import Imported, import_xml
from btq_lang.btcpp.logged import as_written
from btq_lang.btcpp.manual_edits import ADVICE
from btq_lang.btcpp.side_file import side_path
from btq_lang.btcpp.version3 import VersionNote
from btq_lang.checks.engines import declared_engines
from btq_lang.evidence.readers import SUFFIXES as LOGS
from btq_lang.evidence.readers import NotALog, trees
from btq_lang.evidence.readers.bag import files_in
from btq_lang.projects.files import STDIN, Files
from btq_lang.projects.messages import CommandOutput
from btq_lang.render import Finding, Report, render, with_paths
from btq_lang.util.record import Record, replace
from btq_lang.util.source_map import OriginMap
from btq_lang.util.text import LineIndex, counted
from btq_lang.workspace.config import include_candidates
from btq_lang.workspace.file import SUFFIXES
from btq_lang.workspace.loader import LoadProblem, absolute, decoded, find_project, read, shown, write_whole


class ImportOptions(Record):
    """The files to import, and how.

    Attributes:
        files: XML files and logs, or `-` for standard input.
        output: the folder to write to; None: beside the files.
        is_xml: the tree of a log is written as XML.
        keeps_v3: what version 4 of the engine spells otherwise stays as it is.
        is_forced: overwrite files.
        stdin: the bytes of standard input.
        is_coloured: diagnostics are coloured.
    """

    files: Sequence[str]
    output: str | None = None
    is_xml: bool = False
    keeps_v3: bool = False
    is_forced: bool = False
    stdin: bytes = b""
    is_coloured: bool = False


class ImportResult(Record):
    """The result of an import.

    Attributes:
        code: the exit code.
        messages: what there is to print.
        missions: the paths of those that were written.
    """

    code: int
    messages: CommandOutput
    missions: tuple[str, ...]


class _Job(Record):
    """An XML file, its result, and the target path; None: standard output.

    Attributes:
        others: the files of its bundle: their targets and texts.
        losses: what the mission loses, a line each, with what to do.
    """

    path: str
    xml: str
    imported: Imported
    target: str | None
    others: tuple[tuple[str, str], ...] = ()
    losses: tuple[str, ...] = ()


def import_files(options: ImportOptions, overlay: Mapping[str, str] | None = None) -> ImportResult:
    """Import each file; a file that is not XML does not stop the others.

    Args:
        overlay: the texts of project files that are not on the disk yet, by path.
    """
    messages = CommandOutput()
    problems: list[LoadProblem] = []
    targets = {absolute(path): _target(path, options) for path in options.files if path != STDIN}
    possible = (_job(path, targets, options, problems, overlay or {}) for path in options.files)
    jobs = [job for job in possible if job is not None]
    first: dict[str | int, _Job] = {}
    for job in jobs:
        other = first.setdefault(job.target or id(job), job)
        if other is not job and job.target is not None:
            message = f"not imported: {shown(other.path)} would also become {shown(job.target)}"
            problems.append(LoadProblem(job.path, message))
    if len(first) < len(jobs):
        jobs = []  # the others may include what would be missing
    jobs = [job for job in jobs if not _clashes(job, jobs, options.is_forced, problems)]
    _add_findings(jobs, options, messages)
    complete = [job for job in jobs if job.imported.is_complete]
    written = [job for job in complete if _write(job, problems, messages)]
    for job in written:
        _add_changes(job, messages)
    messages.problems(problems)
    _sum_up(written, len(jobs) - len(complete), messages)
    code = 2 if problems else int(len(complete) < len(jobs))
    return ImportResult(code, messages, tuple(job.target for job in written if job.target is not None))


def _target(path: str, options: ImportOptions) -> str:
    """The path of the .btq file for an XML file or a log, or of the XML file for a log."""
    folder, name = os.path.split(absolute(path))
    ending = ".xml" if options.is_xml else ".btq"
    return absolute(os.path.join(options.output or folder, f"{os.path.splitext(name)[0]}{ending}"))


def _job(
    path: str,
    targets: Mapping[str, str],
    options: ImportOptions,
    problems: list[LoadProblem],
    overlay: Mapping[str, str],
) -> _Job | None:
    if path == STDIN:
        xml, problem = decoded("<stdin>", options.stdin)
        if xml is None or problem is not None:  # as for a file
            problems += [problem] if problem else []
            return None
        engines = _engines(absolute("<stdin>"), xml, overlay)
        job = _Job("<stdin>", xml, import_xml(xml, options.keeps_v3, engines=engines), None)
        return _without_side_file(job, "import the file by its name, beside its .qreq.json, to keep them")
    path = absolute(path)
    if path.endswith(LOGS) or files_in(path):
        return _of_log(path, targets[path], options, problems)
    if options.is_xml or targets[path] == path:
        why = "--xml is for logs" if options.is_xml else "its name does not end with .xml"
        problems.append(LoadProblem(path, f"not imported: {why}"))
        return None
    text, problem = read(path)
    if text is None or problem is not None:  # other than UTF-8 would lose bytes
        problems.extend([problem] if problem else [])
        return None
    folder, target = os.path.dirname(path), targets[path]
    moves = os.path.dirname(target) != folder

    def included_as(named: str) -> str:
        """The path to include a file by: a file imported in the same run by its new one, any other by its own."""
        other = absolute(os.path.join(folder, named))
        if other in targets:
            other = targets[other]
        elif not moves or os.path.isabs(named) or not os.path.isfile(other):
            return named
        return os.path.relpath(other, os.path.dirname(target)).replace(os.sep, "/")

    engines = _engines(path, text, overlay)
    job = _Job(path, text, import_xml(text, options.keeps_v3, included_as=included_as, engines=engines), target)
    return _with_side_file(job, target, options.is_forced, problems)


def _engines(path: str, xml: str, overlay: Mapping[str, str]) -> tuple[str, ...]:
    """The versions of the engine that a file is written for, as a check of it takes it."""
    files = Files()
    files.overlay |= {**overlay, path: xml}
    groups, _ = files.groups([path])
    return groups[0].workspace.store.ask(declared_engines, path)


def _of_log(path: str, target: str, options: ImportOptions, problems: list[LoadProblem]) -> _Job | None:
    """The last tree in a log, as the XML that it was created from, or as .btq file."""
    try:
        logged = trees(path)
    except (NotALog, OSError) as error:
        why = f"cannot be read: {error.strerror}" if isinstance(error, OSError) else str(error)
        problems.append(LoadProblem(path, f"not imported: {why}"))
        return None
    if not logged:
        problems.append(LoadProblem(path, "not imported: it has no tree"))
        return None
    xml = write(as_written(logged[-1].xml))
    imported = Imported(xml, (), (), OriginMap()) if options.is_xml else import_xml(xml, options.keeps_v3)
    number = len({write(as_written(tree.xml)) for tree in logged})
    return _Job(
        path, xml, imported, target, losses=(f"it has {number} trees, of which the last is imported",) * (number > 1)
    )


def _with_side_file(job: _Job, target: str, force: bool, problems: list[LoadProblem]) -> _Job | None:
    """The result for a file that `btq build` made, with what its side file has in addition."""
    side = side_path(job.path)
    text, problem = read(side) if os.path.isfile(side) else (None, None)
    if text is None or problem is not None or not job.imported.is_complete:
        return _without_side_file(job, f"put {shown(side)} beside the XML to keep them")
    from btq_lang.btcpp.restoring import restored
    from btq_lang.formatter import format_text

    mission = restored(job.xml, job.imported.text, text)
    if mission is None:
        return _without_side_file(
            job, f"{shown(side)} belongs to another build; put the one of this build there to keep them"
        )
    if mission.is_whole:
        root, target = os.path.dirname(target), place_of_mission(target, mission.file, mission.others)
        others = unpacked(mission.others, root, target, (job.path, side), force, problems)
        if others is None:
            return None
        return replace(job, imported=replace(job.imported, text=mission.text, changes=()), target=target, others=others)
    losses = tuple(
        f"its node no longer exists: {lost.text} (line {lost.line} of {lost.file or 'the mission'} as built)"
        for lost in mission.lost
    )
    manual_edits = (
        VersionNote(edit.span, f"`{edit.guard}` was {edit.happened} by hand: {ADVICE}") for edit in mission.manual_edits
    )
    changes = (*manual_edits, *job.imported.changes)
    return replace(
        job, imported=replace(job.imported, text=format_text(mission.text).text, changes=changes), losses=losses
    )


def _without_side_file(job: _Job, advice: str) -> _Job:
    number = job.imported.described
    if not number:
        return job
    nodes = counted(number, "node")
    return replace(job, losses=(f"the requirements or qualities of {nodes} are lost: {advice}",))


def _clashes(job: _Job, jobs: Iterable[_Job], force: bool, problems: list[LoadProblem]) -> bool:
    """Whether writing a job would overwrite a file."""
    if job.target is None:
        return False
    for other in jobs:
        text_at: dict[str | None, str] = {
            other.path: other.xml,
            **dict(other.others),
            other.target: other.imported.text,
        }
        for path, text in job.others:
            if text_at.get(path, text) != text:
                message = f"not imported: the bundle {shown(other.path)} contains another version of {shown(path)}"
                problems.append(LoadProblem(job.path, message))
                return True
    if os.path.lexists(job.target) and not force:
        problems.append(LoadProblem(job.target, "already exists; --force overwrites it"))
        return True
    return False


def _write(job: _Job, problems: list[LoadProblem], messages: CommandOutput) -> bool:
    if job.target is None:
        messages.result(job.imported.text.removesuffix("\n"))
        return True
    for path, text in (*job.others, (job.target, job.imported.text)):
        try:
            os.makedirs(os.path.dirname(path), exist_ok=True)
            write_whole(path, text)
        except OSError as error:
            problems.append(LoadProblem(path, f"cannot be written: {error.strerror}"))
            return False
    return True


def _add_findings(jobs: Iterable[_Job], options: ImportOptions, messages: CommandOutput) -> None:
    """Report the diagnostics of the XML, with its lines."""
    findings = [Finding(job.path, job.xml, each) for job in jobs for each in job.imported.diagnostics]
    if not findings:
        return
    report = with_paths(Report(tuple(findings), {job.path: job.xml for job in jobs}, ()), shown)
    messages.remark("".join(render("full", report, colour=options.is_coloured)).removesuffix("\n"))


def _add_changes(job: _Job, messages: CommandOutput) -> None:
    """Report losses, and where the new file differs from the XML, a line each."""
    for loss in job.losses:
        messages.remark(f"{shown(job.path)}: {loss}")
    lines = LineIndex(job.xml)
    for change in job.imported.changes:
        line, column = lines.position(change.span.start)
        messages.remark(f"{shown(job.path)}:{line + 1}:{column + 1}: {change.message}")


def _sum_up(written: list[_Job], refused: int, messages: CommandOutput) -> None:
    changes = sum(len(job.imported.changes) for job in written)
    with_changes = f" with {counted(changes, 'change')}" if changes else ""
    others = sum(len(job.others) for job in written)
    parts = [f"{counted(len(written) + others, 'file')} imported{with_changes}"]
    if refused:
        parts.append(f"{counted(refused, 'file')} not imported")
    messages.remark(", ".join(parts))
    for command in dict.fromkeys(command for job in written for command in _missing(job)):
        messages.remark(f"To import an included file: {command}")
    if len(written) == 1 and written[0].target is not None:
        messages.remark(f"Next: btq check {quote(shown(written[0].target))}")


def _missing(job: _Job) -> Iterator[str]:
    """Commands that import a mission's includes that are still XML, beside its XML."""
    if job.target is None or "include" not in job.imported.text:
        return
    from btq_lang.parser import parse
    from btq_lang.syntax.tree import Include

    project = find_project(job.target).project
    for entry in parse(job.imported.text).entries:
        item = entry.item
        if not isinstance(item, Include) or item.path is None or item.path.text.endswith(".xml") or item.attributes:
            continue
        xml = absolute(os.path.join(os.path.dirname(job.path), f"{os.path.splitext(item.path.text)[0]}.xml"))
        places = include_candidates(project, job.target, item.path.text)
        if any(os.path.isfile(place) for place in places) or not os.path.isfile(xml):
            continue
        folder = os.path.dirname(absolute(os.path.join(os.path.dirname(job.target), item.path.text)))
        into = f" -o {quote(shown(folder))}" if folder != os.path.dirname(xml) else ""
        yield f"btq import {quote(shown(xml))}{into}"


def place_of_mission(target: str, file: str, others: Iterable[tuple[str, str]]) -> str:
    """The path of a mission that leaves room for its includes: deeper, if it includes `../shared/a.btq`.

    Args:
        target: its path without includes.
        file: its old path, relative to its side file: folders keep their names.
        others: the paths, seen from the mission, and the texts.
    """
    up = max((name.split("/").count("..") for name, _ in others), default=0)
    folders = file.split("/")[:-1]
    names = folders[len(folders) - up :] if 0 < up <= len(folders) else []
    if any(name in ("", ".", "..") or any(char in name for char in _FOREIGN) for name in names):
        return target
    return absolute(os.path.join(os.path.dirname(target), *names, os.path.basename(target)))


def unpacked(
    others: Iterable[tuple[str, str]],
    root: str,
    target: str,
    taken: Iterable[str],
    force: bool,
    problems: list[LoadProblem],
) -> tuple[tuple[str, str], ...] | None:
    """The paths of the files that a mission includes, with their texts; None: one of them cannot be written.

    Args:
        others: the paths, seen from the mission, and the texts.
        root: the folder that must contain all of them.
        target: the path of the mission.
        taken: files that must not be overwritten.
        force: existing files may be overwritten; equal ones are not touched.
        problems: errors are appended.
    """
    folder = os.path.dirname(target)
    unpacked_texts: dict[str, str] = {}
    problems_before = len(problems)
    for name, text in others:
        path = _below(root, folder, name)
        if path is None:
            message = f"its bundle contains `{name}`, which is not a .btq or XML file below the output folder"
            problems.append(LoadProblem(target, message))
        elif path in (target, *taken):
            problems.append(LoadProblem(target, f"its bundle contains `{name}`, which the import would overwrite"))
        elif not os.path.lexists(path):
            unpacked_texts[path] = text
        elif not os.path.isfile(path) or read(path) != (text, None):
            unpacked_texts[path] = text
            if not force:
                problems.append(LoadProblem(path, "already exists; --force overwrites it"))
    return None if len(problems) > problems_before else tuple(unpacked_texts.items())


def _below(root: str, folder: str, name: str) -> str | None:
    if not name.endswith((*SUFFIXES, ".xml")) or os.path.isabs(name) or any(char in name for char in _FOREIGN):
        return None
    path = absolute(os.path.join(folder, name))
    if posixpath.normpath(name) != name or not path.startswith(f"{root.rstrip('/')}/"):
        return None
    return path if os.path.realpath(path).startswith(os.path.join(os.path.realpath(root), "")) else None


_FOREIGN = "\\:\0"  # on some systems, characters that turn a name into another path
