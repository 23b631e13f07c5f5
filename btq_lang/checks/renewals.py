"""Guards on values that nobody writes while the node runs that they guard: they are as good as asked once.

One invariant: whatever may run beside a node is taken to do so, and whatever may write an entry to write it, so what is
found is found for every run of the mission.  It does not know what the robot's program writes.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from btq_lang.catalog.literals import is_pointer
from btq_lang.catalog.verbs import VERBS
from btq_lang.checks.demanded import Demanded, Found
from btq_lang.checks.writers import isolated, key_of
from btq_lang.diagnostics.model import Diagnostic, Related
from btq_lang.requirements.reading import signals_in
from btq_lang.syntax.tree import Verbatim

if TYPE_CHECKING:
    from btq_lang.requirements.model import Claim, Requirement, Signal, SourceNode
    from btq_lang.requirements.trees import TreeNodes

# While a child of these runs no other one does, and what ran before has come to its end.
_ONE_AT_A_TIME = frozenset(
    (
        *("Sequence", "SequenceWithMemory", "AsyncSequence", "Fallback", "AsyncFallback", "IfThenElse"),
        *(f"Switch{cases}" for cases in range(2, 7)),
    )
)


def guard_never_renewed(demanded: Demanded) -> Iterator[Found]:
    """A guard all of whose signals have writers in the mission, none of which is ticked while the node runs."""
    for applied, claim, node, place, why in demanded.hard:
        signals = _watched(applied.requirement, claim) if why is None else ()
        keys = dict.fromkeys([(signal.key or "").removeprefix("@") for signal in signals])
        if not keys or not all(_is_fixed(demanded, node, key) for key in keys):
            continue
        writers = [*dict.fromkeys([writer for key in keys for writer in demanded.ask((_writers, key))])]
        places = (place, *(writer.place for writer in writers))
        told = next((each for each in places if each is not None and each.path == demanded.view.path), None)
        if told is None:
            continue
        names = " and ".join(f"`{key}`" for key in keys)
        yield (
            told,
            Diagnostic(
                "guard-never-renewed",
                told.span,
                f"no node writes {names} while {node.shown} runs, so the result is fixed when the node starts",
                related=(
                    *(Related(writer.place, "writes it, but not while the node runs") for writer in writers[:3]),
                    Related(node.place, "guarded node"),
                ),
                notes=(
                    "write it beside the node: below the same Parallel, or before it in a reactive control node, `R->`",
                    "ignore this if the robot's program writes it; to check only at the start, write `needs`",
                ),
            ),
        )


def _watched(requirement: Requirement, claim: Claim) -> Iterable[Signal]:
    """The signals that are read again after the node has started; none where nobody can say which."""
    if requirement.classic:
        return ()
    judged = VERBS[claim.verb].judged
    if judged == "while it runs":
        scopes = tuple([scope.condition for scope in requirement.scopes if scope.word == "while"])
        return signals_in((claim.condition, scopes))
    return signals_in((claim.condition, claim.signal)) if judged == "at its end" else ()


def _is_fixed(demanded: Demanded, node: SourceNode, key: str) -> bool:
    """Whether an entry that nodes write stays as it is while a node of the tree runs."""
    if not demanded.ask((_writers, key)):
        return False
    demanded.ask((_carrying, key))
    if id(node) in _renewing(demanded, demanded.tree, key)[1] or _is_renewed_beside(demanded, demanded.tree, node, key):
        return False
    return not demanded.ask((_is_renewed_above, (node.tree, key)))


def _is_renewed_beside(demanded: Demanded, tree: TreeNodes, node: SourceNode, key: str) -> bool:
    """Whether an entry may be written while a node runs, by one above it in the tree, or below one of these."""
    writing, carrying = _renewing(demanded, tree, key)
    below, at = node, node.parent
    while at is not None:
        if id(at) in writing:
            return True
        if at.tag not in _ONE_AT_A_TIME and any(id(each) in carrying for each in at.children if each is not below):
            return True
        below, at = at, at.parent
    return False


def _renewing(demanded: Demanded, tree: TreeNodes, key: str) -> tuple[set[int], set[int]]:
    """As `demanded.renewing` says."""
    known = demanded.renewing.get((id(tree), key))
    if known is None:
        writers = [writer for writer in demanded.answer((_writers, key)) or () if writer.item is tree.item]
        trees = demanded.answer((_carrying, key))
        carrying: set[int] = set()
        for node in (*writers, *(node for name, node in tree.calls if name in trees)):
            at: SourceNode | None = node
            while at is not None and id(at) not in carrying:
                carrying.add(id(at))
                at = at.parent
        known = demanded.renewing[id(tree), key] = set(map(id, writers)), carrying
    return known


# ---- what is so in other trees ----


def _writers(demanded: Demanded, key: str) -> tuple[SourceNode, ...]:
    """The nodes that may write an entry of this name; none where others may, too, or no node surely does."""
    found, view, entries = demanded.requirements, demanded.view, demanded.entries
    if found.mission is None or not view.is_complete or not view.is_read:
        return ()
    if view.path in view.workspace.included_files or any(file.of_type(Verbatim) for file in demanded.files):
        return ()
    if any(each.is_open or key in each.mentioned for each in entries):
        return ()
    for port in (port for ports in demanded.ports.values() for port in ports if port.default is not None):
        text = port.default.text if port.default is not None else ""
        if is_pointer(text) and key_of(text, port.name.text if port.name is not None else "").removeprefix("@") == key:
            return ()
    writing = [each for each in entries if key in each.written]
    writers = [node for each in writing for node, name in each.writes if name.removeprefix("@") == key]
    if not all(_is_reached(demanded, writer.tree) for writer in writers):
        return ()  # perhaps another mission, that runs beside this one
    sure = [write for each in writing for write in each.sure]
    if not any(name.removeprefix("@") == key for _, name in sure) or isolated(found, sure, key) is not None:
        return ()
    return tuple(dict.fromkeys(writers))


def _carrying(demanded: Demanded, key: str) -> frozenset[str]:
    """The trees that write an entry themselves or by those that they run."""
    waiting = [writer.tree for writer in demanded.answer((_writers, key))]
    carrying = {*waiting}
    while waiting:
        for caller in demanded.requirements.nodes.callers(waiting.pop()):
            if caller.tree not in carrying:
                carrying.add(caller.tree)
                waiting.append(caller.tree)
    return frozenset([tree for tree in carrying if tree is not None])


def _is_renewed_above(demanded: Demanded, about: tuple[str | None, str]) -> bool:
    """Whether an entry may be written while a tree runs, by nodes above it or beside it; or nothing runs the tree."""
    tree, key = about
    nodes = demanded.requirements.nodes
    if not _is_reached(demanded, tree):
        return True
    waiting, seen = [tree], {tree}
    while waiting:
        for caller in nodes.callers(waiting.pop()):
            home = nodes.within(caller.item)
            if id(caller) in _renewing(demanded, home, key)[0] or _is_renewed_beside(demanded, home, caller, key):
                return True
            if caller.tree not in seen:
                seen.add(caller.tree)
                waiting.append(caller.tree)
    return False


def _is_reached(demanded: Demanded, tree: str | None) -> bool:
    """Whether a tree is the mission's, or that runs it."""
    reached: frozenset[str | None] = demanded.answer((_reached, ""))
    return tree in reached


def _reached(demanded: Demanded, _: str) -> frozenset[str | None]:
    mission = demanded.requirements.mission
    called: dict[str | None, tuple[str, ...]] = {}
    for tree in demanded.requirements.nodes.trees:
        called.setdefault(tree.name, tree.called)
    waiting: list[str | None] = [mission.tree] if mission is not None else []
    reached = {*waiting}
    while waiting:
        others = [name for name in called.get(waiting.pop(), ()) if name not in reached]
        reached.update(others)
        waiting += others
    return frozenset(reached)
