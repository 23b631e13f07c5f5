"""Nodes of a team's own libraries: CMake says of which C++ each library is made."""

from __future__ import annotations

from pathlib import Path

import pytest
from in_process import run_btq

from btq_lang.nav2.libraries import unloaded_sources

CPP = """\
#include "behaviortree_cpp/bt_factory.h"
class {0} : public BT::SyncActionNode {{
  static BT::PortsList providedPorts() {{ return {{}}; }}
  BT::NodeStatus tick() override {{ return BT::NodeStatus::SUCCESS; }}
}};
BT_REGISTER_NODES(factory) {{ factory.registerNodeType<{0}>("{0}"); }}
"""
CMAKE = """\
project(my_robot)
add_library(${PROJECT_NAME}_nodes SHARED src/say.cpp)  # src/hear.cpp is elsewhere
set(sources include/hear.hpp "${CMAKE_CURRENT_SOURCE_DIR}/src/hear.cpp")
add_library(hearing SHARED ${sources})
"""
SAY = "error[unloaded-node] bt_navigator does not load the library of `Say`: add `my_robot_nodes`"
HEAR = "error[unloaded-node] bt_navigator does not load the library of `Hear`: add `hearing`"
LOST = "error[unloaded-node] no library that bt_navigator loads has a node `Lost`"


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    pytest.importorskip("tree_sitter_cpp", reason="the C++ grammar is not installed: pip install -e '.[cpp]'")
    (tmp_path / "src").mkdir()
    for name in ("Say", "Hear"):
        (tmp_path / "src" / f"{name.lower()}.cpp").write_text(CPP.format(name))
    (tmp_path / "package.xml").write_text("<package><name>my_robot</name></package>\n")
    settings = 'nodes = ["nav2-jazzy", "src/*.cpp"]\n\n[[factory]]\nname = "r"\nnav2 = "p.yaml"\nload = ["t.xml"]\n'
    (tmp_path / "btq.toml").write_text(settings)
    nodes = "<Say/><Hear/><Spin/>"
    xml = f'<root BTCPP_format="4"><BehaviorTree ID="M"><Sequence>{nodes}<Lost/></Sequence></BehaviorTree></root>\n'
    (tmp_path / "t.xml").write_text(xml)
    return tmp_path


def unloaded(robot: Path, cmake: str, *libraries: str) -> list[str]:
    (robot / "CMakeLists.txt").write_text(cmake)
    named = f"bt_navigator:\n  ros__parameters:\n    plugin_lib_names: [{', '.join(libraries)}]\n"
    (robot / "p.yaml").write_text(named)
    _, out, _ = run_btq("check", "--output-format", "concise", cwd=robot)
    return [line.partition(": ")[2] for line in out.splitlines() if "unloaded-node" in line]


def test_a_library_that_is_missing_beside_others(robot: Path) -> None:
    assert unloaded(robot, CMAKE, "my_robot_nodes") == [HEAR, LOST]
    assert unloaded(robot, CMAKE, "hearing") == [SAY, LOST]
    assert unloaded(robot, CMAKE, "hearing", "my_robot_nodes") == [LOST]
    assert unloaded(robot, CMAKE) == [SAY, HEAR, LOST]


def test_a_library_of_which_not_all_is_known(robot: Path) -> None:
    assert unloaded(robot, CMAKE, "my_robot_nodes", "of_another_package") == [HEAR]
    more = f"{CMAKE}target_sources(my_robot_nodes PRIVATE ${{OTHERS}})\n"
    assert unloaded(robot, more, "my_robot_nodes") == [HEAR]
    assert unloaded(robot, "", "my_robot_nodes") == []


@pytest.mark.parametrize("pattern", ["GLOB sources src/*.cpp", "GLOB_RECURSE sources *.cpp"])
def test_sources_by_a_pattern(robot: Path, pattern: str) -> None:
    cmake = f"file({pattern})\nadd_library(all_nodes ${{sources}})\n"
    assert unloaded(robot, cmake, "all_nodes") == [LOST]


def test_what_no_program_loads(robot: Path) -> None:
    cmake = "add_library(core STATIC src/say.cpp src/hear.cpp)\nadd_library(nodes SHARED src/main.cpp)\n"
    assert unloaded(robot, cmake, "nodes") == []


def test_a_node_in_place_of_one_of_nav2_counts_where_its_library_is_loaded(robot: Path) -> None:
    port = 'return {BT::InputPort<int>("times")};'
    spin = (
        CPP.format("Spin").replace("return {};", port).replace("{ return BT", '{ getInput("times", times_); return BT')
    )
    (robot / "src/say.cpp").write_text(spin)
    xml = (robot / "t.xml").read_text()
    (robot / "t.xml").write_text(xml.replace("<Say/><Hear/><Spin/>", '<Spin spin_dist="1"/>\n<Spin times="1"/>'))

    def unknown(*libraries: str) -> list[str]:
        unloaded(robot, CMAKE, *libraries)
        _, out, _ = run_btq("check", "--output-format", "concise", cwd=robot)
        return [line for line in out.splitlines() if "unknown-port" in line]

    times = "t.xml:2:7: error[unknown-port] `Spin` has no port `times`"
    assert unknown() == unknown("hearing") == [times]
    assert unknown("my_robot_nodes") == []
    (robot / "btq.toml").write_text('nodes = ["nav2-jazzy", "src/*.cpp"]\n')
    assert unknown() == []  # which program loads the tree is unknown
    (robot / "t.xml").write_text(xml.replace("<Spin/>", '<Spin spin_dst="1"/>'))
    assert unknown() == ["t.xml:1:74: error[unknown-port] `Spin` has no port `spin_dst`; did you mean `spin_dist`?"]


def test_sources_of_libraries_that_are_not_loaded(robot: Path) -> None:
    (robot / "CMakeLists.txt").write_text(CMAKE + "add_library(${name} src/hear.cpp)\n")
    say, hear, other = (f"{robot}/src/{name}.cpp" for name in ("say", "hear", "other"))
    assert unloaded_sources([say, hear, other], ["hearing"]) == {say}
    assert unloaded_sources([say, hear, other], ["my_robot_nodes"]) == frozenset()
