"""Whether a run is as expected: claims and requirements are judged as in `btq verify`, by the rows of the run."""

from __future__ import annotations

from typing import Final

from btq_lang.evidence.conditions import truth
from btq_lang.evidence.evaluate import MissionEvaluation
from btq_lang.evidence.history import History, Nearby
from btq_lang.evidence.model import FAILURE, ROOT, SampleSeries
from btq_lang.evidence.observed import Observed
from btq_lang.evidence.signals import Signals, UnknownValue
from btq_lang.evidence.verdicts import (
    NEVER,
    SATISFIED,
    UNDECIDED,
    UNKNOWN,
    VIOLATED,
    ClauseVerdict,
    RequirementVerdict,
    Violation,
)
from btq_lang.evidence.wording import quantity
from btq_lang.requirements.model import ResolvedSignal, signals_in
from btq_lang.requirements.one_run import needs_runs, shown_by_one
from btq_lang.scenarios.mission import ScenarioMission
from btq_lang.scenarios.plan import (
    Expectation,
    ExpectedClaims,
    ExpectedEnd,
    ExpectedValues,
    Plan,
    WantedEnd,
    WantedVerdict,
)
from btq_lang.scenarios.results import ExpectationResult, Outcome, Step
from btq_lang.scenarios.running import START, ScenarioRun, Start
from btq_lang.simulator.blackboard import Unknown, Unsaid
from btq_lang.simulator.errors import NotModelled
from btq_lang.simulator.skills import is_value
from btq_lang.util.record import replace


def judged(mission: ScenarioMission, plan: Plan, run: ScenarioRun) -> tuple[ExpectationResult, ...]:
    """The result of each expectation; the last one is that the run ends, if it does not, unless that is expected."""
    verdicts = _verdicts(mission, plan, run)
    judge = _Judge(mission, run, verdicts)
    results = [judge.result(expectation) for expectation in plan.expectations]
    is_expected = any(each.expected == WantedEnd("does not end") for each in plan.expectations)
    if run.end == "does not end" and not is_expected:
        step = Step(run.now / 1000, *judge.node(ROOT), "it goes on for ever", "an end")
        results.append(ExpectationResult("mission ends", 0, "failed", "", step))
    return tuple(results)


def _verdicts(mission: ScenarioMission, plan: Plan, run: ScenarioRun) -> dict[str, RequirementVerdict]:
    """The verdicts of the requirements and claims that are expected, by name.

    A scenario is a test, so it judges the clauses of a requirement whatever the ways to verify that.
    """
    expected = [expectation.expected for expectation in plan.expectations]
    names = {each.name for each in expected if isinstance(each, WantedVerdict)}
    claims = [each for each in expected if isinstance(each, ExpectedClaims)]
    if not names and not claims:
        return {}
    requirements = mission.requirements
    demanded = {name: replace(each, ways=()) for name, each in requirements.all.items() if name in names}
    applied = [
        replace(each, requirement=replace(each.requirement, ways=()))
        for each in requirements.applied
        if each.requirement.name in names
    ]
    candidate, joined = mission.judged_with(
        replace(
            requirements,
            all={**demanded, **{claim.requirement.name: claim.requirement for claim in claims}},
            applied=(*applied, *(each for claim in claims for each in claim.applied)),
        )
    )
    evaluation = MissionEvaluation(candidate)
    evaluation.read(run.session(mission), joined, run.signals, 1, "the scenario")
    return {verdict.id: verdict for verdict in evaluation.verdicts()}


class _Judge:
    def __init__(self, mission: ScenarioMission, run: ScenarioRun, verdicts: dict[str, RequirementVerdict]) -> None:
        self._mission: Final = mission
        self._run: Final = run
        self._verdicts: Final = verdicts

    def result(self, expectation: Expectation) -> ExpectationResult:
        """The result of an expectation."""
        expected = expectation.expected
        why = note = ""
        step: Step | None
        if isinstance(expected, ExpectedClaims):
            step, why = self._claims(self._verdicts[expected.requirement.name], expectation.text)
        elif isinstance(expected, WantedVerdict):
            step, why = self._verdict(self._verdicts[expected.name], expected)
            note = _not_exercised(self._verdicts[expected.name])
        elif isinstance(expected, ExpectedValues):
            step, why = self._values(expected)
        elif isinstance(expected, ExpectedEnd):
            step, why = self._end(expected, expectation.text)
        else:
            step = None if self._run.end == expected.end else self._at_end(_EXPECTED[expected.end])
        outcome: Outcome = "failed" if step is not None else "unknown" if why else "passed"
        return ExpectationResult(expectation.text, expectation.line, outcome, why, step, note)

    def node(self, uid: int) -> tuple[str, str, int]:
        """The path, the file and the line of a node; of a guard, those of the node that it guards."""
        uid = self._mission.guarded(uid)
        return (self._mission.tree.nodes[uid].path, *self._mission.place(uid))

    def _at_end(self, expected: str) -> Step:
        how = "it does not end" if self._run.end == "does not end" else f"the mission {self._run.end}"
        return Step(self._run.now / 1000, *self.node(ROOT), how, expected)

    # ---- claims and verdicts ----

    def _claims(self, verdict: RequirementVerdict, text: str) -> tuple[Step | None, str]:
        if verdict.verdict == SATISFIED:
            return None, ""
        for clause in verdict.clauses:
            if clause.verdict == VIOLATED and clause.violations:
                return self._violation(clause.violations[0], text), ""
        why = next((clause.why for clause in verdict.clauses if clause.why), verdict.verdict)
        if verdict.verdict in (UNKNOWN, UNDECIDED):
            return None, why
        if self._run.end == "is halted" and ROOT in (self._uid(clause.path) for clause in verdict.clauses):
            why = "it was halted"
        return replace(self._at_end(text), happened=why or "it never ran"), ""

    def _uid(self, path: str) -> int:
        """The number of a node by its path; of the root of the mission, that of the root that runs."""
        paths = {node.path: uid for uid, node in reversed(self._mission.tree.nodes.items())}
        uid = paths.get(path, ROOT)
        return ROOT if uid == self._mission.guarded(ROOT) else uid

    def _violation(self, violation: Violation, expected: str) -> Step:
        """The step that broke a clause: where a failure began, or else the node itself."""
        origin = next((link for link in violation.chain if link.kind == "origin"), None)
        uid = self._uid(origin.path if origin is not None else violation.path)
        at, happened = violation.at, violation.why
        if origin is not None:
            failures = [time for time, row_uid, status in self._run.rows if (row_uid, status) == (uid, FAILURE)]
            at, happened = ((failures[-1] - START) / 1e6 if failures else at), "it fails"
        elif self._run.end == "does not end" and uid == ROOT:
            happened = "it does not end"
        elif violation.measured and violation.passed is not None:
            at, happened = violation.passed, f"not over yet: {happened}"
        guard = self._mission.joined.enforcing().get(uid)
        if guard is not None and happened in _FAILURES:
            happened = f"the guard of {guard} fails"
        return Step(at, *self.node(uid), happened, expected)

    def _verdict(self, verdict: RequirementVerdict, expected: WantedVerdict) -> tuple[Step | None, str]:
        actual = verdict_in_words(verdict)
        if actual == expected.verdict:
            return None, ""
        why = self._undecided(expected.name) if actual in (UNDECIDED, UNKNOWN) else ""
        why = "; ".join(filter(None, (next((_why(clause) for clause in verdict.clauses if clause.why), ""), why)))
        if actual == UNKNOWN and expected.verdict in (SATISFIED, VIOLATED):
            return None, why
        wanted = f"{expected.name} {expected.verdict}"
        if actual == VIOLATED:
            violations = [violation for clause in verdict.clauses for violation in clause.violations]
            first = min(violations, key=lambda violation: violation.at)
            return self._violation(first, f"{wanted}{f', bound {first.bound}' if first.bound else ''}"), ""
        return replace(self._at_end(wanted), happened=f"{expected.name} is {actual}{f': {why}' if why else ''}"), ""

    def _undecided(self, name: str) -> str:
        """Why this run alone cannot decide a requirement about many; empty if it is not about many."""
        requirement = self._mission.requirements.all[name]
        what = needs_runs(requirement)
        shown = " and ".join(f"`expect {text}`" for text in shown_by_one(requirement))
        return f"one run cannot decide {what}{f'; {shown} is what it can show' if shown else ''}" if what else ""

    # ---- values of ports ----

    def _values(self, expected: ExpectedValues) -> tuple[Step | None, str]:
        try:
            return self._other_value(expected), ""
        except NotModelled as error:
            return None, str(error)

    def _other_value(self, expected: ExpectedValues) -> Step | None:
        """The first activation with another value than expected."""
        starts = [
            start
            for start in self._run.starts
            if start.uid in expected.uids and all(self._is(start, *pair) for pair in expected.pairs)
        ]
        for start, value in zip(starts, expected.values, strict=False):
            if not self._is(start, expected.port, value):
                return self._other(start, expected.port, f'"{value}"')
        if len(starts) > len(expected.values):
            start = starts[len(expected.values)]
            return self._other(start, expected.port, "no further activation")
        if len(starts) < len(expected.values):
            value = expected.values[len(starts)]
            step = self._at_end(f'"{value}"')
            return replace(step, happened=f"{step.happened}, and the node has not run with it")
        return None

    def _value(self, start: Start, port: str | None) -> str | Unknown | None:
        name = port or self._mission.input_port(start.uid)
        return start.values.get(name) if name is not None else None

    def _is(self, start: Start, port: str | None, wanted: str) -> bool:
        """Whether a node began with a value.

        Raises:
            NotModelled: nothing says with which it did.
        """
        value = self._value(start, port)
        if isinstance(value, Unsaid):
            name = port or self._mission.input_port(start.uid)
            raise NotModelled(f"{self.node(start.uid)[0]} reads its port `{name}`, and {value.why()}")
        return is_value(value, wanted)

    def _other(self, start: Start, port: str | None, expected: str) -> Step:
        actual = self._value(start, port)
        if isinstance(actual, Unsaid):
            happened = f"it runs, and {actual.why()}"
        else:
            happened = f'it runs with "{actual}"' if actual is not None else "it runs with no value"
        return Step(start.at / 1000, *self.node(start.uid), happened, expected)

    # ---- the end ----

    def _end(self, expected: ExpectedEnd, text: str) -> tuple[Step | None, str]:
        begin, end = (START, 0), (START + self._run.now * 1000, 0)
        signals = Signals(self._run.signals, self._run.entries)
        holds = truth(expected.condition, Observed(signals, _NothingRuns(self._mission), begin, end), end)
        if isinstance(holds, UnknownValue):
            unset = [each.name for each in signals_in(expected.condition) if not _series_of(each, self._run)]
            return None, f"nothing gives `{unset[0]}` a value" if unset else holds.why
        if holds:
            return None, ""
        read = {signal.name: signal for signal in signals_in(expected.condition)}
        values = [f"{name} is {_shown(signals.reading(signal, end[0]), signal)}" for name, signal in read.items()]
        return replace(self._at_end(text), happened=", ".join(values) or "it does not hold"), ""


def verdict_in_words(verdict: RequirementVerdict) -> str:
    """A verdict as a scenario expects it."""
    is_not_applicable = verdict.verdict == NEVER and any(clause.not_applicable for clause in verdict.clauses)
    return "not applicable" if is_not_applicable else verdict.verdict


def _not_exercised(verdict: RequirementVerdict) -> str:
    """The clauses that nothing exercised at any node, if others were; empty without any."""
    exercised = {clause.text for clause in verdict.clauses if clause.verdict != NEVER}
    others = {clause.text: clause for clause in verdict.clauses if clause.text not in exercised}
    if not exercised:
        return ""
    return "; ".join(f"`{text}` is never exercised: {_why(clause)}" for text, clause in others.items())


class _NothingRuns(Nearby):
    """The nodes after the end of the run."""

    def __init__(self, mission: ScenarioMission) -> None:
        super().__init__(ROOT, mission.joined, History())

    def runs(self, target: object, moment: object, is_early: bool) -> bool:
        """Nothing runs."""
        return False


def _series_of(signal: ResolvedSignal, run: ScenarioRun) -> SampleSeries | None:
    return run.signals.get(signal.name) or run.entries.get(signal.entry)


def _shown(value: object, signal: ResolvedSignal) -> str:
    """The value of a signal, a number in its unit."""
    if isinstance(value, bool):
        return "true" if value else "false"
    return quantity(value, signal.unit) if isinstance(value, int | float) else f'"{value}"'


def _why(clause: ClauseVerdict) -> str:
    """Why a clause has its verdict, with the path of its node."""
    return f"{clause.path} {clause.why[3:]}" if clause.path and clause.why.startswith("it ") else clause.why


_FAILURES: Final = ("it fails", "failed")  # what happened where a guard did it
_EXPECTED: Final = {
    "fails": "the mission fails",
    "is halted": "the mission is halted",
    "does not end": "it goes on for ever",
}
