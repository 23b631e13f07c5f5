"""Parameter files of Nav2 in `btq check`: in a factory of the project file, by an option, and among the paths."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from shutil import rmtree

import pytest
from in_process import run_btq
from nav2_robot import make_robot

from btq_lang.nav2 import yaml_reader
from btq_lang.nav2.parameters import read_parameters

PARAMETERS = """\
bt_navigator:
  ros__parameters:
    default_nav_to_pose_bt_xml: $(find-pkg-share my_robot)/trees/main.xml
    plugin_lib_names: [nav2_spin_action_bt_node]
    goal_blackboard_id: target
"""
MAIN = """\
<root BTCPP_format="4" main_tree_to_execute="Main">
  <BehaviorTree ID="Main">
    <Sequence>
      <ComputePathToPose goal="{target}" path="{path}"/>
      <FollowPath path="{path}"/>
      <DockRobot dock_pose="{targt}"/>
      <SubTree ID="Dock" _autoremap="true"/>
    </Sequence>
  </BehaviorTree>
</root>
"""
TWICE = (
    "nav2_params.yaml:4:24: error[library-loaded-twice] Nav2 loads `nav2_spin_action_bt_node` by itself in Jazzy, "
    "so nodes are registered twice"
)
UNLOADED = (
    "nav2_params.yaml:4:5: error[unloaded-node] bt_navigator does not load the library of `DockRobot`: add "
    "`opennav_dock_action_bt_node`"
)
TREE = "trees/main.xml:7:20: error[unknown-tree] unknown tree `Dock`; no file of its factory defines it"
MISSPELT = (
    "trees/main.xml:6:30: warning[misspelt-entry] nothing writes `targt`, which is read here; did you mean `target`?"
)
UNSET = (
    "trees/main.xml:4:33: warning[unset-entry] nothing writes `target` before it is read here, and bt_navigator does "
    "not set it"
)
JAZZY = 'nodes = ["nav2-jazzy"]\n'
FACTORY = '[[factory]]\nname = "navigation"\nnav2 = "nav2_params.yaml"\n'


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    make_robot(tmp_path)
    for folder in ("same", "several"):
        rmtree(tmp_path / folder)
    (tmp_path / "trees/main.xml").write_text(MAIN)
    (tmp_path / "nav2_params.yaml").write_text(PARAMETERS)
    (tmp_path / "btq.toml").write_text(JAZZY + FACTORY)
    return tmp_path


def check(folder: Path, *arguments: str) -> list[str]:
    _, out, err = run_btq("check", "--output-format", "concise", *arguments, cwd=folder)
    return [line for line in (*out.splitlines()[:-1], *err.splitlines()) if "navigate.xml" not in line]


def test_a_factory_of_the_project(robot: Path) -> None:
    """`Dock` is in the folder, but Jazzy reads one file only; `target` is set by bt_navigator."""
    assert check(robot) == [UNLOADED, TWICE, MISSPELT, TREE]
    assert check(robot, "nav2_params.yaml") == [UNLOADED, TWICE]
    assert check(robot, "trees/main.xml") == [MISSPELT, TREE]
    (robot / "btq.toml").write_text(JAZZY)
    assert check(robot) == []  # in the folder's XML the tree is found, and `target` is set by nothing that is known


def test_an_option(robot: Path) -> None:
    (robot / "btq.toml").write_text(JAZZY)
    assert check(robot, "--nav2-params", "nav2_params.yaml") == [UNLOADED, TWICE, MISSPELT, TREE]
    assert check(robot, "trees/dock.xml", "--nav2-params", "nav2_params.yaml") == [UNLOADED, TWICE]
    assert check(robot, "nav2_params.yaml") == [UNLOADED, TWICE]
    (robot / "trees/main.xml").unlink()
    assert check(robot, "nav2_params.yaml") != []  # no tree need be there


def test_a_target(robot: Path) -> None:
    """What Jazzy finds as well is not of the target; `DockRobot` is loaded in neither."""
    parameters = PARAMETERS.replace("goal_blackboard_id: target", "error_code_names: [spin_error_code]")
    (robot / "nav2_params.yaml").write_text(parameters)
    (robot / "trees/main.xml").write_text(MAIN.replace("{target}", "{goal}"))
    refused = (
        "nav2_params.yaml:5:5: error[target-breaks] bt_navigator refuses to start with `error_code_names` in Lyrical"
    )
    to_lyrical = ("--target", "nav2-lyrical")
    assert check(robot, "nav2_params.yaml", *to_lyrical) == [UNLOADED, TWICE, refused]
    assert refused in check(robot, *to_lyrical)
    (robot / "btq.toml").write_text(JAZZY)
    assert check(robot, "nav2_params.yaml", *to_lyrical) == [UNLOADED, TWICE, refused]
    found = check(robot, "nav2_params.yaml", "--target", "nav2-jazzy")
    assert [each for each in found if "[target-" in each] == []
    why = "the version of the engine changes no parameter of Nav2; name a distribution, such as nav2-lyrical"
    assert check(robot, "nav2_params.yaml", "--target", "4.10") == [f"btq check: --target 4.10: {why}"]
    assert UNLOADED in check(robot, "trees", "nav2_params.yaml", "--target", "4.10")  # there are trees, too
    assert check(robot, "nav2_params.yaml", *to_lyrical, "--ignore", "target-breaks") == [UNLOADED, TWICE]


def test_an_error_code_that_was_never_collected_does_not_change(robot: Path) -> None:
    nodes = '<Spin error_code_id="{spin_code}"/><Wait error_code_id="{wait_code}"/>'
    tree = f'<root BTCPP_format="4"><BehaviorTree ID="Main"><Sequence>{nodes}</Sequence></BehaviorTree></root>\n'
    (robot / "trees/main.xml").write_text(tree)
    (robot / "nav2_params.yaml").write_text(
        PARAMETERS.replace("goal_blackboard_id: target", "error_code_names: [spin_code]")
    )
    found = check(robot, "trees/main.xml", "--target", "nav2-kilted")
    assert [each for each in found if "[target-" in each] == [
        "trees/main.xml:1:79: warning[target-differs] from Kilted on `Spin` writes its error where nobody collects it: "
        "results have only entries that end in `_error_code`"
    ]


def test_a_target_of_parameters_that_tell_their_distribution(robot: Path) -> None:
    (robot / "btq.toml").unlink()
    names = "[nav2_spin_action_bt_node, nav2_is_path_valid_condition_bt_node]"
    (robot / "nav2_params.yaml").write_text(
        PARAMETERS.replace("[nav2_spin_action_bt_node]", names) + "bt_navigator_navigate_to_pose_rclcpp_node:\n"
        "  ros__parameters: {use_sim_time: true}\n"
    )
    found = [each for each in check(robot, "nav2_params.yaml", "--target", "nav2-lyrical") if "[target-" in each]
    assert found == [
        TWICE.replace("library-loaded-twice", "target-breaks").replace("Jazzy", "Lyrical"),
        "nav2_params.yaml:4:50: error[target-breaks] Nav2 has no library `nav2_is_path_valid_condition_bt_node` in "
        "Lyrical",
        "nav2_params.yaml:5:5: warning[target-differs] Nav2 does not read `goal_blackboard_id` in Lyrical",
    ]
    (robot / "nav2_params.yaml").write_text("bt_navigator:\n  ros__parameters: {}\n")
    (problem,) = check(robot, "nav2_params.yaml", "--target", "nav2-lyrical")
    assert problem.startswith("btq check: --target needs to know what the trees are for: ")


def test_error_codes_that_are_collected_are_those_of_the_parameters(robot: Path) -> None:
    nodes = "".join(f'<Spin error_code_id="{{{each}_error_code}}"/>' for each in ("spin", "my"))
    tree = f'<root BTCPP_format="4"><BehaviorTree ID="Main"><Sequence>{nodes}</Sequence></BehaviorTree></root>\n'
    (robot / "trees/main.xml").write_text(tree)
    (robot / "btq.toml").write_text(JAZZY.replace("jazzy", "kilted") + FACTORY)
    message = "nothing reads `{}_error_code`, and the result of a goal does not have it"

    def uncollected(more: str) -> list[str]:
        (robot / "nav2_params.yaml").write_text(PARAMETERS + more)
        found = check(robot, "trees/main.xml", "--select", "error-code-not-collected")
        return [line.partition("] ")[2] for line in found]

    assert uncollected("") == [message.format("my")]
    assert uncollected("    error_code_name_prefixes: [my]\n") == [message.format("spin")]
    assert uncollected("    error_code_name_prefixes: [my, spin]\n") == []


def test_lyrical_reads_the_folder(robot: Path) -> None:
    parameters = PARAMETERS.replace("    goal_blackboard_id: target\n", "").replace("nav2_spin", "opennav_dock")
    folder = "    bt_search_directories: [$(find-pkg-share my_robot)/trees]\n"
    (robot / "nav2_params.yaml").write_text(parameters + folder)
    (robot / "btq.toml").write_text(FACTORY)  # the parameters tell that this is Lyrical
    assert check(robot) == [UNSET]
    (robot / "trees/dock.xml").unlink()
    assert check(robot) == [TREE]


def test_trees_that_goals_name(robot: Path) -> None:
    (robot / "btq.toml").write_text(f'{JAZZY}{FACTORY}load = ["trees/dock.xml"]\n')
    parameters = PARAMETERS.replace("main.xml", "navigate.xml").replace("[nav2_spin_action_bt_node]", "[]")
    (robot / "nav2_params.yaml").write_text(parameters)
    assert check(robot, "nav2_params.yaml") == [UNLOADED]


def test_what_holds_for_other_files_holds_for_these(robot: Path) -> None:
    assert check(robot, "--select", "unloaded-node") == [UNLOADED]
    assert check(robot, "--ignore", "unloaded-node,unknown-tree") == [TWICE, MISSPELT]
    assert check(robot, "--severity", "error") == [UNLOADED, TWICE, TREE]
    more = (
        '[[overrides]]\ninclude = ["*.yaml"]\nignore = ["unloaded-node"]\nrules = { library-loaded-twice = "hint" }\n'
    )
    (robot / "btq.toml").write_text(JAZZY + FACTORY + more)
    assert check(robot, "nav2_params.yaml") == [TWICE.replace("error", "hint")]
    (robot / "btq.toml").write_text(f'exclude = ["*.yaml"]\n{JAZZY}{FACTORY}')
    assert check(robot) == [MISSPELT, TREE]


def test_a_baseline(robot: Path) -> None:
    assert check(robot, "--baseline", "known.json", "--update-baseline") == ["known.json: 4 added, 0 removed, 0 kept"]
    assert check(robot, "--baseline", "known.json") == []
    assert check(robot, "nav2_params.yaml", "--baseline", "known.json") == []
    toml = robot / "btq.toml"
    toml.write_text(f'baseline = "its.json"\n{toml.read_text()}')
    assert check(robot, "nav2_params.yaml", "--update-baseline") == ["its.json: 2 added, 0 removed, 0 kept"]
    (robot / "nav2_params.yaml").write_text(PARAMETERS.replace("spin", "wait"))  # another line is another finding
    assert check(robot, "--baseline", "known.json") == [UNLOADED, TWICE.replace("spin", "wait")]


def test_since(robot: Path) -> None:
    def git(*words: str) -> None:
        identity = ("-c", "user.name=a", "-c", "user.email=a@b")
        subprocess.run(["git", "-C", str(robot), *identity, *words], check=True, capture_output=True)

    git("init")
    git("add", ".")
    git("commit", "-m", "first")
    assert check(robot, "--since", "HEAD") == []
    (robot / "trees/main.xml").write_text(f"{MAIN}\n")
    assert check(robot, "--since", "HEAD") == [UNLOADED, TWICE, MISSPELT, TREE]
    git("commit", "-am", "second")
    (robot / "trees/dock.xml").write_text('<root BTCPP_format="4"/>\n')
    assert check(robot, "--since", "HEAD") == []
    (robot / "nav2_params.yaml").write_text(f"{PARAMETERS}# more\n")
    assert check(robot, "--since", "HEAD") == [UNLOADED, TWICE, MISSPELT, TREE]
    assert check(robot, "nav2_params.yaml", "--since", "nowhere") == [
        "btq check: --since: git does not know the revision `nowhere`"
    ]


@pytest.mark.parametrize("form", ["full", "concise", "json", "sarif", "github", "gitlab", "junit"])
def test_every_format_has_them(robot: Path, form: str) -> None:
    code, out, _ = run_btq("check", "--output-format", form, cwd=robot)
    assert code == 1
    assert "unloaded-node" in out
    assert "nav2_params.yaml" in out
    if form == "json":
        found = next(each for each in json.loads(out)["diagnostics"] if each["rule"] == "unloaded-node")
        places = [(each["path"], *each["range"]["start"].values()) for each in (found, *found["related"])]
        assert places == [("nav2_params.yaml", 4, 5), ("trees/main.xml", 6, 8)]


def test_bad_yaml(robot: Path) -> None:
    (robot / "nav2_params.yaml").write_text("bt_navigator:\n  ros__parameters: [\n    a: b: c\n")
    message = "expected ',' or ']', but got ':'"
    assert check(robot, "nav2_params.yaml") == [f"nav2_params.yaml:3:9: error[yaml-syntax] {message}"]
    assert check(robot, "nav2_params.yaml", "--ignore", "yaml-syntax") != []  # nothing silences what cannot be read
    (robot / "nav2_params.yaml").write_bytes(b"bt_navigator: {ros__parameters: {a: \xff}}\n")
    assert "btq: nav2_params.yaml:1:37: this is not UTF-8: byte 0xff" in check(robot, "nav2_params.yaml")


def test_no_file(robot: Path) -> None:
    (robot / "nav2_params.yaml").unlink()
    code, _, err = run_btq("check", cwd=robot)
    assert (code, err) == (2, "btq: btq.toml: `nav2_params.yaml` cannot be read: No such file or directory\n")
    code, _, err = run_btq("check", "--nav2-params", "other.yml", "trees/dock.xml", cwd=robot / "..")
    assert code == 2


def test_without_the_extra(robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def missing() -> None:
        raise yaml_reader.YamlMissing

    monkeypatch.setattr(yaml_reader, "_yaml", missing)
    read_parameters.cache_clear()
    code, _, err = run_btq("check", cwd=robot)
    message = "needs PyYAML to be read: pip install 'btq-lang[nav2]'"
    assert (code, err) == (2, f"btq: btq.toml: `nav2_params.yaml` {message}\n")
    (robot / "btq.toml").unlink()
    code, _, err = run_btq("check", "--nav2-params", "nav2_params.yaml", cwd=robot)
    assert (code, err) == (2, f"btq: nav2_params.yaml: {message}\n")


def test_a_built_tree_stands_for_its_mission(robot: Path) -> None:
    (robot / "trees/main.xml").unlink()
    (robot / "trees/main.btq").write_text("BehaviorTree Main\n    DockRobot (dock_pose = {targt})\n")
    run_btq("build", "trees/main.btq", cwd=robot)
    assert check(robot, "trees/main.btq") == [MISSPELT.replace("trees/main.xml:6:30", "trees/main.btq:2:29")]
    assert check(robot, "nav2_params.yaml") == [UNLOADED, TWICE]


def test_a_diff_with_a_revision_uses_its_parameters(robot: Path) -> None:
    """What a tree is called in another file is known on both sides, so nothing else has changed."""
    (robot / "nav2_params.yaml").write_text(
        "bt_navigator:\n  ros__parameters:\n    default_nav_to_pose_bt_xml: $(find-pkg-share my_robot)/trees/main.xml\n"
    )
    (robot / "trees/main.btq").write_text('include "dock.btq"\nBehaviorTree Main\n    SubTree Dock\n')
    (robot / "trees/dock.btq").write_text("BehaviorTree Dock\n    DockRobot\n")
    run_btq("build", "--force", "trees/main.btq", cwd=robot)
    for words in (("init",), ("add", "."), ("-c", "user.name=a", "-c", "user.email=a@b", "commit", "-m", "first")):
        subprocess.run(["git", "-C", str(robot), *words], check=True, capture_output=True)
    assert run_btq("diff", "--git", "HEAD", "trees/main.btq", cwd=robot)[:2] == (0, "")
    (robot / "trees/dock.btq").write_text("BehaviorTree Dock\n    UndockRobot\n")
    code, out, _ = run_btq("diff", "--git", "HEAD", "trees/dock.btq", cwd=robot)
    assert (code, "UndockRobot" in out) == (1, True)


def test_what_bt_navigator_does_not_set_is_said_of_its_trees_alone(tmp_path: Path) -> None:
    delay = '<Delay delay_msec="{lost}"><Spin spin_dist="1"/></Delay>'
    xml = f'<root BTCPP_format="4">\n<BehaviorTree ID="M">\n{delay}\n</BehaviorTree>\n</root>\n'
    (tmp_path / "t.xml").write_text(xml)
    (tmp_path / "p.yaml").write_text("bt_navigator:\n  ros__parameters:\n    bt_loop_duration: 10\n")
    (tmp_path / "own.btq").write_text("Action Own\n")
    nodes = 'nodes = ["nav2-jazzy"]\n'
    factory = '[[factory]]\nname = "r"\nload = ["t.xml"]\nmain = "M"\n'
    navigator = '[[factory]]\nname = "r"\nnav2 = "p.yaml"\nload = ["t.xml"]\n'
    place = "t.xml:3:21: "
    hint = f"{place}hint[unset-entry] nothing here writes `lost` before it is read"
    certain = (
        f"{place}warning[unset-entry] nothing writes `lost` before it is read here, and bt_navigator does not set it"
    )
    for project, expected in (
        (nodes, certain),
        (f"{nodes}{navigator}", certain),
        (f"{nodes}{factory}", hint),
        (f'{nodes}[[factory]]\nname = "s"\nload = ["own.btq"]\n', hint),
        (f'{factory}nodes = ["nav2-jazzy", "own.btq"]\n', hint),
    ):
        (tmp_path / "btq.toml").write_text(project)
        _, out, _ = run_btq("check", "--output-format", "concise", "t.xml", cwd=tmp_path)
        assert [line for line in out.splitlines() if "unset-entry" in line] == [expected], project
