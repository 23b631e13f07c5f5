"""docs/day-in-the-life.md: its commands, on a log of the real engine, print what it shows."""

from __future__ import annotations

import re
import shlex
import shutil
from pathlib import Path

import pytest

from btq_lang.cli import main

PAGE = (Path(__file__).parents[2] / "docs" / "day-in-the-life.md").read_text(encoding="utf-8")


def test_the_day(
    shared: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    shutil.copy(shared / "logs" / "lab.btlog", "laboratory.btlog")
    shutil.copy(shared / "logs" / "lab.battery.csv", "battery.csv")
    mission = Path("laboratory.btq")
    codes = []
    for language, text in re.findall(r"^```(\w+)\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE):
        if language == "btq" and not mission.exists():
            mission.write_text(text, encoding="utf-8")
        elif language == "btq":  # a requirement that changes
            before = mission.read_text(encoding="utf-8")
            Path("first.btq").write_text(before, encoding="utf-8")
            head = text.splitlines(keepends=True)[0]
            old = head + before.partition(head)[2].partition("\n\n")[0] + "\n"
            assert old != text
            mission.write_text(before.replace(old, text), encoding="utf-8")
        else:
            command, _, shown = text.partition("\n")
            prompt, program, *arguments = shlex.split(command)
            assert (language, prompt, program) == ("console", "$", "btq")
            capsys.readouterr()
            codes.append(main(arguments))
            assert capsys.readouterr().out == shown
    # build, verify, diff, build, verify: violated, and changed, are findings
    assert codes == [0, 1, 1, 0, 1]
