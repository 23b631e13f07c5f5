"""Removal of what is unused: items that a rule reports, and includes that are duplicate or add nothing.

One invariant: an include is removed only where no finding, no name and no node that a requirement applies to changes.
Includes are never sorted, because their order has a meaning: of two trees with one ID the engine runs the last one that
it reads, btq takes the first of two definitions, and a build writes the includes in this order.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

from btq_lang.catalog.name_kinds import Kind
from btq_lang.checks import check
from btq_lang.checks.lookups import is_read
from btq_lang.ide.refactor import names_of_nodes
from btq_lang.requirements.resolve import requirements
from btq_lang.syntax.tokens import BLANK, COMMENT, DEDENT, INDENT, NEWLINE
from btq_lang.syntax.tree import Context, Entry, Include, Model, Models, Root, Signal, Tree, shape
from btq_lang.util.record import Record
from btq_lang.util.text import Edit, LineIndex, Position, Span, apply_edits
from btq_lang.workspace.file import File
from btq_lang.workspace.inputs import everything
from btq_lang.workspace.queries import Store
from btq_lang.workspace.workspace import Workspace

UNUSED = {
    "unused-context": "unused context",
    "unused-requirement": "unused requirement",
    "unused-signal": "unused signal",
    "unused-tree": "unused tree",
    "unreachable-tree": "unreachable tree",
}


class NeedlessInclude(Record):
    """An include that can be removed.  why: `duplicate` or `unused`."""

    name: str
    why: str
    span: Span


def removal(file: File, entry: Entry) -> tuple[Edit, ...]:
    """The edits that remove an item with its block, the comments in it and those at the end of its lines."""
    following = next((other.start for other in file.parsed.entries if other.start > entry.start), len(file.text))
    start = end = entry.start + entry.item.start
    column = file.lines.position(start).column
    for token in file.parsed.tokens:
        if not start <= token.start < following or token.kind in _NO_WORDS:
            continue
        if token.kind != COMMENT or file.lines.position(token.start).column > column:
            end = token.end
    return without(file, [Span(start, end)])


def needless_includes(workspace: Workspace, path: str) -> tuple[NeedlessInclude, ...]:
    """The includes of a file that repeat an earlier one, or that add nothing the mission uses.

    Only a mission has unused ones: a file that includes a library may use what the library includes.
    """
    return workspace.store.ask(_needless_includes, path)  # editors request it whenever the cursor moves


def _needless_includes(store: Store[Workspace], path: str) -> tuple[NeedlessInclude, ...]:
    workspace = store.ask(everything, path)
    file = workspace.files[path]
    includes = [one for one in file.includes if one.path is not None and not file.entry_of(one).diagnostics]
    if file.is_foreign or not includes:
        return ()
    duplicates = _duplicates(workspace, path, includes)
    needless = [*duplicates]
    is_mission = path not in workspace.included_files and workspace.main_tree(path) is not None
    if is_mission and workspace.store.ask(is_read, path):
        for include in reversed(includes):
            others = [other for other in includes if other is not include and not _is_among(other, needless)]
            lost = _brought_by(workspace, path, include, others) if not _is_among(include, needless) else set()
            if lost and not _uses(workspace, path, lost) and _changes_nothing(workspace, path, [*needless, include]):
                needless.append(include)
    return tuple(
        NeedlessInclude(_name(one), "duplicate" if _is_among(one, duplicates) else "unused", _span(file, one))
        for one in includes
        if _is_among(one, needless)
    )


def _duplicates(workspace: Workspace, path: str, includes: Sequence[Include]) -> list[Include]:
    """The includes of a file that an earlier one includes; empty where two trees or models have one name, because then
    the engine may run what it reads last."""
    seen: set[object] = set()
    duplicates = []
    for include in includes:
        key = workspace.included_by(path, include) or _name(include), shape(include.attributes)
        if key in seen:
            duplicates.append(include)
        seen.add(key)
    scope = workspace.scope(path)
    kinds = (Kind.TREE, Kind.MODEL) if duplicates else ()
    is_clear = not any(scope.is_repeated(kind, name) for kind in kinds for name in scope.names(kind))
    return duplicates if is_clear else []


def _brought_by(workspace: Workspace, path: str, include: Include, others: Sequence[Include]) -> set[str]:
    """The files that only one of the includes adds; empty if it is not found, or includes the mission."""

    def closure(included: Include) -> set[str]:
        target = workspace.included_by(path, included)
        return set(workspace.closure(target)) if target is not None else set()

    own = closure(include)
    return own.difference(*map(closure, others)) if path not in own else set()


def _uses(workspace: Workspace, path: str, gone: set[str]) -> bool:
    """Whether a mission uses what some of its files define, or may use it without naming it."""
    scope = workspace.scope(path)
    defined = {name for each in gone for name in workspace.files[each].defined_names}
    if not scope.complete or any(kind in (Kind.REQUIREMENT, Kind.QUALITY) for kind, _ in defined):
        return True  # the overview lists requirements that no node satisfies; a quality has several spellings
    remaining = [workspace.files[each] for each in scope.paths if each not in gone]
    named = {(kind, name) for file in remaining for kind, name in file.used_names}
    for file in remaining:
        nodes = names_of_nodes(file)
        named |= {(kind, name) for kind in (Kind.TREE, Kind.MODEL) for name in nodes}
        named |= {(kind, name) for kind in (Kind.SIGNAL, Kind.CONTEXT) for name in file.names_used("asked_for")}
    return not named.isdisjoint(defined) or not all(_is_plain(workspace, each) for each in gone)


def _is_plain(workspace: Workspace, path: str) -> bool:
    """Whether a file has no syntax errors and nothing that affects other files by itself, as `apply` does."""
    file = workspace.files[path]
    return workspace.store.ask(is_read, path) and all(isinstance(entry.item, _PLAIN) for entry in file.parsed.entries)


def _changes_nothing(workspace: Workspace, path: str, removed: Sequence[Include]) -> bool:
    """Whether a mission without some of its includes has the same findings, except those about them, and applies its
    requirements as often."""
    file = workspace.files[path]
    spans = [_span(file, include) for include in removed]
    after = workspace.with_file(path, apply_edits(file.text, without(file, spans)))
    if len(requirements(workspace, path).applied) != len(requirements(after, path).applied):
        return False
    before = [each for each in check(workspace, path) if not any(span.contains(each.span) for span in spans)]
    then, now = (
        Counter((each.rule, each.message) for each in diagnostics) for diagnostics in (before, check(after, path))
    )
    return then == now


def without(file: File, spans: Iterable[Span]) -> tuple[Edit, ...]:
    """The edits that remove some spans: with their lines if nothing else is on them, and with the blank lines that
    would remain; a comment after one stays."""
    text, lines = file.text, file.lines
    edits: list[Edit] = []
    gone: set[int] = set()
    for span in spans:
        first, last = lines.position(span.start).line, lines.position(span.end).line
        before = text[lines.offset(Position(first, 0)) : span.start].lstrip(_BOM)
        after = lines.line(last)[lines.position(span.end).column :]
        if before.strip(" \t") or after.strip(" \t"):
            edits.append(Edit(Span(span.start, span.end + len(after) - len(after.lstrip(" \t"))), ""))
        else:
            gone.update(range(first, last + 1))
    for first in sorted(gone):
        if first - 1 in gone:
            continue  # not the first of its run
        end = first
        was_blank = first == 0 or _is_blank(lines, first - 1)
        while end < lines.line_count and (end in gone or (was_blank and _is_blank(lines, end))):
            end += 1
        gone.update(range(first, end))
        if end < lines.line_count:
            edits.append(Edit(Span(_start(text, lines, first), lines.offset(Position(end, 0))), ""))
            continue
        while first and _is_blank(lines, first - 1):
            first -= 1
        start = _start(text, lines, first)
        if first and text[-1] not in "\r\n":
            start = lines.offset(Position(first - 1, len(lines.line(first - 1))))
        edits.append(Edit(Span(start, len(text)), ""))
    return tuple(sorted(edits, key=lambda edit: edit.span))


def _is_blank(lines: LineIndex, line: int) -> bool:
    return not lines.line(line).strip(" \t")


def _start(text: str, lines: LineIndex, line: int) -> int:
    start = lines.offset(Position(line, 0))
    return start + text.startswith(_BOM, start) if line == 0 else start


def _span(file: File, include: Include) -> Span:
    return Span(include.start, include.end).shifted(file.start_of(include))


def _name(include: Include) -> str:
    return include.path.text if include.path is not None else ""


def _is_among(include: Include, includes: Sequence[Include]) -> bool:
    """Whether it is one of them; two includes with the same text are equal, so `in` is not enough."""
    return any(include is other for other in includes)


_BOM = "\ufeff"
_NO_WORDS = frozenset((NEWLINE, BLANK, INDENT, DEDENT))
_PLAIN = (Tree, Model, Models, Signal, Context, Include, Root)
