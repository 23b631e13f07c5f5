"""`btq check --target`: what another distribution of Nav2 changes for trees of an earlier one."""

from __future__ import annotations

from pathlib import Path

import pytest
from check_asserts import assert_fixes_mend, assert_sound, show
from in_process import run_btq
from moving_pages import moving_pages

from btq_lang.btcpp.opening import file_of
from btq_lang.catalog import versions
from btq_lang.catalog.engine_changes import ENGINE_CHANGES
from btq_lang.catalog.nav2 import DISTRIBUTIONS, PACKAGED
from btq_lang.catalog.nav2.changes import CHANGES
from btq_lang.catalog.versions import ANY, BehaviorChange, at_least, last_of, numbers
from btq_lang.checks import check
from btq_lang.commands.target import with_target
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace

# A value that matches the value of a change, and a node that has the port of a change that concerns every node.
SAMPLES = ("-1", "0.5", "{x}", "1;2", "{path}")
WITH_PORT = {
    "service_name": "ClearEntireCostmap",
    "goals": "ComputePathThroughPoses",
    "input_goals": "RemovePassedGoals",
    "error_code_id": "Spin",
}


def moved(text: str, origin: str, target: str) -> list[str]:
    """What is found of the two rules."""
    return show(text, found_moved(text, origin, target))


def found_moved(text: str, origin: str, target: str) -> list[Diagnostic]:
    workspace = Workspace.of({"main.btq": text}, Project(node_files=(PACKAGED[f"nav2-{origin}"],)))
    workspace = with_target(workspace, f"nav2-{target}")
    found = [each for each in check(workspace, "main.btq") if each.rule.startswith("target-")]
    assert_sound(workspace, "main.btq", found)
    assert_fixes_mend(workspace, "main.btq", found)
    return found


def tree(*nodes: str) -> str:
    return "BehaviorTree Main\n    ->\n" + "".join(f"        {node}\n" for node in nodes)


def sample(change: BehaviorChange) -> str:
    node = WITH_PORT[change.port] if change.nodes == (ANY,) else change.nodes[0]
    if not change.port or change.value is None:
        return node
    value = next(each for each in SAMPLES if change.matches(each))
    return f'{node} ({change.port} = "{value}")'


@pytest.mark.parametrize("change", CHANGES, ids=lambda change: f"{change.since}-{change.nodes[0]}-{change.port}")
def test_each_change_is_found_on_the_step_that_brings_it(change: BehaviorChange) -> None:
    before = DISTRIBUTIONS[DISTRIBUTIONS.index(change.since) - 1]
    said = f"from {change.since.title()} on"
    found = found_moved(tree(sample(change)), before, change.since)
    said_of = [line for each in found for line in (each.message, *each.notes)]  # a note if the node is gone
    assert [line for line in said_of if line.startswith(said) and change.what in line]
    assert moved(tree(sample(change)), before, before) == []


# ---- the engine's own versions ----

LINES = ("3.8", "4.6", "4.7", "4.8", "4.9", "4.10")
SAMPLES_OF_ENGINE = {
    "restarts": ("R->", "    Drive", "    Dock"),
    "completes at once": ("{node}", "    AlwaysSuccess"),
    "runs on": ("{node} ({port})", "    Drive"),
    "queue of a script": ("->", "    Script (code = \"q := '1;2'\")", "    {node} ({port})", "        Drive"),
    "watched": ("->", "    {node} ({port}, output_key = e)", "    WaitValueUpdate (entry = e)", "        Drive"),
    "skipped in the end": ("{node}", "    Drive (_while = ready)"),
}


def engine_tree(row: BehaviorChange, value: str) -> str:
    """A tree with the first node that a row concerns."""
    needed = {"Precondition": 'if = "ready"', "SkipUnlessUpdated": "entry = {e}"}
    node = "M->" if row.nodes[0] == "SequenceWithMemory" else row.nodes[0]
    lines = SAMPLES_OF_ENGINE.get(row.when, ("{node} ({port})", "    Drive", "    Drive", "    Drive"))
    lines = lines[: 2 if row.when == "" and row.nodes[0][:6] != "Switch" else None]
    port = f'{row.port} = "{value}"' if row.port else needed.get(node, "")
    return "BehaviorTree Main\n" + "".join(f"    {line.format(node=node, port=port)}\n" for line in lines)


def moved_engine(text: str, origin: str, target: str, given: str = "main.btq") -> list[str]:
    workspace = Workspace({given: file_of(given, text)}, Project(engines=(origin,)))
    workspace = with_target(workspace, target)
    return show(text, [each for each in check(workspace, given) if each.rule.startswith("target-")])


def row_id(row: BehaviorChange) -> str:
    return f"{row.since}-{row.nodes[0]}-{row.port}-{row.until}"


@pytest.mark.parametrize("row", ENGINE_CHANGES, ids=row_id)
def test_each_change_of_the_engine_is_found_where_it_is_between(row: BehaviorChange) -> None:
    value = next((each for each in ("0", "1;2", "{q}", "5abc", "5") if row.port and row.matches(each)), "")
    text = engine_tree(row, value)
    before = max((each for each in LINES if not at_least(last_of(each), row.since)), key=numbers, default="3.8")
    if row.after:
        before = max(before, next(each for each in LINES if at_least(last_of(each), row.after)), key=numbers)
    after = next(each for each in LINES if at_least(last_of(each), row.since) and each != "3.8")
    found = moved_engine(text, before, after)
    assert [
        line
        for line in found
        if "warning target-differs" in line and f"from {row.since} on `" in line and line.endswith(row.what)
    ]
    assert moved_engine(text, after, after) == []
    assert [line for line in moved_engine(text, after, before) if row.what in line] == []
    if row.until:
        assert [line for line in moved_engine(text, before, row.until) if row.what in line] == []


def test_a_delay_that_waits_no_more_is_said_once() -> None:
    text = "BehaviorTree Main\n    Delay (delay_msec = 5 s)\n        Drive\n"
    assert [line[:50] for line in moved_engine(text, "4.6", "4.8")] == [
        "2:5 warning target-differs «Delay» from 4.8.3 on `"
    ]


def test_a_list_that_no_script_writes_is_what_it_was() -> None:
    loop = "BehaviorTree Main\n    ->\n        Script (code = \"other := '1;2'\")\n        LoopInt (queue = {q})\n"
    assert moved_engine(f"{loop}            Drive\n", "4.8", "4.10") == []


def test_each_change_of_the_engine_is_on_the_page_of_one_step() -> None:
    pages = [page for path, page in moving_pages().items() if path[7:8].isdigit()]
    assert len(pages) == 3
    for what in {row.what for row in ENGINE_CHANGES} | {row.what for row in versions.CHANGES}:
        assert sum(what in page for page in pages) == 1, what
    named = [
        each for name, each in vars(versions).items() if name.isupper() and isinstance(each, versions.VersionChange)
    ]
    assert named == [*versions.CHANGES]


def test_each_change_of_nav2_is_on_the_page_of_its_step() -> None:
    pages = moving_pages()
    for change in CHANGES:
        before = DISTRIBUTIONS[DISTRIBUTIONS.index(change.since) - 1]
        nodes = "any node" if change.nodes == (ANY,) else ", ".join(f"`{node}`" for node in change.nodes)
        on = [path for path, page in pages.items() if f"* {nodes}: {change.what}" in page]
        assert on == [f"moving/{before}-{change.since}.md"], change


def test_what_a_tree_of_humble_meets_on_the_way_to_lyrical() -> None:
    text = tree(
        "IsPathValid (path = {way})",
        'TruncatePathLocal (input_path = {way} output_path = {part} robot_frame = "base_link")',
        'SubTree Rest (goal = goal __shared_blackboard = "true")',
    )
    assert moved(f"{text}BehaviorTree Rest\n    IsStuck\n", "humble", "lyrical") == [
        "3:9 error target-breaks «IsPathValid» Nav2 has no `IsPathValid` in Lyrical: it is called `ValidatePath`",
        "4:68 error target-breaks «robot_frame» `TruncatePathLocal` has no port `robot_frame` in Lyrical: it is called "
        "`robot_base_frame`",
        "5:17 error target-breaks «Rest» `IsStuck` cannot be created in the tree `Rest`: this SubTree does not pass "
        "`node`",
        "5:30 warning target-differs «goal» from 4.0 on `goal` is a text that the SubTree gets, no longer the name "
        "of an entry",
        "5:35 warning target-differs «__shared_blackboard» the engine silently ignores `__shared_blackboard`; did you "
        "mean `_autoremap`?",
    ]


def test_what_else_changes_for_a_node_that_is_gone_is_in_its_notes() -> None:
    (found,) = found_moved(tree("IsPathValid (path = {way})"), "humble", "lyrical")
    assert (found.rule, found.notes) == (
        "target-breaks",
        (
            "from Kilted on `IsPathValid` ends the goal with an exception if there is no answer in time; before, it "
            "failed",
            "from Lyrical on `IsPathValid` without `max_cost` regards a cost up to 254 as free, no longer up to 253",
        ),
    )


def test_a_path_is_empty_only_for_nodes_that_read_it() -> None:
    text = tree("ComputePathToPose (goal = {goal} path = {path})", "FollowPath (path = {path})")
    assert [line.partition(" ")[0] for line in moved(text, "kilted", "lyrical")] == ["4:28"]


def test_a_node_that_comes_back_is_missed_only_between() -> None:
    text = tree("ClearCostmapAroundPose (service_name = clear)")
    assert moved(text, "jazzy", "kilted") == [
        "3:9 error target-breaks «ClearCostmapAroundPose» Nav2 has no `ClearCostmapAroundPose` in Kilted"
    ]
    assert [line for line in moved(text, "jazzy", "lyrical") if "breaks" in line] == []


def test_on_the_way_back_only_what_is_not_there_counts() -> None:
    assert moved(tree("RoundRobin (wrap_around = true)", "    AlwaysSuccess"), "lyrical", "kilted") == [
        "3:21 error target-breaks «wrap_around» `RoundRobin` has no port `wrap_around` in Kilted"
    ]


def test_an_entry_clashes_with_a_type_that_changes() -> None:
    """A time to wait is a double from Jazzy on, and goals are a message from Kilted on: the engine refuses an entry
    that a node of one's own takes for another type."""
    own = (
        "TreeNodesModel\n    Action Own\n"
        '        input goals : "std::vector<geometry_msgs::msg::PoseStamped>"\n        output time : int\n\n'
    )
    nodes = (
        "Own (goals = {goals} time = {time})",
        "Wait (wait_duration = {time})",
        "NavigateThroughPoses (goals = {goals})",
    )
    text = own + tree(*nodes)

    def clashes(origin: str, target: str) -> list[str]:
        return [line for line in moved(text, origin, target) if "has the type" in line]

    assert clashes("iron", "jazzy") == [
        "9:31 error target-breaks «{time}» `time` of `Own` creates `{time}` as int, but `wait_duration` of `Wait` has "
        "the type double"
    ]
    assert clashes("jazzy", "kilted") == [
        "10:39 warning target-differs «{goals}» `goals` of `Own` creates `{goals}` as "
        "std::vector<geometry_msgs::msg::PoseStamped>, but `goals` of `NavigateThroughPoses` has the type "
        "nav_msgs::msg::Goals"
    ]
    assert clashes("kilted", "lyrical") == clashes("jazzy", "jazzy") == []


def test_an_include_of_humble_is_looked_for_elsewhere() -> None:
    text = f'include "more.btq"\n{tree("Own")}'
    assert moved(text, "humble", "iron") == [
        '1:9 warning target-differs «"more.btq"» from Iron on the path counts from the file that includes it, not '
        "from bt_navigator's working folder"
    ]
    assert moved(text, "iron", "lyrical") == []


def test_the_command(tmp_path: Path) -> None:
    (tmp_path / "btq.toml").write_text('nodes = ["nav2-kilted"]\n')
    (tmp_path / "tree.xml").write_text(
        '<root BTCPP_format="4"><BehaviorTree ID="Main"><RoundRobin><IsStuck/></RoundRobin></BehaviorTree></root>\n'
    )
    code, out, _ = run_btq("check", "--target", "nav2-lyrical", "--output-format", "concise", cwd=tmp_path)
    assert (code, out) == (
        1,
        "tree.xml:1:49: warning[target-differs] from Lyrical on `RoundRobin` does not begin again after its last "
        "child: it then fails, even if that child has succeeded\nFound 1 warning\n",
    )
    assert run_btq("check", cwd=tmp_path)[0] == 0
    (tmp_path / "btq.toml").write_text("")
    code, _, err = run_btq("check", "--target", "nav2-lyrical", cwd=tmp_path)
    assert (code, err) == (
        2,
        'btq check: --target needs to know what the trees are for: write `nodes = ["nav2-jazzy"]` into btq.toml\n',
    )


def test_what_a_file_for_version_3_meets_on_the_way_to_4_10() -> None:
    xml = """\
<root main_tree_to_execute="Main">
  <BehaviorTree ID="Main">
    <SequenceStar>
      <Find dock="dock" at="${pose}"/>
      <Parallel success_threshold="1" failure_threshold="1"><Find/></Parallel>
      <BlackboardCheckInt value_A="{a}" value_B="1"><Find/></BlackboardCheckInt>
      <SubTree ID="Go on" name="one" to="dock" __shared_blackboard="true"/>
      <SubTree ID="Go on" name="one"/>
      <Sequence ID="x"><Find/></Sequence>
    </SequenceStar>
  </BehaviorTree>
  <BehaviorTree ID="Go on"><Find at="{to}"/></BehaviorTree>
  <BehaviorTree ID="Go on"><Find/></BehaviorTree>
  <TreeNodesModel>
    <Action ID="Find"><output_port name="dock"/><input_port name="at" default="0"/></Action>
    <SubTree ID="Go on"><input_port name="to"/></SubTree>
  </TreeNodesModel>
</root>
"""
    workspace = with_target(Workspace({"main.xml": file_of("main.xml", xml)}, Project()), "4.10")
    found = check(workspace, "main.xml")
    assert [
        (xml[: each.span.start].count("\n") + 1, each.rule, each.message)
        for each in found
        if each.rule.startswith("target-")
    ] == [
        (3, "target-breaks", "`SequenceStar` is not built into BehaviorTree.CPP 4.6–4.10"),
        (4, "target-differs", 'expected a blackboard entry for the output `dock` of `Find`, found `"dock"`'),
        (4, "target-differs", "the engine reads `${pose}` as a text, not as an entry"),
        (5, "target-breaks", "`Parallel` has no port `success_threshold`; did you mean `success_count`?"),
        (5, "target-breaks", "`Parallel` has no port `failure_threshold`; did you mean `failure_count`?"),
        (6, "target-breaks", "`BlackboardCheckInt` is not built into BehaviorTree.CPP 4.6–4.10"),
        (7, "target-differs", "from 4.0 on `dock` is a text that the SubTree gets, no longer the name of an entry"),
        (7, "target-differs", "the engine silently ignores `__shared_blackboard`; did you mean `_autoremap`?"),
        (8, "target-breaks", "`Go on` requires a value for its port `to`"),
        (8, "target-breaks", "the engine refuses two SubTrees with the name `one` in one tree"),
        (9, "target-breaks", "the engine refuses the attribute `ID` on `Sequence`"),
        (12, "target-breaks", "the engine refuses the tree ID `Go on`: it contains a space"),
        (13, "target-breaks", "the engine refuses the tree ID `Go on`: it contains a space"),
        (13, "target-differs", "from 4.0 on this tree `Go on` counts, no longer the first one"),
    ]
    assert {each.rule for each in found if not each.rule.startswith("target-")} == {
        "version-3-file",
        "duplicate-tree",
        "duplicate-instance-name",
    }
    (star, *_) = [each for each in found if each.rule == "target-breaks"]
    assert star.notes[-1] == "in 4.10 this is not-an-engine-node: `btq explain not-an-engine-node`"


def test_a_number_is_hardly_the_name_of_an_entry() -> None:
    text = "BehaviorTree Main\n    SubTree Rest (goal = goal n = 0)\nBehaviorTree Rest\n    Own\n"
    workspace = with_target(Workspace.of({"main.btq": text}, Project(engines=("3.8",))), "4.10")
    found = [each for each in check(workspace, "main.btq") if each.rule == "target-differs"]
    assert [[fix.title for fix in each.fixes] for each in found] == [["Replace `goal` with `{goal}`"], []]
