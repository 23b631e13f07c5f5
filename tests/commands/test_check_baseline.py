"""`btq check --baseline`: only what is new, wherever lines and files move."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from pathlib import Path

import pytest
from in_process import run_btq

Check = Callable[..., tuple[int, str, str]]

WRONG = "BehaviorTree Main\n    ->\n        Sequnce\n            Dock\n        Sequnce\n            Dock\n"
CLEAN = "BehaviorTree Main\n    AlwaysSuccess\n"


@pytest.fixture
def check(tmp_path: Path) -> Check:
    """`btq check --baseline known.json` in a folder with a mission that has two equal findings."""
    (tmp_path / "main.btq").write_text(WRONG)
    options = ("--output-format", "concise", "--baseline", "known.json")
    return lambda *arguments: run_btq("check", *options, *arguments, cwd=tmp_path)


def found(printed: str) -> list[str]:
    return [line.split(" unknown")[0] for line in printed.splitlines()[:-1]]


def test_what_a_baseline_has_is_not_reported(check: Check, tmp_path: Path) -> None:
    clean = "No new problems found in 1 file, and 2 in the baseline\n"
    assert check("--update-baseline") == (0, clean, "known.json: 2 added, 0 removed, 0 kept\n")
    assert json.loads((tmp_path / "known.json").read_text()) == {
        "format": 1,
        "tool": "btq",
        "findings": [{"path": "main.btq", "rule": "unknown-node", "fingerprint": "4fe2b4eead4a12c6", "count": 2}],
    }
    assert check() == (0, clean, "")


def test_a_third_equal_finding_is_new(check: Check, tmp_path: Path) -> None:
    check("--update-baseline")
    (tmp_path / "main.btq").write_text(WRONG + "        Sequnce\n            Dock\n        Rety\n            Dock\n")
    code, printed, _ = check()
    assert code == 1
    assert found(printed) == ["main.btq:7:9: warning[unknown-node]", "main.btq:9:9: warning[unknown-node]"]
    assert printed.endswith("Found 2 warnings, and 2 in the baseline\n")


def test_moved_lines_and_files_stay_known(check: Check, tmp_path: Path) -> None:
    check("--update-baseline")
    (tmp_path / "main.btq").write_text("# a line\n" + WRONG.replace("    ", "\t"))
    assert check()[0] == 0
    (tmp_path / "lib").mkdir()
    (tmp_path / "main.btq").rename(tmp_path / "lib" / "moved.btq")
    assert check()[0] == 0
    (tmp_path / "copy.btq").write_text(WRONG)  # one of the two files has the findings in addition
    assert len(found(check()[1])) == 2


def test_a_copy_of_a_known_file_is_new(check: Check, tmp_path: Path) -> None:
    check("--update-baseline")
    (tmp_path / "copy.btq").write_text(WRONG)
    assert [line.split(":")[0] for line in found(check()[1])] == ["copy.btq", "copy.btq"]


def test_an_update_removes_what_was_mended(check: Check, tmp_path: Path) -> None:
    check("--update-baseline")
    (tmp_path / "main.btq").write_text(WRONG.replace("Sequnce", "Sequence", 1) + "        Rety\n            Dock\n")
    assert check("--update-baseline")[::2] == (0, "known.json: 1 added, 1 removed, 1 kept\n")
    (tmp_path / "main.btq").write_text(CLEAN)
    assert check("--update-baseline")[::2] == (0, "known.json: 0 added, 2 removed, 0 kept\n")
    assert (tmp_path / "known.json").read_text() == '{\n  "format": 1,\n  "tool": "btq",\n  "findings": []\n}\n'
    assert check("--update-baseline")[::2] == (0, "known.json: 0 added, 0 removed, 0 kept\n")


def test_an_update_keeps_the_findings_of_files_that_were_not_checked(check: Check, tmp_path: Path) -> None:
    for name in ("other.btq", "gone.btq"):
        (tmp_path / name).write_text(WRONG)
    check("--update-baseline")
    before = (tmp_path / "known.json").read_bytes()
    (tmp_path / "gone.btq").unlink()
    assert check("--update-baseline", "main.btq")[2] == "known.json: 0 added, 2 removed, 4 kept\n"
    after = (tmp_path / "known.json").read_bytes()
    assert [json.loads(each)["findings"][0]["path"] for each in (before, after)] == ["gone.btq", "main.btq"]
    assert check()[0] == 0


def test_the_bytes_depend_on_the_findings_alone(check: Check, tmp_path: Path) -> None:
    (tmp_path / "a.btq").write_text(WRONG)
    check("--update-baseline", "main.btq", "a.btq")
    first = (tmp_path / "known.json").read_bytes()
    (tmp_path / "known.json").unlink()
    check("--update-baseline", "a.btq")
    check("--update-baseline", "main.btq")
    assert (tmp_path / "known.json").read_bytes() == first


def test_the_project_file_names_it(check: Check, tmp_path: Path) -> None:
    (tmp_path / "btq.toml").write_text('baseline = "ci/known.json"\n')
    (tmp_path / "ci").mkdir()
    (tmp_path / "lib").mkdir()
    assert run_btq("check", "--update-baseline", cwd=tmp_path)[2] == "ci/known.json: 2 added, 0 removed, 0 kept\n"
    assert '"path": "../main.btq"' in (tmp_path / "ci" / "known.json").read_text()
    assert run_btq("check", "../main.btq", cwd=tmp_path / "lib")[0] == 0


def test_what_cannot_be_silenced_is_always_reported(check: Check, tmp_path: Path) -> None:
    (tmp_path / "main.btq").write_text('BehaviorTree Main\n    Dock "a\n')
    code, printed, errors = check("--update-baseline")
    assert (code, errors) == (1, "known.json: 0 added, 0 removed, 0 kept\n")
    assert "error[unclosed-string]" in printed


@pytest.mark.parametrize(
    "text", ["", "{", "[]", '{"format": 2, "tool": "btq", "findings": []}', '{"format": 1, "tool": "btq"}', WRONG]
)
def test_what_is_no_baseline_is_left_as_it_is(check: Check, tmp_path: Path, text: str) -> None:
    (tmp_path / "known.json").write_text(text)
    message = "btq: known.json: this is not a baseline that `btq check --update-baseline` wrote\n"
    for option in ((), ("--update-baseline",)):
        code, printed, errors = check(*option)
        assert (code, errors) == (2, message)
        assert len(found(printed)) == 2
        assert (tmp_path / "known.json").read_text() == text


def test_a_baseline_that_is_not_there(check: Check, tmp_path: Path) -> None:
    code, printed, errors = check()
    assert (code, len(found(printed))) == (2, 2)
    assert errors == "btq: known.json: does not exist; `btq check --update-baseline` creates it\n"
    message = "btq check: no baseline to update; name it with --baseline, or in btq.toml\n"
    assert run_btq("check", "--update-baseline", cwd=tmp_path) == (2, "", message)


@pytest.mark.parametrize("option", ["--select=unknown-node", "--ignore=unknown-node", "--severity=error", "--diff"])
def test_an_update_needs_all_findings(check: Check, tmp_path: Path, option: str) -> None:
    message = f"--update-baseline needs all findings; leave out {option.partition('=')[0]}"
    assert check("--update-baseline", option) == (2, "", f"btq check: {message}\n")
    assert not (tmp_path / "known.json").exists()


def test_an_update_is_whole_or_not_at_all(check: Check, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert check("--update-baseline", "main.btq", "nowhere.btq")[0] == 2
    assert not (tmp_path / "known.json").exists()
    check("--update-baseline")
    before = (tmp_path / "known.json").read_bytes()
    (tmp_path / "main.btq").write_text(CLEAN)

    def refuse(*_: object) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(os, "replace", refuse)
    code, _, errors = check("--update-baseline")
    assert (code, errors) == (2, "btq: known.json: cannot be written: Permission denied\n")
    assert (tmp_path / "known.json").read_bytes() == before
    assert sorted(os.listdir(tmp_path)) == ["known.json", "main.btq"]
