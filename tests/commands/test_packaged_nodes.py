"""`nodes = ["nav2-jazzy"]` in the project file: Nav2's nodes are declared in all files of the project."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from in_process import run_btq

from btq_lang.catalog.nav2 import PACKAGED
from btq_lang.ide.completion import complete
from btq_lang.ide.hover import hover
from btq_lang.ide.navigation import find_references, goto_definition
from btq_lang.ide.rename import RenameRefusal, prepare_rename
from btq_lang.projects.opening import open_workspace
from btq_lang.workspace.config import parse_project

MISSION = """\
BehaviorTree Main
    ->
        ComputePathToPose (goal = {goal} path = {path} planer_id = GridBased)
        FollowPath (controller_id = Fast)
        GoalReached (goal = {path})
        Own (a = 1)
"""
XML = '<root BTCPP_format="4"><BehaviorTree ID="Main"><FollowPath path="{path}" speed="3"/></BehaviorTree></root>\n'
FOUND = [
    "m.btq:3:56: error[unknown-port] `ComputePathToPose` has no port `planer_id`; did you mean `planner_id`?",
    "m.btq:4:9: warning[missing-port] `FollowPath` requires a value for its port `path`",
    "m.btq:5:29: error[entry-with-two-types] `path` of `ComputePathToPose` creates `{path}` as nav_msgs::msg::Path, "
    "but `goal` of `GoalReached` has the type geometry_msgs::msg::PoseStamped",
    "m.btq:6:9: hint[unknown-node] unknown node `Own`",
]


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    (tmp_path / "btq.toml").write_text('nodes = ["nav2-jazzy"]\n')
    (tmp_path / "m.btq").write_text(MISSION)
    return tmp_path


def check(folder: Path, *paths: str) -> list[str]:
    _, out, err = run_btq("check", "--output-format", "concise", *paths, cwd=folder)
    return [*out.splitlines()[:-1], *err.splitlines()]


def test_checks_know_the_nodes(robot: Path) -> None:
    assert check(robot) == FOUND
    (robot / "m.xml").write_text(XML)
    assert check(robot, "m.xml") == ["m.xml:1:74: error[unknown-port] `FollowPath` has no port `speed`"]


def test_without_the_key_nothing_is_known_of_them(robot: Path) -> None:
    (robot / "btq.toml").write_text("")
    assert [line for line in check(robot) if "unknown-port" in line or "missing-port" in line] == []


def test_another_distribution_has_other_nodes(robot: Path) -> None:
    (robot / "m.btq").write_text(
        "BehaviorTree Main\n    SmoothPath (unsmoothed_path = {goal} error_code_id = {smoother_error_code})\n"
    )
    found = {}
    for name in PACKAGED:
        (robot / "btq.toml").write_text(f'nodes = ["{name}"]\n')
        found[name] = check(robot)
    message = "m.btq:2:42: error[unknown-port] `SmoothPath` has no port `error_code_id`"
    assert found == {name: [message] if name == "nav2-humble" else [] for name in PACKAGED}


def test_a_factory_names_them_too_beside_files(robot: Path) -> None:
    (robot / "btq.toml").write_text('[[factory]]\nname = "nav"\nload = ["m.btq"]\nnodes = ["nav2-jazzy", "own.btq"]\n')
    (robot / "own.btq").write_text("Action Own\n    input a : int\n")
    assert check(robot, "m.btq") == FOUND[:-1]


def test_a_model_of_the_project_counts_first(robot: Path) -> None:
    (robot / "m.btq").write_text("Action FollowPath\n    input speed\nBehaviorTree Main\n    FollowPath (speed = 3)\n")
    duplicate = "m.btq:1:8: warning[duplicate-definition] duplicate definition of the node model `FollowPath`"
    assert check(robot) == [duplicate]
    _, out, _ = run_btq("check", cwd=robot)
    assert "= note: Nav2 registers a node `FollowPath`, and a program can register only one" in out


def test_a_shorter_model_of_the_same_node_hides_nothing(robot: Path) -> None:
    """Groot's has no types and lacks ports; what Nav2's says of the node counts, types and defaults too."""
    short = '<TreeNodesModel><Action ID="Wait"><input_port name="wait_duration"/></Action></TreeNodesModel>'
    use = '<Wait wait_duration="soon" server_name="a" wait="1"/>'
    (robot / "m.btq").unlink()
    (robot / "m.xml").write_text(f'<root BTCPP_format="4"><BehaviorTree ID="M">{use}</BehaviorTree>{short}</root>\n')
    number = "m.xml:1:66: error[invalid-literal] expected a number for `wait_duration`, found `soon`"
    unknown = "m.xml:1:88: error[unknown-port] `Wait` has no port `wait`"
    assert check(robot, "m.xml") == [number, unknown]
    loads = '[[factory]]\nname = "m"\nload = ["m.xml"]\nnodes = ["nav2-jazzy"]\n'
    (robot / "btq.toml").write_text(loads)
    assert check(robot, "m.xml") == [number, unknown]
    typed = short.replace("/></Action>", ' type="bool"/></Action>')
    (robot / "m.xml").write_text((robot / "m.xml").read_text().replace(short, typed))
    duplicate = "duplicate definition of the node model `Wait`"
    assert check(robot, "m.xml") == [
        number.replace("a number", "true, false, 1 or 0"),
        unknown,
        f"m.xml:1:141: warning[duplicate-definition] {duplicate}",
    ]


def test_editors_show_them(robot: Path) -> None:
    workspace, path = open_workspace(str(robot)), f"{robot}/m.btq"
    at = MISSION.index("FollowPath") + 1
    shown = hover(workspace, path, at)
    assert shown is not None
    assert "Drives along a path." in shown.markdown
    assert "- `input path : nav_msgs::msg::Path` (required): the path" in shown.markdown
    assert [target.path for target in goto_definition(workspace, path, at)] == [PACKAGED["nav2-jazzy"]]
    proposed = [each.label for each in complete(workspace, path, MISSION.index("controller_id = Fast")).proposals]
    assert "goal_checker_id" in proposed
    assert prepare_rename(workspace, path, at) == RenameRefusal("cannot rename `FollowPath`: Nav2 defines it")
    of_port = prepare_rename(workspace, path, MISSION.index("controller_id"))
    assert of_port == RenameRefusal("cannot rename `controller_id`: Nav2 defines it")
    references = find_references(workspace, path, at, include_definition=False)
    assert [(each, span.start) for each, span in references] == [(path, at - 1)]


def test_a_build_writes_no_models_of_them(robot: Path) -> None:
    (robot / "m.btq").write_text("BehaviorTree Main\n    FollowPath (path = {path})\n")
    assert run_btq("build", cwd=robot) == (0, "wrote m.xml\n", "")
    assert re.findall(r"<(\w+)", (robot / "m.xml").read_text()) == ["root", "BehaviorTree", "FollowPath"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('nodes = ["nav2-humbel"]', "1:10: unknown nodes `nav2-humbel`; did you mean `nav2-humble`?"),
        ('engine = "4.6"\nnodes = ["nav2-iron", "models.btq"]', "2:23: unknown nodes `models.btq`"),
        ("nodes = 3", "1:1: `nodes` must be a list of strings"),
        (
            '[[factory]]\nname = "a"\nnodes = ["x.xml", "nav2-jazy"]',
            "3:19: unknown nodes `nav2-jazy`; did you mean `nav2-jazzy`?",
        ),
    ],
)
def test_unknown_names_are_reported_at_their_place(text: str, message: str) -> None:
    (problem,) = parse_project(text)[1]
    assert problem.position is not None
    assert f"{problem.position.line + 1}:{problem.position.column + 1}: {problem.message}" == message


def test_what_a_node_does_is_explained_and_shown(robot: Path) -> None:
    text = "BehaviorTree Main\n    RateController\n        FollowPath (path = {path})\n"
    (robot / "m.btq").write_text(text)
    shown = hover(open_workspace(str(robot)), f"{robot}/m.btq", text.index("Rate"))
    semantics = "when 1/hz seconds have passed since its last success; otherwise it returns RUNNING."
    assert shown is not None
    assert semantics in shown.markdown
    _, out, _ = run_btq("explain", "RateController", cwd=robot)
    assert semantics in " ".join(out.split())
