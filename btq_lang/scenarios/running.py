"""One run of a scenario: the tree is ticked, the world changes as planned, and what the nodes do is recorded.

One invariant: a run is a function of the plan and the tree; no time but the virtual one passes.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Final, Literal, TypeAlias

from btq_lang.catalog.nodes import BUILTINS
from btq_lang.evidence.conditions import truth
from btq_lang.evidence.history import History, Nearby
from btq_lang.evidence.model import ROOT, LogSession, SampleSeries, Transition
from btq_lang.evidence.observed import Observed
from btq_lang.evidence.signals import Signals, UnknownValue
from btq_lang.requirements.model import Condition, NodeTarget, signals_in
from btq_lang.scenarios.mission import ScenarioMission
from btq_lang.scenarios.mutating import Mutant, mutated
from btq_lang.scenarios.plan import ExpectedValues, Plan, PlannedChange, Set, WatchedEvent
from btq_lang.scenarios.tape import LeafTick, Tape
from btq_lang.scenarios.unused_lines import unused_lines
from btq_lang.simulator.blackboard import BOOL, Unknown, Unsaid, Value, ValueNeeded, type_of
from btq_lang.simulator.drivers import drive, halt_tree
from btq_lang.simulator.errors import EngineError, NotModelled
from btq_lang.simulator.loading import load
from btq_lang.simulator.nav2_answered import set_answered
from btq_lang.simulator.nodes import FAILURE, IDLE, RUNNING, SKIPPED, SUCCESS, Machine, SimulatedNode
from btq_lang.simulator.ports import key_of, read_whole
from btq_lang.simulator.skills import GivenSkill, Skills, Unanswered, Write, is_value, value_at
from btq_lang.syntax.script.tree import variables
from btq_lang.util.record import Record

Known: TypeAlias = Literal["succeeds", "fails", "is skipped", "is halted", "does not end"]
End: TypeAlias = Known | Literal["is refused", "throws", "unanswered", "unknown"]
START: Final = 1_000_000_000_000_000  # the virtual time 0, in µs since the epoch


class Start(Record):
    """The start of a node.

    Attributes:
        at: in milliseconds.
        values: of its ports then, if they are needed.
    """

    uid: int
    at: int
    values: dict[str, str | Unknown | None]


class ScenarioRun(Record):
    """What happened.

    Attributes:
        end: how it ended; `is refused`: the engine does not load the tree; `throws`: the engine throws an exception;
            `unanswered`: a condition was asked of which nothing is given.
        why: the engine's message, the condition, or what is not known; empty for other ends.
        now: when it ended, in milliseconds.
        rows: each change of a status, as a log has it.
        starts: of all nodes, in their order.
        signals: samples by signal.
        entries: samples by entry.
        assumed: the actions of which nothing was given, by path.
        skipped: the nodes that were skipped at some time.
        unused: the lines of the scenario that had no effect, in words.
    """

    end: End
    why: str
    now: int
    rows: Sequence[Transition]
    starts: Sequence[Start]
    signals: dict[str, SampleSeries]
    entries: dict[str, SampleSeries]
    assumed: tuple[str, ...]
    skipped: frozenset[int]
    unused: tuple[str, ...] = ()

    def session(self, mission: ScenarioMission) -> LogSession:
        """The run as a log would hold it, with the begin of each node in a row of its own."""
        rows = with_begins(self.rows, mission.tree.leaves)
        return LogSession(mission.tree, rows, dict(self.entries), signals=self.signals)


def run(mission: ScenarioMission, plan: Plan, mutant: Mutant | None = None, tape: Tape | None = None) -> ScenarioRun:
    """Run a scenario.

    Args:
        mutant: what is changed in the tree before.
        tape: to be filled with what the program does.
    """
    return _Running(mission, plan, mutant, tape).run()


class _Running:
    """A run while it goes on; it is the program that has the custom leaves."""

    def __init__(self, mission: ScenarioMission, plan: Plan, mutant: Mutant | None, tape: Tape | None) -> None:
        self._tape: Final = tape
        self._mission: Final = mission
        self._plan: Final = plan
        self._mutant: Final = mutant
        self._watched: Final = watched(plan)
        self._skills: Final = Skills(plan.givens, mission.conditions, mission.outputs)
        self._board: Final = mission.program.board()
        self._machine: Machine | None = None
        self._nodes: _NodesNow
        self._rows: Final[list[Transition]] = []
        self._starts: Final[list[Start]] = []
        self._of_open: Final[dict[int, Start]] = {}
        self._signals: Final[dict[str, SampleSeries]] = {}
        self._entries: Final[dict[str, SampleSeries]] = {}
        self._waiting: list[PlannedChange] = list(plan.changes)
        self._counts: Final[dict[int, int]] = {}  # of events, by the identity of the change
        self._is_halted = False
        self._ticks = 0
        self._saved: object = None
        self._never_ends = False

    # ---- the program ----

    def tick(self, node: SimulatedNode) -> int:
        """Tick a custom leaf."""
        if node.status != RUNNING:
            self._begin(node)
        return self._skills.tick(node) if self._tape is None else self._taped(node, self._tape)

    def _taped(self, node: SimulatedNode, tape: Tape) -> int:
        """Tick a custom leaf that has begun, and note what it does."""
        sets = tape.taken()
        writes: list[Write] = []
        self._skills.writes = writes
        result = RUNNING
        try:
            result = self._skills.tick(node)
        finally:
            tape.leaf(node.uid, LeafTick(self._skills.machine.now, result, sets, tuple(writes)))
        return result

    def halt(self, node: SimulatedNode) -> None:
        """Halt a custom leaf that runs."""
        self._skills.halt(node)

    def next_change(self, now: int) -> int:
        """When a skill ends or the world changes."""
        times = [change.trigger for change in self._waiting if isinstance(change.trigger, int)]
        ends = self._skills.next_change(now)
        return min([time for time in (*times, ends) if time > now], default=-1)

    def memory(self) -> object:
        """All of it that changes, as a value."""
        return self._skills.memory(), len(self._waiting), tuple(self._counts.items())

    # ---- the run ----

    def run(self) -> ScenarioRun:
        for value in self._plan.entries:
            self._set(value)
        try:
            self._machine = machine = self._loaded()
            self._skills.machine = machine
            if self._tape is not None:
                self._tape.machine = machine
                self._tape.taken()  # what is given before is in the plan
            self._sample()
            result = drive(machine, self._mission.program.driver, _LONGEST, self._is_over)
            return self._ended(machine, result)
        except EngineError as error:
            return self._record("is refused" if self._machine is None else "throws", str(error))
        except NotModelled as error:
            return self._record("unknown", why_unknown(self._machine.nodes if self._machine is not None else (), error))
        except Unanswered as error:
            return self._record("unanswered", error.node.path)

    def _loaded(self) -> Machine:
        arguments = self._mission.name, self._mission.dialect, self, self._changed, self._board, self._mission.actions
        machine = load(self._mission.documents, *arguments)
        for node in machine.nodes:
            set_answered(node, self._skills)
        if self._mutant is not None:
            machine = mutated(machine, self._mutant)
        self._nodes = _NodesNow(machine, self._mission)
        return machine

    def _ended(self, machine: Machine, result: int) -> ScenarioRun:
        if result != RUNNING:
            if self._tape is not None:
                self._tape.look(machine.now)
            self._sample()
            return self._record(_ENDS[result], "")
        if self._tape is not None:
            self._tape.halt(machine.now)
        halt_tree(machine)
        if self._is_halted:
            return self._record("is halted", "")
        if self._never_ends or (machine.now < _LONGEST and self._ticks <= _MOST_LOOKS):
            return self._record("does not end", "")
        return self._record("unknown", "it had not ended after very many ticks")

    def _record(self, end: End, why: str) -> ScenarioRun:
        now = self._machine.now if self._machine is not None else 0
        self._renew(now)
        assumed = tuple(sorted(self._skills.assumed))
        skipped = frozenset(self._machine.skipped if self._machine is not None else ())
        is_told = end in _COMPLETE and self._mutant is None
        unused = self._unused(self._machine) if is_told and self._machine is not None else ()
        happened = self._rows, self._starts, self._signals, self._entries
        return ScenarioRun(end, why, now, *happened, assumed, skipped, unused)

    def _unused(self, machine: Machine) -> tuple[str, ...]:
        started = {start.uid for start in self._starts}
        return unused_lines(self._mission, self._plan, machine, started, self._skills.applied, self._waiting)

    def _is_over(self) -> bool:
        """Let the world change as planned; whether the program ticks no more."""
        machine = self._machine
        assert machine is not None, "it is ticked"
        is_after = self._tape.look(machine.now) if self._tape is not None else False
        self._sample()
        while due := [change for change in self._waiting if self._is_due(change)]:
            for change in due:
                self._apply(change)
            self._sample()
        if self._tape is not None:
            self._tape.pause(machine.now)
        self._ticks += 1
        is_over = self._is_halted or self._ticks > _MOST_LOOKS or self._goes_round(machine)
        if self._tape is not None and not is_over and not is_after:
            self._tape.tick(machine.now)
        return is_over

    def _goes_round(self, machine: Machine) -> bool:
        """Whether all is as it was once before, but for the time, so that it will be so again and again.

        What is remembered to compare with is replaced after twice as many ticks each time.
        """
        if self._ticks < _FIRST_LOOK:
            return False
        state = self._timeless(machine)
        is_planned = any(isinstance(change.trigger, int) for change in self._waiting)
        self._never_ends = state == self._saved and not is_planned
        if self._ticks & (self._ticks - 1) == 0:
            self._saved = state
        return self._never_ends

    def _timeless(self, machine: Machine) -> object:
        """The state, with times from now on."""
        is_woken, _, boards, world, _ = machine.state()
        now = machine.now
        nodes = [_timeless_memory(node, now) for node in machine.nodes]
        return is_woken, nodes, boards, world, self._skills.memory(now), len(self._waiting)

    # ---- what happens ----

    def _changed(self, node: SimulatedNode, before: int, after: int) -> None:
        assert self._machine is not None, "it is ticked"
        now = self._machine.now
        self._rows.append((START + now * 1000, node.uid, after))
        if self._tape is not None:
            self._tape.change(now, node.uid, after)
        if before != RUNNING and after != IDLE and node.uid not in self._of_open:
            self._begin(node)
        if after != RUNNING:
            start = self._of_open.pop(node.uid, None)
            words = _WORDS.get(after, ("halts",) if before == RUNNING else ())
            if start is not None and words:
                self._happen(node, words, start.values)
        if self._tape is not None:
            self._tape.changed()

    def _begin(self, node: SimulatedNode) -> None:
        assert self._machine is not None, "it is ticked"
        ports = node.ports if node.uid in self._watched else ()
        start = Start(node.uid, self._machine.now, {port: value_at(node, port) for port in ports})
        if self._tape is not None and ports:
            self._tape.event(start.at, (node.uid, start.values))
        self._of_open[node.uid] = start
        self._starts.append(start)
        self._happen(node, ("starts",), start.values)

    def _happen(self, node: SimulatedNode, words: tuple[str, ...], values: dict[str, str | Unknown | None]) -> None:
        for change in self._waiting[:]:
            event = change.trigger
            if not isinstance(event, WatchedEvent) or event.word not in words or node.uid not in event.uids:
                continue
            if all(is_value(values.get(port), value) for port, value in event.values):
                self._counts[id(change)] = self._counts.get(id(change), 0) + 1
                if self._counts[id(change)] == event.number:
                    self._apply(change)

    def _is_due(self, change: PlannedChange) -> bool:
        assert self._machine is not None, "it is ticked"
        trigger = change.trigger
        if isinstance(trigger, int):
            return trigger <= self._machine.now
        return not isinstance(trigger, WatchedEvent) and self.holds(trigger)

    def _apply(self, change: PlannedChange) -> None:
        self._waiting.remove(change)
        if isinstance(change.effect, Set):
            self._set(change.effect)
        elif isinstance(change.effect, GivenSkill):
            self._skills.add(change.effect)
        else:
            self._is_halted = True

    # ---- the world ----

    def holds(self, condition: Condition) -> bool:
        """Whether a condition holds now; before the first value of what it reads it does not.

        Raises:
            NotModelled: that depends on what a skill has written.
        """
        assert self._machine is not None, "it is ticked"
        signals = Signals(self._signals, self._entries)
        moment = START + self._machine.now * 1000, 0
        holds = truth(condition, Observed(signals, self._nodes, moment, moment), moment)
        if isinstance(holds, UnknownValue):
            values = dict(self._values())
            for signal in signals_in(condition):
                if isinstance(value := values.get(signal.entry), Unsaid):
                    raise NotModelled(f"a condition after `when` reads `{signal.name}`, and {value.why(signal.name)}")
        return holds is True

    def _set(self, value: Set) -> None:
        now = self._machine.now if self._machine is not None else 0
        if value.signal:
            self._signals.setdefault(value.signal, SampleSeries()).add(START + now * 1000, value.value)
        if not value.key:
            return
        if self._tape is not None:
            self._tape.set(value)
        is_bool = isinstance(value.value, bool)
        written = int(value.value) if isinstance(value.value, bool) else value.value
        entry = self._board.entries.get(value.key)
        if entry is None or not entry.type:
            self._board.define(value.key, written, "")
            self._board.entries[value.key].number += entry.number if entry is not None else 0
        else:
            self._board.give(value.key, written, BOOL if is_bool else type_of(written))

    def _sample(self) -> None:
        """Note the values of entries that are read and have changed."""
        assert self._machine is not None, "it is loaded"
        time = START + self._machine.now * 1000
        for key, value in self._values():
            series = self._entries.get(key)
            sample = None if isinstance(value, Unknown) else value
            if value is None or (series is not None and series.values[-1] == sample):
                continue
            series = self._entries.setdefault(key, SampleSeries())
            series.add(time, sample)
            if self._tape is not None and key in self._board.entries:
                self._tape.event(self._machine.now, (key, sample))
            if isinstance(value, Unsaid):
                read = next((signal.name for signal in self._plan.read if signal.entry == key), "")
                series.lacking = value.why(read)

    def _values(self) -> list[tuple[str, Value | None]]:
        """The entries that are read, on the root blackboard or, if only one other has them, there."""
        values: list[tuple[str, Value | None]] = []
        for key in dict.fromkeys(signal.entry for signal in self._plan.read if signal.entry):
            entry = self._board.entries.get(key)
            if entry is None and self._machine is not None:
                boards = {id(node.board): node.board for node in self._machine.nodes}.values()
                others = [board.entries[key] for board in boards if key in board.entries]
                entry = others[0] if len(others) == 1 else None
            values.append((key, entry.value if entry is not None else None))
        return values

    def _renew(self, now: int) -> None:
        """Measure signals that are out of date after a while as often as that demands."""
        for signal in self._plan.read:
            series = self._signals.get(signal.name) or self._entries.get(signal.entry)
            if signal.fresh is None or series is None:
                continue
            step = max(round(signal.fresh * 1e6), 1)
            times = [*series.times, START + now * 1000]
            if (times[-1] - times[0]) // step < _MOST_SAMPLES:
                for (begin, end), value in zip(pairwise(times), [*series.values], strict=True):
                    for time in range(begin + step, end, step):
                        series.add(time, value)


def why_unknown(nodes: Sequence[SimulatedNode], error: NotModelled, has_givens: bool = True) -> str:
    """What is not known: of the value of an entry, who of some nodes reads and who wrote it; `has_givens`: and what a
    scenario gives to say it.
    """
    reader = next((node for node in nodes if node.uid == error.uid), None)
    if not isinstance(error, ValueNeeded) or not isinstance(error.value, Unsaid) or reader is None:
        return str(error)
    key = _key_read(reader, error.value) or error.value.key
    return f"{reader.path} reads {{{key}}}, and {error.value.why() if has_givens else error.value.fact}"


class _NodesNow(Nearby):
    """Which nodes run now."""

    def __init__(self, machine: Machine, mission: ScenarioMission) -> None:
        super().__init__(ROOT, mission.joined, History())
        self._machine: Final = machine
        self._mission: Final = mission

    def runs(self, target: NodeTarget, moment: object, is_early: bool) -> bool:
        """Whether an instance of a node runs."""
        uids = self._mission.uids(target)
        return any(node.status == RUNNING and node.uid in uids for node in self._machine.nodes)


def with_begins(rows: Sequence[Transition], leaves: frozenset[int]) -> Iterator[Transition]:
    """The rows, with one more where a node that ends at once begins."""
    running: set[int] = set()
    reset = 0  # the node that the row before resets
    for row in rows:
        time, uid, status = row
        # Control nodes of Nav2 write IDLE before their own result.
        is_end = uid in running or (uid == reset and uid not in leaves)
        if status in (SUCCESS, FAILURE) and not is_end:
            yield time, uid, RUNNING
        reset = uid if status == IDLE and uid in running else 0
        yield row
        (running.add if status == RUNNING else running.discard)(uid)


def _timeless_memory(node: SimulatedNode, now: int) -> tuple[object, ...]:
    """What a node remembers, with times from now on, and without the count of a loop that has no last round."""
    status, index, count, skipped, is_on, completed, seen, result, due, *others = node.memory()
    kind = BUILTINS.get(node.id)
    port = kind.port_for("count") if kind is not None else None
    counted = 0 if port is not None and read_whole(node, port.name) == -1 else count
    after = node.due - now if node.due >= 0 else due
    return status, index, counted, skipped, is_on, completed, seen, result, after, *others


def _key_read(node: SimulatedNode, value: Unknown) -> str:
    """The key under which a node reads a value; empty if there is none."""
    scripts = [*(script for _, script in node.conditions), *node.scripts.values()]
    keys = [variable.name for script in scripts for variable in variables(script)]
    keys += [key for port, written in node.ports.items() if (key := key_of(written, port)) is not None]
    entries = ((key, node.board.entry(key)) for key in keys)
    return next((key for key, entry in entries if entry is not None and entry.value == value), "")


def watched(plan: Plan) -> frozenset[int]:
    """The nodes whose ports are expected to have certain values."""
    uids = [change.trigger.uids for change in plan.changes if isinstance(change.trigger, WatchedEvent)]
    uids += [each.expected.uids for each in plan.expectations if isinstance(each.expected, ExpectedValues)]
    return frozenset().union(*uids)


_ENDS: Final[dict[int, Known]] = {SUCCESS: "succeeds", FAILURE: "fails", SKIPPED: "is skipped"}
_COMPLETE: Final = (*_ENDS.values(), "is halted", "does not end")
_WORDS: Final = {SUCCESS: ("succeeds", "finishes"), FAILURE: ("fails", "finishes")}
_LONGEST: Final = 7 * 24 * 3600 * 1000  # ms
_MOST_LOOKS: Final = 100_000  # two a tick
_FIRST_LOOK: Final = 64  # ticks
_MOST_SAMPLES: Final = 100_000
