"""A clause at a written node: which nodes of a log it holds for, and what their activations come to.

One invariant: a clause that cannot be judged is unknown with the reason, and never left out.
"""

from __future__ import annotations

from btq_lang.evidence.scopes import in_scope, within
from btq_lang.evidence.signals import Unknown
from btq_lang.evidence.tally import Tally
from btq_lang.evidence.verbs import Judgement, judge_of
from btq_lang.evidence.verdicts import NEVER, UNKNOWN, VIOLATED, ClauseVerdict
from btq_lang.evidence.wording import duration
from btq_lang.requirements.model import Mission, Span, Target, Total

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from typing import Final

    from btq_lang.evidence.guards import Guard, Refusal
    from btq_lang.evidence.identity import Joined
    from btq_lang.evidence.model import Activation
    from btq_lang.evidence.signals import Signals
    from btq_lang.requirements.model import Applied, Claim, Requirement


class JudgedClause:
    """A clause at a written node, with what it has come to.

    Attributes:
        tally: what was counted.
    """

    def __init__(self, requirement: Requirement, claim: Claim, applied: Applied | None) -> None:
        self.requirement: Final = requirement
        self.claim: Final = claim
        self.tally: Final = Tally(requirement.odds, requirement.confidence)
        self._target: Final = _target(applied)
        self._not_judged: Final = _not_judged(requirement, claim, applied, self._target)
        self._judge: Final = judge_of(claim.verb)
        self._judged: Final = within(claim, requirement.scopes)
        self._paths: Final[dict[str, None]] = {}
        self._missing = ""

    def join(self, joined: Joined) -> list[int]:
        """The nodes of a log that it holds for."""
        if self._target is None or self._not_judged:
            return []
        found: list[int] = []
        for path, uid in joined.instances(self._target):
            self._paths[path] = None
            if uid is not None:
                found.append(uid)
            else:
                self._missing = self._missing or f"`{path}` {joined.lacking}"
        return found

    def judge(self, activation: Activation, guard: Guard | None, signals: Signals, path: str) -> None:
        """Count an activation of one of its nodes.

        Args:
            guard: what stopped it.
        """
        assert self._judge is not None, "a clause that cannot be judged is joined with no node"
        if guard is not None and self._is_own(guard):
            said = f"stopped by its own guard after {duration(activation.seconds)}"
            self.tally.add(Judgement(False, activation.end, said), path)
            return
        counts = in_scope(self.requirement.scopes, self.claim.verb, activation, signals)
        if counts is False:
            return
        judgement = self._judge(self._judged, activation, signals)
        is_open = activation.outcome == "O"
        if judgement is None or (is_open and judgement.holds):
            self.tally.cut_off += is_open
            return
        if isinstance(counts, Unknown):
            judgement = Judgement(None, judgement.at, counts.why)
        self.tally.add(judgement, path)

    def refuse(self, refusal: Refusal, path: str) -> None:
        """Count a start that was refused for what a requirement needs: that breaks what it needs, and no node succeeds
        that does not start."""
        own = self.claim.verb == "needs" and self.requirement.name == refusal.requirement
        if own or self.claim.verb == "succeeds":
            self.tally.add(Judgement(False, refusal.time, f"its start was refused by {refusal.requirement}"), path)

    def _is_own(self, guard: Guard) -> bool:
        """Whether a guard was put around the node for this clause."""
        return guard.requirement == self.requirement.name and self.claim.verb in _STOPPED_BY.get(guard.kind, ())

    def verdict(self) -> ClauseVerdict:
        """What it has come to."""
        tally = self.tally
        verdict = tally.verdict()
        why = ""
        if self._not_judged or (self._missing and verdict != VIOLATED):
            verdict, why = UNKNOWN, self._not_judged or self._missing
        elif verdict == UNKNOWN:
            why = tally.why
        elif verdict == NEVER:
            why = "it did not start in any run" if not tally.cut_off else "the log ends before it does"
        said = [self.claim.text, *(scope.text for scope in self.requirement.scopes)]
        said += [self.requirement.odds.text] if self.requirement.odds is not None else []
        return ClauseVerdict(
            text=" ".join(said),
            path=", ".join(self._paths),
            verdict=verdict,
            counted=tally.counted,
            violated=tally.violated,
            unknown=tally.unknown,
            cut_off=tally.cut_off,
            unit="runs" if tally.counts_runs else "activations",
            worst=tally.worst,
            interval=tally.interval(),
            confidence=self.requirement.confidence,
            more=tally.more(),
            violations=tuple(tally.violations),
            why=why,
        )


def _target(applied: Applied | None) -> Target | None:
    """The node that is judged."""
    subject = applied.subject if applied is not None else None
    if isinstance(subject, Mission):
        return Target(subject.node) if subject.node is not None else None
    return subject if isinstance(subject, Target) else None


def _not_judged(requirement: Requirement, claim: Claim, applied: Applied | None, target: Target | None) -> str:
    """Why a clause cannot be judged from logs; empty where it can."""
    if applied is None:
        return "the clause applies to no node"
    if isinstance(applied.subject, Span):
        return "the time from one event to another is not judged yet"
    if isinstance(applied.subject, Total):
        return "sums of durations are not judged yet"
    if target is None:
        return "the mission has no known main tree"
    if judge_of(claim.verb) is None:
        return f"`{claim.verb}` is not judged yet"
    return "`over last` is not judged yet" if requirement.window is not None else ""


# The guards that stop a node for a clause; the others around it belong to other clauses.
_STOPPED_BY: Final = {
    "Timeout": frozenset(("takes", "succeeds")),
    "ReactiveSequence": frozenset(("keeps", "never", "succeeds")),
}
