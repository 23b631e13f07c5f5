"""Changes as data, and what two sets of values differ in.

One invariant: a change has a place in each mission that it can be seen in.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final, Literal, TypeAlias

from btq_lang.diff.said import Place, Values
from btq_lang.util.record import Record

# The order in which changes are told: what the mission is and must be first, then how it does that.
THINGS: Final = (
    *("mission", "include", "requirement", "apply", "quality"),
    *("signal", "context", "node model", "tree", "xml", "guard"),
)
GUARD: Final = "guard"  # what enforces a requirement in XML, which the mission says nothing of

What: TypeAlias = "Literal['added', 'removed', 'moved', 'changed', 'renamed']"


class Detail(Record):
    """What is said otherwise of something.

    Attributes:
        aspect: `station`, `name`, `kind`, `takes`, `quality safety`, `requirement rq1`, `port battery`.
        old: what was said, in one line; None where nothing was.
        new: what is said now, likewise.
    """

    aspect: str
    old: str | None
    new: str | None


class Change(Record):
    """A change between two missions.

    Attributes:
        thing: `tree`, `node`, `requirement`, `signal`, `context`, `quality`, `node model`, `include`, `apply`,
            `mission`, `xml`, `guard`.
        name: its name in the new mission, or in the old one where it is gone; of a node the path to it.
        old, new: where it stands; None where it does not.
        details: what is said otherwise; of a node that was added or removed, the requirements attached to it.
        below: how many nodes were added or removed with it.
        around: the nodes, in both missions, that it was put around or taken from around.
        earlier: the old name, the old path.
    """

    what: What
    thing: str
    name: str
    old: Place | None
    new: Place | None
    details: tuple[Detail, ...] = ()
    below: int = 0
    around: tuple[str, ...] = ()
    earlier: str | None = None


def section(change: Change) -> str:
    """The one of `THINGS` that a change is told under: nodes belong to their trees."""
    return "tree" if change.thing == "node" else change.thing


def details(old: Values, new: Values) -> Iterator[Detail]:
    """What is said otherwise, in the order of what was said and then of what is new."""
    for aspect in (*old, *(aspect for aspect in new if aspect not in old)):
        before, after = old.get(aspect), new.get(aspect)
        if before is None or after is None or before.key != after.key:
            yield Detail(aspect, before.text if before is not None else None, after.text if after is not None else None)
