"""Which nodes write which blackboard entries, as far as a mission determines it.

One invariant: every node that may write an entry is included; only ports that are declared as inputs are not.  This
module does not know when nodes run.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from btq_lang.catalog.attributes import RESERVED_ATTRIBUTES
from btq_lang.catalog.literals import is_pointer
from btq_lang.checks import lookups
from btq_lang.checks.pointers import remaps_all
from btq_lang.checks.view import View, port_of
from btq_lang.requirements import nodes
from btq_lang.syntax.tree import Pair, Verbatim
from btq_lang.util.reach import reached
from btq_lang.util.record import Record
from btq_lang.workspace import inputs
from btq_lang.workspace.item_index import Facts
from btq_lang.workspace.queries import Store
from btq_lang.workspace.resolved import ResolvedNode, tree_nodes
from btq_lang.workspace.workspace import Workspace


class Entries(Record):
    """The blackboard entries that the nodes of a tree name.

    Attributes:
        writes: those that a node may write, with that node, those of the root blackboard with their `@`.
        sure: those of them that are certainly written: by a declared output, or by a script.
        written: all of them, without the `@`.
        pointers: the attributes in braces, with their nodes, by the entry without its `@`, and whether it had one.
        mentioned: names without braces that a node gets, which may read or write that entry.
        is_open: whether something in it may write any entry: verbatim XML, or an entry that another one names.
    """

    writes: tuple[tuple[ResolvedNode, str], ...]
    sure: tuple[tuple[ResolvedNode, str], ...]
    written: frozenset[str]
    pointers: dict[str, list[tuple[ResolvedNode, Pair, bool]]]
    mentioned: frozenset[str]
    is_open: bool


@inputs.of_scope
def written_keys(store: Store[Workspace], viewpoint: str) -> frozenset[str]:
    """The entries that something in scope or its program may write, without their `@`."""
    outside = [name for name, direction in store.ask(lookups.outside_entries, viewpoint) if direction != "input"]
    return frozenset(outside).union(*[of_tree.written for of_tree in store.ask(all_entries, viewpoint)])


@inputs.of_scope
def all_entries(store: Store[Workspace], viewpoint: str) -> tuple[Entries, ...]:
    """The entries that nodes name, for each tree in scope."""
    return tuple([store.ask(_entries_in, viewpoint, *tree) for tree in store.ask(inputs.trees, viewpoint)])


@inputs.of_scope
def _entries_in(store: Store[Workspace], viewpoint: str, path: str, facts: Facts) -> Entries:
    view = View(store, viewpoint)
    tree = view.ask(tree_nodes, path, facts)
    writes: list[tuple[ResolvedNode, str]] = []
    perhaps: list[tuple[ResolvedNode, str]] = []
    pointers: dict[str, list[tuple[ResolvedNode, Pair, bool]]] = {}
    mentioned: set[str] = set()
    is_open = any(isinstance(child, Verbatim) for child in tree.item.children)
    for node in tree.all:
        if node.node.children and len(node.children) < len(node.node.children):
            is_open = is_open or any(isinstance(child, Verbatim) for child in node.node.children)
        for pair in node.node.attributes:
            if pair.value is None:
                continue
            text = pair.value.text
            port = pair.key.text
            built_in = node.kind.port(port) if node.kind is not None else None
            content = built_in.content if built_in is not None else ""
            is_entry = is_pointer(text)
            if is_entry:
                key = key_of(text, port)
                pointers.setdefault(key.removeprefix("@"), []).append((node, pair, key[:1] == "@"))
            if content == "script" or port in _SCRIPTS:
                writes += ((node, name) for name in _assigned(text))
            elif built_in is not None and content == "key" and built_in.direction != "input":
                writes.append((node, text.strip("{}")))
                is_open = is_open or is_entry
            elif is_entry:
                may_write = _writes(view, node, port)
                if may_write is not False:
                    (writes if may_write else perhaps).append((node, key))
            elif built_in.removes if built_in is not None else node.kind is None and text.isidentifier():
                mentioned.add(text.removeprefix("@"))
    every = (*writes, *perhaps)
    written = frozenset([name.removeprefix("@") for _, name in every])
    return Entries(every, tuple(writes), written, pointers, frozenset(mentioned), is_open)


def key_of(pointer: str, port: str) -> str:
    """The entry that a port's value points to: `speed` for `{speed}`, the port's own name for `{=}`."""
    key = pointer[1:-1].strip()
    return port if key == "=" else key


def isolated(view: View, writes: Sequence[tuple[ResolvedNode, str]], key: str) -> ResolvedNode | None:
    """A node that writes an entry of this name in its own tree's blackboard, if nothing writes that of the root.

    Args:
        writes: as in `Entries`, at least one of the entry.
    """
    main = view.ask(nodes.mission)
    if main is None:
        return None
    calls: dict[str | None, list[tuple[str, ResolvedNode]]] = {}
    for tree in view.ask(nodes.nodes).trees:
        calls.setdefault(tree.name, []).extend(tree.calls)

    def passed(place: tuple[str | None, str]) -> Iterator[tuple[str, str]]:
        for called, node in calls.get(place[0], ()):
            yield from ((called, name) for name in _passed_on(node, place[1]))

    names = {*reached([(main.tree, key)], passed)}  # of the root's entry, each with its tree
    writers = [node for node, written in writes if written.removeprefix("@") == key]
    if any(written == f"@{key}" or (node.tree, written) in names for node, written in writes):
        return None
    return writers[0]


def _assigned(script: str) -> Iterator[str]:
    from btq_lang.syntax.script.parser import parse_script
    from btq_lang.syntax.script.tree import variables

    for variable in variables(parse_script(script)):
        if variable.writes:
            yield variable.name


def _writes(view: View, node: ResolvedNode, port: str) -> bool | None:
    """Whether a port is written, which it is unless it is an input; None if it is not declared."""
    declared = port_of(view, node, port)
    return (False if node.kind is not None else None) if declared is None else declared.direction != "input"


def _passed_on(node: ResolvedNode, name: str) -> Iterator[str]:
    """The names under which a tree that runs another one passes an entry to that."""
    values = {pair.key.text: pair.value.text for pair in node.node.attributes if pair.value is not None}
    yield from (port for port, text in values.items() if is_pointer(text) and key_of(text, port) == name)
    if remaps_all(node) and name not in values and name[:1] != "_":
        yield name


_SCRIPTS: Final = frozenset([key for key, attribute in RESERVED_ATTRIBUTES.items() if attribute.is_script])
