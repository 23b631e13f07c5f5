"""Signals that nothing writes, and guards that read one before its first sample."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.catalog.attributes import RESERVED_ATTRIBUTES
from btq_lang.catalog.literals import is_pointer
from btq_lang.checks.demanded import Demanded, Found, is_enforced
from btq_lang.checks.view import View
from btq_lang.diagnostics import Diagnostic, Place, Related
from btq_lang.entry_types import is_text
from btq_lang.near import near
from btq_lang.requirements import Requirements
from btq_lang.requirements.model import Signal, SourceNode
from btq_lang.requirements.reading import signals_in
from btq_lang.rules import Severity
from btq_lang.symbols import Kind
from btq_lang.syntax import Model, Pair, Port, Tree

_GUARDS = frozenset(("needs", "keeps", "never", "leaves", "uses"))


def signal_never_written(demanded: Demanded) -> Iterator[Found]:
    """A signal whose blackboard entry no port and no script of the mission writes, where another entry has nearly the
    same name, or where a guard reads it; the robot's program may write it, so then it is a hint.  A guard reads the
    root blackboard, so what a tree writes into its own is another entry."""
    found, view = demanded.requirements, demanded.view
    here = [signal for signal in found.signals.values() if signal.place.path == view.path and signal.key is not None]
    if not here or not found.nodes.all or not view.scope.complete or not view.is_read:
        return
    if view.path in view.workspace.included_files:
        return  # who writes it may be in the files that include this one
    writes = tuple(_writes(view, found.nodes.all))
    written = frozenset(key.removeprefix("@") for _, key in writes)
    guarding = {signal.name for signals, _ in _guards(demanded) for signal in signals}
    for signal in here:
        key = (signal.key or "").removeprefix("@")
        if key in written and signal.name in guarding and (writer := _isolated(found, writes, key)) is not None:
            message = f"`{signal.name}` is read from the root's `{key}`, and the tree `{writer.tree}` writes its own"
            notes = (f"write `{{@{key}}}`, or pass the entry on to the tree: `{key} = {{{key}}}`",)
            related = (Related(writer.place, "written here"),)
            yield signal.place, Diagnostic("signal-never-written", signal.place.span, message, related, notes)
            continue
        likely = near(key, written) if key not in written else ()
        if key in written or not (likely or signal.name in guarding):
            continue
        yield (
            signal.place,
            Diagnostic(
                "signal-never-written",
                signal.place.span,
                f"no port and no script writes `{key}`, from which `{signal.name}` is read",
                notes=(f"is it `{likely[0]}`?",) if likely else ("right where the robot's program writes it",),
                severity=None if likely else Severity.HINT,
            ),
        )


def signal_of_text(demanded: Demanded) -> Iterator[Found]:
    """A signal that is a number, whose entry a port of texts writes: a script that compares it converts the text, and
    throws where it is no number."""
    found, view = demanded.requirements, demanded.view
    numbers = {
        (signal.key or "").removeprefix("@"): signal
        for signal in found.signals.values()
        if signal.place.path == view.path and signal.key is not None and signal.sort == "number"
    }
    told: set[str] = set()
    for node in found.nodes.all if numbers else ():
        for pair in node.node.attributes:
            text = pair.value.text if pair.value is not None else ""
            key = (pair.key.text if text == "{=}" else text[1:-1].strip()) if is_pointer(text) else ""
            is_root = key[:1] == "@" or (found.mission is not None and node.tree == found.mission.tree)
            signal = numbers.get(key.removeprefix("@")) if is_root else None
            port = _declared(view, node, pair.key.text) if signal is not None else None
            if signal is None or port is None or port.type is None or port.direction.raw == "input":
                continue
            if not is_text(port.type.text) or signal.name in told:
                continue
            told.add(signal.name)
            message = (
                f"`{signal.name}` is a number, and `{pair.key.text}` of `{node.node.head.text}` writes a text there"
            )
            related = (Related(node.place, "written here"),)
            notes = ("the engine reads a number from the text, and ends the mission where there is none",)
            yield (
                signal.place,
                Diagnostic("unit-mismatch", signal.place.span, message, related, notes, severity=Severity.WARNING),
            )


def signal_may_be_unset(demanded: Demanded) -> Iterator[Found]:
    """A guard on a signal without a first value: until somebody writes it, the engine ends the mission."""
    told: dict[str, list[Related]] = {}
    signals: dict[str, Signal] = {}
    for read, place in _guards(demanded):
        for signal in read:
            if signal.key is None or signal.initially is not None:
                continue
            signals[signal.name] = signal
            told.setdefault(signal.name, []).append(Related(place, "this is checked by the engine"))
    for name, related in told.items():
        signal = signals[name]
        place = signal.place if signal.place.path == demanded.view.path else related[0].place
        yield (
            place,
            Diagnostic(
                "signal-may-be-unset",
                place.span,
                f"`{name}` has no value before its first sample, and a guard that reads it then ends the mission",
                related=tuple(related[:3]),
                notes=("give it one: `initially …`",),
            ),
        )


def _guards(demanded: Demanded) -> Iterator[tuple[tuple[Signal, ...], Place]]:
    """The signals that the engine reads to enforce a claim, each once, and where to tell of it."""
    known: dict[tuple[int, ...], tuple[Signal, ...]] = {}
    for applied, claim, _, place in demanded.claims:
        if claim.verb not in _GUARDS or not is_enforced(applied):
            continue
        parts = (claim.condition, claim.signal, *(scope.condition for scope in applied.requirement.scopes))
        key = tuple(map(id, parts))  # one claim may hold for many nodes
        if key not in known:
            known[key] = tuple({each.name: each for each in signals_in(parts)}.values())
        yield known[key], place


def _isolated(found: Requirements, writes: tuple[tuple[SourceNode, str], ...], key: str) -> SourceNode | None:
    """One that writes an entry of this name in the blackboard of its own tree, where nobody writes that of the root."""
    if found.mission is None:
        return None
    # Which name the root's entry has in which tree.
    names = {(found.mission.tree, key)}
    waiting = [found.mission.tree]
    while waiting:
        tree = waiting.pop()
        for node in found.nodes.all:
            if node.category != "SubTree" or node.tree != tree or node.node.id is None:
                continue
            for name in _passed_on(node, {name for of, name in names if of == tree}):
                if (node.node.id.text, name) not in names:
                    names.add((node.node.id.text, name))
                    waiting.append(node.node.id.text)
    writers = [node for node, written in writes if written.removeprefix("@") == key]
    if any(written == f"@{key}" or (node.tree, written) in names for node, written in writes):
        return None
    return writers[0]


def _passed_on(node: SourceNode, names: set[str]) -> Iterator[str]:
    """The names by which a tree that runs another one makes its entries known to that."""
    given = {pair.key.text: pair.value.text for pair in node.node.attributes if pair.value is not None}
    for port, text in given.items():
        if is_pointer(text) and (port if text[1:-1].strip() == "=" else text[1:-1].strip()) in names:
            yield port
    if given.get("_autoremap", "false").lower() not in ("false", "0"):
        yield from (name for name in names if name not in given and not name.startswith("_"))


def _writes(view: View, nodes: tuple[SourceNode, ...]) -> Iterator[tuple[SourceNode, str]]:
    """The entries that something may write, those of the root blackboard with their `@`."""
    for node in nodes:
        for pair in node.node.attributes:
            if pair.value is None:
                continue
            text = pair.value.text
            if _is_script(node, pair):
                yield from ((node, name) for name in _assigned(text))
            elif node.tag == "SetBlackboard" and pair.key.text == "output_key":
                yield node, text.strip("{}")
            elif is_pointer(text) and _may_write(view, node, pair.key.text):
                key = text[1:-1].strip()
                yield node, pair.key.text if key == "=" else key


def _is_script(node: SourceNode, pair: Pair) -> bool:
    attribute = RESERVED_ATTRIBUTES.get(pair.key.text)
    port = node.kind.port(pair.key.text) if node.kind is not None else None
    return (attribute is not None and attribute.is_script) or (port is not None and port.content == "script")


def _assigned(script: str) -> Iterator[str]:
    from btq_lang.script import parse_script, variables

    for variable in variables(parse_script(script)):
        if variable.writes:
            yield variable.name


def _may_write(view: View, node: SourceNode, port: str) -> bool:
    """Whether a port may be written: all but those that are said to be inputs."""
    if node.kind is not None:
        builtin = node.kind.port(port)
        return builtin is not None and builtin.direction != "input"
    declared = _declared(view, node, port)
    return declared is None or declared.direction.raw != "input"


def _declared(view: View, node: SourceNode, port: str) -> Port | None:
    """The port as the node's model, or the tree behind a SubTree, declares it."""
    name = node.node.id
    ports: tuple[Port, ...] = ()
    for kind in (Kind.TREE, Kind.MODEL):
        definition = view.scope.find(kind, name.text) if name is not None else None
        if definition is not None and isinstance(target := definition.symbol.target, Tree | Model):
            ports = ports or target.ports
    return next((each for each in ports if each.name is not None and each.name.text == port), None)
