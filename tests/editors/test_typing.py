"""Missions typed key by key in VS Code as it comes, and in Neovim with its own completion: what is on the disk then is
what was meant.  Nothing is pasted, and nothing formats or trims when it is saved."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from by_day import NUMBER
from chromium import CHROMIUM
from installed import ROOT, STORE, there
from person import type_text
from workbench import Workbench, workbench

from btq_lang.btcpp.opening import file_of
from btq_lang.checks import check
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace

# As in test_vscode: a list that a busy machine shows late is looked for once more.
pytestmark = pytest.mark.flaky(reruns=1)

# A fresh profile: only where btq is, and nothing that would hide what is typed.
FRESH = {
    "btq.interpreter": sys.executable,
    "files.autoSave": "off",
    "workbench.startupEditor": "none",
    "chat.disableAIFeatures": True,
}


def mission(page: str, number: int) -> str:
    """A mission on a page."""
    return re.findall(r"^```btq\n(.*?)^```$", (ROOT / page).read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)[
        number
    ]


TEXTS = {
    "readme": mission("README.md", 0),
    # Of comments, which are half of it, two words.
    "laboratory": re.sub(
        r"(# \S+ \S+).*", r"\1", (ROOT / "examples/laboratory/mission.btq").read_text(encoding="utf-8")
    ),
    "tutorial": mission("docs/tutorial.md", -1),
}


def briefly(text: str, *begun: str) -> str:
    """The paragraphs of a mission that begin with these words, and two words of each sentence in quotes."""
    taken = [each.strip("\n") for each in text.split("\n\n") if each.lstrip("\n").startswith(begun)]
    return re.sub(r'"([A-Za-z]\S* [^"\s]+) [^"]*"', r'"\1"', "\n\n".join(taken) + "\n")


# For VS Code, where each word takes a tenth of a second of a processor: what the others have not.
BRIEF = {
    "readme": TEXTS["readme"],
    "laboratory": briefly(
        TEXTS["laboratory"],
        *("Root", "signal", "QualityReq rq1", "QualityReq rq3", "Action ReadLabel", "# Charge if", "# The ports"),
    ),
    "tutorial": briefly(TEXTS["tutorial"], ""),
}
# Milliseconds before Enter, Tab, a blank and a quote that closes: a list has the time to open.
PAUSES = (0, 150, 600)


@pytest.fixture(scope="module")
def window(vsix: Path, node: Path, driver: None, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Workbench]:
    there(CHROMIUM, "Chromium", "from_apt")
    there(STORE / "vscode/node_modules/code-server/out/node/entry.js", "VS Code", "vscode")
    scratch = tmp_path_factory.mktemp("typing")
    with workbench(
        store=STORE,
        node=node,
        vsix=vsix,
        scratch=scratch,
        files=None,
        settings=FRESH,
        programs=scratch,
        size=(900, 600),
    ) as window:
        window.write("wrong.btq", "BehaviorTree Main\n    Sequnce\n")
        window.open("wrong.btq")
        window.see(".squiggly-warning, .squiggly-error")  # the server answers
        window.close_all()
        window.clean()
        yield window


@pytest.fixture
def code(window: Workbench) -> Iterator[Workbench]:
    yield window
    window.keys("Escape")
    window.close_all()
    window.clean()


@pytest.mark.parametrize("name", BRIEF)
def test_vs_code_saves_what_is_typed(code: Workbench, name: str) -> None:
    """The mission of the README with another pause each day."""
    pause = PAUSES[NUMBER % len(PAUSES)] if name == "readme" else 0
    path = code.write("typed.btq", "")
    code.open(path.name)

    def press(key: str) -> None:
        code.keys(key) if key in ("Enter", "Tab", "Backspace") else code.type(key)

    type_text(BRIEF[name], press, code.blanks, lambda: code.page.wait_for_timeout(pause) if pause else None)
    code.save()
    assert path.read_bytes().decode() == BRIEF[name]


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


REQUIREMENT = 'QualityReq soon : safety "Soon"\n    takes at most 30 s\n'
SKILLS = "Action MoveBase\n    input station : string\nAction Charge\n"
LIST = ".suggest-widget.visible"


def begin(code: Workbench, text: str) -> Path:
    """A file that ends where one goes on typing."""
    path = code.write("begun.btq", text)
    code.open(path.name)
    code.keys("Control+End")
    return path


def shows_no_list(code: Workbench) -> bool:
    code.page.wait_for_timeout(700)  # longer than a list takes to open
    return not code.page.locator(LIST).count()


@pytest.mark.parametrize(
    ("text", "typed", "asked"),
    [
        ("QualityReq soon : safety ", '"Soon"', None),  # the quote closes it
        ('BehaviorTree Main\n    Dock (at = "a" by = ', '"b"', None),
        ("", "BehaviorTree Mi", None),  # a name is declared
        ("", "QualityReq ti", None),
        ("", "signal re", None),
        ("BehaviorTree Main\n    -> ", "Sa", None),
        ('QualityReq soon "Soon"\n    takes at most ', "30", "s"),
        ('QualityReq soon "Soon"\n    takes at most ', "30 ", "s"),
        ('QualityReq soon "Soon"\n    takes at most 30 ', "s", "s"),
        ('QualityReq soon "Soon"\n    keeps ok\n    on violation ', "fail", "fail"),
        (f"{SKILLS}BehaviorTree Main\n    ", "Charge", "Charge"),
        (f"{SKILLS}BehaviorTree Main\n    ", "MoveBase", "MoveBase"),  # which has a port to fill in
        ("", "BehaviorTree", None),
    ],
)
def test_no_list_opens_by_itself(code: Workbench, text: str, typed: str, asked: str | None) -> None:
    """But one that is asked for, over a complete word, too."""
    path = begin(code, text)
    code.type(typed)
    assert shows_no_list(code)
    if asked is not None:
        assert code.suggestions()[0] == asked
        code.keys("Escape")
        code.gone(LIST)
    code.keys("Enter")
    code.save()
    assert path.read_text(encoding="utf-8").rstrip(" ") == f"{text}{typed}\n"


def test_a_quote_that_opens_a_string_shows_what_belongs_there(code: Workbench) -> None:
    code.write("demands.btq", REQUIREMENT)
    begin(code, "include ")
    code.type('"')
    code.see(f"{LIST} .monaco-list-row:has-text('demands.btq')")


@pytest.mark.parametrize("typed", [": string", ": double", ": int", ": bool"])
def test_enter_after_the_type_of_a_port_is_a_line_break(code: Workbench, typed: str) -> None:
    """VS Code finds `string` in `std::vector<string>`, too."""
    path = begin(code, "Action Read\n    output label ")
    for key in typed:
        code.type(key)
        code.page.wait_for_timeout(250)  # a list opens
    code.keys("Enter")
    code.save()
    assert path.read_text(encoding="utf-8").rstrip(" ") == f"Action Read\n    output label {typed}\n"


def test_enter_after_a_word_that_begins_another_is_a_line_break(code: Workbench) -> None:
    path = begin(code, "BehaviorTree Main\n    ")
    code.type("Retry")
    code.see(f"{LIST} .monaco-list-row:has-text('RetryUntilSuccessful')")
    code.keys("Enter")
    code.save()
    assert path.read_text(encoding="utf-8").rstrip(" ") == "BehaviorTree Main\n    Retry\n"


@pytest.mark.parametrize(
    ("text", "typed", "label", "after"),
    [
        ("BehaviorTree Main\n    Dock\n        satisfices ", "reliab", "reliability", "reliability"),
        (f"{SKILLS}BehaviorTree Main\n    ", "Mov", "MoveBase", "MoveBase (station = {=})"),
        ("BehaviorTree Main\n    ", "ret", "retry", "Retry (num_attempts = 3)\n        "),
        ("BehaviorTree Main\n    Dock satisfies ", "soo", "soon", "soon"),  # and the include of its file
    ],
)
def test_undo_after_an_accepted_item_is_one_step(
    code: Workbench, text: str, typed: str, label: str, after: str
) -> None:
    code.write("demands.btq", REQUIREMENT)
    path = begin(code, text)
    code.type(typed)
    code.see(f"{LIST} .monaco-list-row.focused[aria-label^='{label},']")
    code.keys("Enter")
    code.gone(LIST)
    include = 'include "demands.btq"\n' if label == "soon" else ""
    code.save()
    code.on_disk(path.name, f"{include}{text}{after}")
    code.keys("Control+z")
    code.save()
    code.on_disk(path.name, f"{text}{typed}")


def test_a_snippet_writes_its_construct_where_it_may_begin(code: Workbench) -> None:
    path = begin(code, "")
    code.type("mission")
    code.see(f"{LIST} .monaco-list-row.focused:has-text('mission')")
    code.keys("Enter", "Escape", "Escape")
    code.save()
    assert path.read_text(encoding="utf-8") == (
        'QualityReq in_time : performance-efficiency.time-behaviour "Reach the station in time"\n'
        "    takes at most 30 s\n\n"
        "BehaviorTree Mission\n    ->\n        Condition BatteryGood\n"
        '        Action MoveBase (station = "charger") satisfies in_time\n        '
    )
