"""Values that are written into a tree for nodes of Nav2: the fields of poses, the share of a battery.

One invariant: only nodes of the distribution's own models are looked at.

Sources: convertFromString in nav2_behavior_tree's bt_conversions.hpp of Humble and Iron, and bt_utils.hpp of Jazzy,
Kilted and Lyrical; batteryCallback in is_battery_low_condition.cpp, which compares sensor_msgs/BatteryState.percentage.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Final

from btq_lang.catalog.literals import OLD_ENTRY, is_pointer
from btq_lang.checks import lookups
from btq_lang.checks.meant_entries import entry_of
from btq_lang.checks.nav2_nodes import of_distribution
from btq_lang.checks.view import View, port_of
from btq_lang.diagnostics.model import Diagnostic, replace_fix
from btq_lang.diagnostics.rules import Severity
from btq_lang.syntax.tokens import BRACED
from btq_lang.syntax.tree import Pair, Word
from btq_lang.workspace.resolved import ResolvedNode


def wrong_number_of_fields(view: View) -> Iterator[Diagnostic]:
    """A pose without the fields that Nav2 reads; its node goes on without the pose."""
    distribution = view.ask(lookups.distribution)
    if distribution is None:
        return
    for resolved, pair, value in view.seen.values():
        text = value.text
        if (
            value.kind == BRACED
            or not text
            or text.startswith("json:")
            or is_pointer(text)
            or OLD_ENTRY.fullmatch(text)
        ):
            continue
        if of_distribution(view, resolved, distribution) is None or entry_of(view, value) is not None:
            continue
        port = port_of(view, resolved, pair.key.text)
        if port is None or port.direction == "output" or port.type != _POSE:
            continue
        number = len(text.split(";"))
        if number != len(_FIELDS):
            message = f"expected the {len(_FIELDS)} fields of a pose for `{pair.key.text}`, found {number}: `{text}`"
            notes = (f"Nav2 reads `{';'.join(_FIELDS)}`: `0;map;1.0;2.0;0.0;0.0;0.0;0.0;1.0`",)
            yield Diagnostic("invalid-literal", value.span, message, notes=notes)


def percentage_for_share(view: View) -> Iterator[Diagnostic]:
    """A battery's limit in percent, where Nav2 compares a share from 0 to 1."""
    for resolved, pair, value in view.seen.values():
        if (share := share_meant(view, resolved, pair, value)) is not None:
            message = f"`{pair.key.text}` is a share from 0 to 1, unless `is_voltage` is true: write `{share}`"
            fixes = (replace_fix(f"Write `{share}`", value.span, share),)
            yield Diagnostic("invalid-literal", value.span, message, fixes=fixes, severity=Severity.WARNING)


def share_meant(view: View, resolved: ResolvedNode, pair: Pair, value: Word) -> str | None:
    """The share of a battery for a limit in percent; None for any other value."""
    if pair.key.text != "min_battery" or resolved.id is None or resolved.id.text != "IsBatteryLow":
        return None
    distribution, is_voltage = view.ask(lookups.distribution), resolved.node.attribute("is_voltage")
    percent = _PERCENT.fullmatch(value.text)
    if distribution is None or percent is None or of_distribution(view, resolved, distribution) is None:
        return None
    if is_voltage is not None and is_voltage.text.casefold() not in ("false", "0"):
        return None
    number = float(percent["number"])
    return f"{number / 100:.10g}" if number <= 100 and (number > 1 or percent["sign"]) else None


_PERCENT: Final = re.compile(r"(?P<number>\d{1,3}(?:\.\d{1,9})?)\s*(?P<sign>%?)")
_POSE: Final = "geometry_msgs::msg::PoseStamped"
_FIELDS: Final = ("time in ns", "frame", "x", "y", "z", "qx", "qy", "qz", "qw")
