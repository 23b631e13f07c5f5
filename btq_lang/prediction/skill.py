"""What a skill does in a drawn activation, whoever says so."""

from __future__ import annotations

from typing import Final, Literal, TypeAlias

from btq_lang.prediction.streams import Stream
from btq_lang.simulator.nodes import SUCCESS
from btq_lang.simulator.skills import Write
from btq_lang.util.record import Record

Source: TypeAlias = Literal["declared", "measured", "ASSUMED"]


class DrawnActivation(Record):
    """What a skill does in one activation.

    Attributes:
        result: SUCCESS, FAILURE or SKIPPED; RUNNING: it does not end.
        takes: in milliseconds; of one that does not end, for how long that is known.
        writes: at its end; None: unknown values.
        is_guess: it is beyond the longest measured activation.
    """

    result: int
    takes: int
    writes: tuple[Write, ...] | None = None
    is_guess: bool = False


class Skill:
    """What draws the activations of a skill.

    Attributes:
        source: who says what it does.
    """

    __slots__ = ("source",)

    def __init__(self, source: Source) -> None:
        self.source: Final = source

    def draw(self, random: Stream) -> DrawnActivation:
        """Draw an activation; `random`: the stream of that activation."""
        raise NotImplementedError


class AssumedSkill(Skill):
    """An action of which nothing is known: it succeeds at once and writes nothing that is known."""

    __slots__ = ()

    def __init__(self) -> None:
        super().__init__("ASSUMED")

    def draw(self, random: Stream) -> DrawnActivation:
        """Draw what it always does."""
        return _ASSUMED


_ASSUMED: Final = DrawnActivation(SUCCESS, 0, ())
