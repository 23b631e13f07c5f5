"""All that one tick of a node can come to, each result with the state that it leaves.

One invariant: outcomes are those of all choices that leaves, timers and comparisons can make, each once.  What a node
may do is computed from what its children may do, and remembered by the node, its state and that of the entries: so a
tick costs what differs in it, and not the number of its ways.  Ways that lead back to where a tick has been are left
out, for all that follows is reached without the detour.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from time import process_time
from typing import Final, TypeAlias

from btq_lang.exploration.choices import Choices
from btq_lang.exploration.resuming import is_endless, is_resumed, last_count
from btq_lang.exploration.snapshots import Memories, Shared, Snapshots
from btq_lang.simulator.errors import EngineError, NotModelled
from btq_lang.simulator.nodes import SimulatedNode
from btq_lang.simulator.ticking import tick_itself

_Place: TypeAlias = tuple[int, Memories, Shared]  # a node, before its tick or within it
ENDED: Final = 5  # results beside those of nodes: what was asked has happened
THROWN: Final = 6  # the engine throws an exception
UNKNOWN: Final = 7  # what happens is not known


class Happened(Exception):
    """What was asked has happened."""


class OutOfWork(Exception):
    """More would have to be computed than is allowed."""


class Outcome:
    """One thing that a tick can come to.

    Attributes:
        result: of the node, or one of those above.
        message: of what was thrown, or why it is not known.
        is_wrapped: the message names the node.
        memories: of the node and all below it, afterwards.
        shared: what all nodes share, afterwards.
        log: the choices that lead here: numbers, and outcomes of children.
    """

    __slots__ = ("is_wrapped", "log", "memories", "message", "result", "shared")

    def __init__(
        self,
        result: int,
        log: Sequence[object],
        memories: Memories = (),
        shared: Shared = (),
        message: str = "",
        is_wrapped: bool = False,
    ) -> None:
        self.result: Final = result
        self.message: Final = message
        self.memories: Final = memories
        self.shared: Final = shared
        self.is_wrapped: Final = is_wrapped
        self.log: Final = tuple(log)


class Outcomes:
    """Computes outcomes, and remembers them."""

    def __init__(
        self, snapshots: Snapshots, most_runs: int, deadline: float | None = None, counts: bool = True
    ) -> None:
        """Begin with nothing remembered.

        Args:
            counts: Repeat and Retry count; else each time may be their last, so that more can happen than in the
                engine, and nothing less.
            most_runs: how many ways are tried before `OutOfWork` is raised.
            deadline: until when, in seconds of processor time; None: any.
        """
        self._snapshots: Final = snapshots
        self._most_runs: Final = most_runs
        self._deadline: Final = deadline
        self._runs = 0
        self._remembered: Final[dict[_Place, Sequence[Outcome]]] = {}
        self._steps: Final[dict[tuple[bool, _Place], Sequence[Outcome]]] = {}
        nodes = snapshots.machine.nodes
        self._parents: Final = {child.uid: node for node in nodes for child in node.children}
        self._resumed: Final = {node.uid for node in nodes if is_resumed(node)}
        self._uncounted: Final = {node.uid for node in nodes if is_endless(node)}
        self._last: Final = {node.uid: last for node in nodes if not counts and (last := last_count(node))}
        self._kept = 0
        self._running: SimulatedNode | None = None  # whose run goes on
        self._has_ticked = False  # it has ticked a child in this run
        snapshots.machine.recall = self._recall

    def of(self, node: SimulatedNode, before: Callable[[], object] | None = None) -> Sequence[Outcome]:
        """What a tick of a node can come to now; `before`: what happens first, which may choose as well."""
        snapshots = self._snapshots
        start: _Place = (node.uid, snapshots.memories(node), snapshots.shared())
        remembered = self._remembered.get(start)
        if remembered is not None:
            return remembered
        outer, running, has_ticked = snapshots.choices, self._running, self._has_ticked
        outcomes: dict[tuple[object, ...], Outcome] = {}
        places: list[tuple[_Place, Outcome | None]] = [(start, None)]
        reached = {start}
        for place, way in places:
            for step in self._steps_from(node, place, before if way is None else None, goes_on=way is not None):
                if step.result == _GOES_ON:
                    following: _Place = (node.uid, step.memories, step.shared)
                    if following not in reached:
                        reached.add(following)
                        places.append((following, _joined(way, step)))
                    continue
                key = (step.result, step.message, step.memories, step.shared)
                if key not in outcomes:
                    outcomes[key] = _joined(way, step)
        snapshots.choices, self._running, self._has_ticked = outer, running, has_ticked
        self._kept += len(outcomes)
        if self._kept > _MOST_KEPT:
            self._kept = 0
            self._remembered.clear()
            self._steps.clear()
        result = self._remembered[start] = tuple(outcomes.values())
        return result

    def _steps_from(
        self, node: SimulatedNode, place: _Place, before: Callable[[], object] | None, goes_on: bool
    ) -> Sequence[Outcome]:
        """What a tick comes to until it would tick a second child, if its flow can go on there, or ends."""
        is_resumed = node.uid in self._resumed
        if is_resumed and (steps := self._steps.get((goes_on, place))) is not None:
            return steps
        snapshots = self._snapshots
        _, memories, shared = place
        choices = Choices()
        outcomes: dict[tuple[object, ...], Outcome] = {}
        has_more = True
        while has_more:
            snapshots.put_back(node, memories)
            snapshots.put_back_shared(shared)
            snapshots.choices, self._running, self._has_ticked = choices, node, False
            outcome = self._run(node, before, goes_on)
            outcomes.setdefault((outcome.result, outcome.message, outcome.memories, outcome.shared), outcome)
            has_more = choices.next_run()
        steps = tuple(outcomes.values())
        if is_resumed:
            self._kept += len(steps)
            self._steps[goes_on, place] = steps
        return steps

    def _run(self, node: SimulatedNode, before: Callable[[], object] | None, goes_on: bool) -> Outcome:
        """What one run comes to."""
        self._runs += 1
        if self._runs > self._most_runs:
            raise OutOfWork
        if self._deadline is not None and self._runs % _CLOCK_PERIOD == 0 and process_time() > self._deadline:
            raise OutOfWork
        snapshots = self._snapshots
        try:
            if before is not None:
                before()
            if node.index == 0 and node.uid in self._last and snapshots.choose(2):
                node.count = self._last[node.uid]
            result = tick_itself(snapshots.machine, node, goes_on)
        except Happened:
            return Outcome(ENDED, snapshots.choices.log)
        except EngineError as error:
            return Outcome(THROWN, snapshots.choices.log, message=str(error), is_wrapped=error.is_wrapped)
        except NotModelled as error:
            return Outcome(UNKNOWN, snapshots.choices.log, message=str(error))
        except _GoesOn:
            result = _GOES_ON
        if node.uid in self._uncounted or node.uid in self._last:
            node.count = 0
        return Outcome(result, snapshots.choices.log, snapshots.memories(node), snapshots.shared())

    def _recall(self, node: SimulatedNode) -> int:
        """Tick a child as one of its outcomes says."""
        snapshots = self._snapshots
        running = self._running
        if running is not None and running.uid in self._resumed and self._parents.get(node.uid) is running:
            if self._has_ticked:
                raise _GoesOn
            self._has_ticked = True
        if not node.children:
            return tick_itself(snapshots.machine, node)
        outcomes = self.of(node)
        if not outcomes:
            raise NotModelled(f"{node.path} goes on without an end in one tick")
        choices = snapshots.choices
        outcome = outcomes[choices.pick(len(outcomes))]
        choices.log.append(outcome)
        if outcome.result == ENDED:
            raise Happened
        if outcome.result == THROWN:
            raise EngineError(outcome.message, outcome.is_wrapped)
        if outcome.result == UNKNOWN:
            raise NotModelled(outcome.message)
        snapshots.put_back(node, outcome.memories)
        snapshots.put_back_shared(outcome.shared)
        return outcome.result


class _GoesOn(Exception):
    """A tick has come to its second child."""


def _joined(way: Outcome | None, step: Outcome) -> Outcome:
    """What a step comes to, after others."""
    if way is None:
        return step
    return Outcome(step.result, (way, step), step.memories, step.shared, step.message, step.is_wrapped)


def flat(log: Sequence[object]) -> list[int]:
    """The choices of a log in the order in which a tick makes them that remembers nothing."""
    choices: list[int] = []
    stack = list(reversed(log))
    while stack:
        item = stack.pop()
        if isinstance(item, Outcome):
            stack += reversed(item.log)
        else:
            assert isinstance(item, int)
            choices.append(item)
    return choices


_GOES_ON: Final = 8
_CLOCK_PERIOD: Final = 256  # runs between two looks at the clock, which may take longer than a run
_MOST_KEPT: Final = 300_000  # outcomes, of a kilobyte in a large tree
