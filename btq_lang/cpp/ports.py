"""The ports that `providedPorts()` returns: lists in braces, helpers that add to a list, variables that are filled,
base classes.

One invariant: as in a `std::unordered_map`, the first of two entries with one name counts, unless `[]` or
`insert_or_assign` sets it.  What is not understood is reported, and the ports then count as not complete.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final, TypeAlias

from btq_lang.catalog.kinds import Direction
from btq_lang.cpp.grammar import LAMBDAS, arguments, callee, contents, enclosing, field, named, text_of, walk
from btq_lang.cpp.model import CppPort, SourcePosition
from btq_lang.cpp.source import REGISTERS, substituted
from btq_lang.cpp.sources import BoundClass, CppSources
from btq_lang.cpp.values import Frame, default, string, type_of
from btq_lang.util.record import Record, replace

if TYPE_CHECKING:
    from tree_sitter import Node

    Ports: TypeAlias = dict[str, CppPort]


class Provided(Record):
    """The ports of a class, and whether these are all."""

    ports: tuple[CppPort, ...]
    complete: bool


class PortsReader:
    """Evaluates expressions that are lists of ports, as far as that needs no running program."""

    def __init__(self, sources: CppSources) -> None:
        self.sources: Final = sources
        self._complete = True
        aliases = (alias for source in sources.files.values() for alias in source.aliases.items())
        self._aliases: Final = frozenset(name.rpartition("::")[2] for name, type_ in aliases if _is_list(type_))

    def is_list(self, type_: Node | None) -> bool:
        """Whether a type is that of a list of ports, or an alias of it."""
        return _is_list(text_of(type_)) or named(type_)[1] in self._aliases

    def of_class(self, bound: BoundClass, place: SourcePosition) -> Provided:
        """The ports that a class provides; place: where it is used."""
        self._complete = True
        ports = self._of_class(bound, place)
        return Provided(tuple(ports.values()), self._complete)

    def before(self, node: Node, scope: tuple[str, ...], path: str) -> Body:
        """The function around a node, with what its variables are there."""
        body = Body(self, Frame(None, scope, path))
        function = enclosing(node, ("function_definition",))
        for statement in contents(field(function, "body")) if function is not None else ():
            if statement.end_byte > node.start_byte:
                break
            if statement.type == "declaration" or (body.names_list(statement) and not _registers(statement)):
                body.run(statement)
        return body

    def of_argument(self, node: Node, body: Body) -> Provided | None:
        """The ports of an argument; None if it is anything else than a list of ports."""
        self._complete = True
        ports = body.evaluated(node)
        return None if ports is None else Provided(tuple(ports.values()), self._complete)

    def _of_class(self, bound: BoundClass, place: SourcePosition, depth: int = 0) -> Ports:
        for ancestor in self.sources.ancestry(bound):
            if bodies := self.sources.methods(ancestor, "providedPorts"):
                ports: Ports = {}
                for node, path in bodies:  # of branches of `#if`: what any of them provides may be there
                    of_branch = Body(self, Frame(ancestor, ancestor.scope, path, depth)).result(node)
                    ports = {**of_branch, **ports}
                if len(bodies) > 1:
                    message = f"`{ancestor.name}::providedPorts` is here {len(bodies)} times, and one of them counts"
                    self.incomplete(message, self.sources.place_of(*bodies[0][::-1]))
                return ports
            if ancestor.class_ is None:
                if (of_library := self._of_library(ancestor, place)) is not None:
                    if of_library:
                        return of_library
                    continue
                self.incomplete(f"`{ancestor.name}` is not in the sources, and may provide ports", place)
            elif "providedPorts" in ancestor.class_.promised:
                self.incomplete(f"the body of `{ancestor.name}::providedPorts` is not in the sources", place)
                return {}
        return {}

    def _of_library(self, bound: BoundClass, place: SourcePosition) -> Ports | None:
        """The ports of a class of a known library; None for any other."""
        provided = self.sources.library_ports(bound, place)
        if provided is None:
            return None
        ports, others = provided
        if others:
            name = bound.name.rpartition("::")[2]
            what_to_do = 'name the distribution of Nav2 in the project file: `nodes = ["nav2-jazzy", …]`'
            self.incomplete(f"whether `{name}` provides {others} depends on the distribution; {what_to_do}", place)
        return ports

    def incomplete(self, message: str, place: SourcePosition) -> None:
        """Report what is not understood."""
        self._complete = False
        self.sources.report(message, place)

    def helper(self, name: str, scope: str, frame: Frame, call: Node) -> tuple[Node, Frame] | None:
        """The function that a call means, a method of the class or of a base or any, and the frame of its body."""
        sources = self.sources
        place = sources.place_of(frame.path, call)
        for owner in self._owners(scope, frame, place):
            for node, path in sources.methods(owner, name)[:1]:
                return node, Frame(owner, owner.scope, path, frame.depth + 1)
        whole = f"{scope}::{name}" if scope else name
        function = sources.function(whole, frame.scope, frame.path, place)
        return (
            None if function is None else (function.node, Frame(None, function.scope, function.path, frame.depth + 1))
        )

    def basic_ports(self, scope: str, frame: Frame, call: Node) -> Ports | None:
        """The ports that `providedBasicPorts` of a library's class adds; None: unknown."""
        place = self.sources.place_of(frame.path, call)
        libraries = [each for each in self._owners(scope, frame, place) if each.class_ is None]
        return next(filter(None, (self._of_library(each, place) for each in libraries)), None)

    def constant(self, name: str, frame: Frame) -> Ports | None:
        """The ports that a constant outside of a function is; None if it is anything else."""
        constant = self.sources.constant(substituted(name, frame.meanings), frame.bound, frame.scope, frame.path)
        if constant is None or frame.depth > _DEEPEST:
            return None
        value, scope, path = constant
        return Body(self, Frame(frame.bound, scope, path, frame.depth + 1)).evaluated(value)

    def class_ports(self, scope: str, frame: Frame, call: Node) -> Ports:
        """The ports of the class before `::providedPorts()`."""
        place = self.sources.place_of(frame.path, call)
        bound = self.sources.find(substituted(scope, frame.meanings), frame.scope, frame.path, place)
        if frame.depth > _DEEPEST:
            self.incomplete("this calls itself", place)
            return {}
        return self._of_class(bound, place, frame.depth + 1)

    def _owners(self, scope: str, frame: Frame, place: SourcePosition) -> list[BoundClass]:
        """The classes that may have the function that a call means; scope: what is before its name."""
        if not scope:
            return list(self.sources.ancestry(frame.bound)) if frame.bound is not None else []
        owner = self.sources.find(substituted(scope, frame.meanings), frame.scope, frame.path, place)
        return list(self.sources.ancestry(owner))


class Body:
    """The body of a function, with the variables that it fills."""

    def __init__(self, reader: PortsReader, frame: Frame) -> None:
        self.reader: Final = reader
        self.frame: Final = frame
        self.lists: Final[dict[str, Ports]] = {}

    # ---- statements ----

    def result(self, function: Node) -> Ports:
        """The ports that a function returns."""
        body = field(function, "body")
        for statement in contents(body):
            if statement.type == "return_statement":
                value = contents(statement)
                ports = self.evaluated(value[0]) if value else None
                if ports is None:
                    self.incomplete(statement)
                return ports or {}
            self.run(statement)
        self.incomplete(function)
        return {}

    def run(self, statement: Node) -> None:
        """Run a statement that may make or fill a list of ports."""
        if statement.type == "declaration":
            self._declare(statement)
        elif statement.type == "expression_statement":
            self._fill(contents(statement)[0] if contents(statement) else statement)
        elif statement.type == "for_range_loop":
            self._loop(statement)
        elif statement.type == "compound_statement":
            for inner in contents(statement):
                self.run(inner)
        elif self.names_list(statement) or any(inner.type == "return_statement" for inner in walk(statement, LAMBDAS)):
            self.incomplete(statement)

    def _declare(self, node: Node) -> None:
        is_list = self.reader.is_list(field(node, "type"))
        for declarator in node.children_by_field_name("declarator"):
            name, value = declarator, field(declarator, "value")
            while name.type in ("init_declarator", "pointer_declarator", "reference_declarator"):
                name = field(name, "declarator") or name.named_children[-1]
            if (text := string(self.reader.sources, value, self.frame)) is not None:
                self.frame.strings[text_of(name)] = text
                continue
            if name.type == "function_declarator" and is_list:  # `PortsList ports(other);`
                passed = contents(field(name, "parameters"))
                ports = self._copied(passed[0]) if passed else {}
                name = field(name, "declarator") or name
            else:
                wanted = is_list or text_of(field(node, "type")) == "auto"
                ports = (self.evaluated(value) if value is not None else {}) if wanted else None
            if ports is not None and (is_list or ports):
                self.lists[text_of(name)] = dict(ports)
            elif is_list:
                self.lists[text_of(name)] = {}
                self.incomplete(declarator)

    def _copied(self, source: Node) -> Ports | None:
        """The list that another one is made of, which the grammar takes for the type of a parameter."""
        scope, name, _ = named(field(source, "type"))
        if name == "providedPorts" and scope:
            return self.reader.class_ports(scope, self.frame, source)
        return self.lists.get(text_of(source))

    def _fill(self, node: Node) -> None:
        """`ports.insert(…)`, `ports["name"] = …` and the like."""
        if node.type == "assignment_expression" and self._assigned(node):
            return
        if node.type == "call_expression" and (self._copied_into(node) or self._filled_by_helper(node)):
            return
        function = field(node, "function") if node.type == "call_expression" else None
        name = text_of(field(function, "argument")) if function is not None else ""
        if function is None or function.type != "field_expression" or name not in self.lists:
            if self.names_list(node):
                self.incomplete(node)
            return
        method, target, passed = text_of(field(function, "field")), self.lists[name], arguments(node)
        if method in ("reserve", "rehash"):
            return
        if method == "erase" and len(passed) == 1 and (key := string(self.reader.sources, passed[0], self.frame)):
            target.pop(key, None)
            return
        ports = self._added(passed) if method in ("insert", "emplace", "merge", "insert_or_assign") else None
        if ports is None:
            self.incomplete(node)
        elif method == "insert_or_assign":
            target.update(ports)
        else:
            self.lists[name] = _united(target, ports)

    def _assigned(self, node: Node) -> bool:
        """Whether an assignment sets a list, or a port in one."""
        left, right = field(node, "left"), field(node, "right")
        if left is None or right is None:
            return False
        if left.type == "subscript_expression":
            name, keys = text_of(field(left, "argument")), contents(field(left, "indices"))
            ports = self._keyed(keys[0], right) if len(keys) == 1 else None
            if name in self.lists and ports is not None:
                self.lists[name] = {**self.lists[name], **ports}
                return True
            return False
        ports = self.evaluated(right) if text_of(left) in self.lists else None
        if ports is not None:
            self.lists[text_of(left)] = ports
        return ports is not None

    def _copied_into(self, node: Node) -> bool:
        """`std::copy(more.begin(), more.end(), std::inserter(ports, ports.end()))`"""
        passed = arguments(node)
        if callee(node)[1] != "copy" or len(passed) < 2 or callee(passed[-1])[1] != "inserter":
            return False
        name, ports = text_of((arguments(passed[-1]) or [node])[0]), self._added(passed[:-1])
        if name not in self.lists or ports is None:
            return False
        self.lists[name] = _united(self.lists[name], ports)
        return True

    def _filled_by_helper(self, node: Node) -> bool:
        """`addPorts(ports)`, which takes the list by reference."""
        scope, name, _ = callee(node)
        passed = arguments(node)
        lists = [text_of(each) in self.lists for each in passed]
        function = field(node, "function")
        if function is None or function.type == "field_expression" or sum(lists) != 1 or self.frame.depth > _DEEPEST:
            return False
        helper = self.reader.helper(name, scope, self.frame, node)
        parameter = _parameters(helper[0])[lists.index(True) :][:1] if helper is not None else []
        if helper is None or not parameter or "&" not in text_of(parameter[0]):
            return False
        body, inner, outer = Body(self.reader, helper[1]), _name_in(parameter[0]), text_of(passed[lists.index(True)])
        body.lists[inner] = self.lists[outer]
        for statement in contents(field(helper[0], "body")):
            body.run(statement)
        self.lists[outer] = body.lists[inner]
        return True

    def _added(self, passed: list[Node]) -> Ports | None:
        """The ports that `insert` and the like receive: a port, a name and a port, a list, or a range."""
        if len(passed) == 2 and all(each.type == "call_expression" for each in passed):
            whose = [_of_range(each) for each in passed]
            names = [callee(each)[1] for each in passed]
            if names in (["begin", "end"], ["cbegin", "cend"]) and whose[0] == whose[1]:
                return self.lists.get(whose[0])
        if len(passed) == 2:
            return self._keyed(*passed)
        return self.evaluated(passed[0]) if len(passed) == 1 else None

    def _keyed(self, key: Node, value: Node) -> Ports | None:
        """The port of a name and of what another port is: `"goal", BT::InputPort<Pose>("").second`."""
        name = string(self.reader.sources, key, self.frame)
        port = field(value, "argument") if value.type == "field_expression" else None
        is_second = port is not None and text_of(field(value, "field")) == "second"
        ports = self.evaluated(port) if name is not None and port is not None and is_second else None
        return {name: replace(next(iter(ports.values())), name=name)} if name is not None and ports else None

    def _loop(self, node: Node) -> None:
        """`for (const auto& port : Base::providedPorts()) ports.insert(port);`"""
        right, body = field(node, "right"), field(node, "body")
        ports = self.evaluated(right) if right is not None else None
        inside = contents(body) if body is not None and body.type == "compound_statement" else [body]
        change = next((each for each in walk(body) if each.type in _CHANGES), None) if body is not None else None
        name = text_of(field(field(change, "function") or change, "argument")) if change is not None else ""
        if ports is None or len(inside) != 1 or name not in self.lists:
            if self.names_list(node):
                self.incomplete(node)
            return
        self.lists[name] = _united(self.lists[name], ports)

    def names_list(self, node: Node) -> bool:
        """Whether a statement may change a list of ports."""
        return any(each.type == "identifier" and text_of(each) in self.lists for each in walk(node, LAMBDAS))

    # ---- expressions ----

    def evaluated(self, node: Node) -> Ports | None:
        """The ports that an expression is, one or many; None if it is anything else."""
        if node.type in ("initializer_list", "argument_list"):
            return self._listed(contents(node))
        if node.type == "parenthesized_expression":
            return self.evaluated(contents(node)[0])
        if node.type in ("identifier", "qualified_identifier"):
            name = text_of(node)
            return self.lists[name] if name in self.lists else self.reader.constant(name, self.frame)
        if node.type == "compound_literal_expression":
            value = field(node, "value")
            is_list = self.reader.is_list(field(node, "type"))
            return self.evaluated(value) if is_list and value is not None else None
        return self._called(node) if node.type == "call_expression" else None

    def _listed(self, nodes: list[Node]) -> Ports | None:
        united: Ports = {}
        for node in nodes:
            if node.type.startswith("preproc_"):
                self.incomplete(node)
                continue
            ports = self.evaluated(node)
            if ports is None:
                may_be_port = any(each.type in ("string_literal", "identifier") for each in walk(node))
                if node.type not in ("call_expression", "initializer_list") or not may_be_port:
                    return None
                self.incomplete(node)
                continue
            united = _united(united, ports)
        return united

    def _called(self, node: Node) -> Ports | None:
        scope, name, types = callee(node)
        passed = arguments(node)
        if name in _DIRECTIONS:
            return self._port(node, _DIRECTIONS[name], types, passed)
        if name == "CreatePort" and passed:
            direction = _DIRECTIONS.get(text_of(passed[0]).rpartition("::")[2])
            return self._port(node, direction, types, passed[1:]) if direction is not None else None
        if name == "PortsList":
            return self._listed(passed)
        if name in ("move", "forward") and len(passed) == 1:
            return self.evaluated(passed[0])
        if name in ("make_pair", "pair") and len(passed) == 2:
            return self._keyed(*passed)
        if name == "providedPorts" and scope:
            return self.reader.class_ports(scope, self.frame, node)
        function = field(node, "function")
        while function is not None and function.type == "parenthesized_expression":
            function = contents(function)[0]
        if function is not None and function.type == "lambda_expression" and not passed and "Port" in text_of(function):
            inside = Body(self.reader, self.frame)
            inside.lists.update(self.lists)
            return inside.result(function)
        return self._helped(name, scope, passed, node)

    def _helped(self, name: str, scope: str, passed: list[Node], node: Node) -> Ports | None:
        """The result of a function of the sources for the lists that it receives."""
        lists = [self.evaluated(each) for each in passed]
        helper = self.reader.helper(name, scope, self.frame, node)
        if helper is None:
            readable = [each for each in lists if each is not None]
            basic = self.reader.basic_ports(scope, self.frame, node) if name == "providedBasicPorts" else None
            if basic is not None and len(readable) == len(lists) == 1:
                return _united(basic, readable[0])
            if not readable and name not in ("providedPorts", "providedBasicPorts"):
                return None
            message = f"`{name}` is not in the sources, and may add ports"
            self.reader.incomplete(message, self.reader.sources.place_of(self.frame.path, node))
            return {key: port for each in readable for key, port in each.items()}
        function, frame = helper
        if not _returns_list(function):
            return None
        if self.frame.depth > _DEEPEST:
            return None
        body = Body(self.reader, frame)
        for parameter, ports in zip(_parameters(function), lists, strict=False):
            if ports is not None and (name := _name_in(parameter)):
                body.lists[name] = dict(ports)
        return body.result(function)

    def _port(self, node: Node, direction: Direction, types: list[str], passed: list[Node]) -> Ports | None:
        """`InputPort<T>(name)`, `(name, text)` or `(name, default, text)`."""
        sources = self.reader.sources
        place = sources.place_of(self.frame.path, node)
        name = string(sources, passed[0], self.frame) if passed else None
        if name is None:
            self.reader.incomplete(f"the name of this port is an expression: `{_short(node)}`", place)
            return {}
        value, written = None, " ".join(text_of(passed[1]).split()) if len(passed) > 2 else ""
        if written and (value := default(sources, passed[1], self.frame)) is None:
            sources.report(f"the default of the port `{name}` is an expression: `{written}`", place)
            value = ""
        text = string(sources, passed[-1], self.frame) if len(passed) > 1 else ""
        type_ = type_of(sources, types[0], self.frame) if types else ""
        return {name: CppPort(name, direction, type_, value, written, text or "", place)}

    def incomplete(self, node: Node) -> None:
        """Report that a node is not understood."""
        message = f"it cannot be seen which ports this provides: `{_short(node)}`"
        self.reader.incomplete(message, self.reader.sources.place_of(self.frame.path, node))


def _united(ports: Ports, others: Ports) -> Ports:
    """Two lists; of a name in both, the first counts."""
    return {**ports, **{name: port for name, port in others.items() if name not in ports}}


def _is_list(type_: str) -> bool:
    return _LIST(type_) is not None


def _returns_list(function: Node) -> bool:
    trailing = next((each for each in walk(function, LAMBDAS) if each.type == "trailing_return_type"), None)
    return _is_list(text_of(trailing) if trailing is not None else text_of(field(function, "type")))


def _of_range(call: Node) -> str:
    """The list of `ports.begin()` or `std::begin(ports)`."""
    function = field(call, "function")
    if function is not None and function.type == "field_expression":
        return text_of(field(function, "argument"))
    return text_of((arguments(call) or [call])[0])


def _parameters(function: Node) -> list[Node]:
    declarator = next((each for each in walk(function) if each.type == "function_declarator"), None)
    return contents(field(declarator, "parameters")) if declarator is not None else []


def _name_in(parameter: Node) -> str:
    names = [text_of(each) for each in walk(parameter) if each.type == "identifier"]
    return names[-1] if names else ""


def _registers(statement: Node) -> bool:
    return any(each.type == "call_expression" and REGISTERS(callee(each)[1]) for each in walk(statement))


def _short(node: Node) -> str:
    text = " ".join(text_of(node).split())
    return text if len(text) <= 60 else f"{text[:60]}…"


_DIRECTIONS: Final[dict[str, Direction]] = {
    "InputPort": "input",
    "OutputPort": "output",
    "BidirectionalPort": "inout",
    "INPUT": "input",
    "OUTPUT": "output",
    "INOUT": "inout",
}
_LIST: Final = re.compile(r"\bPortsList\b|PortInfo>").search
_CHANGES: Final = ("call_expression", "subscript_expression")
_DEEPEST: Final = 20  # helpers that call themselves
