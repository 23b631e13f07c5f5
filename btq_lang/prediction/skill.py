"""What a skill does in a drawn activation, by whatever source."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from math import exp, log
from statistics import NormalDist
from typing import Final, Literal, TypeAlias

from btq_lang.prediction.streams import Stream
from btq_lang.simulator.nodes import SUCCESS, SimulatedNode
from btq_lang.simulator.skills import Write
from btq_lang.util.record import Record
from btq_lang.workspace.project_simulation import Spread

Probability: TypeAlias = "Fraction | float"  # a fraction is exact
Source: TypeAlias = Literal["declared", "measured", "ASSUMED"]


class DrawnActivation(Record):
    """What a skill does in one activation.

    Attributes:
        result: SUCCESS, FAILURE or SKIPPED; RUNNING: it does not end.
        takes: in milliseconds; of one that does not end, for how long that is known.
        writes: at its end; None: unknown values; `Skill.writes` has those that depend on entries.
        is_guess: it is beyond the longest measured activation.
    """

    result: int
    takes: int
    writes: tuple[Write, ...] | None = None
    is_guess: bool = False


class SkillOutcome(Record):
    """How activations may end.

    Attributes:
        result: SUCCESS or FAILURE; RUNNING: they do not end.
        takes: how they are distributed: the probabilities of times in milliseconds, which add up to 1; None: of those
            that do not end.
    """

    result: int
    probability: Probability
    takes: Spread | Mapping[int, float] | None


class Skill:
    """What draws the activations of a skill.

    Attributes:
        source: who says what it does.
        keys: the entries, or ports that name some, of which it says what is written: their values are never unknown.
        has_waited: its durations are of a log, where an activation ends with the tick that sees its end.
    """

    __slots__ = ("has_waited", "keys", "source")

    def __init__(self, source: Source, keys: tuple[str, ...] = (), has_waited: bool = False) -> None:
        self.source: Final = source
        self.has_waited: Final = has_waited
        self.keys: Final = keys

    def draw(self, random: Stream) -> DrawnActivation:
        """Draw an activation; `random`: the stream of that activation."""
        raise NotImplementedError

    def success(self) -> float:
        """The probability that an activation succeeds, of those that end; 1 if none does."""
        successes = sum(float(each.probability) for each in self.outcomes() if each.result == SUCCESS)
        ends = sum(float(each.probability) for each in self.outcomes() if each.takes is not None)
        return successes / ends if ends > 0 else 1.0

    def average(self) -> float:
        """How long an activation takes that ends, on average; in milliseconds, 0 if none does."""
        ending = [(float(each.probability), each.takes) for each in self.outcomes() if each.takes is not None]
        ends = sum(probability for probability, _ in ending)
        return sum(probability * _mean(takes) for probability, takes in ending) / ends if ends > 0 else 0.0

    def outcomes(self) -> Sequence[SkillOutcome]:
        """All that is drawn, with probabilities that add up to 1."""
        raise NotImplementedError

    def writes(self, node: SimulatedNode, drawn: DrawnActivation, has_real_truth: bool) -> tuple[Write, ...] | None:
        """What it writes when an activation ends now; None: unknown values.

        Args:
            has_real_truth: as of scripts.

        Raises:
            EngineError: a script cannot be evaluated.
            NotModelled: it needs a value that is unknown.
        """
        return drawn.writes


class AssumedSkill(Skill):
    """An action of which nothing is known: it succeeds at once and writes nothing that is known."""

    __slots__ = ()

    def __init__(self) -> None:
        super().__init__("ASSUMED")

    def draw(self, random: Stream) -> DrawnActivation:
        """Draw what it always does."""
        return _ASSUMED

    def outcomes(self) -> Sequence[SkillOutcome]:
        """What it always does."""
        return (SkillOutcome(SUCCESS, Fraction(1), AT_ONCE),)


def _mean(takes: Spread | Mapping[int, float]) -> float:
    """The mean duration, in milliseconds."""
    if isinstance(takes, Mapping):
        return sum(time * probability for time, probability in takes.items())
    if takes.kind == "lognormal":
        return 1000 * takes.low * exp((log(takes.high / takes.low) / P95) ** 2 / 2)
    return 1000 * (takes.low + takes.high) / 2


P95: Final = NormalDist().inv_cdf(0.95)  # where the 95 % quantile is, in standard deviations
AT_ONCE: Final[Mapping[int, float]] = {0: 1.0}
_ASSUMED: Final = DrawnActivation(SUCCESS, 0, ())
