"""Models that differ from the C++ that registers their node."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.catalog.name_kinds import Kind
from btq_lang.checks import cpp_lookups, lookups
from btq_lang.checks.clauses import with_blanks
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Place, Related, replace_fix
from btq_lang.diagnostics.rules import Severity
from btq_lang.syntax.tree import Model, Port, written
from btq_lang.util.spelling import did_you_mean, near
from btq_lang.workspace.symbols import may_be_one_type


def stale_model(view: View) -> Iterator[Diagnostic]:
    """A model with another category than in C++, or with a port that the C++ lacks or declares differently."""
    for symbol, other, _ in view.repeated(Kind.MODEL):
        model, of_code = symbol.target, other.symbol.target
        is_cpp = view.store.ask(cpp_lookups.is_cpp, other.path)
        if not (is_cpp and isinstance(model, Model) and isinstance(of_code, Model)):
            continue
        node = f"`{symbol.name}`"
        if model.category.raw != of_code.category.raw:
            is_here, is_there = f"{model.category.raw} in this model", f"{of_code.category.raw} in C++"
            fix = replace_fix(f"Replace it with `{of_code.category.raw}`", model.category.span, of_code.category.raw)
            registered = (Related(other.place, _IN_CPP),)
            message = f"{node} is of category {is_here}, and {is_there}"
            is_harmless = {model.category.raw, of_code.category.raw} == {
                "Action",
                "Condition",
            }  # one leaf to the engine
            severity = Severity.HINT if is_harmless else None
            yield Diagnostic(_RULE, model.category.span, message, registered, fixes=(fix,), severity=severity)
        for port in model.ports:
            if port.id is not None:
                yield from _of_port(view, model, port, other)
    if view.is_xml and view.ask(cpp_lookups.registers_all):
        yield from _unregistered(view)


def _unregistered(view: View) -> Iterator[Diagnostic]:
    """The models of nodes that trees have and no C++ of the factory registers."""
    for symbol in view.facts.summary.symbols:
        is_used = symbol.kind is Kind.MODEL and symbol.name in view.ask(lookups.used, Kind.MODEL)
        is_registered = view.ask(cpp_lookups.is_in_cpp, symbol.name)  # in a way that is not seen
        if is_used and not is_registered and view.ask(cpp_lookups.is_only_in_trees, Kind.MODEL, symbol.name):
            message = (
                f"no C++ of the factory registers `{symbol.name}`: the engine does not read models, and refuses it"
            )
            yield Diagnostic(_RULE, symbol.span, message)


def _of_port(view: View, model: Model, port: Port, other: lookups.Declaration) -> Iterator[Diagnostic]:
    """The differences of a port in a model and in C++."""
    of_code = other.symbol.target
    assert isinstance(of_code, Model), "the caller has looked"
    assert port.id is not None, "the caller has looked"
    ports = {code_port.id.text: code_port for code_port in of_code.ports if code_port.id is not None}
    in_code, name = ports.get(port.id.text), f"`{port.id.text}`"
    if in_code is None:
        if not view.ask(lookups.is_torn, Kind.MODEL, other.symbol.name):
            yield _unknown(view, model, port, other, ports)
        return
    assert in_code.id is not None, "it was looked up by its name"
    related = (Related(Place(in_code.id.span, other.path, other.owner.item), _IN_CPP),)
    direction, code_direction = port.direction, in_code.direction
    if direction.raw != code_direction.raw:
        fix = replace_fix(f"Replace `{direction.raw}` with `{code_direction.raw}`", direction.span, code_direction.raw)
        in_model, in_cpp = _DIRECTIONS[direction.raw], _DIRECTIONS[code_direction.raw]
        message = f"the port {name} is an {in_model} in this model, and an {in_cpp} in C++"
        yield Diagnostic(_RULE, direction.span, message, related, fixes=(fix,))
    if port.type is not None and in_code.type is not None and not may_be_one_type(in_code.type, port.type):
        fix = replace_fix(f"Replace `{port.type.text}` with `{in_code.type.text}`", port.type.span, in_code.type.raw)
        message = f"the type of the port {name} is `{port.type.text}` in this model, and `{in_code.type.text}` in C++"
        yield Diagnostic(_RULE, port.type.span, message, related, fixes=(fix,))


def _unknown(view: View, model: Model, port: Port, other: lookups.Declaration, ports: dict[str, Port]) -> Diagnostic:
    """A port that the C++ does not provide, with the one that may have taken its place."""
    assert port.id is not None, "the caller has looked"
    written_down = {model_port.id.text for model_port in model.ports if model_port.id is not None}
    free = [name for name, code_port in ports.items() if name not in written_down and _is_alike(code_port, port)]
    missing = [
        model_port.id.text
        for model_port in model.ports
        if model_port.id is not None and model_port.id.text not in ports
    ]
    likely = near(port.id.text, free) or (tuple(free) if len(free) == len(missing) == 1 else ())
    fixes = [replace_fix(f"Replace `{port.id.text}` with `{name}`", port.id.span, written(name)) for name in likely]
    fixes.append(replace_fix(f"Remove the port `{port.id.text}`", with_blanks(view.text, port), ""))
    provided = ", ".join(f"`{name}`" for name in ports)
    note = f"it provides {provided}" if provided else "it provides no ports"
    message = f"the C++ of `{other.symbol.name}` has no port `{port.id.text}`{did_you_mean(likely)}"
    related = (Related(other.place, _IN_CPP),)
    return Diagnostic(_RULE, port.id.span, message, related, (note,), tuple(fixes))


def _is_alike(one: Port, other: Port) -> bool:
    return one.direction.raw == other.direction.raw and may_be_one_type(one.type, other.type)


_RULE = "stale-model"
_IN_CPP = "this C++ counts"
_DIRECTIONS = {"input": "input", "output": "output", "inout": "input and output"}
