"""Blackboard entries as attributes name them: text only, without trees."""

from __future__ import annotations

from btq_lang.catalog.literals import is_pointer
from btq_lang.workspace.resolved import ResolvedNode


def pointed_at(port: str, text: str) -> str | None:
    """The entry that the text of a port points to; None if it is not a pointer."""
    if not is_pointer(text):
        return None
    return port if text == "{=}" else text[1:-1]


def remaps_all(seen: ResolvedNode) -> bool:
    """Whether a SubTree gets every entry under its own name; it never gets private ones, which begin with `_`."""
    value = seen.node.attribute("_autoremap")
    return value is not None and value.text in ("true", "True", "TRUE", "1")
