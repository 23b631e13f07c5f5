"""docs/test-a-mission.md: its commands print what it shows, and all its scenarios run."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest
from in_process import run_btq

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "test-a-mission.md"
BLOCK = re.compile(r"^```(xml|btq scenario|console)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
OF_README = re.compile(r"^```(xml|btq scenario|console test)\n(.*?)^```$", re.DOTALL | re.MULTILINE)


def test_the_commands_print_what_the_page_shows(tmp_path: Path, update: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NO_COLOR", "1")

    def made(block: re.Match[str]) -> str:
        language, text = block.groups()
        if language == "console":
            command = text.splitlines()[0]
            text = f"{command}\n{run_btq(*shlex.split(command)[2:], cwd=tmp_path)[1]}"
        else:
            (tmp_path / text.split()[1]).write_text(text, encoding="utf-8")
        return f"```{language}\n{text}```"

    page = PAGE.read_text(encoding="utf-8")
    after = BLOCK.sub(made, page)
    if update:
        PAGE.write_text(after, encoding="utf-8")
    assert after == (PAGE.read_text(encoding="utf-8") if update else page)
    for name in ("givens.btq", "changes.btq"):
        code, out, err = run_btq("test", name, cwd=tmp_path)
        assert (code, err) == (0, ""), out


def test_the_readme_shows_what_a_scenario_says(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NO_COLOR", "1")
    blocks = dict(OF_README.findall((ROOT / "README.md").read_text(encoding="utf-8")))
    (tmp_path / "deliver.xml").write_text(blocks["xml"], encoding="utf-8")
    (tmp_path / "deliver-tests.btq").write_text(blocks["btq scenario"], encoding="utf-8")
    command, _, shown = blocks["console test"].partition("\n")
    assert run_btq(*shlex.split(command)[2:], cwd=tmp_path) == (1, shown, "")


def test_the_scenarios_of_the_examples_are_as_expected() -> None:
    code, out, err = run_btq("test", "examples", cwd=ROOT)
    assert (code, err) == (0, ""), out
