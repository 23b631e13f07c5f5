"""The verbs that are judged for each activation, with their scopes, word for word as the design tells them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING, Final, Literal

from literal_log import Log, as_amount, both, either, negated

if TYPE_CHECKING:
    from literal_log import Truth
    from literal_runs import Activation, Moment

    from btq_lang.requirements.model import Limit, ResolvedClaim, ResolvedRequirement

    Verdict = Truth | Literal["open", "out"]
    Part = Literal["upper", "lower"] | None

OPEN: Final = "open"  # cut off by the end of the log before it breaks anything
OUT: Final = "out"  # not counted


REFUSING = ("needs", "tries", "starts per", "follows")  # what guards look at only before a node starts


@dataclass(frozen=True)
class Judged:
    """What one activation came to: true, false, unknown, open, or not counted.

    Attributes:
        at: its end, or that of the run.
        is_refused: it did not start.
        measures: between which what goes into a mean is.
        decided: when that was decided, of several in a run that are judged when the run has ended.
    """

    run: int
    uid: int
    verdict: Verdict
    at: int
    decided: int = 0
    is_refused: bool = False
    measures: tuple[float, float] = (0.0, 0.0)


class OfActivations(Log):
    """A session, and what each activation of a node comes to."""

    def of_activations(
        self, uid: int, claim: ResolvedClaim, requirement: ResolvedRequirement, part: Part = None
    ) -> list[Judged]:
        """takes, succeeds, needs, keeps, never, leaves, uses at one instance of a node.

        Args:
            part: the only end of `between` that counts.
        """
        found = [
            judged(each, False)  # what the requirement's own guard stops, or finds wrong at the end, is violated
            if self.is_stopped(each, claim, requirement) or self.is_refuted(each, claim, requirement)
            else judged(each, self.keeps(each, claim, requirement))
            if claim.verb in ("keeps", "never")
            else judged(each, self.never_for(each, claim, requirement))
            if claim.verb == "never for"
            else replace(
                judged(each, self.scoped(each, self.whole(each, claim, part), requirement)),
                measures=(self.measured(claim, each) or 0.0,) * 2 if claim.verb.endswith(" on average") else (0.0, 0.0),
            )
            for each in self.of(uid)
        ]
        return [
            replace(each, verdict=self.applicable(a, each.verdict, requirement))
            for a, each in zip(self.of(uid), found, strict=True)
        ]

    def applicable(self, a: Activation, verdict: Verdict, requirement: ResolvedRequirement) -> Verdict:
        """What an activation, or a run, comes to that is not applicable unless each assumption holds all along."""
        first, *later = (self.holds_all("assuming", requirement, moment, a) for moment in self.moments(a))
        if not a.is_exact:  # it may have ended right after its start
            later = [None if each is False else each for each in later]
        return counted(both(first, *later), verdict)

    def is_stopped(self, a: Activation, claim: ResolvedClaim, requirement: ResolvedRequirement) -> bool:
        """Whether the guard around the node for this clause has halted it: the nearest one above it that was not halted
        itself, and failed.
        """
        uid, inner = self.tree.parent[a.uid], a
        while uid in self.guards and inner.outcome == "H":
            inner = next((each for each in reversed(self.of(uid)) if each.first <= inner.first <= each.last), inner)
            word = self.tree.nodes[uid].path.rpartition("_")[2]
            kinds = {"Timeout": ("takes", "succeeds"), "ReactiveSequence": (word, "succeeds")}
            if inner.uid == uid and inner.outcome == "F":
                own = self.guards[uid] == requirement.name
                return own and claim.verb in kinds.get(self.tree.nodes[uid].kind, ())
            uid = self.tree.parent[uid]
        return False

    def is_refuted(self, a: Activation, claim: ResolvedClaim, requirement: ResolvedRequirement) -> bool:
        """Whether the guard around the node for this clause has checked it after it succeeded, and failed."""
        return any(
            verb == claim.verb
            and verb not in REFUSING
            and self.guards[guard.uid] == requirement.name
            and self.held(a.uid, guard, check)[-1:] == [a]
            for verb, guard, check in self.failed_checks(a.uid)
        )

    def refused(self, uid: int, claim: ResolvedClaim, requirement: ResolvedRequirement) -> list[Judged]:
        """The starts of a node that guards around it have refused: each is a case of the clause that its guard
        enforces, unless that is judged by the run, and of `succeeds`, whosever guard it is."""
        return [
            Judged(
                check.run,
                uid,
                self.applicable(replace(check, start=check.stop), False, requirement),
                *2 * (check.end,),
                True,
            )
            for verb, guard, check in self.refusals(uid)
            if claim.verb == "succeeds"
            or (
                claim.verb == verb
                and verb not in ("tries", "starts per")
                and self.guards[guard.uid] == requirement.name
            )
        ]

    def refusals(self, uid: int) -> list[tuple[str, Activation, Activation]]:
        """The checks of guards around a node that have failed before the node started, as all do that are made only
        then; see `failed_checks`."""
        return [each for each in self.failed_checks(uid) if each[0] in REFUSING or not self.held(uid, *each[1:])]

    def failed_checks(self, uid: int) -> list[tuple[str, Activation, Activation]]:
        """The checks of requirements' guards around a node that have failed: the verb that is enforced, the guard, and
        the check."""
        found = []
        for check in self.activations:
            above = self.tree.parent[check.uid]
            if (
                check.outcome == "F"
                and self.tree.nodes[check.uid].kind == "ScriptCondition"
                and check.uid in self.guards
                and self.guards.get(above, "*") != "*"
                and self.is_guard_of(above, uid)
            ):
                guards = [each for each in self.of(above) if each.first <= check.first]
                if not guards or guards[-1].last < check.first:  # the log is cut off before the only row of the guard
                    guards.append(replace(check, uid=above, first=guards[-1].last + 1 if guards else 0))
                word = self.tree.nodes[above].path.rpartition("_")[2]
                words = {"used": "uses", "ends": "ends with", "starts": "starts per"}
                found.append((words.get(word, word), guards[-1], check))
        return found

    def held(self, uid: int, guard: Activation, check: Activation) -> list[Activation]:
        """The activations of a node that a guard let start before a check of it."""
        return [each for each in self.of(uid) if guard.first <= each.first < check.first]

    def is_guard_of(self, guard: int, uid: int) -> bool:
        """Whether nothing but guards is between."""
        while (uid := self.tree.parent[uid]) in self.guards:
            if uid == guard:
                return True
        return False

    def mission_succeeds(self, uid: int, claim: ResolvedClaim, requirement: ResolvedRequirement) -> list[Judged]:
        """`mission succeeds`: each run by the result of the root, whatever that is a guard of; from the begin of the
        written root to its end, where it started."""
        found = []
        for run in self.runs:
            written = [each for each in self.of(uid) if each.run == run.run]
            a = replace(written[-1] if written else replace(run, uid=uid), outcome=run.outcome, is_exact=run.is_exact)
            is_stopped = any(self.is_stopped(each, claim, requirement) for each in written)
            verdict = False if is_stopped else self.scoped(a, self.whole(a, claim), requirement)
            found.append(judged(a, self.applicable(a, verdict, requirement)))
        return found

    def whole(self, a: Activation, claim: ResolvedClaim, part: Part = None) -> Verdict:
        """What one activation comes to, whatever the scope; not of keeps and never, where that is a matter of time."""
        if claim.verb == "takes":
            return self.bounded(a, (a.end - a.begin) / 1e6, claim.limit, part)
        if claim.verb == "succeeds":
            if a.outcome == "F":
                return False
            if claim.limit is None:
                return True if a.outcome == "S" else OPEN if a.outcome == "O" else OUT
            return self.bounded(a, (a.end - a.begin) / 1e6, claim.limit)
        if claim.verb.endswith(" on average"):  # whatever it is
            known: Truth = None if self.measured(claim, a) is None else True
            return known if a.outcome in ("S", "F") else OPEN if a.outcome == "O" else OUT
        if claim.verb == "needs":
            holds = self.holds(claim.condition, a.start, a)
            return OPEN if holds and a.outcome == "O" else holds
        if claim.verb == "leaves":
            holds = self.holds(claim.condition, a.stop, a)
            return holds if a.outcome == "S" else OPEN if a.outcome == "O" else OUT
        if claim.verb == "ends with":
            holds = self.holds(claim.condition, a.stop, a)
            return holds if a.outcome in ("S", "F") else OPEN if a.outcome == "O" else OUT
        assert claim.verb == "uses"
        return self.bounded(a, self.used(claim, a), claim.limit, part)

    def measured(self, claim: ResolvedClaim, a: Activation) -> float | None:
        """How long an activation lasts, or how much it uses."""
        assert claim.limit is not None
        is_bound_known = self.amount(claim.limit.value, a.start, a) is not None
        if claim.signal is None:
            return (a.end - a.begin) / 1e6 if is_bound_known else None
        return self.used(claim, a) if is_bound_known else None

    def used(self, claim: ResolvedClaim, a: Activation) -> float | None:
        """How much of its signal an activation used, in SI, by the samples from the last one before it to its end.

        Of a level: what it fell by, and all that it was recharged by.  A recharge is a rise from a trough to a peak of
        more than half the bound (of `between` the upper end); a fall from the peak by more than that ends it, and less
        is jitter, of which nothing counts.  Of a counter: what it rose by; where a sample is below half the one before
        it, it was restarted at 0, and what it had counted until then is added.
        """
        assert claim.signal is not None
        assert claim.limit is not None
        bound = self.amount(claim.limit.upper or claim.limit.value, a.start, a)
        before, after = self.sample(claim.signal, a.begin), self.sample(claim.signal, a.end)
        if bound is None or before is None or after is None:
            return None
        later = {time: value for time, value in self.samples[claim.signal.name] if a.begin < time <= a.end}
        values = [as_amount(value) for value in (before, *later.values())]
        risen = as_amount(after) - as_amount(before)
        if claim.signal.behaviour == "level":
            return recharged(values, bound / 2) - risen
        return risen + sum(value for value, following in pairwise(values) if following < value / 2)

    def keeps(self, a: Activation, claim: ResolvedClaim, requirement: ResolvedRequirement) -> Verdict:
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

    def never_for(self, a: Activation, claim: ResolvedClaim, requirement: ResolvedRequirement) -> Verdict:
        """never φ for more than d: each part of the activation in which φ (and C) holds; what is unknown may hold."""
        moments = self.moments(a)
        in_scope = [self.holds_all("while", requirement, moment, a) for moment in moments]
        held = [
            both(counts, self.holds(claim.condition, moment, a))
            for counts, moment in zip(in_scope, moments, strict=True)
        ]
        times = [*(time for time, _ in moments), a.end]
        kept: list[Truth] = []
        for first in range(len(held)):
            for last in range(first, len(held)):
                holds = both(*held[first : last + 1])
                if holds is not False:
                    is_short = self.within((times[last + 1] - times[first]) / 1e6, claim.limit, a)[0]
                    kept.append(is_short if is_short is None or is_short or holds else None)
        verdict: Verdict = both(*kept, True if False in kept or {*held} != {None} else None)
        if not a.is_exact:  # it may have ended right after its start
            verdict = None if verdict is False else verdict
            in_scope[1:] = [None if counts else counts for counts in in_scope[1:]]
        counts = both(self.holds_all("when", requirement, a.start, a), either(*in_scope))
        return counted(counts, OPEN if verdict and a.outcome == "O" else verdict)

    def bounded(self, a: Activation, measured: float | None, limit: Limit | None, part: Part = None) -> Verdict:
        """A measure that grows while the activation lasts, against its bound."""
        not_above, not_below = self.within(measured, limit, a)
        not_above, not_below = part == "lower" or not_above, part == "upper" or not_below
        if a.outcome in ("S", "F"):
            return both(not_above, not_below)
        if not_above is True:
            return OPEN if a.outcome == "O" else OUT
        return not_above if a.is_exact else None

    def within(self, measured: float | None, limit: Limit | None, a: Activation) -> tuple[Truth, Truth]:
        """Whether a measure keeps the upper and the lower end of a limit, read at the start."""
        assert limit is not None
        low = self.amount(limit.value, a.start, a)
        high = self.amount(limit.upper, a.start, a) if limit.upper is not None else low
        above: Truth = None if high is None or measured is None else measured <= high
        below: Truth = None if low is None or measured is None else measured >= low
        if limit.relation == "<":
            above = None if high is None or measured is None else measured < high
        if limit.relation == ">":
            below = None if low is None or measured is None else measured > low
        return (True if limit.relation in (">", ">=") else above), (True if limit.relation in ("<", "<=") else below)

    def scoped(self, a: Activation, verdict: Verdict, requirement: ResolvedRequirement) -> Verdict:
        """What an activation comes to where it may not count."""
        return counted(self.counts(a, requirement), verdict)

    def counts(self, a: Activation, requirement: ResolvedRequirement) -> Truth:
        """Only activations with `when C` at their start, and `while C` throughout."""
        first, *later = (self.holds_all("while", requirement, moment, a) for moment in self.moments(a))
        if not a.is_exact:  # it may have ended right after its start
            later = [None if each is False else each for each in later]
        return both(self.holds_all("when", requirement, a.start, a), first, *later)

    def holds_all(self, word: str, requirement: ResolvedRequirement, moment: Moment, a: Activation) -> Truth:
        """The conditions of `while`, or of `when`, at a moment."""
        scopes = (*requirement.scopes, *requirement.assumptions)
        conditions = [each.condition for each in scopes if each.word == word]
        return both(*(self.holds(each, moment, a, initially=True) for each in conditions))


def judged(a: Activation, verdict: Verdict) -> Judged:
    """What an activation came to."""
    return Judged(a.run, a.uid, verdict, a.end)


def recharged(values: Sequence[float], least: float) -> float:
    """The sum of all rises of a level, each from its trough to its peak, that are larger than the least."""
    total = 0.0
    trough, peak = values[0], None
    for value in values:
        if peak is None:
            trough = min(trough, value)
            peak = value if value - trough > least else None
        elif peak - value > least:
            total += peak - trough
            trough, peak = value, None
        else:
            peak = max(peak, value)
    return total if peak is None else total + peak - trough


def counted(counts: Truth, verdict: Verdict) -> Verdict:
    """What an activation comes to that may not count."""
    if counts is False:
        return OUT
    return verdict if counts or verdict in (OPEN, OUT) else None
