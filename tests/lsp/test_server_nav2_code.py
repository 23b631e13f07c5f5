"""Definition of Nav2's nodes in a checkout of Nav2: one that the project names, and one beside its package."""

from __future__ import annotations

import subprocess
import tarfile
from io import BytesIO
from pathlib import Path

import pytest
from lsp_editor import Editor
from nav2_clone import clone

XML = """\
<root BTCPP_format="4">
  <BehaviorTree ID="Main"><ComputePathToPose goal="{goal}" path="{path}" planner_id="a"/></BehaviorTree>
</root>
"""
CLASS = (
    "navigation2/nav2_behavior_tree/include/nav2_behavior_tree/plugins/action/compute_path_to_pose_action.hpp",
    "class ComputePathToPoseAction : public BtActionNode<nav2_msgs::action::ComputePathToPose>",
)
PORT = (CLASS[0], 'BT::InputPort<std::string>("planner_id", "",')


@pytest.fixture
def source(tmp_path: Path) -> Path:
    """The folder `src` of a colcon workspace, with a checkout of Nav2 and a package."""
    git = ["git", "-C", str(clone()), "archive", "lyrical", "--", "nav2_behavior_tree"]
    with tarfile.open(fileobj=BytesIO(subprocess.run(git, capture_output=True, check=True).stdout)) as archive:
        archive.extractall(tmp_path / "src/navigation2", filter="data")
    robot = tmp_path / "src/my_robot"
    robot.mkdir()
    (robot / "package.xml").write_text("<package><name>my_robot</name></package>\n")
    (robot / "main.xml").write_text(XML)
    return tmp_path / "src"


OWN = '"../navigation2/nav2_behavior_tree/**/*.cpp", "../navigation2/nav2_behavior_tree/**/*.hpp"'


@pytest.mark.parametrize("nodes", ['"nav2-lyrical"', f'"nav2-lyrical", {OWN}', OWN, '"nav2-kilted"'])
def test_definition_is_in_the_checkout(source: Path, nodes: str) -> None:
    (source / "my_robot/btq.toml").write_text(f"nodes = [{nodes}]\n")
    assert definitions(source) == [CLASS, PORT]


def test_without_a_checkout_it_is_in_the_table(source: Path) -> None:
    (source / "my_robot/btq.toml").write_text('nodes = ["nav2-lyrical"]\n')
    (source / "navigation2/nav2_behavior_tree/package.xml").unlink()
    assert [path.rpartition("/")[2] for path, _ in definitions(source)] == ["lyrical.btq"] * 2


def definitions(source: Path) -> list[tuple[str, str]]:
    """Where the definitions of a node and of a port are: the file, and what is there."""
    editor = Editor(source / "my_robot")
    editor.open("main.xml", XML)
    found = []
    for word in ("ComputePathToPose", "planner_id"):
        at = editor.at("main.xml", 1, XML.splitlines()[1].index(word))
        (place,) = editor.request("textDocument/definition", **at)
        path, start = place["uri"].removeprefix("file://"), place["range"]["start"]
        lines = Path(path).read_text().splitlines()[start["line"] :]
        shown = lines[0][start["character"] :] + lines[1].strip() if word == "planner_id" else lines[0]
        found.append((path.removeprefix(f"{source}/"), shown))
    assert editor.close() == ""
    return found
