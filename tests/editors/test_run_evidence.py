"""A run of the logs in the page of the preview, in a real browser and out of a real Neovim."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from evidence_logs import MAIN, MAIN_XML, btlog, rows
from installed import ROOT

if TYPE_CHECKING:
    from playwright.sync_api import Browser

MISSION = "BehaviorTree Main\n    ->\n        Move\n        Pick\n"
RUN = {
    "title": "Run 3 of second.btlog: failed",
    "leftOut": 0,
    "steps": [
        {"key": "n0", "state": "running", "time": "", "said": "0 ms: Sequence starts"},
        {"key": "n1", "state": "running", "time": "", "said": "0 ms: Move starts"},
        {"key": "n1", "state": "succeeded", "time": "25 ms", "said": "25 ms: Move succeeded, 25 ms"},
        {"key": "n2", "state": "failed", "time": "5 ms", "said": "30 ms: Pick failed, 5 ms"},
        {"key": "n0", "state": "failed", "time": "30 ms", "said": "30 ms: Sequence failed, 30 ms"},
    ],
}


def test_a_run_is_stepped_through_with_the_keyboard(browser: Browser, tmp_path: Path, artifacts: Path) -> None:
    (tmp_path / "main.btq").write_text(MISSION, encoding="utf-8")
    process = subprocess.Popen(
        [sys.executable, "-m", "btq_lang", "preview", "main.btq", "--follow"],
        cwd=tmp_path,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    assert process.stdin is not None
    found = re.search(r"http://\S+", process.stdout.readline())
    assert found is not None
    page = browser.new_page(viewport={"width": 900, "height": 600})
    page.goto(found[0])
    page.locator(".box", has_text="Move").wait_for(state="attached")
    process.stdin.write(json.dumps({"run": RUN}) + "\n")
    process.stdin.flush()
    said = page.locator("#step")

    def sees(step: int, sentence: str, *marks: str) -> None:
        page.wait_for_function("text => document.getElementById('step').textContent.endsWith(text)", arg=sentence)
        assert said.text_content() == f"Run 3 of second.btlog: failed, step {step} of 5: {sentence}"
        assert page.locator(".mark").all_text_contents() == list(marks)

    sees(5, "30 ms: Sequence failed, 30 ms", "✖ 30 ms", "✔ 25 ms", "✖ 5 ms")
    page.screenshot(path=str(artifacts / "run.png"))
    assert page.evaluate("document.activeElement.id") == "next"  # in an editor the page has the keys only with a focus
    page.keyboard.press("p")
    sees(4, "30 ms: Pick failed, 5 ms", "…", "✔ 25 ms", "✖ 5 ms")
    assert page.locator(".box.step").get_attribute("data-state") == "failed"
    page.keyboard.press("Shift+P")
    sees(1, "0 ms: Sequence starts", "…")
    page.keyboard.press("n")
    sees(2, "0 ms: Move starts", "…", "…")
    page.get_by_role("button", name="Next step").click()
    sees(3, "25 ms: Move succeeded, 25 ms", "…", "✔ 25 ms")
    page.keyboard.press("Shift+N")
    sees(5, "30 ms: Sequence failed, 30 ms", "✖ 30 ms", "✔ 25 ms", "✖ 5 ms")
    page.keyboard.press("Escape")
    page.locator("#run").wait_for(state="hidden")
    assert page.locator(".mark, .box[data-state]").count() == 0
    page.close()
    process.stdin.close()
    process.wait(timeout=30)
    process.stdout.close()


SHOW = """
local said, sent = {}, ''
vim.notify = function(text) table.insert(said, text) end
vim.fn.jobstart = function() return 1 end
vim.fn.chansend = function(_, text)
  sent = text
  return 1
end
vim.wait(60000, function() -- until the logs have been judged, the server refuses
  vim.cmd('BtqRun 2')
  return vim.wait(1000, function() return sent:find('steps') end, 50)
end)
said = {}
local run = vim.fn.json_decode(sent).run
local chosen
vim.ui.select = function(runs, options, act)
  chosen = options.format_item(runs[1])
  act(nil)
end
vim.cmd('BtqRun')
vim.wait(40000, function() return chosen end, 100)
vim.fn.writefile({ vim.fn.json_encode({ run.title, #run.steps, chosen, said }) }, 'seen.json')
"""


def test_neovim_sends_a_run_to_the_page(nvim: Path, tmp_path: Path) -> None:
    demand = "QualityReq quick : safety\n    Move takes at most 30 ms\n"
    (tmp_path / "main.btq").write_text(demand + MAIN, encoding="utf-8")
    (tmp_path / "btq.toml").write_text('[evidence]\nlogs = ["run.btlog"]\n', encoding="utf-8")
    runs = "0 1R 2R 20 2S 3R 60 3S 1S 1I 100 1R 2R 140 2S 3R 150 3S 1S"
    (tmp_path / "run.btlog").write_bytes(btlog(MAIN_XML, rows(runs)))
    (tmp_path / "show.lua").write_text(SHOW)
    scratch = {f"XDG_{name}_HOME": str(tmp_path / name) for name in ("STATE", "CACHE", "DATA", "RUNTIME")}
    setup = [
        f"set rtp^={ROOT / 'editors' / 'nvim'}",
        f"let g:btq_cmd = ['{sys.executable}', '-m', 'btq_lang.server']",
        f"let g:btq_program = ['{sys.executable}', '-m', 'btq_lang']",
    ]
    options = [word for line in setup for word in ("--cmd", line)]
    command: list[str | Path] = [nvim, "--headless", "--clean", *options, "main.btq", "-S", "show.lua", "-c", "qall!"]
    environment = {**os.environ, **scratch, "HOME": str(tmp_path), "PYTHONPATH": str(ROOT)}
    run = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=180)
    assert json.loads((tmp_path / "seen.json").read_text(encoding="utf-8")) == [
        "Run 2 of run.btlog: succeeded",
        6,
        "run 2: the last one; the worst of quick, 40 ms",
        [],
    ], run.stderr
