"""Scenarios in an editor: listed, run in their present text, and what a run shows until the text changes."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from time import sleep
from typing import Any

import pytest
from forked_server import serve
from lsp_editor import Editor, Message
from server_children import children, needs_proc

TREE = """\
BehaviorTree Deliver
    ->
        MoveTo (location = "A")
        ?
            MoveTo (location = "E")
            MoveTo (location = "B")
"""
CASES = """\
include "deliver.btq"

scenario "E is closed"
    given MoveTo (location = "E") fails
    expect MoveTo runs "A", "E", "B"
    expect mission succeeds

scenario "E is open"
    expect MoveTo runs "A", "E", "B"
"""
LONG = """\
BehaviorTree Count
    Repeat (num_cycles = -1)
        Delay (delay_msec = 1)
            Script (code = "n := n + 1")

given {n} = 0

scenario "for ever"
    expect mission succeeds
"""


@pytest.fixture
def editor(tmp_path: Path) -> Iterator[Editor]:
    yield from editing(tmp_path, {})


def editing(folder: Path, capabilities: Message) -> Iterator[Editor]:
    for name, text in {"btq.toml": "", "deliver.btq": TREE, "cases.btq": CASES}.items():
        (folder / name).write_text(text, encoding="utf-8")
    editor = Editor(folder, program=serve(), capabilities=capabilities)
    with editor.process:
        yield editor
        if editor.process.returncode is None:
            editor.close()


def command(editor: Editor, name: str, *arguments: Any) -> Any:
    return editor.request("workspace/executeCommand", command=name, arguments=arguments)


def run(editor: Editor, name: str, *titles: str) -> Any:
    return command(editor, "btq.server.runScenarios", {"uri": editor.uri(name)}, *titles)


def place(first: int, start: int, last: int, end: int) -> Message:
    return {"start": {"line": first, "character": start}, "end": {"line": last, "character": end}}


def shown(editor: Editor, count: int) -> list[Message]:
    """The diagnostics of scenarios, as soon as there are so many."""
    while True:
        published = editor.published("cases.btq")["diagnostics"]
        diagnostics = [each for each in published if each["source"] == "btq test"]
        if len(diagnostics) == count:
            return diagnostics


def test_the_scenarios_of_a_file_and_of_all(editor: Editor) -> None:
    listed = [
        {
            "uri": editor.uri("cases.btq"),
            "scenarios": [
                {"title": "E is closed", "range": place(2, 0, 5, 27)},
                {"title": "E is open", "range": place(7, 0, 8, 36)},
            ],
        }
    ]
    assert command(editor, "btq.server.scenarios", None) == listed
    assert command(editor, "btq.server.scenarios", {"uri": editor.uri("cases.btq")}) == listed
    assert command(editor, "btq.server.scenarios", {"uri": editor.uri("deliver.btq")}) == []
    editor.open("cases.btq", CASES)
    editor.change("cases.btq", CASES[: CASES.index('scenario "E is open"')])
    (file,) = command(editor, "btq.server.scenarios", None)
    assert [each["title"] for each in file["scenarios"]] == ["E is closed"]


def test_a_run_tells_what_differs_where_it_is_expected(editor: Editor) -> None:
    editor.open("cases.btq", CASES)
    closed, opened = run(editor, "cases.btq")
    assert closed == {
        "title": "E is closed",
        "range": place(2, 9, 2, 22),
        "outcome": "passed",
        "message": "",
        "failures": [],
        "text": closed["text"],
    }
    message = (
        'after 0 ms Sequence::1 (deliver.btq:2): the mission succeeds, and the node has not run with it; expected "B"'
    )
    assert opened == {
        "title": "E is open",
        "range": place(7, 9, 7, 20),
        "outcome": "failed",
        "message": message,
        "failures": [{"range": place(8, 4, 8, 36), "message": message}],
        "text": opened["text"],
    }
    (diagnostic,) = shown(editor, 1)
    assert diagnostic == {
        "range": place(8, 4, 8, 36),
        "message": message,
        "severity": 1,
        "source": "btq test",
        "relatedInformation": [
            {
                "location": {"uri": editor.uri("deliver.btq"), "range": place(1, 0, 1, 0)},
                "message": "Sequence::1: the mission succeeds, and the node has not run with it",
            }
        ],
    }
    assert opened["text"].splitlines() == [
        "failed  E is open (cases.btq:8): succeeds after 0 ms",
        '        line 9: expect MoveTo runs "A", "E", "B"',
        f"          {message}",
        "                      0                                   0 ms",
        "          Sequence   |S                                       | succeeded",
        "            MoveTo   |S                                       | succeeded",
        "            Fallback |S                                       | succeeded",
        "              MoveTo |S                                       | succeeded",
        "        ASSUMED to succeed at once: MoveTo::2, MoveTo::4",
    ]


def test_what_is_shown_goes_with_an_edit_that_it_depends_on(editor: Editor) -> None:
    editor.open("cases.btq", CASES)
    editor.open("deliver.btq", TREE)
    run(editor, "cases.btq", "E is open")
    shown(editor, 1)
    editor.change("cases.btq", f"{CASES}# nothing else\n")
    shown(editor, 0)
    run(editor, "cases.btq", "E is open")
    shown(editor, 1)
    editor.change("deliver.btq", TREE.replace('"A"', '"C"'))
    shown(editor, 0)
    run(editor, "cases.btq")
    assert [each["range"]["start"]["line"] for each in shown(editor, 2)] == [4, 8]


def test_the_texts_of_the_editor_are_run(editor: Editor) -> None:
    editor.open("cases.btq", CASES)
    editor.open("deliver.btq", TREE)
    editor.change("deliver.btq", TREE.replace("        ?", "        ->"))
    assert [each["outcome"] for each in run(editor, "cases.btq")] == ["failed", "passed"]
    editor.change("cases.btq", CASES.replace("fails", "succeeds"))
    assert [each["outcome"] for each in run(editor, "cases.btq")] == ["passed", "passed"]
    assert (editor.root / "deliver.btq").read_text(encoding="utf-8") == TREE


COVERED = """\
BehaviorTree Deliver
    ->
        /* 🤖 */ MoveTo (location = "A")
        Ready

BehaviorTree Leave
    MoveTo (location = "B")

Condition Ready
"""
COVERING = """\
include "deliver.btq"

given Ready answers true

scenario "all is well" of Deliver
    expect mission succeeds

scenario "A is closed" of Deliver
    given MoveTo fails
    expect mission fails

scenario "A is closed" of Deliver
    given MoveTo fails
    expect mission succeeds
"""


def test_what_scenarios_have_met_is_told_by_file(editor: Editor) -> None:
    editor.open("deliver.btq", TREE)
    editor.change("deliver.btq", COVERED)
    editor.open("cases.btq", CASES)
    editor.change("cases.btq", COVERING)

    def cover(*titles: str) -> Any:
        return command(editor, "btq.server.coverScenarios", {"uri": editor.uri("cases.btq")}, *titles)

    def node(line: int, column: int, name: str, **scenarios: int) -> Message:
        outcomes = [{"outcome": outcome, "scenarios": number} for outcome, number in scenarios.items()]
        return {"position": {"line": line, "character": column}, "node": name, "outcomes": outcomes}

    answer = cover()
    assert [each["outcome"] for each in answer["results"]] == ["passed", "passed", "failed"]
    assert answer["coverage"] == [
        {
            "uri": editor.uri("deliver.btq"),
            "nodes": [
                node(1, 4, "Sequence", succeeds=1, fails=2),
                node(2, 17, "MoveTo", succeeds=1, fails=2),  # in UTF-16
                node(3, 8, "Ready", succeeds=1, fails=0),
            ],
            "unused": [{"position": {"line": 5, "character": 0}, "tree": "Leave"}],
        }
    ]
    answer = cover("all is well")
    assert [each["title"] for each in answer["results"]] == ["all is well"]
    assert answer["coverage"][0]["nodes"][1] == node(2, 17, "MoveTo", succeeds=1, fails=0)


def test_an_edit_during_a_run_does_not_change_what_runs(editor: Editor) -> None:
    editor.open("cases.btq", CASES)
    asked = {"command": "btq.server.runScenarios", "arguments": [{"uri": editor.uri("cases.btq")}]}
    editor.count += 1
    number = editor.count
    editor.send(id=number, method="workspace/executeCommand", params=asked)
    editor.change("cases.btq", "# nothing")
    answer = editor.wait_for(lambda message: message.get("id") == number)
    assert [each["outcome"] for each in answer["result"]] == ["passed", "failed"]
    editor.change("cases.btq", "# still nothing\n")
    shown(editor, 0)


def test_why_a_whole_scenario_is_not_as_expected_is_shown_at_its_title(editor: Editor) -> None:
    editor.open("deliver.btq", TREE)
    editor.change("deliver.btq", f"Condition Ready\n{TREE}        Ready\n")
    unanswered = f'{CASES}\nscenario "wrong"\n    given Nobody fails\n    expect mission succeeds\n'
    editor.open("cases.btq", unanswered)
    *_, unready, wrong = run(editor, "cases.btq")
    assert (unready["outcome"], unready["message"]) == ("error", "Ready::6 was asked at 0 s; say what it answers")
    assert unready["failures"][0]["range"] == unready["range"]
    assert (wrong["outcome"], wrong["message"]) == ("error", "line 12: unknown node `Nobody`")


def test_the_lens_above_a_scenario_runs_it(editor: Editor) -> None:
    editor.open("cases.btq", CASES)
    (_, lens) = editor.request("textDocument/codeLens", **editor.document("cases.btq"))
    assert lens["range"] == place(7, 9, 7, 20)
    assert lens["command"] == {
        "title": "run",
        "command": "btq.server.showScenarios",
        "arguments": [{"uri": editor.uri("cases.btq")}, "E is open"],
    }
    command(editor, lens["command"]["command"], *lens["command"]["arguments"])
    said = editor.wait_for(lambda message: message.get("method") == "window/showMessage")["params"]
    assert (said["type"], said["message"].splitlines()[0]) == (2, "failed: E is open")
    shown(editor, 1)


def test_an_editor_with_a_list_of_tests_runs_it_there(tmp_path: Path) -> None:
    for editor in editing(tmp_path, {"experimental": {"commands": ["btq.runScenario"]}}):
        editor.open("cases.btq", CASES)
        lenses = editor.request("textDocument/codeLens", **editor.document("cases.btq"))
        assert [each["command"]["command"] for each in lenses] == ["btq.runScenario"] * 2


def test_an_editor_that_pulls_is_told_to_ask_again(tmp_path: Path) -> None:
    pulls = {"textDocument": {"diagnostic": {}}, "workspace": {"diagnostics": {"refreshSupport": True}}}
    for editor in editing(tmp_path, pulls):
        editor.open("cases.btq", CASES)

        def items(editor: Editor = editor) -> list[Message]:
            report = editor.request("textDocument/diagnostic", **editor.document("cases.btq"))
            return [each for each in report["items"] if each["source"] == "btq test"]

        assert items() == []
        editor.asked.clear()
        run(editor, "cases.btq")
        assert [each["range"]["start"]["line"] for each in items()] == [8]
        assert "workspace/diagnostic/refresh" in [each["method"] for each in editor.asked]
        editor.change("cases.btq", f"{CASES}\n")
        assert items() == []


def test_what_cannot_be_run_is_refused(editor: Editor) -> None:
    def refusal(name: str, *titles: str) -> str:
        arguments = [{"uri": editor.uri(name)}, *titles]
        answer = editor.ask("workspace/executeCommand", command="btq.server.runScenarios", arguments=arguments)
        message: str = answer["error"]["message"]
        return message

    editor.open("cases.btq", CASES)
    assert refusal("cases.btq", "no such title") == "this document has no such scenario"
    assert refusal("deliver.btq") == "this document has no scenario"
    assert refusal("elsewhere.btq") == "this is not a .btq file of the open folders"


def begin_long_run(editor: Editor) -> int:
    """Ask for a run, and wait until it has begun; the request."""
    editor.open("cases.btq", LONG)
    editor.count += 1
    asked = {"command": "btq.server.runScenarios", "arguments": [{"uri": editor.uri("cases.btq")}]}
    editor.send(id=editor.count, method="workspace/executeCommand", params=asked)
    number = editor.count
    while not children(editor):
        assert editor.request("textDocument/documentSymbol", **editor.document("cases.btq"))  # is answered meanwhile
    return number


@needs_proc
def test_a_long_run_is_cancelled(editor: Editor) -> None:
    number = begin_long_run(editor)
    editor.notify("$/cancelRequest", id=number)
    answer = editor.wait_for(lambda message: message.get("id") == number)
    assert answer["error"]["code"] == -32800
    while children(editor):
        editor.request("textDocument/documentSymbol", **editor.document("cases.btq"))
    assert editor.close() == ""


@needs_proc
def test_a_long_run_ends_with_the_server(editor: Editor) -> None:
    begin_long_run(editor)
    (child,) = children(editor)
    editor.close()
    while Path(f"/proc/{child}/cmdline").exists() and Path(f"/proc/{child}/cmdline").read_bytes():  # or its rest
        sleep(0.01)
