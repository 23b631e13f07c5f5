"""From the word at a place to its definition, its type, its uses and its path."""

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
    found = at(workspace, path, offset)
    if found is None:
        return ()
    wanted = subject(workspace, found)
    if wanted.what is What.INCLUDE:
        target = wanted.name
        return (NavigationTarget(target, Span(0, 0), Span(0, 0), found.span),) if target in workspace.files else ()
    place = definition(workspace, path, wanted)
    in_cpp = _in_cpp(workspace, found, wanted, place)
    if in_cpp is not None:
        return (NavigationTarget(*in_cpp, in_cpp[1], found.span),)
    if place is not None:
        return (NavigationTarget(place.path, place.whole, place.span, found.span),)
    if wanted.what in (What.KEY, What.PORT, What.PARAMETER, What.INSTANCE):
        places = list(everywhere(workspace, wanted))
        first = next((one for one in places if one.mention.defines), None)
        if first is None and wanted.what is What.KEY:
            first = next((one for one in places if writes(workspace, one)), None)
        return (NavigationTarget(first.path, first.span, first.span, found.span),) if first else ()
    return ()


def _in_cpp(
    workspace: Workspace, found: ReferenceAt, wanted: Subject, place: Definition | None
) -> tuple[str, Span] | None:
    """Where in C++ a node or its port is, whatever models of it there are beside the code."""
    if place is not None and isinstance(place.symbol.target, Model):
        places = (cpp_place(workspace, each, place.symbol.name) for each in (found.path, place.path))
        return next(filter(None, places), None)
    node, owner = found.mention.node, found.mention.owner
    name = owner.name if isinstance(owner, Model) else node.id if node is not None else None
    return cpp_place(workspace, found.path, name.text, wanted.name) if wanted.what is What.PORT and name else None


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
    found = at(workspace, path, offset)
    if found is None or found.entry is None or found.mention.what in _WITHOUT_REFERENCES:
        return ()
    return everywhere(workspace, subject(workspace, found), paths)


def is_definition(workspace: Workspace, found: ReferenceAt) -> bool:
    """Whether a reference is the definition that counts, and not one of the repetitions of classic files."""
    if not found.mention.defines:
        return False
    place = definition(workspace, found.path, subject(workspace, found))
    return place is None or (place.path, place.span) == (found.path, found.span)


def writes(workspace: Workspace, found: ReferenceAt) -> bool:
    """Whether the blackboard entry named here gets its value here."""
    mention = found.mention
    if mention.what not in (What.KEY, What.PORT):
        return False
    if mention.writes:
        return True
    node, pair = mention.node, mention.pair
    if node is None or pair is None or pair.key.text.startswith("_"):
        return False
    port = port_of(workspace, found.path, node, pair.key.text)
    return port is not None and port.direction != "input"


def goto_implementation(workspace: Workspace, path: str, offset: int) -> tuple[NavigationTarget, ...]:
    """The nodes that refer to the requirement at a place; for everything else, the definition."""
    found = at(workspace, path, offset)
    wanted = subject(workspace, found) if found is not None else None
    if found is None or wanted is None or wanted.what is not What.REQUIREMENT:
        return goto_definition(workspace, path, offset)
    targets = {}
    for one in everywhere(workspace, wanted):
        node = one.mention.node
        if node is not None and one.entry is not None:
            name = node.head.span.shifted(one.entry.start)
            whole = Span(node.start, node.block_end).shifted(one.entry.start)
            targets[one.path, name] = NavigationTarget(one.path, whole, name, found.span)
    return tuple(targets.values())


def goto_type(workspace: Workspace, path: str, offset: int) -> tuple[NavigationTarget, ...]:
    """The model or the tree of a named node; the declaration of a requirement's custom quality."""
    found = at(workspace, path, offset)
    if found is None:
        return ()
    place: Definition | None = None
    wanted = subject(workspace, found)
    if wanted.what is What.INSTANCE:
        node = next((one.mention.node for one in everywhere(workspace, wanted) if one.mention.node is not None), None)
        if node is not None and node.id is not None:
            scope = workspace.scope(path)
            place = scope.find(Kind.MODEL, node.id.text) or scope.find(Kind.TREE, node.id.text)
    elif wanted.what is What.REQUIREMENT and (requirement := definition(workspace, path, wanted)) is not None:
        quality = quality_of(requirement)
        place = own_quality(workspace, requirement.path, quality.names[-1].text) if quality is not None else None
    if place is None:
        return ()
    return (NavigationTarget(place.path, place.whole, place.span, found.span),)


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


_WITHOUT_REFERENCES = frozenset((What.QUANTITY, What.UNIT, What.ATTRIBUTE, What.EDITION, What.RULE))
