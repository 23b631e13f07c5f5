"""The world of a drawn run: signals that change with the time, and values of entries that follow from them.

One invariant: between two changes of its rate a signal is a straight line, so that its value at any time, and the time
at which it reaches a value, are calculated and never stepped to.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from math import ceil, floor, inf
from typing import Final

from btq_lang.simulator.blackboard import Unknown, Value
from btq_lang.simulator.scripts import combined, compared
from btq_lang.simulator.timers import NEVER
from btq_lang.util.record import Record


class CourseSettings(Record):
    """How a signal of the world changes.

    Attributes:
        name: of the signal.
        entry: on the root blackboard, which has its value at every time; empty: none.
        start: its value at the start of each run, a number in its unit.
        rate: how much it changes in a second while none of the nodes below runs.
        rates: how much instead while one of some nodes runs; of several that run, all together.
        low, high: what it stays between.
    """

    name: str
    entry: str
    start: float | bool | str
    rate: float = 0.0
    rates: tuple[tuple[frozenset[int], float], ...] = ()
    low: float = -inf
    high: float = inf

    @property
    def is_constant(self) -> bool:
        """Whether it never changes."""
        return isinstance(self.start, bool | str) or (self.rate == 0 and all(rate == 0 for _, rate in self.rates))

    def rate_with(self, running: Collection[int]) -> float:
        """Its rate, per second, while some nodes run."""
        rates = [rate for uids, rate in self.rates if not uids.isdisjoint(running)]
        return sum(rates) if rates else self.rate


class Course:
    """A signal of the world in a run.

    Attributes:
        pieces: since when, in milliseconds, with which value then, and which rate per millisecond.
        thresholds: the values with which conditions and scripts compare it; at these it is looked at.
        is_polled: something reads it otherwise, so that it is looked at whenever it may have changed.
    """

    def __init__(self, settings: CourseSettings) -> None:
        self.settings: Final = settings
        self.thresholds: Final = {settings.low, settings.high} - {-inf, inf}
        self.is_polled = False
        self.pieces: list[tuple[int, float, float]] = []
        self._since, self._value, self._rate = 0, 0.0, 0.0
        self._looked, self._crossing = _NOT_YET, NEVER  # the next crossing after a time

    def begin(self, running: Collection[int] = ()) -> None:
        """Begin a run."""
        self._rate = self.settings.rate_with(running) / 1000
        self._since, self._value = 0, float(self.settings.start)
        self.pieces = [(0, self._value, self._rate)]
        self._looked = _NOT_YET

    def turn(self, now: int, rate: float) -> None:
        """Go on with another rate, per second, from now on."""
        rate /= 1000
        if rate != self._rate:
            self._value = self.at(now)
            self._since, self._rate = now, rate
            self.pieces.append((now, self._value, rate))
            self._looked = _NOT_YET

    def at(self, now: float) -> float:
        """Its value at a time from its last turn on."""
        value = self._value + self._rate * (now - self._since)
        low, high = self.settings.low, self.settings.high
        return low if value < low else high if value > high else value

    def next_crossing(self, now: int) -> int:
        """When a comparison with one of the thresholds may come out otherwise, later than `now`; `NEVER`: never."""
        if self._rate == 0:
            return NEVER
        if self.is_polled:
            return now + 1
        if self._looked <= now < self._crossing or (self._crossing == NEVER and self._looked <= now):
            return self._crossing
        first = NEVER
        for threshold in self.thresholds:
            time = self._since + (threshold - self._value) / self._rate
            if time + 1 < now:
                continue
            for whole in (ceil(time), floor(time) + 1):
                if whole > now and (first == NEVER or whole < first):
                    first = whole
        self._looked, self._crossing = now, first
        return first


def crossings(
    pieces: Sequence[tuple[int, float, float]], thresholds: Iterable[float], end: int
) -> list[tuple[float, int]]:
    """When a course reaches thresholds: each with the time in microseconds, and the first one after it."""
    times: list[tuple[float, int]] = []
    wanted = [*thresholds]
    for (since, value, rate), (until, *_) in zip(pieces, [*pieces[1:], (end, 0.0, 0.0)], strict=True):
        if rate:
            reached = sorted((value, value + rate * (until - since)))
            for threshold in wanted:
                if not reached[0] - _SLACK <= threshold <= reached[1] + _SLACK:
                    continue
                time = (since + (threshold - value) / rate) * 1000
                if since * 1000 <= time <= until * 1000:
                    times += [(threshold, ceil(time)), (threshold, floor(time) + 1)]
    return times


class LiveValue(Unknown):
    """A number of an entry that belongs to a run, not to the state of the tree: what it is, is asked when it matters.

    A comparison with it is a question, as what a skill returns is one; see `Asker`.
    """

    __slots__ = ("_ask",)

    def __init__(self, ask: Asker) -> None:
        self._ask: Final = ask

    def value(self) -> float:
        """What it is now."""
        raise NotImplementedError

    def compared(self, operator: str, other: Value) -> bool:
        """Whether a comparison with it on the left holds."""
        if isinstance(other, Unknown) and not isinstance(other, LiveValue):
            raise other.needed("compared")
        answer = self._ask.ask(_Comparison(self, operator, other))
        return bool(answer)

    def combined(self, operator: str, other: Value, is_left: bool) -> Value:
        """What an operator makes of it and another value, which goes on changing with it."""
        if isinstance(other, Unknown) and not isinstance(other, LiveValue):
            raise other.needed("calculated with")
        return DerivedValue(self._ask, operator, *((self, other) if is_left else (other, self)))

    def __float__(self) -> float:
        return float(self._ask.ask(self.value))  # type: ignore[arg-type]  # the answer to such a question

    def __int__(self) -> int:
        return int(float(self))

    def __str__(self) -> str:
        return f"{float(self):.6f}"


class Asker:
    """Who is asked what is not in the state of a tree.

    Attributes:
        ask: gives the answer to a question: that of now, unless it is given already.
    """

    def __init__(self) -> None:
        self.ask: Callable[[Callable[[], object]], object] = _answer


def _answer(question: Callable[[], object]) -> object:
    return question()


class _Comparison:
    """The question whether a comparison holds."""

    __slots__ = ("_left", "_operator", "_right")

    def __init__(self, left: LiveValue, operator: str, right: Value) -> None:
        self._left: Final = left
        self._operator: Final = operator
        self._right: Final = right

    def __call__(self) -> bool:
        right = self._right.value() if isinstance(self._right, LiveValue) else self._right
        return compared(self._left.value(), self._operator, right)


class WorldValue(LiveValue):
    """The value of a signal of the world.

    Attributes:
        name: of its entry on the root blackboard.
    """

    __slots__ = ("_now", "course", "name")

    def __init__(self, ask: Asker, course: Course, now: Callable[[], int]) -> None:
        super().__init__(ask)
        self.course: Final = course
        self.name: Final = course.settings.entry
        self._now: Final = now

    def value(self) -> float:
        """What it is now."""
        return self.course.at(self._now())


class KeptValue(LiveValue):
    """What an entry holds that was given a value of the world, or one calculated from it, at some time.

    Attributes:
        kept: the number.
    """

    __slots__ = ("kept",)

    def __init__(self, ask: Asker) -> None:
        super().__init__(ask)
        self.kept = 0.0

    def value(self) -> float:
        """What it has been since then."""
        return self.kept


class DerivedValue(LiveValue):
    """What an operator makes of two values of which one is live."""

    __slots__ = ("left", "operator", "right")

    def __init__(self, ask: Asker, operator: str, left: Value, right: Value) -> None:
        super().__init__(ask)
        self.operator: Final = operator
        self.left: Final = left
        self.right: Final = right

    def value(self) -> float:
        """What it is now."""
        left, right = (each.value() if isinstance(each, LiveValue) else each for each in (self.left, self.right))
        return float(combined(self.operator, left, right))


_NOT_YET: Final = 1 << 62  # ms
_SLACK: Final = 1e-9
