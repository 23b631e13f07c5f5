"""VS Code with XML: of BehaviorTree.CPP it is served like a mission, of others nothing is said and nothing started.

One window on a folder without missions: the tests follow each other, and the first finds no server.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from chromium import CHROMIUM
from installed import ROOT, STORE, there
from workbench import Workbench, workbench

from btq_lang.btcpp.opening import file_of
from btq_lang.checks import check
from btq_lang.diagnostics.rules import Severity
from btq_lang.util.text import LineIndex
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace

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
SETTINGS = {
    "files.autoSave": "off",
    "workbench.startupEditor": "none",
    "chat.disableAIFeatures": True,
}


@pytest.fixture(scope="module")
def code(vsix: Path, node: Path, driver: None, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Workbench]:
    there(CHROMIUM, "Chromium", "from_apt")
    there(STORE / "vscode/node_modules/code-server/out/node/entry.js", "VS Code", "vscode")
    scratch = tmp_path_factory.mktemp("xml")
    server = scratch / "btq-lsp"
    server.write_text(
        f'#!/bin/sh\necho >>"{scratch}/started"\nPYTHONPATH="{ROOT}" exec "{sys.executable}" -m btq_lang.server "$@"\n'
    )
    server.chmod(0o755)
    settings = {**SETTINGS, "btq.server.command": [str(server)]}
    with workbench(
        store=STORE, node=node, vsix=vsix, scratch=scratch, files=None, settings=settings, programs=scratch
    ) as window:
        yield window


def started(code: Workbench) -> int:
    """How often a server was started."""
    path = code.programs / "started"
    return len(path.read_text()) if path.exists() else 0


def test_other_xml_starts_no_server(code: Workbench) -> None:
    code.write("pom.xml", POM)
    code.open("pom.xml")
    code.keys("Control+End")
    code.type("<!-- more -->")
    code.page.wait_for_timeout(3000)  # longer than a server takes to start
    assert started(code) == 0
    code.close_all()


def test_xml_of_the_engine_is_checked(code: Workbench) -> None:
    code.write("trees.xml", TREES)
    code.open("trees.xml")
    code.see(".squiggly-warning")
    assert started(code) == 1
    (row,) = code.problems("unknown node `Sequnce`")
    assert "did you mean `Sequence`?" in row
    code.open("trees.xml")
    code.cursor(3, 7)
    code.fixes()
    code.keys("Enter")
    code.problems()
    code.open("trees.xml")
    code.save()
    code.on_disk("trees.xml", TREES.replace("Sequnce", "Sequence"))


def test_a_definition_is_found_in_xml(code: Workbench) -> None:
    code.open("trees.xml")
    code.cursor(4, 22)
    code.keys("F12")
    code.at(7, 21)


def test_the_tree_is_shown_and_the_xml_converted(code: Workbench) -> None:
    code.open("trees.xml")
    code.command("btq: Show Tree Beside")
    frame = code.page.frame_locator("iframe.webview.ready").frame_locator("#active-frame")
    frame.locator("svg text:has-text('AlwaysSuccess')").wait_for()
    code.open("trees.xml")
    code.command("btq: Convert XML to btq")
    code.see(".tab:has-text('trees.btq')")
    code.see(".tab:has-text('trees.xml')")
    assert (code.folder / "trees.btq").read_text(encoding="utf-8").startswith("Root (BTCPP_format = 4)\n")
    code.close_all()  # the tree beside would be drawn again after each key of the next test


@pytest.mark.flaky(reruns=1)  # as in test_typing: a busy machine shows some things late
@pytest.mark.parametrize(("closing", "pause"), [("languageDefined", 0), ("never", 0), ("languageDefined", 300)])
def test_the_xml_that_is_typed_is_saved(code: Workbench, shared: Path, closing: str, pause: int) -> None:
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
    set_closing(code, closing)
    name = f"typed_{closing}_{pause}.xml"
    path = code.write(name, "")
    code.open(name)
    typed = ""
    for number, line in enumerate(text.split("\n")):
        body = line.lstrip(" ")
        if number:
            code.keys("Enter")
            if body:
                while code.blanks() > len(line) - len(body):
                    code.keys("Backspace")
                code.type(" " * (len(line) - len(body) - code.blanks()))
        for key in re.findall(r"\w+|.", body):
            if pause and key in ' ">/':  # lists have the time to open
                code.page.wait_for_timeout(pause)
            code.type(key)
            typed += key
            if typed.endswith("<!--") and closing != "never":
                code.keys(*["Delete"] * len("-->"))  # only single characters are typed over
    code.save()
    assert path.read_bytes().decode() == text
    workspace = Workspace({name: file_of(name, text)}, Project())
    lines = LineIndex(text)
    found = [
        f"btq {each.rule} [Ln {line + 1}, Col {column + 1}]"
        for each in check(workspace, name)
        if each.effective_severity is not Severity.HINT
        for line, column in [lines.position(each.span.start, "utf-16")]
    ]
    rows = code.problems_of(name, len(found))
    assert sorted(each for row in rows for each in re.findall(r"btq [\w-]+ \[Ln \d+, Col \d+\]", row)) == sorted(found)
    code.close_all()
    code.clean()


def set_closing(code: Workbench, closing: str) -> None:
    """Whether VS Code closes quotes and brackets by itself."""
    both = {
        "editor.autoClosingBrackets": closing,
        "editor.autoClosingQuotes": closing,
        "editor.autoClosingComments": closing,
    }
    code.settings(**SETTINGS, **both, **{"btq.server.command": [str(code.programs / "btq-lsp")]})
