"""What Nav2's control nodes and decorators do with their children.

One invariant: distributions differ in ports and their defaults, which are in the models of each, and in what `Dialect`
says.  Source: facts about Nav2's nodes from Humble to Lyrical, seen in runs of them on the engine.
"""

from __future__ import annotations

from math import dist
from typing import Final

from btq_lang.simulator.errors import EngineError, NotModelled
from btq_lang.simulator.nav2_inputs import ORIGIN, Path, goals_of, has_new_goal, path_of
from btq_lang.simulator.nodes import FAILURE, IDLE, RUNNING, SKIPPED, SUCCESS, Machine, SimulatedNode
from btq_lang.simulator.ports import key_of, read, read_real, read_text, read_truth, read_unsigned, read_whole, write
from btq_lang.simulator.ticking import (
    check_rounds,
    execute_tick,
    halt_children,
    reset_child,
    reset_children,
    set_status,
)
from btq_lang.simulator.timers import after, has_passed

# ---- control nodes ----


def tick_pipeline(machine: Machine, node: SimulatedNode) -> int:
    """All children from the first at every tick, past those that run before the furthest one reached."""
    skipped = 0
    for position, child in enumerate(node.children):
        result = execute_tick(machine, child)
        if result == RUNNING and position >= node.index:
            node.index = position
            return RUNNING
        if result == FAILURE:
            reset_children(machine, node)
            node.index = 0
            return FAILURE
        skipped += result == SKIPPED
    reset_children(machine, node)
    node.index = 0
    return SKIPPED if skipped == len(node.children) else SUCCESS


def tick_recovery(machine: Machine, node: SimulatedNode) -> int:
    """The second child when the first fails, then the first again, so many times."""
    retries = read_unsigned(node, "number_of_retries", machine.dialect.is_old)
    if retries is not None:
        node.kept = (retries,)
    most: int = node.kept[0] if node.kept else 1
    if len(node.children) != 2:
        raise EngineError(f"Recovery Node '{node.name}' must only have 2 children.")
    set_status(machine, node, RUNNING)
    rounds = 0
    while node.count <= most:
        check_rounds(node, rounds := rounds + 1)
        result = execute_tick(machine, node.children[node.index])
        if result == RUNNING:
            return RUNNING
        reset_child(machine, node.children[node.index])
        if node.index == 0 and result == FAILURE and node.count < most:
            node.index = 1
        elif node.index == 1 and result == SUCCESS:
            node.index = 0
            node.count += 1
        elif node.index == 1 and result == SKIPPED:
            node.index = 0
            return FAILURE
        else:
            halt_turns(machine, node)
            return result
    halt_turns(machine, node)
    return FAILURE


def tick_round_robin(machine: Machine, node: SimulatedNode) -> int:
    """The children in turn: the next one after a success only when it begins again, after a failure at once."""
    size = len(node.children)
    wraps = read_truth(node, "wrap_around") is not False
    set_status(machine, node, RUNNING)
    skipped = 0
    while node.count + skipped < size:
        result = execute_tick(machine, node.children[node.index])
        if result == RUNNING:
            return RUNNING
        node.index += 1
        node.count += result == FAILURE
        skipped += result == SKIPPED
        if node.index == size:
            if not wraps:
                break
            node.index = 0
        if result == SUCCESS:
            node.count = 0
            reset_children(machine, node)
            return SUCCESS
    halt_turns(machine, node)
    return SKIPPED if skipped == size else FAILURE


def halt_turns(machine: Machine, node: SimulatedNode) -> None:
    """Begin with the first child again, and to count from 0."""
    node.index = 0
    node.count = 0
    halt_children(machine, node)


def tick_nonblocking(machine: Machine, node: SimulatedNode) -> int:
    """All children at every tick, until all succeed in one."""
    result = SUCCESS
    for child in node.children:
        status = execute_tick(machine, child)
        if status == FAILURE:
            reset_children(machine, node)
            return FAILURE
        if status == SKIPPED:
            raise EngineError(f"Invalid node status. Received status SKIPPEDfrom child {child.name}")
        if status == RUNNING:
            result = RUNNING
    if result == SUCCESS:
        reset_children(machine, node)
    return result


def tick_persistent(machine: Machine, node: SimulatedNode) -> int:
    """A sequence whose index is an entry."""
    index = read_whole(node, "current_child_idx")
    if index is None:
        raise EngineError(
            "Missing required input [current_child_idx] in PersistentSequenceNode. "
            'Set via <Script code="current_child_idx := 0" />'
        )
    if index < 0:
        raise NotModelled(f"the index of {node.path} is negative")
    set_status(machine, node, RUNNING)
    while index < len(node.children):
        result = execute_tick(machine, node.children[index])
        if result == RUNNING:
            return RUNNING
        if result == FAILURE:
            reset_children(machine, node)
            write(node, "current_child_idx", 0, "int")
            return FAILURE
        index += 1
        write(node, "current_child_idx", index, "int")
    reset_children(machine, node)
    write(node, "current_child_idx", 0, "int")
    return SUCCESS


def tick_pause_resume(machine: Machine, node: SimulatedNode) -> int:
    """The child of the state: resumed, paused, on its way to pause, or back."""
    size = len(node.children)
    if size not in range(1, 5):
        raise EngineError(f"PauseNode must have at least one and at most four children (currently has {size})")
    if node.status == IDLE:
        node.index = _RESUMED
    set_status(machine, node, RUNNING)
    pauses, resumes = [machine.world.serve(read_text(node, port) or "") for port in _SERVICES]
    if resumes if node.index == _PAUSED else pauses:
        reset_children(machine, node)
        node.index = _ON_RESUME if node.index == _PAUSED else _ON_PAUSE
    if node.index >= size:
        node.index = _NEXT[node.index]
        return RUNNING
    result = execute_tick(machine, node.children[node.index])
    if result in (RUNNING, FAILURE):
        return result
    if node.index == _RESUMED:
        return SUCCESS
    node.index = _NEXT[node.index]
    return RUNNING


# ---- decorators that hold their child back ----


def tick_rate_controller(machine: Machine, node: SimulatedNode) -> int:
    """The child again when a time has passed since its last success."""
    is_first = node.status == IDLE
    if is_first:
        node.kept = (_period(read_real(node, "hz")),)
        node.due = after(machine, node.kept[0])
    set_status(machine, node, RUNNING)
    result = _let_through(machine, node, is_first or has_passed(machine, node))
    if result == SUCCESS:
        node.due = after(machine, node.kept[0] if node.kept else 0.0)
    return result


def tick_distance_controller(machine: Machine, node: SimulatedNode) -> int:
    """The child again when the robot has moved some distance since its last success."""
    distance = read_real(node, "distance")
    position = machine.world.position
    is_first = node.status == IDLE
    if is_first and position is None:
        return FAILURE
    if is_first:
        node.kept = (position,)
    set_status(machine, node, RUNNING)
    if position is None:
        return FAILURE
    result = _let_through(machine, node, is_first or dist(node.kept[0] if node.kept else ORIGIN, position) >= distance)
    if result == SUCCESS:
        if machine.world.position is None:
            return FAILURE
        node.kept = (machine.world.position,)
    return result


def tick_speed_controller(machine: Machine, node: SimulatedNode) -> int:
    """The child again after a time, which is shorter the faster the robot is, and for a new goal."""
    low, high = read_real(node, "min_rate"), read_real(node, "max_rate")
    if low <= 0 or high <= 0:
        raise NotModelled(f"{node.path} has a rate that is not above 0, and the program refuses that")
    is_first = node.status == IDLE
    if is_first:
        node.kept = goals_of(node, node.kept)
    if has_new_goal(node) or is_first:
        node.due = after(machine, 1 / high)
        is_first = True
    set_status(machine, node, RUNNING)
    is_over = has_passed(machine, node)
    if is_over:
        node.due = after(machine, 1 / _rate(machine, node, low, high))
    return _let_through(machine, node, is_first or is_over)


def _rate(machine: Machine, node: SimulatedNode, low: float, high: float) -> float:
    """The rate for the speed of the robot, per second."""
    slow, fast = read_real(node, "min_speed"), read_real(node, "max_speed")
    if slow == fast:
        raise NotModelled(f"the two speeds of {node.path} are the same, and its rate is not defined")
    return max(min((machine.world.speed - slow) / (fast - slow) * (high - low) + low, high), low)


def tick_goal_updated_controller(machine: Machine, node: SimulatedNode) -> int:
    """The child again for a new goal."""
    is_first = node.status == IDLE
    if is_first:
        node.kept = goals_of(node, node.kept)
    set_status(machine, node, RUNNING)
    return _let_through(machine, node, has_new_goal(node) or is_first)


def _let_through(machine: Machine, node: SimulatedNode, is_let: bool) -> int:
    """Tick the child if it is let through or runs; its result, or RUNNING."""
    return execute_tick(machine, node.child) if is_let or node.child.status == RUNNING else RUNNING


def _period(rate: float) -> float:
    """The period of a rate."""
    return 1 / rate if rate else float("inf")


# ---- other decorators ----


def tick_goal_updater(machine: Machine, node: SimulatedNode) -> int:
    """The child, with goals that a topic may have; here it has none."""
    pass_goals(node)
    return execute_tick(machine, node.child)


def pass_goals(node: SimulatedNode) -> None:
    """Write the goals that a GoalUpdater reads to its outputs; where it reads none, a pose that nothing has set."""
    for port in UPDATED:
        key = key_of(node.ports.get(port, ""), port)
        if key is None:
            continue
        value = read(node, port.replace("output", "input"))
        node.board.write(key, 0.0 if value is None else value, node.board.create(key).type)


def tick_path_longer(machine: Machine, node: SimulatedNode) -> int:
    """The child if the path has become much longer close to the goal."""
    before: Path
    last: Path
    last, before = node.kept or ((), ())
    path = path_of(node, last)
    is_iron = machine.dialect.nav2 == "iron"
    nearness, factor = read_real(node, "prox_len"), read_real(node, "length_factor")
    has_same_end = bool(path and before) and path[2:] == before[2:]
    if node.status == IDLE if is_iron else not has_same_end:
        node.is_on = False
    set_status(machine, node, RUNNING)
    is_other = has_same_end and (path != before if is_iron else path[0] != before[0])
    is_longer = node.is_on and is_other and before[1] < nearness and path[1] > factor * before[1]
    if not is_longer:
        node.kept = (path, path)
        node.is_on = True  # it has seen a path to this goal
        return SUCCESS
    node.kept = (path, before)
    result = execute_tick(machine, node.child)
    if result in (SUCCESS, FAILURE):
        node.kept = (path, path)
        if not is_iron:  # there the engine does, once the node has ended
            reset_child(machine, node.child)
    return result


def tick_single_trigger(machine: Machine, node: SimulatedNode) -> int:
    """The child until it has ended once; then FAILURE."""
    if node.status == IDLE:
        node.is_on = False
    set_status(machine, node, RUNNING)
    if node.is_on:
        return FAILURE
    result = execute_tick(machine, node.child)
    node.is_on = result in (SUCCESS, FAILURE)
    return result


UPDATED: Final = ("output_goal", "output_goals")  # by a GoalUpdater
# The states of a PauseResumeController are the positions of their children.
_RESUMED: Final = 0
_PAUSED: Final = 1
_ON_PAUSE: Final = 2
_ON_RESUME: Final = 3
_NEXT: Final = {_RESUMED: _RESUMED, _PAUSED: _PAUSED, _ON_PAUSE: _PAUSED, _ON_RESUME: _RESUMED}
_SERVICES: Final = ("pause_service_name", "resume_service_name")
