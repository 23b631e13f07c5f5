"""`:BtqPreview`: a real Neovim on one side, the page in a real browser on the other."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from installed import ROOT

if TYPE_CHECKING:
    from playwright.sync_api import Browser

MISSION = "BehaviorTree Main\n    ->\n        Größe  # ü\n        ? Way\n            Dock\n            Charge\n"


class Neovim:
    """One that runs, and takes keys and questions over a socket."""

    def __init__(self, program: Path, folder: Path, environment: dict[str, str]) -> None:
        self._remote = [str(program), "--server", str(folder / "socket")]
        self._environment = environment
        setup = [
            f"set rtp^={ROOT / 'editors' / 'nvim'}",
            "let g:btq_no_lsp = v:true",
            f"let g:btq_program = ['{sys.executable}', '-m', 'btq_lang']",
        ]
        options = [word for line in setup for word in ("--cmd", line)]
        self.process = subprocess.Popen(
            [program, "--headless", "--clean", "--listen", folder / "socket", *options, "main.btq"],
            cwd=folder,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        until(lambda: (folder / "socket").exists() and self.says("&filetype") == "btq", "Neovim does not answer")

    def keys(self, keys: str) -> None:
        self._ask("--remote-send", keys)

    def says(self, expression: str) -> str:
        return self._ask("--remote-expr", expression)

    def _ask(self, *words: str) -> str:
        command = [*self._remote, *words]
        run = subprocess.run(command, env=self._environment, capture_output=True, text=True, timeout=60)
        return run.stdout + run.stderr  # 0.7 answers on the latter


def until(condition: Callable[[], bool], otherwise: str) -> None:
    """Wait for what another process does: each question to it takes its time."""
    end = time.monotonic() + 40
    while not condition():
        assert time.monotonic() < end, otherwise


def test_the_page_follows_the_text_and_the_cursor_and_leads_back(
    nvim: Path, browser: Browser, tmp_path: Path, artifacts: Path
) -> None:
    (tmp_path / "main.btq").write_text(MISSION, encoding="utf-8")
    opener = tmp_path / "browser"
    opener.write_text(f'#!/bin/sh\necho "$1" > "{tmp_path}/opened"\n')
    opener.chmod(0o755)
    scratch = {f"XDG_{name}_HOME": str(tmp_path / name) for name in ("STATE", "CACHE", "DATA", "RUNTIME")}
    environment = {**os.environ, **scratch, "HOME": str(tmp_path), "PYTHONPATH": str(ROOT), "BROWSER": str(opener)}
    neovim = Neovim(nvim, tmp_path, environment)
    opened = tmp_path / "opened"
    page = browser.new_page(viewport={"width": 900, "height": 600})
    try:
        neovim.keys("5G:BtqPreview<CR>")
        until(lambda: opened.exists() and opened.read_text().endswith("\n"), "no page was opened")
        page.goto(opened.read_text().strip())
        here = page.locator(".box.here")
        here.filter(has_text="Dock").wait_for(state="attached")
        neovim.keys("j")
        here.filter(has_text="Charge").wait_for(state="attached")
        neovim.keys("AFully<CR>Rest<Esc>")  # typed, and not written
        here.filter(has_text="Rest").wait_for(state="attached")
        titles = page.locator(".box text.title").all_text_contents()
        assert titles == ["->", "Größe", "?", "Dock", "ChargeFully", "Rest"]
        assert (tmp_path / "main.btq").read_text(encoding="utf-8") == MISSION
        page.screenshot(path=str(artifacts / "nvim-preview.png"))
        page.locator(".box", has_text="Größe").click()
        until(lambda: neovim.says("line('.') . ':' . col('.')") == "3:9", "the cursor stays where it was")
        here.filter(has_text="Größe").wait_for(state="attached")
        neovim.keys(":BtqPreview!<CR>")
        page.locator("#said.trouble", has_text="btq preview has ended").wait_for()
        neovim.keys(":BtqPreview<CR>")
        until(lambda: opened.read_text().strip() not in ("", page.url), "no other page was opened")
        page.goto(opened.read_text().strip())
        here.filter(has_text="Größe").wait_for(state="attached")
        neovim.keys(":qall!<CR>")
        assert neovim.process.wait(30) == 0
        page.locator("#said.trouble", has_text="btq preview has ended").wait_for()
    finally:
        page.close()
        neovim.process.kill()
        neovim.process.wait(30)


RELOAD = """
local said, sent, over = 0, '', false
vim.notify = function() said = said + 1 end
local start, tell = vim.fn.jobstart, vim.fn.chansend
vim.fn.jobstart = function(command, options)
  options.on_exit = function() over = true end
  return start(command, options)
end
vim.fn.chansend = function(job, text)
  sent = text
  return tell(job, text)
end
vim.cmd('BtqPreview')
vim.wait(40000, function() return said > 0 end)
vim.fn.writefile({ 'BehaviorTree Main', '    Reloaded' }, 'main.btq')
vim.cmd('edit!')
local kept = not vim.wait(500, function() return over end)
local told = sent
vim.cmd('bdelete')
print(vim.fn.json_encode({ kept, told, (vim.wait(40000, function() return over end)) }))
"""


def test_a_reload_is_followed_and_closing_the_buffer_ends_it(nvim: Path, tmp_path: Path) -> None:
    (tmp_path / "main.btq").write_text(MISSION, encoding="utf-8")
    (tmp_path / "reload.lua").write_text(RELOAD)
    scratch = {f"XDG_{name}_HOME": str(tmp_path / name) for name in ("STATE", "CACHE", "DATA")}
    setup = [
        f"set rtp^={ROOT / 'editors' / 'nvim'}",
        "let g:btq_no_lsp = v:true",
        f"let g:btq_program = ['{sys.executable}', '-m', 'btq_lang']",
    ]
    options = [word for line in setup for word in ("--cmd", line)]
    run = subprocess.run(
        [nvim, "--headless", "--clean", *options, "main.btq", "-c", "luafile reload.lua", "-c", "qall!"],
        cwd=tmp_path,
        env={**os.environ, **scratch, "HOME": str(tmp_path), "PYTHONPATH": str(ROOT), "BROWSER": "true"},
        capture_output=True,
        text=True,
        timeout=120,
    )
    (said,) = re.findall(r"^\[.*\]", run.stdout + run.stderr, re.MULTILINE)
    assert json.loads(said) == [True, '{"text": "BehaviorTree Main\\n    Reloaded\\n"}\n', True]


def test_a_mission_that_is_not_saved_and_a_program_that_is_not_there_are_told(nvim: Path, tmp_path: Path) -> None:
    script = "vim.notify = function(said) print(said) end vim.bo.filetype = 'btq' vim.cmd('BtqPreview')"
    (tmp_path / "main.btq").write_text(MISSION, encoding="utf-8")
    scratch = {f"XDG_{name}_HOME": str(tmp_path / name) for name in ("STATE", "CACHE", "DATA")}
    said = []
    for file in ("new.btq", "main.btq"):
        setup = [
            f"set rtp^={ROOT / 'editors' / 'nvim'}",
            "let g:btq_no_lsp = v:true",
            "let g:btq_program = ['no-such']",
        ]
        command = [nvim, "--headless", "--clean", *(word for line in setup for word in ("--cmd", line)), file]
        run = subprocess.run(
            [*command, "-c", f"lua {script}", "-c", "qall!"],
            cwd=tmp_path,
            env={**os.environ, **scratch, "HOME": str(tmp_path)},
            capture_output=True,
            text=True,
            timeout=60,
        )
        said += re.findall(r"btq: (.*)", run.stdout + run.stderr)
    assert [line.strip() for line in said] == [
        "save this mission first to show its trees",
        "no-such not found; see :help btq_program",
    ]
