"""Follows a publisher from one request to the next: transitions, gaps between them, samples, and other trees.

One invariant: where transitions may have been lost, there is a GAP among those that came.  They are lost if the
publisher's buffer was full, if a reply did not come, or if another program took some; the latter shows in a status that
does not follow from the transitions.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from typing import Final, TypeAlias

from btq_lang.btcpp.reader import read as read_xml
from btq_lang.evidence.model import GAP, IDLE, PAUSE, RUNNING, LoggedTree, SampleValue, Transition
from btq_lang.evidence.readers.groot2 import messages
from btq_lang.evidence.readers.groot2.messages import BadReply, Reply
from btq_lang.evidence.readers.groot2.publisher import NoAnswer, NotAPublisher
from btq_lang.evidence.readers.tree import NotALog, read_tree
from btq_lang.util.record import Record


class Began(Record):
    """A publisher that was not known before; `is_amid`: a run is open."""

    tree: LoggedTree
    is_amid: bool


class Came(Record):
    """Transitions, with times in µs since the epoch."""

    transitions: Sequence[Transition]


class Sampled(Record):
    """The values of entries that have changed; None: the entry is gone."""

    time: int
    values: Mapping[str, SampleValue | None]


class LostTransitions(Record):
    """Why transitions may have been lost, before those that come next."""

    time: int
    why: str


class Notice(Record):
    """What happened to the connection."""

    text: str


class Passed(Record):
    """All that the robot did up to this time, on its clock, has been reported."""

    time: int


Event: TypeAlias = Began | Came | Sampled | LostTransitions | Notice | Passed


class Following:
    """A publisher, by its replies so far.

    Attributes:
        pause: how long to wait before the next step, in seconds.
        passed: until when all that the robot did is known, on its clock; None: without a publisher.
        refused: why the first that answered is not a publisher; empty if it is one, or none has answered.
    """

    def __init__(
        self, ask: Callable[..., Reply], clock: Callable[[], int], entries: Collection[str], address: str
    ) -> None:
        """
        Args:
            ask: as `Publisher.ask`.
            clock: the time in µs, on a clock that is never set.
            entries: those of the blackboard that are wanted.
        """
        self.pause = _PAUSE
        self.passed: int | None = None
        self.refused = ""
        self._ask: Final = ask
        self._clock: Final = clock
        self._entries: Final = frozenset(entries)
        self._address: Final = address
        self._publisher = b""  # its ID
        self._is_there = False
        self._tree: LoggedTree
        self._boards: Sequence[str] = ()  # none if they cannot be read
        self._started = 0  # when the recording began, on the robot's clock
        self._ahead = 0  # how far that is ahead of ours
        self._at_least = 0  # likewise, at least
        self._asked = 0  # when transitions were last asked for
        self._statuses: dict[int, int] = {}  # of the nodes where it is known
        self._at_rest: dict[int, int] | None = None  # all statuses, after the last transitions
        self._is_halting = False
        self._values: dict[str, SampleValue | None] = {}
        self._last_notice = ""

    def step(self) -> Iterator[Event]:
        """Ask once for all that is new."""
        try:
            if not self._is_there:
                yield from self._connect()
            else:
                yield from self._poll()
        except NotAPublisher:
            raise
        except (NoAnswer, BadReply, NotALog) as error:
            self.pause = _PAUSE_WITHOUT
            yield from self._gone(str(error))

    def _gone(self, why: str) -> Iterator[Event]:
        self.passed = None
        text = why or ("the publisher does not answer any more" if self._publisher else "no publisher yet")
        self._is_there = False
        if text != self._last_notice:
            self._last_notice = text
            yield Notice(f"{text}; waiting for one at {self._address}")

    def _connect(self) -> Iterator[Event]:
        """Take the tree of a publisher, and make it record from now on."""
        try:
            answer = self._ask(messages.TREE)
            text = answer.content.decode("utf-8", "replace")
            tree = read_tree(text)
        except (BadReply, NotALog) as error:
            self.refused = "" if self._publisher else str(error)
            raise
        before = self._all_statuses(tree)
        self._record()
        after = self._all_statuses(tree)
        is_amid = before != after or RUNNING in after.values()
        is_same = answer.publisher == self._publisher
        self._publisher, self._tree, self._is_there, self._last_notice = answer.publisher, tree, True, ""
        self._boards = [*_boards(text)]
        self._values = {}
        self.pause, self.passed = _PAUSE, None
        if is_same:
            yield from self._lost("the publisher had not answered for a while")
        else:
            yield Began(tree, is_amid)
            if is_amid:
                yield Came([(self._started, GAP, IDLE)])
        self._statuses = {} if is_amid else after

    def _record(self) -> None:
        """Begin a recording, which drops the publisher's buffer."""
        asked = self._clock()
        self._started = messages.start_of(self._ask(messages.RECORDING, "start").content)
        self._ahead = self._started - (asked + self._clock()) // 2
        self._at_least = self._started - self._clock()
        self._asked = asked
        self._statuses, self._at_rest = {}, None

    def _poll(self) -> Iterator[Event]:
        asked = self._clock()
        answer = self._ask(messages.TRANSITIONS)
        if answer.publisher != self._publisher:
            yield from self._connect()
            return
        rows = [(self._started + time, uid, status) for time, uid, status in messages.transitions(answer.content)]
        since, self._asked = self._asked, asked
        yield from self._new(rows, since) if rows else self._quiet(since)
        self._pass(asked)
        if self._entries and self._boards:
            yield from self._samples()
        self.pause = 0.0 if len(rows) >= messages.MOST_KEPT // 4 else _PAUSE

    def _pass(self, asked: int) -> None:
        """Move `passed` to when transitions were asked for, unless another program may have taken some since."""
        active = [uid for uid, status in self._statuses.items() if status == RUNNING]
        now = self._at_rest or (self._all_statuses(self._tree) if active else {})
        if all(now.get(uid) == RUNNING for uid in active):
            self.passed = asked + self._at_least

    def _new(self, rows: Sequence[Transition], since: int) -> Iterator[Event]:
        """Take transitions, which came after they were last asked for, at `since`, and before now."""
        now = self._clock()
        earliest, latest = since + self._ahead - _TOLERANCE, now + self._ahead + _TOLERANCE
        if not all(earliest <= time <= latest for time, _, _ in rows):
            why = "another program has restarted the recording, or the robot's clock was set"
            yield from self._begin_again(why, since)
            return
        self._ahead = max(min(self._ahead, rows[0][0] - since), rows[-1][0] - now)
        self._at_least = max(min(self._at_least, rows[0][0] - since), rows[-1][0] - now)
        if len(rows) >= messages.MOST_KEPT:
            yield from self._lost("more transitions than the publisher keeps came between two requests", rows[0][0])
        elif not self._follow(rows):
            yield from self._lost("another program took some", rows[0][0])
        self._statuses.update((uid, status) for _, uid, status in rows)
        self._at_rest = None
        self._is_halting = rows[-1][2] == IDLE
        yield Came(rows)

    def _follow(self, rows: Sequence[Transition]) -> bool:
        """Whether each transition changes the status that its node is known to have."""
        statuses = dict(self._statuses)
        for _, uid, status in rows:
            if statuses.get(uid) == status:
                return False
            statuses[uid] = status
        return True

    def _quiet(self, since: int) -> Iterator[Event]:
        """Nothing has changed since the last request, so all statuses must be those that were there then."""
        if self._at_rest is not None and not self._statuses.items() <= self._at_rest.items():
            yield from self._begin_again("another program took some", since)
            return
        if self._at_rest is not None:
            self._statuses = self._at_rest
        self._at_rest = self._all_statuses(self._tree)
        if self._is_halting:
            self._is_halting = False
            yield Came([(since + self._ahead, PAUSE, IDLE)])

    def _begin_again(self, why: str, since: int) -> Iterator[Event]:
        time = since + self._ahead
        self._record()
        yield from self._lost(why, time)

    def _lost(self, why: str, time: int | None = None) -> Iterator[Event]:
        time = self._started if time is None else time
        self._statuses = {}
        yield LostTransitions(time, why)
        yield Came([(time, GAP, IDLE)])

    def _samples(self) -> Iterator[Event]:
        asked = self._clock()
        entries: Mapping[str, SampleValue] = {}
        try:
            content = self._ask(messages.BLACKBOARD, ";".join(self._boards)).content
            entries = messages.blackboard(content, self._boards)
        except BadReply as error:  # the verdicts that need no samples do not suffer
            self._boards = ()
            yield Notice(f"{error}; signals have no samples from now on")
        values: dict[str, SampleValue | None] = {key: entries.get(key) for key in self._entries if key in entries}
        values |= {key: None for key, value in self._values.items() if value is not None and key not in entries}
        changed = {key: value for key, value in values.items() if not _is_same(value, self._values.get(key))}
        if changed:
            self._values |= changed
            yield Sampled((asked + self._clock()) // 2 + self._ahead, changed)

    def _all_statuses(self, tree: LoggedTree) -> dict[int, int]:
        return messages.statuses(self._ask(messages.STATUS).content, len(tree.nodes))


def _boards(xml: str) -> Iterator[str]:
    """The names of a tree's blackboards: the main tree's ID, and the paths of its subtrees."""
    document = read_xml(xml).document
    for tree in document.root.elements if document is not None else ():
        if tree.tag == "BehaviorTree":
            yield tree.get("_fullpath") or tree.get("ID") or ""


def _is_same(value: SampleValue | None, before: SampleValue | None) -> bool:
    return type(value) is type(before) and value == before


_PAUSE: Final = 0.05  # s
_PAUSE_WITHOUT: Final = 0.5  # s, without a publisher
_TOLERANCE: Final = 1_000_000  # µs by which a robot's clock may seem to deviate
