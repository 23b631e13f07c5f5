"""The tables about bt_navigator: its libraries, and the entries that it sets."""

from __future__ import annotations

import re
from pathlib import Path
from subprocess import run

import pytest
from nav2_clone import clone
from nav2_libraries import table_file
from nav2_servers import table_file as servers_file

from btq_lang.catalog.nav2 import DISTRIBUTIONS, libraries, servers
from btq_lang.catalog.nav2.libraries import LIBRARIES
from btq_lang.catalog.nav2.navigator import ENTRIES, ERROR_CODES, PARAMETERS, outside_entries
from btq_lang.commands.explain_nav2 import models_of


@pytest.mark.parametrize(("distribution", "count"), [*zip(DISTRIBUTIONS, (49, 51, 60, 66, 76), strict=True)])
def test_how_many_libraries_are_loaded_unnamed(distribution: str, count: int) -> None:
    assert sum(distribution[0] in loaded for _, _, loaded in LIBRARIES.values()) == count


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
def test_each_node_is_in_one_library(distribution: str) -> None:
    found = [node for nodes, known, _ in LIBRARIES.values() for node in nodes if distribution[0] in known]
    assert len(found) == len({*found})
    assert {*found} >= models_of(distribution).keys()
    assert {*found} - models_of(distribution).keys() <= {"ClearCostmapAroundPose"}  # not in each that has its library


def test_error_codes_are_prefixes_since_kilted() -> None:
    assert dict(outside_entries("jazzy", ("my_code",)))["my_code"] == "inout"
    kilted = dict(outside_entries("kilted", ("mine",), {"goal": "target"}))
    assert [name for name in kilted if "mine" in name or "goal" in name or "target" in name] == [
        *("target", "goals", "mine_error_code", "mine_error_msg")
    ]


# ---- against the code ----


def test_the_libraries_are_what_the_tool_writes() -> None:
    assert Path(libraries.__file__).read_text(encoding="utf-8") == table_file(clone())


def test_the_parameters_of_other_nodes_are_what_the_tool_writes() -> None:
    assert Path(servers.__file__).read_text(encoding="utf-8") == servers_file(clone())


@pytest.mark.parametrize("branch", DISTRIBUTIONS)
def test_the_entries_are_what_the_code_sets(branch: str) -> None:
    texts = [_text(branch, path) for path in _files(branch)]
    found = {match[1] or match[2] for text in texts for match in _SET.finditer(text)} - {"name", "error_code"}
    renamed = {"goal_blackboard_id_", "goals_blackboard_id_", "path_blackboard_id_", "waypoint_statuses_blackboard_id_"}
    assert {each.removesuffix("_blackboard_id_") for each in found & renamed} | (found - renamed) == {
        name for name, of in ENTRIES.items() if branch[0] in of
    }


@pytest.mark.parametrize("branch", DISTRIBUTIONS)
def test_the_error_codes_are_those_of_the_code(branch: str) -> None:
    text = _text(branch, f"{_TREES}/bt_action_server_impl.hpp")
    found = re.search(r"error_code_\w+\s*(?:=\s*)?\{(.*?)\}", text, re.DOTALL)
    assert set(re.findall(r'"(\w+)"', found[1]) if found else ()) == {*ERROR_CODES[branch[0]]}


@pytest.mark.parametrize("branch", DISTRIBUTIONS)
def test_the_parameters_are_those_that_the_code_reads(branch: str) -> None:
    """And what all nodes of ROS 2 read, or those of Nav2 for introspection."""
    texts = [_text(branch, path) for path in _files(branch)]
    found = {match[2] if match[1] is None else f"*{match[2]}" for text in texts for match in _READ.finditer(text)}
    assert ("*search_window" in found) == (branch == "lyrical")  # without a point
    named = {name for name, parameter in PARAMETERS.items() if branch[0] in parameter.of}
    of_all_nodes = {"use_sim_time", "introspection_mode", "service_introspection_mode"}
    assert found - of_all_nodes - {"*search_window"} == named - of_all_nodes


def _files(branch: str) -> list[str]:
    command = ["git", "-C", str(clone()), "ls-tree", "-r", "--name-only", branch]
    listed = run(command, capture_output=True, check=True, text=True).stdout.splitlines()
    of_navigators = re.compile(r"nav2_(bt_navigator|core)/.*navigat(or|e_to_pose|e_through_poses)\.[ch]pp")
    return [each for each in listed if of_navigators.search(each)] + [f"{_TREES}/bt_action_server_impl.hpp"]


def _text(branch: str, path: str) -> str:
    command = ["git", "-C", str(clone()), "show", f"{branch}:{path}"]
    return run(command, capture_output=True, check=True, text=True).stdout


_TREES = "nav2_behavior_tree/include/nav2_behavior_tree"
_READ = re.compile(
    r"(?:declare_parameter(?:_if_not_declared)?|declare_or_get_parameter|get_parameter(?:_or)?)(?:<[^;()]*>)?"
    r'\(\s*(?:\w+,\s*)?(getName\(\)\s*\+\s*|default_navigator_ids\[i\]\s*\+\s*)?"([^"]+)"'
)
_SET = re.compile(r'blackboard_?->(?:template )?set(?:<[^;]*?>)?\(\s*(?:"(\w+)"|(\w+))')
