"""`nodes = ["src/**/*.cpp"]` in the project file: the nodes of C++ sources are declared in all files of the project."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from shutil import copytree

import pytest
from in_process import run_btq

from btq_lang.ide.completion import complete
from btq_lang.ide.hover import hover
from btq_lang.ide.navigation import find_references, goto_definition
from btq_lang.ide.rename import RenameRefusal, prepare_rename
from btq_lang.projects.files import Files
from btq_lang.projects.opening import open_workspace
from btq_lang.workspace.workspace import Workspace

pytest.importorskip("tree_sitter_cpp", reason="the C++ grammar is not installed: pip install -e '.[cpp]'")

HEADER = """\
namespace robot {
class Drive : public BT::StatefulActionNode
{
public:
  static BT::PortsList providedPorts();
  BT::NodeStatus onStart() override;
};
}
"""
SOURCE = """\
#include "drive.hpp"
namespace robot {
/* größer */ BT::PortsList Drive::providedPorts()
{
  return { BT::InputPort<Pose>("goal", "where to go"),
           BT::InputPort<bool>("fast"),
           /* ü */ BT::InputPort<double>("speed", 0.5, "m/s"),
           BT::OutputPort<int>("code") };
}
BT::NodeStatus Drive::onStart()
{
  auto goal = getInput<Pose>("goal").value();
  if(!getInput("fast", fast_)) { fast_ = false; }
  getInput("sped", speed_);
  setOutput("code", 0);
}
}
BT_REGISTER_NODES(factory)
{
  factory.registerNodeType<robot::Drive>("Drive");
  factory.registerSimpleCondition("IsOpen", std::bind(isOpen));
}
"""
MISSION = """\
BehaviorTree Main
    ->
        IsOpen
        Drive (gaol = {g} fast = maybe)
"""
IN_MISSION = [
    "trees/m.btq:4:16: error[unknown-port] `Drive` has no port `gaol`; did you mean `goal`?",
    "trees/m.btq:4:34: error[invalid-literal] expected true, false, 1 or 0 for `fast`, found `maybe`",
]
OF_UNUSED = "warning[unused-port-in-cpp] `Drive` provides the port `speed`, but its code never names it"
UNUSED = f"src/drive.cpp:7:20: {OF_UNUSED}"
OF_UNDECLARED = "warning[undeclared-port-in-cpp] `Drive` reads the port `sped`, which it does not provide"
UNDECLARED = f"src/drive.cpp:14:3: {OF_UNDECLARED}"


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    for folder in ("src", "include", "trees"):
        (tmp_path / folder).mkdir()
    write(tmp_path, "btq.toml", 'nodes = ["src/**/*.cpp", "include/*.hpp"]\n')
    write(tmp_path, "include/drive.hpp", HEADER)
    write(tmp_path, "src/drive.cpp", SOURCE)
    write(tmp_path, "trees/m.btq", MISSION)
    return tmp_path


def write(folder: Path, path: str, text: str) -> None:
    (folder / path).write_text(text, encoding="utf-8")


def check(folder: Path, *paths: str) -> list[str]:
    _, out, err = run_btq("check", "--output-format", "concise", *paths, cwd=folder)
    return [*out.splitlines()[:-1], *err.splitlines()]


def test_checks_know_the_nodes_and_hold_the_code_against_them(robot: Path) -> None:
    assert check(robot) == [*IN_MISSION, UNUSED, UNDECLARED]
    assert check(robot, "trees") == IN_MISSION
    assert check(robot, "trees/m.btq") == IN_MISSION
    assert check(robot, "trees/m.btq", "src") == [*IN_MISSION, UNUSED, UNDECLARED]


def test_a_helper_of_a_helper_reads_a_port(robot: Path) -> None:
    helpers = """\
namespace {
void read(BT::TreeNode & node, const char * port, double & value) { node.getInput(port, value); }
void readAll(BT::TreeNode & node, double & value) { read(node, "speed", value); }
}
"""
    tick = 'getInput("sped", speed_);'
    write(robot, "src/drive.cpp", (helpers + SOURCE).replace(tick, "readAll(*this, speed_);"))
    assert check(robot) == IN_MISSION
    write(robot, "src/drive.cpp", (helpers + SOURCE).replace(tick, "read(*this, kName, speed_);"))
    assert check(robot) == [*IN_MISSION, f"src/drive.cpp:11:20: {OF_UNUSED}"]
    write(robot, "src/drive.cpp", (helpers + SOURCE).replace(tick, "elsewhere(*this);"))
    assert check(robot) == IN_MISSION


def test_a_node_of_version_3_may_have_the_name_of_a_built_in_of_version_4(robot: Path) -> None:
    ports = 'BT::PortsList providedPorts() { return { BT::InputPort<double>("sleep_time") }; }'
    node = f"struct Sleep : BT::SyncActionNode {{ static {ports} }};\n"
    write(robot, "src/drive.cpp", f'{node}void f() {{ factory.registerNodeType<Sleep>("Sleep"); }}\n')
    tree = '<BehaviorTree ID="M">\n<Sequence>\n<Sleep sleep_time="5.0"/>\n<Sleep sleep_tim="5.0"/>\n</Sequence>\n'
    write(robot, "trees/m.btq", "")
    write(robot, "trees/m.xml", f'<root BTCPP_format="4">\n{tree}</BehaviorTree>\n</root>\n')
    for line in ('engine = "3.8"\nnodes = ["src/*.cpp"]', 'nodes = ["nav2-humble", "src/*.cpp"]'):
        write(robot, "btq.toml", f"{line}\n")
        misspelt = "error[unknown-port] `Sleep` has no port `sleep_tim`; did you mean `sleep_time`?"
        assert check(robot, "trees") == [f"trees/m.xml:5:8: {misspelt}"]
        workspace, path = open_workspace(str(robot)), f"{robot}/trees/m.xml"
        file = workspace.files[path]
        assert place(workspace, path, file.text.index("Sleep")) == ["drive.cpp:1:8 Sleep"]
        shown = hover(workspace, path, file.text.index("Sleep"))
        assert shown is not None
        assert shown.markdown.startswith("```btq\nAction Sleep\n```")
    write(robot, "btq.toml", 'nodes = ["src/*.cpp"]\n')
    assert [line.split()[1:5] for line in check(robot, "trees")] == [
        ["error[unknown-port]", "`Sleep`", "has", "no"],
        ["error[unknown-port]", "`Sleep`", "has", "no"],
    ]


def test_an_action_that_ends_within_its_tick_runs_over_no_second_one(robot: Path) -> None:
    source = (
        "struct Prune : BT::ActionNodeBase {{ static PortsList providedPorts() {{ return {{}}; }}\n"
        "  NodeStatus tick() {{ return NodeStatus::{}; }} }};\n"
        'void add(F& f) {{ f.registerNodeType<Prune>("Prune"); f.registerNodeType<Prune>("Follow"); }}\n'
    )
    write(robot, "btq.toml", 'nodes = ["src/prune.cpp"]\n')
    write(robot, "src/prune.cpp", source.format("RUNNING"))
    write(robot, "trees/m.btq", "BehaviorTree M\n    R->\n        Prune\n        Follow\n")
    rule = ("--select", "reactive-multiple-async")
    (found,) = check(robot, "trees", *rule)
    assert found.startswith("trees/m.btq:4:9: hint[reactive-multiple-async] if `Prune` takes longer than one tick")
    write(robot, "src/prune.cpp", source.format("SUCCESS"))
    assert check(robot, "trees", *rule) == []


def test_a_baseline_holds_what_is_found_in_cpp(robot: Path) -> None:
    known = ("--baseline", "known.json")
    assert check(robot, *known, "--update-baseline") == [f"known.json: {len(IN_MISSION) + 2} added, 0 removed, 0 kept"]
    assert check(robot, *known) == []
    assert check(robot, "trees", *known, "--update-baseline") == [
        f"known.json: 0 added, 0 removed, {len(IN_MISSION) + 2} kept"
    ]
    write(robot, "src/drive.cpp", SOURCE.replace('"sped"', '"spd"'))
    assert check(robot, *known) == [UNDECLARED.replace("sped", "spd")]


def test_a_port_is_missing_only_if_the_code_is_seen_to_fail_without_it(robot: Path) -> None:
    write(robot, "trees/m.xml", '<root BTCPP_format="4"><BehaviorTree ID="M"><Drive/></BehaviorTree></root>\n')
    assert check(robot, "trees/m.xml") == [
        "trees/m.xml:1:46: warning[missing-port] `Drive` requires a value for its port `goal`"
    ]


def test_the_type_of_a_field_of_a_message_is_not_known(robot: Path) -> None:
    write(robot, "src/drive.cpp", SOURCE.replace("OutputPort<int>", "OutputPort<typename Result::_code_type>"))
    write(robot, "trees/m.btq", "BehaviorTree Main\n    Drive (goal = {g} code = {c})\n")
    workspace, path = open_workspace(str(robot)), f"{robot}/trees/m.btq"
    shown = hover(workspace, path, workspace.files[path].text.index("code"))
    assert shown is not None
    assert shown.markdown.splitlines()[0] == "`output code`"


def test_a_comment_and_the_project_file_silence_what_is_found_in_cpp(robot: Path) -> None:
    silent = SOURCE.replace('"sped", speed_);', '"sped", speed_);  // btq: ignore[undeclared-port-in-cpp] of a base')
    write(robot, "src/drive.cpp", silent)
    assert check(robot, "trees/m.btq", "src") == [*IN_MISSION, UNUSED]
    write(robot, "src/drive.cpp", silent.replace("           /* ü", "  // btq: ignore\n           /* ü"))
    assert check(robot, "trees/m.btq", "src") == IN_MISSION
    write(robot, "src/drive.cpp", SOURCE)
    write(
        robot,
        "btq.toml",
        'nodes = ["src/*.cpp", "include/*.hpp"]\nignore = ["undeclared-port-in-cpp"]\n'
        '[[overrides]]\ninclude = ["src/"]\nrules = { unused-port-in-cpp = "off" }\n',
    )
    assert check(robot, "trees/m.btq", "src") == IN_MISSION


def test_no_port_is_unknown_or_missing_where_not_all_are_seen(robot: Path) -> None:
    write(robot, "src/drive.cpp", SOURCE.replace("return {", "return more({").replace('"code") };', '"code") });'))
    write(robot, "trees/m.btq", MISSION.replace("gaol = {g} fast = maybe", "rate = 3"))
    assert check(robot) == [
        "src/drive.cpp:5:10: hint[unseen-in-cpp] `more` is not in the sources, and may add ports",
        UNUSED,
    ]


def test_no_node_is_unknown_where_one_may_be_hidden(robot: Path) -> None:
    write(robot, "trees/m.btq", "BehaviorTree Main\n    ->\n        IsOpen\n        Other\n")
    unknown = "trees/m.btq:4:9: hint[unknown-node] unknown node `Other`"
    assert check(robot, "trees") == [unknown]
    write(robot, "src/other.cpp", "void add(F& f, std::string name) { f.registerNodeType<robot::Drive>(name); }\n")
    assert check(robot) == [
        UNUSED,
        UNDECLARED,
        "src/other.cpp:1:36: hint[unseen-in-cpp] the name of this node is an expression: `name`",
    ]


@pytest.mark.parametrize("line", ["nodes = {}\n", '[[factory]]\nname = "a"\nload = ["trees/*.btq"]\nnodes = {}\n'])
def test_tests_and_excluded_sources_register_nothing(robot: Path, line: str) -> None:
    for folder in ("test/unit", "src/mocks"):
        (robot / folder).mkdir(parents=True)
        name = folder.partition("/")[2]
        write(robot, f"{folder}/{name}.cpp", f'void add(F& f) {{ f.registerSimpleAction("Of_{name}", drive); }}\n')
    write(robot, "trees/m.btq", "BehaviorTree M\n    ->\n        Of_unit (no = 1)\n        Of_mocks (no = 1)\n")

    def known(patterns: str, more: str = "") -> list[str]:
        write(robot, "btq.toml", more + line.format(patterns))
        found = check(robot, "trees", "--select", "unknown-port")
        return [each.split("`")[1] for each in found]

    assert known('["**/*.cpp"]') == ["Of_mocks"]
    assert known('["**/*.cpp", "test/**/*.cpp"]') == ["Of_unit", "Of_mocks"]
    assert known('["test/unit/*.cpp"]') == ["Of_unit"]
    assert known('["**/*.cpp"]', 'exclude = ["src/mocks/"]\n') == []


@pytest.mark.parametrize(
    ("program", "is_all"),
    [
        (
            'int main() { BT::BehaviorTreeFactory f; f.registerNodeType<robot::Drive>("Drive"); f.createTree("M"); }',
            True,
        ),
        ('void add(F& f) { f.registerNodeType<robot::Drive>("Drive"); }', True),
        ('int main() { f.registerNodeType<robot::Drive>("Drive"); f.registerFromPlugin("libmore.so"); }', False),
        ('BT_REGISTER_NODES(f) { f.registerNodeType<robot::Drive>("Drive"); }', False),
    ],
)
def test_a_node_that_a_program_does_not_register(robot: Path, program: str, is_all: bool) -> None:
    """Not of a library, nor of a program that loads libraries."""
    factory = '[[factory]]\nname = "r"\nload = ["trees/*.xml"]\nmain = "M"\nnodes = ["src/*.cpp", "include/*.hpp"]\n'
    write(robot, "btq.toml", factory)
    write(robot, "src/drive.cpp", f'#include "drive.hpp"\n{program}\n')
    xml = '<root BTCPP_format="4"><BehaviorTree ID="M"><Sequence>{}<Drive/></Sequence></BehaviorTree></root>\n'
    for node, column in (("<Navigat/>", 56), ('<Action ID="Navigat"/>', 67)):
        write(robot, "trees/m.xml", xml.format(node))
        found = check(robot, "trees", "--select", "unknown-node")
        assert found == [f"trees/m.xml:1:{column}: error[unknown-node] unknown node `Navigat`"] * is_all


SETS = """\
struct Say : BT::SyncActionNode {
  static BT::PortsList providedPorts() { return { BT::InputPort<double>("pct") }; }
  BT::NodeStatus tick() override { return getInput<double>("pct").value() > 3 ? Status::SUCCESS : Status::FAILURE; }
};
int main() {
  factory.registerNodeType<Say>("Say");
  blackboard->set("battery_pct", 20.0);
  blackboard.set<std::string>("mode", "slow");
  tree.rootBlackboard()->set( "robot_name", name);
}
"""


@pytest.mark.parametrize(
    ("node", "entry", "meant"),
    [
        ('<Say pct="{batery_pct}"/>', "batery_pct", "battery_pct"),
        ('<Say pct="{batteryPct}"/>', "batteryPct", "battery_pct"),
        ('<Say pct="{robot_nam}"/>', "robot_nam", "robot_name"),
        ('<Say pct="{@robot_nmae}"/>', "@robot_nmae", "@robot_name"),
        ('<ScriptCondition code="mdoe == 2"/>', "mdoe", "mode"),
        ('<AlwaysSuccess _skipIf="battery_ptc > 3"/>', "battery_ptc", "battery_pct"),
    ],
)
def test_an_entry_is_misspelt_that_only_a_program_sets(robot: Path, node: str, entry: str, meant: str) -> None:
    write(robot, "src/say.cpp", SETS)
    xml = '<root BTCPP_format="4"><BehaviorTree ID="M"><Sequence>{}</Sequence></BehaviorTree></root>\n'
    write(robot, "trees/m.xml", xml.format(node))
    found = check(robot, "trees/m.xml", "--select", "misspelt-entry,unset-entry")
    message = f"nothing writes `{entry}`, which is read here; did you mean `{meant}`?"
    column = xml.index("{") + node.index(entry) + 1
    assert found == [f"trees/m.xml:1:{column}: warning[misspelt-entry] {message}"]


@pytest.mark.parametrize(
    ("program", "severity"),
    [
        ('blackboard->set("count", 1);', None),
        ('tree.rootBlackboard()->set<int>("count", 0);', None),
        ("setEntry<int>(", None),
        ('put("count", 1);', "warning"),
        ('blackboard->set("count" + suffix, 1);', "hint"),
        ("blackboard->set(Names::COUNT, 1);", "hint"),
        ("setEntry(name, 1);", "hint"),
        ('config().blackboard->get("count", value);', "warning"),
    ],
)
def test_what_a_program_sets_is_created(robot: Path, program: str, severity: str | None) -> None:
    program = program.replace("<int>(", '<int>("count", 0);')
    wrapper = (
        "template <typename T> void setEntry(const std::string &key, const T &value) {\n"
        "  if (has(key)) { tree.rootBlackboard()->set<T>(key, value); }\n}\n"
    )
    write(robot, "src/say.cpp", f"{SETS}void run() {{ {program} }}\n")
    write(robot, "src/tree.cpp", wrapper)
    code = '<root BTCPP_format="4"><BehaviorTree ID="M"><Script code="count = 1"/></BehaviorTree></root>\n'
    write(robot, "trees/m.xml", code)
    column = code.index("count") + 1
    message = f"trees/m.xml:1:{column}: {severity}[uncreated-entry] a script assigns to `count`, which nothing creates"
    assert check(robot, "trees/m.xml", "--select", "uncreated-entry") == [message] * (severity is not None)


def test_what_a_program_sets_is_not_unset(robot: Path) -> None:
    write(robot, "src/say.cpp", SETS)
    xml = '<root BTCPP_format="4"><BehaviorTree ID="M"><Sequence>{}</Sequence></BehaviorTree></root>\n'
    write(robot, "trees/m.xml", xml.format('<Say pct="{battery_pct}"/><Say pct="{level}"/>'))
    hint = "hint[unset-entry] nothing here writes `level` before it is read"
    assert check(robot, "trees/m.xml") == [f"trees/m.xml:1:92: {hint}"]


def test_messages_name_other_files_from_the_folder_of_the_project(robot: Path) -> None:
    write(robot, "src/other.cpp", 'void add(F& f) { f.registerSimpleAction("Drive", drive); }\n')
    write(robot, "trees/m.btq", "BehaviorTree Main\n    IsOpen\n")
    said = "`Drive` is also registered at src/drive.cpp:20:3, as another node"
    assert check(robot)[2:] == [f"src/other.cpp:1:18: hint[unseen-in-cpp] {said}"]


@pytest.mark.parametrize("order", [("nav", "arm"), ("arm", "nav")])
def test_a_factory_has_the_nodes_that_its_own_sources_register(robot: Path, order: tuple[str, ...]) -> None:
    write(robot, "src/grip.cpp", 'void add(F& f) { f.registerSimpleAction("Grip", grip); }\n')
    nodes = ("IsOpen", "Gripp (a = 1)", "Grip (a = 1)")
    write(robot, "trees/m.btq", "\n        ".join(("BehaviorTree Main\n    ->", *nodes)) + "\n")
    tables = {
        "nav": '[[factory]]\nname = "nav"\nload = ["trees/m.btq"]\nnodes = ["src/drive.cpp", "include/*.hpp"]\n',
        "arm": '[[factory]]\nname = "arm"\nload = ["trees/*.btq"]\nnodes = ["src/grip.cpp"]\n',
    }
    write(robot, "btq.toml", "".join(tables[name] for name in order))
    assert check(robot) == [
        UNUSED,
        UNDECLARED,
        "trees/m.btq:3:9: error[unknown-node] unknown node `IsOpen`",
        "trees/m.btq:4:9: error[unknown-node] unknown node `Gripp`; did you mean `Grip`?",
        "trees/m.btq:5:15: warning[unknown-port] `Grip` has no port `a`",
    ]


def test_what_keeps_nodes_from_being_known_is_said_once_in_the_project_file(
    robot: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write(robot, "trees/m.btq", "BehaviorTree Main\n    ->\n        IsOpen\n        Drive (a = 1)\n        Other\n")
    write(robot, "btq.toml", 'engine = "4.6"\nnodes = ["lib/*.cc"]\n')
    assert check(robot) == ["btq: btq.toml:2:10: no C++ file matches `lib/*.cc`"]
    write(robot, "btq.toml", 'nodes = ["include/*.hpp"]\n')
    assert check(robot) == [
        "btq: btq.toml:1:10: no node is registered in 1 C++ file; also pass the files that call BT_REGISTER_NODES, "
        "registerNodeType, registerBuilder or CreateRosNodePlugin"
    ]
    from btq_lang.cpp import grammar

    grammar._parser.cache_clear()
    monkeypatch.setitem(sys.modules, "tree_sitter", None)
    write(robot, "btq.toml", 'nodes = ["src/*.cpp"]\n')
    message = "C++ is read with tree-sitter; install it with pip install 'btq-lang[cpp]'"
    assert check(robot) == [f"btq: btq.toml:1:10: {message}"]
    write(robot, "btq.toml", '[[factory]]\nname = "a"\nload = ["trees/*"]\nnodes = ["src/*.cpp"]\n')
    assert check(robot) == [f"btq: btq.toml:4:10: {message}"]


def place(workspace: Workspace, path: str, offset: int) -> list[str]:
    """Where the definition is, as file:line:column and its text."""
    found = []
    for target in goto_definition(workspace, path, offset):
        file = workspace.files[target.path]
        span = file.on_disk(target.name)
        line, column = file.source_lines.position(span.start)
        name = target.path.rpartition("/")[2]
        found.append(f"{name}:{line + 1}:{column + 1} {file.source[span.start : span.end]}")
    return found


@pytest.mark.parametrize("suffix", ["btq", "xml"])
def test_definition_is_the_class_and_the_port_in_the_code(robot: Path, suffix: str) -> None:
    xml = '<root BTCPP_format="4"><BehaviorTree ID="M"><Drive goal="{g}" speed="1"/></BehaviorTree></root>\n'
    text = "BehaviorTree M\n    ->\n        Drive (goal = {g} speed = 1)\n        IsOpen\n" if suffix == "btq" else xml
    write(robot, f"trees/n.{suffix}", text)
    workspace, path = open_workspace(str(robot)), f"{robot}/trees/n.{suffix}"
    text = workspace.files[path].text
    assert place(workspace, path, text.index("Drive")) == ["drive.hpp:2:7 Drive"]
    assert place(workspace, path, text.index("speed")) == ['drive.cpp:7:20 BT::InputPort<double>("speed", 0.5, "m/s")']
    if suffix == "btq":
        registration = 'drive.cpp:21:3 factory.registerSimpleCondition("IsOpen", std::bind(isOpen))'
        assert place(workspace, path, text.index("IsOpen")) == [registration]


def test_definition_is_in_the_code_whatever_models_there_are(robot: Path) -> None:
    model = '<Action ID="Drive"><input_port name="speed"/><input_port name="old"/></Action>'
    tree = '<BehaviorTree ID="M"><Drive goal="{g}" speed="1" old="1"/></BehaviorTree>'
    text = f'<root BTCPP_format="4">{tree}<TreeNodesModel>{model}</TreeNodesModel></root>\n'
    write(robot, "trees/n.xml", text)
    workspace, path = open_workspace(str(robot)), f"{robot}/trees/n.xml"
    file = workspace.files[path]

    def places(word: str) -> list[list[str]]:
        """Where it leads to from the tree and from the model."""
        begins = (text.index(word), text.rindex(word))
        return [place(workspace, path, at) for each in begins if (at := file.from_disk(each)) is not None]

    assert places("Drive") == [["drive.hpp:2:7 Drive"]] * 2
    assert places("speed") == [['drive.cpp:7:20 BT::InputPort<double>("speed", 0.5, "m/s")']] * 2
    column = text.rindex("old") + 1
    assert places("old") == [[f"n.xml:1:{column} old"]] * 2
    at = file.from_disk(text.index("speed"))
    assert at is not None
    shown = hover(workspace, path, at)
    assert shown is not None
    assert f"[src/drive.cpp:7](file://{robot}/src/drive.cpp#L7)" in shown.markdown


def test_editors_show_them(robot: Path) -> None:
    write(robot, "trees/m.btq", MISSION.replace("gaol", "goal"))
    workspace, path = open_workspace(str(robot)), f"{robot}/trees/m.btq"
    text = workspace.files[path].text
    shown = hover(workspace, path, text.index("Drive"))
    assert shown is not None
    assert shown.markdown == (
        "```btq\nAction Drive\n```\n\n"
        "- `input goal : Pose` (required): where to go\n"
        '- `input fast : bool = ""`\n'
        "- `input speed : double = 0.5`: m/s\n"
        "- `output code : int`\n\n"
        f"[include/drive.hpp:2](file://{robot}/include/drive.hpp#L2)"
    )
    shown = hover(workspace, path, text.index("fast"))
    assert shown is not None
    assert shown.markdown == f'`input fast : bool = ""`\n\n[src/drive.cpp:6](file://{robot}/src/drive.cpp#L6)'
    assert {"speed", "code"} <= {one.label for one in complete(workspace, path, text.index("goal")).proposals}
    for word in ("Drive", "goal"):
        reason = f"cannot rename `{word}`: its definition is in src/drive.cpp, which is C++"
        assert prepare_rename(workspace, path, text.index(word)) == RenameRefusal(reason)
    at = text.index("Drive")
    references = [(each, span.start) for each, span in find_references(workspace, path, at, include_definition=False)]
    assert references == [(path, at)]


def test_a_build_knows_them_and_writes_no_models_of_them(robot: Path) -> None:
    code, _, err = run_btq("build", cwd=robot)
    assert (code, [line.removeprefix("nothing") for line in err.splitlines()]) == (1, [" was written"])
    write(robot, "trees/m.btq", "BehaviorTree Main\n    Drive (goal = {g})\n")
    assert run_btq("build", cwd=robot) == (0, "wrote trees/m.xml\n", "")
    assert re.findall(r"<(\w+)", (robot / "trees/m.xml").read_text()) == ["root", "BehaviorTree", "Drive"]


def test_a_source_is_parsed_again_only_if_it_changes(robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from btq_lang.cpp import source
    from btq_lang.cpp.grammar import parse

    parsed: list[str] = []

    def counting(text: str) -> object:
        parsed.append(text)
        return parse(text)

    monkeypatch.setattr(source, "parse", counting)
    files = Files()
    (before,), _ = files.groups([str(robot)])
    assert sorted(parsed) == [SOURCE, HEADER]
    changed = SOURCE.replace('"fast"', '"quick"')
    write(robot, "src/drive.cpp", changed)
    (after,), _ = files.groups([str(robot)])
    assert parsed[2:] == [changed]
    of_each = [group.workspace.files[f"{robot}/include/drive.hpp"] for group in (before, after)]
    assert of_each[0] is of_each[1]


def test_cpp_counts_before_a_stale_model(shared: Path, tmp_path: Path) -> None:
    if not (shared / "field" / "nav2" / "stale-model").is_dir():
        pytest.skip("the shared inputs have no field/nav2/stale-model")
    copytree(shared / "field" / "nav2" / "stale-model", tmp_path, dirs_exist_ok=True)
    assert check(tmp_path) == [
        "t.xml:3:10: error[unknown-port] `Fly` has no port `path_topic`; did you mean `route`?",
        "t.xml:6:40: warning[stale-model] the C++ of `Fly` has no port `path_topic`; did you mean `route`?",
    ]
    _, shown, _ = run_btq("check", cwd=tmp_path)
    assert shown.count("= help: Replace `path_topic` with `route`") == 2


STALE = "trees/m.btq:{}: {}[stale-model] {}"


@pytest.mark.parametrize(
    ("model", "found"),
    [
        ("Action Drive\n    input goal\n    input fast\n    input speed\n    output code", []),
        ('Action Drive\n    input goal : "Pose_<std::allocator<void>>"\n    input speed : double = 1.0', []),
        ("Condition IsOpen", []),
        ("Action IsOpen", ["1:1", "`IsOpen` is of category Action in this model, and Condition in C++"]),
        ("Condition IsOpen\n    input door", ["2:11", "the C++ of `IsOpen` has no port `door`"]),
        (
            "Action Drive\n    output goal",
            ["2:5", "the port `goal` is an output in this model, and an input in C++"],
        ),
        (
            "Action Drive\n    inout speed : double",
            ["2:5", "the port `speed` is an input and output in this model, and an input in C++"],
        ),
        (
            "Action Drive\n    input speed : string",
            ["2:19", "the type of the port `speed` is `string` in this model, and `double` in C++"],
        ),
        (
            "Action Drive\n    input gaol : Pose",
            ["2:11", "the C++ of `Drive` has no port `gaol`; did you mean `goal`?"],
        ),
        (
            "TreeNodesModel\n    Action Drive\n        input velocity : double",
            ["3:15", "the C++ of `Drive` has no port `velocity`"],
        ),
    ],
)
def test_a_model_that_says_otherwise_than_the_cpp_is_stale(robot: Path, model: str, found: list[str]) -> None:
    write(robot, "trees/m.btq", f"{model}\n\nBehaviorTree M\n    ->\n        IsOpen\n        Drive (goal = {{g}})\n")
    findings = check(robot, "trees/m.btq", "--ignore", "unset-entry")
    severity = "hint" if "category" in "".join(found) else "warning"
    assert findings == ([STALE.format(found[0], severity, found[1])] if found else [])


def test_a_stale_model_in_a_file_of_models_declares_no_port(robot: Path) -> None:
    cpp = 'nodes = ["src/*.cpp", "include/*.hpp"]\n'
    write(robot, "btq.toml", f'{cpp}[[factory]]\nname = "a"\nload = ["trees/*"]\nnodes = ["models.btq"]\n')
    write(robot, "models.btq", "Action Drive\n    input goal\n    input old\n")
    write(robot, "trees/m.btq", "BehaviorTree Main\n    Drive (goal = {g} old = 1)\n")
    of_tree = "trees/m.btq:2:23: error[unknown-port] `Drive` has no port `old`"
    assert check(robot, "trees") == [of_tree]
    stale = "models.btq:3:11: warning[stale-model] the C++ of `Drive` has no port `old`"
    assert check(robot, "trees", "models.btq") == [stale, of_tree]


def test_a_model_registers_no_node(robot: Path) -> None:
    """Not where C++ may register it in a way that is not seen, nor where `nodes` names the file of the model."""
    factory = '[[factory]]\nname = "a"\nload = ["trees/*"]\nnodes = ["src/*.cpp"{}]\n'
    model = '<TreeNodesModel><Action ID="Ghost"/></TreeNodesModel>'
    write(robot, "btq.toml", factory.format(""))
    write(
        robot,
        "src/drive.cpp",
        SOURCE.replace("BT_REGISTER_NODES(factory)", "void run(BT::BehaviorTreeFactory& factory)"),
    )
    tree = '<BehaviorTree ID="Other"><Sequence><IsOpen/><Ghost/></Sequence></BehaviorTree>'
    write(robot, "trees/m.xml", f'<root BTCPP_format="4">\n{tree}\n{model}\n</root>\n')
    stale = "no C++ of the factory registers `Ghost`: the engine does not read models, and refuses it"
    assert check(robot, "trees") == [f"trees/m.xml:3:29: warning[stale-model] {stale}"]
    write(robot, "src/ghost.cpp", '// add("Ghost");\n')
    assert check(robot, "trees") == []
    (robot / "src/ghost.cpp").unlink()
    write(robot, "models.xml", f"<root>{model}</root>\n")
    write(robot, "btq.toml", factory.format(', "models.xml"'))
    assert check(robot, "trees") == []


def test_where_not_all_ports_of_the_cpp_are_seen_a_model_may_have_more(robot: Path) -> None:
    write(robot, "src/drive.cpp", SOURCE.replace("return {", "return more({").replace('"code") };', '"code") });'))
    tree = "\nBehaviorTree Main\n    Drive (goal = {g} rate = 1)\n"
    write(robot, "trees/m.btq", f"Action Drive\n    input goal\n    input rate : int\n{tree}")
    assert check(robot, "trees") == []
    write(robot, "trees/m.btq", f"Action Drive\n    output goal\n    input rate : int\n{tree}")
    stale = "the port `goal` is an output in this model, and an input in C++"
    assert check(robot, "trees") == [f"trees/m.btq:2:5: warning[stale-model] {stale}"]


def test_a_factory_holds_models_against_its_own_sources(robot: Path) -> None:
    write(
        robot,
        "btq.toml",
        '[[factory]]\nname = "a"\nload = ["trees/m.btq"]\nnodes = ["src/*.cpp", "include/*.hpp"]\n'
        '[[factory]]\nname = "b"\nload = ["trees/n.btq"]\n',
    )
    for name in "mn":
        write(
            robot,
            f"trees/{name}.btq",
            "Action Drive\n    input goal\n    input old\n\nBehaviorTree Main\n    Drive (goal = {g} old = 1)\n",
        )
    assert check(robot, "trees", "--ignore", "unset-entry") == [
        "trees/m.btq:3:11: warning[stale-model] the C++ of `Drive` has no port `old`",
        "trees/m.btq:6:23: error[unknown-port] `Drive` has no port `old`",
    ]


OF_NAV2 = """\
struct Scan : nav2_behavior_tree::BtActionNode<M> {
  static BT::PortsList providedPorts() { return providedBasicPorts({ BT::InputPort<int>("area") }); }
};
BT_REGISTER_NODES(factory) { factory.registerNodeType<Scan>("Scan"); }
"""


@pytest.mark.parametrize(
    ("project", "found"),
    [
        ('nodes = ["nav2-humble", "src/*.cpp"]\n', ["error[unknown-port] `Scan` has no port `error_msg`"]),
        ('nodes = ["nav2-lyrical", "src/*.cpp"]\n', []),
        ('engine = "3.8"\nnodes = ["src/*.cpp"]\n', ["error[unknown-port] `Scan` has no port `error_msg`"]),
        ('engine = "4.6"\nnodes = ["src/*.cpp"]\n', []),  # it may be Lyrical's
        (
            '[[factory]]\nname = "a"\nload = ["trees/*"]\nnodes = ["nav2-jazzy", "src/*.cpp"]\n',
            ["error[unknown-port] `Scan` has no port `error_msg`"],
        ),
    ],
)
def test_base_classes_of_nav2_are_known_by_the_distribution_of_the_project(
    robot: Path, project: str, found: list[str]
) -> None:
    (robot / "src/drive.cpp").unlink()
    write(robot, "src/scan.cpp", OF_NAV2)
    write(robot, "btq.toml", project)
    write(robot, "trees/m.btq", "BehaviorTree M\n    Scan (area = 1 server_name = a error_msg = {e})\n")
    assert [each.partition(": ")[2] for each in check(robot, "trees")] == found
    code, out, err = run_btq("nodes", "src", cwd=robot)
    assert (code, "error_msg" in out) == ((1, False) if "4.6" in project else (0, "lyrical" in project))
    assert err.splitlines()[:-1] == (
        [
            "src/scan.cpp:2:49: hint[unseen-in-cpp] whether `BtActionNode` provides `error_code_id`, `error_msg` "
            "depends on the distribution; name the distribution of Nav2 in the project file: "
            '`nodes = ["nav2-jazzy", …]`'
        ]
        if code
        else []
    )


@pytest.mark.parametrize(
    ("base", "distribution", "entries"),
    [
        ("BtActionNode<M>", "jazzy", "`node`, `wait_for_service_timeout`, `bt_loop_duration`"),
        ("BtServiceNode<M>", "humble", "`node`, `wait_for_service_timeout`, `bt_loop_duration`, `server_timeout`"),
        ("BtCancelActionNode<M>", "lyrical", "`node`, `wait_for_service_timeout`"),
        ("Other", "jazzy", ""),
    ],
)
def test_a_node_that_derives_from_nav2s_needs_what_they_need(
    robot: Path, base: str, distribution: str, entries: str
) -> None:
    (robot / "src/drive.cpp").unlink()
    write(robot, "src/scan.cpp", OF_NAV2.replace("BtActionNode<M>", base))
    write(robot, "src/other.cpp", "namespace nav2_behavior_tree { struct Other : BT::SyncActionNode {}; }\n")
    write(robot, "btq.toml", f'nodes = ["nav2-{distribution}", "src/*.cpp"]\n')
    mission = "BehaviorTree M\n    SubTree Look{}\n\nBehaviorTree Look\n    Scan (area = 1)\n"
    write(robot, "trees/m.btq", mission.format(""))
    refused = f"error[isolated-node] `Scan` cannot be created in the tree `Look`: this SubTree does not pass {entries}"
    assert check(robot, "trees") == ([f"trees/m.btq:2:13: {refused}"] if entries else [])
    if distribution != "humble":
        write(robot, "trees/m.btq", mission.format(" (_autoremap = true)"))
        assert check(robot, "trees") == []


@pytest.mark.parametrize(
    ("read", "severity"),
    [
        ('fast_ = getInput<bool>("fast").value();', "warning"),
        ('if(!getInput("fast", fast_)) { fast_ = false; }', "hint"),
        ('getInput("fast", fast_);', "hint"),
    ],
)
def test_a_default_does_not_count_for_an_entry_that_nothing_sets(robot: Path, read: str, severity: str) -> None:
    source = SOURCE.replace('if(!getInput("fast", fast_)) { fast_ = false; }', read).replace('"sped"', '"speed"')
    write(
        robot, "src/drive.cpp", source.replace('BT::InputPort<bool>("fast")', 'BT::InputPort<bool>("fast", true, "")')
    )
    node = "    Drive (goal = {place} fast = {hasty})\n"
    main = "    ->\n        SubTree Go (place = there hasty = true)\n        SubTree Go (place = there)\n"
    write(robot, "trees/m.btq", f"BehaviorTree Main\n{main}BehaviorTree Go\n{node}")
    message = "`Go` reads `hasty`, which this SubTree does not pass to it, and another one does"
    assert check(robot) == [f"trees/m.btq:4:17: {severity}[unset-entry] {message}"]
    write(robot, "trees/m.btq", f"BehaviorTree Main\n{main.replace(' hasty = true', '')}BehaviorTree Go\n{node}")
    message = "nothing in `Go` writes `hasty`, which is read here, and no SubTree passes it"
    assert check(robot) == [f"trees/m.btq:6:35: {severity}[unset-entry] {message}"]


@pytest.mark.parametrize("condition", ["_successIf", "_failureIf", "_skipIf", "_while"])
def test_the_condition_of_a_node_of_cpp_reads_an_entry_by_its_bare_name(robot: Path, condition: str) -> None:
    tree = f'    IsOpen ({condition} = "is_placed")\n'
    write(robot, "trees/m.btq", f"BehaviorTree Main\n    SubTree Go\nBehaviorTree Go\n{tree}")
    column = tree.index("is_placed") + 1
    message = "nothing in `Go` writes `is_placed`, which is read here, and no SubTree passes it"
    unset = f"trees/m.btq:4:{column}: warning[unset-entry] {message}"
    assert check(robot, "trees") == [unset]
