"""All files together: which class, function or constant a name means, and what classes derive from.

One invariant: a name means what is nearest: in the scopes around it, in the same file, in a file that is included; of
several that are equally near none is taken, and that is reported.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Final, TypeVar

from btq_lang.catalog.cpp_classes import BASES, ENGINE, LIBRARIES, NAMESPACE, NUMBERED_TAGS, ROS_PORTS, TAGS, BasePort
from btq_lang.catalog.kinds import Category
from btq_lang.catalog.nav2 import DISTRIBUTIONS
from btq_lang.catalog.nodes import BUILTINS
from btq_lang.cpp.model import CppPort, SourcePosition, Unseen
from btq_lang.cpp.source import Class, CppSource, Function, parts, substituted
from btq_lang.util.grouping import grouped
from btq_lang.util.record import Record

if TYPE_CHECKING:
    from tree_sitter import Node


T = TypeVar("T", Class, Function)


class BoundClass(Record):
    """A class and what the parameters of its template mean; class_: None for one that is not in the sources."""

    class_: Class | None
    name: str
    meanings: dict[str, str]

    @property
    def scope(self) -> tuple[str, ...]:
        """The scope inside of the class."""
        return tuple(self.name.split("::"))


class CppSources:
    """The files, by path.

    Args:
        distributions: those of Nav2 that may be meant.

    Attributes:
        accessed: the ports that code reads or writes of another object.
    """

    def __init__(self, sources: Iterable[CppSource], distributions: tuple[str, ...] = DISTRIBUTIONS) -> None:
        self._distributions: Final = distributions
        self.files: Final = {source.path: source for source in sources}
        self.unseen: Final = [each for source in self.files.values() for each in source.unseen]
        self.accessed: Final = frozenset().union(*(source.accessed for source in self.files.values()))
        self._orders: Final[dict[str, list[CppSource]]] = {}  # by path, the nearest first
        every = self.files.values()
        self._by_file_name: Final = grouped((path.rpartition("/")[2], path) for path in self.files)
        # By the last part of the name, of a class and of a function.
        self._classes: Final = grouped((_last(each.name), each) for source in every for each in source.classes)
        self._methods: Final = grouped((_last(each.name), each) for source in every for each in source.functions)

    def place_of(self, path: str, node: Node) -> SourcePosition:
        """The place of a node of a file on the disk."""
        return self.files[path].place_of(node)

    def report(self, message: str, place: SourcePosition, hides_node: bool = False) -> None:
        """Report once what cannot be read."""
        unseen = Unseen(message, place, hides_node)
        if unseen not in self.unseen:
            self.unseen.append(unseen)

    def find(
        self, type_: str, scope: tuple[str, ...], path: str, place: SourcePosition, aliases: int = 0
    ) -> BoundClass:
        """The class that a type means at a place; aliases: by how many of them it was found."""
        name, passed = parts(type_)
        class_ = self._nearest(self._classes.get(_last(name), []), name, scope, path, place)
        if class_ is None and aliases < _MOST_ALIASES and (alias := self.alias(name, scope, path)) is not None:
            return self.find(alias, scope, path, place, aliases + 1)
        if class_ is None:
            return BoundClass(None, name, {str(index): text for index, text in enumerate(passed)})
        return BoundClass(class_, class_.name, dict(zip(class_.parameters, passed, strict=False)))

    def function(self, name: str, scope: tuple[str, ...], path: str, place: SourcePosition) -> Function | None:
        """The function outside of a class that a name means at a place."""
        return self._nearest(self._methods.get(_last(name), []), name, scope, path, place)

    def functions(self, name: str, scope: tuple[str, ...], path: str) -> list[Function]:
        """The functions outside of classes that a name may mean, which differ in their parameters."""
        return self._all_nearest(self._methods.get(_last(name), []), name, scope, path)

    def ancestry(self, bound: BoundClass) -> Iterator[BoundClass]:
        """A class and all that it derives from, the nearest first; those that are not in the sources too."""
        waiting, seen = [bound], {bound.name}
        for derived in waiting:
            yield derived
            if derived.class_ is None:
                continue
            for base in derived.class_.bases:
                type_ = substituted(base, derived.meanings)
                place = self.place_of(derived.class_.path, derived.class_.node)
                above = self.find(type_, derived.scope, derived.class_.path, place)
                if above.name not in seen:
                    seen.add(above.name)
                    waiting.append(above)

    def category(self, bound: BoundClass) -> Category | None:
        """The category that a class has from what it derives from; None if that is not in the sources."""
        for ancestor in self.ancestry(bound):
            scope, _, name = ancestor.name.rpartition("::")
            if name in ENGINE and (scope == "BT" or (ancestor.class_ is None and not scope)):
                return ENGINE[name]
            if ancestor.class_ is None and name in LIBRARIES:
                return LIBRARIES[name]
        return next(filter(None, map(_mixed_in, self.ancestry(bound))), None)

    def nav2_base(self, bound: BoundClass) -> str:
        """The class of Nav2 that creates what a class needs, from which it derives; empty if there is none."""
        for ancestor in self.ancestry(bound):
            scope, _, name = ancestor.name.rpartition("::")
            if name in BASES and (scope == NAMESPACE or (ancestor.class_ is None and not scope)):
                return name
        return ""

    def methods(self, bound: BoundClass, name: str) -> list[tuple[Node, str]]:
        """The bodies of a class's own methods of a name, in the class or outside, each with its file."""
        class_ = bound.class_
        if class_ is None:
            return []
        inside = [(each, class_.path) for each in class_.methods.get(name, ())]
        return inside + [(each.node, each.path) for each in self._outside(class_, name)]

    def all_methods(self, class_: Class) -> list[tuple[str, Node, str]]:
        """All bodies of a class's own methods, each with its name and file."""
        methods = [(name, body, class_.path) for name, bodies in class_.methods.items() for body in bodies]
        for name in sorted(class_.promised):
            methods += [(name, method.node, method.path) for method in self._outside(class_, name)]
        return methods

    def string(self, name: str, bound: BoundClass | None, scope: tuple[str, ...], path: str) -> str | None:
        """The string that a constant means."""
        for whole, source in self._whole_names(name, bound, scope, path):
            if whole in source.strings:
                return source.strings[whole]
        strings = {
            string
            for source in self.files.values()
            for whole, string in source.strings.items()
            if whole.endswith(f"::{name}") or whole == name
        }
        return strings.pop() if len(strings) == 1 else None

    def constant(
        self, name: str, bound: BoundClass | None, scope: tuple[str, ...], path: str
    ) -> tuple[Node, tuple[str, ...], str] | None:
        """The value of a constant that may be ports, with its scope and file."""
        for whole, source in self._whole_names(name, bound, scope, path):
            if whole in source.lists:
                return *source.lists[whole], source.path
        return None

    def _whole_names(
        self, name: str, bound: BoundClass | None, scope: tuple[str, ...], path: str
    ) -> Iterator[tuple[str, CppSource]]:
        """The whole names that a name may mean, each in each file, the nearest first."""
        scopes = [each.scope for each in self.ancestry(bound)] if bound is not None else []
        for around in (scope, *scopes):
            for whole in _in_scopes(name, around):
                yield from ((whole, source) for source in self._near(path))

    def strings_of(self, names: set[str]) -> set[str]:
        """The strings of all constants that have one of some names."""
        return {
            string
            for source in self.files.values()
            for whole, string in source.strings.items()
            if _last(whole) in names
        }

    def alias(self, name: str, scope: tuple[str, ...], path: str) -> str | None:
        """The type that an alias means."""
        for whole in _in_scopes(name, scope):
            for source in self._near(path):
                if whole in source.aliases:
                    return source.aliases[whole]
        return None

    def library_ports(self, bound: BoundClass, place: SourcePosition) -> tuple[dict[str, CppPort], str] | None:
        """The ports of a class of a known library, by name, each at a place, and those that it may have, too; None for
        any other class, which may provide any port."""
        if (of_nav2 := _of_nav2(bound)) is None:
            ports = _library_ports(bound, place)
            return None if ports is None else (ports, "")
        in_all = [port for port in of_nav2 if all(map(port.is_in, self._distributions))]
        in_some = [port for port in of_nav2 if port not in in_all and any(map(port.is_in, self._distributions))]
        ports = {
            port.name: CppPort(port.name, port.direction, port.type, _default(port), "", port.text, place)
            for port in in_all
        }
        return ports, ", ".join(f"`{port.name}`" for port in in_some)

    def _outside(self, class_: Class, name: str) -> list[Function]:
        """The methods of a class whose body is outside of it."""
        methods = []
        for function in self._methods.get(name, ()):
            owner = function.name.rpartition("::")[0]
            if not owner or _last(owner) != _last(class_.name):
                continue
            place = self.place_of(function.path, function.node)
            meant = self._nearest(self._classes[_last(owner)], owner, function.scope, function.path, place)
            if meant is class_:
                methods.append(function)
        return methods

    def _nearest(
        self, candidates: list[T], name: str, scope: tuple[str, ...], path: str, place: SourcePosition
    ) -> T | None:
        """The candidate that a name means at a place.

        Args:
            candidates: those with the last part of the name.
        """
        fitting = self._all_nearest(candidates, name, scope, path)
        if len(fitting) > 1 and isinstance(fitting[0], Class):
            places = ", ".join(sorted(f"{each.path}:{each.node.start_point[0] + 1}" for each in fitting))
            self.report(f"`{name}` may be any of several classes: {places}", place)
            return None
        return fitting[0] if fitting else None

    def _all_nearest(self, candidates: list[T], name: str, scope: tuple[str, ...], path: str) -> list[T]:
        """The candidates that a name may mean which are equally near."""
        if not candidates:
            return []
        usings: list[str] = self.files[path].usings
        names = [*_in_scopes(name, scope), *(f"{using}::{name}" for using in usings)]
        fitting = next(
            (fit for whole in names if (fit := [candidate for candidate in candidates if _whole(candidate) == whole])),
            None,
        )
        if fitting is None:
            fitting = [candidate for candidate in candidates if _whole(candidate).endswith(f"::{name}")]
        if len(fitting) < 2:
            return fitting
        near = [source.path for source in self._near(path)]
        least = min(near.index(candidate.path) for candidate in fitting)
        return [candidate for candidate in fitting if near.index(candidate.path) == least]

    def _near(self, path: str) -> list[CppSource]:
        """All files, the nearest first: the file itself, what it includes, directly or not, and the others."""
        if path not in self._orders:
            order = {path: self.files[path]}
            waiting = [self.files[path]]
            for source in waiting:
                included = {other for include in source.includes for other in self._included(include)} - order.keys()
                waiting += [self.files[other] for other in sorted(included)]
                order.update((other, self.files[other]) for other in sorted(included))
            self._orders[path] = [*order.values(), *(other for name, other in self.files.items() if name not in order)]
        return self._orders[path]

    def _included(self, include: str) -> list[str]:
        """The files that an `#include` may mean."""
        name = include.rpartition("/")[2]
        end = "/" + include.lstrip("./")
        return [path for path in self._by_file_name.get(name, ()) if f"/{path}".endswith(end)]


def _mixed_in(bound: BoundClass) -> Category | None:
    """The category of a class of the engine that a template, which is not in the sources, is given to derive from."""
    meanings = bound.meanings.values() if bound.class_ is None else ()
    names = (each.removeprefix("BT::") for each in meanings if each.startswith("BT::"))
    return next((ENGINE[name] for name in names if name in ENGINE), None)


def _in_scopes(name: str, scope: tuple[str, ...]) -> list[str]:
    """The whole names that a name may mean, from the innermost scope to the outermost."""
    return ["::".join((*scope[:depth], name)) for depth in range(len(scope), -1, -1)]


def _whole(named: Class | Function) -> str:
    return named.name if isinstance(named, Class) else "::".join((*named.scope, named.name))


def _last(name: str) -> str:
    return name.rpartition("::")[2]


def _of_nav2(bound: BoundClass) -> tuple[BasePort, ...] | None:
    """The ports of a base class of Nav2's nodes in its distributions; None for any other class."""
    scope, _, name = bound.name.rpartition("::")
    return BASES.get(name) if bound.class_ is None and scope in ("", NAMESPACE) else None


def _default(port: BasePort) -> str | None:
    return "" if port.direction == "input" else None


def _library_ports(bound: BoundClass, place: SourcePosition) -> dict[str, CppPort] | None:
    """The ports of a class of the engine or of behaviortree_ros2, by name, each at a place."""
    name = bound.name.rpartition("::")[2]
    if name in ROS_PORTS:
        key, text = ROS_PORTS[name]
        return {key: CppPort(key, "input", "std::string", "", "", text, place)}
    numbered = NUMBERED_TAGS.get(name)
    tag = numbered.format(bound.meanings.get("0")) if numbered is not None else TAGS.get(name)
    if name not in ENGINE or (tag is not None and tag not in BUILTINS):
        return None
    ports = {}
    for port in BUILTINS[tag].ports if tag is not None else ():
        of_item = name == "LoopNode" and port.name == "value"
        type_ = bound.meanings.get("0", port.type) if of_item else port.type
        ports[port.name] = CppPort(port.name, port.direction, type_, port.default, port.default or "", port.doc, place)
    return ports


_MOST_ALIASES: Final = 20  # an alias may mean itself
