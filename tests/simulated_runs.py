"""Runs of a mission, without guards, in the model of the engine that scenarios have: leaves take what time they like.

A tick costs no time unless a leaf says so, and the tree is ticked whenever something happens, and sometimes between.
"""

from __future__ import annotations

import random

from btq_lang.evidence.identity import Candidate
from btq_lang.scenarios.mission import ScenarioMission, main_tree
from btq_lang.simulator.blackboard import STRING, Board
from btq_lang.simulator.drivers import tick_exactly_once
from btq_lang.simulator.loading import load
from btq_lang.simulator.nodes import FAILURE, RUNNING, SUCCESS, Machine, SimulatedNode
from btq_lang.simulator.ports import key_of
from btq_lang.simulator.ticking import tick_itself
from btq_lang.simulator.timers import NEVER, advance, next_due, next_passing
from btq_lang.workspace.resolved import ResolvedNode


class Endless(Exception):
    """The run has gone on for so long that it is not worth waiting for its end."""


class SimulatedRuns:
    """Runs of one tree, one after the other: what a node remembers from one to the next it keeps.

    Attributes:
        last: when a run that still goes on counts as endless, in milliseconds.
        started: when each node began that has not ended, in milliseconds, by its number.
    """

    last = 500_000

    def __init__(self, mission: ScenarioMission, chance: random.Random, is_stateful: bool = True) -> None:
        """
        Args:
            is_stateful: an action that has ended and was not reset keeps its result when it is ticked again.
        """
        self.nodes = mission.written
        self.conditions = mission.conditions
        self.chance = chance
        self.started: dict[int, int] = {}
        self._ends: dict[int, int] = {}  # of leaves, by their number
        tree = mission.name, mission.dialect, self, self.changed, Board(), mission.actions if is_stateful else ()
        self.machine: Machine = load(mission.documents, *tree)
        self.machine.recall = self.ticked

    def run(self) -> None:
        """One run, from the first tick to the end.

        Raises:
            Endless: it has none.
        """
        machine = self.machine
        idle = 0
        for _ in range(400):
            machine.is_woken = False
            if tick_exactly_once(machine) != RUNNING:
                return
            due = next_due(machine)
            times = self.next_change(machine.now), due, next_passing(machine)
            is_ticked_now = machine.is_woken or NEVER != due <= machine.now
            later = [time for time in times if time > machine.now and not is_ticked_now]
            idle = 0 if later else idle + 1
            if idle > 20 or machine.now > self.last:
                break
            between = self.chance.choice([0.25, 0.5, 1.0, 1.0, 1.0]) if later else 0.0
            self.wait(round((min(later, default=machine.now) - machine.now) * between))
        raise Endless

    def wait(self, milliseconds: int) -> None:
        """Let time pass; a timer that went off while a leaf kept the tree from noticing does so now."""
        for node in self.machine.timed:
            if node.due != NEVER:
                node.due = max(node.due, self.machine.now)
        advance(self.machine, self.machine.now + milliseconds)

    # ---- the world ----

    def drawn(self, leaf: ResolvedNode) -> float:
        """How long an activation of a leaf takes that begins now, in seconds."""
        raise NotImplementedError

    def ended(self, leaf: ResolvedNode) -> int:
        """How an activation of a leaf ends."""
        return self.chance.choice([SUCCESS, FAILURE])

    def answer(self, condition: ResolvedNode) -> int:
        """What a condition says when it is asked."""
        return self.chance.choice([SUCCESS, SUCCESS, SUCCESS, FAILURE])

    # ---- what is seen ----

    def began(self, node: SimulatedNode) -> None:
        """A node that has not run is ticked: a Switch, which may choose another case then."""
        if "variable" in node.ports:
            cases = [value for port, value in node.ports.items() if port.startswith("case_")]
            key = key_of(node.ports["variable"], "variable")
            assert key is not None
            node.board.write(key, self.chance.choice([*cases, "none of them"]), STRING)

    def over(self, node: SimulatedNode, result: int, milliseconds: int) -> None:
        """A node has ended: nothing is done with it here."""

    def changed(self, node: SimulatedNode, before: int, status: int) -> None:
        """A status has changed."""
        if status != RUNNING:
            self.started.pop(node.uid, None)

    def ticked(self, node: SimulatedNode) -> int:
        """Tick a node; its result."""
        is_leaf = not node.children
        if is_leaf and node.status in (SUCCESS, FAILURE) and (node.rules.is_stateful or node.rules.is_timed):
            return tick_itself(self.machine, node)  # it keeps its result
        start = self.started.get(node.uid)
        if start is None:
            start = self.started[node.uid] = self.machine.now
            self.began(node)
        result = tick_itself(self.machine, node)
        if result != RUNNING:
            self.started.pop(node.uid, None)
            self.over(node, result, self.machine.now - start)
        return result

    # ---- the program that has the leaves ----

    def tick(self, node: SimulatedNode) -> int:
        """Tick a leaf of the program."""
        leaf = self.nodes[node.uid]
        if node.id in self.conditions:
            return self.answer(leaf)
        if node.status != RUNNING:
            start = self.machine.now
            self._ends[node.uid] = start + round(self.drawn(leaf) * 1000)
        if self.machine.now < self._ends[node.uid]:
            return RUNNING
        del self._ends[node.uid]
        return self.ended(leaf)

    def halt(self, node: SimulatedNode) -> None:
        """Halt a leaf of the program that runs."""
        self._ends.pop(node.uid, None)

    def next_change(self, now: int) -> int:
        """When a leaf ends; negative: none will."""
        return min([end for end in self._ends.values() if end > now], default=NEVER)

    def memory(self) -> object:
        """All of it that changes; nobody asks."""
        raise NotImplementedError


def bare(candidate: Candidate) -> ScenarioMission:
    """A mission as it is written, without guards."""
    tree = main_tree(candidate.workspace, candidate.path)
    return ScenarioMission(candidate.workspace, candidate.path, tree, is_enforced=False)
