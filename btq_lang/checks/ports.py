"""Ports and attributes: unknown, missing, given twice, or silently ignored by the engine."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from itertools import chain

from btq_lang.catalog.attributes import RESERVED_ATTRIBUTES
from btq_lang.catalog.foreign_names import NAME, of_other_engines
from btq_lang.catalog.literals import is_known_type, plain_type
from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.names import is_port_name, port_name_problem
from btq_lang.catalog.nav2 import ports_of
from btq_lang.catalog.nodes import BUILTINS, KNOWN_WORDS, OLD_PORTS, PortKind
from btq_lang.catalog.units import Unit, convert, dimension_name, parse_unit
from btq_lang.catalog.versions import ID_IN_COMPACT_FORM, PORTS_OF_SUBTREE, UNDERSCORES, is_before_4
from btq_lang.checks import lookups
from btq_lang.checks.entries import handling
from btq_lang.checks.kinds import model_related, way_in
from btq_lang.checks.own_nodes import OWN, WHY, may_be_own
from btq_lang.checks.pointers import pointed_at, remaps_all
from btq_lang.checks.view import View, ports_beside
from btq_lang.diagnostics.model import Diagnostic, Fix, FixEdit, Place, Related, replace_fix, write_fix
from btq_lang.diagnostics.rules import Severity
from btq_lang.syntax.tokens import NUMBER, QUANTITY
from btq_lang.syntax.tree import Include, Meta, Node, Pair, Port, Root, Tree, Word, models_in, quote, written
from btq_lang.util.record import replace
from btq_lang.util.spelling import did_you_mean, distance, near
from btq_lang.util.text import Span
from btq_lang.workspace import inputs
from btq_lang.workspace.port_types import as_kind
from btq_lang.workspace.queries import Store
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace

_OWN = frozenset(("ID", "name"))
_ASSIGNABLE = re.compile(r"-?[0-9.]+|true|false|\{@?\w+\}")
_REFERRED = re.compile('[<&"]')
# Attributes that people miss, in small letters, and whether `_skipIf` says the opposite.
_WISHED = {
    **dict.fromkeys(
        ("_onlyif", "_runif", "_executeif", "_tickif", "_doif", "_if", "_when", "_enableif", "_enabledif"), True
    ),
    **dict.fromkeys(("_unless", "_notif", "_ignoreif", "_disableif", "_disabledif"), False),
}


def unknown_port(view: View) -> Iterator[Diagnostic]:
    """A port that the built-in, the model or the tree of a SubTree does not have."""
    for resolved in view.seen.given:
        yield from _forbidden_id(resolved) if ID_IN_COMPACT_FORM.holds(view.target) else ()
        ports = _ports(view, resolved)
        if (
            ports is None
            or not (unknown_keys := _unknown_keys(view, resolved, ports))
            or _may_have_more(view, resolved)
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


def missing_port(view: View) -> Iterator[Diagnostic]:
    """A port without a value: one the engine requires, or an input without default of a model."""
    for resolved in view.nodes:
        ports = _ports(view, resolved)
        if ports is None or not ports.required:
            continue
        keys = {pair.key.text for pair in resolved.node.attributes}
        if resolved.is_subtree:  # the engine passes to a tree only what it takes for ports
            keys = set(filter(is_port_name, keys))
        missing = _needed(view, resolved, [port for port in ports.required if port.name not in keys])
        if (
            not missing
            or (resolved.is_subtree and _remaps_all(resolved))
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
        is_severe = not is_own and bool(resolved.kind or resolved.is_subtree or _throwing(resolved))
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
                *(WHY if is_own else ()),
            ),
            fixes=(*to_port, *_passing_on(view, resolved, missing)),
            # Only the robot's program knows whether it requires an input, except for the nodes of Nav2.
            severity=None if is_severe else Severity.WARNING,
        )


def unknown_attribute(view: View) -> Iterator[Diagnostic]:
    """`_skipif`: neither a port nor anything the engine reads, which it does not report."""
    if isinstance(view.item, Tree):
        for pair in view.item.attributes:
            kind = RESERVED_ATTRIBUTES.get(pair.key.text)
            if kind is not None and kind.is_script:
                message = f"`{pair.key.text}` has no effect on a BehaviorTree: move it to the tree's node"
                yield Diagnostic("unknown-attribute", pair.key.span, message)
    for resolved in view.seen.given:
        for pair in resolved.node.attributes:
            key = pair.key.text
            if is_port_name(key) or key in _OWN:
                meant = _ATTRIBUTES.get(_plain(key)) if UNDERSCORES.holds(view.target) else None
                if meant is not None and _ports(view, resolved) is None:
                    yield from _without_underscore(resolved, pair.key, meant)
                continue
            if not UNDERSCORES.holds(view.target):
                if resolved.category != "SubTree" and key != "_description":
                    message = f"{view.target} takes `{key}` for a port, and refuses {resolved.shown_kind}"
                    yield Diagnostic("unknown-attribute", pair.key.span, message, severity=Severity.ERROR)
                continue
            if key in _KEPT:
                continue
            if resolved.is_subtree and key[:1] != "_":
                yield from _dropped(view, resolved, pair)
                continue
            if key.casefold() in _WISHED and pair.value is not None:
                yield _wished(view, pair, pair.value)
                continue
            likely = (_OF_TODAY[key],) if key in _OF_TODAY else near(key, _KEPT)
            if not likely:
                kept = "from 4.7 on the engine keeps it for the node's own code"
                refused = f"{view.target} reads it as a port, and refuses a node without a port of that name"
                is_port = is_port_name(key, view.target)
                note, severity = (refused, Severity.WARNING) if is_port else (kept, Severity.HINT)
                message = f"the engine does not read `{key}`"
                yield Diagnostic("unknown-attribute", pair.key.span, message, notes=(note,), severity=severity)
            elif not (key in _OF_TODAY and _is_off(pair.value)):
                fixes = tuple(replace_fix(f"Replace `{key}` with `{name}`", pair.key.span, name) for name in likely)
                message = f"the engine silently ignores `{key}`{did_you_mean(likely)}"
                yield Diagnostic("unknown-attribute", pair.key.span, message, fixes=fixes)


def _dropped(view: View, seen: ResolvedNode, pair: Pair) -> Iterator[Diagnostic]:
    """An argument of a SubTree that does not reach its tree, because of its name."""
    key = pair.key.text
    is_same = pair.value is not None and pointed_at(key, pair.value.text) == key
    if is_port_name(key, view.target) or (is_same and remaps_all(seen)):
        return
    reason = port_name_problem(key, view.target) or "it does not begin with a letter"
    notes = (
        "rename it here and in its tree",
        *(("releases before 4.8.4 pass it on",) if is_port_name(key, "4.6") else ()),
    )
    message = f"the engine drops the argument `{key}` because of its name: {reason}"
    yield Diagnostic("unknown-attribute", pair.key.span, message, notes=tuple(notes))


def _wished(view: View, pair: Pair, value: Word) -> Diagnostic:
    """An attribute that no version has, with the one that does what it says."""
    key, is_negated = pair.key.text, _WISHED[pair.key.text.casefold()]
    script = f"!({value.text})" if is_negated else value.text
    changes = [FixEdit(Place(pair.key.span), "_skipIf")]
    inner = Span(value.start + 1, value.end - 1)
    if is_negated and not value.quoted:
        changes.append(FixEdit(Place(value.span), written(script)))
    elif is_negated and _REFERRED.search(value.text[1:-1]):  # XML spells it in pieces: change the first and the last
        changes.append(FixEdit(Place(Span(inner.start, inner.start + 1)), f"!({value.text[0]}"))
        changes.append(FixEdit(Place(Span(inner.end - 1, inner.end)), f"{value.text[-1]})"))
    elif is_negated:
        changes.append(FixEdit(Place(inner), script))
    fix = Fix(f'Write `_skipIf="{script}"`', tuple(changes))
    message = f"no version of the engine has `{key}`, and it ignores it silently; did you mean `_skipIf`?"
    return Diagnostic("unknown-attribute", pair.key.span, message, notes=(f'write `_skipIf="{script}"`',), fixes=(fix,))


def _without_underscore(resolved: ResolvedNode, key: Word, meant: str) -> Iterator[Diagnostic]:
    """`skipIf` on a node whose ports are unknown; elsewhere it is an unknown port."""
    if key.text.islower() and "_" not in key.text and not resolved.is_subtree:
        return  # `while` and `post` may be ports
    message = f"the engine takes `{key.text}` for a port; did you mean `{meant}`?"
    fix = replace_fix(f"Replace `{key.text}` with `{meant}`", key.span, meant)
    yield Diagnostic("unknown-attribute", key.span, message, fixes=(fix,))


def duplicate_attribute(view: View) -> Iterator[Diagnostic]:
    """Two values for one attribute: the first counts."""
    for pairs, before_brackets in _attribute_lists(view):
        keys = {pair.key.text for pair in pairs}
        if len(keys) == len(pairs) and keys.isdisjoint(before_brackets):
            continue
        first: dict[str, Word | Pair] = {key: word for key, word in before_brackets.items() if word is not None}
        for pair in pairs:
            key = pair.key.text
            if key in first:
                related = (Related(Place(first[key].span), "first value, which takes effect"),)
                yield Diagnostic("duplicate-attribute", pair.key.span, f"duplicate value for `{key}`", related=related)
            first.setdefault(key, pair)


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


def first_port(view: View, resolved: ResolvedNode) -> PortKind | None:
    """The likely port of a value without a name: the first that needs a value, or else the first."""
    ports = _ports(view, resolved)
    return next(iter((*ports.required, *ports.all)), None) if ports is not None else None


def is_case(resolved: ResolvedNode, key: str) -> bool:
    """Whether an attribute is a case of a Switch; which ones exist depends on the number of its children."""
    return resolved.flow == "switch" and key.startswith("case_") and key[5:].isdecimal()


class KnownPorts:
    """The ports of a node: their names and those that need a value."""

    __slots__ = ("all", "names", "required")

    def __init__(self, ports: tuple[PortKind, ...]) -> None:
        self.all = ports
        self.names = frozenset([port.name for port in ports])
        self.required = tuple([port for port in ports if port.required])

    def named(self, name: str) -> PortKind | None:
        return next((port for port in self.all if port.name == name), None)


def _ports(view: View, resolved: ResolvedNode) -> KnownPorts | None:
    """The ports of a node; None if unknown."""
    if resolved.is_placeholder or (resolved.is_subtree and not PORTS_OF_SUBTREE.holds(view.target)):
        return None
    if resolved.is_subtree:
        # The engine reads `default = ""` as none, requires outputs too, and adds up the models of a tree.
        name = resolved.id
        others = view.ask(lookups.ports_of_models, Kind.MODEL, name.text) if name is not None else ()
        declared = {port.id.text: port for port in chain(ports_beside(view, resolved), *others) if port.id is not None}
        ports = [replace(port, required=not port.default) for port in map(as_kind, declared.values())]
        return KnownPorts(tuple(ports)) if ports else None
    if resolved.kind is not None:
        return _builtin_ports(resolved.kind.tag, is_before_4(view.target))
    model_ports = view.ask(_model_ports, resolved.id.text) if resolved.is_defined and resolved.id is not None else None
    if model_ports is None or not (throws := _throwing(resolved)):
        return model_ports
    return KnownPorts(tuple([replace(port, required=port.required or port.name in throws) for port in model_ports.all]))


def _throwing(resolved: ResolvedNode) -> tuple[str, ...]:
    """The ports without which a node of Nav2 throws."""
    behavior = resolved.behavior if resolved.kind is None else None
    return tuple([port.name for port in behavior.ports if port.required]) if behavior is not None else ()


def _may_have_more(view: View, resolved: ResolvedNode) -> bool:
    """Whether a port may be declared on a line that could not be read."""
    name = resolved.id
    if name is None or not (resolved.is_subtree or resolved.is_defined):
        return False
    kinds = (Kind.TREE, Kind.MODEL) if resolved.is_subtree else (Kind.MODEL,)
    return any(view.ask(lookups.is_torn, kind, name.text) for kind in kinds)


def _model_ports(store: Store[Workspace], viewpoint: str, name: str) -> KnownPorts | None:
    """The ports of a node with a model.  Of several models a port of any counts, and is required if all require it."""
    models = [[*map(as_kind, ports)] for ports in store.ask(lookups.ports_of_models, viewpoint, Kind.MODEL, name)]
    needed = [{port.name for port in ports if port.required} for ports in models]
    first: dict[str, PortKind] = {}
    for port in chain(*models):
        first.setdefault(port.name, port)
    ports = [replace(port, required=all(port.name in names for names in needed)) for port in first.values()]
    return KnownPorts(tuple(ports))


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


@cache
def _builtin_ports(tag: str, has_old_names: bool) -> KnownPorts:
    old = {today: name for (owner, name), today in OLD_PORTS.items() if owner == tag and has_old_names}
    named = [replace(port, name=old.get(port.name, port.name)) for port in BUILTINS[tag].ports]
    return KnownPorts(tuple([replace(port, doc=f"{port.doc[0].lower()}{port.doc[1:]}") for port in named]))


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
        if key in names or key in _OWN or not is_port_name(key) or is_case(resolved, key):
            continue
        if resolved.is_subtree and resolved.id is not None and _is_used_in(view, resolved.id.text, key):
            continue  # the tree gets the entry, whatever its model declares
        old = OLD_PORTS.get((resolved.kind.tag, key)) if resolved.kind else None
        old = old or (_ATTRIBUTES.get(_plain(key)) if UNDERSCORES.holds(view.target) else None)
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


def _plain(key: str) -> str:
    return key.replace("_", "").casefold()


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


def _remaps_all(resolved: ResolvedNode) -> bool:
    """Whether a SubTree gets every entry under its own name, or has an attribute of version 3 that means it."""
    values = [resolved.node.attribute(key) for key in ("_autoremap", *_OF_TODAY)]
    return any(value is not None and not _is_off(value) for value in values)


def _is_off(value: Word | None) -> bool:
    return value is not None and value.text in ("false", "False", "FALSE", "0")


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


def _attribute_lists(view: View) -> Iterator[tuple[tuple[Pair, ...], dict[str, Word | None]]]:
    """Every list of attributes in an item, with the attributes that are written before the brackets."""
    item = view.item
    if isinstance(item, Tree):
        yield item.attributes, {"ID": item.name}
        for port in item.ports:
            if port.attributes:
                yield port.attributes, _before_brackets(port)
        for resolved in view.seen.given:
            node = resolved.node
            if len(node.attributes) > 1 or node.label is not None or node.category is not None:
                yield node.attributes, {"name": node.label, "ID": node.kind if node.category else None}
    elif isinstance(item, Include):
        yield item.attributes, {"path": item.path}
    elif isinstance(item, Root):
        yield item.attributes, {"main_tree_to_execute": item.name}
    for model in models_in(item):
        if model.attributes:
            yield model.attributes, {"ID": model.name}
        for part in model.body:
            if isinstance(part, Port) and part.attributes:
                yield part.attributes, _before_brackets(part)
            elif isinstance(part, Meta):
                yield part.attributes, {}


def _before_brackets(port: Port) -> dict[str, Word | None]:
    return {"name": port.name, "type": port.type, "default": port.default}


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

# Version 3's attributes of a SubTree, and their successors.
_OF_TODAY = {"__shared_blackboard": "_autoremap", "__autoremap": "_autoremap"}
_KEPT = frozenset(RESERVED_ATTRIBUTES) - frozenset(_OF_TODAY)
# The attributes that the engine reads, as one writes them who forgets the `_`.
_ATTRIBUTES = {_plain(name): name for name in _KEPT if RESERVED_ATTRIBUTES[name].group != "tool"}
_WORDS_IN_KEY = re.compile(r"[A-Z]?[a-z]+")
