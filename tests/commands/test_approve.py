"""`btq approve`: what it writes, where, and when it writes nothing."""

from __future__ import annotations

import os
import sys
from datetime import date
from pathlib import Path

import pytest
from in_process import run_btq

MISSION = """\
include "lib.btq"
QualityReq top "Top"
QualityReq line : safety "x" mission takes at most 3 s  # why
BehaviorTree Main
    ->
        A satisfies QualityReq q1 takes at most 3 s, q3
        B (satisfies QualityReq q2
            takes at most 3 s)
        C
            satisfies QualityReq q4
                takes at most 4 s
                # last
QualityReq q3 : safety
    takes at most 3 s   # three

QualityReq ID = "classic" description = "FailureIf takes more than 3 s"
"""
LIBRARY = """\
QualityReq lib : safety "x"
    mission takes at most 3 s
    approved by "Lee" on "2026-01-01" of "1:000000000000"
    approved by "Kim" on "2026-01-01" of "1:000000000000"
"""
NAMES = ("top", "line", "q1", "q2", "q3", "q4", "classic", "lib")


@pytest.fixture
def robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "btq.toml").write_text("")
    (tmp_path / "mission.btq").write_text(MISSION)
    (tmp_path / "lib.btq").write_text(LIBRARY)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def btq(*arguments: str) -> tuple[int, str, str]:
    return run_btq(*arguments, cwd=Path.cwd())


def approve(*arguments: str) -> tuple[int, str, str]:
    return btq("approve", *arguments, "--date", "2026-11-29")


def approve_as(name: str, on: str, by: str = "Kim") -> tuple[int, str, str]:
    return btq("approve", name, "--by", by, "--date", on)


def test_a_requirement_is_approved_wherever_it_is(robot: Path) -> None:
    code, out, error = approve(*NAMES, "--by", "Kim")
    assert (code, error) == (0, "8 requirements, 2 files written\n")
    of = {name: line.split()[-1] for name, line in zip(NAMES, out.splitlines(), strict=True)}
    clause = {name: f'approved by "Kim" on "2026-11-29" of "{fingerprint}"' for name, fingerprint in of.items()}
    assert (
        (robot / "mission.btq").read_text()
        == f"""\
include "lib.btq"
QualityReq top "Top"
    {clause["top"]}
QualityReq line : safety "x" mission takes at most 3 s  # why
    {clause["line"]}
BehaviorTree Main
    ->
        A satisfies QualityReq q1 takes at most 3 s {clause["q1"]}, q3
        B (satisfies QualityReq q2
            takes at most 3 s {clause["q2"]})
        C
            satisfies QualityReq q4
                takes at most 4 s
                {clause["q4"]}
                # last
QualityReq q3 : safety
    takes at most 3 s   # three
    {clause["q3"]}

QualityReq ID = "classic" description = "FailureIf takes more than 3 s"
    {clause["classic"]}
"""
    )
    assert (robot / "lib.btq").read_text() == LIBRARY.replace(
        'approved by "Kim" on "2026-01-01" of "1:000000000000"', clause["lib"]
    )
    assert "approval-outdated" in btq("check")[1]  # that of Lee
    assert btq("check", "--select", "approval-outdated")[1].count("warning[") == 1
    assert approve(*NAMES, "--by", "Kim")[::2] == (0, "8 requirements, 0 files written\n")


def test_it_is_suspect_after_a_change(robot: Path) -> None:
    approve("q3", "--by", "Kim")
    assert "q3" not in btq("check", "--select", "approval-outdated")[1]
    path = robot / "mission.btq"
    path.write_text(
        path.read_text().replace("takes at most 3 s   # three\n", "takes at most 3 s\n    on violation warn\n")
    )
    code, out, _ = btq("check", "--select", "approval-outdated", "mission.btq")
    assert code == 1
    assert "`q3` has changed since Kim approved it on 2026-11-29" in out
    assert "note: `on violation warn` was added since then" in out
    assert approve("q3", "--by", "Kim")[0] == 0
    assert "q3" not in btq("check", "--select", "approval-outdated", "mission.btq")[1]


def test_a_project_can_require_approvals(robot: Path) -> None:
    def missing() -> int:
        return btq("check", "--select", "approval-missing")[1].count("warning[approval-missing]")

    assert missing() == 0
    (robot / "btq.toml").write_text('[requirements]\napproval = "required"\n')
    assert missing() == len(NAMES) - 1  # that of the library is approved, though outdated
    approve("q1", "q2", "--by", "Kim")
    assert missing() == len(NAMES) - 3


def test_an_approval_without_a_fingerprint_is_told_where_approvals_are_required(robot: Path) -> None:
    (robot / "hand.btq").write_text('QualityReq r "R"\n    approved by "Kim L." on "2026-05-04"\n')
    check = ("check", "--select", "approval-missing", "hand.btq")
    assert btq(*check)[0] == 0
    (robot / "btq.toml").write_text('[requirements]\napproval = "required"\n')
    code, out, _ = btq(*check)
    assert (code, out.count("warning[")) == (1, 1)
    assert "warning[approval-missing]: the approval of `r` by Kim L. has no fingerprint, so no change is noticed" in out
    again = "`btq approve r --by 'Kim L.' --date 2026-05-04` adds it"
    assert f"note: if it is of what is written now, {again}" in out
    assert approve_as("r", "2026-05-04", "Kim L.")[1].startswith(
        "hand.btq: `r` approved by Kim L. (replaces the approval of 2026-05-04), 1:"
    )
    assert btq(*check)[0] == 0


def test_what_is_replaced_is_said(robot: Path) -> None:
    assert approve_as("top", "2026-05-04")[1].startswith("mission.btq: `top` approved by Kim, 1:")
    first = (robot / "mission.btq").read_text()
    assert approve_as("top", "2026-05-04")[1].startswith("mission.btq: `top` was approved already by Kim, 1:")
    assert btq("approve", "top", "--by", "Kim")[1].startswith("mission.btq: `top` was approved already by Kim, 1:")
    assert (robot / "mission.btq").read_text() == first
    assert approve_as("top", "2026-06-01")[1].startswith(
        "mission.btq: `top` approved by Kim (replaces the approval of 2026-05-04), 1:"
    )
    assert (robot / "mission.btq").read_text() == first.replace("2026-05-04", "2026-06-01")


def test_today_is_the_default(robot: Path) -> None:
    assert btq("approve", "top", "--by", "Kim")[0] == 0
    assert f'on "{date.today().isoformat()}"' in (robot / "mission.btq").read_text()


def test_nothing_is_written_if_one_cannot_be_approved(robot: Path) -> None:
    assert approve("q3", "topp", "--by", "Kim") == (
        1,
        "unknown requirement `topp`; did you mean `top`?\n",
        "nothing written\n",
    )
    (robot / "other.btq").write_text('QualityReq q3 "Another"\n')
    assert approve("q3", "--by", "Kim")[:2] == (
        1,
        "`q3` is defined differently at mission.btq:13, other.btq:1; choose with --in\n",
    )
    (robot / "other.btq").write_text('QualityReq torn "Another"\n    takes\n')
    assert approve("torn", "--by", "Kim")[:2] == (1, "other.btq:1: `torn` has mistakes, which `btq check` shows\n")
    assert (robot / "mission.btq").read_text() == MISSION


def test_in_chooses_files(robot: Path) -> None:
    (robot / "other.btq").write_text('QualityReq q3 "Another"\n')
    assert approve("q3", "--by", "Kim", "--in", "other.btq")[0] == 0
    assert (robot / "mission.btq").read_text() == MISSION
    assert "approved by" in (robot / "other.btq").read_text()


def test_the_same_definition_in_several_files_is_approved_in_each(robot: Path) -> None:
    for name in ("a.btq", "b.btq"):
        (robot / name).write_text('QualityReq same "Same"\n    mission takes at most 3 s\n')
    assert approve("same", "--by", "Kim", "--in", "a.btq", "--in", "b.btq")[::2] == (
        0,
        "1 requirement, 2 files written\n",
    )
    assert (robot / "a.btq").read_text() == (robot / "b.btq").read_text()


def test_line_ends_and_tabs_stay(robot: Path) -> None:
    (robot / "dos.btq").write_bytes(b'QualityReq dos "Dos"\r\n\tmission takes at most 3 s\r\nQualityReq after "A"')
    assert approve("dos", "after", "--by", 'K "x"')[0] == 0
    text = (robot / "dos.btq").read_bytes().decode()
    assert text.count("\r\n") == text.count("\n") - 1 == 3
    assert text.splitlines()[2].startswith('\tapproved by "K \\"x\\"" on "2026-11-29" of "1:')


def test_usage(robot: Path) -> None:
    assert btq("approve", "top", "--by", "Kim", "--date", "29.11.2026") == (
        2,
        "",
        "btq approve: --date 29.11.2026: expected a date as 2026-11-29\n",
    )
    assert approve("top", "--by", " ") == (2, "", "btq approve: --by needs a name\n")
    assert approve("top", "--by", "Kim", "--in", "nowhere.btq")[0] == 2
    assert (robot / "mission.btq").read_text() == MISSION


@pytest.mark.skipif(sys.platform == "win32" or os.geteuid() == 0, reason="root may write anywhere")
def test_a_folder_that_cannot_be_written(robot: Path) -> None:
    robot.chmod(0o500)
    try:
        assert approve("top", "--by", "Kim")[0] == 2
        assert (robot / "mission.btq").read_text() == MISSION
    finally:
        robot.chmod(0o700)
