"""`btq build`: write missions as XML that BehaviorTree.CPP loads."""

from __future__ import annotations

import os
import sys
from argparse import Namespace
from collections.abc import Iterator
from typing import Final

from btq_lang.btcpp.bundle import bundle
from btq_lang.btcpp.document import Comment, Document, write
from btq_lang.btcpp.enforcement import Enforcement, Held, enforced
from btq_lang.btcpp.export import Export, export, is_mission, xml_name
from btq_lang.btcpp.marks import generated_mark, is_generated
from btq_lang.btcpp.side_file import Built, is_side_file, side_file, side_path
from btq_lang.btcpp.source import Remark
from btq_lang.checks import check
from btq_lang.checks.includes import is_told_beside
from btq_lang.commands.files import STDIN, Files, Group, nothing_below, usage_problem
from btq_lang.commands.left_over import left_over
from btq_lang.diagnostics import Diagnostic, Place
from btq_lang.file import File
from btq_lang.loader import LoadProblem, absolute, read, shown, write_whole
from btq_lang.record import Record, replace
from btq_lang.render import Finding, Report, render, with_paths
from btq_lang.render.colour import wants_colour
from btq_lang.rules import Severity
from btq_lang.syntax import Tree
from btq_lang.text import Span
from btq_lang.workspace import Workspace


class Output(Record):
    """A file to be written, or to be removed.

    Attributes:
        text: what is to stand there; None: nothing.
        old: what stands there now; None: nothing.
    """

    path: str
    text: str | None
    old: str | None


class Outcome(Record):
    """What one run did.

    Attributes:
        code: the exit code.
        watched: the files that another run would depend on.
        files: what was written, or stood there already.
    """

    code: int
    watched: tuple[str, ...]
    files: tuple[str, ...] = ()


def run(options: Namespace) -> int:
    """Build once, or again and again with `--watch`."""
    if problem := _usage_problem(options):
        print(f"btq build: {problem}", file=sys.stderr)
        return 2
    files = Files()
    built = build(options, files)
    if options.watch:
        from btq_lang.commands.again import run_again

        run_again(lambda: build(options, files).watched, options.paths, built.watched)
    return built.code


def _usage_problem(options: Namespace) -> str | None:
    if options.watch and STDIN in options.paths:
        return "--watch cannot watch standard input"
    if STDIN in options.paths and (len(options.paths) > 1 or options.output or options.check):
        return "btq builds standard input to standard output; give no other path, no -o and no --check"
    return usage_problem(options.paths)


def build(options: Namespace, files: Files) -> Outcome:
    """One run; what there is to say of it is printed."""
    groups, problems = files.groups(options.paths, options.stdin_filename)
    if options.target:
        groups = tuple(_for_target(group, options.target) for group in groups)
    watched = tuple(
        path for group in groups for path in (*group.workspace.files, *group.absent, group.project_file) if path
    )
    problems += tuple(
        LoadProblem(path, "is XML already")
        for group in groups
        for path in group.given
        if not is_mission(group.workspace, path)
    )
    for problem in problems:
        print(f"btq: {problem}", file=sys.stderr)
    if nothing := nothing_below(options.paths, groups):
        print(f"btq build: {nothing}", file=sys.stderr)
    if problems or nothing:  # a file that could not be read may be part of any other
        return Outcome(2, watched)
    if _has_errors(groups, options):
        return Outcome(1, watched)
    empty = [path for group in groups for path in _without_tree(group)]
    for path in empty:
        print(f"btq build: {shown(path)} has no tree to run", file=sys.stderr)
    if empty and len(empty) == sum(len(group.given) for group in groups):
        print("nothing was written", file=sys.stderr)
        return Outcome(1, watched)
    sources = {path: None for group in groups for path in _sources(group)}
    places = _Places(options.output, tuple(sources))
    made = [
        (path, places.of(path), _exported(group, path, places, options))
        for group in groups
        for path in (_missions(group) if options.bundle else _sources(group))
    ]
    told = 0
    for _, _, done in made:
        told += _tell(done.export.problems, "error", groups)
    for twice in _same_place([(path, place) for path, place, _ in made]):
        print(f"btq build: {twice}", file=sys.stderr)
        told += 1
    if told:
        print("nothing was written", file=sys.stderr)
        return Outcome(1, watched)
    for _, _, done in made:
        _tell(done.export.repairs, "repaired", groups)
    _tell_clauses([done for _, _, done in made], groups, options.verbose)
    if not options.check:
        _tell_guessed([done.export for _, _, done in made])
    if STDIN in options.paths:
        for path, _, done in made:
            if path == files.stdin:
                sys.stdout.write(_text(path, done.export.document, options))
        return Outcome(0, watched)
    exports = {path: done for path, _, done in made}
    outputs: list[Output] = []
    for group in groups:
        for path in _missions(group) if options.bundle else _sources(group):
            outputs += _outputs(group.workspace, path, places, exports, options)
    gone = () if options.output else left_over(os.path.dirname(path) for path in sources)
    for path in gone:
        print(f"stale: {shown(path)}", file=sys.stdout if options.check else sys.stderr)
    code = _compare(outputs, bool(gone)) if options.check else _write(outputs, options)
    return Outcome(code, watched, tuple(output.path for output in outputs if output.text is not None))


def _for_target(group: Group, target: str) -> Group:
    project = replace(group.workspace.project, engines=(target,))
    return replace(group, workspace=group.workspace.with_project(project))


def _sources(group: Group) -> tuple[str, ...]:
    """The files that were asked for, and all that they include."""
    found = dict.fromkeys(group.given)
    for path in group.given:
        found.update(dict.fromkeys(group.workspace.closure(path)))
    return tuple(path for path in found if is_mission(group.workspace, path))


def _missions(group: Group) -> tuple[str, ...]:
    """The files that were asked for and that none of them includes."""
    included = group.workspace.included_files
    return tuple(path for path in group.given if path not in included) or group.given


def _without_tree(group: Group) -> Iterator[str]:
    """The files that were asked for, have no tree, and declare nothing that another file could use."""
    for path in group.given:
        workspace = group.workspace
        if path in workspace.included_files or not is_mission(workspace, path) or workspace.defined_in(path):
            continue
        entries = (entry for each in workspace.closure(path) for entry in workspace.files[each].parsed.entries)
        if not any(isinstance(entry.item, Tree) for entry in entries):  # a lone one needs no name
            yield path


# ---- what is wrong ----


def _has_errors(groups: tuple[Group, ...], options: Namespace) -> bool:
    """Tell what keeps the files from being built."""
    findings = []
    for group in groups:
        workspace = group.workspace
        sources = _sources(group)
        included = dict.fromkeys(each for path in sources for each in workspace.closure(path) if each not in sources)
        made = _missions(group) if options.bundle else sources
        replaced = () if options.output else tuple(map(xml_name, made))  # what stands there now is written over
        told = {*sources, *included}
        for path in (*sources, *(each for each in included if each not in replaced)):
            found = _read(workspace.files[path]) if options.verbatim else check(workspace, path)
            findings += [
                Finding(path, workspace.files[path].source, each)
                for each in found
                if each.effective_severity is Severity.ERROR and not is_told_beside(each, told)
            ]
    if not findings:
        return False
    texts = {path: file.source for group in groups for path, file in group.workspace.files.items()}
    report = with_paths(Report(tuple(findings), texts, tuple(path for group in groups for path in group.given)), shown)
    colour = options.color == "always" or (options.color == "auto" and wants_colour(sys.stdout.isatty(), os.environ))
    for piece in render(options.report, report, colour=colour, width=120):
        sys.stdout.write(piece)
    print("nothing was written", file=sys.stderr)
    return True


def _read(file: File) -> tuple[Diagnostic, ...]:
    """What is wrong with how a file is written, whatever it means."""
    return file.parsed.diagnostics if file.origin is None else file.origin.diagnostics


def _tell(remarks: tuple[Remark, ...], word: str, groups: tuple[Group, ...]) -> int:
    """Print what an export has to say; how much that was."""
    for remark in remarks:
        file = next(group.workspace.files[remark.path] for group in groups if remark.path in group.workspace.files)
        line, column = file.lines.position(remark.span.start)
        place = "" if file.origin else f":{line + 1}:{column + 1}"  # XML is read as this language would say it
        print(f"{shown(remark.path)}{place}: {word}: {remark.message}", file=sys.stderr)
    return len(remarks)


def _tell_clauses(made: list[Enforcement], groups: tuple[Group, ...], verbose: bool) -> None:
    """Print how the clauses of requirements are held: those that are to be enforced one by one, where they are not, or
    where there is something to say of it."""
    clauses: dict[object, Held] = {}
    for held in (held for done in made for applied in done.held for held in applied):
        key = held.requirement, held.clause, held.place.path, held.place.span, id(held.node and held.node.node)
        if key not in clauses or held.way == "enforced":  # what one file cannot enforce, another may
            clauses[key] = held
    for held in clauses.values():
        if not verbose and (not held.asked or (held.way == "enforced" and not held.why)):
            continue
        where = f" at {held.subject}" if held.subject else ""
        way = "not enforced, monitored" if held.asked and held.way == "monitored" else held.way
        why = f": {held.why}" if held.why else ""
        remark = Remark(*_absolute(held.place, groups), f"{held.requirement}, `{held.clause}`{where}{why}")
        _tell((remark,), way, groups)
    known = {(held.requirement, held.clause, held.place.path, held.place.span) for held in clauses.values()}
    loose = {
        (requirement.name, claim.text, claim.place.path, claim.place.span): claim.place
        for done in made
        for requirement, claim in done.loose
    }
    loose = {key: place for key, place in loose.items() if key not in known}  # one file's may be another's
    for (requirement, clause, *_), place in loose.items():
        remark = Remark(*_absolute(place, groups), f"{requirement}, `{clause}` applies to no node")
        _tell((remark,), "not checked", groups)
    if clauses:
        ways = [held.way for held in clauses.values()]
        counted = [f"{ways.count(way)} {way}" for way in ("enforced", "monitored", "reviewed") if way in ways]
        counted += [f"{len(loose)} without a node"] if loose else []
        print(f"clauses of requirements: {', '.join(counted)}", file=sys.stderr)


def _tell_guessed(exports: list[Export]) -> None:
    """Print which nodes have a model that says what they may be, for the mission does not say it."""
    guessed = {name: category for each in exports for name, category in each.guessed.items()}
    shown = [f"{name} ({category})" for name, category in sorted(guessed.items())[:_GUESSES_SHOWN]]
    if len(guessed) > len(shown):
        shown.append(f"{len(guessed) - len(shown)} more")
    if shown:
        which = "declare a node whose category is wrong, for example `Condition Name`"
        print(f"categories guessed from the use of the nodes: {', '.join(shown)}; {which}", file=sys.stderr)


def _absolute(place: Place, groups: tuple[Group, ...]) -> tuple[str, Span]:
    """The file of a place, and where it is in that."""
    assert place.path is not None, "a clause is part of a file"
    file = next(group.workspace.files[place.path] for group in groups if place.path in group.workspace.files)
    return place.path, place.span.shifted(file.start_of(place.anchor)) if place.anchor is not None else place.span


def _same_place(places: list[tuple[str, str]]) -> Iterator[str]:
    """Two files that would be written to one place: `a.btq` and `a.qualitybtcpp`."""
    known: dict[str, str] = {}
    for source, place in places:
        other = known.setdefault(place, source)
        if other != source:
            yield f"{shown(other)} and {shown(source)} would both be written to {shown(place)}"


# ---- what is written, and where ----


class _Places:
    """Where the XML of each file is put: beside it, or below the folder `output`, in the places they have below the
    folder that holds them all."""

    def __init__(self, output: str | None, sources: tuple[str, ...]) -> None:
        self._output = absolute(output) if output else None
        folders = [os.path.dirname(source) for source in sources]
        self._above = os.path.commonpath(folders).replace(os.sep, "/") if output and folders else ""

    def of(self, source: str) -> str:
        """The place of the XML of one of the files."""
        if self._output is None:
            return xml_name(source)
        return absolute(os.path.join(self._output, os.path.relpath(xml_name(source), self._above)))

    def seen_from(self, source: str, included: str, workspace: Workspace) -> str:
        """How the XML of `source` names an included file: that made from it, or an XML file where it is."""
        place = self.of(included) if is_mission(workspace, included) else included
        return os.path.relpath(place, os.path.dirname(self.of(source))).replace(os.sep, "/")


def _exported(group: Group, path: str, places: _Places, options: Namespace) -> Enforcement:
    workspace = group.workspace
    if options.bundle:
        done = bundle(workspace, path, verbatim=options.verbatim)
    else:
        name = places.seen_from
        done = export(workspace, path, verbatim=options.verbatim, included_as=lambda to: name(path, to, workspace))
    if options.verbatim or options.no_enforce or done.problems:
        return Enforcement(done, ())
    return enforced(workspace, path, done, options.bundle)


def _text(path: str, document: Document, options: Namespace) -> str:
    if options.verbatim:
        return write(document)
    return write(Document([Comment(generated_mark(os.path.basename(path))), *document.contents]))


def _outputs(
    workspace: Workspace, path: str, places: _Places, exports: dict[str, Enforcement], options: Namespace
) -> Iterator[Output]:
    """The XML of a mission, and its side file, where it says more than that; one of an earlier build goes."""
    done = exports[path].export
    place = places.of(path)
    text = _text(path, done.document, options)
    yield Output(place, text, _old_text(place))
    side = None if options.verbatim else _side_text(workspace, path, place, text, exports, options)
    old = _old_text(side_path(place))
    if side is not None or (old is not None and is_side_file(old)):
        yield Output(side_path(place), side, old)


def _side_text(
    workspace: Workspace, path: str, place: str, text: str, exports: dict[str, Enforcement], options: Namespace
) -> str | None:
    """The side file of a mission's XML."""
    parts: tuple[Export, ...] = (exports[path].export,)
    if not options.bundle:  # XML that it includes is read as this language says it
        parts = tuple(
            exports[each].export if each in exports else export(workspace, each) for each in workspace.closure(path)
        )
    elements = {key: element for part in parts for key, element in part.elements.items()}
    documents = tuple(part.document for part in parts)
    return side_file(workspace, Built(path, place, text, documents, elements, exports[path].held))


def _old_text(path: str) -> str | None:
    return read(path)[0] if os.path.exists(path) else None


def _compare(outputs: list[Output], is_more_stale: bool) -> int:
    """`--check`: name the files that are not what they would be, or would not be."""
    stale = [output for output in outputs if output.text != output.old]
    for output in stale:
        state = "missing" if output.old is None else "out of date" if output.text is not None else "stale"
        print(f"{state}: {shown(output.path)}")
    return int(bool(stale) or is_more_stale)


def _write(outputs: list[Output], options: Namespace) -> int:
    """Write what has changed: all of it, or where one file cannot be written, none."""
    changed = [output for output in outputs if output.text != output.old]
    foreign = [output for output in changed if not options.force and _is_foreign(output.old)]
    for output in foreign:
        why = "not overwritten, because it was not generated by btq build (or was built with --verbatim)"
        print(f"btq build: {shown(output.path)}: {why}; use --force to overwrite it", file=sys.stderr)
    if foreign:
        print("nothing was written", file=sys.stderr)
        return 2
    done: list[Output] = []
    for output in changed:
        try:
            _put(output.path, output.text)
        except OSError as error:
            what = "written" if output.text is not None else "removed"
            print(f"btq: {LoadProblem(output.path, f'cannot be {what}: {error.strerror}')}", file=sys.stderr)
            _take_back(done)
            print("nothing was written", file=sys.stderr)
            return 2
        done.append(output)
    for output in changed:
        print(f"{'wrote' if output.text is not None else 'removed'} {shown(output.path)}")
    same = len(outputs) - len(changed)
    if same:
        print(f"{same} file{'' if same == 1 else 's'} unchanged", file=sys.stderr)
    return 0


def _put(path: str, text: str | None) -> None:
    """Write a file, or remove it.

    Raises:
        OSError: it cannot be.
    """
    if text is None:
        os.unlink(path)
    else:
        os.makedirs(os.path.dirname(path), exist_ok=True)
        write_whole(path, text)


def _is_foreign(text: str | None) -> bool:
    return text is not None and not is_generated(text) and not is_side_file(text)


def _take_back(outputs: list[Output]) -> None:
    """Put back what stood in files before, as far as the disk lets us."""
    for output in outputs:
        try:
            _put(output.path, output.old)
        except OSError as error:
            problem = LoadProblem(output.path, f"was changed and cannot be restored: {error.strerror}")
            print(f"btq: {problem}", file=sys.stderr)


_GUESSES_SHOWN: Final = 8
