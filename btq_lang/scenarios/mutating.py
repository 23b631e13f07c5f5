"""A loaded tree with a change in it, as a mistake could have made it.

One invariant: all other nodes are as they were, with their numbers and their blackboards.
"""

from __future__ import annotations

from typing import Final, TypeAlias

from btq_lang.simulator.nodes import FAILURE, SUCCESS, Flow, Machine, SimulatedNode
from btq_lang.simulator.ports import key_of
from btq_lang.syntax.script.parser import parse_script
from btq_lang.util.record import Record, replace


class Exchange(Record):
    """Two children change places; their positions."""

    first: int
    second: int


class Omission(Record):
    """A node is left out, and its child at a position takes its place."""

    keeps: int


class Inversion(Record):
    """A leaf returns SUCCESS for FAILURE, and FAILURE for SUCCESS."""


class OtherScript(Record):
    """An attribute has another script."""

    attribute: str
    code: str


class OtherPort(Record):
    """A port has another value."""

    port: str
    value: str


Change: TypeAlias = Exchange | Omission | Inversion | OtherScript | OtherPort


class Mutant(Record):
    """A change of a tree.

    Attributes:
        changes: by the numbers of the nodes.
    """

    changes: tuple[tuple[int, Change], ...]


def mutated(machine: Machine, mutant: Mutant) -> Machine:
    """A machine with a changed tree; the one that was given is not to be used any more."""
    root = _mutated(machine.root, dict(mutant.changes))
    return Machine(root, machine.dialect, machine.program, machine.changes, machine.world)


def _mutated(node: SimulatedNode, changes: dict[int, Change]) -> SimulatedNode:
    change = changes.get(node.uid)
    children = [_mutated(child, changes) for child in node.children]
    if isinstance(change, Omission):
        kept = children[change.keeps]
        kept.conditions[:0] = [each for each in node.conditions if each[0] in _OF_WRAPPED]
        return kept
    if isinstance(change, Exchange):
        children[change.first], children[change.second] = children[change.second], children[change.first]
    rules, ports, board = node.rules, node.ports, node.board
    if isinstance(change, Inversion):
        rules = replace(rules, flow=_inverted(rules.flow))
    if isinstance(change, OtherPort):
        ports = {**ports, change.port: change.value}
    copy = SimulatedNode(node.uid, node.id, node.name, node.path, ports, board, rules)
    copy.conditions.extend(node.conditions)
    copy.scripts.update(node.scripts)
    copy.children.extend(children)
    if isinstance(change, OtherScript):
        script = parse_script(change.code)
        copy.conditions[:] = [(name, script if name == change.attribute else old) for name, old in node.conditions]
        if change.attribute in copy.scripts:
            copy.scripts[change.attribute] = script
    if isinstance(change, OtherPort) and children and children[0].board.parent is board:
        _pass(children[0], change)
    return copy


def _pass(root: SimulatedNode, change: OtherPort) -> None:
    """Pass another value to the tree of a SubTree."""
    key = key_of(change.value, change.port)
    if key is not None:
        root.board.remapped[change.port] = key
    else:
        root.board.entries[change.port].value = change.value


def _inverted(flow: Flow) -> Flow:
    def tick(machine: Machine, node: SimulatedNode) -> int:
        result = flow(machine, node)
        return FAILURE if result == SUCCESS else SUCCESS if result == FAILURE else result

    return tick


_OF_WRAPPED: Final = ("_skipIf", "_while")  # which a wrapper has taken over from the node inside
