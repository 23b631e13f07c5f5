"""The simulator held against runs of the real engine: `python tests/simulator/against_truth.py FILE…`.

Each file is gzip, one JSON object a line: a tree, what its leaves do, and each change of a status that the engine made.
Prints what differs, and the counts on the last line; exits with 1 if anything differs.
"""

from __future__ import annotations

import gzip
import json
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from btq_lang.btcpp.reader import read
from btq_lang.simulator.blackboard import DOUBLE, STRING, Board
from btq_lang.simulator.drivers import halt_tree, tick_exactly_once
from btq_lang.simulator.errors import EngineError
from btq_lang.simulator.loading import load
from btq_lang.simulator.nodes import FAILURE, RUNNING, SKIPPED, SUCCESS, SimulatedNode
from btq_lang.simulator.timers import advance
from btq_lang.simulator.versions import Dialect
from btq_lang.simulator.world import World

Case = dict[str, Any]
DIALECTS = {
    "nav2-humble": Dialect("3.8.7", "humble"),
    "random-4.6": Dialect("4.6"),
    "random-4.10": Dialect("4.10"),
    "nav2-jazzy": Dialect("4.10", "jazzy"),
    "nav2-kilted": Dialect("4.10", "kilted"),
    "nav2-lyrical": Dialect("4.10", "lyrical"),
}
LINE = re.compile(r"^Error at line \d+: ")
OUTCOMES = {"S": SUCCESS, "F": FAILURE, "K": SKIPPED}
TYPES = {
    "goal": "geometry_msgs::msg::PoseStamped",
    "path": "nav_msgs::msg::Path",
    "error_code": "uint16_t",
    "initial_pose_received": "bool",
    "retries": "int",
    **{f"idx{number}": "int" for number in range(1, 10)},
}


class ScriptedLeaves:
    """The leaves of a case: each start takes the next entry of its list; and how they change entries and the world."""

    def __init__(self, skills: dict[str, list[list[Any]]], nav2: str = "") -> None:
        self.skills = skills
        self.world = World()
        self.world.position = (0.0, 0.0)
        self.goals = "nav_msgs::msg::Goals" if nav2 in ("kilted", "lyrical") else f"std::vector<{TYPES['goal']}>"
        self.starts: dict[int, int] = {}
        self.left: dict[int, int] = {}

    def tick(self, node: SimulatedNode) -> int:
        entries = self.skills[node.name]
        if node.status != RUNNING:
            self.starts[node.uid] = self.starts.get(node.uid, -1) + 1
            self.left[node.uid] = entries[self.starts[node.uid] % len(entries)][0]
        _, outcome, writes = entries[self.starts[node.uid] % len(entries)]
        if self.left[node.uid] > 0:
            self.left[node.uid] -= 1
            return RUNNING
        for key, value in writes.items():
            self.write(node.board, key, value)
        return OUTCOMES[outcome]

    def write(self, board: Board, key: str, value: float | str) -> None:
        if key == "robot_x":
            self.world.position = None if isinstance(value, str) else (value, 0.0)
        elif key == "robot_speed":
            self.world.speed = float(value)
        elif key == "call":
            self.world.calls.append(str(value))
        else:
            type_ = TYPES.get(key, STRING if isinstance(value, str) else DOUBLE) if key != "goals" else self.goals
            is_whole = type_ not in (DOUBLE, TYPES["goal"], self.goals) and not isinstance(value, str)
            board.write(key, int(value) if is_whole else value, type_)

    def halt(self, node: SimulatedNode) -> None:
        pass

    def next_change(self, now: int) -> int:
        return -1

    def memory(self) -> object:
        return tuple(self.starts.items()), tuple(self.left.items())


def run(case: Case, dialect: Dialect) -> Case:
    """What the simulator does with a case: root, changes, error and entries_after."""
    changes: list[list[int]] = []
    root: list[int] = []
    tick = 0

    def see(node: SimulatedNode, before: int, after: int) -> None:
        changes.append([tick, node.uid, before, after])

    board = Board(is_old=dialect.is_old)
    leaves = ScriptedLeaves(case["skills"], dialect.nav2)
    for key, value in case["entries"].items():
        leaves.write(board, key, value)
    document = read(case["xml"]).document
    assert document is not None
    error = None
    try:
        machine = load([document], "Main", dialect, leaves, see, board, ("Act",), leaves.world)
        while tick < case["ticks"]:
            advance(machine, tick * case.get("ms", 0))
            root.append(tick_exactly_once(machine))
            tick += 1
        halt_tree(machine)
    except EngineError as thrown:
        error = str(thrown)
    after = {key: entry.value for key, entry in board.entries.items() if entry.value is not None and key != "path"}
    return {"root": root, "changes": changes, "error": error, "entries_after": after if error is None else None}


def cases(path: Path) -> Iterator[Case]:
    with gzip.open(path, "rt", encoding="utf-8") as lines:
        yield from map(json.loads, lines)


def first_difference(case: Case, dialect: Dialect) -> str:
    """What the simulator does otherwise; empty if nothing."""
    ours = run(case, dialect)
    for number, (mine, theirs) in enumerate(zip(ours["changes"], case["changes"], strict=False)):
        if mine != theirs:
            return f"change {number}: {mine}, in the engine {theirs}"
    if len(ours["changes"]) != len(case["changes"]):
        return f"{len(ours['changes'])} changes, in the engine {len(case['changes'])}; error {ours['error']!r}"
    for name in ("root", "error", "entries_after"):
        mine, theirs = ours[name], case[name]
        if name == "error" and mine and theirs:  # the program that made the files put lines before the tree
            mine, theirs = LINE.sub("", mine), LINE.sub("", theirs)
        if mine != theirs:
            return f"{name} {mine!r}, in the engine {theirs!r}"
    return ""


def main(paths: list[Path]) -> int:
    count = different = changes = 0
    for path in paths:
        dialect = DIALECTS[path.name.partition(".jsonl")[0]]
        for case in cases(path):
            count += 1
            changes += len(case["changes"])
            if difference := first_difference(case, dialect):
                different += 1
                print(f"{path.name} {case['seed']}: {difference}")
    print(f"{count} cases, {changes} changes, {different} cases differ")
    return int(different > 0)


if __name__ == "__main__":
    sys.exit(main([Path(name) for name in sys.argv[1:]]))
