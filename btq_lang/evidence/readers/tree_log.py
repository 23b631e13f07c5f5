"""What Nav2 publishes about its behavior trees, `nav2_msgs/BehaviorTreeLog`, from a bag.

One invariant: status changes are in the order of their own stamps, which are wall-clock time even in simulation: a
message may contain the last changes of a goal together with the first of the next, or of another navigator's.

A message identifies the changed node by name, and since ROS 2 Jazzy by uid, but does not identify the tree.
"""

from __future__ import annotations

from array import array
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any, Final

from btq_lang.evidence.model import FAILURE, IDLE, RUNNING, SKIPPED, SUCCESS, LoggedTree, NamedLog, SampleSeries
from btq_lang.evidence.readers.bag import TEXT, TREE_LOG, opened
from btq_lang.evidence.readers.topics import Clock, Topics
from btq_lang.evidence.readers.tree import NotALog, read_tree

if TYPE_CHECKING:
    from btq_lang.workspace.project_evidence import SignalSource


def read(path: str, sources: Iterable[SignalSource] = ()) -> Iterator[NamedLog]:
    """The logs in a bag, one for each topic that behavior trees are logged on, with samples from the topics of sources.

    Raises:
        NotALog: it is not a bag, or nothing of it can be used.
        OSError: it cannot be read.
    """
    with opened(path) as bag:
        logs = {connection.topic: _Changes() for connection in bag.of_type(TREE_LOG)}
        if not logs:
            raise NotALog(f"expected a topic of type {TREE_LOG}, such as /behavior_tree_log; the bag has none")
        topics = Topics(sources, [connection.topic for connection in bag.connections], map(_namespace, logs))
        trees_by_robot: dict[str, dict[str, LoggedTree]] = {}
        malformed = 0
        connections = [*bag.of_type(TREE_LOG), *bag.of_type(TEXT)]
        connections += [
            connection
            for connection in bag.connections
            if connection.topic in topics.names and connection not in connections
        ]
        for topic, received, message in bag.messages(connections):
            if topic in logs:
                malformed += logs[topic].add(received, message)
                continue
            if topic in topics.names:
                topics.add(topic, received, message)
            if wrong := _add_tree(message, trees_by_robot.setdefault(_namespace(topic), {})):
                bag.remarks.append(f"{topic}: {wrong}")
        remarks = bag.remarks
        if malformed:
            remarks.append(f"status changes that are not as Nav2 defines them, left out: {malformed}")
    every = [tree for of_robot in trees_by_robot.values() for tree in of_robot.values()]
    for topic, changes in logs.items():
        own = trees_by_robot.get(_namespace(topic))
        signals = topics.series(_namespace(topic), changes.clock())
        named = [*own.values()] if own else every
        yield changes.log(topic, len(logs) > 1, named, signals, [*remarks, *topics.remarks])
        topics.remarks.clear()


def trees(path: str) -> list[LoggedTree]:
    """The trees on the topics of a bag.

    Raises:
        NotALog: it is not a bag.
        OSError: it cannot be read.
    """
    trees_by_text: dict[str, LoggedTree] = {}
    with opened(path) as bag:
        for _, _, message in bag.messages(bag.of_type(TEXT)):
            _add_tree(message, trees_by_text)
    return [*trees_by_text.values()]


def _add_tree(message: Any, trees_by_text: dict[str, LoggedTree]) -> str:
    """Add the tree in a message, if it has a new one; returns what is wrong with it."""
    text = getattr(message, "data", "")
    if isinstance(text, str) and "_uid" in text and text not in trees_by_text:
        try:
            trees_by_text[text] = read_tree(text)
        except NotALog as error:
            return str(error)
    return ""


def samples(path: str, sources: Iterable[SignalSource]) -> tuple[dict[str, SampleSeries], list[str]] | None:
    """The samples in a bag without a log of a tree, and notes about them; None if it has one.

    Raises:
        NotALog: it is not a bag, or a topic does not match its source.
        OSError: it cannot be read.
    """
    with opened(path) as bag:
        topics = Topics(sources, [connection.topic for connection in bag.connections], ())
        if bag.of_type(TREE_LOG) or not topics.names:
            return None
        for message in bag.messages([connection for connection in bag.connections if connection.topic in topics.names]):
            topics.add(*message)
        series = topics.series("", Clock(array("q"), array("q")))
        return series, [*bag.remarks, *topics.remarks]


def clocks(path: str) -> dict[str, Clock]:
    """The clock of each log in a bag, by topic.

    Raises:
        NotALog: it is not a bag.
        OSError: it cannot be read.
    """
    with opened(path) as bag:
        logs = {connection.topic: _Changes() for connection in bag.of_type(TREE_LOG)}
        for topic, received, message in bag.messages(bag.of_type(TREE_LOG)):
            logs[topic].add(received, message)
    return {topic: changes.clock() for topic, changes in logs.items()}


def _namespace(topic: str) -> str:
    return topic.rpartition("/")[0]


class _Changes:
    """Status changes on a topic."""

    def __init__(self) -> None:
        self._times: Final = array("q")  # ns
        self._nodes: Final = array("I")
        self._statuses: Final = array("B")
        self._index: Final[dict[tuple[int, str], int]] = {}
        self._received: Final = array("q")  # µs, of each message
        self._newest: Final = array("q")

    def add(self, received: int, message: Any) -> int:
        """Add the changes in a message; returns how many have an unknown status."""
        index, times, nodes, statuses = self._index, self._times, self._nodes, self._statuses
        changes = getattr(message, "event_log", None)
        if not isinstance(changes, list):
            return 1
        malformed = 0
        for change in changes:
            try:
                status = _STATUSES[change.current_status]
                node = int(getattr(change, "uid", 0)), str(change.node_name)
                times.append(change.timestamp.sec * 1_000_000_000 + change.timestamp.nanosec)
            except (AttributeError, KeyError, TypeError, ValueError, OverflowError):  # a bag may define its own type
                malformed += 1
                continue
            nodes.append(index.setdefault(node, len(index)))
            statuses.append(status)
        if times:
            self._received.append(received // 1000)
            self._newest.append(times[-1] // 1000)
        return malformed

    def clock(self) -> Clock:
        """The clock on which the changes are stamped."""
        return Clock(self._received, self._newest)

    def log(
        self,
        topic: str,
        is_one_of_several: bool,
        trees: list[LoggedTree],
        signals: dict[str, SampleSeries],
        remarks: list[str],
    ) -> NamedLog:
        """The log of the added changes, in order."""
        import numpy  # `rosbags` needs it too

        order = numpy.argsort(numpy.frombuffer(self._times, numpy.int64), kind="stable")
        times = numpy.frombuffer(self._times, numpy.int64)[order] // 1000
        nodes = numpy.frombuffer(self._nodes, numpy.uint32)[order]
        statuses = numpy.frombuffer(self._statuses, numpy.uint8)[order]
        return NamedLog(
            topic=topic if is_one_of_several else "",
            robot=_namespace(topic).strip("/"),
            nodes=[*self._index],
            times=array("q", times.tobytes()),
            changed=array("I", nodes.tobytes()),
            statuses=array("B", statuses.tobytes()),
            trees=trees,
            signals=signals,
            remarks=remarks,
        )


_STATUSES: Final = {"IDLE": IDLE, "RUNNING": RUNNING, "SUCCESS": SUCCESS, "FAILURE": FAILURE, "SKIPPED": SKIPPED}
