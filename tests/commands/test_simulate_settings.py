"""`btq check` of a project whose btq.toml says what skills do: each mistake at its line and column."""

from __future__ import annotations

from pathlib import Path

import pytest
from in_process import run_btq

MISSION = """\
signal battery : % from {battery_level} level
Condition BatteryFull
Action MoveBase
Action Charge

BehaviorTree Main
    ->
        MoveBase
        R?
            BatteryFull
            Charge
"""
OTHER = "Action Vacuum\n\nBehaviorTree Clean\n    Vacuum\n"
XML = '<root BTCPP_format="4"><BehaviorTree ID="Wipe"><Action ID="Mop"/></BehaviorTree></root>'
TABLE = """\
engine = "4.10"

[simulate.skills]
MoveBase = { takes = "18 s" }
BatteryFull = { is = "battery >= 95 %" }
Vacuum = { takes = "1 min" }
Mop = { takes = "2 min" }
[simulate.world]
battery = { start = "60 %", while = { Charge = "+1 %/s" } }
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "other").mkdir()
    for name, text in (("main.btq", MISSION), ("other/clean.btq", OTHER), ("wipe.xml", XML), ("btq.toml", TABLE)):
        (tmp_path / name).write_text(text, encoding="utf-8")
    return tmp_path


@pytest.mark.parametrize("paths", [(".",), ("main.btq",), ("other/clean.btq",), ("other",), ("wipe.xml",)])
def test_names_of_any_mission_are_known(folder: Path, paths: tuple[str, ...]) -> None:
    code, _, err = run_btq("check", "--ignore", "no-models", *paths, cwd=folder)
    assert (code, err) == (0, "")


def assert_told(folder: Path, path: str, right: str, wrong: str, problem: str) -> None:
    (folder / "btq.toml").write_text(TABLE.replace(right, wrong, 1), encoding="utf-8")
    code, _, err = run_btq("check", "--ignore", "no-models", path, cwd=folder)
    assert (code, err) == (2, f"btq: btq.toml:{problem}\n")


@pytest.mark.parametrize("path", [".", "main.btq", "other", "wipe.xml"])
@pytest.mark.parametrize(
    ("right", "wrong", "problem"),
    [
        ("Vacuum =", "Vacum =", "6:1: unknown node `Vacum`; did you mean `Vacuum`?"),
        ("Mop =", '"Main/Mop" =', "7:1: no node matches `Main/Mop`"),
        ("{ Charge =", "{ Chrge =", "9:39: unknown node `Chrge`; did you mean `Charge`?"),
        ("battery =", "batery =", "9:1: unknown signal `batery`; did you mean `battery`?"),
    ],
)
def test_a_name_that_no_mission_has_is_told(folder: Path, path: str, right: str, wrong: str, problem: str) -> None:
    """Whichever part of the project is checked."""
    assert_told(folder, path, right, wrong, problem)


@pytest.mark.parametrize(
    ("right", "wrong", "problem"),
    [
        ('"battery >=', '"batery >=', "5:17: unknown signal `batery`; did you mean `battery`?"),
        ("95 %", "95 kg", "5:17: cannot compare `battery` (a percentage) with `95 kg` (a mass)"),
        ('"60 %"', '"60 m"', "9:13: expected a percentage, found `60 m` (a length)"),
        ("%/s", "%", "9:39: expected a value in %/s, found `1 %` (a percentage)"),
        (
            'takes = "1 min"',
            'fails = "1 per h", for = "1 s"',
            "6:1: `Vacuum` is an action; say what it `takes` and how often it `succeeds`",
        ),
    ],
)
def test_a_mistake_is_told_at_its_place(folder: Path, right: str, wrong: str, problem: str) -> None:
    assert_told(folder, ".", right, wrong, problem)


def test_a_name_that_may_be_in_a_file_that_is_missing_is_not_unknown(folder: Path) -> None:
    (folder / "main.btq").write_text(f'include "gone.btq"\n{MISSION}', encoding="utf-8")
    (folder / "btq.toml").write_text(TABLE.replace("Vacuum =", "Hoover ="), encoding="utf-8")
    _, _, err = run_btq("check", ".", cwd=folder)
    assert "Hoover" not in err
