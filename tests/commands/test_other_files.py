"""`btq check` of files that are no missions: project files, and what is not checked."""

from __future__ import annotations

from pathlib import Path

import pytest
from in_process import run_btq

MISSION = "BehaviorTree Main\n    Dock\n"
UNKNOWN_KEY = "unknown key `engin`; did you mean `engine`?"


@pytest.mark.parametrize(
    ("file", "text", "line"),
    [("btq.toml", 'engin = "4.6"\n', 1), ("pyproject.toml", '[project]\n\n[tool.btq]\nengin = "4.6"\n', 4)],
)
def test_mistakes_in_a_project_file_are_findings(file: str, text: str, line: int, tmp_path: Path) -> None:
    (tmp_path / file).write_text(text)
    (tmp_path / "main.btq").write_text(MISSION)
    told = f"btq: {file}:{line}:1: {UNKNOWN_KEY}\n"
    assert run_btq("check", file, cwd=tmp_path) == (1, "Found 1 error\n", told)
    assert run_btq("check", file, "main.btq", cwd=tmp_path) == (1, "Found 1 error\n", told)
    assert run_btq("check", "--exit-zero", file, cwd=tmp_path) == (0, "Found 1 error\n", told)
    assert run_btq("check", "main.btq", cwd=tmp_path)[0] == 2
    (tmp_path / file).write_text(text.replace("engin ", "engine "))
    assert run_btq("check", file, cwd=tmp_path) == (0, "No problems found in 1 file\n", "")


@pytest.mark.parametrize(
    ("file", "reason"),
    [
        ("pyproject.toml", "has no [tool.btq], where btq reads settings"),
        ("main.qreq.json", "is what a build writes; check main.xml beside it"),
        (
            "main.txt",
            "cannot be checked; expected a folder, btq.toml, or a file that ends in .btq, .qualitybtcpp, .xml, "
            ".btproj, .yaml, .yml",
        ),
        ("lost.toml", "cannot be read: No such file or directory"),
    ],
)
def test_other_files_are_refused_and_the_rest_is_checked(file: str, reason: str, tmp_path: Path) -> None:
    (tmp_path / "main.btq").write_text(MISSION)
    if file != "lost.toml":
        (tmp_path / file).write_text("[project]\n")
    told = f"btq: {file}: {reason}\n"
    assert run_btq("check", file, cwd=tmp_path) == (2, "No files were checked\n", told)
    several = run_btq("check", "main.btq", file, cwd=tmp_path)
    assert several == (2, f"Found nothing; incomplete because of {told.removeprefix('btq: ')}", told)


def test_the_last_line_says_why_the_code_is_2(tmp_path: Path) -> None:
    factory = '[[factory]]\nname = "robot"\nload = ["*.btq"]\n'
    (tmp_path / "btq.toml").write_text(factory * 2)
    (tmp_path / "main.btq").write_text(f"{MISSION}BehaviorTree Main\n    Dock\n")
    code, out, err = run_btq("check", cwd=tmp_path)
    why = "btq.toml:5:8: duplicate factory `robot`"
    assert (code, out.splitlines()[-1], err) == (2, f"Found 1 error; incomplete because of {why}", f"btq: {why}\n")


def test_of_two_project_files_one_counts(tmp_path: Path) -> None:
    (tmp_path / "btq.toml").write_text("")
    (tmp_path / "pyproject.toml").write_text("[tool.btq]\n")
    _, _, told = run_btq("check", "pyproject.toml", cwd=tmp_path)
    assert told == "btq: pyproject.toml: is not read, because btq.toml beside it is\n"
