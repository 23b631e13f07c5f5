"""What Nav2 publishes about its behavior trees, `nav2_msgs/BehaviorTreeLog`, from a bag.

One invariant: status changes come out in the order of their own stamps, which are wall clock also in simulation: a
message may bring the last changes of a goal together with the first of the next one, or of another navigator's.

A message says which node changed by its name, and since ROS 2 Jazzy by its uid; which tree it is of, it does not say.
"""

from __future__ import annotations

from array import array

from btq_lang.evidence.model import FAILURE, IDLE, RUNNING, SKIPPED, SUCCESS, LoggedTree, NamedLog
from btq_lang.evidence.readers.bag import TEXT, TREE_LOG, opened
from btq_lang.evidence.readers.tree import NotALog, read_tree

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from collections.abc import Iterator
    from typing import Any, Final


def read(path: str) -> Iterator[NamedLog]:
    """The logs in a bag, one for each topic that behavior trees are logged on.

    Args:
        path: of a folder or a file.

    Raises:
        NotALog: it is not a bag, or nothing of it can be used.
        OSError: it cannot be read.
    """
    with opened(path) as bag:
        logs = {each.topic: _Changes() for each in bag.of_type(TREE_LOG)}
        if not logs:
            raise NotALog(f"expected a topic of type {TREE_LOG}, such as /behavior_tree_log; the bag has none")
        trees: dict[str, dict[str, LoggedTree]] = {}
        malformed = 0
        for topic, _, message in bag.messages([*bag.of_type(TREE_LOG), *bag.of_type(TEXT)]):
            if topic in logs:
                malformed += logs[topic].add(message)
            elif "_uid" in message.data and message.data not in (found := trees.setdefault(_namespace(topic), {})):
                try:
                    found[message.data] = read_tree(message.data)
                except NotALog as error:
                    bag.remarks.append(f"{topic}: {error}")
        remarks = bag.remarks
        if malformed:
            remarks.append(f"status changes with an unknown status, left out: {malformed}")
    every = [tree for found in trees.values() for tree in found.values()]
    for topic, changes in logs.items():
        own = trees.get(_namespace(topic))
        yield changes.log(topic if len(logs) > 1 else "", [*own.values()] if own else every, remarks)


def _namespace(topic: str) -> str:
    return topic.rpartition("/")[0]


class _Changes:
    """Status changes on a topic."""

    def __init__(self) -> None:
        self._times: Final = array("q")  # ns
        self._nodes: Final = array("I")
        self._statuses: Final = array("B")
        self._index: Final[dict[tuple[int, str], int]] = {}

    def add(self, message: Any) -> int:
        """Add the changes in a message; how many of them have no known status."""
        index, times, nodes, statuses = self._index, self._times, self._nodes, self._statuses
        malformed = 0
        for change in message.event_log:
            status = _STATUSES.get(change.current_status)
            if status is None:
                malformed += 1
                continue
            node = getattr(change, "uid", 0), change.node_name
            stamp = change.timestamp
            times.append(stamp.sec * 1_000_000_000 + stamp.nanosec)
            nodes.append(index.setdefault(node, len(index)))
            statuses.append(status)
        return malformed

    def log(self, topic: str, trees: list[LoggedTree], remarks: list[str]) -> NamedLog:
        """What was added, in order."""
        import numpy  # `rosbags` needs it too

        order = numpy.argsort(numpy.frombuffer(self._times, numpy.int64), kind="stable")
        times = numpy.frombuffer(self._times, numpy.int64)[order] // 1000
        nodes = numpy.frombuffer(self._nodes, numpy.uint32)[order]
        statuses = numpy.frombuffer(self._statuses, numpy.uint8)[order]
        return NamedLog(
            topic=topic,
            nodes=[*self._index],
            times=array("q", times.tobytes()),
            changed=array("I", nodes.tobytes()),
            statuses=array("B", statuses.tobytes()),
            trees=trees,
            remarks=remarks,
        )


_STATUSES: Final = {"IDLE": IDLE, "RUNNING": RUNNING, "SUCCESS": SUCCESS, "FAILURE": FAILURE, "SKIPPED": SKIPPED}
