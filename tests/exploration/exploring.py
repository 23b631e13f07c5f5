"""`btq explore` in a folder of its own."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from btq_lang.cli import main


class Exploring:
    """The command in a folder of its own."""

    def __init__(self, folder: Path, output: pytest.CaptureFixture[str]) -> None:
        self.folder = folder
        self._output = output
        self._written = ""

    def tree(self, xml: str, name: str = "tree.xml", version: int = 4) -> None:
        """A file with one tree."""
        start = f'<root BTCPP_format="{version}">\n<BehaviorTree ID="Main">\n'
        self.mission(f"{start}{xml}\n</BehaviorTree>\n</root>\n", name)

    def mission(self, text: str, name: str = "mission.btq") -> None:
        """A file, which is explored from now on."""
        self._written = name
        (self.folder / name).write_text(text, encoding="utf-8")

    def __call__(self, *arguments: str) -> tuple[int, str, str]:
        """The exit code, the output and the messages."""
        self._output.readouterr()
        named = [] if any(argument.endswith((".xml", ".btq")) for argument in arguments) else [self._written]
        code = main(["explore", *named, *arguments])
        captured = self._output.readouterr()
        return code, captured.out, captured.err

    def can(self, question: str, *arguments: str) -> tuple[int, str]:
        """The exit code of a question, and the answer with its witness, without the first line."""
        code, out, err = self("--can", question, *arguments)
        assert err == ""
        return code, out.partition("\n")[2]

    def json(self, *arguments: str) -> Any:
        """What is written for programs."""
        return json.loads(self("--format", "json", *arguments)[1])


@pytest.fixture
def explore(tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Exploring:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("NO_COLOR", "1")
    return Exploring(tmp_path, capsys)
