"""Runs of a mission whose skills do what they draw: the tree is loaded once, and time jumps to what happens next.

One invariant: a run is a function of its seed and number; no run leaves anything to the next but steps that need not be
made again.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Final, Literal, TypeAlias

from btq_lang.evidence.evaluate import NeededNodes
from btq_lang.evidence.model import ROOT, SampleValue
from btq_lang.prediction.remembering import HALT, TICK, Effect, KnownState, RememberedTree, Rows
from btq_lang.prediction.robot import Robot
from btq_lang.prediction.thresholds import look_at_scripts
from btq_lang.prediction.world import Course, LiveValue, crossings
from btq_lang.requirements.model import ResolvedSignal
from btq_lang.scenarios.mission import ScenarioMission
from btq_lang.scenarios.running import why_unknown
from btq_lang.simulator.blackboard import BOOL, DOUBLE, Board, Unknown, Value, type_of
from btq_lang.simulator.errors import EngineError, NotModelled
from btq_lang.simulator.loading import load
from btq_lang.simulator.nav2_answered import set_answered
from btq_lang.simulator.nodes import FAILURE, IDLE, RUNNING, SKIPPED, SUCCESS, Machine, SimulatedNode
from btq_lang.simulator.ports import key_of
from btq_lang.simulator.timers import ENDLESS, NEVER
from btq_lang.util.record import Record

End: TypeAlias = Literal["succeeds", "fails", "is skipped", "does not end", "throws", "unknown"]
Sample: TypeAlias = tuple[int, SampleValue | None]  # when, in µs since the start of the run, and the value


class DrawnRun(Record):
    """What happened in a run.

    Attributes:
        end: how it ended; `throws`: the engine throws an exception.
        why: the message of the engine, or what is not known; empty for other ends.
        now: when it ended, in milliseconds.
        rows: the status changes of the wanted nodes: when, in milliseconds, of which node, and its status. That of a
            run which does not succeed ends with a failure of the root, also where it was halted or the engine threw.
        samples: by signal.
        guessed: the skills that did what was never measured.
    """

    number: int
    end: End
    why: str
    now: int
    rows: Sequence[tuple[int, int, int]]
    samples: Mapping[str, Sequence[Sample]]
    guessed: frozenset[str]


class LoadedRuns:
    """A mission that is loaded and can be run again and again.

    Attributes:
        robot: its program.
        nodes: of the tree, by number from 1.
        limit: a run that has not ended by then, in milliseconds, does not end.
    """

    def __init__(
        self,
        mission: ScenarioMission,
        robot: Robot,
        read: Sequence[ResolvedSignal],
        limit: int,
        needed: NeededNodes | None = None,
    ) -> None:
        """Load the tree.

        Args:
            read: the signals whose samples are wanted.
            needed: the nodes whose rows are wanted; None: all rows of all nodes.

        Raises:
            EngineError: the engine refuses it.
            NotModelled: it has something whose effect is not known.
        """
        self.robot: Final = robot
        self.limit = limit
        self._read: Final = read
        self._courses: Final = {
            signal.name: course
            for signal in read
            for course in robot.courses
            if course.settings.name == signal.name or (signal.entry and course.settings.entry == signal.entry)
        }
        board = mission.program.board()
        for course in robot.courses:
            self._define(board, course)
        arguments = mission.name, mission.dialect, robot, self._changed, board, mission.actions
        self._machine: Final[Machine] = load(mission.documents, *arguments)
        self.nodes: Final = self._machine.nodes
        robot.machine = self._machine
        robot.period = mission.program.driver.period
        for node in self.nodes:
            set_answered(node, robot)
        look_at_scripts(self._machine, robot.courses)
        robot.write_into(_outputs(robot, self._machine, mission.outputs))
        self._is_loaded = False
        entries = [signal.entry for signal in read if signal.entry and signal.name not in self._courses]
        self._entries: Final = [*dict.fromkeys(entries)]
        wanted = needed.all if needed is not None else None
        self._guards: Final = needed.guards if needed is not None else frozenset[int]()
        self._driver: Final = mission.program.driver
        self._tree: Final = RememberedTree(self._machine, self._driver, robot, wanted, self._entries)
        self._is_loaded = True
        self._rows: list[tuple[int, int, int]] = []
        self._values: dict[str, list[Sample]] = {}
        self._last_read: tuple[Value | None, ...] = ()
        self._rates: tuple[float, ...] = ()

    def _define(self, board: Board, course: Course) -> None:
        """Give the root blackboard the entry of a signal of the world."""
        settings = course.settings
        if not settings.entry:
            return
        if settings.is_constant:
            start = int(settings.start) if isinstance(settings.start, bool) else settings.start
            board.define(settings.entry, start, BOOL if isinstance(settings.start, bool) else type_of(start))
        else:
            board.define(settings.entry, self.robot.live[settings.name], DOUBLE)

    def _changed(self, node: SimulatedNode, before: int, after: int) -> None:
        if self._is_loaded:
            self._tree.note(node, before, after)

    # ---- a run ----

    def run(self, seed: int, number: int) -> DrawnRun:
        """Make a run by its number.

        Raises:
            Unanswered: a condition was asked, and nothing says what it answers.
        """
        machine = self._machine
        machine.now = 0
        self._rows, self._values, self._last_read, self._rates = [], {}, (), ()
        self.robot.begin_run(seed, number)
        end: End
        why = ""
        try:
            result = self._driven()
            end = _ENDS.get(result, "does not end")
            if machine.now < self.limit and self._is_cut:
                end, why = "unknown", "it had not ended after very many ticks"
        except EngineError as error:
            end, why = "throws", str(error)
            self._note_rows(self._tree.rows())
        except NotModelled as error:
            end, why = "unknown", why_unknown(machine.nodes, error, has_givens=False)
            self._note_rows(self._tree.rows())
        if end not in ("succeeds", "fails"):
            self._end_root()
        if self._guards:
            self._rows = _without_successes(self._rows, self._guards)
        samples = {signal.name: samples for signal in self._read if (samples := self._samples(signal))}
        guessed = frozenset(self.robot.guessed)
        return DrawnRun(number, end, why, machine.now, self._rows, samples, guessed)

    def _driven(self) -> int:
        """Tick the tree until it has ended; its result, or RUNNING if it does not end.

        As `drive`, which does not remember.
        """
        tree, machine = self._tree, self._machine
        tree.begin()
        state = tree.initial
        self._note_state(state)
        ticks = 0
        self._is_cut = False
        has_jumped = True
        while True:
            effect = tree.step(state, TICK)
            if not effect.is_quiet or effect.rows:
                state = self._noted(effect)
            if effect.result != RUNNING:
                return effect.result
            ticks += 1
            self._is_cut = ticks > _MOST_TICKS
            if machine.now >= self.limit or self._is_cut:
                break
            has_jumped = effect.is_quiet and not has_jumped
            until = self._next_change(machine.now) if has_jumped else machine.now + self._driver.period
            if until == NEVER:
                break
            state = self._asleep(state, until)
            if machine.now > self.limit:
                machine.now = self.limit
                break
        self._noted(tree.step(state, HALT))
        return RUNNING

    def _asleep(self, state: KnownState, until: int) -> KnownState:
        """Let time pass until a time, or until a node wakes up the program; the state then."""
        tree, machine = self._tree, self._machine
        is_woken = False
        while NEVER != tree.wakes <= min(until, self.limit) and not is_woken:
            machine.now = tree.wakes
            for timer in tree.due():
                effect = tree.step(state, timer)
                is_woken = is_woken or effect.is_woken
                state = self._noted(effect)
        if not is_woken:
            machine.now = until
        return state

    def _next_change(self, now: int) -> int:
        """When the program ticks next, if nothing wakes it up before; `NEVER`: nothing will change."""
        change = self.robot.next_change(now)
        for due in (self._tree.wakes, *self._tree.dues[self._tree.timers :]):
            if now < due < ENDLESS and (change == NEVER or due < change):
                change = due
        return self._driver.tick_after(now, change) if change != NEVER else NEVER

    def _noted(self, effect: Effect) -> KnownState:
        """Note what a step did; the state after it."""
        if effect.kept:
            self._last_read = tuple([None if isinstance(each, LiveValue) else each for each in self._last_read])
        if effect.rows:
            self._note_rows(effect.rows)
        state = effect.state
        if state.rates is not self._rates or state.read is not self._last_read:
            self._note_state(state)
        return state

    def _note_rows(self, rows: Rows) -> None:
        now = self._machine.now
        self._rows += [(now, uid, status) for uid, status in rows]

    def _note_state(self, state: KnownState) -> None:
        now = self._machine.now
        if state.rates != self._rates:
            for course, rate in zip(self.robot.courses, state.rates, strict=True):
                course.turn(now, rate)
        self._rates = state.rates
        before = self._last_read or (None,) * len(state.read)
        for key, old, value in zip(self._entries, before, state.read, strict=True):
            if value is not old and value is not None and (old is None or value != old or type(value) is not type(old)):
                self._values.setdefault(key, []).append((now * 1000, _sampled(value)))
        self._last_read = state.read

    def _end_root(self) -> None:
        """Let the root fail: to what is demanded of the mission, no other end than a success is one."""
        rows = self._rows
        place = next((place for place in range(len(rows) - 1, -1, -1) if rows[place][1] == ROOT), None)
        now = self._machine.now
        if place is not None and rows[place][2] == FAILURE:
            return
        if place is not None and rows[place][2] == IDLE:
            del rows[place]
        elif place is None:
            rows.append((now, ROOT, RUNNING))
        rows.append((now, ROOT, FAILURE))

    # ---- what signals were ----

    def _samples(self, signal: ResolvedSignal) -> Sequence[Sample]:
        course = self._courses.get(signal.name)
        end = self._machine.now
        step = max(round(signal.fresh * 1e6), 1) if signal.fresh is not None else 0
        renewals = range(0, end * 1000 + 1, step) if step and end * 1000 // step < _MOST_SAMPLES else range(1)
        if course is None:
            return _renewed(self._values.get(signal.entry, ()), renewals)
        if course.settings.is_constant:
            return [(time, course.settings.start) for time in renewals]
        times = {time * 1000 for time, *_ in self._rows}
        times.update(renewals)
        times.update([time * 1000 for time, *_ in course.pieces])
        times.update([time for _, time in crossings(course.pieces, course.thresholds, end)])
        return _on(course, sorted(times), end)


def _renewed(samples: Sequence[Sample], times: range) -> Sequence[Sample]:
    """The samples, and at some times those before again: a signal that gets out of date is measured that often."""
    if len(times) == 1 or not samples:
        return samples
    by_time = dict(samples)
    renewed: list[Sample] = []
    for time in sorted({*by_time, *times}):
        if time in by_time or renewed:
            renewed.append((time, by_time[time] if time in by_time else renewed[-1][1]))
    return renewed


def _on(course: Course, times: Sequence[int], end: int) -> list[Sample]:
    """The values of a course at times in µs, up to its end in ms."""
    samples: list[Sample] = []
    pieces: Iterator[tuple[int, float, float]] = iter((*course.pieces[1:], (end + 1, 0.0, 0.0)))
    since, value, rate = course.pieces[0]
    until = next(pieces)
    low, high = course.settings.low, course.settings.high
    for time in times:
        at = time / 1000
        while at >= until[0] and until[0] <= end:
            since, value, rate = until
            until = next(pieces)
        level = value + rate * (at - since)
        samples.append((time, low if level < low else high if level > high else level))
    return samples


def _without_successes(rows: Sequence[tuple[int, int, int]], uids: Collection[int]) -> list[tuple[int, int, int]]:
    """The rows without those of activations of some nodes that succeed."""
    kept: list[tuple[int, int, int] | None] = []
    begun: dict[int, int] = {}
    for row in rows:
        _, uid, status = row
        if uid in uids:
            if status == RUNNING:
                begun[uid] = len(kept)
            elif status == SUCCESS and uid in begun:
                kept[begun.pop(uid)] = None
                continue
        kept.append(row)
    return [row for row in kept if row is not None]


def _sampled(value: Value) -> SampleValue | None:
    """A value of an entry as a log has it; None: it is unknown."""
    if isinstance(value, LiveValue):
        return value.value()
    return None if isinstance(value, Unknown) else value


def _outputs(
    robot: Robot, machine: Machine, declared: Mapping[str, tuple[str, ...]]
) -> dict[int, Mapping[str, tuple[str, ...]]]:
    """The ports through which each leaf may write unknown values: not into what the world has, and not what its skill
    says.
    """
    outputs: dict[int, Mapping[str, tuple[str, ...]]] = {}
    root = machine.root.board.root
    of_world = {course.settings.entry for course in robot.courses}
    skills = robot.skills
    for node in machine.nodes:
        own_keys = skills[node.uid].keys if node.uid in skills else ()
        own: list[str] = []
        for port in declared.get(node.id, ()):
            key = key_of(node.ports.get(port, ""), port) or port
            board, name = node.board.home(key)
            if not (port in own_keys or key in own_keys or (board is root and name in of_world)):
                own.append(port)
        if not node.children:
            outputs[node.uid] = {node.id: tuple(own)} if node.id in declared else {}
    return outputs


_ENDS: Final[dict[int, End]] = {SUCCESS: "succeeds", FAILURE: "fails", SKIPPED: "is skipped"}
_MOST_TICKS: Final = 200_000
_MOST_SAMPLES: Final = 100_000
