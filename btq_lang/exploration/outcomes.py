"""All that one tick of a node can come to, each result with the state that it leaves.

One invariant: outcomes are those of all choices that leaves, timers and comparisons can make, each once.  What a node
may do is computed from what its children may do, and remembered by the node, its state and that of the entries: so a
tick costs what differs in it, and not the number of its ways.  Ways that lead back to where a tick has been are left
out, for all that follows is reached without the detour.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

from btq_lang.exploration.choices import Choices
from btq_lang.exploration.snapshots import Memories, Shared, Snapshots
from btq_lang.simulator.errors import EngineError, NotModelled
from btq_lang.simulator.nodes import SimulatedNode
from btq_lang.simulator.ports import key_of
from btq_lang.simulator.ticking import tick_itself

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

    def __init__(self, snapshots: Snapshots, most_runs: int) -> None:
        """Begin with nothing remembered; `most_runs`: how many ways are tried before `OutOfWork` is raised."""
        self._snapshots: Final = snapshots
        self._most_runs: Final = most_runs
        self._runs = 0
        self._remembered: dict[tuple[int, Memories, Shared], Sequence[Outcome]] = {}
        self._seen: set[tuple[object, ...]] = set()  # where the ticks of children began in the run that is going on
        endless = [node for node in snapshots.machine.nodes if _is_endless(node)]
        self._uncounted: Final = {node.uid for node in endless}
        self._endless: Final = {child.uid for node in endless for child in node.children}
        snapshots.machine.recall = self._recall

    def of(self, node: SimulatedNode, before: Callable[[], None] | None = None) -> Sequence[Outcome]:
        """What a tick of a node can come to now; `before`: what happens first, which may choose as well."""
        snapshots = self._snapshots
        memories, shared = snapshots.memories(node), snapshots.shared()
        key = node.uid, memories, shared
        remembered = self._remembered.get(key)
        if remembered is not None:
            return remembered
        outer, outer_seen = snapshots.choices, self._seen
        snapshots.choices = choices = Choices()
        outcomes: dict[tuple[object, ...], Outcome] = {}
        is_first = True
        while is_first or choices.next_run():
            if not is_first:
                snapshots.put_back(node, memories)
                snapshots.put_back_shared(shared)
            is_first = False
            outcome = self._run(node, before)
            if outcome is not None:
                outcomes.setdefault((outcome.result, outcome.message, outcome.memories, outcome.shared), outcome)
        snapshots.choices, self._seen = outer, outer_seen
        if len(self._remembered) >= _MOST_REMEMBERED:
            self._remembered.clear()
        result = self._remembered[key] = tuple(outcomes.values())
        return result

    def _run(self, node: SimulatedNode, before: Callable[[], None] | None) -> Outcome | None:
        """What one run comes to; None: it has come back to where it was."""
        self._runs += 1
        if self._runs > self._most_runs:
            raise OutOfWork
        self._seen = set()
        snapshots = self._snapshots
        try:
            if before is not None:
                before()
            result = tick_itself(snapshots.machine, node)
        except Happened:
            return Outcome(ENDED, snapshots.choices.log)
        except EngineError as error:
            return Outcome(THROWN, snapshots.choices.log, message=str(error), is_wrapped=error.is_wrapped)
        except NotModelled as error:
            return Outcome(UNKNOWN, snapshots.choices.log, message=str(error))
        except _CameBack:
            return None
        if node.uid in self._uncounted:
            node.count = 0
        return Outcome(result, snapshots.choices.log, snapshots.memories(node), snapshots.shared())

    def _recall(self, node: SimulatedNode) -> int:
        """Tick a child as one of its outcomes says."""
        snapshots = self._snapshots
        if node.uid in self._endless:
            place = (node.uid, snapshots.memories(node), snapshots.shared())
            if place in self._seen:
                raise _CameBack
            self._seen.add(place)
        if not node.children:
            return tick_itself(snapshots.machine, node)
        outcomes = self.of(node)
        if not outcomes:
            raise _CameBack
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


class _CameBack(Exception):
    """A tick has come back to where it was."""


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


def _is_endless(node: SimulatedNode) -> bool:
    """Whether it may tick its child again and again in one tick, and how often it did so does not matter."""
    written = [node.ports.get(port, "") for port in ("num_cycles", "num_attempts")]
    return any(text.strip() == "-1" and key_of(text, "") is None for text in written)


_MOST_REMEMBERED: Final = 200_000
