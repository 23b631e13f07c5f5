"""The program of a drawn run: actions do what their skills draw, and conditions answer by the time and the world.

One invariant: what a leaf does depends on the seed, the run, its own activations before, the time and what its tree
shows it, and on nothing else, so that runs can be made in any order and in any process.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Final, Protocol, TypeAlias

from btq_lang.prediction.skill import DrawnActivation, Skill, Source
from btq_lang.prediction.streams import Stream
from btq_lang.prediction.world import Asker, Course, WorldValue
from btq_lang.simulator.nodes import FAILURE, RUNNING, SKIPPED, SUCCESS, Machine, SimulatedNode
from btq_lang.simulator.skills import Unanswered, write_outputs
from btq_lang.simulator.timers import NEVER

Outcome: TypeAlias = "int | DrawnActivation"  # a result, or more if more than that has an effect


class AnsweringCondition(Protocol):
    """What a condition answers.

    Attributes:
        source: who says so.
        is_timely: the answer may change by the time alone.
    """

    source: Source

    @property
    def is_timely(self) -> bool: ...

    def begin(self, random: Stream) -> None:
        """Begin a run, if it is timely; `random`: the stream of the condition in it."""

    def holds(self, node: SimulatedNode) -> bool:
        """What it answers now; what is not in the state of the tree is asked of the robot."""

    def next_change(self, now: int) -> int:
        """When the answer may change by the time alone, later than `now`; `NEVER`: it does not."""


class Robot:
    """The program of simulated runs.

    Attributes:
        machine: whose leaves it has; to be set before the first run.
        asker: who is asked what is not in the state of the tree.
        courses: the signals of the world.
        period: between two ticks, in milliseconds.
        drawn: how many activations have been drawn in this run.
        guessed: the paths of skills that in this run did what was never measured.
        live: the values of those signals that change, by name.
        halted: the nodes that were halted, where that is put off; None: they are halted at once.
    """

    def __init__(self, courses: Sequence[Course], names: Mapping[int, str]) -> None:
        """Have no leaves yet; `names`: of their streams, by the numbers of nodes."""
        self.machine: Machine
        self.asker: Final = Asker()
        self.courses: Final = courses
        self.drawn = 0
        self.period = 10
        self.guessed: Final[set[str]] = set()
        self.halted: list[int] | None = None
        self._names: Final = names
        self._actions: Final[dict[int, _Action]] = {}
        self._conditions: Final[dict[int, AnsweringCondition]] = {}
        self._timely: Final[dict[int, AnsweringCondition]] = {}
        self._open: Final[dict[int, _Action]] = {}
        self._outputs: Final[dict[int, Mapping[str, tuple[str, ...]]]] = {}
        self._changing: Final = [course for course in courses if not course.settings.is_constant]
        self.live: Final = {
            course.settings.name: WorldValue(self.asker, course, self._now) for course in self._changing
        }

    def _now(self) -> int:
        return self.machine.now

    def have(self, skills: Mapping[int, Skill], conditions: Mapping[int, AnsweringCondition]) -> None:
        """Have leaves, by the numbers of nodes."""
        self._actions.update({uid: _Action(self, uid, skill) for uid, skill in skills.items()})
        self._conditions.update(conditions)
        self._timely.update({uid: each for uid, each in conditions.items() if each.is_timely})

    @property
    def skills(self) -> Mapping[int, Skill]:
        """What draws the activations of actions, by the numbers of the nodes."""
        return {uid: action.skill for uid, action in self._actions.items()}

    def exchange(self, skills: Mapping[int, Skill]) -> None:
        """Give actions other skills from the next run on."""
        for uid, skill in skills.items():
            self._actions[uid].skill = skill

    def write_into(self, outputs: Mapping[int, Mapping[str, tuple[str, ...]]]) -> None:
        """Say into which ports each node may write; as of `write_outputs`."""
        self._outputs.update(outputs)

    def begin_run(self, seed: int, run: int) -> None:
        """Begin a run; its number."""
        self.drawn = 0
        self.guessed.clear()
        self._open.clear()
        for uid, action in self._actions.items():
            action.number = 0
            action.stream = None
            action.key = seed, self._names[uid], run
        for uid, condition in self._timely.items():
            condition.begin(Stream(seed, self._names[uid], run))
        for course in self.courses:
            course.begin()

    # ---- the program ----

    def tick(self, node: SimulatedNode) -> int:
        """Tick a leaf.

        Raises:
            Unanswered: it is a condition, and nothing says what it answers.
        """
        action = self._actions.get(node.uid)
        outputs = self._outputs.get(node.uid)
        if action is None:
            condition = self._conditions.get(node.uid)
            if condition is None:
                raise Unanswered(node, self.machine.now)
            holds = condition.holds(node)
            write_outputs(node, outputs, only_empty=True)
            return SUCCESS if holds else FAILURE
        question = action.go_on if node.status == RUNNING else action.begin
        outcome: Outcome = self.asker.ask(question)  # type: ignore[assignment]  # the answer to such a question
        if outcome == RUNNING:
            write_outputs(node, outputs, only_empty=True)
            return RUNNING
        drawn = _ENDED[outcome] if isinstance(outcome, int) else outcome
        writes = action.skill.writes(node, drawn, self.machine.dialect.has_real_truth) or ()
        write_outputs(node, outputs, writes, is_skipped=drawn.result == SKIPPED)
        return drawn.result

    def has_answer(self, node: SimulatedNode) -> bool:
        """Whether something says what a node of Nav2 answers that reads the time or the world."""
        return node.uid in self._conditions

    def answer(self, node: SimulatedNode) -> bool:
        """What such a node answers.

        Raises:
            Unanswered: nothing says it.
        """
        condition = self._conditions.get(node.uid)
        if condition is None:
            raise Unanswered(node, self.machine.now)
        return condition.holds(node)

    def update(self, node: SimulatedNode) -> None:
        """Write the goals that a GoalUpdater has received, which are unknown."""
        write_outputs(node, self._outputs.get(node.uid))

    def halt(self, node: SimulatedNode) -> None:
        """Halt a leaf that runs."""
        if self.halted is None:
            self._open.pop(node.uid, None)
        else:
            self.halted.append(node.uid)

    def close(self, uids: Sequence[int]) -> None:
        """End activations of nodes that were halted."""
        for uid in uids:
            self._open.pop(uid, None)

    def moves(self, question: object, answer: object) -> bool:
        """Whether a question with this answer begins or ends an activation."""
        action = getattr(question, "__self__", None)
        return isinstance(action, _Action) and (question == action.begin or answer != RUNNING)

    def next_change(self, now: int) -> int:
        """When an activation ends, or a signal or a condition may make something happen."""
        first = NEVER
        for action in self._open.values():
            end = action.end
            if end > now and (first == NEVER or end < first):
                first = end
        for course in self._changing:
            time = course.next_crossing(now)
            if time != NEVER and (first == NEVER or time < first):
                first = time
        for condition in self._timely.values():
            time = condition.next_change(now)
            if time != NEVER and (first == NEVER or time < first):
                first = time
        return first

    def memory(self) -> object:
        """What changes with each activation."""
        return self.drawn, tuple(self._open)


class _Action:
    """An action of the program.

    Attributes:
        skill: what draws its activations.
        number: of the next activation in this run.
        key: of its stream in this run, which is made when it is needed.
        end: when its activation ends; `NEVER`: it does not.
    """

    __slots__ = ("_robot", "_uid", "begin", "end", "go_on", "key", "number", "outcome", "skill", "stream")

    def __init__(self, robot: Robot, uid: int, skill: Skill) -> None:
        self._robot: Final = robot
        self._uid: Final = uid
        self.skill = skill
        self.number = 0
        self.key = (0, "", 0)
        self.stream: Stream | None = None
        self.end = NEVER
        self.outcome: Outcome = RUNNING
        # One object each: questions are compared.
        self.begin: Final[Callable[[], Outcome]] = self._begun
        self.go_on: Final[Callable[[], Outcome]] = self._gone_on

    def _begun(self) -> Outcome:
        """Begin an activation: its outcome if it ends at once, or else RUNNING."""
        stream = self.stream
        if stream is None:
            stream = self.stream = Stream(*self.key)
        robot = self._robot
        drawn = self.skill.draw(stream.activation(self.number))
        self.number += 1
        robot.drawn += 1
        if drawn.is_guess:
            robot.guessed.add(self.key[1])
        if drawn.result == RUNNING:
            self.end = NEVER
        elif takes := _ticks(drawn.takes, robot.period) if self.skill.has_waited else drawn.takes:
            self.end = robot.machine.now + takes
            self.outcome = _outcome(drawn)
        else:
            robot.close((self._uid,))
            return _outcome(drawn)
        robot._open[self._uid] = self
        return RUNNING

    def _gone_on(self) -> Outcome:
        """Its outcome if it ends now, or else RUNNING."""
        if self.end == NEVER or self._robot.machine.now < self.end:
            return RUNNING
        del self._robot._open[self._uid]
        return self.outcome


def _ticks(takes: int, period: int) -> int:
    """A duration to the nearest tick: one of a log already has the time that it waits for its tick."""
    return (takes + period // 2) // period * period


def _outcome(drawn: DrawnActivation) -> Outcome:
    """What of an activation has an effect when it ends: equal ones of skills are asked for as one answer."""
    return DrawnActivation(drawn.result, 0, drawn.writes) if drawn.writes else drawn.result


_ENDED: Final = {result: DrawnActivation(result, 0, ()) for result in (SUCCESS, FAILURE, SKIPPED)}
