"""Entries that a skill writes while nothing says what: they are passed on, and what needs their value is unknown."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from in_process import run_btq

TREE = """\
Action Dock
    output place
    input speed : double
Action Adjust
    inout place
Action MoveTo
    input to
Condition Seen
    output where : string

BehaviorTree Main
    ->
        Dock (place = {place} speed = {speed})
"""
CURE = "write `given Dock succeeds and writes place = …`"
UNKNOWN = f"nothing says what Dock::2 writes into {{place}}; {CURE}"


def ran(folder: Path, nodes: str, *steps: str) -> tuple[str, str, str]:
    """How a scenario ends whose tree goes on with these nodes: its outcome, its end, and why."""
    tree = TREE + "".join(f"        {line}\n" for line in nodes.splitlines())
    scenario = "".join(f"    {step}\n" for step in steps)
    (folder / "main.btq").write_text(f'{tree}\nscenario "S"\n{scenario}', encoding="utf-8")
    _, out, err = run_btq("test", "main.btq", "--format", "json", cwd=folder)
    assert err == ""
    (result,) = json.loads(out)["scenarios"]
    whys = [each["why"] or (each["step"] or {}).get("happened", "") for each in result["expectations"]]
    return result["outcome"], result["ended"], result["why"] or next(filter(None, whys), "")


@pytest.mark.parametrize(
    ("nodes", "reader"),
    [
        (
            'Switch (variable = {place} case_1 = "A" case_2 = "B")\n    MoveTo\n    MoveTo\n    MoveTo',
            "Switch2::3 reads {place}",
        ),
        ('ScriptCondition (code = "(place == 3)")', "ScriptCondition::3 reads {place}"),
        ('MoveTo (_skipIf = "(place == 3)" to = "A")', "MoveTo::3 reads {place}"),
        ('MoveTo (_post = "copy := (place + 1)" to = "A")', "MoveTo::3 reads {place}"),
        ("Retry (num_attempts = {place})\n    Dock", "RetryUntilSuccessful::3 reads {place}"),
        (
            'SetBlackboard (value = {place} output_key = "copy")\nScriptCondition (code = "(copy == 3)")',
            "ScriptCondition::4 reads {copy}",
        ),
    ],
)
@pytest.mark.parametrize("given", [[], ["given Dock succeeds after 1 s"], ["given {place} = 5"]])
def test_what_needs_the_value(tmp_path: Path, nodes: str, reader: str, given: list[str]) -> None:
    assert ran(tmp_path, nodes, *given, "expect mission succeeds") == ("unknown", "", f"{reader}, and {UNKNOWN}")


def test_a_failed_skill_may_have_written(tmp_path: Path) -> None:
    nodes = 'Fallback\n    Dock Again (place = {place})\n    ScriptCondition (code = "(place == 3)")'
    steps = "given Again fails", "expect mission succeeds"
    why = "ScriptCondition::5 reads {place}, and nothing says what Again writes into {place}; " + CURE
    assert ran(tmp_path, nodes, *steps) == ("unknown", "", why)


def test_an_unknown_value_is_passed_on(tmp_path: Path) -> None:
    nodes = 'SetBlackboard (value = {place} output_key = "copy")\nMoveTo (to = {copy})\nAdjust (place = {copy})'
    assert ran(tmp_path, nodes, "expect mission succeeds") == ("passed", "succeeds", "")


@pytest.mark.parametrize(
    ("step", "outcome", "why"),
    [
        ("expect MoveTo runs 3", "unknown", f"MoveTo::3 reads its port `to`, and {UNKNOWN}"),
        ("expect MoveTo runs 3, 4", "unknown", f"MoveTo::3 reads its port `to`, and {UNKNOWN}"),
        ("expect finally {place} == 3", "unknown", UNKNOWN),
        ("expect finally not node Dock", "passed", ""),
    ],
)
def test_an_expectation_that_needs_the_value(tmp_path: Path, step: str, outcome: str, why: str) -> None:
    steps = "given {place} = 3", step
    assert ran(tmp_path, "MoveTo (to = {place})", *steps) == (outcome, "succeeds", why)


@pytest.mark.parametrize(
    ("step", "reader"),
    [
        ("given MoveTo (to = 3) fails", "MoveTo::3 reads {place}"),
        ("when MoveTo (to = 3) starts: mission halts", "MoveTo::3 reads {place}"),
        ("when {place} == 3: mission halts", "a condition after `when` reads `{place}`"),
    ],
)
def test_a_step_that_needs_the_value(tmp_path: Path, step: str, reader: str) -> None:
    steps = step, "given MoveTo takes 1 s", "expect mission succeeds"
    assert ran(tmp_path, "MoveTo (to = {place})", *steps) == ("unknown", "", f"{reader}, and {UNKNOWN}")


@pytest.mark.parametrize(
    "given",
    [
        "given Dock succeeds and writes place = 3",
        "given Dock takes 2 s and writes place = 3",
        "when Dock succeeds: {place} = 3",
    ],
)
def test_a_value_that_is_given(tmp_path: Path, given: str) -> None:
    nodes = 'ScriptCondition (code = "(place == 3)")'
    assert ran(tmp_path, nodes, given, "expect finally {place} == 3") == ("passed", "succeeds", "")


def test_a_skill_that_runs_may_write(tmp_path: Path) -> None:
    nodes = '|| (success_count = 1)\n    Dock Other (place = {other})\n    ScriptCondition (code = "(other == 3)")'
    steps = "given Other takes 1 s", "expect mission succeeds"
    why = "ScriptCondition::5 reads {other}, and nothing says what Other writes into {other}; " + CURE
    assert ran(tmp_path, nodes, *steps) == ("unknown", "", why)


@pytest.mark.parametrize(
    ("given", "result"),
    [
        ('given {seen} = "A"', ("passed", "succeeds", "")),
        (
            "given Seen answers true",
            (
                "unknown",
                "",
                "Reads reads {seen}, and nothing says what Seen::3 writes into {seen}; write `given {seen} = …`",
            ),
        ),
    ],
)
def test_a_condition_keeps_the_reading_that_is_given(tmp_path: Path, given: str, result: tuple[str, str, str]) -> None:
    nodes = "Seen (where = {seen})\nScriptCondition Reads (code = \"(seen == 'A')\")"
    assert ran(tmp_path, nodes, "given Seen answers true", given, "expect mission succeeds") == result


@pytest.mark.parametrize(
    ("action", "result"),
    [
        ("\n    on violation halt", ("passed", "")),
        ("", ("unknown", "nothing says what Sense::2 writes into {@edge}; write `given edge = …`")),
    ],
)
def test_a_value_initially_is_that_of_an_entry_only_where_a_guard_reads_it(
    tmp_path: Path, action: str, result: tuple[str, str]
) -> None:
    (tmp_path / "main.btq").write_text(
        "signal edge : m from {@edge} initially 3 m\n"
        f'QualityReq far : safety "Far"\n    mission keeps edge >= 1 m{action}\n'
        "Condition Sense\n    output edge : double\nBehaviorTree Main\n    ->\n        Sense (edge = {@edge})\n"
        'scenario "S"\n    given Sense answers true\n    expect far\n',
        encoding="utf-8",
    )
    _, out, _ = run_btq("test", "main.btq", "--format", "json", cwd=tmp_path)
    (scenario,) = json.loads(out)["scenarios"]
    assert (scenario["outcome"], scenario["expectations"][0]["why"]) == result


def test_an_endless_run_is_noticed(tmp_path: Path) -> None:
    nodes = "KeepRunningUntilFailure\n    Dock (place = {place})"
    assert ran(tmp_path, nodes, "expect mission does not end")[:2] == ("passed", "does not end")


@pytest.mark.parametrize("read", ["seen_at", "{seen}"])
def test_the_cure_of_a_reading_is_the_name_that_reads_it(tmp_path: Path, read: str) -> None:
    tree = f"signal seen_at : text from {{seen}}\n{TREE}        Seen (where = {{seen}})\n"
    scenario = f'scenario "S"\n    given Seen answers true\n    expect finally {read} == "A"\n'
    (tmp_path / "main.btq").write_text(tree + scenario, encoding="utf-8")
    _, out, _ = run_btq("test", "main.btq", cwd=tmp_path)
    cure = f"given {read} = …"
    assert f"nothing says what Seen::3 writes into {{seen}}; write `{cure}`" in out
    given = cure.replace("…", '"A"')
    (tmp_path / "main.btq").write_text(tree + scenario.replace("expect", f"{given}\n    expect"), encoding="utf-8")
    code, _, _ = run_btq("test", "main.btq", cwd=tmp_path)
    assert code == 0
