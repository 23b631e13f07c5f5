"""The contents of a log: the tree that ran, and what its nodes did.

One invariant: times are whole microseconds since the epoch, and values are as they were logged, in whatever unit.  File
formats, requirements and verdicts are unknown here.
"""

from __future__ import annotations

from array import array
from bisect import bisect_left, bisect_right
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final, Literal, TypeAlias, TypeVar

from btq_lang.util.record import Record

if TYPE_CHECKING:
    from btq_lang.catalog.units import Unit

Transition: TypeAlias = tuple[int, int, int]  # time, uid, new status
SampleValue: TypeAlias = float | bool | str
Outcome: TypeAlias = Literal["S", "F", "H", "O"]
Timing: TypeAlias = Literal["exact", "latest", "broken", "late", "lost", "part"]
Moment: TypeAlias = tuple[int, int]  # time, and place among the rows of the log, which orders those of one time
T = TypeVar("T")
IDLE: Final = 0
RUNNING: Final = 1
SUCCESS: Final = 2
FAILURE: Final = 3
SKIPPED: Final = 4
UNKNOWN_END: Final = "the log does not say when it was halted"
UNKNOWN_BEGIN: Final = "the log does not say exactly when it began"
CLOCK_SET_BACK: Final = "the clock was set back meanwhile"
ROWS_LOST: Final = "transitions were lost meanwhile"
BEGUN_BEFORE: Final = ("late", "part")  # the timings of activations whose begin was not seen
CUT_BY_GAP: Final = ("lost", "part")  # those of runs of which later rows were lost
PLACES: Final = 4  # from one row to the next: there are moments just after one, between both, and just before the next
ENOUGH: Final = 0.01  # of a measure: what is known to this is known well enough for statistics
ROOT: Final = 1  # the uid of the node whose activations are the runs


class LiveMark(int):
    """A uid that no node has, for a mark between two transitions of a running robot."""


GAP: Final = LiveMark(-1)  # transitions before this one were not seen
PAUSE: Final = LiveMark(-2)  # for a while there has been none
UNTIL: Final = LiveMark(-3)  # up to this time there has been no other


class LoggedNode(Record):
    """A node of the tree in a log; `kind`: the ID it is registered under."""

    uid: int
    kind: str
    path: str

    @property
    def name(self) -> str:
        """The engine's name of it: its own name, or else its kind."""
        own = self.path.rpartition("/")[2]
        return self.kind if own == f"{self.kind}::{self.uid}" else own


class LoggedTree:
    """The tree in a log.

    Attributes:
        nodes: by uid.
        parent: the uid of the parent of each node; 0 for the root.
        last: the largest uid below each node; its own for a leaf.
        name: the ID of the tree; empty if the log does not name it.
        xml: as it is in the log; empty if it was made otherwise.
        delays: how long a Delay waits before it ticks its child, in µs, where that is a number.
        shows_begins: every node writes RUNNING when it begins, as in a simulated run.
    """

    def __init__(
        self,
        nodes: Sequence[tuple[int, str, str, int]],
        name: str = "",
        *,
        xml: str = "",
        delays: Mapping[int, int] | None = None,
        shows_begins: bool = False,
    ) -> None:
        """Build it from uid, kind, path and parent of each node, in the order of the uids."""
        self.name: Final = name
        self.shows_begins: Final = shows_begins
        self.xml: Final = xml
        self.delays: Final = delays or {}
        self.parent: Final = {uid: parent for uid, _, _, parent in nodes}
        self.last: Final = {uid: uid for uid, *_ in nodes}
        for uid, _, _, parent in reversed(nodes):
            if parent:
                self.last[parent] = max(self.last[parent], self.last[uid])
        self.leaves: Final = frozenset(uid for uid, last in self.last.items() if uid == last)
        self.nodes: Final = {uid: LoggedNode(uid, kind, path) for uid, kind, path, _ in nodes}

    def has_tree(self, uid: int) -> bool:
        """Whether a node is a SubTree, by the paths below it; its kind is the name of the tree."""
        return self.last[uid] > uid and self.nodes[uid + 1].path.startswith(f"{self.nodes[uid].path}/")

    def is_like(self, other: LoggedTree) -> bool:
        """Whether the other has the same nodes."""
        return (self.nodes, self.parent) == (other.nodes, other.parent)

    def above(self, uid: int) -> Iterator[int]:
        """The ancestors of a node, the nearest first."""
        while uid := self.parent[uid]:
            yield uid


class Activation:
    """One activation of a node, from its start to its end.

    Attributes:
        started, ended: when it began, at the latest, and ended, with the rows of the log that say so.
        shown: the time of the row that says that it began, and that row: by it, activations and events are in order.
        begin, end: the times of these moments.
        earliest: when it began at the earliest: equal to `begin` if that is known, 0 if nothing is.
        outcome: succeeded, failed, halted, or still open when the log ends.
        timing: `latest`: the log shows only that it had ended by `end`; `broken`: the clock was set back meanwhile;
            `late`: it began before `begin`, where nothing was seen; `lost`: a run of which later rows were lost;
            `part`: both of these.
    """

    __slots__ = ("_early", "begin", "earliest", "end", "ended", "outcome", "shown", "started", "timing", "uid")

    def __init__(
        self,
        uid: int,
        started: Moment,
        ended: Moment,
        outcome: Outcome,
        timing: Timing = "exact",
        early: Moment | None = None,
        shown: Moment | None = None,
    ) -> None:
        self.uid: Final = uid
        self.started: Final = started
        self.ended: Final = ended
        self.begin: Final = started[0]
        self.end: Final = ended[0]
        self.outcome: Final[Outcome] = outcome
        self.timing: Final[Timing] = timing
        self._early: Final = early if early is not None else started
        self.earliest: Final = self._early[0]
        self.shown: Final = shown if shown is not None else started

    @property
    def seconds(self) -> float:
        """Its duration; the least if its begin is not known."""
        return (self.end - self.begin) / 1e6

    @property
    def is_begin_known(self) -> bool:
        """Whether the log says when it began."""
        return self.earliest == self.begin

    @property
    def is_duration_known(self) -> bool:
        """Whether the log says how long it lasted, to one percent: enough for statistics."""
        return self.begin - self.earliest <= (self.end - self.begin) * ENOUGH

    def begun(self, is_early: bool) -> Moment:
        """When it began, at the earliest or at the latest."""
        return self._early if is_early else self.started

    def from_earliest(self) -> Activation:
        """The activation as if it had begun as early as it may have."""
        return Activation(self.uid, self.begun(True), self.ended, self.outcome, self.timing, shown=self.shown)

    def __repr__(self) -> str:
        return f"<{self.uid} {self.begin}..{self.end} {self.outcome} {self.timing}>"


class SampleSeries:
    """The samples of one signal, in the order of their times.

    Attributes:
        unit: of the values; None: the signal's own.
        lacking: why there is no value where one is None; empty: the entry was not on the blackboard.
    """

    def __init__(self, unit: Unit | None = None) -> None:
        self.unit: Final = unit
        self.lacking = ""
        self.times: Final = array("q")
        self.values: Final[list[SampleValue | None]] = []

    def add(self, time: int, value: SampleValue | None) -> None:
        """Add a sample, usually the latest; of several at one time the last counts.  None: no value from then on."""
        index = len(self.times)
        if index and time <= self.times[-1]:
            index = bisect_left(self.times, time)
            if self.times[index] == time:
                self.values[index] = value
                return
        self.times.insert(index, time)
        self.values.insert(index, value)

    def at(self, time: int) -> tuple[int, SampleValue | None] | None:
        """The time and value of the last sample at or before a time; None before the first."""
        index = bisect_right(self.times, time) - 1
        return (self.times[index], self.values[index]) if index >= 0 else None

    def between(self, begin: int, end: int) -> Sequence[int]:
        """The times of the samples after `begin`, up to `end`."""
        return self.times[bisect_right(self.times, begin) : bisect_right(self.times, end)]

    def forget_before(self, time: int) -> None:
        """Drop the samples that are not needed to answer for this time or later ones."""
        index = bisect_left(self.times, time) - 1
        if index > 0:
            del self.times[:index], self.values[:index]


def is_sample(value: object) -> bool:
    """Whether a value from a file can be a sample: a text, a bool, or a number that stays finite in any unit."""
    return isinstance(value, str | bool) or (isinstance(value, float | int) and -_LARGEST <= value <= _LARGEST)


def by_entry(boards: Mapping[Any, Mapping[Any, T]], main: str | None) -> dict[Any, T]:
    """What is on blackboards, by entry: on the main tree's, and of others the entries that only one of them has."""
    others = [board for name, board in boards.items() if name != main]
    times = Counter(key for board in others for key in board)
    alone = {key: value for board in others for key, value in board.items() if times[key] == 1}
    return {**alone, **boards.get(main, {})}


class LogSession:
    """What one logger object wrote: a tree and its transitions, which can be read once.

    Attributes:
        transitions: in the order of the file; of a running robot, with marks among them.
        samples: of the log's own blackboard entries, by entry; they grow while the transitions are read.
        signals: samples of signals that the project file finds in the log, by signal.
        keeping: the nodes that start a child again without resetting it; complete when the transitions have been read.
        remarks: notes about the file, complete when the transitions have been read.
        robot: its name, if the log has one.
        unlike: how the names of its nodes differ from those in the nearest mission, where the log has no tree and is of
            no mission.
    """

    def __init__(
        self,
        tree: LoggedTree,
        transitions: Iterator[Transition],
        samples: dict[str, SampleSeries] | None = None,
        remarks: list[str] | None = None,
        signals: Mapping[str, SampleSeries] | None = None,
        robot: str = "",
    ) -> None:
        self.tree: Final = tree
        self.robot: Final = robot
        self.transitions: Final = transitions
        self.samples: Final = {} if samples is None else samples
        self.signals: Final[Mapping[str, SampleSeries]] = {} if signals is None else signals
        self.keeping: Final[set[int]] = set()
        self.unlike: Sequence[str] = ()
        self.remarks: Final = [] if remarks is None else remarks


class NamedLog(Record):
    """A log that names the nodes that changed but not their tree, and may mix runs of several trees.

    Attributes:
        topic: where it was published; empty if the file has only one.
        robot: the namespace of that topic.
        nodes: uid and name of each node; the uid is 0 where the log has none.
        times, changed, statuses: of each status change its time, the index of its node, and its new status.
        trees: the trees that the file holds beside the changes, in their order.
        signals: samples of signals that the project file finds in the log, by signal.
        remarks: notes about the file.
    """

    topic: str
    robot: str
    nodes: Sequence[tuple[int, str]]
    times: array[int]
    changed: array[int]
    statuses: array[int]
    trees: Sequence[LoggedTree]
    signals: Mapping[str, SampleSeries]
    remarks: Sequence[str]


_LARGEST: Final = 1e200
