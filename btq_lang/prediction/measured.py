"""What skills did in logs, as what they will do: whole activations are drawn again, duration and result together.

A halted activation would have gone on: it says how long the skill takes at least.  Sources: E. L. Kaplan, P. Meier,
Nonparametric estimation from incomplete observations, JASA 53 (1958); with two results, O. O. Aalen, S. Johansen, An
empirical transition matrix for non-homogeneous Markov chains based on censored observations, Scand. J. Statist. 5
(1978).  Both suppose that what halts a skill does not depend on how long it would have gone on.  The uncertainty: B.
Efron, Censored data and the bootstrap, JASA 76 (1981), with runs drawn instead of activations, because those of one run
are not independent.
"""

from __future__ import annotations

from bisect import bisect_right
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from itertools import accumulate, groupby
from typing import Final, Literal, TypeAlias

from btq_lang.evidence.model import SampleValue
from btq_lang.prediction.skill import DrawnActivation, Skill, SkillOutcome
from btq_lang.prediction.streams import Stream
from btq_lang.simulator.blackboard import BOOL, type_of
from btq_lang.simulator.nodes import FAILURE, RUNNING, SUCCESS
from btq_lang.simulator.skills import Write
from btq_lang.util.record import Record

Scope: TypeAlias = Literal["path", "kind"]


class MeasuredActivation(Record):
    """An activation of a skill in a log.

    Attributes:
        node: its name, as `node_names` of `evidence/store/rows.py` has it.
        kind: the name under which the skill is registered.
        result: SUCCESS or FAILURE; RUNNING: it was halted, or the log ends.
        seconds: how long it took, or had taken by then.
        writes: the values of entries when it ended, by the ports that name them, as far as they are known.
    """

    node: str
    kind: str
    result: int
    seconds: float
    writes: tuple[tuple[str, SampleValue], ...] = ()


class MeasuredSkill(Skill):
    """What some activations show of a skill.

    Attributes:
        by: whether they are of one node, or of all nodes of its kind.
        number: how many there are.
        ended: how many of them ended by themselves.
        longest: the longest of them, in milliseconds, ended or not.
        beyond: the probability of an activation that is longer than all that ended; that it runs on is a guess.
    """

    __slots__ = ("_drawn", "_steps", "beyond", "by", "ended", "longest", "number")

    def __init__(self, activations: Iterable[tuple[MeasuredActivation, int]], by: Scope = "path") -> None:
        """Take activations, at least one, each with how often it counts."""
        super().__init__("measured", has_waited=True)
        in_order = sorted(activations, key=lambda pair: pair[0].seconds)
        at_risk = self.number = sum(times for _, times in in_order)
        mass = 1.0  # of activations that are not shorter
        masses: list[float] = []
        drawn: list[DrawnActivation] = []
        for _, at_one_time in groupby(in_order, key=lambda pair: pair[0].seconds):
            weighed = [*at_one_time]
            ends = [(each, times) for each, times in weighed if each.result != RUNNING]
            for each, times in ends:  # before the halts of this time, which could have seen them
                masses.append(mass * times / at_risk)
                drawn.append(DrawnActivation(each.result, _milliseconds(each), _writes(each)))
            mass *= 1 - sum(times for _, times in ends) / at_risk
            at_risk -= sum(times for _, times in weighed)
        self.by: Final = by
        self.ended: Final = sum(times for each, times in in_order if each.result != RUNNING)
        self.longest: Final = _milliseconds(in_order[-1][0])
        self.beyond: Final = mass
        self._steps: Final = [*accumulate(masses)]
        self._drawn: Final = (
            [*drawn, DrawnActivation(RUNNING, self.longest, None, True)] if mass > 0 or not drawn else drawn
        )

    def draw(self, random: Stream) -> DrawnActivation:
        """Draw one of the activations that ended, or one that is longer than all of them."""
        return self._drawn[min(bisect_right(self._steps, random.next()), len(self._drawn) - 1)]

    def outcomes(self) -> Sequence[SkillOutcome]:
        """The results, each with the durations that it had."""
        outcomes: list[SkillOutcome] = []
        for result in (SUCCESS, FAILURE):
            total = self.probability(result)
            takes: dict[int, float] = {}
            for mass, each in self._masses():
                if each.result == result and mass > 0:
                    takes[each.takes] = takes.get(each.takes, 0.0) + mass / total
            outcomes += [SkillOutcome(result, total, takes)] if takes else []
        running = 1 - sum(float(each.probability) for each in outcomes)
        return [*outcomes, SkillOutcome(RUNNING, running, None)] if self.beyond > 0 or not outcomes else outcomes

    def _masses(self) -> Iterable[tuple[float, DrawnActivation]]:
        """The activations that ended, with their probabilities."""
        masses = (after - before for before, after in zip((0.0, *self._steps), self._steps, strict=False))
        return zip(masses, self._drawn, strict=False)

    def probability(self, result: int, within: float = float("inf")) -> float:
        """The probability that an activation has a result if it is not halted.

        Args:
            result: SUCCESS, FAILURE; RUNNING: it is longer than all that ended.
            within: seconds, at most; not for RUNNING.
        """
        if result == RUNNING:
            return self.beyond
        return sum(mass for mass, each in self._masses() if each.result == result and each.takes <= within * 1000)


class MeasuredSkills:
    """What skills did in the runs of logs.

    Attributes:
        runs: how many there are.
    """

    def __init__(self, runs: Sequence[Sequence[MeasuredActivation]]) -> None:
        """Take the activations of skills in each run."""
        self.runs: Final = len(runs)
        self._by: Final[dict[tuple[Scope, str], list[tuple[MeasuredActivation, int]]]] = {}  # each with its run
        for run, activations in enumerate(runs):
            for each in activations:
                self._by.setdefault(("path", each.node), []).append((each, run))
                self._by.setdefault(("kind", each.kind), []).append((each, run))

    def of_nodes(
        self, nodes: Mapping[int, tuple[str, str]], times: Mapping[int, int] | None = None
    ) -> dict[int, MeasuredSkill]:
        """What nodes will do: each what its own activations show if there are at least 30, else those of its kind.

        Args:
            nodes: the name and the kind of each node, by its number; those that never ran are left out.
            times: how often each run counts; None: once.
        """
        made: dict[tuple[Scope, str], MeasuredSkill] = {}
        skills: dict[int, MeasuredSkill] = {}
        for uid, (node, kind) in nodes.items():
            is_enough = len(self._by.get(("path", node), ())) >= ENOUGH_OF_A_NODE
            key: tuple[Scope, str] = ("path", node) if is_enough else ("kind", kind)
            if key in self._by and key not in made:
                made[key] = self._made(key, times)
            if key in made:
                skills[uid] = made[key]
        return skills

    def resampled(self, nodes: Mapping[int, tuple[str, str]], random: Stream) -> dict[int, MeasuredSkill]:
        """The same from as many runs, drawn with replacement: how the skills might have been measured as well.

        A skill that no drawn run has stays as it was measured.
        """
        return self.of_nodes(nodes, Counter(int(random.next() * self.runs) for _ in range(self.runs)))

    def _made(self, key: tuple[Scope, str], times: Mapping[int, int] | None) -> MeasuredSkill:
        activations = [(each, 1) for each, _ in self._by[key]]
        if times is not None:
            drawn = [(each, times[run]) for each, run in self._by[key] if run in times]
            activations = drawn or activations
        return MeasuredSkill(activations, key[0])


def _writes(activation: MeasuredActivation) -> tuple[Write, ...] | None:
    """What is known of the values that it wrote; None: nothing is."""
    values = [(port, value, isinstance(value, bool)) for port, value in activation.writes]
    return (
        tuple(
            Write(port, int(value) if is_bool else value, BOOL if is_bool else type_of(value))
            for port, value, is_bool in values
        )
        or None
    )


def _milliseconds(activation: MeasuredActivation) -> int:
    return round(activation.seconds * 1000)


ENOUGH_OF_A_NODE: Final = 30
