"""What led to a violation: where the time went, where a failure began, which sample was read and which leaf ran then.

One invariant: ended activations are kept only as sums over the nodes below each judged node, and a run only as its last
failure, so memory does not grow with a log.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from functools import partial
from typing import TYPE_CHECKING, Final, TypeAlias

from btq_lang.catalog.nav2.nodes import NODES
from btq_lang.catalog.nodes import BUILTINS
from btq_lang.catalog.units import Unit
from btq_lang.catalog.verbs import VERBS
from btq_lang.evidence.explain_run import RunExplainer, ago, part, ran
from btq_lang.evidence.model import Activation, LoggedTree, Outcome
from btq_lang.evidence.signals import Signals, UnknownValue
from btq_lang.evidence.verdicts import CauseLink
from btq_lang.evidence.wording import quantity, took
from btq_lang.requirements.model import Condition, ResolvedClaim, ResolvedSignal, signals_in
from btq_lang.util.record import Record

if TYPE_CHECKING:
    from btq_lang.evidence.verbs import Judgement

    Sums: TypeAlias = dict[int, list[int]]  # by uid: activations, those that failed, µs


class FailureOrigin(Record):
    """Where a failure began: a node that failed although no child of it made it fail, or that has no child.

    Attributes:
        child: the child that ended last; 0 for none.
        outcome: of that child.
    """

    uid: int
    child: int
    outcome: Outcome | None


class Explainer:
    """Follows the nodes of a session while its log is read."""

    def __init__(
        self, tree: LoggedTree, judged: Collection[int], signals: Signals, *, has_clauses_over_runs: bool
    ) -> None:
        """Follow nothing yet; `judged`: the nodes whose violations are explained."""
        self._tree: Final = tree
        self._signals: Final = signals
        self._below: Final[dict[int, Sums]] = {uid: {} for uid in judged}  # since the last end of each judged node
        self._above: Final = {uid: [above for above in tree.above(uid) if above in judged] for uid in tree.nodes}
        self._going_on: Final = {uid for uid, node in tree.nodes.items() if node.kind in _GOES_ON}
        # Of open nodes: the child that ended last, or the first that failed of a node that then goes on.
        self._last: Final[dict[int, tuple[int, Outcome, FailureOrigin | None]]] = {}
        self._ended: Final[
            dict[int, tuple[Activation, Sums, FailureOrigin | None]]
        ] = {}  # the last of each judged node
        self._leaves: Final[dict[int, Activation]] = {}  # the last activation of each leaf
        self._failed: Activation | None = None  # the run's last leaf that took time and failed
        self.over_run: Final = RunExplainer(tree, partial(self._samples, is_named=True))
        self._is_over_run: Final = has_clauses_over_runs

    def see(self, activation: Activation) -> FailureOrigin | None:
        """Record an activation that has ended; returns where its failure began, if it failed."""
        uid, outcome = activation.uid, activation.outcome
        child, came, origin = self._last.pop(uid, _NO_CHILD)
        if outcome != "F":
            origin = None
        elif came != "F":
            origin = FailureOrigin(uid, child, came)
        if uid in self._below:
            self._ended[uid] = activation, self._below[uid], origin
            self._below[uid] = {}
        if uid in self._tree.leaves:
            self._leaves[uid] = activation
            if self._is_over_run:
                self.over_run.add(activation)
            if outcome == "F" and activation.ended != activation.shown:
                self._failed = activation
        parent = self._tree.parent[uid]
        before = self._last.get(parent)
        keeps_failure = before is not None and before[1] == "F" and parent in self._going_on
        # Halting a child does not cause the end.
        if parent and (before is None or (outcome != "H" and not keeps_failure)):
            self._last[parent] = uid, outcome, origin
        for above in self._above[uid]:
            sums = self._below[above].setdefault(uid, [0, 0, 0])
            sums[0] += 1
            sums[1] += outcome == "F"
            sums[2] += activation.end - activation.begin
        return origin

    def end_run(self) -> None:
        """Begin another run: what led to a violation began in its own run."""
        self._failed = None
        self.over_run.clear()

    def chain(self, claim: ResolvedClaim, judgement: Judgement, path: str) -> tuple[CauseLink, ...]:
        """What led to the violation of a clause by the activation, of the node with this path, that has just ended."""
        if claim.condition is not None:
            since = judgement.since if judgement.since is not None else judgement.at
            return tuple(self._sample(claim.condition, since, path))
        for activation, sums, origin in self._ended.values():
            if activation.end == judgement.at and self._tree.nodes[activation.uid].path == path:
                parts = tuple(self._parts(activation, sums))
                if judgement.measure is None and origin is not None:
                    return (self._origin(activation, sums, origin), *parts)
                if claim.signal is not None and judgement.measure is not None:
                    return (self._levels(claim.signal, judgement.measure.unit, activation), *parts)
                if parts or not VERBS[claim.verb].limits:
                    return parts
                return (
                    CauseLink("self", path, ran(activation), activation.seconds, 1, int(activation.outcome == "F")),
                )
        return ()

    def _parts(self, activation: Activation, sums: Sums) -> Iterator[CauseLink]:
        """Where the time went: the nodes that ran for a twentieth of it, leaves first, then the longest."""
        tree = self._tree
        long = [uid for uid, (_, _, time) in sums.items() if time * 20 >= activation.end - activation.begin and time]
        for uid in sorted(long, key=lambda uid: (tree.last[uid] > uid, -sums[uid][2], uid)):
            number, failed, time = sums[uid]
            yield part(tree.nodes[uid].path, time, number, failed)

    def _origin(self, activation: Activation, sums: Sums, origin: FailureOrigin) -> CauseLink:
        """Where a failure began."""
        nodes = self._tree.nodes
        path = nodes[origin.uid].path
        if origin.uid == activation.uid:
            text = ran(activation)
            if origin.outcome is not None:
                text = f"its last child {self._came_to(origin, origin.outcome)}"
            return CauseLink("origin", path, text, activation.seconds, 1, 1)
        number, failed, time = sums.get(origin.uid, (1, 1, 0))
        text = f"it began at {path}"
        if origin.outcome is not None:
            text += f", whose last child {self._came_to(origin, origin.outcome)}"
        elif number > 1:
            text += f", {failed} of its {number} starts failed"
        return CauseLink("origin", path, text, time / 1e6, number, failed)

    def _came_to(self, origin: FailureOrigin, outcome: Outcome) -> str:
        """How the last child ended, and which port of the node would have made it the result."""
        nodes = self._tree.nodes
        text = f"{nodes[origin.child].path} {_CAME_TO[outcome]}"
        kind = NODES.get(nodes[origin.uid].kind) if outcome == "S" else None
        port = kind.port_for("wraps") if kind is not None else None
        return f"{text}, which is lost without `{port.name}`" if port is not None else text

    def _levels(self, signal: ResolvedSignal, unit: Unit | None, activation: Activation) -> CauseLink:
        """The level of a signal at the start and at the end of an activation that used some of it."""
        levels = [self._signals.reading(signal, time) for time in (activation.begin, activation.end)]
        first, last = [quantity(float(level), unit) for level in levels if not isinstance(level, UnknownValue)]
        time = took(activation)
        text = f"`{signal.name}` went from {first} to {last} {f'in {time}' if time else 'at once'}"
        return CauseLink("sample", self._tree.nodes[activation.uid].path, text, activation.seconds, 1, 0)

    def _sample(self, condition: Condition, time: int, judged: str) -> Iterator[CauseLink]:
        """The samples that a condition read, and the leaf that had failed before."""
        yield from self._samples(condition, time)
        failed = self._failed
        path = self._tree.nodes[failed.uid].path if failed is not None else judged
        if failed is not None and path != judged and failed.end <= time:
            yield CauseLink("failure", path, f"{path} had failed before in this run", failed.seconds, 1, 1)

    def _samples(self, condition: Condition, time: int, *, is_named: bool = False) -> Iterator[CauseLink]:
        """The samples that a condition read: their age, and which leaf ran when they were taken."""
        for signal in dict.fromkeys(signals_in(condition)):
            sampled = self._signals.sampled(signal, time)
            if sampled is None:
                continue
            age = time - sampled
            text = f"{f'`{signal.name}` was ' if is_named else ''}sampled {ago(age)}"
            running = [leaf for leaf in self._leaves.values() if leaf.begin <= sampled <= leaf.end > leaf.begin]
            path = ""
            if running:
                path = self._tree.nodes[min(running, key=lambda leaf: leaf.end).uid].path
                text += f", while {path} ran"
            yield CauseLink("sample", path, text, age / 1e6, 1, 0)


_NO_CHILD: Final[tuple[int, Outcome | None, FailureOrigin | None]] = (0, None, None)
# After a child has failed, these run other children, whose results then do not matter.
_GOES_ON: Final = frozenset(
    [kind.tag for kind in BUILTINS.values() if kind.flow in ("parallel", "parallel-all", "try")]
)
_CAME_TO: Final = {"S": "succeeded", "H": "was halted", "O": "was still running"}
