"""What logs show, in an editor: judged by a process of its own, and again when logs, bounds or trees change."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from evidence_logs import MAIN, MAIN_XML, START, btlog, rows
from forked_server import serve
from lsp_editor import Editor, Message

MISSION = """\
QualityReq quick : performance-efficiency "In time"
    Move takes at most 30 ms
QualityReq seldom : reliability
    Pick succeeds within 1 s
    when node Move
"""
TEXT = MISSION + MAIN
RUNS = "0 1R 2R 20 2S 3R 60 3S 1S 1I 100 1R 2R 140 2S 3R 150 3S 1S"
SHOWS_PROGRESS: Message = {"window": {"workDoneProgress": True}, "workspace": {"codeLens": {"refreshSupport": True}}}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    folder = tmp_path / "robot"
    folder.mkdir()
    (folder / "btq.toml").write_text('[evidence]\nlogs = ["logs/*.btlog"]\n', encoding="utf-8")
    (folder / "main.btq").write_text(TEXT, encoding="utf-8")
    (folder / "logs").mkdir()
    (folder / "logs" / "run.btlog").write_bytes(btlog(MAIN_XML, rows(RUNS)))
    return folder


@pytest.fixture
def editor(folder: Path, tmp_path: Path) -> Iterator[Editor]:
    """An editor whose server looks at logs often, and has a cache of its own."""
    settings = f"import os, btq_lang.lsp.logs as logs; os.environ['XDG_CACHE_HOME'] = {str(tmp_path / 'cache')!r}"
    editor = Editor(folder, program=f"{settings}; logs.PAUSE = 0.1; {serve()}", capabilities=SHOWS_PROGRESS)
    with editor.process:
        yield editor
        if editor.process.returncode is None:
            editor.close()


def found(editor: Editor, *wanted: str) -> dict[str, Any]:
    """The diagnostics of evidence as soon as these rules are published, by rule."""
    while True:
        seen = {each["code"]: each for each in editor.published("main.btq")["diagnostics"]}
        if (seen.keys() & {"requirement-violated", "never-exercised"}) == {*wanted}:
            return seen


def lenses(editor: Editor) -> dict[int, list[str]]:
    titles: dict[int, list[str]] = {}
    for each in editor.request("textDocument/codeLens", **editor.document("main.btq")):
        titles.setdefault(each["range"]["start"]["line"], []).append(each["command"]["title"])
    return titles


def test_what_logs_show_of_a_mission(folder: Path, editor: Editor) -> None:
    editor.open("main.btq", TEXT)
    violated = found(editor, "requirement-violated", "never-exercised")["requirement-violated"]
    line = TEXT.splitlines().index("        Action Move")
    assert (violated["severity"], violated["range"]["start"]) == (2, {"line": line, "character": 15})
    assert violated["message"].splitlines()[0] == ("`quick` is violated: 1 of 2 activations, worst 40 ms in run 2")
    assert [
        (each["location"]["uri"], each["location"]["range"]["start"]["line"], each["message"])
        for each in violated["relatedInformation"]
    ] == [
        (editor.uri("main.btq"), 0, "`quick` demands: Move takes at most 30 ms"),
        (editor.uri("logs/run.btlog"), 0, "run 2 is in this log"),
    ]
    assert lenses(editor)[0] == ["holds for 1 node", "violated in 1 of 2 activations · worst 40 ms"]
    hover = editor.request("textDocument/hover", **editor.at("main.btq", 0, 12))["contents"]["value"]
    assert hover.split("**2 runs in logs/run.btlog**")[1].strip().splitlines()[:3] == [
        "| Verdict | Clause | Result |",
        "|---|---|---|",
        "| violated | `Move takes at most 30 ms` at Move::2 | 1 of 2 activations, worst 40 ms in run 2 |",
    ]
    shown = [each["params"]["value"] for each in editor.kept if each.get("method") == "$/progress"]
    assert [each["kind"] for each in shown if each.get("message") == "judging logs"] in (["begin"], [])


def test_an_edited_bound_is_judged_at_once_and_an_edited_tree_is_an_earlier_one(folder: Path, editor: Editor) -> None:
    editor.open("main.btq", TEXT)
    found(editor, "requirement-violated", "never-exercised")
    before = sorted((folder.parent / "cache" / "btq").iterdir())
    editor.change("main.btq", TEXT.replace("30 ms", "45 ms"))
    found(editor, "never-exercised")
    assert lenses(editor)[0][1] == "held in 2 of 2 activations · worst 40 ms"
    editor.change("main.btq", TEXT.replace("30 ms", "15 ms"))
    found(editor, "requirement-violated", "never-exercised")
    assert lenses(editor)[0][1] == "violated in 2 of 2 activations · worst 40 ms"
    edited = TEXT.replace("        Action Pick", "        AlwaysSuccess\n        Action Pick")
    editor.change("main.btq", edited)
    violated = found(editor, "requirement-violated", "never-exercised")["requirement-violated"]
    assert violated["message"].splitlines()[0].endswith("in run 2, measured on an earlier text")
    assert lenses(editor)[0][1] == "violated in 1 of 2 activations · worst 40 ms · measured on an earlier text"
    assert sorted((folder.parent / "cache" / "btq").iterdir()) == before


def test_the_picture_has_what_logs_show_of_the_present_text(folder: Path, editor: Editor) -> None:
    document = {"uri": editor.uri("main.btq")}

    def picture() -> str:
        svg: str = editor.request("workspace/executeCommand", command="btq.server.picture", arguments=[document])["svg"]
        return svg

    editor.open("main.btq", TEXT)
    editor.wait_for(lambda message: message.get("method") == "$/btq/judged")
    assert "last run: 40 ms, violated" in picture()
    assert picture().count('class="broken"') == 1
    editor.change("main.btq", TEXT.replace("30 ms", "45 ms"))
    assert "last run: 40 ms, satisfied" in picture()
    editor.change("main.btq", TEXT.replace("30 ms", "15 ms"))
    assert picture().count('class="broken"') == 2


def test_other_logs_are_read(folder: Path, editor: Editor) -> None:
    editor.open("main.btq", TEXT)
    found(editor, "requirement-violated", "never-exercised")
    (folder / "logs" / "run.btlog").write_bytes(btlog(MAIN_XML, rows(RUNS.replace("140 2S", "120 2S"))))
    found(editor, "never-exercised")
    assert lenses(editor)[0][1] == "held in 2 of 2 activations · worst 20 ms"
    editor.write("btq.toml", "")
    found(editor)
    assert [*lenses(editor)[0]] == ["holds for 1 node"]


def test_a_comment_or_a_setting_silences_them(folder: Path, editor: Editor) -> None:
    editor.write(
        "btq.toml",
        '[evidence]\nlogs = ["logs/*.btlog"]\n[rules]\nnever-exercised = "off"\nrequirement-violated = "error"\n',
    )
    editor.open("main.btq", TEXT)
    assert found(editor, "requirement-violated")["requirement-violated"]["severity"] == 1
    editor.change(
        "main.btq", TEXT.replace("        Action Move", "        Action Move  # btq: ignore[requirement-violated]")
    )
    found(editor)


def test_a_later_session_does_not_read_the_logs_again(folder: Path, editor: Editor, tmp_path: Path) -> None:
    editor.open("main.btq", TEXT)
    found(editor, "requirement-violated", "never-exercised")
    (summary,) = (tmp_path / "cache" / "btq").iterdir()
    made = os.stat(summary).st_mtime_ns
    editor.close()
    settings = f"import os; os.environ['XDG_CACHE_HOME'] = {str(tmp_path / 'cache')!r}"
    later = Editor(folder, program=f"{settings}; {serve()}")
    later.open("main.btq", TEXT)
    found(later, "requirement-violated", "never-exercised")
    later.close()
    assert os.stat(summary).st_mtime_ns == made


def test_a_run_step_by_step(folder: Path, editor: Editor) -> None:
    (folder / "logs" / "second.btlog").write_bytes(btlog(MAIN_XML, rows("0 1R 2R 25 2S 3R 30 3F 1F"), START + 10**6))
    editor.open("main.btq", TEXT)
    found(editor, "requirement-violated", "never-exercised")
    document = {"uri": editor.uri("main.btq")}
    assert editor.request("workspace/executeCommand", command="btq.server.runs", arguments=[document]) == [
        {"run": 3, "said": "the last one"},
        {"run": 2, "said": "the worst of quick, 40 ms"},
    ]
    run = editor.request("workspace/executeCommand", command="btq.server.run", arguments=[document, 3])
    assert (run["title"], run["leftOut"]) == ("Run 3 of second.btlog: failed", 0)
    assert [(step["key"], step["state"], step["time"], step["said"]) for step in run["steps"]] == [
        ("n0", "running", "", "0 ms: Sequence::1 starts"),
        ("n1", "running", "", "0 ms: Move::2 starts"),
        ("n1", "succeeded", "25 ms", "25 ms: Move::2 succeeded, 25 ms"),
        ("n2", "running", "", "25 ms: Pick::3 starts"),
        ("n2", "failed", "5 ms", "30 ms: Pick::3 failed, 5 ms"),
        ("n0", "failed", "30 ms", "30 ms: Sequence::1 failed, 30 ms"),
    ]
    refused = editor.ask("workspace/executeCommand", command="btq.server.run", arguments=[document, 4])["error"]
    assert refused["message"] == "the logs have no run 4 of this mission"
    editor.change("main.btq", TEXT.replace("        Action Pick\n", "        Action Pick (port = 1)\n"))
    refused = editor.ask("workspace/executeCommand", command="btq.server.run", arguments=[document, 3])["error"]
    assert refused["message"] == ("this run is of an earlier text: the trees have been edited since, or are not saved")


def test_the_overview_has_the_verdicts(folder: Path, editor: Editor) -> None:
    editor.open("main.btq", TEXT)
    found(editor, "requirement-violated", "never-exercised")
    document = {"uri": editor.uri("main.btq")}
    page = editor.request("workspace/executeCommand", command="btq.server.overview", arguments=[document])
    assert (
        '<span class="verdict violated">violated</span> <small>1 of 2 activations, worst 40 ms in run 2</small>' in page
    )
