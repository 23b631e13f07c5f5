"""Requirements that no log can show are in every report, as open, with the reason."""

from __future__ import annotations

import csv
import io
import json
import re
from pathlib import Path
from xml.etree import ElementTree

import pytest
from evidence_logs import MAIN, MAIN_XML, START, Verify, btlog, rows
from in_process import run_btq
from json_schema import violations

from btq_lang.commands.verify_options import FORMATS
from btq_lang.evidence.json_document import read_verdicts
from btq_lang.ide.meaning import Subject
from btq_lang.ide.verdicts import ProjectVerdicts, verdict_table, verdict_titles
from btq_lang.workspace.references import What
from btq_lang.workspace.workspace import Workspace

JUDGED = 'QualityReq quick : safety "In time"\n    Move takes at most 1 s\n'
OPEN = """\
QualityReq kind : ergonomics "Nobody is startled"
    verified by analysis
QualityReq calm : ergonomics
QualityReq private : security
    Move takes at most 9 s
    every Pick succeeds
    in at least 90 % of runs
    verified by test
"""
RUN = "0 1R 2R 20 2S 3R 25 3S 1S 26 2I 3I 1I"
HELD = "held so far in 1 activation, worst 20 ms in run 1"
NO_CLAUSE = "it has no clause that can be measured"
REASONS = [
    ("kind", "", "verified by analysis"),
    ("calm", "", NO_CLAUSE),
    ("private", "Move takes at most 9 s in at least 90 % of runs", "verified by test"),
    ("private", "every Pick succeeds in at least 90 % of runs", "verified by test"),
]
SCHEMA = json.loads((Path(__file__).parents[2] / "btq_lang/evidence/verdicts.schema.json").read_text(encoding="utf-8"))


def folder(verify: Verify, demands: str) -> tuple[str, ...]:
    (verify.folder / "main.btq").write_text(demands + MAIN, encoding="utf-8")
    (verify.folder / "run.btlog").write_bytes(btlog(MAIN_XML, rows(RUN)))
    return "run.btlog", "--mission", "main.btq"


def test_table(verify: Verify) -> None:
    lines = verify.text(*folder(verify, JUDGED + OPEN)).splitlines()
    assert [re.split("  +", line.strip()) for line in lines[2:7]] == [
        [
            "satisfied",
            "quick",
            "In time",
            "Move takes at most 1 s",
            HELD,
        ],
        ["open", "kind", "Nobody is startled", "verified by analysis"],
        ["open", "calm", NO_CLAUSE],
        ["open", "private", REASONS[2][1], "verified by test"],
        ["open", *REASONS[3][1:]],
    ]
    assert verify.code == 0


def test_json(verify: Verify) -> None:
    document = json.loads(verify.text(*folder(verify, OPEN + JUDGED), "--format", "json"))
    assert [*violations(document, SCHEMA)] == []
    assert document["version"] == 2
    assert [(each["id"], each["verdict"]) for each in document["requirements"]] == [
        *(("kind", "open"), ("calm", "open"), ("private", "open"), ("quick", "satisfied"))
    ]
    found = [
        (each["id"], clause["text"], clause["why"])
        for each in document["requirements"][:3]
        for clause in each["clauses"]
    ]
    assert found == REASONS
    assert all(each["verdict"] == "open" for one in document["requirements"][:3] for each in one["clauses"])


def test_csv(verify: Verify) -> None:
    text = verify.text(*folder(verify, JUDGED + OPEN), "--format", "csv")
    found = [row for row in csv.DictReader(io.StringIO(text, newline="")) if row["verdict"] == "open"]
    assert [(row["requirement"], row["clause"], row["result"]) for row in found] == REASONS
    assert {(row["path"], row["counted"], row["worst"], row["look_at"]) for row in found} == {("", "0", "", "")}


def test_junit(verify: Verify) -> None:
    root = ElementTree.fromstring(verify.text(*folder(verify, JUDGED + OPEN), "--format", "junit"))
    assert {name: root.attrib[name] for name in ("tests", "failures", "skipped")} == {
        "tests": "4",
        "failures": "0",
        "skipped": "3",
    }
    skipped = {case.attrib["name"]: case.find("skipped") for case in root.iter("testcase")}
    assert {name: found.attrib for name, found in skipped.items() if found is not None} == {
        "kind": {"type": "open", "message": "open: verified by analysis"},
        "calm": {"type": "open", "message": f"open: {NO_CLAUSE}"},
        "private": {"type": "open", "message": "open: verified by test"},
    }


def test_markdown(verify: Verify) -> None:
    lines = verify.text(*folder(verify, JUDGED + OPEN), "--format", "markdown").splitlines()
    assert lines[0] == "### main: 1 satisfied, 3 open"
    assert [line for line in lines if line.startswith("| open ")] == [
        "| open | **kind**<br>Nobody is startled |  | verified by analysis |",
        f"| open | **calm** |  | {NO_CLAUSE} |",
        f"| open | **private** | `{REASONS[2][1]}` | verified by test |",
        f"| open | **private** | `{REASONS[3][1]}` | verified by test |",
    ]


def test_page(verify: Verify) -> None:
    page = verify.text(*folder(verify, JUDGED + OPEN), "--format", "html")
    open_row = r'<tr data-note="r\d+">\s*<td><span class="verdict open">open</span></td>(.*?)</tr>'
    open_rows = re.findall(open_row, page, re.DOTALL)
    assert [re.sub("<[^>]*>", " ", row).split() for row in open_rows] == [
        ["kind", "Nobody", "is", "startled", "verified", "by", "analysis"],
        ["calm", *NO_CLAUSE.split()],
        ["private", *REASONS[2][1].split(), *REASONS[2][2].split()],
        ["private", *REASONS[3][1].split(), *REASONS[3][2].split()],
    ]


@pytest.mark.parametrize("form", FORMATS)
@pytest.mark.parametrize(("demands", "strictly"), [(JUDGED, 0), (JUDGED + OPEN, 1), (OPEN, 1)])
def test_strict_wants_nothing_open(form: str, demands: str, strictly: int, verify: Verify) -> None:
    given = folder(verify, demands)
    verify.text(*given, "--format", form)
    assert (verify.code, verify.errors) == (0, "")
    verify.text(*given, "--format", form, "--strict")
    assert (verify.code, verify.errors) == (strictly, "")


def test_a_requirement_that_is_measured_or_attached_to_nothing_is_not_open(verify: Verify) -> None:
    demands = JUDGED + "    verified by monitor\nQualityReq loose : safety\n    takes at most 1 s\n"
    document = json.loads(verify.text(*folder(verify, demands), "--format", "json"))
    assert [(each["id"], each["verdict"]) for each in document["requirements"]] == [
        ("quick", "satisfied"),
        ("loose", "unknown"),
    ]


def test_a_document_of_an_older_version_is_read(verify: Verify) -> None:
    document = json.loads(verify.text(*folder(verify, JUDGED), "--format", "json"))
    (mission,) = read_verdicts(json.dumps(document))
    assert read_verdicts(json.dumps({**document, "version": 1})) == (mission,)
    assert [(each.id, each.verdict) for each in mission.requirements] == [("quick", "satisfied")]


def test_a_store_has_them_and_no_comparison_calls_them_violated(verify: Verify) -> None:
    given = folder(verify, JUDGED + OPEN)
    assert "open" in verify.text(*given, "--store", "kept", "--label", "v1")
    (verify.folder / "run.btlog").write_bytes(btlog(MAIN_XML, rows(RUN), START + 60_000_000))
    verify.text(*given, "--store", "kept", "--label", "v2")
    text = verify.text("--store", "kept", "--format", "csv")
    found = [row for row in csv.DictReader(io.StringIO(text, newline="")) if row["verdict"] == "open"]
    assert [(row["requirement"], row["clause"], row["result"]) for row in found] == REASONS
    verify.text("--store", "kept", "--strict")
    assert verify.code == 1

    (verify.folder / "main.btq").write_text((JUDGED + OPEN).replace("at most 9 s", "at most 8 s") + MAIN)
    verify.text(*given, "--store", "kept", "--label", "v2")
    code, output, errors = run_btq("compare", "kept", "v1", "v2", cwd=verify.folder)
    assert (code, errors) == (0, "")
    assert not {"private", "kind", "calm"} & {*re.split(r"[^a-z]+", output)}
    assert run_btq("report", "kept", "-o", "report.html", cwd=verify.folder) == (0, "", "")
    page = (verify.folder / "report.html").read_text(encoding="utf-8")
    assert '<span class="verdict open">open</span><small>verified by analysis</small>' in page
    (covered,) = re.findall(r'<th scope="row">Requirements</th>(.*?)</tr>', page)
    assert re.findall(">([^<>]+)<", covered) == ["1 of 1", "1 of 1"]


def test_an_editor_shows_them_beside_verdicts(verify: Verify) -> None:
    verify.text(*folder(verify, JUDGED + OPEN), "--summary", "summary.json")
    (mission,) = read_verdicts((verify.folder / "summary.json").read_text(encoding="utf-8"))
    workspace = Workspace.of({"main.btq": JUDGED + OPEN + MAIN})
    evidence = ProjectVerdicts(str(verify.folder), {"main.btq": mission})
    assert [title for _, title, _ in verdict_titles(workspace, "main.btq", evidence)] == [
        "held in 1 of 1 activations · worst 20 ms",
        "open: verified by analysis",
        f"open: {NO_CLAUSE}",
        "open: verified by test",
    ]
    asked = [Subject(What.REQUIREMENT, name) for name in ("calm", "private")]
    hovers = [verdict_table(workspace, "main.btq", each, evidence) for each in asked]
    assert [[line for line in hover.splitlines() if line.startswith("| open")] for hover in hovers] == [
        [f"| open |  | {NO_CLAUSE} |"],
        [f"| open | `{text}` | verified by test |" for _, text, _ in REASONS[2:]],
    ]


def test_what_people_verify_beside_what_a_log_shows(shared: Path, verify: Verify) -> None:
    hand = shared / "field" / "verdicts" / "hand"
    given = str(hand / "nosig.btlog"), "--mission", str(hand / "rev.btq"), "--strict", "--format", "json"
    document = json.loads(verify.text(*given))
    assert [(each["id"], each["verdict"]) for each in document["requirements"]] == [
        *(("q1", "satisfied"), ("q2", "open"), ("q3", "open"), ("q4", "open"))
    ]
    assert verify.code == 1


def test_a_clause_with_a_mistake_is_unknown_and_not_open(verify: Verify) -> None:
    """Also where another clause of the requirement is satisfied."""
    demands = "    Move takes at most 80\n    Move takes at most 1 s\n"
    (verify.folder / "main.btq").write_text(f"QualityReq rq : safety\n{demands}{MAIN}", encoding="utf-8")
    (verify.folder / "run.btlog").write_bytes(btlog(MAIN_XML, rows("0 1R 2R 20 2S 3S 1S")))
    (requirement,) = verify.json("run.btlog", "--mission", "main.btq")["requirements"]
    assert requirement["verdict"] == "unknown"
    assert [(each["text"], each["verdict"], each["why"]) for each in requirement["clauses"]] == [
        ("Move takes at most 1 s", "satisfied", ""),
        ("Move takes at most 80", "unknown", "it has a mistake; run btq check"),
    ]
    assert verify.code == 2
