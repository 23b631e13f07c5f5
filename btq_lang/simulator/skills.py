"""What the skills of a robot do in a simulated run: their results, durations, answers and writes.

One invariant: a condition is never assumed; an action of which nothing is given succeeds at once, and is listed.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Final

from btq_lang.simulator.blackboard import UNTYPED, Unknown, Unsaid, Value
from btq_lang.simulator.nodes import FAILURE, RUNNING, SKIPPED, SUCCESS, Machine, SimulatedNode
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
        line: of the scenario that says so.
    """

    uids: frozenset[int]
    rank: int
    activations: tuple[GivenActivation, ...] = ()
    answers: tuple[bool, ...] = ()
    values: tuple[tuple[str, str], ...] = ()
    line: int = 0

    def concerns(self, node: SimulatedNode) -> bool:
        """Whether it is about the activation of a node that starts now."""
        return node.uid in self.uids and has_values(node, self.values)


def has_values(node: SimulatedNode, values: Iterable[tuple[str, str]]) -> bool:
    """Whether ports of a node have these values now; numbers are compared as such."""
    return all(is_value(value_at(node, port), wanted) for port, wanted in values)


def value_at(node: SimulatedNode, port: str) -> str | Unknown | None:
    """The value at a port now, as a text if it is known; None: there is none."""
    value = read(node, port)
    if value is None or isinstance(value, Unknown):
        return value
    return f"{value:g}" if isinstance(value, float) else text_of(value)


def is_value(value: str | Unknown | None, wanted: str) -> bool:
    """Whether the value at a port is the wanted one; numbers are compared as such.  None: there is none.

    Raises:
        NotModelled: it is unknown.
    """
    if isinstance(value, Unknown):
        return value.compared("==", wanted)
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
        applied: the identities of what is given and was about some activation.
        writes: a list to which all that leaves write is added, with the keys of entries; None: it is not noted.
        machine: whose leaves they are; to be set before the first tick.
    """

    def __init__(
        self,
        givens: Iterable[GivenSkill],
        conditions: Iterable[str],
        outputs: Mapping[str, tuple[str, ...]] | None = None,
    ) -> None:
        """Take what is given.

        Args:
            conditions: the registered names of conditions.
            outputs: the ports through which a skill writes, by its registered name, if that is known; without a name
                here it is taken to write into those of its entries that are empty.
        """
        self.machine: Machine
        self.assumed: Final[set[str]] = set()
        self.applied: Final[set[int]] = set()
        self.writes: list[Write] | None = None
        self._givens: Final = sorted(givens, key=lambda given: -given.rank)
        self._conditions: Final = frozenset(conditions)
        self._outputs: Final = outputs
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
            result = self._answer(node)
            given = self._given(node)
            writes = given.writes or () if given is not None else ()
            self._write(node, writes, only_empty=True)
            return result
        activation = self._open.get(node.uid) if node.status == RUNNING else None
        if activation is None:
            activation = self._open[node.uid] = self._begun(node)
        if activation.end == NEVER or self.machine.now < activation.end:
            if not activation.writes:
                self._write(node, only_empty=True)
            return RUNNING
        del self._open[node.uid]
        self._write(node, activation.writes, is_skipped=activation.result == SKIPPED)
        return activation.result

    def has_answer(self, node: SimulatedNode) -> bool:
        """Whether it is given what a node of Nav2 answers that reads the time or the world."""
        return any(given.answers and given.concerns(node) for given in self._givens)

    def answer(self, node: SimulatedNode) -> bool:
        """What such a node answers.

        Raises:
            Unanswered: nothing is given.
        """
        return self._answer(node) == SUCCESS

    def update(self, node: SimulatedNode) -> None:
        """Write the goals that a GoalUpdater has received, which are unknown if they are not given."""
        given = self._given(node)
        if not self.has_answer(node) or self.answer(node):
            self._write(node, given.writes or () if given is not None else ())

    def _write(
        self, node: SimulatedNode, writes: Sequence[Write] = (), only_empty: bool = False, is_skipped: bool = False
    ) -> None:
        result = "answers true" if node.children else "succeeds"
        given = "" if node.id in self._conditions else f"{node.id} {result} and writes"
        written = write_outputs(node, self._outputs, writes, only_empty, is_skipped, given)
        if self.writes is not None:
            self.writes += written

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
                self.applied.add(id(given))
                number = min(self._asked.get(id(given), -1) + 1, len(given.answers) - 1)
                self._asked[id(given)] = number
                return SUCCESS if given.answers[number] else FAILURE
        raise Unanswered(node, self.machine.now)

    def _begun(self, node: SimulatedNode) -> _Activation:
        """A new activation of an action."""
        given = self._given(node)
        if given is None:
            self.assumed.add(node.path)
            given = GivenActivation()
        end = NEVER if given.result == RUNNING else self.machine.now + (given.takes or 0)
        return _Activation(end, SUCCESS if given.result is None else given.result, given.writes or ())

    def _given(self, node: SimulatedNode) -> GivenActivation | None:
        """What is given of a new activation, or of a condition that is asked: each aspect as the most specific says;
        None: nothing."""
        merged: GivenActivation | None = None
        for given in self._givens:
            if not given.activations or not given.concerns(node):
                continue
            self.applied.add(id(given))
            most = sum(activation.times or 1 for activation in given.activations[:-1])
            number = self._starts[id(given)] = min(self._starts.get(id(given), -1) + 1, most)
            of_this = _of_number(given.activations, number)
            merged = merged or GivenActivation()
            merged = GivenActivation(
                of_this.result if merged.result is None else merged.result,
                of_this.takes if merged.takes is None else merged.takes,
                of_this.writes if merged.writes is None else merged.writes,
            )
        return merged


def write_outputs(
    node: SimulatedNode,
    outputs: Mapping[str, tuple[str, ...]] | None,
    writes: Sequence[Write] = (),
    only_empty: bool = False,
    is_skipped: bool = False,
    given: str = "",
) -> Sequence[Write]:
    """Write what a skill writes, and unknown values into the entries of its other outputs; all of it, with the keys of
    entries.

    Args:
        outputs: the ports through which skills write, by their registered names; None: nothing is known of any, and
            only `writes` are written.  A skill without a name here is taken to write into those of its entries that are
            empty.
        writes: of which the values are given.
        only_empty: entries with a value keep it: the readings that a condition copies are given, and a skill that runs
            may write later.  What is given is written where it is another value.
        is_skipped: only what is given is written.
        given: what a scenario gives before `PORT = …` to say an unknown value; as of `Unsaid`.
    """
    keys = [key_of(node.ports.get(write.key, ""), write.key) or write.key for write in writes]
    written: list[Write] = []
    if not is_skipped and outputs is not None:
        written += _unsaid(node, outputs.get(node.id), keys, only_empty, given)
    for key, write in zip(keys, writes, strict=True):
        entry = node.board.entry(key)
        if only_empty and entry is not None and entry.value == write.value:
            continue  # a tick that changes nothing can be passed over
        written.append(Write(key, write.value, write.type))
    for write in written:
        node.board.give(write.key, write.value, write.type)
    return written


def _unsaid(
    node: SimulatedNode, outputs: tuple[str, ...] | None, written: Sequence[str], only_empty: bool, given: str
) -> Iterator[Write]:
    for port in node.ports if outputs is None else outputs:
        key = key_of(node.ports.get(port, ""), port)
        if key is None or key in written:
            continue
        entry = node.board.entry(key)
        is_empty = entry is None or entry.value is None
        if is_empty or not (only_empty or outputs is None):
            value = Unsaid(node.path, key, given and f"{given} {port} = …")
            yield Write(key, value, entry.type if entry is not None else UNTYPED)


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
