"""What the guards, nodes that a build adds around others, did: which nodes they stopped, whose start they refused, and
whose success they did not accept.

One invariant: an activation is passed on only when it is certain what the guards around it did: a halted one when its
nearest ancestor that was not halted itself has ended, a successful one when its success has been checked.  A guard
has failed when its check has, also where the log is cut off before the guard's own row.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Set
from itertools import takewhile
from typing import Final

from btq_lang.btcpp.wrappers import EVALUATING, LIMITING, WATCHING
from btq_lang.catalog.verbs import VERBS, words
from btq_lang.evidence.model import ROOT, Activation, LoggedTree, Moment
from btq_lang.util.record import Record


class Guard(Record):
    """A node that a build added around another one to enforce a requirement.

    Attributes:
        path: of the node that decides: itself, or the condition that it evaluates.
        requirement: empty: the mission does not have the node.
        verbs: of the clauses that it enforces; none: it halts the whole mission.
        checks: whether it evaluates a condition when the node has succeeded.
        halts: whether it may halt the node: it is ticked, or waits, while that runs.
    """

    path: str
    requirement: str
    verbs: frozenset[str]
    checks: bool = False
    halts: bool = True

    @property
    def refuses(self) -> bool:
        """Whether it looks only before the node starts, so that each time it fails it has refused a start."""
        return bool(self.verbs) and not (self.checks or self.halts)


class RefusedStart(Record):
    """A start that a guard refused because it would have violated a clause."""

    uid: int
    at: Moment
    guard: Guard


class Guards:
    """The guards around some nodes of a tree, while a log is read.

    Attributes:
        concerned: those nodes, the guards and the root; other activations need not be passed in.
        needed: those of them on which what is passed on depends.
        last: the requirement of the guard that last violated something in the open run; empty if none has.
    """

    def __init__(
        self, tree: LoggedTree, enforcing: Mapping[int, str], judged: Collection[int], unjoined: Set[int] = frozenset()
    ) -> None:
        """Wait for activations.

        Args:
            enforcing: guards, each with its requirement.
            judged: the nodes with clauses.
            unjoined: nodes that the mission does not have: what they do around others is unknown.
        """
        self.last = ""
        names = {**dict.fromkeys(unjoined, ""), **enforcing}
        self._around: Final = {uid: tuple(takewhile(names.__contains__, tree.above(uid))) for uid in judged}
        conditions = {tree.parent[uid]: uid for uid in enforcing if tree.nodes[uid].kind == EVALUATING}
        self._guards: Final = {uid: _guard(tree, uid, conditions.get(uid, uid), name) for uid, name in names.items()}
        self._holders: Final = {condition: guard for guard, condition in conditions.items()}
        self._inside: Final = {guard: uid for uid, around in self._around.items() for guard in around}
        self._waiting: list[tuple[Activation, tuple[int, ...]]] = []
        self._failed: Final[dict[int, Moment]] = {}  # when the condition of a guard failed, until the guard ends
        self._shown: Final[dict[int, Moment]] = {}  # of guards that have not ended: when the node inside last began
        self.concerned: Final = {*judged, *names, ROOT}
        deciding = {condition for condition, guard in self._holders.items() if guard in self._inside}
        self.needed: Final = {*judged, *self._inside, *deciding, ROOT}

    def see(self, activation: Activation) -> tuple[list[tuple[Activation, Guard | None]], RefusedStart | None]:
        """The activations that can be judged now that this one has ended, each with the guard that stopped it or did
        not accept its success; and the start that it refused, if it is a guard.
        """
        uid = activation.uid
        if activation.outcome == "F" and uid in self._holders:
            holder = self._holders[uid]
            inside = self._inside.get(holder)
            if inside is not None and self._guards[holder].refuses:  # whatever rows its other nodes have
                self.last = self._guards[holder].requirement
                return [], RefusedStart(inside, activation.ended, self._guards[holder])
            self._failed[holder] = activation.ended
        settled: list[tuple[Activation, Guard | None]] = []
        refusal = self._refusal(activation)
        for failed, failed_at in [*self._failed.items()] if uid == ROOT else ():
            if failed != ROOT:  # it has no row
                stopped, refused = self.see(Activation(failed, (0, 0), failed_at, "F"))
                settled += stopped
                refusal = refusal or refused
        around = self._around.get(uid)
        self._shown.update(dict.fromkeys(around or (), activation.shown))
        waiting: list[tuple[Activation, tuple[int, ...]]] = []
        if uid in self._guards or uid == ROOT:  # only these settle others
            waiting, self._waiting = self._waiting, waiting
        for ended, guards in waiting:
            if uid not in guards and uid != ROOT:
                self._waiting.append((ended, guards))
                continue
            further = guards[guards.index(uid) + 1 :] if uid in guards else ()
            is_inside = activation.started <= ended.started  # else it left no row, and this one came later
            guard = self._guards[uid] if uid in guards and is_inside and self._violates(ended, activation) else None
            if guard is not None and guard.verbs:
                self.last = guard.requirement
            if guard is None and is_inside and activation.outcome == ended.outcome != "S" and further:
                self._waiting.append((ended, further))
            elif guard is None and ended.outcome == "S" and (checks := self._checks(further)):
                self._waiting.append((ended, checks))
            else:
                settled.append((ended, guard))
        if around and activation.outcome in ("H", "O"):
            self._waiting.append((activation, around))
        elif around and activation.outcome == "S" and (checks := self._checks(around)):
            self._waiting.append((activation, checks))
        elif around is not None:
            settled.append((activation, None))
        self._failed.pop(uid, None)
        self._shown.pop(uid, None)
        return settled, refusal

    def _refusal(self, activation: Activation) -> RefusedStart | None:
        uid = activation.uid
        failed_at = self._failed.get(uid)
        inside = self._inside.get(uid)
        if failed_at is None or inside is None or not self._guards[uid].verbs:
            return None
        if uid in self._shown and self._shown[uid] >= activation.shown:
            return None
        self.last = self._guards[uid].requirement
        return RefusedStart(inside, failed_at, self._guards[uid])

    def end_run(self) -> None:
        """Begin another run."""
        self.last = ""

    def _checks(self, guards: tuple[int, ...]) -> tuple[int, ...]:
        return tuple(guard for guard in guards if self._guards[guard].checks)

    def _violates(self, ended: Activation, by: Activation) -> bool:
        """Whether a guard that has ended stopped an activation inside of it, or did not accept its success."""
        has_failed = by.uid in self._failed and self._failed[by.uid] >= ended.started
        return has_failed or (by.outcome == "F" and ended.outcome == "H" and self._guards[by.uid].halts)


def _guard(tree: LoggedTree, uid: int, condition: int, requirement: str) -> Guard:
    kind = tree.nodes[uid].kind
    purpose = tree.nodes[uid].path.rpartition("_")[2]  # a build names it
    path = tree.nodes[condition].path
    if not requirement:
        return Guard(path, "", frozenset())
    if kind == LIMITING:
        return Guard(path, requirement, words(enforced="limit"))
    if kind == WATCHING:
        return Guard(path, requirement, words(limits=("success",)) | {purpose} if purpose in VERBS else frozenset())
    checked = _CHECKED.get(purpose)
    if checked is not None:
        return Guard(path, requirement, frozenset([checked]), checks=True, halts=False)
    return Guard(path, requirement, words(enforced="refusal") & {_REFUSED.get(purpose, purpose)}, halts=False)


# The last word in the name of a Sequence that checks a success, and the verb of its clause.
_CHECKED: Final = {"leaves": "leaves", "ends": "ends with", "used": "uses"}
_REFUSED: Final = {"starts": "starts per"}
