"""Guards on values that never change: reported only if no run might write what they read, and always then."""

from __future__ import annotations

from contextlib import suppress

import pytest
from budget_missions import WildRuns, mission_of, missions
from check_asserts import findings, problems
from hypothesis import given
from hypothesis import strategies as st
from simulated_runs import Endless

from btq_lang.checks import check
from btq_lang.scenarios.mission import ScenarioMission
from btq_lang.simulator.nodes import SimulatedNode
from btq_lang.workspace.workspace import Workspace

RULE = "guard-never-renewed"
GUARD = "signal n : 1 from {level} initially 0\nQualityReq q\n    A keeps n <= 3\n    on violation halt\n"
DECLARED = "Condition S\n    output out : double\nCondition I\n    input in : double\n"
W = "Condition S (out = {level})"


def told(tree: str, others: str = "", guard: str = GUARD) -> list[str]:
    lines = "".join(f"    {line}\n" for line in tree.split("\n"))
    return findings(f"{guard}Root Main\nBehaviorTree Main\n{lines}{others}", RULE)


MESSAGE = "no node writes `level` while `A` runs, so the result is fixed when the node starts"
TOLD = [f"3 warning «A keeps n <= 3» {MESSAGE}"]


@pytest.mark.parametrize(
    "tree",
    [
        f"->\n    {W}\n    Action A",
        f"->\n    Action A\n    {W}",
        f"?\n    {W}\n    Action A",
        f"M->\n    {W}\n    Action A",
        f"A->\n    {W}\n    Action A",
        f"IfThenElse\n    {W}\n    Action A",
        f"Switch2 (variable = {{v}} case_1 = a case_2 = b)\n    {W}\n    Action A\n    Action B",
        f"Repeat (num_cycles = 3)\n    ->\n        {W}\n        Timeout (msec = 5 s)\n            Action A",
        f"||\n    ->\n        {W}\n        Action A\n    Action B",
        f"R->\n    Condition C\n    ->\n        {W}\n        Action A",
        "->\n    Action A\n    Condition S (out = {@level})",
        '->\n    Script (code = "level := 2.0")\n    Action A',
        '->\n    Action B (_onSuccess = "@level := 2.0")\n    Action A',
        "->\n    SetBlackboard (value = 2 output_key = level)\n    Action A",
        f"->\n    {W}\n    Action B (any = {{level}})\n    Action A",
        f"->\n    {W}\n    {W}\n    Action A",
        '->\n    Action B (any = {level} _onSuccess = "level := 1.0")\n    Action A',
        f"->\n    {W}\n    Condition I (in = {{level}})\n    Action A",
        f"->\n    {W}\n    UnsetBlackboard (name = level key = other)\n    Action A",
    ],
)
def test_what_is_written_before_or_after(tree: str) -> None:
    assert told(tree, DECLARED) == TOLD


@pytest.mark.parametrize(
    "tree",
    [
        "->\n    Condition C\n    Action A",  # the robot's program writes it
        "->\n    Action B (any = {level})\n    Action A",  # which may only read it
        f"->\n    {W}\n    R->\n        Action B (any = {{level}})\n        Action A",
        f"R->\n    {W}\n    Action A",
        f"R?\n    {W}\n    Action A",
        f"R->\n    Action A\n    {W}",  # it may be halted then, and write
        f"||\n    {W}\n    Action A",
        f"All||\n    {W}\n    -> Deep\n        ?\n            Action A",
        f"WhileDoElse\n    {W}\n    Action A",
        f"TryCatch\n    {W}\n    Action A",
        f"Control Mine\n    {W}\n    Action A",  # it is unknown
        f"->\n    {W}\n    Decorator Mine (speed = {{level}})\n        Action A",
        f'->\n    {W}\n    -> Inner (_while = "level := 1.0")\n        Action A',
        f"->\n    {W}\n    Action A (level = {{=}})",
        f"->\n    {W}\n    Action A\n    xml '<Extra out=\"{{level}}\"/>'",
        f"->\n    {W}\n    SetBlackboard (value = 2 output_key = {{which}})\n    Action A",
        f"->\n    {W}\n    Parallel\n        Action B (entry = level)\n        Action A",  # may write what it is called
        f"->\n    {W}\n    UnsetBlackboard (key = level)\n    Action A",
        f"R->\n    ||\n        Condition C\n        {W}\n    -> Inner\n        {W}\n        Action A",
    ],
)
def test_what_may_be_written_meanwhile(tree: str) -> None:
    assert told(tree, DECLARED) == []


@pytest.mark.parametrize(
    ("clauses", "expected"),
    [
        ("A keeps n <= 3|on violation fail", True),
        ("A never n > 3|on violation halt", True),
        ("A leaves n <= 3|on violation halt", True),
        ("A uses at most 3 of used|on violation halt", True),
        ("A needs n <= 3|on violation halt", False),  # evaluated once, as intended
        ("A takes at most 3 s if n <= 3 else 5 s|on violation halt", False),
        ("A keeps n <= 3", False),
        ("A keeps n <= 3|on violation warn", False),
        ("A keeps n <= 3|in at least 9 % of runs|on violation halt", False),  # that is not enforced
        ("A keeps n <= 3|while m > 2|on violation halt", False),  # the program writes m
        ("A keeps n <= 3|when m > 2|on violation halt", True),  # which is read at the start
        ("A keeps n <= 3|while n > 2|on violation halt", True),
        ("A keeps n + m <= 3|on violation halt", False),
    ],
)
def test_which_claims_are_guards(clauses: str, *, expected: bool) -> None:
    signals = "signal n : 1 from {level} initially 0\nsignal m : 1 from {other} initially 0\n"
    signals += "signal used : 1 from {level} counter initially 0\n"
    text = signals + "QualityReq q\n" + "".join(f"    {clause}\n" for clause in clauses.split("|"))
    found = told(f"->\n    {W}\n    Action A", DECLARED, text)
    assert len(found) == expected
    assert all(each.endswith(MESSAGE) for each in found)


@pytest.mark.parametrize(
    ("tree", "part", "expected"),
    [
        # The guarded node in another tree.
        (f"->\n    {W}\n    SubTree Part", "Action A", True),
        (f"R->\n    {W}\n    SubTree Part", "Action A", False),
        (
            f"->\n    {W}\n    SubTree Part\n    ||\n        {W}\n        SubTree Part",
            "Action A",
            False,
        ),  # once is enough
        (f"->\n    {W}\n    SubTree Part (x = {{level}})", "Action A", False),  # what is in it may write it
        # The writer in another tree.
        ("->\n    SubTree Made (out = {level})\n    Action A", W.replace("level", "out"), True),
        ("R->\n    SubTree Made (out = {level})\n    Action A", W.replace("level", "out"), False),
        ("->\n    SubTree Part (out = {level})\n    Action A", W.replace("level", "out"), False),
        ("->\n    SubTree Part (_autoremap = true)\n    Action A", W, True),
        ("||\n    SubTree Part (_autoremap = true)\n    Action A", W, False),
        ("->\n    SubTree Part\n    Action A", W.replace("level", "@level"), True),
        ("||\n    SubTree Part\n    Action A", W.replace("level", "@level"), False),
        ("->\n    SubTree Part\n    Action A", W, False),  # an entry of its own, see signal-never-written
        # A tree that the mission does not run may belong to another one beside it.
        (f"->\n    {W}\n    Action A", W, False),
    ],
)
def test_other_trees(tree: str, part: str, *, expected: bool) -> None:
    name = "Made\n    output out : double" if "Made" in tree else "Part"  # one says that it writes, the other nothing
    assert told(tree, f"{DECLARED}BehaviorTree {name}\n    {part}\n") == (TOLD if expected else [])


@pytest.mark.parametrize(("parent", "expected"), [("->", TOLD), ("||", [])])
def test_a_tree_below_another_tree(parent: str, expected: list[str]) -> None:
    others = f"BehaviorTree Part\n    SubTree Inner\nBehaviorTree Inner\n    {W.replace('level', '@level')}\n"
    assert told(f"{parent}\n    SubTree Part\n    Action A", DECLARED + others) == expected


def test_a_default_may_be_an_entry() -> None:
    tree = f"->\n    {W}\n    R->\n        Condition D\n        Action A"
    assert told(tree, DECLARED + "Condition D\n    output now : double\n") == TOLD
    assert told(tree, DECLARED + 'Condition D\n    output now : double = "{level}"\n') == []
    assert told(tree, DECLARED + 'Condition D\n    output level : double = "{=}"\n') == []


def test_files() -> None:
    rules = GUARD.replace("    A keeps", "    keeps")
    skills = "Condition S\n    output out : double\nAction A\n"
    main = f'include "rules.btq"\ninclude "skills.btq"\nBehaviorTree Main\n    ->\n        {W}\n        A'
    (found,) = problems(f"{main} satisfies q\n", RULE, rules=rules, skills=skills)
    assert found.message == MESSAGE
    assert [each.message for each in found.related] == ["writes it, but not while the node runs", "guarded node"]
    # Attached in the other file: reported at the node.
    both = f'include "skills.btq"\n{rules}apply q to every A\n'
    assert findings(f"{main}\n", RULE, rules=both, skills=skills) == [f"6 warning «A» {MESSAGE}"]
    # With the node in the other file, too: reported at what writes the entry.
    part = f"{both}BehaviorTree Part\n    A\n"
    calls = f"{main[:-1]}SubTree Part\n"
    assert findings(calls, RULE, rules=part, skills=skills) == [f"5 warning «S» {MESSAGE}"]
    # In a file that others include these may write it, and in one that is gone others may.
    written = f"{rules}BehaviorTree Main\n    ->\n        {W}\n        A satisfies q\n"
    assert findings(f'include "skills.btq"\n{written}', RULE, skills=skills) == [f"4 warning «keeps n <= 3» {MESSAGE}"]
    workspace = Workspace.of(
        {"a.btq": 'include "b.btq"\n', "b.btq": f'include "skills.btq"\n{written}', "skills.btq": skills}
    )
    assert [each for path in workspace.files for each in check(workspace, path) if each.rule == RULE] == []
    assert findings(f'include "skills.btq"\ninclude "gone.btq"\n{written}', RULE, skills=skills) == []


@given(missions(), st.integers(0, 1000), st.data())
def test_no_run_writes_what_is_said_to_stay(text: str, seed: int, data: st.DataObject) -> None:
    lines = text.split("\n")
    leaves = [at for at, line in enumerate(lines) if line.strip() == "Condition C" or "Action L" in line]
    nodes = [at for at, line in enumerate(lines) if line[:1] == " " and "SubTree" not in line]
    if not leaves or len(nodes) < 2:
        return
    writer, guarded = data.draw(st.sampled_from(leaves)), data.draw(st.sampled_from(nodes))
    for leaf in ("Condition C", "Action L"):
        lines[writer] = lines[writer].replace(leaf, f'{leaf} (w = {{@n}} _onSuccess = "@n := 1.0")')
    head, satisfies, rest = lines[guarded].partition(" satisfies")
    lines[guarded] = f"{head} tags g{satisfies}{rest}"
    trees = "\n".join(lines)
    guard = "signal n : 1 from {n} initially 0\nQualityReq guard\n    keeps n <= 3\n    on violation halt\n"
    if findings(f"{trees}{guard}apply guard to every node tagged g\nRoot Main\n", RULE):
        assert not _writes_meanwhile(trees, seed)


@pytest.mark.parametrize(("parent", "expected"), [("R->", True), ("->", False)])
def test_runs_show_who_writes_meanwhile(parent: str, *, expected: bool) -> None:
    writer = 'Condition C (w = {@n} _onSuccess = "@n := 1.0")'
    action = "Action L tags g satisfies QualityReq q takes between 1 s and 2 s"
    assert _writes_meanwhile(f"BehaviorTree Main\n    {parent}\n        {writer}\n        {action}\n", 0) is expected


def _writes_meanwhile(text: str, seed: int) -> bool:
    """Whether, in some runs, the writer is ticked while the node with the tag runs."""
    runs = _WatchedRuns(mission_of(text), seed)
    with suppress(Endless):
        for _ in range(5):
            runs.run()
    return runs.writes_meanwhile


class _WatchedRuns(WildRuns):
    def __init__(self, mission: ScenarioMission, seed: int) -> None:
        super().__init__(mission, seed)
        self.writes_meanwhile = False
        (guarded,) = mission.requirements.nodes.tagged("g")
        self.guarded = {uid for uid, node in mission.written.items() if node is guarded}

    def ticked(self, node: SimulatedNode) -> int:
        if "w" in node.ports and self.guarded & self.started.keys():
            self.writes_meanwhile = True
        return super().ticked(node)
