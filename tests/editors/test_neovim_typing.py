"""Missions and XML typed key by key in Neovim with its own completion: what is on the disk then is what was meant.

Nothing is pasted, and nothing formats or trims when it is saved.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from installed import ROOT, STORE, there
from typed_missions import PAUSES, TEXTS

from btq_lang.btcpp.opening import file_of
from btq_lang.checks import check
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace

# A list that a busy machine shows late is looked for once more.
pytestmark = pytest.mark.flaky(reruns=1)


@pytest.mark.parametrize(
    ("name", "pause"), [("laboratory", 0), ("tutorial", 0), *(("readme", pause) for pause in PAUSES)]
)
def test_neovim_saves_what_is_typed(name: str, pause: int, tmp_path: Path) -> None:
    """With the line of docs/editors.md that lets lists open by themselves, and all else as Neovim comes."""
    nvim = there(STORE / "neovim-sid/nvim", "Neovim of Debian's sid", "neovim-sid")
    page = (ROOT / "docs/editors.md").read_text(encoding="utf-8").partition("\n## Neovim\n")[2]
    (lists,) = re.findall(r"^```lua\n(.*?vim\.lsp\.completion\.enable.*?)^```$", page, re.DOTALL | re.MULTILINE)
    lists = lists.rpartition("```lua\n")[2]
    server = f"vim.g.btq_cmd = {{ {json.dumps(sys.executable)}, '-m', 'btq_lang.server' }}\n"
    (tmp_path / "init.lua").write_text(f"vim.opt.runtimepath:prepend('{ROOT}/editors/nvim')\n{server}{lists}")
    (tmp_path / "typed.btq").write_text("")
    (tmp_path / "btq.toml").write_text("")
    typed = [str(nvim), "--embed", "--headless", "-n", "-u", str(tmp_path / "init.lua"), str(tmp_path / "typed.btq")]
    todo = {"command": typed, "text": TEXTS[name].removesuffix("\n"), "pause": pause}
    run = type_in_neovim(nvim, tmp_path, todo)
    assert run.returncode == 0, run.stdout + run.stderr
    assert (tmp_path / "typed.btq").read_bytes().decode() == TEXTS[name]
    assert pause == 0 or int(run.stdout) > 0, "no list has opened"


def type_in_neovim(nvim: Path, folder: Path, todo: dict[str, object]) -> subprocess.CompletedProcess[str]:
    folders = {f"XDG_{name}_HOME": str(folder / "xdg") for name in ("STATE", "CACHE", "DATA", "CONFIG")}
    return subprocess.run(
        [str(nvim), "--headless", "--clean", "-l", str(Path(__file__).with_name("type.lua"))],
        cwd=folder,
        env={**os.environ, **folders, "HOME": str(folder), "BTQ_TYPE": json.dumps(todo)},
        capture_output=True,
        text=True,
        timeout=300,
    )


def test_neovim_saves_the_xml_that_is_typed(shared: Path, tmp_path: Path) -> None:
    """The laboratory's, which begins as a file that no server serves; Neovim's own indentation of XML is off."""
    nvim = there(STORE / "neovim-sid/nvim", "Neovim of Debian's sid", "neovim-sid")
    text = (shared / "original" / "paper_example.xml").read_bytes().decode()
    path = tmp_path / "typed.xml"
    path.write_text("")
    server = f"vim.g.btq_cmd = {{ {json.dumps(sys.executable)}, '-m', 'btq_lang.server' }}\n"
    indentation = "vim.cmd('filetype indent off')\n"
    (tmp_path / "init.lua").write_text(f"vim.opt.runtimepath:prepend('{ROOT}/editors/nvim')\n{server}{indentation}")
    typed = [str(nvim), "--embed", "--headless", "-n", "-u", str(tmp_path / "init.lua"), str(path)]
    findings = len(check(open_workspace_of(text), "typed.xml"))
    todo = {"command": typed, "text": text.removesuffix("\n"), "pause": 0, "level": 1000, "findings": findings}
    run = type_in_neovim(nvim, tmp_path, todo)
    assert run.returncode == 0, run.stdout + run.stderr
    assert path.read_bytes().decode() == text


def open_workspace_of(xml: str) -> Workspace:
    return Workspace({"typed.xml": file_of("typed.xml", xml)}, Project())
