"""Arguments of SubTrees that nothing in their trees reads or writes."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Final

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.names import is_port_name
from btq_lang.catalog.versions import PORTS_OF_SUBTREE
from btq_lang.checks import lookups
from btq_lang.checks.entries import handling
from btq_lang.checks.flow import below, calls_of
from btq_lang.checks.results import is_filled_in
from btq_lang.checks.view import View, declared_ports
from btq_lang.diagnostics.model import Diagnostic, replace_fix
from btq_lang.syntax.tree import Tree, port_named
from btq_lang.util.spelling import did_you_mean, near
from btq_lang.workspace import inputs
from btq_lang.workspace.inputs import of_scope
from btq_lang.workspace.queries import Store, on_circle
from btq_lang.workspace.workspace import Workspace


def unread_argument(view: View) -> Iterator[Diagnostic]:
    """An argument of a SubTree that nothing in its tree names, once for each tree.  If the tree declares ports, the
    argument is an unknown port instead."""
    reported: set[tuple[str, str]] = set()
    for resolved in view.seen.subtrees:
        tree = resolved.id.text if resolved.id is not None else ""
        for pair in resolved.node.attributes:
            name = pair.key.text
            if not is_port_name(name) or (tree, name) in reported or not view.ask(lookups.is_defined, Kind.TREE, tree):
                continue
            declared = declared_ports(view, tree)
            if port_named(declared, name) or (declared and PORTS_OF_SUBTREE.holds(view.target)):
                continue
            if view.ask(_is_named, tree, name):
                continue
            reported.add((tree, name))
            meant = [
                entry for entry in view.ask(_similar_entries, tree, name) if resolved.node.attribute(entry) is None
            ]
            fixes = tuple([replace_fix(f"Replace `{name}` with `{entry}`", pair.key.span, entry) for entry in meant])
            message = f"nothing in `{tree}` reads `{name}`{did_you_mean(tuple(meant))}"
            yield Diagnostic("unread-argument", pair.key.span, message, fixes=fixes)


def unread_port(view: View) -> Iterator[Diagnostic]:
    """A declared port that SubTrees give a value and nothing in the tree names, reported at its declaration."""
    for owner in view.owners:
        is_of_tree = isinstance(owner, Tree) or owner.category.raw == "SubTree"
        tree = owner.name.text if is_of_tree and owner.name is not None else ""
        for port in owner.ports if tree and view.ask(lookups.is_defined, Kind.TREE, tree) else ():
            name = port.id.text if port.id is not None else ""
            if port.id is None or not is_port_name(name) or view.ask(_is_named, tree, name):
                continue
            if view.ask(_is_given, tree, name):
                is_output = port.direction.raw == "output"
                use = "writes" if is_output else "reads"
                given = "for which SubTrees name an entry" if is_output else "which SubTrees give it"
                message = f"nothing in `{tree}` {use} `{name}`, {given}"
                yield Diagnostic("unread-argument", port.id.span, message)


def _is_given(store: Store[Workspace], viewpoint: str, tree: str, name: str) -> bool:
    """Whether a SubTree gives a tree an argument."""
    calls = calls_of(View(store, viewpoint), tree)
    return any(name in call.given or name in call.values for _, call in calls)


@of_scope
def _similar_entries(store: Store[Workspace], viewpoint: str, tree: str, name: str) -> tuple[str, ...]:
    return near(name, [entry for entry in store.ask(below, viewpoint, tree).uses if entry.isidentifier()])


@on_circle(True)
@of_scope
def _is_named(store: Store[Workspace], viewpoint: str, tree: str, name: str) -> bool:
    """Whether anything in a tree may read or write an entry."""
    view = View(store, viewpoint)
    own, definition = view.ask(handling, tree), view.ask(inputs.definition, Kind.TREE, tree)
    if own.is_open or own.has_strangers or definition is None or name in view.ask(_words, tree):
        return True
    if isinstance(item := definition[1].item, Tree) and is_filled_in(view, tree, item):
        return True
    if any(resolved.kind is None and not resolved.is_subtree for resolved in view.seen_in(*definition).all):
        from btq_lang.catalog.nav2.navigator import ENTRIES  # few arguments are not named

        if name in ENTRIES:
            return True  # Nav2's nodes read it when they are created
    return any(view.ask(_is_named, call.tree, name) for call in own.calls if call.passed(name) == name)


@of_scope
def _words(store: Store[Workspace], viewpoint: str, tree: str) -> frozenset[str]:
    """All words in the values of a tree's attributes: a program may read the name of an entry from any of them."""
    view = View(store, viewpoint)
    words: set[str] = set()
    for resolved in view.nodes_of(tree).given:
        for pair in resolved.node.attributes:
            if pair.value is not None:
                words.update(_WORD(pair.value.text) if pair.value.text not in ("=", "{=}") else (pair.key.text,))
    return frozenset(words)


_WORD: Final = re.compile(r"\w+").findall
