"""The goals and paths that Nav2's nodes read, and how they notice another one.

A goal is what its entry holds.  A path is a text, `poses;length;end;yaw`: how many poses it has, how long it is, where
it ends, and in which direction.
"""

from __future__ import annotations

from typing import Any, Final, TypeAlias

from btq_lang.simulator.blackboard import Unknown, Value
from btq_lang.simulator.errors import NotModelled
from btq_lang.simulator.nodes import SimulatedNode
from btq_lang.simulator.ports import key_of, read

Path: TypeAlias = tuple[float, ...]  # empty if it has no pose; else poses, length, end, yaw


def read_or_entry(node: SimulatedNode, port: str) -> Value | None:
    """The value of an entry: that of a port, or without one that of the port's name; None: there is none.

    Raises:
        NotModelled: the port is a literal.
    """
    value = _read_entry(node, port)
    if value is not None:
        return value
    entry = node.board.entry(port)
    return entry.value if entry is not None else None


def _read_entry(node: SimulatedNode, port: str) -> Value | None:
    """The value of the entry at a port; None: there is none."""
    written = node.ports.get(port)
    if written is not None and key_of(written, port) is None:
        raise NotModelled(f"the port {port} of {node.path} is a literal")
    return read(node, port)


def goals_of(node: SimulatedNode, before: tuple[Any, ...] = ()) -> tuple[Any, ...]:
    """The goals and the goal that a node sees; `before`: those that it keeps where there is no entry."""
    seen = [_goal_at(node, port) for port in ("goals", "goal")]
    return tuple([old if new is None else new for new, old in zip(seen, before or _NO_GOALS, strict=True)])


def _goal_at(node: SimulatedNode, port: str) -> object:
    """The goals or the goal at a port; if they are unknown, with the number of times that the entry was written."""
    value = read_or_entry(node, port)
    if not isinstance(value, Unknown):
        return value
    entry = node.board.entry(key_of(node.ports.get(port, ""), port) or port)
    return value, entry.number if entry is not None else 0


def has_new_goal(node: SimulatedNode) -> bool:
    """Whether a node sees other goals than those that it keeps; from now on it keeps these.

    Raises:
        NotModelled: they were written again, and are unknown.
    """
    goals = goals_of(node)
    before, node.kept = node.kept or _NO_GOALS, goals
    for pair in zip(before, goals, strict=True):
        unknown = [goal[0] for goal in pair if isinstance(goal, tuple)]
        if unknown and pair[0] != pair[1]:
            raise unknown[-1].needed("compared with another one")
    return before != goals


def path_of(node: SimulatedNode, before: Path = ()) -> Path:
    """The path that a node sees; `before`: what it sees where there is no entry.

    Raises:
        NotModelled: the entry holds no path.
    """
    value = _read_entry(node, "path")
    if value is None:
        return before
    try:
        poses, length, end, yaw = map(float, str(value).split(";"))
    except ValueError:
        raise NotModelled(f"the path of {node.path} is not written `poses;length;end;yaw`") from None
    if poses == 0:
        return ()
    return poses, length if poses > 1 else 0.0, end, yaw


ORIGIN: Final = (0.0, 0.0)  # where a node began to measure that never learned where the robot is
_NO_GOALS: Final = (None, 0.0)  # a pose that nothing has set is the origin
