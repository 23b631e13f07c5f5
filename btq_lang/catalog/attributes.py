"""Attributes of a node that are not ports: the engine's pre- and post-conditions, and those of tools, which it ignores.

One invariant: every attribute here begins with `_`; the engine takes no such attribute for a port.  It does not know
`name` and `ID`, which a file writes in other ways.  An attribute with a `_` that is not here is most likely a
misspelling: the engine keeps it silently and never reads it.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, Literal

from btq_lang.util.record import Record


class AttributeKind(Record):
    """An attribute.

    Attributes:
        group: pre: a pre-condition; post: a post-condition; engine: others that the engine reads; tool: those it
            ignores.
    """

    name: str
    group: Literal["pre", "post", "engine", "tool"]
    doc: str

    @property
    def is_script(self) -> bool:
        """Whether its value is a script."""
        return self.group in ("pre", "post")


_KINDS: Final = (
    # In the order in which the engine evaluates them, whatever the order in the file.
    *(
        AttributeKind(
            name,
            "pre",
            f"if true when the node starts, the node returns {result} without a tick; not checked while it runs",
        )
        for name, result in (("_failureIf", "FAILURE"), ("_successIf", "SUCCESS"), ("_skipIf", "SKIPPED"))
    ),
    AttributeKind(
        "_while", "pre", "checked at every tick; when it is false, the node is halted and returns SKIPPED, not FAILURE"
    ),
    AttributeKind("_onHalted", "post", "runs when the node is halted, also at the end of a tree that never reached it"),
    AttributeKind("_onSuccess", "post", "runs after the node has succeeded"),
    AttributeKind("_onFailure", "post", "runs after the node has failed"),
    AttributeKind("_post", "post", "runs after the node has completed, either way, and after _onSuccess or _onFailure"),
    AttributeKind("_autoremap", "engine", "on a SubTree: passes every entry of this blackboard under the same name"),
    AttributeKind("_description", "tool", "a description of the node, shown by Groot; btq writes requirements into it"),
    AttributeKind("_collapsed", "tool", "Groot shows the subtree collapsed"),
    AttributeKind("_favorite", "tool", "Groot lists the tree among the favorites"),
    AttributeKind("_hardcoded", "tool", "MoveIt Pro: the tree belongs to the robot and cannot be edited"),
    AttributeKind("_subtreeOnly", "tool", "MoveIt Pro: the tree is available as a subtree, not as a mission"),
    AttributeKind("_fullpath", "tool", "the path of a tree's instance, in the XML of a log"),
    AttributeKind("_uid", "tool", "the number of a node, in the XML of a log"),
    AttributeKind("_btq", "tool", "the requirement that a generated node enforces"),
    AttributeKind(
        "__shared_blackboard", "tool", "shared the blackboard in version 3; version 4 ignores it: use _autoremap"
    ),
    AttributeKind("__autoremap", "tool", "the name of _autoremap in version 3; version 4 ignores it"),
)

# By name.
RESERVED_ATTRIBUTES: Final[Mapping[str, AttributeKind]] = {kind.name: kind for kind in _KINDS}
# Those that version 3 of the engine does not read.
OF_VERSION_4: Final = frozenset([kind.name for kind in _KINDS if kind.is_script or kind.group == "engine"])
