"""C++ sources that the project file names: an editor hears what a save of one changes, in missions and in the C++."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from lsp_editor import Editor, Message

pytest.importorskip("tree_sitter_cpp", reason="the C++ grammar is not installed: pip install -e '.[cpp]'")

DRIVE = """\
class Drive : public BT::SyncActionNode
{
  static BT::PortsList providedPorts() { return { BT::InputPort<double>("speed") }; }
  BT::NodeStatus tick() override { return go(getInput<double>("speed").value()); }
};
void add(BT::BehaviorTreeFactory& factory) { factory.registerNodeType<Drive>("Drive"); }
"""
MISSION = "BehaviorTree Main\n    Drive (speed = 1)\n"
XML = '<root BTCPP_format="4"><BehaviorTree ID="Main"><Drive speed="1"/></BehaviorTree></root>\n'
PULLS: Message = {"textDocument": {"diagnostic": {}}, "workspace": {"diagnostics": {"refreshSupport": True}}}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    robot = tmp_path / "robot"
    (robot / "src").mkdir(parents=True)
    (robot / "btq.toml").write_text('nodes = ["src/*.cpp"]\n', encoding="utf-8")
    (robot / "src" / "drive.cpp").write_text(DRIVE, encoding="utf-8")
    (robot / "main.btq").write_text(MISSION, encoding="utf-8")
    (robot / "main.xml").write_text(XML, encoding="utf-8")
    return tmp_path


@pytest.fixture
def editor(folder: Path) -> Iterator[Editor]:
    editor = Editor(folder)
    yield editor
    assert editor.close() == ""


def test_a_save_changes_what_is_found_in_open_missions_and_in_the_source(editor: Editor) -> None:
    editor.open("robot/main.btq", MISSION)
    assert editor.diagnostics("robot/main.btq") == []
    editor.open("robot/main.xml", XML)
    assert editor.diagnostics("robot/main.xml") == []
    editor.write("robot/src/drive.cpp", DRIVE.replace('InputPort<double>("speed")', 'InputPort<double>("pace")'))
    assert editor.diagnostics("robot/main.btq") == [("unknown-port", 1, 11, 16)]
    assert editor.diagnostics("robot/main.xml") == [("unknown-port", 0, 54, 59)]
    in_source = [("unused-port-in-cpp", 2, 50, 79), ("undeclared-port-in-cpp", 3, 45, 70)]
    assert editor.diagnostics("robot/src/drive.cpp") == in_source
    editor.write("robot/src/drive.cpp", DRIVE)
    assert editor.diagnostics("robot/main.btq") == []
    assert editor.diagnostics("robot/main.xml") == []
    assert editor.diagnostics("robot/src/drive.cpp") == []


def test_a_new_source_and_a_deleted_one_count(editor: Editor, folder: Path) -> None:
    editor.open("robot/main.btq", MISSION.replace("Drive (speed", "Grip (a"))
    assert editor.diagnostics("robot/main.btq") == []
    editor.write("robot/src/grip.cpp", 'void more(F& f) { f.registerSimpleAction("Grip", grip); }\n')
    assert editor.diagnostics("robot/main.btq") == [("unknown-port", 1, 10, 11)]
    (folder / "robot/src/grip.cpp").unlink()
    gone = {"uri": editor.uri("robot/src/grip.cpp"), "type": 3}
    editor.notify("workspace/didChangeWatchedFiles", changes=[gone])
    assert editor.diagnostics("robot/main.btq") == []


def test_a_tick_that_takes_longer_after_a_save_counts(editor: Editor) -> None:
    source = (
        "struct Prune : BT::ActionNodeBase { static PortsList providedPorts() { return {}; }\n"
        "  NodeStatus tick() { return NodeStatus::SUCCESS; } };\n"
        'void more(F& f) { f.registerNodeType<Prune>("Prune"); }\n'
    )
    editor.write("robot/src/prune.cpp", source)
    editor.open("robot/main.btq", "BehaviorTree M\n    R->\n        Prune\n        Prune\n")
    assert editor.diagnostics("robot/main.btq") == []
    editor.write("robot/src/prune.cpp", source.replace("SUCCESS", "RUNNING"))
    assert editor.diagnostics("robot/main.btq") == [("reactive-multiple-async", 3, 8, 13)]
    editor.write("robot/src/prune.cpp", source)
    assert editor.diagnostics("robot/main.btq") == []


def test_cpp_that_no_project_names_is_not_read(editor: Editor) -> None:
    editor.open("robot/main.btq", MISSION)
    assert editor.diagnostics("robot/main.btq") == []
    editor.write("robot/other.cpp", "not C++")
    editor.open("robot/src/drive.cpp", "an editor may send it, and what is on the disk counts")
    editor.change("robot/src/drive.cpp", "still")
    assert editor.request("textDocument/hover", **editor.at("robot/src/drive.cpp", 0, 8)) is None
    editor.shut("robot/src/drive.cpp")
    editor.change("robot/main.btq", MISSION.replace("speed", "sped"))
    assert editor.diagnostics("robot/main.btq") == [("unknown-port", 1, 11, 15)]
    assert [each for each in editor.kept if "other.cpp" in str(each)] == []


@pytest.mark.parametrize(("name", "line", "character"), [("main.btq", 1, 6), ("main.xml", 0, 50)])
def test_definition_goes_to_the_class_and_to_the_port(name: str, line: int, character: int, editor: Editor) -> None:
    editor.open(f"robot/{name}", MISSION if name == "main.btq" else XML)

    def definition(character: int) -> tuple[str, tuple[int, ...]]:
        (found,) = editor.request("textDocument/definition", **editor.at(f"robot/{name}", line, character))
        ends = [found["range"][end] for end in ("start", "end")]
        return found["uri"], tuple(end[part] for end in ends for part in ("line", "character"))

    assert definition(character) == (editor.uri("robot/src/drive.cpp"), (0, 6, 0, 11))
    assert definition(character + 8) == (editor.uri("robot/src/drive.cpp"), (2, 50, 2, 80))


def test_an_editor_that_pulls_diagnostics_of_open_files_hears_of_sources(folder: Path) -> None:
    (folder / "robot/src/drive.cpp").write_text(DRIVE.replace('<double>("speed")', '<double>("pace")', 1))
    editor = Editor(folder, capabilities=PULLS)
    in_source = [("unused-port-in-cpp", 2, 50, 79), ("undeclared-port-in-cpp", 3, 45, 70)]
    assert editor.diagnostics("robot/src/drive.cpp") == in_source
    editor.write("robot/src/drive.cpp", DRIVE)
    assert editor.diagnostics("robot/src/drive.cpp") == []
    assert editor.close() == ""
