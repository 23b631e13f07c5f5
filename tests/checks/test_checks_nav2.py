"""What checks know of Nav2's nodes, by distribution: `nodes = ["nav2-…"]`."""

from __future__ import annotations

import pytest
from check_asserts import assert_fixes_mend, assert_sound, show

from btq_lang.btcpp.opening import file_of
from btq_lang.catalog.nav2 import PACKAGED
from btq_lang.checks import check
from btq_lang.workspace.config import Project
from btq_lang.workspace.loader import read
from btq_lang.workspace.workspace import Workspace


def found(text: str, distribution: str) -> list[str]:
    """All that is found in a file for a distribution."""
    path = PACKAGED[f"nav2-{distribution}"]
    name = "main.xml" if text.startswith("<") else "main.btq"
    files = {name: file_of(name, text), path: file_of(path, read(path)[0] or "")}
    workspace = Workspace(files, Project(node_files=(path,)))
    diagnostics = check(workspace, name)
    assert_sound(workspace, name, diagnostics)
    assert_fixes_mend(workspace, name, diagnostics)
    return show(text, diagnostics)


def tree(*lines: str) -> str:
    return "BehaviorTree Main\n" + "".join(f"    {line}\n" for line in lines)


# ---- nodes of a team's own ----

OWN = "; this may be a node of your own"
HAS_NO = "`IsBatteryLow` has no port"
REQUIRES = "`PersistentSequence` requires a value for its port"


@pytest.mark.parametrize(
    ("node", "expected"),
    [
        (
            "IsBatteryLow (threshold = 20 voltage = 23.5)",
            [
                "3:9 warning missing-port «IsBatteryLow» `IsBatteryLow` requires a value for its port `min_battery`"
                + OWN,
                f"3:23 warning unknown-port «threshold» {HAS_NO} `threshold`{OWN}",
                f"3:38 warning unknown-port «voltage» {HAS_NO} `voltage`{OWN}",
            ],
        ),
        (
            "IsBatteryLow (threshold = 20)",
            [f"3:23 warning unknown-port «threshold» {HAS_NO} `threshold`{OWN}; did you mean `min_battery`?"],
        ),
        (
            "IsBatteryLow",
            [
                "3:9 warning missing-port «IsBatteryLow» `IsBatteryLow` requires a value for its port `min_battery`"
                + OWN
            ],
        ),
        (
            "IsBatteryLow (min_battery = 0.2 cells = 4)",
            [f"3:41 warning unknown-port «cells» {HAS_NO} `cells`{OWN}"],
        ),
        (
            "IsBatteryLow (min_battery = 0.2 is_voltag = true)",
            [f"3:41 error unknown-port «is_voltag» {HAS_NO} `is_voltag`; did you mean `is_voltage`?"],
        ),
        (
            "IsBatteryLow (is_voltage = true)",
            ["3:9 warning missing-port «IsBatteryLow» `IsBatteryLow` requires a value for its port `min_battery`"],
        ),
        (
            "PersistentSequence (start = 2)\n            AlwaysSuccess\n            AlwaysSuccess",
            [
                "3:29 warning unknown-port «start» `PersistentSequence` has no port `start`"
                f"{OWN}; did you mean `current_child_idx`?"
            ],
        ),
        (
            "PersistentSequence\n            AlwaysSuccess\n            AlwaysSuccess",
            [f"3:9 warning missing-port «PersistentSequence» {REQUIRES} `current_child_idx`{OWN}"],
        ),
    ],
)
def test_a_node_of_ones_own_with_the_name_of_one_of_nav2(node: str, expected: list[str]) -> None:
    """Where only Nav2's nodes are named, and others of the file are unknown; else it is Nav2's."""
    of_file = found(tree("->", f"    {node}", "    StopMoving"), "lyrical")
    assert [each for each in of_file if "StopMoving" not in each] == expected
    of_known = found(tree("->", f"    {node}", "    AlwaysSuccess"), "lyrical")
    assert of_known == [each.replace("warning", _severity(node, each)).replace(OWN, "") for each in expected]


def _severity(node: str, finding: str) -> str:
    """Without an input, most nodes of Nav2 do not throw."""
    return "warning" if "missing-port" in finding and not node.startswith("Persistent") else "error"


# ---- children and results ----


def test_a_number_of_children_that_throws_only_when_ticked() -> None:
    text = tree("RecoveryNode", "    IsStuck", "    IsStuck", "    IsStuck")
    assert found(text, "jazzy") == [
        "2:5 error child-count «RecoveryNode» `RecoveryNode` requires exactly 2 children, found 3"
    ]
    controller = 'PauseResumeController (pause_service_name = "p" resume_service_name = "r")'
    text = tree(controller, *(["    IsStuck"] * 5))
    assert found(text, "lyrical") == [
        "2:5 error child-count «PauseResumeController» `PauseResumeController` requires 1 to 4 children, found 5"
    ]
    assert found(tree(controller, *(["    IsStuck"] * 4)), "lyrical") == []


def test_a_model_of_the_project_with_another_category_is_another_node() -> None:
    text = "Decorator RecoveryNode\n" + tree("RecoveryNode", "    IsStuck")
    assert found(text, "jazzy") == [
        "1:11 warning duplicate-definition «RecoveryNode» duplicate definition of the node model `RecoveryNode`"
    ]


def test_a_node_of_another_distribution_is_unknown_here() -> None:
    text = "Control PauseResumeController\n" + tree("PauseResumeController", *(["    IsStuck"] * 5))
    assert found(text, "kilted") == []


def test_children_that_can_never_run() -> None:
    pipeline = tree("PipelineSequence", "    AlwaysFailure", "    IsStuck")
    assert found(pipeline, "jazzy") == [
        "4:9 warning unreachable-child «IsStuck» `IsStuck` can never run: `AlwaysFailure` before it never succeeds"
    ]
    recovery = tree("RecoveryNode", "    AlwaysSuccess", "    Wait")
    assert found(recovery, "jazzy") == [
        "4:9 warning unreachable-child «Wait» `Wait` can never run: `AlwaysSuccess` before it never fails"
    ]


def test_a_failure_that_a_recovery_swallows() -> None:
    demand = "satisfies QualityReq q takes at most 5 s on violation fail"
    first = tree("RecoveryNode (number_of_retries = 2)", f"    Spin {demand}", "    Wait")
    assert found(first, "jazzy") == [
        "3:37 warning swallowed-failure «takes at most 5 s» when `Spin` fails "
        "because of this, `RecoveryNode` runs its second child"
    ]
    assert found(first.replace("= 2", "= 0"), "jazzy") == []
    assert found(tree("RecoveryNode", "    Spin", f"    Wait {demand}"), "jazzy") == []


# ---- what ends within a tick ----


def test_only_what_may_run_on_restarts_what_runs_beside_it() -> None:
    text = tree(
        "R->", "    TruncatePathLocal (input_path = {goal} output_path = {goals})", "    FollowPath (path = {goals})"
    )
    assert found(text, "jazzy") == []
    text = text.replace("TruncatePathLocal (input_path = {goal} output_path = {goals})", "Spin")
    assert found(text, "jazzy") == [
        "4:9 hint reactive-multiple-async «FollowPath» if `Spin` takes longer than one tick, it restarts whenever "
        "`FollowPath` is RUNNING, and halts it"
    ]


# ---- version 3 of the engine ----

OF_VERSION_3 = """\
<root main_tree_to_execute="Main">
  <BehaviorTree ID="Main">
    <ReactiveSequence>
      <Condition ID="IsStuck"/>
      <SequenceStar name="rest">
        <SubTreePlus ID="Other" __autoremap="true"/>
        <SubTree ID="Other" __shared_blackboard="true"/>
        <BlackboardCheckInt value_A="{a}" value_B="1" return_on_mismatch="FAILURE"><IsStuck/></BlackboardCheckInt>
        <Parallel success_threshold="1" failure_threshold="1"><GoalReached goal="${goal}"/></Parallel>
      </SequenceStar>
    </ReactiveSequence>
  </BehaviorTree>
  <BehaviorTree ID="Other"><Wait/></BehaviorTree>
</root>
"""


def test_words_of_version_3_are_right_where_the_nodes_come_with_it() -> None:
    assert found(OF_VERSION_3, "humble") == []
    assert found(OF_VERSION_3, "iron") == []
    assert found(OF_VERSION_3, "jazzy") == [
        "1:2 error version-3-file «root» this file is for version 3 of the engine: it has "
        "`SequenceStar`, `SubTreePlus`, `__autoremap`, `__shared_blackboard` …, but Jazzy has 4.9.1"
    ]


def test_nodes_of_version_4_are_not_in_version_3() -> None:
    text = tree("->", '    Script (code = "a := 1")', "    IsStuck")
    assert found(text, "iron") == [
        "3:9 error newer-engine-node «Script» `Script` requires BehaviorTree.CPP 4; 3.8 does not have it"
    ]
    assert found(text, "jazzy") == []


# ---- memory ----

KEEPING = ("WhileDoElse", "    {}", "    IsStuck", "    IsStuck")
LOSING = ("R?", "    {}", "    Wait")


def within(lines: tuple[str, ...], *child: str) -> str:
    """A tree of these lines, with a child for `{}`."""
    found: list[str] = []
    for line in lines:
        margin = line[: len(line) - len(line.lstrip())]
        found += [line] if "{}" not in line else [f"{margin}{each}" for each in child]
    return tree(*found)


def lost(text: str, distribution: str = "jazzy") -> list[str]:
    return [line.split("» ")[1] for line in found(text, distribution) if "memory-lost" in line]


def test_what_waits_for_a_change_is_kept_only_as_a_condition_that_is_asked_again() -> None:
    never = "`GoalUpdated` never succeeds here: `{}` resets it before it ticks it again"
    assert lost(within(KEEPING, "GoalUpdated")) == []
    assert lost(within(LOSING, "GoalUpdated")) == [never.format("R?")]
    for parent in ("PipelineSequence", "->", "?", "||", "IfThenElse", "RoundRobin", "RecoveryNode"):
        assert lost(within((parent, "    {}", "    Wait"), "GoalUpdated")) == [never.format(parent)]
    for parent in ("Inverter", "ForceSuccess", "Timeout (msec = 100)", "PathLongerOnApproach (path = {p})"):
        assert lost(tree(parent, "    GoalUpdated")) == [never.format(parent.split()[0])]


def test_an_action_that_calls_a_server_guards_nothing_as_a_condition() -> None:
    text = tree("WhileDoElse", "    Spin", "    Wait")
    assert [line for line in found(text, "jazzy") if "stateful-condition" in line] == [
        "3:9 warning stateful-condition «Spin» `Spin` is not started again while a later child runs: "
        "`WhileDoElse` does not reset it"
    ]


def test_a_throttle_is_kept_in_a_pipeline_before_its_last_child() -> None:
    rate = ("RateController", "    Spin")
    assert lost(within(KEEPING, *rate)) == []
    assert lost(within(("PipelineSequence", "    {}", "    Wait"), *rate)) == []
    nothing = "`RateController` holds nothing back here: `{}` resets it before it ticks it again"
    assert lost(within(("PipelineSequence", "    Wait", "    {}"), *rate)) == [nothing.format("PipelineSequence")]
    assert lost(within(("Inverter", "    {}"), *rate)) == [nothing.format("Inverter")]
    assert lost(within(("RecoveryNode", "    {}", "    Wait"), *rate)) == [nothing.format("RecoveryNode")]
    trigger = lost(within(("->", "    {}", "    Wait"), "SingleTrigger", "    Spin"))
    assert trigger == ["`SingleTrigger` holds nothing back here: `->` resets it before it ticks it again"]


def test_the_engine_resets_the_child_of_every_decorator() -> None:
    rate = ("        RateController", "            Spin", "    Wait")
    own = "Decorator Own\n" + tree("PipelineSequence", "    Own", *rate)
    nothing = "`RateController` holds nothing back here: `{}` resets it before it ticks it again"
    assert lost(own) == [nothing.format("Own")]
    updater = "GoalUpdater (input_goal = {goal} output_goal = {g})"
    text = tree("PipelineSequence", f"    {updater}", *rate)
    for distribution in ("humble", "jazzy", "lyrical"):
        assert lost(text, distribution) == [nothing.format("GoalUpdater")]


def test_of_nodes_that_are_not_known_nothing_is_said() -> None:
    assert lost("Control Own\n" + tree("Own", "    GoalUpdated")) == []
    assert lost(tree("GoalUpdated")) == []


def test_where_it_is_unknown_which_node_is_whose_child_nothing_is_said() -> None:
    text = "BehaviorTree Main\n    Inverter\n        GoalUpdated\n      Wait\n"
    assert [line.split()[2] for line in found(text, "jazzy")] == ["inconsistent-indentation"]


# ---- the last success ----


def test_the_success_that_is_lost() -> None:
    robin = ("RoundRobin", "    Spin", "    Wait")
    message = (
        "2:5 warning last-success-lost «RoundRobin» `RoundRobin` fails after its last child, `Wait`, even if that "
        "succeeds"
    )
    assert found(tree(*robin), "lyrical") == [message]
    assert found(tree(*robin), "kilted") == []
    assert found(tree("RoundRobin (wrap_around = false)", *robin[1:]), "lyrical") == [message]
    assert found(tree("RoundRobin (wrap_around = true)", *robin[1:]), "lyrical") == []
    assert found(tree(*robin[:2], "    AlwaysFailure"), "lyrical") == []


# ---- values that are never read ----


def test_an_entry_that_is_read_before_it_is_written() -> None:
    text = tree("PipelineSequence", "    DistanceController (distance = {d})", "        Spin", "    Wait")
    message = (
        "3:40 warning default-instead «{d}» `distance` of `DistanceController` is read only when the tree is created, "
        "when nothing has written `d`"
    )
    assert found(text, "jazzy") == [message]
    given = f"{text.replace('Main', 'Sub')}BehaviorTree Main\n    SubTree Sub (_autoremap = true d = {{}})\nRoot Main\n"
    assert found(given.replace("{}", "2.0"), "jazzy") == []
    assert found(given.replace("{}", "{e}"), "jazzy") == [message]
    assert found(given.replace(" d = {}", ""), "jazzy") == [message]
    through = given.replace("{}", "{e}").replace(
        "Root Main", "BehaviorTree Top\n    SubTree Main (_autoremap = true e = 2.0)\nRoot Top"
    )
    assert found(through, "jazzy") == []
    declared = text.replace("BehaviorTree Main\n", "BehaviorTree Main\n    input d : double = 2.0\n")
    assert found(declared, "jazzy") == []


# ---- nodes in SubTrees ----


def isolated(text: str, distribution: str) -> list[str]:
    return [line.split("» ")[1] for line in found(text, distribution) if "isolated-node" in line]


def lacking(node: str, *entries: str) -> list[str]:
    names = ", ".join(f"`{each}`" for each in entries)
    return [f"`{node}` cannot be created in the tree `Sub`: this SubTree does not pass {names}"]


OF_ACTIONS = ("node", "wait_for_service_timeout", "bt_loop_duration")


@pytest.mark.parametrize(
    ("node", "distribution", "entries"),
    [
        ("Spin", "jazzy", OF_ACTIONS),
        ("Spin", "humble", (*OF_ACTIONS, "server_timeout")),
        ("CancelSpin", "lyrical", OF_ACTIONS[:2]),
        ('ClearEntireCostmap (service_name = "x")', "kilted", OF_ACTIONS),
        ("GetCurrentPose (current_pose = {p})", "lyrical", ("node", "tf_buffer")),
        ('PlannerSelector (topic_name = "t" selected_planner = {p} default_planner = "a")', "iron", ("node",)),
        ("IsStuck", "humble", ("node",)),
        ("TruncatePath (distance = 1.0 input_path = {q} output_path = {p})", "jazzy", ()),
        ("TimeExpired (seconds = 1.0)", "jazzy", ()),
        ("IsStuck", "kilted", ("node",)),
        ("Own", "jazzy", ()),
    ],
)
def test_a_node_in_a_subtree_without_what_it_is_created_with(
    node: str, distribution: str, entries: tuple[str, ...]
) -> None:
    text = f"BehaviorTree Main\n    SubTree Sub\nBehaviorTree Sub\n    {node}\nRoot Main\nAction Own\n"
    assert isolated(text, distribution) == (lacking(node.partition(" ")[0], *entries) if entries else [])
    sharing = "__shared_blackboard" if distribution in ("humble", "iron") else "_autoremap"
    assert isolated(text.replace("Tree Sub\nB", f'Tree Sub ({sharing} = "true")\nB'), distribution) == []


def test_entries_that_are_passed_one_by_one() -> None:
    text = "BehaviorTree Main\n    SubTree Sub ({})\nBehaviorTree Sub\n    IsStuck\nRoot Main\n"
    assert isolated(text.format("node = {node}"), "jazzy") == isolated(text.format("node = node"), "humble") == []
    assert isolated(text.format('__shared_blackboard = "true"'), "jazzy") == lacking("IsStuck", "node")
    assert isolated(text.format('__shared_blackboard = "false"'), "humble") == lacking("IsStuck", "node")


def test_each_subtree_on_the_way_passes_them() -> None:
    text = (
        "BehaviorTree Main\n    SubTree Sub{}\nBehaviorTree Sub\n    SubTree Below{}\n"
        "BehaviorTree Below\n    IsStuck\nRoot Main\n"
    )
    all_of = " (_autoremap = true)"
    below = ["`IsStuck` cannot be created in the tree `Below`: this SubTree does not pass `node`"]
    assert isolated(text.format(all_of, all_of), "jazzy") == []
    assert isolated(text.format("", all_of), "jazzy") == lacking("IsStuck", "node")
    assert isolated(text.format(all_of, ""), "jazzy") == below
    assert isolated(text.format("", ""), "jazzy") == lacking("IsStuck", "node") + below
    assert isolated(text.format(" (n = {node})", " (node = {n})"), "jazzy") == []


def test_a_node_of_a_team_that_has_the_name_of_one_of_nav2() -> None:
    text = "BehaviorTree Main\n    SubTree Sub\nBehaviorTree Sub\n    Wait (own = 1)\nRoot Main\n"
    assert isolated(f"{text}Action Wait\n    input own\n", "jazzy") == []
    assert isolated(f"{text}Action Wait\n    input wait_duration = 1.0\n", "jazzy") == lacking("Wait", *OF_ACTIONS)


# ---- servers ----

CALLED = "calls the server `follow_path`, as another child of"


@pytest.mark.parametrize(
    ("kind", "shown", "distribution"),
    [
        ("||", "||", "jazzy"),
        ("ParallelAll", "ParallelAll", "lyrical"),
        ("NonblockingSequence", "NonblockingSequence", "lyrical"),
        ("->", "", "jazzy"),
        ("R->", "", "lyrical"),
    ],
)
def test_two_callers_of_a_server(kind: str, shown: str, distribution: str) -> None:
    def shared(*lines: str) -> list[str]:
        text = tree(kind, *(f"    {line}" for line in lines))
        text += "BehaviorTree Follow\n    FollowPath (path = {path})\nRoot Main\n"
        return [each for each in found(text, distribution) if "shared-server" in each]

    one, sub = "FollowPath (path = {path})", "SubTree Follow (_autoremap = true)"

    def message(place: str, caller: str) -> list[str]:
        return [f"{place} warning shared-server {caller} {CALLED} `{shown}` does"] if shown else []

    assert shared(one, "->", f"    {one}") == message("5:13", "«FollowPath» `FollowPath`")
    assert shared(one, sub) == message("4:17", "«Follow» `FollowPath` in the tree `Follow`")
    assert shared(one, 'FollowPath (path = {path} server_name = "/follow_path")') == message(
        "4:9", "«FollowPath» `FollowPath`"
    )
    assert shared(one, 'FollowPath (path = {path} server_name = "other")') == []
    assert shared(one, "FollowPath (path = {path} server_name = {other})") == []
    assert shared("->", f"    {one}", f"    {one}", "Spin") == []
    assert shared(one, "CancelControl", 'Spin (server_name = "spin")', "Wait") == []


def test_bt_navigator_sets_some_entries_before() -> None:
    assert found(tree("Spin (server_timeout = {bt_loop_duration})"), "jazzy") == []
    assert len(found(tree("Spin (server_timeout = {later})"), "jazzy")) == 1
    service = 'ClearEntireCostmap (service_name = "clear" server_timeout = {later})'
    assert [len(found(tree(service), each)) for each in ("humble", "jazzy", "kilted", "lyrical")] == [1, 1, 0, 0]


def test_a_number_that_must_not_be_negative() -> None:
    text = tree("RecoveryNode (number_of_retries = -1)", "    Spin", "    Wait")
    assert found(text, "iron") == []
    assert found(text, "jazzy") == [
        "2:39 warning default-instead «-1» `number_of_retries` of `RecoveryNode` must not be negative: the node cannot "
        "read `-1`"
    ]
    assert [line.split()[2] for line in found(text.replace("-1", '"a"'), "jazzy")] == ["invalid-literal"]


# ---- error codes ----


def test_an_error_code_that_nobody_reads() -> None:
    message = (
        "2:27 hint error-code-not-collected «{{{}}}» nothing reads `{}`, and the result of a goal does not have it"
    )
    for name, where in {"spin_code": "ijkl", "spin_error_code": "ij", "smoother_error_code": ""}.items():
        for distribution in ("iron", "jazzy", "kilted", "lyrical"):
            expected = [message.format(name, name)] if distribution[0] in where else []
            assert found(tree(f"Spin (error_code_id = {{{name}}})"), distribution) == expected
    read = tree(
        "->",
        "    Spin (error_code_id = {code})",
        '    AreErrorCodesPresent (error_code = {code} error_codes_to_check = "1")',
    )
    assert found(read, "jazzy") == []


OF_PLANNER = "`ComputePathToPose` and `ComputePathThroughPoses`"


@pytest.mark.parametrize(
    ("writers", "condition", "wanted", "has"),
    [
        (("ComputeRoute",), "Planner", OF_PLANNER, "`ComputeRoute`"),
        (("ComputeRoute", "Spin"), "Planner", OF_PLANNER, "`ComputeRoute` and `Spin`"),
        (("ComputePathToPose",), "Route", "`ComputeRoute` and `ComputeAndTrackRoute`", "`ComputePathToPose`"),
        (("ComputeRoute", "ComputePathToPose"), "Planner", OF_PLANNER, ""),
        (("ComputePathThroughPoses",), "Planner", OF_PLANNER, ""),
        (("ComputeRoute", "Action Own"), "Planner", OF_PLANNER, ""),  # its numbers are not known
        ((), "Planner", OF_PLANNER, ""),
    ],
)
def test_a_condition_that_looks_for_codes_of_others(
    writers: tuple[str, ...], condition: str, wanted: str, has: str
) -> None:
    condition = f"WouldA{condition}RecoveryHelp"
    nodes = [f"    {each} (error_code_id = {{code}})" for each in writers]
    text = tree("?", *nodes, f"    {condition} (error_code = {{code}})")
    for distribution in ("kilted", "lyrical"):
        lines = [line for line in found(text, distribution) if "foreign-error-code" in line]
        assert [line.partition("«")[2] for line in lines] == (
            [f"{{code}}» `{condition}` never succeeds: it looks for codes of {wanted}, and `code` has those of {has}"]
            if has
            else []
        )


def test_codes_that_another_tree_writes_too_are_not_known() -> None:
    text = tree(
        "?",
        "    ComputeRoute (error_code_id = {code})",
        "    SubTree Part (code = {code})",
        "    WouldAPlannerRecoveryHelp (error_code = {code})",
    )
    part = "BehaviorTree Part\n    Action Own (error_code_id = {code})\n"
    assert [line for line in found(text + part, "kilted") if "foreign-error-code" in line] == []


def test_codes_that_bt_navigator_resets_are_still_of_others() -> None:
    text = tree(
        "?",
        "    FollowPath (path = {path} error_code_id = {follow_path_error_code})",
        "    WouldAPlannerRecoveryHelp (error_code = {follow_path_error_code})",
    )
    assert [line.split()[2] for line in found(text, "lyrical")] == ["foreign-error-code"]


# ---- other rules ----


def test_an_index_without_an_entry_is_never_counted_on() -> None:
    text = tree("PersistentSequence (current_child_idx = 0)", "    Spin", "    Wait")
    assert found(text, "lyrical") == [
        "2:45 warning literal-for-output «0» expected a blackboard entry for the output `current_child_idx` of "
        "`PersistentSequence`, found `0`"
    ]
    assert found(text.replace("= 0", "= {at}"), "lyrical") == []


def test_a_skipped_child_where_none_may_be() -> None:
    text = tree("NonblockingSequence", "    Spin", '    Wait (_skipIf = "@a > 1")')
    assert found(text, "lyrical") == [
        "4:15 warning skipped-condition «_skipIf» if `_skipIf` skips `Wait`, `NonblockingSequence` throws and the "
        "mission ends"
    ]
    assert found(text.replace("NonblockingSequence", "PipelineSequence"), "lyrical") == []


def test_a_guard_would_make_a_node_forget() -> None:
    demand = "satisfies QualityReq q takes at most 5 s on violation fail"
    text = tree("PipelineSequence", f"    RateController {demand}", "        Spin", "    Wait")
    assert found(text, "jazzy") == [
        "3:47 warning not-enforced «takes at most 5 s» the engine cannot enforce `on violation fail`: a guard around "
        "`RateController` would reset it, and it would forget what it waits for"
    ]
    assert found(text.replace("RateController", "GoalUpdater (input_goal = {goal} output_goal = {g})"), "jazzy") == []


def test_how_long_a_recovery_may_take() -> None:
    text = tree(
        "RecoveryNode (number_of_retries = 2)",
        "    satisfies QualityReq a takes at most 20 s",
        "    FollowPath (path = {goal}) satisfies QualityReq b takes at most 5 s",
        "    Spin satisfies QualityReq c takes at most 3 s",
    )
    assert found(text, "jazzy") == [
        "3:32 warning budget-exceeded «takes at most 20 s» `RecoveryNode` may take 21 s, more than `20 s` allows: "
        "3 × `FollowPath` 5 s + 2 × `Spin` 3 s"
    ]
    assert found(text.replace("20 s", "21 s"), "jazzy") == []


@pytest.mark.parametrize("extra", [("Spin",), ("Spin", "Wait")])
def test_a_recovery_node_with_several_recoveries(extra: tuple[str, ...]) -> None:
    path = PACKAGED["nav2-jazzy"]
    children = ("ComputePathToPose", "BackUp", *extra)
    text = tree("RecoveryNode (number_of_retries = 1)", *(f"    {name}" for name in children))
    files = {"main.btq": file_of("main.btq", text), path: file_of(path, read(path)[0] or "")}
    problems = check(Workspace(files, Project(node_files=(path,))), "main.btq")
    assert [each.notes for each in problems if each.rule == "child-count"] == [
        (
            "the engine loads this and throws when the node is ticked",
            "put those after the first one below one Sequence, or a RoundRobin, which takes turns",
        )
    ]


# ---- poses ----


@pytest.mark.parametrize("distribution", ["humble", "iron", "jazzy", "kilted", "lyrical"])
@pytest.mark.parametrize(("value", "number"), [("1.0;2.0;0.0", 3), ("kitchen", 1), ("0;map;1;2;0;0;0;0;1;0", 10)])
def test_a_pose_with_other_fields(distribution: str, value: str, number: int) -> None:
    """Sources: convertFromString in bt_conversions.hpp of Humble and Iron, bt_utils.hpp of the others."""
    message = f"expected the 9 fields of a pose for `goal`, found {number}: `{value}`"
    node = 'ComputePathToPose (goal = "{}" path = {{path}})'
    text = tree("->", "    " + node.format(value), "    FollowPath (path = {path})")
    where = f'3:35 error invalid-literal «"{value}"» {message}'
    assert [each for each in found(text, distribution) if "invalid-literal" in each] == [where]
    for right in ("0;map;1.0;2.0;0.0;0;0;0;1", "json:{}", "{goal}"):
        assert "invalid-literal" not in str(found(text.replace(value, right), distribution))


@pytest.mark.parametrize("distribution", ["humble", "jazzy", "lyrical"])
@pytest.mark.parametrize(("value", "share"), [("20", "0.2"), ('"20%"', "0.2"), ("7.5", "0.075"), ('"0.5 %"', "0.005")])
def test_a_battery_in_percent(distribution: str, value: str, share: str) -> None:
    """Source: batteryCallback in is_battery_low_condition.cpp: BatteryState.percentage is a share from 0 to 1."""
    text = tree(f'IsBatteryLow (min_battery = {value} battery_topic = "/battery")')
    message = f"`min_battery` is a share from 0 to 1, unless `is_voltage` is true: write `{share}`"
    where = f"2:33 warning invalid-literal «{value}» {message}"
    assert [each for each in found(text, distribution) if "min_battery" in each] == [where]
    for voltage in ("false", "False", "0"):
        assert message in str(found(text.replace(")", f" is_voltage = {voltage})"), distribution))
    for right in ("0.2", "1", "1.0", "{limit}"):
        assert "share" not in str(found(text.replace(value, right), distribution))
    for voltage in ("true", "1", "{volts}"):
        assert "share" not in str(found(text.replace(")", f" is_voltage = {voltage})"), distribution))


def test_a_pose_in_xml() -> None:
    text = (
        '<root BTCPP_format="4"><BehaviorTree ID="Main"><Sequence><GoalReached goal="1.0;2.0;0.0" '
        'global_frame="map" robot_base_frame="base_link"/></Sequence></BehaviorTree></root>'
    )
    message = "expected the 9 fields of a pose for `goal`, found 3: `1.0;2.0;0.0`"
    assert found(text, "jazzy") == [f"1:77 error invalid-literal «1.0;2.0;0.0» {message}"]


@pytest.mark.parametrize(
    ("name", "meant"),
    [
        ("Pipeline", "; did you mean `PipelineSequence`?"),
        ("Round", "; did you mean `RoundRobin`?"),
        ("Goal", ""),  # which several begin with
        ("Pipe", ""),  # no whole word
    ],
)
def test_the_first_words_of_a_node(name: str, meant: str) -> None:
    text = (
        f'<root BTCPP_format="4"><BehaviorTree ID="Main"><{name}><Wait wait_duration="1.0"/><Mine/></{name}>'
        "</BehaviorTree></root>"
    )
    (unknown,) = [each for each in found(text, "jazzy") if f"«{name}»" in each]
    assert unknown == f"1:49 hint unknown-node «{name}» unknown node `{name}`{meant}"
