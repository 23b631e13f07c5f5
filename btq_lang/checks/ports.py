"""Ports: unknown, missing, declared twice, or with a type that is misspelt."""

from __future__ import annotations

import re
from collections.abc import Iterator

from btq_lang.catalog.foreign_names import NAME, of_other_engines
from btq_lang.catalog.literals import is_known_type, plain_type
from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.names import is_port_name
from btq_lang.catalog.nav2 import ports_of
from btq_lang.catalog.nodes import BUILTINS, KNOWN_WORDS, OLD_PORTS, PortKind
from btq_lang.catalog.units import Unit, convert, dimension_name, parse_unit
from btq_lang.catalog.versions import ID_IN_COMPACT_FORM
from btq_lang.checks import lookups
from btq_lang.checks.attributes import NAMES_OF_NODES, attribute_meant, may_remap_all
from btq_lang.checks.entries import handling
from btq_lang.checks.kinds import model_related, way_in
from btq_lang.checks.known_ports import KnownPorts, is_case, known_ports, throwing
from btq_lang.checks.own_nodes import OWN, WHY, may_be_own
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Fix, FixEdit, Place, Related, replace_fix, write_fix
from btq_lang.diagnostics.rules import Severity
from btq_lang.syntax.tokens import NUMBER, QUANTITY
from btq_lang.syntax.tree import Model, Node, Verbatim, Word, is_name, quote, written
from btq_lang.util.spelling import did_you_mean, distance, near
from btq_lang.util.text import Span
from btq_lang.workspace import inputs
from btq_lang.workspace.resolved import ResolvedNode

_ASSIGNABLE = re.compile(r"-?[0-9.]+|true|false|\{@?\w+\}")


def unknown_port(view: View) -> Iterator[Diagnostic]:
    """A port that the built-in, the model or the tree of a SubTree does not have."""
    for resolved in view.seen.given:
        yield from _forbidden_id(resolved) if ID_IN_COMPACT_FORM.holds(view.target) else ()
        ports = known_ports(view, resolved)
        if (
            ports is None
            or not (unknown_keys := _unknown_keys(view, resolved, ports))
            or _may_have_more(view, resolved)
            or _assignments(resolved, ports) is not None  # which missing_port reports
        ):
            continue
        all_ports = ports.all
        names = ", ".join(f"`{port.name}`" for port in all_ports)
        required = {port.name for port in ports.required}
        stale = _of_model_in_xml(view, resolved)
        of_nav2 = ports_of(resolved.id.text) if resolved.id is not None and _is_of_pool(view, resolved) else None
        for key, likely in unknown_keys.items():
            if key.text in (of_nav2 or ()):
                continue  # the model may be one of another program, or a short one
            if _is_in_ignored_element(view, resolved, key.text):
                continue  # which elements.py reports
            # The engine takes any port of a SubTree, a model without ports is often an unfinished one, and a program
            # may register another node than the one that another file of the project declares.
            harmless = (resolved.is_subtree and not required.intersection(likely)) or not (all_ports or resolved.kind)
            harmless = harmless or _is_of_pool(view, resolved)
            fixes = _renamings(view, resolved, ports, key, likely)
            if node := _node_meant(resolved, ports, key, likely):
                likely = (node,)
                fixes = (
                    replace_fix(f"Replace `{resolved.node.head.text}` with `{node}`", resolved.node.head.span, node),
                )
            elif assigned := _assigned(view, resolved, ports, key, likely):
                likely, fixes = assigned
            is_own = not harmless and may_be_own(view, resolved, ports.names, bool(near(key.text, ports.names)))
            what = OWN if is_own else ""
            message = f"{resolved.shown_kind} has no port `{key.text}`{what}{did_you_mean(likely) or stale}"
            related = _declared(view, resolved)
            notes = (f"it has {names}" if all_ports else "it has no ports", *_of_version_3(view, resolved, key.text))
            if resolved.kind is not None and not likely and (note := of_other_engines(resolved.kind.flow, key.text)):
                notes += (note,)
            notes += WHY if is_own else ()
            severity = Severity.WARNING if harmless or is_own else None
            yield Diagnostic("unknown-port", key.span, message, related, notes, fixes, severity=severity)
            if not all_ports and resolved.kind is None:
                break  # all of the model's ports are missing


def _is_in_ignored_element(view: View, resolved: ResolvedNode, key: str) -> bool:
    """Whether the model of a node in XML has a port in an element of another name: `<input name="key"/>`."""
    name = resolved.id.text if resolved.is_defined and resolved.id is not None else ""
    model = view.ask(lookups.meaning, Kind.MODEL, name) if name else None
    body = model.target.body if model is not None and isinstance(model.target, Model) else ()
    texts = [part.text.text for part in body if isinstance(part, Verbatim) and part.text is not None]
    return any(f'name="{key}"' in text for text in texts)


def missing_port(view: View) -> Iterator[Diagnostic]:
    """A port without a value: one the engine requires, or an input without default of a model."""
    for resolved in view.nodes:
        ports = known_ports(view, resolved)
        if ports is None or not ports.required:
            continue
        keys = {pair.key.text for pair in resolved.node.attributes}
        if resolved.is_subtree:  # the engine passes to a tree only what it takes for ports
            keys = set(filter(is_port_name, keys))
        missing = _needed(view, resolved, [port for port in ports.required if port.name not in keys])
        if (
            not missing
            or (resolved.is_subtree and may_remap_all(resolved))
            or view.is_torn(resolved.node.start, resolved.node.end)
        ):
            continue  # a value may be on a line that could not be read
        if _may_have_more(view, resolved):
            continue  # and so may a default
        misspelt = {
            likely[0] for likely in _unknown_keys(view, resolved, ports).values() if likely
        }  # reported as unknown, with a fix
        missing = [port for port in missing if port.name not in misspelt]
        if not missing:
            continue
        names = " and ".join(f"`{port.name}`" for port in missing)
        as_value, to_port = _label_as_value(view, resolved, missing)
        is_own = may_be_own(view, resolved, ports.names)
        is_severe = not is_own and bool(resolved.kind or resolved.is_subtree or throwing(resolved))
        yield Diagnostic(
            "missing-port",
            resolved.node.head.span,
            f"{resolved.shown_kind} requires {'a value' if len(missing) == 1 else 'values'} for its "
            f"port{'s' if len(missing) > 1 else ''} {names}{OWN if is_own else ''}",
            related=_declared(view, resolved),
            notes=(
                *(f"`{port.name}`: {port.doc}" for port in missing if port.doc),
                *(
                    f"the engine cannot set `{port.name}`: remove it from the model"
                    for port in missing
                    if port.name[:1] == "_"
                ),
                *as_value,
                *(f"write `{script}`" for script in (_assignments(resolved, ports),) if script is not None),
                *(WHY if is_own else ()),
            ),
            fixes=(*to_port, *_passing_on(view, resolved, missing)),
            # Only the robot's program knows whether it requires an input, except for the nodes of Nav2.
            severity=None if is_severe else Severity.WARNING,
        )


def duplicate_port(view: View) -> Iterator[Diagnostic]:
    """Two ports of one name in a model or a tree: the engine takes the last one, and tools the first."""
    for owner in view.owners:
        first: dict[str, Word] = {}
        for port in owner.ports:
            name = port.id
            if name is None or not name.text:
                continue
            if first.setdefault(name.text, name) is not name:
                message = f"duplicate port `{name.text}`"
                related = (Related(Place(first[name.text].span), "first one"),)
                yield Diagnostic("duplicate-definition", name.span, message, related=related, severity=Severity.WARNING)


def misspelt_type(view: View) -> Iterator[Diagnostic]:
    """`strng`: not a type of C++ and probably not one of the robot's program; its values then are not checked."""
    for owner in view.owners:
        for port in owner.ports:
            name = port.type.text if port.type is not None else ""
            if not name.islower() or len(name) < 4 or is_known_type(plain_type(name)):
                continue
            likely = [type_name for type_name in _TYPES if distance(name, type_name, 1) == 1]
            if port.type is None or not likely:
                continue
            fix = replace_fix(f"Replace `{name}` with `{likely[0]}`", port.type.span, likely[0])
            message = f"unknown type `{name}`; did you mean `{likely[0]}`?"
            yield Diagnostic("misspelt-type", port.type.span, message, fixes=(fix,))


def _may_have_more(view: View, resolved: ResolvedNode) -> bool:
    """Whether a port may be declared on a line that could not be read."""
    name = resolved.id
    if name is None or not (resolved.is_subtree or resolved.is_defined):
        return False
    kinds = (Kind.TREE, Kind.MODEL) if resolved.is_subtree else (Kind.MODEL,)
    return any(view.ask(lookups.is_torn, kind, name.text) for kind in kinds)


def _of_version_3(view: View, resolved: ResolvedNode, key: str) -> tuple[str, ...]:
    """The notes about a port that a built-in has in version 3 of the engine only."""
    if resolved.kind is None or (resolved.kind.tag, key) not in OLD_PORTS:
        return ()
    return (f"version 3 of the engine has `{key}`", *way_in(view))


def _of_model_in_xml(view: View, resolved: ResolvedNode) -> str:
    """The end of a message about a port of a node whose only model is in XML: the model may be out of date."""
    name = resolved.id if resolved.is_defined and not (resolved.kind or resolved.is_subtree) else None
    declaration = view.ask(lookups.declaration, Kind.MODEL, name.text) if name is not None else None
    if name is None or declaration is None or not view.store.ask(lookups.is_xml, declaration.path):
        return ""
    if view.ask(lookups.is_repeated, Kind.MODEL, name.text):
        return ""
    return f": its model in {view.project.shown(declaration.path)} lacks it"


def _is_of_pool(view: View, resolved: ResolvedNode) -> bool:
    """Whether only the model of a file that this one does not include declares a node."""
    return (
        resolved.kind is None
        and resolved.id is not None
        and resolved.is_defined
        and not view.ask(lookups.is_defined, Kind.MODEL, resolved.id.text)
    )


def _needed(view: View, resolved: ResolvedNode, missing: list[PortKind]) -> list[PortKind]:
    """The missing ports that a node seems to need.

    A model in C++ says which inputs its node can do without; one in XML does not.  If there are several such nodes and
    none has a value for a port, the port is optional; likewise if the model may be one of another program.
    """
    if not missing or resolved.kind is not None or resolved.is_subtree or resolved.id is None:
        return missing
    name = resolved.id.text
    definition = view.ask(inputs.definition, Kind.MODEL, name)
    if definition is None:
        return []
    if not view.store.ask(lookups.is_xml, definition[0]):
        return missing
    _, used, uses = view.ask(lookups.custom_node, name)
    used_names = {port.name for port in used}
    return missing if uses == 1 else [port for port in missing if port.name in used_names]


def _is_used_in(view: View, tree: str, entry: str) -> bool:
    """Whether a node of a tree reads or writes an entry."""
    return any(touch.name == entry for touch in view.ask(handling, tree).touches)


def _unknown_keys(view: View, resolved: ResolvedNode, ports: KnownPorts) -> dict[Word, tuple[str, ...]]:
    """The keys that are not ports, each with the ports without a value that it may mean."""
    names = ports.names
    keys = [pair.key.text for pair in resolved.node.attributes]
    if names.issuperset(keys):
        return {}
    has_value = set(keys)
    free = [port for port in ports.all if port.name not in has_value]
    unknown: dict[Word, tuple[str, ...]] = {}
    for pair in resolved.node.attributes:
        key = pair.key.text
        if key in names or key in NAMES_OF_NODES or not is_port_name(key) or is_case(resolved, key):
            continue
        if resolved.is_subtree and resolved.id is not None and _is_used_in(view, resolved.id.text, key):
            continue  # the tree gets the entry, whatever its model declares
        old = OLD_PORTS.get((resolved.kind.tag, key)) if resolved.kind else None
        old = old or attribute_meant(key, view.target)
        likely = near(key, (port.name for port in free)) if len(unknown) * len(free) < _MOST_COMPARED else ()
        unknown[pair.key] = (old,) if old else likely
    strange = [key for key, likely in unknown.items() if not likely]
    missing = [port.name for port in free if port.required]
    if len(strange) == len(missing) == 1 and not any(missing[0] in likely for likely in unknown.values()):
        unknown[strange[0]] = (missing[0],)  # `timeout_ms` can only be `msec`
    return unknown


def _renamings(
    view: View, resolved: ResolvedNode, ports: KnownPorts, key: Word, likely: tuple[str, ...]
) -> tuple[Fix, ...]:
    """The fixes that write a port's name in place of a key; if the key names a unit, the value gets it."""
    value = resolved.node.attribute(key.text)
    unit = _unit_in(key.text)
    fixes: list[Fix] = []
    for name in likely:
        of_port = parse_unit(port.unit or "") if (port := ports.named(name)) is not None else None
        title = f"Replace `{key.text}` with `{name}`"
        if unit is None or of_port is None or value is None or unit == of_port or value.kind == QUANTITY:
            fixes.append(replace_fix(title, key.span, written(name)))
        elif value.kind == NUMBER and unit.dimension == of_port.dimension:
            amount = f"{value.raw} {unit.symbol}"
            if view.is_xml:
                amount = f"{convert(float(value.raw), unit, of_port):g}"
            changes = (FixEdit(Place(key.span), written(name)), FixEdit(Place(value.span), amount))
            fixes.append(Fix(f"Write `{name} = {amount}`", changes))
    return tuple(fixes)


def _unit_in(key: str) -> Unit | None:
    """The unit of time with which a key ends: `seconds`, `timeout_s`, `delaySec`."""
    word = _WORDS_IN_KEY.findall(key)[-1:]
    unit = parse_unit(word[0].lower()) if word else None
    return unit if unit is not None and dimension_name(unit) == "time" else None


def _node_meant(resolved: ResolvedNode, ports: KnownPorts, key: Word, likely: tuple[str, ...]) -> str | None:
    """The one built-in with a port of this name, of another role than the missing one: `Loop (num_cycles = 3)`."""
    port = ports.named(likely[0]) if len(likely) == 1 else None
    if resolved.kind is None or port is None or near(key.text, likely):
        return None
    beside = [kind for kind in BUILTINS.values() if kind.category == resolved.kind.category and kind.port(key.text)]
    meant = beside[0].port(key.text) if len(beside) == 1 else None
    return beside[0].tag if meant is not None and meant.role not in ("", port.role) else None


def _assigned(
    view: View, resolved: ResolvedNode, ports: KnownPorts, key: Word, likely: tuple[str, ...]
) -> tuple[tuple[str, ...], tuple[Fix, ...]] | None:
    """The suggestion and the fix for `Script (x = 3)`, which assigns to an entry as if it were a port."""
    port, value = ports.named(likely[0]) if len(likely) == 1 else None, resolved.node.attribute(key.text)
    if (
        resolved.flow != "succeeds"
        or port is None
        or port.content != "script"
        or value is None
        or near(key.text, likely)
    ):
        return None
    if not _ASSIGNABLE.fullmatch(value.text):
        return None  # perhaps a script itself
    script = f"{key.text} := {value.text.strip('{}')}"
    written_value = script if view.is_xml else quote(script)
    changes = (FixEdit(Place(key.span), port.name), FixEdit(Place(value.span), written_value))
    shown = f'{port.name} = "{script}"'
    return (shown,), (Fix(f"Write `{shown}`", changes),)


def _assignments(resolved: ResolvedNode, ports: KnownPorts) -> str | None:
    """The script for `<Script tries="0" place="shelf"/>`, which assigns to several entries as if they were ports."""
    given = {pair.key.text: pair.value.text for pair in resolved.node.attributes if pair.value is not None}
    entries = {key: text for key, text in given.items() if is_name(key) and key[0] != "_" and key != "name"}
    is_script = resolved.flow == "succeeds" and [port.content for port in ports.required] == ["script"]
    is_plain = len(entries) > 1 and all(_ASSIGNABLE.fullmatch(text) or is_name(text) for text in entries.values())
    if not is_script or not is_plain or not ports.names.isdisjoint(entries):
        return None
    values = {key: text.strip("{}") if _ASSIGNABLE.fullmatch(text) else f"'{text}'" for key, text in entries.items()}
    return f'{ports.required[0].name}="{"; ".join(f"{key} := {value}" for key, value in values.items())}"'


def _forbidden_id(resolved: ResolvedNode) -> Iterator[Diagnostic]:
    """`-> (ID = x)`: the engine accepts an ID in the explicit form only."""
    node = resolved.node
    if node.kind is None or node.category is not None or (not node.kind.quoted and node.kind.raw in KNOWN_WORDS):
        return
    for pair in node.attributes:
        if pair.key.text == "ID":
            message = f"the engine refuses the attribute `ID` on {resolved.shown_kind}"
            fix = replace_fix("Replace `ID` with `name`", pair.key.span, "name")
            fixes, notes = ((), ()) if node.name is not None else ((fix,), (NAME,))
            yield Diagnostic("unknown-port", pair.key.span, message, notes=notes, fixes=fixes)


def _declared(view: View, resolved: ResolvedNode) -> tuple[Related, ...]:
    if resolved.is_subtree:
        return view.declared_at(Kind.TREE, resolved.id.text, _DECLARED) if resolved.id is not None else ()
    return model_related(view, resolved, _DECLARED)


def _passing_on(view: View, resolved: ResolvedNode, missing: list[PortKind]) -> tuple[Fix, ...]:
    """The fix that passes to a custom node or a SubTree the blackboard entries named as its ports."""
    if resolved.kind is not None:
        return ()
    pairs = " ".join(f"{written(port.name)} = {{=}}" for port in missing)
    return adding_fix(
        view, resolved.node, f"Pass on the entr{'y' if len(missing) == 1 else 'ies'} of the same name", pairs
    )


def _label_as_value(
    view: View, resolved: ResolvedNode, missing: list[PortKind]
) -> tuple[tuple[str, ...], tuple[Fix, ...]]:
    """The note and the fix for `Precondition "x > 3"`, whose label is probably the value that a built-in lacks."""
    label = resolved.node.label
    if resolved.kind is None or label is None or not label.quoted or view.is_xml or len(missing) != 1:
        return (), ()
    pair = f"({written(missing[0].name)} = {label.raw})"
    fixes = () if resolved.node.attributes else (write_fix(pair, label.span),)
    return (f"btq reads `{label.raw}` as its label; for a value, write `{pair}`",), fixes


def adding_fix(view: View, node: Node, title: str, pairs: str) -> tuple[Fix, ...]:
    """The fix that adds attributes to a node; none if there is no place for them.

    Args:
        pairs: the attributes as a .btq file writes them.
    """
    title = f"{title}: `{pairs}`"
    if node.attributes:
        end = node.attributes[-1].span.end
        return (replace_fix(title, Span(end, end), f" {pairs}"),)
    end = (node.label or node.kind or node.head).end
    behind = view.text[end : node.end].lstrip(" \t")
    return () if behind.startswith("(") else (replace_fix(title, Span(end, end), f" ({pairs})"),)


_DECLARED = "ports declared here"
_TYPES = (
    "string",
    "double",
    "float",
    "bool",
    "unsigned",
    "long",
    "short",
    "int32_t",
    "uint32_t",
    "int64_t",
    "uint64_t",
)

# For a node with hundreds of ports and as many mistakes suggestions are of no use.
_MOST_COMPARED = 2_000

_WORDS_IN_KEY = re.compile(r"[A-Z]?[a-z]+")
