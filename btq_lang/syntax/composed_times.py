"""Times of several numbers, as on a clock or in speech: `3:30 min`, `1 h 30 min`; btq has one number and one unit.

One invariant: it looks only at the text from a place on.
"""

from __future__ import annotations

import re
from typing import Final

from btq_lang.diagnostics.model import Diagnostic, write_fix
from btq_lang.util.text import Span


def composed_time(text: str, start: int) -> Diagnostic | None:
    """The diagnostic for a time of several numbers that begins at `start`; None if none does."""
    units: list[tuple[str, ...]]
    if clock := _CLOCK.match(text, start):
        parts = [int(part) for part in clock.group(1, 2, 3) if part is not None]
        unit = _UNITS.get(clock[4] or "")
        if unit is None and clock[4]:
            return None
        units = [("h", "min", "s")] if len(parts) == 3 else _readings(unit)
        end = clock.end()
    elif (spoken := _SPOKEN.match(text, start)) and spoken[2] in _UNITS and (spoken[4] or "s") in _UNITS:
        large = _UNITS[spoken[2]]
        small = _UNITS[spoken[4]] if spoken[4] else _BELOW.get(large, "")
        if not small or _SECONDS[small] >= _SECONDS[large]:
            return None
        parts, units, end = [int(spoken[1]), int(spoken[3])], [(large, small)], spoken.end()
    else:
        return None
    written = [amount for reading in units for amount in _in_one_unit(parts, reading)]
    span = Span(start, end)
    fixes = tuple([write_fix(amount, span) for amount in written])
    shown = " or ".join(f"`{amount}`" for amount in written)
    return Diagnostic("syntax-error", span, f"a time has one number and one unit: {shown}", fixes=fixes)


def _readings(unit: str | None) -> list[tuple[str, ...]]:
    """The units of the two numbers of a clock; the unit after them is that of the first, or of the whole."""
    hours, minutes = ("h", "min"), ("min", "s")
    return [minutes, hours] if unit is None else [hours] if unit == "h" else [minutes]


def _in_one_unit(parts: list[int], units: tuple[str, ...]) -> list[str]:
    """A time in its largest unit, if that takes few decimals, and in its smallest."""
    seconds = sum(part * _SECONDS[unit] for part, unit in zip(parts, units, strict=True))
    numbers = [f"{seconds / _SECONDS[unit]:.10g}" for unit in (units[0], units[-1])]
    return [f"{number} {unit}" for number, unit in zip(numbers, (units[0], units[-1]), strict=True) if len(number) < 7]


_CLOCK: Final = re.compile(r"(\d+):(\d\d)(?::(\d\d))?(?!\d)(?:[ \t]*([^\W\d_]+))?")
_SPOKEN: Final = re.compile(r"(\d+)[ \t]*([^\W\d_]+?)(?:,|[ \t]+and\b)?[ \t]*(\d+)(?:[ \t]*([^\W\d_]+))?(?![\w.])")
_UNITS: Final = {
    **dict.fromkeys(("d", "day", "days"), "d"),
    **dict.fromkeys(("h", "hr", "hour", "hours"), "h"),
    **dict.fromkeys(("m", "min", "mins", "minute", "minutes"), "min"),
    **dict.fromkeys(("s", "sec", "secs", "second", "seconds"), "s"),
    "ms": "ms",
}
_BELOW: Final = {"d": "h", "h": "min", "min": "s", "s": "ms"}
_SECONDS: Final = {"d": 86_400, "h": 3_600, "min": 60, "s": 1, "ms": 0.001}
