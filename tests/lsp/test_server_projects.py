"""What is wrong with a project file, as an editor hears of it: in that file, open or not, and no longer when mended."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from lsp_editor import Editor, Message, part

MISSION = "BehaviorTree Main\n    Pick\n"
PULLS: Message = {"textDocument": {"diagnostic": {}}, "workspace": {"diagnostics": {"refreshSupport": True}}}
MISTAKES = [
    ("engin = 1\n", (0, 0, 5), "unknown key `engin`; did you mean `engine`?"),
    ('engine = "4.10\n', (0, 14, 14), "Illegal character '\\n'"),
    (
        "engine = 4.10\n",
        (0, 0, 6),
        '`engine` must be a string such as "4.10", or a list of them: TOML reads 4.10 as 4.1',
    ),
    (
        'engine = "4.11"\n',
        (0, 9, 15),
        "unknown engine version `4.11`; did you mean `4.10`? btq supports 3.8 and 4.6 to 4.10",
    ),
    ("engine = []\n", (0, 0, 6), "`engine` must name at least one version; btq supports 3.8 and 4.6 to 4.10"),
    ('engine = "5.0"\n', (0, 9, 14), "unknown engine version `5.0`; btq supports 3.8 and 4.6 to 4.10"),
    ('[rules]\nunknwn-node = "off"\n', (1, 0, 11), "unknown rule `unknwn-node`; did you mean `unknown-node`?"),
    ("ignore = [\n  'unknwn-node']\n", (1, 2, 15), "unknown rule `unknwn-node`; did you mean `unknown-node`?"),
    (
        '[rules]\nunknown-node = "warn"\n',
        (1, 0, 12),
        '`rules.unknown-node` must be one of "error", "warning", "info", "hint", "off"',
    ),
    (
        '[rules]\nunknown-node = "errors"\n',
        (1, 0, 12),
        '`rules.unknown-node` must be one of "error", "warning", "info", "hint", "off"; did you mean `error`?',
    ),
    (
        'qualities = "iso25010-2024"\n',
        (0, 0, 9),
        '`qualities` must be "iso25010-2023" or "iso25010-2011"; did you mean `iso25010-2023`?',
    ),
]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "robot").mkdir()
    (tmp_path / "robot" / "main.btq").write_text(MISSION, encoding="utf-8")
    return tmp_path


@pytest.fixture
def editor(folder: Path) -> Iterator[Editor]:
    editor = Editor(folder)
    yield editor
    assert editor.close() == ""


def said(diagnostics: list[Message]) -> list[tuple[tuple[int, int, int], str]]:
    """Line, first and last column, and the message of each, which is an error of btq on one line."""
    found = []
    for each in diagnostics:
        start, end = each["range"]["start"], each["range"]["end"]
        assert (each["severity"], each["source"], end["line"]) == (1, "btq", start["line"])
        found.append(((start["line"], start["character"], end["character"]), each["message"]))
    return found


@pytest.mark.parametrize(("text", "place", "message"), MISTAKES)
def test_a_mistake_is_told_in_its_place(
    text: str, place: tuple[int, int, int], message: str, folder: Path, editor: Editor
) -> None:
    editor.write("robot/btq.toml", text)
    assert said(editor.published("robot/btq.toml")["diagnostics"]) == [(place, message)]
    checked = subprocess.run(
        (sys.executable, "-m", "btq_lang", "check", "robot"), cwd=folder, capture_output=True, text=True, check=False
    )
    assert checked.returncode == 2
    assert f"robot/btq.toml:{place[0] + 1}:" in checked.stderr
    assert message in checked.stderr


def test_it_is_told_from_the_start_and_goes_when_it_is_mended_or_deleted(folder: Path) -> None:
    (folder / "robot" / "btq.toml").write_text("engin = 1\n", encoding="utf-8")
    editor = Editor(folder)
    assert len(editor.published("robot/btq.toml")["diagnostics"]) == 1
    editor.write("robot/btq.toml", 'engine = "4.8"\n')
    assert editor.published("robot/btq.toml") == {"uri": editor.uri("robot/btq.toml"), "diagnostics": []}
    editor.write("robot/btq.toml", "engin = 1\n")
    assert len(editor.published("robot/btq.toml")["diagnostics"]) == 1
    (folder / "robot" / "btq.toml").unlink()
    editor.notify("workspace/didChangeWatchedFiles", changes=[{"uri": editor.uri("robot/btq.toml"), "type": 3}])
    assert editor.published("robot/btq.toml")["diagnostics"] == []
    assert editor.close() == ""


@pytest.mark.parametrize(("encoding", "column"), [("utf-8", 32), ("utf-16", 30), ("utf-32", 29)])
def test_its_columns_are_counted_as_agreed(encoding: str, column: int, folder: Path) -> None:
    editor = Editor(folder, capabilities={"general": {"positionEncodings": [encoding]}})
    editor.write("robot/btq.toml", 'rules = { unused-tree = "🤖", zebra = "off" }\n')
    found = said(editor.published("robot/btq.toml")["diagnostics"])
    assert [place for place, _ in found] == [(0, 10, 21), (0, column, column + 5)]
    assert editor.close() == ""


def test_of_pyproject_the_table_of_btq_is_looked_at(editor: Editor) -> None:
    editor.write("robot/pyproject.toml", '[tool.other]\nengin = 1\n[tool.btq]\nengine = "4.8"\nengin = 1\n')
    found = said(editor.published("robot/pyproject.toml")["diagnostics"])
    assert found == [((4, 0, 5), "unknown key `engin`; did you mean `engine`?")]
    editor.write("robot/pyproject.toml", "[tool.btq]\n[tool.other]\nengin =\n")  # none of it is readable
    assert said(editor.published("robot/pyproject.toml")["diagnostics"]) == [((2, 7, 7), "Invalid value")]
    editor.write("robot/pyproject.toml", "[tool.other]\nengin = 1\n")
    assert editor.published("robot/pyproject.toml")["diagnostics"] == []


def test_a_folder_with_its_name_is_told(folder: Path) -> None:
    (folder / "robot" / "btq.toml").mkdir()
    editor = Editor(folder)
    found = said(editor.published("robot/btq.toml")["diagnostics"])
    assert found == [((0, 0, 0), "cannot be read: Is a directory")]
    (folder / "robot" / "btq.toml").rmdir()
    editor.notify("workspace/didChangeWatchedFiles", changes=[{"uri": editor.uri("robot/btq.toml"), "type": 3}])
    assert editor.published("robot/btq.toml")["diagnostics"] == []
    assert editor.close() == ""


def test_what_is_typed_counts_before_it_is_saved(editor: Editor) -> None:
    unknown = "BehaviorTree Main\n    Sequnce\n        Pick\n"
    editor.open("robot/main.btq", unknown)
    assert [each["severity"] for each in editor.published("robot/main.btq")["diagnostics"]] == [2]
    editor.open("robot/btq.toml", '[rules]\nunknown-node = "eror"\n')
    ((place, message),) = said(editor.published("robot/btq.toml")["diagnostics"])
    assert (place, message.partition("; ")[2]) == ((1, 0, 12), "did you mean `error`?")
    editor.change("robot/btq.toml", part((1, 18), (1, 18), "r"))
    of_project, of_mission = editor.published_for("robot/btq.toml", "robot/main.btq")
    assert of_project["diagnostics"] == []
    assert [each["severity"] for each in of_mission["diagnostics"]] == [1]
    editor.change("robot/btq.toml", part((0, 0), (0, 0), "x = 1\n"))
    told = editor.published("robot/btq.toml")
    assert (said(told["diagnostics"]), told["version"]) == ([((0, 0, 1), "unknown key `x`")], 3)
    editor.shut("robot/btq.toml")  # without saving: there is no such file
    of_project, of_mission = editor.published_for("robot/btq.toml", "robot/main.btq")
    assert of_project["diagnostics"] == []
    assert [each["severity"] for each in of_mission["diagnostics"]] == [2]


def test_a_project_file_is_no_mission(editor: Editor) -> None:
    editor.open("robot/btq.toml", 'engine = "4.8"\n')
    assert editor.published("robot/btq.toml")["diagnostics"] == []
    assert editor.request("textDocument/documentSymbol", **editor.document("robot/btq.toml")) == []
    assert editor.request("textDocument/hover", **editor.at("robot/btq.toml", 0, 2)) is None
    assert editor.request("textDocument/completion", **editor.at("robot/btq.toml", 0, 2)) is None
    assert [each["name"] for each in editor.request("workspace/symbol", query="")] == ["Main"]


def test_the_diagnostics_of_a_project_file_are_pulled(folder: Path) -> None:
    def pulled() -> dict[str, int]:
        """How many diagnostics are reported for each file, by its name; without unchanged reports."""
        known = [{"uri": uri, "value": result} for uri, result in results.items()]
        items = editor.request("workspace/diagnostic", previousResultIds=known)["items"]
        results.update({each["uri"]: each["resultId"] for each in items if "resultId" in each})
        return {Path(each["uri"]).name: len(each["items"]) for each in items if each["kind"] == "full"}

    (folder / "robot" / "btq.toml").write_text("engin = 1\n", encoding="utf-8")
    results: dict[str, str] = {}
    editor = Editor(folder, capabilities=PULLS)
    assert pulled() == {"btq.toml": 1, "main.btq": 0}
    editor.open("robot/btq.toml", "engin = 1\nexclud = []\n")
    report = editor.request("textDocument/diagnostic", **editor.document("robot/btq.toml"))
    assert [message for _, message in said(report["items"])] == [
        "unknown key `engin`; did you mean `engine`?",
        "unknown key `exclud`; did you mean `exclude`?",
    ]
    assert pulled() == {"btq.toml": 2}
    editor.shut("robot/btq.toml")
    assert pulled() == {"btq.toml": 1}
    editor.write("robot/btq.toml", "exclude = []\n")
    assert pulled() == {"btq.toml": 0}
    assert editor.close() == ""


def test_an_editor_that_asks_only_about_what_is_open_is_told_of_project_files(folder: Path) -> None:
    (folder / "robot" / "btq.toml").write_text("engin = 1\n", encoding="utf-8")
    editor = Editor(folder, capabilities=PULLS)
    assert len(editor.published("robot/btq.toml")["diagnostics"]) == 1
    editor.open("robot/btq.toml", "engin = 1\n")  # from now on it asks
    assert editor.published("robot/btq.toml")["diagnostics"] == []
    editor.shut("robot/btq.toml")
    assert len(editor.published("robot/btq.toml")["diagnostics"]) == 1
    assert len(editor.request("workspace/diagnostic", previousResultIds=[])["items"]) == 2
    assert editor.published("robot/btq.toml")["diagnostics"] == []  # what is published twice would be shown twice
    editor.write("robot/btq.toml", "engines = 1\n")
    editor.request("workspace/diagnostic", previousResultIds=[])
    assert [one for one in editor.kept if one["method"] == "textDocument/publishDiagnostics"] == []
    assert editor.close() == ""


def test_a_project_file_is_not_told_of_where_only_open_files_are_wanted(folder: Path) -> None:
    (folder / "robot" / "btq.toml").write_text("engin = 1\n", encoding="utf-8")
    editor = Editor(folder, initializationOptions={"checkClosedFiles": False})
    editor.open("robot/main.btq", MISSION)
    assert editor.published("robot/main.btq")["diagnostics"] == []
    editor.open("robot/btq.toml", "engin = 1\n")
    assert len(editor.published("robot/btq.toml")["diagnostics"]) == 1
    editor.shut("robot/btq.toml")
    assert editor.published("robot/btq.toml")["diagnostics"] == []
    assert editor.close() == ""


def test_names_of_simulated_skills_are_told(folder: Path) -> None:
    editor = Editor(folder)
    editor.write("robot/btq.toml", '[simulate.skills]\nDock = { takes = "6 s" }\n"A/Dck" = { takes = "6 s" }\n')
    assert said(editor.published("robot/btq.toml")["diagnostics"]) == [
        ((1, 0, 4), "unknown node `Dock`"),
        ((2, 0, 7), "no node matches `A/Dck`"),
    ]
    assert editor.close() == ""
