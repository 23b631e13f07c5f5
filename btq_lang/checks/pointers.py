"""Blackboard entries as attributes name them: text only, without trees."""

from __future__ import annotations

from btq_lang.catalog.literals import is_pointer
from btq_lang.workspace.resolved import ResolvedNode


def pointed_at(port: str, text: str) -> str | None:
    """The entry that the text of a port points to; None if it is not a pointer."""
    if not is_pointer(text):
        return None
    return port if text == "{=}" else text[1:-1]


def remaps_all(resolved: ResolvedNode) -> bool:
    """Whether a SubTree gets every entry under its own name; it never gets private ones, which begin with `_`."""
    return is_on(resolved, "_autoremap")


def is_on(resolved: ResolvedNode, attribute: str) -> bool:
    """Whether an attribute has a value that the engine takes for true."""
    value = resolved.node.attribute(attribute)
    return value is not None and value.text in ("true", "True", "TRUE", "1")


def passed_on(resolved: ResolvedNode, name: str) -> str | None:
    """The entry that a SubTree passes to its tree under a name; empty: a value; None: the entry is that tree's own."""
    value = resolved.node.attribute(name)
    if value is not None:
        return pointed_at(name, value.text) or ""
    return name if remaps_all(resolved) and name[:1] != "_" else None
