"""The column of evidence: verdicts of a file of `btq verify`, or by logs, beside the requirements."""

from __future__ import annotations

import csv
import io
import json
import re
from pathlib import Path
from typing import Any

import pytest
from evidence_logs import MAIN, MAIN_XML, btlog, rows

from btq_lang.cli import main
from btq_lang.evidence.json_document import NotVerdicts, read_verdicts
from btq_lang.evidence.verdicts import ClauseVerdict, RequirementVerdict
from btq_lang.trace.collect import collect
from btq_lang.trace.wording import evidence_lines
from btq_lang.workspace.workspace import Workspace

MISSION = """\
QualityReq quick : performance-efficiency "In time"
    Move takes at most 30 ms
    Pick takes at most 30 ms
QualityReq alike : reliability
    every Pick succeeds
QualityReq looked_at : safety
    mission succeeds
    verified by review
"""
RUNS = "0 1R 2R 20 2S 3R 60 3F 1F 1I 100 1R 2R 140 2S 3R 150 3S 1S"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A mission, and a log of two runs."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "main.btq").write_text(MISSION + MAIN, encoding="utf-8")
    (tmp_path / "run.btlog").write_bytes(btlog(MAIN_XML, rows(RUNS)))
    return tmp_path


def trace(capsys: pytest.CaptureFixture[str], *arguments: str, code: int = 0) -> str:
    capsys.readouterr()
    assert main(["trace", "main.btq", *arguments]) == code
    return capsys.readouterr().out


def as_json(capsys: pytest.CaptureFixture[str], *arguments: str) -> dict[str, Any]:
    found = json.loads(trace(capsys, *arguments, "--format", "json"))
    return {each["id"]: each["evidence"] for each in found["requirements"]}


QUICK = {
    "mission": "",
    "clause": "Move takes at most 30 ms",
    "path": "Move::2",
    "verdict": "violated",
    "result": "1 of 2 activations, worst 40 ms in run 2",
    "suspect": False,
}
PICK = QUICK | {
    "clause": "Pick takes at most 30 ms",
    "path": "Pick::3",
    "result": "1 of 2 activations, worst 40 ms in run 1",
}
LOOKED_AT = QUICK | {"clause": "mission succeeds", "path": "", "verdict": "open", "result": "verified by review"}
ALIKE = QUICK | {"clause": "every Pick succeeds", "path": "Pick::3", "result": "1 of 2 activations"}


def test_verdicts_by_logs(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert as_json(capsys, "--evidence", "run.btlog") == {
        "quick": [QUICK, PICK],
        "alike": [ALIKE],
        "looked_at": [LOOKED_AT],
    }


def test_verdicts_of_no_mission_that_is_traced(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", "run.btlog", "--store", "kept", "--label", "v1"]) == 1
    assert main(["verify", "--store", "kept", "--by", "label", "-o", "by_label.json"]) == 1
    capsys.readouterr()
    assert main(["trace", "main.btq", "--evidence", "by_label.json"]) == 2
    message = "btq trace: by_label.json: no verdicts of these missions, only of main, label v1\n"
    assert capsys.readouterr().err.endswith(message)


def test_a_file_of_verdicts_shows_the_same_as_the_logs(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", "run.btlog", "-o", "verdicts.json"]) == 1
    for form in ("table", "csv", "json", "markdown", "html"):
        by_logs = trace(capsys, "--evidence", "run.btlog", "--format", form)
        assert trace(capsys, "--evidence", "verdicts.json", "--format", form) == by_logs


def test_the_logs_of_the_project_are_the_default(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    without = trace(capsys)
    (folder / "btq.toml").write_text('[evidence]\nlogs = ["gone/*.btlog"]\n', encoding="utf-8")
    assert trace(capsys) == without
    assert as_json(capsys) == {"quick": None, "alike": None, "looked_at": None}
    (folder / "btq.toml").write_text('[evidence]\nlogs = ["*.btlog"]\n', encoding="utf-8")
    assert as_json(capsys)["alike"] == [ALIKE]


def test_the_table(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    lines = trace(capsys, "--evidence", "run.btlog").splitlines()
    at = lines[0].index("Evidence")
    assert [line[at:].rstrip() for line in lines[: lines.index("")]] == [
        "Evidence",
        "-" * len(lines[1][at:]),
        "violated",
        *("  Move takes at most 30 ms: 1 of 2 activations, worst 40", "  ms in run 2"),
        "violated",
        *("  Pick takes at most 30 ms: 1 of 2 activations, worst 40", "  ms in run 1"),
        *("violated", "  1 of 2 activations", ""),
        *("open", "  verified by review", "", ""),
    ]


def test_csv_and_markdown(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    written = csv.DictReader(io.StringIO(trace(capsys, "--evidence", "run.btlog", "--format", "csv")))
    seen = [row for row in written if row["kind"] == "evidence"]
    assert [(row["requirement"], row["holds_for"], row["clause"], row["verdict"], row["result"]) for row in seen] == [
        ("quick", "Move::2", QUICK["clause"], "violated", QUICK["result"]),
        ("quick", "Pick::3", PICK["clause"], "violated", PICK["result"]),
        ("alike", "Pick::3", ALIKE["clause"], "violated", ALIKE["result"]),
        ("looked_at", "", "mission succeeds", "open", "verified by review"),
    ]
    markdown = trace(capsys, "--evidence", "run.btlog", "--format", "markdown")
    assert "| Requirement | Quality | Holds for | How | Evidence | Defined |" in markdown
    assert "| monitored | **violated** 1 of 2 activations | main.btq:4 |" in markdown


def test_the_page(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    page = trace(capsys, "--evidence", "run.btlog", "--format", "html")
    cells = re.findall(r"<td>(?:<ul>)?(<li><span class=\"verdict.*?|<span class=.*?)(?:</ul>)?</td></tr>", page)
    assert cells[1] == '<li><span class="verdict violated">violated</span> <small>1 of 2 activations</small></li>'
    assert cells[2] == '<li><span class="verdict open">open</span> <small>verified by review</small></li>'
    assert ".verdict.violated {" in page


def test_missions_that_share_a_requirement_are_named() -> None:
    texts = {
        "demands.btq": "QualityReq safe : safety\n    mission succeeds\n",
        "a.btq": f'include "demands.btq"\n{MAIN}',
        "b.btq": f'include "demands.btq"\n{MAIN}',
    }

    def verdicts(path: str) -> tuple[RequirementVerdict, ...]:
        why = "it did not start in any run"
        clause = ClauseVerdict(
            text="mission succeeds",
            path=f"{path[0]}/Sequence",
            of="",
            verdict="never exercised",
            why=why,
            unit="activations",
            counted=0,
            violated=0,
            unknown=0,
            cut_off=0,
            worst=None,
            interval=None,
            limits="one look",
            confidence=None,
            more=None,
            violations=(),
            histogram=None,
        )
        return (RequirementVerdict("safe", "", "never exercised", (clause,)),)

    overview = collect([(Workspace.of(texts), ("a.btq", "b.btq"))], verdicts_of=verdicts)
    (row,) = overview.requirements
    assert [(each.mission, each.path) for each in row.evidence] == [("a.btq", "a/Sequence"), ("b.btq", "b/Sequence")]
    assert [*evidence_lines(row)] == [
        ("never exercised", "a.btq: it did not start in any run"),
        ("never exercised", "b.btq: it did not start in any run"),
    ]


OTHER_TEXT = "this is not a document that btq verify --format json wrote"


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("{}", OTHER_TEXT),
        ("[" * 100_000, OTHER_TEXT),
        ('{"format": "btq-verdicts", "version": 3}', "expected btq-verdicts 1 or 2, found btq-verdicts 3"),
        ('{"format": "btq-verdicts", "version": 1, "missions": [1]}', OTHER_TEXT),
    ],
)
def test_other_texts_are_no_verdicts(text: str, why: str) -> None:
    with pytest.raises(NotVerdicts, match=re.escape(why)):
        read_verdicts(text)


def test_evidence_that_cannot_be_read(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    without = trace(capsys)
    (folder / "other.json").write_text("{}", encoding="utf-8")
    (folder / "kept" / "0123").mkdir(parents=True)
    (folder / "kept" / "0123" / "about.json").write_text("{}", encoding="utf-8")
    given = (word for name in ("other.json", "kept", "gone.btlog") for word in ("--evidence", name))
    assert main(["trace", "main.btq", *given]) == 2
    printed = capsys.readouterr()
    assert printed.out == without
    assert printed.err.splitlines() == [
        "btq trace: other.json: this is not a document that btq verify --format json wrote;"
        " write such a file with btq verify LOG -o verdicts.json",
        "btq trace: kept: no verdicts are kept there; keep some with btq verify LOG --store kept",
        "btq trace: gone.btlog: cannot be read: No such file or directory",
    ]


# ---- by build -------------------------------------------------------------------------------------------------------

SLOW = "0 1R 2R 20 2S 3R 60 3F 1F"
FAST = "0 1R 2R 20 2S 3R 30 3S 1S"


@pytest.fixture
def builds(folder: Path, capsys: pytest.CaptureFixture[str]) -> Path:
    """The folder with a store of three builds: one violates `quick` and `alike`, one nothing, one has no label."""
    for place, (label, runs) in enumerate({"v2": SLOW, "v1": FAST, "": FAST}.items()):
        (folder / f"{place}.btlog").write_bytes(btlog(MAIN_XML, rows(runs), 1_700_000_000_000_000 - place * 10**10))
        labelled = ("--label", label) if label else ()
        main(["verify", f"{place}.btlog", "--store", "kept", *labelled])
    capsys.readouterr()
    return folder


def test_a_store_with_labels_has_a_matrix(builds: Path, capsys: pytest.CaptureFixture[str]) -> None:
    document = json.loads(trace(capsys, "--evidence", "kept", "--format", "json"))
    names = {each["key"]: each["id"] for each in document["requirements"]}
    assert [
        (build["label"], [(names[each["requirement"]], each["verdict"]) for each in build["verdicts"]])
        for build in document["builds"]
    ] == [
        ("", [("quick", "satisfied"), ("alike", "satisfied"), ("looked_at", "open")]),
        ("v1", [("quick", "satisfied"), ("alike", "satisfied"), ("looked_at", "open")]),
        ("v2", [("quick", "violated"), ("alike", "violated"), ("looked_at", "open")]),
    ]
    lines = trace(capsys, "--evidence", "kept").splitlines()
    start = next(index for index, line in enumerate(lines) if line.startswith("By build"))
    assert [line.split() for line in lines[start : start + 5]] == [
        ["By", "build", "(none)", "v1", "v2"],
        ["---------", "---------", "---------", "--------"],
        ["quick", "satisfied", "satisfied", "violated"],
        ["alike", "satisfied", "satisfied", "violated"],
        ["looked_at", "open", "open", "open"],
    ]
    markdown = trace(capsys, "--evidence", "kept", "--format", "markdown")
    assert "| Requirement | (none) | v1 | v2 |" in markdown
    assert "| quick | satisfied | satisfied | violated |" in markdown
    written = csv.DictReader(io.StringIO(trace(capsys, "--evidence", "kept", "--format", "csv")))
    assert [(row["requirement"], row["build"], row["verdict"]) for row in written if row["kind"] == "build"][:3] == [
        ("quick", "", "satisfied"),
        ("quick", "v1", "satisfied"),
        ("quick", "v2", "violated"),
    ]
    page = trace(capsys, "--evidence", "kept", "--format", "html")
    assert '<h2 id="h-builds">Requirements by build</h2>' in page


def test_without_labels_there_is_none(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main(["verify", "run.btlog", "--store", "kept"])
    assert json.loads(trace(capsys, "--evidence", "kept", "--format", "json"))["builds"] == []
    assert "By build" not in trace(capsys, "--evidence", "kept")
