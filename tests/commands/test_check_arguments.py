"""`btq check`: where paths may be among options, project files as paths, and encodings without some signs."""

from __future__ import annotations

from pathlib import Path

import pytest
from in_process import run_btq

WRONG = "BehaviorTree Main\n    Sequnce\n        Dock\n"
FOUND = "2:5: warning[unknown-node] unknown node `Sequnce`; did you mean `Sequence`?"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name in ("a.btq", "b.btq", "c.btq"):
        (tmp_path / name).write_text(WRONG)
    return tmp_path


@pytest.mark.parametrize(
    "arguments",
    [
        ("a.btq", "--output-format", "concise", "b.btq"),
        ("--output-format", "concise", "a.btq", "b.btq"),
        ("a.btq", "b.btq", "--output-format", "concise"),
        ("a.btq", "--output-format=concise", "--ignore", "unused-tree", "b.btq"),
    ],
)
def test_paths_on_both_sides_of_an_option(arguments: tuple[str, ...], folder: Path) -> None:
    printed = f"a.btq:{FOUND}\nb.btq:{FOUND}\nFound 2 warnings\n"
    assert run_btq("check", *arguments, cwd=folder) == (1, printed, "")


def test_no_path_is_this_folder(folder: Path) -> None:
    assert run_btq("check", "--output-format", "concise", cwd=folder)[1].endswith("Found 3 warnings\n")


def test_an_unknown_option_is_no_path(folder: Path) -> None:
    code, printed, errors = run_btq("check", "a.btq", "--wrong", cwd=folder)
    assert (code, printed, errors.splitlines()[-1]) == (2, "", "btq check: error: unrecognized arguments: --wrong")


def test_a_project_file_stands_for_its_folder(folder: Path) -> None:
    (folder / "robot").mkdir()
    (folder / "robot" / "d.btq").write_text(WRONG)
    project = folder / "robot" / "btq.toml"
    project.write_text('ignore = ["unknown-node"]\n')
    assert run_btq("check", "robot/btq.toml", cwd=folder) == (0, "No problems found in 1 file\n", "")
    project.write_text('engin = "4.10"\n')
    errors = run_btq("check", "--output-format", "concise", "robot/btq.toml", cwd=folder)[2]
    assert errors == "btq: robot/btq.toml:1:1: unknown key `engin`; did you mean `engine`?\n"
