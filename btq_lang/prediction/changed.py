"""A skill that does something else than what is known of it, with the same random numbers.

One invariant: what a change leaves alone stays as it was drawn, so that two predictions differ by the change alone.
"""

from __future__ import annotations

from typing import Final

from btq_lang.prediction.declared import quantile
from btq_lang.prediction.skill import DrawnActivation, Skill
from btq_lang.prediction.streams import Stream
from btq_lang.simulator.nodes import FAILURE, RUNNING, SUCCESS, SimulatedNode
from btq_lang.simulator.skills import Write
from btq_lang.util.record import Record, replace
from btq_lang.workspace.project_simulation import Spread


class SkillChange(Record):
    """What is otherwise with a skill.

    Attributes:
        path: its name, or a path to some nodes.
        factor: of its durations.
        takes: in place of its durations.
        is_even: each activation takes as long as they take on average.
        succeeds: the share of activations that end; None: as it is.
        spares: the share of its failures that succeed.
    """

    path: str
    factor: float = 1.0
    takes: Spread | None = None
    is_even: bool = False
    succeeds: float | None = None
    spares: float = 0.0


class ChangedSkill(Skill):
    """A skill with a change.

    A result that changes is that of another activation, which is drawn until it has the new result: whole activations
    are drawn, so a failure that becomes a success takes as long as successes do.
    """

    __slots__ = ("_average", "_base", "_change", "_turns")

    def __init__(self, base: Skill, change: SkillChange) -> None:
        says_all = base.source == "ASSUMED" and (change.takes is not None or change.succeeds is not None)
        super().__init__("declared" if says_all else base.source, base.keys, base.has_waited and change.takes is None)
        self._base: Final = base
        self._change: Final = change
        self._average: Final = round(base.average())
        self._turns: Final = _turns(base.success(), change)

    def draw(self, random: Stream) -> DrawnActivation:
        """Draw what it did, and turn that."""
        place = random.copy()
        drawn = self._base.draw(random)
        change = self._change
        if change.takes is not None and drawn.result == RUNNING:
            drawn = self._drawn(random, (SUCCESS, FAILURE), replace(drawn, result=SUCCESS))
        if random.next() < self._turns.get(drawn.result, 0.0):
            other = FAILURE if drawn.result == SUCCESS else SUCCESS
            drawn = self._drawn(random, (other,), replace(drawn, result=other))
        if drawn.result == RUNNING:
            return drawn
        takes = drawn.takes
        if change.takes is not None:
            takes = round(quantile(change.takes, place.next()) * 1000)
        elif change.is_even:
            takes = self._average
        return DrawnActivation(drawn.result, round(takes * change.factor), drawn.writes)

    def _drawn(self, random: Stream, results: tuple[int, ...], otherwise: DrawnActivation) -> DrawnActivation:
        """An activation with one of some results; `otherwise`: if there hardly is one."""
        draws = (self._base.draw(random) for _ in range(_MOST_DRAWS))
        return next((drawn for drawn in draws if drawn.result in results), otherwise)

    def success(self) -> float:
        """The probability that an activation succeeds, of those that end."""
        success = self._base.success()
        return success * (1 - self._turns.get(SUCCESS, 0.0)) + (1 - success) * self._turns.get(FAILURE, 0.0)

    def average(self) -> float:
        """How long an activation takes that ends, on average, as far as the change is about that."""
        return self._base.average() * self._change.factor

    def writes(self, node: SimulatedNode, drawn: DrawnActivation, has_real_truth: bool) -> tuple[Write, ...] | None:
        """As the skill without the change."""
        return self._base.writes(node, drawn, has_real_truth)


def _turns(success: float, change: SkillChange) -> dict[int, float]:
    """With which probability each result turns into the other one: as seldom as the change allows."""
    if change.succeeds is None:
        return {FAILURE: change.spares}
    if change.succeeds >= success:
        return {FAILURE: (change.succeeds - success) / (1 - success) if success < 1 else 0.0}
    return {SUCCESS: (success - change.succeeds) / success}


_MOST_DRAWS: Final = 100
