"""The trees of the first screen: names of nodes, and signs at them for the states of their requirements.

One invariant: each box has another id than in the drawing of the whole tree, and leads to the worst of its
requirements.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Final

from btq_lang.graph.figure import Box, Figure, Note
from btq_lang.graph.picture import foldable
from btq_lang.graph.placing import Drawing, place
from btq_lang.trace.states import SIGNS, box_class, state_at, worst_state
from btq_lang.util.grouping import grouped
from btq_lang.util.record import Record, replace

if TYPE_CHECKING:
    from btq_lang.trace.overview import Overview, RequirementRow


def drawings(overview: Overview, qualities: Mapping[str, str]) -> Iterator[Drawing]:
    """A drawing of each tree.

    Args:
        qualities: the names of qualities, by the keys of their rows.
    """
    notes = [note for tree in overview.trees for box in tree.figure.boxes for note in box.notes]
    lookup = _Lookup(
        {row.key: row for row in overview.requirements},
        qualities,
        {node.key: node.name for node in overview.nodes},
        frozenset(note.key for note in notes if note.measured),
    )
    for tree in overview.trees:
        folded = _folded(replace(tree.figure, boxes=tuple(_with_name(box, lookup) for box in tree.figure.boxes)))
        yield _placed(replace(folded, boxes=tuple(_marked(box, lookup) for box in folded.boxes)))


class _Lookup(Record):
    """What boxes show, by keys.

    Attributes:
        qualities, nodes: their names.
        measured: the keys of the requirements that logs show at some node.
    """

    rows: Mapping[str, RequirementRow]
    qualities: Mapping[str, str]
    nodes: Mapping[str, str]
    measured: frozenset[str]


def _with_name(box: Box, lookup: _Lookup) -> Box:
    """A box without values of ports and what logs show of its node."""
    return replace(box, lines=tuple(line for line in box.lines[:1] if lookup.nodes[box.key].endswith(line)))


def _folded(figure: Figure) -> Figure:
    """A large tree without what is below nodes and has no note."""
    if len(figure.boxes) <= _WHOLE:
        return figure
    named = foldable(figure).boxes
    leads_to_note = [False] * len(named)
    for number in range(len(named) - 1, 0, -1):
        parent = named[number].parent
        if parent is not None and (named[number].notes or leads_to_note[number]):
            leads_to_note[parent] = True
    folded = foldable(figure, {box.name for box, leads in zip(named, leads_to_note, strict=True) if not leads})
    return replace(folded, boxes=tuple(replace(box, name="") for box in folded.boxes))


def _marked(box: Box, lookup: _Lookup) -> Box:
    """A box in the worst state of its requirements, with a short note for each of them and each quality."""
    rows = lookup.rows
    by_key = grouped((note.key, note) for note in box.notes if note.key in rows)
    # A node of several missions has a note of each, of which logs need not show all.
    judged = {key: [note for note in notes if note.measured] or notes for key, notes in by_key.items()}
    states = {
        key: worst_state(state_at(rows[key], note, key in lookup.measured) for note in notes)
        for key, notes in judged.items()
    }
    worst_first = sorted(states, key=lambda key: list(SIGNS).index(states[key]))
    notes = [_requirement(key, rows[key].name, states[key]) for key in worst_first]
    qualities = [
        replace(note, title=lookup.qualities[note.key], lines=()) for note in box.notes if note.key not in rows
    ]
    whole_tree = f"#{box.key}" if box.hidden else ""
    link = next((note.link for note in (*notes, *qualities)), f"#{ID}{box.link[1:]}" if box.link else whole_tree)
    return replace(
        box,
        key=f"{ID}{box.key}",
        text="; ".join((box.text or box.title, *(note.text for note in notes))),
        notes=(*_shortened(notes), *qualities),
        link=link,
        state=box_class(worst_state(states.values())) if states else "",
    )


def _requirement(key: str, name: str, state: str) -> Note:
    title, text = f"{SIGNS[state]} {name}", f"{name}: {state}"
    return Note("requirement", key, title, text=text, state=box_class(state), link=f"#{key}")


def _shortened(notes: Sequence[Note]) -> Sequence[Note]:
    """The notes of a node; of many, the last ones as one, in the worst of their states."""
    if len(notes) <= _NOTES:
        return notes
    rest = notes[_NOTES - 1 :]
    sign, keys, text = rest[0].title[0], " ".join(note.key for note in rest), "; ".join(note.text for note in rest)
    more = replace(rest[0], key=keys, title=f"{sign} {len(rest)} more", text=text, link="#requirements")
    return [*notes[: _NOTES - 1], more]


def _placed(figure: Figure) -> Drawing:
    down = place(figure)
    if down.width <= _BROAD:
        return down
    right = place(figure, "right")
    return right if right.width < down.width else down


ID: Final = "at-"  # with which the ids of boxes begin
_WHOLE: Final = 40  # nodes of a tree that is not folded
_NOTES: Final = 5  # at a node
_BROAD: Final = 640  # pixels: a broader tree is drawn from left to right, if that is narrower
