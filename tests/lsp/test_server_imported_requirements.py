"""Requirements of other tools in an editor: their files are read again when they change."""

from __future__ import annotations

from pathlib import Path

from lsp_editor import Editor


def test_problems_come_and_go_with_the_file(tmp_path: Path) -> None:
    (tmp_path / "btq.toml").write_text('[requirements]\nimport = ["reqs.csv"]\n')
    (tmp_path / "reqs.csv").write_text("name\nx\n")
    (tmp_path / "main.btq").write_text("BehaviorTree Main\n    AlwaysSuccess\n")
    editor = Editor(tmp_path)
    (problem,) = editor.published("btq.toml")["diagnostics"]
    assert problem["range"]["start"] == {"line": 1, "character": 10}
    assert problem["message"].startswith("`reqs.csv:1:1`: no column has ids; expected one that is named id, uid")
    editor.write("reqs.csv", "id\nx\n")
    assert editor.published("btq.toml")["diagnostics"] == []
    editor.write("reqs.csv", 'id\n"x\n')
    (problem,) = editor.published("btq.toml")["diagnostics"]
    assert problem["message"] == "`reqs.csv:2:1`: not CSV: unexpected end of data"
    assert editor.close() == ""


def test_names_of_requirements_are_links(tmp_path: Path) -> None:
    (tmp_path / "btq.toml").write_text('[requirements]\nimport = ["reqs.csv"]\n')
    (tmp_path / "reqs.csv").write_text("id,title,url\nR1,One,https://x.org/R1\nR2,Two,\n")
    text = "QualityReq calm\n    Drive takes at most 30 s\n    refines R1, \nAction Drive\n"
    (tmp_path / "main.btq").write_text(text)
    editor = Editor(tmp_path)
    editor.open("main.btq", text)
    links = editor.request("textDocument/documentLink", **editor.document("main.btq"))
    assert [(link["target"], link["range"]["start"]) for link in links] == [
        ("https://x.org/R1", {"line": 2, "character": 12})
    ]
    offers = editor.request("textDocument/completion", **editor.at("main.btq", 2, 16))
    assert [one["label"] for one in offers["items"] if one.get("detail") == "Two"] == ["R2"]
    editor.change("main.btq", text.replace("R1, ", "R2"))
    links = editor.request("textDocument/documentLink", **editor.document("main.btq"))
    assert [link["target"] for link in links] == [f"{editor.uri('reqs.csv')}#L3"]
    assert editor.close() == ""
