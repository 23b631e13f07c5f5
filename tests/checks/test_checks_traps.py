"""The traps of the engine's semantics, and where there is none: a false alarm costs more than a missed trap."""

from __future__ import annotations

from pathlib import Path

import pytest
from check_asserts import after, findings, problems

from btq_lang.checks import check
from btq_lang.projects.opening import open_workspace
from btq_lang.workspace.config import Project

TRAPS = (
    *("reactive-multiple-async", "one-shot-monitor", "while-skip-is-success", "unreachable-child"),
    "condition-without-recheck",
)


def tree(*lines: str) -> str:
    return "BehaviorTree Main\n" + "".join(f"    {line}\n" for line in lines)


# ---- reactive-multiple-async ----

REACTIVE = "reactive-multiple-async"


@pytest.mark.parametrize(
    "lines",
    [
        ("R->", "    Condition Ok", "    Action Work"),
        ("R->", "    Unknown", "    Action Work"),
        ("R->", '    ScriptCondition (code = "x")', "    Script (code = 'y := 1')", "    Sleep (msec = 1 s)"),
        ("R?", "    -> A", "        Condition Low", "        Action Charge", "    -> B", "        Action Work"),
        # Priorities, the one with a guard that is asked all the while.
        ("R?", "    R-> A", "        Condition Low", "        Action Charge", "    -> B", "        Action Work"),
        (
            "R->",
            "    ?",
            "        Condition Done",
            "        Action Do",
            "    ?",
            "        Condition B",
            "        Action B2",
        ),
        ("R->", "    RunOnce", "        Action Greet", "    Action Work"),
        ("R->", '    Action Greet (_skipIf = "greeted")', "    Action Work"),
        ("R->", '    Action Greet (_successIf = "greeted")', "    Action Work"),
        ("R->", "    Action Work", "    Condition Ok", "    Script (code = 'x := 1')"),
        ("R->", "    Repeat (num_cycles = 1)", "        Condition Ok", "    Action Work"),
        ("R->", "    SubTree Elsewhere", "    Action Work"),
        ("R->", "    RateController", "        Action Plan", "    Action Work"),
        ("R->", "    Action Work"),
        ("->", "    Action A", "    Action B"),
        ("R->", "    xml '<A/>'", "    Action B"),
        ("R->",),
    ],
    ids=" ".join,
)
def test_one_child_at_most_takes_its_time(lines: tuple[str, ...]) -> None:
    assert findings(tree(*lines), REACTIVE) == []


@pytest.mark.parametrize(
    "first",
    [
        ("Sleep (msec = 1 s)",),
        ("Delay (delay_msec = {pause})", "    Condition Ok"),
        ("Timeout (msec = 1 s)", "    Action Greet"),
        ("Repeat (num_cycles = 3)", "    Condition Ok"),
        ("A->", "    Script (code = 'x := 1')", "    Script (code = 'y := 1')"),
        ("->", "    Condition Ok", "    Sleep (msec = 1 s)"),
        ("SubTree Pause",),
    ],
    ids=" ".join,
)
def test_what_surely_takes_more_than_a_tick_gives_a_warning(first: tuple[str, ...]) -> None:
    text = tree("R->", *(f"    {line}" for line in first), "    Action Work") + (
        "\nBehaviorTree Pause\n    Sleep (msec = 1 s)\n"
    )
    name = first[0].split(" (")[0].removeprefix("SubTree ")
    message = f"`Work` never gets beyond its first tick: `{name}` restarts and halts it"
    assert findings(text, REACTIVE) == [f"{len(first) + 3} warning «Work» {message}"]


def test_an_action_may_complete_at_once_so_it_gives_a_hint() -> None:
    text = tree("R?", "    Action GoTo", "    Condition Ok", "    -> Rest", "        Action Park")
    assert findings(text, REACTIVE) == [
        "5 hint «->» if `GoTo` takes longer than one tick, it restarts whenever `-> Rest` is RUNNING, and halts it"
    ]
    (found,) = problems(text, REACTIVE)
    assert [text[related.place.span.start : related.place.span.end] for related in found.related] == ["GoTo"]


def test_placeholders_are_actions_and_conditions() -> None:
    assert (
        findings(tree("R->", '    ScriptCondition (name = "Ok?")', '    ScriptAction (name = "Work")'), REACTIVE) == []
    )
    text = tree("R->", '    ScriptAction (name = "GoTo")', '    ScriptAction (name = "Work")')
    assert len(findings(text, REACTIVE)) == 1


def test_an_action_known_by_its_model() -> None:
    text = "Action GoTo\n\nCondition Ok\n\n" + tree("R->", "    {}", "    GoTo")
    assert len(findings(text.replace("{}", "GoTo"), REACTIVE)) == 1
    assert findings(text.replace("{}", "Ok"), REACTIVE) == []


def test_the_engine_refuses_a_second_async_sequence() -> None:
    text = tree("R->", "    A->", "        Condition Ok", "    AsyncSequence", "        Action Work")
    assert findings(text, REACTIVE) == ["5 error «AsyncSequence» the engine refuses a second AsyncSequence in `R->`"]
    assert findings(text, REACTIVE, project=Project(engines=("4.6",))) == []
    assert findings(text.replace("R->", "R?"), REACTIVE) == []


# ---- condition-without-recheck ----

RECHECK = "condition-without-recheck"
PRIORITY = ("?", "    -> Recharge", "        Condition Low", "        Action Charge", "    Action Work")


def test_a_choice_at_the_top_of_a_mission() -> None:
    message = "while `Work` runs, `Low` is not checked again"
    assert findings(tree(*PRIORITY), RECHECK) == [f"2 hint «?» {message}"]
    inside = ("Repeat (num_cycles = -1)", "    R->", "        Condition Ok", *(f"        {line}" for line in PRIORITY))
    assert findings(tree(*inside), RECHECK) == [f"5 hint «?» {message}"]


@pytest.mark.parametrize(
    ("kind", "mended"),
    [("?", "R?"), ("Fallback", "ReactiveFallback"), ('"Fallback"', '"ReactiveFallback"'), ("A?", "R?")],
)
def test_the_fix_asks_at_every_tick(kind: str, mended: str) -> None:
    text = tree(kind, *PRIORITY[1:])
    (found,) = problems(text, RECHECK)
    (fix,) = found.fixes
    assert (fix.safe, after(text, fix)) == (False, tree(mended, *PRIORITY[1:]))
    assert problems(after(text, fix), *TRAPS) == []


WATCHED_DRIVE = ("    R->", "        Condition NotCancelled", "        Action Drive")
GIVE_UP = ("    -> GiveUp", "        Action CallOperator", "        AlwaysFailure")


@pytest.mark.parametrize("other", [WATCHED_DRIVE, ("    Action Drive",), ("    SubTree Elsewhere",)], ids=" ".join)
def test_no_fix_where_another_branch_would_start_again(other: tuple[str, ...]) -> None:
    """While `GiveUp` runs, `R?` would start `Drive` again at the next tick."""
    for lines in ((*PRIORITY[1:4], *other, *GIVE_UP), (*other, *PRIORITY[1:4], *GIVE_UP)):
        (found,) = problems(tree("?", *lines), RECHECK)
        assert found.message.endswith(", `Low` is not checked again")
        assert found.fixes == ()


def test_the_last_branch_may_take_its_time() -> None:
    (found,) = problems(tree(*PRIORITY[:4], *GIVE_UP), RECHECK)
    assert [fix.title for fix in found.fixes] == ["Check at every tick: `R?`"]


@pytest.mark.parametrize(
    "lines",
    [
        ("R?", *PRIORITY[1:]),
        # "Charge unless it is enough": the condition alone is what the next child brings about.
        ("?", "    Condition BatteryOk", "    Action Charge"),
        ("?", "    Inverter", "        Condition Low", "    Action Charge"),
        # The later branch completes at once.
        ("?", "    ->", "        Condition Low", "        Action Charge", "    Script (code = 'x := 1')"),
        # No condition in front.
        ("?", "    ->", "        Action Look", "        Condition Low", "    Action Work"),
        ("?", "    ->", "        Unknown", "        Action Charge", "    Action Work"),
        ("?", "    ->", "        Condition Low", "    Action Work"),
        # What to do when a branch has failed that is watched all the while.
        ("?", *WATCHED_DRIVE, *GIVE_UP),
        ("?", "    Condition IsDocked", *WATCHED_DRIVE, *GIVE_UP),
        ("?", "    ->", *(f"    {line}" for line in WATCHED_DRIVE), *GIVE_UP),
        # A step of a longer plan.
        ("->", "    Action Start", *(f"    {line}" for line in PRIORITY)),
        ("?", *(f"    {line}" for line in PRIORITY), "    Action Call"),
        ("?",),
    ],
    ids=" ".join,
)
def test_other_choices_are_meant_to_be_made_once(lines: tuple[str, ...]) -> None:
    assert findings(tree(*lines), RECHECK) == []


def test_only_the_mission_has_priorities() -> None:
    text = "BehaviorTree Top\n    SubTree Main\n\n" + tree(*PRIORITY)
    assert findings(text, RECHECK) == []


@pytest.mark.parametrize("decorator", ["", "Inverter", "Timeout (msec = 5 s)"])
def test_a_node_that_resumes_after_a_halt_gets_further(decorator: str) -> None:
    """Run in 4.6 and 4.10: two of SequenceWithMemory in a ReactiveSequence succeed."""
    steps = ("Sleep (msec = 10)", "Sleep (msec = 10)")
    first = ("    M->", *(f"        {step}" for step in steps))
    lines = first if not decorator else (f"    {decorator}", *(f"    {line}" for line in first))
    assert findings(tree("R->", *first, *lines), REACTIVE) == []
    plain = [line.replace("M->", "->") for line in lines]
    assert len(findings(tree("R->", *first, *plain), REACTIVE)) == 1


# ---- one-shot-monitor ----


@pytest.mark.parametrize(
    ("node", "severity"),
    [
        ('Action Work (_failureIf = "x > 1")', "warning"),
        ('Work (_failureIf = "x > 1")', "warning"),
        ('ScriptAction (name = "Work" _failureIf = "x > 1")', "warning"),
        ('SubTree Elsewhere (_failureIf = "x > 1")', "warning"),
        ('Sleep (msec = 1 s _failureIf = "x > 1")', "warning"),
        ('-> (_failureIf = "x > 1")\n        Action Work', "warning"),
        ('Inverter (_failureIf = "x > 1")\n        Action Work', "warning"),
        ('Action Work (_successIf = "x > 1")', "hint"),
    ],
)
def test_a_node_that_runs_is_asked_once(node: str, severity: str) -> None:
    (found,) = findings(tree(node), "one-shot-monitor")
    assert found.startswith(f"2 {severity} «_{'failure' if severity == 'warning' else 'success'}If» ")


@pytest.mark.parametrize(
    "node",
    [
        'Condition Ok (_failureIf = "x > 1")',
        'ScriptCondition (code = "y" _failureIf = "x > 1")',
        'Script (code = "y := 1" _successIf = "x > 1")',
        '-> (_failureIf = "x > 1")\n        Condition Ok\n        Script (code = "y := 1")',
        'Action Work (_skipIf = "x > 1" _while = "x < 2" _onFailure = "y := 1")',
        'Action Work (_failureIf = "false")',
        "Action Work (_failureIf = )",
    ],
)
def test_a_node_that_completes_at_once_or_another_attribute(node: str) -> None:
    assert findings(tree(node), "one-shot-monitor") == []


# ---- while-skip-is-success ----

WHILE = "while-skip-is-success"
WATCHED = 'Action Work (_while = "x")'


@pytest.mark.parametrize("parent", ["->", "M->", "A->", "R->"])
def test_a_sequence_takes_skipped_for_success(parent: str) -> None:
    message = f"when `_while` becomes false, `Work` is halted and `{parent}` continues as if it had succeeded"
    assert findings(tree(parent, f"    {WATCHED}", "    Condition Next"), WHILE) == [f"3 warning «_while» {message}"]
    message = f"when `_while` becomes false, `Work` is halted and `{parent}` succeeds"
    assert findings(tree(parent, "    Condition First", f"    {WATCHED}"), WHILE) == [f"4 hint «_while» {message}"]


def test_decorators_pass_it_on() -> None:
    text = tree("->", "    Timeout (msec = 5 s)", "        Inverter", f"            {WATCHED}", "    Condition Next")
    assert len(findings(text, WHILE)) == 1


def test_a_reactive_node_passes_on_that_its_only_child_is_skipped() -> None:
    text = tree("->", "    R->", f"        {WATCHED}", "    Condition Next")
    message = "when `_while` becomes false, `Work` is halted and `->` continues as if it had succeeded"
    assert findings(text, WHILE) == [f"4 warning «_while» {message}"]


@pytest.mark.parametrize(
    "lines",
    [
        (WATCHED,),
        ("?", f"    {WATCHED}", "    Action Else"),
        ("||", f"    {WATCHED}", "    Action Else"),
        ("->", '    Condition Ok (_while = "x")', "    Action Next"),
        ("->", '    Script (code = "y := 1" _while = "x")', "    Action Next"),
        ("->", '    Action A (_while = "m == 1")', '    Action B (_while = "m == 2")'),
        ("->", "    Action Decide", '    Action A (_while = "m == 1")', '    Action B (_skipIf = "m == 1")'),
        ("TryCatch", "    Action Try", f"    {WATCHED}"),
        ("->", "    KeepRunningUntilFailure", f"        {WATCHED}", "    Action Next"),
        ("Custom", f"    {WATCHED}", "    Action Next"),
        ("R->", f"    {WATCHED}"),
    ],
    ids=" ".join,
)
def test_where_skipped_is_no_success(lines: tuple[str, ...]) -> None:
    assert findings(tree(*lines), WHILE) == []


# ---- unreachable-child ----

UNREACHABLE = "unreachable-child"


@pytest.mark.parametrize(
    ("lines", "expected"),
    [
        (
            ("->", "    AlwaysFailure", "    Action A"),
            "4 «A» `A` can never run: `AlwaysFailure` before it never succeeds",
        ),
        (("?", "    AlwaysSuccess x", "    A"), "4 «A» `A` can never run: `AlwaysSuccess x` before it never fails"),
        (
            ("?", "    Retry (num_attempts = -1)", "        Action A", "    -> B", "        Action C"),
            "5 «->» `-> B` can never run: `Retry` before it never fails",
        ),
        (
            ("->", "    Repeat (num_cycles = -1)", "        Action A", "    Action B", "    Action C"),
            "5 «B» `B` can never run: `Repeat` before it never succeeds",
        ),
        (
            ("R?", "    Condition Ok", "    Script (code = 'x := 1')", "    xml '<A/>'"),
            "5 «xml '<A/>'» this element can never run: `Script` before it never fails",
        ),
        (
            ("->", "    SubTree Patrol", "    Action A"),
            "4 «A» `A` can never run: `Patrol` before it never succeeds",
        ),
        (
            ("IfThenElse", "    AlwaysSuccess", "    Action A", "    Action B"),
            "5 «B» `B` can never run: the condition `AlwaysSuccess` never fails",
        ),
        (
            ("WhileDoElse", "    AlwaysFailure", "    Action A", "    Action B"),
            "4 «A» `A` can never run: the condition `AlwaysFailure` never succeeds",
        ),
        (
            ("TryCatch", "    AlwaysSuccess", "    Action Clean"),
            "4 «Clean» `Clean` can never run: nothing before it can fail",
        ),
        (
            ("TryCatch", "    AlwaysFailure", "    Action A", "    Action Clean"),
            "4 «A» `A` can never run: `AlwaysFailure` before it never succeeds",
        ),
        (
            ("Switch (case_1 = a case_2 = b)", "    Action A", "    Action B", "    Action C"),
            "3 «A» `A` can never run: without a `variable` `Switch` runs its last child",
        ),
        (
            ("Switch3 (variable = {v} case_1 = a case_2 = b case_3 = 'a')", "    A", "    B", "    C", "    D"),
            "5 «C» `C` can never run: an earlier case already has the value `a`",
        ),
    ],
)
def test_a_child_that_can_never_run(lines: tuple[str, ...], expected: str) -> None:
    text = tree(*lines) + "\nBehaviorTree Patrol\n    KeepRunningUntilFailure\n        Action Walk\n"
    line, rest = expected.split(" ", 1)
    assert findings(text, UNREACHABLE) == [f"{line} warning {rest}"]


@pytest.mark.parametrize(
    "lines",
    [
        ("->", "    AlwaysSuccess", "    Action A", "    AlwaysFailure"),
        ("?", "    AlwaysFailure", "    Action A", "    AlwaysSuccess"),
        ("->", "    Repeat (num_cycles = {n})", "        Action A", "    Action B"),
        ("->", '    Repeat (num_cycles = -1 _skipIf = "x")', "        Action A", "    Action B"),
        ("?", '    AlwaysSuccess (_failureIf = "x")', "    Action B"),
        ("?", "    ForceSuccess", '        Action A (_while = "x")', "    Action B"),
        ("?", "    Timeout (msec = 1 s)", "        KeepRunningUntilFailure", "            Action A", "    Action B"),
        ("||", "    AlwaysFailure", "    Action A"),
        ("Custom", "    AlwaysFailure", "    Action A"),
        ("->", "    xml '<AlwaysFailure/>'", "    Action A"),
        ("->", "    SubTree Elsewhere", "    Action A"),
        ("->", "    Inverter", "    Action A"),
        ("TryCatch (catch_on_halt = true)", "    AlwaysSuccess", "    Action Clean"),
        ("TryCatch", "    Action A", "    Action Clean"),
        ("IfThenElse", "    Condition Ok", "    Action A", "    Action B"),
        ("IfThenElse", "    AlwaysSuccess", "    Action A"),
        ("Switch (variable = {v} case_1 = {a} case_2 = {a})", "    Action A", "    Action B", "    Action C"),
        ("IfThenElse", "    AlwaysSuccess"),
    ],
    ids=" ".join,
)
def test_a_child_that_may_run(lines: tuple[str, ...]) -> None:
    assert findings(tree(*lines), UNREACHABLE) == []


# ---- all of them ----


def test_the_example_of_the_paper(shared: Path) -> None:
    text = (shared / "original" / "paper_example.qualitybtcpp").read_text("utf-8")
    assert findings(text, *TRAPS) == [
        "3 hint «?» while `-> SolidStation` runs, `ScriptCondition BatteryLow?` is not checked again"
    ]


def test_every_prefix_of_a_mission_full_of_traps() -> None:
    text = tree(
        *PRIORITY,
        "R-> (_while = 'x')",
        "    Delay (delay_msec = 1 s)",
        "        Switch (case_1 = a)",
        "            A",
        "            TryCatch",
        "                AlwaysSuccess",
        "                SubTree Main (_failureIf = 'x')",
        "    IfThenElse",
        "        AlwaysFailure",
        "        ScriptAction (name = 'B?' _skipIf = 'x')",
    )
    for end in range(len(text)):
        problems(text[:end], *TRAPS, "classic-placeholder", "placeholder-clash", "script-error")


# ---- stateful-condition ----

STATEFUL = "stateful-condition"


def test_an_action_may_keep_its_failure_as_the_condition_of_a_choice_of_two() -> None:
    choice = ("IfThenElse", "    Action Ask", "    Action Work")
    assert findings(tree(*choice), STATEFUL) == [
        "3 hint «Ask» if `Ask` is a StatefulActionNode, it is not started again after it has failed: `IfThenElse` does "
        "not reset it"
    ]
    for others in (
        (*choice, "    AlwaysFailure"),
        ("IfThenElse", "    Condition Ask", "    Action Work"),
        ("IfThenElse", "    Unknown", "    Action Work"),
        ("IfThenElse", "    Inverter", "        Action Ask", "    Action Work"),
        ("IfThenElse", "    Sleep (msec = 1 s)", "    Action Work"),  # it never fails
        ("WhileDoElse", "    Action Ask", "    Action Work"),
    ):
        assert findings(tree(*others), STATEFUL) == []


def test_an_action_that_takes_time_guards_nothing_in_a_loop() -> None:
    guarded = tree("WhileDoElse", "    Sleep (msec = 1 s)", "    {}")
    assert findings(guarded.format("Action Work"), STATEFUL) == [
        "3 warning «Sleep» `Sleep` is not started again while a later child runs: `WhileDoElse` does not reset it"
    ]
    assert findings(guarded.format("AlwaysSuccess"), STATEFUL) == []


def test_the_class_of_an_action_in_cpp_says_whether_it_keeps_its_result(tmp_path: Path) -> None:
    pytest.importorskip("tree_sitter_cpp", reason="the C++ grammar is not installed: pip install -e '.[cpp]'")
    code = (
        "class Ask : public BT::{} {{ public: static BT::PortsList providedPorts() {{ return {{}}; }} }};\n"
        'BT_REGISTER_NODES(factory) {{ factory.registerNodeType<Ask>("Ask"); }}\n'
    )
    (tmp_path / "btq.toml").write_text('nodes = ["ask.cpp"]\n', encoding="utf-8")
    for kind, base, severity in (
        ("IfThenElse", "StatefulActionNode", "warning"),
        ("WhileDoElse", "StatefulActionNode", "warning"),
        ("IfThenElse", "SyncActionNode", None),
        ("WhileDoElse", "ConditionNode", None),
    ):
        (tmp_path / "ask.cpp").write_text(code.format(base), encoding="utf-8")
        (tmp_path / "main.btq").write_text(tree(kind, "    Ask", "    Action Work"), encoding="utf-8")
        path = str(tmp_path / "main.btq")
        found = [each for each in check(open_workspace(path), path) if each.rule == STATEFUL]
        assert [each.effective_severity.value for each in found] == ([severity] if severity else [])


# ---- unset-without-effect, unnoticed-update ----

KEPT = "unset-without-effect"
BELOW = "\nBehaviorTree Below\n    UnsetBlackboard (key = goal)\n"


def test_an_entry_that_a_tree_gets_stays() -> None:
    calls = tree("->", "    SubTree Below ({})") + BELOW
    own = "6 warning «goal» `UnsetBlackboard` removes nothing here: `goal` is an entry of another tree"
    assert findings(calls.format("goal = {target}"), KEPT) == [own]
    assert findings(calls.format("_autoremap = true"), KEPT) == [own]
    assert findings(calls.format("goal = 3"), KEPT) == []
    assert findings(calls.format("_autoremap = true, goal = 3"), KEPT) == []
    assert findings(calls.format("other = {goal}"), KEPT) == []
    assert findings(calls.format("_autoremap = true").replace("key = goal", "key = _goal"), KEPT) == []
    assert findings(tree("UnsetBlackboard (key = goal)"), KEPT) == []
    assert findings(tree('UnsetBlackboard (key = "@goal")'), KEPT) == [
        '2 warning «"@goal"» `UnsetBlackboard` removes nothing: a key with `@` is never an entry of its own tree'
    ]


def test_the_subtrees_that_pass_the_entry_are_named() -> None:
    text = tree("->", "    SubTree Below (goal = {a})", "    SubTree Below (goal = {b})", "    SubTree Below") + BELOW
    (found,) = problems(text, KEPT)
    assert [each.message for each in found.related] == ["passes it to `Below` (and 1 more SubTree)"]


def test_up_to_4_6_a_copy_of_an_entry_is_no_update() -> None:
    update = "unnoticed-update"
    text = tree(
        "->",
        "    SetBlackboard (value = {a}, output_key = {key})",
        "    WaitValueUpdate (entry = {entry})",
        "        Work",
    ).replace("{key}", "goal")
    watched = text.replace("{entry}", "goal")
    expected = [
        "3 warning «SetBlackboard» `WaitValueUpdate` does not notice this copy: in 4.6 it does not update `goal`"
    ]
    assert findings(watched, update, project=Project(engines=("4.6",))) == expected
    assert findings(text.replace("{entry}", "{goal}"), update, project=Project(engines=("4.6", "4.8"))) == expected
    assert findings(watched, update, project=Project(engines=("4.8",))) == []
    assert findings(watched, update) == []
    assert findings(text.replace("{entry}", "other"), update, project=Project(engines=("4.6",))) == []
    assert findings(watched.replace("{a}", "3"), update, project=Project(engines=("4.6",))) == []
