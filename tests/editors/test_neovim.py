"""Neovim with the plug-in, headless, as a user has it: files are opened, keys' commands run, the server is btq-lsp."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest
from chromium import CHROMIUM
from forked_server import relay
from installed import NVIMS, ROOT, there

PLUGIN = ROOT / "editors" / "nvim"
WRONG = "BehaviorTree Main\n    ->\n        Sequnce  # größer\n            Dock\n"


class Neovim:
    """One Neovim a script, in a folder with the files of the test."""

    def __init__(self, program: Path, folder: Path) -> None:
        self.program, self.folder = program, folder
        scratch = {f"XDG_{name}_HOME": str(folder / ".xdg" / name.lower()) for name in ("STATE", "CACHE", "DATA")}
        self.environment = {**os.environ, "HOME": str(folder), **scratch}

    def run(self, files: Mapping[str, str], script: str, *, lsp: bool = True) -> Any:
        """Open the first of the files, do what the script says, and return its value."""
        for name, text in files.items():
            (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
            (self.folder / name).write_text(text, encoding="utf-8", newline="")
        server = f"let g:btq_cmd = {json.dumps(relay())}"
        setup = [f"set rtp^={PLUGIN}", server if lsp else "let g:btq_no_lsp = v:true"]
        command = [str(self.program), "--headless", "--clean", *(word for line in setup for word in ("--cmd", line))]
        run = subprocess.run(
            [*command, next(iter(files)), "-S", str(Path(__file__).with_name("drive.lua"))],
            cwd=self.folder,
            env={**self.environment, "BTQ_SCRIPT": f"local btq = ...\n{script}"},
            capture_output=True,
            text=True,
            timeout=120,
        )
        assert run.returncode == 0, run.stdout + run.stderr
        return json.loads(run.stdout.splitlines()[-1])


every_nvim = pytest.mark.parametrize("nvim", NVIMS, indirect=True)


@pytest.fixture
def neovim(nvim: Path, tmp_path: Path) -> Neovim:
    (tmp_path / "btq.toml").write_text("")
    return Neovim(nvim, tmp_path)


@every_nvim
def test_installed_as_the_page_says(nvim: Path, tmp_path: Path) -> None:
    """A new user's home: the two lines of docs/editors.md, `btq-lsp` on the PATH, and the line that formats on save."""
    page = (ROOT / "docs" / "editors.md").read_text(encoding="utf-8").partition("\n## Neovim\n")[2]
    (install, *_), (format_on_save, *_) = (
        re.findall(rf"^```{language}\n(.*?)^```$", page, re.DOTALL | re.MULTILINE) for language in ("sh", "lua")
    )
    server = tmp_path / "bin" / "btq-lsp"
    server.parent.mkdir()
    server.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m btq_lang.server "$@"\n')
    server.chmod(0o755)
    environment = {name: value for name, value in os.environ.items() if not name.startswith("XDG_")}
    environment |= {"HOME": str(tmp_path), "PATH": f"{server.parent}:{os.environ['PATH']}"}
    subprocess.run(["bash", "-e", "-c", install], cwd=ROOT, env=environment, check=True)
    (tmp_path / "init.lua").write_text(f"if vim.lsp.buf.format then\n{format_on_save}end\n")
    (tmp_path / "main.btq").write_text(WRONG, encoding="utf-8")
    script = """
    local btq = ...
    local found = btq.diagnostics(1)
    vim.api.nvim_buf_set_lines(0, 2, 3, true, { '        Sequence   First' })
    vim.cmd('write')
    return { found, btq.lines()[3], vim.lsp.buf.format ~= nil }
    """
    drive = Path(__file__).with_name("drive.lua")
    command = [str(nvim), "--headless", "-u", str(tmp_path / "init.lua"), "main.btq", "-S", str(drive)]
    run = subprocess.run(
        command,
        cwd=tmp_path,
        env={**environment, "BTQ_SCRIPT": script},
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert run.returncode == 0, run.stdout + run.stderr
    found, line, formats = json.loads(run.stdout.splitlines()[-1])
    assert found == ["3:9-15 unknown-node"]
    assert line == ("        Sequence First" if formats else "        Sequence   First")


def test_both_endings_are_missions(neovim: Neovim) -> None:
    assert neovim.run({"a.qualitybtcpp": ""}, "return vim.bo.filetype", lsp=False) == "btq"
    assert neovim.run({"a.btq": ""}, "return {vim.bo.filetype, vim.bo.commentstring}", lsp=False) == ["btq", "# %s"]


@every_nvim
def test_diagnostics_come_and_go(neovim: Neovim) -> None:
    script = """
    local before = btq.diagnostics(1)
    vim.api.nvim_buf_set_lines(0, 2, 3, true, { '        Sequence' })
    return { before, btq.diagnostics(0) }
    """
    assert neovim.run({"main.btq": WRONG}, script) == [["3:9-15 unknown-node"], []]


def test_columns_are_right_behind_letters_of_several_bytes(neovim: Neovim) -> None:
    text = 'BehaviorTree Main\n    Größe "😀 ü" (zähler = 30 sek)\n'
    found = neovim.run({"main.btq": text}, "return btq.diagnostics(1)")
    line = text.splitlines()[1].encode()
    start = line.index(b"sek")
    assert found == [f"2:{start + 1}-{start + 3} unknown-unit"]


def test_formatting(neovim: Neovim) -> None:
    script = """
    btq.wait(btq.client, 'the server')
    btq.format()
    return btq.lines()
    """
    text = "BehaviorTree   Main\n  ->\n     Action   Dock( x=1 )\n"
    assert neovim.run({"main.btq": text}, script) == [
        "BehaviorTree Main",
        "    ->",
        "        Action Dock (x = 1)",
    ]


REQUIREMENTS = """\
QualityReq in_time : performance-efficiency.time-behaviour "größer als nötig"
    takes at most 30 s
"""
MISSION = """\
include "shared/requirements.btq"
BehaviorTree Main
    ->
        Größe (ü = "😀") satisfies in_time
        Charge satisfies in_time
"""
FILES = {"main.btq": MISSION, "shared/requirements.btq": REQUIREMENTS}


def test_a_reference_leads_to_the_definition_in_another_file(neovim: Neovim) -> None:
    script = """
    btq.wait(btq.client, 'the server')
    btq.to('in_time')
    vim.lsp.buf.definition()
    btq.wait(function() return vim.fn.expand('%:t') == 'requirements.btq' end, 'the jump')
    return vim.api.nvim_win_get_cursor(0)
    """
    assert neovim.run(FILES, script) == [1, 11]


def test_references_and_hover(neovim: Neovim) -> None:
    script = """
    btq.wait(btq.client, 'the server')
    btq.to('in_time', 2)
    local found = btq.ask('textDocument/references', { context = { includeDeclaration = true } })
    local places = vim.tbl_map(function(item)
      return vim.fn.fnamemodify(item.filename, ':t') .. ':' .. item.lnum .. ':' .. item.col
    end, vim.lsp.util.locations_to_items(found, btq.client().offset_encoding))
    table.sort(places)
    return { places, btq.ask('textDocument/hover').contents.value }
    """
    places, hover = neovim.run(FILES, script)
    column = MISSION.splitlines()[3].encode().index(b"in_time") + 1
    assert places == [f"main.btq:4:{column}", "main.btq:5:26", "requirements.btq:1:12"]
    assert "größer als nötig" in hover


def test_renaming_changes_every_file(neovim: Neovim) -> None:
    script = """
    btq.wait(btq.client, 'the server')
    btq.to('in_time', 2)
    vim.lsp.buf.rename('punctual')
    btq.wait(function() return btq.lines()[5]:find('punctual') end, 'the new name')
    return { btq.lines(), btq.lines(vim.fn.bufnr('requirements.btq')) }
    """
    mission, requirements = neovim.run(FILES, script)
    assert mission == MISSION.replace("in_time", "punctual").splitlines()
    assert requirements == REQUIREMENTS.replace("in_time", "punctual").splitlines()


def test_completion_proposes_qualities(neovim: Neovim) -> None:
    script = """
    btq.wait(btq.client, 'the server')
    vim.o.virtualedit = 'onemore'
    vim.fn.cursor(3, 20)
    local answer = btq.ask('textDocument/completion')
    return vim.tbl_map(function(item) return item.label end, answer.items or answer)
    """
    labels = neovim.run({"main.btq": "BehaviorTree Main\n    Dock\n        satisfices \n"}, script)
    assert {"performance-efficiency", "reliability", "safety"} <= set(labels)


@pytest.mark.parametrize(
    ("typed", "words"),
    [
        ("time", ["time", "performance-efficiency.time-behaviour"]),
        ("performance-efficiency.ti", ["time-behaviour"]),
        (
            "perf",
            [
                "performance",
                "performance-efficiency",
                "performance-efficiency.time-behaviour",
                "performance-efficiency.resource-utilization",
                "performance-efficiency.capacity",
            ],
        ),
    ],
)
def test_a_quality_is_found_by_either_name(neovim: Neovim, typed: str, words: list[str]) -> None:
    """With CTRL-X CTRL-O, which compares the typed letters with the start of a filter text; it does since 0.11."""
    script = """
    if vim.fn.has('nvim-0.11') == 0 then
      return vim.NIL
    end
    btq.wait(btq.client, 'the server')
    vim.o.completeopt = 'menuone,noinsert'
    local found, asked = {}, 0
    vim.fn.timer_start(50, function(timer)
      found, asked = vim.fn.complete_info({ 'items' }).items, asked + 1
      if #found > 0 or asked == 400 then
        vim.fn.timer_stop(timer)
        vim.api.nvim_input('<C-e><Esc>')
      end
    end, { ['repeat'] = -1 })
    vim.fn.cursor(3, 1)
    vim.api.nvim_feedkeys(vim.api.nvim_replace_termcodes('A<C-x><C-o>', true, false, true), 'tx!', false)
    return vim.tbl_map(function(item) return item.word end, found)
    """
    found = neovim.run({"main.btq": f"BehaviorTree Main\n    Dock\n        satisfices {typed}\n"}, script)
    assert found in (None, words)  # None: it is older


def test_a_code_action_mends_the_mistake(neovim: Neovim) -> None:
    script = """
    btq.diagnostics(1)
    btq.to('Sequnce')
    local range = vim.lsp.util.make_range_params(0, btq.client().offset_encoding).range
    local wrong = { range = range, message = 'unknown node', code = 'unknown-node' }
    local context = { diagnostics = { wrong } }
    for _, action in ipairs(btq.ask('textDocument/codeAction', { range = range, context = context })) do
      if action.edit and action.title:find('Sequence') then
        vim.lsp.util.apply_workspace_edit(action.edit, btq.client().offset_encoding)
        return btq.lines()
      end
    end
    """
    assert neovim.run({"main.btq": WRONG}, script) == WRONG.replace("Sequnce", "Sequence").splitlines()


def test_a_code_lens_lists_the_uses(neovim: Neovim) -> None:
    script = """
    btq.wait(btq.client, 'the server')
    for _, lens in ipairs(btq.ask('textDocument/codeLens')) do
      if lens.range.start.line == 0 then
        vim.lsp.commands[lens.command.command](lens.command, { client_id = btq.client().id })
        return vim.tbl_map(function(item) return item.lnum end, vim.fn.getqflist())
      end
    end
    """
    text = REQUIREMENTS + MISSION.partition("\n")[2]
    assert neovim.run({"main.btq": text}, script) == [5, 6]


def test_a_code_lens_with_nothing_to_open_is_a_title(neovim: Neovim) -> None:
    """To run it opens nothing, and no version warns that the server lacks a command."""
    script = """
    btq.wait(btq.client, 'the server')
    local warned = {}
    vim.notify = function(text) table.insert(warned, text) end
    vim.notify_once = vim.notify
    if vim.lsp.codelens.enable then
      vim.lsp.codelens.enable(true)
    else
      vim.lsp.codelens.refresh()
    end
    local shown
    btq.wait(function()
      local found = vim.lsp.codelens.get(vim.lsp.codelens.enable and { bufnr = 0 } or 0)
      shown = found[1] and (found[1].lens or found[1]).command.title
      return shown
    end, 'a lens')
    vim.fn.cursor(1, 1)
    vim.lsp.codelens.run()
    vim.wait(500)
    return { shown, warned, vim.fn.getqflist() }
    """
    shown, said, listed = neovim.run({"main.btq": "BehaviorTree Main\n    Dock\n"}, script)
    assert (shown, listed) == ("main tree", [])
    assert said in ([], ["No executable codelens found at current line"])  # 0.10 says so


def test_one_server_serves_a_project(neovim: Neovim) -> None:
    script = """
    btq.wait(btq.client, 'the server')
    vim.cmd('edit sub/other.btq')
    btq.diagnostics(1)
    return { #(vim.lsp.get_clients or vim.lsp.get_active_clients)(), btq.client().config.root_dir }
    """
    assert neovim.run({"main.btq": "", "sub/other.btq": WRONG}, script) == [1, str(neovim.folder)]


def test_the_health_check_says_what_runs(neovim: Neovim) -> None:
    script = """
    btq.diagnostics(1)
    vim.cmd('checkhealth btq')
    return table.concat(btq.lines(), '\\n')
    """
    said = neovim.run({"main.btq": WRONG}, script)
    assert "btq-lsp 0." in said
    assert f"serves {neovim.folder}" in said
    assert "ERROR" not in said


def test_the_health_check_says_what_is_missing(neovim: Neovim) -> None:
    script = "vim.g.btq_cmd = { 'no-such-server' } vim.cmd('checkhealth btq') return table.concat(btq.lines(), '\\n')"
    assert "no-such-server not found" in neovim.run({"main.txt": ""}, script)


def test_a_server_that_is_not_there_is_told_once(neovim: Neovim) -> None:
    script = """
    local said = {}
    vim.notify = function(text) table.insert(said, text) end
    vim.g.btq_no_lsp = nil
    vim.g.btq_cmd = { 'no-such-server' }
    require('btq').setup()
    vim.cmd('edit main.btq')
    vim.cmd('edit other.btq')
    return said
    """
    found = neovim.run({"main.txt": "", "main.btq": WRONG, "other.btq": WRONG}, script, lsp=False)
    assert found == ["btq: no-such-server not found; run :checkhealth btq"]


@pytest.mark.parametrize(
    ("typed", "lines"),
    [
        ("iBehaviorTree Main<CR>-><CR>Dock<CR>Charge", "BehaviorTree Main|    ->|        Dock|        Charge"),
        ("iRetry (n = 1)<CR>Dock", "Retry (n = 1)|    Dock"),
        ("iDock (<CR>a = 1<CR>)<CR>Charge", "Dock (|    a = 1|)|Charge"),
        ("iQualityReq a<CR>takes at most 3 s<CR>goal 2 s", "QualityReq a|    takes at most 3 s|    goal 2 s"),
    ],
)  # fmt: skip
def test_enter_indents(neovim: Neovim, typed: str, lines: str) -> None:
    script = f"""
    local keys = vim.api.nvim_replace_termcodes({json.dumps(typed)}, true, false, true)
    vim.api.nvim_feedkeys(keys, 'x', false)
    return btq.lines()
    """
    assert neovim.run({"main.btq": ""}, script, lsp=False) == lines.split("|")


def test_a_file_with_tabs_goes_on_with_tabs(neovim: Neovim) -> None:
    script = """
    vim.fn.cursor(2, 1)
    vim.api.nvim_feedkeys('oDock', 'x', false)
    return { btq.lines(), vim.bo.expandtab }
    """
    tabs = neovim.run({"main.btq": "BehaviorTree Main\n\t->\n"}, script, lsp=False)
    assert tabs == [["BehaviorTree Main", "\t->", "\t\tDock"], False]
    blanks = neovim.run({"main.btq": "BehaviorTree Main\n    ->\n\tPick\n"}, script, lsp=False)
    assert blanks == [["BehaviorTree Main", "    ->", "        Dock", "\tPick"], True]


@pytest.mark.parametrize("setting", ["btq_program", "btq_cmd"])
def test_make_runs_the_program_that_is_set(neovim: Neovim, setting: str) -> None:
    """It is in a folder with a blank, and none is on the PATH; by the server's setting it is found beside that."""
    folder = neovim.folder / "my programs"
    folder.mkdir()
    for name in ("btq", "btq-lsp"):
        (folder / name).write_text(f'#!/bin/sh\nPYTHONPATH="{ROOT}" exec "{sys.executable}" -m btq_lang "$@"\n')
        (folder / name).chmod(0o755)
    value = json.dumps([str(folder / ("btq" if setting == "btq_program" else "btq-lsp"))])
    script = f"""
    vim.g.{setting} = vim.fn.json_decode('{value}')
    vim.cmd('edit main.btq')
    vim.cmd('silent make!')
    local found = vim.tbl_filter(function(item) return item.valid == 1 end, vim.fn.getqflist())
    return vim.tbl_map(function(item) return {{ item.lnum, item.col, item.type, item.text }} end, found)
    """
    text = "BehaviorTree Main\n    Dock (t = 30 sek)\n"
    (found, *_) = neovim.run({"main.txt": "", "main.btq": text}, script, lsp=False)
    assert found[:3] == [2, 18, "e"]
    assert re.match(r"\[unknown-unit\] unknown unit `sek`", found[3])


def test_every_kind_of_word_has_its_colour(neovim: Neovim) -> None:
    text = (ROOT / "examples" / "laboratory" / "mission.btq").read_text(encoding="utf-8")
    places = [
        ("# A mobile", "btqComment"),
        ("Root", "btqItem"),
        ("Laboratory", "btqName"),
        ("signal battery", "btqItem"),
        ("{battery_level}", "btqBraced"),
        ("fresh within", "btqClauseWord"),
        ("5 s initially", "btqNumber"),
        ("s initially", "btqUnit"),
        ("QualityReq rq1", "btqItem"),
        ("rq1 : ", "btqRequirementName"),
        ("performance-efficiency.time", "btqQuality"),
        ('"Reach', "btqString"),
        ("takes at most", "btqClauseWord"),
        ("fail  # hard", "btqOutcome"),
        ("Condition SensorsAlive", "btqCategory"),
        ("SensorsAlive \"", "btqNode"),
        ("output battery", "btqPort"),
        ("double", "btqType"),
        ("R->\\n", "btqControl"),
        ("Repeat MoveTubes", "btqControl"),
        ("MoveTubes (", "btqLabel"),
        ("num_cycles", "btqKey"),
        ("satisfices performance", "btqAttach"),
        ("performance-efficiency, safety", "btqQuality"),
        ("satisfies rq2", "btqAttach"),
        ("rq2\\n", "btqRequirement"),
        ("AlwaysSuccess", "btqBuiltin"),
    ]  # fmt: skip
    assert colours(neovim, text, [place for place, _ in places]) == [f"{place}: {colour}" for place, colour in places]


def test_a_string_goes_on_in_the_next_line_and_ends_before_an_item(neovim: Neovim) -> None:
    text = (ROOT / "tests" / "every_form.btq").read_text(encoding="utf-8")
    places = [
        ("b='1'", "btqString"),
        ("FailureIf b", "btqString"),
        ("on violation halt\\nQ", "btqClauseWord"),
        ("QualityReq subject", "btqItem"),
        ("Or so", "btqString"),
        ('BehaviorTree "3', "btqItem"),
    ]
    found = colours(neovim, text, [place for place, _ in places])
    torn = 'QualityReq a "no end\n    takes at most 3 s\nBehaviorTree Main\n    Dock\n'
    found += colours(neovim, torn, ["Dock"])  # the item's own line is still taken for the rest of the torn one
    assert found == [f"{place}: {colour}" for place, colour in (*places, ("Dock", "btqNode"))]


def colours(neovim: Neovim, text: str, places: list[str]) -> list[str]:
    """The name of the colour at each place: the first, from the top of the file, where this stands."""
    script = f"""
    local found = {{}}
    for _, place in ipairs(vim.fn.json_decode({json.dumps(json.dumps(places))})) do
      vim.fn.cursor(1, 1)
      assert(vim.fn.search('\\\\V\\\\C' .. place, 'cW') > 0, place)
      local at = vim.fn.synID(vim.fn.line('.'), vim.fn.col('.'), 1)
      table.insert(found, {{ place, vim.fn.synIDattr(at, 'name') }})
    end
    return vim.tbl_map(function(pair) return table.concat(pair, ': ') end, found)
    """
    found: list[str] = neovim.run({"main.btq": text}, script, lsp=False)
    return found


def test_what_the_server_says_has_the_colours_of_the_plugin(neovim: Neovim) -> None:
    """Words of the server are laid over those of the syntax file: with its colours, or with none."""
    script = """
    btq.wait(btq.client, 'the server')
    if not vim.inspect_pos then return { 'older' } end
    local found = {}
    for _, place in ipairs({ 'QualityReq', 'rq1', 'security', 'Retry', 'AlwaysSuccess', 'Dock', 'msec' }) do
      btq.to(place)
      local row, column = vim.fn.line('.') - 1, vim.fn.col('.') - 1
      local tokens
      btq.wait(function()
        vim.cmd('redraw')
        tokens = vim.inspect_pos(0, row, column).semantic_tokens
        return #tokens > 0
      end, 'the word for ' .. place)
      local above, group = 0, nil
      for _, token in ipairs(tokens) do
        local link = vim.api.nvim_get_hl(0, { name = token.opts.hl_group }).link
        if link and token.opts.priority > above then
          above, group = token.opts.priority, link
        end
      end
      table.insert(found, place .. ': ' .. group)
    end
    return found
    """
    text = (
        "QualityReq rq1 : security 'x'\n    on violation warn\n"
        "BehaviorTree Main\n    Retry\n        Dock (msec = 3) satisfies rq1\n        AlwaysSuccess\n"
    )
    assert neovim.run({"main.btq": text}, script) in (
        ["older"],
        [
            "QualityReq: btqAsAbove",
            "rq1: btqRequirement",
            "security: btqQuality",
            "Retry: btqControl",
            "AlwaysSuccess: btqBuiltin",
            "Dock: btqNode",
            "msec: btqKey",
        ],
    )


LOOK = """
vim.o.termguicolors = true
pcall(vim.cmd, 'packadd nvim.tohtml')  -- from 0.12 on an optional package
for _, theme in ipairs({ 'light', 'dark' }) do
  vim.o.background = theme
  local found, html = pcall(require, 'tohtml')
  if found then
    vim.fn.writefile(html.tohtml(0, {}), theme .. '.html')
  else
    vim.cmd('runtime plugin/tohtml.vim | TOhtml')
    vim.cmd('silent write! ' .. theme .. '.html | bwipeout!')
  end
end
"""


def test_how_a_mission_looks(neovim: Neovim, request: pytest.FixtureRequest, artifacts: Path, tmp_path: Path) -> None:
    """Neovim's own page of the buffer, every form of the language in it, in both themes; screenshots are kept."""
    chromium = there(CHROMIUM, "Chromium", "from_apt")
    text = (ROOT / "tests" / "every_form.btq").read_text(encoding="utf-8")
    neovim.run({"every_form.btq": text}, LOOK, lsp=False)
    for theme in ("light", "dark"):
        html = (tmp_path / f"{theme}.html").read_text(encoding="utf-8")
        colours = set(re.findall(r"[^-]color: (#?\w+)", html))
        assert len(colours) >= 5
        assert "Größe!" in html
        picture = artifacts / f"nvim-{request.node.callspec.params['nvim']}-{theme}.png"
        picture.unlink(missing_ok=True)
        flags = ("--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--hide-scrollbars")
        subprocess.run(
            [chromium, *flags, "--window-size=1500,1900", f"--screenshot={picture}", f"{tmp_path}/{theme}.html"],
            env={**os.environ, "HOME": str(tmp_path)},
            check=True,
            capture_output=True,
            timeout=120,
        )
        assert picture.read_bytes().startswith(b"\x89PNG")


def test_a_wrong_project_file_is_told_in_that_file_and_goes_when_it_is_mended(neovim: Neovim) -> None:
    script = """
    btq.wait(btq.client, 'the server')
    vim.cmd('edit btq.toml')
    local buffer = vim.api.nvim_get_current_buf()
    local function message()
      btq.wait(function() return #vim.diagnostic.get(buffer) == 1 end, 'a diagnostic')
      return vim.diagnostic.get(buffer)[1].message
    end
    vim.api.nvim_buf_set_lines(0, 0, -1, true, { '[rules]', 'unknwn-node = "off"' })
    vim.cmd('write')
    local first = message()
    vim.api.nvim_buf_set_lines(0, 1, 2, true, { 'unknown-node = "eror"' })
    vim.cmd('write')
    btq.wait(function() return message() ~= first end, 'another diagnostic')
    local second = message()
    vim.api.nvim_buf_set_lines(0, 1, 2, true, { 'unknown-node = "error"' })
    vim.cmd('write')
    btq.diagnostics(0, buffer)
    return { first, second }
    """
    first, second = neovim.run({"main.btq": "BehaviorTree Main\n    Dock\n"}, script)
    assert first == "unknown rule `unknwn-node`; did you mean `unknown-node`?"
    assert second.endswith("; did you mean `error`?")


TREES = """\
<?xml version="1.0"?>
<!-- <root> -->
<root BTCPP_format="4">
  <BehaviorTree ID="Main">
    <Sequnce/>
  </BehaviorTree>
</root>
"""


def test_xml_of_the_engine_is_served(neovim: Neovim) -> None:
    """Like a mission, with the edits that are typed; the file keeps its type."""
    script = """
    local before = btq.diagnostics(1)
    vim.api.nvim_buf_set_lines(0, 4, 5, true, { '    <Sequence><Dock/></Sequence>' })
    local mended = btq.diagnostics(0)
    btq.to('Sequence')
    local shown = btq.ask('textDocument/hover').contents.value
    return { before, mended, shown:sub(1, 12), vim.bo.filetype, vim.fn.exists(':BtqPreview') }
    """
    found = neovim.run({"main.xml": TREES}, script)
    assert found == [["5:6-12 unknown-node"], [], "**Sequence**", "xml", 2]


def test_xml_is_converted_with_both_open(neovim: Neovim) -> None:
    script = """
    btq.wait(btq.client, 'the server')
    btq.diagnostics(1)
    vim.cmd('BtqConvert')
    local names = vim.tbl_map(function(window)
      return vim.fn.fnamemodify(vim.api.nvim_buf_get_name(vim.api.nvim_win_get_buf(window)), ':t')
    end, vim.api.nvim_list_wins())
    table.sort(names)
    return { names, btq.lines() }
    """
    names, lines = neovim.run({"main.xml": TREES}, script)
    assert names == ["main.btq", "main.xml"]
    assert lines[:3] == ["# <root>", "", "Root (BTCPP_format = 4)"]


@pytest.mark.parametrize(
    "text",
    [
        "<project><root/></project>\n",
        "<root><item path='x'/></root>\n",
        "<!-- a\n<root BTCPP_format='4'> -->\n<rooted BTCPP_format='4'/>\n",
        "",
    ],
)
def test_other_xml_starts_no_server_until_it_is_the_engines(neovim: Neovim, text: str) -> None:
    script = """
    vim.wait(300)
    local before = #(vim.lsp.get_clients or vim.lsp.buf_get_clients)() + vim.fn.exists(':BtqPreview')
    local trees = { '<root>', '<BehaviorTree ID="A">', '<Sequnce/>', '</BehaviorTree>', '</root>' }
    vim.api.nvim_buf_set_lines(0, 0, -1, true, trees)
    vim.cmd('doautocmd TextChanged')
    return { before, btq.diagnostics(1) }
    """
    before, after = neovim.run({"pom.xml": text}, script)
    assert (before, len(after)) == (0, 1)


SCENARIOS = """\
BehaviorTree Deliver
    ?
        MoveTo (location = "E")
        MoveTo (location = "B")

scenario "E is closed"
    given MoveTo (location = "E") fails
    expect MoveTo runs "E", "B"

scenario "E is open"
    expect MoveTo runs "E", "B"

scenario "B is closed"
    given every MoveTo fails
    expect mission succeeds
"""


@every_nvim
def test_scenarios_are_run(neovim: Neovim) -> None:
    """The nearest one, one at the cursor, one by its code lens, all; an edit takes away what they have shown."""
    script = """
    btq.wait(btq.client, 'the server')
    local seen, said = {}, nil
    vim.notify = function(text) said = text end
    local function shown()
      return vim.tbl_map(function(each) return each.lnum + 1 end, vim.diagnostic.get(0))
    end
    local function test(command, count)
      said = nil
      vim.cmd(command)
      btq.wait(function() return said end, 'what is said')
      btq.wait(function() return #shown() == count end, count .. ' diagnostics')
      table.insert(seen, { said, shown() })
    end
    test('BtqTest nearest', 0)
    btq.to('expect', 2)
    test('BtqTest nearest', 1)
    for _, lens in ipairs(btq.ask('textDocument/codeLens')) do
      if lens.range.start.line == 12 then
        said = nil
        vim.lsp.commands[lens.command.command](lens.command, { client_id = btq.client().id })
        btq.wait(function() return said end, 'what is said')
        btq.wait(function() return #shown() == 2 end, 'two diagnostics')
        table.insert(seen, { lens.command.title .. ': ' .. said, shown() })
      end
    end
    test('BtqTest', 2)
    local first = vim.diagnostic.get(0)[1]
    vim.api.nvim_buf_set_lines(0, 10, 10, true, { '    given MoveTo (location = "E") fails' })
    btq.wait(function() return #shown() == 0 end, 'no diagnostics')
    test('BtqTest', 1)
    return { seen, { first.source, first.message }, vim.fn.getcompletion('BtqTest ', 'cmdline') }
    """
    seen, first, completed = neovim.run({"main.btq": SCENARIOS}, script)
    assert seen == [
        ["btq: scenarios: 1 passed", []],
        ["btq: scenarios: 1 failed", [11]],
        ["run: btq: scenarios: 1 failed", [11, 15]],
        ["btq: scenarios: 1 passed, 2 failed", [11, 15]],
        ["btq: scenarios: 2 passed, 1 failed", [16]],
    ]
    assert first == [
        "btq test",
        'after 0 ms Fallback::1 (main.btq:2): the mission succeeds, and the node has not run with it; expected "B"',
    ]
    assert completed == ["nearest"]


EXPLORED = """\
QualityReq most : reliability "It looks twice"
    Look tries at most 2

BehaviorTree Main
    Retry (num_attempts = 3)
        Look
"""


@every_nvim
def test_how_a_requirement_can_be_violated(neovim: Neovim) -> None:
    """By the command, by the code lens after an edit that forbids it, and by the code action."""
    script = """
    btq.wait(btq.client, 'the server')
    local said
    vim.notify = function(text) said = text end
    local function hear(act)
      said = nil
      act()
      btq.wait(function() return said end, 'what is said')
      return said
    end
    local mission, seen = vim.api.nvim_get_current_buf(), {}
    btq.to('Retry')
    table.insert(seen, hear(function() vim.cmd('BtqExplore') end))
    btq.to('most')
    table.insert(seen, hear(function() vim.cmd('BtqExplore') end))
    local run = { vim.fn.expand('%:t'), vim.bo.filetype, vim.bo.modified, btq.lines() }
    btq.wait(function() return #vim.lsp.buf_request_sync(0, 'textDocument/codeLens',
      { textDocument = { uri = vim.uri_from_bufnr(0) } }, 20000) > 0 end, 'the lens of the run')
    vim.cmd('wincmd p')
    vim.api.nvim_buf_set_lines(mission, 4, 5, true, { '    Retry (num_attempts = 2)' })
    for _, lens in ipairs(btq.ask('textDocument/codeLens')) do
      if lens.command.command == 'btq.explore' then
        table.insert(seen, lens.command.title .. ' ' .. hear(function()
          vim.lsp.commands['btq.explore'](lens.command, { client_id = btq.client().id })
        end))
      end
    end
    vim.ui.select = function(items, _, chosen) chosen(items[1], 1) end
    table.insert(seen, hear(function()
      vim.lsp.buf.code_action()
    end))
    return { seen, run }
    """
    seen, run = neovim.run({"main.btq": EXPLORED}, script)
    violated = "most `Look tries at most 2` can be violated"
    assert seen == [
        "btq: no requirement at the cursor that can be explored",
        f"btq: {violated}: yes, in 3 ticks",
        f"how can this be violated? btq: {violated}: no, in all 2 states",
        f"btq: {violated}: no, in all 2 states",
    ]
    scenario = [
        'include "main.btq"',
        "",
        'scenario "most is violated" verifies most',
        "    given Look fails 2 times, then succeeds",
        "    expect most",
    ]
    assert run == ["most_violated.btq", "btq", True, scenario]
