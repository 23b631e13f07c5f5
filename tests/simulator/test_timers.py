"""Timeout, Delay and Sleep in virtual time: a tick every 20 ms."""

from __future__ import annotations

from typing import Any

import pytest
from against_truth import ScriptedLeaves
from simulated import LETTERS

from btq_lang.btcpp.reader import read
from btq_lang.simulator.blackboard import DOUBLE
from btq_lang.simulator.drivers import tick_once
from btq_lang.simulator.loading import load
from btq_lang.simulator.nodes import SimulatedNode
from btq_lang.simulator.timers import advance
from btq_lang.simulator.versions import Dialect

LONG: dict[str, list[list[Any]]] = {"a": [[9, "S", {}]]}
SHORT: dict[str, list[list[Any]]] = {"a": [[1, "S", {}]]}


def ticked(tree: str, skills: dict[str, list[list[Any]]], ticks: int = 8) -> tuple[str, list[str]]:
    """What the root returns at each tick, and when which named node was halted or ended."""
    document = read(f'<root BTCPP_format="4"><BehaviorTree ID="Main">{tree}</BehaviorTree></root>').document
    assert document is not None
    ends: list[str] = []

    def see(node: SimulatedNode, before: int, after: int) -> None:
        if node.name != node.id and LETTERS[before] == "R":
            ends.append(f"{machine.now} {node.name} {LETTERS[after]}")

    machine = load([document], "Main", Dialect("4.10"), ScriptedLeaves(skills), see, stateful=("Act",))
    machine.root.board.write("x", 0.0, DOUBLE)
    letters = ""
    for tick in range(ticks):
        advance(machine, tick * 20)
        letters += LETTERS[tick_once(machine)]
    return letters, ends


@pytest.mark.parametrize(
    ("tree", "skills", "letters", "ends"),
    [
        ('<Timeout msec="50"><Act name="a"/></Timeout>', LONG, "RRRFRRRF", ["50 a I", "130 a I"]),
        ('<Timeout msec="50"><Act name="a"/></Timeout>', SHORT, "RSRSRSRS", ["20 a S", "60 a S", "100 a S", "140 a S"]),
        ('<Timeout msec="0"><Act name="a"/></Timeout>', LONG, "RRRRRRRR", []),
        ('<Delay delay_msec="30"><AlwaysSuccess/></Delay>', {}, "RRSRRSRR", []),
        ('<Sleep name="s" msec="30"/>', {}, "RRSRRSRR", ["40 s S", "100 s S"]),
        ('<Sleep msec="0"/>', {}, "SSSSSSSS", []),
        # A child that was skipped first: the timer has gone off, and there is no other one.
        (
            '<ParallelAll><Timeout msec="30"><Act name="a" _skipIf="x == 0"/></Timeout>'
            '<Sequence><Sleep msec="50"/><Script code="x := 1.0"/><Sleep msec="500"/></Sequence></ParallelAll>',
            LONG,
            "RRRRRRRR",
            [],
        ),
        # A Retry between that runs counts as the child; an attempt follows another within the tick.
        (
            '<Timeout msec="50"><RetryUntilSuccessful name="r" num_attempts="-1"><Act name="a"/></RetryUntilSuccessful>'
            "</Timeout>",
            {"a": [[1, "F", {}]]},
            "RRRFRRRF",
            ["20 a F", "40 a F", "50 a I", "50 r I", "80 a F", "100 a F", "120 a F", "130 a I", "130 r I"],
        ),
    ],
)
def test_what_waits(tree: str, skills: dict[str, list[list[Any]]], letters: str, ends: list[str]) -> None:
    assert ticked(tree, skills) == (letters, ends)
