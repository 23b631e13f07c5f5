"""Quantities: a number and its unit, as a file writes them."""

from __future__ import annotations

import re

from btq_lang.units import Unit, parse_unit

_QUANTITY = r"(-?[0-9]+(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?)[ \t]*(\S+)"  # compiled when first used: most files have none


def parse_quantity(text: str) -> tuple[float, Unit, str] | None:
    """The number, the unit and the unit's text of a quantity such as `30 s`; None where it is none."""
    match = re.fullmatch(_QUANTITY, text)
    unit = parse_unit(match[2]) if match else None
    return (float(match[1]), unit, match[2]) if match and unit else None
