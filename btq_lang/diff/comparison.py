"""Two compared missions, with all that is needed to show where a change is."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import Final

from btq_lang.btcpp.marks import is_generated
from btq_lang.btcpp.models import made_models
from btq_lang.diff import Change, DiskPlace, compare
from btq_lang.diff.changes import GUARD, Detail
from btq_lang.util.record import Record, replace
from btq_lang.util.text import Position
from btq_lang.workspace.workspace import Workspace


class UnmergedEdit(Record):
    """A manual edit of a mission's XML that is not a part of the mission.

    Attributes:
        name: of the generated node.
        contents: now, in a form that can be compared.
        message: what happened to it, and what to do.
    """

    name: str
    contents: str
    message: str
    place: DiskPlace


class Side(Record):
    """One of two missions.

    Attributes:
        name: None if this mission does not exist, so that all of the other was added or removed.
        paths: its files, the mission's own last.
        shown: turns a path into the one to show.
        manual_edits: the manual edits, if it is XML.
    """

    name: str | None
    workspace: Workspace
    paths: tuple[str, ...]
    shown: Callable[[str], str]
    manual_edits: tuple[UnmergedEdit, ...] = ()

    def place(self, place: DiskPlace) -> tuple[str, Position, Position]:
        """A place: the file as it is shown, and its start and end, counted from 0."""
        lines = self.workspace.files[place.path].source_lines
        return self.shown(place.path), lines.position(place.span.start), lines.position(place.span.end)


class MissionComparison(Record):
    """Two missions and what changed between them."""

    old: Side
    new: Side
    changes: tuple[Change, ...]

    def line(self, change: Change) -> str:
        """`mission.btq:12`: the place of a change, in the new mission if possible."""
        side, place = (self.new, change.new) if change.new is not None else (self.old, change.old)
        assert place is not None, "a change has a place"
        path, start, _ = side.place(place)
        return f"{path}:{start.line + 1}"

    @property
    def title(self) -> str:
        """`old.btq -> new.btq`."""
        if self.old.name is None or self.new.name is None:
            return f"{self.new.name or self.old.name} ({'added' if self.old.name is None else 'removed'})"
        return f"{self.old.name} -> {self.new.name}"


def diff_missions(old: Workspace, old_path: str, new: Workspace, new_path: str) -> tuple[Change, ...]:
    """What changed between two missions; empty if and only if they mean the same.

        >>> from btq_lang import Workspace, diff_missions
        >>> old = Workspace.of({"main.btq": "BehaviorTree Main\\n    Retry (num_attempts = 2)\\n        Dock\\n"})
        >>> new = Workspace.of({"main.btq": "BehaviorTree Main\\n    Retry (num_attempts = 3)\\n        Dock\\n"})
        >>> (change,) = diff_missions(old, "main.btq", new, "main.btq")
        >>> change.what, change.name, change.details
        ('changed', 'Main/Retry', (Detail(aspect='num_attempts', old='2', new='3'),))

    Args:
        old_path, new_path: of the missions, in .btq or XML, in their workspaces, which may be the same one; what they
            include is a part of them.

    Raises:
        KeyError: a file does not exist.
    """
    sides = Side(old_path, old, old.closure(old_path), str), Side(new_path, new, new.closure(new_path), str)
    return without_made_models(compared(*sides)).changes


def compared(old: Side, new: Side) -> MissionComparison:
    """Compare two missions."""
    changes = compare(old.workspace, old.paths, new.workspace, new.paths)
    return MissionComparison(old, new, (*changes, *_manual_edits(old, new)))


def without_made_models(comparison: MissionComparison) -> MissionComparison:
    """Leave out the models that a build has added to XML for undeclared nodes."""
    generated = {
        (what, path, name)
        for what, side in (("removed", comparison.old), ("added", comparison.new))
        for path in side.paths
        if side.workspace.files[path].is_foreign and is_generated(side.workspace.files[path].source)
        for name in made_models(side.workspace, path)
    }

    def is_made(change: Change) -> bool:
        place = change.new or change.old
        if place is None or change.thing != "node model":
            return False
        return (change.what, place.path, change.name) in generated

    return replace(comparison, changes=tuple(each for each in comparison.changes if not is_made(each)))


def _manual_edits(old: Side, new: Side) -> Iterator[Change]:
    before, after = ({(edit.name, edit.contents): edit for edit in side.manual_edits} for side in (old, new))
    for edit in old.manual_edits:
        if (edit.name, edit.contents) not in after:
            yield Change("changed", GUARD, edit.name, edit.place, None, (Detail("by hand", edit.message, None),))
    for edit in new.manual_edits:
        if (edit.name, edit.contents) not in before:
            yield Change("changed", GUARD, edit.name, None, edit.place, (Detail("by hand", None, edit.message),))


def all_changes(comparisons: Iterable[MissionComparison]) -> tuple[Change, ...]:
    return tuple(change for comparison in comparisons for change in comparison.changes)


NOWHERE: Final = Side(None, Workspace.of({}), (), str)
