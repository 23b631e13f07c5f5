"""One C++ file: its classes, functions, constants, aliases and calls that may register nodes.

One invariant: a name is kept with the namespaces and classes around it; what it means is not known here.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Final

from btq_lang.cpp.grammar import (
    arguments,
    callee,
    contents,
    errors,
    field,
    literal,
    named,
    parse,
    text_of,
    walk,
)
from btq_lang.cpp.macros import MATTERS, Expanded, Macro
from btq_lang.cpp.model import SourcePosition, Unseen
from btq_lang.util.record import Record

if TYPE_CHECKING:
    from tree_sitter import Node


class Class(Record):
    """A class with a body.

    Attributes:
        name: with namespaces.
        parameters: of its template.
        bases: as they are written.
        methods: those with a body in the class, by name; the others are functions of files.
        promised: the names of methods whose body is elsewhere.
    """

    name: str
    path: str
    node: Node
    parameters: tuple[str, ...]
    bases: tuple[str, ...]
    methods: dict[str, list[Node]]
    promised: set[str]


class Function(Record):
    """A function with a body outside of a class; scope: the namespaces around it."""

    name: str
    scope: tuple[str, ...]
    path: str
    node: Node


class RegistrationCall(Record):
    """A call that may register a node; scope: the namespaces and classes around it."""

    name: str
    types: tuple[str, ...]
    scope: tuple[str, ...]
    path: str
    node: Node


class CppSource:
    """One file.

    Args:
        macros: those that are expanded in it.

    Attributes:
        strings: constants by their whole name.
        lists: constants that may be ports, likewise, each with the scope that it is in.
        aliases: of types, likewise.
        accessed: the ports that code reads or writes of another object, as tests do.
        registering: what may register a node, and does not show how.
    """

    def __init__(self, path: str, text: str, macros: tuple[Macro, ...] = ()) -> None:
        self.path: Final = path
        self.classes: Final[list[Class]] = []
        self.functions: Final[list[Function]] = []
        self.calls: Final[list[RegistrationCall]] = []
        self.strings: Final[dict[str, str]] = {}
        self.lists: Final[dict[str, tuple[Node, tuple[str, ...]]]] = {}
        self.aliases: Final[dict[str, str]] = {}
        self.accessed: Final[set[str]] = set()
        self.includes: Final[list[str]] = []
        self.usings: Final[list[str]] = []
        self.unseen: Final[list[Unseen]] = []
        self._expanded: Final = Expanded(path, text, macros)
        self.registering: Final = self._expanded.registering
        self.unseen.extend(Unseen(each.message, each.place, hides_node=True) for each in self._expanded.failed)
        root = parse(self._expanded.text)
        self._visit(contents(root), (), None, ())
        lines = self._expanded.text.splitlines()
        for row, node in {node.start_point[0]: node for node in reversed([*errors(root)])}.items():
            if any(map(MATTERS, lines[row : node.end_point[0] + 1])):
                self.unseen.append(Unseen("the C++ grammar cannot read this", self.place_of(node), hides_node=True))

    def place_of(self, node: Node) -> SourcePosition:
        """The place of a node on the disk."""
        row, column = self._expanded.original(*node.start_point)
        end_row, end_column = self._expanded.original(*node.end_point, at_end=True)
        return SourcePosition(self.path, row + 1, column + 1, end_row + 1, end_column + 1)

    def _visit(
        self, nodes: Iterable[Node], scope: tuple[str, ...], within: Class | None, parameters: tuple[str, ...]
    ) -> None:
        for node in nodes:
            kind = node.type
            if kind == "namespace_definition":
                inner = tuple(filter(None, text_of(field(node, "name")).split("::")))
                self._visit(contents(field(node, "body")), (*scope, *inner), within, ())
            elif kind == "template_declaration":
                self._visit(contents(node), scope, within, _parameters(field(node, "parameters")))
            elif kind in ("class_specifier", "struct_specifier"):
                self._class(node, scope, parameters)
            elif kind == "function_definition":
                self._function(node, scope, within)
            elif kind in ("declaration", "field_declaration"):
                self._declaration(node, scope, within)
            elif kind in ("alias_declaration", "type_definition"):
                name = text_of(field(node, "name") or field(node, "declarator"))
                self.aliases["::".join((*scope, name))] = plain(text_of(field(node, "type")))
            elif kind == "preproc_include":
                self.includes.append(text_of(field(node, "path")).strip('<>"'))
            elif kind == "preproc_def":
                if (quoted := _QUOTED.fullmatch(text_of(field(node, "value")).strip())) is not None:
                    self.strings[text_of(field(node, "name"))] = quoted[1]
            elif kind == "using_declaration":
                self.usings.append(text_of(node).removesuffix(";").split()[-1])
            elif kind == "ERROR":
                self._visit(contents(node), scope, within, ())
            elif kind.startswith("preproc_") or kind in ("linkage_specification", "declaration_list"):
                self._visit(contents(node), scope, within, parameters)
            else:
                self._inside(node, scope)

    def _class(self, node: Node, scope: tuple[str, ...], parameters: tuple[str, ...]) -> None:
        body = field(node, "body")
        if body is None:
            return
        scopes, name, _ = named(field(node, "name"))
        inner = (*scope, *filter(None, scopes.split("::")), name)
        clause = next((each for each in node.children if each.type == "base_class_clause"), None)
        bases = [plain(text_of(each)) for each in contents(clause) if each.type not in _OF_BASES]
        class_ = Class("::".join(inner), self.path, node, parameters, tuple(bases), {}, set())
        self.classes.append(class_)
        self._visit(contents(body), inner, class_, ())

    def _function(self, node: Node, scope: tuple[str, ...], within: Class | None) -> None:
        body = field(node, "body")
        if body is None:  # `= default`, `= delete`
            return
        name = _name_of(node)
        if within is not None:
            within.methods.setdefault(name, []).append(node)
        else:
            self.functions.append(Function(name, scope, self.path, node))
        self._inside(node, scope)

    def _declaration(self, node: Node, scope: tuple[str, ...], within: Class | None) -> None:
        for declarator in node.children_by_field_name("declarator"):
            inner = declarator
            while inner.type in ("pointer_declarator", "reference_declarator", "init_declarator"):
                inner = field(inner, "declarator") or inner.named_children[-1]
            if inner.type == "function_declarator":
                if within is not None and field(node, "default_value") is None:  # not `= 0`
                    within.promised.add(text_of(field(inner, "declarator")))
                continue
            value = field(declarator, "value") or field(node, "default_value")
            if value is not None and value.type in ("initializer_list", "argument_list") and len(contents(value)) == 1:
                value = contents(value)[0]
            if (string := literal(value)) is not None:
                self.strings["::".join((*scope, text_of(inner)))] = string
            elif value is not None and "Port" in text_of(node):
                self.lists["::".join((*scope, text_of(inner)))] = value, scope
        self._inside(node, scope)

    def _inside(self, node: Node, scope: tuple[str, ...]) -> None:
        """Find the calls, and the classes that a function defines for itself."""
        for inner in walk(node, _CLASSES):
            if inner.type in _CLASSES:
                self._class(inner, scope, ())
            elif inner.type == "call_expression":
                _, name, types = callee(inner)
                if REGISTERS(name):
                    self.calls.append(RegistrationCall(name, tuple(map(plain, types)), scope, self.path, inner))
                elif name in ACCESSES and _is_of_another(field(inner, "function")) and (given := arguments(inner)):
                    self.accessed.add(literal(given[0]) or "")


def _is_of_another(method: Node | None) -> bool:
    """Whether a method is called of another object: `node->getInput`."""
    return method is not None and text_of(field(method, "argument")) not in ("", "this")


def _name_of(function: Node) -> str:
    """The name of a function, with what is written before it: `Move::providedPorts`."""
    declarator = field(function, "declarator")
    while declarator is not None and declarator.type != "function_declarator":
        inside = contents(declarator)
        declarator = field(declarator, "declarator") or (inside[-1] if inside else None)
    return parts(text_of(field(declarator, "declarator")))[0] if declarator is not None else ""


def _parameters(node: Node | None) -> tuple[str, ...]:
    names = []
    for parameter in contents(node):
        words = [text_of(one) for one in walk(parameter) if one.type in ("type_identifier", "identifier")]
        first = 0 if parameter.type == "optional_type_parameter_declaration" else -1
        names.append(words[first] if words else "")
    return tuple(names)


def plain(text: str) -> str:
    """A type without superfluous blanks: `std::vector<int>`."""
    text = _BLANKS.sub(" ", text.strip()).removeprefix("typename ").removeprefix("::")
    return _AROUND.sub(r"\1", text).replace(",", ", ")


def parts(text: str) -> tuple[str, list[str]]:
    """The name of a type and the arguments of its template: `Base` and `int` of `Base<int>`."""
    text = plain(text)
    name, sign, inside = text.partition("<")
    if not sign or not text.endswith(">"):
        return text, []
    depth, begin, pieces = 0, 0, []
    for index, sign in enumerate(inside[:-1]):
        depth += sign in "<({"
        depth -= sign in ">)}"
        if sign == "," and not depth:
            pieces.append(inside[begin:index].strip())
            begin = index + 1
    return name, [*pieces, inside[begin:-1].strip()]


def substituted(text: str, meanings: Mapping[str, str]) -> str:
    """A type in which the parameters of a template are replaced by what they mean."""
    return plain(_WORD.sub(lambda match: meanings.get(match[0], match[0]), text))


_CLASSES: Final = frozenset(("class_specifier", "struct_specifier"))
_OF_BASES: Final = ("access_specifier", "virtual")
_QUOTED: Final = re.compile(r'"((?:[^"\\]|\\.)*)"')
ACCESSES: Final = ("getInput", "setOutput", "getLockedPortContent", "getInputStamped")
REGISTERS: Final = re.compile(r"[rR]egister[A-Z]\w*|CreateRosNodePlugin").fullmatch
_BLANKS: Final = re.compile(r"\s+")
_AROUND: Final = re.compile(r" ?(::|[<>,]) ?")
_WORD: Final = re.compile(r"(?<![\w:])[A-Za-z_]\w*")
