"""The nodes that are put around a node to enforce a requirement, as data.

One invariant: only `wrappers` makes elements of this data.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, Literal, TypeAlias

from btq_lang.util.record import Record

WrapperTag: TypeAlias = Literal["Sequence", "ReactiveSequence", "Timeout"]

# The kinds that enforce a clause: a log shows by them what stopped a node.
LIMITING: Final = "Timeout"  # halts the node after a time
WATCHING: Final = "ReactiveSequence"  # halts the node when a condition beside it changes
EVALUATING: Final = "ScriptCondition"  # that condition, or the one that refuses a start

# From the outside in: the wrappers that several requirements put around one node are sorted by this rank.
START: Final = 0  # the beginning of the mission
VALUES: Final = 1  # values that are read when the node starts
CONDITION: Final = 2  # condition that must hold when the node starts
CHECK: Final = 3  # condition that must hold when the node has succeeded
GUARD: Final = 4  # condition that must hold while the node runs
LIMIT: Final = 5
INSIDE: Final = 6  # scripts that record the start and end of the node itself


class Leaf(Record):
    """A Script or a ScriptCondition beside a node.

    Attributes:
        failed: script that runs when it fails.
    """

    tag: Literal["Script", "ScriptCondition"]
    name: str
    code: str
    failed: str | None = None


class FirstValues(Record):
    """The values of entries that are still unwritten when the tree runs for the first time.

    A script cannot test whether an entry exists, so a node does: `WasEntryUpdated` fails if its entry was never
    written. It also fails if the entry was not written since the last test, hence the `RunOnce`.  The entry has no
    braces because a port creates an entry of its own type, in which no script can store a text.

    Attributes:
        values: each entry, as scripts name it (`@speed`), with its value, a script.
    """

    values: tuple[tuple[str, str], ...]


class Wrapper(Record):
    """An element around a node.

    Attributes:
        rank: one of the constants above.
        requirement: that it enforces.
        attributes: except its name; values are unescaped.
        before, behind: its other children, before and after the node.
    """

    rank: int
    requirement: str
    tag: WrapperTag
    name: str
    attributes: tuple[tuple[str, str], ...] = ()
    before: tuple[Leaf | FirstValues, ...] = ()
    behind: tuple[Leaf, ...] = ()


def may_be_skipped(names: Sequence[str]) -> bool:
    """Whether attributes of these names can make the engine skip their node."""
    return "_skipIf" in names or "_while" in names
