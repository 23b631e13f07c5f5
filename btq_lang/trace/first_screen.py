"""What the page opens with: which qualities matter where, and what is satisfied, violated and open, for people who do
not read trees.

One invariant: each requirement is in the table of qualities, also one without a quality or without a node.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Final

from btq_lang.catalog.qualities import get
from btq_lang.graph.placing import Drawing
from btq_lang.graph.svg import part
from btq_lang.render.pages import PageData
from btq_lang.trace.marked_trees import drawings
from btq_lang.trace.states import IN_SENTENCES, SIGNS, box_class, class_of, counted_states, state_of_row
from btq_lang.util.grouping import grouped
from btq_lang.util.record import Record
from btq_lang.util.text import counted

if TYPE_CHECKING:
    from btq_lang.trace.overview import Overview, RequirementRow, TreeRow

    _Rows = Mapping[str, RequirementRow]
    _Places = tuple[tuple[str, tuple[tuple[str, str], ...]], ...]  # trees, each with names of nodes and their keys


def first_screen(overview: Overview) -> PageData:
    """What the template shows of an overview."""
    rows = {row.key: row for row in overview.requirements}
    qualities = list(_qualities(overview, rows))
    names = {each.key: each.name for each in qualities}
    pictures = list(drawings(overview, names))
    titles = _titles(overview.trees)
    noted = {note.key for tree in overview.trees for box in tree.figure.boxes for note in box.notes}
    return {
        "headline": headline(overview),
        "qualities": [each.for_page(rows) for each in qualities],
        "legend": [(SIGNS[state], state, class_of(state)) for state in _states(overview, pictures)],
        "has_concerns": any(each.concerns for each in overview.qualities),
        "buttons": [
            (quality.name, " ".join(quality.note_keys))
            for quality in qualities
            if not noted.isdisjoint(quality.note_keys)
        ],
        "pictures": [
            {"name": title, "drawing": part(drawing, _label(tree, title, rows)), "width": drawing.width}
            for tree, title, drawing in zip(overview.trees, titles, pictures, strict=True)
        ],
        "layout": "stacked" if any(drawing.width > _BESIDE for drawing in pictures) else "side-by-side",
    }


def headline(overview: Overview) -> str:
    """How many requirements are in each state, and by which runs."""
    what = "selected requirement" if overview.is_selection else "requirement"
    numbers = [f"{number} {state}" for state, number in counted_states(map(state_of_row, overview.requirements))]
    sentence = f"{counted(len(overview.requirements), what)}{': ' if numbers else ''}{', '.join(numbers)}"
    judged = overview.judged
    if judged is None:
        has_verdicts = any(row.verdict for row in overview.requirements)
        return f"{sentence}." if has_verdicts else f"{sentence}. No log has been judged: there is no evidence yet."
    if not judged.runs:
        return f"{sentence}. The evidence has no run of these missions."
    last = f", the last one on {judged.last}" if judged.last and judged.runs > 1 else f" on {judged.last}"
    return f"{sentence}. Verdicts of {counted(judged.runs, 'run')}{last if judged.last else ''}."


# ---- qualities, and where they matter ----


class _Quality(Record):
    """A quality.

    Attributes:
        key: of its row; empty for requirements without one.
        part_of: the name of its characteristic; empty if it is one, or has none.
        requirements: the keys of those that make it measurable.
        places: what it matters for.
    """

    key: str
    name: str
    part_of: str
    requirements: tuple[str, ...]
    places: _Places

    @property
    def note_keys(self) -> tuple[str, ...]:
        """The keys of all its notes in the pictures."""
        return (self.key, *self.requirements) if self.key else self.requirements

    def for_page(self, rows: _Rows) -> PageData:
        by_state = grouped((state_of_row(rows[key]), (key, rows[key].name)) for key in self.requirements)
        return {
            "key": self.key,
            "note_keys": " ".join(self.note_keys),
            "name": self.name,
            "part_of": self.part_of,
            "places": [(tree, nodes[:_NODES], _more(len(nodes) - _NODES)) for tree, nodes in self.places[:_TREES]],
            "more_trees": _more(len(self.places) - _TREES, "tree"),
            "total": counted(len(self.requirements), "requirement") if len(by_state) > 1 else "",
            "states": [
                (SIGNS[state], state, class_of(state), number, by_state[state][:_NAMES], _more(number - _NAMES))
                for state, number in counted_states(state_of_row(rows[key]) for key in self.requirements)
            ],
        }


def _qualities(overview: Overview, rows: _Rows) -> Iterator[_Quality]:
    nodes = {node.key: node.name for node in overview.nodes}
    tree_of = {
        key: title for tree, title in zip(overview.trees, _titles(overview.trees), strict=True) for key in tree.nodes
    }
    for quality in overview.qualities:
        model = get(quality.id, overview.edition) if quality.id is not None else None
        above = get(quality.characteristic, overview.edition) if quality.characteristic is not None else None
        yield _Quality(
            quality.key,
            model.name if model is not None else quality.name,
            above.name if above not in (None, model) else "",
            quality.requirements,
            _places(quality.concerns, quality.requirements, rows, nodes, tree_of),
        )
    without = tuple(row.key for row in overview.requirements if row.quality is None)
    if without:
        yield _Quality("", "without a quality", "", without, _places((), without, rows, nodes, tree_of))


def _places(
    concerns: Sequence[str],
    requirements: Sequence[str],
    rows: _Rows,
    names: Mapping[str, str],
    tree_of: Mapping[str, str],
) -> _Places:
    """The nodes that have a concern or a requirement; of other subjects their words, without a tree and a key."""
    places: dict[str, dict[str, str]] = {}
    for node in concerns:
        places.setdefault(tree_of[node], {}).setdefault(names[node], node)
    for use in (use for requirement in requirements for use in rows[requirement].uses):
        for node in use.nodes:
            name = "the whole mission" if use.subject == "mission" else names[node]
            places.setdefault(tree_of[node], {}).setdefault(name, node)
        if not use.nodes:
            places.setdefault("", {}).setdefault(use.subject, "")
    return tuple((tree, tuple(of_tree.items())) for tree, of_tree in places.items())


def _titles(trees: Sequence[TreeRow]) -> list[str]:
    """The names of trees, with their files where several have the same."""
    numbers = Counter(tree.name for tree in trees)
    return [tree.name if numbers[tree.name] == 1 else f"{tree.name} in {tree.at.file}" for tree in trees]


def _more(number: int, what: str = "") -> str:
    return "" if number <= 0 else f"and {counted(number, f'more {what}') if what else f'{number} more'}"


# ---- trees ----


def _states(overview: Overview, pictures: Sequence[Drawing]) -> list[str]:
    """The states of requirements, and those at nodes."""
    classes = {note.note.state for drawing in pictures for box in drawing.boxes for note in box.notes}
    classes |= {box_class(state_of_row(row)) for row in overview.requirements}
    return [state for state in IN_SENTENCES if box_class(state) in classes]


def _label(tree: TreeRow, title: str, rows: _Rows) -> str:
    keys = dict.fromkeys(note.key for box in tree.figure.boxes for note in box.notes if note.key in rows)
    return f"The tree {title}: {counted(len(tree.nodes), 'node')}, {counted(len(keys), 'requirement')}"


_NODES: Final = 6  # named of a tree
_TREES: Final = 6
_NAMES: Final = 6  # of requirements in one state
_BESIDE: Final = 760  # pixels: a broader tree is below the table
