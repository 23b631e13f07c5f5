"""What scenarios have met of all that can happen to nodes."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

from btq_lang.scenarios.mission import ScenarioMission, position_of
from btq_lang.scenarios.outcomes import NodeOutcomes
from btq_lang.scenarios.results import CoverageReport, CoveredNode, CoveredOutcome, OutcomePlace
from btq_lang.syntax.tree import Tree


def coverage(
    missions: Sequence[tuple[ScenarioMission, NodeOutcomes]], met: Iterable[frozenset[tuple[OutcomePlace, str]]]
) -> CoverageReport:
    """The coverage of missions by scenarios.

    Args:
        met: the outcomes that each scenario has met.
    """
    counts = Counter(outcome for each in met for outcome in each)
    words: dict[OutcomePlace, dict[str, None]] = {}
    for _, outcomes in missions:
        for place, possible in outcomes.possible.items():
            words[place] = words.get(place, {}) | dict.fromkeys(possible)
    nodes = [
        CoveredNode(place, tuple(CoveredOutcome(word, counts[place, word]) for word in possible))
        for place, possible in sorted(words.items(), key=lambda item: item[0].position)
    ]
    return CoverageReport(tuple(nodes), _unused(missions))


def _unused(missions: Sequence[tuple[ScenarioMission, NodeOutcomes]]) -> tuple[OutcomePlace, ...]:
    """The trees that no scenario runs."""
    used = {tree for _, outcomes in missions for tree in outcomes.trees}
    places: dict[OutcomePlace, None] = {}
    for mission, _ in missions:
        for path in mission.workspace.registered_with(mission.path):
            file = mission.workspace.files[path]
            for tree in file.of_type(Tree):
                name = tree.name.text if tree.name is not None else None
                if (path, name) not in used:
                    places[OutcomePlace(*position_of(mission.workspace, path, tree, tree.start), name or "")] = None
    return tuple(sorted(places, key=lambda place: place.position))
