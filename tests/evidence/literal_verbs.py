"""The verbs that are judged for each activation, with their scopes, word for word as the design tells them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from literal_log import Log, both, either, negated

if TYPE_CHECKING:
    from literal_log import Truth
    from literal_runs import Activation, Moment

    from btq_lang.requirements.model import Claim, Limit, Requirement

    Verdict = Truth | str

OPEN, OUT = "open", "out"  # cut off by the end of the log before it breaks anything; not counted


@dataclass(frozen=True)
class Judged:
    """What one activation came to: true, false, unknown, open, or not counted.

    Attributes:
        at: its end, or that of the run.
        is_refused: it did not start.
        decided: when that was decided, of several in a run that are judged when the run has ended.
    """

    run: int
    uid: int
    verdict: Verdict
    at: int
    decided: int = 0
    is_refused: bool = False


class OfActivations(Log):
    """A session, and what each activation of a node comes to."""

    def of_activations(self, uid: int, claim: Claim, requirement: Requirement) -> list[Judged]:
        """takes, succeeds, needs, keeps, never, leaves, uses at one instance of a node."""
        return [
            judged(each, False)  # stopped by the requirement's own enforcement is always violated
            if self.is_stopped(each, claim, requirement)
            else judged(each, self.keeps(each, claim, requirement))
            if claim.verb in ("keeps", "never")
            else judged(each, self.scoped(each, self.whole(each, claim), requirement))
            for each in self.of(uid)
        ]

    def is_stopped(self, a: Activation, claim: Claim, requirement: Requirement) -> bool:
        """Whether the guard around the node for this clause has halted it: the nearest one above it that was not halted
        itself, and failed.
        """
        uid, inner = self.tree.parent[a.uid], a
        while uid in self.guards and inner.outcome == "H":
            inner = next((each for each in reversed(self.of(uid)) if each.start <= inner.start <= each.stop), inner)
            kinds = {"Timeout": ("takes", "succeeds"), "ReactiveSequence": ("keeps", "never", "uses", "succeeds")}
            if inner.uid == uid and inner.outcome == "F":
                own = self.guards[uid] == requirement.name
                return own and claim.verb in kinds.get(self.tree.nodes[uid].kind, ())
            uid = self.tree.parent[uid]
        return False

    def refused(self, uid: int, claim: Claim, requirement: Requirement) -> list[Judged]:
        """The starts that a guard's condition before the node has refused; one that `needs` has counts for needs and
        succeeds."""
        found = []
        above = self.tree.parent[uid]
        while above in self.guards:
            verb = self.tree.nodes[above].path.rpartition("_")[2]
            checks = [
                each
                for each in self.activations
                if self.tree.parent[each.uid] == above
                and self.tree.nodes[each.uid].kind == "ScriptCondition"
                and each.outcome == "F"
                and verb in ("needs", "tries", "follows")
            ]
            own = claim.verb == verb and self.guards[above] == requirement.name
            if own or (claim.verb == "succeeds" and verb == "needs"):
                found += [Judged(each.run, uid, False, each.end, each.end, True) for each in checks]
            above = self.tree.parent[above]
        return found

    def whole(self, a: Activation, claim: Claim) -> Verdict:
        """What one activation comes to, whatever the scope; not of keeps and never, where that is a matter of time."""
        if claim.verb == "takes":
            return self.bounded(a, (a.end - a.begin) / 1e6, claim.limit)
        if claim.verb == "succeeds":
            if a.outcome == "F":
                return False
            if claim.limit is None:
                return {"S": True, "H": OUT, "O": OPEN}[a.outcome]
            return self.bounded(a, (a.end - a.begin) / 1e6, claim.limit)
        if claim.verb == "needs":
            holds = self.holds(claim.condition, a.start, a)
            return OPEN if holds and a.outcome == "O" else holds
        if claim.verb == "leaves":
            holds = self.holds(claim.condition, a.stop, a)
            return {"S": holds, "F": OUT, "H": OUT, "O": OPEN}[a.outcome]
        assert claim.verb == "uses"
        before, after = self.sample(claim.signal, a.begin), self.sample(claim.signal, a.end)
        used = None if before is None or after is None else after - before
        if used is not None and claim.signal.behaviour == "level":
            used = -used
        return self.bounded(a, used, claim.limit)

    def keeps(self, a: Activation, claim: Claim, requirement: Requirement) -> Verdict:
        """keeps, never: a sample in [b, e] with C that breaks it; it counts if C holds at all meanwhile."""
        moments = [
            (
                self.holds_all("while", requirement, moment, a),
                negated(self.holds(claim.condition, moment, a), claim.verb == "never"),
            )
            for moment in self.moments(a)
        ]
        if not a.is_exact:  # it may have ended right after its start
            moments[1:] = [(None if counts else counts, holds) for counts, holds in moments[1:]]
        counts = both(self.holds_all("when", requirement, a.start, a), either(*(counts for counts, _ in moments)))
        kept = both(*(either(negated(counts, True), holds) for counts, holds in moments))
        return counted(counts, OPEN if kept and a.outcome == "O" else kept)

    def bounded(self, a: Activation, measured: float | None, limit: Limit | None) -> Verdict:
        """A measure that grows while the activation lasts, against its bound."""
        not_above, not_below = self.within(measured, limit, a)
        if a.outcome in ("S", "F"):
            return both(not_above, not_below)
        if not_above is True:
            return OPEN if a.outcome == "O" else OUT
        return not_above if a.is_exact else None

    def within(self, measured: float | None, limit: Limit | None, a: Activation) -> tuple[Truth, Truth]:
        """Whether a measure keeps the upper and the lower end of a limit, read at the start."""
        assert limit is not None
        low = self.number(limit.value, a.start, a)
        high = self.number(limit.upper, a.start, a) if limit.upper is not None else low
        is_known = measured is not None
        above: Truth = None if high is None or not is_known else measured <= high
        below: Truth = None if low is None or not is_known else measured >= low
        if limit.relation == "<":
            above = None if high is None or not is_known else measured < high
        if limit.relation == ">":
            below = None if low is None or not is_known else measured > low
        return (True if limit.relation in (">", ">=") else above), (True if limit.relation in ("<", "<=") else below)

    def scoped(self, a: Activation, verdict: Verdict, requirement: Requirement) -> Verdict:
        """What an activation comes to where it may not count."""
        return counted(self.counts(a, requirement), verdict)

    def counts(self, a: Activation, requirement: Requirement) -> Truth:
        """Only activations with `when C` at their start, and `while C` throughout."""
        first, *later = (self.holds_all("while", requirement, moment, a) for moment in self.moments(a))
        if not a.is_exact:  # it may have ended right after its start
            later = [None if each is False else each for each in later]
        return both(self.holds_all("when", requirement, a.start, a), first, *later)

    def holds_all(self, word: str, requirement: Requirement, moment: Moment, a: Activation) -> Truth:
        """The conditions of `while`, or of `when`, at a moment."""
        return both(*(self.holds(each.condition, moment, a) for each in requirement.scopes if each.word == word))


def judged(a: Activation, verdict: Verdict) -> Judged:
    """What an activation came to."""
    return Judged(a.run, a.uid, verdict, a.end)


def counted(counts: Truth, verdict: Verdict) -> Verdict:
    """What an activation comes to that may not count."""
    if counts is False:
        return OUT
    return verdict if counts or verdict in (OPEN, OUT) else None
