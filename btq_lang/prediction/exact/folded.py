"""How likely a node ends in which way, and after how long: what a fold knows of it."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from typing import Final, TypeAlias

from btq_lang.prediction.exact.times import Times, mixed
from btq_lang.prediction.skill import Probability
from btq_lang.simulator.nodes import FAILURE, RUNNING, SUCCESS, SimulatedNode
from btq_lang.util.record import Record

Memory: TypeAlias = "frozenset[tuple[int, int]]"  # where nodes go on that keep their place: their numbers and places


class NotExact(Exception):
    """A tree cannot be folded.

    Attributes:
        node: because of which.
        reason: what about it, in words that follow its name.
    """

    def __init__(self, node: SimulatedNode, reason: str) -> None:
        super().__init__(f"{node.path}: {reason}")
        self.node: Final = node
        self.reason: Final = reason


class FoldedOutcome(Record):
    """One way in which an activation may end.

    Attributes:
        result: SUCCESS or FAILURE; RUNNING: it does not end.
        probability: a fraction if it does not depend on durations.
        takes: None: it does not end.
        memory: what nodes below then have kept.
    """

    result: int
    probability: Probability
    takes: Times | None
    memory: Memory = frozenset()


class Folded(Record):
    """What an activation of a node does.

    Attributes:
        outcomes: their probabilities add up to 1.
        doubt: how wrong probabilities may be, because durations are on a grid.
    """

    outcomes: tuple[FoldedOutcome, ...]
    doubt: float = 0.0

    def probability(self, result: int) -> Probability:
        """How likely it has a result; of RUNNING, how likely it does not end."""
        return min(sum([each.probability for each in self.outcomes if each.result == result], ZERO), _SURE)

    def takes(self, *results: int) -> Times | None:
        """How long it takes if it has one of some results, by default if it ends; None: it never does."""
        wanted = results or (SUCCESS, FAILURE)
        parts = [
            (float(each.probability), each.takes)
            for each in self.outcomes
            if each.result in wanted and each.takes is not None and each.probability
        ]
        return mixed(parts) if parts else None

    @property
    def success(self) -> Probability:
        """How likely it succeeds."""
        return self.probability(SUCCESS)

    @property
    def is_endless(self) -> bool:
        """Whether it may never end."""
        return bool(self.probability(RUNNING))


def folded(outcomes: Iterable[FoldedOutcome], doubt: float = 0.0) -> Folded:
    """Ways to end, those with the same result and memory as one."""
    ways: dict[tuple[int, Memory], list[FoldedOutcome]] = {}
    for each in outcomes:
        if each.probability:
            memory = each.memory if each.result != RUNNING else frozenset()
            ways.setdefault((each.result, memory), []).append(each)
    return Folded(tuple(_joined(result, memory, each) for (result, memory), each in ways.items()), doubt)


def _joined(result: int, memory: Memory, ways: list[FoldedOutcome]) -> FoldedOutcome:
    probability = sum([each.probability for each in ways], ZERO)
    parts = [(float(each.probability), each.takes) for each in ways if each.takes is not None]
    return FoldedOutcome(result, probability, mixed(parts) if parts else None, memory)


ZERO: Final[Probability] = Fraction(0)
_SURE: Final[Probability] = Fraction(1)  # sums of rounded numbers may be more
