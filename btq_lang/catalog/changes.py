"""A change in what a node does, from one release of the engine or of Nav2 on."""

from __future__ import annotations

import re
from typing import Final

from btq_lang.util.record import Record

ANY: Final = "*"  # every node


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
