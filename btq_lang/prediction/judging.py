"""Drawn runs judged by the evaluator of `btq verify`, as sessions of one log.

One invariant: a block of runs is judged by itself, so that blocks may be judged in any process and added up in order.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Final

from btq_lang.evidence.evaluate import LogFindings, MissionEvaluation
from btq_lang.evidence.identity import Candidate, Joined
from btq_lang.evidence.model import LogSession, SampleSeries, Transition
from btq_lang.evidence.odds import Limits
from btq_lang.prediction.prepared import PreparedMission
from btq_lang.prediction.runs import DrawnRun
from btq_lang.scenarios.mission import ScenarioMission
from btq_lang.scenarios.running import START
from btq_lang.util.record import Record


class JudgedBlock(Record):
    """What came of some runs.

    Attributes:
        runs: how many.
        judged: how many of them were judged: not those of which something is unknown.
        findings: of these, numbered from 1.
        ends: how they ended, and how many.
        why: why runs are unknown or threw an exception, and how many.
        guessed: in how many runs each skill did what was never measured.
        numbers: of the runs that were judged, in order.
        times: how long those took that succeeded, in milliseconds.
    """

    runs: int
    judged: int
    findings: LogFindings
    ends: Counter[str]
    why: Counter[tuple[str, str]]
    guessed: Counter[str]
    numbers: tuple[int, ...]
    times: tuple[int, ...]


class Judge:
    """Judges the runs of a mission."""

    def __init__(self, mission: ScenarioMission, limits: Limits = "one look") -> None:
        """limits: which limits of probabilities decide."""
        self.candidate: Candidate
        self.joined: Joined
        self.candidate, self.joined = mission.judged_with(mission.requirements)
        self._limits: Final[Limits] = limits
        self._mission: Final = mission
        self._keys: Final = {name: signal.entry for name, signal in mission.requirements.signals.items()}

    def evaluation(self) -> MissionEvaluation:
        """One that has judged nothing yet."""
        return MissionEvaluation(self.candidate, limits=self._limits)

    def block(self, prepared: PreparedMission, seed: int, numbers: Sequence[int]) -> JudgedBlock:
        """Make runs by their numbers, and judge them.

        Raises:
            Unanswered: a condition was asked, and nothing says what it answers.
        """
        ends: Counter[str] = Counter()
        why: Counter[tuple[str, str]] = Counter()
        guessed: Counter[str] = Counter()
        judged: list[int] = []
        times: list[int] = []

        def runs() -> Iterator[DrawnRun]:
            for number in numbers:
                run = prepared.loaded.run(seed, number)
                ends[run.end] += 1
                guessed.update(run.guessed)
                if run.why:
                    why[run.end, run.why] += 1
                if run.end == "succeeds":
                    times.append(run.now)
                if run.end != "unknown":
                    judged.append(number)
                    yield run

        evaluation = self.evaluation()
        self.read(evaluation, runs())
        return JudgedBlock(
            len(numbers), len(judged), evaluation.findings, ends, why, guessed, tuple(judged), tuple(times)
        )

    def read(self, evaluation: MissionEvaluation, runs: Iterator[DrawnRun]) -> None:
        """Judge runs one after the other."""
        logged: dict[str, SampleSeries] = {}
        given: dict[str, SampleSeries] = {}
        session = LogSession(self._mission.tree, self._rows(runs, logged, given), logged)
        evaluation.read(session, self.joined, given, 1, _SOURCE)

    def _rows(
        self, runs: Iterator[DrawnRun], logged: dict[str, SampleSeries], given: dict[str, SampleSeries]
    ) -> Iterator[Transition]:
        """The rows of runs, each of which begins when the one before has ended; their samples are added meanwhile."""
        begin = START
        for run in runs:
            for series in given.values():
                series.forget_before(begin - 1)
            for name, samples in run.samples.items():
                key = self._keys.get(name)
                series = (logged if key else given).setdefault(key or name, SampleSeries())
                times, values = series.times, series.values
                times.extend([begin + time for time, _ in samples])
                values.extend([value for _, value in samples])
            for time, uid, status in run.rows:
                yield begin + time * 1000, uid, status
            begin += (run.now + _BETWEEN) * 1000


_SOURCE: Final = "simulated runs"
_BETWEEN: Final = 1000  # ms between two runs
