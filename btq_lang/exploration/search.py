"""All states of a tree between two ticks, the nearest first, and what can happen on the way.

One invariant: a state is reached by the fewest ticks; the order in which states are found is the same in every run.
A search that ends before its budget has seen every state.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from functools import partial
from itertools import pairwise
from time import process_time
from typing import Final

from btq_lang.exploration.outcomes import ENDED, UNKNOWN, Outcome, Outcomes, OutOfWork, flat
from btq_lang.exploration.snapshots import Memories, Shared, Snapshots
from btq_lang.simulator.nodes import RUNNING, SimulatedNode
from btq_lang.simulator.timers import NEVER, fire
from btq_lang.util.garbage import NotCollecting
from btq_lang.util.reach import knots
from btq_lang.util.record import Record


class SearchBudget(Record):
    """How far to search.

    Attributes:
        states: how many states between two ticks.
        seconds: of processor time; None: any.
    """

    states: int = 100_000
    seconds: float | None = None


class End(Record):
    """How a run can end.

    Attributes:
        result: of the root, or THROWN or UNKNOWN.
        message: of what is thrown, or why it is not known.
    """

    result: int
    message: str


class Search:
    """What has been searched.

    Attributes:
        states: how many.
        is_closed: all states were seen, and in each it is known what happens.
        ends: how runs can end, with the choices of each tick of a shortest run that does.
        way: the choices of each tick of a shortest run to what was asked; None: it was not found.
        edges: for each state the states that a tick can lead to, and how; empty unless they were to be kept.
    """

    def __init__(
        self, snapshots: Snapshots, budget: SearchBudget, keeps_edges: bool = False, counts: bool = True
    ) -> None:
        self._snapshots: Final = snapshots
        self._budget: Final = budget
        self._keeps_edges: Final = keeps_edges
        self._counts: Final = counts
        self.ends: Final[dict[End, Sequence[Sequence[int]]]] = {}
        self.way: Sequence[Sequence[int]] | None = None
        self.is_closed = False
        self.edges: Final[list[list[tuple[int, Outcome]]]] = []
        self._states: Final[list[tuple[Memories, Shared]]] = []
        self._from: Final[list[tuple[int, Outcome | None]]] = []  # for each state, another one and what led from it
        self.current = 0  # the state whose ticks are computed

    @property
    def states(self) -> int:
        return len(self._from)

    def run(self) -> Search:
        """Search until what was asked is found, or there is nothing more, or the budget is spent; itself."""
        with NotCollecting():
            return self._run()

    def _run(self) -> Search:
        snapshots, root = self._snapshots, self._snapshots.machine.root
        limit = None if self._budget.seconds is None else process_time() + self._budget.seconds
        outcomes = Outcomes(snapshots, self._budget.states * _RUNS_A_STATE, limit, self._counts)
        timers: Callable[[], object] = partial(fire_timers, snapshots)
        states = self._states
        states.append((snapshots.memories(root), snapshots.shared()))
        numbers = {states[0]: 0}
        self._from.append((0, None))
        is_unknown = False
        while self.current < len(states):
            memories, shared = states[self.current]
            snapshots.put_back(root, memories)
            snapshots.put_back_shared(shared)
            try:
                results = outcomes.of(root, timers)
            except OutOfWork:
                return self
            following: list[tuple[int, Outcome]] = []
            for outcome in results:
                if outcome.result == ENDED:
                    self.way = self._ways(self.current, outcome)
                    return self
                if outcome.result != RUNNING:
                    is_unknown = is_unknown or outcome.result == UNKNOWN
                    end = End(outcome.result, outcome.message)
                    if end not in self.ends:
                        self.ends[end] = self._ways(self.current, outcome)
                    continue
                state = self._counted_anew(outcome)
                number = numbers.get(state)
                if number is None:
                    if len(states) >= self._budget.states:
                        return self
                    number = numbers[state] = len(states)
                    states.append(state)
                    self._from.append((self.current, outcome))
                following.append((number, outcome))
            if self._keeps_edges:
                self.edges.append(following)
            self.current += 1
        self.is_closed = not is_unknown
        return self

    def _counted_anew(self, outcome: Outcome) -> tuple[Memories, Shared]:
        """The state that an outcome leaves, with writes counted again from the first."""
        snapshots, root = self._snapshots, self._snapshots.machine.root
        if not snapshots.counts_writes:
            return outcome.memories, outcome.shared
        snapshots.put_back(root, outcome.memories)
        snapshots.put_back_shared(outcome.shared)
        snapshots.count_anew()
        return snapshots.memories(root), snapshots.shared()

    def circle(self, leaves: Collection[int]) -> tuple[Sequence[Sequence[int]], Sequence[Sequence[int]]] | None:
        """The choices of a run to a circle, and those of the circle, on which none of some leaves and no timer runs
        for ever; None: there is no such circle among the states that were seen.
        """
        graph = {
            number: [other for other, _ in following if other < len(self.edges)]
            for number, following in enumerate(self.edges)
        }
        nodes = self._snapshots.machine.nodes
        waiting = [at for at, node in enumerate(nodes) if node.uid in leaves or node.rules.is_timed]
        for knot in knots(graph):
            stops = [min((number for number in knot if self._is_over(at, number)), default=None) for at in waiting]
            if None not in stops:
                start = min(knot)
                return self.ways_to(start), self._around([start, *filter(None, stops), start], knot)
        return None

    def _is_over(self, position: int, number: int) -> bool:
        """Whether in a state a leaf does not run, or a timer."""
        status, *_, due, _, _, _ = self._states[number][0][position]
        return bool(status != RUNNING or (self._snapshots.machine.nodes[position].rules.is_timed and due == NEVER))

    def _around(self, stops: Sequence[int], knot: Collection[int]) -> Sequence[Sequence[int]]:
        """The choices of a walk past some states, within a knot."""
        ways: list[Sequence[int]] = []
        for start, stop in pairwise(stops):
            if start != stop or len(stops) == 2:
                ways += self._walk(start, stop, knot)
        return ways or self._walk(stops[0], stops[0], knot)

    def _walk(self, start: int, stop: int, knot: Collection[int]) -> Sequence[Sequence[int]]:
        """The choices of a shortest walk of at least one tick."""
        reached: dict[int, tuple[int, Outcome]] = {}
        waiting = [start]
        for number in waiting:
            for other, outcome in self.edges[number]:
                if other in knot and other not in reached:
                    reached[other] = number, outcome
                    waiting.append(other)
        number, outcome = reached[stop]
        ways = [flat(outcome.log)]
        while number != start:
            number, outcome = reached[number]
            ways.append(flat(outcome.log))
        return ways[::-1]

    def are_together(self, first: int, second: int) -> bool:
        """Whether two nodes run in a state that was seen; `first`, `second`: their positions among all nodes."""
        return any(memories[first][0] == memories[second][0] == RUNNING for memories, _ in self._states)

    def ways_to(self, state: int) -> Sequence[Sequence[int]]:
        """The choices of each tick that leads to a state."""
        logs: list[Sequence[object]] = []
        state, outcome = self._from[state]
        while outcome is not None:
            logs.append(outcome.log)
            state, outcome = self._from[state]
        return [flat(log) for log in reversed(logs)]

    def _ways(self, state: int, outcome: Outcome) -> Sequence[Sequence[int]]:
        return [*self.ways_to(state), flat(outcome.log)]


def fire_timers(snapshots: Snapshots) -> Sequence[SimulatedNode]:
    """Have timers go off between two ticks, those of children before those of parents; their nodes."""
    snapshots.machine.is_woken = False
    fired: list[SimulatedNode] = []
    for node in reversed(snapshots.machine.timed):
        if node.due != NEVER and snapshots.choose(2):
            fire(snapshots.machine, node)
            fired.append(node)
    return fired


_RUNS_A_STATE: Final = 10
