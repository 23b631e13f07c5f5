"""The versions of BehaviorTree.CPP that missions are written for, and what changed between them: one row a change.

One invariant: every difference between versions is a row here, a field of a row in `engine_nodes` or `nodes` (since or
until when a node exists, a port's type before), a row of `engine_changes`, where a node does something else, or in
`syntax/script/versions.py`, where it is one of the scripting language.  Determined from the sources of the releases and
by experiment.
"""

from __future__ import annotations

import re
from functools import cache
from typing import Final, Literal

from btq_lang.util.record import Record

# The lines of the engine that ROS distributions ship; each means its last release (4.6.2, 4.8.4, 4.10.0).
VERSIONS: Final = ("4.6", "4.8", "4.10")
DEFAULT_VERSION: Final = VERSIONS[-1]
# The last line before the present syntax of XML.  Its files are checked, and `btq import` translates them; none is
# written for it.
VERSION_3: Final = "3.8"
MOVEIT_PRO: Final = "moveit-pro"
# Programs that provide a version of the engine and trees of their own, by the name that a project has for them.
PRODUCTS: Final = {MOVEIT_PRO: "4.6"}


class VersionChange(Record):
    """A behavior that one version introduces and all later ones keep.

    Attributes:
        what: the rest of a sentence that begins with a version.
        effect: what it is for a file that an earlier version reads.
    """

    since: str
    what: str
    effect: Literal["refused", "differs", "new"] = "refused"

    def holds(self, version: str) -> bool:
        """Whether a version does it."""
        return at_least(version, self.since)


class BehaviorChange(Record):
    """A change in what a node does.

    Attributes:
        since: the first release with it.
        nodes: those that change.
        what: the rest of a sentence that begins with a node's name.
        instead: what to write, or look at.
        port: on whose value the change depends; empty for none.
        value: the whole value of the port that changes its meaning, as a regular expression; None if the change is for
            nodes without a value of the port.
        breaks: whether the tree is refused, and does not only mean something else.
        keeps: the value of `port` that keeps the old meaning.
        until: the first release that does not do it any more; empty if all do.
        after: the first release that did what is changed; empty if all before did.
        when: what else there must be in the tree: a condition that checks/target_changes.py knows.
    """

    since: str
    nodes: tuple[str, ...]
    what: str
    instead: str = ""
    port: str = ""
    value: str | None = ""
    breaks: bool = False
    keeps: str | None = None
    until: str = ""
    after: str = ""
    when: str = ""

    def concerns(self, node: str) -> bool:
        return self.nodes == (ANY,) or node in self.nodes

    def matches(self, value: str | None) -> bool:
        """Whether a node changes whose port has a value, or None."""
        if not self.port:
            return True
        if self.value is None or value is None:
            return self.value is value
        return re.fullmatch(self.value, value) is not None


ANY: Final = "*"  # every node
ENTRIES_OF_SUBTREE: Final = VersionChange(
    "4.0", "takes `key` at a port of a SubTree for a text; before, for an entry's name", "differs"
)
LAST_TREE_COUNTS: Final = VersionChange(
    "4.0", "takes the last of several trees with one ID; before, the first", "differs"
)
ID_IN_COMPACT_FORM: Final = VersionChange("4.0", "refuses an `ID` in the compact form of a node")
UNDERSCORES: Final = VersionChange(
    "4.0",
    "ignores `__shared_blackboard` and `__autoremap` (write `_autoremap`), and takes no attribute that begins with `_` "
    "for a port",
    "differs",
)
ENTRY_WITHOUT_DOLLAR: Final = VersionChange("4.3.4", "takes `${key}` for a text; before, for an entry", "differs")
PORTS_OF_SUBTREE: Final = VersionChange("4.4", "requires the ports without default that the model of a SubTree has")
OUTPUT_IN_BRACES: Final = VersionChange(
    "4.4.2", "writes an output only to an entry in braces; before, `key` names one too", "differs"
)
ID_OF_EACH_TREE: Final = VersionChange("4.6", "refuses a tree without an ID beside other trees")
DEEP_TREES: Final = VersionChange("4.7", "reads trees of any depth; before, no node may have 97 others above it", "new")
ONE_ASYNC_SEQUENCE: Final = VersionChange("4.7", "refuses a second AsyncSequence in a ReactiveSequence")
NO_EXPLICIT_CHILD: Final = VersionChange("4.7", "refuses the explicit form of a node directly in a ReactiveSequence")
SCRIPT_RANKS: Final = VersionChange("4.7", "ranks the operators of scripts otherwise than 4.6 does", "differs")
BOOL_LISTS: Final = VersionChange("4.7.3", "reads a list of bool from text", "new")
NAME_RULES: Final = VersionChange("4.8", "refuses names of trees, nodes and ports with characters that it forbids")
UNIQUE_SUBTREES: Final = VersionChange("4.8", "refuses two SubTrees of one name in one tree")
NEW_SCRIPTS: Final = VersionChange(
    "4.9", 'reads scripts by a grammar of its own: every operator has a rank, and `"` no meaning', "differs"
)
STRICT_NUMBERS: Final = VersionChange(
    "4.9", "reads numbers as std::from_chars does: no blank, no `+`, no hexadecimal digits"
)
JSON_LISTS: Final = VersionChange("4.9", "reads a list from `json:[1, 2]`", "new")
TYPED_CONSTANTS: Final = VersionChange("4.9.1", "keeps a number that a SubTree gives to a port as a number", "differs")

CHANGES: Final = tuple([each for each in [*globals().values()] if isinstance(each, VersionChange)])  # all of the above


@cache
def at_least(version: str, since: str) -> bool:
    """Whether `version` is the version `since` or a later one.  Both are numbers with points; `4.8` is older than
    4.10."""
    return numbers(version) >= numbers(since)


def last_of(version: str) -> str:
    """A version that is after all releases of a line; for a release, the release itself."""
    return version if version.count(".") > 1 else f"{version}.99"


def is_before_4(version: str) -> bool:
    """Whether a version reads the syntax of version 3."""
    return not at_least(version, "4")


def targets() -> tuple[str, ...]:
    """Every line of the engine from the first of these versions to the last: `4.6`, `4.7` …"""
    (major, first), (_, last) = numbers(VERSIONS[0]), numbers(VERSIONS[-1])
    return tuple([f"{major}.{minor}" for minor in range(first, last + 1)])


def numbers(version: str) -> tuple[int, ...]:
    """A version as numbers, by which versions are ordered."""
    return tuple(int(part) for part in version.split("."))
