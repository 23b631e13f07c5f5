"""Hazards as an editor sees them: kinds that the protocol has."""

from __future__ import annotations

from pathlib import Path

from lsp_editor import Editor

TEXT = 'hazard H1 "Collision"\nQualityReq r "R"\n    mitigates H1\n'


def test_outline_and_completion(tmp_path: Path) -> None:
    editor = Editor(tmp_path)
    editor.open("main.btq", TEXT)
    outline = editor.request("textDocument/documentSymbol", **editor.document("main.btq"))
    assert [(symbol["name"], symbol["kind"]) for symbol in outline] == [("H1", 20), ("r", 7)]
    offered = editor.request("textDocument/completion", **editor.at("main.btq", 2, 14))["items"]
    assert [(item["label"], item["kind"]) for item in offered] == [("H1", 23)]
    editor.close()
