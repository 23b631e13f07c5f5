"""The nodes that C++ sources register.

One invariant: a node whose ID or category cannot be seen is left out and reported.
"""

from __future__ import annotations

import re
from collections.abc import Container, Iterable, Mapping
from typing import TYPE_CHECKING, Final

from btq_lang.catalog.cpp_classes import NAMESPACE, STARTING_AFTER_RESET
from btq_lang.catalog.kinds import Category
from btq_lang.catalog.nav2 import DISTRIBUTIONS
from btq_lang.cpp.grammar import LAMBDAS, arguments, callee, contents, enclosing, field, text_of, walk
from btq_lang.cpp.macros import Macros, macros_in
from btq_lang.cpp.model import CppNode, CppNodes
from btq_lang.cpp.ports import Body, PortsReader, Provided
from btq_lang.cpp.source import CppSource, RegistrationCall
from btq_lang.cpp.sources import BoundClass, CppSources
from btq_lang.cpp.uses import Uses
from btq_lang.cpp.values import string

if TYPE_CHECKING:
    from tree_sitter import Node


def read_nodes(files: Mapping[str, str], distributions: tuple[str, ...] = DISTRIBUTIONS) -> CppNodes:
    """The nodes that some files register.

    Args:
        files: texts by path.
        distributions: those of Nav2 whose base classes may be meant.

    Raises:
        GrammarMissing: tree-sitter is not installed.
    """
    macros = Macros(macro for path, text in files.items() for macro in macros_in(path, text))
    return nodes_of((CppSource(path, text, macros.needed_by(text)) for path, text in files.items()), distributions)


def nodes_of(sources: Iterable[CppSource], distributions: tuple[str, ...] = DISTRIBUTIONS) -> CppNodes:
    """The nodes that parsed files register; distributions: as above."""
    reader = _Reader(CppSources(sources, distributions))
    nodes: dict[str, CppNode] = {}
    for source in reader.sources.files.values():
        for call in source.calls:
            node = reader.node(call)
            if node is None:
                continue
            first = nodes.setdefault(node.name, node)
            if (first.class_name, first.ports) != (node.class_name, node.ports):
                reader.sources.report(f"`{node.name}` is also registered at {first.place}, as another node", node.place)
    reader.report_hidden({node.class_name for node in nodes.values()})
    unseen = sorted(reader.sources.unseen, key=lambda each: (each.place.path, each.place.line, each.message))
    return CppNodes(tuple(nodes[name] for name in sorted(nodes)), tuple(unseen))


class _Reader:
    def __init__(self, sources: CppSources) -> None:
        self.sources: Final = sources
        self._ports: Final = PortsReader(sources)

    def node(self, call: RegistrationCall) -> CppNode | None:
        """The node that a call registers; None if it registers none, or none that can be seen."""
        passed = arguments(call.node)
        if _OTHERS(call.name) or not passed or _is_of_template(call):
            return None
        body = self._ports.before(call.node, call.scope, call.path)
        if call.name in _SIMPLE:
            return self._simple(call, body, passed)
        if call.name == "registerBuilder" and not call.types:
            return self._manifest(call, body, passed[0])
        if call.name == "CreateRosNodePlugin" and len(passed) == 2:
            return self._class(call, body, text_of(passed[0]), passed[1], None)
        if not call.types:
            return None
        if call.name in _ENGINES:
            ports = passed[1] if call.name == "registerNodeType" and len(passed) > 1 else None
            return self._class(call, body, call.types[0], passed[0], ports)
        named = next((argument for argument in passed if string(self.sources, argument, body.frame) is not None), None)
        return self._class(call, body, call.types[0], named, None) if named is not None else None

    def report_hidden(self, registered: Container[str]) -> None:
        """Report what looks like a macro that registers a class which nothing else is seen to register."""
        for source in self.sources.files.values():
            for macro in source.registering:
                bounds = (self.sources.find(argument, (), source.path, macro.place) for argument in macro.arguments)
                for bound in bounds:
                    if bound.class_ is None or bound.class_.name in registered or not self.sources.category(bound):
                        continue
                    message = f"it cannot be seen under which ID `{macro.name}` registers `{bound.name}`; {_OF_MACRO}"
                    self.sources.report(message, macro.place, hides_node=True)

    def _simple(self, call: RegistrationCall, body: Body, passed: list[Node]) -> CppNode | None:
        """`registerSimpleAction("Name", function, ports)`"""
        if (name := self._name(call, body, passed[0])) is None:
            return None
        place = self.sources.place_of(call.path, call.node)
        provided = self._ports.of_argument(passed[2], body) if len(passed) > 2 else Provided((), True)
        if provided is None:
            self.sources.report(f"it cannot be seen which ports `{name}` has: `{text_of(passed[2])}`", place)
            provided = Provided((), False)
        ports, complete = provided.ports, provided.complete
        uses = Uses.of_function(self.sources, passed[1], body.frame) if len(passed) > 1 else Uses(self.sources)
        undeclared = uses.undeclared(ports) if complete else ()
        category, without = _SIMPLE[call.name], uses.without_each(ports)
        unread, ends_at_once = uses.unread(ports), category == "Action"  # else the engine throws
        return CppNode(
            name, category, "", place, place, ports, complete, unread, undeclared, without, at_once=ends_at_once
        )

    def _manifest(self, call: RegistrationCall, body: Body, manifest: Node) -> CppNode | None:
        """`registerBuilder(CreateManifest<T>("Name", ports), builder)`"""
        if manifest.type == "call_expression":
            _, name, types = callee(manifest)
            passed = arguments(manifest)
            if name == "CreateManifest" and types and passed:
                return self._class(call, body, types[0], passed[0], passed[1] if len(passed) > 1 else None)
        self._report(call, f"it cannot be seen which node this registers: `{text_of(manifest)}`")
        return None

    def _class(self, call: RegistrationCall, body: Body, type_: str, named: Node, last: Node | None) -> CppNode | None:
        """A class under a name; given: the argument that may be its ports."""
        if (name := self._name(call, body, named)) is None:
            return None
        place = self.sources.place_of(call.path, call.node)
        bound = self.sources.find(type_, call.scope, call.path, place)
        if bound.class_ is None and self.sources.library_ports(bound, place) is None:
            self._report(call, f"the class `{type_}` of the node `{name}` is not in the sources")
            return None
        category = self.sources.category(bound)
        if category is None:
            bases = ", ".join(f"`{each.name}`" for each in self.sources.ancestry(bound) if each.class_ is None)
            bases = bases or "a base class"
            self._report(call, f"the category of `{name}` cannot be seen: {bases} is not in the sources")
            return None
        of_call = self._ports.of_argument(last, body) if last is not None and _may_be_ports(last, body) else None
        provided = of_call or self._ports.of_class(bound, place)
        ports, complete = provided.ports, provided.complete
        if bound.class_ is None:
            return CppNode(name, category, bound.name, place, place, ports, complete)
        uses = Uses.of_class(self.sources, bound)
        return CppNode(
            name,
            category,
            bound.class_.name,
            place,
            self.sources.place_of(bound.class_.path, field(bound.class_.node, "name") or bound.class_.node),
            ports,
            complete,
            uses.unread(ports),
            uses.undeclared(ports) if complete else (),
            uses.without_each(ports),
            ends_within_tick(self.sources, bound),
            keeps_result(self.sources, bound),
            self.sources.nav2_base(bound),
        )

    def _name(self, call: RegistrationCall, body: Body, node: Node) -> str | None:
        name = string(self.sources, node, body.frame)
        if name is None:
            self._report(call, f"the name of this node is an expression: `{text_of(node)}`")
        return name

    def _report(self, call: RegistrationCall, message: str) -> None:
        self.sources.report(message, self.sources.place_of(call.path, call.node), hides_node=True)


def _may_be_ports(node: Node, body: Body) -> bool:
    """Whether an argument may be a list of ports, and not one for the constructor."""
    return node.type != "identifier" or text_of(node) in body.lists


def _is_of_template(call: RegistrationCall) -> bool:
    """Whether a call is in a template that registers what it is given."""
    around = enclosing(call.node, ("template_declaration",))
    while around is not None:
        names = {text_of(each) for each in walk(around) if each.type == "type_parameter_declaration"}
        own = {each.split()[-1] for each in names if each}
        if own.intersection(call.types) or (not call.types and own and call.name == "registerBuilder"):
            return True
        around = enclosing(around, ("template_declaration",))
    return False


def ends_within_tick(sources: CppSources, bound: BoundClass) -> bool:
    """Whether the nodes of a class are seen never to return RUNNING.

    Only the engine says so, which throws if a SyncActionNode returns it, or each `return` of a `tick` that no class of
    the engine continues at a later tick.
    """
    above = list(sources.ancestry(bound))
    outside = {ancestor.name.rpartition("::")[2] for ancestor in above if ancestor.class_ is None}
    if outside != {"ActionNodeBase"}:
        return outside == {"SyncActionNode"}
    for ancestor in above:
        bodies = sources.methods(ancestor, "tick")
        if bodies or (ancestor.class_ is not None and "tick" in ancestor.class_.promised):
            return len(bodies) == 1 and _answers(bodies[0][0])
    return False


def keeps_result(sources: CppSources, bound: BoundClass) -> bool:
    """Whether the nodes of a class are seen to start only after a reset."""
    for ancestor in sources.ancestry(bound):
        scope, _, name = ancestor.name.rpartition("::")
        is_of_library = scope in ("BT", NAMESPACE) or (ancestor.class_ is None and not scope)
        if is_of_library and name in STARTING_AFTER_RESET:
            return True
    return False


def _answers(tick: Node) -> bool:
    returns = [each for each in walk(tick, LAMBDAS) if each.type == "return_statement"]
    return bool(returns) and all(len(contents(each)) == 1 and _is_answer(contents(each)[0]) for each in returns)


def _is_answer(value: Node) -> bool:
    """Whether an expression is SUCCESS or FAILURE, or a choice between them."""
    if value.type == "parenthesized_expression":
        return _is_answer(contents(value)[0])
    if value.type == "conditional_expression":
        branches = (field(value, "consequence"), field(value, "alternative"))
        return all(each is not None and _is_answer(each) for each in branches)
    return text_of(value).rpartition("::")[2] in ("SUCCESS", "FAILURE")


_SIMPLE: Final[dict[str, Category]] = {
    "registerSimpleAction": "Action",
    "registerSimpleCondition": "Condition",
    "registerSimpleDecorator": "Decorator",
}
_OF_MACRO: Final = "name the file that defines it, too, or declare the node in a model"
_ENGINES: Final = ("registerNodeType", "registerBuilder")
_OTHERS: Final = re.compile(
    r"register(BehaviorTreeFrom\w+|From\w*Plugins?|ScriptingEnums?|PolymorphicCast)|RegisterJsonDefinition"
).fullmatch
