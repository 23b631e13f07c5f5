"""Random missions with budgets, and what their requirements come to."""

from __future__ import annotations

import random
import re
from collections.abc import Callable, Sequence
from pathlib import Path

from hypothesis import strategies as st
from requirement_problems import problems_of
from simulated_runs import SimulatedRuns

from btq_lang.catalog.nav2 import FILES
from btq_lang.requirements.model import Quantity
from btq_lang.requirements.resolve import Requirements, requirements
from btq_lang.scenarios.mission import ScenarioMission
from btq_lang.simulator.blackboard import BOOL
from btq_lang.simulator.nodes import FAILURE, SKIPPED, SimulatedNode
from btq_lang.simulator.ports import write
from btq_lang.simulator.ticking import reset_child
from btq_lang.workspace.config import Project
from btq_lang.workspace.file import File
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace

NAV2 = File(FILES["lyrical"], Path(FILES["lyrical"]).read_text(encoding="utf-8"))

# What the kinds of nodes with children have in common where trees are drawn.
GROUPS = {
    "order": ("->", "?", "M->", "A->", "A?"),
    "reactive": ("R->", "R?"),
    "parallel": ("||", "All||"),
    "one": (
        *("Timeout", "Delay", "Retry", "Repeat", "Inverter", "ForceSuccess", "ForceFailure"),
        *("KeepRunningUntilFailure", "RunOnce", "Precondition"),
    ),
    "other": ("IfThenElse", "WhileDoElse", "TryCatch", "Switch"),
    "many of Nav2": ("PipelineSequence", "RoundRobin", "NonblockingSequence", "PersistentSequence"),
    "two of Nav2": ("RecoveryNode",),
    "one of Nav2": ("RateController", "DistanceController", "PathLongerOnApproach", "SingleTrigger"),
    "leaf": ("SubTree",),
}


def leaf(draw: st.DrawFn) -> str:
    kind = draw(st.sampled_from(["action", "action", "action", "condition", "sleep", "AlwaysSuccess", "AlwaysFailure"]))
    if kind == "action":
        low = draw(st.integers(0, 8))
        high = low + draw(st.integers(0, 8))
        return f"Action L satisfies QualityReq @ takes between {low / 4} s and {high / 4} s"
    if kind == "condition":
        return "Condition C"
    return f"Sleep (msec = {draw(st.integers(0, 8)) * 250})" if kind == "sleep" else kind


def tree(draw: st.DrawFn, depth: int, sub: bool, may_skip: bool = True, top: str = "") -> list[str]:
    """The lines of a node with all below it.

    Args:
        sub: SubTree nodes may be among them.
        may_skip: it may be skipped.
        top: its kind; any by default.
    """

    def below(count: int = 1, skipping: bool = True) -> list[list[str]]:
        return [tree(draw, depth - 1, sub, skipping) for _ in range(count)]

    def one_of(choices: Sequence[str]) -> str:
        return draw(st.sampled_from([each for each in choices if each.split()[0] == top] or choices))

    group = next((group for group, kinds in GROUPS.items() if top in kinds), "leaf")
    if not top and depth:
        groups = [*GROUPS, "order"]
        group = draw(st.sampled_from(groups))
    children: list[list[str]] = []
    if group == "leaf":
        is_subtree = top == "SubTree" or (sub and draw(st.integers(0, 4)) == 0 and may_skip)
        head = "SubTree Sub" if is_subtree else leaf(draw)
    elif group == "order":
        head, children = one_of(GROUPS["order"]), below(draw(st.integers(1, 3)))
    elif group == "reactive":
        head = one_of(GROUPS["reactive"])
        first, *others = below(draw(st.integers(1, 2)))
        for other in others:
            other[0] = other[0].replace("A->", "->")  # the engine refuses two that are asynchronous
        children = [["Condition C"] for _ in range(draw(st.integers(0, 2)))] + [first, *others]
    elif group == "parallel":
        count = draw(st.integers(1, 3))
        children = below(count)
        head = f"|| (success_count = {draw(st.sampled_from([-1, *range(1, count + 1)]))} failure_count = "
        head += f"{draw(st.sampled_from([-1, *range(1, count + 1)]))})"
        if one_of(GROUPS["parallel"]) == "All||":
            head = f"All|| (max_failures = {draw(st.integers(-1, count))})"
    elif group == "one":
        milliseconds = draw(st.integers(0, 12)) * 250
        count = draw(st.sampled_from([-1, 0, 1, 2, 3]))
        choices = [f"Timeout (msec = {milliseconds})", f"Delay (delay_msec = {milliseconds})"] * 2
        choices += [f"Retry (num_attempts = {count})", f"Repeat (num_cycles = {count})"] * 2
        choices += ["Inverter", "ForceSuccess", "ForceFailure", "KeepRunningUntilFailure", "RunOnce"]
        choices += [
            "RunOnce (then_skip = false)",
            'Precondition (if = "!@x" else = SKIPPED)',
            'Precondition (if = "!@x")',
        ]
        head = one_of(choices)
        children = below(skipping=may_skip)
        if not may_skip and ("SKIPPED" in head or head == "RunOnce" or "= 0)" in head):
            head = "Inverter"
    elif group.endswith("of Nav2"):
        head, children = draw_of_nav2(draw, one_of(GROUPS[group]), below)
    else:
        head = one_of(GROUPS["other"])
        children = below(1, head == "TryCatch") + below(draw(st.integers(1, 2)))
        if head == "WhileDoElse":  # it asks a condition that takes time in every tick, and starves the branch meanwhile
            children[0] = ["Condition C"]
        if head == "Switch":
            head, children = "Switch2 (variable = {v} case_1 = a case_2 = b)", below(3)
    if group not in ("leaf", "one") and not may_skip:
        return ["Condition C"]
    if may_skip and not head.startswith("SubTree") and draw(st.integers(0, 5)) == 0:
        attribute = draw(
            st.sampled_from(['_skipIf = "@x"', '_while = "!@x"', '_failureIf = "@x"', '_successIf = "@x"'])
        )
        head = f"{head[:-1]} {attribute})" if head.endswith(")") else head
        if head == "Condition C":
            head = f"Condition C ({attribute})"
    return [head, *(f"    {line}" for child in children for line in child)]


def draw_of_nav2(
    draw: st.DrawFn, kind: str, below: Callable[[int, bool], list[list[str]]]
) -> tuple[str, list[list[str]]]:
    """The head of a node of Nav2, and its children."""
    if kind == "RecoveryNode":
        return f"{kind} (number_of_retries = {draw(st.integers(0, 2))})", below(2, True)
    if kind == "PathLongerOnApproach":
        return f"{kind} (path = {{p}})", below(1, True)
    if kind in GROUPS["one of Nav2"]:
        return kind, below(1, True)
    children = below(draw(st.integers(1, 3)), kind != "NonblockingSequence")  # which throws if one is skipped
    if kind == "PersistentSequence":
        kind += " (current_child_idx = {at})"
    elif kind == "RoundRobin" and draw(st.booleans()):
        kind += " (wrap_around = true)"
    return kind, children


@st.composite
def missions(draw: st.DrawFn, top: str = "") -> str:
    lines = ["BehaviorTree Main", *(f"    {line}" for line in tree(draw, 3, True, top=top))]
    lines += ["BehaviorTree Sub", *(f"    {line}" for line in tree(draw, 1, False))]
    numbered = (
        _OWN.sub(rf"\g<1>{number}", line.replace("@ takes", f"q{number} takes")) for number, line in enumerate(lines)
    )
    return "\n".join(numbered) + "\n"


_OWN = re.compile(r"(@x|\{v|\{at|\{p)\b")  # entries, of which each node has one of its own


class WildRuns(SimulatedRuns):
    """Runs in which leaves take what their `takes between` allows, and entries and the robot change at random.

    What budgets leave out does not occur: a RateController that its parent has not reset lets its child begin, a timer
    is not that of an activation before, which was skipped, and a DistanceController halts its child when it fails.
    """

    def __init__(self, mission: ScenarioMission, seed: int) -> None:
        chance = random.Random(seed)
        super().__init__(mission, chance, is_stateful=chance.random() < 0.5)
        self.limits = {applied.node: applied.requirement.claims[0].limit for applied in mission.requirements.applied}
        self.entries = re.findall(r"@(x\d+)", mission.workspace.files[mission.path].source)
        for node in self.machine.nodes:
            write(node, "current_child_idx", 0, "int")
        self.change()

    def change(self) -> None:
        """The world is another one."""
        self.machine.world.position = (self.chance.random() * 1e6, 0.0) if self.chance.random() < 0.9 else None
        for entry in self.entries:
            self.machine.root.board.write(entry, int(self.chance.random() < 0.3), BOOL)

    def drawn(self, leaf: ResolvedNode) -> float:
        """A duration that the leaf's `takes between` allows, often one of the ends."""
        limit = self.limits[leaf]
        assert limit is not None
        assert isinstance(limit.value, Quantity)
        assert isinstance(limit.upper, Quantity)
        low, high = limit.value.si, limit.upper.si
        return self.chance.choice([low, high, self.chance.randint(int(low * 4), int(high * 4)) / 4])

    def ticked(self, node: SimulatedNode) -> int:
        if node.id == "RateController" and node.uid not in self.started:
            node.due = self.machine.now
        self.change()
        result = super().ticked(node)
        if result == SKIPPED and node.rules.is_timed:
            reset_child(self.machine, node)
        elif result == FAILURE and node.id == "DistanceController":
            reset_child(self.machine, node.child)
        return result

    def began(self, node: SimulatedNode) -> None:
        super().began(node)
        if node.id == "PathLongerOnApproach":
            length = self.chance.choice([2, 5, 12])
            write(node, "path", f"{length};{length};0;0", "nav_msgs::msg::Path")


def mission_of(text: str) -> ScenarioMission:
    """A mission as it is written, without guards."""
    return ScenarioMission(workspace_with_nav2(text), "main.btq", "Main", is_enforced=False)


def resolved(text: str) -> Requirements:
    found = requirements(workspace_with_nav2(text), "main.btq")
    assert not problems_of(found)
    return found


def workspace_with_nav2(text: str) -> Workspace:
    workspace = Workspace({"main.btq": File("main.btq", text), NAV2.path: NAV2}, Project(node_files=(NAV2.path,)))
    assert workspace.files["main.btq"].parsed.diagnostics == ()
    return workspace
