"""From the word at a place to its definition, its type, its uses and its path; from a tree to its callers."""

from __future__ import annotations

from collections.abc import Iterable

from btq_lang.catalog.name_kinds import Kind
from btq_lang.ide.block import nodes_at
from btq_lang.ide.meaning import (
    ReferenceAt,
    Subject,
    at,
    definition,
    entry_at,
    everywhere,
    home_of,
    own_quality,
    quality_of,
    subject,
)
from btq_lang.ide.ports import cpp_place, port_of
from btq_lang.syntax.tree import Model, Tree, is_name, written
from btq_lang.util.record import Record
from btq_lang.util.text import Span
from btq_lang.workspace.file import Definition
from btq_lang.workspace.references import What
from btq_lang.workspace.workspace import Workspace


class NavigationTarget(Record):
    """A place to go to.

    Attributes:
        span: all of what is defined there.
        name: the word to select.
        origin: the word at the cursor.
    """

    path: str
    span: Span
    name: Span
    origin: Span


class Highlight(Record):
    """A reference in the same file; `writes`: whether it gives the name or the value, instead of using it."""

    span: Span
    writes: bool


def goto_definition(workspace: Workspace, path: str, offset: int) -> tuple[NavigationTarget, ...]:
    """Where the word at a place is defined; for a name out of scope, its definitions elsewhere in the project.

    A node and its ports are defined in the C++ that registers it, if that is known, and else in a model.  A blackboard
    entry is defined where its tree declares it as a port, or else where it is first written.
    """
    reference = at(workspace, path, offset)
    if reference is None:
        return ()
    referent = subject(workspace, reference)
    if referent.what is What.INCLUDE:
        target = referent.name
        return (NavigationTarget(target, Span(0, 0), Span(0, 0), reference.span),) if target in workspace.files else ()
    place = definition(workspace, path, referent)
    in_cpp = _in_cpp(workspace, reference, referent, place)
    if in_cpp is not None:
        return (NavigationTarget(*in_cpp, in_cpp[1], reference.span),)
    if place is not None:
        return (NavigationTarget(place.path, place.whole, place.span, reference.span),)
    if referent.what in (What.KEY, What.PORT, What.PARAMETER, What.INSTANCE):
        places = list(everywhere(workspace, referent))
        first = next((one for one in places if one.mention.defines), None)
        if first is None and referent.what is What.KEY:
            first = next((one for one in places if writes(workspace, one)), None)
        return (NavigationTarget(first.path, first.span, first.span, reference.span),) if first else ()
    return ()


def _in_cpp(
    workspace: Workspace, reference: ReferenceAt, referent: Subject, place: Definition | None
) -> tuple[str, Span] | None:
    """Where in C++ a node or its port is, whatever models of it there are beside the code."""
    if place is not None and isinstance(place.symbol.target, Model):
        places = (cpp_place(workspace, each, place.symbol.name) for each in (reference.path, place.path))
        return next(filter(None, places), None)
    node, owner = reference.mention.node, reference.mention.owner
    name = owner.name if isinstance(owner, Model) else node.id if node is not None else None
    return (
        cpp_place(workspace, reference.path, name.text, referent.name) if referent.what is What.PORT and name else None
    )


def find_references(
    workspace: Workspace, path: str, offset: int, include_definition: bool = True
) -> tuple[tuple[str, Span], ...]:
    """Every reference, in every file, to what the word at a place means."""
    places = _references(workspace, path, offset, None)
    return tuple((one.path, one.span) for one in places if include_definition or not is_definition(workspace, one))


def highlights(workspace: Workspace, path: str, offset: int) -> tuple[Highlight, ...]:
    """The references in this file to what the word at a place means."""
    places = _references(workspace, path, offset, (path,))
    return tuple(Highlight(one.span, one.mention.defines or writes(workspace, one)) for one in places)


def _references(workspace: Workspace, path: str, offset: int, paths: tuple[str, ...] | None) -> Iterable[ReferenceAt]:
    reference = at(workspace, path, offset)
    if reference is None or reference.entry is None or reference.mention.what in _WITHOUT_REFERENCES:
        return ()
    return everywhere(workspace, subject(workspace, reference), paths)


def is_definition(workspace: Workspace, reference: ReferenceAt) -> bool:
    """Whether a reference is the definition that counts, and not one of the repetitions of classic files."""
    if not reference.mention.defines:
        return False
    place = definition(workspace, reference.path, subject(workspace, reference))
    return place is None or (place.path, place.span) == (reference.path, reference.span)


def writes(workspace: Workspace, reference: ReferenceAt) -> bool:
    """Whether the blackboard entry named here gets its value here."""
    mention = reference.mention
    if mention.what not in (What.KEY, What.PORT):
        return False
    if mention.writes:
        return True
    node, pair = mention.node, mention.pair
    if node is None or pair is None or pair.key.text.startswith("_"):
        return False
    port = port_of(workspace, reference.path, node, pair.key.text)
    return port is not None and port.direction != "input"


def goto_implementation(workspace: Workspace, path: str, offset: int) -> tuple[NavigationTarget, ...]:
    """The nodes that refer to the requirement at a place; for everything else, the definition."""
    reference = at(workspace, path, offset)
    referent = subject(workspace, reference) if reference is not None else None
    if reference is None or referent is None or referent.what is not What.REQUIREMENT:
        return goto_definition(workspace, path, offset)
    targets = {}
    for use in everywhere(workspace, referent):
        node = use.mention.node
        if node is not None and use.entry is not None:
            name = node.head.span.shifted(use.entry.start)
            whole = Span(node.start, node.block_end).shifted(use.entry.start)
            targets[use.path, name] = NavigationTarget(use.path, whole, name, reference.span)
    return tuple(targets.values())


def goto_type(workspace: Workspace, path: str, offset: int) -> tuple[NavigationTarget, ...]:
    """The model or the tree of a named node; the declaration of a requirement's custom quality."""
    reference = at(workspace, path, offset)
    if reference is None:
        return ()
    place: Definition | None = None
    referent = subject(workspace, reference)
    if referent.what is What.INSTANCE:
        node = next((one.mention.node for one in everywhere(workspace, referent) if one.mention.node is not None), None)
        if node is not None and node.id is not None:
            scope = workspace.scope(path)
            place = scope.find(Kind.MODEL, node.id.text) or scope.find(Kind.TREE, node.id.text)
    elif referent.what is What.REQUIREMENT and (requirement := definition(workspace, path, referent)) is not None:
        quality = quality_of(requirement)
        place = own_quality(workspace, requirement.path, quality.names[-1].text) if quality is not None else None
    if place is None:
        return ()
    return (NavigationTarget(place.path, place.whole, place.span, reference.span),)


def node_path(workspace: Workspace, path: str, offset: int) -> str | None:
    """The names of the tree and of all nodes down to the one at a place, instance names before kinds; unnamed control
    nodes that are symbols are left out, for no path can name them.  None if there is no node."""
    entry = entry_at(workspace, path, offset)
    line = nodes_at(workspace.files[path], entry, offset) if entry is not None else ()
    if not line or entry is None or not isinstance(entry.item, Tree):
        return None
    words = [entry.item.name, *(node.name or node.id for node in line)]
    names = [word.text for word in words if word is not None and (word.quoted or is_name(word.text))]
    return "/".join(map(written, names))


# ---- the call hierarchy of trees ----


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
    reference = at(workspace, path, offset)
    if reference is not None:
        referent = subject(workspace, reference)
        place = definition(workspace, path, referent) if referent.what is What.TREE else None
        if place is not None:
            return _item(place)
    return None


def callers(workspace: Workspace, tree: TreeItem) -> tuple[TreeCall, ...]:
    """The trees that run a tree."""
    referent = Subject(What.TREE, tree.name, f"{tree.path}:{tree.name_span.start}")
    by_caller: dict[tuple[str, int], list[ReferenceAt]] = {}
    for reference in everywhere(workspace, referent):
        if reference.mention.node is not None and reference.entry is not None:
            by_caller.setdefault((reference.path, reference.entry.start), []).append(reference)
    calls = []
    for places in by_caller.values():
        defined = workspace.files[places[0].path].defined
        trees = (tree for tree in defined if tree.symbol.kind is Kind.TREE and tree.entry is places[0].entry)
        caller = next(trees, None)
        if caller is not None:
            calls.append(TreeCall(_item(caller), caller.path, tuple(reference.span for reference in places)))
    return tuple(calls)


def called(workspace: Workspace, tree: TreeItem) -> tuple[TreeCall, ...]:
    """The trees that a tree runs, in the order of their first call."""
    start = tree.name_span.start
    entry = entry_at(workspace, tree.path, start) if tree.path in workspace.files else None
    item = entry.item if entry is not None else None
    if entry is None or not isinstance(item, Tree) or item.name is None or entry.start + item.name.start != start:
        return ()
    callees: dict[str, tuple[Definition, list[Span]]] = {}
    for mention in workspace.files[tree.path].mentions_of(entry):
        is_run = mention.what is What.TREE and mention.node is not None
        place = workspace.scope(tree.path).find(Kind.TREE, mention.name) if is_run else None
        if place is not None:
            callees.setdefault(home_of(place), (place, []))[1].append(mention.span.shifted(entry.start))
    return tuple(TreeCall(_item(place), tree.path, tuple(spans)) for place, spans in callees.values())


def _item(place: Definition) -> TreeItem:
    return TreeItem(place.symbol.name, place.path, place.whole, place.span)


_WITHOUT_REFERENCES = frozenset((What.QUANTITY, What.UNIT, What.ATTRIBUTE, What.EDITION, What.RULE))
