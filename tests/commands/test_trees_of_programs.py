"""Trees that C++ of the project creates by their names, and those in the place of which it registers others."""

from __future__ import annotations

from pathlib import Path

import pytest
from in_process import run_btq

CPP = """\
#include "behaviortree_cpp/bt_factory.h"
class Say : public BT::SyncActionNode {
 public:
  using SyncActionNode::SyncActionNode;
  static BT::PortsList providedPorts() { return {}; }
  BT::NodeStatus tick() override { return BT::NodeStatus::FAILURE; }
};
int main() {
  BT::BehaviorTreeFactory factory;
  factory.registerNodeType<Say>("Say");
  auto tree = factory.createTree("Patrol");
}
"""


def found(folder: Path, xml: str, settings: str = 'nodes = ["*.cpp"]\n', cpp: str = CPP) -> list[str]:
    pytest.importorskip("tree_sitter_cpp", reason="the C++ grammar is not installed: pip install -e '.[cpp]'")
    (folder / "btq.toml").write_text(settings)
    (folder / "robot.cpp").write_text(cpp)
    (folder / "t.xml").write_text(f'<root BTCPP_format="4"{xml}</root>\n')
    _, out, _ = run_btq("check", "--output-format", "concise", "t.xml", cwd=folder)
    return out.splitlines()[:-1]


TREES = '>\n<BehaviorTree ID="Patrol"><Say/></BehaviorTree>\n<BehaviorTree ID="Dock"><Say/></BehaviorTree>\n'
AMBIGUOUS = "ambiguous main tree: no other tree refers to `Patrol` or `Dock`"


@pytest.mark.parametrize("settings", ['nodes = ["*.cpp"]\n', ""], ids=["named", "unnamed"])
@pytest.mark.parametrize(
    ("create", "severity"),
    [
        ('factory.createTree("Patrol")', ""),
        ('factory.createTree(name, blackboard); } void f(std::string name = "Patrol") {', ""),
        ('factory.createTree(name_); declare_parameter<std::string>("tree", "Patrol")', ""),
        ('factory.createTree("Charge")', "warning"),
        ('factory.createTree(is_late ? "Dock" : "Patrol")', "hint"),
    ],
)
def test_a_main_tree_that_a_program_names(tmp_path: Path, settings: str, create: str, severity: str) -> None:
    program = CPP.replace('factory.createTree("Patrol")', create)
    expected = [f"t.xml:2:19: {severity}[unknown-main-tree] {AMBIGUOUS}"] if severity else []
    assert found(tmp_path, TREES, settings, program) == expected


def test_a_name_in_a_program_that_creates_no_tree_by_name(tmp_path: Path) -> None:
    program = CPP.replace('factory.createTree("Patrol")', 'print("Patrol")')
    assert found(tmp_path, TREES, "", program) == [f"t.xml:2:19: warning[unknown-main-tree] {AMBIGUOUS}"]


def test_a_main_tree_that_another_file_of_the_package_names(tmp_path: Path) -> None:
    """The folder that is checked has only the trees."""
    (tmp_path / "package.xml").write_text("<package/>\n")
    (tmp_path / "src").mkdir()
    (tmp_path / "src" / "robot.cpp").write_text(CPP)
    (tmp_path / "trees").mkdir()
    (tmp_path / "trees" / "t.xml").write_text(f'<root BTCPP_format="4"{TREES}</root>\n')
    assert run_btq("check", "trees", cwd=tmp_path)[:2] == (0, "No problems found in 1 file\n")


@pytest.mark.parametrize(
    ("name", "body", "is_filled_in"),
    [
        ("__BringUp__", "<AlwaysSuccess/>", True),
        ("__BringUp__", '<Action ID="AlwaysSuccess" name="later"/>', True),
        ("Patrol", "<AlwaysSuccess/>", True),  # a string in the C++
        ("BringUp", "<AlwaysSuccess/>", False),
        ("__BringUp__", "<Sequence><AlwaysSuccess/></Sequence>", True),
        ("__BringUp__", '<Script code="n := 1"/>', False),
    ],
)
def test_a_tree_that_a_program_fills_in(tmp_path: Path, name: str, body: str, is_filled_in: bool) -> None:
    xml = f""" main_tree_to_execute="Main">
<BehaviorTree ID="Main"><Fallback><SubTree ID="{name}"/><Say/></Fallback></BehaviorTree>
<BehaviorTree ID="{name}">{body}</BehaviorTree>
"""
    rules = [line.partition("[")[2].partition("]")[0] for line in found(tmp_path, xml)]
    assert rules == ([] if is_filled_in else ["unreachable-child"])


@pytest.mark.parametrize(
    ("direction", "name", "body", "messages"),
    [
        ("input", "Watch", "<Say/>", ["nothing in `Watch` reads `event`, which SubTrees give it"]),
        ("output", "Watch", "<Say/>", ["nothing in `Watch` writes `event`, for which SubTrees name an entry"]),
        ("output", "__Watch__", "<Sequence><AlwaysSuccess/></Sequence>", []),
        ("output", "__Watch__", "<AlwaysFailure/>", []),  # the program puts nodes into it
    ],
)
def test_a_port_that_nothing_in_its_tree_names(
    tmp_path: Path, direction: str, name: str, body: str, messages: list[str]
) -> None:
    xml = f""" main_tree_to_execute="Main">
<BehaviorTree ID="Main"><SubTree ID="{name}" event="{{event}}"/></BehaviorTree>
<BehaviorTree ID="{name}">{body}</BehaviorTree>
<TreeNodesModel><SubTree ID="{name}"><{direction}_port name="event"/></SubTree></TreeNodesModel>
"""
    lines = [line for line in found(tmp_path, xml) if "unread-argument" in line]
    assert [line.partition("] ")[2] for line in lines] == messages
