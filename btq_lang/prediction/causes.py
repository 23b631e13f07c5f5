"""Why runs miss a demand: some are made again with all their rows, and what led to the violations is counted."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from typing import Final, TypeAlias

from btq_lang.evidence.model import ROOT
from btq_lang.evidence.verdicts import CauseLink, ClauseVerdict, Violation
from btq_lang.prediction.judging import Judge
from btq_lang.prediction.report import Cause, PredictedClause
from btq_lang.prediction.runs import DrawnRun
from btq_lang.scenarios.mission import ScenarioMission
from btq_lang.scenarios.running import with_begins
from btq_lang.util.record import replace

Again: TypeAlias = Callable[[Sequence[int]], Sequence[DrawnRun]]


def with_causes(
    mission: ScenarioMission,
    again: Again,
    clauses: Sequence[tuple[ClauseVerdict, PredictedClause]],
    numbers: Sequence[int],
) -> list[PredictedClause]:
    """The clauses of a requirement, each with the main cause of its misses, and with the numbers that runs have.

    Args:
        again: makes runs again, by their numbers, with all rows.
        numbers: of the judged runs; violations count these from 1.
    """
    explained: list[PredictedClause] = []
    for verdict, clause in clauses:
        run = numbers[clause.worst_run - 1] if clause.worst_run is not None else None
        clause = replace(clause, worst_run=run)
        if verdict.violations:
            missing = [numbers[number - 1] for number in dict.fromkeys(each.run for each in verdict.violations)]
            clause = replace(clause, cause=_cause(mission, again(missing[:_LOOKED]), verdict))
        explained.append(clause)
    return explained


def _cause(mission: ScenarioMission, runs: Sequence[DrawnRun], verdict: ClauseVerdict) -> Cause | None:
    """The main cause of the violations of a clause in some runs."""
    leaves = mission.tree.leaves
    judge = Judge(mission)
    evaluation = judge.evaluation()
    judge.read(evaluation, (replace(run, rows=[*with_begins(run.rows, leaves)]) for run in runs))
    clauses = (clause for each in evaluation.verdicts() for clause in each.clauses)
    again = next((each for each in clauses if (each.text, each.path) == (verdict.text, verdict.path)), None)
    if again is None:
        return None
    first = {violation.run: violation for violation in reversed(again.violations)}
    causes = Counter(
        text for number, violation in sorted(first.items()) if (text := _text(mission, runs[number - 1], violation))
    )
    if not causes:
        return None
    text, number = causes.most_common(1)[0]
    return Cause(text, number / len(runs), len(runs))


def _text(mission: ScenarioMission, run: DrawnRun, violation: Violation) -> str:
    if run.end == "does not end":
        return "it does not end"
    if run.end == "throws":
        return "the engine throws an exception"
    if not violation.chain:
        return violation.why if not violation.measured else f"{_name(mission, violation.path)} is too long"
    return _of_link(mission, violation.chain[0])


def _of_link(mission: ScenarioMission, link: CauseLink) -> str:
    uid = next((uid for uid, node in mission.tree.nodes.items() if node.path == link.path), ROOT)
    guard = mission.joined.enforcing().get(uid)
    if guard is not None and link.kind == "origin":
        return f"the guard of {guard} fails"
    name = _name(mission, link.path)
    if link.kind in ("origin", "failure"):
        return f"{name} fails"
    return f"{name} takes long" if link.kind in ("part", "self") else f"while {name} runs" if link.path else link.text


def _name(mission: ScenarioMission, path: str) -> str:
    """The name of a node."""
    return next((node.name for node in mission.tree.nodes.values() if node.path == path), path)


_LOOKED: Final = 100  # runs that are made again
