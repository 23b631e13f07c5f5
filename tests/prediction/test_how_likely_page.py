"""The page docs/how-likely.md: its commands print what it shows."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

from in_process import run_btq

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs/how-likely.md"
BLOCK = re.compile(r"^```console\n\$ btq (.*)\n((?:.*\n)*?)```$", re.MULTILINE)


def test_the_page_shows_what_commands_print(tmp_path: Path) -> None:
    blocks = BLOCK.findall(PAGE.read_text(encoding="utf-8"))
    assert len(blocks) == 1
    folder = shutil.copytree(ROOT / "examples/laboratory", tmp_path / "laboratory")
    for arguments, shown in blocks:
        code, out, err = run_btq(*arguments.split(), cwd=folder)
        assert (code, out, err) == (0, shown, "")
