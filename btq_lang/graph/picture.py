"""A mission as a page shows it beside the text: its trees with notes, and the place of each node in the text.

A folded subtree is the one box at its top, which shows how much is below it.

One invariant: every key of `places` is the id of a group in the picture, and a fold identifies its node by the names on
the path to it, so an edit elsewhere in the mission neither opens it nor folds another.
"""

from __future__ import annotations

from collections.abc import Container, Mapping
from typing import Final

from btq_lang.graph import draw
from btq_lang.graph.figure import Box, Figure, Note
from btq_lang.graph.missions import MeasuredBy, figures, keyed
from btq_lang.util.record import Record, replace
from btq_lang.util.text import Span, counted
from btq_lang.workspace.workspace import Workspace


class Picture(Record):
    """The SVG, and for each node in it the word that names its kind, in the order of the text."""

    svg: str
    places: Mapping[str, Span]


def picture(
    workspace: Workspace, path: str, folded: Container[str] = (), measured_by: MeasuredBy = lambda applied: ()
) -> Picture:
    """The trees of a file.

    Args:
        measured_by: as of `figures`.
        folded: the names of the nodes whose subtrees are not shown, as in `data-name` of the SVG; `+notes` among them
            shows all notes, `-notes` folds them.  Without either they are folded if more than 60 nodes are shown.

    Raises:
        KeyError: there is no such file.
    """
    shown = [foldable(figure, folded) for figure in figures(workspace, path, True, measured_by)]
    keys = {box.key for figure in shown for box in figure.boxes}
    if "-notes" in folded or (len(keys) > _MOST_WITH_NOTES and "+notes" not in folded):
        shown = [
            replace(figure, boxes=tuple(replace(box, notes=_folded(box.notes)) for box in figure.boxes))
            for figure in shown
        ]
    return Picture(draw(shown), {key: span for key, span in places(workspace, path).items() if key in keys})


def places(workspace: Workspace, path: str) -> dict[str, Span]:
    """The place of each node of a file in its text, folded or not.

    Raises:
        KeyError: there is no such file.
    """
    return {
        key: node.node.head.span.shifted(workspace.files[path].start_of(node.item))
        for key, node in keyed(workspace, path)
    }


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
    visible = [number for number, hiding in enumerate(top) if hiding is None]
    new_numbers = {number: place for place, number in enumerate(visible)}
    boxes = (_visible(figure.boxes[index], names[index], below[index], new_numbers) for index in visible)
    return replace(figure, boxes=tuple(boxes))


def _folded(notes: tuple[Note, ...]) -> tuple[Note, ...]:
    """One note for all of a node, with the name of the first."""
    if not notes:
        return ()
    first = notes[0]
    name = first.key.rpartition(".")[2] if first.kind == "quality" else first.key
    title = name if len(notes) == 1 else f"{name} +{len(notes) - 1}"
    text = "; ".join(note.text or note.title for note in notes)
    return (replace(first, title=title, lines=(), text=text, state="folded", measured=()),)


def _visible(box: Box, name: str, below: list[Box], new_numbers: dict[int, int]) -> Box:
    parent = None if box.parent is None else new_numbers[box.parent]
    if not below:
        return replace(box, name=name, parent=parent)
    # A search for a folded node finds the box that hides it.
    text = f"{box.text or box.title}; folded: {', '.join(each.text or each.title for each in below)}"
    lines = (*box.lines, f"… {counted(len(below), 'node')}")
    return replace(box, name=name, parent=parent, hidden=len(below), lines=lines, text=text)


def _names(figure: Figure) -> list[str]:
    """For each box, the titles and instance names from the top of its tree; equal siblings are numbered."""
    names: list[str] = []
    counts: dict[str, int] = {}
    for box in figure.boxes:
        above = figure.title if box.parent is None else names[box.parent]
        name = f"{above}/{' '.join((box.title, *box.lines[:1]))}"
        counts[name] = counts.get(name, 0) + 1
        names.append(name if counts[name] == 1 else f"{name}#{counts[name]}")
    return names


_MOST_WITH_NOTES: Final = 60  # nodes: with the notes of more, a tree that fits a window has no readable names
