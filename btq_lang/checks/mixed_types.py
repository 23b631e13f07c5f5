"""Blackboard entries that two ports give two types.

Source: createNodeFromXML in src/xml_parsing.cpp of 4.6.2, 4.8.4 and 4.10.0: the first port that is given an entry makes
it, with the port's type; a port of another type that is given it later ends the making of the tree, unless the first
type was that of texts or of anything.
"""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.catalog.literals import is_known_type, plain_type
from btq_lang.catalog.nodes import port_type
from btq_lang.checks.pointers import pointed_at, remaps_all
from btq_lang.checks.view import SeenNode, View
from btq_lang.diagnostics import Diagnostic, Place, Related
from btq_lang.entry_types import declared_type, is_text
from btq_lang.record import record
from btq_lang.rules import Severity
from btq_lang.symbols import Kind
from btq_lang.syntax import Entry, Pair, Tree
from btq_lang.workspace import Definition

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from typing import Final


@record
class _Meeting:
    """An entry of a tree given to a port.

    Attributes:
        type: of the port; nothing where nobody knows it, or where it takes anything.
        node: in the tree itself: the port's, or the SubTree below which the port is.
        given: the attribute of that node; None where the SubTree gets it without one.
        at: the tree that the port's node stands in, the attribute that gives the entry to it, and the node.
    """

    type: str
    node: SeenNode
    given: Pair | None
    at: tuple[Definition, Pair, SeenNode]


def entry_with_two_types(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """An entry that ports of two types are given: the engine makes no tree of it."""
    tree = entry.item
    if not isinstance(tree, Tree) or tree.name is None or "{" not in view.file.text:
        return
    definition = view.scope.find(Kind.TREE, tree.name.text)
    if definition is None or not view.is_this(definition, entry):
        return
    is_main = view.main_tree is not None and view.is_this(view.main_tree, entry)
    known = view.entry_types.of(tree.name.text)
    for key in dict.fromkeys(name.removeprefix("@") for name in known):
        meetings = known.get(key, [])
        if is_main and (shared := known.get(f"@{key}")):  # the same entry
            meetings = sorted((*meetings, *shared), key=lambda each: each.node.node.start)
        if len(meetings) > 1:
            yield from _clashes(view, tree.name.text, key, meetings)


class EntryTypes:
    """The types that the entries of the trees in scope meet."""

    def __init__(self, view: View) -> None:
        self._view = view
        self._of: dict[str, dict[str, list[_Meeting]]] = {}

    def of(self, tree: str) -> dict[str, list[_Meeting]]:
        """The ports that are given each entry of a tree, in the engine's order, the first of each type."""
        waiting = [tree]
        while waiting:
            name = waiting[-1]
            below = [each for each in self._view.calls.called_by(name) if each not in self._of]
            if name not in self._of and below and name not in waiting[:-1]:
                waiting += below
                continue
            waiting.pop()
            if name not in self._of:
                self._of[name] = self._met_in(name)
        return self._of[tree]

    def is_first(self, tree: str, key: str) -> bool:
        """Whether in some way into a tree the first of its ports makes the entry, or meets a type that is one."""
        seen = {(tree, key)}
        waiting = [(tree, key)]
        while waiting:
            name, entry = waiting.pop()
            callers = self._view.calls.callers(name)
            if not callers:
                return True
            for caller in callers:
                for given in self._given(caller, name, entry):
                    if given is None:
                        return True
                    meetings = self.of(caller).get(given, ())
                    if given and meetings and _is_strong(meetings[0].type) and (caller, given) not in seen:
                        seen.add((caller, given))
                        waiting.append((caller, given))
        return False

    def _given(self, caller: str, tree: str, key: str) -> Iterator[str | None]:
        """What the SubTree nodes of one tree call an entry of another one; None: nothing, it is that tree's own; an
        empty text: a value."""
        definition = self._view.scope.find(Kind.TREE, caller)
        for seen in self._view.nodes(definition.entry) if definition is not None else ():
            if not seen.is_subtree or seen.node.id is None or seen.node.id.text != tree:
                continue
            value = seen.node.attribute(key)
            if value is not None:
                yield pointed_at(key, value.text) or ""
            else:
                yield key if remaps_all(seen) and key[0] != "_" else None

    def _met_in(self, tree: str) -> dict[str, list[_Meeting]]:
        found: dict[str, list[_Meeting]] = {}
        definition = self._view.scope.find(Kind.TREE, tree)
        if definition is None:
            return found
        for seen in self._view.nodes(definition.entry):
            if seen.is_subtree:
                for key, given, below in self._handed_on(seen):
                    _add(found, key, _Meeting(below.type, seen, given, below.at))
                continue
            for pair in seen.node.attributes:
                value = pair.value
                if value is None or "{" not in value.raw:
                    continue
                if (entry := pointed_at(pair.key.text, value.text)) is not None:
                    type_ = _port_type(self._view, seen, pair.key.text)
                    _add(found, entry, _Meeting(type_, seen, pair, (definition, pair, seen)))
        return found

    def _handed_on(self, seen: SeenNode) -> Iterator[tuple[str, Pair | None, _Meeting]]:
        """What the entries meet that a SubTree gives to its tree, by the names that they have here."""
        below = self._of.get(seen.node.id.text if seen.node.id is not None else "", {})
        given = {pair.key.text: pair for pair in reversed(seen.node.attributes) if pair.value is not None}
        shares_all = remaps_all(seen)
        for port, meetings in below.items():
            pair = given.get(port)
            key: str | None = port if port[0] == "@" else None
            if key is None and pair is not None and pair.value is not None:
                key = pointed_at(port, pair.value.text)
            elif key is None and shares_all and port[0] != "_":
                key = port
            if key:
                yield from ((key, pair, meeting) for meeting in meetings)


def _clashes(view: View, tree: str, key: str, meetings: list[_Meeting]) -> Iterator[Diagnostic]:
    first = meetings[0]
    # The ports of one node are met in no promised order.
    if not all(_is_strong(each.type) for each in meetings if each.node is first.node):
        return
    told = {first.type}
    for later in meetings:
        if later.type in told or not later.type or (later.given is first.given and later.given is not None):
            continue
        severity = _severity(first.type, later.type)
        if severity is None or not view.entry_types.is_first(tree, key):
            continue
        told.add(later.type)
        _, pair, seen = first.at
        span = later.node.node.head.span
        if later.given is not None and later.given.value is not None:
            span = later.given.value.span
        at = () if later.at[2] is later.node else (_related(later.at, f"it is given to this port of {later.type}"),)
        yield Diagnostic(
            "entry-with-two-types",
            span,
            f"`{{{key}}}` is made as {first.type} by `{pair.key.text}` of {seen.shown}, "
            f"and `{later.at[1].key.text}` of {later.at[2].shown} is of type {later.type}",
            related=(_related(first.at, f"here it becomes {first.type}"), *at),
            notes=("the engine makes no tree where an entry has two types: give each its own entry",),
            severity=severity,
        )


def _severity(first: str, later: str) -> Severity | None:
    """How sure it is that two types are two: a type of somebody's program may be another word for one."""
    if is_known_type(first) and is_known_type(later):
        return Severity.ERROR
    if "<" in first + later or first.rpartition("::")[2].casefold() == later.rpartition("::")[2].casefold():
        return None
    return Severity.WARNING


def _related(at: tuple[Definition, Pair, SeenNode], message: str) -> Related:
    tree, pair, _ = at
    return Related(Place(pair.key.span, tree.path, tree.entry.item), message)


def _is_strong(type_: str) -> bool:
    return bool(type_) and not is_text(type_)


def _add(found: dict[str, list[_Meeting]], key: str, meeting: _Meeting) -> None:
    known = found.setdefault(key, [])
    if all(each.type != meeting.type for each in known):
        known.append(meeting)


def _port_type(view: View, seen: SeenNode, port: str) -> str:
    if seen.kind is not None:
        builtin = seen.kind.port(port)
        type_ = port_type(builtin, view.workspace.project.target) if builtin is not None else ""
    else:
        type_ = declared_type(seen.model.ports, port) if seen.model is not None else ""
    return plain_type(type_) if type_ not in _ANYTHING else ""


_ANYTHING: Final = frozenset(("", "BT::Any", "BT::AnyTypeAllowed", "Any", "AnyTypeAllowed", "any", "auto"))
