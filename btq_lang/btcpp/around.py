"""The elements that are put around a node to enforce a requirement, as they are planned.

One invariant: each has the attribute `_btq`, with the requirement that it enforces.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Final, Literal, TypeAlias

from btq_lang.btcpp.document import Attribute, Content, Element, escape
from btq_lang.btcpp.marks import MARK
from btq_lang.util.record import Record

WrapperTag: TypeAlias = Literal["Sequence", "ReactiveSequence", "Timeout"]
LeafTag: TypeAlias = Literal["Script", "ScriptCondition"]

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


def marked(tag: str, requirement: str, attributes: Mapping[str, str], children: Iterable[Content] = ()) -> Element:
    """An element that enforces a requirement; the values of its attributes are unescaped."""
    spelt = [Attribute(name, escape(value)) for name, value in attributes.items()]
    return Element(tag, [*spelt, Attribute(MARK, escape(requirement))], children)


def leaf(tag: LeafTag, requirement: str, name: str, code: str, failed: str | None = None) -> Element:
    """A Script or a ScriptCondition beside a node; `failed`: script that runs when it fails.

    It does not succeed but is skipped, because a Sequence is skipped only if all its children are: a node that skips
    itself must not become one that has succeeded.  So a Script runs as the condition of its being skipped.
    """
    skipped = code if tag == EVALUATING else f"{code}; true"
    failing = {"_onFailure": failed} if failed is not None else {}
    return marked(tag, requirement, {"name": name, "code": code, "_skipIf": skipped, **failing})


def first_values(requirement: str, values: Mapping[str, str]) -> Element:
    """Gives values to entries that are still unwritten when the tree runs for the first time.

    A script cannot test whether an entry exists, so a node does: `WasEntryUpdated` fails if its entry was never
    written. It also fails if the entry was not written since the last test, hence the `RunOnce`.  The entry has no
    braces because a port creates an entry of its own type, in which no script can store a text.

    Args:
        values: by entry, as scripts name it (`@speed`); each a script.
    """
    asked = [
        marked("WasEntryUpdated", requirement, {"entry": entry, "_onFailure": f"{entry} := {value}"})
        for entry, value in values.items()
    ]
    # All of them are evaluated, whichever fails.
    inside = marked("ForceSuccess", requirement, {}, [marked("ParallelAll", requirement, {}, asked)])
    return marked("RunOnce", requirement, {"name": "btq_first"}, [inside])


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
    before: tuple[Element, ...] = ()
    behind: tuple[Element, ...] = ()


def may_be_skipped(names: Sequence[str]) -> bool:
    """Whether attributes of these names can make the engine skip their node."""
    return "_skipIf" in names or "_while" in names
