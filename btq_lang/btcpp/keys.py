"""Names for what a build generates: nodes, and entries of the blackboard.

One invariant: no two clauses share a name, and no two files of a mission share an entry of the root blackboard.  The
names of the user's entries are not known here: the underscore avoids them.

    rq1_limit   a node          @rq1_stop   in the root blackboard         _rq1_done   in that of the tree

An entry of one tree begins with `_`: `_autoremap` leaves such entries alone, so SubTrees that run at the same time
never share one.
"""

from __future__ import annotations

import re
from typing import Final


class Keys:
    """The names that are taken."""

    def __init__(self) -> None:
        self._taken: Final[set[str]] = set()
        self._numbers: Final[dict[str, int]] = {}  # the highest number in use, by stem
        self._stops: Final[dict[str, str]] = {}

    def next(self, requirement: str) -> str:
        """The prefix for the names of a clause's nodes and entries; `take` reserves it."""
        plain = legal(requirement)
        number = self._numbers.get(plain, 1)
        while (name := plain if number == 1 else f"{plain}_{number}") in self._taken:
            number += 1
        self._numbers[plain] = number
        return name

    def take(self, name: str) -> None:
        """Reserve a name."""
        self._taken.add(name)

    def stop(self, requirement: str) -> str:
        """The entry that halts the mission for a requirement, wherever it is violated."""
        entry = self._stops.get(requirement)
        if entry is None:
            plain = legal(requirement)
            name = f"@{plain}_stop"
            number = 1
            while name in self._stops.values():
                number += 1
                name = f"@{plain}_{number}_stop"
            entry = self._stops[requirement] = name
        return entry


def legal(name: str) -> str:
    """A name in which `_` replaces each character that scripts do not allow in names."""
    if name.isascii() and name.isidentifier():
        return name
    plain = _OTHER.sub("_", name)
    return f"_{plain}" if plain[:1].isdigit() else plain or "_"


_OTHER: Final = re.compile(r"[^A-Za-z0-9_]")
