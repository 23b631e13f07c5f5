"""Which tree runs which: the call hierarchy over subtrees."""

from __future__ import annotations

from btq_lang.catalog.name_kinds import Kind
from btq_lang.ide.meaning import ReferenceAt, Subject, at, definition, entry_at, everywhere, home_of, subject
from btq_lang.syntax.tree import Tree
from btq_lang.util.record import Record
from btq_lang.util.text import Span
from btq_lang.workspace.file import Definition
from btq_lang.workspace.references import What
from btq_lang.workspace.workspace import Workspace


class TreeItem(Record):
    """A tree; `name_span` is the span to select."""

    name: str
    path: str
    span: Span
    name_span: Span


class TreeCall(Record):
    """A tree that runs another, or is run by one.  places: the SubTrees, in the caller's file."""

    tree: TreeItem
    path: str
    places: tuple[Span, ...]


def prepare_calls(workspace: Workspace, path: str, offset: int) -> TreeItem | None:
    """The tree named at a place, or the tree around the node there."""
    found = at(workspace, path, offset)
    if found is not None:
        wanted = subject(workspace, found)
        place = definition(workspace, path, wanted) if wanted.what is What.TREE else None
        if place is not None:
            return _item(place)
    return None


def callers(workspace: Workspace, tree: TreeItem) -> tuple[TreeCall, ...]:
    """The trees that run a tree."""
    wanted = Subject(What.TREE, tree.name, f"{tree.path}:{tree.name_span.start}")
    found: dict[tuple[str, int], list[ReferenceAt]] = {}
    for one in everywhere(workspace, wanted):
        if one.mention.node is not None and one.entry is not None:
            found.setdefault((one.path, one.entry.start), []).append(one)
    calls = []
    for places in found.values():
        defined = workspace.files[places[0].path].defined
        trees = (each for each in defined if each.symbol.kind is Kind.TREE and each.entry is places[0].entry)
        caller = next(trees, None)
        if caller is not None:
            calls.append(TreeCall(_item(caller), caller.path, tuple(one.span for one in places)))
    return tuple(calls)


def called(workspace: Workspace, tree: TreeItem) -> tuple[TreeCall, ...]:
    """The trees that a tree runs, in the order of their first call."""
    start = tree.name_span.start
    entry = entry_at(workspace, tree.path, start) if tree.path in workspace.files else None
    item = entry.item if entry is not None else None
    if entry is None or not isinstance(item, Tree) or item.name is None or entry.start + item.name.start != start:
        return ()
    found: dict[str, tuple[Definition, list[Span]]] = {}
    for mention in workspace.files[tree.path].mentions_of(entry):
        is_run = mention.what is What.TREE and mention.node is not None
        place = workspace.scope(tree.path).find(Kind.TREE, mention.name) if is_run else None
        if place is not None:
            found.setdefault(home_of(place), (place, []))[1].append(mention.span.shifted(entry.start))
    return tuple(TreeCall(_item(place), tree.path, tuple(spans)) for place, spans in found.values())


def _item(place: Definition) -> TreeItem:
    return TreeItem(place.symbol.name, place.path, place.whole, place.span)
