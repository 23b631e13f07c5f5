"""Random missions with budgets, and what their requirements come to."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from hypothesis import strategies as st
from requirement_problems import problems_of

from btq_lang.catalog.nav2 import FILES
from btq_lang.requirements.resolve import Requirements, requirements
from btq_lang.workspace.config import Project
from btq_lang.workspace.file import File
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
    "one of Nav2": ("RateController", "DistanceController", "GoalUpdater", "PathLongerOnApproach", "SingleTrigger"),
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
        children = [["Condition C"] for _ in range(draw(st.integers(0, 2)))] + below(draw(st.integers(1, 2)))
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
            'Precondition (if = "@x" else = SKIPPED)',
            'Precondition (if = "@x")',
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
        attribute = draw(st.sampled_from(["_skipIf", "_while", "_failureIf", "_successIf"]))
        head = f'{head[:-1]} {attribute} = "@x")' if head.endswith(")") else head
        if head == "Condition C":
            head = f'Condition C ({attribute} = "@x")'
    return [head, *(f"    {line}" for child in children for line in child)]


def draw_of_nav2(
    draw: st.DrawFn, kind: str, below: Callable[[int, bool], list[list[str]]]
) -> tuple[str, list[list[str]]]:
    """The head of a node of Nav2, and its children."""
    if kind == "RecoveryNode":
        return f"{kind} (number_of_retries = {draw(st.integers(0, 2))})", below(2, True)
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
    numbered = (line.replace("@ takes", f"q{number} takes") for number, line in enumerate(lines))
    return "\n".join(numbered) + "\n"


def resolved(text: str) -> Requirements:
    workspace = Workspace({"main.btq": File("main.btq", text), NAV2.path: NAV2}, Project(node_files=(NAV2.path,)))
    assert workspace.files["main.btq"].parsed.diagnostics == ()
    found = requirements(workspace, "main.btq")
    assert not problems_of(found)
    return found
