"""What is wrong with scenarios: names that nothing has, values that do not fit, what nodes cannot do, and ties."""

from __future__ import annotations

import pytest
from check_asserts import assert_clean, assert_fix, assert_problems, show, workspace_of

from btq_lang.checks import check

MISSION = """\
signal battery : % from {battery_level}
signal near : bool from {near}
context low : battery < 20 %
QualityReq in_time
    takes at most 2 min
    while near or low
Action MoveTo
    input location : string
Action Dock
    input station : string
    input speed : double
    output pose : string
Condition BatteryLow
BehaviorTree Deliver
    -> satisfies in_time
        BatteryLow
        Dock (station = "A", speed = 1, pose = {pose})
        MoveTo First (location = "A")
        MoveTo (location = {goal})
        Grasp
        SubTree Charge
BehaviorTree Charge
    Plug
"""
HEAD = 'include "mission.btq"\n'


def text(*steps: str, head: str = 'scenario "S" of Deliver', last: str = "    expect in_time\n") -> str:
    """A file with a scenario, and the mission that it includes."""
    lines = "".join(f"    {step}\n" for step in steps)
    return f"//- cases.btq\n{HEAD}{head}\n{lines}{last}//- mission.btq\n{MISSION}"


def of_step(step: str) -> list[str]:
    """The findings about a step: their rules, words and messages."""
    file = f'{MISSION}scenario "S" of Deliver\n    {step}\n    expect in_time\n'
    found = show(file, check(workspace_of({"main.btq": file}), "main.btq"))
    return [line.split(" ", 1)[1] for line in found]


def test_right_scenarios() -> None:
    assert_clean(
        text(
            'given MoveTo (location = "E") fails',
            "given First takes 2 s",
            "given every MoveTo takes 20 s",
            "given BatteryLow answers false, true",
            "given Dock fails twice, then succeeds after 3 s and writes pose = 3",
            "given Grasp answers true",  # it may be a condition
            "given battery = 80 %",
            "given {goal} = 3",
            "when 30 s have passed: near = true",
            "when Dock (speed = 1) fails for the 2 time: mission halts",
            "when {goal} == 3 and low: Grasp fails",
            "expect mission succeeds within 2 min",
            'expect MoveTo runs "A"',
            "expect Dock (speed) runs 1",
            "expect finally {goal} == 3 or not near",
            "expect never node Plug",
            head='scenario "S" of Deliver verifies in_time',
        )
    )


def test_a_file_of_scenarios_needs_no_main_tree() -> None:
    two = "BehaviorTree A\n    SubTree B\nBehaviorTree B\n    Y\n"
    assert_clean(f'//- cases.btq\n{HEAD}scenario "S" of B\n    expect succeeds\n//- mission.btq\nRoot A\n{two}')
    assert_clean(
        '//- cases.btq\ninclude "t.xml"\nscenario "S" of Main\n    given Dock fails\n    expect Dock tries at most 3\n'
        '//- t.xml\n<root BTCPP_format="4"><BehaviorTree ID="Main"><Dock/></BehaviorTree></root>\n'
    )


@pytest.mark.parametrize(
    ("step", "finding"),
    [
        ("given Dok fails", "error unmatched-path «Dok» unknown node `Dok`; did you mean `Dock`?"),
        ("given every Dok fails", "error unmatched-path «Dok» no node matches `every Dok`; did you mean `Dock`?"),
        ("given Charge/Dock fails", "error unmatched-path «Charge/Dock» no node `Dock` below `Charge`"),
        ("when Dok fails: near = true", "error unmatched-path «Dok» unknown node `Dok`; did you mean `Dock`?"),
        ("expect never node Dok", "error unmatched-path «Dok» unknown node `Dok`; did you mean `Dock`?"),
        (
            'given MoveTo (locaton = "E") fails',
            "error unknown-port «locaton» `MoveTo` has no port `locaton`; did you mean `location`?",
        ),
        ("when Dock (x = 3) fails: near = true", "error unknown-port «x» `Dock` has no port `x`"),
        ("expect MoveTo (x) runs 3", "error unknown-port «x» `MoveTo` has no port `x`"),
        (
            "expect Dock runs 1",
            "error impossible-step «Dock» `Dock` has several input ports (`station`, `speed`); name one before `runs`",
        ),
        (
            "given batery = 80 %",
            "error unknown-signal «batery» unknown signal `batery`; did you mean `battery`?",
        ),
        (
            "given low = true",
            "error unknown-signal «low» `low` is a context: what is given are the signals that it compares",
        ),
        ("given BatteryLow = true", "error unknown-signal «BatteryLow» `BatteryLow` is a node, not a signal"),
        (
            "given battery = 80",
            "error number-without-unit «80» missing unit after `80`; expected a percentage",
        ),
        ("given battery = 80 s", "error unit-mismatch «80 s» expected a percentage, found `80 s` (a time)"),
        ("given near = 1", "error unit-mismatch «1» expected `true` or `false`, found `1`"),
        (
            "when 30 s have passed: battery = 3 m",
            "error unit-mismatch «3 m» expected a percentage, found `3 m` (a length)",
        ),
        ("when 30 m have passed: near = true", "error unit-mismatch «30 m» expected a time, found `30 m` (a length)"),
        ("given Dock takes 3 m", "error unit-mismatch «3 m» expected a time, found `3 m` (a length)"),
        (
            "when battery < 3 s: near = true",
            "error unit-mismatch «battery < 3 s» cannot compare `battery` (a percentage) with `3 s` (a time)",
        ),
        (
            "expect finally batery > 3 %",
            "error unknown-signal «batery» unknown signal `batery`; did you mean `battery`?",
        ),
        ("expect Dock takes at most 3 m", "error unit-mismatch «3 m» expected a time, found `3 m` (a length)"),
        (
            "given Dock answers true",
            "error impossible-step «answers true» `Dock` is not a condition: it succeeds or fails, and answers nothing",
        ),
        (
            "given BatteryLow fails",
            "error impossible-step «fails» `BatteryLow` is a condition: it `answers` true or false at once",
        ),
        (
            "given BatteryLow takes 3 s",
            "error impossible-step «takes 3 s» `BatteryLow` is a condition: it `answers` true or false at once",
        ),
        (
            "given Sequence fails",
            "error impossible-step «Sequence» `->` is a node of the engine, so its behavior follows from the tree",
        ),
        ("expect intime", "error unknown-requirement «intime» unknown requirement `intime`; did you mean `in_time`?"),
    ],
)  # fmt: skip
def test_steps(step: str, finding: str) -> None:
    assert of_step(step) == [finding]


def test_first_lines() -> None:
    assert_problems(
        text(head='scenario "S" of Delivr verifies intime'),
        "cases.btq:2:17 error unknown-tree «Delivr» unknown tree `Delivr`; did you mean `Deliver`?",
        "cases.btq:2:33 error unknown-requirement «intime» unknown requirement `intime`; did you mean `in_time`?",
    )
    assert_problems(
        text("given Dock fails", last=""),
        'cases.btq:2:10 warning expects-nothing «"S"» this scenario expects nothing',
    )


@pytest.mark.parametrize(
    ("step", "title", "fixed"),
    [
        ("given BatteryLow = true", "Write ` answers true`", "given BatteryLow answers true"),
        ("given BatteryLow fails", "Write `answers false`", "given BatteryLow answers false"),
        ("given Dock answers true", "Write `succeeds`", "given Dock succeeds"),
        ("expect Dock runs 1", "Name `speed`", "expect Dock (speed) runs 1"),
    ],
)
def test_fixes(step: str, title: str, fixed: str) -> None:
    assert_fix(text(step), title, text(fixed))


def test_ties() -> None:
    tie = "two givens say the {} of one node, and neither is more specific"
    assert_problems(
        text(
            "given Dock fails",
            "given Dock takes 3 s",
            "given Deliver/Dock succeeds",
            "given every Dock succeeds",
            "given Dock (speed = 1) succeeds",
            "given Dock (speed = 2) fails",
            'given Dock (station = "A") fails',
            "given Dock fails",
            "given First takes 3 s",
            "given MoveTo takes 4 s",
        ),
        f"cases.btq:5:5 error ambiguous-given «given Deliver/Dock succeeds» {tie.format('result')}",
        f'cases.btq:9:5 error ambiguous-given «given Dock (station = "A") fails» {tie.format("result")}',
        f"cases.btq:10:5 error ambiguous-given «given Dock fails» {tie.format('result')}",
        f"cases.btq:12:5 error ambiguous-given «given MoveTo takes 4 s» {tie.format('duration')}",
    )


def test_ties_of_the_file() -> None:
    assert_problems(
        f'//- cases.btq\n{HEAD}given Dock fails\ngiven Dock succeeds\nscenario "S" of Deliver\n    given Dock fails\n'
        f"    expect in_time\n//- mission.btq\n{MISSION}",
        "cases.btq:3:1 error ambiguous-given «given Dock succeeds» "
        "two givens say the result of one node, and neither is more specific",
    )


def test_two_values_of_a_signal() -> None:
    assert_problems(
        "signal hour : h from {@hour}\nBehaviorTree T\n    A (hour = {@hour})\ngiven hour = 1 h\n"
        'scenario "S"\n    given hour = 2 h\n    given hour = 2 h\n    given {hour} = 3\n'
        "    expect finally hour == 1 h\n",
        "8:5 error ambiguous-given «given {hour} = 3» "
        "two givens say the value of `{hour}`, and neither is more specific",
    )


def test_a_signal_that_a_scenario_reads_is_used() -> None:
    assert_clean(
        "signal near : bool from {near}\nBehaviorTree T\n    A (near = {near})\n"
        'scenario "S"\n    when 3 s have passed: near = true\n    expect succeeds\n'
    )


def test_two_scenarios_of_one_file_have_two_titles() -> None:
    scenario = 'scenario "S" of T\n    expect mission succeeds\n'
    assert_problems(
        f"//- main.btq\nBehaviorTree T\n    A\n{scenario}{scenario}{scenario.replace('S', 'R')}"
        f'//- other.btq\ninclude "main.btq"\n{scenario}',
        'main.btq:5:10 warning duplicate-definition «"S"» duplicate title of a scenario: `S`',
    )
