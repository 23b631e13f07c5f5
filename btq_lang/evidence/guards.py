"""What the guards, nodes that a build adds around others, did: which nodes they stopped, and whose start they refused.

One invariant: a halted activation is passed on only when it is known what halted it: its nearest ancestor that was not
halted itself.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from itertools import takewhile
from typing import Final

from btq_lang.btcpp.around import EVALUATING
from btq_lang.catalog.verbs import words
from btq_lang.evidence.model import ROOT, Activation, LoggedTree
from btq_lang.util.record import Record


class Guard(Record):
    """A node that a build added around others to enforce a requirement.

    Attributes:
        kind: `Timeout`, `ReactiveSequence`, `Sequence` or `ScriptCondition`.
    """

    kind: str
    requirement: str


class Refusal(Record):
    """A start that a guard refused because it would have violated a clause with this verb."""

    uid: int
    time: int
    requirement: str
    verb: str


class Guards:
    """The guards around some nodes of a tree, while a log is read.

    Attributes:
        concerned: those nodes, the guards and the root; other activations need not be passed in.
    """

    def __init__(self, tree: LoggedTree, enforcing: Mapping[int, str], judged: Collection[int]) -> None:
        """Wait for activations; `enforcing`: guards, each with its requirement; `judged`: the nodes with clauses."""
        self._guards: Final = {uid: Guard(tree.nodes[uid].kind, name) for uid, name in enforcing.items()}
        self._around: Final[dict[int, tuple[int, ...]]] = {}  # innermost first
        self._refuse: Final[dict[int, tuple[str, list[int]]]] = {}
        self._waiting: list[tuple[Activation, tuple[int, ...]]] = []
        self.concerned: Final = {*judged, *enforcing, ROOT}
        for uid in judged:
            around = self._around[uid] = tuple(takewhile(self._guards.__contains__, tree.above(uid)))
            for guard in self._guards:
                if self._guards[guard].kind == EVALUATING and tree.parent[guard] in around:
                    verb = tree.nodes[tree.parent[guard]].path.rpartition("_")[2]
                    if verb in _REFUSING:
                        self._refuse.setdefault(guard, (verb, []))[1].append(uid)

    def settled(self, activation: Activation) -> list[tuple[Activation, Guard | None]]:
        """The activations that can be judged now that this one has ended, each with the guard that stopped it."""
        uid = activation.uid
        around = self._around.get(uid)
        found: list[tuple[Activation, Guard | None]] = []
        waiting, self._waiting = self._waiting, []
        for halted, guards in waiting:
            if uid not in guards and uid != ROOT:
                self._waiting.append((halted, guards))
                continue
            further = guards[guards.index(uid) + 1 :] if uid in guards else ()
            is_inside = activation.started <= halted.started  # else it left no row, and this one came later
            if is_inside and activation.outcome == "H" and further:
                self._waiting.append((halted, further))
            else:
                is_stopped = is_inside and activation.outcome == "F" and uid in guards
                found.append((halted, self._guards[uid] if is_stopped else None))
        if around and activation.outcome == "H":
            self._waiting.append((activation, around))
        elif around is not None:
            found.append((activation, None))
        return found

    def refused(self, activation: Activation) -> list[Refusal]:
        """The starts that the activation which has just ended refused."""
        if activation.outcome != "F" or activation.uid not in self._refuse:
            return []
        requirement = self._guards[activation.uid].requirement
        verb, refused = self._refuse[activation.uid]
        return [Refusal(uid, activation.end, requirement, verb) for uid in refused]


_REFUSING: Final = words(enforced="refusal")  # the end of the names of Sequences that refuse a start
