"""What the skills of a robot do in a simulated run: their results, durations, answers and writes.

One invariant: a condition is never assumed; an action of which nothing is given succeeds at once, and is listed.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from btq_lang.simulator.blackboard import Value
from btq_lang.simulator.nodes import FAILURE, RUNNING, SUCCESS, Machine, SimulatedNode
from btq_lang.simulator.ports import key_of, read
from btq_lang.simulator.scripts import text_of
from btq_lang.simulator.timers import NEVER
from btq_lang.util.record import Record


class Write(Record):
    """What a skill writes when it ends; key: of an entry, or the port that names the entry."""

    key: str
    value: Value
    type: str


class GivenActivation(Record):
    """What a skill does in one activation, as far as it is given.

    Attributes:
        result: SUCCESS, FAILURE or SKIPPED; RUNNING: it does not end.  None: not given.
        takes: in milliseconds; None: not given.
        writes: at its end; None: not given.
        times: in how many successive activations; 0: in all later ones.
    """

    result: int | None = None
    takes: int | None = None
    writes: tuple[Write, ...] | None = None
    times: int = 0


class GivenSkill(Record):
    """What some nodes do, their activations counted together in the order of their starts.

    Attributes:
        uids: the numbers of the nodes.
        rank: how specific it is; for each aspect the most specific one counts.
        activations: in the order of their starts; the last one repeats.
        answers: of successive ticks of conditions; the last one repeats.
        values: which ports have which values at the start of the activations that it is about.
    """

    uids: frozenset[int]
    rank: int
    activations: tuple[GivenActivation, ...] = ()
    answers: tuple[bool, ...] = ()
    values: tuple[tuple[str, str], ...] = ()

    def concerns(self, node: SimulatedNode) -> bool:
        """Whether it is about the activation of a node that starts now."""
        return node.uid in self.uids and has_values(node, self.values)


def has_values(node: SimulatedNode, values: Iterable[tuple[str, str]]) -> bool:
    """Whether ports of a node have these values now; numbers are compared as such."""
    return all(is_value(value_at(node, port), wanted) for port, wanted in values)


def value_at(node: SimulatedNode, port: str) -> str | None:
    """The value at a port now, as a text; None: there is none."""
    value = read(node, port)
    return f"{value:g}" if isinstance(value, float) else None if value is None else text_of(value)


def is_value(value: str | None, wanted: str) -> bool:
    """Whether the value at a port is the wanted one; numbers are compared as such.  None: there is none."""
    if value is None or value == wanted:
        return value == wanted
    try:
        return float(value) == float(wanted)
    except ValueError:
        return False


class Unanswered(Exception):
    """A condition was asked, and nothing says what it answers.

    Attributes:
        node: the condition.
        at: when, in milliseconds.
    """

    def __init__(self, node: SimulatedNode, at: int) -> None:
        super().__init__(node.path)
        self.node: Final = node
        self.at: Final = at


class Skills:
    """The program of a simulated robot: its custom leaves.

    Attributes:
        assumed: the actions of which nothing was given that have run, by path.
        machine: whose leaves they are; to be set before the first tick.
    """

    def __init__(self, givens: Iterable[GivenSkill], conditions: Iterable[str]) -> None:
        """Take what is given; `conditions`: the registered names of conditions."""
        self.machine: Machine
        self.assumed: Final[set[str]] = set()
        self._givens: Final = sorted(givens, key=lambda given: -given.rank)
        self._conditions: Final = frozenset(conditions)
        self._starts: Final[dict[int, int]] = {}  # by the identity of what is given
        self._asked: Final[dict[int, int]] = {}
        self._open: Final[dict[int, _Activation]] = {}  # by the number of the node

    def add(self, given: GivenSkill) -> None:
        """Take something that is given from now on, which counts before all that is as specific."""
        place = next((place for place, other in enumerate(self._givens) if other.rank <= given.rank), len(self._givens))
        self._givens.insert(place, given)

    def tick(self, node: SimulatedNode) -> int:
        """Tick a skill; its result.

        Raises:
            Unanswered: it is a condition without an answer.
        """
        if node.id in self._conditions:
            return self._answer(node)
        activation = self._open.get(node.uid) if node.status == RUNNING else None
        if activation is None:
            activation = self._open[node.uid] = self._begun(node)
        if activation.end == NEVER or self.machine.now < activation.end:
            return RUNNING
        del self._open[node.uid]
        for write in activation.writes:
            key = key_of(node.ports.get(write.key, ""), write.key) or write.key
            node.board.write(key, write.value, write.type)
        return activation.result

    def halt(self, node: SimulatedNode) -> None:
        """Halt a skill that runs."""
        self._open.pop(node.uid, None)

    def next_change(self, now: int) -> int:
        """When the next skill ends; negative: none will."""
        return min([each.end for each in self._open.values() if each.end > now], default=NEVER)

    def memory(self, now: int = 0) -> object:
        """Which activations are open and when they end, counted from `now`, and how many have begun."""
        ends = [
            (uid, each.end if each.end == NEVER else each.end - now, each.result) for uid, each in self._open.items()
        ]
        return tuple(ends), tuple(self._starts.items()), tuple(self._asked.items())

    def _answer(self, node: SimulatedNode) -> int:
        for given in self._givens:
            if given.answers and given.concerns(node):
                number = min(self._asked.get(id(given), -1) + 1, len(given.answers) - 1)
                self._asked[id(given)] = number
                return SUCCESS if given.answers[number] else FAILURE
        raise Unanswered(node, self.machine.now)

    def _begun(self, node: SimulatedNode) -> _Activation:
        """A new activation: each aspect as the most specific of what is given says."""
        result: int | None = None
        takes: int | None = None
        writes: tuple[Write, ...] | None = None
        is_given = False
        for given in self._givens:
            if not given.activations or not given.concerns(node):
                continue
            is_given = True
            most = sum(activation.times or 1 for activation in given.activations[:-1])
            number = self._starts[id(given)] = min(self._starts.get(id(given), -1) + 1, most)
            of_this = _of_number(given.activations, number)
            result = of_this.result if result is None else result
            takes = of_this.takes if takes is None else takes
            writes = of_this.writes if writes is None else writes
        if not is_given:
            self.assumed.add(node.path)
        end = NEVER if result == RUNNING else self.machine.now + (takes or 0)
        return _Activation(end, SUCCESS if result is None else result, writes or ())


class _Activation(Record):
    """An activation of a skill that runs."""

    end: int
    result: int
    writes: tuple[Write, ...]


def _of_number(activations: tuple[GivenActivation, ...], number: int) -> GivenActivation:
    """What is given of an activation by its number, from 0; the last one repeats."""
    for activation in activations[:-1]:
        if number < (activation.times or 1):
            return activation
        number -= activation.times or 1
    return activations[-1]
