"""Folds figures: a subtree becomes the one box at its top, which shows how much is below it; the notes of a node become
the name of the first.

One invariant: a fold identifies its node by the names on the path to it, so an edit elsewhere in the mission neither
opens it nor folds another.  Pages and keys are unknown here.
"""

from __future__ import annotations

from collections.abc import Container

from btq_lang.graph.figure import Box, Figure, Note
from btq_lang.util.record import replace
from btq_lang.util.text import counted


def foldable(figure: Figure, folded: Container[str] = ()) -> Figure:
    """A figure whose boxes have their `name`, without what is below those that are folded.

    Args:
        folded: names of boxes; unknown names, and those of leaves, fold nothing.
    """
    names = _names(figure)
    below: list[list[Box]] = [[] for _ in figure.boxes]
    top: list[int | None] = []  # for each box, the folded one that contains it
    for box in figure.boxes:
        hiding = None
        if box.parent is not None:
            hiding = top[box.parent]
            if hiding is None and names[box.parent] in folded:
                hiding = box.parent
        if hiding is not None:
            below[hiding].append(box)
        top.append(hiding)
    kept = [number for number, hiding in enumerate(top) if hiding is None]
    now = {number: place for place, number in enumerate(kept)}
    return replace(figure, boxes=tuple(_kept(figure.boxes[each], names[each], below[each], now) for each in kept))


def with_folded_notes(figure: Figure) -> Figure:
    """A figure with one line for all notes of a node."""
    return replace(figure, boxes=tuple(replace(box, notes=_folded(box.notes)) for box in figure.boxes))


def _folded(notes: tuple[Note, ...]) -> tuple[Note, ...]:
    if not notes:
        return ()
    first = notes[0]
    name = first.key.rpartition(".")[2] if first.kind == "quality" else first.key
    title = name if len(notes) == 1 else f"{name} +{len(notes) - 1}"
    text = "; ".join(note.text or note.title for note in notes)
    return (replace(first, title=title, lines=(), text=text, state="folded"),)


def _kept(box: Box, name: str, below: list[Box], now: dict[int, int]) -> Box:
    parent = None if box.parent is None else now[box.parent]
    if not below:
        return replace(box, name=name, parent=parent)
    # A search for a folded node finds the box that hides it.
    text = f"{box.text or box.title}; folded: {', '.join(each.text or each.title for each in below)}"
    lines = (*box.lines, f"… {counted(len(below), 'node')}")
    return replace(box, name=name, parent=parent, hidden=len(below), lines=lines, text=text)


def _names(figure: Figure) -> list[str]:
    """For each box, the titles and instance names from the top of its tree; equal siblings are numbered."""
    found: list[str] = []
    seen: dict[str, int] = {}
    for box in figure.boxes:
        above = figure.title if box.parent is None else found[box.parent]
        name = f"{above}/{' '.join((box.title, *box.lines[:1]))}"
        seen[name] = seen.get(name, 0) + 1
        found.append(name if seen[name] == 1 else f"{name}#{seen[name]}")
    return found
