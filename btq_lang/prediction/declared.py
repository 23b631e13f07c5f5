"""What btq.toml declares of skills: their durations, results, writes, and what conditions answer."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from math import exp, log
from statistics import NormalDist
from typing import Final

from btq_lang.prediction.skill import AT_ONCE, P95, DrawnActivation, Probability, Skill, SkillOutcome
from btq_lang.prediction.streams import Stream
from btq_lang.requirements.model import Condition
from btq_lang.requirements.simulation import (
    DeclaredSignal,
    Problem,
    ResolvedSkill,
    SettingsReader,
    is_condition,
)
from btq_lang.scenarios.mission import ScenarioMission
from btq_lang.simulator.blackboard import type_of
from btq_lang.simulator.nodes import FAILURE, RUNNING, SUCCESS, SimulatedNode
from btq_lang.simulator.scripts import evaluate
from btq_lang.simulator.skills import Write
from btq_lang.syntax.script.parser import parse_script
from btq_lang.util.record import Record
from btq_lang.workspace.project_simulation import SimulationSettings, SkillSetting, Spread


class DeclaredSkill(Skill):
    """An action of which a setting says something; of the rest, another skill, or that it succeeds, at once."""

    __slots__ = ("_base", "_scripts", "_succeeds", "_takes")

    def __init__(
        self,
        takes: Spread | None = None,
        succeeds: float | None = None,
        writes: Iterable[tuple[str, str]] = (),
        base: Skill | None = None,
    ) -> None:
        self._scripts: Final = tuple((key, parse_script(text).statements[0]) for key, text in writes)
        says_all = takes is not None and succeeds is not None
        is_measured = not says_all and base is not None and base.source == "measured"
        has_waited = takes is None and base is not None and base.has_waited
        keys = tuple(key for key, _ in self._scripts)
        super().__init__("measured" if is_measured else "declared", keys, has_waited)
        self._takes: Final = takes
        self._succeeds: Final = succeeds
        self._base: Final = None if says_all else base

    def draw(self, random: Stream) -> DrawnActivation:
        """Draw a duration and a result; each has a number of its own, whether it is needed or not."""
        place, chance = random.next(), random.next()
        base = self._base.draw(random) if self._base is not None else _AT_ONCE
        if self._takes is None and base.result == RUNNING:
            return base
        takes = base.takes if self._takes is None else round(quantile(self._takes, place) * 1000)
        if self._succeeds is not None:
            return DrawnActivation(SUCCESS if chance < self._succeeds else FAILURE, takes, base.writes)
        for _ in range(_MOST_DRAWS):  # one that runs on, which the declared duration excludes
            if base.result != RUNNING or self._base is None:
                break
            base = self._base.draw(random)
        return DrawnActivation(base.result, takes, base.writes)

    def outcomes(self) -> Sequence[SkillOutcome]:
        """As `draw`: the declared duration and result, each independent of all else."""
        base = self._base.outcomes() if self._base is not None else (SkillOutcome(SUCCESS, Fraction(1), AT_ONCE),)
        if self._takes is not None:
            base = [SkillOutcome(each.result, each.probability, self._takes) for each in _ended(base)]
        if self._succeeds is None:
            return base
        chance = Fraction(self._succeeds).limit_denominator(_FINEST)
        succeeds = [SkillOutcome(SUCCESS, each.probability * chance, each.takes) for each in base if each.takes]
        fails = [SkillOutcome(FAILURE, each.probability * (1 - chance), each.takes) for each in base if each.takes]
        return [*succeeds, *fails, *(each for each in base if each.takes is None)]

    def writes(self, node: SimulatedNode, drawn: DrawnActivation, has_real_truth: bool) -> tuple[Write, ...] | None:
        """The values of its scripts, where it succeeds."""
        if drawn.result != SUCCESS or not self._scripts:
            return drawn.writes
        values = [(key, evaluate(script, node.board, has_real_truth)) for key, script in self._scripts]
        own = tuple(Write(key, value, type_of(value)) for key, value in values if value is not None)
        return (*(drawn.writes or ()), *own)


def _ended(outcomes: Sequence[SkillOutcome]) -> Sequence[SkillOutcome]:
    """Those that end, with the probability of the others."""
    ending = [each for each in outcomes if each.takes is not None]
    total: Probability = sum((each.probability for each in ending), Fraction(0))
    return [SkillOutcome(each.result, each.probability / total, each.takes) for each in ending]


def share_within(spread: Spread, seconds: float) -> float:
    """The probability that a duration is at most so long."""
    if seconds < spread.low and spread.kind != "lognormal":
        return 0.0
    if spread.kind == "lognormal":
        if seconds <= 0:
            return 0.0
        if spread.high == spread.low:
            return float(seconds >= spread.low)
        return _NORMAL.cdf(log(seconds / spread.low) * P95 / log(spread.high / spread.low))
    return 1.0 if seconds >= spread.high else (seconds - spread.low) / (spread.high - spread.low)


def quantile(spread: Spread, probability: float) -> float:
    """The duration, in seconds, that is not exceeded with a probability between 0 and 1."""
    if spread.kind == "lognormal":
        deviations = _NORMAL.inv_cdf(probability) / P95
        return exp(log(spread.low) + log(spread.high / spread.low) * deviations)
    return spread.low + (spread.high - spread.low) * probability


class Outages:
    """When a condition fails in one run, whatever else it would answer: `lasts` seconds each time, and `fails` times a
    second on average.

    The process is stationary: it may fail when the run begins.  Between two failures it works for a time with an
    exponential distribution.
    """

    def __init__(self, fails: float, lasts: float, random: Stream) -> None:
        """Begin a run; `random`: its stream, of which nothing else takes numbers."""
        self._random: Final = random
        self._lasts: Final = lasts
        self._works: Final = 1 / fails - lasts  # for how long, on average
        self._changes: list[float] = []  # in milliseconds: it begins and ends to fail, in turn
        if random.next() < fails * lasts:
            self._changes += [-1.0, random.next() * lasts * 1000]

    def is_out(self, now: int) -> bool:
        """Whether it fails at a time, in milliseconds since the start of the run."""
        return self._next(now) % 2 == 1

    def next_change(self, now: int) -> int:
        """The first whole millisecond, later than `now`, from which on that may be otherwise."""
        return int(self._changes[self._next(now)]) + 1

    def _next(self, now: int) -> int:
        """The index of the first change after a time."""
        while not self._changes or self._changes[-1] <= now:
            last = self._changes[-1] if self._changes else 0.0
            begin = last - log(self._random.next()) * self._works * 1000
            self._changes += [begin, begin + self._lasts * 1000]
        return bisect_right(self._changes, now)


class DeclaredCondition(Record):
    """What a condition answers.

    Attributes:
        condition: over signals and entries; None: it is always true.
        fails: how often it begins to fail, per second; 0: never.
        lasts: for how many seconds it then fails.
    """

    condition: Condition | None = None
    fails: float = 0.0
    lasts: float = 0.0

    def outages(self, random: Stream) -> Outages | None:
        """When it fails in the run of a stream; None: never."""
        return Outages(self.fails, self.lasts, random) if self.fails else None


class DeclaredWorld(Record):
    """What btq.toml declares for a mission.

    Attributes:
        skills: what its actions do, by the numbers of the nodes.
        conditions: what its conditions answer, likewise.
        signals: how signals change.
        problems: what is wrong with the settings, as far as they are about this mission.
    """

    skills: dict[int, Skill]
    conditions: dict[int, DeclaredCondition]
    signals: tuple[DeclaredSignal, ...] = ()
    problems: tuple[Problem, ...] = ()


def declared_world(
    settings: SimulationSettings, mission: ScenarioMission, measured: Mapping[int, Skill] | None = None
) -> DeclaredWorld:
    """What is declared of the nodes and signals of a mission; each aspect as the most specific setting says.

    Args:
        measured: what else is known of skills, by the numbers of the nodes: they do what no setting says.
    """
    reader = SettingsReader(mission.workspace.store, mission.path)
    resolved = [each for setting in settings.skills if (each := reader.skill(setting)) is not None]
    by_uid: dict[int, list[tuple[tuple[int, int, int], ResolvedSkill]]] = {}
    for place, each in enumerate(resolved):
        uids = {uid for target in each.targets for uid in mission.uids(target)}
        for uid in uids:
            rank = each.setting.name.count("/"), -len(uids), place
            by_uid.setdefault(uid, []).append((rank, each))
    skills: dict[int, Skill] = {}
    conditions: dict[int, DeclaredCondition] = {}
    for uid, ranked in sorted(by_uid.items()):
        skill_settings = [each for _, each in sorted(ranked, key=lambda pair: pair[0], reverse=True)]
        if is_condition(mission.written[uid]):
            conditions[uid] = _condition(skill_settings)
        else:
            skills[uid] = _skill([each.setting for each in skill_settings], (measured or {}).get(uid))
    signals = tuple(signal for setting in settings.world if (signal := reader.signal(setting)) is not None)
    return DeclaredWorld(skills, conditions, signals, tuple(reader.problems))


def _skill(settings: list[SkillSetting], measured: Skill | None) -> DeclaredSkill:
    """What the settings of an action say, the most specific one first."""
    takes = next((each.takes for each in settings if each.takes is not None), None)
    succeeds = next((each.succeeds for each in settings if each.succeeds is not None), None)
    writes: dict[str, str] = {}
    for setting in reversed(settings):
        writes.update(setting.writes)
    return DeclaredSkill(takes, succeeds, writes.items(), measured)


def _condition(resolved: list[ResolvedSkill]) -> DeclaredCondition:
    """What the settings of a condition say, the most specific one first."""
    condition = next((each.condition for each in resolved if each.condition is not None), None)
    failing = next((each.setting for each in resolved if each.setting.fails), None)
    if failing is None:
        return DeclaredCondition(condition)
    return DeclaredCondition(condition, failing.fails, failing.lasts)


_AT_ONCE: Final = DrawnActivation(SUCCESS, 0, ())
_MOST_DRAWS: Final = 100
_FINEST: Final = 10**9  # no one writes a share with more digits
_NORMAL: Final = NormalDist()
