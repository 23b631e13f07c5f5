"""What version of the engine a text is for: the same for check, import, init and the server, whatever says it."""

from __future__ import annotations

from pathlib import Path

import pytest
from in_process import run_btq

from btq_lang.lsp.session import Session

MAIN = 'main_tree_to_execute="Main"'
ALL = 'engine = ["4.6", "4.8", "4.10"]\n'


def tree(root: str, *nodes: str) -> str:
    """A file that version 3 and 4 take otherwise: `map` is the name of an entry, and an explicit child is allowed."""
    return f"""\
<root {root}>
  <BehaviorTree ID="Main">
    <ReactiveSequence>
      <Action ID="Say" text="hello"/>
      <SubTree ID="Place" frame="map"/>
      {"".join(nodes)}
    </ReactiveSequence>
  </BehaviorTree>
  <BehaviorTree ID="Place"><Say text="{{frame}}"/></BehaviorTree>
</root>
"""


SHARING = '<SubTree ID="Place" __shared_blackboard="true"/>'
PLUS = '<SubTreePlus ID="Place" __autoremap="true"/>'
STAR = "<SequenceStar><Say/></SequenceStar>"
SCRIPT = '<Script code="n := 1"/>'

# What the project file says, the attributes of the root, more nodes, and the version.
CASES = {
    "nothing": ("", MAIN, (), 4),
    "format": ("", f'{MAIN} BTCPP_format="4"', (), 4),
    "format-first": ("", f'BTCPP_format="4" {MAIN}', (), 4),
    "format-alone": ("", 'BTCPP_format="4"', (), 4),
    "format-in-other-quotes": ("", f"x='1' BTCPP_format=' 4 ' {MAIN}", (), 4),
    "format-first-and-an-old-word": ("", f'BTCPP_format="4" {MAIN}', (SHARING,), 4),
    "format-last-and-an-old-word": ("", f'{MAIN} BTCPP_format="4"', (STAR,), 4),
    "format-3": ("", f'BTCPP_format="3" {MAIN}', (), 3),
    "format-3-last": ("", f'{MAIN} BTCPP_format="3"', (), 3),
    "another-attribute-that-ends-so": ("", f'x_BTCPP_format="4" {MAIN}', (SHARING,), 3),
    "a-comment-about-the-format": ("", MAIN, ('<!-- BTCPP_format="4" -->', SHARING), 3),
    "old-node": ("", MAIN, (STAR,), 3),
    "old-node-in-explicit-form": ("", MAIN, ('<Control ID="SequenceStar"><Say/></Control>',), 3),
    "old-subtree": ("", MAIN, (PLUS,), 3),
    "old-attribute": ("", MAIN, (SHARING,), 3),
    "old-port": ("", MAIN, ('<Parallel success_threshold="1"><Say/></Parallel>',), 3),
    "entry-without-braces": ("", MAIN, ('<Say text="{map}"/>',), 3),
    "entry-of-the-same-name": ("", MAIN, ('<SubTree ID="Place" frame="frame"/>',), 3),
    "new-node": ("", MAIN, (SCRIPT,), 4),
    "new-attribute": ("", MAIN, ('<Say _skipIf="true"/>',), 4),
    "old-and-new": ("", MAIN, (PLUS, SCRIPT), 4),
    "pinned": ('engine = "4.10"\n', MAIN, (), 4),
    "pinned-to-several": ('engine = ["4.8", "4.10"]\n', MAIN, (SHARING,), 4),
    "pinned-to-all": (ALL, MAIN, (SHARING,), 4),
    "pinned-and-format-3": ('engine = "4.10"\n', f'BTCPP_format="3" {MAIN}', (), 4),
    "pinned-and-refused": ('engine = "4.10"\n', MAIN, (PLUS,), 3),
    "pinned-to-3": ('engine = "3.8"\n', MAIN, (), 3),
    "pinned-to-3-and-format-4": ('engine = "3.8"\n', f'BTCPP_format="4" {MAIN}', (), 3),
    "humble": ('nodes = ["nav2-humble"]\n', MAIN, (), 3),
    "jazzy": ('nodes = ["nav2-jazzy"]\n', MAIN, (SHARING,), 4),
    "engine-before-distribution": ('engine = "4.10"\nnodes = ["nav2-humble"]\n', MAIN, (), 4),
    "factory": ('[[factory]]\nname = "f"\nload = ["*.xml"]\nnodes = ["nav2-humble"]\n', MAIN, (), 3),
}


@pytest.mark.parametrize("case", CASES)
def test_every_command_decides_alike(tmp_path: Path, case: str) -> None:
    project, root, nodes, version = CASES[case]
    if project:
        (tmp_path / "btq.toml").write_text(project)
    text = tree(root, *nodes)
    (tmp_path / "t.xml").write_text(text)
    is_old = version == 3

    checked = run_btq("check", "t.xml", "--output-format", "concise", cwd=tmp_path)[1]
    assert ("explicit-in-reactive" not in checked) is is_old
    assert run_btq("check", "-", "--stdin-filename", "t.xml", cwd=tmp_path, stdin=text)[1].count("explicit") == (
        checked.count("explicit")
    )

    session = Session()
    session.folders = (str(tmp_path),)
    session.edit(str(tmp_path / "t.xml"), text)
    assert (
        "explicit-in-reactive" not in {each.rule for each in session.diagnostics(str(tmp_path / "t.xml"))}
    ) is is_old

    assert run_btq("import", "t.xml", cwd=tmp_path)[0] == 0
    argument = "frame = {map}" if is_old else 'frame = "map"'
    assert f"SubTree Place ({argument})" in (tmp_path / "t.btq").read_text()
    if case != "factory":  # which does not load what has no name
        assert argument in run_btq("import", "-", cwd=tmp_path, stdin=text)[1]

    if not project:
        assert run_btq("init", "--from-xml", cwd=tmp_path)[0] == 0
        engine = (tmp_path / "btq.toml").read_text().splitlines()[1].partition("  #")[0]
        assert f"{engine}\n" == ('engine = "3.8"\n' if is_old else ALL)


def test_a_distribution_of_a_factory_counts_before_the_engine_of_the_project(tmp_path: Path) -> None:
    for name, number, node in (("old", 3, '<Wait wait_duration="3"/>'), ("new", 4, '<Script code="a := 1"/>')):
        root = f'<root BTCPP_format="{number}">\n<BehaviorTree ID="{name}">\n{node}\n</BehaviorTree>\n</root>\n'
        (tmp_path / f"{name}.xml").write_text(root)
    old = 'old.xml:1:2: warning[version-3-file] this file is for version 3 of the engine: it has `BTCPP_format="3"`'

    def check(project: str) -> list[str]:
        (tmp_path / "btq.toml").write_text(project)
        return run_btq("check", "--output-format", "concise", cwd=tmp_path)[1].splitlines()[:-1]

    engine, factory = 'engine = ["4.6", "4.8", "4.10"]\n', '[[factory]]\nname = "r"\nload = ["old.xml"]\n'
    assert check(engine)[0] == f"{old}, but btq.toml names 4.10"
    assert check(f"{engine}{factory}")[0] == f"{old}, but btq.toml names 4.10"
    assert check(f'{engine}{factory}nodes = ["nav2-humble"]\n') == []
    script = "new.xml:3:2: error[newer-engine-node] `Script` requires BehaviorTree.CPP 4; 3.8 does not have it"
    of_new = factory.replace("old", "new")
    assert check(f'engine = "3.8"\n{of_new}') == [script]
    assert check(f'engine = "3.8"\n{of_new}nodes = ["nav2-jazzy"]\n') == []


def test_a_word_of_version_3_that_a_pinned_engine_loads_is_said_once_and_kept(tmp_path: Path) -> None:
    (tmp_path / "btq.toml").write_text('engine = "4.10"\n')
    (tmp_path / "t.xml").write_text(tree(MAIN, '<SubTree ID="Place" frame="frame"/>').replace('Action ID="Say"', "Say"))
    code, out, _ = run_btq("check", "t.xml", cwd=tmp_path)
    assert code == 1
    assert (
        "warning[version-3-file]: this file is for version 3 of the engine: "
        'it has `frame="frame"`, but btq.toml names 4.10\n'
    ) in out
    assert "= note: if it runs version 4, write `_autoremap`, and braces round the names of entries\n" in out
    assert run_btq("import", "t.xml", cwd=tmp_path)[2] == "1 file imported\nNext: btq check t.btq\n"


def test_the_version_of_the_shared_trees(tmp_path: Path, shared: Path) -> None:
    """An import into a pinned project, and a format that is the first of the attributes."""
    pinned = shared / "field" / "trees" / "32-import-unversioned"
    for name in ("btq.toml", "t.xml"):
        (tmp_path / name).write_text((pinned / name).read_text())
    assert run_btq("import", "t.xml", cwd=tmp_path)[2] == "1 file imported\nNext: btq check t.btq\n"
    assert 'SubTree Place (frame = "map")\n' in (tmp_path / "t.btq").read_text()
    for name in ("btq.toml", "t.xml", "t.btq"):
        (tmp_path / name).unlink()

    first = shared / "field" / "trees" / "33-version-by-attribute-order" / "a.xml"
    (tmp_path / "a.xml").write_text(first.read_text())
    assert [
        line.split(" ")[1] for line in run_btq("check", "--output-format", "concise", cwd=tmp_path)[1].splitlines()
    ] == [
        "warning[unknown-attribute]",
        "error[explicit-in-reactive]",
        "warning[old-entry]",
        "error[forbidden-name]",
        "warning[unused-tree]",
        "2",
    ]
    assert run_btq("init", "--from-xml", cwd=tmp_path)[0] == 0
    assert ALL.strip() in (tmp_path / "btq.toml").read_text()


PACKAGE = '<package format="3"><name>robot</name>{}</package>\n'
# What is beside the trees, and the value of `engine`.
PACKAGES = {
    "package-3": ({"package.xml": PACKAGE.format("<depend>behaviortree_cpp_v3</depend>")}, "3.8"),
    "package-4": (
        {"package.xml": PACKAGE.format('<build_depend version_gte="4.0">behaviortree_cpp</build_depend>')},
        "",
    ),
    "package-of-ros": ({"package.xml": PACKAGE.format("<exec_depend>\nbehaviortree_ros2\n</exec_depend>")}, ""),
    "commented": (
        {
            "package.xml": PACKAGE.format(
                "<!-- <depend>behaviortree_cpp_v3</depend> --><depend>behaviortree_cpp</depend>"
            )
        },
        "",
    ),
    "several": (
        {
            "a/package.xml": PACKAGE.format("<depend>behaviortree_cpp_v3</depend>"),
            "b/package.xml": PACKAGE.format("<depend>behaviortree_cpp</depend>"),
        },
        None,
    ),
    "cmake-3": ({"CMakeLists.txt": "find_package(BehaviorTreeV3 REQUIRED)\n"}, "3.8"),
    "cmake-4": ({"CMakeLists.txt": "# behaviortree_cpp_v3\nfind_package(behaviortree_cpp REQUIRED)\n"}, ""),
    "includes-3": ({"src/a.cpp": '#include "behaviortree_cpp_v3/bt_factory.h"\n'}, "3.8"),
    "includes-4": ({"src/a.hpp": "// behaviortree_cpp_v3/\n#include <behaviortree_cpp/bt_factory.h>\n"}, ""),
    "manifest-before-includes": (
        {
            "package.xml": PACKAGE.format("<depend>behaviortree_cpp</depend>"),
            "old.cpp": '#include "behaviortree_cpp_v3/bt_factory.h"\n',
        },
        "",
    ),
    "of-nothing": ({"package.xml": PACKAGE.format("<depend>rclcpp</depend>")}, None),
}


@pytest.mark.parametrize("case", PACKAGES)
@pytest.mark.parametrize("old", [True, False], ids=["old-words", "no-words"])
def test_init_takes_the_version_that_packages_depend_on(tmp_path: Path, case: str, old: bool) -> None:
    files, engine = PACKAGES[case]
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    (tmp_path / "t.xml").write_text(tree(MAIN, *([PLUS] if old else ())))
    assert run_btq("init", "--from-xml", cwd=tmp_path)[0] == 0
    is_3 = old if engine is None else engine == "3.8"
    line = (tmp_path / "btq.toml").read_text().splitlines()[1]
    why = (
        "the packages depend on behaviortree_cpp_v3"
        if engine
        else "the XML is written for version 3 of BehaviorTree.CPP"
    )
    assert line == (
        f'engine = "3.8"  # {why}' if is_3 else f"{ALL.strip()}  # the versions of BehaviorTree.CPP that must load them"
    )


def test_the_package_that_a_folder_is_in_counts_too(tmp_path: Path) -> None:
    (tmp_path / "package.xml").write_text(PACKAGE.format("<depend>behaviortree_cpp_v3</depend>"))
    (tmp_path / "trees").mkdir()
    (tmp_path / "trees" / "t.xml").write_text(tree(MAIN))
    assert run_btq("init", "--from-xml", "trees", cwd=tmp_path)[0] == 0
    assert (
        '\nengine = "3.8"  # the packages depend on behaviortree_cpp_v3\n' in (tmp_path / "trees/btq.toml").read_text()
    )


@pytest.mark.parametrize(("package", "argument"), [("behaviortree_cpp_v3", "{map}"), ("behaviortree_cpp", '"map"')])
def test_what_is_converted_is_read_as_the_packages_do(tmp_path: Path, package: str, argument: str) -> None:
    (tmp_path / "package.xml").write_text(PACKAGE.format(f"<depend>{package}</depend>"))
    (tmp_path / "t.xml").write_text(tree(MAIN))
    assert run_btq("init", "--from-xml", "--convert", cwd=tmp_path)[0] == 0
    assert f"(frame = {argument})" in (tmp_path / "t.btq").read_text()
    assert (tmp_path / "btq.toml").read_text().splitlines()[1].startswith(ALL.strip())


def test_init_proposes_sources_and_parameters(tmp_path: Path) -> None:
    pytest.importorskip("tree_sitter_cpp", reason="the C++ grammar is not installed: pip install -e '.[cpp]'")
    (tmp_path / "src").mkdir()
    (tmp_path / "src" / "nodes.cpp").write_text('void f(F& x) { x.registerNodeType<Dock>("Dock"); }\n')
    (tmp_path / "src" / "main.cpp").write_text("int main() {}\n")
    (tmp_path / "config").mkdir()
    (tmp_path / "config" / "nav.yaml").write_text("bt_navigator:\n  ros__parameters:\n    use_sim_time: true\n")
    (tmp_path / "config" / "other.yaml").write_text("controller_server: {}\n")
    (tmp_path / "t.xml").write_text('<root BTCPP_format="4"><BehaviorTree ID="Main"><Dock/></BehaviorTree></root>\n')
    heading = "# [[factory]]  # what bt_navigator loads; name its distribution in `nodes` first"
    navigator = ["", heading, '# name = "navigator"', '# nav2 = "config/nav.yaml"']
    assert lines_of_init(tmp_path) == ['nodes = ["src/*.cpp"]  # C++ that registers nodes', *navigator]
    (tmp_path / "src" / "nodes.cpp").write_text("// registerNodeType is called elsewhere\n")
    where = "also pass the files that call BT_REGISTER_NODES, registerNodeType, registerBuilder or CreateRosNodePlugin"
    why = f"no node is registered in 2 C++ files; {where}"
    proposed = f'# nodes = ["src/*.cpp"]  # C++ that registers nodes; {why}'
    assert lines_of_init(tmp_path) == [proposed, *navigator]


def test_init_says_what_is_unknown_with_sources(tmp_path: Path) -> None:
    pytest.importorskip("tree_sitter_cpp", reason="the C++ grammar is not installed: pip install -e '.[cpp]'")
    (tmp_path / "n.cpp").write_text(
        'void f(F& x) { x.registerSimpleAction("Dock", d); x.registerSimpleAction("Undock", d); }\n'
    )
    xml = '<root BTCPP_format="4"><BehaviorTree ID="Main"><Sequence><Dock/>{}</Sequence></BehaviorTree></root>\n'
    (tmp_path / "t.xml").write_text(xml.format("<Dokc/><Undock/>"))
    lines = ['nodes = ["*.cpp"]  # C++ that registers nodes']
    assert lines_of_init(tmp_path) == lines
    (tmp_path / "btq.toml").unlink()
    wrote, after = "Wrote btq.toml with no factories.", "Next: btq check .\n"
    one = f"{wrote} With its nodes btq finds 1 problem in the trees. {after}"
    assert run_btq("init", "--from-xml", cwd=tmp_path)[:2] == (0, one)
    _, out, _ = run_btq("check", "--output-format", "concise", cwd=tmp_path)
    assert out.splitlines()[0].endswith("warning[unknown-node] unknown node `Dokc`; did you mean `Dock`?")
    (tmp_path / "btq.toml").unlink()
    (tmp_path / "t.xml").write_text(xml.format("<Dock/><Undock/>"))
    assert run_btq("init", "--from-xml", cwd=tmp_path)[:2] == (0, f"{wrote} {after}")


def test_init_proposes_all_nodes_in_one_line(tmp_path: Path) -> None:
    """Without the distribution, Nav2's nodes are unknown beside those of C++."""
    pytest.importorskip("tree_sitter_cpp", reason="the C++ grammar is not installed: pip install -e '.[cpp]'")
    (tmp_path / "n.cpp").write_text(
        'void f(F& x) { x.registerSimpleAction("Dock", d); x.registerSimpleAction("Undock", d); }\n'
    )
    nodes = "<Sequence><Dock/><Undock/><FollowPath path='{p}' goal_checker_id='a'/></Sequence>"
    (tmp_path / "t.xml").write_text(f'<root BTCPP_format="4"><BehaviorTree ID="M">{nodes}</BehaviorTree></root>\n')
    assert lines_of_init(tmp_path) == [
        '# nodes = ["nav2-DISTRIBUTION", "*.cpp"]',
        "#     the trees use nodes of Nav2; name yours: they fit jazzy, kilted, lyrical",
        "#     C++ that registers nodes; name the distribution first",
    ]
    (tmp_path / "p.yaml").write_text(
        "bt_navigator:\n  ros__parameters:\n    filter_duration: 0.2\n    introspection_mode: x\n"
    )
    why = "the distribution of Nav2 for which the parameters of bt_navigator are"
    assert lines_of_init(tmp_path)[0] == f'nodes = ["nav2-lyrical", "*.cpp"]  # {why}'
    (tmp_path / "n.cpp").write_text("// registerNodeType is called elsewhere\n")
    unknown = "nav2-lyrical does not fit, with it btq finds in t.xml: unknown node `Dock`"
    assert lines_of_init(tmp_path)[:3] == [
        '# nodes = ["nav2-DISTRIBUTION", "*.cpp"]',
        f"#     the trees use nodes of Nav2; name yours: {unknown}",
        "#     C++ that registers nodes; name the distribution first",
    ]
    (tmp_path / "t.xml").write_text((tmp_path / "t.xml").read_text().replace("<Dock/><Undock/>", ""))
    lines = lines_of_init(tmp_path)
    assert lines[0] == f'nodes = ["nav2-lyrical"]  # {why}'
    assert lines[1].startswith('# "*.cpp" may be added: C++ that registers nodes; no node is registered in 1 C++ file;')


PARAMETERS = "bt_navigator:\n  ros__parameters:\n    introspection_mode: x\n    bt_log_idle_transitions: true\n"


def test_init_writes_a_factory_for_each_parameter_file(tmp_path: Path) -> None:
    """For Lyrical, as they tell; programs name trees, perhaps for goals."""
    pytest.importorskip("yaml", reason="PyYAML is not installed: pip install -e '.[nav2]'")
    (tmp_path / "t.xml").write_text('<root BTCPP_format="4"><BehaviorTree ID="M"><Wait/></BehaviorTree></root>\n')
    (tmp_path / "u.xml").write_text('<root BTCPP_format="4"><BehaviorTree ID="N"><Wait/></BehaviorTree></root>\n')
    (tmp_path / "a.yaml").write_text(PARAMETERS)
    (tmp_path / "b.yaml").write_text(PARAMETERS)
    (tmp_path / "go.py").write_text("goal.behavior_tree = share + '/u.xml'\n")
    load = '# load = ["u.xml"]  # Python or a launch file names them: keep what is for goals'
    table = "", "[[factory]]  # what bt_navigator loads"
    assert lines_of_init(tmp_path) == [
        *(*table, 'name = "navigator"', 'nav2 = "a.yaml"', load),
        *(*table, 'name = "navigator2"', 'nav2 = "b.yaml"', load),
    ]
    assert run_btq("check", cwd=tmp_path)[0] < 2
    text = (tmp_path / "btq.toml").read_text()
    (tmp_path / "btq.toml").write_text(text.replace("# load", "load"))
    assert run_btq("check", cwd=tmp_path)[0] < 2
    (tmp_path / "package.xml").write_text(PACKAGE.format("<depend>behaviortree_cpp_v3</depend>"))
    assert lines_of_init(tmp_path)[1] == f"# {table[1]}; name its distribution in `nodes` first"


def lines_of_init(folder: Path) -> list[str]:
    """What a new project file has after its heading and the engine."""
    (folder / "btq.toml").unlink(missing_ok=True)
    assert run_btq("init", "--from-xml", cwd=folder)[0] == 0
    return [line for line in (folder / "btq.toml").read_text().splitlines()[1:] if not line.startswith("engine")]


def test_init_names_sources_beside_the_distribution_of_the_parameters(tmp_path: Path) -> None:
    pytest.importorskip("tree_sitter_cpp", reason="the C++ grammar is not installed: pip install -e '.[cpp]'")
    for folder in ("src/a", "src/b", "test", "config"):
        (tmp_path / folder).mkdir(parents=True)
    (tmp_path / "src/a/one.cpp").write_text('void f(F& x) { x.registerNodeType<Dock>("Dock"); }\n')
    (tmp_path / "src/b/two.cpp").write_text("PortsList Dock::providedPorts() { return {}; }\n")
    (tmp_path / "test/mock.cpp").write_text('void f(F& x) { x.registerNodeType<Mock>("Mock"); }\n')
    parameters = "bt_navigator:\n  ros__parameters:\n    error_code_name_prefixes: [a]\n    introspection_mode: x\n"
    (tmp_path / "config/nav.yaml").write_text(parameters)
    nodes = '<FollowPath path="{p}"/>'
    (tmp_path / "t.xml").write_text(f'<root BTCPP_format="4"><BehaviorTree ID="M">{nodes}</BehaviorTree></root>\n')
    why = "the distribution of Nav2 for which the parameters of bt_navigator are"
    assert lines_of_init(tmp_path) == [
        f'nodes = ["nav2-lyrical", "src/**/*.cpp"]  # {why}',
        *("", "[[factory]]  # what bt_navigator loads", 'name = "navigator"', 'nav2 = "config/nav.yaml"'),
    ]
