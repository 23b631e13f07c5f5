"""What stands around a node for a requirement, as data.

One invariant: it says what is put where, and `wrappers` alone makes elements of it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final, Literal, TypeAlias

from btq_lang.util.record import Record

if TYPE_CHECKING:
    WrapperTag: TypeAlias = Literal["Sequence", "ReactiveSequence", "Timeout"]

# The kinds that do a clause's work, by which a log shows who stopped a node.
LIMITING: Final = "Timeout"  # halts the node after a time
WATCHING: Final = "ReactiveSequence"  # halts the node when a condition beside it changes
EVALUATING: Final = "ScriptCondition"  # that condition, or the one that refuses a start

# From the outside in: what stands around the node of several requirements is ordered by this.
START: Final = 0  # the beginning of the mission
VALUES: Final = 1  # what is read when the node starts
CONDITION: Final = 2  # what must hold when it starts
CHECK: Final = 3  # what must hold when it has succeeded
GUARD: Final = 4  # what must hold while it runs
LIMIT: Final = 5
INSIDE: Final = 6  # what notes that the node itself starts and ends


class Leaf(Record):
    """A Script or a ScriptCondition beside a node.

    Attributes:
        failed: what is done when it fails: a script.
    """

    tag: Literal["Script", "ScriptCondition"]
    name: str
    code: str
    failed: str | None = None


class FirstValues(Record):
    """What entries are where nobody has written them before the tree runs for the first time.

    A script cannot ask whether an entry is there, so a node does: `WasEntryUpdated` fails where its entry was never
    written.  It also fails where that was not written since it was last asked, hence the `RunOnce`.  The entry has no
    braces, for a port makes an entry of its own type, in which no script can store a text.

    Attributes:
        values: each entry, as scripts name it (`@speed`), with its value, a script.
    """

    values: tuple[tuple[str, str], ...]


class Wrapper(Record):
    """An element around a node.

    Attributes:
        rank: what is outside of what: one of the constants above.
        requirement: who asks for it.
        attributes: others than its name, values as they read.
        before, behind: what stands in it beside the node.
    """

    rank: int
    requirement: str
    tag: WrapperTag
    name: str
    attributes: tuple[tuple[str, str], ...] = ()
    before: tuple[Leaf | FirstValues, ...] = ()
    behind: tuple[Leaf, ...] = ()


def may_be_skipped(names: Sequence[str]) -> bool:
    """Whether a node with attributes of these names may be skipped by what they say."""
    return "_skipIf" in names or "_while" in names
