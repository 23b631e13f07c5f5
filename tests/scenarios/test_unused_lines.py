"""Lines of a scenario that had no effect: each is told of, with the reason, and is no failure."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from in_process import run_btq

MISSION = """\
signal battery : % from {@battery_level}

Condition Low
Action Move
    input to : string
Action Dock
    output place : string

BehaviorTree Main
    ->
        Move First (to = "A")
        Move Second (to = {goal})
        ?
            Low
            SubTree Charging

BehaviorTree Charging
    -> Docking
        Dock (place = {place})
        Move (to = {place})

given {goal} = "B"

"""


def notes(folder: Path, *steps: str) -> list[str]:
    """What is said of lines without an effect; the first of these steps is in line 25."""
    lines = "".join(f"    {step}\n" for step in steps)
    (folder / "main.btq").write_text(f'{MISSION}scenario "S" of Main\n{lines}', encoding="utf-8")
    code, out, err = run_btq("test", "main.btq", "--format", "json", cwd=folder)
    (scenario,) = json.loads(out)["scenarios"]
    assert (code, err, scenario["outcome"]) == (0, "", "passed"), out
    return list(scenario["notes"])


@pytest.mark.parametrize(
    ("step", "why"),
    [
        ('given Move (to = "A") takes 2 s', ""),
        ('given Move (to = "B") takes 2 s', ""),
        ('given Move (to = "C") takes 2 s', "none of its nodes begins with such a value"),
        ("given Dock takes 2 s", "none of its nodes runs"),
        ('given {gaol} = "B"', "nothing reads {gaol}; did you mean `goal`?"),
        ("given {battery_level} = 3", ""),
        ("given battery = 3 %", ""),
        ("given First succeeds and writes goal = 3", ""),
        ("given First succeeds and writes gaol = 3", "nothing reads `gaol` that it writes"),
        ("given First succeeds and writes battery = 100 %", ""),
        ("given Dock fails and writes place = 100", "none of its nodes runs"),
        ("when 2 s have passed: Dock fails", "the run ends before"),
        ("when Second starts for the 2 time: Dock fails", "this does not happen"),
        ("when Second starts: Dock fails", ""),
        ("when {goal} == 'C': Dock fails", "the condition is never true"),
        ("when battery < 20 %: Dock fails", "the condition is never true"),
        ('when First starts: {gaol} = "C"', ""),
    ],
)
def test_lines_without_an_effect(tmp_path: Path, step: str, why: str) -> None:
    step = step.replace("'", '"')
    found = notes(tmp_path, step, "given Low answers true", "expect mission succeeds")
    assert found == ([f"line 25 has no effect: {why}"] if why else [])


def test_what_a_skill_writes_through_a_port_may_be_read(tmp_path: Path) -> None:
    steps = ["given Dock succeeds and writes place = 3", "given Low answers false", "expect mission succeeds"]
    assert notes(tmp_path, *steps) == []


def test_a_line_of_the_file_may_be_for_another_scenario(tmp_path: Path) -> None:
    text = (
        f'{MISSION}given Dock fails\n\nscenario "S" of Main\n    given Low answers true\n    expect mission succeeds\n'
    )
    (tmp_path / "main.btq").write_text(text.replace("{goal} =", "{gaol} ="), encoding="utf-8")
    assert run_btq("test", "main.btq", cwd=tmp_path) == (
        0,
        "passed  S (main.btq:26): succeeds after 0 ms\n"
        "        line 22 has no effect: nothing reads {gaol}; did you mean `goal`?\n"
        "1 scenario: 1 passed\n",
        "",
    )
