"""How a requirement can be violated, asked in an editor: the answer, and what the next key does to it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from forked_server import serve
from lsp_editor import Editor, Message
from server_children import children, needs_proc

DEMANDS = """\
QualityReq most : reliability "It looks three times"
    Look tries at most {most}

QualityReq quick : performance-efficiency "It is quick"
    takes at most 30 s
"""
MISSION = """\
include "demands.btq"

BehaviorTree Main
    Retry (num_attempts = 3) satisfies quick
        Look

BehaviorTree Root
    SubTree Main
"""
# A search of many states: actions run beside each other.
LARGE = 'include "demands.btq"\n\nBehaviorTree Main\n    ParallelAll\n        Look\n' + "".join(
    f"        Sequence\n            A{number}\n            B{number}\n            C{number}\n" for number in range(9)
)


@pytest.fixture
def editor(tmp_path: Path) -> Iterator[Editor]:
    yield from editing(tmp_path, {})


def editing(folder: Path, capabilities: Message) -> Iterator[Editor]:
    for name, text in {"btq.toml": "", "demands.btq": DEMANDS.format(most=2), "mission.btq": MISSION}.items():
        (folder / name).write_text(text, encoding="utf-8")
    editor = Editor(folder, program=serve(), capabilities=capabilities)
    with editor.process:
        yield editor
        if editor.process.returncode is None:
            editor.close()


def command(editor: Editor, name: str, *arguments: Any) -> Any:
    return editor.request("workspace/executeCommand", command=name, arguments=arguments)


def explore(editor: Editor, requirement: str) -> Any:
    return command(editor, "btq.server.explore", {"uri": editor.uri("demands.btq")}, requirement)


RUN = """\
mission.btq: tree Root, BehaviorTree.CPP 4.10
  most `Look tries at most 2` can be violated: yes, in 3 ticks
    tick 1
      Main::1/Look::3 fails  (mission.btq:5)
    tick 2
      Main::1/Look::3 fails  (mission.btq:5)
    tick 3
      Main::1/Look::3 succeeds  (mission.btq:5)

most is violated
                          0                                   0 ms
  Main                   |S                                       | succeeded
    RetryUntilSuccessful |S                                       | succeeded
      Look               |S                                       | succeeded 1, failed 2
"""
SCENARIO = """\
include "mission.btq"

scenario "most is violated" verifies most
    given Look fails 2 times, then succeeds
    expect most
"""


def test_a_run_that_violates_it_is_a_scenario(editor: Editor) -> None:
    (editor.root / "most_violated.btq").write_text("# another\n", encoding="utf-8")
    editor.open("demands.btq", DEMANDS.format(most=2))
    clause = {
        "text": "Look tries at most 2",
        "answer": "yes",
        "states": 3,
        "message": "most `Look tries at most 2` can be violated: yes, in 3 ticks",
    }
    assert explore(editor, "most") == [
        {
            "uri": editor.uri("mission.btq"),
            "clauses": [clause],
            "text": RUN,
            "scenarios": {"uri": editor.uri("most_violated2.btq"), "text": SCENARIO},
            "problem": "",
        }
    ]


def test_the_scenario_may_be_in_a_buffer_that_is_to_become_a_file(editor: Editor) -> None:
    """As VS Code opens one: the include is that of the folder of the mission."""
    uri = f"untitled:{editor.root}/most_violated.btq"
    editor.notify(
        "textDocument/didOpen", textDocument={"uri": uri, "languageId": "btq", "version": 1, "text": SCENARIO}
    )
    published = editor.wait_for(lambda message: message.get("params", {}).get("uri") == uri)
    assert published["params"]["diagnostics"] == []
    (result,) = command(editor, "btq.server.runScenarios", {"uri": uri})
    assert (result["title"], result["outcome"]) == ("most is violated", "failed")


def test_the_texts_of_the_editor_are_explored(editor: Editor) -> None:
    editor.open("demands.btq", DEMANDS.format(most=2))
    editor.change("demands.btq", DEMANDS.format(most=3))
    (answer,) = explore(editor, "most")
    message = "most `Look tries at most 3` can be violated: no, in all 3 states"
    assert answer["clauses"] == [{"text": "Look tries at most 3", "answer": "no", "states": 3, "message": message}]
    assert (answer["scenarios"], answer["text"].splitlines()[1:]) == (None, [f"  {message}"])
    editor.open("mission.btq", MISSION)
    editor.change("mission.btq", MISSION.replace("= 3", "= 4"))
    assert explore(editor, "most")[0]["clauses"][0]["answer"] == "yes"


def test_why_a_mission_cannot_be_explored(editor: Editor) -> None:
    editor.open("mission.btq", MISSION)
    editor.change("mission.btq", MISSION.replace("Retry (num_attempts = 3)", "Retry"))
    (answer,) = explore(editor, "most")
    assert (answer["clauses"], answer["scenarios"], answer["text"]) == ([], None, "")
    why = "Main::1/RetryUntilSuccessful::2 lacks the port [num_attempts]"
    assert answer["problem"] == f"mission.btq: the engine refuses the tree: {why}"


def place(line: int, start: int, end: int) -> Message:
    return {"start": {"line": line, "character": start}, "end": {"line": line, "character": end}}


@pytest.mark.parametrize("own", [False, True])
def test_a_lens_and_an_action_ask_where_that_can_be_asked(tmp_path: Path, own: bool) -> None:
    """Of `quick` it cannot: time has a part in it."""
    for editor in editing(tmp_path, {"experimental": {"commands": ["btq.explore"]}} if own else {}):
        editor.open("demands.btq", DEMANDS.format(most=2))
        editor.open("mission.btq", MISSION.replace("satisfies quick", "satisfies quick satisfies most"))
        name = "btq.explore" if own else "btq.server.showExplored"
        asked = {"command": name, "arguments": [{"uri": editor.uri("demands.btq")}, "most"]}
        lenses = editor.request("textDocument/codeLens", **editor.document("demands.btq"))
        assert [each for each in lenses if each["command"]["command"] == name] == [
            {"range": place(0, 11, 15), "command": {"title": "how can this be violated?", **asked}}
        ]
        action = {"title": "Explore how `most` can be violated", "kind": "btq.explore"}
        for file, line, column, offered in (
            ("demands.btq", 0, 12, True),
            ("mission.btq", 3, 55, True),  # where a node satisfies it
            ("demands.btq", 3, 12, False),
            ("mission.btq", 3, 5, False),
        ):
            context = {"diagnostics": [], "only": ["btq.explore"]}
            where = {"range": place(line, column, column), "context": context}
            actions = editor.request("textDocument/codeAction", **editor.document(file), **where)
            assert actions == ([{**action, "command": {"title": action["title"], **asked}}] if offered else [])
        if not own:
            command(editor, name, *asked["arguments"])
            said = editor.wait_for(lambda message: message.get("method") == "window/showMessage")["params"]
            assert said == {"type": 2, "message": RUN}


def test_what_cannot_be_asked_is_refused(editor: Editor) -> None:
    def refusal(name: str, requirement: str) -> Any:
        arguments = [{"uri": editor.uri(name)}, requirement]
        answer = editor.ask("workspace/executeCommand", command="btq.server.explore", arguments=arguments)
        return answer["error"]["code"], answer["error"]["message"]

    why = "no mission demands by `{}` what a run can violate without regard to time"
    assert refusal("demands.btq", "quick") == (-32803, why.format("quick"))
    assert refusal("demands.btq", "nothing") == (-32803, why.format("nothing"))
    assert refusal("elsewhere.btq", "most") == (-32803, "this is not a .btq file of the open folders")


def begin_long_search(editor: Editor) -> int:
    """Ask, and wait until the search has begun; the request."""
    editor.open("mission.btq", MISSION)
    editor.change("mission.btq", LARGE)
    editor.open("demands.btq", DEMANDS.format(most=2))
    editor.count += 1
    asked = {"command": "btq.server.explore", "arguments": [{"uri": editor.uri("demands.btq")}, "most"]}
    editor.send(id=editor.count, method="workspace/executeCommand", params=asked)
    number = editor.count
    while not children(editor):
        assert editor.request("textDocument/documentSymbol", **editor.document("mission.btq"))  # is answered meanwhile
    return number


@needs_proc
@pytest.mark.parametrize("by", ["a key", "the editor"])
def test_a_long_search_ends(editor: Editor, by: str) -> None:
    number = begin_long_search(editor)
    if by == "a key":
        editor.change("demands.btq", DEMANDS.format(most=3))
        edited = "a text was edited: ask again whether `most` can be violated"
        expected = {"code": -32801, "message": edited}
    else:
        editor.notify("$/cancelRequest", id=number)
        expected = {"code": -32800, "message": f'Request with id "{number}" is canceled'}
    answer = editor.wait_for(lambda message: message.get("id") == number)
    assert {key: answer["error"][key] for key in ("code", "message")} == expected
    while children(editor):
        assert editor.request("textDocument/documentSymbol", **editor.document("demands.btq"))
    editor.change("mission.btq", MISSION)
    assert explore(editor, "most")[0]["clauses"][0]["states"] == 3
    assert editor.close() == ""
