"""How likely trees succeed, in an editor: computed while it is idle, and again after an edit."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from lsp_editor import Editor, Message

TEXT = """\
Action Pick
Action Place
BehaviorTree Main
    Sequence
        Retry (num_attempts = 2)
            Pick
        Place
"""
SETTINGS = '[simulate.skills]\nPick = { takes = "4 s", succeeds = "90 %" }\n'
REFRESHES: Message = {"workspace": {"codeLens": {"refreshSupport": True}}}


@pytest.fixture
def editor(tmp_path: Path) -> Iterator[Editor]:
    (tmp_path / "btq.toml").write_text(SETTINGS, encoding="utf-8")
    (tmp_path / "main.btq").write_text(TEXT, encoding="utf-8")
    editor = Editor(tmp_path, capabilities=REFRESHES)
    with editor.process:
        yield editor
        editor.close()


def lenses(editor: Editor) -> list[str]:
    return [each["command"]["title"] for each in editor.request("textDocument/codeLens", **editor.document("main.btq"))]


def lenses_after_refresh(editor: Editor, number: int) -> list[str]:
    """The lenses once the server has asked so often for them to be asked for again."""
    while [each["method"] for each in editor.asked].count("workspace/codeLens/refresh") < number:
        lenses(editor)
    return lenses(editor)


def test_a_lens_says_how_likely_a_tree_succeeds(editor: Editor) -> None:
    editor.open("main.btq", TEXT)
    first = lenses_after_refresh(editor, 1)
    assert first == ["main tree", "succeeds 99 %, p95 8 s (declared, 1 ASSUMED)"]
    editor.change("main.btq", TEXT.replace("= 2", "= 1"))
    second = lenses_after_refresh(editor, 2)
    assert second == ["main tree", "succeeds 90 %, p95 4 s (declared, 1 ASSUMED)"]
    hover = editor.request("textDocument/hover", **editor.at("main.btq", 4, 9))["contents"]["value"]
    assert "| 3 | 99.9 % | 8 s | 99.9 % |" in hover


def test_without_declared_skills_there_is_none(editor: Editor, tmp_path: Path) -> None:
    editor.open("main.btq", TEXT)
    assert len(lenses_after_refresh(editor, 1)) == 2
    (tmp_path / "btq.toml").write_text("", encoding="utf-8")
    change = {"uri": editor.uri("btq.toml"), "type": 2}
    editor.notify("workspace/didChangeWatchedFiles", changes=[change])
    while lenses(editor) != ["main tree"]:
        pass
