"""VS Code with XML: of BehaviorTree.CPP it is served like a mission, of others nothing is said and nothing started.

One window on a folder without missions: the tests follow each other, and the first finds no server.
"""

from __future__ import annotations

import shutil
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from installed import ROOT, STORE, there
from workbench import Workbench, workbench

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
    there(shutil.which("chromium"), "Chromium", "from_apt")
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
