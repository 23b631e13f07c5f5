"""Data flow across trees: what happens to an entry in a tree, in the trees that it runs, and in those that run it.

One invariant: all that may happen is included.  Unknown trees and XML may do anything; what only a robot's program does
is a flag of its own.  This module does not know when nodes run.  `handling` (entries.py) says what a tree itself does;
the rest is composed of that, tree by tree, so that an edit stops where it does not change what others see.

Sources: addSubtreeRemapping, getEntry and enableAutoRemapping in src/blackboard.cpp of 4.6.2 and 4.10.0; for version 3
buildTreeRecursively in src/xml_parsing.cpp of 3.8.8.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from enum import IntFlag
from functools import reduce
from operator import or_
from typing import Final

from btq_lang.catalog.name_kinds import Kind
from btq_lang.checks import lookups
from btq_lang.checks.calls import callers, is_main
from btq_lang.checks.entries import SubTreeCall, Touch, handling, signal_entries
from btq_lang.checks.view import View, declared_ports
from btq_lang.syntax.tree import port_named
from btq_lang.util.record import Record
from btq_lang.workspace import inputs
from btq_lang.workspace.inputs import of_scope
from btq_lang.workspace.queries import Store, on_circle
from btq_lang.workspace.workspace import Workspace


class EntryUse(IntFlag):
    """What may happen to an entry.

    READ, WRITTEN, CREATED: by nodes, scripts and values that SubTrees give.
    GIVEN: it is a declared port, or a signal is read from it.
    STRANGE: a node that nothing declares may read and write any entry.
    OPEN: something unknown to btq may read and write it.
    OUTSIDE: it is on the root blackboard, where the robot's program may set and read it.
    """

    READ = 1
    WRITTEN = 2
    CREATED = 4
    GIVEN = 8
    STRANGE = 16
    OPEN = 32
    OUTSIDE = 64


class Below(Record):
    """What happens to the entries of a tree, in it and in the trees that it runs.

    Attributes:
        uses: by the entry's name in the tree.
        any: what may happen to each entry.
    """

    uses: Mapping[str, EntryUse]
    any: EntryUse

    def use_of(self, name: str) -> EntryUse:
        """What may happen to an entry."""
        return self.uses.get(name, EntryUse(0)) | self.any


_ANYTHING: Final = EntryUse(127)


@of_scope
def uses(store: Store[Workspace], viewpoint: str, tree: str, name: str) -> EntryUse:
    """What may happen to an entry of a tree, in it and in the trees above and below that it is passed to."""
    if name[:1] == "@":
        return store.ask(_of_root, viewpoint, name[1:])
    view = View(store, viewpoint)
    use = view.ask(below, tree).use_of(name)
    if port_named(declared_ports(view, tree), name) is not None:
        use |= EntryUse.GIVEN
    running = view.ask(callers, tree)
    if not running or view.ask(is_main, tree):
        use |= EntryUse.OUTSIDE | view.ask(of_program, name)
    for caller in running:
        for call in view.ask(handling, caller).calls:
            if call.tree == tree:
                passed = call.passed(name)
                if name in call.values:
                    use |= EntryUse.WRITTEN | EntryUse.CREATED
                if passed is not None:
                    use |= view.ask(_above, caller, passed)
    return use


@on_circle(Below({}, _ANYTHING))
@of_scope
def below(store: Store[Workspace], viewpoint: str, tree: str) -> Below:
    """What happens to the entries of a tree in it and in the trees that it runs; anything, if it runs itself."""
    own = store.ask(handling, viewpoint, tree)
    by_entry: dict[str, EntryUse] = {}
    anything = EntryUse.OPEN if own.is_open else EntryUse(0)
    if own.has_strangers:
        anything |= EntryUse.STRANGE
    for touch in own.touches:
        by_entry[touch.name] = by_entry.get(touch.name, EntryUse(0)) | _use(touch)
    for name in own.named:
        by_entry[name] = by_entry.get(name, EntryUse(0)) | EntryUse.OPEN
    for call in own.calls:
        called = store.ask(below, viewpoint, call.tree)
        if call.shares:
            anything |= called.any
        for name, use in called.uses.items():
            passed = name if name[:1] == "@" else call.passed(name)
            if passed is not None:
                by_entry[passed] = by_entry.get(passed, EntryUse(0)) | use
        for port, passed in call.given.items():
            if called.any and port not in called.uses:
                by_entry[passed] = by_entry.get(passed, EntryUse(0)) | called.any
    return Below(by_entry, anything)


@on_circle(_ANYTHING)
@of_scope
def _above(store: Store[Workspace], viewpoint: str, tree: str, name: str) -> EntryUse:
    return uses(store, viewpoint, tree, name)


@of_scope
def _of_root(store: Store[Workspace], viewpoint: str, name: str) -> EntryUse:
    """What may happen to an entry of the root blackboard that is named with its `@`."""
    view = View(store, viewpoint)
    trees = [(tree, view.ask(below, tree)) for tree in view.ask(inputs.names, Kind.TREE)]
    entry_uses = [tree_uses.uses.get(f"@{name}", EntryUse(0)) | tree_uses.any for _, tree_uses in trees]
    entry_uses += [tree_uses.use_of(name) for tree, tree_uses in trees if not view.ask(callers, tree)]
    return reduce(or_, entry_uses, EntryUse.OUTSIDE | view.ask(of_program, name))


@of_scope
def of_program(store: Store[Workspace], viewpoint: str, name: str) -> EntryUse:
    """What the program does with an entry of the root blackboard, and trees by its name with `@`."""
    view = View(store, viewpoint)
    use = view.ask(_with_sign).get(name, EntryUse(0))
    if ("", name) in view.ask(signal_entries):
        use |= EntryUse.GIVEN
    for entry, direction in view.ask(lookups.outside_entries):
        if entry == name:
            use |= EntryUse.READ if direction != "output" else EntryUse(0)
            use |= EntryUse.WRITTEN | EntryUse.CREATED if direction != "input" else EntryUse(0)
    return use


@of_scope
def _with_sign(store: Store[Workspace], viewpoint: str) -> dict[str, EntryUse]:
    """The entries of the root blackboard that trees name with its `@`."""
    view = View(store, viewpoint)
    by_entry: dict[str, EntryUse] = {}
    for tree in view.ask(inputs.names, Kind.TREE):
        for touch in view.ask(handling, tree).touches:
            if touch.name[:1] == "@":
                by_entry[touch.name[1:]] = by_entry.get(touch.name[1:], EntryUse(0)) | _use(touch)
    return by_entry


def _use(touch: Touch) -> EntryUse:
    return EntryUse(EntryUse.READ * touch.reads | EntryUse.WRITTEN * touch.writes | EntryUse.CREATED * touch.creates)


@of_scope
def writes_alone(store: Store[Workspace], viewpoint: str, tree: str, called: str, name: str) -> bool:
    """Whether a tree that another one runs certainly writes an entry of its own, which never leaves it."""
    calls = [call for call in store.ask(handling, viewpoint, tree).calls if call.tree == called]
    if any(call.passed(name) is not None or name in call.values for call in calls):
        return False
    return any(
        touch.name == name and touch.writes and not touch.reads
        for touch in store.ask(handling, viewpoint, called).touches
    )


def calls_of(view: View, tree: str) -> Iterator[tuple[str, SubTreeCall]]:
    """The SubTrees that run a tree, each with the tree that it is in."""
    for caller in view.ask(callers, tree):
        yield from ((caller, call) for call in view.ask(handling, caller).calls if call.tree == tree)
