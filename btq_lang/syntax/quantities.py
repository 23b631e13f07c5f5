"""Quantities in a file: a number and its unit.

In a module of its own because its users read single values and need nothing of the scanner.
"""

from __future__ import annotations

import re

from btq_lang.catalog.units import Unit, parse_unit

_QUANTITY = re.compile(r"(-?[0-9]+(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?)[ \t]*(\S+)")


def parse_quantity(text: str) -> tuple[float, Unit, str] | None:
    """The number, the unit and the unit's text of a quantity such as `30 s`; None if it is not one."""
    match = _QUANTITY.fullmatch(text)
    unit = parse_unit(match[2]) if match is not None else None
    return (float(match[1]), unit, match[2]) if match is not None and unit is not None else None
