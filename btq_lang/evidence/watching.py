"""A running robot: verdicts reported as they fall, and those so far at any time.

One invariant: what is reported comes from the evaluation that judges logs; nothing is judged here.
"""

from __future__ import annotations

import secrets
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, Final

from btq_lang.evidence.clause import JudgedClause
from btq_lang.evidence.clause_findings import verdict_of
from btq_lang.evidence.model import GAP, PLACES, ROOT, RUNNING, Activation, LogSession, Moment, NamedLog, Transition
from btq_lang.evidence.sentences import result
from btq_lang.evidence.tally import Run
from btq_lang.evidence.verbs import Judgement
from btq_lang.evidence.verdicts import NEVER, OUTCOMES, VIOLATED, RequirementVerdict, Verdict
from btq_lang.evidence.wording import duration, measured
from btq_lang.util.record import Record

if TYPE_CHECKING:
    from btq_lang.evidence.evaluate import MissionEvaluation
    from btq_lang.evidence.identity import Joined


class News(Record):
    """Something that has just happened.

    Attributes:
        time: on the robot's clock, in µs since the epoch; None: now.
        verdict: that has fallen; None for other news.
    """

    time: int | None
    verdict: Verdict | None
    text: str


class Watched:
    """A running robot whose transitions are judged as they come.

    Attributes:
        id: unique to these runs, in 64 hexadecimal digits.
        sessions: they end when the robot is no longer watched.
        address: of the robot.
        mission: what the current session is, in words; empty without one.
        outcomes: how many runs ended in which way.
    """

    def __init__(self, sessions: Iterable[LogSession | NamedLog], address: str, tell: Callable[[News], None]) -> None:
        self.id: Final = secrets.token_hex(32)
        self.sessions: Final = map(self._followed, sessions)
        self.mission = ""
        self.address: Final = address
        self._tell: Final = tell
        self._missions: Final[list[tuple[MissionEvaluation, _Listener]]] = []
        self.outcomes: Final[Counter[str]] = Counter()
        self._listener: _Listener | None = None  # of the current session
        self._open: Final[dict[int, Moment]] = {}  # when each active node wrote that it is
        self._rows = 0  # of the current session

    def judged_by(self, evaluation: MissionEvaluation) -> None:
        """Tell what the evaluation of a mission finds; the mission has judged no session before."""
        listener = _Listener(self)
        self._missions.append((evaluation, listener))
        evaluation.listeners.append(listener)

    def foreign(self, difference: str) -> None:
        """Tell that the next session belongs to no mission; `difference`: as in `Foreign`."""
        self.mission = ""
        self.tell(f"its tree belongs to no known mission{f': {difference}' if difference else ''}; it is not judged")

    def enter(self, listener: _Listener, mission: str) -> None:
        """Begin a session of a mission, and tell which, unless the session before was of the same."""
        self._listener = listener
        if mission != self.mission:
            self.mission = mission
            self.tell(mission)

    def look(self, time: int) -> None:
        """Tell which clauses are broken by nodes that are still active.

        Args:
            time: until when all that the robot did is known.
        """
        active = [Activation(uid, began, (time, self._rows), "O") for uid, began in self._open.items()]
        for activation in active:
            if self._listener is not None:
                self._listener.look(activation)
        root = next((activation for activation in active if activation.uid == ROOT), None)
        if self._listener is not None and root is not None:
            self._listener.look_over(root, active)

    def so_far(self) -> Iterator[tuple[RequirementVerdict, ...]]:
        """The verdicts of each mission that was judged, including the open run."""
        for evaluation, listener in self._missions:
            yield evaluation.verdicts(listener.open_run())

    def _followed(self, session: LogSession | NamedLog) -> LogSession | NamedLog:
        """The session, with transitions that are noted while they are read."""
        if not isinstance(session, LogSession):
            return session
        self._listener = None
        noted = self._noted(session)
        return LogSession(session.tree, noted, session.samples, session.remarks, session.signals, session.robot)

    def _noted(self, session: LogSession) -> Iterator[Transition]:
        last, latest = session.tree.last, 0
        self._open.clear()
        for number, row in enumerate(session.transitions, 1):
            self._rows = number * PLACES
            time, uid, status = row
            if uid is GAP or (uid in last and time < latest):  # who is active is unknown, or since when
                self._open.clear()
            if uid in last:
                latest = time
                for open_uid in [open_uid for open_uid in self._open if uid <= open_uid <= last[uid]]:
                    del self._open[open_uid]
                if status == RUNNING:
                    self._open[uid] = time, self._rows
            yield row

    def tell(self, text: str, time: int | None = None, verdict: Verdict | None = None) -> None:
        """Tell something."""
        self._tell(News(time, verdict, text))


class _Listener:
    """Tells what an evaluation finds while a mission is judged."""

    def __init__(self, watched: Watched) -> None:
        self._watched: Final = watched
        self._clauses: Final[dict[JudgedClause, Verdict]] = {}  # each with the verdict last reported
        self._paths: dict[int, str] = {}
        self._begin: int | None = None  # of the open run
        self._end = 0

    def join(self, joined: Joined, clauses: Sequence[JudgedClause]) -> None:
        watched = self._watched
        self._paths = {node.uid: node.path for node in joined.tree.nodes.values()}
        nodes = f"{joined.number} of {len(self._paths)} nodes"
        watched.enter(self, f"mission {joined.mission.name} ({joined.how}, {nodes})")
        for clause in clauses if not self._clauses else ():
            self._clauses[clause] = NEVER
            if clause.requirement.odds is None:
                clause.record(partial(self._judged, clause))

    def look(self, activation: Activation) -> None:
        """Tell which clauses an open activation breaks."""
        path = self._paths[activation.uid]
        self._note(activation)
        for clause in self._clauses:
            if clause.requirement.odds is None and clause.look(activation, path):
                self._tell(clause, clause.broken[activation.uid][0], path, "; it is still active")

    def look_over(self, root: Activation, active: Sequence[Activation]) -> None:
        """Tell which clauses are broken from an event until another one; `active`: all that is, with the root."""
        for clause in self._clauses:
            if clause.requirement.odds is None:
                for judgement, path in clause.look_over(root, active):
                    self._tell(clause, judgement, path)

    def see(self, activation: Activation) -> None:
        self._note(activation)

    def _note(self, activation: Activation) -> None:
        if self._begin is None:
            self._begin = activation.begin
        self._end = activation.end

    def end_run(self, root: Activation, retries: int, recoveries: int, failure: int | None) -> None:
        watched = self._watched
        how = OUTCOMES[root.outcome]
        watched.outcomes[how] += 1
        began = f"; the failure began at {self._paths[failure]}" if failure is not None else ""
        watched.tell(f"run {watched.outcomes.total()} {how} after {duration(root.seconds)}{began}", root.end)
        self._begin = None
        for clause, told_verdict in self._clauses.items():
            findings = clause.findings
            verdict, _ = verdict_of(findings.tally.result(), findings.missing, findings.has_run)
            if verdict != told_verdict:
                self._clauses[clause] = verdict
                watched.tell(f"{_named(clause)}: {result(clause.verdict())}", root.end, verdict)

    def end(self, clauses: Sequence[JudgedClause]) -> None:
        pass

    def open_run(self) -> Run | None:
        """The open run, as far as it has been seen; None without one."""
        if self._begin is None:
            return None
        return Run(self._watched.outcomes.total() + 1, self._watched.address, self._begin, self._end)

    def _judged(self, clause: JudgedClause, judgement: Judgement, begin: int, end: int, path: str) -> None:
        if judgement.holds is False and not _was_seen(clause, judgement, path, begin):
            self._tell(clause, judgement, path)

    def _tell(self, clause: JudgedClause, judgement: Judgement, path: str, more: str = "") -> None:
        measure = judgement.measure
        value = measured(measure.si, measure.unit, measure.bound.si) if measure is not None else ""
        bound = f", bound {measure.bound.text}" if measure is not None else ""
        sentence = judgement.sentence.replace("{}", value)
        self._clauses[clause] = VIOLATED
        self._watched.tell(f"{_named(clause)}: {path} {sentence}{bound}{more}", judgement.at, VIOLATED)


def _named(clause: JudgedClause) -> str:
    return f"{clause.requirement.name}  {clause.text}"


def _was_seen(clause: JudgedClause, judgement: Judgement, path: str, begin: int) -> bool:
    """Whether a violation in the open run, which has ended, was seen before.

    A span may begin before the row of its node; each one that was seen is the first violation like it.
    """
    for key, (seen, known_path) in clause.broken.items():
        if isinstance(key, int) and path == known_path:
            return True
        if isinstance(key, tuple) and (path, judgement.sentence) == (known_path, seen.sentence) and begin <= key[1]:
            del clause.broken[key]
            return True
    return False
