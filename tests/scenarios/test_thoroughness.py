"""What scenarios have not met, and which changes of a tree they do not notice."""

from __future__ import annotations

import html
import json
import re
from pathlib import Path

import pytest
from in_process import run_btq
from json_schema import violations

SCHEMA = json.loads(
    (Path(__file__).parents[2] / "btq_lang/scenarios/scenarios.schema.json").read_text(encoding="utf-8")
)
ROW = re.compile(r"<tr>(.*?)</tr>", re.DOTALL)
CELL = re.compile(r"<t[hd][^>]*>(.*?)</t[hd]>", re.DOTALL)
MISSION = """\
QualityReq swift : performance-efficiency.time-behaviour "Soon there"
    takes at most 10 s
    on violation fail

Condition Open
Action Go
    input to : string
Action Ring

BehaviorTree Enter
    R->
        Open
        IfThenElse
            ScriptCondition(code = "@floor == 2")
            Go(to = "lift")
                satisfies swift
            Switch2(variable = "{@door}", case_1 = "A", case_2 = "B")
                Go(to = "A", _skipIf = "@floor == 3")
                Go(to = "B")
                Ring

BehaviorTree Leave
    Ring
"""
CASES = """\
include "mission.btq"

given Open answers true
given {@door} = "A"

scenario "By lift" of Enter
    given {@floor} = 2
    given Go takes 12 s
    expect mission fails at least 1 per run
    expect swift violated

scenario "Door A" of Enter
    given {@floor} = 1
    given Go takes 5 s
    when 2 s have passed: Open answers false
    expect mission fails at least 1 per run
    expect Go runs "A"
"""
SKIPPED = """
scenario "Nobody is there" of Enter
    given {@floor} = 3
    expect finally {@floor} == 3
"""
PASSED = """\
passed  By lift (cases.btq:6): fails after 10 s
passed  Door A (cases.btq:12): fails after 2 s
2 scenarios: 2 passed
"""
COVERAGE = """\
coverage: 14 of 34 outcomes of 10 nodes
mission.btq
    11  ReactiveSequence   never succeeds
    13  IfThenElse         never succeeds, is skipped
    15  Go                 never succeeds, fails
    15  guard swift of Go  never lets it pass
    17  Switch2            never succeeds, fails, is skipped, case "B", default
    18  Go                 never succeeds, fails, is skipped
    19  Go                 never succeeds, fails, is halted
    20  Ring               never succeeds, fails, is halted
    22  Leave              runs in no scenario
"""
MUTANTS = """\
mutants: 9 of 15 noticed
mission.btq
    11  ReactiveSequence  children 1 and 2 (Open, IfThenElse) exchanged
    15  Go                to="A" instead of "lift"
    17  Switch2           children 2 and 3 (Go, Ring) exchanged
    18  Go                _skipIf="@floor == 2" instead of "@floor == 3"
    18  Go                _skipIf="@floor == 4" instead of "@floor == 3"
    19  Go                to="lift" instead of "B" (not reached)
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A mission with two scenarios."""
    monkeypatch.setenv("NO_COLOR", "1")
    (tmp_path / "mission.btq").write_text(MISSION, encoding="utf-8")
    (tmp_path / "cases.btq").write_text(CASES, encoding="utf-8")
    return tmp_path


def test_outcomes_that_no_scenario_has_met(folder: Path) -> None:
    assert run_btq("test", "--coverage", cwd=folder) == (0, PASSED + COVERAGE, "")


def test_another_scenario_meets_more(folder: Path) -> None:
    with open(folder / "cases.btq", "a", encoding="utf-8") as cases:
        cases.write(SKIPPED)
    _, out, _ = run_btq("test", "--coverage", cwd=folder)
    assert out.splitlines()[4:] == [
        "coverage: 18 of 34 outcomes of 10 nodes",
        "mission.btq",
        *(line.replace(", is skipped", "") for line in COVERAGE.splitlines()[3:]),
    ]


def test_a_part_of_the_scenarios(folder: Path) -> None:
    _, out, _ = run_btq("test", "-k", "lift", "--coverage", cwd=folder)
    assert out.splitlines()[2] == "coverage: 7 of 34 outcomes of 10 nodes"


def test_changes_that_no_scenario_notices(folder: Path) -> None:
    assert run_btq("test", "--mutants", cwd=folder) == (0, PASSED + MUTANTS, "")
    both = run_btq("test", "--coverage", "--mutants", "--jobs", "2", cwd=folder)
    assert both == (0, PASSED + COVERAGE + MUTANTS, "")


def test_a_sample_of_the_changes(folder: Path) -> None:
    _, out, _ = run_btq("test", "--mutants", "4", cwd=folder)
    assert out.splitlines()[3:] == [
        "mutants: 3 of 4 noticed, an even sample of 15",
        "mission.btq",
        "    11  ReactiveSequence  children 1 and 2 (Open, IfThenElse) exchanged",
    ]
    refused = "btq test: --mutants -1: expected how many at most, or no number for all\n"
    assert run_btq("test", "--mutants", "-1", cwd=folder) == (2, "", refused)


def test_the_whole_for_programs(folder: Path) -> None:
    run_btq("test", "--coverage", "--mutants", "-o", "out.json", cwd=folder)
    document = json.loads((folder / "out.json").read_text(encoding="utf-8"))
    assert [*violations(document, SCHEMA)] == []
    nodes = {(node["line"], node["column"], node["node"]): node["outcomes"] for node in document["coverage"]["nodes"]}
    assert nodes[13, 9, "IfThenElse"] == [
        {"outcome": "succeeds", "scenarios": 0},
        {"outcome": "fails", "scenarios": 1},
        {"outcome": "is skipped", "scenarios": 0},
        {"outcome": "is halted", "scenarios": 1},
        {"outcome": "then", "scenarios": 1},
        {"outcome": "else", "scenarios": 1},
    ]
    # Where a node cannot be halted it is not asked for, nor what never fails to fail.
    assert [each["outcome"] for each in nodes[12, 9, "Open"]] == ["succeeds", "fails"]
    assert document["coverage"]["unused"] == [{"file": "mission.btq", "line": 22, "column": 1, "tree": "Leave"}]
    assert document["mutants"]["number"] == len(document["mutants"]["mutants"]) == 15
    mutants = [tuple(each.values())[1:] for each in document["mutants"]["mutants"]]
    assert mutants == [
        (11, 5, "ReactiveSequence", "children 1 and 2 (Open, IfThenElse) exchanged", True, None),
        (12, 9, "Open", "inverted", True, "By lift"),
        (13, 9, "IfThenElse", "children 2 and 3 (Go, Switch2) exchanged", True, "By lift"),
        (14, 13, "ScriptCondition", "inverted", True, "By lift"),
        (14, 13, "ScriptCondition", 'code="@floor == 1" instead of "@floor == 2"', True, "By lift"),
        (14, 13, "ScriptCondition", 'code="@floor == 3" instead of "@floor == 2"', True, "By lift"),
        (15, 13, "Go", 'to="A" instead of "lift"', True, None),
        (15, 13, "guard swift of Go", "left out", True, "By lift"),
        (17, 13, "Switch2", "children 1 and 2 (Go, Go) exchanged", True, "Door A"),
        (17, 13, "Switch2", "children 2 and 3 (Go, Ring) exchanged", True, None),
        (18, 17, "Go", 'to="B" instead of "A"', True, "Door A"),
        (18, 17, "Go", '_skipIf="!(@floor == 3)" instead of "@floor == 3"', True, "Door A"),
        (18, 17, "Go", '_skipIf="@floor == 2" instead of "@floor == 3"', True, None),
        (18, 17, "Go", '_skipIf="@floor == 4" instead of "@floor == 3"', True, None),
        (19, 17, "Go", 'to="lift" instead of "B"', False, None),
    ]


def test_the_whole_as_a_page(folder: Path) -> None:
    assert run_btq("test", "--coverage", "--mutants", "-o", "out.html", cwd=folder) == (0, "", "")
    rows = ROW.findall((folder / "out.html").read_text(encoding="utf-8"))
    cells = [[html.unescape(cell) for cell in CELL.findall(row)] for row in rows]
    assert cells[:4] == [
        ["Scenario", "Where", "Result"],
        ["By lift", "cases.btq:6", '<span class="verdict satisfied">passed</span>'],
        ["Door A", "cases.btq:12", '<span class="verdict satisfied">passed</span>'],
        ["Line", "Node", "No scenario has met", "Met"],
    ]
    assert cells[6] == ["13", "IfThenElse", "succeeds, is skipped", "fails, is halted, then, else"]
    assert cells[14:18] == [
        ["22", "Leave", "runs in no scenario", ""],
        ["Line", "Node", "No scenario notices", "Noticed by"],
        ["11", "ReactiveSequence", "children 1 and 2 (Open, IfThenElse) exchanged", ""],
        ["12", "Open", "", "inverted: By lift"],
    ]
    assert len(cells) == 16 + 15


def test_a_page_shows_how_a_scenario_failed(folder: Path) -> None:
    cases = CASES.replace("Go takes 12 s", "Go takes 2 s")
    (folder / "cases.btq").write_text(cases, encoding="utf-8")
    assert run_btq("test", "-k", "lift", "-o", "out.html", cwd=folder) == (1, "", "")
    page = (folder / "out.html").read_text(encoding="utf-8")
    assert "<p>1 scenario: 1 failed</p>" in page
    assert "<pre>line 9: expect mission fails at least 1 per run\n" in page


XML = """\
<root BTCPP_format="4" main_tree_to_execute="Deliver">
  <BehaviorTree ID="Deliver">
    <Sequence>
      <AlwaysSuccess/>
      <SubTree ID="Visit" station="A"/>
      <SubTree ID="Visit" station="E"/>
      <RetryUntilSuccessful num_attempts="3">
        <Dock/>
      </RetryUntilSuccessful>
    </Sequence>
  </BehaviorTree>
  <BehaviorTree ID="Visit">
    <MoveTo location="{station}"/>
  </BehaviorTree>
</root>
"""
XML_CASES = """\
include "deliver.xml"

scenario "Docking is difficult"
    given Dock fails twice, then succeeds
    expect mission succeeds
    expect every MoveTo runs "A", "E"
"""


def test_plain_xml_with_a_tree_that_runs_twice(folder: Path) -> None:
    (folder / "deliver.xml").write_text(XML, encoding="utf-8")
    (folder / "xml.btq").write_text(XML_CASES, encoding="utf-8")
    code, out, err = run_btq("test", "xml.btq", "--coverage", "--mutants", cwd=folder)
    assert (code, err) == (0, "")
    assert out.splitlines()[2:] == [
        "coverage: 8 of 13 outcomes of 7 nodes",
        "deliver.xml",
        "     3  Sequence              never fails",
        "     5  Visit                 never fails",
        "     6  Visit                 never fails",
        "     7  RetryUntilSuccessful  never fails",
        "    13  MoveTo                never fails",
        "mutants: 5 of 8 noticed",
        "deliver.xml",
        "     3  Sequence              children 1 and 2 (AlwaysSuccess, Visit) exchanged",
        "     3  Sequence              children 3 and 4 (Visit, RetryUntilSuccessful) exchanged",
        '     7  RetryUntilSuccessful  num_attempts="4" instead of "3"',
    ]


def test_a_scenario_that_fails_notices_nothing(folder: Path) -> None:
    (folder / "deliver.xml").write_text(XML, encoding="utf-8")
    (folder / "xml.btq").write_text(XML_CASES.replace('"E"', '"F"'), encoding="utf-8")
    code, out, err = run_btq("test", "xml.btq", "--mutants", cwd=folder)
    assert (code, err) == (1, "")
    assert out.splitlines()[-10:] == [
        "mutants: 0 of 8 noticed",
        "deliver.xml",
        "     3  Sequence              children 1 and 2 (AlwaysSuccess, Visit) exchanged (not reached)",
        "     3  Sequence              children 2 and 3 (Visit, Visit) exchanged (not reached)",
        "     3  Sequence              children 3 and 4 (Visit, RetryUntilSuccessful) exchanged (not reached)",
        '     5  Visit                 station="E" instead of "A" (not reached)',
        '     6  Visit                 station="A" instead of "E" (not reached)',
        "     7  RetryUntilSuccessful  left out (not reached)",
        '     7  RetryUntilSuccessful  num_attempts="2" instead of "3" (not reached)',
        '     7  RetryUntilSuccessful  num_attempts="4" instead of "3" (not reached)',
    ]
