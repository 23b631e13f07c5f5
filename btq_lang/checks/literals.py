"""Values that the engine refuses, reads as something else, or that have a unit where none is known."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.catalog.literals import check_literal
from btq_lang.catalog.nodes import PortKind, port_type
from btq_lang.checks.ports import is_placeholder
from btq_lang.checks.view import SeenNode, View, subtree_ports
from btq_lang.diagnostics import Diagnostic, Fix, replace_fix
from btq_lang.quantities import parse_quantity
from btq_lang.record import record
from btq_lang.syntax import Entry, Pair, Port, Word
from btq_lang.tokens import BRACED, QUANTITY
from btq_lang.units import convert, dimension_name, parse_unit

_INTEGERS = ("int", "unsigned int", "int64_t", "uint64_t")


@record
class _Target:
    """What a value goes to: a port's type, and its unit where one is known."""

    port: str
    type: str
    unit: str | None


def invalid_literal(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A literal that the port's type refuses, or whose tail the engine drops."""
    for target, value in _values(view, entry):
        if value.kind == BRACED or value.kind == QUANTITY:
            continue
        text = value.text
        problem = check_literal(target.type, text, view.workspace.project.target)
        if problem is None:
            continue
        if problem.kind == "refused":
            message = f"`{text}` {problem.reason}"
            notes = (f"the port `{target.port}` is of type {target.type}",)
            yield Diagnostic("invalid-literal", value.span, message, notes=notes)
        else:
            message = f"the engine reads `{text}` as {problem.reads} and drops the rest without a word"
            yield Diagnostic(
                "trailing-text-in-number", value.span, message, fixes=_as_quantity(value, target, problem.reads)
            )


def quantity_on_unitless_port(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A quantity where the port's unit is unknown, of another dimension, or where the result is no whole number."""
    for target, value in _values(view, entry):
        if value.kind != QUANTITY:
            continue
        quantity = parse_quantity(value.raw)
        if quantity is None:
            continue  # an unknown unit, which is told
        number, unit, _ = quantity
        if target.unit is None:
            yield Diagnostic(
                "quantity-on-unitless-port",
                value.span,
                f"nobody knows the unit of the port `{target.port}`",
                notes=("write the number that the node expects, and say its unit in the port's description",),
                fixes=(replace_fix(f"Write `{_plain(number)}`", value.span, _plain(number)),),
            )
            continue
        wanted = parse_unit(target.unit)
        assert wanted is not None, "the catalog's units are in the unit table"
        if unit.dimension != wanted.dimension:
            message = f"`{target.port}` takes {dimension_name(wanted)}, `{value.raw}` is {dimension_name(unit)}"
            yield Diagnostic("quantity-on-unitless-port", value.span, message)
        elif target.type in _INTEGERS and not _is_whole(convert(number, unit, wanted)):
            message = f"`{value.raw}` is no whole number of {target.unit}, and `{target.port}` is of type {target.type}"
            yield Diagnostic("invalid-literal", value.span, message)


def _values(view: View, entry: Entry) -> Iterator[tuple[_Target, Word]]:
    """Each value that goes to a port of known type, with what it goes to."""
    for seen in view.nodes(entry):
        if is_placeholder(seen):
            continue
        for pair in seen.node.attributes:
            if pair.value is not None and (target := _target(view, seen, pair)) is not None:
                yield target, pair.value


def _target(view: View, seen: SeenNode, pair: Pair) -> _Target | None:
    key = pair.key.text
    if seen.kind is not None:
        port = seen.kind.port(key)
        return _of_builtin(port, view.workspace.project.target) if port is not None else None
    ports = subtree_ports(view, seen) if seen.is_subtree else seen.model.ports if seen.model else ()
    declared = next((port for port in ports if port.name is not None and port.name.text == key), None)
    return _of_model(declared) if declared is not None else None


def _of_builtin(port: PortKind, version: str) -> _Target | None:
    if port.content != "value":
        return None
    return _Target(port.name, port.literal or port_type(port, version), port.unit)


def _of_model(port: Port) -> _Target | None:
    if port.name is None:
        return None
    return _Target(port.name.text, port.type.text if port.type else "", None)


def _as_quantity(value: Word, target: _Target, reads: str | None) -> tuple[Fix, ...]:
    """`"30 sec"` on a port in ms was meant as 30 s; `"5 apples"` as nothing we know but the number."""
    fixes = []
    quantity = parse_quantity(value.text.strip())
    wanted = parse_unit(target.unit) if target.unit else None
    if quantity is not None and wanted is not None and quantity[1].dimension == wanted.dimension:
        written = f"{_plain(quantity[0])} {quantity[2]}"
        fixes.append(replace_fix(f"Write the quantity `{written}`", value.span, written))
    if reads is not None:
        fixes.append(replace_fix(f"Write what the engine reads: `{reads}`", value.span, reads, safe=not fixes))
    return tuple(fixes)


def _plain(number: float) -> str:
    return str(int(number)) if number == int(number) else repr(number)


def _is_whole(value: float) -> bool:
    return abs(value - round(value)) < 1e-9 * max(1.0, abs(value))
