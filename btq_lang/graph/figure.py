"""What a picture shows: a tree's boxes in the order of its text, and what is attached to each.

One invariant: a parent stands before its children, so that nobody who reads a figure needs recursion: trees are deep.
It does not know where anything stands on the paper.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, TypeAlias

from btq_lang.util.record import Record

if TYPE_CHECKING:
    # How a node is drawn: control nodes as boxes with a symbol, actions as boxes, conditions as ellipses, decorators as
    # hexagons (the literature has diamonds, in which no word fits), SubTree nodes as boxes with a second line at both
    # ends, as flow charts draw what is drawn elsewhere.
    Outline: TypeAlias = Literal["control", "action", "condition", "decorator", "subtree", "unknown"]


class Note(Record):
    """A quality or a requirement at a node.

    Attributes:
        key: the same for all notes that stand for the same thing.
        title: its name.
        lines: what it says, each line short enough to be drawn.
        text: all of it.
        state: a class of the drawing: `enforced`, `monitored`, `reviewed`; empty: nothing is known.
        link: where a page leads from it.
    """

    kind: Literal["quality", "requirement"]
    key: str
    title: str
    lines: tuple[str, ...] = ()
    text: str = ""
    state: str = ""
    link: str = ""


class Box(Record):
    """A node.

    Attributes:
        key: its name in the document that the figure becomes a part of.
        parent: the place of its parent in the figure; None: it stands at the top.
        title: its symbol or what it is.
        lines: its instance name, and values worth seeing.
        text: all of it.
        link: where a page leads from it.
        name: the names on the way to it, where subtrees can be folded: the same after an edit elsewhere.
        hidden: how many nodes are folded away below it.
        state: a class of the drawing; empty: nothing is known.
    """

    key: str
    parent: int | None
    outline: Outline
    title: str
    lines: tuple[str, ...] = ()
    text: str = ""
    notes: tuple[Note, ...] = ()
    link: str = ""
    name: str = ""
    hidden: int = 0
    state: str = ""


class Figure(Record):
    """A tree."""

    title: str
    boxes: tuple[Box, ...]
