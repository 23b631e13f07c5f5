"""Nodes that small C++ sources register, in every form that the reader knows, and in those that it must not guess."""

from __future__ import annotations

from textwrap import dedent

import pytest

from btq_lang.catalog.nav2 import DISTRIBUTIONS
from btq_lang.cpp.model import CppNode, CppNodes
from btq_lang.cpp.nodes import read_nodes

pytest.importorskip("tree_sitter_cpp", reason="the C++ grammar is not installed: pip install -e '.[cpp]'")

REGISTERED = """
    BT_REGISTER_NODES(factory)
    {
      factory.registerNodeType<robot::Move>("Move");
    }
"""


def read(*texts: str) -> CppNodes:
    """The nodes of some files: a.cpp, b.cpp and so on."""
    return read_nodes({f"{name}.cpp": dedent(text) for name, text in zip("abcdef", texts, strict=False)})


def ports(node: CppNode) -> list[str]:
    """The ports of a node, each as `input goal : Pose = default "text"`."""
    return [
        f"{port.direction} {port.name}"
        + (f" : {port.type}" if port.type else "")
        + (f" = {port.default!r}" if port.default is not None else "")
        + (f" # {port.text}" if port.text else "")
        for port in node.ports
    ]


def move(body: str, bases: str = "BT::SyncActionNode", more: str = "") -> str:
    """A class `robot::Move` with a body, and its registration."""
    inside = dedent(body)
    return (
        f"namespace robot {{\n{dedent(more)}\nclass Move : public {bases}\n{{\n{inside}\n}};\n}}\n{dedent(REGISTERED)}"
    )


def moved(body: str, bases: str = "BT::SyncActionNode", more: str = "") -> CppNode:
    """The node of such a class, of which everything is seen."""
    found = read(move(body, bases, more))
    assert found.unseen == ()
    (node,) = found.nodes
    return node


def provided(returned: str, more: str = "", bases: str = "BT::SyncActionNode") -> list[str]:
    """The ports of a class whose `providedPorts` returns an expression."""
    return ports(moved(f"public: static BT::PortsList providedPorts() {{ {returned} }}", bases, more))


def unseen(found: CppNodes) -> list[str]:
    return [f"{each.place}: {each.message}" for each in found.unseen]


def test_ports_with_direction_type_default_and_description() -> None:
    assert provided(
        """return {
             BT::InputPort<geometry_msgs::msg::PoseStamped>("goal", "where to go"),
             BT::InputPort<double>("speed", 0.5, "metres"  // a comment
               " a second"),
             BT::OutputPort<std::vector< int >>("codes"),
             BT::BidirectionalPort("item"),
           };"""
    ) == [
        "input goal : geometry_msgs::msg::PoseStamped # where to go",
        "input speed : double = '0.5' # metres a second",
        "output codes : std::vector<int>",
        "inout item",
    ]


def test_the_second_of_two_arguments_is_a_description_and_no_default() -> None:
    assert provided('return { BT::InputPort<std::string>("controller_id", "FollowPath") };') == [
        "input controller_id : std::string # FollowPath"
    ]


@pytest.mark.parametrize(
    ("written", "default"),
    [
        ('""', ""),
        ('"a\\"b"', 'a"b'),
        ('std::string("map")', "map"),
        ("std::string()", ""),
        ('std::string{"map"}', "map"),
        ('"map"s', "map"),
        ('R"(json:{"x":1})"', 'json:{"x":1}'),
        ('"{=}"', "{=}"),
        ("true", "true"),
        ("-1", "-1"),
        ("1.5f", "1.5"),
        ("253u", "253"),
        ("1'000", "1000"),
        ("1000ms", "1000"),
        ("std::numeric_limits<double>::infinity()", "inf"),
        ("BT::NodeStatus::SUCCESS", "SUCCESS"),
    ],
)
def test_a_default_is_read(written: str, default: str) -> None:
    node = moved(f'static BT::PortsList providedPorts() {{ return {{ BT::InputPort<T>("p", {written}, "") }}; }}')
    (port,) = node.ports
    assert (port.default, port.written) == (default, written)


def test_a_default_that_is_an_expression_is_reported() -> None:
    text = move('static BT::PortsList providedPorts() { return { BT::InputPort<P>("p", P{1,  2}, "") }; }')
    found = read(text)
    assert [(port.default, port.written) for node in found.nodes for port in node.ports] == [("", "P{1, 2}")]
    assert unseen(found) == ["a.cpp:5:49: the default of the port `p` is an expression: `P{1, 2}`"]


@pytest.mark.parametrize(
    "returned",
    [
        'return BT::PortsList({ BT::InputPort<int>("a"), BT::InputPort<int>("b") });',
        'return BT::PortsList{ BT::InputPort<int>("a"), BT::InputPort<int>("b") };',
        'BT::PortsList list = { BT::InputPort<int>("a"), BT::InputPort<int>("b") }; return list;',
        'PortsList list; list.insert(BT::InputPort<int>("a")); list.emplace(BT::InputPort<int>("b")); return list;',
        'PortsList list{ BT::InputPort<int>("a") }; list.insert({ BT::InputPort<int>("b") }); return list;',
        'PortsList one = { BT::InputPort<int>("a") }; PortsList list = { BT::InputPort<int>("b") };'
        " one.insert(list.begin(), list.end()); return one;",
        'auto one = PortsList({ BT::InputPort<int>("a") }); PortsList list = { BT::InputPort<int>("b") };'
        " one.merge(std::move(list)); return one;",
        'PortsList one = { BT::InputPort<int>("a") }; const PortsList list = { BT::InputPort<int>("b") };'
        " for (const auto& port : list) { one.insert(port); } return one;",
        'PortsList list = { BT::InputPort<int>("a"), BT::InputPort<int>("b"), BT::InputPort<int>("c") };'
        ' list.erase("c"); return list;',
        'const char* name = "a";'
        ' return { BT::InputPort<int>(name), BT::CreatePort<int>(BT::PortDirection::INPUT, "b") };',
    ],
)
def test_ports_are_read_from_every_way_to_make_a_list(returned: str) -> None:
    assert provided(returned) == ["input a : int", "input b : int"]


def test_the_name_of_a_port_may_be_a_constant() -> None:
    more = """
        #define NAME_A "a"
        constexpr auto kB = "b";
        struct Names { static constexpr const char* C = "c"; };
        static const std::string D{"d"};
    """
    returned = (
        "return { BT::InputPort<int>(NAME_A), BT::InputPort<int>(kB), BT::InputPort<int>(Names::C),"
        " BT::InputPort<int>(D) };"
    )
    assert provided(returned, more) == [f"input {name} : int" for name in "abcd"]


BASE = """
    template <class ActionT>
    class BtActionNode : public BT::ActionNodeBase
    {
    public:
      static BT::PortsList providedBasicPorts(BT::PortsList addition)
      {
        BT::PortsList basic = {
          BT::InputPort<std::string>("server_name", "Action server name"),
          BT::OutputPort<ActionT>("result")
        };
        basic.insert(addition.begin(), addition.end());
        return basic;
      }
      static BT::PortsList providedPorts() { return providedBasicPorts({}); }
    };
"""


def test_a_helper_of_a_base_class_adds_ports_and_its_entry_wins_a_clash_of_names() -> None:
    returned = (
        "BT::RegisterJsonDefinition<Pose>();"
        ' return providedBasicPorts({ BT::InputPort<int>("server_name", 3, "clash"), BT::InputPort<int>("order") });'
    )
    assert provided(returned, BASE, "BtActionNode<msgs::Fibonacci>") == [
        "input server_name : std::string # Action server name",
        "output result : msgs::Fibonacci",
        "input order : int",
    ]


def test_a_class_without_ports_of_its_own_has_those_of_its_base() -> None:
    node = moved("", "BtActionNode<std::vector<int>>", BASE)
    assert ports(node) == ["input server_name : std::string # Action server name", "output result : std::vector<int>"]


def test_ports_of_a_base_are_named_by_its_function() -> None:
    more = 'struct Base : BT::ConditionNode { static PortsList providedPorts() { return { InputPort<int>("a") }; } };'
    returned = 'PortsList list = Base::providedPorts(); list.insert(BT::OutputPort<int>("b")); return list;'
    node = moved(f"static PortsList providedPorts() {{ {returned} }}", "Base", more)
    assert (node.category, ports(node)) == ("Condition", ["input a : int", "output b : int"])


BASES = """
    struct Base : BT::SyncActionNode {
      static PortsList providedPorts() { return { InputPort<int>("a") }; }
    };
    PortsList joined(const PortsList& one, const PortsList& other) {
      PortsList all;
      for (const auto& port : one) all.insert(port);
      for (const auto& port : other) all.insert(port);
      return all;
    }
    auto made() -> BT::PortsList { return { BT::InputPort<int>("b") }; }
    void add(BT::PortsList& ports) { ports.insert(BT::InputPort<int>("b")); }
    using List = BT::PortsList;
    const List kList = { BT::InputPort<int>("a"), BT::InputPort<int>("b") };
    const auto kB = BT::InputPort<int>("b");
"""


@pytest.mark.parametrize(
    "statements",
    [
        'auto ports = Base::providedPorts(); ports.insert(BT::InputPort<int>("b"));',
        'auto ports = Base::providedPorts(); ports.insert({ BT::InputPort<int>("b") });',
        'auto ports = Base::providedPorts(); ports.merge(BT::PortsList{ BT::InputPort<int>("b") });',
        'auto ports = Base::providedPorts(); ports["b"] = BT::InputPort<int>("b").second;',
        'auto ports = Base::providedPorts(); ports.emplace("b", BT::InputPort<int>("").second);',
        'auto ports = Base::providedPorts(); ports.insert_or_assign("b", BT::InputPort<int>("").second);',
        'auto ports = Base::providedPorts(); ports.insert(std::make_pair("b", BT::InputPort<int>("").second));',
        'auto ports = Super::providedPorts(); ports.reserve(2); { ports.insert(BT::InputPort<int>("b")); }',
        "auto ports = Base::providedPorts(); ports.insert(kB);",
        "auto ports = Base::providedPorts(); add(ports);",
        "auto ports = Base::providedPorts(); auto own = made();"
        " std::copy(own.begin(), own.end(), std::inserter(ports, ports.end()));",
        "auto ports = Base::providedPorts(); std::ranges::copy(made(), std::inserter(ports, ports.end()));",
        "auto ports = Base::providedPorts(); auto own = made(); ports.insert(std::begin(own), std::end(own));",
        'auto ports = Base::providedPorts(); for (auto port : { BT::InputPort<int>("b") }) ports.insert(port);',
        "List ports = Base::providedPorts(); for (const auto& [name, port] : made()) { ports[name] = port; }",
        'BT::PortsList ports(Base::providedPorts()); ports.insert(BT::InputPort<int>("b"));',
        "std::unordered_map<std::string, BT::PortInfo> ports = Base::providedPorts(); ports.insert(kB);",
        'return joined(Base::providedPorts(), { BT::InputPort<int>("b") });',
        "static const BT::PortsList ports = [] { auto all = Base::providedPorts(); all.insert(kB); return all; }();",
        "return kList;",
        "return Move::kOwn;",
    ],
)
def test_a_list_is_joined_with_that_of_a_base_class(statements: str) -> None:
    body = f"""
        using Super = Base;
        inline static const BT::PortsList kOwn = {{ BT::InputPort<int>("a"), BT::InputPort<int>("b") }};
        static BT::PortsList providedPorts() {{ {statements} return ports; }}
    """
    assert ports(moved(body, "Base", BASES)) == ["input a : int", "input b : int"]


def test_what_is_no_list_is_not_taken_for_one() -> None:
    found = read(
        """
        auto makeNode() { return std::make_shared<Node>(); }
        struct A : BT::SyncActionNode { static PortsList providedPorts() { return {}; } };
        void f() {
          auto node = makeNode();
          static const auto done = [] { return true; }();
          registerNodeType<A>("A", node);
        }
        """
    )
    assert (unseen(found), [node.complete for node in found.nodes]) == ([], [True])


def test_an_alias_stands_for_its_type() -> None:
    body = """
        typedef std::vector<Pose> Goals;
        static BT::PortsList providedPorts() { return { BT::InputPort<Goals>("goals") }; }
    """
    assert ports(moved(body)) == ["input goals : std::vector<Pose>"]


@pytest.mark.parametrize(
    ("base", "category"),
    [
        ("BT::SyncActionNode", "Action"),
        ("BT::StatefulActionNode", "Action"),
        ("BT::ConditionNode", "Condition"),
        ("BT::ControlNode", "Control"),
        ("BT::ReactiveSequence", "Control"),
        ("BT::DecoratorNode", "Decorator"),
        ("ns::Mixed<BT::ThreadedAction>", "Action"),
    ],
)
def test_the_category_is_that_of_the_base_class(base: str, category: str) -> None:
    body = "static BT::PortsList providedPorts() { return {}; }"
    assert moved(body, base).category == category


@pytest.mark.parametrize(
    ("base", "category", "port"),
    [
        ("RosActionNode", "Action", "action_name"),
        ("RosServiceNode", "Action", "service_name"),
        ("RosTopicPubNode", "Condition", "topic_name"),
        ("RosTopicSubNode", "Condition", "topic_name"),
    ],
)
@pytest.mark.parametrize("scope", ["", "Base::"])
def test_a_base_class_of_behaviortree_ros2_adds_its_port(base: str, category: str, port: str, scope: str) -> None:
    body = f"""
        using Base = BT::{base}<M>;
        static PortsList providedPorts() {{ return {scope}providedBasicPorts({{ InputPort<int>("a") }}); }}
    """
    node = moved(body, f"BT::{base}<M>")
    assert (node.category, [each.name for each in node.ports], node.complete) == (category, [port, "a"], True)
    assert (node.ports[0].type, node.ports[0].default) == ("std::string", "")
    assert [each.name for each in moved("", f"BT::{base}<M>").ports] == [port]


TIMEOUT = "input server_timeout : std::chrono::milliseconds = ''"
SERVER = ["input server_name : std::string = '' # Action server name", TIMEOUT]
ERRORS = [
    "output error_code_id : uint16_t # The action error code",
    "output error_msg : std::string # The action error message",
]


@pytest.mark.parametrize(
    ("base", "distributions", "of_base"),
    [
        ("BtActionNode", ("humble",), SERVER),
        ("BtActionNode", ("iron", "jazzy", "kilted"), SERVER),
        ("BtActionNode", ("lyrical",), [*SERVER, *ERRORS]),
        ("BtCancelActionNode", DISTRIBUTIONS, SERVER),
        (
            "BtServiceNode",
            DISTRIBUTIONS,
            ["input service_name : std::string = '' # please_set_service_name_in_BT_Node", TIMEOUT],
        ),
    ],
)
def test_a_base_class_of_nav2_adds_the_ports_of_its_distribution(
    base: str, distributions: tuple[str, ...], of_base: list[str]
) -> None:
    body = """
        using Base = nav2_behavior_tree::{0}<M>;
        static PortsList providedPorts() {{ return {1}providedBasicPorts({{ InputPort<int>("a") }}); }}
    """
    of_nav2 = f"nav2_behavior_tree::{base}"
    for text, own in (
        (move(body.format(base, ""), f"{of_nav2}<M>"), ["input a : int"]),
        (move(body.format(base, "Base::"), f"{of_nav2}<M>"), ["input a : int"]),
        (move(body.format(base, f"{of_nav2}<M>::"), f"{base}<M>"), ["input a : int"]),
        (move("", f"{of_nav2}<M>"), []),
    ):
        found = read_nodes({"a.cpp": text}, distributions)
        assert found.unseen == ()
        assert [(node.category, ports(node), node.complete) for node in found.nodes] == [
            ("Action", of_base + own, True)
        ]


def test_ports_that_a_base_class_of_nav2_has_in_some_distributions_are_unseen() -> None:
    found = read(move("", "nav2_behavior_tree::BtActionNode<M>"))
    assert [(ports(node), node.complete) for node in found.nodes] == [(SERVER, False)]
    assert unseen(found) == [
        "a.cpp:11:3: whether `BtActionNode` provides `error_code_id`, `error_msg` depends on the distribution; "
        'name the distribution of Nav2 in the project file: `nodes = ["nav2-jazzy", …]`'
    ]
    other = read(move("", "elsewhere::BtActionNode<M>"))
    assert unseen(other) == ["a.cpp:11:3: `elsewhere::BtActionNode` is not in the sources, and may provide ports"]


BASE_OF_NAV2 = """
}
namespace nav2_behavior_tree { template<class T> struct BtActionNode : BT::ActionNodeBase {}; }
namespace robot {
"""


@pytest.mark.parametrize(
    ("base", "above", "nav2_base"),
    [
        ("nav2_behavior_tree::BtServiceNode<M>", "", "BtServiceNode"),
        ("BtCancelActionNode<M>", "", "BtCancelActionNode"),
        ("Base", "struct Base : nav2_behavior_tree::BtActionNode<M> {};", "BtActionNode"),
        ("nav2_behavior_tree::BtActionNode<M>", BASE_OF_NAV2, "BtActionNode"),
        ("BtActionNode<M>", "template<class T> struct BtActionNode : BT::SyncActionNode {};", ""),
        ("elsewhere::BtActionNode<M>", "", ""),
        ("BT::SyncActionNode", "", ""),
    ],
)
def test_the_class_of_nav2_from_which_a_node_derives(base: str, above: str, nav2_base: str) -> None:
    assert moved("static PortsList providedPorts() { return {}; }", base, above).nav2_base == nav2_base


@pytest.mark.parametrize(
    ("base", "above", "keeps_result"),
    [
        ("BT::StatefulActionNode", "", True),
        ("StatefulActionNode", "", True),
        ("Base", "struct Base : BT::ThreadedAction {};", True),
        ("RosActionNode<A>", "", True),
        ("BtActionNode<M>", "template<class T> struct BtActionNode : BT::SyncActionNode {};", False),
        ("elsewhere::StatefulActionNode", "struct elsewhere::StatefulActionNode : BT::ActionNodeBase {};", False),
        ("BT::SyncActionNode", "", False),
        ("BT::ConditionNode", "", False),
    ],
)
def test_the_classes_whose_nodes_start_only_after_a_reset(base: str, above: str, keeps_result: bool) -> None:
    assert moved("static PortsList providedPorts() { return {}; }", base, above).keeps_result == keeps_result


@pytest.mark.parametrize(
    ("base", "tick", "at_once"),
    [
        ("BT::SyncActionNode", "return status_;", True),
        ("BT::ActionNodeBase", "if (a) { return FAILURE; } return BT::NodeStatus::SUCCESS;", True),
        ("BT::ActionNodeBase", "return (a ? BT::NodeStatus::SUCCESS : BT::NodeStatus::FAILURE);", True),
        ("BT::ActionNodeBase", "auto f = [] { return 1; }; return BT::NodeStatus::SUCCESS;", True),
        ("BT::ActionNodeBase", "if (a) { return status_; } return BT::NodeStatus::SUCCESS;", False),
        ("BT::ActionNodeBase", "return a ? BT::NodeStatus::RUNNING : BT::NodeStatus::SUCCESS;", False),
        ("BT::CoroActionNode", "setStatusRunningAndYield(); return BT::NodeStatus::SUCCESS;", False),
        ("BT::ThreadedAction", "return BT::NodeStatus::SUCCESS;", False),
        ("ns::Unseen, public BT::ActionNodeBase", "return BT::NodeStatus::SUCCESS;", False),
    ],
)
def test_what_ends_within_its_tick(base: str, tick: str, at_once: bool) -> None:
    body = f"static PortsList providedPorts() {{ return {{}}; }} BT::NodeStatus tick() {{ {tick} }}"
    assert [node.at_once for node in read(move(body, base)).nodes] == [at_once]


def test_a_tick_that_is_not_in_the_sources_may_take_longer() -> None:
    base = "struct Base : BT::ActionNodeBase { NodeStatus tick() { return NodeStatus::SUCCESS; } };"
    assert moved("", "Base", base).at_once
    assert not moved("NodeStatus tick() override;", "Base", base).at_once


def test_a_template_of_the_engine_is_a_node_without_a_class_in_the_sources() -> None:
    found = read(
        """
        void RegisterAll(BT::BehaviorTreeFactory& factory)
        {
          factory.registerNodeType<BT::LoopNode<Pose>>("LoopPose");
          factory.registerNodeType<BT::SwitchNode<2>>("Choose");
          factory.registerNodeType<BT::SwitchNode<N>>("ChooseMany");
          factory.registerNodeType<BT::Unheard<2>>("Unheard");
        }
        """
    )
    assert [(node.name, node.category, node.complete, *(port.name for port in node.ports)) for node in found.nodes] == [
        ("Choose", "Control", True, "variable", "case_1", "case_2"),
        ("LoopPose", "Decorator", True, "queue", "if_empty", "value"),
    ]
    assert [port.type for port in found.nodes[1].ports] == ["BT::AnyTypeAllowed", "BT::NodeStatus", "Pose"]
    assert unseen(found) == [
        "a.cpp:6:3: the class `BT::SwitchNode<N>` of the node `ChooseMany` is not in the sources",
        "a.cpp:7:3: the class `BT::Unheard<2>` of the node `Unheard` is not in the sources",
    ]


def test_all_ways_to_register_a_node() -> None:
    found = read(
        """
        class A : public BT::SyncActionNode { static PortsList providedPorts() { return {}; } };
        class BT_EXPORT B final : public BT::ConditionNode { static PortsList providedPorts(); };
        BT::PortsList B::providedPorts() { return { BT::InputPort<int>("b") }; }
        void RegisterAll(BT::BehaviorTreeFactory& factory)
        {
          BT::NodeBuilder builder = [](const std::string& name, const BT::NodeConfig& config) {
            return std::make_unique<A>(name, "server", config);
          };
          factory.registerNodeType<A>("PlainA", 42);
          factory.registerBuilder<A>("BuiltA", builder);
          const BT::PortsList ports = { BT::OutputPort<std::string>("text") };
          factory.registerNodeType<A>("GivenPorts", ports);
          factory.registerBuilder(BT::CreateManifest<B>("Manifest", ports), BT::CreateBuilder<B>());
          factory.registerSimpleAction("Open", [&](BT::TreeNode&) { return gripper.open(); });
          factory.registerSimpleCondition("IsOpen", std::bind(isOpen), { BT::InputPort<int>("door") });
          factory.registerSimpleDecorator("Twice", twice, ports);
          moveit::registerBehavior<B>(factory, "OfLibrary", resources);
          factory.registerFromPlugin("x.so");
          factory.registerScriptingEnum("RED", 1);
          factory.registerPolymorphicCast<A, B>();
        }
        CreateRosNodePlugin(B, "OfMacro");
        """
    )
    assert unseen(found) == []
    assert [f"{node.category} {node.name} {' '.join(ports(node))}".rstrip() for node in found.nodes] == [
        "Action BuiltA",
        "Action GivenPorts output text : std::string",
        "Condition IsOpen input door : int",
        "Condition Manifest output text : std::string",
        "Condition OfLibrary input b : int",
        "Condition OfMacro input b : int",
        "Action Open",
        "Action PlainA",
        "Decorator Twice output text : std::string",
    ]


def test_nodes_are_registered_across_files_with_their_places() -> None:
    header = """
        namespace nav { class Spin : public BT::ActionNodeBase {
          static BT::PortsList providedPorts();
        }; }
    """
    source = """
        #include "a.cpp"
        namespace nav {
        BT::PortsList Spin::providedPorts()
        {
          return { BT::InputPort<double>("dist") };
        }
        }
        BT_REGISTER_NODES(factory) { factory.registerNodeType<nav::Spin>("Spin"); }
    """
    (node,) = read(header, source).nodes
    assert (str(node.place), str(node.class_place)) == ("b.cpp:9:30", "a.cpp:2:23")
    assert [(port.name, str(port.place)) for port in node.ports] == [("dist", "b.cpp:6:12")]


def test_a_name_means_the_class_that_is_nearest() -> None:
    of = (
        "struct Go : BT::SyncActionNode"
        ' {{ static PortsList providedPorts() {{ return {{ InputPort<int>("{}") }}; }} }};'
    )
    register = 'void f() { factory.registerNodeType<Go>("Go"); }'
    included = f'#include "b.cpp"\n{register}'
    for texts, port in [
        ((f"namespace x {{ {of.format('x')} }}", f"{of.format('own')} {register}"), "own"),
        ((of.format("a"), of.format("b"), included), "b"),
        ((f"namespace x {{ {of.format('x')} }} namespace y {{ {of.format('y')} {register} }}",), "y"),
        (
            (
                f"namespace x {{ {of.format('x')} }} using namespace x; {register}",
                f"namespace y {{ {of.format('y')} }}",
            ),
            "x",
        ),
    ]:
        found = read(*texts)
        assert unseen(found) == []
        assert [ports(node) for node in found.nodes] == [[f"input {port} : int"]]


def test_a_name_that_may_mean_several_classes_means_none() -> None:
    one = (
        "namespace {} {{ struct Go : BT::SyncActionNode {{ static PortsList providedPorts() {{ return {{}}; }} }}; }}\n"
    )
    found = read(f'{one.format("x")}{one.format("y")}void f() {{ factory.registerNodeType<Go>("Go"); }}')
    assert found.nodes == ()
    assert unseen(found) == [
        "a.cpp:3:12: `Go` may be any of several classes: a.cpp:1, a.cpp:2",
        "a.cpp:3:12: the class `Go` of the node `Go` is not in the sources",
    ]


def test_one_name_for_two_nodes_is_reported() -> None:
    of = "struct {} : BT::SyncActionNode {{ static PortsList providedPorts() {{ return {{}}; }} }};\n"
    register = 'void f() { factory.registerNodeType<A>("Go"); factory.registerNodeType<B>("Go"); }'
    found = read(of.format("A") + of.format("B") + register)
    assert [(node.name, node.class_name) for node in found.nodes] == [("Go", "A")]
    assert unseen(found) == ["a.cpp:3:47: `Go` is also registered at a.cpp:3:12, as another node"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "struct A : Unknown { static PortsList providedPorts() { return {}; } };\n"
            'void f() { factory.registerNodeType<A>("Go"); }',
            "a.cpp:2:12: the category of `Go` cannot be seen: `Unknown` is not in the sources",
        ),
        (
            'void f() { factory.registerNodeType<Elsewhere>("Go"); }',
            "a.cpp:1:12: the class `Elsewhere` of the node `Go` is not in the sources",
        ),
        (
            "struct A : BT::SyncActionNode {};\nvoid f(std::string id) { factory.registerNodeType<A>(id); }",
            "a.cpp:2:26: the name of this node is an expression: `id`",
        ),
        (
            "void f() { factory.registerBuilder(manifest, builder); }",
            "a.cpp:1:12: it cannot be seen which node this registers: `manifest`",
        ),
    ],
)
def test_a_node_that_cannot_be_seen_is_left_out_and_reported(text: str, message: str) -> None:
    found = read(text)
    assert (found.nodes, unseen(found)) == ((), [message])


@pytest.mark.parametrize(
    ("returned", "message"),
    [
        (
            'PortsList list = { InputPort<int>("a") }; for (auto t : all()) { list.insert(InputPort<int>(t)); }'
            " return list;",
            "it cannot be seen which ports this provides: `for (auto t : all()) { list.insert(InputPort<int>(t)); }`",
        ),
        ("return { InputPort<int>(name()) };", "the name of this port is an expression: `InputPort<int>(name())`"),
        (
            'PortsList list = { InputPort<int>("a") }; if (debug) { list.erase("a"); } return list;',
            'it cannot be seen which ports this provides: `if (debug) { list.erase("a"); }`',
        ),
        ("return readPorts();", "it cannot be seen which ports this provides: `return readPorts();`"),
    ],
)
def test_ports_that_cannot_be_seen_are_reported_and_make_the_node_incomplete(returned: str, message: str) -> None:
    found = read(move(f"static PortsList providedPorts() {{ {returned} }}"))
    assert [node.complete for node in found.nodes] == [False]
    assert [each.message for each in found.unseen] == [message]


def test_a_template_that_registers_what_it_is_given_registers_nothing_itself() -> None:
    found = read(
        """
        struct A : BT::SyncActionNode { static PortsList providedPorts() { return {}; } };
        template <class NodeT> void registerOne(BT::BehaviorTreeFactory& factory, const std::string& id)
        {
          BT::TreeNodeManifest manifest;
          factory.registerBuilder(manifest, builder);
          factory.registerNodeType<NodeT>(id);
        }
        void f() { registerOne<A>(factory, "A"); }
        """
    )
    assert ([node.name for node in found.nodes], unseen(found)) == (["A"], [])


def test_the_code_cannot_be_read_where_the_grammar_fails() -> None:
    found = read('BT_REGISTER_NODES(factory) { factory.registerNodeType<A>"A"); ) }')
    assert found.nodes == ()
    assert unseen(found) == ["a.cpp:1:60: the C++ grammar cannot read this"]


def test_what_means_itself_is_unseen() -> None:
    found = read(
        """
        struct A : BT::SyncActionNode { static PortsList providedPorts() { return A::providedPorts(); } };
        PortsList loop(PortsList more) { return loop(more); }
        struct B : BT::SyncActionNode { static PortsList providedPorts() { return loop({ InputPort<X>("a") }); } };
        using X = Y; using Y = X;
        template <class T> struct C : C<C<T>> { };
        void f() {
          registerNodeType<A>("A"); registerNodeType<B>("B"); registerNodeType<X>("X"); registerNodeType<C<X>>("C");
        }
        """
    )
    assert [(node.name, node.complete) for node in found.nodes] == [("A", False), ("B", False)]
    assert [each.message for each in found.unseen][-2:] == [
        "the category of `C` cannot be seen: a base class is not in the sources",
        "the class `X` of the node `X` is not in the sources",
    ]


WITHOUT = {
    'if (!getInput("p", p)) { throw 1; }': "fails",
    'if (!getInput("p", p)) return BT::NodeStatus::FAILURE;': "fails",
    'auto r = getInput<int>("p"); if (!r) { throw 1; }': "fails",
    'auto r = getInput<int>("p"); if (!r.has_value()) { return NodeStatus::FAILURE; }': "fails",
    'if (auto r = getInput<int>("p"); !r) throw 1;': "fails",
    'use(getInput<int>("p").value());': "fails",
    'auto r = getInput<int>("p"); use(r.value());': "fails",
    'if (!getInput("p", p)) { p = 3; }': "goes on",
    'if (getInput("p", p)) { use(p); }': "goes on",
    'if (getInput("p", p)) { use(p); } else { throw 1; }': "fails",
    'use(getInput<int>("p").value_or(3));': "goes on",
    'BT::getInputOrBlackboard("p", p);': "goes on",
    'auto r = getInput<int>("p"); if (r) { return use(r.value()); } return later();': "",
    'if (!getInput("p", p)) { exit(-1); }': "fails",
    'getInput("p", p);': "ignores",
    '[[maybe_unused]] auto r = getInput("p", p);': "ignores",
    'if (flag && !getInput("p", p)) { throw 1; }': "",
    'if (!getInput("p", p)) { return; }': "",
    'check(getInput<int>("p"));': "",
    'if (!getInput("p", p)) { p = 3; } getInput("p", p);': "ignores",
    'if (!getInput("p", p)) { throw 1; } getInput("p", p);': "fails",
    'auto r = getInput<int>("p"); if (r) { use(*r); } else { if (!x) { return NodeStatus::FAILURE; } }': "",
    'auto r = getInput<int>("p"); if (r) { use(*r); } else if (x) { go(); } else { return NodeStatus::FAILURE; }': "",
    'if (!getInput("p", p)) { auto x = other(); if (!x) { throw 1; } }': "",
}


@pytest.mark.parametrize("code", WITHOUT)
def test_what_the_code_does_without_an_input(code: str) -> None:
    body = f'static PortsList providedPorts() {{ return {{ InputPort<int>("p") }}; }} NodeStatus tick() {{ {code} }}'
    assert moved(body).without == (("p", WITHOUT[code]),)


def test_ports_that_the_code_never_names_and_names_that_are_no_ports() -> None:
    body = """
        static PortsList providedPorts() {
          return { InputPort<int>("used"), InputPort<int>(kName), InputPort<int>("unused"), OutputPort<int>("never") };
        }
        NodeStatus tick() { getInput("used", x); getInput(kName, x); getInput("usde", x); setOutput("out", x); }
    """
    node = moved(body, more='constexpr auto kName = "by_constant";')
    assert [port.name for port in node.unread] == ["unused", "never"]
    assert [(use.port, use.writes, str(use.place)) for use in node.undeclared] == [
        ("usde", False, "a.cpp:9:62"),
        ("out", True, "a.cpp:9:83"),
    ]


def test_a_method_that_the_class_overrides_reads_no_port_of_it() -> None:
    base = """
        struct Base : BT::StatefulActionNode {
          static PortsList providedPorts() { return { InputPort<int>("x"), InputPort<int>("y") }; }
          NodeStatus onStart() { getInput("x", x_); }
          NodeStatus onRunning() { getInput("y", y_); }
        };
    """
    body = """
        static PortsList providedPorts() { return { InputPort<int>("home") }; }
        NodeStatus onStart() { getInput("home", x_); }
    """
    node = moved(body, "Base", base)
    assert [use.port for use in node.undeclared] == ["y"]
    assert node.unread == ()


def test_of_branches_of_a_condition_all_ports_may_be_there() -> None:
    body = """
        #ifdef OTHER
        static PortsList providedPorts() { return {}; }
        #else
        static PortsList providedPorts() { return { InputPort<int>("x") }; }
        #endif
        NodeStatus tick() { getInput("x", x_); }
    """
    read_so = read(move(body))
    (node,) = read_so.nodes
    assert (ports(node), node.complete, node.undeclared) == (["input x : int"], False, ())
    assert unseen(read_so) == ["a.cpp:7:1: `robot::Move::providedPorts` is here 2 times, and one of them counts"]


def test_a_condition_inside_of_brackets_is_taken_as_if_it_held() -> None:
    body = """
        static PortsList providedPorts() {
          return PortsList({
        #ifndef OTHER  // (
            InputPort<int>("x"),
        #endif
            InputPort<int>("y", ":)", "(")
          });
        }
        NodeStatus tick() { getInput("x", x_); getInput("y", y_); }
    """
    assert ports(moved(body)) == ["input x : int", "input y : int = ':)' # ("]


def test_a_port_is_not_called_unread_where_code_is_missing() -> None:
    body = 'static PortsList providedPorts() { return { InputPort<int>("p") }; } NodeStatus tick() override;'
    assert moved(body).unread == ()
    assert moved(body.replace(" override;", " { }")).unread != ()
    assert (
        moved(
            f"{body.removesuffix('NodeStatus tick() override;')}", "Base", "struct Base : BT::RosActionNode<M> {};"
        ).unread
        == ()
    )


def test_a_port_is_not_unread_if_other_code_reads_it_or_a_name_is_made() -> None:
    class_ = """
        static BT::PortsList providedPorts() {{ return {{ BT::InputPort("near"), BT::InputPort("far") }}; }}
        BT::NodeStatus tick() {{ {} }}
    """

    def unread(tick: str, *others: str) -> list[str]:
        (node,) = read(move(class_.format(tick)), *others).nodes
        return [port.name for port in node.unread]

    assert unread("") == ["near", "far"]
    assert unread("", 'void test(BT::TreeNode* node) { node->getInput<int>("far"); }') == ["near"]
    assert unread("", 'void test(BT::TreeNode* node) { find("far"); }') == ["near", "far"]
    assert unread('getInput(prefix + "ar", value_);') == []
    helper = "\n template <class T> T get(const std::string& port) {{ T value; getInput(port, value); return value; }}"
    class_ += helper
    assert unread('auto x = get<int>("near");') == ["far"]


HELPERS = """
    namespace {
      bool read(BT::TreeNode& node, const char* port) { return node.getInput<int>(port).has_value(); }
      bool read(BT::TreeNode& node, int number) { return read(node, "far"); }
      bool readOne(BT::TreeNode& node) { return one(node, "near"); }
      bool one(BT::TreeNode& node, const char* port) { return node.getInput<int>(port).has_value(); }
      bool readAll(BT::TreeNode& node) { return read(node, "near") && read(node, 1); }
      bool handOn(BT::TreeNode* node) { return elsewhere(node); }
      bool ignore(BT::TreeNode&) { return true; }
    }
"""


@pytest.mark.parametrize(
    ("tick", "unread"),
    [
        ("readAll(*this);", []),
        ("readOne(*this);", ["far"]),
        ("read(*this, 1);", ["near"]),
        ("ignore(*this);", ["near", "far"]),
        ("handOn(this);", []),
        ("elsewhere(*this);", []),
        ("reader_.read(*this);", []),
        ("Reader reader(*this);", []),
        ("elsewhere(3);", ["near", "far"]),
        ("subscribe(std::bind(&Move::take, this));", ["near", "far"]),
        ("later([this] { this->take(); });", ["near", "far"]),
    ],
)
def test_helpers_are_followed_to_any_depth_unless_they_are_not_in_the_sources(tick: str, unread: list[str]) -> None:
    ports = 'static BT::PortsList providedPorts() { return { BT::InputPort("near"), BT::InputPort("far") }; }'
    (node,) = read(HELPERS + move(f"{ports} BT::NodeStatus tick() {{ {tick} }}")).nodes
    assert [port.name for port in node.unread] == unread
    assert node.undeclared == ()


SIMPLE = """
    BT::NodeStatus speak(BT::TreeNode& self) {
      if (!self.getInput("text", text)) { return BT::NodeStatus::FAILURE; }
      self.setOutput("lenght", 1);
      return BT::NodeStatus::SUCCESS;
    }
    void f(BT::BehaviorTreeFactory& factory) {
      BT::PortsList ports{ BT::InputPort<std::string>("text"), BT::OutputPort<int>("length") };
      auto listen = [&](BT::TreeNode& self) { self.getInput("text", text); return hear(text); };
      factory.registerSimpleAction("Speak", speak, ports);
      factory.registerSimpleCondition("Hears", listen, { BT::InputPort<std::string>("text") });
      factory.registerSimpleDecorator("Mute", [](BT::NodeStatus status, BT::TreeNode& node) {
        const auto level = node.getInput<int>("level").value();
        return level > 3 ? status : BT::NodeStatus::SKIPPED;
      }, { BT::BidirectionalPort<int>("level"), BT::InputPort<double>("gain", 1.0, "of the microphone") });
      factory.registerSimpleAction("Whole", [](BT::TreeNode& self) { return other(self); },
                                   { BT::InputPort<int>("a") });
      factory.registerSimpleAction("Bound", std::bind(&Robot::go, &robot), { BT::InputPort<int>("b") });
    }
"""


def test_a_simple_action_ends_at_once() -> None:
    assert [node.name for node in read(SIMPLE).nodes if node.at_once] == ["Bound", "Speak", "Whole"]


def test_the_function_of_a_simple_node_is_held_against_its_ports() -> None:
    found = read(SIMPLE)
    assert found.unseen == ()
    assert [
        (
            node.name,
            ports(node),
            [port.name for port in node.unread],
            [use.port for use in node.undeclared],
            [what for _, what in node.without],
        )
        for node in found.nodes
    ] == [
        ("Bound", ["input b : int"], [], [], [""]),
        ("Hears", ["input text : std::string"], [], [], ["ignores"]),
        (
            "Mute",
            ["inout level : int", "input gain : double = '1.0' # of the microphone"],
            ["gain"],
            [],
            ["fails", ""],
        ),
        ("Speak", ["input text : std::string", "output length : int"], ["length"], ["lenght"], ["fails"]),
        ("Whole", ["input a : int"], [], [], [""]),
    ]


def test_ports_are_in_declared_order_those_of_a_base_first() -> None:
    more = """
        struct Base : BT::StatefulActionNode {
          static PortsList providedPorts() { return { InputPort<int>("z"), OutputPort<int>("m") }; }
        };
    """
    own = 'auto ports = Base::providedPorts(); ports.insert({ InputPort<A>("k"), InputPort<B>("a") }); return ports;'
    assert provided(own, more, "Base") == ["input z : int", "output m : int", "input k : A", "input a : B"]
    own = 'PortsList ports{ InputPort<A>("k"), InputPort<B>("a") }; ports.merge(Base::providedPorts()); return ports;'
    assert provided(own, more, "Base") == ["input k : A", "input a : B", "input z : int", "output m : int"]
