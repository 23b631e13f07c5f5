"""Nodes that seem to remove an entry, or to update it, and do not.

One invariant: a finding is certain.  Entries of one name in several trees are one where a SubTree passes them; updates
are looked for in one tree only.
"""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.catalog.kinds import PortKind
from btq_lang.catalog.literals import is_pointer
from btq_lang.catalog.versions import at_least
from btq_lang.checks.calls import callers
from btq_lang.checks.entries import call_of
from btq_lang.checks.pointers import pointed_at
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Related
from btq_lang.syntax.tree import Word
from btq_lang.util.text import counted
from btq_lang.workspace.node_names import copies
from btq_lang.workspace.resolved import ResolvedNode


def unset_without_effect(view: View) -> Iterator[Diagnostic]:
    """The removal of an entry that a tree gets from another one: it stays.

    Source: the tests of rules in BehaviorTree.CPP 4.6.2 and 4.10.0 (tests/engine).
    """
    tree = view.tree_name
    for resolved in view.seen.by_flow.get("succeeds", ()):
        port, value = _port(resolved), _key(resolved)
        if port is None or value is None or not port.removes or is_pointer(value.text):
            continue
        if value.text.startswith("@"):
            message = f"{resolved.shown} removes nothing: a key with `@` is never an entry of its own tree"
            yield Diagnostic("unset-without-effect", value.span, message, notes=(_INSTEAD,))
        elif tree is not None and (passing := list(_passing(view, tree.text, value.text))):
            count = "" if len(passing) == 1 else f" (and {counted(len(passing) - 1, 'more SubTree')})"
            message = f"{resolved.shown} removes nothing here: `{value.text}` is an entry of another tree"
            related = (Related(passing[0].place, f"passes it to `{tree.text}`{count}"),)
            yield Diagnostic("unset-without-effect", value.span, message, related, (_INSTEAD,))


def unnoticed_update(view: View) -> Iterator[Diagnostic]:
    """A copy into an entry whose updates a node waits for, in a version in which that does not count as one."""
    if not view.is_pinned:
        return
    for resolved in view.seen.by_flow.get("succeeds", ()):
        watcher, key = watcher_of_copy(view, resolved), _key(resolved)
        if watcher is not None and key is not None:
            from btq_lang.catalog.engine_changes import COPY_IS_UPDATE  # few trees have such nodes

            if at_least(view.engines[0], COPY_IS_UPDATE.since):
                return
            message = f"{watcher.shown} does not notice this copy: in {view.engines[0]} it does not update `{key.text}`"
            related = (Related(watcher.place, f"waits for updates of `{key.text}`"),)
            notes = (f"write `{key.text} := …` in a Script",)
            yield Diagnostic("unnoticed-update", resolved.node.head.span, message, related, notes)


def watcher_of_copy(view: View, resolved: ResolvedNode) -> ResolvedNode | None:
    """The first node of the tree that waits for updates of the entry into which a node copies another one."""
    key = _key(resolved)
    if key is None or resolved.behavior is None or not copies(resolved.behavior, resolved.node):
        return None
    return next((other for other in view.seen.given if _watched(other) == key.text), None)


def _watched(resolved: ResolvedNode) -> str | None:
    """The entry whose updates a node waits for."""
    port, key = _port(resolved), _key(resolved)
    if port is None or key is None or port.removes or port.direction != "input":
        return None
    return pointed_at(port.name, key.text) or key.text


def _key(resolved: ResolvedNode) -> Word | None:
    """The name of the entry that a node is about."""
    port = _port(resolved)
    return resolved.node.attribute(port.name) if port is not None else None


def _port(resolved: ResolvedNode) -> PortKind | None:
    ports = resolved.kind.ports if resolved.kind is not None else ()
    return next((port for port in ports if port.content == "key"), None)


def _passing(view: View, tree: str, name: str) -> Iterator[ResolvedNode]:
    """The SubTrees that pass an entry to a tree, by its name or with all others."""
    for caller in view.ask(callers, tree):
        for resolved in view.nodes_of(caller).subtrees:
            call = call_of(view, resolved)
            if call is not None and call.tree == tree and call.passed(name) is not None:
                yield resolved


_INSTEAD = "it removes only entries of its own tree: remove it there, or write a value that means none"
