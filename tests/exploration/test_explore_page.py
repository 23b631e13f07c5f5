"""docs/what-can-happen.md: its commands print what it shows."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest
from in_process import run_btq

PAGE = Path(__file__).resolve().parents[2] / "docs" / "what-can-happen.md"
BLOCK = re.compile(r"^```(xml|console)\n(.*?)^```$", re.DOTALL | re.MULTILINE)


def test_the_commands_print_what_the_page_shows(tmp_path: Path, update: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NO_COLOR", "1")

    def with_output(block: re.Match[str]) -> str:
        language, text = block.groups()
        if language == "xml":
            (tmp_path / text.split()[1]).write_text(text, encoding="utf-8")
        else:
            command = text.splitlines()[0]
            _, out, err = run_btq(*shlex.split(command)[2:], cwd=tmp_path)
            text = f"{command}\n{out}{err}"
        return f"```{language}\n{text}```"

    page = PAGE.read_text(encoding="utf-8")
    after = BLOCK.sub(with_output, page)
    if update:
        PAGE.write_text(after, encoding="utf-8")
    assert after == (PAGE.read_text(encoding="utf-8") if update else page)
