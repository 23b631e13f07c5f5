"""The mutants of a mission: changes of its tree, each as a mistake could have made it.

One invariant: they depend on the tree alone, and are in the order of its text.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Final

from btq_lang.btcpp.document import Element
from btq_lang.btcpp.marks import MARK
from btq_lang.scenarios.mission import ScenarioMission
from btq_lang.scenarios.mutating import Change, Exchange, Inversion, Mutant, Omission, OtherPort, OtherScript
from btq_lang.scenarios.outcomes import NodeOutcomes
from btq_lang.scenarios.results import OutcomePlace
from btq_lang.simulator.ports import key_of
from btq_lang.syntax.script.parser import parse_script
from btq_lang.syntax.script.tree import Assign, Number, children
from btq_lang.util.grouping import grouped
from btq_lang.util.record import Record
from btq_lang.workspace.resolved import ResolvedNode


class NamedMutant(Record):
    """A mutant; `what`: the change, in words."""

    place: OutcomePlace
    what: str
    mutant: Mutant


def mutants(mission: ScenarioMission, outcomes: NodeOutcomes) -> tuple[NamedMutant, ...]:
    """The mutants of a mission."""
    maker = _Maker(mission, outcomes)
    named = [*maker.of_nodes(), *maker.of_guards()]
    return tuple(sorted(named, key=lambda each: each.place.position))


class _Maker:
    def __init__(self, mission: ScenarioMission, outcomes: NodeOutcomes) -> None:
        self._mission: Final = mission
        self._outcomes: Final = outcomes
        self._elements: Final = outcomes.elements
        self._children: Final = outcomes.children
        self._literals: Final = _values_by(mission, self._elements, is_key=False)
        self._keys: Final = _values_by(mission, self._elements, is_key=True)

    def of_nodes(self) -> Iterator[NamedMutant]:
        """The mutants of written nodes; one that runs as several nodes changes as all of them."""
        for uids in grouped((id(element), uid) for uid, element in self._elements.items()).values():
            if (place := self._outcomes.places.get(uids[0])) is not None:
                for what, change in self._of_node(uids[0]):
                    yield NamedMutant(place, what, Mutant(tuple((uid, change) for uid in uids)))

    def of_guards(self) -> Iterator[NamedMutant]:
        """Guards that are left out."""
        parts = grouped((place, part) for part, place in self._outcomes.guards.items())
        for place, evaluating in parts.items():
            around: dict[int, Change] = {}
            for part in evaluating:
                for wrapper in (part, self._mission.tree.parent[part]):
                    if self._elements[wrapper].get(MARK) == self._elements[part].get(MARK):
                        around |= self._omission(wrapper)
            if around:
                yield NamedMutant(place, "left out", Mutant(tuple(around.items())))

    def _omission(self, wrapper: int) -> dict[int, Change]:
        """Leave out a wrapper, but for the child that is or holds a node; nothing if it has no such child."""
        last = self._mission.tree.last
        for index, child in enumerate(self._children.get(wrapper, ())):
            if any(uid in self._mission.written for uid in range(child, last[child] + 1)):
                return {wrapper: Omission(index)}
        return {}

    def _of_node(self, uid: int) -> Iterator[tuple[str, Change]]:
        node = self._mission.written[uid]
        below = self._children.get(uid, ())
        if node.flow not in _UNORDERED:
            first = 1 if node.flow == "choice" else 0
            for index, (left, right) in enumerate(pairwise(below)):
                if index >= first and _shape(self._elements[left]) != _shape(self._elements[right]):
                    names = f"{self._name(left)}, {self._name(right)}"
                    yield f"children {index + 1} and {index + 2} ({names}) exchanged", Exchange(index, index + 1)
        if node.category == "Decorator" and len(below) == 1:
            yield "left out", Omission(0)
        if not below and (node.category == "Condition" or (node.kind is not None and node.flow == "answers")):
            yield "inverted", Inversion()
        for attribute in self._elements[uid].attributes:
            name, value = attribute.name, attribute.value
            if name in _SCRIPTS or (name in _CODE and node.kind is not None):
                for other in (*_inverted(name, value), *_other_numbers(value)):
                    yield f'{name}="{other}" instead of "{value}"', OtherScript(name, other)
            elif not (name.startswith("_") or name in _NO_PORTS):
                for other in self._other_values(node, uid, name, value):
                    yield f'{name}="{other}" instead of "{value}"', OtherPort(name, other)

    def _name(self, uid: int) -> str:
        """The name of a written node, also of one in a guard."""
        below = range(uid, self._mission.tree.last[uid] + 1)
        return self._mission.tree.nodes[next((each for each in below if each in self._mission.written), uid)].name

    def _other_values(self, node: ResolvedNode, uid: int, port: str, value: str) -> Iterator[str]:
        """Wrong values of a port: numbers that a built-in counts by, entries of the same tree, texts of its like."""
        if key_of(value, port) is not None:
            yield from _next(self._keys.get((node.path, node.tree), ()), value)
        elif (
            node.behavior is not None
            and (kind := node.behavior.port(port)) is not None
            and kind.role not in ("", "copied")
        ):
            if _NUMBER.fullmatch(value):
                yield from _other_number(value, is_positive=True)
        else:
            yield from _next(self._literals.get((_kind(self._elements[uid]), port), ()), value)


def _values_by(
    mission: ScenarioMission, elements: Mapping[int, Element], *, is_key: bool
) -> dict[tuple[str | None, str | None], list[str]]:
    """The values that are written at ports: entries by tree, others by the kind of the node and the port."""
    values: dict[tuple[str | None, str | None], list[str]] = {}
    for uid, node in mission.written.items():
        for attribute in elements[uid].attributes:
            name, value = attribute.name, attribute.value
            if name.startswith("_") or name in (*_NO_PORTS, *_CODE) or (key_of(value, name) is not None) != is_key:
                continue
            values.setdefault((node.path, node.tree) if is_key else (_kind(elements[uid]), name), []).append(value)
    return {place: sorted(set(texts)) for place, texts in values.items()}


def _next(texts: Sequence[str], text: str) -> Iterator[str]:
    """The text after this one, in a circle, if there is another."""
    if len(texts) > 1 and text in texts:
        yield texts[(texts.index(text) + 1) % len(texts)]


def _kind(element: Element) -> str:
    return element.get("ID") or element.tag


def _shape(element: Element) -> tuple[object, ...]:
    """What an element is, as a value."""
    attributes = tuple((each.name, each.raw) for each in element.attributes)
    return element.tag, attributes, tuple(_shape(child) for child in element.elements)


# ---- scripts and numbers ----


def _inverted(attribute: str, code: str) -> Iterator[str]:
    """The negation of a condition."""
    script = parse_script(code)
    if attribute in _CONDITIONS and len(script.statements) == 1 and not isinstance(script.statements[0], Assign):
        yield f"!({code})"


def _other_numbers(code: str) -> Iterator[str]:
    """A script with another number, for each of its numbers."""
    stack = list(reversed(parse_script(code).statements))
    while stack:
        part = stack.pop()
        stack.extend(reversed(children(part)))
        if isinstance(part, Number):
            for other in _other_number(part.raw, is_positive=False):
                yield f"{code[: part.start]}{other}{code[part.end :]}"


def _other_number(raw: str, *, is_positive: bool) -> Iterator[str]:
    """A smaller and a larger number: small whole ones by 1, others half and double."""
    is_whole = _WHOLE.fullmatch(raw) is not None
    if is_whole and abs(int(raw)) <= _SMALL:
        others = (int(raw) - 1, int(raw) + 1) if int(raw) >= 0 else (1,)
        yield from (str(other) for other in others if other >= 1 or not is_positive)
    elif is_whole:
        yield from (str(int(raw) // 2), str(int(raw) * 2))
    elif _NUMBER.fullmatch(raw):
        yield from (f"{float(raw) / 2:g}", f"{float(raw) * 2:g}")


_UNORDERED: Final = ("", "parallel", "parallel-all", "together", "pause", "recover")  # or each child has its part
_NO_PORTS: Final = ("ID", "name")
_CODE: Final = ("code", "if")
_CONDITIONS: Final = ("_failureIf", "_successIf", "_skipIf", "_while", "if")
_SCRIPTS: Final = ("_failureIf", "_successIf", "_skipIf", "_while", "_onSuccess", "_onFailure", "_post", "_onHalted")
_WHOLE: Final = re.compile(r"-?\d+")
_NUMBER: Final = re.compile(r"-?\d+(?:\.\d*)?(?:[eE][+-]?\d+)?")
_SMALL: Final = 10
