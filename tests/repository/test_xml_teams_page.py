"""docs/xml-teams.md: its commands, run one after the other on the files that it shows, print what it shows."""

from __future__ import annotations

import re
import shlex
import subprocess
from pathlib import Path

import pytest
from in_process import run_btq

PAGE = Path(__file__).resolve().parents[2] / "docs" / "xml-teams.md"
BLOCK = re.compile(r"^```(xml|toml|yaml|console)\n(.*?)^```$", re.DOTALL | re.MULTILINE)


@pytest.mark.usefixtures("terminal")
def test_the_commands_print_what_the_page_shows(tmp_path: Path, update: bool) -> None:
    subprocess.run(["git", "init", "-q"], cwd=tmp_path, check=True)

    def made(block: re.Match[str]) -> str:
        language, text = block.groups()
        if language == "xml" or (language == "yaml" and text.startswith("# ")):
            path = tmp_path / text.split()[1]
            path.parent.mkdir(exist_ok=True)
            path.write_text(text, encoding="utf-8")
        elif language == "toml":
            (tmp_path / "btq.toml").write_text(text, encoding="utf-8")
        elif language == "console":
            commands = [line for line in text.splitlines() if line.startswith("$ ")]
            text = "".join(f"{command}\n{shown(command[2:], tmp_path)}" for command in commands)
        return f"```{language}\n{text}```"

    page = PAGE.read_text(encoding="utf-8")
    after = BLOCK.sub(made, page)
    if update:
        PAGE.write_text(after, encoding="utf-8")
    assert after == (PAGE.read_text(encoding="utf-8") if update else page)


@pytest.fixture
def terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    """Neither colours nor the formats of a build server."""
    for name in ("GITHUB_ACTIONS", "GITLAB_CI"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("NO_COLOR", "1")


def shown(command: str, folder: Path) -> str:
    """What a command prints; it must not fail."""
    if command.startswith("btq "):
        code, out, err = run_btq(*shlex.split(command)[1:], cwd=folder)
        assert code in (0, 1), err
        return out + err
    return subprocess.run(command, shell=True, cwd=folder, capture_output=True, text=True, check=True).stdout
