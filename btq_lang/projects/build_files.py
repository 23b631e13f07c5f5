"""Missions on the disk as XML that BehaviorTree.CPP loads, written all of them or none.

One invariant: what another program or a person has written is not overwritten without `is_forced`.
"""

from __future__ import annotations

import glob
import os
from collections.abc import Collection, Iterable, Iterator, Sequence
from typing import Final

from btq_lang.btcpp.enforceability import WAYS_COUNTED
from btq_lang.btcpp.enforcement import ClauseEnforcement, Enforcement
from btq_lang.btcpp.export import Export, is_mission
from btq_lang.btcpp.marks import is_generated
from btq_lang.btcpp.outputs import MissionOutput, OutputPlaces, outputs, sources, without_tree
from btq_lang.btcpp.side_file import is_side_file, side_path
from btq_lang.btcpp.source import Remark
from btq_lang.catalog.versions import is_before_4
from btq_lang.diagnostics.model import Place
from btq_lang.projects.building import errors, for_target
from btq_lang.projects.files import STDIN, FileGroup, Files, no_mission_below
from btq_lang.projects.messages import CommandOutput
from btq_lang.render import Finding, Report, render, with_paths
from btq_lang.util.record import Record, replace
from btq_lang.util.text import Span, counted
from btq_lang.workspace.file import SUFFIXES
from btq_lang.workspace.loader import LoadProblem, absolute, read, shown, write_whole


class BuildOptions(Record):
    """The missions to build, and how.

    Attributes:
        paths: files and folders, or `-` for standard input.
        stdin_filename: the path that standard input is taken for.
        target: the version of the engine; None: the newest of the project.
        output: the folder to write to; None: beside the missions.
        is_bundled: each mission in one file with all that it needs.
        is_enforced: add the nodes that enforce requirements.
        is_verbatim: exactly the content of the file, without repairs and additions.
        is_check: write nothing, compare.
        is_forced: overwrite XML that btq did not write.
        is_verbose: report for every clause whether and how it is enforced.
        report: the format of errors.
        is_coloured: errors are coloured.
    """

    paths: Sequence[str]
    stdin_filename: str | None = None
    target: str | None = None
    output: str | None = None
    is_bundled: bool = False
    is_enforced: bool = True
    is_verbatim: bool = False
    is_check: bool = False
    is_forced: bool = False
    is_verbose: bool = False
    report: str = "full"
    is_coloured: bool = False


class BuildResult(Record):
    """The result of a build.

    Attributes:
        code: the exit code.
        messages: what there is to print.
        watched: the files that another build depends on.
        files: those written, or already up to date.
    """

    code: int
    messages: CommandOutput
    watched: tuple[str, ...]
    files: tuple[str, ...] = ()


class _Target(Record):
    """A file to write or to remove.

    Attributes:
        text: the new contents; None: remove the file.
        old: the current contents; None: no file.
    """

    path: str
    text: str | None
    old: str | None


def build_files(options: BuildOptions, files: Files) -> BuildResult:
    """Build missions, unless one of them has errors.

    Raises:
        ValueError: btq does not know the version of the engine.
    """
    messages = CommandOutput()
    groups, problems = files.groups(options.paths, options.stdin_filename)
    if options.target:
        groups = tuple(replace(group, workspace=for_target(group.workspace, options.target)) for group in groups)
    watched = tuple(path for group in groups for path in group.watched)
    problems += tuple(
        LoadProblem(path, "is XML already")
        for group in groups
        for path in group.given
        if not is_mission(group.workspace, path)
    )
    messages.problems(problems)
    if usage := no_mission_below(options.paths, groups) or _version_problem(groups, options):
        messages.remark(f"btq build: {usage}")
    if problems or usage:  # an unreadable file may be part of any other
        return BuildResult(2, messages, watched)
    planned = None if _has_errors(groups, options, messages) else _planned(groups, options, messages)
    if planned is None:
        messages.remark("nothing was written")
        return BuildResult(1, messages, watched)
    for output in planned:
        _add_remarks(output.done.export.repairs, "repaired", groups, messages)
    _add_clauses([output.done for output in planned], groups, options.is_verbose, messages)
    if not options.is_check:
        _add_guesses([output.done.export for output in planned], messages)
    if not planned:
        messages.remark("nothing to build: there are only scenarios, which `btq test` runs")
    if STDIN in options.paths:
        for output in planned:
            if output.path == files.stdin:
                messages.add(output.text, "document")
        return BuildResult(0, messages, watched)
    targets = [target for output in planned for target in _targets(output)]
    code = (_compare if options.is_check else _write)(targets, options, _stale(groups, options), messages)
    return BuildResult(code, messages, watched, tuple(target.path for target in targets if target.text is not None))


def _version_problem(groups: tuple[FileGroup, ...], options: BuildOptions) -> str | None:
    if not options.target and any(is_before_4(group.workspace.project.target) for group in groups):
        return "btq writes XML for version 4 of the engine, and btq.toml names an older one: choose one with --target"
    return None


def _planned(
    groups: tuple[FileGroup, ...], options: BuildOptions, messages: CommandOutput
) -> list[MissionOutput] | None:
    """The files to write; None: there are none, and a message says why."""
    empty = [path for group in groups for path in without_tree(group.workspace, group.given)]
    for path in empty:
        messages.remark(f"btq build: {shown(path)} has no tree to run")
    if empty and len(empty) == sum(len(group.given) for group in groups):
        return None
    places = OutputPlaces(absolute(options.output) if options.output else None, _sources(groups))
    planned = [output for group in groups for output in _outputs(group, places, options)]
    number = sum(_add_remarks(output.done.export.problems, "error", groups, messages) for output in planned)
    clashes = [*_same_place(planned)]
    for clash in clashes:
        messages.remark(f"btq build: {clash}")
    return None if number or clashes else planned


def _sources(groups: tuple[FileGroup, ...]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(path for group in groups for path in sources(group.workspace, group.given)))


def _stale(groups: tuple[FileGroup, ...], options: BuildOptions) -> list[str]:
    """The files that an earlier build left beside missions."""
    return [] if options.output else stale_outputs(os.path.dirname(path) for path in _sources(groups))


def _outputs(group: FileGroup, places: OutputPlaces, options: BuildOptions) -> tuple[MissionOutput, ...]:
    return outputs(
        group.workspace,
        group.given,
        places,
        bundled=options.is_bundled,
        verbatim=options.is_verbatim,
        enforce=options.is_enforced,
    )


def _has_errors(groups: tuple[FileGroup, ...], options: BuildOptions, messages: CommandOutput) -> bool:
    """Whether errors prevent the build; they are results."""
    findings = [
        Finding(path, group.workspace.files[path].source, diagnostic)
        for group in groups
        for path, diagnostic in errors(
            group.workspace,
            group.given,
            bundled=options.is_bundled,
            verbatim=options.is_verbatim,
            replaces=not options.output,
        )
    ]
    if not findings:
        return False
    texts = {path: file.source for group in groups for path, file in group.workspace.files.items()}
    report = with_paths(Report(tuple(findings), texts, tuple(path for group in groups for path in group.given)), shown)
    messages.result("".join(render(options.report, report, colour=options.is_coloured)).removesuffix("\n"))
    return True


def _add_remarks(remarks: Collection[Remark], word: str, groups: tuple[FileGroup, ...], messages: CommandOutput) -> int:
    """Report an export's remarks; returns how many."""
    for remark in remarks:
        file = next(group.workspace.files[remark.path] for group in groups if remark.path in group.workspace.files)
        line, column = file.lines.position(remark.span.start)
        place = (
            "" if file.is_foreign else f":{line + 1}:{column + 1}"
        )  # places are in the text that XML was converted to
        messages.remark(f"{shown(remark.path)}{place}: {word}: {remark.message}")
    return len(remarks)


def _add_clauses(
    planned: list[Enforcement], groups: tuple[FileGroup, ...], is_verbose: bool, messages: CommandOutput
) -> None:
    """Report how the clauses of requirements are covered, with a line for each clause that has a remark, or that is
    demanded to be enforced and is not.
    """
    clauses: dict[object, ClauseEnforcement] = {}
    for clause in (clause for enforcement in planned for applied in enforcement.clauses for clause in applied):
        key = (
            clause.requirement,
            clause.clause,
            clause.place.path,
            clause.place.span,
            id(clause.node and clause.node.node),
        )
        if key not in clauses or clause.way == "enforced":  # one file may enforce what another cannot
            clauses[key] = clause
    for clause in clauses.values():
        if not is_verbose and (not clause.asked or (clause.way == "enforced" and not clause.why)):
            continue
        where = f" at {clause.subject}" if clause.subject else ""
        way, why = clause.in_words
        because = f": {why}" if why else ""
        remark = Remark(*_absolute(clause.place, groups), f"{clause.requirement}, `{clause.clause}`{where}{because}")
        _add_remarks((remark,), way, groups, messages)
    with_nodes = {
        (clause.requirement, clause.clause, clause.place.path, clause.place.span) for clause in clauses.values()
    }
    loose = {  # without those whose node another file has
        clause_key: Remark(*_absolute(claim.place, groups), f"{requirement.name}, `{claim.text}` applies to no node")
        for enforcement in planned
        for requirement, claim in enforcement.loose
        if (clause_key := (requirement.name, claim.text, claim.place.path, claim.place.span)) not in with_nodes
    }
    _add_remarks(loose.values(), "not checked", groups, messages)
    if clauses:
        ways = [clause.way for clause in clauses.values()]
        counted = [f"{ways.count(way)} {words}" for way, words in WAYS_COUNTED.items() if way in ways]
        counted += [f"{len(loose)} without a node"] if loose else []
        messages.remark(f"clauses of requirements: {', '.join(counted)}")


def _add_guesses(exports: list[Export], messages: CommandOutput) -> None:
    """Report which nodes got a guessed category in the models, because the mission does not declare it."""
    guessed = {name: category for export in exports for name, category in export.guessed.items()}
    shown = [f"{name} ({category})" for name, category in sorted(guessed.items())[:_GUESSES_SHOWN]]
    if len(guessed) > len(shown):
        shown.append(f"{len(guessed) - len(shown)} more")
    if shown:
        which = "declare a node whose category is wrong, for example `Condition Name`"
        messages.remark(f"categories guessed from the use of the nodes: {', '.join(shown)}; {which}")


def _absolute(place: Place, groups: tuple[FileGroup, ...]) -> tuple[str, Span]:
    """The file of a place, and its span in that file."""
    assert place.path is not None, "a clause is part of a file"
    file = next(group.workspace.files[place.path] for group in groups if place.path in group.workspace.files)
    return place.path, file.span_of(place)


def _same_place(planned: list[MissionOutput]) -> Iterator[str]:
    """Messages for two files that would be written to one place: `a.btq` and `a.qualitybtcpp`."""
    path_at: dict[str, str] = {}
    for output in planned:
        other = path_at.setdefault(output.place, output.path)
        if other != output.path:
            yield f"{shown(other)} and {shown(output.path)} would both be written to {shown(output.place)}"


def _targets(output: MissionOutput) -> Iterator[_Target]:
    """The XML of a mission and its side file; an outdated side file is removed."""
    yield _Target(output.place, output.text, _old_text(output.place))
    side = side_path(output.place)
    old = _old_text(side)
    if output.side is not None or (old is not None and is_side_file(old)):
        yield _Target(side, output.side, old)


def _old_text(path: str) -> str | None:
    """The text of a file; empty: it cannot be read, so btq did not write it; None: there is no file."""
    return (read(path)[0] or "") if os.path.exists(path) else None


def _compare(targets: list[_Target], options: BuildOptions, stale: list[str], messages: CommandOutput) -> int:
    """`--check`: report which files a build would change or remove."""
    for path in stale:
        messages.result(f"stale: {shown(path)}")
    outdated = [target for target in targets if target.text != target.old]
    for target in outdated:
        state = "missing" if target.old is None else "out of date" if target.text is not None else "stale"
        messages.result(f"{state}: {shown(target.path)}")
    return int(bool(outdated or stale))


def _write(targets: list[_Target], options: BuildOptions, stale: list[str], messages: CommandOutput) -> int:
    """Write what has changed: all files, or none if one cannot be written."""
    for path in stale:
        messages.remark(f"stale: {shown(path)}")
    changed = [target for target in targets if target.text != target.old]
    foreign = [target for target in changed if not options.is_forced and _is_foreign(target.old)]
    for target in foreign:
        why = "is in the way: btq build did not write it (or wrote it with --verbatim)"
        instead = "write to another folder with -o FOLDER, or overwrite it with --force"
        messages.remark(f"btq build: {shown(target.path)} {why}; {instead}")
    if foreign or not _put_all(changed, messages):
        messages.remark("nothing was written")
        return 2
    for target in changed:
        messages.result(f"{'wrote' if target.text is not None else 'removed'} {shown(target.path)}")
    if same := len(targets) - len(changed):
        messages.remark(f"{counted(same, 'file')} unchanged")
    return 0


def _put_all(targets: list[_Target], messages: CommandOutput) -> bool:
    """Write or remove all files, or none if that fails for one."""
    for number, target in enumerate(targets):
        try:
            _write_or_remove(target.path, target.text)
        except OSError as error:
            what = "written" if target.text is not None else "removed"
            messages.problems([LoadProblem(target.path, f"cannot be {what}: {error.strerror}")])
            _take_back(targets[:number], messages)
            return False
    return True


def _write_or_remove(path: str, text: str | None) -> None:
    """Write a file, or remove it.

    Raises:
        OSError: that fails.
    """
    if text is None:
        os.unlink(path)
    else:
        os.makedirs(os.path.dirname(path), exist_ok=True)
        write_whole(path, text)


def _is_foreign(text: str | None) -> bool:
    return text is not None and not is_generated(text) and not is_side_file(text)


def _take_back(targets: list[_Target], messages: CommandOutput) -> None:
    """Restore the old contents of files, as far as possible."""
    for target in targets:
        try:
            _write_or_remove(target.path, target.old)
        except OSError as error:
            messages.problems([LoadProblem(target.path, f"was changed and cannot be restored: {error.strerror}")])


def stale_outputs(folders: Iterable[str]) -> list[str]:
    """The files in some folders that a build made and whose mission is no longer beside them.

    Subfolders are not searched, nor are targets of `-o`, which have no missions beside them.
    """
    stale: list[str] = []
    for folder in sorted(set(folders)):
        for xml in sorted(glob.glob(os.path.join(glob.escape(folder), "*.xml"))):
            stem = os.path.splitext(xml)[0]
            if any(os.path.exists(stem + suffix) for suffix in SUFFIXES) or not is_generated(read(xml)[0] or ""):
                continue
            stale.append(xml)
            side = side_path(xml)
            if os.path.exists(side) and is_side_file(read(side)[0] or ""):
                stale.append(side)
    return stale


_GUESSES_SHOWN: Final = 8
