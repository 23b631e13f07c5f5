"""Scenarios that verify a requirement: they are among its tests in each format of the overview."""

from __future__ import annotations

import csv
import io
import json
import re
from html import unescape
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
from evidence_logs import btlog, rows
from in_process import run_btq

import btq_lang as btq

MISSION = """\
hazard H1 "The arm hits somebody"
QualityReq quick : safety "In time"
    Move takes at most 30 s
    mitigates H1
QualityReq tested : safety
    Move takes at least 1 ms
    verified by test
QualityReq named : safety
    Move takes at most 9 s
    verified by test "It  arrives", review "R-3"
QualityReq calm : safety "Nobody is startled"
QualityReq bare : safety
    Move takes at most 5 min
    verified by test
Action Move
BehaviorTree Main
    Move satisfies calm
"""
SCENARIOS = """\
include "../mission.btq"

scenario "It arrives" verifies quick, named, PLANT_1
    expect mission succeeds

scenario "It takes its time" verifies quick, tested, calm
    given Move takes 20 s
    expect mission succeeds
"""
OTHER = """\
QualityReq quick
    Move takes at most 1 s
Action Move
BehaviorTree Main
    Move
"""
MOVE_XML = (
    '<root BTCPP_format="4"><BehaviorTree ID="Main" _fullpath=""><Move name="Move" _uid="1"/></BehaviorTree></root>'
)
UNKNOWN = {"expects": None, "outcome": None, "changed": False}  # what came of a scenario


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "tests").mkdir()
    (tmp_path / "mission.btq").write_text(MISSION, encoding="utf-8")
    (tmp_path / "tests/arrival.btq").write_text(SCENARIOS, encoding="utf-8")
    (tmp_path / "btq.toml").write_text('[requirements]\nimport = ["plant.csv"]\n', encoding="utf-8")
    (tmp_path / "plant.csv").write_text("id,title\nPLANT_1,It comes back\n", encoding="utf-8")
    return tmp_path


def trace(folder: Path, *arguments: str) -> str:
    code, out, err = run_btq("trace", *arguments, cwd=folder)
    assert (code, err) == (0, "")
    return out


def as_json(folder: Path, *arguments: str) -> dict[str, Any]:
    document: dict[str, Any] = json.loads(trace(folder, *arguments, "--format", "json"))
    return document


def titles(folder: Path, *arguments: str) -> dict[str, list[str]]:
    """The titles of the scenarios of each requirement, by its name and where it is defined."""
    return {
        f"{each['id']} {each['at']['path']}": [way["id"] for way in each["verified_by"] if way["at"] is not None]
        for each in as_json(folder, *arguments)["requirements"]
    }


TABLE = """\
Hazard or requirement of others               Mitigated or refined by
--------------------------------------------  ---------------------------------------------------------------------
H1, mission.btq:1                             quick: monitored; scenario "It arrives", scenario "It takes its time"
  The arm hits somebody
PLANT_1, plant.csv:2                          nothing
  It comes back
  scenario "It arrives", tests/arrival.btq:3

Requirement                                     Holds for             How
----------------------------------------------  --------------------  -------------------------------------------------
quick, mission.btq:2                            Move, mission.btq:3   monitored
  In time                                                             scenario "It arrives", tests/arrival.btq:3
  Move takes at most 30 s                                             scenario "It takes its time", tests/arrival.btq:6
  mitigates H1
  for safety
tested, mission.btq:5                           Move, mission.btq:6   by test
  Move takes at least 1 ms                                            scenario "It takes its time", tests/arrival.btq:6
  verified by test
  for safety
named, mission.btq:8                            Move, mission.btq:9   by review R-3 and test
  Move takes at most 9 s                                              scenario "It arrives", tests/arrival.btq:3
  verified by test "It  arrives", review "R-3"
  for safety
calm, mission.btq:11                            Move, mission.btq:17  by test
  Nobody is startled                                                  scenario "It takes its time", tests/arrival.btq:6
  for safety
bare, mission.btq:12                            Move, mission.btq:13  by test
  Move takes at most 5 min
  verified by test
  for safety
"""


@pytest.mark.parametrize("path", [".", "mission.btq"])
def test_the_table(folder: Path, path: str) -> None:
    table = trace(folder, path)
    assert table.startswith(TABLE)
    assert " ".join(table.split()).endswith(
        "0 not at all. 2 scenarios verify 4 requirements; btq trace runs no scenario, btq test does."
    )


def test_json(folder: Path) -> None:
    document = as_json(folder, "mission.btq")
    assert document["files"] == ["mission.btq"]
    arrives = {"path": "tests/arrival.btq", "line": 3, "column": 10}
    takes_time = {"method": "test", "id": "It takes its time", "at": {**arrives, "line": 6}, **UNKNOWN}
    assert {each["id"]: each["verified_by"] for each in document["requirements"]} == {
        "quick": [{"method": "test", "id": "It arrives", "at": arrives, **UNKNOWN}, takes_time],
        "tested": [takes_time],
        "named": [
            {"method": "review", "id": "R-3", "at": None},
            {"method": "test", "id": "It arrives", "at": arrives, **UNKNOWN},
        ],
        "calm": [takes_time],
        "bare": [{"method": "test", "id": None, "at": None}],
    }
    assert document["external"] == [
        {
            **{"key": "x1", "id": "PLANT_1", "title": "It comes back", "status": "", "url": "", "requirements": []},
            "at": {"path": "plant.csv", "line": 2, "column": 1},
            "scenarios": [{"id": "It arrives", "at": arrives, **UNKNOWN}],
        }
    ]


def test_csv(folder: Path) -> None:
    written = [*csv.DictReader(io.StringIO(trace(folder, "--format", "csv")))]
    columns = ("requirement", "external", "scenario", "source", "line")
    assert [tuple(row[name] for name in columns) for row in written if row["kind"] == "scenario"] == [
        ("quick", "", "It arrives", "tests/arrival.btq", "3"),
        ("quick", "", "It takes its time", "tests/arrival.btq", "6"),
        ("tested", "", "It takes its time", "tests/arrival.btq", "6"),
        ("named", "", "It arrives", "tests/arrival.btq", "3"),
        ("calm", "", "It takes its time", "tests/arrival.btq", "6"),
        ("", "PLANT_1", "It arrives", "tests/arrival.btq", "3"),
    ]
    assert {row["requirement"]: row["verified_by"] for row in written if row["requirement"]} == {
        "quick": "test It arrives, test It takes its time",
        "tested": "test It takes its time",
        "named": "review R-3, test It arrives",
        "calm": "test It takes its time",
        "bare": "test",
    }
    assert {row["kind"] for row in written} == {"requirement", "scenario", "hazard"}


def test_markdown(folder: Path) -> None:
    markdown = trace(folder, "--format", "markdown")
    arrives, takes_time = 'scenario "It arrives"', 'scenario "It takes its time"'
    assert f"| **quick** monitored; {arrives}, {takes_time} |\n" in markdown
    assert f"| monitored<br>{arrives} (tests/arrival.btq:3)<br>{takes_time} (tests/arrival.btq:6) |" in markdown
    assert f"| by review R-3 and test<br>{arrives} (tests/arrival.btq:3) |" in markdown
    assert "2 scenarios verify 4 requirements; btq trace runs no scenario, btq test does.\n" in markdown


def test_the_page(folder: Path) -> None:
    page = unescape(re.sub(r"\s*\n\s*", "", trace(folder, "--format", "html")))
    arrives = f'<li>scenario "It arrives" {at(3)}</li>'
    takes_time = f'<li>scenario "It takes its time" {at(6)}</li>'
    way = '<ul><li><span class="way monitored">monitored</span></li></ul>'
    assert f'<td>{way}<ul class="scenarios">{arrives}{takes_time}</ul></td>' in page
    assert '<small>monitored; scenario "It arrives", scenario "It takes its time"</small>' in page
    assert '<li>scenario "It arrives", tests/arrival.btq:3</li>' in page  # of PLANT_1
    assert "calm; Nobody is startled; by test" in page  # what a screen reader says of the box
    assert "2 scenarios verify 4 requirements; btq trace runs no scenario, btq test does." in page


def at(line: int) -> str:
    return f'<small class="at" title="tests/arrival.btq:{line}:10">arrival.btq:{line}</small>'


def test_needs(folder: Path) -> None:
    needs = json.loads(trace(folder, "--format", "needs-json"))["versions"][""]["needs"]
    assert needs["tested"]["content"].splitlines() == [
        "* ``Move takes at least 1 ms``",
        "* ``verified by test``",
        '* ``scenario "It takes its time"``, tests/arrival.btq:6',
    ]


def test_a_scenario_is_the_test_that_was_asked_for(folder: Path) -> None:
    (folder / "run.btlog").write_bytes(btlog(MOVE_XML, rows("0 1R 20 1S")))
    document = as_json(folder, "--evidence", "run.btlog")
    names = {each["key"]: each["id"] for each in document["requirements"]}
    assert [names[key] for key in document["gaps"]["requirements_without_verdicts"]] == ["bare"]
    selected = as_json(folder, "--evidence", "run.btlog", "--state", "without verdict")
    assert [each["id"] for each in selected["requirements"]] == ["bare"]
    selected = as_json(folder, "--evidence", "run.btlog", "--state", "reviewed")
    assert [each["id"] for each in selected["requirements"]] == ["tested", "named", "calm", "bare"]


@pytest.mark.parametrize("mission", [(), ("--mission", "mission.btq")])
def test_verdicts_name_scenarios_as_tests(folder: Path, mission: tuple[str, ...]) -> None:
    (folder / "run.btlog").write_bytes(btlog(MOVE_XML, rows("0 1R 20 1S")))
    _, out, _ = run_btq("verify", "run.btlog", *mission, "--format", "json", cwd=folder)
    verified_by = {each["id"]: each.get("verified_by") for each in json.loads(out)["requirements"]}
    assert verified_by == {
        "quick": ["test It arrives", "test It takes its time"],
        "tested": ["test It takes its time"],
        "named": ["review R-3", "test It arrives"],
        "calm": ["test It takes its time"],
        "bare": ["test"],
    }
    _, out, _ = run_btq("verify", "run.btlog", *mission, "--format", "junit", cwd=folder)
    properties = {
        case.attrib["name"]: [
            each.attrib["value"]
            for each in case.iterfind("properties/property")
            if each.attrib["name"] == "verified_by"
        ]
        for case in ElementTree.fromstring(out).iter("testcase")
    }
    assert properties == {name: [",".join(ways or ())] for name, ways in verified_by.items()}


# ---- what came of them ------------------------------------------------------------------------------------------


@pytest.fixture
def tested(folder: Path) -> Path:
    """With the results of the scenarios, of which `It arrives` fails, one that changed since, and one that is new."""
    text = (folder / "tests/arrival.btq").read_text(encoding="utf-8")
    text = text.replace("expect mission succeeds", "expect mission fails", 1)
    text += '\nscenario "It is slow" verifies quick\n    given Move takes 40 s\n    expect quick violated\n'
    (folder / "tests/arrival.btq").write_text(text, encoding="utf-8")
    assert run_btq("test", ".", "-o", "t.json", cwd=folder)[0] == 1
    text = text.replace("    expect mission fails", "        expect   mission  fails")
    text = text.replace("given Move takes 40 s", "given Move takes 50 s")
    text += '\nscenario "It is late" verifies quick\n    given Move takes 20 s\n    expect quick\n'
    (folder / "tests/arrival.btq").write_text(text, encoding="utf-8")
    return folder


def test_results_beside_the_scenarios(tested: Path) -> None:
    document = as_json(tested, "mission.btq", "--evidence", "t.json")
    (quick,) = (each for each in document["requirements"] if each["id"] == "quick")
    assert [(way["id"], way["outcome"], way["changed"], way["expects"]) for way in quick["verified_by"]] == [
        ("It arrives", "failed", False, None),
        ("It takes its time", "passed", False, None),
        ("It is slow", "passed", True, "violated"),
        ("It is late", "not run", False, None),
    ]
    assert quick["evidence"] is None
    names = {each["key"]: each["id"] for each in (*document["requirements"], *document["external"])}
    gaps = document["gaps"]["scenarios_not_passed"]
    assert [(names[each["requirement"]], each["scenario"], each["outcome"]) for each in gaps] == [
        ("quick", "It arrives", "failed"),
        ("quick", "It is late", "not run"),
        ("named", "It arrives", "failed"),
        ("PLANT_1", "It arrives", "failed"),
    ]
    assert document["external"][0]["scenarios"][0]["outcome"] == "failed"


def test_results_in_every_format(tested: Path) -> None:
    slow = 'scenario "It is slow" (passed, changed since, expects it violated)'
    arrives = 'scenario "It arrives" (failed)'
    came = "4 scenarios verify 4 requirements; 1 failed, 1 not run, 2 passed."
    texts = {
        form: trace(tested, "mission.btq", "--evidence", "t.json", "--format", form)
        for form in ("table", "markdown", "html", "needs-json", "csv")
    }
    table = texts["table"]
    assert f"\nScenarios that have not passed\n  quick, mission.btq:2: {arrives}\n" in table
    assert came in " ".join(table.split())
    markdown = texts["markdown"]
    assert f"* Scenarios that have not passed: quick (mission.btq:2): {arrives}, " in markdown
    assert slow in markdown
    assert came in markdown
    page = unescape(texts["html"])
    assert slow in page
    assert "Scenarios that have not passed (4)" in page
    assert came in page
    assert slow in json.loads(texts["needs-json"])["versions"][""]["needs"]["quick"]["content"]
    rows = [*csv.DictReader(io.StringIO(texts["csv"]))]
    columns = ("scenario", "result", "suspect", "verdict")
    of_quick = [row for row in rows if row["kind"] == "scenario" and row["requirement"] == "quick"]
    assert [tuple(row[name] for name in columns) for row in of_quick] == [
        ("It arrives", "failed", "", ""),
        ("It takes its time", "passed", "", ""),
        ("It is slow", "passed", "yes", "violated"),
        ("It is late", "not run", "", ""),
    ]
    lacking = [(row["requirement"], row["external"]) for row in rows if row["kind"] == "scenario not passed"]
    assert lacking == [("quick", ""), ("quick", ""), ("named", ""), ("", "PLANT_1")]


def test_what_failed_or_expects_a_violation_is_no_evidence(tested: Path) -> None:
    violated = 'include "mission.btq"\nscenario "It hurries" verifies bare\n    expect bare violated\n'
    (tested / "more.btq").write_text(violated, encoding="utf-8")
    text = (tested / "mission.btq").read_text(encoding="utf-8")
    (tested / "mission.btq").write_text(text.replace(', review "R-3"', ""), encoding="utf-8")
    (tested / "run.btlog").write_bytes(btlog(MOVE_XML, rows("0 1R 20 1S")))
    arguments = ("mission.btq", "--evidence", "run.btlog")
    for more, lacking in (((), ["bare"]), (("--evidence", "t.json"), ["named", "bare"])):
        document = as_json(tested, *arguments, *more, "--state", "without verdict")
        assert [each["id"] for each in document["requirements"]] == lacking


def test_results_of_another_version_are_not_read(tested: Path) -> None:
    (tested / "t.json").write_text('{"format": "btq-scenarios", "version": 7}', encoding="utf-8")
    code, _, err = run_btq("trace", "mission.btq", "--evidence", "t.json", cwd=tested)
    assert (code, err.startswith("btq trace: t.json: expected btq-verdicts")) == (2, True)


def test_a_test_that_is_not_the_title_of_a_scenario_is_named(folder: Path) -> None:
    why = 'no scenario has the title "It arives"'
    assert why not in trace(folder, "mission.btq")
    text = (folder / "mission.btq").read_text(encoding="utf-8")
    text = text.replace('"It  arrives"', '"It arives"').replace("verified by test\nA", 'verified by test "TC-1"\nA')
    (folder / "mission.btq").write_text(text, encoding="utf-8")
    assert why in " ".join(trace(folder, "mission.btq").split())
    assert why in trace(folder, "mission.btq", "--format", "markdown")
    assert why in unescape(trace(folder, "mission.btq", "--format", "html"))
    assert "TC-1" in trace(folder, "mission.btq")
    assert 'title "TC-1"' not in trace(folder, "mission.btq")  # which no scenario verifies


# ---- which scenarios count --------------------------------------------------------------------------------------


def test_those_of_a_requirement_with_the_same_name_in_another_mission_do_not(folder: Path) -> None:
    (folder / "other.btq").write_text(OTHER, encoding="utf-8")
    assert titles(folder)["quick other.btq"] == []
    assert titles(folder)["quick mission.btq"] == ["It arrives", "It takes its time"]
    assert titles(folder, "other.btq") == {"quick other.btq": []}
    waves = 'include "../other.btq"\nscenario "It waves" verifies quick\n    expect mission succeeds\n'
    (folder / "tests/waving.btq").write_text(waves, encoding="utf-8")
    assert titles(folder, "other.btq") == {"quick other.btq": ["It waves"]}
    assert titles(folder)["quick mission.btq"] == ["It arrives", "It takes its time"]


def test_those_in_the_mission_itself_and_in_what_it_includes_do(tmp_path: Path) -> None:
    scenario = 'scenario "{}" verifies quick\n    expect mission succeeds\n'
    (tmp_path / "parts.btq").write_text(OTHER + scenario.format("Part"), encoding="utf-8")
    main = 'include "parts.btq"\nBehaviorTree Whole\n    SubTree Main\n'
    (tmp_path / "whole.btq").write_text(main + scenario.format("Whole"), encoding="utf-8")
    assert titles(tmp_path, "whole.btq") == {"quick parts.btq": ["Part", "Whole"]}
    assert titles(tmp_path, ".") == {"quick parts.btq": ["Part", "Whole"]}


def test_without_a_project_file_those_beside_the_mission_do(folder: Path) -> None:
    (folder / "btq.toml").unlink()
    assert titles(folder, "mission.btq")["quick mission.btq"] == []
    (folder / "arrival.btq").write_text(SCENARIOS.replace("../", "").replace(", PLANT_1", ""), encoding="utf-8")
    assert titles(folder, "mission.btq")["quick mission.btq"] == ["It arrives", "It takes its time"]


def test_a_file_of_scenarios_that_cannot_be_read_is_none(folder: Path) -> None:
    (folder / "tests/broken.btq").write_bytes(b'include "../mission.btq"\nscenario "S" verifies quick\n\0')
    assert titles(folder, "mission.btq")["quick mission.btq"] == ["It arrives", "It takes its time"]


def test_those_of_a_program_that_registers_several_files_do(folder: Path) -> None:
    with (folder / "btq.toml").open("a", encoding="utf-8") as file:
        file.write('[[factory]]\nname = "robot"\nload = ["*.btq"]\nmain = "Main"\n')
    (folder / "part.btq").write_text("BehaviorTree Part\n    Wave\nAction Wave\n", encoding="utf-8")
    assert titles(folder, "mission.btq")["quick mission.btq"] == ["It arrives", "It takes its time"]
    assert titles(folder)["quick mission.btq"] == ["It arrives", "It takes its time"]


def test_in_a_workspace(folder: Path) -> None:
    workspace = btq.open_workspace(str(folder))
    overview = btq.trace_table(workspace, str(folder / "mission.btq")).overview
    assert [[way.id for way in row.scenarios] for row in overview.requirements] == [
        ["It arrives", "It takes its time"],
        ["It takes its time"],
        ["It arrives"],
        ["It takes its time"],
        [],
    ]
