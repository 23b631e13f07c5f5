"""The language server as an editor runs it: a process, spoken to over its standard input and output."""

from __future__ import annotations

import asyncio
import json
import re
import shutil
import socket
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from time import sleep

import pytest
from lsp_editor import SERVER, Editor, Message, part
from lsprotocol import types
from running_process import running

from btq_lang.diagnostics.model import Diagnostic, Place, Related
from btq_lang.lsp.convert import Converter
from btq_lang.lsp.editor import Server
from btq_lang.util.text import Span
from btq_lang.workspace.findings import FileFindings
from btq_lang.workspace.workspace import Workspace

WRONG = "BehaviorTree Main\n    ->\n        Sequnce\n            Dock\n"
RIGHT = WRONG.replace("Sequnce", "Sequence")
MISSION = 'include "skills.btq"\nBehaviorTree Main\n    Pick (from = shelf)\n'
SKILLS = "Action Pick\n    input from : string\n"


@pytest.fixture
def editor(tmp_path: Path) -> Iterator[Editor]:
    editor = Editor(tmp_path)
    yield editor
    assert editor.close() == ""


def edits(changes: list[Message]) -> list[tuple[int, int, int, str]]:
    return [
        (
            each["range"]["start"]["line"],
            each["range"]["start"]["character"],
            each["range"]["end"]["character"],
            each["newText"],
        )
        for each in changes
    ]


# ---- diagnostics that are pushed ----


def test_diagnostics_come_and_go_as_one_types(editor: Editor) -> None:
    editor.open("main.btq", WRONG)
    assert editor.diagnostics("main.btq") == [("unknown-node", 2, 8, 15)]
    editor.change("main.btq", RIGHT)
    assert editor.diagnostics("main.btq") == []
    editor.change("main.btq", "")
    assert editor.published("main.btq") == {"uri": editor.uri("main.btq"), "diagnostics": [], "version": 3}


def test_typed_key_by_key_it_is_what_it_would_be_at_once(tmp_path: Path) -> None:
    requirement = 'QualityReq rq : speed "Fast"\n    takes at most 3 sek\n'
    text = f"{requirement}BehaviorTree Main\n    Retry\n        Pick satisfies rq\n"
    typing, reading = Editor(tmp_path), Editor(tmp_path)
    typing.open("main.btq", "")
    for end in range(1, len(text) + 1):
        typing.change("main.btq", text[:end])
    reading.open("main.btq", text)
    while (told := typing.published("main.btq")).pop("version") != len(text) + 1:
        pass
    expected = reading.published("main.btq")
    assert expected.pop("version") == 1
    assert told == expected
    assert len(told["diagnostics"]) > 2
    assert typing.close() == reading.close() == ""


def test_an_edit_in_one_file_reaches_the_file_that_includes_it(editor: Editor) -> None:
    editor.open("skills.btq", "Action Dock\n")
    assert editor.diagnostics("skills.btq") == []
    editor.open("main.btq", 'include "skills.btq"\nBehaviorTree Main\n    Dock (x = 1)\n')
    assert editor.diagnostics("main.btq") == [("unknown-port", 2, 10, 11)]
    editor.change("skills.btq", "Action Dock\n    input x : int = 0\n")
    assert editor.diagnostics("main.btq") == []


def test_an_edit_reaches_files_that_are_closed(tmp_path: Path) -> None:
    (tmp_path / "main.btq").write_text(MISSION, encoding="utf-8")
    (tmp_path / "skills.btq").write_text(SKILLS, encoding="utf-8")
    editor = Editor(tmp_path)
    editor.open("skills.btq", SKILLS)
    assert editor.diagnostics("skills.btq") == []
    editor.change("skills.btq", SKILLS.replace("from", "shelf"))
    assert [found[0] for found in editor.diagnostics("main.btq")] == ["unknown-port"]
    editor.shut("skills.btq")  # without saving: the file on the disk counts again
    assert editor.diagnostics("main.btq") == []
    assert editor.close() == ""


def test_closed_files_are_checked_from_the_start(tmp_path: Path) -> None:
    (tmp_path / "main.btq").write_text(WRONG, encoding="utf-8")
    editor = Editor(tmp_path)
    assert editor.diagnostics("main.btq") == [("unknown-node", 2, 8, 15)]
    editor.open("main.btq", RIGHT)
    assert editor.diagnostics("main.btq") == []
    editor.shut("main.btq")
    assert editor.diagnostics("main.btq") == [("unknown-node", 2, 8, 15)]
    assert editor.close() == ""


def test_closing_a_file_that_is_on_no_disk_clears_it(editor: Editor) -> None:
    editor.open("main.btq", WRONG)
    assert editor.diagnostics("main.btq") != []
    editor.shut("main.btq")
    assert editor.diagnostics("main.btq") == []


def test_a_file_has_one_name_at_a_time(tmp_path: Path) -> None:
    def told(editor: Editor, uri: str) -> list[str]:
        message = editor.wait_for(lambda message: message.get("params", {}).get("uri") == uri)
        return [each["code"] for each in message["params"]["diagnostics"]]

    (tmp_path / "main (2).btq").write_text(WRONG, encoding="utf-8")
    ours = (tmp_path / "main (2).btq").as_uri()
    theirs = ours.replace("%28", "(").replace("%29", ")")
    assert theirs != ours
    document = {"uri": theirs, "languageId": "btq", "version": 1, "text": WRONG}
    editor = Editor(tmp_path)
    assert told(editor, ours) == ["unknown-node"]
    editor.notify("textDocument/didOpen", textDocument=document)
    assert (told(editor, ours), told(editor, theirs)) == ([], ["unknown-node"])
    assert editor.close() == ""

    editor = Editor(tmp_path, capabilities=PULLS)
    first = editor.request("workspace/diagnostic", previousResultIds=[])["items"]
    editor.notify("textDocument/didOpen", textDocument=document)
    known = [{"uri": each["uri"], "value": each["resultId"]} for each in first]
    items = editor.request("workspace/diagnostic", previousResultIds=known)["items"]
    assert {each["uri"]: len(each["items"]) for each in items} == {ours: 0, theirs: 1}
    assert editor.close() == ""


def test_a_buffer_without_a_file(editor: Editor) -> None:
    uri = "untitled:Untitled-1"
    editor.notify("textDocument/didOpen", textDocument={"uri": uri, "languageId": "btq", "version": 1, "text": WRONG})
    told = editor.wait_for(lambda message: message.get("params", {}).get("uri") == uri)["params"]
    assert [each["code"] for each in told["diagnostics"]] == ["unknown-node"]
    place = {"textDocument": {"uri": uri}, "position": {"line": 0, "character": 14}}
    made = editor.request("textDocument/rename", **place, newName="Mission")["changes"]
    assert edits(made[uri]) == [(0, 13, 17, "Mission")]
    editor.notify("textDocument/didClose", textDocument={"uri": uri})
    told = editor.wait_for(lambda message: message.get("params", {}).get("uri") == uri)["params"]
    assert told["diagnostics"] == []


def test_files_that_change_on_the_disk(tmp_path: Path) -> None:
    watching = {"workspace": {"didChangeWatchedFiles": {"dynamicRegistration": True}}}
    editor = Editor(tmp_path, capabilities=watching)
    editor.open("main.btq", MISSION)
    assert editor.diagnostics("main.btq")[0][0] == "missing-include"
    editor.write("skills.btq", SKILLS)
    assert editor.diagnostics("main.btq") == []
    editor.write("btq.toml", '[rules]\nunknown-node = "off"\n')
    editor.change("main.btq", WRONG)
    assert editor.diagnostics("main.btq") == []
    editor.write("btq.toml", '[rules]\nunknown-node = "error"\n')
    assert [each["severity"] for each in editor.published("main.btq")["diagnostics"]] == [1]
    (tmp_path / "btq.toml").unlink()
    editor.notify("workspace/didChangeWatchedFiles", changes=[{"uri": editor.uri("btq.toml"), "type": 3}])
    assert [each["severity"] for each in editor.published("main.btq")["diagnostics"]] == [2]
    assert [asked["method"] for asked in editor.asked] == ["client/registerCapability"]
    assert editor.close() == ""


def test_a_folder_that_is_deleted_as_a_whole(tmp_path: Path) -> None:
    (tmp_path / "robot" / "missions").mkdir(parents=True)
    (tmp_path / "robot" / "missions" / "main.btq").write_text(WRONG, encoding="utf-8")
    editor = Editor(tmp_path)
    assert editor.diagnostics("robot/missions/main.btq") != []
    shutil.rmtree(tmp_path / "robot")
    for deleted in ("elsewhere", "robot/missions/notes.txt"):  # nothing that it knows: it reads nothing again
        editor.notify("workspace/didChangeWatchedFiles", changes=[{"uri": editor.uri(deleted), "type": 3}])
    assert editor.request("workspace/symbol", query="Main") != []
    editor.notify("workspace/didChangeWatchedFiles", changes=[{"uri": editor.uri("robot"), "type": 3}])
    assert editor.diagnostics("robot/missions/main.btq") == []
    assert editor.close() == ""


def test_a_diagnostic_says_where_its_rule_is_explained(editor: Editor) -> None:
    editor.open(
        "main.btq", "Root Main\n" + WRONG.replace("Dock", "Pick satisfices usability.user-interface-aesthetics")
    )
    found = {each["code"]: each for each in editor.published("main.btq")["diagnostics"]}
    page = Path(found["unknown-node"]["codeDescription"]["href"].removeprefix("file://"))
    assert page.read_text(encoding="utf-8").startswith("# unknown-node")
    assert found["old-quality-name"]["tags"] == [2]
    assert {each["source"] for each in found.values()} == {"btq"}


def test_what_is_said_beside_lines_and_columns_may_hold_signs_of_formats() -> None:
    workspace = Workspace.of({"/%d.btq": "ab\ncd\n", "/other.btq": "\n\nef\n"})
    related = (Related(Place(Span(0, 2)), "50 %"), Related(Place(Span(2, 4), "/other.btq"), "%s"))
    found = FileFindings.placed([Diagnostic("unknown-node", Span(3, 5), "%d %% of it", related, ("%(a)s",))])
    (told,) = json.loads(Converter().findings(workspace, "/%d.btq", found))
    assert (told["message"], told["range"]) == ("%d %% of it\n%(a)s", range_of((1, 0), (1, 2)))
    assert told["relatedInformation"] == [
        {"location": {"uri": "file:///%25d.btq", "range": range_of((0, 0), (0, 2))}, "message": "50 %"},
        {"location": {"uri": "file:///other.btq", "range": range_of((2, 0), (2, 2))}, "message": "%s"},
    ]


def range_of(start: tuple[int, int], end: tuple[int, int]) -> Message:
    return {"start": {"line": start[0], "character": start[1]}, "end": {"line": end[0], "character": end[1]}}


def test_folders_come_and_go(tmp_path: Path) -> None:
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "main.btq").write_text(WRONG, encoding="utf-8")
    one, two = ({"uri": (tmp_path / name).as_uri(), "name": name} for name in ("one", "two"))
    editor = Editor(tmp_path, workspaceFolders=[one])
    assert editor.diagnostics("one/main.btq") != []
    editor.notify("workspace/didChangeWorkspaceFolders", event={"added": [two], "removed": [one]})
    assert editor.diagnostics("two/main.btq") != []
    assert editor.diagnostics("one/main.btq") == []
    assert editor.close() == ""


def test_settings_change_live(tmp_path: Path) -> None:
    editor = Editor(tmp_path, initializationOptions={"rules": {"unknown-node": "error"}})
    editor.open("main.btq", WRONG)
    assert [each["severity"] for each in editor.published("main.btq")["diagnostics"]] == [1]
    editor.notify("workspace/didChangeConfiguration", settings={"btq": {"rules": {"unknown-node": "off"}}})
    assert editor.diagnostics("main.btq") == []
    editor.notify("workspace/didChangeConfiguration", settings=None)
    assert editor.close() == ""


def test_a_severity_of_the_editor_counts_before_the_projects_overrides(tmp_path: Path) -> None:
    (tmp_path / "btq.toml").write_text('[[overrides]]\ninclude = ["*"]\nignore = ["unknown-node"]\n')
    editor = Editor(tmp_path, initializationOptions={"rules": {"unknown-node": "error"}})
    editor.open("main.btq", WRONG)
    assert [each["severity"] for each in editor.published("main.btq")["diagnostics"]] == [1]
    assert editor.close() == ""


def test_settings_are_asked_for_where_the_editor_has_them(tmp_path: Path) -> None:
    (tmp_path / "main.btq").write_text(WRONG, encoding="utf-8")
    editor = Editor(tmp_path, capabilities={"workspace": {"configuration": True}})
    assert editor.diagnostics("main.btq") != []
    editor.settings = {"checkClosedFiles": False}
    editor.notify("workspace/didChangeConfiguration", settings=None)
    assert editor.diagnostics("main.btq") == []
    assert editor.close() == ""


def test_many_files_are_checked_with_progress(tmp_path: Path) -> None:
    for number in range(60):
        (tmp_path / f"main{number}.btq").write_text(WRONG, encoding="utf-8")
    editor = Editor(tmp_path, capabilities={"window": {"workDoneProgress": True}})
    begin = editor.wait_for(lambda message: message.get("method") == "$/progress")
    assert begin["params"]["value"]["kind"] == "begin"
    end = editor.wait_for(lambda message: message.get("params", {}).get("value", {}).get("kind") == "end")
    assert end["params"]["value"]["message"] == "60 files checked"
    assert editor.close() == ""


# ---- diagnostics that are pulled ----

PULLS: Message = {"textDocument": {"diagnostic": {}}, "workspace": {"diagnostics": {"refreshSupport": True}}}


def test_diagnostics_are_pulled(tmp_path: Path) -> None:
    (tmp_path / "closed.btq").write_text(WRONG, encoding="utf-8")
    editor = Editor(tmp_path, capabilities=PULLS)
    editor.open("main.btq", WRONG)
    first = editor.request("textDocument/diagnostic", **editor.document("main.btq"))
    assert (first["kind"], [each["code"] for each in first["items"]]) == ("full", ["unknown-node"])
    again = editor.request("textDocument/diagnostic", **editor.document("main.btq"), previousResultId=first["resultId"])
    assert again == {"kind": "unchanged", "resultId": first["resultId"]}
    editor.change("main.btq", RIGHT)
    last = editor.request("textDocument/diagnostic", **editor.document("main.btq"), previousResultId=first["resultId"])
    assert (last["kind"], last["items"]) == ("full", [])
    assert not [message for message in editor.kept if message["method"] == "textDocument/publishDiagnostics"]
    assert editor.close() == ""


def test_the_diagnostics_of_the_whole_workspace_are_pulled(tmp_path: Path) -> None:
    (tmp_path / "closed.btq").write_text(WRONG, encoding="utf-8")
    editor = Editor(tmp_path, capabilities=PULLS)
    editor.open("main.btq", RIGHT)
    first = editor.request("workspace/diagnostic", previousResultIds=[])["items"]
    found = {Path(each["uri"]).name: (each["version"], len(each["items"])) for each in first}
    assert found == {"main.btq": (1, 0), "closed.btq": (None, 1)}
    known = [{"uri": each["uri"], "value": each["resultId"]} for each in first]
    again = editor.request("workspace/diagnostic", previousResultIds=known)["items"]
    assert [each["kind"] for each in again] == ["unchanged", "unchanged"]
    assert editor.close() == ""


@pytest.mark.parametrize("why", ["deleted", "not wanted"])
def test_what_is_shown_of_closed_files_goes_when_they_are_deleted_or_no_longer_wanted(why: str, tmp_path: Path) -> None:
    (tmp_path / "closed.btq").write_text(WRONG, encoding="utf-8")
    editor = Editor(tmp_path, capabilities=PULLS)
    editor.open("main.btq", WRONG)
    first = editor.request("workspace/diagnostic", previousResultIds=[])["items"]
    known = [{"uri": each["uri"], "value": each["resultId"]} for each in first]
    if why == "deleted":
        (tmp_path / "closed.btq").unlink()
        editor.notify("workspace/didChangeWatchedFiles", changes=[{"uri": editor.uri("closed.btq"), "type": 3}])
    else:
        editor.notify("workspace/didChangeConfiguration", settings={"btq": {"checkClosedFiles": False}})
    again = editor.request("workspace/diagnostic", previousResultIds=known)["items"]
    gone: Message = {"uri": editor.uri("closed.btq"), "version": None, "kind": "full", "items": []}
    assert again[0] == gone
    assert [(Path(each["uri"]).name, each["kind"]) for each in again[1:]] == (
        [("main.btq", "unchanged")] if why == "deleted" else []
    )
    assert editor.close() == ""


@pytest.mark.parametrize("why", ["deleted", "not wanted"])
def test_what_is_shown_of_a_document_goes_when_it_is_closed_and_deleted_or_no_longer_wanted(
    why: str, tmp_path: Path
) -> None:
    """VS Code asks once more about a document that it closes, shows no answer, and never names the result again."""
    (tmp_path / "main.btq").write_text(WRONG, encoding="utf-8")
    editor = Editor(tmp_path, capabilities=PULLS, initializationOptions={"checkClosedFiles": why == "deleted"})
    editor.open("main.btq", WRONG)
    first = editor.request("textDocument/diagnostic", **editor.document("main.btq"))
    if why == "deleted":
        (tmp_path / "main.btq").unlink()
        editor.notify("workspace/didChangeWatchedFiles", changes=[{"uri": editor.uri("main.btq"), "type": 3}])
    last = editor.request("textDocument/diagnostic", **editor.document("main.btq"), previousResultId=first["resultId"])
    assert last["kind"] == "unchanged"
    editor.shut("main.btq")
    editor.request("textDocument/diagnostic", **editor.document("main.btq"), previousResultId=first["resultId"])
    gone: Message = {"uri": editor.uri("main.btq"), "version": None, "kind": "full", "items": []}
    assert editor.request("workspace/diagnostic", previousResultIds=[])["items"] == [gone]
    (tmp_path / "main.btq").write_text(RIGHT, encoding="utf-8")
    editor.open("main.btq", RIGHT)
    assert editor.request("textDocument/diagnostic", **editor.document("main.btq"))["items"] == []
    editor.shut("main.btq")
    items = editor.request("workspace/diagnostic", previousResultIds=[])["items"]
    assert [each["items"] for each in items] == [[]]
    assert editor.close() == ""


def test_a_large_workspace_is_pulled_in_parts_and_with_progress(tmp_path: Path) -> None:
    for number in range(60):
        (tmp_path / f"main{number:02}.btq").write_text(WRONG, encoding="utf-8")
    editor = Editor(tmp_path, capabilities={**PULLS, "window": {"workDoneProgress": True}})
    rest = editor.request("workspace/diagnostic", previousResultIds=[], partialResultToken="part")
    progress = [message["params"] for message in editor.kept if message["method"] == "$/progress"]
    shown = [each["value"] for each in progress if each["token"] != "part"]
    assert [each["kind"] for each in shown] == ["begin", "report", "report", "report", "end"]
    assert [each.get("percentage") for each in shown] == [0, 33, 66, 100, None]
    parts = [each["value"]["items"] for each in progress if each["token"] == "part"]
    assert [len(part) for part in parts] == [20, 20, 20]
    assert rest == {"items": []}
    files = [item for part in parts for item in part]
    assert {each["uri"] for each in files} == {editor.uri(f"main{number:02}.btq") for number in range(60)}
    assert {tuple(found["code"] for found in each["items"]) for each in files} == {("unknown-node",)}
    known = [{"uri": each["uri"], "value": each["resultId"]} for each in files]
    again = editor.request("workspace/diagnostic", previousResultIds=known)["items"]
    assert {each["kind"] for each in again} == {"unchanged"}
    assert editor.close() == ""


# ---- requests ----


def test_formatting(editor: Editor) -> None:
    editor.open("main.btq", "BehaviorTree Main\n  Dock\n")
    options = {"tabSize": 4, "insertSpaces": True}
    found = editor.request("textDocument/formatting", **editor.document("main.btq"), options=options)
    assert edits(found) == [(1, 2, 2, "  ")]
    whole = {"start": {"line": 0, "character": 0}, "end": {"line": 2, "character": 0}}
    ranged = editor.request("textDocument/rangeFormatting", **editor.document("main.btq"), range=whole, options=options)
    assert edits(ranged) == [(1, 2, 2, "  ")]


def test_why_a_file_is_not_formatted(editor: Editor) -> None:
    editor.open("main.btq", "BehaviorTree Main\n  Dock )\n")
    options = {"tabSize": 4, "insertSpaces": True}
    whole = {"start": {"line": 0, "character": 0}, "end": {"line": 2, "character": 0}}
    said = f"{editor.root / 'main.btq'}:2:8: cannot format a file with an error: unexpected `)`: no bracket is open"
    for method, more in (("formatting", {}), ("rangeFormatting", {"range": whole})):
        asked = {**editor.document("main.btq"), "options": options, **more}
        assert editor.request(f"textDocument/{method}", **asked) is None
        told = editor.wait_for(lambda message: message.get("method") == "window/logMessage")
        assert told["params"] == {"type": 2, "message": said}


def test_from_a_name_to_its_definition_and_back(editor: Editor) -> None:
    editor.open("skills.btq", SKILLS)
    editor.open("main.btq", MISSION)
    there = {"start": {"line": 0, "character": 7}, "end": {"line": 0, "character": 11}}
    for method in ("definition", "declaration"):
        found = editor.request(f"textDocument/{method}", **editor.at("main.btq", 2, 5))
        assert found == [{"uri": editor.uri("skills.btq"), "range": there}]
    context = {"includeDeclaration": False}
    uses = editor.request("textDocument/references", **editor.at("skills.btq", 0, 8), context=context)
    assert [(each["uri"], each["range"]["start"]["line"]) for each in uses] == [(editor.uri("main.btq"), 2)]
    shown = editor.request("textDocument/documentHighlight", **editor.at("main.btq", 2, 5))
    assert [each["kind"] for each in shown] == [2]


def test_from_a_requirement_to_its_nodes_and_its_quality(editor: Editor) -> None:
    text = 'quality soft : safety "x"\nQualityReq rq : soft "y"\nBehaviorTree Main\n    Pick satisfies rq\n'
    editor.open("main.btq", text)
    here = editor.at("main.btq", 1, 12)
    for method, line, start, end in (("implementation", 3, 4, 8), ("typeDefinition", 0, 8, 12)):
        place = {"start": {"line": line, "character": start}, "end": {"line": line, "character": end}}
        found = editor.request(f"textDocument/{method}", **here)
        assert found == [{"uri": editor.uri("main.btq"), "range": place}]


def test_an_editor_that_takes_links_gets_them(tmp_path: Path) -> None:
    editor = Editor(tmp_path, capabilities={"textDocument": {"definition": {"linkSupport": True}}})
    editor.open("main.btq", SKILLS + "BehaviorTree Main\n    Pick\n")
    (link,) = editor.request("textDocument/definition", **editor.at("main.btq", 3, 6))
    assert link["originSelectionRange"] == {"start": {"line": 3, "character": 4}, "end": {"line": 3, "character": 8}}
    assert link["targetSelectionRange"]["start"] == {"line": 0, "character": 7}
    assert editor.close() == ""


def test_rename(editor: Editor) -> None:
    editor.open("skills.btq", SKILLS)
    editor.open("main.btq", MISSION)
    ready = editor.request("textDocument/prepareRename", **editor.at("main.btq", 2, 5))
    assert ready["placeholder"] == "Pick"
    made = editor.request("textDocument/rename", **editor.at("main.btq", 2, 5), newName="Grasp")["changes"]
    assert {uri: edits(changes) for uri, changes in made.items()} == {
        editor.uri("main.btq"): [(2, 4, 8, "Grasp")],
        editor.uri("skills.btq"): [(0, 7, 11, "Grasp")],
    }
    refused = editor.ask("textDocument/rename", **editor.at("main.btq", 2, 5), newName="Retry")
    assert refused["error"] == {"code": -32803, "message": "`Retry` is a built-in node"}


def test_rename_names_versions_to_an_editor_that_compares_them(tmp_path: Path) -> None:
    editor = Editor(tmp_path, capabilities={"workspace": {"workspaceEdit": {"documentChanges": True}}})
    editor.open("main.btq", RIGHT)
    editor.change("main.btq", RIGHT)
    made = editor.request("textDocument/rename", **editor.at("main.btq", 3, 13), newName="Land")
    assert [each["textDocument"] for each in made["documentChanges"]] == [{"uri": editor.uri("main.btq"), "version": 2}]
    assert editor.close() == ""


def test_completion_is_documented_when_it_is_looked_at(tmp_path: Path) -> None:
    snippets = {"textDocument": {"completion": {"completionItem": {"snippetSupport": True}}}}
    for capabilities, text in (({}, "Pick"), (snippets, "Pick (from = ${1:{=\\}})")):
        editor = Editor(tmp_path, capabilities=capabilities)
        editor.open("main.btq", SKILLS + "BehaviorTree Main\n    P")
        found = editor.request("textDocument/completion", **editor.at("main.btq", 3, 5))
        first = found["items"][0]
        assert (first["label"], first["textEdit"]["newText"]) == ("Pick", text)
        resolved = editor.request("completionItem/resolve", **first)
        assert "`input from : string` (required)" in resolved["documentation"]["value"]
        assert editor.close() == ""


@pytest.mark.parametrize(
    ("line", "context", "labels"),
    [
        ('    Say (text = "a"', {"triggerKind": 2, "triggerCharacter": '"'}, []),
        ("    Pick", {"triggerKind": 3}, []),
        ("    Pick", {"triggerKind": 1}, ["Pick", "Pick …"]),
        ("    Pick", None, ["Pick", "Pick …"]),
    ],
)
def test_a_list_opens_over_a_complete_word_only_where_somebody_asks(
    tmp_path: Path, line: str, context: object, labels: list[str]
) -> None:
    snippets = {"textDocument": {"completion": {"completionItem": {"snippetSupport": True}}}}
    editor = Editor(tmp_path, capabilities=snippets)
    editor.open("main.btq", f"{SKILLS}BehaviorTree Main\n{line}")
    place = editor.at("main.btq", 3, len(line))
    found = editor.request("textDocument/completion", **place, **({"context": context} if context else {}))
    assert [item["label"] for item in found["items"]][:2] == labels
    assert editor.close() == ""


def test_snippets_are_for_editors_that_have_places_to_fill_in(tmp_path: Path) -> None:
    for takes, expected in (
        (True, [(15, 2, "BehaviorTree ${1:Name}\n    ${2|->,?,R->,R?|}$0")]),
        (False, []),
    ):
        editor = Editor(
            tmp_path, capabilities={"textDocument": {"completion": {"completionItem": {"snippetSupport": takes}}}}
        )
        editor.open("main.btq", "t")
        items = editor.request("textDocument/completion", **editor.at("main.btq", 0, 1))["items"]
        trees = [item for item in items if item["label"] == "tree"]
        assert [(item["kind"], item["insertTextFormat"], item["textEdit"]["newText"]) for item in trees] == expected
        assert editor.close() == ""


def test_hover_and_signature(editor: Editor) -> None:
    editor.open("main.btq", SKILLS + "BehaviorTree Main\n    Pick (")
    shown = editor.request("textDocument/hover", **editor.at("main.btq", 3, 5))
    assert shown["contents"]["kind"] == "markdown"
    assert shown["range"]["start"] == {"line": 3, "character": 4}
    help_ = editor.request("textDocument/signatureHelp", **editor.at("main.btq", 3, 10))
    assert help_["signatures"][0]["label"] == "Pick (input from : string)"
    assert editor.request("textDocument/hover", **editor.at("main.btq", 3, 2)) is None


SCATTERED = {
    "a/main.btq": (
        'include "../b/lib.btq"\ninclude "../c/trees.xml"\ninclude "gone.btq"\ninclude "../../else/out.btq"\n'
        "BehaviorTree Main\n    Drive satisfies soon satisfices gentle\n"
        "BehaviorTree Other\n    ->\n        SubTree Xml\n        SubTree Out\n"
    ),
    "b/lib.btq": 'QualityReq soon\n    takes at most 30 s\nquality gentle : safety "soft"\n',
    "c/trees.xml": (
        "<!-- Generated by btq from trees.btq; edit that file. -->\n"
        '<root BTCPP_format="4"><BehaviorTree ID="Xml"><Action ID="Go"/></BehaviorTree></root>\n'
    ),
    "../else/out.btq": "BehaviorTree Out\n    Wait\n",
}


@pytest.mark.parametrize("project", ["", "btq.toml", "a/btq.toml"])
def test_paths_are_shown_as_seen_from_the_editor_s_folder(tmp_path: Path, project: str) -> None:
    """Wherever the project file is, and wherever the server was started; what is outside the folder in full."""
    root = tmp_path / "folder"
    for name, text in {**SCATTERED, **({project: ""} if project else {})}.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)
    editor = Editor(root)
    editor.open("a/main.btq", SCATTERED["a/main.btq"])
    (missing,) = (each for each in editor.published("a/main.btq")["diagnostics"] if each["code"] == "missing-include")
    assert re.findall("`[^`]*`", missing["message"])[:2] == ["`gone.btq`", "`a`"]

    def shown(line: int, character: int) -> list[str]:
        hover = editor.request("textDocument/hover", **editor.at("a/main.btq", line, character))
        return re.findall(r"[^\s(]+\.(?:btq|xml)", hover["contents"]["value"])

    assert shown(5, 21) == ["a/main.btq"]  # where soon is attached
    assert shown(5, 38) == ["b/lib.btq"]
    assert shown(8, 17) == ["c/trees.xml", "a/main.btq"]
    assert shown(9, 17) == [f"{tmp_path}/else/out.btq", "a/main.btq"]
    refused = editor.ask("textDocument/rename", **editor.at("a/main.btq", 8, 17), newName="New")["error"]["message"]
    assert re.findall(r"\S+\.xml", refused) == ["c/trees.xml"]
    document = {"uri": editor.uri("a/main.btq")}
    page = editor.request("workspace/executeCommand", command="btq.server.overview", arguments=[document])
    assert {place.rpartition("/")[0] for place in re.findall(r'title="(\S+):\d+:\d+"', page)} == {
        *("a", "b", "c", f"{tmp_path}/else")
    }
    built = editor.ask("workspace/executeCommand", command="btq.server.build", arguments=[document])
    assert built["error"]["message"].startswith("a/main.btq:3:9: error[missing-include] ")
    assert editor.close() == ""


def test_structure(editor: Editor) -> None:
    editor.open("skills.btq", SKILLS)
    editor.open("main.btq", MISSION)
    outline = editor.request("textDocument/documentSymbol", **editor.document("main.btq"))
    assert [each["name"] for each in outline] == ["skills.btq", "Main"]
    folds = editor.request("textDocument/foldingRange", **editor.document("main.btq"))
    assert [(each["startLine"], each["endLine"]) for each in folds] == [(1, 2)]
    links = editor.request("textDocument/documentLink", **editor.document("main.btq"))
    assert [each["target"] for each in links] == [editor.uri("skills.btq")]
    (selection,) = editor.request(
        "textDocument/selectionRange", **editor.document("main.btq"), positions=[{"line": 2, "character": 5}]
    )
    assert selection["parent"]["range"]["start"] == {"line": 2, "character": 4}
    found = editor.request("workspace/symbol", query="pick")
    assert [(each["name"], each["location"]["uri"]) for each in found] == [("Pick", editor.uri("skills.btq"))]


def test_the_deepest_tree_has_an_outline(editor: Editor) -> None:
    lines = "".join(f"{'  ' * depth}Inverter\n" for depth in range(1, 256)) + "  " * 256 + "Pick\n"
    editor.open("main.btq", f"BehaviorTree Main\n{lines}")
    (symbol,) = editor.request("textDocument/documentSymbol", **editor.document("main.btq"))
    depth = 0
    while symbol["children"]:
        (symbol,) = symbol["children"]
        depth += 1
    assert depth == 256


def test_semantic_tokens(editor: Editor) -> None:
    editor.open("main.btq", RIGHT)
    full = editor.request("textDocument/semanticTokens/full", **editor.document("main.btq"))
    editor.change("main.btq", RIGHT + "        Pick\n")
    changed = editor.request(
        "textDocument/semanticTokens/full/delta", **editor.document("main.btq"), previousResultId=full["resultId"]
    )
    (edit,) = changed["edits"]
    after = full["data"][: edit["start"]] + edit["data"] + full["data"][edit["start"] + edit["deleteCount"] :]
    new = editor.request("textDocument/semanticTokens/full", **editor.document("main.btq"))
    assert new["data"] == after
    stale = editor.request(
        "textDocument/semanticTokens/full/delta", **editor.document("main.btq"), previousResultId="another"
    )
    assert stale["data"] == after
    line = {"start": {"line": 2, "character": 0}, "end": {"line": 2, "character": 99}}
    part = editor.request("textDocument/semanticTokens/range", **editor.document("main.btq"), range=line)
    assert part["data"] == [2, 8, 8, 6, 2]


def test_an_edit_ends_what_is_made_ready_in_a_pause(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("btq_lang.lsp.schedule.PAUSE", 0)
    path = str(tmp_path / "main.btq")
    steps: list[str] = []

    def making(workspace: Workspace, path: str) -> Iterator[None]:
        for _ in range(100):
            steps.append(workspace.files[path].text)
            yield

    async def type_meanwhile() -> None:
        server = Server()
        server.protocol.client_capabilities = types.ClientCapabilities()
        server.schedule.check_soon(server.session.edit(path, WRONG))
        while len(steps) < 3:
            await asyncio.sleep(0)
        server.schedule.check_soon(server.session.edit(path, RIGHT))
        while len(steps) < 103:
            await asyncio.sleep(0)
        await asyncio.sleep(0.05)
        server.schedule.check_soon(server.session.edit(path, WRONG))  # all is there already
        await asyncio.sleep(0.05)

    monkeypatch.setattr("btq_lang.ide.readiness.getting_ready", making, raising=False)
    asyncio.run(type_meanwhile())
    assert steps == [WRONG] * 3 + [RIGHT] * 100


def test_nothing_is_made_ready_while_somebody_waits(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("btq_lang.lsp.schedule.PAUSE", 0.05)
    steps: list[int] = []

    def making(*_: object) -> Iterator[None]:
        for step in range(100):
            steps.append(step)
            yield

    async def ask_meanwhile() -> None:
        server = Server()
        server.protocol.client_capabilities = types.ClientCapabilities()
        server.schedule.answering = 1
        server.schedule.check_soon(server.session.edit(str(tmp_path / "main.btq"), RIGHT))
        await asyncio.sleep(0.2)
        assert not steps
        server.schedule.answering = 0
        while not steps:
            await asyncio.sleep(0)
        server.schedule.answering = 1
        for _ in range(50):
            await asyncio.sleep(0)
        assert len(steps) < 10
        server.schedule.answering = 0
        while len(steps) < 100:
            await asyncio.sleep(0)

    monkeypatch.setattr("btq_lang.ide.readiness.getting_ready", making, raising=False)
    asyncio.run(ask_meanwhile())


@pytest.mark.parametrize("asks", [False, True])
def test_tokens_are_made_in_a_pause_for_an_editor_that_asks_for_them(
    asks: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("btq_lang.lsp.schedule.PAUSE", 0)
    path = str(tmp_path / "main.btq")
    made: list[str] = []

    async def pause() -> None:
        server = Server()
        requests = types.ClientSemanticTokensRequestOptions()
        tokens = types.SemanticTokensClientCapabilities(requests, [], [], []) if asks else None
        document = types.TextDocumentClientCapabilities(semantic_tokens=tokens)
        server.protocol.client_capabilities = types.ClientCapabilities(text_document=document)
        server.schedule.check_soon(server.session.edit(path, RIGHT))
        while "the rest" not in made:
            await asyncio.sleep(0)

    def making(what: str) -> Callable[..., Iterator[None]]:
        def make(*_: object) -> Iterator[None]:
            made.append(what)
            return iter(())

        return make

    monkeypatch.setattr("btq_lang.ide.colours.making", making("tokens"), raising=False)
    monkeypatch.setattr("btq_lang.ide.readiness.getting_ready", making("the rest"), raising=False)
    asyncio.run(pause())
    assert made == [*["tokens"] * asks, "the rest"]


def test_what_the_server_does_not_know_is_nothing(editor: Editor) -> None:
    for method in ("hover", "completion", "prepareRename"):
        assert editor.request(f"textDocument/{method}", **editor.at("nowhere.btq", 0, 0)) is None
    for method in ("documentSymbol", "foldingRange", "documentLink"):
        assert editor.request(f"textDocument/{method}", **editor.document("nowhere.btq")) == []
    report = editor.request("textDocument/diagnostic", **editor.document("nowhere.btq"))
    assert report == {"kind": "full", "items": []}


def test_code_actions(editor: Editor) -> None:
    editor.open("main.btq", WRONG)
    place = {"start": {"line": 2, "character": 9}, "end": {"line": 2, "character": 9}}
    found = editor.request(
        "textDocument/codeAction", **editor.document("main.btq"), range=place, context={"diagnostics": []}
    )
    assert [each["title"] for each in found[:2]] == [
        "Replace `Sequnce` with `Sequence`",
        "Silence `unknown-node` on this line",
    ]
    assert [each.get("isPreferred", False) for each in found[:2]] == [True, False]
    assert found[0]["diagnostics"][0]["code"] == "unknown-node"
    assert edits(found[0]["edit"]["changes"][editor.uri("main.btq")]) == [(2, 8, 15, "Sequence")]
    all_ = editor.request(
        "textDocument/codeAction",
        **editor.document("main.btq"),
        range=place,
        context={"diagnostics": [], "only": ["source.fixAll"]},
    )
    assert all_ == []


def test_an_editor_knows_the_kinds_of_code_actions_and_gets_those_that_it_asks_for(editor: Editor) -> None:
    assert editor.capabilities["codeActionProvider"]["codeActionKinds"] == [
        *("quickfix", "refactor.extract", "refactor.inline", "refactor.rewrite"),
        *("source.fixAll.btq", "source.organizeImports.btq", "btq.explore"),
    ]
    editor.open("lib.btq", "BehaviorTree Lib\n    Pick\n")
    head = 'include "lib.btq"\ninclude "lib.btq"  # twice\nsignal b : % from {b}\nRoot Main\n'
    editor.open("main.btq", f"{head}BehaviorTree Main\n    Pick satisfices speed\n")
    whole = {"start": {"line": 0, "character": 0}, "end": {"line": 5, "character": 25}}

    def asked(*only: str) -> list[tuple[str, str, list[tuple[int, int, int, str]]]]:
        context = {"diagnostics": [], "only": [*only]}
        found = editor.request("textDocument/codeAction", **editor.document("main.btq"), range=whole, context=context)
        uri = editor.uri("main.btq")
        return [(each["kind"], each["title"], edits(each["edit"]["changes"][uri])) for each in found]

    organize = ("source.organizeImports.btq", "Remove 2 duplicate or unused includes", [(0, 0, 0, ""), (1, 0, 19, "")])
    (fix_all,) = asked("source.fixAll")
    assert fix_all[:2] == ("source.fixAll.btq", "Apply 1 safe fix")
    assert asked("source.organizeImports") == [organize]
    assert asked("source") == [fix_all, organize]
    assert asked("source.fixAll.ruff") == []
    assert [each[1] for each in asked("quickfix") if each[1].startswith("Remove")] == [
        "Remove the unused signal `b`",
        "Remove the unused include `lib.btq`",
        "Remove the duplicate include `lib.btq`",
    ]


def test_renamed_files_take_their_includes_with_them(tmp_path: Path) -> None:
    (tmp_path / "skills.btq").write_text(SKILLS, encoding="utf-8")
    editor = Editor(tmp_path)
    editor.open("main.btq", MISSION)
    files = [{"oldUri": editor.uri("skills.btq"), "newUri": editor.uri("lib/hands.btq")}]
    made = editor.request("workspace/willRenameFiles", files=files)["changes"]
    assert edits(made[editor.uri("main.btq")]) == [(0, 8, 20, '"lib/hands.btq"')]
    other = [{"oldUri": editor.uri("nobody.btq"), "newUri": editor.uri("other.btq")}]
    assert editor.request("workspace/willRenameFiles", files=other) is None
    assert editor.close() == ""


def test_while_one_types(editor: Editor) -> None:
    editor.open("main.btq", "QualityReq slow(limit : m/s)\n    keeps v <= limit\nBehaviorTree Main\n\n")
    options = {"tabSize": 4, "insertSpaces": True}
    found = editor.request("textDocument/onTypeFormatting", **editor.at("main.btq", 3, 0), ch="\n", options=options)
    assert edits(found) == [(3, 0, 0, "    ")]
    linked = editor.request("textDocument/linkedEditingRange", **editor.at("main.btq", 0, 17))
    assert [each["start"] for each in linked["ranges"]] == [
        {"line": 0, "character": 16},
        {"line": 1, "character": 15},
    ]


def test_call_hierarchy(editor: Editor) -> None:
    editor.open("main.btq", "BehaviorTree Main\n    SubTree Dock\nBehaviorTree Dock\n    Pick\n")
    (dock,) = editor.request("textDocument/prepareCallHierarchy", **editor.at("main.btq", 1, 13))
    assert (dock["name"], dock["selectionRange"]["start"]) == ("Dock", {"line": 2, "character": 13})
    (incoming,) = editor.request("callHierarchy/incomingCalls", item=dock)
    assert (incoming["from"]["name"], incoming["fromRanges"][0]["start"]["line"]) == ("Main", 1)
    (outgoing,) = editor.request("callHierarchy/outgoingCalls", item=incoming["from"])
    assert outgoing["to"]["name"] == "Dock"


def test_hints_and_lenses_can_be_switched_off(editor: Editor) -> None:
    editor.open("main.btq", "BehaviorTree Main\n    Timeout (msec = 2 s)\n        Pick\n")
    whole = {"start": {"line": 0, "character": 0}, "end": {"line": 9, "character": 0}}
    (hint,) = editor.request("textDocument/inlayHint", **editor.document("main.btq"), range=whole)
    assert (hint["label"], hint["position"]) == ("= 2000", {"line": 1, "character": 23})
    (lens,) = editor.request("textDocument/codeLens", **editor.document("main.btq"))
    assert (lens["command"]["title"], lens["command"]["command"]) == ("main tree", "")
    editor.notify("workspace/didChangeConfiguration", settings={"btq": {"inlayHints": False, "codeLens": False}})
    assert editor.request("textDocument/inlayHint", **editor.document("main.btq"), range=whole) == []
    assert editor.request("textDocument/codeLens", **editor.document("main.btq")) == []


def test_a_lens_calls_the_command_of_an_editor_that_has_it(tmp_path: Path) -> None:
    editor = Editor(tmp_path, capabilities={"experimental": {"commands": ["btq.showReferences"]}})
    editor.open("main.btq", "Root Main\nBehaviorTree Main\n    SubTree Dock\nBehaviorTree Dock\n    Pick\n")
    main, lens = editor.request("textDocument/codeLens", **editor.document("main.btq"))
    assert main["command"] == {"title": "main tree", "command": ""}  # nothing to open: a plain title
    assert (lens["command"]["title"], lens["command"]["command"]) == ("1 call", "btq.showReferences")
    uri, place, uses = lens["command"]["arguments"]
    assert (uri, place) == (editor.uri("main.btq"), {"line": 3, "character": 13})
    assert uses == [{"uri": uri, "range": {"start": {"line": 2, "character": 12}, "end": {"line": 2, "character": 16}}}]
    assert editor.close() == ""


def test_a_lens_of_any_other_editor_names_or_shows_the_places(tmp_path: Path) -> None:
    once = "QualityReq rq\n    takes at most 1 s\nBehaviorTree Main\n    Pick satisfies rq\n"
    for capabilities in ({}, {"window": {"showDocument": {"support": True}}}):
        editor = Editor(tmp_path, capabilities=capabilities)
        editor.open("main.btq", once)
        lens, unused = editor.request("textDocument/codeLens", **editor.document("main.btq"))
        assert unused["command"] == {"title": "main tree", "command": ""}
        assert (lens["command"]["title"], lens["command"]["command"]) == ("1 use", "btq.server.uses")
        assert lens["command"]["command"] in editor.capabilities["executeCommandProvider"]["commands"]
        editor.request("workspace/executeCommand", **{key: lens["command"][key] for key in ("command", "arguments")})
        place = {"start": {"line": 3, "character": 19}, "end": {"line": 3, "character": 21}}
        if capabilities:
            (shown,) = editor.asked
            assert (shown["params"]["uri"], shown["params"]["selection"]) == (editor.uri("main.btq"), place)
        else:
            told = editor.wait_for(lambda message: message.get("method") == "window/showMessage")
            assert told["params"]["message"] == "main.btq:4"
        assert editor.close() == ""


def test_commands(editor: Editor) -> None:
    editor.open("main.btq", "BehaviorTree Main\n    -> First\n        Retry (num_attempts = 2)\n            Pick\n")
    place = editor.at("main.btq", 3, 13)
    path = editor.request("workspace/executeCommand", command="btq.server.nodePath", arguments=[place])
    assert path == "Main/First/Retry/Pick"
    document = editor.document("main.btq")["textDocument"]
    xml = editor.request("workspace/executeCommand", command="btq.server.xml", arguments=[document])
    assert '<Sequence name="First">' in xml
    picture = editor.request("workspace/executeCommand", command="btq.server.picture", arguments=[document])
    assert picture["nodes"] == {
        "n0": {"line": 1, "character": 4},
        "n1": {"line": 2, "character": 8},
        "n2": {"line": 3, "character": 12},
    }
    assert all(f'id="{key}"' in picture["svg"] for key in picture["nodes"])
    asked = [document, "Main/-> First"]
    folded = editor.request("workspace/executeCommand", command="btq.server.picture", arguments=asked)
    assert set(folded["nodes"]) == {"n0"}
    page = editor.request("workspace/executeCommand", command="btq.server.overview", arguments=[document])
    assert page.startswith("<!DOCTYPE html>")
    assert "Retry" in page
    neither = "neither a .btq file nor BehaviorTree.CPP's XML"
    whats = {"xml": "not a .btq file", "build": "not a .btq file"} | dict.fromkeys(
        ("picture", "overview", "import"), neither
    )
    for command, what in whats.items():
        arguments = [{"uri": editor.uri("nowhere.btq")}]
        refused = editor.ask("workspace/executeCommand", command=f"btq.server.{command}", arguments=arguments)
        assert refused["error"]["message"] == f"this is {what} of the open folders"


def test_a_build_writes_what_the_command_line_writes(tmp_path: Path) -> None:
    (tmp_path / "skills.btq").write_text(SKILLS, encoding="utf-8")
    (tmp_path / "main.btq").write_text(MISSION, encoding="utf-8")
    editor = Editor(tmp_path)
    editor.open("main.btq", MISSION.replace("shelf", "table"))  # not saved
    document = editor.document("main.btq")["textDocument"]
    done = editor.request("workspace/executeCommand", command="btq.server.build", arguments=[document])
    assert done["files"] == [editor.uri("main.xml"), editor.uri("skills.xml")]
    assert sorted(done["said"].split()) == ["main.xml", "skills.xml", "wrote", "wrote"]
    assert 'from="table"' in (tmp_path / "main.xml").read_text(encoding="utf-8")
    (tmp_path / "main.btq").write_text(MISSION.replace("shelf", "table"), encoding="utf-8")
    again = subprocess.run([sys.executable, "-m", "btq_lang", "build", "--check", str(tmp_path)], check=False)
    assert again.returncode == 0
    assert editor.close() == ""


def test_a_build_has_included_files_as_they_are_in_the_editor(tmp_path: Path) -> None:
    (tmp_path / "skills.btq").write_text(SKILLS, encoding="utf-8")
    (tmp_path / "main.btq").write_text(MISSION, encoding="utf-8")
    editor = Editor(tmp_path)
    editor.open("skills.btq", f"{SKILLS}Action Unsaved\n")
    document = editor.document("main.btq")["textDocument"]
    editor.request("workspace/executeCommand", command="btq.server.build", arguments=[document])
    assert '"Unsaved"' in (tmp_path / "skills.xml").read_text(encoding="utf-8")
    assert editor.close() == ""


def test_a_build_that_is_not_done_says_why(editor: Editor) -> None:
    editor.open("main.btq", "BehaviorTree Main\n    SubTree Dock\n")
    document = editor.document("main.btq")["textDocument"]
    refused = editor.ask("workspace/executeCommand", command="btq.server.build", arguments=[document])
    line, _, last = refused["error"]["message"].splitlines()
    assert "main.btq:2:13: error[unknown-tree] unknown tree `Dock`" in line
    assert last == "nothing was written"
    assert not (editor.root / "main.xml").exists()
    uri = "untitled:Untitled-1"
    editor.notify("textDocument/didOpen", textDocument={"uri": uri, "languageId": "btq", "version": 1, "text": RIGHT})
    refused = editor.ask("workspace/executeCommand", command="btq.server.build", arguments=[{"uri": uri}])
    assert refused["error"]["message"] == "save this document to a file first"


# ---- the way there ----


@pytest.mark.parametrize(("encoding", "column"), [("utf-8", 17), ("utf-16", 15), ("utf-32", 14)])
def test_columns_are_counted_as_agreed(tmp_path: Path, encoding: str, column: int) -> None:
    editor = Editor(tmp_path, capabilities={"general": {"positionEncodings": [encoding]}})
    assert editor.capabilities["positionEncoding"] == encoding
    editor.open("main.btq", 'BehaviorTree Main\n    Dock "🤖" (_skipif = x _while = y)\n')
    found = editor.diagnostics("main.btq")
    assert (found[0][0], found[0][2]) == ("unknown-attribute", column)
    behind = column + len("_skipif = x ")
    for character, expected in ((5, (4, 8)), (behind, (behind, behind + 6)), (behind + 6, (behind, behind + 6))):
        shown = editor.request("textDocument/hover", **editor.at("main.btq", 1, character))["range"]
        assert (shown["start"]["character"], shown["end"]["character"]) == expected
    assert editor.close() == ""


@pytest.mark.parametrize(("encoding", "robot"), [("utf-8", 4), ("utf-16", 2), ("utf-32", 1)])
def test_a_part_of_a_text_is_changed_where_the_editor_says(tmp_path: Path, encoding: str, robot: int) -> None:
    editor = Editor(tmp_path, capabilities={"general": {"positionEncodings": [encoding]}})
    assert editor.capabilities["textDocumentSync"]["change"] == 2
    editor.open("main.btq", "# \f\u2028\r# \U0001f916\r\nBehaviorTree Main\n    Pick")
    assert editor.diagnostics("main.btq") == []
    editor.change(
        "main.btq",
        part((1, 2), (1, 2 + robot), "\U0001f916\U0001f916\n"),  # each change counts in what the one before made
        part((1, 2 + robot), (2, 0), ""),
        part((2, 13), (2, 99), "Tree"),  # beyond the end of a line is its end
        part((3, 0), (9, 9), "    Sequnce\n        Dock\n"),
    )
    assert editor.diagnostics("main.btq") == [("unknown-node", 3, 4, 11)]
    outline = editor.request("textDocument/documentSymbol", **editor.document("main.btq"))
    assert [one["name"] for one in outline] == ["Tree"]
    editor.change("main.btq", "Ignored", part((0, 0), (0, 7), "BehaviorTree Anew\n    Pick"))
    assert editor.diagnostics("main.btq") == []
    outline = editor.request("textDocument/documentSymbol", **editor.document("main.btq"))
    assert [one["name"] for one in outline] == ["Anew"]
    assert editor.close() == ""


def test_lines_end_where_editors_end_them(editor: Editor) -> None:
    editor.open("main.btq", "# a\u2028b\fc\r# d\r\nBehaviorTree Main\n    Sequnce\n        Pick\n")
    assert editor.diagnostics("main.btq") == [("unknown-node", 3, 4, 11)]


def test_a_handler_that_raises_answers_an_error_and_the_server_lives(tmp_path: Path) -> None:
    program = (
        "import btq_lang.ide as features\n"
        "def broken(*_): raise ZeroDivisionError('broken')\n"
        "features.hover.hover = broken\n"
        "from btq_lang.server import main; main([])\n"
    )
    editor = Editor(tmp_path, program=program)
    editor.open("main.btq", WRONG)
    for _ in range(3):
        answer = editor.ask("textDocument/hover", **editor.at("main.btq", 0, 0))
        told = "internal error: ZeroDivisionError: broken while reading main.btq; report it in btq's issue tracker"
        assert answer["error"] == {"code": -32603, "message": told}
    unknown = editor.ask("workspace/executeCommand", command="btq.unknown", arguments=[])
    assert unknown["error"]["code"] == -32602
    assert editor.diagnostics("main.btq") != []
    assert editor.close().splitlines().count("ZeroDivisionError: broken") == 1


@pytest.mark.parametrize(("broken", "is_told"), [("findings", False), ("edit", True)])
def test_what_raises_while_somebody_types_is_logged_once(tmp_path: Path, broken: str, is_told: bool) -> None:
    """Failures outside requests: in a check, and in the handler of a change."""
    program = (
        "from btq_lang.lsp.session import Session\n"
        "def broken(*_): raise ZeroDivisionError('broken')\n"
        f"Session.{broken} = broken\n"
        "from btq_lang.server import main; main([])\n"
    )
    editor = Editor(tmp_path, program=program)
    editor.open("main.btq", WRONG)
    for _ in range(3):
        editor.change("main.btq", RIGHT)
        editor.ask("textDocument/foldingRange", **editor.document("main.btq"))
    shown = [message["params"]["message"] for message in editor.kept if message["method"] == "window/showMessage"]
    told = "internal error: ZeroDivisionError: broken while reading main.btq; report it in btq's issue tracker"
    places = 2 if is_told else 1  # it is opened, and changed
    assert shown == [told] * (places if is_told else 0)
    assert editor.close().splitlines().count("ZeroDivisionError: broken") == places


def test_a_request_that_cannot_be_read_is_answered(tmp_path: Path) -> None:
    editor = Editor(tmp_path)
    answer = editor.ask("textDocument/hover", **editor.document("main.btq"))
    assert answer["error"] == {
        "code": -32602,
        "message": "textDocument/hover cannot be read: required field missing @ $.params.position",
    }
    editor.open("main.btq", WRONG)
    assert editor.diagnostics("main.btq") != []
    assert "While structuring HoverParams" in editor.close()


def test_what_is_printed_does_not_get_into_the_protocol(tmp_path: Path) -> None:
    program = (
        "import btq_lang.ide as features\n"
        "features.hover.hover = lambda *_: print('Content-Length: 3')\n"
        "from btq_lang.server import main; main([])\n"
    )
    editor = Editor(tmp_path, program=program)
    editor.open("main.btq", WRONG)
    assert editor.request("textDocument/hover", **editor.at("main.btq", 0, 0)) is None
    assert editor.diagnostics("main.btq") != []
    assert editor.close() == "Content-Length: 3\n"


def test_an_editor_that_traces_is_told_what_the_server_does(tmp_path: Path) -> None:
    program = (
        "import btq_lang.ide as features\n"
        "def broken(*_): raise ZeroDivisionError('broken')\n"
        "features.hover.signature_help = broken\n"
        "from btq_lang.server import main; main([])\n"
    )
    editor = Editor(tmp_path, program=program, trace="messages")
    editor.open("main.btq", WRONG)
    editor.wait_for(lambda message: message.get("params", {}).get("message", "").startswith("initialized: "))
    traced = traces(editor, "textDocument/hover")
    assert re.fullmatch(r"textDocument/hover: \d+\.\d ms", traced[-1]["message"])
    assert "verbose" not in traced[-1]
    editor.notify("$/setTrace", value="verbose")
    assert "HoverParams" in traces(editor, "textDocument/hover")[-1]["verbose"]
    failed = traces(editor, "textDocument/signatureHelp")[-1]
    assert failed["message"].startswith("internal error: ZeroDivisionError: broken while reading ")
    assert "ZeroDivisionError: broken" in failed["verbose"]
    editor.notify("$/setTrace", value="off")
    assert traces(editor, "textDocument/hover") == []
    assert "ZeroDivisionError" in editor.close()


def traces(editor: Editor, method: str) -> list[Message]:
    """What is published while a request is answered."""
    editor.kept.clear()
    editor.ask(method, **editor.at("main.btq", 0, 0))
    return [message["params"] for message in editor.kept if message["method"] == "$/logTrace"]


def test_a_key_leaves_nothing_behind(tmp_path: Path) -> None:
    program = (
        "import sys; from btq_lang import server\n"
        "made = server.make_server(); server.make_server = lambda: made\n"
        "server.main([])\n"
        "print(len(made.protocol._request_futures), file=sys.stderr)\n"
    )
    editor = Editor(tmp_path, program=program)
    editor.open("main.btq", RIGHT)
    for _ in range(50):
        editor.change("main.btq", RIGHT)
    assert int(editor.close()) < 5  # what goes on while the server ends


def test_a_request_for_what_nobody_does_answers_an_error(editor: Editor) -> None:
    answer = editor.ask("textDocument/somethingNew", **editor.document("main.btq"))
    assert answer["error"]["code"] == -32601
    editor.notify("textDocument/somethingElse")
    editor.open("main.btq", RIGHT)
    assert editor.diagnostics("main.btq") == []


def test_a_cancelled_request_is_answered_as_cancelled(tmp_path: Path) -> None:
    for number in range(100):  # enough to show progress
        (tmp_path / f"main{number}.btq").write_text(WRONG, encoding="utf-8")
    editor = Editor(tmp_path, capabilities={**PULLS, "window": {"workDoneProgress": True}})
    editor.request("workspace/diagnostic", previousResultIds=[])  # from then on all files are known
    editor.send(id="slow", method="workspace/diagnostic", params={"previousResultIds": []})
    editor.notify("$/cancelRequest", id="slow")  # after it comes the response that the server waits for
    answer = editor.wait_for(lambda message: message.get("id") == "slow")
    assert answer["error"]["code"] == -32800
    assert [each["method"] for each in editor.asked].count("window/workDoneProgress/create") == 2
    assert editor.close() == ""


def test_what_is_outdated_is_not_checked() -> None:
    class Telling(Server):
        pulls = False

        def publish(self, path: str) -> None:
            told.append(path)
            if path == "first":
                self.schedule.check_soon(("edited", "linked"))  # an edit, while all is checked for the first time

    async def edit() -> None:
        server = Telling()
        server.schedule.check_soon(("first", "linked", "other", "edited"))
        for _ in range(50):  # keys that come faster than they are checked
            server.schedule.check_soon(("first", "linked"))
        assert server.schedule.task is not None
        await server.schedule.task

    told: list[str] = []
    asyncio.run(edit())
    assert told == ["first", "edited", "linked", "other"]


class Telling(Server):
    """A server that notes which files it checks, and has one open."""

    pulls = False

    def __init__(self) -> None:
        super().__init__()
        self.told: list[str] = []
        self.session.open["open"] = ""

    def publish(self, path: str) -> None:
        self.told.append(path)


def test_what_is_asked_is_answered_before_files_that_are_not_open_are_checked() -> None:
    async def ask() -> None:
        server = Telling()
        server.schedule.answering = 1
        server.schedule.check_soon(("open", "closed"))
        await asyncio.sleep(0.05)
        assert server.told == ["open"]
        server.schedule.check_soon(("open",))  # a key meanwhile does not wait
        await asyncio.sleep(0.05)
        assert server.told == ["open", "open"]
        server.schedule.answering = 0
        assert server.schedule.task is not None
        await server.schedule.task
        assert server.told == ["open", "open", "closed"]

    asyncio.run(ask())


def test_a_key_does_not_wait_for_what_an_editor_may_ask_about_the_key_before(monkeypatch: pytest.MonkeyPatch) -> None:
    async def press() -> None:
        server = Telling()
        server.schedule.check_soon(("open", "closed"))
        for keys in range(1, 4):
            while len(server.told) < keys:
                await asyncio.sleep(0)
            server.schedule.check_soon(("open",))
        while len(server.told) < 4:
            await asyncio.sleep(0)
        assert server.schedule.task is not None
        assert not server.schedule.task.done()
        assert server.told == ["open"] * 4
        server.schedule.task.cancel()

    monkeypatch.setattr("btq_lang.lsp.schedule.REQUEST_WINDOW", 2)
    asyncio.run(asyncio.wait_for(press(), 4))  # seconds; less than three keys would wait


# A server that says what it does, and for which every file takes a minute to check.
SLOW = """
import sys
from btq_lang.lsp import editor
from btq_lang.lsp import session
from btq_lang import ide as features
editor.MAX_REST = 60
check, complete = session.Session.findings, features.completion.complete
def slow(self, path):
    print(f"check of {len(self.open[path])} characters", file=sys.stderr)
    found = check(self, path)
    self.check_seconds = {path: 60}
    return found
def say(*place, **wanted):
    print("completion", file=sys.stderr)
    return complete(*place, **wanted)
session.Session.findings, features.completion.complete = slow, say
from btq_lang.server import main
main([])
"""


def test_a_completion_does_not_wait_for_the_check_of_the_key_before_it(tmp_path: Path) -> None:
    editor = Editor(tmp_path, program=SLOW)
    editor.open("main.btq", RIGHT)
    assert editor.diagnostics("main.btq") == []
    for _ in range(5):
        editor.change("main.btq", part((3, 16), (3, 16), "k"))
        assert editor.request("textDocument/completion", **editor.at("main.btq", 3, 17))["items"] != []
    said = editor.close().splitlines()
    assert said.count("completion") == 5
    assert {*said} == {"completion", f"check of {len(RIGHT)} characters"}  # of none of the keys


def is_answer_to(request: str) -> Callable[[Message], bool]:
    return lambda message: message.get("id") == request


def test_nor_does_it_where_the_editor_asks_for_diagnostics(tmp_path: Path) -> None:
    editor = Editor(tmp_path, capabilities=PULLS, program=SLOW)
    editor.open("main.btq", RIGHT)
    editor.request("textDocument/diagnostic", **editor.document("main.btq"))
    for number in range(5):
        editor.change("main.btq", part((3, 16), (3, 16), "k"))
        editor.send(id=f"slow{number}", method="textDocument/diagnostic", params=editor.document("main.btq"))
        assert editor.request("textDocument/completion", **editor.at("main.btq", 3, 17))["items"] != []
        editor.notify("$/cancelRequest", id=f"slow{number}")  # as an editor does at the next key
        answer = editor.wait_for(is_answer_to(f"slow{number}"))
        assert answer["error"]["code"] == -32800
    said = editor.close().splitlines()
    assert said.count("completion") == 5
    assert {*said} == {"completion", f"check of {len(RIGHT)} characters"}  # of none of the keys


# A server in which each step of a check takes long until a completion is asked for.
STEP_BY_STEP = """
import sys, time
from btq_lang.lsp import session
from btq_lang import ide as features
check, complete = session.Session.check, features.completion.complete
seconds = [0.2]
def stepping(self, path, is_cancelled):
    def step():
        time.sleep(seconds[0])  # else the check ends before the request comes
        return is_cancelled()
    check(self, path, step)
    print("checked", file=sys.stderr)
def say(*place, **wanted):
    print("completion", file=sys.stderr)
    seconds[0] = 0
    return complete(*place, **wanted)
session.Session.check, features.completion.complete = stepping, say
from btq_lang.server import main
main([])
"""


def test_a_request_interrupts_a_check(tmp_path: Path) -> None:
    editor = Editor(tmp_path, program=STEP_BY_STEP)
    editor.open("main.btq", RIGHT)
    sleep(0.5)  # it is being checked, for several seconds
    assert editor.request("textDocument/completion", **editor.at("main.btq", 3, 16))["items"] != []
    assert editor.diagnostics("main.btq") == []
    assert editor.close().splitlines()[:2] == ["completion", "checked"]


def test_a_key_ends_a_pause() -> None:
    async def press() -> None:
        server = Telling()
        server.schedule.check_soon(("open",))
        assert server.schedule.task is not None
        await server.schedule.task
        pause = server.schedule._pause
        assert pause is not None
        assert not pause.cancelled()
        server.schedule.check_soon(("open",))
        await server.schedule.task
        assert pause.cancelled()

    asyncio.run(press())


def test_the_server_on_a_port_of_this_machine(tmp_path: Path) -> None:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    command = (sys.executable, "-m", "btq_lang", "lsp", "--tcp", str(port), "--log", "info")
    with running(command, stderr=subprocess.PIPE) as process:
        assert process.stderr is not None
        log = next(line for line in process.stderr if "Serving on" in line)
        assert f"('127.0.0.1', {port})" in log
        with socket.create_connection(("127.0.0.1", port)) as connection, connection.makefile("rwb") as stream:
            body = json.dumps(
                {"jsonrpc": "2.0", "id": 1, "method": "initialize", "params": {"capabilities": {}, "processId": None}}
            ).encode()
            stream.write(b"Content-Length: %d\r\n\r\n%s" % (len(body), body))
            stream.flush()
            assert stream.readline().startswith(b"Content-Length:")
        process.terminate()


def test_btq_lsp_is_the_same_server(tmp_path: Path) -> None:
    editor = Editor(tmp_path, command=(sys.executable, "-m", "btq_lang", "lsp"))
    assert editor.initialized["serverInfo"]["name"] == "btq"
    assert editor.close() == ""
    assert SERVER[-1] == "--stdio"
