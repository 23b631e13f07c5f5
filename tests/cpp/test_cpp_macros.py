"""Nodes that are registered by macros of a project, expanded from the sources that are read."""

from __future__ import annotations

from pathlib import Path
from shutil import copytree
from textwrap import dedent

import pytest
from in_process import run_btq
from test_cpp_nodes import ports, unseen

from btq_lang.cpp.model import CppNodes
from btq_lang.cpp.nodes import read_nodes

pytest.importorskip("tree_sitter_cpp", reason="the C++ grammar is not installed: pip install -e '.[cpp]'")

CLASSES = """
namespace robot {
struct Dock : BT::SyncActionNode { static PortsList providedPorts() { return { InputPort<int>("bay") }; } };
struct IsDocked : BT::ConditionNode { static PortsList providedPorts() { return {}; } };
}
"""


def read(*texts: str) -> CppNodes:
    """The nodes of some headers and of the source after them: a.hpp, b.hpp, c.cpp and so on."""
    names = (*(f"{name}.hpp" for name in "abcde"[: len(texts) - 1]), f"{'abcdef'[len(texts) - 1]}.cpp")
    return read_nodes({name: dedent(text) for name, text in zip(names, texts, strict=True)})


def test_btq_nodes_of_the_shared_file(shared: Path, tmp_path: Path) -> None:
    if not (shared / "field" / "nav2" / "macro").is_dir():
        pytest.skip("the shared inputs have no field/nav2/macro")
    copytree(shared / "field" / "nav2" / "macro", tmp_path, dirs_exist_ok=True)
    code, out, err = run_btq("nodes", ".", cwd=tmp_path)
    assert (code, out.splitlines()[2:], err) == (
        0,
        ["TreeNodesModel", "    Action AlignYaw", "        input kp : double"],
        "1 node with 1 port in 1 file\n",
    )


@pytest.mark.parametrize(
    ("macros", "where"),
    [
        (
            "#define REG(t) f.registerNodeType<t>(#t)",
            "the macro `REG` in n.hpp registers its argument: also pass the files that use it",
        ),
        (
            "#ifndef REG\n#define REG(t) \\\n  f.registerBuilder<t>(#t)\n#endif\n#undef REG\n#define ALSO(t) REG(t)",
            "the macro `REG` in n.hpp registers its argument: also pass the files that use it",
        ),
        (
            "#define TWICE(x) x x",
            "also pass the files that call BT_REGISTER_NODES, registerNodeType, registerBuilder or CreateRosNodePlugin",
        ),
    ],
)
def test_a_macro_that_nothing_uses(tmp_path: Path, macros: str, where: str) -> None:
    (tmp_path / "n.hpp").write_text(f"{macros}\n{CLASSES}")
    message = f"no node is registered in 1 C++ file; {where}"
    code, _, err = run_btq("nodes", ".", cwd=tmp_path)
    assert (code, err) == (1, f"btq nodes: {message}\n0 nodes with 0 ports in 1 file\n")
    (tmp_path / "btq.toml").write_text('nodes = ["*.hpp"]\n')
    (tmp_path / "m.btq").write_text("BehaviorTree Main\n    Dock\n")
    code, _, err = run_btq("check", cwd=tmp_path)
    assert (code, err) == (2, f"btq: btq.toml:1:10: {message}\n")


@pytest.mark.parametrize(
    ("macro", "use"),
    [
        (r"#define REG(name) factory.registerNodeType<robot::name>(#name)", "void f() { REG(Dock); REG(IsDocked); }"),
        (
            "#define REG(type, id) \\\n  do { \\\n    factory.registerNodeType<type>(id); /* so */ \\\n  } while (0)",
            'void f() {\n  REG(robot::Dock, "Dock");\n  REG(\n    robot::IsDocked,\n    "IsDocked");\n}',
        ),
        (
            "#define REG(ns, name) static void add_##ns##name(F& f) { f.registerNodeType<ns::name>(#name); }",
            "REG(robot, Dock)\nREG(robot, IsDocked)",
        ),
        (
            "#define NAME(type) #type\n#define ADD(f, type) f.registerNodeType<robot::type>(NAME(type))\n"
            "#define REG(type) ADD(factory, type)",
            "void f() { REG(Dock); REG(IsDocked); }",
        ),
        (
            "#define NODES(X) \\\n  X(Dock) \\\n  X(IsDocked)\n"
            "#define REG(type) f.registerNodeType<robot::type>(#type);",
            "void add(F& f) { NODES(REG) }",
        ),
        (
            "#define ALL REG(Dock) REG(IsDocked)\n#define REG(t) f.registerNodeType<robot::t>(#t);",
            "void a(F& f) { ALL }",
        ),
        (
            "#define REG(type, ...) factory.registerNodeType<type>(__VA_ARGS__)",
            'void f() { REG(robot::Dock, "Dock", 1); REG(robot::IsDocked, "IsDocked"); }',
        ),
        (
            "#define REG(type, id, args...) factory.registerNodeType<type>(id, ##args)",
            'void f() { REG(robot::Dock, "Dock"); REG(robot::IsDocked, "IsDocked", 42); }',
        ),
        (
            "#define REG(type) BT_REGISTER_NODES(factory) { factory.registerNodeType<robot::type>(#type); }",
            "REG(Dock)\nREG(IsDocked)",
        ),
        (
            "#define REG(type) factory.registerBuilder<robot::type>(# type, [](auto& n, auto& c) "
            "{ return std::make_unique<robot::type>(n, c); })",
            "void f() { REG(Dock); REG(IsDocked); }",
        ),
        (
            "#ifdef STATIC\n#define REG(type)\n#else\n#define REG(t) factory.registerNodeType<robot::t>(#t)\n#endif",
            "void f() { REG(Dock); REG(IsDocked); }",
        ),
        (
            "#define ID(x) #x\n#define REG(t) factory.registerNodeType<robot::t>(#t);\n"
            "void f() { REG(Dock) }\n#undef REG\n#define REG(t) factory.registerNodeType<t>(ID(IsDocked));",
            "void g() { REG(robot::IsDocked) }",
        ),
        (
            "#define REG(type) ROBOT_EXPORT void add_##type(F& f) { f.registerNodeType<robot::type>(#type); }",
            "REG(Dock);\nREG(IsDocked);",
        ),
        (
            "#define register_node(type) g.registerNodeType<robot::type>(#type)",
            "void f() { register_node(Dock); if (a) register_node(IsDocked); } // register_node(No)\n"
            'auto s = "register_node(No)";',
        ),
    ],
)
@pytest.mark.parametrize("is_in_header", [False, True])
def test_a_macro_that_registers_is_expanded(macro: str, use: str, is_in_header: bool) -> None:
    texts = (macro, CLASSES + use) if is_in_header else (f"{CLASSES}\n{macro}\n{use}\n",)
    found = read(*texts)
    assert unseen(found) == []
    assert [(node.category, node.name, node.class_name, ports(node)) for node in found.nodes] == [
        ("Action", "Dock", "robot::Dock", ["input bay : int"]),
        ("Condition", "IsDocked", "robot::IsDocked", []),
    ]


def test_a_macro_may_define_classes_and_ports() -> None:
    found = read(
        """
        #define PORT(type, name) BT::InputPort<type>(#name, "of the robot")
        #define NODE(name) \\
          class name : public BT::SyncActionNode \\
          { \\
           public: \\
            using BT::SyncActionNode::SyncActionNode; \\
            static BT::PortsList providedPorts() { return { PORT(double, speed), PORT(Pose, goal) }; } \\
          };
        NODE(Go)
        BT_REGISTER_NODES(factory) { factory.registerNodeType<Go>("Go"); }
        """
    )
    assert unseen(found) == []
    assert [ports(node) for node in found.nodes] == [
        ["input speed : double # of the robot", "input goal : Pose # of the robot"]
    ]


def test_places_are_those_of_the_use() -> None:
    found = read(
        f"""{CLASSES}
        #define REG(type, id) f.registerNodeType<robot::type>(id)
        void f() {{ /* ü */ REG(Dock, "A"); REG(Dock, "B"); f.registerNodeType<robot::Dock>("C");
          REG(Dock,
              "D"); f.registerNodeType<robot::Dock>("E"); }}
        """
    )
    lines = [(node.name, node.place.line, node.place.column, node.place.end_column) for node in found.nodes]
    assert lines == [("A", 8, 29, 43), ("B", 8, 45, 59), ("C", 8, 61, 97), ("D", 9, 11, 19), ("E", 10, 21, 57)]
    assert [(node.place.end_line) for node in found.nodes] == [8, 8, 8, 10, 10]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "#define REG(type, id) f.registerNodeType<type>(id)\nvoid f() { REG(robot::Dock); }",
            "7:12: `REG` takes 2 arguments, and is given 1; it cannot be expanded",
        ),
        (
            '#define REG(type, id) f.registerNodeType<type>(prefix + id)\n\nvoid f() { REG(robot::Dock, "Dock"); }',
            '8:12: the name of this node is an expression: `prefix + "Dock"`',
        ),
        (
            "REGISTER_NODE(Dock)\nREGISTER_NODE(Other)\nRCLCPP_COMPONENTS_REGISTER_NODE(Other)",
            "6:1: it cannot be seen under which ID `REGISTER_NODE` registers `robot::Dock`; "
            "name the file that defines it, too, or declare the node in a model",
        ),
        (
            "#define BT_EXPORT(name) Registry::get().add(#name, make<name>)\nvoid f() { BT_EXPORT(robot::Dock); }",
            "7:12: it cannot be seen under which ID `BT_EXPORT` registers `robot::Dock`; "
            "name the file that defines it, too, or declare the node in a model",
        ),
        (
            'RegisterRosNode(robot::Dock, "Dock");\nregisterTool("Dock");',
            "6:1: it cannot be seen under which ID `RegisterRosNode` registers `robot::Dock`; "
            "name the file that defines it, too, or declare the node in a model",
        ),
        (
            "#define REG(x) REG(x); f.registerNodeType<Lost>(#x)\nvoid f() { REG(Dock); }",
            "7:12: the class `Lost` of the node `Dock` is not in the sources",
        ),
    ],
)
def test_what_cannot_be_expanded_is_told(text: str, message: str) -> None:
    found = read(CLASSES + text)
    assert found.nodes == ()
    assert unseen(found) == [f"a.cpp:{message}"]
    assert all(each.hides_node for each in found.unseen)


def test_a_macro_that_two_headers_define_otherwise_is_told() -> None:
    define = "#define REG(t) f.registerNodeType<robot::t>({})\n"
    use = CLASSES + "void f() { REG(Dock); }\n"
    found = read(define.format("#t"), define.format('"my_" #t'), use)
    assert unseen(found) == [
        "c.cpp:6:12: `REG` may be any of several macros: a.hpp:1, b.hpp:1; include the file that defines it"
    ]
    assert [node.name for node in read(define.format("#t"), define.format("#t"), use).nodes] == ["Dock"]
    assert [node.name for node in read(define.format("#t"), define.format('"my_" #t') + use).nodes] == ["my_Dock"]
    including = read(define.format("#t"), define.format('"my_" #t'), f'#include "b.hpp"\n{use}')
    assert [node.name for node in including.nodes] == ["my_Dock"]


def test_a_macro_whose_class_is_registered_otherwise_hides_nothing() -> None:
    text = 'REGISTER_FOR_DOCUMENTATION(Dock)\nvoid f() { f.registerNodeType<robot::Dock>("Dock"); }'
    assert unseen(read(CLASSES + text)) == []


def test_a_macro_of_a_source_file_is_none_of_another_file() -> None:
    define = "#define add(f, type) f.registerNodeType<robot::type>(#type)\n"
    use = 'void g() { list.add(1); list.add(Dock, "x"); f.registerNodeType<robot::Dock>("Dock"); }\n'
    found = read_nodes({"a.cpp": define, "b.cpp": CLASSES + use})
    assert ([node.name for node in found.nodes], unseen(found)) == (["Dock"], [])
    of_header = read_nodes({"a.hpp": define, "b.cpp": f'#include "a.hpp"\n{CLASSES}void g() {{ add(f, Dock); }}\n'})
    assert ([node.name for node in of_header.nodes], unseen(of_header)) == (["Dock"], [])


def test_a_macro_that_has_nothing_to_do_with_nodes_is_no_finding() -> None:
    text = "#define APPLY(f, x) f(x)\nvoid g() { APPLY(h); }\n" + CLASSES
    assert unseen(read(text)) == []
