"""Nodes of Nav2 whose answers are given: what they notice of goals, of the path, of the time, and of the robot.

One invariant: they do with an answer what they do with what they find themselves, as one that fails when it begins
whatever it would notice.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Final, Protocol

from btq_lang.simulator import nav2, nav2_conditions
from btq_lang.simulator.nodes import FAILURE, IDLE, RUNNING, SUCCESS, Flow, Machine, SimulatedNode
from btq_lang.simulator.ticking import execute_tick, reset_child, set_status
from btq_lang.util.record import replace


class Answers(Protocol):
    """Who gives answers."""

    def has_answer(self, node: SimulatedNode) -> bool:
        """Whether something says what a node answers."""

    def answer(self, node: SimulatedNode) -> bool:
        """What it answers now."""

    def update(self, node: SimulatedNode) -> None:
        """Write the goals that it has received, if they are newer than those that it passes on."""


def set_answered(node: SimulatedNode, answers: Answers) -> None:
    """Have a node do what is said, if it is one of Nav2 that reads the time or the world.

    Where nothing is said, it does what it finds in entries and by the time, but for those that read the robot or a
    topic: of these something must be said.
    """
    own = node.rules.flow
    make = _ANSWERED.get(own)
    if make is not None:
        flow = make(answers)
        node.rules = replace(node.rules, flow=flow if own in _READS_THE_WORLD else _if_said(answers, flow, own))


def _if_said(answers: Answers, flow: Flow, own: Flow) -> Flow:
    """A flow where something is said, and otherwise the node's own."""

    def tick(machine: Machine, node: SimulatedNode) -> int:
        return flow(machine, node) if answers.has_answer(node) else own(machine, node)

    return tick


def _noticing(answers: Answers) -> Flow:
    """A condition that fails when it begins."""

    def tick(_: Machine, node: SimulatedNode) -> int:
        return SUCCESS if node.status != IDLE and answers.answer(node) else FAILURE

    return tick


def _at_any_time(answers: Answers) -> Flow:
    """A condition."""

    def tick(_: Machine, node: SimulatedNode) -> int:
        return SUCCESS if answers.answer(node) else FAILURE

    return tick


def _after_its_first(first: int, answers: Answers) -> Flow:
    """A condition that has one result when it is asked for the first time, whatever it would notice."""

    def tick(_: Machine, node: SimulatedNode) -> int:
        if not node.is_on:
            node.is_on = True
            return first
        return SUCCESS if answers.answer(node) else FAILURE

    return tick


def _letting_through(answers: Answers) -> Flow:
    """A decorator that ticks its child when it begins, while the child runs, and when the answer is yes."""

    def tick(machine: Machine, node: SimulatedNode) -> int:
        is_first = node.status == IDLE
        set_status(machine, node, RUNNING)
        if is_first or node.child.status == RUNNING or answers.answer(node):
            return execute_tick(machine, node.child)
        return RUNNING

    return tick


def _when_longer(answers: Answers) -> Flow:
    """A PathLongerOnApproach: whether the path is longer than another one that it has seen."""

    def tick(machine: Machine, node: SimulatedNode) -> int:
        has_seen_one = node.status != IDLE if machine.dialect.nav2 == "iron" else node.is_on
        node.is_on = True
        set_status(machine, node, RUNNING)
        if not (has_seen_one and answers.answer(node)):
            return SUCCESS
        result = execute_tick(machine, node.child)
        if result in (SUCCESS, FAILURE):
            reset_child(machine, node.child)
        return result

    return tick


def _updating(answers: Answers) -> Flow:
    """A GoalUpdater: whether it has received a goal."""

    def tick(machine: Machine, node: SimulatedNode) -> int:
        nav2.pass_goals(node)
        answers.update(node)
        return execute_tick(machine, node.child)

    return tick


_ANSWERED: Final[dict[Flow, Callable[[Answers], Flow]]] = {
    **dict.fromkeys(
        (
            nav2.tick_rate_controller,
            nav2.tick_distance_controller,
            nav2.tick_speed_controller,
            nav2.tick_goal_updated_controller,
        ),
        _letting_through,
    ),
    nav2.tick_path_longer: _when_longer,
    nav2.tick_goal_updater: _updating,
    **dict.fromkeys(
        (
            nav2_conditions.tick_goal_updated,
            nav2_conditions.tick_time_expired,
            nav2_conditions.tick_distance_traveled,
        ),
        _noticing,
    ),
    **dict.fromkeys(
        (
            nav2_conditions.tick_initial_pose_received,
            nav2_conditions.tick_error_codes,
        ),
        _at_any_time,
    ),
    nav2_conditions.tick_global_updated_goal: partial(_after_its_first, SUCCESS),
    nav2_conditions.tick_path_expiring_timer: partial(_after_its_first, FAILURE),
}
_READS_THE_WORLD: Final = (
    nav2.tick_distance_controller,
    nav2.tick_speed_controller,
    nav2.tick_goal_updater,
    nav2_conditions.tick_distance_traveled,
)
