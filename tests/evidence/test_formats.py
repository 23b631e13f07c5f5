"""Verdicts as CSV, JUnit XML and Markdown, and as files."""

from __future__ import annotations

import csv
import io
import itertools
import json
import re
import shutil
import subprocess
from xml.etree import ElementTree

import pytest
from evidence_logs import START, Verify, btlog, rows
from ub_test_reports.junitparser import JUnitParser

from btq_lang.commands.verify_options import FORMATS

MISSION = """
Root Main
QualityReq works : reliability "It <works> & \\"well\\""
    mission succeeds in at least 50 % of runs
QualityReq swift : reliability
    Drive takes at most 25 ms
QualityReq sure : reliability
    Drive succeeds in at least 90 % of runs
    confidence 95 %
QualityReq "=grips" : reliability
    Grip needs charge > 5 %
signal charge : % from {charge}
BehaviorTree Main
    -> Errand
        Action Move Drive
        Action Pick Grip
Action Move
Action Pick
"""
RUNS = "0 1R 2R 30 2S 3R 40 3S 1S 1I 50 1R 2R 70 2S 3R 80 3F 1F 1I"
LOOK = (
    "Drive: took 30 ms, bound 25 ms; its median is 20 ms"
    " (run 1 of run.btlog, 30 ms after its start at 2026-11-20 21:22:20.000 UTC)"
)


@pytest.fixture
def judged(verify: Verify) -> Verify:
    """A folder with a mission and a log of two runs."""
    (verify.folder / "main.btq").write_text(MISSION, encoding="utf-8")
    (verify.folder / "run.btlog").write_bytes(btlog(verify.build(MISSION), rows(RUNS)))
    return verify


def written(judged: Verify, form: str) -> str:
    output = judged.text("run.btlog", "--mission", "main.btq", "--format", form)
    assert (judged.code, judged.errors) == (1, "")
    return output


def test_csv(judged: Verify) -> None:
    text = written(judged, "csv")
    assert text.count("\r\n") == 5
    found = {row["requirement"]: row for row in csv.DictReader(io.StringIO(text, newline=""))}
    assert [*found] == ["works", "swift", "sure", "'=grips"]
    assert found["swift"] == {
        "requirement": "swift",
        "title": "",
        "mission": "main",
        "clause": "Drive takes at most 25 ms",
        "path": "Drive",
        "verdict": "violated",
        "unit": "activations",
        "counted": "2",
        "violated": "1",
        "unknown": "0",
        "cut_off": "0",
        "worst": "30 ms",
        "worst_si": "0.03",
        "worst_run": "1",
        "low": "",
        "high": "",
        "more": "",
        "result": "1 of 2 activations, worst 30 ms in run 1",
        "look_at": LOOK,
        "limits": "",
        "suspect": "",
    }
    assert (found["works"]["title"], found["works"]["verdict"], found["works"]["look_at"]) == (
        'It <works> & "well"',
        "satisfied",
        "",
    )
    assert found["sure"]["more"] == "27"


JUNIT = f"""\
<?xml version="1.0" encoding="UTF-8"?>
<testsuites name="btq verify" tests="4" failures="1" errors="0" skipped="2">
  <testsuite name="main" tests="4" failures="1" errors="0" skipped="2" time="0" timestamp="2026-11-20T21:22:20">
    <testcase classname="main" name="works" time="0">
      <properties><property name="verifies" value="works"/></properties>
      <system-out>mission succeeds in at least 50 % of runs: 1 of 2, 50 %; limits 2.53 % to 97.5 % with confidence 95 % each</system-out>
    </testcase>
    <testcase classname="main" name="swift" time="0">
      <properties><property name="verifies" value="swift"/></properties>
      <failure type="violated" message="{LOOK}">
Drive takes at most 25 ms at Drive: violated, 1 of 2 activations, worst 30 ms in run 1
  {LOOK}</failure>
    </testcase>
    <testcase classname="main" name="sure" time="0">
      <properties><property name="verifies" value="sure"/></properties>
      <skipped type="undecided" message="undecided: 2 of 2; 27 more without a violation decide it"/>
    </testcase>
    <testcase classname="main" name="=grips" time="0">
      <properties><property name="verifies" value="=grips"/></properties>
      <skipped type="unknown" message="unknown: no samples of `charge` (2 of 2 activations)"/>
    </testcase>
  </testsuite>
</testsuites>
"""  # noqa: E501  # as it is printed


def test_junit(judged: Verify) -> None:
    assert written(judged, "junit") == JUNIT


def test_sphinx_test_reports_reads_junit(judged: Verify) -> None:
    path = judged.folder / "verdicts.xml"
    path.write_text(written(judged, "junit"), encoding="utf-8")
    (suite,) = JUnitParser(str(path)).parse()
    assert {key: suite[key] for key in ("name", "tests", "failures", "errors", "skips", "passed")} == {
        "name": "main",
        "tests": 4,
        "failures": 1,
        "errors": 0,
        "skips": 2,
        "passed": 1,
    }
    assert [(case["name"], case["result"], case["properties"]) for case in suite["testcases"]] == [
        ("works", "passed", {"verifies": "works"}),
        ("swift", "failed", {"verifies": "swift"}),
        ("sure", "skipped", {"verifies": "sure"}),
        ("=grips", "skipped", {"verifies": "=grips"}),
    ]


@pytest.mark.skipif(shutil.which("strictdoc") is None, reason="strictdoc is not on the PATH: it is 466 MB")
def test_strictdoc_reads_junit(judged: Verify) -> None:
    """StrictDoc itself, which exports what it has read."""
    (judged.folder / "verdicts.gtest.junit.xml").write_text(written(judged, "junit"), encoding="utf-8")
    command = ["strictdoc", "export", ".", "--formats", "json", "--no-parallelization", "--output-dir", "exported"]
    done = subprocess.run(command, cwd=judged.folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    exported = json.loads((judged.folder / "exported" / "json" / "index.json").read_text(encoding="utf-8"))
    (document,) = exported["DOCUMENTS"]
    assert document["TITLE"] == "Test report: main"
    (suite,) = document["NODES"]
    _, *cases = suite["NODES"]
    assert [(each["_NODE_TYPE"], each["TITLE"], each["STATUS"], each["VERIFIES"]) for each in cases] == [
        ("TEST_RESULT", "main.works", "PASSED", "works"),
        ("TEST_RESULT", "main.swift", "FAILED", "swift"),
        ("TEST_RESULT", "main.sure", "SKIPPED", "sure"),
        ("TEST_RESULT", "main.=grips", "SKIPPED", "=grips"),
    ]


def test_junit_is_as_strictdoc_demands(judged: Verify) -> None:
    """Where it is not installed: its reader of `.gtest.junit.xml` (0.30) needs some attributes, refuses errors and
    properties that come twice, and makes fields of the names of properties, of which some are taken."""
    root = ElementTree.fromstring(written(judged, "junit"))
    (suite,) = root.findall("testsuite")
    assert {"name", "tests", "failures", "skipped"} <= {*suite.attrib}
    for case in suite.findall("testcase"):
        assert {"classname", "name", "time"} <= {*case.attrib}
        assert case.find("error") is None
        names = [each.attrib["name"] for each in case.findall("properties/property")]
        fields = {re.sub("[^A-Za-z0-9]", "_", name).upper() for name in names}
        assert len(fields) == len(names)
        assert not fields & {"UID", "TEST_PATH", "TEST_FUNCTION", "DURATION", "STATUS", "TITLE", "STATEMENT"}


PULL_REQUEST = f"""\
### main: 1 violated, 1 unknown, 1 undecided, 1 satisfied

2 runs in `run.btlog`: 1 succeeded, 1 failed

| Verdict | Requirement | Clause | Result |
|---|---|---|---|
| **violated** | **swift** | `Drive takes at most 25 ms`<br>`Drive` | 1 of 2 activations, worst 30 ms in run 1 |
| unknown | **=grips** | `Grip needs charge > 5 %`<br>`Grip` | no samples of \\`charge\\` (2 of 2 activations) |
| undecided | **sure** | `Drive succeeds in at least 90 % of runs`<br>`Drive` | 2 of 2; 27 more without a violation decide it |
| satisfied | **works**<br>It &lt;works> &amp; "well" | `mission succeeds in at least 50 % of runs`<br>`Errand` | 1 of 2, 50 %; limits 2.53 % to 97.5 % with confidence 95 % each |

What to look at:

* {LOOK}
"""  # noqa: E501  # as it is printed


def test_markdown(judged: Verify) -> None:
    assert written(judged, "markdown") == PULL_REQUEST


@pytest.mark.parametrize("form", FORMATS)
def test_every_format_goes_to_a_file(form: str, judged: Verify) -> None:
    printed = written(judged, form)
    assert judged.text("run.btlog", "--mission", "main.btq", "--format", form, "-o", "out/verdicts") == ""
    assert (judged.code, judged.errors) == (1, "")
    assert (judged.folder / "out" / "verdicts").read_bytes().decode() == printed


def test_the_name_of_the_file_says_the_format(judged: Verify) -> None:
    judged.text("run.btlog", "--mission", "main.btq", "-o", "verdicts.md")
    assert (judged.folder / "verdicts.md").read_text(encoding="utf-8") == written(judged, "markdown")


@pytest.mark.parametrize(
    ("name", "more", "error"),
    [
        ("main.btq", (), "-o main.btq may overwrite a mission; choose another file name"),
        ("main.xml", (), "-o main.xml may overwrite a mission; choose another file name"),
        ("a.pdf", (), "cannot write .pdf; choose one of {} with --format, or another file name"),
        ("run.btlog/a.md", (), "run.btlog/a.md: cannot be written: File exists"),
        ("run.btlog/a.xml", ("--format", "junit"), "run.btlog/a.xml: cannot be written: File exists"),
    ],
)
def test_what_cannot_be_written(name: str, more: tuple[str, ...], error: str, judged: Verify) -> None:
    before = {path: path.read_bytes() for path in sorted(judged.folder.iterdir())}
    assert judged.text("run.btlog", "--mission", "main.btq", "-o", name, *more) == ""
    assert judged.code == 2
    assert judged.errors == f"btq verify: {error.format(', '.join(FORMATS))}\n"
    assert {path: path.read_bytes() for path in sorted(judged.folder.iterdir())} == before


def test_a_file_is_written_whole_or_not_at_all(judged: Verify, monkeypatch: pytest.MonkeyPatch) -> None:
    target = judged.folder / "verdicts.json"
    target.write_text("before", encoding="utf-8")

    def fails(source: object, destination: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.replace", fails)
    judged.text("run.btlog", "--mission", "main.btq", "-o", "verdicts.json")
    assert judged.code == 2
    assert judged.errors == "btq verify: verdicts.json: cannot be written: No space left on device\n"
    assert target.read_text(encoding="utf-8") == "before"
    assert sorted(path.name for path in judged.folder.iterdir()) == ["main.btq", "run.btlog", "verdicts.json"]


def test_more_violations_are_explained_when_asked_for(judged: Verify) -> None:
    text = (judged.folder / "main.btq").read_text(encoding="utf-8")
    (judged.folder / "main.btq").write_text(text.replace("Drive takes at most 25 ms", "mission takes at most 25 ms"))
    output = judged.text("run.btlog", "--mission", "main.btq", "--verbose")
    below = [line.strip() for line in output.splitlines() if line.startswith(" " * 19)]
    assert below == [
        "Errand: took 40 ms, bound 25 ms; Drive ran 30 ms of it"
        " (run 1 of run.btlog, 40 ms after its start at 2026-11-20 21:22:20.000 UTC)",
        "- Drive ran 30 ms of it",
        "- Grip ran 10 ms of it",
        "Errand: took 30 ms, bound 25 ms; Drive ran 20 ms of it"
        " (run 2 of run.btlog, 30 ms after its start at 2026-11-20 21:22:20.050 UTC)",
    ]


def test_few_of_many_violations_are_explained(judged: Verify) -> None:
    runs = " ".join(f"{at} 1R 2R {at + 26 + at / 1000} 2S 3S 1S 1I" for at in range(0, 700, 100))
    (judged.folder / "run.btlog").write_bytes(btlog(judged.build(MISSION), rows(runs)))
    output = judged.text("run.btlog", "--mission", "main.btq", "--verbose")
    below = [line.strip().partition(";")[0] for line in output.splitlines() if line.startswith(" " * 19)]
    assert below == [
        "Drive: took 26.6 ms, bound 25 ms",
        *(f"Drive: took {took} ms, bound 25 ms" for took in (26, 26.1, 26.2, 26.3)),
        "… 2 more",
    ]


def test_strict_wants_every_requirement_exercised(judged: Verify) -> None:
    text = MISSION[: MISSION.index("QualityReq works")] + "QualityReq charged : safety\n    Grip takes at most 1 s\n"
    (judged.folder / "main.btq").write_text(text + MISSION[MISSION.index("BehaviorTree") :], encoding="utf-8")
    (judged.folder / "run.btlog").write_bytes(btlog(judged.build(MISSION), rows("0 1R 2R 10 2F 1F 1I")))
    assert "  never exercised  charged" in judged.text("run.btlog", "--mission", "main.btq")
    assert judged.code == 0
    judged.text("run.btlog", "--mission", "main.btq", "--strict")
    assert judged.code == 1


def test_progress_is_shown_to_people_at_a_terminal(judged: Verify, monkeypatch: pytest.MonkeyPatch) -> None:
    clock = itertools.count(step=1.0)
    monkeypatch.setattr("btq_lang.commands.progress.monotonic", lambda: next(clock))
    (judged.folder / "again.btlog").write_bytes(btlog(judged.build(MISSION), rows(RUNS), START + 1_000_000))
    printed = judged.text(".", "--mission", "main.btq")
    assert judged.errors == ""  # the test's streams are no terminal
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    assert judged.text(".", "--mission", "main.btq") == printed
    shown = [line for line in judged.errors.split("\r\x1b[K") if line]
    assert shown == [
        "read 0 of 2 files, 1 run judged",
        "read 0 of 2 files, 2 runs judged",
        "read 1 of 2 files, 3 runs judged",
        "read 1 of 2 files, 4 runs judged",
    ]
    assert judged.errors.endswith("\r\x1b[K")
