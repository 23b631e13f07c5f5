"""Which ports the code of a class reads and writes, and what it does if one is not given.

One invariant: a port is called unread only if all code of the class and of its bases is in the sources, its name is
nowhere in it or in the functions that it calls, and no other code reads a port of that name, and what the code does
without a port is said only where the place of the read shows it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import TYPE_CHECKING, Final

from btq_lang.catalog.cpp_classes import ENGINE
from btq_lang.cpp.grammar import LAMBDAS, arguments, callee, contents, enclosing, field, literal, text_of, walk
from btq_lang.cpp.model import CppPort, PortUse
from btq_lang.cpp.source import ACCESSES, Function
from btq_lang.cpp.sources import BoundClass, CppSources
from btq_lang.cpp.values import Frame, string

if TYPE_CHECKING:
    from tree_sitter import Node


_OWN: Final = frozenset(("this",))
_OF_BASE: Final = frozenset(("this", ""))  # in a method that a derived class overrides: it may never be called


class Uses:
    """The reads and writes of ports in some code.

    Attributes:
        all: reads and writes whose port can be seen, in order.
        complete: whether all code is in the sources, and the names of all ports in it can be seen.
    """

    def __init__(self, sources: CppSources) -> None:
        self.all: Final[list[PortUse]] = []
        self.complete = True
        self._sources: Final = sources
        self._strings: Final[set[str]] = set()
        self._identifiers: Final[set[str]] = set()
        self._followed: Final[set[tuple[Node, frozenset[str]]]] = set()

    @classmethod
    def of_class(cls, sources: CppSources, bound: BoundClass) -> Uses:
        """The uses in the methods of a class and of its bases."""
        uses = cls(sources)
        overriding: set[str] = set()
        for ancestor in sources.ancestry(bound):
            if ancestor.class_ is None:
                uses.complete = uses.complete and ancestor.name.rpartition("::")[2] in ENGINE
                continue
            bodies = sources.all_methods(ancestor.class_)
            uses.complete = uses.complete and ancestor.class_.promised <= {name for name, *_ in bodies}
            for name, node, path in bodies:
                if not _PROVIDES(name):
                    names = _OF_BASE if name in overriding else _OWN
                    uses._read(node, Frame(ancestor, ancestor.scope, path), names)
            overriding |= {name for name, *_ in bodies}
        return uses

    @classmethod
    def of_function(cls, sources: CppSources, argument: Node, frame: Frame) -> Uses:
        """The uses in the function of a node: a lambda, or the name of one or of a function."""
        uses = cls(sources)
        function = _function(sources, argument, frame)
        uses.complete = function is not None and not _is_handed_on(function[0])
        if function is not None:
            uses._read(*function)
        return uses

    def unread(self, ports: Iterable[CppPort]) -> tuple[CppPort, ...]:
        """The ports that the code never names."""
        if not self.complete:
            return ()
        named = self._strings | self._sources.accessed | self._sources.strings_of(self._identifiers)
        return tuple(port for port in ports if port.name not in named)

    def undeclared(self, ports: Iterable[CppPort]) -> tuple[PortUse, ...]:
        """Uses of ports that are not among some."""
        names = {port.name for port in ports}
        return tuple(use for use in self.all if use.port not in names and not use.falls_back)

    def without_each(self, ports: Iterable[CppPort]) -> tuple[tuple[str, str], ...]:
        """The effect of each input for which there is no value: see `PortUse.without`."""
        inputs = (port for port in ports if port.direction != "output")
        return tuple((port.name, self._without(port)) for port in inputs)

    def _without(self, port: CppPort) -> str:
        effects = {use.without for use in self.all if use.port == port.name and not use.writes}
        if "fails" in effects:
            return "fails"
        return next((each for each in ("", _IGNORES, "goes on") if each in effects), "")

    def _read(self, body: Node, frame: Frame, names: frozenset[str] = _OWN) -> None:
        """Read some code; names: those that the object with the ports has in it."""
        for node in walk(body):
            if node.type in ("string_literal", "raw_string_literal"):
                self._strings.add(literal(node) or "")
            elif node.type in ("identifier", "field_identifier"):
                self._identifiers.add(text_of(node))
            elif node.type == "call_expression":
                self._access(node, frame, names is _OWN)
                self._follow(node, frame, names)
            if node.type in ("identifier", "this") and text_of(node) in names and self._escapes(node, frame):
                self.complete = False

    def _access(self, call: Node, frame: Frame, is_own: bool) -> None:
        """Take a read or a write of a port; is_own: by the class or the function itself."""
        name, passed = callee(call)[1], arguments(call)
        if name in ACCESSES and passed:
            port = string(self._sources, passed[0], frame)
            if port is None:  # the name of a parameter is in a string of the code that calls this
                self.complete = self.complete and _is_parameter(passed[0])
            elif is_own:
                writes = name == "setOutput"
                without = "" if writes else _without(call)
                self.all.append(PortUse(port, writes, without, self._sources.place_of(frame.path, call)))
        elif is_own and _FALLS_BACK(name):
            for port in filter(None, map(literal, passed)):
                self.all.append(
                    PortUse(port, False, "goes on", self._sources.place_of(frame.path, call), falls_back=True)
                )

    def _follow(self, call: Node, frame: Frame, names: frozenset[str]) -> None:
        """Read the functions outside of classes that a call may mean, which have the object as some parameters."""
        passed = [_is_object(argument, names) for argument in arguments(call)]
        for function in self._functions(call, frame):
            parameters = map(text_of, _parameters(function.node))
            inner = frozenset(name for name, is_object in zip(parameters, passed, strict=False) if is_object)
            if (function.node, inner) not in self._followed:
                self._followed.add((function.node, inner))
                self._read(function.node, Frame(None, function.scope, function.path), inner)

    def _functions(self, call: Node, frame: Frame) -> list[Function]:
        """The functions that a call may mean, but for methods of objects."""
        scope, name, _ = callee(call)
        called = field(call, "function")
        if called is None or called.type == "field_expression":
            return []
        whole = f"{scope}::{name}" if scope else name
        functions = self._sources.functions(whole, frame.scope, frame.path)
        return [function for function in functions if scope or "::" not in function.name]

    def _escapes(self, name: Node, frame: Frame) -> bool:
        """Whether code that is not in the sources may get the object that has a name."""
        node = name
        while (around := node.parent) is not None and around.type in ("pointer_expression", "parenthesized_expression"):
            node = around
        if around is None or around.type in _HARMLESS:
            return False
        call = around.parent if around.type == "argument_list" else None
        if call is None or call.type != "call_expression":
            return True
        return callee(call)[1] != "bind" and not self._functions(call, frame)


def _function(sources: CppSources, argument: Node, frame: Frame) -> tuple[Node, Frame] | None:
    """The function that an argument is, with the frame of its body; None if it cannot be seen."""
    if argument.type == "lambda_expression":
        return argument, frame
    if argument.type not in ("identifier", "qualified_identifier"):
        return None
    around = enclosing(argument, ("function_definition",))
    for node in walk(around) if around is not None else ():
        if node.type == "init_declarator" and text_of(field(node, "declarator")) == text_of(argument):
            value = field(node, "value")
            return (value, frame) if value is not None and value.type == "lambda_expression" else None
    function = sources.function(text_of(argument), frame.scope, frame.path, sources.place_of(frame.path, argument))
    return None if function is None else (function.node, Frame(None, function.scope, function.path))


def _parameters(function: Node) -> list[Node | None]:
    """The name of each parameter of a function; None for one without a name."""
    listed = next((node for node in walk(function) if node.type == "parameter_list"), None)
    return [
        next((node for node in reversed([*walk(parameter)]) if node.type == "identifier"), None)
        for parameter in contents(listed)
    ]


def _is_object(argument: Node, names: frozenset[str]) -> bool:
    """Whether an argument is an object with some name, or a pointer to it."""
    while argument.type in ("pointer_expression", "parenthesized_expression"):
        argument = contents(argument)[-1]
    return text_of(argument) in names


def _is_handed_on(function: Node) -> bool:
    """Whether a function passes on its node, so that other code may read ports, too."""
    listed = next((node for node in walk(function) if node.type == "parameter_list"), None)
    parameters = [node for node in contents(listed) if "NodeStatus" not in text_of(node)]  # that of a decorator's child
    names = {text_of(node) for parameter in parameters for node in walk(parameter) if node.type == "identifier"}
    body = field(function, "body")
    return any(
        node.type == "identifier"
        and text_of(node) in names
        and node.parent is not None
        and node.parent.type != "field_expression"
        for node in (walk(body) if body is not None else ())
    )


def _is_parameter(name: Node) -> bool:
    """Whether an expression is a parameter of the function that it is in."""
    function = enclosing(name, ("function_definition", "lambda_expression"))
    declarator = next((each for each in walk(function) if each.type == "parameter_list"), None) if function else None
    return name.type == "identifier" and text_of(name) in map(text_of, walk(declarator) if declarator else ())


def _without(read: Node) -> str:
    """The effect of a read that gets nothing, as the code around it shows."""
    node, negated, within_and = read, False, False
    while (around := node.parent) is not None:
        if around.type == "expression_statement":
            return _IGNORES
        if around.type == "field_expression":
            method = text_of(field(around, "field"))
            if method == "value":
                return "fails"
            if method == "value_or":
                return "goes on"
            around = around.parent
            if method != "has_value" or around is None:
                return ""
        elif around.type == "unary_expression" and text_of(around).startswith("!"):
            negated = not negated
        elif around.type == "binary_expression":
            within_and = within_and or text_of(field(around, "operator")) == "&&"
        elif around.type == "condition_clause":
            return _in_condition(around, negated, within_and)
        elif around.type in ("init_declarator", "assignment_expression", "declaration"):
            return _kept(around)
        elif around.type not in ("parenthesized_expression",):
            return ""
        node = around
    return ""


def _in_condition(condition: Node, negated: bool, within_and: bool) -> str:
    """The effect of the branch that is taken if the read gets nothing."""
    statement = condition.parent
    if statement is None or statement.type != "if_statement":
        return ""
    taken, other = field(statement, "consequence"), field(statement, "alternative")
    if not negated:
        if other is None:
            return "" if taken is None or _leaves(taken) else "goes on"
        taken = other
    if taken is None:
        return ""
    if _fails(taken):
        return "" if within_and else "fails"
    return "" if _leaves(taken) else "goes on"


def _kept(declared: Node) -> str:
    """The effect of a missing result that is kept in a variable."""
    inner = field(declared, "declarator") or field(declared, "left")
    name = text_of(inner)
    if name == "std::ignore":
        return _IGNORES
    condition = enclosing(declared, ("condition_clause", "compound_statement"))
    if condition is not None and condition.type == "condition_clause":  # `if (auto found = getInput(…); !found)`
        value = field(condition, "value")
        value = None if value == declared else value
        return _in_condition(condition, value is not None and text_of(value).startswith("!"), False)
    function = enclosing(declared, ("function_definition", "lambda_expression"))
    for node in walk(function) if function is not None else ():  # the first use shows what is expected
        if node.start_byte >= declared.end_byte and node.type == "identifier" and text_of(node) == name:
            effect = _without(node)
            return "" if effect == _IGNORES else effect
    return _IGNORES


def _fails(branch: Node) -> bool:
    """Whether a branch throws, ends the program, or returns FAILURE, and not only in a case of several."""
    for node in walk(branch, _CASES):
        if node.type == "throw_statement" or (node.type == "call_expression" and callee(node)[1] in _ENDS):
            return True
        if node.type == "return_statement" and text_of(node).rstrip("; ").endswith("NodeStatus::FAILURE"):
            return True
    return False


def _leaves(branch: Node) -> bool:
    return any(each.type in ("return_statement", "throw_statement") for each in walk(branch, LAMBDAS))


_CASES: Final = LAMBDAS | {"if_statement", "switch_statement", "while_statement", "for_statement", "for_range_loop"}
_HARMLESS: Final = ("field_expression", "lambda_capture_specifier", "reference_declarator", "pointer_declarator")
_IGNORES: Final = "ignores"
_PROVIDES: Final = re.compile(r"provided\w*Ports").fullmatch
_FALLS_BACK: Final = re.compile(r"get\w*Or[A-Z]\w*").fullmatch
_ENDS: Final = ("exit", "abort", "terminate")
