"""The chain of an overview: hazard, requirement, what refines it, node, enforcement, verdict; and parts of it."""

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
from evidence_logs import MAIN, MAIN_XML, btlog, rows
from in_process import run_btq

from btq_lang.evidence.json_document import read_verdicts

MISSION = """\
hazard H1 "Collision <b>"
    severity high
    source "FMEA-12"
hazard H2 "Fire"
QualityReq top : safety "Nobody is hurt"
    source "ISO 13482"
QualityReq quick : performance-efficiency.time-behaviour and reliability "In time"
    Move takes at most 30 ms
    refines top, REQ_1
    mitigates H1, HAZ_9
    priority high
QualityReq alike : reliability
    every Pick succeeds
    priority low
    verified by test "TC-1", monitor
QualityReq looked_at : safety
    verified by review "R-3"
QualityReq calm : safety
    verified by review
"""
RUNS = "0 1R 2R 20 2S 3R 60 3F 1F 1I 100 1R 2R 140 2S 3R 150 3S 1S"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "main.btq").write_text(MISSION + MAIN, encoding="utf-8")
    (tmp_path / "run.btlog").write_bytes(btlog(MAIN_XML, rows(RUNS)))
    (tmp_path / "btq.toml").write_text('[requirements]\nimport = ["reqs.csv"]\nsource = "required"\n')
    reqs = "id,title,status,url\nREQ_1,Arrive,open,https://x.org/1\nHAZ_9,Late,,\nREQ_2,Unused,,\n"
    (tmp_path / "reqs.csv").write_text(reqs)
    return tmp_path


def trace(folder: Path, form: str, *arguments: str) -> str:
    code, out, err = run_btq("trace", "--format", form, *arguments, cwd=folder)
    assert (code, err) == (0, "")
    return out


def as_json(folder: Path, *arguments: str) -> dict[str, Any]:
    document: dict[str, Any] = json.loads(trace(folder, "json", *arguments))
    return document


def test_links_are_in_both_ends(folder: Path) -> None:
    document = as_json(folder)
    names = {each["key"]: each["id"] for each in document["requirements"]}
    refined = {each["id"]: [names[key] for key in each["refined_by"]] for each in document["requirements"]}
    assert refined == {"top": ["quick"], "quick": [], "alike": [], "looked_at": [], "calm": []}
    hazards = {each["id"]: [names[key] for key in each["requirements"]] for each in document["hazards"]}
    assert hazards == {"H1": ["quick"], "H2": []}
    assert document["external"] == [
        {
            "key": "x1",
            "id": "REQ_1",
            "title": "Arrive",
            "status": "open",
            "url": "https://x.org/1",
            "at": {"path": "reqs.csv", "line": 2, "column": 1},
            "requirements": ["r2"],
            "scenarios": [],
        },
        {
            **{"key": "x2", "id": "HAZ_9", "title": "Late", "status": "", "url": ""},
            **{"requirements": ["r2"], "scenarios": []},
            "at": {"path": "reqs.csv", "line": 3, "column": 1},
        },
    ]


def test_gaps(folder: Path) -> None:
    document = as_json(folder, "--evidence", "run.btlog")
    names = {each["key"]: each["id"] for part in ("requirements", "hazards") for each in document[part]}
    gaps = {gap: [names[key] for key in keys] for gap, keys in document["gaps"].items() if gap.startswith(CHAIN)}
    assert gaps == {
        "requirements_without_nodes": ["looked_at", "calm"],  # `top` has those of `quick`
        "hazards_without_requirements": ["H2"],
        "requirements_without_verdicts": ["calm"],  # `looked_at` has a report
        "requirements_without_sources": ["alike", "looked_at", "calm"],
    }
    assert as_json(folder)["gaps"]["requirements_without_verdicts"] == []  # without evidence none has one
    (folder / "btq.toml").write_text('[requirements]\nimport = ["reqs.csv"]\n')
    assert as_json(folder)["gaps"]["requirements_without_sources"] == []


CHAIN = ("requirements_without", "hazards_without")


def test_the_table(folder: Path) -> None:
    lines = trace(folder, "table", "--evidence", "run.btlog").splitlines()
    assert lines[: lines.index("") + 1] == [
        "Hazard or requirement of others  Mitigated or refined by",
        "-------------------------------  --------------------------",
        "H1, main.btq:1                   quick: monitored; violated",
        "  Collision <b>",
        "  severity high",
        '  source "FMEA-12"',
        "H2, main.btq:4                   nothing",
        "  Fire",
        "REQ_1, reqs.csv:2                quick: monitored; violated",
        "  Arrive",
        "  open",
        "HAZ_9, reqs.csv:3                quick: monitored; violated",
        "  Late",
        "",
    ]
    assert any(line.startswith("  for performance-efficiency.time-behaviour") for line in lines)
    assert any(line.startswith("  refined by quick") for line in lines)
    assert lines[lines.index("Hazards without a requirement") + 1] == "  H2, main.btq:4"
    assert lines[lines.index("Requirements without a verdict") + 1] == "  calm, main.btq:18"


def test_csv(folder: Path) -> None:
    written = [*csv.DictReader(io.StringIO(trace(folder, "csv", "--evidence", "run.btlog")))]
    chain = [
        (row["kind"], row["requirement"], row["hazard"] or row["external"], row["how"], row["verdict"], row["line"])
        for row in written
        if row["kind"].startswith(("hazard", "external")) or "verdict" in row["kind"]
    ]
    assert chain == [
        ("hazard", "quick", "H1", "monitored", "violated", "1"),
        ("hazard without requirement", "", "H2", "", "", "4"),
        ("external", "quick", "REQ_1", "monitored", "violated", "2"),
        ("external", "quick", "HAZ_9", "monitored", "violated", "3"),
        ("requirement without verdict", "calm", "", "", "", ""),
    ]
    quick, alike = (next(row for row in written if row["requirement"] == name) for name in ("quick", "alike"))
    assert (quick["refines"], quick["mitigates"], quick["priority"]) == ("top, REQ_1", "H1, HAZ_9", "high")
    assert (alike["verified_by"], alike["approval"], alike["origin"]) == ("test TC-1, monitor", "open", "")


def test_markdown_and_page(folder: Path) -> None:
    markdown = trace(folder, "markdown", "--evidence", "run.btlog")
    hazard = '**H1** (main.btq:1)<br>Collision &lt;b><br>severity high<br>source "FMEA-12"'
    assert f"| {hazard} | **quick** monitored; violated |" in markdown
    assert "* Hazards without a requirement: H2 (main.btq:4)\n" in markdown
    page = trace(folder, "html", "--evidence", "run.btlog")
    chain = re.sub(r"\s*\n\s*", "", page[page.index('<section id="chain"') : page.index('<section id="requirements"')])
    row = '<tr class="row" id="h1" data-way="monitored" data-of="performance-efficiency reliability">'
    assert f'{row}<th scope="row"><a class="name" href="#h1">H1</a>' in chain
    assert "<p>Collision &lt;b&gt;</p>" in chain
    assert '<a class="name" href="https://x.org/1">REQ_1</a>' in chain
    assert '<li><a href="#r2">quick</a> <small>monitored; violated</small></li>' in chain
    assert '<p>refined by <a href="#r2">quick</a></p>' in page


def test_the_chain_names_tests_and_reports(tmp_path: Path) -> None:
    requirement = "QualityReq r1 : safety\n    Move takes at most 1 s\n    mitigates H1\n"
    ways = '    verified by test "TC-7", test, review "R-2", monitor\n'
    (tmp_path / "main.btq").write_text(f'hazard H1 "Fire"\n{requirement}{ways}{MAIN}', encoding="utf-8")
    how = 'monitored; test "TC-7", review "R-2"'
    assert trace(tmp_path, "table").splitlines()[2] == f"H1, main.btq:1                   r1: {how}"
    assert f"| **r1** {how} |" in trace(tmp_path, "markdown")
    assert f'<a href="#r1">r1</a> <small>{how}</small>' in unescape(trace(tmp_path, "html"))


def test_needs(folder: Path) -> None:
    needs = json.loads(trace(folder, "needs-json"))["versions"][""]["needs"]
    assert [(id_, need["type"], need["links"]) for id_, need in needs.items()] == [
        ("top", "req", []),
        ("quick", "req", ["top", "REQ_1", "H1", "HAZ_9"]),
        ("alike", "req", []),
        ("looked_at", "req", []),
        ("calm", "req", []),
        ("H1", "hazard", []),
        ("H2", "hazard", []),
    ]
    assert needs["H1"]["content"] == "* severity high\n* FMEA-12"


@pytest.mark.parametrize(
    ("arguments", "names"),
    [
        (("--priority", "high"), ["quick"]),
        (("--priority", "high", "--priority", "low"), ["quick", "alike"]),
        (("--quality", "reliability"), ["quick", "alike"]),
        (("--quality", "time-behaviour"), ["quick"]),
        (("--quality", "performance-efficiency", "--priority", "low"), []),
        (("--state", "violated"), ["quick", "alike"]),
        (("--state", "without verdict"), ["top", "calm"]),
        (("--state", "not attached"), ["top", "looked_at", "calm"]),
        (("--state", "not approved", "--quality", "safety"), ["top", "looked_at", "calm"]),
    ],
)
def test_a_part_of_them(folder: Path, arguments: tuple[str, ...], names: list[str]) -> None:
    document = as_json(folder, "--evidence", "run.btlog", *arguments)
    assert [each["id"] for each in document["requirements"]] == names
    keys = {each["key"] for each in document["requirements"]}
    for part in ("hazards", "external", "qualities"):
        assert all(each["requirements"] and keys.issuperset(each["requirements"]) for each in document[part])
    gaps = ("nodes_without_qualities", "trees_without_qualities", "qualities_without_requirements")
    assert [document["gaps"][gap] for gap in gaps] == [[], [], []]
    for form in ("table", "csv", "markdown", "html", "needs-json"):
        text = trace(folder, form, "--evidence", "run.btlog", *arguments).replace("\\_", "_")
        assert [name for name in ("quick", "alike", "looked_at") if name in text] == [
            name for name in ("quick", "alike", "looked_at") if name in names
        ]


@pytest.mark.parametrize(
    ("asked", "sentence"),
    [
        (("--state", "suspect"), "no requirement is suspect (of 5)\n"),
        (("--state", "suspect", "--priority", "could"), "no requirement has priority could and is suspect (of 5)\n"),
        (("--quality", "usability", "--format", "markdown"), "no requirement has quality usability (of 5)\n"),
    ],
)
def test_a_selection_of_nothing_is_a_sentence(asked: tuple[str, ...], sentence: str, folder: Path) -> None:
    assert run_btq("trace", *asked, cwd=folder) == (0, sentence, "")
    code, out, _ = run_btq("trace", *asked[:2], "--format", "json", cwd=folder)
    assert (code, json.loads(out)["requirements"]) == (0, [])


def test_an_unknown_state(folder: Path) -> None:
    code, _, err = run_btq("trace", "--state", "broken", cwd=folder)
    assert code == 2
    assert err.startswith(
        "btq trace: unknown state 'broken'; expected one of enforced, monitored, reviewed, not attached, "
    )


def test_verdicts_name_the_links(folder: Path) -> None:
    _, out, _ = run_btq("verify", "run.btlog", "--format", "json", cwd=folder)
    requirements = {each.pop("id"): each for each in json.loads(out)["requirements"]}
    named = ("sources", "refines", "mitigates", "priority", "verified_by")
    assert {id_: {name: each[name] for name in named if name in each} for id_, each in requirements.items()} == {
        "top": {"sources": ["ISO 13482"]},
        "quick": {"refines": ["top", "REQ_1"], "mitigates": ["H1", "HAZ_9"], "priority": "high"},
        "alike": {"priority": "low", "verified_by": ["test TC-1", "monitor"]},
        "looked_at": {"verified_by": ["review R-3"]},
        "calm": {"verified_by": ["review"]},
    }
    assert [each.links.refines for each in read_verdicts(out)[0].requirements] == [(), ("top", "REQ_1"), (), (), ()]
    _, out, _ = run_btq("verify", "run.btlog", "--format", "junit", cwd=folder)
    properties = [
        {each.attrib["name"]: each.attrib["value"] for each in case.iterfind("properties/property")}
        for case in ElementTree.fromstring(out).iter("testcase")
    ]
    assert properties[:3] == [
        {"verifies": "top", "source": "ISO 13482"},
        {"verifies": "quick", "refines": "top,REQ_1", "mitigates": "H1,HAZ_9", "priority": "high"},
        {"verifies": "alike", "verified_by": "test TC-1,monitor", "priority": "low"},
    ]
