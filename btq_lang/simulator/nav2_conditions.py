"""The answers of Nav2's conditions that notice changes, time and distance.

What a node compares with before it has begun is what its class sets, or 0 where it sets nothing, as in those runs.
Source: facts about Nav2's nodes from Humble to Lyrical, seen in runs of them on the engine.
"""

from __future__ import annotations

from math import dist

from btq_lang.simulator.errors import EngineError
from btq_lang.simulator.nav2_inputs import ORIGIN, goals_of, has_new_goal, path_of, read_or_entry
from btq_lang.simulator.nodes import FAILURE, IDLE, SUCCESS, Machine, SimulatedNode
from btq_lang.simulator.ports import read_real, read_text, read_whole
from btq_lang.simulator.timers import after, has_passed


def tick_goal_updated(machine: Machine, node: SimulatedNode) -> int:
    """SUCCESS if there is another goal than when it was asked last; FAILURE when it begins."""
    if node.status == IDLE:
        node.kept = goals_of(node, node.kept)
        return FAILURE
    return SUCCESS if has_new_goal(node) else FAILURE


def tick_global_updated_goal(machine: Machine, node: SimulatedNode) -> int:
    """SUCCESS if there is another goal than when it was asked last, and when it is asked for the first time."""
    if not node.is_on:
        node.is_on = True
        node.kept = goals_of(node)
        return SUCCESS
    return SUCCESS if has_new_goal(node) else FAILURE


def tick_time_expired(machine: Machine, node: SimulatedNode) -> int:
    """SUCCESS when a time has passed since the last success; FAILURE when it begins."""
    begins = node.status == IDLE
    if begins:
        node.kept = (read_real(node, "seconds"),)
    elif not has_passed(machine, node):
        return FAILURE
    (seconds,) = node.kept or (1.0,)
    node.due = after(machine, seconds)
    return FAILURE if begins else SUCCESS


def tick_path_expiring_timer(machine: Machine, node: SimulatedNode) -> int:
    """SUCCESS when a time has passed since the path changed, or since the last success."""
    if not node.is_on:
        node.is_on = True
        node.kept = (read_real(node, "seconds"), path_of(node))
        node.due = after(machine, node.kept[0])
        return FAILURE
    seconds, before = node.kept
    path = path_of(node)
    if path != before:
        node.kept = (seconds, path)
        node.due = after(machine, seconds)
    if not has_passed(machine, node):
        return FAILURE
    node.due = after(machine, seconds)
    return SUCCESS


def tick_distance_traveled(machine: Machine, node: SimulatedNode) -> int:
    """SUCCESS when the robot has moved some distance since the last success; FAILURE when it begins."""
    start, distance = node.kept or (ORIGIN, 1.0)
    position = machine.world.position
    if node.status == IDLE:
        node.kept = (position or start, read_real(node, "distance"))
        return FAILURE
    if position is None or dist(start, position) < distance:
        return FAILURE
    node.kept = (position, distance)
    return SUCCESS


def tick_initial_pose_received(machine: Machine, node: SimulatedNode) -> int:
    """SUCCESS if the entry is true."""
    value = read_or_entry(node, "initial_pose_received")
    if value is None and machine.dialect.is_old:
        raise EngineError("Blackboard::get() error. Missing key [initial_pose_received]")
    return SUCCESS if value else FAILURE


def tick_error_codes(machine: Machine, node: SimulatedNode) -> int:
    """SUCCESS if the error code is one of a list, which Iron cannot read."""
    if machine.dialect.nav2 == "iron":
        return FAILURE
    code = read_whole(node, "error_code")
    if code is not None:
        node.kept = (code,)
    (code,) = node.kept or (0,)
    codes = (read_text(node, "error_codes_to_check") or "").split(";")
    return SUCCESS if str(code) in codes else FAILURE
