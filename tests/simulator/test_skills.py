"""What skills do: results, durations, answers and writes, one activation after another."""

from __future__ import annotations

import pytest

from btq_lang.btcpp.reader import read
from btq_lang.simulator.blackboard import STRING
from btq_lang.simulator.drivers import drive
from btq_lang.simulator.loading import load
from btq_lang.simulator.nodes import FAILURE, RUNNING, SUCCESS, Machine
from btq_lang.simulator.skills import GivenActivation, GivenSkill, Skills, Unanswered, Write
from btq_lang.simulator.versions import Dialect
from btq_lang.workspace.project_driver import Driver

DELIVER = (
    '<Sequence><Cond name="ready"/><RetryUntilSuccessful num_attempts="3"><Act name="go"/></RetryUntilSuccessful>'
    "<ScriptCondition code=\"place == 'B'\"/></Sequence>"
)
READY, GO = frozenset({2}), frozenset({4})


def run(*givens: GivenSkill) -> tuple[int, Machine, Skills]:
    document = read(f'<root BTCPP_format="4"><BehaviorTree ID="Main">{DELIVER}</BehaviorTree></root>').document
    assert document is not None
    skills = Skills(givens, ("Cond",))
    machine = load([document], "Main", Dialect("4.10"), skills, lambda *_: None, stateful=("Act",))
    skills.machine = machine
    return drive(machine, Driver(), 60_000), machine, skills


def test_a_failure_and_then_a_success_that_writes() -> None:
    fails, arrives = (
        GivenActivation(FAILURE, 2_000, times=1),
        GivenActivation(SUCCESS, 3_000, (Write("place", "B", STRING),)),
    )
    result, machine, skills = run(GivenSkill(GO, 1, (fails, arrives)), GivenSkill(READY, 1, answers=(True,)))
    assert (result, machine.now, skills.assumed) == (SUCCESS, 5_000, set())


def test_aspects_come_from_the_most_specific() -> None:
    every, own = GivenSkill(GO, 0, (GivenActivation(FAILURE, 1_000),)), GivenSkill(GO, 1, (GivenActivation(takes=500),))
    result, machine, _ = run(every, own, GivenSkill(READY, 1, answers=(True,)))
    assert (result, machine.now) == (FAILURE, 1_500)


def test_one_that_does_not_end() -> None:
    result, machine, _ = run(GivenSkill(GO, 1, (GivenActivation(RUNNING),)), GivenSkill(READY, 1, answers=(True,)))
    assert (result, machine.now) == (RUNNING, 10)


def test_a_condition_is_never_assumed() -> None:
    with pytest.raises(Unanswered) as raised:
        run()
    assert (raised.value.node.name, raised.value.at) == ("ready", 0)


def test_an_action_is_assumed_and_listed() -> None:
    *_, skills = run(GivenSkill(READY, 1, answers=(False, True)))
    assert skills.assumed == set()
    with pytest.raises(Exception, match="Variable not found: place"):
        run(GivenSkill(READY, 1, answers=(True,)))
