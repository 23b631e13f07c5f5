"""The key `driver` in the table `[simulate]` of a project file: how the program ticks its tree.

[simulate]
driver = { tick_once = "100 ms" }
"""

from __future__ import annotations

from typing import Final

from btq_lang.catalog.units import dimension_name, to_si
from btq_lang.syntax.quantities import parse_quantity
from btq_lang.util.record import Record
from btq_lang.util.spelling import did_you_mean, near


class Driver(Record):
    """How a program ticks its tree.

    Attributes:
        function: of the engine, a key of `FUNCTIONS`.
        period: how long it sleeps between two ticks, in milliseconds.
    """

    function: str = "tick_while_running"
    period: int = 10

    @property
    def is_woken(self) -> bool:
        """Whether a node ends the sleep that asks to be ticked again."""
        return self.function == "tick_while_running"

    def tick_after(self, now: int, time: int) -> int:
        """The first tick that is not before a time, if there is one now."""
        return now + -((now - time) // self.period) * self.period


def read_driver(value: object) -> tuple[Driver | None, list[tuple[str, tuple[str, ...]]]]:
    """A driver; or what is wrong, as a message without its subject, and the keys below."""
    if not isinstance(value, dict) or len(value) != 1:
        return None, [('must be a table with one function such as { tick_once = "10 ms" }', ())]
    ((function, period),) = value.items()
    if function not in FUNCTIONS:
        meant = did_you_mean(near(function, FUNCTIONS, 1))
        return None, [(f"has an unknown function `{function}`{meant}", (function,))]
    parsed = parse_quantity(period.strip()) if isinstance(period, str) else None
    if parsed is None:
        return None, [(f'must give `{function}` a duration such as "10 ms"', (function,))]
    milliseconds = to_si(parsed[0], parsed[1]) * 1000 if dimension_name(parsed[1]) == "time" else 0.0
    if milliseconds < 1 or abs(milliseconds - round(milliseconds)) > _TOLERANCE:
        return None, [(f'must give `{function}` whole milliseconds such as "10 ms"', (function,))]
    return Driver(function, round(milliseconds)), []


# Each function with a line for editors.
FUNCTIONS: Final = {
    "tick_while_running": "tickWhileRunning(time): ticks after this time, or sooner when a node asks for it",
    "tick_once": "tickOnce(), and sleeps for this time",
    "tick_exactly_once": "tickExactlyOnce(), and sleeps for this time",
}
_TOLERANCE: Final = 1e-6  # milliseconds
