"""ROS 2 bags made by hand: what a robot with Nav2 would have recorded."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

from evidence_logs import START, Row
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

Message = tuple[str, int, Any]  # topic, time of reception in ns, message
STATUSES = ("IDLE", "RUNNING", "SUCCESS", "FAILURE")
LOG = "/behavior_tree_log"
TREE_LOG = "nav2_msgs/msg/BehaviorTreeLog"

STORE = get_typestore(Stores.ROS2_JAZZY)
STORE.register(
    get_types_from_msg(
        "builtin_interfaces/Time timestamp\nstring node_name\nuint16 uid\nstring previous_status\n"
        "string current_status\n",
        "nav2_msgs/msg/BehaviorTreeStatusChange",
    )
)
STORE.register(
    get_types_from_msg("builtin_interfaces/Time timestamp\nBehaviorTreeStatusChange[] event_log\n", TREE_LOG)
)
HUMBLE = get_typestore(Stores.ROS2_HUMBLE)  # before changes of status had a uid
HUMBLE.register(
    get_types_from_msg(
        "builtin_interfaces/Time timestamp\nstring node_name\nstring previous_status\nstring current_status\n",
        "nav2_msgs/msg/BehaviorTreeStatusChange",
    )
)
HUMBLE.register(
    get_types_from_msg("builtin_interfaces/Time timestamp\nBehaviorTreeStatusChange[] event_log\n", TREE_LOG)
)


def write_bag(
    path: Path,
    messages: Iterable[Message],
    storage: Literal["mcap", "sqlite3"] = "mcap",
    compression: Literal["none", "file", "message", "storage"] = "none",
    store: Any = STORE,
) -> None:
    """A folder with a bag.

    Args:
        messages: written in the order of their reception.
        store: the types.
    """
    with _writer(path, storage, compression) as bag:
        connections: dict[str, Any] = {}
        for topic, received, message in sorted(messages, key=lambda each: each[1]):
            name = message.__msgtype__
            if topic not in connections:
                connections[topic] = bag.add_connection(topic, name, typestore=store)
            bag.write(connections[topic], received, store.serialize_cdr(message, name))


def _writer(path: Path, storage: str, compression: str) -> Writer:
    bag = Writer(path, version=9, storage_plugin=StoragePlugin[storage.upper()])
    bag.set_compression(CompressionMode[compression.upper()], CompressionFormat.ZSTD)
    return bag


def tree_log(
    transitions: Sequence[Row], names: Mapping[int, str], start: int = START, topic: str = LOG, store: Any = STORE
) -> list[Message]:
    """What Nav2 publishes: a message for each loop of 10 ms in which something changed.

    Args:
        transitions: µs since `start`, uid, status.
        start: µs since the epoch.
    """
    change = store.types["nav2_msgs/msg/BehaviorTreeStatusChange"]
    has_uid = "uid" in change.__dataclass_fields__
    last: dict[int, int] = {}
    loops: dict[int, list[Any]] = {}
    for time, uid, status in transitions:
        loops.setdefault((start + time) // 10_000, []).append(
            change(
                timestamp=stamp(store, start + time),
                node_name=names[uid],
                previous_status=STATUSES[last.get(uid, 0)],
                current_status=STATUSES[status],
                **({"uid": uid} if has_uid else {}),
            )
        )
        last[uid] = status
    log = store.types[TREE_LOG]
    return [
        (topic, (loop + 1) * 10_000_000, log(timestamp=stamp(store, (loop + 1) * 10_000), event_log=changes))
        for loop, changes in loops.items()
    ]


def text(topic: str, time: int, data: str) -> Message:
    """A `std_msgs/String`; time: µs since the epoch."""
    return topic, time * 1000, STORE.types["std_msgs/msg/String"](data=data)


def stamp(store: Any, time: int) -> Any:
    """A `builtin_interfaces/Time` of µs since the epoch."""
    seconds, rest = divmod(time, 1_000_000)
    return store.types["builtin_interfaces/msg/Time"](sec=seconds, nanosec=rest * 1000)


def names_of(xml: str) -> dict[int, str]:
    """The names of the nodes of a logged tree, by uid."""
    found = {}
    for tag, attributes in re.findall(r"<(\w+)([^>]*)>", xml):
        given = dict(re.findall(r'(\w+)="([^"]*)"', attributes))
        if "_uid" in given:
            own = given.get("_fullpath", "").rpartition("/")[2].partition("::")[0]
            found[int(given["_uid"])] = given.get("name") or own or given.get("ID") or tag
    return found


def late_ends(messages: Sequence[Message], root: int = 1) -> list[Message]:
    """The same as Nav2 of ROS 2 Jazzy writes it: the tick that ends a tree, and what follows, comes with the next
    goal's first message; of the last goal, never."""
    found: list[Message] = []
    kept: list[Any] = []
    for topic, received, message in messages:
        changes = message.event_log
        ends = any(each.uid == root and each.current_status in ("SUCCESS", "FAILURE") for each in changes)
        if ends or (kept and all(each.current_status == "IDLE" for each in changes)):
            kept += changes
        else:
            found.append((topic, received, STORE.types[TREE_LOG](message.timestamp, [*kept, *changes])))
            kept = []
    return found


def number(topic: str, time: int, value: float, received: int | None = None) -> Message:
    """A `std_msgs/Float64`, which has no header; times: µs since the epoch."""
    return topic, (time if received is None else received) * 1000, STORE.types["std_msgs/msg/Float64"](data=value)


def stamped(topic: str, time: int, value: float, received: int | None = None) -> Message:
    """A `geometry_msgs/PointStamped` with a value as x; times: µs since the epoch."""
    header = STORE.types["std_msgs/msg/Header"](stamp=stamp(STORE, time), frame_id="")
    point = STORE.types["geometry_msgs/msg/Point"](x=value, y=0.0, z=0.0)
    message = STORE.types["geometry_msgs/msg/PointStamped"](header=header, point=point)
    return topic, (time if received is None else received) * 1000, message
