"""Values of ports with which a node has no effect or fails when it is ticked: literals for outputs, names of entries in
braces, counts and times.

Sources: SetBlackboardNode::tick and UnsetBlackboardNode::tick, which get the name by getInput (4.6.2, 4.10.0); the tick
functions of RepeatNode, RetryNode, TimeoutNode and DelayNode in 4.6.2, 4.8.4 and 4.10.0.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cache

from btq_lang.catalog.kinds import NodeKind
from btq_lang.catalog.literals import OLD_ENTRY, check_literal, is_pointer
from btq_lang.catalog.nodes import BUILTINS
from btq_lang.catalog.versions import OUTPUT_IN_BRACES, at_least, last_of
from btq_lang.checks import lookups
from btq_lang.checks.engines import is_for_version_3
from btq_lang.checks.meant_entries import entry_in
from btq_lang.checks.view import View, ports_beside
from btq_lang.diagnostics.model import Diagnostic, replace_fix
from btq_lang.diagnostics.rules import Severity
from btq_lang.syntax.quantities import parse_quantity
from btq_lang.syntax.tokens import QUANTITY
from btq_lang.syntax.tree import Pair, Port, Tree, Word, is_name
from btq_lang.workspace import inputs
from btq_lang.workspace.item_index import Facts
from btq_lang.workspace.queries import Store
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace


def literal_for_output(view: View) -> Iterator[Diagnostic]:
    """A value for an output, which needs an entry to write to: the node fails to write when it is ticked.  The engine
    refuses a value that the output's type does not accept already at load.

    Some programs take such a value for the name of an entry.  If most outputs of a file have one, that is reported
    once, as a hint.
    """
    if not OUTPUT_IN_BRACES.holds(view.target):
        return
    for resolved, pair, value, type_ in _outputs(view, view.seen.given):
        if not _is_literal(value) or OLD_ENTRY.fullmatch(value.text):
            continue  # `${key}` is one mistake, which old_entry reports
        problem = check_literal(type_, value.text, view.target)
        is_refused = problem is not None and problem.kind == "refused"
        is_custom = not is_refused and not view.ask(is_for_version_3) and view.ask(_is_custom)
        if is_custom and not _is_first_value(view, pair):
            continue
        name = value.text if is_name(value.text) else pair.key.text
        meant = entry_in(view, value) or f"{{{name}}}"
        entry = replace_fix(f"Write the entry `{meant}`", value.span, meant)
        fixes = (entry,) if is_name(name) and not is_custom else ()
        notes: tuple[str, ...] = ()
        if is_custom:
            notes = (
                "many outputs of this file have a literal; ignore this if your program reads it as an entry's name",
            )
        elif is_refused and problem is not None:
            notes = (f"the engine refuses this value: the port expects {problem.expected}",)
        output = f"the output `{pair.key.text}` of {resolved.shown_kind}"
        message = f"expected a blackboard entry for {output}, found `{value.raw}`"
        severity = Severity.HINT if is_custom else Severity.ERROR if is_refused else None
        yield Diagnostic("literal-for-output", value.span, message, notes=notes, fixes=fixes, severity=severity)


def _outputs(view: View, nodes: Iterable[ResolvedNode]) -> Iterator[tuple[ResolvedNode, Pair, Word, str]]:
    """The values for the outputs of nodes with attributes, and the outputs' types; empty for those of a tree, which
    take any value."""
    for resolved in nodes:
        if resolved.is_placeholder:
            continue
        types = _types(view, resolved)
        for pair in resolved.node.attributes if types else ():
            if pair.value is not None and (type_ := types.get(pair.key.text)) is not None:
                yield resolved, pair, pair.value, type_


def _is_custom(store: Store[Workspace], viewpoint: str) -> bool:
    """Whether most outputs of the file have a value, or many."""
    counts = [store.ask(_counts, viewpoint, tree) for tree in store.ask(lookups.trees, viewpoint)]
    assigned, values = sum(count[0] for count in counts), sum(count[1] for count in counts)
    return values > 2 and (values > assigned / 2 or values > 9)


def _is_first_value(view: View, pair: Pair) -> bool:
    """Whether no output of the file before this one has a value."""
    values = (other for _, other, value, _ in _outputs(view, view.seen.given) if _is_literal(value))
    return view.ask(_first_with_value) is view.facts and next(values, None) is pair


def _first_with_value(store: Store[Workspace], viewpoint: str) -> Facts | None:
    trees = store.ask(lookups.trees, viewpoint)
    return next((tree for tree in trees if store.ask(_counts, viewpoint, tree)[1]), None)


def _counts(store: Store[Workspace], viewpoint: str, tree: Facts) -> tuple[int, int]:
    """The number of a tree's assigned outputs, and of those with a value."""
    view = View(store, viewpoint)
    nodes = view.seen_in(viewpoint, tree).given
    assigned = [value for _, _, value, _ in _outputs(view, nodes)]
    return len(assigned), sum(map(_is_literal, assigned))


def _is_literal(value: Word) -> bool:
    """Whether a value is neither an entry nor empty, as tools write it for an unused port; `=` is `{=}`."""
    return value.text not in ("", "=") and not is_pointer(value.text)


def _types(view: View, resolved: ResolvedNode) -> dict[str, str]:
    """The outputs of a node, and their types."""
    if resolved.kind is not None:
        return _outputs_of(resolved.kind.tag)
    types = _declared(ports_beside(view, resolved))
    if resolved.is_subtree:
        return dict.fromkeys(types, "")
    index = resolved.behavior.port_for("index") if resolved.behavior is not None else None
    return types if index is None else {**types, index.name: index.type}


@cache
def _outputs_of(tag: str) -> dict[str, str]:
    return {port.name: port.type for port in BUILTINS[tag].ports if port.direction == "output"}


def _declared(ports: tuple[Port, ...]) -> dict[str, str]:
    return {
        port.name.text: port.type.text if port.type is not None else ""
        for port in ports
        if port.direction.raw == "output" and port.name is not None
    }


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


def count_of_nothing(view: View) -> Iterator[Diagnostic]:
    """A Repeat or a Retry that never runs its child, a Timeout that never ends, a Delay that does not wait."""
    if (
        view.is_pinned or view.project.names_all
    ) and not view.project.original_engines:  # what moves on meets the change
        yield from _delays(view)
    for resolved in view.seen.of_flow("repeat", "retry", "timeout"):
        if resolved.kind is None:
            continue
        port = resolved.kind.port_for("time" if resolved.flow == "timeout" else "count")
        value = resolved.node.attribute(port.name) if port is not None else None
        number = _number(value) if value is not None else None
        if value is None or number is None:
            continue
        if resolved.flow == "timeout":
            if number == 0:
                yield _timeout(resolved.kind, value)
        elif number < 1 and number != -1:
            yield _loop(resolved, value, number)


def _delays(view: View) -> Iterator[Diagnostic]:
    """Each Delay, if a release of a line that the project names does not wait in it."""
    delays = view.seen.of_flow("delay")
    if not delays:
        return
    from btq_lang.catalog.engine_changes import NO_DELAY  # few files have a Delay and are for one line

    if any(at_least(last_of(line), NO_DELAY.since) and not at_least(line, NO_DELAY.until) for line in view.engines):
        pin = f'if you run {view.target}, set `engine = "{view.target}"` in btq.toml'
        notes = (NO_DELAY.instead, *(() if view.is_pinned else (pin,)))
        severity = None if view.is_pinned else Severity.HINT  # `btq init` names all, and the robot may run another
        for resolved in delays:
            message = f"{resolved.shown_kind} {NO_DELAY.what}"
            yield Diagnostic("count-of-nothing", resolved.node.head.span, message, notes=notes, severity=severity)


def _loop(resolved: ResolvedNode, value: Word, number: float) -> Diagnostic:
    fixes = (replace_fix("Write `-1` for endless", value.span, "-1"),) if number < 0 else ()
    message = f"{resolved.shown_kind} never runs its child with `{value.raw}`"
    notes = ("-1 means endless, other numbers below 1 mean never",)
    return Diagnostic("count-of-nothing", value.span, message, notes=notes, fixes=fixes)


def _timeout(kind: NodeKind, value: Word) -> Diagnostic:
    message = f"a {kind.tag} of `{value.raw}` is disabled: it never halts its child"
    return Diagnostic("count-of-nothing", value.span, message)


def _number(value: Word) -> float | None:
    if value.kind == QUANTITY:
        quantity = parse_quantity(value.raw)
        return quantity[0] if quantity is not None else None
    text = value.text
    return int(text) if text.removeprefix("-").isdecimal() and len(text) < 12 else None


_INDIRECT = tuple((kind.tag, port.name) for kind in BUILTINS.values() for port in kind.ports if port.indirect)
_PORTS = tuple(port for _, port in _INDIRECT)
