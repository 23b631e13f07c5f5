"""Steps of a simulated tree that are made once: from the same state, with the same answers, the same happens again.

A step is a tick, or a timer that goes off.  What it does is known by the questions that it asks, of skills, conditions
and numbers that belong to the run, each with what follows on each answer: a tree of questions whose leaves are effects.

One invariant: an effect is what the simulator itself did; the simulator makes each step for which there is none yet.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from functools import partial
from typing import Any, Final, TypeAlias

from btq_lang.prediction.robot import Robot
from btq_lang.prediction.states import StateKey, States
from btq_lang.prediction.world import KeptValue, LiveValue
from btq_lang.simulator.blackboard import Value
from btq_lang.simulator.drivers import halt_tree, tick_of
from btq_lang.simulator.nodes import FAILURE, IDLE, RUNNING, SUCCESS, Machine, SimulatedNode
from btq_lang.simulator.timers import NEVER, fire
from btq_lang.workspace.project_driver import Driver

Question: TypeAlias = Callable[[], object]
Rows: TypeAlias = list[tuple[int, int]]  # a node, and its new status
TICK: Final = -1  # a step; of a timer that goes off, its number
HALT: Final = -2


class KnownState:
    """A state with the steps from it that have been made.

    Attributes:
        steps: by their numbers, the first question of each, or its effect.
        rates: of the signals of the world, per second.
        read: the values of entries that signals read, in the order of `RememberedTree.read`.
    """

    __slots__ = ("key", "rates", "read", "steps")

    def __init__(self, key: StateKey, rates: tuple[float, ...], read: tuple[Value | None, ...]) -> None:
        self.key: Final = key
        self.rates: Final = rates
        self.read: Final = read
        self.steps: Final[dict[int, _Asked | Effect]] = {}


class Effect:
    """What a step does.

    Attributes:
        result: of a tick; RUNNING after others.
        state: after it.
        rows: the status changes of the nodes whose rows are wanted.
        halted: the leaves whose activations were halted and not begun again.
        timers: of each that was started or stopped its number, and how long it runs; `NEVER`: it does not.
        kept: the entries that were given a number that belongs to the run, each with that number.
        is_quiet: nothing has changed, so that the same step does the same until something else happens.
        is_woken: it wakes up the program, which ticks then.
    """

    __slots__ = ("halted", "is_quiet", "is_woken", "kept", "result", "rows", "state", "timers")

    def __init__(
        self,
        result: int,
        state: KnownState,
        rows: Rows,
        halted: Sequence[int],
        timers: Sequence[tuple[int, int]],
        kept: Sequence[tuple[KeptValue, LiveValue]],
        is_quiet: bool,
        is_woken: bool,
    ) -> None:
        self.result: Final = result
        self.state: Final = state
        self.rows: Final = rows
        self.halted: Final = halted
        self.timers: Final = timers
        self.kept: Final = kept
        self.is_quiet: Final = is_quiet
        self.is_woken: Final = is_woken


class _Asked:
    """A question, and what comes after each answer."""

    __slots__ = ("answers", "question")

    def __init__(self, question: Question) -> None:
        self.question: Final = question
        self.answers: Final[dict[object, _Asked | Effect]] = {}


class RememberedTree:
    """A loaded tree whose steps are remembered.

    Attributes:
        initial: its state before the first tick.
        dues: when each timer goes off in the run that goes on, in milliseconds; then, when the time has passed for
            which a node waits without one.
        timers: how many of these are timers.
        wakes: when the next timer goes off; `NEVER`: none runs.
        read: the entries that signals read.
    """

    def __init__(
        self, machine: Machine, driver: Driver, robot: Robot, wanted: Collection[int] | None, read: Sequence[str]
    ) -> None:
        """Remember nothing yet.

        Args:
            wanted: the nodes whose rows are wanted; None: all rows of all nodes.
            read: the entries that signals read.
        """
        self.machine: Final = machine
        self.read: Final = read
        self._robot: Final = robot
        self._tick: Final = tick_of(driver)
        self._wakes_up: Final = driver.is_woken
        self._states: Final = States(machine, robot.asker)
        self._timed: Final = self._states.timed
        self._known: Final[dict[StateKey, KnownState]] = {}
        self._wanted: Final = wanted
        self._waits: Final = {node.uid: partial(self._has_passed, timer) for timer, node in enumerate(self._timed)}
        self._shared: Final[dict[tuple[Any, ...], tuple[Any, ...]]] = {}  # equal ones of states are the same
        self._size = 0
        self._changes: Final[list[tuple[SimulatedNode, int, int]]] = []
        self.dues: Final[list[int]] = [NEVER] * len(self._timed)
        self.timers: Final = len(machine.timed)
        self.wakes = NEVER
        machine.passed = self._passed
        self.initial: Final = self._state()

    def note(self, node: SimulatedNode, before: int, after: int) -> None:
        """A status has changed; for the machine to call."""
        self._changes.append((node, before, after))

    def begin(self) -> None:
        """Begin a run: no timer runs."""
        self.dues[:] = [NEVER] * len(self.dues)
        self.wakes = NEVER

    def due(self) -> Iterator[int]:
        """The timers that go off now, each as long as the one before has not stopped it."""
        dues = self.dues
        for timer in range(self.timers):
            if dues[timer] == self.machine.now:
                dues[timer] = NEVER
                yield timer
        self._look_at_timers()

    def _look_at_timers(self) -> None:
        self.wakes = min([due for due in self.dues[: self.timers] if due != NEVER], default=NEVER)

    def step(self, state: KnownState, number: int) -> Effect:
        """Make a step; all that belongs to the run is changed with it.

        Raises:
            EngineError, NotModelled, Unanswered: as the simulator does; the run is over.
        """
        place = state.steps.get(number)
        answers: list[object] = []
        while place.__class__ is _Asked:
            answer = place.question()
            answers.append(answer)
            place = place.answers.get(answer)
        effect: Effect = place if place is not None else self._made(state, number, answers)  # type: ignore[assignment]  # mypy does not narrow by `__class__`
        if effect.halted:
            self._robot.close(effect.halted)
        if effect.timers:
            now, dues = self.machine.now, self.dues
            for timer, wait in effect.timers:
                dues[timer] = now + wait if wait != NEVER else NEVER
            self._look_at_timers()
        if effect.kept:
            values = [value.value() for _, value in effect.kept]
            for (own, _), value in zip(effect.kept, values, strict=True):
                own.kept = value
        return effect

    def _passed(self, node: SimulatedNode) -> bool:
        """Whether the time has passed for which a node waits: a question, unless it has begun to wait in this step."""
        return (
            bool(self._robot.asker.ask(self._waits[node.uid])) if node.due >= _ARMED else node.due <= self.machine.now
        )

    def _has_passed(self, timer: int) -> bool:
        return self.dues[timer] <= self.machine.now

    def _made(self, state: KnownState, number: int, answers: list[object]) -> Effect:
        """The effect of a step by the simulator, after some questions have been answered."""
        machine, robot = self.machine, self._robot
        armed = [_ARMED + timer if due != NEVER else NEVER for timer, due in enumerate(self.dues)]
        self._states.put_back(state.key, armed)
        self._changes.clear()
        asked: list[tuple[Question, object]] = []

        def ask(question: Question) -> object:
            place = len(asked)
            answer = answers[place] if place < len(answers) else question()
            asked.append((question, answer))
            return answer

        direct, robot.asker.ask, robot.halted = robot.asker.ask, ask, []
        try:
            result = RUNNING
            if number == TICK:
                result = self._tick(machine)
            elif number == HALT:
                halt_tree(machine)
            else:
                fire(machine, self._timed[number])
            halted = [uid for uid in dict.fromkeys(robot.halted) if machine.nodes[uid - 1].status != RUNNING]
            kept = self._states.keep_values()
            is_woken = self._wakes_up and machine.is_woken
            machine.is_woken = machine.is_woken and not is_woken
        finally:
            robot.asker.ask, robot.halted = direct, None
        dues = [node.due for node in self._timed]
        timers = [
            (timer, due - machine.now if due != NEVER else NEVER)
            for timer, (due, before) in enumerate(zip(dues, armed, strict=True))
            if due != before
        ]
        after = self._state()
        has_moved = timers or kept or halted or any(robot.moves(*each) for each in asked)
        is_quiet = not has_moved and (after is state or after.key == state.key)
        effect = Effect(result, after, self.rows(), halted, timers, kept, is_quiet, is_woken)
        if self._size < _MOST:
            self._remember(state, number, asked, effect)
        return effect

    def _remember(
        self, state: KnownState, number: int, asked: Sequence[tuple[Question, object]], effect: Effect
    ) -> None:
        self._size += len(asked) + 1
        level: dict[Any, _Asked | Effect] = state.steps
        key: object = number
        for question, answer in asked:
            place = level.get(key)
            if not isinstance(place, _Asked):
                place = level[key] = _Asked(question)
            level, key = place.answers, answer
        level[key] = effect

    def _state(self) -> KnownState:
        key = self._states.key()
        state = self._known.get(key)
        if state is None:
            running = {node.uid for node in self.machine.nodes if node.status == RUNNING}
            rates = tuple([course.settings.rate_with(running) for course in self._robot.courses])
            read = tuple([self._entry(name) for name in self.read])
            state = KnownState(key, self._shared.setdefault(rates, rates), self._shared.setdefault(read, read))
            if self._size < _MOST:
                self._known[key] = state
        return state

    def _entry(self, name: str) -> Value | None:
        """The value of an entry on the root blackboard or, if only one other has it, there."""
        root, *others = self._states.boards
        if (entry := root.entries.get(name)) is not None:
            return entry.value
        values = [board.entries[name].value for board in others if name in board.entries]
        return values[0] if len(values) == 1 else None

    def rows(self) -> Rows:
        """The wanted rows of the last step that the simulator made.

        If not all are wanted, a node that ends at once has one more, of its begin, as `with_begins` writes it.
        """
        rows: Rows = []
        reset = 0  # the node that the row before resets
        for node, before, after in self._changes:
            uid = node.uid
            # Control nodes of Nav2 write IDLE before their own result.
            is_end = before == RUNNING or (uid == reset and bool(node.children))
            reset = uid if after == IDLE and before == RUNNING else 0
            if self._wanted is None or uid in self._wanted:
                if after in (SUCCESS, FAILURE) and not is_end and self._wanted is not None:
                    rows.append((uid, RUNNING))
                if self._wanted is None or after != IDLE or before == RUNNING:
                    rows.append((uid, after))
        return rows


_ARMED: Final = 1 << 60  # ms: what a step does depends on no such time
_MOST: Final = 1_000_000  # questions and effects that are remembered
