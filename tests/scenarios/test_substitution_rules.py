"""Scenarios as substitution rules of the engine, and those that rules cannot say.

That the engine does with them what the scenario says is in `engine/test_engine_rules.py`.
"""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from in_process import run_btq

TREE = """\
<root BTCPP_format="4" main_tree_to_execute="Deliver">
  <BehaviorTree ID="Deliver">
    <Sequence>
      <MoveTo location="A"/>
      <ReactiveFallback>
        <Condition ID="BatteryFull"/>
        <MoveTo location="{station}"/>
      </ReactiveFallback>
      <RetryUntilSuccessful num_attempts="4">
        <Dock place="{place}"/>
      </RetryUntilSuccessful>
    </Sequence>
  </BehaviorTree>
</root>
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A tree without scenarios."""
    (tmp_path / "tree.xml").write_text(TREE, encoding="utf-8")
    return tmp_path


def write_case(folder: Path, *lines: str) -> None:
    steps = "".join(f"    {line}\n" for line in lines)
    case = f'include "tree.xml"\n\nscenario "it"\n{steps}    expect mission succeeds\n'
    (folder / "cases.btq").write_text(case, encoding="utf-8")


def test_what_test_nodes_do(folder: Path) -> None:
    write_case(
        folder,
        'given {station} = "B"',
        "given MoveTo takes 20 s",
        "given BatteryFull answers true",
        "given Dock fails 3 times, then succeeds",
        'given every Dock skips and writes place = "dock", docked = true',
    )
    written = "set the entry station = 'B' before the first tick\nset the entry btq_3 = 0.0 before the first tick\n"
    assert run_btq("test", "--rules", "rules.json", cwd=folder) == (0, "wrote rules.json\n", written)
    rules = json.loads((folder / "rules.json").read_text(encoding="utf-8"))
    assert rules == {
        "TestNodeConfigs": {
            "MoveTo::2": {"return_status": "SUCCESS", "async_delay": 20000},
            "BatteryFull::4": {"return_status": "SUCCESS"},
            "MoveTo::5": {"return_status": "SUCCESS", "async_delay": 20000},
            "Dock::7": {
                "return_status_script": "@btq_3 += 1; (@btq_3 <= 3) ? FAILURE : (SUCCESS)",
                "post_script": "place := 'dock'; docked := true",
            },
        },
        "SubstitutionRules": {name: name for name in ("MoveTo::2", "BatteryFull::4", "MoveTo::5", "Dock::7")},
    }


def test_a_condition_that_nobody_answers_keeps_its_node(folder: Path) -> None:
    write_case(folder, "given Dock does not end")
    remark = "no rule for BatteryFull::4: nothing says what it answers\n"
    assert run_btq("test", "--rules", "rules.json", cwd=folder) == (0, "wrote rules.json\n", remark)
    rules = json.loads((folder / "rules.json").read_text(encoding="utf-8"))
    assert [*rules["SubstitutionRules"]] == ["MoveTo::2", "MoveTo::5", "Dock::7"]
    assert rules["TestNodeConfigs"]["Dock::7"] == {"return_status": "RUNNING"}


@pytest.mark.parametrize(
    ("lines", "target", "reason"),
    [
        (
            ["given Dock fails"],
            "4.6",
            "4.6 reads rules of a file from memory that it has freed; use --target 4.8",
        ),
        (
            ["given Dock fails once, then succeeds"],
            "4.8",
            "the results of Dock::7 differ, which takes a `return_status_script`, new in 4.10; the rules are for 4.8",
        ),
        (["when 3 s have passed: mission halts"], "4.10", "rules cannot say what a `when` changes"),
        (
            ["given Dock fails once, then succeeds after 3 s"],
            "4.10",
            "`takes` of Dock::7 differs from one activation to the next",
        ),
        (
            ['given MoveTo (location = "A") fails'],
            "4.10",
            "what is given of MoveTo::5 depends on the entry at its port `location`",
        ),
        (
            ["given BatteryFull answers false, true"],
            "4.10",
            "BatteryFull::4 is asked at every tick, and the engine ticks more often than the model",
        ),
        (['given Dock succeeds and writes place = "it\'s"'], "4.10", "a script cannot have the text `it's`"),
        (["given Dork fails"], "4.10", "line 4: unknown node `Dork`; did you mean `Dock`?"),
    ],
)
def test_what_rules_cannot_say(folder: Path, lines: list[str], target: str, reason: str) -> None:
    write_case(folder, *lines)
    refused = run_btq("test", "--rules", "rules.json", "--target", target, cwd=folder)
    assert refused == (2, "", f"btq test: --rules rules.json: {reason}\n")
    assert not (folder / "rules.json").exists()


def test_a_rule_for_one_node_must_not_be_one_for_another(folder: Path) -> None:
    named = TREE.replace('<MoveTo location="A"/>', '<MoveTo name="MoveTo" location="A"/>')
    (folder / "tree.xml").write_text(named, encoding="utf-8")
    write_case(folder, "given every MoveTo takes 1 s")
    assert run_btq("test", "--rules", "rules.json", cwd=folder)[0] == 0
    (folder / "tree.xml").write_text(named.replace("Dock ", 'Dock name="MoveTo" '), encoding="utf-8")
    code, _, err = run_btq("test", "--rules", "rules.json", cwd=folder)
    assert code == 2
    reason = "a rule for `MoveTo` is one for several nodes; give them names of their own"
    assert err == f"btq test: --rules rules.json: {reason}\n"


def test_rules_are_of_one_scenario(folder: Path) -> None:
    write_case(folder, "given Dock fails")
    with open(folder / "cases.btq", "a", encoding="utf-8") as cases:
        cases.write('\nscenario "another"\n    expect mission succeeds\n')
    refused = (2, "", "btq test: --rules rules.json: 2 scenarios; choose one with -k\n")
    assert run_btq("test", "--rules", "rules.json", cwd=folder) == refused
