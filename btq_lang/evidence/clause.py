"""A clause at a written node: which nodes of a log it holds for, and its verdict.

One invariant: a clause that cannot be judged is unknown with the reason, and never left out.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterator, Sequence
from typing import TYPE_CHECKING, Final, TypeAlias

from btq_lang.catalog.verbs import POOLED, VERBS
from btq_lang.evidence import margins
from btq_lang.evidence.clause_findings import ClauseFindings, verdict_on
from btq_lang.evidence.clause_nodes import events_in, judged_together
from btq_lang.evidence.conditions import Measure
from btq_lang.evidence.edges import WHILE_IT_RUNS, edge_of, key_of
from btq_lang.evidence.history import History, Nearby
from btq_lang.evidence.kept_spans import broken_spans, ends_by_row
from btq_lang.evidence.model import (
    BEGUN_BEFORE,
    CLOCK_SET_BACK,
    CUT_BY_GAP,
    ROWS_LOST,
    UNKNOWN_BEGIN,
    Activation,
    LoggedTree,
    Moment,
)
from btq_lang.evidence.observed import Observed
from btq_lang.evidence.over_run import OverRun, target_of
from btq_lang.evidence.pools import pool_of
from btq_lang.evidence.run_verbs import run_judge
from btq_lang.evidence.scopes import in_scope, within
from btq_lang.evidence.signals import Signals, UnknownValue
from btq_lang.evidence.tally import Run
from btq_lang.evidence.verbs import JUDGES, OUT, Judgement, agreed, in_order
from btq_lang.evidence.verbs import duration as lasted
from btq_lang.evidence.verdicts import CauseLink, ClauseVerdict, Measures
from btq_lang.evidence.wording import duration
from btq_lang.requirements.model import (
    Age,
    Aggregate,
    DurationSum,
    Interval,
    MissionRun,
    NodeTarget,
    ResolvedEachEvent,
    Running,
    parts_in,
    signals_in,
)
from btq_lang.util.record import Record, replace
from btq_lang.util.text import counted

if TYPE_CHECKING:
    from btq_lang.evidence.explain import Explainer
    from btq_lang.evidence.guards import Guard, RefusedStart
    from btq_lang.evidence.identity import Joined
    from btq_lang.evidence.model import Outcome
    from btq_lang.evidence.odds import Limits
    from btq_lang.evidence.outline import Demand
    from btq_lang.requirements.model import (
        ResolvedClaim,
    )


class _Place(Record):
    """Where a clause that is judged over a run holds: a node, or the nodes whose events or durations it measures.

    Attributes:
        others: the other nodes that it mentions.
    """

    path: str
    uids: tuple[int, ...]
    others: Nearby


# An activation as it may have been, what was observed during it then, and whether it was in scope.
_Way: TypeAlias = "tuple[Activation, Observed, bool | UnknownValue]"


class JudgedClause:
    """A clause at a written node, and its judgements so far.

    Attributes:
        findings: what the logs so far show of it.
        judged: the claim as it is judged.
        broken: what breaks it already in the open run, each with the path: open activations, by node, and spans, by
            node and begin.
        explainer: of the current log.
    """

    def __init__(self, demand: Demand, limits: Limits = "one look", with_measures: bool = False) -> None:
        """Judge nothing yet; `limits`: those that decide about probabilities, except in a window."""
        requirement, claim, subject = demand.requirement, demand.claim, demand.subject
        self.demand: Final = demand
        self.requirement: Final = requirement
        self.claim: Final = claim
        self.findings: Final = ClauseFindings(requirement, limits, pool_of(claim, requirement.confidence))
        self._tally: Final = self.findings.tally
        self._margins: Final = self.findings.margins
        self._subject: Final = subject
        span = requirement.span
        is_of_one = span is None and not isinstance(subject, Interval | DurationSum)
        self._judge: Final = JUDGES.get(claim.verb) if is_of_one else None
        self._judge_run: Final = run_judge(claim, subject, has_span=span is not None)
        # Whether a mission succeeds is what the log's root returns, whatever is around the written root.
        self._is_result: Final = isinstance(subject, MissionRun) and VERBS[claim.verb].limits == "success"
        self.judged: Final = replace(within(claim, requirement.scopes), subject=subject)
        self._edge: Final = edge_of(self.judged, subject, requirement) if with_measures else None
        self._extremes: Final = self._edge.extremes if self._edge is not None else ()
        self._with_measures: Final = with_measures
        self._events: Final = events_in(claim, subject, span)
        subjects = (subject, *(event.subject for event in self._events))
        self._is_about_mission: Final = any(isinstance(each, MissionRun) for each in subjects)
        scopes = (*requirement.scopes, *requirement.assumptions)
        parts = (claim.condition, claim.limit, *self._events, *(scope.condition for scope in scopes))
        self._running: Final = [part.target for part in parts_in(parts) if isinstance(part, Running)]
        has_age = any(isinstance(part, Age) for part in parts_in(parts))  # which counts from the start
        measures_time = has_age or VERBS[claim.verb].operand not in ("condition", "use")
        self._bounds_time: Final = VERBS[claim.verb].operand in _OF_TIME and not isinstance(subject, DurationSum)
        self._reads: Final = None if measures_time else [*signals_in((parts, claim.signal))]
        self._is_at_any_time: Final = VERBS[claim.verb].judged == "while it runs"
        is_whole = any(scope.word == "while" for scope in requirement.scopes) and not self._is_at_any_time
        is_of_all = any(isinstance(part, Aggregate) for part in parts_in(parts))
        is_open = self._running or is_whole or is_of_all or requirement.assumptions
        self._is_final: Final = VERBS[claim.verb].is_final and not is_open
        self.findings.missing = self._why_not()
        self._is_judged: Final = not self.findings.missing
        self._nodes: Final[list[int]] = []  # of the current log, as are these:
        self._places: Final[list[_Place]] = []
        self._signals: Signals
        self._history: History
        self._nearby: Callable[[int], Nearby]
        # Activations that wait until the end of the run shows what else ran meanwhile.
        self._waiting: Final[list[tuple[Activation, Observed, str, Guard | None]]] = []
        self._refused: Final[list[RefusedStart]] = []  # in the open run, of the clause's nodes
        self._around: Final[list[int]] = []  # a guard of a span is around the parent of its nodes
        self._stopped: Final[list[Activation]] = []  # of these, in the open run
        self._notes: Final[Counter[str]] = Counter()
        self._waits = False
        self._has_started = False  # in the open run
        self._written: tuple[Activation, Guard | None] | None = None  # in the open run, if its root's result counts
        self._records: Final[list[Callable[[Judgement, int, int, str], None]]] = []
        self._looked: Final[dict[int, tuple[Moment, Moment]]] = {}  # of open activations: their start, and up to when
        self._looked_until: Moment = _FIRST  # the same of the open run
        self.broken: Final[dict[int | tuple[int, int], tuple[Judgement, str]]] = {}
        self.explainer: Explainer

    def record(self, record: Callable[[Judgement, int, int, str], None]) -> None:
        """Give each judgement to a function, with begin and end of what is judged, and the path of its node."""
        self._records.append(record)

    def join(self, joined: Joined, signals: Signals, history: History, nearby: Callable[[int], Nearby]) -> list[int]:
        """Begin another log; returns those of its nodes that the clause holds for.

        Args:
            nearby: resolves the other nodes that a clause names, relative to its node.
        """
        self._signals, self._history, self._nearby = signals, history, nearby
        self._nodes.clear()
        self._around.clear()
        self._places.clear()
        self._notes.clear()
        for uids in self._groups(joined):
            others = nearby(uids[0])
            needed = [target_of(event) for event in self._events if event.condition is None]
            needed += [node for node in (self.claim.per, self.claim.of) if isinstance(node, NodeTarget)]
            needed += [node.target for visit in self.claim.visits for node in visit.nodes]
            instances = [others.find(target) for target in needed]
            lost = [uids_of_target for uids_of_target in instances if isinstance(uids_of_target, UnknownValue)]
            for target in self._running:
                for uid in uids:
                    nearby(uid).find(target)
            if lost:
                self.findings.missing = self.findings.missing or lost[0].why
                continue
            self._nodes.extend(uids)
            if self._judge_run is not None:
                history.watch(uids)
                self._places.append(_Place(joined.tree.nodes[uids[0]].path, uids, others))
        if isinstance(self._subject, Interval):
            guards = joined.enforcing()
            tree = joined.tree
            parents = [next((above for above in tree.above(uid) if above not in guards), 0) for uid in self._nodes]
            self._around.extend(parent for parent in dict.fromkeys(parents) if parent)
        return [*self._nodes, *self._around]

    def judge(self, activation: Activation, guard: Guard | None, observed: Observed, path: str) -> None:
        """Count an activation of one of its nodes, which a guard may have stopped, by what was observed during it."""
        if activation.uid in self._around:
            if guard is not None and guard.requirement == self.requirement.name and self.claim.verb in guard.verbs:
                self._stopped.append(activation)
            if activation.uid not in self._nodes:
                return
        self.findings.has_run = self._has_started = True
        if activation.timing in BEGUN_BEFORE:
            return
        self._waits = self._waits or activation.shown != activation.ended
        if self._is_result:
            self._written = activation, guard
        else:
            self._judge_in(activation, guard, observed, path)
        self.broken.pop(activation.uid, None)

    def _judge_in(self, activation: Activation, guard: Guard | None, observed: Observed, path: str) -> None:
        if guard is not None and self._is_own(guard) and self._judge is None:
            self._stopped.append(activation)
            self._margins.is_exact = False  # as below
        elif guard is not None and self._is_own(guard):
            self._margins.is_exact = False  # with another bound the guard would have done something else
            self._count(self._broken(activation, guard, observed), activation, path)
        elif self._judge is not None and self._running:
            self._waiting.append((activation, observed, path, guard))
        elif self._judge is not None:
            self._judge_one(activation, observed, path, guard)

    def look(self, activation: Activation, path: str) -> bool:
        """Judge an activation that is still open; returns whether it breaks the clause for certain, and did not when it
        was looked at before.
        """
        uid, verb = activation.uid, self.claim.verb
        if self._judge is None or not self._is_final or uid in self.broken or uid not in self._nodes:
            return False
        observed = Observed(self._signals, self._nearby(uid), activation.started, activation.ended)
        starts = [scope for scope in self.requirement.scopes if scope.word == "when"]
        if in_scope(starts, verb, observed) is not True:
            return False
        started, until = self._looked.get(uid, (None, activation.started))
        if self._is_at_any_time and VERBS[verb].operand != "stretch" and started == activation.started:
            observed = observed.between(until, activation.ended)
        self._looked[uid] = activation.started, activation.ended
        judgement = self._judge(self.judged, activation, observed)
        if judgement is None or judgement.holds is not False:
            return False
        self.broken[uid] = judgement, path
        return True

    def look_over(self, root: Activation, active: Sequence[Activation]) -> Iterator[tuple[Judgement, str]]:
        """The violations in spans of the open run, each with the path, that stay such, and were not seen before.

        Args:
            root: its activation so far; `active`: those that are still open, with it.
        """
        if self.requirement.span is None or self._judge_run is None or not self._is_final:
            return
        with self._history.including(active if ends_by_row(self.requirement.span) else [root]):
            for place in self._places:
                for judgement in broken_spans(self.judged, self._over(place, root), self._looked_until):
                    assert judgement.since is not None, "a span has a begin"
                    key = place.uids[0], judgement.since
                    if key not in self.broken:
                        self.broken[key] = judgement, place.path
                        yield judgement, place.path
        self._looked_until = root.ended

    def refuse(self, refusal: RefusedStart, path: str) -> None:
        """Count a start that a guard refused: it violates the demand that the guard enforces, and for `succeeds` it is
        a failure.
        """
        is_own = self._is_own(refusal.guard)
        if self._is_result or (not is_own and VERBS[self.claim.verb].limits != "success"):
            return
        self.findings.has_run = True
        self._margins.is_exact = False
        if is_own and VERBS[self.claim.verb].operand == "count":
            self._refused.append(refusal)
            return
        by = f"its guard at {refusal.guard.path}" if is_own else refusal.guard.requirement
        time = refusal.at[0]
        judgement = Judgement(False, time, f"its start was refused by {by}")
        observed = Observed(self._signals, self._nearby(refusal.uid), refusal.at, refusal.at)
        applies = in_scope(self.requirement.assumptions, self.claim.verb, observed)
        if applies is False:
            self.findings.left_out["not_applicable"] += 1
            return
        if isinstance(applies, UnknownValue):
            judgement = Judgement(None, time, applies.why)
        self._add(judgement, path, time, time, self.explainer.chain(self.claim, judgement, path))

    def _broken(self, activation: Activation, guard: Guard, observed: Observed) -> Judgement:
        """The judgement of an activation that its own guard stopped, or whose success it did not accept."""
        assert self._judge is not None, "a guard is about one activation"
        judged = self._judge(self.judged, activation, observed)
        measure = judged.measure if judged is not None and judged.holds is False else None
        stopped = f"stopped by its own guard after {duration(activation.seconds)}"
        if VERBS[self.claim.verb].limits and self.judged.limit is not None and measure is None:
            ran = lasted(self.judged, activation, observed)
            measure = ran.beyond() if isinstance(ran, Measure) else None
        sentence = f"its guard at {guard.path} did not accept its success" if guard.checks else stopped
        return Judgement(False, activation.end, sentence, measure)

    def end_run(self, run: Run, root: Activation) -> None:
        """Judge the open run, which has ended; `root`: the activation of its root."""
        is_whole = root.timing not in BEGUN_BEFORE  # else it is unknown what ran in its first part
        if self._is_result and self._nodes and is_whole:
            self._judge_result(root)
        for activation, observed, path, guard in self._waiting if is_whole else ():
            # Observed again: a late sample may count.
            self._judge_one(activation, observed.during(activation), path, guard, root)
        self._waiting.clear()
        if self._judge_run is not None and is_whole:
            self._judge_over(root)
        if root.timing in CUT_BY_GAP and self._nodes:
            lost = Judgement(None, root.end, ROWS_LOST)
            self._add(lost, next(iter(self.findings.paths)), root.end, root.end, ())
            self._margins.add(margins.UNKNOWN, margins.UNKNOWN, ())
        self._refused.clear()
        self._stopped.clear()
        self._tally.end_run(run)
        self._margins.end_run(run.number)
        if not self._has_started and self._judge is not None and self._is_judged:
            self.findings.left_out["idle"] += 1
        self._has_started = False
        self._written = None
        self.broken.clear()
        self._looked.clear()
        self._looked_until = _FIRST

    def _judge_result(self, root: Activation) -> None:
        """Judge a run by the result of its root, from the begin of the written root to its end, if that ran."""
        top, guard = self._written or (root, None)
        run = Activation(self._nodes[0], top.started, top.ended, root.outcome, root.timing, top.begun(True), top.shown)
        observed = Observed(self._signals, self._nearby(run.uid), run.started, run.ended, run.timing != "latest")
        self._judge_in(run, guard, observed, next(iter(self.findings.paths)))

    def _judge_over(self, root: Activation) -> None:
        """Count what is judged over the run, in order of time for all uses of a subtree together: a window may keep
        only the last ones.
        """
        assert self._judge_run is not None, "the clause is judged by runs"
        judged: list[tuple[Judgement | None, _Place, OverRun]] = []
        for place in self._places:
            applies = self._is_applicable(root, place)
            if applies is False:
                continue
            over = self._over(place, root)
            overs = [over]
            are_begins_known = root.is_begin_known and place.others.are_begins_known()
            if not are_begins_known or not all(activation.is_begin_known for activation in over.own):
                early = root.from_earliest()
                overs.append(replace(over, root=early, observed=over.observed.earlier(early.started)))
            judgements = self._judged_over(self.judged, overs)
            if isinstance(applies, UnknownValue):
                judgements = [each and Judgement(None, each.at, applies.why) for each in judgements]
                self._margins.is_exact = False
            judged += [(judgement, place, over) for judgement in judgements]
            self.findings.missed += len(over.missed)
            if self._extremes:
                self._measure([self._judged_over(claim, overs) for claim in self._extremes], root)
                self._margins.is_exact = self._margins.is_exact and not over.unsettled
        if len(judged) > 1:
            judged.sort(key=lambda entry: entry[0].at if entry[0] is not None else 0)
        for judgement, place, over in judged:
            if judgement is not None and judgement.holds is False:
                chain = self.explainer.over_run.chain(self.judged, judgement, over, place.others)
                since = judgement.since if judgement.since is not None else root.begin
                self._add(judgement._replace(since=None, starts=(), note=""), place.path, since, root.end, chain)
            else:
                self._count(judgement, root, place.path)

    def _is_applicable(self, root: Activation, place: _Place) -> bool | UnknownValue:
        """Whether the assumptions hold all along in a run; if they do not, it is counted as not applicable."""
        if not self.requirement.assumptions:
            return True
        observed = Observed(self._signals, place.others, root.started, root.ended, root.timing != "latest")
        ways: list[_Way] = [(root, observed, True)]
        if not root.is_begin_known:
            ways.append((root, observed.earlier(root.begun(True)), True))
        applicable = self._applicable(ways)
        if applicable is None:
            return False
        answers = [applies for *_, applies in applicable]
        unknown = next((answer for answer in answers if isinstance(answer, UnknownValue)), None)
        return True if all(answer is True for answer in answers) else unknown or UnknownValue(UNKNOWN_BEGIN)

    def _over(self, place: _Place, root: Activation) -> OverRun:
        observed = Observed(self._signals, place.others, root.started, root.ended)
        own = self._history.activations_of(place.uids)
        refused = [refusal for refusal in self._refused if refusal.uid in place.uids]
        stopped, scopes, span = self._stopped, self.requirement.scopes, self.requirement.span
        return OverRun(self.claim.verb, scopes, root, place.uids, own, observed, refused, stopped, [], span, [])

    def _judged_over(self, claim: ResolvedClaim, overs: Sequence[OverRun]) -> Sequence[Judgement | None]:
        """The judgements of a run by a claim; `overs`: the run as it may have been."""
        assert self._judge_run is not None, "the clause is judged by runs"
        late, *others = [[*self._judge_run(claim, over)] for over in overs]
        root = overs[0].root
        for early in others:
            if len(early) != len(late):
                is_any = any(judgement is not OUT for judgement in (*early, *late))
                return [Judgement(None, root.end, UNKNOWN_BEGIN)] if is_any else []
            late = [in_order(agreed(*pair, root), pair[0]) for pair in zip(late, early, strict=True)]
        return [_clocked(judgement, root) for judgement in late if judgement is not OUT]

    def _judge_one(
        self,
        activation: Activation,
        observed: Observed,
        path: str,
        guard: Guard | None = None,
        root: Activation | None = None,
    ) -> None:
        """Count an activation.

        Args:
            guard: what stopped it, unless that was halted itself.
            root: of the run, if the judgement depends on the order of events.
        """
        ways: list[_Way] = [(activation, observed, in_scope(self.requirement.scopes, self.claim.verb, observed))]
        if self._running or self._depends_on_begin(activation):
            early = activation.from_earliest()
            earlier = observed.earlier(early.started)
            ways.append((early, earlier, in_scope(self.requirement.scopes, self.claim.verb, earlier)))
        if all(counts is False for *_, counts in ways):
            return
        applicable = self._applicable(ways) if self.requirement.assumptions else ways
        if applicable is None:
            return
        ways = applicable
        judgement = self._judged_by(self.judged, ways)
        if judgement is None and guard is not None and not guard.requirement:
            why = f"it was stopped by {guard.path}, which the mission does not have"
            judgement = Judgement(None, activation.end, why)
            self._margins.is_exact = False
        self._count(_clocked(judgement, root), activation, path)
        if self._extremes:
            self._measure([[_clocked(self._judged_by(extreme, ways), root)] for extreme in self._extremes], activation)

    def _applicable(self, ways: list[_Way]) -> list[_Way] | None:
        """The ways in which an activation, or a run, may have been, in scope only if the assumptions hold all along;
        None if it is not applicable, and counted as such."""
        assumptions, verb = self.requirement.assumptions, self.claim.verb
        applies = [in_scope(assumptions, verb, observed) for _, observed, _ in ways]
        if all(each is False for each in applies):
            self.findings.left_out["not_applicable"] += 1
            return None
        return [
            (activation, observed, applicable if counts is True or applicable is False else counts)
            for (activation, observed, counts), applicable in zip(ways, applies, strict=True)
        ]

    def _depends_on_begin(self, activation: Activation) -> bool:
        """Whether its judgement may differ between the earliest and the latest begin of an activation."""
        if activation.is_begin_known or self._reads is None:
            return not activation.is_begin_known
        between = activation.earliest, activation.begin
        return any(self._signals.changes(signal, *between) for signal in self._reads)

    def _judged_by(self, claim: ResolvedClaim, ways: Sequence[_Way]) -> Judgement | None:
        """The judgement of an activation by a claim; None: it does not count."""
        if len(ways) == 1:
            return self._judged_as(claim, *ways[0])
        late, early = (self._judged_as(claim, *way) for way in ways)
        return agreed(late, early, activation=ways[0][0])

    def _judged_as(
        self, claim: ResolvedClaim, activation: Activation, observed: Observed, counts: bool | UnknownValue
    ) -> Judgement | None:
        """The judgement of an activation with this begin; `counts`: whether it is in scope."""
        if counts is False:
            return None
        assert self._judge is not None, "the clause is judged by its activations"
        judgement = self._judge(claim, activation, observed)
        if activation.outcome == "O" and judgement is not None and judgement.holds:
            # Also for `needs`, although nothing can violate it any more: with one rule for all clauses, the counts of
            # two clauses at one node differ by what happened, not by where the log ends.
            judgement = None
        if judgement is not None and isinstance(counts, UnknownValue):
            judgement = Judgement(None, judgement.at, counts.why, judgement.measure)
        return judgement

    def _measure(self, extremes: Sequence[Sequence[Judgement | None]], activation: Activation) -> None:
        """Add to the margins with which bounds an activation, or a run, is kept, violated or unknown.

        Args:
            extremes: the judgements with a bound that every measure keeps, and with one that none keeps.
        """
        assert self._edge is not None, "its bound may be moved"
        within, beyond = extremes
        is_first_decisive = self.claim.verb in WHILE_IT_RUNS
        if len(within) != len(beyond) or (is_first_decisive and activation.timing != "exact"):
            self._margins.is_exact = False
            return
        for kept, broken in zip(within, beyond, strict=True):
            judgements = [one for one in (kept, broken) if one is not None and one.measure is not None]
            if is_first_decisive and (kept is None or kept.measure is None):
                judgements.clear()
            limits = [judgements[0].measure, judgements[0].most] if judgements else []
            values = [self._edge.across(measure.si) for measure in limits if measure is not None]
            self._margins.add(margins.kind_of(kept, activation), margins.kind_of(broken, activation), values)

    def _count(self, judgement: Judgement | None, activation: Activation, path: str) -> None:
        if judgement is None:
            self._tally.cut_off += activation.outcome == "O"
            if self.claim.verb in ("leaves", "ends with") and activation.outcome in _WITHOUT_SUCCESS:
                self.findings.left_out[_WITHOUT_SUCCESS[activation.outcome]] += 1
        else:
            if judgement.note:
                self._notes[judgement.note] += 1
            chain = self.explainer.chain(self.claim, judgement, path) if judgement.holds is False else ()
            since = judgement.since if judgement.since is not None else activation.begin
            self._add(judgement, path, since, activation.end, chain)

    def _add(self, judgement: Judgement, path: str, begin: int, end: int, chain: tuple[CauseLink, ...]) -> None:
        measure = judgement.measure
        if judgement.holds is False and self._bounds_time and measure is not None and measure.is_upper:
            judgement = judgement._replace(passed=min(begin + round(measure.bound.si * 1e6), judgement.at))
        self._tally.add(judgement, path, end, chain)
        for record in self._records:
            record(judgement, begin, end, path)

    def _groups(self, joined: Joined) -> list[tuple[int, ...]]:
        """The nodes of a log that the clause holds for, in groups that are judged as one node."""
        if not self._is_judged:
            return []
        if self._is_about_mission and not joined.build.is_main:  # which did not run as a whole
            return []
        return judged_together(self.claim, self._subject, joined, self.findings)

    def _is_own(self, guard: Guard) -> bool:
        """Whether a guard enforces this clause; spans and sums have no guards."""
        if isinstance(self._subject, Interval | DurationSum | ResolvedEachEvent):
            return False
        return guard.requirement == self.requirement.name and self.claim.verb in guard.verbs

    def _why_not(self) -> str:
        """Why it cannot be judged from logs; empty where it can."""
        subject = self._subject
        if subject is None:
            return "the clause applies to no node"
        subjects = (subject, *(event.subject for event in self._events))
        if any(isinstance(each, MissionRun) and each.node is None for each in subjects):
            return "the mission has no known main tree"
        if self.claim.verb in POOLED and self.findings.pool is None:
            return "its bound depends on the situation, and all runs are judged together"
        if self._judge is None and self._judge_run is None:
            measured = "the time from one event to another" if isinstance(subject, Interval) else "a sum of durations"
            if self.requirement.span is not None:
                measured = "the time from one event until another"
            return f"`{self.claim.head}` cannot be judged of {measured}"
        return ""

    def remarks(self, tree: LoggedTree, keeping: Collection[int]) -> Iterator[str]:
        """Remarks on the current log, which has been read."""
        yield from (
            f"{self.requirement.name}: {note} ({counted(number, 'activation')})" for note, number in self._notes.items()
        )
        for uid in self._nodes:
            # A node that completes at once and is not reset leaves a row only when its result changes.
            if VERBS[self.claim.verb].operand in ("count", "rate") and not self._waits and tree.parent[uid] in keeping:
                path = tree.nodes[uid].path
                yield f"{path} is not reset between its starts, so {self.requirement.name} may count too few of them"
                break

    @property
    def is_over_run(self) -> bool:
        """Whether the clause is judged at the end of a run."""
        return self._judge_run is not None

    def verdict(self, open_run: Run | None = None) -> ClauseVerdict:
        """The verdict on all judgements so far, with those of the open run if that is given."""
        tally = self._tally.result() if open_run is None else self._tally.so_far(open_run, self.broken.values())
        measures = self._measures() if self._with_measures else None
        return verdict_on(self.demand, self.findings, tally, self.is_over_run, measures)

    def _measures(self) -> Measures:
        edge, odds = self._edge, self.requirement.odds
        is_exact = edge is not None and self._margins.is_exact
        return Measures(
            key=key_of(self.requirement, self.claim, edge),
            place=self.demand.place,
            bound=edge.value.si if edge is not None else None,
            odds=(odds.relation, odds.probability) if odds is not None else None,
            missing=self.findings.missing,
            has_run=self.findings.has_run,
            margins=self._margins if is_exact else None,
        )

    @property
    def text(self) -> str:
        """As of its demand."""
        return self.demand.text


def _clocked(judgement: Judgement | None, root: Activation | None) -> Judgement | None:
    """The judgement, unknown if it depends on the order of events in a run during which the clock was set back."""
    if judgement is None or root is None or root.timing != "broken":
        return judgement
    return Judgement(None, judgement.at, CLOCK_SET_BACK)


_FIRST: Final[Moment] = (0, 0)
_WITHOUT_SUCCESS: Final[dict[Outcome, str]] = {"F": "failed", "H": "halted"}
# The operands that bound the time since something began.
_OF_TIME: Final = ("duration", "deadline", "reaction", "answer", "stretch")
