"""A mission as a page shows it beside the text: its trees with notes, and the place of each node in the text.

One invariant: every key of `places` is the id of a group in the picture.
"""

from __future__ import annotations

from collections.abc import Container, Mapping
from typing import Final

from btq_lang.graph import draw
from btq_lang.graph.folding import foldable, with_folded_notes
from btq_lang.graph.missions import figures, keyed
from btq_lang.util.record import Record
from btq_lang.util.text import Span
from btq_lang.workspace.workspace import Workspace


class Picture(Record):
    """The SVG, and for each node in it the word that names its kind, in the order of the text."""

    svg: str
    places: Mapping[str, Span]


def picture(workspace: Workspace, path: str, folded: Container[str] = ()) -> Picture:
    """The trees of a file.

    Args:
        folded: the names of the nodes whose subtrees are not shown, as in `data-name` of the SVG; `+notes` among them
            shows all notes, `-notes` folds them.  Without either they are folded if more than 60 nodes are shown.

    Raises:
        KeyError: there is no such file.
    """
    shown = [foldable(figure, folded) for figure in figures(workspace, path, with_qualities=True)]
    keys = {box.key for figure in shown for box in figure.boxes}
    if "-notes" in folded or (len(keys) > _MOST_WITH_NOTES and "+notes" not in folded):
        shown = [with_folded_notes(figure) for figure in shown]
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


_MOST_WITH_NOTES: Final = 60  # nodes: with the notes of more, a tree that fits a window has no readable names
