"""Some requirements of an overview, and what these concern.

One invariant: an overview of some requirements has no gap that the others would fill.
"""

from __future__ import annotations

from collections.abc import Sequence, Set
from typing import Final

from btq_lang.evidence.verdicts import WORST_FIRST
from btq_lang.trace.collect import totals_of
from btq_lang.trace.overview import WAYS, Overview, QualityRow, RequirementRow, TreeRow
from btq_lang.util.record import Record, replace


class Selection(Record):
    """What is asked of requirements: one word of each list that is not empty.

    Attributes:
        priorities: as they are written.
        qualities: a characteristic, a part of one, or a declared quality.
        states: of STATES.
    """

    priorities: Sequence[str] = ()
    qualities: Sequence[str] = ()
    states: Sequence[str] = ()


def selected(overview: Overview, selection: Selection) -> Overview:
    """The overview of the requirements that a selection asks for, with the hazards and qualities that they concern."""
    if not (selection.priorities or selection.qualities or selection.states):
        return overview
    names = {quality.key: _names(quality) for quality in overview.qualities}
    rows = tuple(row for row in overview.requirements if _is_asked_for(row, selection, names))
    keys = {row.key for row in rows}
    of_rows = {key for row in rows for key in (row.quality_key, *row.further_quality_keys)}
    part = replace(
        overview,
        requirements=tuple(replace(row, refined_by=_among(row.refined_by, keys)) for row in rows),
        qualities=tuple(
            replace(quality, requirements=_among(quality.requirements, keys))
            for quality in overview.qualities
            if quality.key in of_rows
        ),
        trees=tuple(_tree(tree, keys | of_rows) for tree in overview.trees),
        hazards=tuple(
            replace(hazard, requirements=_among(hazard.requirements, keys))
            for hazard in overview.hazards
            if not keys.isdisjoint(hazard.requirements)
        ),
        external=tuple(
            replace(external, requirements=_among(external.requirements, keys))
            for external in overview.external
            if not keys.isdisjoint(external.requirements)
        ),
        builds=tuple(
            replace(build, verdicts=tuple(one for one in build.verdicts if one[0] in keys)) for build in overview.builds
        ),
        is_selection=True,
    )
    return replace(part, totals=totals_of(part))


def none_selected(selection: Selection, number: int) -> str:
    """Says that a selection asks for none of some requirements; `number`: of them."""
    asked = {"has priority": selection.priorities, "has quality": selection.qualities, "is": selection.states}
    what = " and ".join(f"{verb} {' or '.join(words)}" for verb, words in asked.items() if words)
    return f"no requirement {what} (of {number})\n"


def _is_asked_for(row: RequirementRow, selection: Selection, names: dict[str, Set[str]]) -> bool:
    if selection.priorities and row.priority not in selection.priorities:
        return False
    own = {name for key in (row.quality_key, *row.further_quality_keys) if key is not None for name in names[key]}
    if selection.qualities and own.isdisjoint(selection.qualities):
        return False
    states = {*row.ways, row.verdict, "" if row.is_judged else NO_VERDICT}
    states |= {row.state if row.state != "open" else NOT_APPROVED, "suspect" if row.is_suspect else ""}
    return not selection.states or not states.isdisjoint(selection.states)


def _names(quality: QualityRow) -> Set[str]:
    """The names of a quality: that in the model, with and without what it is a part of, and its characteristic."""
    parts = (quality.id or "").split(".")
    below = (".".join(parts[:end]) for end in range(1, len(parts) + 1))
    return {quality.name, quality.characteristic or "", *parts, *below} - {""}


def _among(keys: Sequence[str], selected_keys: Set[str]) -> tuple[str, ...]:
    return tuple(key for key in keys if key in selected_keys)


def _tree(tree: TreeRow, keys: Set[str | None]) -> TreeRow:
    """A tree with the notes of some rows only."""
    boxes = (replace(box, notes=tuple(note for note in box.notes if note.key in keys)) for box in tree.figure.boxes)
    return replace(tree, figure=replace(tree.figure, boxes=tuple(boxes)))


NO_VERDICT: Final = "without verdict"
NOT_APPROVED: Final = "not approved"
# How a requirement is covered, its verdict, and its approval; `open` is the verdict on what people verify.
# What has changed since it was judged is suspect, too.
_APPROVALS: Final = ("approved", "approved without fingerprint", "suspect", NOT_APPROVED)
STATES: Final = (*WAYS, "not attached", *WORST_FIRST, NO_VERDICT, *_APPROVALS)
