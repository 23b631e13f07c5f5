"""Which changes of a mission no scenario notices.

One invariant: a mutant is noticed if a scenario that is as expected without it is not so with it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from btq_lang.scenarios.mutants import NamedMutant
from btq_lang.scenarios.mutating import Mutant
from btq_lang.scenarios.parallel import results
from btq_lang.scenarios.results import MutantReport, MutantResult, OutcomePlace
from btq_lang.scenarios.suite import ScenarioPlace, Suite
from btq_lang.util.record import Record


class TestedScenario(Record):
    """A scenario that has run.

    Attributes:
        suite: the index of its suite.
        begun: the nodes that began or were skipped, if it is as expected; else none.
        mutants: of its mission.
    """

    suite: int
    place: ScenarioPlace
    begun: frozenset[int]
    mutants: tuple[NamedMutant, ...]


def tested(suites: Sequence[Suite], scenarios: Iterable[TestedScenario], limit: int, jobs: int) -> MutantReport:
    """Run the scenarios that reach a change with it, for each change.

    Args:
        limit: how many mutants at most, an even sample of all; 0: all.
        jobs: how many processes.
    """
    trials: dict[tuple[OutcomePlace, str], list[_Trial]] = {}
    for scenario in scenarios:
        for named in scenario.mutants:
            of_mutant = trials.setdefault((named.place, named.what), [])
            if any(uid in scenario.begun for uid, _ in named.mutant.changes):
                of_mutant.append(_Trial(scenario.suite, scenario.place, named.mutant))
    names = sorted(trials, key=lambda name: name[0].position)
    if 0 < limit < len(names):
        names = [names[index * len(names) // limit] for index in range(limit)]
    noticed = results(suites, _noticed_by, [tuple(trials[name]) for name in names], jobs)
    mutants = [
        MutantResult(place, what, bool(trials[place, what]), title)
        for (place, what), title in zip(names, noticed, strict=True)
    ]
    return MutantReport(len(trials), tuple(mutants))


class _Trial(Record):
    suite: int
    place: ScenarioPlace
    mutant: Mutant


def _noticed_by(suites: Sequence[Suite], trials: tuple[_Trial, ...]) -> str:
    """The title of the first scenario that is not as expected; empty if all are."""
    for trial in trials:
        result = suites[trial.suite].ran(trial.place, False, trial.mutant).result
        if result.outcome != "passed":
            return result.title
    return ""
