"""Budgets: the rule of each node, what they are made of, and that no run of any tree is outside of them."""

from __future__ import annotations

from math import inf

import pytest
from budget_missions import GROUPS, WildRuns, mission_of, missions, resolved
from hypothesis import given, settings
from hypothesis import strategies as st
from simulated_runs import Endless

from btq_lang.catalog.nav2.nodes import NODES
from btq_lang.catalog.nodes import BUILTINS, lookup
from btq_lang.requirements.budgets import Budgets
from btq_lang.requirements.composition import _CONTROLS, _DECORATORS
from btq_lang.requirements.durations import Range
from btq_lang.requirements.resolve import Requirements
from btq_lang.scenarios.mission import ScenarioMission
from btq_lang.simulator.nodes import FAILURE, SKIPPED, SUCCESS, SimulatedNode
from btq_lang.workspace.resolved import ResolvedNode

# ---- no run lies outside --------------------------------------------------------------------------------------------

KINDS = tuple(kind for kinds in GROUPS.values() for kind in kinds)
# Queues and entries that others write are not drawn, and what GoalUpdater hears on its topic is in no model.
NOT_SIMULATED = {"for-each", "skip-unless-updated", "wait-until-updated", "pass"}


@given(missions(), st.integers(0, 1000))
def test_no_run_lies_outside_its_budget(text: str, seed: int) -> None:
    assert_within_budgets(text, seed)


@pytest.mark.parametrize("top", KINDS)
def test_no_run_of_any_kind_of_node_lies_outside_its_budget(top: str) -> None:
    ended: set[str] = set()

    @settings(max_examples=30)
    @given(missions(top), st.integers(0, 1000))
    def run(text: str, seed: int) -> None:
        ended.update(assert_within_budgets(text, seed))

    run()
    only = {"ForceSuccess": "success", "ForceFailure": "failure", "KeepRunningUntilFailure": "failure"}.get(top)
    assert ended - {"skip"} == ({only} if only else {"success", "failure"})


def test_all_flows_are_simulated_that_have_a_rule() -> None:
    found = [kind for name in KINDS if (kind := lookup(name) or NODES.get(name)) is not None]
    assert {
        kind.flow for kind in found if kind.children != (0, 0)
    } | NOT_SIMULATED == _CONTROLS.keys() | _DECORATORS.keys()
    simulated = {kind.tag for kind in found}
    assert {
        tag for tag, kind in BUILTINS.items() if kind.flow in _CONTROLS.keys() | _DECORATORS.keys()
    } - simulated == {
        *("LoopInt", "LoopBool", "LoopDouble", "LoopString", "SkipUnlessUpdated", "WaitValueUpdate"),
        *("Switch3", "Switch4", "Switch5", "Switch6"),
    }


def assert_within_budgets(text: str, seed: int) -> set[str]:
    """Some runs of a mission; how its root ended."""
    mission = mission_of(text)
    found = mission.requirements
    budgets = Budgets(found.store, found.viewpoint)
    runs = BudgetedRuns(mission, seed, budgets)
    try:
        for _ in range(6):
            runs.run()
    except Endless:
        longest = budgets.of(found.nodes.find(("Main",))[0].node).anything
        assert longest is None or longest.high > 100.0 or not_bounded(budgets, found)
    return runs.ends


class BudgetedRuns(WildRuns):
    """Runs in which no node may take more or less than its budget says.

    Attributes:
        ends: how the root has ended.
    """

    def __init__(self, mission: ScenarioMission, seed: int, budgets: Budgets) -> None:
        super().__init__(mission, seed)
        self.budgets = budgets
        self.ends: set[str] = set()

    def over(self, node: SimulatedNode, result: int, milliseconds: int) -> None:
        budget = self.budgets.of(self.nodes[node.uid])
        word = {SUCCESS: "success", FAILURE: "failure", SKIPPED: "skip"}[result]
        allowed = getattr(budget, word)
        assert allowed is not None, f"{node.path} {word} after {milliseconds} ms: {budget}"
        assert allowed.low <= milliseconds / 1000 <= allowed.high, (
            f"{node.path} {word} after {milliseconds} ms: {budget}"
        )
        if node is self.machine.root:
            self.ends.add(word)


def not_bounded(budgets: Budgets, found: Requirements) -> bool:
    """Some node that costs no time may be tried without end."""
    nodes = found.nodes.all
    return any(not budgets.composed(node).is_bounded or "-1" in str(node.node.attributes) for node in nodes)


# ---- the rules, one by one -------------------------------------------------------------------------------------------

LEAVES = """
QualityReq a "t"
    every A takes between 1 s and 2 s
QualityReq b "t"
    every B takes between 3 s and 5 s
"""


def budget(tree: str, requirements: str = LEAVES) -> tuple[Budgets, ResolvedNode]:
    """The budgets of a tree, and its root."""
    lines = "".join(f"    {line}\n" for line in tree.strip("\n").split("\n"))
    everyone = "BehaviorTree Unused\n    ->\n        A\n        B\n        X\n"  # so that each name is one of a node
    found = resolved(f"{requirements}BehaviorTree Main\n{lines}{everyone}")
    root = found.nodes.find(("Main",))[0].node
    return Budgets(found.store, found.viewpoint), root


def said(tree: str, requirements: str = LEAVES) -> tuple[object, object, object]:
    """Success, failure and skip of a tree's root, each as (low, high)."""
    budgets, root = budget(tree, requirements)
    found = budgets.of(root)
    return pair(found.success), pair(found.failure), pair(found.skip)


def pair(each: Range | None) -> tuple[float, float] | None:
    return (each.low, each.high) if each is not None else None


@pytest.mark.parametrize(
    ("tree", "success", "failure"),
    [
        ("A", (1, 2), (1, 2)),
        ("-> \n    A\n    B", (4, 7), (1, 7)),
        ("A->\n    A\n    B", (4, 7), (1, 7)),
        ("M->\n    A\n    B", (3, 7), (1, 7)),  # after a failure it begins where it failed
        ("?\n    A\n    B", (1, 7), (4, 7)),
        ("R->\n    Condition C\n    B", (3, 5), (0, 5)),
        ("R?\n    Condition C\n    B", (0, 5), (3, 5)),
        ("R->\n    Script (code = x)\n    B", (3, 5), (3, 5)),
        ("R->\n    A\n    B", (0, inf), (0, inf)),
        ("||\n    A\n    B", (3, 5), (1, 5)),
        ("|| (success_count = 1 failure_count = 2)\n    A\n    B", (1, 5), (3, 5)),
        ("|| (success_count = 2 failure_count = 2)\n    A\n    B", (3, 5), (1, 5)),
        ("All||\n    A\n    B", (3, 5), (3, 5)),
        ("All|| (max_failures = 0)\n    A\n    B", None, (3, 5)),
        ("IfThenElse\n    A\n    B", (4, 7), (0, 7)),  # an action that has failed as its condition may not run again
        ("IfThenElse\n    A\n    B\n    A", (2, 7), (2, 7)),
        ("WhileDoElse\n    Condition C\n    B", (3, 5), (0, 5)),
        ("WhileDoElse\n    Condition C\n    B\n    AlwaysSuccess", (0, 5), (0, 5)),
        ("WhileDoElse\n    Condition C\n    A\n    B", (0, inf), (0, inf)),
        ("Switch (variable = {v} case_1 = x)\n    A\n    B", (1, 5), (1, 5)),
        ("Switch (case_1 = x)\n    A\n    B", (3, 5), (3, 5)),
        ("TryCatch\n    A\n    B", (1, 2), (4, 7)),
        ("Inverter\n    ForceSuccess\n        A", None, (1, 2)),
        ("ForceFailure\n    A", None, (1, 2)),
        ("Retry (num_attempts = 3)\n    A", (1, 6), (3, 6)),
        ("Retry (num_attempts = -1)\n    A", (1, inf), None),
        ("Retry (num_attempts = -1)\n    ForceSuccess\n        A", (1, 2), None),
        ("Retry (num_attempts = {n})\n    A", (1, inf), (0, inf)),
        ("Repeat (num_cycles = 3)\n    A", (3, 6), (1, 6)),
        ("Repeat (num_cycles = -1)\n    A", None, (1, inf)),
        ("Repeat (num_cycles = 0)\n    A", (0, 0), None),
        ("Timeout (msec = 1500)\n    A", (1, 1.5), (1, 1.5)),
        ("Timeout (msec = 1.5 s)\n    A", (1, 1.5), (1, 1.5)),
        ("Timeout (msec = 500)\n    A", None, (0.5, 0.5)),
        ("Timeout (msec = 2000)\n    A", (1, 2), (1, 2)),
        ("Timeout (msec = 2000)\n    ForceSuccess\n        A", (1, 2), (2, 2)),  # at 2 s either may come first
        ("Timeout (msec = 0)\n    A", (1, 2), (1, 2)),
        ("Timeout (msec = {t})\n    A", (1, 2), (0, 2)),
        ("Timeout (msec = 5 s)\n    X", (0, 5), (0, 5)),
        ("Timeout (msec = 5)\n    AlwaysSuccess", (0, 0), None),
        ("Delay (delay_msec = 500)\n    A", (1.5, 2.5), (1.5, 2.5)),
        ("Delay (delay_msec = {t})\n    A", (1, inf), (1, inf)),
        ("KeepRunningUntilFailure\n    A", None, (1, inf)),
        ("Sleep (msec = 250)", (0.25, 0.25), None),
        ("Sleep (msec = {t})", (0, inf), None),
        ("LoopDouble (queue = {q})\n    A", (0, inf), (0, inf)),
        ("WaitValueUpdate (entry = {q})\n    A", (1, inf), (1, inf)),
        ("Decorator Mine\n    A", (0, inf), (0, inf)),
        ("X", (0, inf), (0, inf)),
        ("A (_failureIf = x _successIf = x)", (0, 2), (0, 2)),
        ("SubTree Elsewhere", (0, inf), (0, inf)),
        ("->\n    A\n    SubTree Main", (1, inf), (1, inf)),
        ("->\n    A\n    xml '<B/>'", (1, inf), (1, inf)),
    ],
)
def test_what_a_node_makes_of_its_children(
    tree: str, success: tuple[float, float] | None, failure: tuple[float, float] | None
) -> None:
    assert said(tree)[:2] == (success, failure)


@pytest.mark.parametrize(
    ("tree", "success", "failure", "skip"),
    [
        ("A (_skipIf = x)", (1, 2), (1, 2), (0, 0)),
        ("A (_while = x)", (1, 2), (1, 2), (0, 2)),
        ("->\n    A (_skipIf = x)\n    B", (3, 7), (1, 7), None),
        ("->\n    A (_skipIf = x)", (0, 2), (1, 2), (0, 0)),
        ("Retry (num_attempts = 3)\n    A (_skipIf = x)", (1, 6), (1, 6), (0, 4)),
        ("RunOnce\n    A", (0, 2), (0, 2), (0, 0)),
        ("SkipUnlessUpdated (entry = {q})\n    A", (1, 2), (1, 2), (0, 0)),
        ("Precondition (if = x else = SKIPPED)\n    A", (1, 2), (1, 2), (0, 2)),
        ("||\n    A (_skipIf = x)\n    B", (0, 7), (0, 7), (0, 7)),
        ("|| (success_count = 2)\n    A (_skipIf = x)\n    B", (0, inf), (0, inf), (0, inf)),
    ],
)
def test_skips(tree: str, success: object, failure: object, skip: object) -> None:
    assert said(tree) == (success, failure, skip)


@pytest.mark.parametrize(
    ("tree", "success", "failure", "skip"),
    [
        # While a later child runs, the earlier ones are ticked again, and may fail.
        ("PipelineSequence\n    A\n    B", (4, 7), (0, 7), None),
        ("PipelineSequence\n    A\n    ForceSuccess\n        B", (4, 7), (0, 7), None),
        ("PipelineSequence\n    A\n    Condition C", (1, 2), (1, 2), None),
        ("PipelineSequence\n    A\n    Condition C\n    B", (4, 7), (0, 7), None),
        ("PipelineSequence\n    ForceSuccess\n        A\n    ForceSuccess\n        B", (4, 7), None, None),
        ("PipelineSequence\n    A (_skipIf = x)\n    B (_skipIf = x)", (0, 7), (0, 7), (0, 7)),
        ("PipelineSequence\n    A (_skipIf = x)\n    Condition C (_skipIf = x)", (0, 2), (0, 2), (0, 0)),
        ("PipelineSequence\n    A (_skipIf = x)\n    B", (3, 7), (0, 7), None),
        # It begins with any child, and ends with any.
        ("RoundRobin\n    A\n    B", (1, 7), (0, 7), None),
        ("RoundRobin\n    B\n    A", (1, 7), (0, 7), None),
        ("RoundRobin\n    ForceFailure\n        A\n    B", (3, 7), (0, 7), None),
        ("RoundRobin\n    ForceFailure\n        A\n    ForceFailure\n        B", None, (0, 7), None),
        ("RoundRobin\n    A (_skipIf = x)\n    B", (1, 7), (0, 7), None),
        ("RoundRobin\n    A (_skipIf = x)\n    B (_skipIf = x)", (1, 7), (0, 7), (0, 7)),
        ("RoundRobin (wrap_around = true)\n    A (_skipIf = x)\n    B", (1, 7), (0, 7), None),
        # A skip that takes time may come again and again, as long as the first child follows the last.
        ("RoundRobin\n    A (_while = x)\n    B", (1, 7), (0, 7), None),
        ("RoundRobin (wrap_around = true)\n    A (_while = x)\n    B", (0, inf), (0, inf), (0, inf)),
        ("RoundRobin (wrap_around = {w})\n    A (_while = x)\n    B", (0, inf), (0, inf), (0, inf)),
    ],
)
def test_what_nodes_of_nav2_make_of_their_children(tree: str, success: object, failure: object, skip: object) -> None:
    assert said(tree) == (success, failure, skip)


def test_why_one_that_takes_turns_has_no_bound() -> None:
    budgets, root = budget("RoundRobin (wrap_around = true)\n    A (_while = x)\n    B")
    found = budgets.of(root)
    assert (found.endless, found.waits) == (True, True)
    budgets, root = budget("RoundRobin\n    A (_while = x)\n    B")
    found = budgets.of(root)
    assert (found.endless, found.waits) == (False, True)


def test_what_the_longest_is_made_of() -> None:
    budgets, root = budget("->\n    A\n    Repeat (num_cycles = 3)\n        B\n    Condition C")
    longest = budgets.of(root).anything
    assert longest is not None
    assert [(term.node.shown, term.times, term.seconds) for term in longest.terms] == [
        ("`A`", 1, 2),
        ("`Repeat`", 1, 15),
    ]
    (repeat,) = (term.node for term in longest.terms if term.times == 1 and term.seconds == 15)
    inner = budgets.of(repeat).anything
    assert inner is not None
    assert [(term.node.shown, term.times, term.seconds) for term in inner.terms] == [("`B`", 3, 5)]


@pytest.mark.parametrize(
    ("clauses", "success", "failure", "probability"),
    [
        ("takes at most 2 s", (0, 2), (0, 2), 1.0),
        ("takes less than 2 s\n    takes at least 1 s", (1, 2), (1, 2), 1.0),
        ("takes at most 2 s if now else 4 s", (0, 4), (0, 4), 1.0),
        ("takes at most 2 s\n    while now", (0, inf), (0, inf), 1.0),
        ("takes at most 2 s\n    in at least 90 % of activations", (0, 2), (0, 2), 0.9),
        ("succeeds within 2 s", (0, 2), (0, inf), 1.0),
        ("takes at most 2 s\n    takes at least 3 s", (3, inf), (3, inf), 1.0),
    ],
)
def test_what_a_node_is_held_to(clauses: str, success: object, failure: object, probability: float) -> None:
    named = clauses.replace("takes", "every A takes").replace("succeeds", "every A succeeds")
    budgets, root = budget("A", f'signal now : bool\nQualityReq a "t"\n    {named}\n')
    found = budgets.of(root)
    assert (pair(found.success), pair(found.failure), found.probability) == (success, failure, probability)


def test_a_bound_of_its_own_stands_for_what_is_below() -> None:
    rules = LEAVES + 'QualityReq c "t"\n    Steps takes at most 6 s\n'
    budgets, root = budget("->\n    -> Steps\n        A\n        B\n    A", rules)
    assert pair(budgets.of(root).success) == (5, 8)
    (steps, _) = root.children
    assert pair(budgets.composed(steps).success) == (4, 7)


def test_the_union_bound() -> None:
    rules = LEAVES.replace("2 s\n", "2 s\n    in at least 98 % of activations\n")
    budgets, root = budget("->\n    A\n    Repeat (num_cycles = 3)\n        A\n    B", rules)
    assert budgets.of(root).probability == pytest.approx(0.92)
    assert budgets.of(root).anything == budgets.composed(root).anything
    budgets, root = budget("Retry (num_attempts = -1)\n    A", rules)
    assert budgets.composed(root).probability == 0.0
    assert (budgets.of(root).probability, pair(budgets.of(root).success)) == (1.0, (0, inf))


def test_success() -> None:
    rules = """
QualityReq a "t"
    every A succeeds within 2 s
    in at least 98 % of activations
QualityReq b "t"
    every B succeeds
"""
    budgets, root = budget("->\n    A\n    Repeat (num_cycles = 3)\n        A\n    Script (code = x)", rules)
    found = budgets.success(root)
    assert found is not None
    assert found.seconds == 8
    assert found.probability == pytest.approx(0.92)
    assert [(node.shown, share) for node, share in found.parts] == [
        ("`A`", pytest.approx(0.02)),
        ("`Repeat`", pytest.approx(0.06)),
        ("`Script`", 0.0),
    ]
    budgets, root = budget("->\n    A\n    B", rules)
    assert (found := budgets.success(root)) is not None
    assert (found.seconds, found.probability) == (inf, 0.98)
    for tree in ("->\n    A\n    X", "?\n    A\n    B", "->\n    A (_skipIf = x)"):
        budgets, root = budget(tree, rules)
        assert budgets.success(root) is None
