"""Draws a mission in the notation of the behavior-tree literature, with qualities beside their nodes.

One invariant: the same mission gives the same bytes.  It does not touch the disk and starts no program: Graphviz is not
needed.

    figure.py    what is drawn: boxes, and what is attached to them
    missions.py  a mission's trees as figures
    layout.py    positions of the boxes: a tidy tree in linear time
    widths.py    widths of texts
    placing.py   a figure with the positions of its parts
    svg.py, dot.py, mermaid.py   the writers; SVG has sparklines too
    picture.py   all of it, for the page beside a text, where parts are folded
"""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from btq_lang.graph.figure import Figure

FORMATS: Final = ("svg", "dot", "mermaid")
DIRECTIONS: Final = ("down", "right")


def draw(figures: Sequence[Figure], form: str = "svg", direction: str = "down") -> str:
    """Figures as one text in one of FORMATS.

    Args:
        direction: whether children are below their parent or to its right.

    Raises:
        ValueError: there is no such format or direction.
    """
    if direction not in DIRECTIONS:
        raise ValueError(f"unknown direction {direction!r}; expected one of {', '.join(DIRECTIONS)}")
    if form not in FORMATS:
        raise ValueError(f"unknown format {form!r}; expected one of {', '.join(FORMATS)}")
    text: str = import_module(f"{__name__}.{form}").render(figures, direction)
    return text
