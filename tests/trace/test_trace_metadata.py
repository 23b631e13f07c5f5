"""What an overview has of hazards, and of where requirements are from, what they belong to and who approved them."""

from __future__ import annotations

import csv
import io
import json

import pytest

from btq_lang.trace import write
from btq_lang.trace.collect import collect
from btq_lang.trace.overview import Overview
from btq_lang.trace.selection import Selection, selected
from btq_lang.workspace.workspace import Workspace

MISSION = """\
hazard H1 "Collision  with a person"
    source "FMEA-12"
    severity high
    because "people walk there"
hazard H2
QualityReq top "Top"
QualityReq slow : safety and reliability.availability "Slow"
    mission takes at most 1 h
    source "ISO 13482, 5.10.2"
    refines top, REQ-7
    mitigates H1
    priority must
    verified by test "TC-12", monitor
    approved by "Kim" on "2026-11-29" of "1:0123456789ab"
    approved by "Lee" on "2026-11-30"
BehaviorTree Main
    A
"""


def overview(text: str = MISSION) -> Overview:
    return collect([(Workspace.of({"main.btq": text}), ["main.btq"])])


def test_requirements_and_hazards_in_json() -> None:
    document = json.loads(write(overview(), "json"))
    assert document["hazards"] == [
        {
            "key": "h1",
            "id": "H1",
            "title": "Collision with a person",
            "severity": "high",
            "sources": ["FMEA-12"],
            "reasons": ["people walk there"],
            "at": {"path": "main.btq", "line": 1, "column": 8},
            "requirements": ["r2"],
        },
        {
            "key": "h2",
            "id": "H2",
            "title": "",
            "severity": None,
            "sources": [],
            "reasons": [],
            "at": {"path": "main.btq", "line": 5, "column": 8},
            "requirements": [],
        },
    ]
    top, slow = document["requirements"]
    names = ("sources", "refines", "mitigates", "priority", "verified_by", "approvals", "state")
    assert {name: slow[name] for name in names} == {
        "sources": ["ISO 13482, 5.10.2"],
        "refines": ["top", "REQ-7"],
        "mitigates": ["H1"],
        "priority": "must",
        "verified_by": [
            {"method": "test", "id": "TC-12", "at": None},
            {"method": "monitor", "id": None, "at": None},
        ],
        "approvals": [
            {"by": "Kim", "on": "2026-11-29", "of": "1:0123456789ab"},
            {"by": "Lee", "on": "2026-11-30", "of": None},
        ],
        "state": "suspect",
    }
    assert (top["state"], top["priority"], top["verified_by"]) == ("open", None, [])
    assert slow["further_qualities"] == [{"name": "reliability.availability", "key": "q2"}]


def test_who_has_approved_a_requirement_and_when() -> None:
    one, two = "approved by Kim on 2026-11-29", "approved by Lee on 2026-11-30, without a fingerprint"
    in_cells = [line.partition("   ")[0].strip() for line in write(overview(), "table").splitlines()]
    assert in_cells[in_cells.index(one) :][:3] == [one, two, "approval outdated"]
    assert f"<br>{one}<br>{two}<br>approval outdated |" in write(overview(), "markdown")
    assert f'<p>{one}</p><p>{two}</p><p class="missing">approval outdated</p>' in write(overview(), "html")
    rows = [row for row in csv.DictReader(io.StringIO(write(overview(), "csv"))) if row["requirement"] == "slow"]
    assert {(row["approval"], row["approved_by"]) for row in rows} == {("suspect", "Kim 2026-11-29; Lee 2026-11-30")}


def test_an_approval_without_a_fingerprint_is_a_state_of_its_own() -> None:
    text = MISSION.replace('    approved by "Kim" on "2026-11-29" of "1:0123456789ab"\n', "")
    assert overview(text).requirements[1].state == "approved without fingerprint"
    part = selected(overview(text), Selection(states=["approved without fingerprint"]))
    assert [row.name for row in part.requirements] == ["slow"]


def test_clauses_as_typed() -> None:
    assert overview().requirements[1].clauses == (
        "mission takes at most 1 h",
        'verified by test "TC-12", monitor',
        'source "ISO 13482, 5.10.2"',
        "refines top, REQ-7",
        "mitigates H1",
        "priority must",
    )


def test_a_requirement_counts_for_each_of_its_qualities_and_once_in_all() -> None:
    document = overview()
    counted = {total.id: (total.requirements, total.monitored) for total in document.totals if total.requirements}
    assert counted == {"safety": (1, 1), "reliability": (1, 1), "": (1, 0)}
    assert [(row.name, row.requirements) for row in document.qualities] == [
        ("safety", ("r2",)),
        ("reliability.availability", ("r2",)),
    ]
    assert "2 requirements (1 clause: 1 monitored)" in write(document, "table")


def test_prose_that_people_verify_counts_as_such_under_its_quality() -> None:
    text = """QualityReq light : safety "Weighs little"
    verified by analysis "A-3"

QualityReq quick : safety "In time"
    takes at most 3 s
    verified by test "TC-1"

Action Go

BehaviorTree Main
    Go satisfies light, quick
"""
    document = overview(text)
    (safety,) = [total for total in document.totals if total.id == "safety"]
    assert safety.numbers == (0, 2, 0, 0, 2)
    assert document.requirements[0].uses[0].clauses[0].why == "it is prose, which people verify"
    headings = ("Concerns", "Requirements", "Clauses enforced", "Clauses monitored", "Clauses, texts by people")
    assert "  ".join(headings) in write(document, "table")
    assert f"| Characteristic | {' | '.join(headings)} |" in write(document, "markdown")
    assert all(f">{heading}</th>" in write(document, "html") for heading in headings)
    assert "(1 clause: 1 by people)" in write(document, "table")


@pytest.mark.parametrize(
    ("written", "words"),
    [('test "TC-12"', "by test TC-12"), ("analysis", "by analysis"), ("review", "by review"), ("test", "by test")],
)
def test_nothing_is_called_reviewed_that_a_test_shows(written: str, words: str) -> None:
    table = overview(MISSION.replace('test "TC-12", monitor', written))
    assert f"mission, main.btq:8  {words}\n" in write(table, "table")
    assert f" | {words} | main.btq:7 |" in write(table, "markdown")
    assert f'<span class="way reviewed">{words}</span></li>' in write(table, "html")
    rows = csv.DictReader(io.StringIO(write(table, "csv")))
    assert [row["how"] for row in rows if row["kind"] == "requirement"] == [words]
    assert "2 requirements (1 clause: 1 by people)" in write(table, "table")


def test_one_way_by_a_tool_is_enough_to_monitor() -> None:
    ways = {
        'test "TC-12", monitor': "monitored",
        'test "TC-12", review': "reviewed",
        "review": "reviewed",
        "monitor": "monitored",
    }
    for written, way in ways.items():
        row = overview(MISSION.replace('test "TC-12", monitor', written)).requirements[1]
        assert (written, row.way) == (written, way)
    row = overview(MISSION.replace(", monitor", ', review "R-3"')).requirements[1]
    assert row.ways_in_words == ("by test TC-12 and review R-3",)
    assert row.uses[0].clauses[0].why == 'verified by test "TC-12", review "R-3"'
