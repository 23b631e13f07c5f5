"""`btq build`: write missions as XML that BehaviorTree.CPP loads."""

from __future__ import annotations

import glob
import os
import sys
from argparse import Namespace
from collections.abc import Collection, Iterable, Iterator
from typing import Final

from btq_lang.btcpp.enforcement import ClauseEnforcement, Enforcement
from btq_lang.btcpp.export import Export, is_mission
from btq_lang.btcpp.marks import is_generated
from btq_lang.btcpp.outputs import Output, Places, outputs, sources, without_tree
from btq_lang.btcpp.side_file import is_side_file, side_path
from btq_lang.btcpp.source import Remark
from btq_lang.catalog.versions import is_before_4
from btq_lang.commands.output import is_coloured, tell
from btq_lang.diagnostics.model import Place
from btq_lang.projects.building import errors, for_target
from btq_lang.projects.files import STDIN, Files, Group, no_mission_below, usage_problem, write_stdout
from btq_lang.projects.options import refuse
from btq_lang.render import Finding, Report, render, with_paths
from btq_lang.util.record import Record, replace
from btq_lang.util.text import Span, counted
from btq_lang.workspace.file import SUFFIXES
from btq_lang.workspace.loader import LoadProblem, absolute, read, shown, write_whole


class Target(Record):
    """A file to write or to remove.

    Attributes:
        text: the new contents; None: remove the file.
        old: the current contents; None: no file.
    """

    path: str
    text: str | None
    old: str | None


class Outcome(Record):
    """The result of one run.

    Attributes:
        code: the exit code.
        watched: the files that another run would depend on.
        files: those written, or already up to date.
    """

    code: int
    watched: tuple[str, ...]
    files: tuple[str, ...] = ()


def run(options: Namespace) -> int:
    """Build once, or again and again with `--watch`."""
    refuse(_usage_problem(options))
    files = Files()
    built = build(options, files)
    if options.watch:
        from btq_lang.commands.watch_mode import run_on_changes

        run_on_changes(lambda: build(options, files).watched, options.paths, built.watched)
    return built.code


def _usage_problem(options: Namespace) -> str | None:
    if options.watch and STDIN in options.paths:
        return "--watch cannot watch standard input"
    if STDIN in options.paths and (len(options.paths) > 1 or options.output or options.check):
        return "btq builds standard input to standard output; give no other path, no -o and no --check"
    return usage_problem(options.paths)


def build(options: Namespace, files: Files) -> Outcome:
    """Build once, and print messages."""
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
    tell(problems)
    if usage := no_mission_below(options.paths, groups):
        print(f"btq build: {usage}", file=sys.stderr)
    elif not options.target and any(is_before_4(group.workspace.project.target) for group in groups):
        usage = "btq writes XML for version 4 of the engine, and btq.toml names an older one: choose one with --target"
        print(f"btq build: {usage}", file=sys.stderr)
    if problems or usage:  # an unreadable file may be part of any other
        return Outcome(2, watched)
    if _has_errors(groups, options):
        return Outcome(1, watched)
    empty = [path for group in groups for path in without_tree(group.workspace, group.given)]
    for path in empty:
        print(f"btq build: {shown(path)} has no tree to run", file=sys.stderr)
    if empty and len(empty) == sum(len(group.given) for group in groups):
        print("nothing was written", file=sys.stderr)
        return Outcome(1, watched)
    built = dict.fromkeys(path for group in groups for path in sources(group.workspace, group.given))
    places = Places(absolute(options.output) if options.output else None, tuple(built))
    made = [output for group in groups for output in _outputs(group, places, options)]
    printed = 0
    for output in made:
        printed += _print_remarks(output.done.export.problems, "error", groups)
    for twice in _same_place(made):
        print(f"btq build: {twice}", file=sys.stderr)
        printed += 1
    if printed:
        print("nothing was written", file=sys.stderr)
        return Outcome(1, watched)
    for output in made:
        _print_remarks(output.done.export.repairs, "repaired", groups)
    _print_clauses([output.done for output in made], groups, options.verbose)
    if not options.check:
        _print_guesses([output.done.export for output in made])
    if STDIN in options.paths:
        for output in made:
            if output.path == files.stdin:
                write_stdout(output.text)
        return Outcome(0, watched)
    targets = [target for output in made for target in _targets(output)]
    gone = () if options.output else stale_outputs(os.path.dirname(path) for path in built)
    for path in gone:
        print(f"stale: {shown(path)}", file=sys.stdout if options.check else sys.stderr)
    code = _compare(targets, bool(gone)) if options.check else _write(targets, options)
    return Outcome(code, watched, tuple(target.path for target in targets if target.text is not None))


def _outputs(group: Group, places: Places, options: Namespace) -> tuple[Output, ...]:
    return outputs(
        group.workspace,
        group.given,
        places,
        bundled=options.bundle,
        verbatim=options.verbatim,
        enforce=not options.no_enforce,
    )


def _has_errors(groups: tuple[Group, ...], options: Namespace) -> bool:
    """Print the errors that prevent the build; returns whether there are any."""
    findings = [
        Finding(path, group.workspace.files[path].source, each)
        for group in groups
        for path, each in errors(
            group.workspace,
            group.given,
            bundled=options.bundle,
            verbatim=options.verbatim,
            replaces=not options.output,
        )
    ]
    if not findings:
        return False
    texts = {path: file.source for group in groups for path, file in group.workspace.files.items()}
    report = with_paths(Report(tuple(findings), texts, tuple(path for group in groups for path in group.given)), shown)
    colour = is_coloured(options, sys.stdout.isatty())
    sys.stdout.writelines(render(options.report, report, colour=colour))
    print("nothing was written", file=sys.stderr)
    return True


def _print_remarks(remarks: Collection[Remark], word: str, groups: tuple[Group, ...]) -> int:
    """Print an export's remarks; returns how many."""
    for remark in remarks:
        file = next(group.workspace.files[remark.path] for group in groups if remark.path in group.workspace.files)
        line, column = file.lines.position(remark.span.start)
        place = "" if file.origin else f":{line + 1}:{column + 1}"  # places are in the text that XML was converted to
        print(f"{shown(remark.path)}{place}: {word}: {remark.message}", file=sys.stderr)
    return len(remarks)


def _print_clauses(made: list[Enforcement], groups: tuple[Group, ...], verbose: bool) -> None:
    """Print how the clauses of requirements are covered, with a line for each one demanded to be enforced that is not,
    or that has a remark.
    """
    clauses: dict[object, ClauseEnforcement] = {}
    for each in (each for done in made for applied in done.clauses for each in applied):
        key = each.requirement, each.clause, each.place.path, each.place.span, id(each.node and each.node.node)
        if key not in clauses or each.way == "enforced":  # one file may enforce what another cannot
            clauses[key] = each
    for each in clauses.values():
        if not verbose and (not each.asked or (each.way == "enforced" and not each.why)):
            continue
        where = f" at {each.subject}" if each.subject else ""
        way = "not enforced, monitored" if each.asked and each.way == "monitored" else each.way
        why = f": {each.why}" if each.why else ""
        remark = Remark(*_absolute(each.place, groups), f"{each.requirement}, `{each.clause}`{where}{why}")
        _print_remarks((remark,), way, groups)
    known = {(each.requirement, each.clause, each.place.path, each.place.span) for each in clauses.values()}
    loose = {  # without those whose node another file has
        found: Remark(*_absolute(claim.place, groups), f"{requirement.name}, `{claim.text}` applies to no node")
        for done in made
        for requirement, claim in done.loose
        if (found := (requirement.name, claim.text, claim.place.path, claim.place.span)) not in known
    }
    _print_remarks(loose.values(), "not checked", groups)
    if clauses:
        ways = [each.way for each in clauses.values()]
        counted = [f"{ways.count(way)} {way}" for way in ("enforced", "monitored", "reviewed") if way in ways]
        counted += [f"{len(loose)} without a node"] if loose else []
        print(f"clauses of requirements: {', '.join(counted)}", file=sys.stderr)


def _print_guesses(exports: list[Export]) -> None:
    """Print which nodes got a guessed category in the models, because the mission does not declare it."""
    guessed = {name: category for each in exports for name, category in each.guessed.items()}
    shown = [f"{name} ({category})" for name, category in sorted(guessed.items())[:_GUESSES_SHOWN]]
    if len(guessed) > len(shown):
        shown.append(f"{len(guessed) - len(shown)} more")
    if shown:
        which = "declare a node whose category is wrong, for example `Condition Name`"
        print(f"categories guessed from the use of the nodes: {', '.join(shown)}; {which}", file=sys.stderr)


def _absolute(place: Place, groups: tuple[Group, ...]) -> tuple[str, Span]:
    """The file of a place, and its span in that file."""
    assert place.path is not None, "a clause is part of a file"
    file = next(group.workspace.files[place.path] for group in groups if place.path in group.workspace.files)
    return place.path, file.span_of(place)


def _same_place(made: list[Output]) -> Iterator[str]:
    """Messages for two files that would be written to one place: `a.btq` and `a.qualitybtcpp`."""
    known: dict[str, str] = {}
    for output in made:
        other = known.setdefault(output.place, output.path)
        if other != output.path:
            yield f"{shown(other)} and {shown(output.path)} would both be written to {shown(output.place)}"


def _targets(output: Output) -> Iterator[Target]:
    """The XML of a mission and its side file; an outdated side file is removed."""
    yield Target(output.place, output.text, _old_text(output.place))
    side = side_path(output.place)
    old = _old_text(side)
    if output.side is not None or (old is not None and is_side_file(old)):
        yield Target(side, output.side, old)


def _old_text(path: str) -> str | None:
    """The text of a file, empty if it cannot be read: then it is not one that btq wrote."""
    return (read(path)[0] or "") if os.path.exists(path) else None


def _compare(targets: list[Target], is_more_stale: bool) -> int:
    """`--check`: print the files that a build would change or remove."""
    stale = [target for target in targets if target.text != target.old]
    for target in stale:
        state = "missing" if target.old is None else "out of date" if target.text is not None else "stale"
        print(f"{state}: {shown(target.path)}")
    return int(bool(stale) or is_more_stale)


def _write(targets: list[Target], options: Namespace) -> int:
    """Write what has changed: all files, or none if one cannot be written."""
    changed = [target for target in targets if target.text != target.old]
    foreign = [target for target in changed if not options.force and _is_foreign(target.old)]
    for target in foreign:
        why = "is in the way: btq build did not write it (or wrote it with --verbatim)"
        instead = "write to another folder with -o FOLDER, or overwrite it with --force"
        print(f"btq build: {shown(target.path)} {why}; {instead}", file=sys.stderr)
    if foreign:
        print("nothing was written", file=sys.stderr)
        return 2
    done: list[Target] = []
    for target in changed:
        try:
            _put(target.path, target.text)
        except OSError as error:
            what = "written" if target.text is not None else "removed"
            print(f"btq: {LoadProblem(target.path, f'cannot be {what}: {error.strerror}')}", file=sys.stderr)
            _take_back(done)
            print("nothing was written", file=sys.stderr)
            return 2
        done.append(target)
    for target in changed:
        print(f"{'wrote' if target.text is not None else 'removed'} {shown(target.path)}")
    same = len(targets) - len(changed)
    if same:
        print(f"{counted(same, 'file')} unchanged", file=sys.stderr)
    return 0


def _put(path: str, text: str | None) -> None:
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


def _take_back(targets: list[Target]) -> None:
    """Restore the old contents of files, as far as possible."""
    for target in targets:
        try:
            _put(target.path, target.old)
        except OSError as error:
            problem = LoadProblem(target.path, f"was changed and cannot be restored: {error.strerror}")
            print(f"btq: {problem}", file=sys.stderr)


def stale_outputs(folders: Iterable[str]) -> list[str]:
    """The files in some folders that a build made and whose mission is no longer beside them.

    Subfolders are not searched, nor are targets of `-o`, which have no missions beside them.
    """
    found: list[str] = []
    for folder in sorted(set(folders)):
        for xml in sorted(glob.glob(os.path.join(glob.escape(folder), "*.xml"))):
            stem = os.path.splitext(xml)[0]
            if any(os.path.exists(stem + suffix) for suffix in SUFFIXES) or not is_generated(read(xml)[0] or ""):
                continue
            found.append(xml)
            side = side_path(xml)
            if os.path.exists(side) and is_side_file(read(side)[0] or ""):
                found.append(side)
    return found


_GUESSES_SHOWN: Final = 8
