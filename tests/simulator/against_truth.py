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
from btq_lang.simulator.versions import Dialect

Case = dict[str, Any]
VERSIONS = {"random-4.6": "4.6", "random-4.10": "4.10"}
LINE = re.compile(r"^Error at line \d+: ")
OUTCOMES = {"S": SUCCESS, "F": FAILURE, "K": SKIPPED}


class ScriptedLeaves:
    """The leaves of a case: each start takes the next entry of its list."""

    def __init__(self, skills: dict[str, list[list[Any]]]) -> None:
        self.skills = skills
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
            node.board.write(key, value, STRING if isinstance(value, str) else DOUBLE)
        return OUTCOMES[outcome]

    def halt(self, node: SimulatedNode) -> None:
        pass

    def next_change(self, now: int) -> int:
        return -1

    def memory(self) -> object:
        return tuple(self.starts.items()), tuple(self.left.items())


def run(case: Case, version: str) -> Case:
    """What the simulator does with a case: root, changes, error and entries_after."""
    changes: list[list[int]] = []
    root: list[int] = []
    tick = 0

    def see(node: SimulatedNode, before: int, after: int) -> None:
        changes.append([tick, node.uid, before, after])

    board = Board()
    for key, value in case["entries"].items():
        board.write(key, value, STRING if isinstance(value, str) else DOUBLE)
    document = read(case["xml"]).document
    assert document is not None
    error = None
    try:
        leaves = ScriptedLeaves(case["skills"])
        machine = load([document], "Main", Dialect(version), leaves, see, board, stateful=("Act",))
        while tick < case["ticks"]:
            root.append(tick_exactly_once(machine))
            tick += 1
        halt_tree(machine)
    except EngineError as thrown:
        error = str(thrown)
    after = {key: entry.value for key, entry in board.entries.items() if isinstance(entry.value, (int, float, str))}
    return {"root": root, "changes": changes, "error": error, "entries_after": after if error is None else None}


def cases(path: Path) -> Iterator[Case]:
    with gzip.open(path, "rt", encoding="utf-8") as lines:
        yield from map(json.loads, lines)


def first_difference(case: Case, version: str) -> str:
    """What the simulator does otherwise; empty if nothing."""
    ours = run(case, version)
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
        version = VERSIONS[path.name.partition(".jsonl")[0]]
        for case in cases(path):
            count += 1
            changes += len(case["changes"])
            if difference := first_difference(case, version):
                different += 1
                print(f"{path.name} {case['seed']}: {difference}")
    print(f"{count} cases, {changes} changes, {different} cases differ")
    return int(different > 0)


if __name__ == "__main__":
    sys.exit(main([Path(name) for name in sys.argv[1:]]))
