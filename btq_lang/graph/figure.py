"""The contents of a picture: a tree's boxes in the order of its text, and what is attached to each.

One invariant: a parent comes before its children, so that readers of a figure need no recursion: trees are deep.
Positions are unknown here.
"""

from __future__ import annotations

from typing import Literal, TypeAlias

from btq_lang.util.record import Record

# How a node is drawn: control nodes as boxes with a symbol, actions as boxes, conditions as ellipses, decorators as
# hexagons (the literature has diamonds, in which no word fits), SubTree nodes as boxes with a second line at both
# ends, as flow charts draw subroutines.
Outline: TypeAlias = Literal["control", "action", "condition", "decorator", "subtree", "unknown"]


class MeasuredClause(Record):
    """What logs show of a clause.

    Attributes:
        lines: the value of the last run, and the verdict.
        verdict: a class of the drawing.
        values: of the runs in their order, each with whether it violates the clause; None: unknown.
        bounds: what the values are compared with.
        text: all of it in words.
    """

    lines: tuple[str, ...]
    verdict: str
    values: tuple[tuple[float | None, bool], ...]
    bounds: tuple[float, ...]
    text: str

    @property
    def has_values(self) -> bool:
        """Whether a value is known."""
        return any(value is not None for value, _ in self.values)


class Note(Record):
    """A quality or a requirement at a node.

    Attributes:
        key: the same for all notes of the same thing.
        lines: its contents, each line short enough to be drawn.
        text: all of its contents.
        state: a class of the drawing: `enforced`, `monitored`, `reviewed`; empty: unknown.
        link: its target on a page.
        measured: what logs show of its clauses; empty where there are none.
    """

    kind: Literal["quality", "requirement"]
    key: str
    title: str
    lines: tuple[str, ...] = ()
    text: str = ""
    state: str = ""
    link: str = ""
    measured: tuple[MeasuredClause, ...] = ()


class Box(Record):
    """A node.

    Attributes:
        key: its id in the document that contains the figure.
        parent: the index of its parent in the figure; None: it is the root.
        title: its symbol or its kind.
        lines: its instance name, and values worth seeing.
        text: all of its contents.
        link: its target on a page.
        name: the names on the path to it, if subtrees can be folded: unchanged by edits elsewhere.
        hidden: how many nodes are folded away below it.
        state: a class of the drawing; empty: unknown.
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
