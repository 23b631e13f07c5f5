"""What led to a violation judged over a run: which leaves ran meanwhile, how the counted starts ended, and when an
event last happened.

One invariant: only the last activations of each leaf in the open run are kept, so memory does not grow with a log.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterable, Iterator, Sequence
from operator import attrgetter, itemgetter
from typing import TYPE_CHECKING, Final

from btq_lang.evidence.over_run import OverRun, target_of
from btq_lang.evidence.verdicts import CauseLink
from btq_lang.evidence.wording import duration, took
from btq_lang.requirements.model import Condition, DurationSum, Interval, ResolvedClaim, ResolvedEvent
from btq_lang.util.grouping import grouped
from btq_lang.util.text import counted

if TYPE_CHECKING:
    from btq_lang.evidence.history import Nearby
    from btq_lang.evidence.model import Activation, LoggedTree
    from btq_lang.evidence.verbs import Judgement


class RunExplainer:
    """Follows the leaves of a session in the open run."""

    def __init__(self, tree: LoggedTree, samples: Callable[[Condition, int], Iterator[CauseLink]]) -> None:
        """Follow nothing yet; `samples`: gives those that a condition read at a time, in whole sentences."""
        self._tree: Final = tree
        self._samples: Final = samples
        self._leaves: Final[dict[int, list[Activation]]] = {}

    def add(self, activation: Activation) -> None:
        """Record an activation of a leaf."""
        kept = self._leaves.setdefault(activation.uid, [])
        kept.append(activation)
        if len(kept) >= 2 * _KEPT:
            del kept[:_KEPT]

    def clear(self) -> None:
        """Begin another run."""
        self._leaves.clear()

    def chain(self, claim: ResolvedClaim, judgement: Judgement, over: OverRun, others: Nearby) -> tuple[CauseLink, ...]:
        """What led to a violation in the run that has just ended; `others`: the other nodes that a clause mentions."""
        if isinstance(claim.subject, DurationSum):
            return tuple(self._shares(judgement.starts))
        event = claim.subject.last if isinstance(claim.subject, Interval) else claim.event
        if judgement.measure is None and event is not None:
            return tuple(link for atom in event.atoms for link in self._last(atom, judgement.at, others))
        if judgement.measure is None and claim.condition is not None:
            return tuple(self._samples(claim.condition, judgement.at))
        if judgement.starts:
            return (_ends(self._path(judgement.starts[0]), judgement.starts), *self._inside(judgement.starts))
        if judgement.since is None:  # only a guard refused it
            return ()
        if claim.verb != "ends":
            return tuple(self._meanwhile(judgement.since, judgement.at, self._leaves))
        return tuple(self._going_on(judgement.since, judgement.at, over.own))

    def _meanwhile(self, begin: int, end: int, leaves: Iterable[int]) -> Iterator[CauseLink]:
        """The leaves that ran for at least a twentieth of a period, the longest first."""
        long_leaves: list[tuple[int, int, list[Activation]]] = []
        for uid in leaves:
            kept = self._leaves.get(uid, [])
            first = max(bisect_right(kept, begin, key=_BEGIN) - 1, 0)
            inside = [
                activation for activation in kept[first : bisect_left(kept, end, key=_BEGIN)] if activation.end > begin
            ]
            time = sum(min(activation.end, end) - max(activation.begin, begin) for activation in inside)
            if time > 0 and time * 20 >= end - begin:
                long_leaves.append((-time, uid, inside))
        for time, uid, inside in sorted(long_leaves, key=itemgetter(0, 1)):
            yield part(self._tree.nodes[uid].path, -time, len(inside), _failed(inside))

    def _going_on(self, begin: int, end: int, own: Sequence[Activation]) -> Iterator[CauseLink]:
        """What ran below a node that did not end; for a leaf, how long it ran."""
        late = next(activation for activation in own if activation.begin <= begin <= activation.end >= end)
        if late.uid in self._tree.leaves:
            yield CauseLink("self", self._path(late), ran(late), late.seconds, 1, _failed([late]))
        else:
            yield from self._meanwhile(begin, end, range(late.uid + 1, self._tree.last[late.uid] + 1))

    def _shares(self, starts: Sequence[Activation]) -> Iterator[CauseLink]:
        """How long each node of a sum ran, the longest first."""
        by_node = grouped((start.uid, start) for start in starts)
        times = {uid: sum(start.end - start.begin for start in own) for uid, own in by_node.items()}
        for uid in sorted(by_node, key=lambda uid: (-times[uid], uid)):
            yield part(self._tree.nodes[uid].path, times[uid], len(by_node[uid]), _failed(by_node[uid]))

    def _inside(self, starts: Sequence[Activation]) -> Iterator[CauseLink]:
        """The leaves that failed during activations of a node, the most frequent first."""
        links: list[CauseLink] = []
        for uid in range(starts[0].uid + 1, self._tree.last[starts[0].uid] + 1):
            kept = self._leaves.get(uid, [])
            inside = [
                activation
                for activation in kept
                if starts[0].begin <= activation.begin and activation.end <= starts[-1].end
            ]
            if failed := _failed(inside):
                time = sum(activation.end - activation.begin for activation in inside)
                text = f"{self._path(inside[0])} failed in {failed} of its {counted(len(inside), 'start')}"
                links.append(CauseLink("failure", self._path(inside[0]), text, time / 1e6, len(inside), failed))
        return iter(sorted(links, key=lambda link: -link.failed))

    def _last(self, event: ResolvedEvent, time: int, others: Nearby) -> Iterator[CauseLink]:
        """What the node of an event last did instead."""
        if event.condition is not None:
            yield from self._samples(event.condition, time)
            return
        target = target_of(event)
        uids = others.find(target)
        before = [activation for activation in others.activations(target) if activation.begin <= time]
        if before:
            last = before[-1]
            text = f"{self._path(last)} had started {ago(time - last.begin)}"
            if last.end <= time and last.outcome in _CAME_TO:
                text = f"{self._path(last)} {_CAME_TO[last.outcome]} {ago(time - last.end)}"
            yield CauseLink("event", self._path(last), text, last.seconds, len(before), _failed(before))
        elif isinstance(uids, tuple) and uids:
            path = self._tree.nodes[uids[0]].path
            yield CauseLink("event", path, f"{path} had not started in the run", 0.0, 0, 0)

    def _path(self, activation: Activation) -> str:
        return self._tree.nodes[activation.uid].path


def part(path: str, time: int, number: int, failed: int) -> CauseLink:
    """A node that took a share of the time; time in µs."""
    text = f"{path} ran {duration(time / 1e6)} of it"
    if number > 1:
        text += f" in {number} starts"
        text += f", {failed} of them failed" if failed else ""
    elif failed:
        text += ", and failed"
    return CauseLink("part", path, text, time / 1e6, number, failed)


def ran(activation: Activation) -> str:
    """How long a node ran."""
    time = took(activation)
    return f"it ran {time}" if time else "it ended at once"


def _ends(path: str, starts: Sequence[Activation]) -> CauseLink:
    """How activations of a node ended."""
    numbers = {outcome: sum(start.outcome == outcome for start in starts) for outcome in _ENDED}
    came = [f"{number} {_ENDED[outcome]}" for outcome, number in numbers.items() if number]
    time = sum(start.end - start.begin for start in starts)
    return CauseLink("starts", path, ", ".join(came), time / 1e6, len(starts), _failed(starts))


def _failed(activations: Iterable[Activation]) -> int:
    return sum(activation.outcome == "F" for activation in activations)


def ago(time: int) -> str:
    """`… before`, for a duration in µs."""
    return f"{duration(time / 1e6)} before" if time >= _JUST_BEFORE else "just before"


_BEGIN: Final = attrgetter("begin")
_CAME_TO: Final = {"S": "had succeeded", "F": "had failed", "H": "had been halted"}
_ENDED: Final = {"F": "failed", "H": "halted", "O": "still running", "S": "succeeded"}
_JUST_BEFORE: Final = 1000  # µs
_KEPT: Final = 1000  # of each leaf
