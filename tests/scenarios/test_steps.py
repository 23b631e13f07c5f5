"""Each given, when and expect of a scenario, by the command: what comes out, and the first step that differs."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from in_process import run_btq
from json_schema import violations

SCHEMA = json.loads(
    (Path(__file__).parents[2] / "btq_lang/scenarios/scenarios.schema.json").read_text(encoding="utf-8")
)
MISSION = """\
signal battery : % from {battery} level
signal person : bool

QualityReq quick : performance-efficiency "Dock in time"
    Dock takes at most 5 s

QualityReq calm : safety "Nobody is near while it moves"
    every Move never person

Condition Low
Action Move
    input to : string
Action Dock
    input at : string
    input speed : double
    output place : string

BehaviorTree Main
    ->
        Move First (to = "A")
        ?
            Low
            Move Second (to = {goal})
        Retry Docking (num_attempts = 3)
            Dock (at = "home" speed = "1.5" place = {place})
"""
QUIET = ["given Low answers false", 'given {goal} = "B"']


def result(folder: Path, *steps: str) -> dict[str, Any]:
    """The result of a scenario with these steps."""
    lines = "\n".join(f"    {step}" for step in steps)
    (folder / "main.btq").write_text(f'{MISSION}\nscenario "S"\n{lines}\n', encoding="utf-8")
    _, out, err = run_btq("test", "main.btq", "--format", "json", cwd=folder)
    assert err == ""
    document = json.loads(out)
    assert [*violations(document, SCHEMA)] == []
    (scenario,) = document["scenarios"]
    return dict(scenario)


def reasons(scenario: dict[str, Any]) -> list[str]:
    """Why it is not as expected: of each step its time, its node and what happened."""
    steps = [
        f"{each['step']['at']:g} s {each['step']['node']}:{each['step']['line']} {each['step']['happened']}"
        if each["step"]
        else each["why"]
        for each in scenario["expectations"]
        if each["outcome"] != "passed"
    ]
    return [scenario["why"]] if scenario["why"] else steps


@pytest.mark.parametrize(
    ("steps", "ended", "seconds"),
    [
        (["given Dock succeeds"], "succeeds", 0),
        (["given Dock fails"], "fails", 0),
        (["given Dock fails twice, then succeeds"], "succeeds", 0),
        (["given Dock fails once, then succeeds after 3 s"], "succeeds", 3),
        (["given Dock fails 3 times, then succeeds"], "fails", 0),
        (["given Dock fails after 2 s twice, then takes 4 s"], "succeeds", 8),
        (["given Dock fails twice"], "succeeds", 0),
        (["given Dock skips"], "succeeds", 0),
        (["given Move takes 20 s"], "succeeds", 40),
        (["given every Move takes 20 s", "given First takes 1 s"], "succeeds", 21),
        (['given Move (to = "B") takes 2 s', "given Move takes 30 s"], "succeeds", 32),
        (['given Move (to = "B") fails', "given Move takes 30 s"], "fails", 60),
        (["given Main/Second takes 2 s", "given every Move fails"], "fails", 0),
        (["given Low answers true"], "succeeds", 0),
        (['given Dock (at = "home", speed = 1.50) takes 3 s'], "succeeds", 3),
        (["given Dock does not end", "when 8 s have passed: mission halts"], "is halted", 8),
        (["given Dock takes 9 s", "when Dock starts: mission halts"], "is halted", 0),
    ],
)
def test_what_nodes_do(tmp_path: Path, steps: list[str], ended: str, seconds: float) -> None:
    given = [] if any("Low" in step for step in steps) else QUIET[:1]
    scenario = result(tmp_path, *given, QUIET[1], *steps, "expect finally not node Dock")
    assert (reasons(scenario), scenario["ended"], scenario["seconds"]) == ([], ended, seconds)


@pytest.mark.parametrize(
    ("when", "moves"),
    [
        ("when 5 s have passed: Second takes 1 s", 11),
        ("when 15 s have passed: Second takes 1 s", 20),
        ("when First succeeds: Second takes 2 s", 12),
        ("when Move finishes for the 2 time: Dock takes 7 s", 27),
        ("when Move starts for the second time: Dock takes 6 s", 26),
        ('when Move (to = "B") starts: Dock takes 5 s', 25),
        ("when mission starts: Move takes 1 s", 2),
        ("when First fails: Move takes 1 s", 20),
        ('when 3 s have passed: {goal} = "C"', 20),
        ("when battery < 60 %: Dock takes 4 s", 24),
        ("when person: Second takes 3 s", 20),
        ('when {goal} == "B" and not node Dock: Dock takes 8 s', 28),
        ('when {goal} == "C": Dock takes 8 s', 20),
    ],
)
def test_when_something_changes(tmp_path: Path, when: str, moves: float) -> None:
    givens = [*QUIET, "given Move takes 10 s", "given battery = 50 %", "given person = false"]
    scenario = result(tmp_path, *givens, when, "expect mission succeeds")
    assert (reasons(scenario), scenario["seconds"]) == ([], moves)


def test_changes_one_after_the_other(tmp_path: Path) -> None:
    changes = [
        "when 4 s have passed: person = true",
        "when person: battery = 10 %",
        "when battery < 20 %: Low answers true",
    ]
    givens = [
        *QUIET,
        "given First takes 5 s",
        "given Second takes 30 s",
        "given battery = 50 %",
        "given person = false",
    ]
    expected = [
        'expect Move (to) runs "A"',
        "expect calm violated",
        "expect finally battery == 10 % and {battery} == 10",
    ]
    assert reasons(result(tmp_path, *givens, *changes, *expected)) == []


@pytest.mark.parametrize(
    ("expect", "why"),
    [
        ("mission succeeds", ""),
        ("mission succeeds within 60 s", ""),
        ("mission succeeds within 40 s", "40 s Sequence::1:19 not over yet: succeeded after 46 s"),
        ("succeeds within 60 s", ""),
        ("Dock takes at most 6 s", ""),
        ("Dock takes at most 5 s", "45 s Dock::7:25 not over yet: took 6 s"),
        ("Dock tries at most 3", ""),
        ("never node Second", "20 s Sequence::1:19 `node Second` held"),
        ("every Move takes at most 20 s", ""),
        ("Dock starts within 1 s after Second succeeds", ""),
        ('Move runs "A", "B"', ""),
        ('Move (to) runs "A", "B"', ""),
        ('Dock (at) runs "home"', ""),
        ('Dock (at = "home", speed) runs 1.50', ""),
        ('Move runs "A", "C"', '20 s Second:23 it runs with "B"'),
        ('Move runs "A"', '20 s Second:23 it runs with "B"'),
        ('Move runs "A", "B", "C"', "46 s Sequence::1:19 the mission succeeds, and the node has not run with it"),
        ('Move (to = "A", to) runs "A"', ""),
        ("finally {place} == 3", ""),
        ("finally {place} == 4", "46 s Sequence::1:19 {place} is 3"),
        ('finally {goal} == "B" and not node Dock', ""),
        ("finally {nothing} == 1", "nothing gives `{nothing}` a value"),
        ("mission does not end", "46 s Sequence::1:19 the mission succeeds"),
        ("mission fails", "46 s Sequence::1:19 the mission succeeds"),
        ("mission halts", "46 s Sequence::1:19 the mission succeeds"),
        ("calm", ""),
        ("calm satisfied", ""),
        ("quick violated", ""),
        ("quick", "45 s Dock::7:25 not over yet: took 6 s"),
        ("finally battery < 20 %", "46 s Sequence::1:19 battery is 50 %"),
        ("calm violated", "46 s Sequence::1:19 calm is satisfied"),
    ],
)
def test_what_is_expected(tmp_path: Path, expect: str, why: str) -> None:
    givens = [
        *QUIET,
        "given Move takes 20 s",
        "given Dock succeeds after 6 s and writes place = 3",
        "given person = false",
        "given battery = 50 %",
    ]
    scenario = result(tmp_path, *givens, f"expect {expect}")
    assert reasons(scenario) == ([why] if why else [])


@pytest.mark.parametrize(
    ("steps", "outcome"),
    [
        (["given Dock fails"], "mission fails"),
        (["given Dock takes 9 s", "when Dock starts: mission halts"], "mission halts"),
    ],
)
def test_how_a_run_is_expected_to_end(tmp_path: Path, steps: list[str], outcome: str) -> None:
    scenario = result(tmp_path, *QUIET, *steps, f"expect {outcome}")
    assert (scenario["outcome"], reasons(scenario)) == ("passed", [])


def test_the_failure_of_a_mission_is_shown_where_it_began(tmp_path: Path) -> None:
    scenario = result(tmp_path, *QUIET, "given Dock fails after 2 s", "expect mission succeeds")
    assert reasons(scenario) == ["6 s Dock::7:25 it fails"]


def test_a_requirement_whose_signal_nobody_gives_is_unknown(tmp_path: Path) -> None:
    scenario = result(tmp_path, *QUIET, "expect calm")
    assert (scenario["outcome"], reasons(scenario)) == ("unknown", ["no samples of `person`"])


@pytest.mark.parametrize("ways", ["test", 'test "S"', 'analysis, review "R-3"', "monitor, test"])
def test_a_scenario_judges_what_is_verified_by_people(tmp_path: Path, ways: str) -> None:
    (tmp_path / "main.btq").write_text(
        'QualityReq soon : time-behaviour "Soon"\n    Move takes at most 3 s\n'
        f"    verified by {ways}\nBehaviorTree Main\n    ->\n        Move\nAction Move\n"
        + "".join(
            f'scenario "{expect}" verifies soon\n    given Move takes {seconds} s\n    expect {expect}\n'
            for seconds, expect in ((2, "soon"), (4, "soon violated"))
        ),
        encoding="utf-8",
    )
    code, out, err = run_btq("test", "main.btq", cwd=tmp_path)
    assert (code, err, out.splitlines()[-1]) == (0, "", "2 scenarios: 2 passed")


@pytest.mark.parametrize(
    ("clauses", "why"),
    [
        (
            ["mission succeeds within 40 min", "in at least 95 % of runs", "confidence 95 %"],
            "often is undecided: one run cannot decide `in at least 95 % of runs` with confidence 95 %; "
            "`expect mission succeeds within 40 min` is what it can show",
        ),
        (
            ["mission takes at most 6 s on average", "confidence 95 %"],
            "often is undecided: one run cannot decide `mission takes at most 6 s on average` with confidence 95 %; "
            "`expect mission takes at most 6 s` is what it can show",
        ),
        (
            ["Move takes at most 6 s", "in at least 95 % of activations", "confidence 95 %", "while not low"],
            "often is undecided: one run cannot decide `in at least 95 % of activations` with confidence 95 %",
        ),
    ],
)
def test_one_run_cannot_decide_what_is_about_many(tmp_path: Path, clauses: list[str], why: str) -> None:
    demanded = "".join(f"    {clause}\n" for clause in clauses)
    (tmp_path / "main.btq").write_text(
        f'signal low : bool from {{low}} initially false\nQualityReq often : reliability "Often"\n{demanded}'
        "BehaviorTree Main\n    ->\n        Move\nAction Move\n"
        'scenario "S"\n    given low = false\n    given Move takes 4 s\n    expect often\n',
        encoding="utf-8",
    )
    _, out, _ = run_btq("test", "main.btq", "--format", "json", cwd=tmp_path)
    (scenario,) = json.loads(out)["scenarios"]
    assert (scenario["outcome"], scenario["expectations"][0]["step"]["happened"]) == ("failed", why)


def test_what_hours_decide_is_unknown_after_one_run(tmp_path: Path) -> None:
    (tmp_path / "main.btq").write_text(
        'QualityReq seldom : reliability "Seldom"\n    Move fails at most 1 per 1000 h\n'
        'BehaviorTree Main\n    Move\nAction Move\nscenario "S"\n    given Move takes 4 s\n    expect seldom\n',
        encoding="utf-8",
    )
    _, out, _ = run_btq("test", "main.btq", "--format", "json", cwd=tmp_path)
    (scenario,) = json.loads(out)["scenarios"]
    why = "0 in 4 s, 1000 h more are needed; one run cannot decide `Move fails at most 1 per 1000 h`"
    assert (scenario["outcome"], scenario["expectations"][0]["why"]) == ("unknown", why)


def test_a_requirement_whose_node_did_not_run_names_it(tmp_path: Path) -> None:
    scenario = result(tmp_path, "given Low answers true", "given First fails", "expect quick")
    assert reasons(scenario) == ["0 s Sequence::1:19 quick is never exercised: Dock::7 did not start in any run"]


def test_a_clause_that_nothing_exercised_is_noted(tmp_path: Path) -> None:
    (tmp_path / "main.btq").write_text(
        'QualityReq both : safety "Both"\n    Report starts within 60 s after Move fails\n    mission succeeds\n'
        "BehaviorTree Main\n    ?\n        Move\n        Report\nAction Move\nAction Report\n"
        'scenario "S"\n    given Move succeeds\n    expect both\n'
        'scenario "T"\n    given Move fails\n    expect both\n'
        'scenario "U"\n    given Move fails\n    given Report fails\n    expect both violated\n',
        encoding="utf-8",
    )
    note = "`Report starts within 60 s after Move fails` is never exercised: Report::3 did not start in any run"
    assert run_btq("test", "main.btq", cwd=tmp_path) == (
        0,
        "passed  S (main.btq:10): succeeds after 0 ms\n"
        f"        line 12 expects both; {note}\n"
        "passed  T (main.btq:13): succeeds after 0 ms\n"
        "passed  U (main.btq:16): fails after 0 ms\n"
        "3 scenarios: 3 passed\n",
        "",
    )
    _, out, _ = run_btq("test", "main.btq", "--format", "json", cwd=tmp_path)
    document = json.loads(out)
    assert [*violations(document, SCHEMA)] == []
    assert [each["expectations"][0]["note"] for each in document["scenarios"]] == [note, "", ""]


def test_a_halted_mission_neither_succeeds_nor_fails(tmp_path: Path) -> None:
    scenario = result(
        tmp_path, *QUIET, "given Dock takes 9 s", "when Dock starts: mission halts", "expect mission succeeds"
    )
    assert reasons(scenario) == ["0 s Sequence::1:19 it was halted"]


def test_a_run_that_never_ends_is_an_outcome_of_its_own(tmp_path: Path) -> None:
    steps = [*QUIET, "given Dock does not end"]
    scenario = result(tmp_path, *steps, "expect never person")
    expected = result(tmp_path, *steps, "expect mission does not end")
    assert (scenario["ended"], scenario["outcome"], expected["outcome"]) == ("does not end", "failed", "passed")


def test_a_mission_that_goes_round_does_not_end(tmp_path: Path) -> None:
    (tmp_path / "main.btq").write_text(
        "BehaviorTree Patrol\n    Repeat (num_cycles = -1)\n        ->\n            Move\n            Look\n"
        'scenario "for ever"\n    given Move takes 7 s\n    expect mission does not end\n'
        "    expect Look takes at most 1 s\n",
        encoding="utf-8",
    )
    code, out, err = run_btq("test", "main.btq", cwd=tmp_path)
    assert (code, out.splitlines()[-1], err) == (0, "1 scenario: 1 passed", "")


@pytest.mark.parametrize(
    ("steps", "end"),
    [
        (["given Dock succeeds and writes battery = 90 %"], "battery == 90 % and {battery} == 90"),
        (["given Low answers false and writes seen = 3"], "{seen} == 3"),
        (["given Low answers false, false and writes seen = 3, then answers true and writes seen = 4"], "{seen} == 3"),
        (["given Low answers false, then answers true and writes seen = 4"], "{seen} == 5"),
    ],
)
def test_what_nodes_write(tmp_path: Path, steps: list[str], end: str) -> None:
    givens = [QUIET[1], *([] if "Low" in steps[0] else QUIET[:1]), "given {seen} = 5"]
    assert reasons(result(tmp_path, *givens, *steps, f"expect finally {end}")) == []


def test_a_condition_writes_at_every_answer(tmp_path: Path) -> None:
    (tmp_path / "main.btq").write_text(
        "Condition Alive\n    output hour : double\nAction Go\n"
        "BehaviorTree Main\n    R->\n        Alive (hour = {@hour})\n        Go\n"
        'scenario "The night begins"\n'
        "    given Alive answers true 3 times and writes hour = 21, then answers true and writes hour = 22\n"
        "    given Go takes 10 min\n    expect mission succeeds\n    expect finally {hour} == 22\n",
        encoding="utf-8",
    )
    assert run_btq("test", "main.btq", cwd=tmp_path)[:2] == (
        0,
        "passed  The night begins (main.btq:8): succeeds after 10 min\n1 scenario: 1 passed\n",
    )


@pytest.mark.parametrize(
    ("steps", "why"),
    [
        (
            ["given Dock succeeds and writes person = true", "expect calm"],
            "line 28: `person` is a signal without an entry; no node writes it, so change it with `when …: person = …`",
        ),
        (
            ["given battery = 20 %", "given {battery} = 30", "expect calm"],
            "line 29: two givens say the value of `{battery}`, and neither is more specific",
        ),
        (["expect mission succeeds"], "Low::4 was asked at 0 s; say what it answers"),
        (
            ["given First takes 12 s", 'given {goal} = "B"', "expect mission succeeds"],
            "Low::4 was asked at 12 s; say what it answers",
        ),
        (["given Dok fails", "expect mission succeeds"], "line 28: unknown node `Dok`; did you mean `Dock`?"),
        (["given Dock fails"], "line 27: it expects nothing"),
        (["given batery = 3 %", "expect calm"], "line 28: unknown signal `batery`; did you mean `battery`?"),
        (["given battery = 3 s", "expect calm"], "line 28: expected a percentage, found `3 s` (a time)"),
        (["expect calmer"], "line 28: unknown requirement `calmer`; did you mean `calm`?"),
        (
            ['expect Dock runs "home"'],
            "line 28: `Dock` has several input ports (`at`, `speed`); name one before `runs`",
        ),
        (
            ["given Dock fails", "given Dock succeeds", "expect calm"],
            "line 29: two givens say the result of one node, and neither is more specific",
        ),
    ],
)
def test_mistakes_of_a_scenario(tmp_path: Path, steps: list[str], why: str) -> None:
    scenario = result(tmp_path, *steps)
    assert (scenario["outcome"], scenario["why"]) == ("error", why)


def test_what_is_given_in_a_file_holds_for_all_its_scenarios(tmp_path: Path) -> None:
    text = (
        f"{MISSION}\ngiven Low answers true\ngiven Move takes 9 s\n\n"
        'scenario "as usual"\n    expect mission takes between 9 s and 9 s\n'
        'scenario "otherwise"\n    given Move takes 2 s\n    expect mission takes between 2 s and 2 s\n'
    )
    (tmp_path / "main.btq").write_text(text, encoding="utf-8")
    assert run_btq("test", "main.btq", cwd=tmp_path) == (
        0,
        "passed  as usual (main.btq:30): succeeds after 9 s\n"
        "passed  otherwise (main.btq:32): succeeds after 2 s\n"
        "2 scenarios: 2 passed\n",
        "",
    )
