"""Signals that nothing writes, and guards that read one before its first sample."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.verbs import words
from btq_lang.checks import lookups
from btq_lang.checks.demanded import Demanded, Guard, PlacedDiagnostic, diagnostic_at
from btq_lang.checks.view import View, port_of
from btq_lang.checks.writers import all_entries, isolated, written_keys
from btq_lang.diagnostics.model import Related
from btq_lang.diagnostics.rules import Severity
from btq_lang.requirements import reader
from btq_lang.requirements.model import ResolvedSignal
from btq_lang.requirements.nodes import has_nodes, mission
from btq_lang.util.spelling import near
from btq_lang.workspace import inputs
from btq_lang.workspace.port_types import is_text
from btq_lang.workspace.queries import Store
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace

_READING = words(operands=("condition", "use"))


def of_signals(view: View, guards: Sequence[Guard]) -> Iterator[PlacedDiagnostic]:
    """The findings of these rules.

    Args:
        guards: all claims for which the engine reads signals.
    """
    names = view.ask(inputs.names, Kind.SIGNAL)
    signals = [resolved for name in names if (resolved := view.ask(reader.signal, name)[0]) is not None]
    own_signals = [signal for signal in signals if signal.place.path == view.path and signal.key is not None]
    yield from _may_be_unset(view, guards)
    if own_signals:
        yield from _never_written(view, own_signals, guards)
        yield from _of_text(view, own_signals)


def guards(demanded: Demanded) -> Iterator[Guard]:
    """The signals and the entries that the engine reads to enforce a claim, each once, and where to report it."""
    by_parts: dict[tuple[int, ...], tuple[tuple[ResolvedSignal, ...], tuple[str, ...]]] = {}
    for applied, claim, _, place in demanded.claims:
        if claim.verb not in _READING or not applied.requirement.is_enforceable:
            continue
        parts = (claim.condition, claim.signal, *(scope.condition for scope in applied.requirement.scopes))
        key = tuple(map(id, parts))  # one claim may apply to many nodes
        if key not in by_parts:
            from btq_lang.requirements.classic import entries_in  # few missions have a claim that is enforced
            from btq_lang.requirements.model import signals_in

            signals = tuple({signal.name: signal for signal in signals_in(parts)}.values())
            by_parts[key] = signals, entries_in(claim.condition)
        yield *by_parts[key], place


def _never_written(
    view: View, own_signals: list[ResolvedSignal], guards: Sequence[Guard]
) -> Iterator[PlacedDiagnostic]:
    """A signal whose blackboard entry no port and no script of the mission writes, if another entry has nearly the same
    name, or if a guard reads it.  The latter is a hint, as the robot's program may write the entry.  A signal reads the
    root blackboard: an entry in a tree's own blackboard is another one; without a guard that is a hint, for what a log
    has under the entry's name may come from elsewhere."""
    if not view.ask(has_nodes) or not view.ask(inputs.is_complete) or not view.is_read:
        return
    if view.ask(inputs.is_included):
        return  # it may be written in the files that include this one
    keys = view.ask(written_keys)
    entries = view.ask(all_entries)
    writes = [write for of_tree in entries for write in of_tree.writes]
    is_closed = not any(of_tree.is_open for of_tree in entries)
    sure = {node for of_tree in entries for node, _ in of_tree.sure} if is_closed else set()
    guarding = {signal.name for signals, *_ in guards for signal in signals}
    related: tuple[Related, ...]
    for signal in own_signals:
        key = signal.entry
        is_guarding = signal.name in guarding
        writer = isolated(view, writes, key) if key in keys else None
        if writer is not None and (is_guarding or (writer in sure and view.ask(lookups.is_asked_for, signal.name))):
            message = f"`{signal.name}` reads the root's `{key}`, but the tree `{writer.tree}` writes its own `{key}`"
            notes = (f"write `{{@{key}}}`, or pass the entry on to the tree: `{key} = {{{key}}}`",)
            related = (Related(writer.place, "written here"),)
            severity = None if is_guarding else Severity.HINT
            yield diagnostic_at(signal.place, "signal-never-written", message, related, notes, severity=severity)
            continue
        if key in keys:
            continue
        likely = view.ask(_near_keys, key)
        if not (likely or is_guarding):
            continue
        message = f"no port and no script writes `{key}`, the entry of `{signal.name}`"
        notes = (f"did you mean `{likely[0]}`?" if likely else "ignore this if the robot's program writes it",)
        lost, port = (None, "") if likely else _unconnected(view, signal)
        related = ()
        if lost is not None:
            notes = (f"connect the output `{port}` of {lost.shown_kind}: `{port} = {{@{key.removeprefix('@')}}}`",)
            related = (Related(lost.place, f"writes `{port}` nowhere"),)
        severity = None if likely or lost is not None else Severity.HINT
        yield diagnostic_at(signal.place, "signal-never-written", message, related, notes, severity=severity)


def _unconnected(view: View, signal: ResolvedSignal) -> tuple[ResolvedNode | None, str]:
    """The first node with an output that has the name of a signal or of its entry and writes to no entry; and that
    name."""
    names = dict.fromkeys((signal.name, signal.entry.removeprefix("@")))
    for path, tree in view.ask(inputs.trees):
        for node in [node for node in view.seen_in(path, tree).all if node.is_defined]:
            given = {pair.key.text for pair in node.node.attributes}
            for name in [name for name in names if name not in given]:
                port = port_of(view, node, name)
                if port is not None and port.direction == "output":
                    return node, name
    return None, ""


def _near_keys(store: Store[Workspace], viewpoint: str, key: str) -> tuple[str, ...]:
    """The entries that are written and have a name similar to this one."""
    return near(key, store.ask(written_keys, viewpoint))


def _of_text(view: View, own_signals: list[ResolvedSignal]) -> Iterator[PlacedDiagnostic]:
    """A numeric signal whose entry a text port writes.  A script that compares it converts the text, and throws if that
    is not a number."""
    main = view.ask(mission)
    numbers = {signal.entry: signal for signal in own_signals if signal.sort == "number"}
    entries = [of_tree for of_tree in view.ask(all_entries) if not numbers.keys().isdisjoint(of_tree.pointers)]
    for key, signal in numbers.items():
        for node, pair, is_of_root in (pointer for of_tree in entries for pointer in of_tree.pointers.get(key, ())):
            if not is_of_root and (main is None or node.tree != main.tree):
                continue
            port = port_of(view, node, pair.key.text) if node.kind is None else None
            if port is None or port.direction == "input" or not is_text(port.type):
                continue
            port_of_node = f"the port `{pair.key.text}` of `{node.node.head.text}`"
            message = f"the signal `{signal.name}` is a number, but {port_of_node} writes a string"
            related = (Related(node.place, "written here"),)
            notes = ("the engine converts the string to a number; if that fails, the mission ends",)
            yield diagnostic_at(signal.place, "unit-mismatch", message, related, notes, severity=Severity.WARNING)
            break


def _may_be_unset(view: View, guards: Iterable[Guard]) -> Iterator[PlacedDiagnostic]:
    """A guard on a signal without an initial value, or a classic guard on an entry that nothing writes: the engine ends
    the mission if it reads the entry before anything writes it."""
    reported: dict[str, tuple[ResolvedSignal, list[Related]]] = {}
    for read, entries, place in guards:
        for entry in entries:
            if (
                entry.removeprefix("@") not in view.ask(written_keys)
                and view.is_read
                and not view.ask(inputs.is_included)
            ):
                message = (
                    f"nothing in the mission writes `{entry}`: it ends if a guard reads it before anything writes it"
                )
                notes = (f'write it first: `Script (code = "{entry} := …")`',)
                yield diagnostic_at(place, "signal-may-be-unset", message, notes=notes)
        for signal in read:
            if signal.key is not None and signal.initially is None:
                related = reported.setdefault(signal.name, (signal, []))[1]
                related.append(Related(place, "the engine checks this"))
    for name, (signal, related) in reported.items():
        place = signal.place if signal.place.path == view.path else related[0].place
        message = f"`{name}` has no initial value: the mission ends if a guard reads it before anything writes it"
        notes = ("add an initial value: `initially …`",)
        yield diagnostic_at(place, "signal-may-be-unset", message, related=tuple(related[:3]), notes=notes)
