"""How a program ticks its tree: when it ends, when it never will, and how time jumps."""

from __future__ import annotations

import pytest
from against_truth import ScriptedLeaves

from btq_lang.btcpp.reader import read
from btq_lang.simulator.drivers import drive
from btq_lang.simulator.loading import load
from btq_lang.simulator.nodes import FAILURE, RUNNING, SKIPPED, SUCCESS, Machine, SimulatedNode
from btq_lang.simulator.versions import Dialect
from btq_lang.workspace.project_driver import Driver

WHILE_RUNNING = Driver()


class Timed(ScriptedLeaves):
    """Leaves whose actions take 1 s; counts how often any was ticked."""

    def __init__(self) -> None:
        super().__init__({})
        self.ends: dict[int, int] = {}
        self.machine: Machine
        self.ticks = 0

    def tick(self, node: SimulatedNode) -> int:
        self.ticks += 1
        if node.status != RUNNING:
            self.ends[node.uid] = self.machine.now + 1_000
        return SUCCESS if self.machine.now >= self.ends[node.uid] else RUNNING

    def halt(self, node: SimulatedNode) -> None:
        del self.ends[node.uid]

    def next_change(self, now: int) -> int:
        return min([end for end in self.ends.values() if end > now], default=-1)

    def memory(self) -> object:
        return tuple(self.ends.items())


def run(tree: str, driver: Driver = WHILE_RUNNING) -> tuple[int, int, int]:
    """The result of a tree, how many milliseconds it took, and how often its leaves were ticked."""
    document = read(f'<root BTCPP_format="4"><BehaviorTree ID="Main">{tree}</BehaviorTree></root>').document
    assert document is not None
    program = Timed()
    machine = load([document], "Main", Dialect("4.10", "jazzy"), program, lambda *_: None, stateful=("Act",))
    program.machine = machine
    return drive(machine, driver, 10_000), machine.now, program.ticks


@pytest.mark.parametrize(
    ("tree", "result", "took", "ticks"),
    [
        ("<AlwaysSuccess/>", SUCCESS, 0, 0),
        ('<AlwaysSuccess _skipIf="true"/>', SKIPPED, 0, 0),
        ('<Sequence><Act name="a"/><Act name="b"/></Sequence>', SUCCESS, 2_000, 6),
        ('<Timeout msec="205"><Act name="a"/></Timeout>', FAILURE, 205, 2),
        ('<Sequence><Sleep msec="33"/><Act name="a"/></Sequence>', SUCCESS, 1_033, 3),
        ("<KeepRunningUntilFailure><AlwaysSuccess/></KeepRunningUntilFailure>", RUNNING, 10, 0),
        ('<LoopInt queue="1;2;3" value="{i}"><AlwaysSuccess/></LoopInt>', SUCCESS, 30, 0),
        ('<ReactiveSequence><Act name="a"/><Act name="b"/></ReactiveSequence>', RUNNING, 10_090, 40),
        (
            '<PipelineSequence><RateController hz="0"><AlwaysSuccess/></RateController>'
            '<WaitValueUpdate entry="{x}"><AlwaysSuccess/></WaitValueUpdate></PipelineSequence>',
            RUNNING,
            20,
            0,
        ),
        (
            '<WhileDoElse><TimeExpired seconds="0.333"/><AlwaysFailure/><Act name="a"/></WhileDoElse>',
            FAILURE,
            340,
            2,
        ),
        (
            '<PipelineSequence><RateController hz="2.3"><AlwaysSuccess/></RateController><Act name="a"/>'
            "</PipelineSequence>",
            SUCCESS,
            1_000,
            10,
        ),
    ],
)
def test_runs(tree: str, result: int, took: int, ticks: int) -> None:
    assert run(tree) == (result, took, ticks)


@pytest.mark.parametrize(
    ("tree", "function", "took", "ticks"),
    [
        # The sleep of these ends when it ends, whatever happens in between.
        ('<Timeout msec="205"><Act name="a"/></Timeout>', "tick_while_running", 205, 2),
        ('<Timeout msec="205"><Act name="a"/></Timeout>', "tick_once", 300, 2),
        ('<Sequence><Act name="a"/><Act name="b"/></Sequence>', "tick_once", 2_000, 6),
        ('<Sequence><Sleep msec="33"/><Act name="a"/></Sequence>', "tick_once", 1_100, 4),
        # A node that asks to be ticked again is, or waits for the next tick.
        ('<Repeat num_cycles="3"><AlwaysSuccess/></Repeat>', "tick_once", 0, 0),
        ('<Repeat num_cycles="3"><AlwaysSuccess/></Repeat>', "tick_exactly_once", 200, 0),
    ],
)
def test_other_drivers(tree: str, function: str, took: int, ticks: int) -> None:
    assert run(tree, Driver(function, 100))[1:] == (took, ticks)
