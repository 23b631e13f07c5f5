"""Blackboard entries to which two ports give different types.

Source: createNodeFromXML in src/xml_parsing.cpp of 4.6.2, 4.8.4 and 4.10.0: the first port to which an entry is
assigned creates it, with the port's type; a later port of another type makes loading fail, unless the first type
accepts texts or anything.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Final, TypeAlias

from btq_lang.catalog.literals import is_known_type, plain_type
from btq_lang.catalog.name_kinds import Kind
from btq_lang.checks import lookups
from btq_lang.checks.calls import callers
from btq_lang.checks.entries import mentions
from btq_lang.checks.pointers import passed_on, pointed_at
from btq_lang.checks.view import View, port_of
from btq_lang.diagnostics.model import Diagnostic, Fix, Place, Related, replace_fix
from btq_lang.diagnostics.rules import Severity
from btq_lang.syntax.tree import Pair
from btq_lang.util.grouping import grouped
from btq_lang.util.reach import reached
from btq_lang.util.record import Record
from btq_lang.util.spelling import did_you_mean
from btq_lang.workspace import inputs
from btq_lang.workspace.inputs import of_scope
from btq_lang.workspace.port_types import is_text
from btq_lang.workspace.queries import Store, on_circle
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace


class _Port(Record):
    """A port of a node: the tree it is in, the number of the node in it, and that of the attribute at the node."""

    tree: str
    node: int
    pair: int


class _Meeting(Record):
    """An entry of a tree assigned to a port.

    Attributes:
        type: of the port; empty if unknown or if it takes anything.
        node: the number of the node in the tree itself: the port's, or the SubTree below which the port is.
        pair: the number of that node's attribute; None if the SubTree gets it without one.
        port: the port itself.
    """

    type: str
    node: int
    pair: int | None
    port: _Port


# The ports to which each entry of a tree is assigned, in the engine's order, the first of each type.
_Types: TypeAlias = "dict[str, list[_Meeting]]"


def entry_with_two_types(view: View) -> Iterator[Diagnostic]:
    """An entry that is assigned to ports of two types: the engine refuses to load the tree."""
    name = view.tree_name
    if name is not None and view.ask(lookups.has_pointers) and view.defines_here(Kind.TREE, name.text):
        yield from view.ask(_clashes_in, name.text)


def _clashes_in(store: Store[Workspace], viewpoint: str, tree: str) -> tuple[Diagnostic, ...]:
    view = View(store, viewpoint)
    diagnostics: list[Diagnostic] = []
    types = view.ask(_types, tree)
    is_main = any(name[:1] == "@" for name in types) and view.main_tree == tree
    for key in dict.fromkeys(name.removeprefix("@") for name in types):
        meetings = types.get(key, [])
        if is_main and (shared := types.get(f"@{key}")):  # the same entry
            meetings = sorted((*meetings, *shared), key=lambda meeting: meeting.node)
        if len(meetings) > 1:
            diagnostics += _clashes(view, tree, key, meetings)
    return tuple(diagnostics)


@on_circle({})
@of_scope
def _types_below(store: Store[Workspace], viewpoint: str, tree: str) -> _Types:
    """The types that a tree passes on to those that run it; empty if it runs itself."""
    return _types(store, viewpoint, tree)


@of_scope
def _types(store: Store[Workspace], viewpoint: str, tree: str) -> _Types:
    """The types of the ports to which entries of a tree are assigned, in it and below.  `_types_below` calls it and
    does not ask for it, or it would be part of each circle."""
    view = View(store, viewpoint)
    types: _Types = {}
    for number, resolved in enumerate(view.nodes_of(tree).all):
        if resolved.is_subtree:
            for key, passed_at, below in _handed_on(view, resolved):
                _add(types, key, _Meeting(below.type, number, passed_at, below.port))
            continue
        for index, pair in enumerate(resolved.node.attributes):
            value = pair.value
            if value is not None and "{" in value.raw and (entry := pointed_at(pair.key.text, value.text)) is not None:
                port = port_of(view, resolved, pair.key.text)
                type_ = plain_type(port.type) if port is not None and port.type not in _ANYTHING else ""
                _add(types, entry, _Meeting(type_, number, index, _Port(tree, number, index)))
    return types


def _handed_on(view: View, resolved: ResolvedNode) -> Iterator[tuple[str, int | None, _Meeting]]:
    """The uses of entries that a SubTree passes to its tree, by their names in the tree of the SubTree."""
    if resolved.id is None or not resolved.id.text:
        return
    positions = {
        pair.key.text: position
        for position, pair in reversed([*enumerate(resolved.node.attributes)])
        if pair.value is not None
    }
    for port, meetings in view.ask(_types_below, resolved.id.text).items():
        position = positions.get(port)
        key = port if port[0] == "@" else passed_on(resolved, port)
        if key:
            yield from ((key, position, meeting) for meeting in meetings)


def _is_first(view: View, tree: str, key: str) -> bool:
    """Whether on some way into a tree the entry gets its type from the tree's first port, or above from a port whose
    type accepts no texts."""

    def entry_above(place: tuple[str, str | None]) -> Iterator[tuple[str, str | None]]:
        """The entry in the trees that run a tree, where the first port creates it; None: it is that tree's own."""
        name, entry = place
        if entry is None:
            return
        for caller in view.ask(callers, name):
            for resolved in view.nodes_of(caller).all:
                if resolved.is_subtree and resolved.id is not None and resolved.id.text == name:
                    passed = passed_on(resolved, entry)
                    meetings = view.ask(_types, caller).get(passed, ()) if passed else ()
                    if passed is None or (meetings and _is_strong(meetings[0].type)):
                        yield caller, passed

    start: tuple[str, str | None] = tree, key
    return any(entry is None or not view.ask(callers, name) for name, entry in reached([start], entry_above))


def _clashes(view: View, tree: str, key: str, meetings: list[_Meeting]) -> Iterator[Diagnostic]:
    first = meetings[0]
    # The order of ports at one node is unspecified.
    if not all(_is_strong(meeting.type) for meeting in meetings if meeting.node == first.node):
        return
    nodes = view.nodes_of(tree).all
    reported = {first.type}
    for later in meetings:
        is_one = (later.node, later.pair) == (first.node, first.pair) and later.pair is not None
        if later.type in reported or not later.type or is_one:
            continue
        severity = _severity(first.type, later.type)
        if severity is None or not _is_first(view, tree, key):
            continue
        reported.add(later.type)
        span = nodes[later.node].node.head.span
        if later.pair is not None and (value := nodes[later.node].node.attributes[later.pair].value) is not None:
            span = value.span
        resolved, port = _port(view, first.port)
        later_seen, later_port = _port(view, later.port)
        related = [_related(view, first.port, f"created here as {first.type}")]
        if later.port.tree != tree or later.port.node != later.node:
            related.append(_related(view, later.port, f"used here as {later.type}"))
        message = (
            f"`{port.key.text}` of {resolved.shown_kind} creates `{{{key}}}` as {first.type}, "
            f"but `{later_port.key.text}` of {later_seen.shown_kind} has the type {later.type}"
        )
        unless = "" if severity is Severity.ERROR else ", unless one of the types is an alias for the other"
        refuses = f"BehaviorTree.CPP refuses to load this tree{unless}"
        notes = (f"{refuses}; use an entry for each type, and copy the value in a script: `other := entry`",)
        fixes: tuple[Fix, ...] = ()
        if later.pair is not None and later.port.tree == tree and (meant := _meant(view, tree, later.type)):
            message += did_you_mean((meant,))
            notes, fixes = (refuses,), (replace_fix(f"Write `{meant}`", span, meant),)
        yield Diagnostic("entry-with-two-types", span, message, tuple(related), notes, fixes, severity=severity)


def _meant(view: View, tree: str, type_: str) -> str | None:
    """The only entry of a tree that has a type and is written, but not read."""
    unread = view.ask(_unread_by_type, tree).get(type_, ())
    return f"{{{unread[0]}}}" if len(unread) == 1 else None


def _unread_by_type(store: Store[Workspace], viewpoint: str, tree: str) -> dict[str, list[str]]:
    """The entries of a tree that are written, but not read, and have one type, by that type."""
    view = View(store, viewpoint)
    definition = view.ask(inputs.definition, Kind.TREE, tree)
    entries = view.ask(mentions, *definition) if definition is not None else ()
    read = {mention.name for mention in entries if mention.reads or mention.node.is_subtree}
    unread = {mention.name for mention in entries if mention.writes} - read
    types = ((key, [meeting.type for meeting in meetings]) for key, meetings in view.ask(_types, tree).items())
    return grouped((of_key[0], key) for key, of_key in types if key in unread and len(of_key) == 1)


def _port(view: View, port: _Port) -> tuple[ResolvedNode, Pair]:
    resolved = view.nodes_of(port.tree).all[port.node]
    return resolved, resolved.node.attributes[port.pair]


def _related(view: View, port: _Port, message: str) -> Related:
    tree = view.ask(lookups.declaration, Kind.TREE, port.tree)
    assert tree is not None, "its nodes have been seen"
    return Related(Place(_port(view, port)[1].key.span, tree.path, tree.owner.item), message)


def _severity(first: str, later: str) -> Severity | None:
    """The severity for two types; None if they may be one: a type of a program may be an alias for another."""
    if is_known_type(first) and is_known_type(later):
        return Severity.ERROR
    if any(_VECTOR(one) and _MESSAGE(other) for one, other in ((first, later), (later, first))):
        return Severity.WARNING  # a message of ROS is a class of its own
    if _MESSAGE(first) and _MESSAGE(later) and first.rpartition("::")[2] != later.rpartition("::")[2]:
        return Severity.ERROR
    if "<" in first + later or first.rpartition("::")[2].casefold() == later.rpartition("::")[2].casefold():
        return None
    return Severity.WARNING


def _is_strong(type_: str) -> bool:
    return bool(type_) and not is_text(type_)


def _add(types: dict[str, list[_Meeting]], key: str, meeting: _Meeting) -> None:
    meetings = types.setdefault(key, [])
    if all(other.type != meeting.type for other in meetings):
        meetings.append(meeting)


_VECTOR: Final = re.compile(r"std::vector<.*>").fullmatch
_MESSAGE: Final = re.compile(r"\w+::msg::\w+").fullmatch
_ANYTHING: Final = frozenset(("", "BT::Any", "BT::AnyTypeAllowed", "Any", "AnyTypeAllowed", "any", "auto"))
