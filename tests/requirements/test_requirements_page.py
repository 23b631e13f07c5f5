"""docs/requirements.md: each mission in it checks clean, is built, and gives the overview that follows it."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from btq_lang.cli import main

PAGE = Path(__file__).resolve().parents[2] / "docs" / "requirements.md"
STEP = re.compile(
    r"^```btq\n(?P<mission>.*?)^```$.*?^```console\n\$ btq trace mission\.btq\n(?P<shown>.*?)^```$",
    re.DOTALL | re.MULTILINE,
)


def steps() -> list[tuple[str, str]]:
    return [(match["mission"], match["shown"]) for match in STEP.finditer(PAGE.read_text(encoding="utf-8"))]


def test_there_is_a_step_for_each_mission() -> None:
    assert len(steps()) == PAGE.read_text(encoding="utf-8").count("```btq\n") == 6


@pytest.mark.parametrize(("mission", "shown"), steps(), ids=lambda text: text.split("\n", 1)[0])
def test_a_step(
    mission: str,
    shown: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
    update: bool,
) -> None:
    """The overview begins as the page shows it; the totals, the same kind of table each time, are left out."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mission.btq").write_text(mission, encoding="utf-8")
    assert main(["trace", "mission.btq"]) == 0
    overview = capfd.readouterr().out.split("ISO/IEC 25010")[0].rstrip("\n") + "\n"
    if update:
        before, found, behind = PAGE.read_text(encoding="utf-8").partition(f"```btq\n{mission}```\n")
        PAGE.write_text(before + found + behind.replace(shown, overview, 1), encoding="utf-8")
        return
    assert overview == shown
    assert main(["build", "mission.btq"]) == 0
