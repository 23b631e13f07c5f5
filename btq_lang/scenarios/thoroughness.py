"""How thorough scenarios are: what they have met, and which changes of the mission they notice."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache, partial

from btq_lang.scenarios.coverage import coverage
from btq_lang.scenarios.mission import ScenarioMission
from btq_lang.scenarios.mutants import NamedMutant, mutants
from btq_lang.scenarios.mutation_testing import TestedScenario, tested
from btq_lang.scenarios.outcomes import NodeOutcomes
from btq_lang.scenarios.parallel import results
from btq_lang.scenarios.results import OutcomePlace, ScenarioReport, ScenarioResult
from btq_lang.scenarios.suite import ScenarioPlace, Suite
from btq_lang.util.record import Record


def thorough_report(
    suites: Sequence[Suite],
    wanted: Sequence[tuple[int, ScenarioPlace]],
    is_drawn: bool,
    is_covered: bool,
    most_mutants: int | None,
    jobs: int,
) -> ScenarioReport:
    """Run scenarios, and say how thorough they are.

    Args:
        wanted: each scenario with the index of its suite.
        is_drawn: all runs are drawn.
        is_covered: whether coverage is wanted.
        most_mutants: how many mutants at most; 0: all; None: none are wanted.
        jobs: how many processes.
    """
    runs = [*results(suites, partial(_run, is_drawn), wanted, jobs)]
    missions: dict[int, tuple[ScenarioMission, NodeOutcomes]] = {}
    of_mission: dict[int, tuple[NamedMutant, ...]] = {}
    scenarios: list[TestedScenario] = []
    for (index, place), run in zip(wanted, runs, strict=True):
        mission = suites[index].mission(place)
        if mission is None:
            continue
        if id(mission) not in missions:
            missions[id(mission)] = mission, _outcomes(mission)
            if most_mutants is not None:
                of_mission[id(mission)] = mutants(*missions[id(mission)])
        begun = run.begun if run.result.outcome == "passed" else frozenset()
        scenarios.append(TestedScenario(index, place, begun, of_mission.get(id(mission), ())))
    return ScenarioReport(
        tuple(run.result for run in runs),
        coverage([*missions.values()], [run.met for run in runs]) if is_covered else None,
        tested(suites, scenarios, most_mutants, jobs) if most_mutants is not None else None,
    )


class _Thorough(Record):
    """A scenario that has run, with the outcomes that it has met, and the nodes that began or were skipped."""

    result: ScenarioResult
    met: frozenset[tuple[OutcomePlace, str]]
    begun: frozenset[int]


def _run(is_drawn: bool, suites: Sequence[Suite], wanted: tuple[int, ScenarioPlace]) -> _Thorough:
    ran = suites[wanted[0]].ran(wanted[1], is_drawn)
    if ran.mission is None or ran.run is None:
        return _Thorough(ran.result, frozenset(), frozenset())
    begun = frozenset(start.uid for start in ran.run.starts) | ran.run.skipped
    return _Thorough(ran.result, _outcomes(ran.mission).met(ran.run), begun)


_outcomes = cache(NodeOutcomes)  # of each mission once in a process
