"""Changes as data, and the differences of two sets of values.

One invariant: a change has a place in each mission in which it can be seen.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final, Literal, TypeAlias

from btq_lang.diff.contents import DiskPlace, Values
from btq_lang.util.record import Record

# The titles of the lists of changes, in their order: what the mission is and must be first, then how it does that.
TITLES: Final = {
    "mission": "Mission",
    "include": "Includes",
    "requirement": "Requirements",
    "apply": "Requirements applied",
    "hazard": "Hazards",
    "quality": "Qualities",
    "signal": "Signals",
    "context": "Contexts",
    "node model": "Node models",
    "tree": "Trees",
    "scenario": "Scenarios",
    "given": "Given for all scenarios",
    "xml": "Verbatim XML",
    "guard": "Guards",
}
GUARD: Final = "guard"  # enforces a requirement in XML; not a part of the mission

What: TypeAlias = "Literal['added', 'removed', 'moved', 'changed', 'renamed']"


class Detail(Record):
    """One aspect in which something differs.

    Attributes:
        aspect: `station`, `name`, `kind`, `takes`, `quality safety`, `requirement rq1`, `port battery`.
        old, new: its value, in one line; None if there is none.
    """

    aspect: str
    old: str | None
    new: str | None


class Change(Record):
    """A change between two missions.

    Attributes:
        thing: `tree`, `node`, `requirement`, `signal`, `context`, `quality`, `node model`, `include`, `apply`,
            `mission`, `xml`, `guard`.
        name: its name in the new mission, or in the old one if it was removed; for a node, its path.
        old, new: its place; None if that mission does not have it.
        details: the differences; for a node that was added or removed, the requirements attached to it.
        below: number of nodes that were added or removed with it.
        around: the nodes of both missions around which it was added or removed.
        earlier: the old name, the old path.
    """

    what: What
    thing: str
    name: str
    old: DiskPlace | None
    new: DiskPlace | None
    details: tuple[Detail, ...] = ()
    below: int = 0
    around: tuple[str, ...] = ()
    earlier: str | None = None


def section(change: Change) -> str:
    """The one of `TITLES` under which a change is listed: nodes belong to their trees."""
    return "tree" if change.thing == "node" else change.thing


def details(old: Values, new: Values) -> Iterator[Detail]:
    """The differences: of the old values in their order, then new ones."""
    for aspect in (*old, *(aspect for aspect in new if aspect not in old)):
        before, after = old.get(aspect), new.get(aspect)
        if before is None or after is None or before.key != after.key:
            yield Detail(aspect, before.text if before is not None else None, after.text if after is not None else None)
