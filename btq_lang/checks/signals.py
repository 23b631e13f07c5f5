"""Signals that nothing writes, and guards that read one before its first sample."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from btq_lang.catalog.verbs import words
from btq_lang.checks.demanded import Demanded, Found, Guard, is_enforced
from btq_lang.checks.writers import declared_port, isolated
from btq_lang.diagnostics.model import Diagnostic, Related
from btq_lang.diagnostics.rules import Severity
from btq_lang.util.spelling import near
from btq_lang.workspace.port_types import is_text

if TYPE_CHECKING:
    from btq_lang.checks.writers import Entries
    from btq_lang.requirements.memory import Memory
    from btq_lang.requirements.model import Signal

_READING = words(operands=("condition", "use"))


def of_signals(demanded: Demanded, guards: Iterable[Guard], memory: Memory) -> Iterator[Found]:
    """What these rules find.

    Args:
        guards: all claims for which the engine reads signals.
    """
    signals = demanded.requirements.signals.values()
    here = [each for each in signals if each.place.path == demanded.view.path and each.key is not None]
    guards = list(guards)
    yield from _may_be_unset(demanded, guards)
    if not here:
        return
    entries = demanded.entries
    yield from _never_written(demanded, here, entries, guards, memory)
    yield from _of_text(demanded, here, entries)


def guards(demanded: Demanded) -> Iterator[Guard]:
    """The signals that the engine reads to enforce a claim, each once, and where to tell of it."""
    known: dict[tuple[int, ...], tuple[Signal, ...]] = {}
    for applied, claim, _, place in demanded.claims:
        if claim.verb not in _READING or not is_enforced(applied):
            continue
        parts = (claim.condition, claim.signal, *(scope.condition for scope in applied.requirement.scopes))
        key = tuple(map(id, parts))  # one claim may hold for many nodes
        if key not in known:
            from btq_lang.requirements.reading import signals_in  # few missions have a claim that is enforced

            known[key] = tuple({each.name: each for each in signals_in(parts)}.values())
        yield known[key], place


def _never_written(
    demanded: Demanded, here: list[Signal], entries: list[Entries], guards: list[Guard], memory: Memory
) -> Iterator[Found]:
    """A signal whose blackboard entry no port and no script of the mission writes, where another entry has nearly the
    same name, or where a guard reads it; the robot's program may write it, so then it is a hint.  A guard reads the
    root blackboard, so what a tree writes into its own is another entry."""
    found, view = demanded.requirements, demanded.view
    if not found.nodes.are_known or not view.is_complete or not view.is_read:
        return
    if view.path in view.workspace.included_files:
        return  # who writes it may be in the files that include this one
    written = frozenset().union(*(each.written for each in entries))
    writes = [write for each in entries for write in each.writes] if guards else []
    guarding = {signal.name for signals, _ in guards for signal in signals}
    unwritten = [signal for signal in here if (signal.key or "").removeprefix("@") not in written]
    keys = [(signal.key or "").removeprefix("@") for signal in unwritten]
    table = memory.table("near", demanded)
    near_keys = table.all(unwritten, [written] * len(unwritten), lambda at: near(keys[at], written))
    likely_keys = dict(zip(keys, near_keys, strict=True))
    for signal in here:
        key = (signal.key or "").removeprefix("@")
        if key in written and signal.name in guarding and (writer := isolated(found, writes, key)) is not None:
            message = f"`{signal.name}` reads the root's `{key}`, but the tree `{writer.tree}` writes its own `{key}`"
            notes = (f"write `{{@{key}}}`, or pass the entry on to the tree: `{key} = {{{key}}}`",)
            related = (Related(writer.place, "written here"),)
            yield signal.place, Diagnostic("signal-never-written", signal.place.span, message, related, notes)
            continue
        if key in written:
            continue
        likely = likely_keys[key]
        if not (likely or signal.name in guarding):
            continue
        yield (
            signal.place,
            Diagnostic(
                "signal-never-written",
                signal.place.span,
                f"no port and no script writes `{key}`, the entry of `{signal.name}`",
                notes=(f"did you mean `{likely[0]}`?",)
                if likely
                else ("ignore this if the robot's program writes it",),
                severity=None if likely else Severity.HINT,
            ),
        )


def _of_text(demanded: Demanded, here: list[Signal], entries: list[Entries]) -> Iterator[Found]:
    """A signal that is a number, whose entry a port of texts writes: a script that compares it converts the text, and
    throws where it is no number."""
    mission = demanded.requirements.mission
    numbers = {(signal.key or "").removeprefix("@"): signal for signal in here if signal.sort == "number"}
    entries = [each for each in entries if not numbers.keys().isdisjoint(each.pointers)]
    for key, signal in numbers.items():
        for node, pair, is_of_root in (pointer for each in entries for pointer in each.pointers.get(key, ())):
            if not is_of_root and (mission is None or node.tree != mission.tree):
                continue
            port = declared_port(demanded, node, pair.key.text)
            if port is None or port.type is None or port.direction.raw == "input" or not is_text(port.type.text):
                continue
            port_of_node = f"the port `{pair.key.text}` of `{node.node.head.text}`"
            message = f"the signal `{signal.name}` is a number, but {port_of_node} writes a string"
            related = (Related(node.place, "written here"),)
            notes = ("the engine converts the string to a number; if that fails, the mission ends",)
            yield (
                signal.place,
                Diagnostic("unit-mismatch", signal.place.span, message, related, notes, severity=Severity.WARNING),
            )
            break


def _may_be_unset(demanded: Demanded, guards: Iterable[Guard]) -> Iterator[Found]:
    """A guard on a signal without a first value: until somebody writes it, the engine ends the mission."""
    told: dict[str, list[Related]] = {}
    signals: dict[str, Signal] = {}
    for read, place in guards:
        for signal in read:
            if signal.key is None or signal.initially is not None:
                continue
            signals[signal.name] = signal
            told.setdefault(signal.name, []).append(Related(place, "the engine checks this"))
    for name, related in told.items():
        signal = signals[name]
        place = signal.place if signal.place.path == demanded.view.path else related[0].place
        yield (
            place,
            Diagnostic(
                "signal-may-be-unset",
                place.span,
                f"`{name}` has no initial value: the mission ends if a guard reads it before anything writes it",
                related=tuple(related[:3]),
                notes=("add an initial value: `initially …`",),
            ),
        )
