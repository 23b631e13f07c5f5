"""Values that the engine refuses or reads as something else, values of an unknown unit, and numbers that a SubTree
passes to text ports."""

from __future__ import annotations

import re
from collections.abc import Iterator
from math import isfinite

from btq_lang.catalog.kinds import RESULT
from btq_lang.catalog.literals import OLD_ENTRY, check_literal, is_pointer
from btq_lang.catalog.names import is_port_name
from btq_lang.catalog.nodes import BUILTINS
from btq_lang.catalog.units import a_dimension, convert, parse_unit
from btq_lang.catalog.versions import ENTRY_WITHOUT_DOLLAR, TYPED_CONSTANTS
from btq_lang.checks import lookups
from btq_lang.checks.meant_entries import entry_in, entry_of
from btq_lang.checks.nav2_literals import share_meant
from btq_lang.checks.view import View, port_of
from btq_lang.diagnostics.model import Diagnostic, Fix, Place, Related, replace_fix
from btq_lang.diagnostics.rules import Severity
from btq_lang.syntax.quantities import parse_quantity
from btq_lang.syntax.tokens import BRACED, QUANTITY
from btq_lang.syntax.tree import Pair, Port, Tree, Word, quote, written
from btq_lang.util.record import Record
from btq_lang.util.spelling import did_you_mean
from btq_lang.workspace.port_types import is_number
from btq_lang.workspace.resolved import ResolvedNode

_NUMBER = re.compile(r"-?[0-9]+(\.[0-9]+)?([eE][+-]?[0-9]+)?")
_WHOLE = re.compile(r"(?:-?[0-9]+(?:\.0*)?\s*(?:;|$))+")  # integers that are written as reals, too
_JSON = re.compile(r"[\"'\[\],]|:\s|^{")  # no name of an entry has any of that
_FRACTION = re.compile(r"[0-9]*\.[0-9]*[1-9][0-9]*")
_DECIMAL_COMMA = re.compile(r"-?[0-9]+,[0-9]+")
_ENDLESS = frozenset(
    (
        "inf",
        "+inf",
        "infinity",
        "infinite",
        "infinitely",
        "forever",
        "always",
        "endless",
        "endlessly",
        "unlimited",
        "∞",
        "*",
    )
)
_INTEGERS = ("int", "unsigned int", "int64_t", "uint64_t")


class _Target(Record):
    """What a value is assigned to.

    Attributes:
        unit: of a number in the port, if known.
        converts: whether the engine reads a literal as the type; for a tree's port it keeps the text or number.
        is_output: whether it is an output; another rule reports every literal for one.
        is_count: whether it says how often a child runs, and -1 means endless.
        is_number_of_children: whether it says how many of them must succeed or fail.
        doc: the port's description.
    """

    port: str
    type: str
    unit: str | None = None
    converts: bool = True
    is_output: bool = False
    is_count: bool = False
    is_number_of_children: bool = False
    doc: str = ""


def old_entry(view: View) -> Iterator[Diagnostic]:
    """`${key}`, an entry of the blackboard to version 3 of the engine, and a text to version 4."""
    if not ENTRY_WITHOUT_DOLLAR.holds(view.target):
        return
    begun = [(pair.key, value) for _, pair, value in view.seen.values() if "${" in value.raw[:3]]
    values = [value for key, value in begun if OLD_ENTRY.fullmatch(value.text) and is_port_name(key.text)]
    typed = {value.span: target for target, value in _values(view)} if values else {}
    for value in values:
        key, target = value.text[1:], typed.get(value.span)
        refused = target is not None and check_literal(target.type, value.text, view.target) is not None
        message = f"the engine reads `{value.text}` as a text, not as an entry"
        fixes = (replace_fix(f"Replace `{value.text}` with `{key}`", value.span, key),)
        notes = ("version 3 of the engine read it as an entry",)
        severity = Severity.ERROR if refused else None
        yield Diagnostic("old-entry", value.span, message, notes=notes, fixes=fixes, severity=severity)


def json_in_braces(view: View) -> Iterator[Diagnostic]:
    """A text in braces that cannot be the name of an entry."""
    for _, pair, value in view.seen.values():
        if not is_pointer(value.text) or not _JSON.search(value.text[1:-1]) or not is_port_name(pair.key.text):
            continue
        if entry_in(view, value) is not None:
            continue  # which meant_entry reports
        message = f"the engine reads `{value.text}` as an entry of that name, not as a value"
        notes = (
            "a port whose type reads JSON takes `json:{…}`",
            f"for a text let a script set an entry before, `{pair.key.text} := '…'`, and pass `{{{pair.key.text}}}`",
        )
        yield Diagnostic("json-in-braces", value.span, message, notes=notes)


def invalid_literal(view: View) -> Iterator[Diagnostic]:
    """A literal that the port's type refuses, or whose end the engine drops; a quantity whose unit does not fit."""
    version = view.target
    for target, value in _values(view):
        if target.is_output:
            continue
        if value.kind == QUANTITY:
            yield from _quantity(target, value, version)
            continue
        text = value.text
        if OLD_ENTRY.fullmatch(text):
            continue  # which old_entry reports
        if target.port == "_autoremap" and is_pointer(text):
            note = "the engine reads this attribute before any entry exists: write `true`, or remove it"
            yield Diagnostic(
                "invalid-literal", value.span, f"expected true or false for `_autoremap`, found `{text}`", notes=(note,)
            )
            continue
        problem = check_literal(target.type, text, version)
        if problem is None:
            continue
        notes: tuple[str, ...] = (f"`{target.port}` has the type {target.type}",)
        if target.type == RESULT:
            notes = (f"`{target.port}` is a BT::NodeStatus, and IDLE is not allowed",)
        if target.converts and problem.kind != "refused":
            message = f"the engine reads `{text}` as {problem.reads} and silently drops the rest"
            fixes = _as_quantity(value, target, problem.reads, is_xml=view.is_xml)
            in_unit = (f"`{target.port}` is in ms",) if _is_in_seconds(target, text) else ()
            if target.is_number_of_children and text.endswith("%"):
                in_unit = (f"`{target.port}` is a number of children, of which -1 means all",)
                fixes = (replace_fix("Write `-1` for all children", value.span, "-1"),) * (problem.reads == "100")
            elif not target.unit and (quantity := parse_quantity(text.strip())) is not None:
                in_unit = ("write the number in the unit that the node expects",)
                # In SI units, which ROS has everywhere: another number would be another value.
                if (quantity[1].factor, quantity[1].offset) == (1.0, 0.0) and problem.reads is not None:
                    fixes = (replace_fix(f"Write what the engine reads: `{problem.reads}`", value.span, problem.reads),)
            severity = Severity.HINT if _WHOLE.fullmatch(text) else None
            yield Diagnostic(
                "trailing-text-in-number", value.span, message, notes=in_unit, fixes=fixes, severity=severity
            )
            continue
        message = f"expected {problem.expected} for `{target.port}`, found {problem.found or _shown(text)}"
        fixes, severity = (_accepted(target, value, version), None) if target.converts else ((), Severity.WARNING)
        if target.is_count and text.casefold() in _ENDLESS:
            message += "; endless is `-1`"
            fixes = (replace_fix("Write `-1` for endless", value.span, "-1"),)
        elif not fixes and _is_in_seconds(target, text):  # `.5`, the only fraction that is refused
            notes += (f"`{target.port}` is in ms",)
            fixes = _as_quantity(value, target, None, is_xml=view.is_xml)
        elif not fixes and (entry := entry_of(view, value)) is not None:
            message += did_you_mean((entry,))
            fixes = (replace_fix(f"Replace `{text}` with `{entry}`", value.span, entry),)
        yield Diagnostic("invalid-literal", value.span, message, notes=notes, fixes=fixes, severity=severity)


def number_for_text(view: View) -> Iterator[Diagnostic]:
    """A number where a node below expects a text: a SubTree passes it to a port, or it is a port's default."""
    if not TYPED_CONSTANTS.holds(view.target):
        return
    for resolved in view.seen.subtrees:
        if resolved.id is None:
            continue
        for pair in resolved.node.attributes:
            text_port = _text_below(view, resolved.id, pair.key, pair.value)
            if text_port is not None and pair.value is not None:
                yield _number_for_text(pair.value, text_port, None)
    for tree, port in _ports_of_trees(view):
        text_port = _text_below(view, tree, port.name, port.default)
        if text_port is not None and port.default is not None:
            # Only if a SubTree passes nothing else to the port.
            yield _number_for_text(port.default, text_port, Severity.WARNING)


def _quantity(target: _Target, value: Word, version: str) -> Iterator[Diagnostic]:
    """A quantity where the port's unit is unknown or of another dimension, or the number in that unit does not fit."""
    quantity = parse_quantity(value.raw)
    if quantity is None:
        return  # an unknown unit, which is reported
    port_unit = parse_unit(target.unit) if target.unit is not None else None
    if port_unit is None:
        stated = parse_unit(target.doc) if target.doc else None
        if stated is not None and stated.dimension == quantity[1].dimension:
            in_unit = f"{convert(quantity[0], quantity[1], stated):.10g}"
            yield Diagnostic(
                "quantity-on-unitless-port",
                value.span,
                f"unknown unit of the port `{target.port}`",
                notes=(f"its description is `{target.doc}`: write the number in that unit, `{in_unit}`",),
                fixes=(replace_fix(f"Write `{in_unit}`", value.span, in_unit),),
            )
            return
        as_text = check_literal(target.type, value.raw, version) is None
        # No fix: without its unit the number may mean something else, and not every node reads the text.
        yield Diagnostic(
            "quantity-on-unitless-port",
            value.span,
            f"unknown unit of the port `{target.port}`",
            notes=(
                "write the number in the unit that the node expects, and state that unit in the port's description",
                *([f"if the node reads the unit itself, use quotes: `{quote(value.raw)}`"] * as_text),
            ),
        )
        return
    unit = quantity[1]
    if unit.dimension != port_unit.dimension:
        message = f"expected {a_dimension(port_unit)} for `{target.port}`, found `{value.raw}` ({a_dimension(unit)})"
        fixes: tuple[Fix, ...] = ()
        if unit.symbol == "m" and port_unit.symbol in ("ms", "s"):
            minutes = f"{_plain(quantity[0])} min"
            message += f"; did you mean `{minutes}`?"
            fixes = (replace_fix(f"Replace `{value.raw}` with `{minutes}`", value.span, minutes),)
        yield Diagnostic("quantity-on-unitless-port", value.span, message, fixes=fixes)
        return
    number = convert(quantity[0], unit, port_unit)
    notes = (f"`{target.port}` has the type {target.type} and the unit {target.unit}",)
    if not isfinite(number):
        message = f"`{value.raw}` exceeds the range of numbers"
    elif target.type in _INTEGERS and not _is_whole(number):
        message = f"expected a whole number of {target.unit} for `{target.port}`, found `{value.raw}`"
    elif problem := check_literal(target.type, _plain(number), version):
        message = (
            f"expected {problem.expected} for `{target.port}`, found `{value.raw}` ({_plain(number)} {target.unit})"
        )
    else:
        return
    yield Diagnostic("invalid-literal", value.span, message, notes=notes)


def _values(view: View) -> Iterator[tuple[_Target, Word]]:
    """Each literal that is assigned to a port with a type or a unit, with that target."""
    for port in [port for owner in view.owners for port in owner.ports]:
        value = port.default
        if value is not None and value.kind != BRACED and value.text and port.name is not None:
            yield _Target(port.name.text, port.type.text if port.type else "", converts=False), value
    for resolved, pair, value in view.seen.values():
        if resolved.is_placeholder or (value.kind == BRACED and pair.key.text != "_autoremap"):
            continue
        if share_meant(view, resolved, pair, value) is not None:
            continue  # which percentage_for_share reports
        if (target := _target(view, resolved, pair, value)) is not None:
            yield target, value


def _target(view: View, resolved: ResolvedNode, pair: Pair, value: Word) -> _Target | None:
    key = pair.key.text
    is_declared = key != "_autoremap" or not resolved.is_subtree
    port = port_of(view, resolved, key) if is_declared else BUILTINS["SubTree"].port(key)
    if port is None:
        # A node without a model takes any literal, but there is no unit that a quantity could be converted to.
        is_free = value.kind == QUANTITY and resolved.kind is None and is_port_name(key)
        return _Target(key, "") if is_free else None
    if port.content != "value":
        return None
    converts = not (resolved.is_subtree and is_declared)
    is_count = (
        resolved.kind is not None and resolved.kind.port_for("count") is port and resolved.flow in ("repeat", "retry")
    )
    is_number_of_children = port.role in ("successes", "failures")
    type_, is_output = port.literal or port.type, port.direction == "output"
    return _Target(key, type_, port.unit, converts, is_output, is_count, is_number_of_children, port.doc)


def _accepted(target: _Target, value: Word, version: str) -> tuple[Fix, ...]:
    """Fixes that satisfy the engine's strictness: `success`, `+5`, ` 5`."""
    text = value.text
    for other in (text.strip(), text.strip().removeprefix("+"), text.upper(), text.lower()):
        if other and check_literal(target.type, other, version) is None:
            return (replace_fix(f"Write `{other}`", value.span, _as_value(other)),)
    return ()


def _as_quantity(value: Word, target: _Target, reads: str | None, *, is_xml: bool) -> tuple[Fix, ...]:
    """`"30 sec"` on a port in ms was meant as 30 s, `0.5` as 0.5 s, and `0,5` as 0.5 on a port for reals; of
    `"5 apples"` only the number counts, but a number without its unit means something else."""
    if _DECIMAL_COMMA.fullmatch(value.text):
        meant = value.text.replace(",", ".")
        takes = check_literal(target.type, meant) is None
        return (replace_fix(f"Write `{meant}`", value.span, meant),) if takes else ()
    fixes = []
    is_in_seconds = _is_in_seconds(target, value.text)
    quantity = parse_quantity(f"{float(value.text)} s" if is_in_seconds else value.text.strip())
    port_unit = parse_unit(target.unit) if target.unit else None
    if quantity is not None and port_unit is not None and quantity[1].dimension == port_unit.dimension:
        quantity_text = f"{_plain(quantity[0])} {quantity[2]}" if isfinite(quantity[0]) else value.text
        if is_xml:  # which has numbers alone
            number = _plain(convert(quantity[0], quantity[1], port_unit))
            fixes.append(replace_fix(f"Write `{number}`, which is {quantity_text}", value.span, number))
        else:
            fixes.append(replace_fix(f"Write the quantity `{quantity_text}`", value.span, quantity_text))
    if reads is not None and not (is_in_seconds and reads == "0") and (quantity is None or is_in_seconds):
        fixes.append(replace_fix(f"Write what the engine reads: `{reads}`", value.span, _as_value(reads)))
    return tuple(fixes)


def _is_in_seconds(target: _Target, text: str) -> bool:
    """Whether a time in ms is probably written in seconds."""
    return target.unit == "ms" and _FRACTION.fullmatch(text) is not None


def _as_value(text: str) -> str:
    return text if _NUMBER.fullmatch(text) else written(text)


def _shown(text: str) -> str:
    return f"`{text}`" if text else "an empty string"


def _plain(number: float) -> str:
    return str(int(number)) if number == int(number) else repr(number)


def _is_whole(value: float) -> bool:
    return abs(value - round(value)) < 1e-9 * max(1.0, abs(value))


def _text_below(view: View, tree: Word, port: Word | None, value: Word | None) -> tuple[Place, str, str] | None:
    """The text port that receives a number: its place, its name, its node."""
    if value is None or port is None or value.kind == QUANTITY or not is_number(value.text):
        return None
    if not is_port_name(port.text):
        return None
    return view.ask(lookups.text_below, tree.text, port.text, view.target)


def _number_for_text(value: Word, text_port: tuple[Place, str, str], severity: Severity | None) -> Diagnostic:
    place, name, node = text_port
    port = f"`{name}` of `{node}`"
    message = (
        f"BehaviorTree.CPP {TYPED_CONSTANTS.since} and later refuse to load this tree: `{value.text}` is a number, "
        f"{port} a string"
    )
    notes = (f"pass an entry that holds the string: `Script (code = \"text := '{value.text}'\")`, then `{{text}}`",)
    related = (Related(place, "the string port"),)
    return Diagnostic("number-for-text", value.span, message, related=related, notes=notes, severity=severity)


def _ports_of_trees(view: View) -> Iterator[tuple[Word, Port]]:
    for owner in view.owners:
        if owner.name is not None and (isinstance(owner, Tree) or owner.category.raw == "SubTree"):
            yield from ((owner.name, port) for port in owner.ports)
