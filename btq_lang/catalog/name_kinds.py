"""The kinds of things that have names.

In a module of its own because most rooms look names up by their kind and need no table of the catalog.
"""

from __future__ import annotations

from enum import Enum


class Kind(Enum):
    """The kind of what a name names."""

    TREE = "tree"
    MODEL = "node model"
    REQUIREMENT = "requirement"
    SIGNAL = "signal"
    CONTEXT = "context"
    QUALITY = "quality"
    HAZARD = "hazard"

    __hash__ = object.__hash__  # `Enum` implements it in Python, and every name is looked up with its kind
