"""`btq check`: where the report goes, in which format, and what of it."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from pathlib import Path

import pytest
from in_process import run_btq

from btq_lang import __version__

Check = Callable[..., tuple[int, str, str]]

# Two unknown nodes, an old name with a safe fix, and a literal.
WRONG = """\
BehaviorTree Main
    ->
        Sequnce
            Dock
        Sequnce
            Dock
        SequenceStar
            Dock
        Timeout (msec = -5)
            Dock
"""


@pytest.fixture
def check(tmp_path: Path) -> Check:
    """`btq check` in a folder with a mission."""
    (tmp_path / "main.btq").write_text(WRONG)
    return lambda *arguments: run_btq("check", *arguments, cwd=tmp_path)


def test_findings_may_leave_the_exit_code_zero(check: Check) -> None:
    code, report, _ = check()
    assert code == 1
    assert check("--exit-zero") == (0, report, "")
    assert check("--exit-zero", "nowhere.btq")[0] == 2


def test_statistics_count_by_rule_most_first(check: Check) -> None:
    code, printed, errors = check("--statistics")
    assert (code, errors) == (1, "")
    *rows, summary = printed.splitlines()
    assert rows == ["2  [ ] unknown-node", "1  [ ] invalid-literal", "1  [*] not-an-engine-node"]
    assert summary == "Found 1 error, 3 warnings (1 fixable with --fix)"
    assert check("--statistics", "--output-format", "concise") == (1, printed, "")


def test_statistics_mark_what_fix_fixes(check: Check, tmp_path: Path) -> None:
    (tmp_path / "main.btq").write_text("BehaviorTree Main\n    Sequnce\n        Dock\n")
    assert check("--statistics")[1].splitlines()[0] == "1  unknown-node"  # nothing is fixable, so there are no marks
    (tmp_path / "main.btq").write_text("BehaviorTree Main\n    AlwaysSuccess\n")
    assert check("--statistics") == (0, "No problems found in 1 file\n", "")


def test_statistics_as_json(check: Check) -> None:
    code, printed, _ = check("--statistics", "--output-format", "json")
    assert code == 1
    assert json.loads(printed) == {
        "format": 1,
        "tool": "btq",
        "version": __version__,
        "statistics": [
            {"rule": "unknown-node", "count": 2, "fixable": 0},
            {"rule": "invalid-literal", "count": 1, "fixable": 0},
            {"rule": "not-an-engine-node", "count": 1, "fixable": 1},
        ],
        "summary": {"error": 1, "warning": 3, "info": 0, "hint": 0, "fixable": 1, "files": 1},
    }
    code, printed, _ = check("--statistics", "--output-format", "json", "nowhere.btq")
    assert code == 2
    assert json.loads(printed)["statistics"] == [{"rule": "io-error", "count": 1, "fixable": 0}]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--statistics", "--output-format", "sarif"), "cannot be written as sarif; choose one of full, concise, json"),
        (("--output-file", "main.btq"), "--output-file main.btq may overwrite a mission; choose another file name"),
        (("-o", "tree.xml"), "--output-file tree.xml may overwrite a mission; choose another file name"),
    ],
)
def test_usage_errors_of_reports(check: Check, tmp_path: Path, arguments: tuple[str, ...], message: str) -> None:
    code, printed, errors = check(*arguments)
    assert (code, printed) == (2, "")
    assert errors.endswith(f"{message}\n")
    assert os.listdir(tmp_path) == ["main.btq"]
    assert (tmp_path / "main.btq").read_text() == WRONG


def test_a_report_goes_into_a_file(check: Check, tmp_path: Path) -> None:
    for form, name in (("full", "report.txt"), ("junit", "reports/btq.xml"), ("json", "report.json")):
        report = check("--output-format", form)[1]
        assert check("--output-format", form, "--output-file", name) == (1, "", "")
        assert (tmp_path / name).read_text() == report


def test_a_report_is_written_whole_or_not_at_all(check: Check, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "report.txt").write_text("of yesterday")

    def refuse(*_: object) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(os, "replace", refuse)
    code, printed, errors = check("--output-file", "report.txt")
    assert (code, printed) == (2, "")
    assert errors == "btq check: report.txt: cannot be written: Permission denied\n"
    assert (tmp_path / "report.txt").read_text() == "of yesterday"
    assert sorted(os.listdir(tmp_path)) == ["main.btq", "report.txt"]


def test_a_code_host_chooses_the_format_it_reads(check: Check, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    full, annotations = check()[1], check("--output-format", "github")[1]
    monkeypatch.setenv("GITHUB_ACTIONS", "true")
    assert check() == (1, annotations, "")
    assert check("--output-format", "full") == (1, full, "")
    assert check("--statistics")[1].startswith("2  [ ] unknown-node\n")
    assert check("-o", "report") == (1, "", "")
    assert (tmp_path / "report").read_text() == full
    monkeypatch.delenv("GITHUB_ACTIONS")
    monkeypatch.setenv("GITLAB_CI", "true")
    assert check() == (1, full, "")
    assert check("-o", "report") == (1, "", "")
    assert (tmp_path / "report").read_text() == check("--output-format", "gitlab")[1]


def identities(printed: str) -> dict[str, tuple[str, int]]:
    """The path and the line of each fingerprint."""
    issues = json.loads(printed)
    found = {each["fingerprint"]: each["location"] for each in issues}
    assert len(found) == len(issues)
    return {name: (at["path"], at["positions"]["begin"]["line"]) for name, at in found.items()}


def test_code_quality_for_gitlab(check: Check, tmp_path: Path) -> None:
    code, printed, _ = check("--output-format", "gitlab", "main.btq", "nowhere.btq")
    trouble, first, *others = json.loads(printed)
    assert code == 2
    assert (trouble["check_name"], trouble["severity"], trouble["location"]["path"]) == (
        "io-error",
        "critical",
        "nowhere.btq",
    )
    assert {name: value for name, value in first.items() if name != "fingerprint"} == {
        "description": "unknown-node: unknown node `Sequnce`; did you mean `Sequence`?",
        "check_name": "unknown-node",
        "severity": "minor",
        "location": {
            "path": "main.btq",
            "positions": {"begin": {"line": 3, "column": 9}, "end": {"line": 3, "column": 16}},
        },
    }
    assert [each["severity"] for each in others] == ["minor", "minor", "major"]
    (tmp_path / "main.btq").write_text("BehaviorTree Main\n    AlwaysSuccess\n")
    assert check("--output-format", "gitlab") == (0, "[]\n", "")


def test_fingerprints_stay_where_lines_move(check: Check, tmp_path: Path) -> None:
    before = identities(check("--output-format", "gitlab")[1])
    moved = "# one more line\n" + WRONG.replace("    ", "  ")
    (tmp_path / "main.btq").write_text(moved)
    after = identities(check("--output-format", "gitlab")[1])
    assert after == {name: (path, line + 1) for name, (path, line) in before.items()}
    (tmp_path / "main.btq").write_text(WRONG.replace("-5", "-6"))
    assert len(before.keys() - identities(check("--output-format", "gitlab")[1]).keys()) == 1


def test_paths_for_gitlab_are_those_of_its_checkout(
    check: Check, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CI_PROJECT_DIR", str(tmp_path.parent))
    found = identities(check("--output-format", "gitlab")[1])
    assert {path for path, _ in found.values()} == {f"{tmp_path.name}/main.btq"}
