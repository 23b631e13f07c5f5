"""Names of entries in braces, where a node reads the name itself from that entry.

Source: SetBlackboardNode::tick and UnsetBlackboardNode::tick, which get the name by getInput (4.6.2, 4.10.0).
"""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.catalog.literals import is_pointer
from btq_lang.catalog.nodes import BUILTINS
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, replace_fix
from btq_lang.syntax.tree import Tree, is_name
from btq_lang.workspace import inputs
from btq_lang.workspace.item_index import Facts
from btq_lang.workspace.queries import Store
from btq_lang.workspace.workspace import Workspace

_INDIRECT = tuple((kind.tag, port.name) for kind in BUILTINS.values() for port in kind.ports if port.indirect)


def key_in_braces(view: View) -> Iterator[Diagnostic]:
    """`SetBlackboard (output_key = {speed})`, unless something gives `speed` the name of an entry."""
    for tag, port in _INDIRECT:
        for resolved in view.seen.by_tag.get(tag, ()):
            value = resolved.node.attribute(port)
            if value is None or not is_pointer(value.text):
                continue
            from btq_lang.checks.writers import key_of  # few files have such a name

            entry = key_of(value.text, port)
            if entry.removeprefix("@") in view.ask(_entries_with_value):
                continue
            message = f"`{value.text}` is the entry whose name `{entry}` holds; write `{port}` without braces"
            notes = (f"the engine throws when the node is ticked, unless `{entry}` holds the name of an entry",)
            fixes = (replace_fix(f"Replace `{value.raw}` with `{entry}`", value.span, entry),) if is_name(entry) else ()
            yield Diagnostic("key-in-braces", value.span, message, notes=notes, fixes=fixes)


def _entries_with_value(store: Store[Workspace], viewpoint: str) -> frozenset[str]:
    """The entries that something in scope certainly gives a value, which may be a name, and the ports of trees."""
    from btq_lang.checks.writers import all_entries

    view = View(store, viewpoint)
    written = {
        key.removeprefix("@")
        for entries in view.ask(all_entries)
        for resolved, key in entries.sure
        if not any(is_pointer(value.text) for value in map(resolved.node.attribute, _PORTS) if value is not None)
    }
    return frozenset(written).union(*(view.ask(_passed, *tree) for tree in store.ask(inputs.trees, viewpoint)))


def _passed(store: Store[Workspace], viewpoint: str, path: str, tree: Facts) -> frozenset[str]:
    """The ports of a tree, and those to which it passes something in other trees."""
    view = View(store, viewpoint)
    nodes = view.seen_in(path, tree)
    ports = tree.item.ports if isinstance(tree.item, Tree) else ()
    own = (port.name.text for port in ports if port.name is not None)
    return frozenset([*own, *(pair.key.text for resolved in nodes.subtrees for pair in resolved.node.attributes)])


_PORTS = tuple(port for _, port in _INDIRECT)
