"""`btq nodes` as a person runs it."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from in_process import run_btq

from btq_lang.projects.opening import open_workspace

pytest.importorskip("tree_sitter_cpp", reason="the C++ grammar is not installed: pip install -e '.[cpp]'")

DRIVE = """\
class Drive : public BT::StatefulActionNode
{
public:
  static BT::PortsList providedPorts()
  {
    return { BT::InputPort<Pose>("goal", "where <to> go"),
             BT::InputPort<std::vector<double>>("speeds", "1;2", "m/s"),
             BT::InputPort<bool>("fast"),
             BT::OutputPort<int>("code") };
  }
  BT::NodeStatus onStart() override
  {
    if(!getInput("goal", goal_)) { throw BT::RuntimeError("no goal"); }
    if(!getInput("fast", fast_)) { fast_ = false; }
    getInput("speeds", speeds_);
    setOutput("code", 0);
  }
};
BT_REGISTER_NODES(factory)
{
  factory.registerNodeType<Drive>("Drive");
  factory.registerSimpleCondition("IsOpen", std::bind(isOpen));
}
"""
BTQ = """\
# made by `btq nodes` from src: change the C++ code and run it again

TreeNodesModel
    Action Drive
        input goal : Pose "where <to> go"
        input speeds : "std::vector<double>" = "1;2" "m/s"
        input fast : bool = ""
        output code : int
    Condition IsOpen
"""
XML = """\
<?xml version="1.0" encoding="UTF-8"?>
<!-- made by `btq nodes` from src: change the C++ code and run it again -->
<root BTCPP_format="4">
  <TreeNodesModel>
    <Action ID="Drive">
      <input_port name="goal" type="Pose">where &lt;to&gt; go</input_port>
      <input_port name="speeds" type="std::vector&lt;double&gt;" default="1;2">m/s</input_port>
      <input_port name="fast" type="bool"/>
      <output_port name="code" type="int"/>
    </Action>
    <Condition ID="IsOpen"/>
  </TreeNodesModel>
</root>
"""
COUNTED = "2 nodes with 4 ports in 1 file\n"


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    (tmp_path / "src").mkdir()
    (tmp_path / "src/drive.cpp").write_text(DRIVE, encoding="utf-8")
    return tmp_path


@pytest.mark.parametrize(("options", "text"), [((), BTQ), (("--format", "xml"), XML)])
def test_models_on_standard_output(robot: Path, options: tuple[str, ...], text: str) -> None:
    assert run_btq("nodes", "src", *options, cwd=robot) == (0, text, COUNTED)


@pytest.mark.parametrize(("name", "text"), [("nodes.btq", BTQ), ("nodes.xml", XML)])
def test_the_suffix_of_the_file_says_the_format(robot: Path, name: str, text: str) -> None:
    for _ in range(2):  # it overwrites what it has written
        assert run_btq("nodes", "src", "-o", name, cwd=robot) == (0, "", COUNTED)
    assert (robot / name).read_text(encoding="utf-8") == text
    assert run_btq("check", name, cwd=robot)[0] == 0


def test_a_mission_is_not_overwritten(robot: Path) -> None:
    (robot / "main.btq").write_text("BehaviorTree Main\n    Drive\n", encoding="utf-8")
    message = "btq nodes: main.btq exists, and btq nodes did not make it; choose another file name\n"
    assert run_btq("nodes", "src", "-o", "main.btq", cwd=robot) == (2, "", message)
    assert run_btq("nodes", "src", "-o", "main.svg", cwd=robot) == (
        2,
        "",
        "btq nodes: cannot write main.svg; choose one of btq, xml, html with --format\n",
    )


def test_the_page_shows_each_port_with_its_place(robot: Path) -> None:
    code, page, _ = run_btq("nodes", "src", "--format", "html", cwd=robot)
    assert code == 0
    assert "<title>Nodes of src</title>" in page
    assert "<p>class <code>Drive</code> at <code>src/drive.cpp:1:7</code></p>" in page
    assert (
        "<tr><td>input <span class='name'>goal</span></td><td><code>Pose</code></td><td><code></code></td>"
        "<td>where &lt;to&gt; go The node fails without it.</td>"
        "<td><code class='at'>src/drive.cpp:6:14</code></td></tr>"
    ) in page
    assert "<p>function registered at <code>src/drive.cpp:22:3</code></p>" in page


def test_what_cannot_be_seen_and_what_the_code_does_otherwise_is_said(robot: Path) -> None:
    text = DRIVE.replace('getInput("speeds", speeds_);', 'getInput("spede", speeds_);').replace('"IsOpen"', "name")
    (robot / "src/drive.cpp").write_text(text, encoding="utf-8")
    code, out, remarks = run_btq("nodes", "src", cwd=robot)
    assert (code, out) == (1, BTQ.removesuffix("    Condition IsOpen\n"))
    assert remarks.splitlines() == [
        "src/drive.cpp:7:14: warning[unused-port-in-cpp] `Drive` provides the port `speeds`, "
        "but its code never names it",
        "src/drive.cpp:15:5: warning[undeclared-port-in-cpp] `Drive` reads the port `spede`, which it does not provide",
        "src/drive.cpp:22:3: hint[unseen-in-cpp] the name of this node is an expression: `name`",
        "1 node with 4 ports in 1 file",
    ]


@pytest.mark.parametrize(
    ("names", "subject"),
    [
        ("A", "`A`"),
        ("AB", "`A` (like 1 other node)"),
        ("ABC", "`A` (like 2 other nodes)"),
    ],
)
def test_nodes_that_share_a_base_class_are_reported_together(tmp_path: Path, names: str, subject: str) -> None:
    (tmp_path / "n.cpp").write_text(
        "struct Base : BT::SyncActionNode {\n"
        '    static BT::PortsList providedPorts() { return { BT::InputPort<int>("a") }; }\n'
        "    BT::NodeStatus tick() { return BT::NodeStatus::SUCCESS; }\n"
        "};\n"
        + "".join(f"struct {name} : Base {{}};\n" for name in names)
        + "void f(BT::BehaviorTreeFactory& f) {\n"
        + "".join(f'    f.registerNodeType<{name}>("{name}");\n' for name in names)
        + "}\n"
    )
    _, _, remarks = run_btq("nodes", "n.cpp", cwd=tmp_path)
    problem = "provides the port `a`, but its code never names it"
    assert remarks.splitlines()[0] == f"n.cpp:2:53: warning[unused-port-in-cpp] {subject} {problem}"


def test_a_node_that_may_have_more_ports_says_so(robot: Path) -> None:
    text = DRIVE.replace("BT::StatefulActionNode", "nav2_behavior_tree::BtActionNode<Go>").replace(
        "return {", "return providedBasicPorts({"
    )
    (robot / "src/drive.cpp").write_text(text.replace('("code") }', '("code") })'), encoding="utf-8")
    code, out, _ = run_btq("nodes", "src", cwd=robot)
    assert code == 1
    assert "    # it cannot be seen whether Drive has more ports\n    Action Drive\n" in out


def test_without_files_or_the_grammar_it_says_so(robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (robot / "docs").mkdir()
    assert run_btq("nodes", "docs", cwd=robot) == (2, "", "btq nodes: no C++ file below docs\n")
    code, _, message = run_btq("nodes", "gone.cpp", cwd=robot)
    assert (code, message) == (2, "btq: gone.cpp: cannot be read: No such file or directory\n")
    from btq_lang.cpp import grammar

    grammar._parser.cache_clear()
    monkeypatch.setitem(sys.modules, "tree_sitter", None)
    assert run_btq("nodes", "src", cwd=robot) == (
        2,
        "",
        "btq nodes: C++ is read with tree-sitter; install it with pip install 'btq-lang[cpp]'\n",
    )


PLUGINS = """\
<class_libraries>
  <library path="docking">
    <class type="my::Dock" base_class_type="BT::SyncActionNode"><description>Docks.</description></class>
    <class type="my::Navigator" base_class_type="nav2_core::NavigatorBase"/>
  </library>
</class_libraries>
"""


def test_nodes_that_pluginlib_exports(tmp_path: Path) -> None:
    (tmp_path / "src").mkdir()
    (tmp_path / "src" / "drive.cpp").write_text(DRIVE, encoding="utf-8")
    (tmp_path / "src" / "plugins.xml").write_text(PLUGINS, encoding="utf-8")
    (tmp_path / "src" / "package.xml").write_text("<package/>", encoding="utf-8")
    code, output, errors = run_btq("nodes", "src", cwd=tmp_path)
    assert (code, output) == (1, BTQ)
    assert errors == (
        "src/plugins.xml:3:5: hint[unseen-in-cpp] exports `my::Dock`, a BT::SyncActionNode, to pluginlib;"
        " under which ID trees have it cannot be seen\n2 nodes with 4 ports in 1 file\n"
    )


def test_other_xml_is_no_source(tmp_path: Path) -> None:
    (tmp_path / "package.xml").write_text("<package/>", encoding="utf-8")
    assert run_btq("nodes", "package.xml", cwd=tmp_path) == (
        2,
        "",
        "btq: package.xml: neither C++ nor what pluginlib reads\n",
    )


def test_folders_of_tests_and_of_builds_are_read_only_where_they_are_named(tmp_path: Path) -> None:
    one = 'void add(F& f) { f.registerSimpleAction("%s", go); }\n'
    folders = "src test src/tests src/a/test/b build src/node_modules install log src/log src/x"
    for folder in folders.split():
        (tmp_path / folder).mkdir(parents=True)
        name = folder.replace("/", "_").title()
        (tmp_path / folder / "a.cpp").write_text(one % name)
    (tmp_path / "src/x/COLCON_IGNORE").touch()
    (tmp_path / "m.btq").write_text("BehaviorTree M\n    Src\n")
    (tmp_path / "src/old").mkdir()
    (tmp_path / "src/old/a.cpp").write_text(one % "Src_Old")
    (tmp_path / "btq.toml").write_text('nodes = ["**/*.cpp"]\nexclude = ["src/old/"]\n')

    def of_command(*paths: str) -> list[str]:
        _, out, _ = run_btq("nodes", *paths, cwd=tmp_path)
        return [line.split()[1] for line in out.splitlines() if line.startswith("    Action")]

    def of_pattern(pattern: str) -> list[str]:
        (tmp_path / "btq.toml").write_text(f'nodes = ["{pattern}"]\nexclude = ["src/old/"]\n')
        files = open_workspace(str(tmp_path)).files.values()
        return sorted(node for file in files for node in file.cpp_nodes)

    assert of_command(".") == of_pattern("**/*.cpp") == ["Src", "Src_Log"]
    assert of_command("test") == of_pattern("test/**/*.cpp") == ["Test"]
    assert of_command("src/tests") == of_pattern("src/tests/*.cpp") == ["Src_Tests"]
    assert of_command("src", "test") == ["Src", "Src_Log", "Test"]
    assert of_command("src/tests/a.cpp", "build") == ["Build", "Src_Tests"]
