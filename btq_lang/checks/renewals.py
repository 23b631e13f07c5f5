"""Guards on values that nothing writes while the guarded node runs: they are effectively checked once.

One invariant: every node that may run in parallel to another one is assumed to run, and every node that may write an
entry to write it, so a finding is true for every run of the mission.  This module does not know what the robot's
program writes.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import pairwise

from btq_lang.catalog.literals import is_pointer
from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.verbs import VERBS
from btq_lang.checks.demanded import Demanded, Found, found_at
from btq_lang.checks.view import View, declared_ports
from btq_lang.checks.writers import all_entries, isolated, key_of
from btq_lang.diagnostics.model import Related
from btq_lang.requirements import nodes
from btq_lang.requirements.model import ResolvedClaim, ResolvedRequirement, ResolvedSignal, signals_in
from btq_lang.util.reach import reached
from btq_lang.workspace import inputs
from btq_lang.workspace.item_index import Facts
from btq_lang.workspace.queries import Store
from btq_lang.workspace.resolved import ResolvedNode, tree_nodes, trees_called
from btq_lang.workspace.workspace import Workspace

# While a child of these runs no other one does, and earlier ones have ended, unless they are reactive.
_ONE_AT_A_TIME = frozenset(("sequence", "fallback", "choice", "switch", "resume", "recover", "rotate"))


def guard_never_renewed(demanded: Demanded) -> Iterator[Found]:
    """A guard whose signals all have writers in the mission, but no writer is ticked while the node runs."""
    for applied, claim, node, place, why in demanded.hard:
        signals = _watched(applied.requirement, claim) if why is None else ()
        keys = dict.fromkeys([signal.entry for signal in signals])
        if not keys or not all(_is_fixed(demanded, node, key) for key in keys):
            continue
        writers = [*dict.fromkeys([writer for key in keys for writer in demanded.view.ask(_writers, key)])]
        places = (place, *(writer.place for writer in writers))
        shown = next(
            (candidate for candidate in places if candidate is not None and candidate.path == demanded.view.path), None
        )
        if shown is None:
            continue
        names = " and ".join(f"`{key}`" for key in keys)
        message = f"no node writes {names} while {node.shown} runs, so the result is fixed when the node starts"
        notes = (
            "write it beside the node: below the same Parallel, or before it in a reactive control node, `R->`",
            "ignore this if the robot's program writes it; to check only at the start, write `needs`",
        )
        related = (
            *(Related(writer.place, "writes it, but not while the node runs") for writer in writers[:3]),
            Related(node.place, "guarded node"),
        )
        yield found_at(shown, "guard-never-renewed", message, related=related, notes=notes)


def _watched(requirement: ResolvedRequirement, claim: ResolvedClaim) -> Iterable[ResolvedSignal]:
    """The signals that are read again after the node has started; empty if unknown."""
    if requirement.classic:
        return ()
    judged = VERBS[claim.verb].judged
    if judged == "while it runs":
        scopes = tuple([scope.condition for scope in requirement.scopes if scope.word == "while"])
        return signals_in((claim.condition, scopes))
    return signals_in((claim.condition, claim.signal)) if judged == "at its end" else ()


def _is_fixed(demanded: Demanded, node: ResolvedNode, key: str) -> bool:
    """Whether an entry that nodes write does not change while a node of the tree runs."""
    view, tree = demanded.view, demanded.tree
    if not view.ask(_writers, key):
        return False
    writing, carrying = view.ask(_renewing, tree.path, tree.facts, key)
    if id(node) in carrying or _is_renewed_beside(writing, carrying, node):
        return False
    return not view.ask(_is_renewed_above, node.tree, key)


def _is_renewed_beside(writing: frozenset[int], carrying: frozenset[int], node: ResolvedNode) -> bool:
    """Whether a node above another one in its tree, or below such a node, may write an entry while the other one runs.

    Args:
        writing, carrying: the result of `_renewing` for the tree.
    """
    for below, above in pairwise((node, *node.ancestors())):
        beside = () if _runs_one_at_a_time(above) else [sibling for sibling in above.children if sibling is not below]
        if id(above) in writing or any(id(sibling) in carrying for sibling in beside):
            return True
    return False


def _runs_one_at_a_time(node: ResolvedNode) -> bool:
    return node.flow in _ONE_AT_A_TIME and node.behavior is not None and not node.behavior.reactive


# ---- queries ----


def _renewing(
    store: Store[Workspace], viewpoint: str, path: str, facts: Facts, key: str
) -> tuple[frozenset[int], frozenset[int]]:
    """The `id`s of the nodes of a tree that write an entry, and of those with such a node in them, or in a tree that
    they run."""
    tree = store.ask(tree_nodes, viewpoint, path, facts)
    writers = [writer for writer in store.ask(_writers, viewpoint, key) if writer.facts is facts]
    trees = store.ask(_carrying, viewpoint, key)
    inner = [*writers, *[node for name, node in tree.calls if name in trees]]
    carrying = reached(inner, lambda node: [node.parent] if node.parent is not None else [])
    return frozenset(map(id, writers)), frozenset(map(id, carrying))


def _writers(store: Store[Workspace], viewpoint: str, key: str) -> tuple[ResolvedNode, ...]:
    """The nodes that may write an entry of this name; empty if the program may too, or if no node certainly does."""
    view = View(store, viewpoint)
    if view.ask(nodes.mission) is None or not view.ask(inputs.is_complete) or not view.is_read:
        return ()
    if view.ask(inputs.is_included) or store.ask(inputs.has_xml, viewpoint):
        return ()
    entries = view.ask(all_entries)
    if any(of_tree.is_open or key in of_tree.mentioned for of_tree in entries) or key in view.ask(_keys_of_defaults):
        return ()
    writing = [of_tree for of_tree in entries if key in of_tree.written]
    writers = [node for of_tree in writing for node, name in of_tree.writes if name.removeprefix("@") == key]
    running = view.ask(_reached)
    if not all(writer.tree in running for writer in writers):
        return ()  # perhaps another mission that runs in parallel
    sure = [write for of_tree in writing for write in of_tree.sure]
    if not any(name.removeprefix("@") == key for _, name in sure) or isolated(view, sure, key) is not None:
        return ()
    return tuple(dict.fromkeys(writers))


def _keys_of_defaults(store: Store[Workspace], viewpoint: str) -> frozenset[str]:
    """The entries, without their `@`, that are defaults of ports of trees and models in scope."""
    view = View(store, viewpoint)
    keys: set[str] = set()
    for name in (*view.ask(inputs.names, Kind.TREE), *view.ask(inputs.names, Kind.MODEL)):
        for port in declared_ports(view, name):
            text = port.default.text if port.default is not None else ""
            if is_pointer(text):
                keys.add(key_of(text, port.name.text if port.name is not None else "").removeprefix("@"))
    return frozenset(keys)


def _carrying(store: Store[Workspace], viewpoint: str, key: str) -> frozenset[str]:
    """The trees that write an entry, themselves or through those that they run."""
    writing = [writer.tree for writer in store.ask(_writers, viewpoint, key)]
    return frozenset([tree for tree in _with_callers(store, viewpoint, *writing) if tree is not None])


def _is_renewed_above(store: Store[Workspace], viewpoint: str, tree: str | None, key: str) -> bool:
    """Whether nodes of other trees may write an entry while a tree runs, or nothing runs the tree."""
    if tree not in store.ask(_reached, viewpoint):
        return True
    for name in _with_callers(store, viewpoint, tree):
        for caller in store.ask(nodes.callers, viewpoint, name):
            writing, carrying = store.ask(_renewing, viewpoint, caller.path, caller.facts, key)
            if id(caller) in writing or _is_renewed_beside(writing, carrying, caller):
                return True
    return False


def _with_callers(store: Store[Workspace], viewpoint: str, *trees: str | None) -> Iterator[str | None]:
    """Trees and all that run them, directly or not."""
    return reached(trees, lambda tree: [caller.tree for caller in store.ask(nodes.callers, viewpoint, tree)])


def _reached(store: Store[Workspace], viewpoint: str) -> frozenset[str | None]:
    """The mission's tree, and those that it runs."""
    main = store.ask(nodes.mission, viewpoint)
    trees = [main.tree] if main is not None else []
    return frozenset(reached(trees, lambda name: store.ask(trees_called, viewpoint, name) if name is not None else ()))
