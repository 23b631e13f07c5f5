"""docs/requirements.md: each mission in it is built, and gives the overview that follows it, if one does."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from btq_lang.cli import main

PAGE = Path(__file__).resolve().parents[2] / "docs" / "requirements.md"
BLOCK = re.compile(r"^```btq\n(.*?)^```$", re.DOTALL | re.MULTILINE)
SHOWN = re.compile(r"\s*```console\n\$ btq trace mission\.btq\n(.*?)^```$", re.DOTALL | re.MULTILINE)


TESTED = re.compile(
    r"^```btq\n([^`]*)^```\n\n```console\n\$ btq test mission\.btq\n(.*?)^```$", re.DOTALL | re.MULTILINE
)

TRACED = re.compile(r"^```console\n\$ btq trace mission\.btq\n(.*?)^```$", re.DOTALL | re.MULTILINE)


def test_a_scenario_shows_what_the_page_shows(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    ((mission, shown),) = TESTED.findall(PAGE.read_text(encoding="utf-8"))
    (tmp_path / "mission.btq").write_text(mission, encoding="utf-8")
    assert main(["test", "mission.btq"]) == 0
    assert capfd.readouterr().out == shown
    (overview,) = TRACED.findall(PAGE.read_text(encoding="utf-8").partition(shown)[2])
    assert main(["trace", "mission.btq"]) == 0
    assert capfd.readouterr().out.split("\nISO/IEC 25010")[0] == overview


def steps() -> list[tuple[str, str]]:
    """The missions of the page, each with the overview that follows it, or nothing."""
    text = PAGE.read_text(encoding="utf-8")
    blocks = [(match[1], SHOWN.match(text, match.end())) for match in BLOCK.finditer(text)]
    return [(mission, shown[1] if shown is not None else "") for mission, shown in blocks]


def test_some_missions_are_followed_by_their_overview() -> None:
    assert [bool(shown) for _, shown in steps()].count(True) == 1


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
    assert main(["build", "mission.btq"]) == 0
    capfd.readouterr()
    if not shown:
        return
    assert main(["trace", "mission.btq"]) == 0
    overview = capfd.readouterr().out.split("ISO/IEC 25010")[0].rstrip("\n") + "\n"
    if update:
        before, found, behind = PAGE.read_text(encoding="utf-8").partition(f"```btq\n{mission}```\n")
        PAGE.write_text(before + found + behind.replace(shown, overview, 1), encoding="utf-8")
        return
    assert overview == shown
