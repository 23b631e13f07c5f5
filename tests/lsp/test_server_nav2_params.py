"""A parameter file of Nav2 in an editor: trees as it loads them, and what is wrong with it."""

from __future__ import annotations

from pathlib import Path

import pytest
from lsp_editor import Editor, Message
from nav2_robot import make_robot

PULLS: Message = {"textDocument": {"diagnostic": {}}, "workspace": {"diagnostics": {"refreshSupport": True}}}
MAIN = 'include "trees/dock.xml"\nBehaviorTree Main\n    SubTree Dock\n'
TREE = '<root BTCPP_format="4"><BehaviorTree ID="Main"><SubTree ID="Dock"/></BehaviorTree></root>\n'


def parameters(*libraries: str) -> str:
    named = "    plugin_lib_names: [" + ", ".join(libraries) + "]\n"
    tree = "    default_nav_to_pose_bt_xml: $(find-pkg-share my_robot)/trees/dock.xml\n"
    return f"bt_navigator:\n  ros__parameters:\n{tree}{named}"


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    make_robot(tmp_path)
    (tmp_path / "nav2_params.yaml").write_text(parameters())
    project = 'nodes = ["nav2-jazzy"]\n[[factory]]\nname = "navigation"\nnav2 = "nav2_params.yaml"\n'
    (tmp_path / "btq.toml").write_text(project)
    (tmp_path / "main.btq").write_text(MAIN)
    return tmp_path


def said(published: Message) -> list[tuple[int, str]]:
    return [(each["range"]["start"]["line"], each["code"]) for each in published["diagnostics"]]


def test_findings_come_and_go_with_the_file(robot: Path) -> None:
    editor = Editor(robot)
    (found,) = editor.published("nav2_params.yaml")["diagnostics"]
    assert (found["code"], found["range"]["start"]) == ("unloaded-node", {"line": 3, "character": 4})
    (related,) = found["relatedInformation"]
    assert related["location"]["uri"] == editor.uri("trees/dock.xml")
    assert related["location"]["range"]["start"] == {"line": 1, "character": 27}
    editor.write("nav2_params.yaml", parameters("opennav_dock_action_bt_node"))
    assert said(editor.published("nav2_params.yaml")) == []
    editor.write("nav2_params.yaml", parameters("opennav_dock_action_bt_node", "a: b: c"))
    assert said(editor.published("nav2_params.yaml")) == [(3, "yaml-syntax")]
    editor.write("btq.toml", "")
    assert said(editor.published("nav2_params.yaml")) == []
    assert editor.close() == ""


def test_what_is_typed_counts(robot: Path) -> None:
    editor = Editor(robot)
    assert said(editor.published("nav2_params.yaml")) == [(3, "unloaded-node")]
    editor.open("nav2_params.yaml", parameters("nav2_spin_action_bt_node"))
    assert said(editor.published("nav2_params.yaml")) == [(3, "unloaded-node"), (3, "library-loaded-twice")]
    editor.shut("nav2_params.yaml")
    assert said(editor.published("nav2_params.yaml")) == [(3, "unloaded-node")]
    assert editor.close() == ""


def test_a_tree_is_looked_at_as_the_parameters_load_it(robot: Path) -> None:
    (robot / "trees/main.xml").write_text(TREE)
    (robot / "main.btq").unlink()
    editor = Editor(robot)
    editor.open("trees/main.xml", TREE)
    assert said(editor.published("trees/main.xml")) == []  # in the folder
    editor.write("nav2_params.yaml", parameters("opennav_dock_action_bt_node").replace("dock.xml", "main.xml"))
    assert said(editor.published("trees/main.xml")) == [(0, "unknown-tree")]
    assert editor.close() == ""


def test_an_editor_that_pulls_gets_them_too(robot: Path) -> None:
    editor = Editor(robot, capabilities=PULLS)
    assert said(editor.published("nav2_params.yaml")) == [(3, "unloaded-node")]
    assert editor.close() == ""
