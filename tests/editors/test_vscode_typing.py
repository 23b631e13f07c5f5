"""XML in VS Code, and XML and missions typed key by key there: what is on the disk then is what was meant.

XML of BehaviorTree.CPP is served like a mission, of others nothing is said and nothing started.  Nothing is pasted, and
nothing formats or trims when it is saved.  One window on a folder without missions: the tests of XML follow each other,
and the first finds no server.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from chromium import CHROMIUM
from installed import ROOT, STORE, there
from person import type_text
from typed_missions import PAUSES, PIECES
from workbench import Workbench, workbench

from btq_lang.btcpp.opening import file_of
from btq_lang.checks import check
from btq_lang.diagnostics.rules import Severity
from btq_lang.util.text import LineIndex
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace

# A list that a busy machine shows late is looked for once more.
pytestmark = pytest.mark.flaky(reruns=1)

POM = '<?xml version="1.0"?>\n<project>\n  <root name="x"/>\n</project>\n'
TREES = """\
<root BTCPP_format="4">
  <BehaviorTree ID="Main">
    <Sequnce>
      <SubTree ID="Dock"/>
    </Sequnce>
  </BehaviorTree>
  <BehaviorTree ID="Dock">
    <AlwaysSuccess/>
  </BehaviorTree>
</root>
"""


@pytest.fixture(scope="module")
def window(vsix: Path, node: Path, driver: None, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Workbench]:
    there(CHROMIUM, "Chromium", "from_apt")
    there(STORE / "vscode/node_modules/code-server/out/node/entry.js", "VS Code", "vscode")
    scratch = tmp_path_factory.mktemp("typing")
    server = scratch / "btq-lsp"
    server.write_text(
        f'#!/bin/sh\necho >>"{scratch}/started"\nPYTHONPATH="{ROOT}" exec "{sys.executable}" -m btq_lang.server "$@"\n'
    )
    server.chmod(0o755)
    settings = settings_of(scratch)
    with workbench(
        store=STORE, node=node, vsix=vsix, scratch=scratch, files=None, settings=settings, programs=scratch
    ) as window:
        yield window


def settings_of(programs: Path) -> dict[str, object]:
    """A fresh profile: only where btq is, and nothing that would hide what is typed."""
    return {
        "btq.server.command": [str(programs / "btq-lsp")],
        "files.autoSave": "off",
        "workbench.startupEditor": "none",
        "chat.disableAIFeatures": True,
    }


def started(window: Workbench) -> int:
    """How often a server was started."""
    path = window.programs / "started"
    return len(path.read_text()) if path.exists() else 0


def test_other_xml_starts_no_server(window: Workbench) -> None:
    window.write("pom.xml", POM)
    window.open("pom.xml")
    window.keys("Control+End")
    window.type("<!-- more -->")
    window.page.wait_for_timeout(3000)  # longer than a server takes to start
    assert started(window) == 0
    window.close_all()


def test_xml_of_the_engine_is_checked(window: Workbench) -> None:
    window.write("trees.xml", TREES)
    window.open("trees.xml")
    window.see(".squiggly-warning")
    assert started(window) == 1
    (row,) = window.problems("unknown node `Sequnce`")
    assert "did you mean `Sequence`?" in row
    window.open("trees.xml")
    window.cursor(3, 7)
    window.fixes()
    window.keys("Enter")
    window.problems()
    window.open("trees.xml")
    window.save()
    window.on_disk("trees.xml", TREES.replace("Sequnce", "Sequence"))


def test_a_definition_is_found_in_xml(window: Workbench) -> None:
    window.open("trees.xml")
    window.cursor(4, 22)
    window.keys("F12")
    window.at(7, 21)


def test_the_tree_is_shown_and_the_xml_converted(window: Workbench) -> None:
    window.open("trees.xml")
    window.command("btq: Show Tree Beside")
    frame = window.page.frame_locator("iframe.webview.ready").frame_locator("#active-frame")
    frame.locator("svg text:has-text('AlwaysSuccess')").wait_for()
    window.open("trees.xml")
    window.command("btq: Convert XML to btq")
    window.see(".tab:has-text('trees.btq')")
    window.see(".tab:has-text('trees.xml')")
    assert (window.folder / "trees.btq").read_text(encoding="utf-8").startswith("Root (BTCPP_format = 4)\n")
    window.close_all()  # the tree beside would be drawn again after each key of the next test
    (window.folder / "trees.btq").unlink()


@pytest.mark.scheduled
@pytest.mark.parametrize(("closing", "pause"), [("languageDefined", 0), ("never", 0), ("languageDefined", 300)])
def test_the_xml_that_is_typed_is_saved(window: Workbench, shared: Path, closing: str, pause: int) -> None:
    """The laboratory's, key by key, with and without quotes and braces that close by themselves; what is found at last
    is what a check finds."""
    text = (shared / "original" / "paper_example.xml").read_bytes().decode()
    # Neovim's test types the whole: here each word takes a tenth of a second of a processor.
    first, _, rest = text.partition("</BehaviorTree>")
    if pause or closing == "never":
        text = first.replace("mainTree", "PickPlace") + "</BehaviorTree>\n</root>\n"
    else:  # with half of the second tree, and a word and brackets of each sentence
        half, models = rest[: rest.index("</Sequence>")], rest[rest.index("<!--") :]
        half = re.sub(r'="( \S+)[^"]*"', r'="\1 ()"', half)
        text = f"{first}</BehaviorTree>{half}</Sequence>\n    </Fallback>\n  </BehaviorTree>\n\n  {models}"
    set_closing(window, closing)
    name = f"typed_{closing}_{pause}.xml"
    path = window.write(name, "")
    window.open(name)
    typed = ""
    for number, line in enumerate(text.split("\n")):
        body = line.lstrip(" ")
        if number:
            window.keys("Enter")
            if body:
                while window.blanks() > len(line) - len(body):
                    window.keys("Backspace")
                window.type(" " * (len(line) - len(body) - window.blanks()))
        for key in re.findall(r"\w+|.", body):
            if pause and key in ' ">/':  # lists have the time to open
                window.page.wait_for_timeout(pause)
            window.type(key)
            typed += key
            if typed.endswith("<!--") and closing != "never":
                window.keys(*["Delete"] * len("-->"))  # only single characters are typed over
    window.save()
    assert path.read_bytes().decode() == text
    workspace = Workspace({name: file_of(name, text)}, Project())
    lines = LineIndex(text)
    found = [
        f"btq {each.rule} [Ln {line + 1}, Col {column + 1}]"
        for each in check(workspace, name)
        if each.effective_severity is not Severity.HINT
        for line, column in [lines.position(each.span.start, "utf-16")]
    ]
    rows = window.problems_of(name, len(found))
    assert sorted(each for row in rows for each in re.findall(r"btq [\w-]+ \[Ln \d+, Col \d+\]", row)) == sorted(found)
    window.close_all()
    window.clean()


def set_closing(window: Workbench, closing: str) -> None:
    """Whether VS Code closes quotes and brackets by itself."""
    both = {
        "editor.autoClosingBrackets": closing,
        "editor.autoClosingQuotes": closing,
        "editor.autoClosingComments": closing,
    }
    window.settings(**settings_of(window.programs), **both)


# ---- missions ----


@pytest.fixture(scope="module")
def served(window: Workbench) -> Workbench:
    """The window with all settings as they come, small, for each key takes less of a processor then."""
    window.settings(**settings_of(window.programs))
    window.page.set_viewport_size({"width": 900, "height": 600})
    window.write("wrong.btq", "BehaviorTree Main\n    Sequnce\n")
    window.open("wrong.btq")
    window.see(".squiggly-warning, .squiggly-error")  # the server answers
    window.close_all()
    window.clean()
    return window


@pytest.fixture
def code(served: Workbench) -> Iterator[Workbench]:
    yield served
    served.keys("Escape")
    served.close_all()
    served.clean()


@pytest.mark.parametrize(
    ("piece", "pause"),
    [
        (0, 0),
        *(pytest.param(0, pause, marks=pytest.mark.scheduled) for pause in PAUSES[1:]),
        *(pytest.param(piece, 0, marks=pytest.mark.scheduled) for piece in range(1, len(PIECES))),
    ],
)
def test_a_mission_that_is_typed_is_saved(code: Workbench, piece: int, pause: int) -> None:
    path = code.write("typed.btq", "")
    code.open(path.name)

    def press(key: str) -> None:
        code.keys(key) if key in ("Enter", "Tab", "Backspace") else code.type(key)

    type_text(PIECES[piece], press, code.blanks, lambda: code.page.wait_for_timeout(pause) if pause else None)
    code.save()
    assert path.read_bytes().decode() == PIECES[piece]


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


@pytest.mark.scheduled
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


@pytest.mark.parametrize(
    ("text", "typed", "label", "after"),
    [
        ("QualityReq soon ", ": ", "reliability", "QualityReq soon : reliability"),
        ("BehaviorTree Main\n    Dock satisfices safety", ", ", "reliability", "safety, reliability"),
    ],
)
def test_an_accepted_quality_keeps_the_blank_before_it(
    code: Workbench, text: str, typed: str, label: str, after: str
) -> None:
    """The list opens at the sign and goes on after the blank, which VS Code takes for the beginning of the word."""
    path = begin(code, text)
    for key in typed:
        code.type(key)
        code.see(LIST)
    code.type(label[:-2])
    code.see(f"{LIST} .monaco-list-row.focused[aria-label^='{label}']")
    code.keys("Enter")
    code.gone(LIST)
    code.save()
    assert path.read_text(encoding="utf-8").endswith(after)


def test_enter_after_a_declared_node_goes_on_with_its_ports(code: Workbench) -> None:
    path = begin(code, "")
    code.type('Action Drive "Drives"')
    code.keys("Enter")
    code.type("input goal")
    code.save()
    assert path.read_text(encoding="utf-8") == 'Action Drive "Drives"\n    input goal'


def test_the_snippet_of_a_tree_leaves_no_blank_line(code: Workbench) -> None:
    path = begin(code, "")
    code.type("tree")
    code.see(f"{LIST} .monaco-list-row.focused[aria-label^='tree']")
    code.keys("Enter")
    code.gone(LIST)
    code.type("Main")
    code.keys("Tab")
    code.keys("Enter")
    code.save()
    assert path.read_text(encoding="utf-8") == "BehaviorTree Main\n    ->"


def test_enter_after_a_word_that_begins_another_is_a_line_break(code: Workbench) -> None:
    path = begin(code, "BehaviorTree Main\n    ")
    code.type("Retry")
    code.see(f"{LIST} .monaco-list-row:has-text('RetryUntilSuccessful')")
    code.keys("Enter")
    code.save()
    assert path.read_text(encoding="utf-8").rstrip(" ") == "BehaviorTree Main\n    Retry\n"


@pytest.mark.scheduled
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
        '        Action MoveBase (station = "charger") satisfies in_time'
    )
