"""A running robot: verdicts reported as they fall, and those so far at any time.

One invariant: what is reported comes from the evaluation that judges logs; nothing is judged here.
"""

from __future__ import annotations

import secrets
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, Final

from btq_lang.evidence.clause import JudgedClause, verdict_of
from btq_lang.evidence.model import Activation, NamedLog, Session
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

    def __init__(self, sessions: Iterable[Session | NamedLog], address: str, tell: Callable[[News], None]) -> None:
        self.id: Final = secrets.token_hex(32)
        self.sessions: Final = sessions
        self.mission = ""
        self.address: Final = address
        self._tell: Final = tell
        self._missions: Final[list[tuple[MissionEvaluation, _Listener]]] = []
        self.outcomes: Final[Counter[str]] = Counter()

    def judged_by(self, evaluation: MissionEvaluation) -> None:
        """Tell what the evaluation of a mission finds, by which no session before was judged."""
        listener = _Listener(self)
        self._missions.append((evaluation, listener))
        evaluation.listeners.append(listener)

    def foreign(self, difference: str) -> None:
        """Tell that the next session belongs to no mission; `difference`: as in `Foreign`."""
        self.mission = ""
        self.tell(f"its tree belongs to no known mission{f': {difference}' if difference else ''}; it is not judged")

    def so_far(self) -> Iterator[tuple[RequirementVerdict, ...]]:
        """The verdicts of each mission that was judged, including the open run."""
        for evaluation, listener in self._missions:
            yield evaluation.verdicts(listener.open_run())

    def tell(self, text: str, time: int | None = None, verdict: Verdict | None = None) -> None:
        """Tell something."""
        self._tell(News(time, verdict, text))


class _Listener:
    """Tells what is found while a mission is judged."""

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
        watched.mission = f"mission {joined.mission.name} ({joined.how}, {nodes})"
        watched.tell(watched.mission)
        for clause in clauses if not self._clauses else ():
            self._clauses[clause] = NEVER
            if clause.requirement.odds is None:
                clause.record(partial(self._judged, clause))

    def see(self, activation: Activation) -> None:
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
        for clause, told in self._clauses.items():
            found = clause.found
            verdict, _ = verdict_of(found.tally.result(), found.missing, found.has_run)
            if verdict != told:
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
        if judgement.holds is not False:
            return
        measure = judgement.measure
        value = measured(measure.si, measure.unit, measure.bound.si) if measure is not None else ""
        bound = f", bound {measure.bound.text}" if measure is not None else ""
        sentence = judgement.sentence.replace("{}", value)
        self._clauses[clause] = VIOLATED
        self._watched.tell(f"{_named(clause)}: {path} {sentence}{bound}", judgement.at, VIOLATED)


def _named(clause: JudgedClause) -> str:
    return f"{clause.requirement.name}  {clause.text}"
