"""Requirements for other tools: what `btq trace` writes as needs.json and as CSV is read as it was meant."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from in_process import run_btq

from btq_lang.requirements.external import read_external

MISSION = """\
QualityReq rq1 : performance-efficiency.time-behaviour "In time"
    takes at most 30 s
    goal 20 s
    because "-x, \\"y\\" ``z`` ä"
QualityReq rq2
    Dock needs battery >= 3 %
QualityReq rq3 "=cmd()"
    verified by review
signal battery : % from {battery}
Action Drive
Action Dock
BehaviorTree Main
    ->
        Drive satisfies rq1
        Dock
"""


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    (tmp_path / "m.btq").write_text(MISSION, encoding="utf-8")
    return tmp_path


def test_the_document(robot: Path) -> None:
    code, out, err = run_btq("trace", "--format", "needs-json", cwd=robot)
    assert (code, err) == (0, "")
    document = json.loads(out)
    version = document["versions"][document["current_version"]]
    assert (document["project"], version["needs_amount"], [*version["needs"]]) == ("btq", 3, ["rq1", "rq2", "rq3"])
    assert version["needs"]["rq1"] == {
        "id": "rq1",
        "type": "req",
        "title": "In time",
        "content": '* ``takes at most 30 s``\n* ``goal 20 s``\n* ``because "-x, "y" ``z`` ä"``',
        "status": None,
        "tags": ["performance-efficiency.time-behaviour"],
        "links": [],
        "docname": "m.btq",
        "lineno": 1,
    }
    assert (version["needs"]["rq2"]["title"], version["needs"]["rq2"]["tags"]) == ("rq2", [])


def test_what_is_written_is_read(robot: Path) -> None:
    run_btq("trace", "--format", "needs-json", "-o", "needs.json", cwd=robot)
    run_btq("trace", "-o", "reqs.csv", cwd=robot)
    needs = read_external("needs.json", (robot / "needs.json").read_text(encoding="utf-8"))
    assert [(each.id, each.title, each.text, each.status) for each in needs] == [
        ("rq1", "In time", '* ``takes at most 30 s``\n* ``goal 20 s``\n* ``because "-x, "y" ``z`` ä"``', ""),
        ("rq2", "rq2", "* ``Dock needs battery >= 3 %``", ""),
        ("rq3", "=cmd()", "* ``verified by review``", ""),
    ]
    rows = read_external("reqs.csv", (robot / "reqs.csv").read_text(encoding="utf-8"))
    assert [(each.id, each.title, each.text) for each in rows] == [
        ("rq1", "In time", "takes at most 30 s"),
        ("rq2", "", "Dock needs battery >= 3 %"),
        ("rq3", "=cmd()", "verified by review"),
    ]


def test_the_status_is_the_worst_verdict(tmp_path: Path) -> None:
    laboratory = Path(__file__).resolve().parents[2] / "examples/laboratory"
    for form, name in (("needs-json", "n.json"), ("csv", "n.csv")):
        _, out, _ = run_btq("trace", "--format", form, str(laboratory), cwd=tmp_path)
        statuses = {each.id: each.status for each in read_external(name, out)}
        assert (statuses["rq1"], statuses["rq2"]) == ("violated", "satisfied")
