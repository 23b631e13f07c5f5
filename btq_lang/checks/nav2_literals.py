"""Poses that are written into a tree for nodes of Nav2: how many fields they have.

One invariant: only nodes of the distribution's own models are looked at, and only the number of fields.

Sources: convertFromString in nav2_behavior_tree's bt_conversions.hpp of Humble and Iron, and bt_utils.hpp of Jazzy,
Kilted and Lyrical.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from btq_lang.catalog.literals import OLD_ENTRY, is_pointer
from btq_lang.checks import lookups
from btq_lang.checks.meant_entries import entry_of
from btq_lang.checks.nav2_nodes import of_distribution
from btq_lang.checks.view import View, port_of
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.syntax.tokens import BRACED


def wrong_number_of_fields(view: View) -> Iterator[Diagnostic]:
    """A pose that has not the fields that Nav2 reads: its node goes on without it."""
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


_POSE: Final = "geometry_msgs::msg::PoseStamped"
_FIELDS: Final = ("time in ns", "frame", "x", "y", "z", "qx", "qy", "qz", "qw")
