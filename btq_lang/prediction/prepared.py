"""A mission ready for runs: who says what each of its skills does, and of which conditions nothing is said.

One invariant: each leaf of the program has exactly one source, and a condition without one keeps the mission from
running.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Final

from btq_lang.catalog.units import parse_unit
from btq_lang.evidence.evaluate import needed_nodes
from btq_lang.evidence.identity import without_number
from btq_lang.prediction.answers import DeclaredAnswers
from btq_lang.prediction.declared import DeclaredWorld
from btq_lang.prediction.robot import AnsweringCondition, Robot
from btq_lang.prediction.runs import LoadedRuns
from btq_lang.prediction.skill import AssumedSkill, Skill
from btq_lang.prediction.thresholds import look_at_conditions
from btq_lang.prediction.world import Course, CourseSettings
from btq_lang.requirements.model import Quantity, Running, parts_in, signals_in
from btq_lang.requirements.simulation import DeclaredSignal, is_condition, is_skill
from btq_lang.scenarios.mission import ScenarioMission
from btq_lang.simulator.leaves import tick_custom
from btq_lang.util.record import Record


class SkillSource(Record):
    """Who says what a leaf does.

    Attributes:
        path: of the node.
        source: `declared`, `measured` or `ASSUMED`.
    """

    path: str
    source: str


class PreparedMission(Record):
    """A mission whose runs can be made.

    Attributes:
        sources: of each leaf of the program.
        unanswered: the paths of the conditions of which nothing is said; with any, no run can be made.
    """

    mission: ScenarioMission
    loaded: LoadedRuns
    sources: tuple[SkillSource, ...]
    unanswered: tuple[str, ...]


def prepared(
    mission: ScenarioMission,
    world: DeclaredWorld,
    known: Mapping[int, Skill],
    with_all_rows: bool = False,
) -> PreparedMission:
    """A mission with its skills.

    Args:
        world: what is declared of conditions and signals.
        known: what actions do of which something is declared or was measured, by the numbers of nodes.
        with_all_rows: the rows of all nodes are wanted, and not only those on which verdicts depend.

    Raises:
        EngineError: the engine refuses the tree.
        NotModelled: it has something whose effect is not known.
    """
    requirements = mission.requirements
    parts = (tuple(requirements.applied), tuple(requirements.all.values()), tuple(requirements.contexts.values()))
    read = [*dict.fromkeys(signals_in(parts))]
    courses = {each.signal.name: Course(_course(each, mission)) for each in world.signals}
    robot = Robot(list(courses.values()), _stream_names(mission))
    leaves = {uid: node for uid, node in mission.written.items() if is_skill(node)}
    skills = {uid: known.get(uid) or AssumedSkill() for uid, node in leaves.items() if not is_condition(node)}
    conditions: dict[int, AnsweringCondition] = {}
    for uid, declared in world.conditions.items():
        targets = [part.target for part in parts_in(declared.condition) if isinstance(part, Running)]
        uids = {id(target): frozenset(mission.uids(target)) for target in targets}
        conditions[uid] = DeclaredAnswers(robot, declared, robot.live, uids)
    robot.have(skills, conditions)
    look_at_conditions((*parts, *(declared.condition for declared in world.conditions.values())), courses)
    needed = None if with_all_rows else needed_nodes(*mission.judged_with(requirements))
    loaded = LoadedRuns(mission, robot, read, _limit(parts), needed)
    own = [node.uid for node in loaded.nodes if node.rules.flow is tick_custom]
    paths = {uid: mission.tree.nodes[uid].path for uid in own}
    by_uid = {
        **{uid: skill.source for uid, skill in skills.items()},
        **{uid: each.source for uid, each in conditions.items()},
    }
    sources = tuple(SkillSource(path, by_uid[uid]) for uid, path in paths.items() if uid in by_uid)
    return PreparedMission(mission, loaded, sources, tuple(path for uid, path in paths.items() if uid not in by_uid))


def _course(declared: DeclaredSignal, mission: ScenarioMission) -> CourseSettings:
    rates = [
        (frozenset(uid for target in targets for uid in mission.uids(target)), rate) for targets, rate in declared.rates
    ]
    signal = declared.signal
    return CourseSettings(
        signal.name, signal.entry, declared.start, declared.rate, tuple(rates), declared.low, declared.high
    )


def _stream_names(mission: ScenarioMission) -> dict[int, str]:
    """A name for each node that stays when other nodes are added: its path without numbers, and which of several."""
    names: dict[int, str] = {}
    seen: Counter[str] = Counter()
    for uid, node in mission.tree.nodes.items():
        path = without_number(node.path)
        names[uid] = f"{path}#{seen[path]}" if seen[path] else path
        seen[path] += 1
    return names


def _limit(parts: object) -> int:
    """After how many milliseconds a run that has not ended never does: a hundred times the longest bound."""
    times = [part.si for part in parts_in(parts) if isinstance(part, Quantity) and part.unit.dimension == _TIME]
    return max(round(max(times, default=0.0) * 1000 * _TIMES), _LEAST)


_SECOND: Final = parse_unit("s")
assert _SECOND is not None, "it is a unit"
_TIME: Final = _SECOND.dimension
_TIMES: Final = 100
_LEAST: Final = 24 * 3600 * 1000  # ms, also where nothing is bounded
