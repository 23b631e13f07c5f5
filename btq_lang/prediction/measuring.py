"""Reads what skills did, from logs and from stores.

One invariant: a run counts once, however often it is given, and what a log does not show is left out and counted.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from itertools import groupby
from typing import Final

from btq_lang.evidence.identity import Joined
from btq_lang.evidence.judging import Means, rows_of
from btq_lang.evidence.model import BEGUN_BEFORE, ROOT, Activation, LogSession, SampleSeries, SampleValue
from btq_lang.evidence.named_runs import joined_sessions
from btq_lang.evidence.readers import NotALog, read
from btq_lang.evidence.repeats import LoggedRuns, notes, repeated, without_copies
from btq_lang.evidence.runs import activations
from btq_lang.evidence.store.engine import asked
from btq_lang.evidence.store.rows import node_names
from btq_lang.evidence.store.tables import quoted
from btq_lang.evidence.verdicts import OUTCOMES
from btq_lang.prediction.measured import MeasuredActivation, MeasuredSkills
from btq_lang.requirements.simulation import is_condition, is_skill
from btq_lang.scenarios.mission import ScenarioMission
from btq_lang.simulator.nodes import FAILURE, RUNNING, SUCCESS
from btq_lang.simulator.ports import key_of
from btq_lang.util.record import Record
from btq_lang.workspace.loader import shown


class Measurement(Record):
    """What skills did.

    Attributes:
        skills: in the runs that count.
        foreign: how many runs are of other missions.
        left_out: how many activations are left out, because it is unknown how long they took.
        latest: how many halted ones may have been halted earlier than the log shows.
        problems: why logs could not be read.
        remarks: which runs are there twice.
    """

    skills: MeasuredSkills
    foreign: int = 0
    left_out: int = 0
    latest: int = 0
    problems: tuple[str, ...] = ()
    remarks: tuple[str, ...] = ()


def actions_of(mission: ScenarioMission) -> dict[int, tuple[str, str]]:
    """The name and the kind of each action of a mission, by its number."""
    names = node_names(mission.tree)
    return {
        uid: (names[uid], mission.tree.nodes[uid].kind)
        for uid, node in mission.written.items()
        if is_skill(node) and not is_condition(node)
    }


def measured_in_logs(logs: Sequence[str], mission: ScenarioMission) -> Measurement:
    """What skills did in the runs of a mission that logs hold."""
    means = Means([mission.joined.mission])
    wanted, copies = without_copies(logs)
    reading = _Reading(mission.outputs)
    problems: list[str] = []
    for log in wanted:
        try:
            for _, session, joined in joined_sessions(read(log), means.missions, log):
                reading.read(log, session, joined)
        except NotALog as error:
            problems.append(f"{shown(log)}: {error}")
        except OSError as error:
            problems.append(f"{shown(log)}: cannot be read: {error.strerror or error}")
    repeats = repeated(reading.sessions, partial(rows_of, means=means))
    twice = {(session.log, session.number): runs.keys() for session, runs in repeats}
    counted = [run for key, run in reading.runs if key[2] not in twice.get(key[:2], ())]
    same = [f"{shown(log)} is the same log as {shown(first)}, so it is not counted" for log, first in copies.items()]
    remarks = *same, *notes(repeats, reading.sessions, shown)
    skills = MeasuredSkills(counted)
    return Measurement(skills, reading.foreign, reading.left_out, reading.latest, tuple(problems), remarks)


class _Reading:
    """Reads sessions.

    Attributes:
        sessions: where the runs are.
        runs: the activations in each run, with its log, the number of its session there, and its own in that.
    """

    def __init__(self, outputs: Mapping[str, tuple[str, ...]]) -> None:
        """outputs: the ports through which skills write, by their kinds."""
        self._outputs: Final = outputs
        self.sessions: Final[list[LoggedRuns]] = []
        self.runs: Final[list[tuple[tuple[str, int, int], list[MeasuredActivation]]]] = []
        self.foreign = 0
        self.left_out = 0
        self.latest = 0

    def read(self, log: str, session: LogSession, joined: Joined | str) -> None:
        """Read a session, which is of the mission if it is joined."""
        if isinstance(joined, str):
            self.foreign += sum(activation.uid == ROOT for activation in activations(session))
            return
        number = sum(other.log == log for other in self.sessions)
        runs = LoggedRuns(log, number, (joined.mission.path, None), session.robot)
        self.sessions.append(runs)
        names = _names(joined)
        entries = dict(_entries(joined, self._outputs))
        of_run: list[MeasuredActivation] = []
        for activation in activations(session):
            uid = activation.uid
            if uid in session.tree.leaves and self._is_known(activation):
                writes = _written(activation, entries.get(uid, {}), session.samples)
                result = _RESULTS.get(activation.outcome, RUNNING)
                kind = session.tree.nodes[uid].kind
                of_run.append(MeasuredActivation(names[uid], kind, result, activation.seconds, writes))
            if activation.uid == ROOT:
                self.runs.append(((log, number, len(runs.begins)), of_run))
                runs.add(activation)
                of_run = []

    def _is_known(self, activation: Activation) -> bool:
        """Whether the log shows how long it took, at least."""
        is_known = activation.timing not in _UNKNOWN
        self.left_out += not is_known
        self.latest += activation.timing == "latest"
        return is_known


def _names(joined: Joined) -> dict[int, str]:
    """The names of the nodes in a log: those that they have in the mission, if they are there."""
    names = node_names(joined.tree)
    in_mission = node_names(joined.build.tree())
    return names | {uid: in_mission[number] for number, uid in joined.uids.items() if number in in_mission}


def _entries(joined: Joined, outputs: Mapping[str, tuple[str, ...]]) -> Iterator[tuple[int, dict[str, str]]]:
    """The entries into which the nodes in a log write, by their ports."""
    for instance, _ in joined.build.running.all:
        uid = joined.uids.get(instance.uid or 0)
        ports = outputs.get(joined.tree.nodes[uid].kind, ()) if uid is not None else ()
        keys = {port: key for port in ports if (key := key_of(instance.element.get(port) or "", port)) is not None}
        if uid is not None and keys:
            yield uid, {port: key.removeprefix("@") for port, key in keys.items()}


def _written(
    activation: Activation, entries: Mapping[str, str], samples: Mapping[str, SampleSeries]
) -> tuple[tuple[str, SampleValue], ...]:
    """The values of entries with the row by which an activation ended: an earlier sample may be from before it, and a
    later one from another node.
    """
    values: list[tuple[str, SampleValue]] = []
    for port, key in entries.items():
        sample = samples[key].at(activation.end) if key in samples else None
        if sample is not None and sample[0] == activation.end and sample[1] is not None:
            values.append((port, sample[1]))
    return tuple(values)


def measured_in_store(store: str, name: str, label: str | None = None) -> Measurement:
    """What skills did in the runs of a mission that a store keeps.

    Args:
        name: of the mission, as the store has it.
        label: of the runs that count; None: all.

    Raises:
        NoEngine: DuckDB is missing, or the store has no sets or a damaged one.
    """
    rows = asked(store, label)(_ACTIVATIONS.format(mission=quoted(name)))
    runs: list[list[MeasuredActivation]] = []
    for _, of_run in groupby(rows, key=lambda row: (row["log"], row["run"])):
        runs.append(
            [
                MeasuredActivation(row["node"], row["kind"], _RESULTS.get(row["outcome"], RUNNING), row["us"] / 1e6)
                for row in of_run
                if row["timing"] not in _UNKNOWN
            ]
        )
    left_out = sum(row["timing"] in _UNKNOWN for row in rows)
    latest = sum(row["timing"] == "latest" for row in rows)
    return Measurement(MeasuredSkills(runs), 0, left_out, latest)


_ACTIVATIONS: Final = """
    SELECT log, run, node, kind, outcome, timing, end_us - start_us AS us
    FROM activations
    WHERE leaf AND mission = {mission}
    ORDER BY log, run, start_us, uid, end_us
"""
_UNKNOWN: Final = (*BEGUN_BEFORE, "broken")
_RESULTS: Final = {"S": SUCCESS, "F": FAILURE, OUTCOMES["S"]: SUCCESS, OUTCOMES["F"]: FAILURE}
