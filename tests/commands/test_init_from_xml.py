"""`btq init --from-xml`: a project file for what lies there."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from in_process import run_btq

Write = Callable[..., None]

HEAD = """\
# What holds for all missions of this project
engine = ["4.6", "4.8", "4.10"]  # the versions of BehaviorTree.CPP that must load them
"""


@pytest.fixture
def write(tmp_path: Path) -> Write:
    def write(name: str, *trees: str) -> None:
        """A file with trees, each `Name`, or `Name: OTHER` if it runs another."""
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        text = ""
        for tree in trees:
            own, _, other = tree.partition(": ")
            text += f'<BehaviorTree ID="{own}">' + (f'<SubTree ID="{other}"/>' if other else "<AlwaysSuccess/>")
            text += "</BehaviorTree>\n"
        (tmp_path / name).write_text(f'<root BTCPP_format="4">\n{text}</root>\n')

    return write


def test_files_that_need_each_other_are_a_factory(tmp_path: Path, write: Write) -> None:
    write("trees/main.xml", "Main: Dock", "Patrol")
    write("trees/dock.xml", "Dock: Align")
    write("lib/align.xml", "Align")
    write("lib/alone.xml", "Alone")
    (tmp_path / "models.xml").write_text('<root><TreeNodesModel><Action ID="Go"/></TreeNodesModel></root>')
    (tmp_path / "package.xml").write_text("<package/>")
    code, out, err = run_btq("init", "--from-xml", cwd=tmp_path)
    assert (code, out, err) == (0, "Wrote btq.toml with 1 factory. Next: btq check .\n", "")
    table = '[[factory]]\nname = "{}"\nload = {}\nmain = ["Main", "Patrol"]\nnodes = ["models.xml"]\n'
    loaded = '["lib/align.xml", "trees/*.xml"]'
    assert (tmp_path / "btq.toml").read_text() == f"{HEAD}\n{table.format(tmp_path.name, loaded)}"
    assert run_btq("check", cwd=tmp_path)[:2] == (0, "No problems found in 5 files\n")
    assert (
        run_btq("init", "--from-xml", cwd=tmp_path)[2] == "btq init: btq.toml is there already; nothing was written\n"
    )


def test_what_defines_a_tree_twice_is_no_factory(tmp_path: Path, write: Write) -> None:
    write("a.xml", "Main: Dock")
    write("b.xml", "Main: Dock")
    write("dock.xml", "Dock")
    code, out, err = run_btq("init", "--from-xml", cwd=tmp_path)
    assert (code, out) == (0, "Wrote btq.toml with no factories. Next: btq check .\n")
    assert err == "not a factory, because several define the tree `Main`: a.xml, b.xml, dock.xml\n"
    assert (tmp_path / "btq.toml").read_text() == HEAD
    assert run_btq("check", cwd=tmp_path)[0] == 0


def test_what_runs_a_tree_that_several_others_define_is_no_factory(tmp_path: Path, write: Write) -> None:
    """Whether the program loads `one` or `two` is not known, so that the factory would lack `Wait`."""
    write("arm/main.xml", "Main: Pick")
    write("arm/pick.xml", "Pick: Wait")
    write("one/wait.xml", "Wait")
    write("two/wait.xml", "Wait")
    code, out, err = run_btq("init", "--from-xml", cwd=tmp_path)
    assert (code, out) == (0, "Wrote btq.toml with no factories. Next: btq check .\n")
    why = "arm/pick.xml runs the tree `Wait`, which one/wait.xml and two/wait.xml define"
    assert err == f"not a factory, because {why}: arm/main.xml, arm/pick.xml\n"
    assert run_btq("check", cwd=tmp_path)[:2] == (0, "No problems found in 4 files\n")


@pytest.mark.parametrize("package", ["moveit_pro_behavior", "moveit_studio_agent", "moveit_studio_behavior_interface"])
def test_the_packages_of_moveit_pro_name_the_engine(tmp_path: Path, package: str) -> None:
    """It provides trees, and its engine takes names that others refuse."""
    tree = '<BehaviorTree ID="Pick: fast"><SubTree ID="Move to Waypoint"/></BehaviorTree>'
    (tmp_path / "main.xml").write_text(f'<root BTCPP_format="4">{tree}</root>\n')
    (tmp_path / "package.xml").write_text(f"<package><exec_depend>{package}</exec_depend></package>\n")
    assert run_btq("check", "--output-format", "concise", cwd=tmp_path)[0] == 1
    run_btq("init", "--from-xml", cwd=tmp_path)
    engine = f'engine = "moveit-pro"  # the packages depend on {package}\n'
    assert (tmp_path / "btq.toml").read_text() == HEAD.splitlines(keepends=True)[0] + engine
    assert run_btq("check", cwd=tmp_path)[:2] == (0, "No problems found in 1 file\n")


@pytest.mark.parametrize("package", ["moveit_ros_planning", "<!-- moveit_pro_behavior -->"])
def test_other_packages_of_moveit_are_not_moveit_pro(tmp_path: Path, write: Write, package: str) -> None:
    write("main.xml", "Main")
    (tmp_path / "package.xml").write_text(f"<package><exec_depend>{package}</exec_depend></package>\n")
    run_btq("init", "--from-xml", cwd=tmp_path)
    assert (tmp_path / "btq.toml").read_text() == HEAD


def test_a_project_of_groot_says_what_belongs_together(tmp_path: Path, write: Write) -> None:
    write("a.xml", "A")
    write("b.xml", "B")
    (tmp_path / "robot.btproj").write_text('<root><include path="a.xml"/><include path="b.xml"/></root>')
    assert run_btq("init", "--from-xml", cwd=tmp_path)[0] == 0
    table = 'load = ["*.xml"]\nmain = ["A", "B"]\nnodes = ["robot.btproj"]\n'
    assert (tmp_path / "btq.toml").read_text().endswith(table)


def test_xml_is_converted_and_what_changes_is_said(tmp_path: Path, write: Write) -> None:
    write("main.xml", "Main: Dock")
    write("dock.xml", "Dock")
    old = (tmp_path / "dock.xml").read_text().replace(' BTCPP_format="4"', "")
    old = old.replace("<AlwaysSuccess/>", "<SequenceStar><AlwaysSuccess/></SequenceStar>")
    (tmp_path / "dock.xml").write_text(old)
    code, out, err = run_btq("init", "--from-xml", "--convert", cwd=tmp_path)
    assert (code, out.splitlines()[-1]) == (0, "Wrote btq.toml with 1 factory. Next: btq check .")
    assert 'dock.xml:1:2: BTCPP_format="4" is added\n' in err
    assert (tmp_path / "btq.toml").read_text().endswith('load = ["*.btq"]\nmain = "Main"\n')
    assert sorted(path.name for path in tmp_path.glob("*.btq")) == ["dock.btq", "main.btq"]
    assert 'exclude = ["/*.xml"]  # converted; delete' in (tmp_path / "btq.toml").read_text()
    assert run_btq("check", cwd=tmp_path)[:2] == (0, "No problems found in 2 files\n")
    assert run_btq("build", "--force", cwd=tmp_path)[0] == 0
    toml = (tmp_path / "btq.toml").read_text()
    (tmp_path / "btq.toml").write_text("".join(line for line in toml.splitlines(True) if "exclude" not in line))
    assert run_btq("check", cwd=tmp_path)[:2] == (0, "No problems found in 2 files\n")


def test_nothing_to_start_from(tmp_path: Path) -> None:
    nothing = "btq init: no BehaviorTree.CPP XML below .; nothing was written\n"
    assert run_btq("init", "--from-xml", cwd=tmp_path) == (2, "", nothing)
    assert run_btq("init", "--convert", cwd=tmp_path) == (2, "", "btq init: --convert goes with --from-xml\n")
    assert [*tmp_path.iterdir()] == []


def test_a_folder_with_one_kind_of_files_is_a_pattern(tmp_path: Path, write: Write) -> None:
    write("trees/main.xml", "Main: Dock")
    write("trees/dock/dock.xml", "Dock: Align")
    write("trees/dock/align.xml", "Align")
    write("more/a.xml", "Other: Align")
    write("more/b.xml", "Alone")
    for name in ("models/a.xml", "models/b.xml", "trees/dock/models/one.xml"):
        write(name)
        model = '<root><TreeNodesModel><Action ID="Go"/></TreeNodesModel></root>'
        (tmp_path / name).write_text(model)
    run_btq("init", "--from-xml", cwd=tmp_path)
    text = (tmp_path / "btq.toml").read_text()
    assert 'load = ["more/a.xml", "trees/dock/*.xml", "trees/main.xml"]\n' in text
    assert text.endswith('nodes = ["models/*.xml", "trees/dock/models/one.xml"]\n')
    (tmp_path / "trees" / "dock" / "models" / "one.xml").unlink()
    (tmp_path / "btq.toml").unlink()
    run_btq("init", "--from-xml", cwd=tmp_path)
    assert 'load = ["more/a.xml", "trees/**/*.xml"]\n' in (tmp_path / "btq.toml").read_text()
    assert run_btq("check", cwd=tmp_path)[:2] == (0, "No problems found in 7 files\n")


@pytest.mark.parametrize(
    ("root", "nodes", "line"),
    [
        ("<root>", "<FollowPath path='{p}' goal_checker_id='a'/>", "they fit humble, iron"),
        ('<root BTCPP_format="4">', "<FollowPath path='{p}' goal_checker_id='a'/>", "they fit jazzy, kilted, lyrical"),
        ("<root>", "<Spin spin_dist='1' error_code_id='{e}'/>", "nav2-iron"),
        (
            '<root BTCPP_format="4">',
            "<IsStopped duration_stopped='1'/>",
            "nav2-kilted",
        ),
        ("<root>", "<IsStopped duration_stopped='1'/>", "no distribution has all of these nodes and ports"),
        ("<root>", "<Sequence><Wait/><Spin angle='3'/></Sequence>", ""),
    ],
)
def test_the_distribution_of_nav2(tmp_path: Path, root: str, nodes: str, line: str) -> None:
    """Named if only one has the nodes with their ports; else a comment says which may be meant."""
    (tmp_path / "nav.xml").write_text(f'{root}<BehaviorTree ID="Main">{nodes}</BehaviorTree></root>\n')
    run_btq("init", "--from-xml", cwd=tmp_path)
    said = (tmp_path / "btq.toml").read_text()
    if line.startswith("nav2"):
        only = f'nodes = ["{line}"]  # the only distribution of Nav2 with the nodes and ports of the trees\n'
        assert said == HEAD.splitlines(keepends=True)[0] + only
    else:
        what = f'# nodes = ["nav2-DISTRIBUTION"]  # the trees use nodes of Nav2; name yours: {line}\n'
        assert said == HEAD + (what if line else "")
    assert run_btq("check", cwd=tmp_path)[0] < 2


@pytest.mark.parametrize(
    ("program", "is_nav2"),
    [
        ('factory.registerNodeType<Spin>("Spin");', False),
        ("#define REGISTER(Name) factory.registerNodeType<Name>(#Name)\nREGISTER(Spin);", False),
        ('factory.registerNodeType<Spin>("Turn"); say("Spin");', True),
    ],
)
def test_nodes_that_cpp_registers_are_not_nav2s(tmp_path: Path, program: str, is_nav2: bool) -> None:
    spin = '<root BTCPP_format="4"><BehaviorTree ID="Main"><Spin spin_dist="1"/></BehaviorTree></root>\n'
    (tmp_path / "nav.xml").write_text(spin)
    (tmp_path / "nodes.cpp").write_text(f"void add(F& factory) {{\n{program}\n}}\n")
    run_btq("init", "--from-xml", cwd=tmp_path)
    assert ("nodes of Nav2" in (tmp_path / "btq.toml").read_text()) == is_nav2


def test_a_distribution_that_lacks_a_port_is_not_proposed(tmp_path: Path) -> None:
    """The project has a node of its own that is called as one of Nav2's."""
    (tmp_path / "nav.xml").write_text(
        "<root><BehaviorTree ID='Main'><SpeedController filter_duration='1'>"
        "<Spin spin_dist='1' error_code_id='{e}'/></SpeedController></BehaviorTree></root>\n"
    )
    models = tmp_path / "models.xml"
    model = "<Decorator ID='SpeedController'><input_port name='filter_duration'/></Decorator>"
    models.write_text(f"<root><TreeNodesModel>{model}</TreeNodesModel></root>\n")
    assert run_btq("init", "--from-xml", cwd=tmp_path)[0] == 0
    unfit = "with it btq finds in nav.xml: `SpeedController` has no port `filter_duration`"
    said = f"name yours: nav2-iron does not fit, {unfit}\n"
    assert (tmp_path / "btq.toml").read_text().startswith(HEAD)
    assert (tmp_path / "btq.toml").read_text().endswith(said)
    assert run_btq("check", cwd=tmp_path)[:2] == (0, "No problems found in 2 files\n")


@pytest.mark.parametrize(
    ("beside", "engine"), [("<root>", '"3.8"'), ('<root BTCPP_format="4">', '["4.6", "4.8", "4.10"]')]
)
def test_the_engine_is_that_of_the_files(tmp_path: Path, beside: str, engine: str) -> None:
    """Version 3 if a file can only be for it, and none can only be for version 4."""
    (tmp_path / "old.xml").write_text(
        "<root><BehaviorTree ID='Old'><SequenceStar><AlwaysSuccess/></SequenceStar></BehaviorTree></root>\n"
    )
    (tmp_path / "other.xml").write_text(f"{beside}<BehaviorTree ID='Other'><AlwaysSuccess/></BehaviorTree></root>\n")
    assert run_btq("init", "--from-xml", cwd=tmp_path)[0] == 0
    assert (tmp_path / "btq.toml").read_text().splitlines()[1].partition("  #")[0] == f"engine = {engine}"


def test_the_plugin_of_a_ros_node_is_cpp_that_registers(tmp_path: Path, write: Write) -> None:
    pytest.importorskip("tree_sitter_cpp", reason="tree_sitter_cpp is not installed: pip install -e '.[cpp]'")
    write("go.xml", "Main")
    (tmp_path / "go.cpp").write_text('CreateRosNodePlugin(robot::Go, "Go");\n')
    assert run_btq("init", "--from-xml", cwd=tmp_path)[0] == 0
    nodes = 'nodes = ["*.cpp"]  # C++ that registers nodes'
    assert (tmp_path / "btq.toml").read_text().splitlines()[2] == nodes


def test_one_file_does_not_keep_a_folder_from_being_a_pattern(tmp_path: Path, write: Write) -> None:
    """Unless it defines a tree of the others; and a long list has a line for each item."""
    for number in range(10):
        write(f"trees/strategy_{number}.xml", f"strategy_number_{number}: Dock")
    write("trees/dock.xml", "Dock")
    write("trees/alone.xml", "Alone")
    run_btq("init", "--from-xml", cwd=tmp_path)
    text = (tmp_path / "btq.toml").read_text()
    main = "".join(f',\n    "strategy_number_{number}"' for number in range(10))
    assert text.endswith(f'load = ["trees/*.xml"]\nmain = [\n    "Alone"{main}\n]\n')
    assert run_btq("check", cwd=tmp_path)[:2] == (0, "No problems found in 12 files\n")
    (tmp_path / "btq.toml").unlink()
    write("trees/alone.xml", "Alone", "strategy_number_0")
    run_btq("init", "--from-xml", cwd=tmp_path)
    text = (tmp_path / "btq.toml").read_text()
    assert "alone.xml" not in text
    assert '    "trees/strategy_9.xml"\n]\nmain = [\n    "strategy_number_0",\n' in text


SERVER = """\
/robot:
  server:
    ros__parameters:
      plugins: [behaviortree_cpp/bt_plugins, {plugins}/bt_plugins]
      behavior_trees: [robot/trees, elsewhere/trees]
  client:
    ros__parameters:
      target_tree: Dock
"""
REGISTRATION = 'void f() { factory.registerSimpleAction("Go", go, {}); }'


def test_a_server_registers_whole_folders_and_creates_trees_by_their_names(tmp_path: Path, write: Write) -> None:
    pytest.importorskip("yaml", reason="PyYAML is not installed: pip install -e '.[nav2]'")
    write("src/robot/trees/a.xml", "Patrol: Dock", "Charge")
    write("src/robot/trees/b.xml", "Dock")
    write("src/robot/trees/c.xml", "Alone", "Lone")
    write("src/robot/others/d.xml", "Other", "Another")
    (tmp_path / "src/robot/package.xml").write_text("<package><name>robot</name></package>")

    def mains() -> list[str]:
        out = run_btq("check", "--output-format", "concise", cwd=tmp_path)[1]
        return [line.partition(":")[0] for line in out.splitlines() if "unknown-main-tree" in line]

    assert mains() == ["src/robot/others/d.xml", "src/robot/trees/c.xml"]
    (tmp_path / "src/robot/params.yaml").write_text(SERVER.format(plugins="robot"))
    assert mains() == ["src/robot/others/d.xml"]
    assert run_btq("init", "--from-xml", cwd=tmp_path)[0] == 0
    main = '["Dock", "Alone", "Charge", "Lone", "Patrol"]'
    table = f'[[factory]]\nname = "trees"\nload = ["src/robot/trees/*.xml"]\nmain = {main}\n'
    assert (tmp_path / "btq.toml").read_text() == f"{HEAD}\n{table}"
    assert mains() == ["src/robot/others/d.xml"]


@pytest.mark.parametrize(
    ("models", "plugins", "nodes", "remark"),
    [
        ("src/robot/models.xml", "nodes", 'nodes = ["src/robot/models.xml"]\n', ""),
        ("models.xml", "nodes", 'nodes = ["models.xml"]\n', ""),
        ("src/nodes/models.xml", "nodes", 'nodes = ["src/nodes/*.cpp"]\n', ""),
        (
            "src/nodes/models.xml",
            "unknown",
            "",
            "the factory `trees` has no `nodes`, because all models are of other packages\n",
        ),
    ],
)
def test_the_models_of_a_factory_are_those_of_its_package(
    tmp_path: Path, write: Write, models: str, plugins: str, nodes: str, remark: str
) -> None:
    for missing in ("yaml", "tree_sitter_cpp"):
        pytest.importorskip(missing, reason=f"{missing} is not installed: pip install -e '.[cpp,nav2]'")
    write("src/robot/trees/a.xml", "Patrol: Dock")
    write("src/robot/trees/b.xml", "Dock")
    for package in ("robot", "nodes"):
        (tmp_path / "src" / package).mkdir(exist_ok=True)
        (tmp_path / "src" / package / "package.xml").write_text(f"<package><name>{package}</name></package>")
    (tmp_path / "src/nodes/go.cpp").write_text(REGISTRATION)
    (tmp_path / models).write_text('<root><TreeNodesModel><Action ID="Go"/></TreeNodesModel></root>')
    (tmp_path / "params.yaml").write_text(SERVER.format(plugins=plugins))
    assert run_btq("init", "--from-xml", cwd=tmp_path)[2] == remark
    table = '[[factory]]\nname = "trees"\nload = ["src/robot/trees/*.xml"]\nmain = ["Dock", "Patrol"]\n'
    assert (tmp_path / "btq.toml").read_text().partition("\n\n")[2] == table + nodes
