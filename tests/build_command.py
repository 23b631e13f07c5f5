"""`btq build` in a folder of its own."""

from __future__ import annotations

from pathlib import Path

import pytest

from btq_lang.cli import main

GUESSED = (
    "categories guessed from the use of the nodes: {}; "
    "declare a node whose category is wrong, for example `Condition Name`\n"
)


class Btq:
    """The command in a folder of its own."""

    def __init__(self, folder: Path, output: pytest.CaptureFixture[str]) -> None:
        self.folder = folder
        self._output = output

    def write(self, **files: str) -> None:
        """Files, `__` in a name for `/`; without an ending they are missions."""
        for name, text in files.items():
            path = self.folder / (name.replace("__", "/") + ("" if "." in name else ".btq"))
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")

    def read(self, name: str) -> str:
        return (self.folder / name).read_text(encoding="utf-8")

    @property
    def files(self) -> list[str]:
        return sorted(path.relative_to(self.folder).as_posix() for path in self.folder.rglob("*") if path.is_file())

    def build(self, *arguments: str) -> tuple[int, str, str]:
        """The exit code, the output and the messages."""
        self._output.readouterr()
        code = main(["build", *arguments])
        captured = self._output.readouterr()
        return code, captured.out, captured.err


@pytest.fixture
def btq(tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Btq:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("NO_COLOR", "1")
    return Btq(tmp_path, capsys)
