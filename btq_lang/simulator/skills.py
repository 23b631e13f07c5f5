"""What the skills of a robot do in a simulated run: their results, durations, answers and writes.

One invariant: a condition is never assumed; an action of which nothing is given succeeds at once, and is listed.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from btq_lang.simulator.blackboard import Value
from btq_lang.simulator.nodes import FAILURE, RUNNING, SUCCESS, Machine, SimulatedNode
from btq_lang.simulator.timers import NEVER
from btq_lang.util.record import Record


class Write(Record):
    """An entry that a skill writes when it ends."""

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
    """

    uids: frozenset[int]
    rank: int
    activations: tuple[GivenActivation, ...] = ()
    answers: tuple[bool, ...] = ()


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
        self._starts: Final[dict[int, int]] = {}  # by the index of what is given
        self._asked: Final[dict[int, int]] = {}
        self._open: Final[dict[int, _Activation]] = {}  # by the number of the node

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
            node.board.write(write.key, write.value, write.type)
        return activation.result

    def halt(self, node: SimulatedNode) -> None:
        """Halt a skill that runs."""
        self._open.pop(node.uid, None)

    def next_change(self, now: int) -> int:
        """When the next skill ends; negative: none will."""
        return min([each.end for each in self._open.values() if each.end > now], default=NEVER)

    def memory(self) -> object:
        """Which activations are open, and how many have begun."""
        return tuple(self._open.items()), tuple(self._starts.items()), tuple(self._asked.items())

    def _answer(self, node: SimulatedNode) -> int:
        for index, given in enumerate(self._givens):
            if given.answers and node.uid in given.uids:
                number = self._asked[index] = self._asked.get(index, -1) + 1
                return SUCCESS if given.answers[min(number, len(given.answers) - 1)] else FAILURE
        raise Unanswered(node, self.machine.now)

    def _begun(self, node: SimulatedNode) -> _Activation:
        """A new activation: each aspect as the most specific of what is given says."""
        result: int | None = None
        takes: int | None = None
        writes: tuple[Write, ...] | None = None
        is_given = False
        for index, given in enumerate(self._givens):
            if not given.activations or node.uid not in given.uids:
                continue
            is_given = True
            number = self._starts[index] = self._starts.get(index, -1) + 1
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
