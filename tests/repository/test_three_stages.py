"""docs/three-stages.md: its commands draw its pictures; `--update` draws them again."""

from __future__ import annotations

import re
import shlex
import shutil
from pathlib import Path

import pytest

from btq_lang.cli import main

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "three-stages.md").read_text(encoding="utf-8")
COMMANDS = re.findall(r"^\$ btq (.*)$", PAGE, re.MULTILINE)
PICTURES = re.findall(r"\]\((.*?\.svg)\)", PAGE)


def test_the_commands_draw_the_pictures(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, update: bool) -> None:
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    monkeypatch.chdir(tmp_path)
    (mission,) = re.findall(r"^```btq\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE)
    Path("early.btq").write_text(mission, encoding="utf-8")
    assert [main(shlex.split(command)) for command in COMMANDS] == [0, 0, 0]
    assert PICTURES == ["stage-a.svg", "stage-b.svg", "stage-c.svg"]
    for name in PICTURES:
        if update:
            shutil.copy(name, ROOT / "docs" / name)
        assert Path(name).read_bytes() == (ROOT / "docs" / name).read_bytes()
    # A has the quality, B the bounds, C the values and the history.
    a, b, c = ((ROOT / "docs" / name).read_text(encoding="utf-8") for name in PICTURES)
    assert ["performance-efficiency" in each for each in (a, b, c)] == [True, True, True]
    assert ["takes at most 30 s" in each for each in (a, b, c)] == [False, True, True]
    assert ["last run: 30.9 s, violated" in each for each in (a, b, c)] == [False, False, True]
    assert [each.count('<g class="sparkline">') for each in (a, b, c)] == [0, 0, 3]
