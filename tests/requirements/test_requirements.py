"""Requirements, resolved: subjects, values in SI, arguments, and what a mission with one of everything says."""

from __future__ import annotations

import pytest
from check_asserts import after, assert_clean, problems, split_files
from requirement_problems import problems_of
from worked_mission import WORKED

from btq_lang.requirements.applied import Applied
from btq_lang.requirements.model import (
    Aggregate,
    All,
    Arithmetic,
    ClassicScript,
    Compare,
    DurationSum,
    Flag,
    InContext,
    Interval,
    Limit,
    MissionRun,
    Negation,
    NodeTarget,
    Quantity,
    ResolvedTable,
    Running,
    SignalRead,
    TextValue,
)
from btq_lang.requirements.resolve import Requirements, requirements
from btq_lang.workspace.workspace import Workspace


def resolved(text: str) -> Requirements:
    files = split_files(text)
    return requirements(Workspace.of(files), next(iter(files)))


def applied(found: Requirements, name: str) -> list[Applied]:
    return [each for each in found.applied if each.requirement.name == name]


def one(found: Requirements, name: str) -> Applied:
    (each,) = applied(found, name)
    return each


def where(found: Requirements, name: str) -> list[str]:
    """The nodes that a requirement applies to, each with its arguments."""
    return [
        f"{each.node.node.head.text} {each.node.node.name.text if each.node.node.name else '-'} in {each.node.tree}"
        + "".join(f" {argument.name}={argument.value.text}" for argument in each.arguments)
        for each in applied(found, name)
        if each.node is not None
    ]


# ---- one of everything -----------------------------------------------------------------------------------------------


def test_the_worked_examples_resolve() -> None:
    found = resolved(WORKED)
    assert not problems_of(found)
    assert {name: where(found, name) for name in found.all} == {
        "rq1": ["MoveBase - in Main"],
        "rq4": ["MoveBase - in Main"],
        "rq5": ["-> SolidStation in Main"],
        "rq6": [],
        "slow": ["MoveBase - in Main limit=0.25 m/s", "Place - in PickPlace limit=0.1 m/s"],
        "fetch": ["GoToFridge - in Main"],
        "replan": ["ComputePathToPose - in Main"],
        "order": ["Place - in PickPlace"],
        "calm": ["GoToFridge - in Main"],
    }


def test_the_worked_examples_mean_what_they_say() -> None:
    found = resolved(WORKED)
    rq4 = one(found, "rq4").requirement
    assert (rq4.odds and rq4.odds.probability, rq4.confidence, rq4.window and rq4.window.count) == (0.98, 0.95, 200)
    rq5 = one(found, "rq5").requirement
    (claim,) = rq5.claims
    assert claim.limit is not None
    assert isinstance(claim.limit.value, Quantity)
    assert (claim.limit.relation, claim.limit.value.si, claim.limit.value.text) == ("<=", 72000.0, "0.02 kWh")
    assert claim.signal is found.signals["energy"]
    assert isinstance(rq5.goal, Quantity)
    assert rq5.goal.si == 54000.0
    span = one(found, "rq6").subject
    assert isinstance(span, Interval)
    (first,), (last,) = span.first.atoms, span.last.atoms
    assert (first.happening, last.happening) == ("starts", "succeeds")
    slow = applied(found, "slow")[1].requirement
    humans_near = found.contexts["humans_near"]
    assert humans_near is not None
    assert slow.scopes[0].condition == InContext("humans_near", humans_near)
    compare = slow.claims[0].condition
    assert isinstance(compare, Compare)
    assert compare.operators == ("<=",)
    assert compare.operands[0] == SignalRead(found.signals["speed"])
    assert isinstance(compare.operands[1], Quantity)
    assert (compare.operands[1].si, slow.action, slow.reasons) == (0.1, "fail", ("movement next to people",))
    table = one(found, "fetch").requirement.claims[0].limit
    assert table is not None
    assert isinstance(table.value, ResolvedTable)
    assert [case.value.text for case in table.value.cases] == ["20 s", "30 s"]
    assert table.value.cases[0].condition == Negation(InContext("humans_near", humans_near))
    assert table.value.cases[1].condition is None
    scope = one(found, "replan").requirement.scopes[0].condition
    assert isinstance(scope, Running)
    assert scope.target.node.node.head.text == "FollowPath"
    assert one(found, "order").requirement.claims[0].text == "Place follows CheckClear succeeds"


def test_the_worked_examples_check_clean() -> None:
    """All but `signal … initially`, which the page leaves out, and the battery, for which nothing asks."""
    text = "".join(line for line in WORKED.splitlines(keepends=True) if not line.startswith("signal battery"))
    text = text.replace("from {energy_used} counter", "from {energy_used} counter initially 0 Wh")
    text = text.replace("from {base_speed}\n", "from {base_speed} initially 0 m/s\n")
    assert_clean(text.replace("from {people_count}\n", "from {people_count} initially 0 person\n"))


@pytest.mark.parametrize(
    ("claim", "fixed"),
    [
        ("mission never Dock", ["mission never node Dock"]),
        (
            "mission keeps not Dock while Go",
            ["mission keeps not node Dock while Go", "mission keeps not Dock while node Go"],
        ),
        (
            "each Go succeeds is followed by Dock within 60 s",
            [
                "each Go succeeds is followed by Dock succeeds within 60 s",
                "each Go succeeds is followed by node Dock within 60 s",
            ],
        ),
        ('mission never "Dock"', ['mission never node "Dock"']),
        ("mission never node Dock", []),
        ("mission never busy", []),
    ],
)
def test_a_node_that_is_no_condition(claim: str, fixed: list[str]) -> None:
    """Its name alone means that it runs, which is said with the ways to write what is meant."""
    text = f"signal busy : bool from {{@busy}} initially false\nQualityReq rq : safety\n    {claim}\n"
    text += "Action Go\n    output busy : bool\nAction Dock\n"
    text += "BehaviorTree Main\n    -> A\n        Go (busy = {@busy})\n        Dock\n"
    shown = problems(text, "unknown-signal")
    texts = [after(text, fix) for each in shown for fix in each.fixes]
    assert texts == [text.replace(claim, other) for other in fixed]
    assert {each.effective_severity.value for each in shown} <= {"warning"}


# ---- paths ----------------------------------------------------------------------------------------------------------

PATHS = """
QualityReq rq1 "t"
    {path} takes at most 30 s
BehaviorTree Main
    -> Top
        SubTree Leg First
        SubTree Leg Second
        Retry Again (num_attempts = 2)
            SubTree Other
        Action Alone "by itself"
BehaviorTree Leg
    -> Steps
        Action Walk
        Action Turn Left
        Action Turn Right
BehaviorTree Other
    Action Turn
"""


@pytest.mark.parametrize(
    ("path", "node", "through"),
    [
        ("Walk", "Walk -", ()),
        ("Leg/Walk", "Walk -", ()),
        ("Steps/Walk", "Walk -", ()),
        ("Leg/Steps/Walk", "Walk -", ()),
        ("Main/Walk", "Walk -", ()),  # the main tree is above every instance
        ("First/Walk", "Walk -", ("First",)),
        ("Main/First/Walk", "Walk -", ("Main", "First")),
        ("Top/First/Leg/Walk", "Walk -", ("Top", "First")),
        ("Left", "Turn Left", ()),
        ("Other/Turn", "Turn -", ()),
        ("Again/Turn", "Turn -", ()),
        ("Retry/Turn", "Turn -", ()),
        ("RetryUntilSuccessful/Turn", "Turn -", ()),
        ("First", "Leg First", ()),
        ("Leg", "-> Steps", ()),  # a tree's root and the SubTrees that run it are one
        ("Steps", "-> Steps", ()),
        ("Again/Other", "Turn -", ()),  # the only instance is every instance
        ("Top/First/Leg", "-> Steps", ("Top", "First")),
        ("Other", "Turn -", ()),
        ('Main/"by itself"', "Alone by itself", ()),
    ],
)
def test_a_path_names_one_node(path: str, node: str, through: tuple[str, ...]) -> None:
    found = resolved(PATHS.replace("{path}", path).replace('Alone "by itself"', 'Alone (name = "by itself")'))
    assert not problems_of(found)
    subject = one(found, "rq1").subject
    assert isinstance(subject, NodeTarget)
    name = subject.node.node.name
    assert f"{subject.node.node.head.text} {name.text if name else '-'}" == node
    assert subject.through == through


@pytest.mark.parametrize(
    ("path", "message"),
    [
        ("Turn", "ambiguous path `Turn`: 3 nodes match"),
        ("Leg/Turn", "ambiguous path `Leg/Turn`: 2 nodes match"),
        ("Walk/Leg", "no node `Leg` below `Walk`"),
        ("First/Alone", "no node `Alone` below `First`"),
        ("Jump", "unknown node `Jump`"),
        ("Leg/Leg/Leg/Walk", "no node `Walk` below `Leg/Leg/Leg`"),
    ],
)
def test_paths_that_name_none_or_several(path: str, message: str) -> None:
    found = resolved(PATHS.replace("{path}", path))
    assert [problem.diagnostic.message for problem in problems_of(found)] == [message]
    assert found.applied == ()


def test_other_subjects() -> None:
    text = PATHS.replace('QualityReq rq1 "t"', 'QualityReq rq1 "t"\n    mission takes at most 1 h')
    text = text.replace("{path} takes", "sum of Walk, Left takes") + "        Action Wave\n"
    found = resolved(text.replace("Action Wave", "").replace("Root", ""))
    mission, total = applied(found, "rq1")
    assert isinstance(mission.subject, MissionRun)
    assert mission.node is found.nodes.find(("Main",))[0].node is found.mission
    assert isinstance(total.subject, DurationSum)
    assert [target.node.node.head.text for target in total.subject.targets] == ["Walk", "Turn"]
    assert [claim.text for claim in total.requirement.claims] == ["sum of Walk, Left takes at most 30 s"]


def test_a_tag_that_nothing_has() -> None:
    text = 'QualityReq slow "t"\n    takes at most 9 s\napply slow to every node tagged drivng\n'
    text += "BehaviorTree Main\n    A Home tags driving, heavy\n"
    (problem,) = problems_of(resolved(text))
    assert problem.diagnostic.message == "no node has the tag `drivng`; did you mean `driving`?"
    assert [fix.title for fix in problem.diagnostic.fixes] == ["Replace `drivng` with `driving`"]


def test_every() -> None:
    found = resolved(PATHS.replace("{path}", "every Turn"))
    assert where(found, "rq1") == ["Turn Left in Leg", "Turn Right in Leg", "Turn - in Other"]
    found = resolved(PATHS.replace("{path}", "every Sequence"))
    assert where(found, "rq1") == ["-> Top in Main", "-> Steps in Leg"]
    found = resolved(PATHS.replace("{path}", "every Leg"))
    assert where(found, "rq1") == ["Leg First in Main", "Leg Second in Main"]


def test_trees_that_run_each_other_have_no_top() -> None:
    text = 'QualityReq rq1 "t"\n    Nowhere/X takes at most 1 s\n'
    text += "BehaviorTree A\n    SubTree B\nBehaviorTree B\n    ->\n        SubTree A\n        X\n"
    assert [problem.diagnostic.rule for problem in problems_of(resolved(text))] == ["unmatched-path"]


def test_two_demands_in_one_clause_are_two_clauses() -> None:
    text = "QualityReq q\n    takes at most 30 s and succeeds\nBehaviorTree Main\n    Action Dock satisfies q\n"
    (problem,) = problems_of(resolved(text))
    assert (problem.diagnostic.message, problem.diagnostic.notes) == (
        "unknown node `and`",
        ("a clause has one verb: write `succeeds within 30 s`, or put `succeeds` on a line of its own",),
    )


def test_a_library_does_not_know_whose_nodes_it_speaks_of() -> None:
    text = '//- main.btq\nQualityReq rq1 "t"\n    X takes at most 1 s\nBehaviorTree A\n    Y\n'
    assert len(problems_of(resolved(text))) == 1
    assert not problems_of(resolved(text + '//- other.btq\ninclude "main.btq"\n'))
    assert not problems_of(resolved(text.replace("QualityReq", 'include "trees.xml"\nQualityReq', 1)))


# ---- who has which --------------------------------------------------------------------------------------------------

APPLY = """
QualityReq slow(limit : s = 9 s, other : m = 2 m) "t"
    takes at most limit
{apply}
BehaviorTree Main
    -> Top tags heavy
        A One{one}
        -> Inner
            A Two tags heavy
        A Three
"""


@pytest.mark.parametrize(
    ("apply", "one", "expected"),
    [
        ("apply slow to every A", "", ["One 9 s", "Two 9 s", "Three 9 s"]),
        ("apply slow to every A except Two, Three", "", ["One 9 s"]),
        ("apply slow to every A under Inner", "", ["Two 9 s"]),
        ("apply slow to every node tagged heavy", "", ["Top 9 s", "Two 9 s"]),
        ("apply slow to every A\napply slow(limit = 1 s) to Two", "", ["One 9 s", "Two 1 s", "Three 9 s"]),
        (
            "apply slow(limit = 1 s) to every A under Inner\napply slow to every A",
            "",
            ["Two 1 s", "One 9 s", "Three 9 s"],
        ),
        ("apply slow(limit = 1 s) to every A under Inner\napply slow to Two", "", ["Two 9 s"]),
        ("apply slow to One", " satisfies slow(limit = 3 s)", ["One 3 s"]),
        ("apply slow(limit = 3000 ms) to every A under Inner, every A\napply slow(limit = 3 s) to every A", "", None),
        ("apply slow to every A except every node tagged heavy", "", ["One 9 s", "Three 9 s"]),
    ],
)
def test_the_most_specific_application_counts(apply: str, one: str, expected: list[str] | None) -> None:
    found = resolved(APPLY.replace("{apply}", apply).replace("{one}", one))
    assert not problems_of(found)
    got = [
        f"{each.node.node.name.text} {each.arguments[0].value.text}"
        for each in found.applied
        if each.node is not None and each.node.node.name is not None
    ]
    # Two applications that say the same are one.
    assert sorted(got) == sorted(expected or ["One 3000 ms", "Two 3000 ms", "Three 3000 ms"])


def test_two_values_of_one_rank() -> None:
    found = resolved(
        APPLY.replace("{apply}", "apply slow to every A\napply slow(limit = 1 s) to every A").replace("{one}", "")
    )
    assert len(problems_of(found)) == 3
    assert problems_of(found)[0].diagnostic.message == (
        "`slow` has two values for `A One`: limit = 9 s, other = 2 m and limit = 1 s, other = 2 m"
    )
    assert found.applied == ()


def test_a_claims_own_subject_wins() -> None:
    found = resolved(
        'QualityReq rq1 "t"\n    B takes at most 1 s\nBehaviorTree Main\n    ->\n        A satisfies rq1\n        B\n'
    )
    assert where(found, "rq1") == ["B - in Main"]
    assert [(trace.requirement, trace.node.node.head.text) for trace in found.traces] == [("rq1", "A")]


def test_a_tree_satisfies_at_its_root() -> None:
    found = resolved("BehaviorTree Main\n    satisfies QualityReq rq1 takes at most 1 s\n    A\n")
    assert where(found, "rq1") == ["A - in Main"]


def test_classic_requirements_have_the_quality_around_them() -> None:
    found = resolved(
        'BehaviorTree Main\n    A (satisfices Quality = performance (QualityReq ID = "rq1" description = "Quick"))\n'
    )
    assert [(each.name, each.quality, each.title) for each in found.all.values()] == [("rq1", "performance", "Quick")]


# ---- values and conditions ------------------------------------------------------------------------------------------

SIGNALS = """
signal speed : km/h from {speed} gauge fresh within 200 ms initially 3.6 km/h
signal ok : bool initially false
signal zone : text initially "hall"
signal heat : degC
signal way : m counter
signal n : 1
context fast : speed > 1 m/s
QualityReq rq1(low : m/s = 0.5 m/s, where : text, on : bool = true) "t"
    keeps {condition}
"""


def condition(text: str) -> object:
    found = resolved(SIGNALS.replace("{condition}", text))
    assert not problems_of(found)
    return found.all["rq1"].claims[0].condition


def test_signals() -> None:
    found = resolved(SIGNALS.replace("{condition}", "ok")).signals
    speed = found["speed"]
    assert (speed.sort, speed.key, speed.behaviour, speed.fresh) == ("number", "speed", "gauge", 0.2)
    assert isinstance(speed.initially, Quantity)
    assert (speed.initially.si, speed.initially.text) == (1.0, "3.6 km/h")
    assert (found["ok"].sort, found["ok"].initially, found["ok"].key) == ("bool", Flag(False), None)
    assert (found["zone"].sort, found["zone"].initially) == ("text", TextValue("hall"))
    assert [name for name, signal in found.items() if signal.behaviour == "counter"] == ["way"]


def test_conditions() -> None:
    found = resolved(SIGNALS.replace("{condition}", "ok")).signals
    speed = SignalRead(found["speed"])
    near = condition("low <= speed < 2 m/s and not (ok or fast)")
    assert isinstance(near, All)
    first, second = near.conditions
    assert isinstance(first, Compare)
    assert first.operators == ("<=", "<")
    assert repr(first.operands[1]) == repr(speed)  # two workspaces: they say the same, at places of their own
    assert isinstance(second, Negation)
    ratio = condition("change(way) / 10 s <= mean(speed) + 2 * low")
    assert isinstance(ratio, Compare)
    assert isinstance(ratio.operands[0], Arithmetic)
    assert repr(ratio.operands[0].left) == repr(Aggregate("change", found["way"]))
    assert repr(condition("heat <= -5 degC")) == repr(condition("heat <= - 5 degC"))
    assert condition('zone == "hall" and where != zone and on') is not None
    assert condition("count(ok) < 3 and count(ok) < 3 times and n < 3 and heat - 5 degC < 3 K") is not None
    assert condition("heat + 5 K < 30 degC and max(heat) < 300 K and heat - 3 K < heat") is not None


@pytest.mark.parametrize(
    ("text", "rule", "message"),
    [
        ("speed <= 3 s", "unit-mismatch", "cannot compare `speed` (a speed) with `3 s` (a time)"),
        ("speed <= 3", "number-without-unit", "missing unit after `3`; `speed` is in km/h"),
        ("-3 <= speed", "number-without-unit", "missing unit after `3`; `speed` is in km/h"),
        ("speed + 3 < 5 m/s", "number-without-unit", "missing unit after `3`; `speed` is in km/h"),
        ("n < 3 m", "unit-mismatch", "cannot compare `n` (a plain number) with `3 m` (a length)"),
        ("n < 3 %", "unit-mismatch", "cannot compare `n` (a plain number) with `3 %` (a percentage)"),
        ("zone == 3", "unit-mismatch", "cannot compare `zone` (a text) with `3` (a plain number)"),
        ('zone < "a"', "unit-mismatch", "cannot order a text; compare with `==` or `!=`"),
        ("ok < 3", "unit-mismatch", "cannot compare `ok` (true or false) with `3` (a plain number)"),
        ("speed", "unit-mismatch", "expected a condition, found `speed` (a speed)"),
        ("zone", "unit-mismatch", "expected a condition, found `zone` (a text)"),
        ("3 s", "unit-mismatch", "expected a condition, found `3 s` (a time)"),
        ("speed * 2", "unit-mismatch", "expected a condition, found `speed * 2` (a speed)"),
        ("ok + 1 < 2", "unit-mismatch", "`+` requires numbers, found `ok` (true or false)"),
        ("max(zone) < 2", "unit-mismatch", "`max` requires a number, but `zone` is a text"),
        ("heat < 5 m", "unit-mismatch", "cannot compare `heat` (a temperature) with `5 m` (a length)"),
        ("heat + heat < 5 degC", "unit-mismatch", "expected a temperature difference, found `heat` (a temperature)"),
        ("heat * 2 < 5 K", "unit-mismatch", "cannot multiply or divide `heat`, a temperature in degC"),
        (
            "heat - heat < 5 degC",
            "unit-mismatch",
            "expected a temperature difference, found `5 degC` (a temperature)",
        ),
        (
            "stddev(heat) < 5 degC",
            "unit-mismatch",
            "expected a temperature difference, found `5 degC` (a temperature)",
        ),
        ("fast < 3", "unit-mismatch", "`fast` is a context, not a value"),
        ("sped < 3 m/s", "unknown-signal", "unknown signal `sped`; did you mean `speed`?"),
        ("max(sped) < 3 m/s", "unknown-signal", "unknown signal `sped`; did you mean `speed`?"),
        ("(ok or fast) == 3", "unit-mismatch", "expected a value, found the condition `ok or fast`"),
    ],
)
def test_conditions_that_mean_nothing(text: str, rule: str, message: str) -> None:
    found = resolved(SIGNALS.replace("{condition}", text))
    assert [(each.diagnostic.rule, each.diagnostic.message) for each in problems_of(found)] == [(rule, message)]
    assert found.all["rq1"].claims == ()


@pytest.mark.parametrize(
    ("clauses", "message"),
    [
        ("takes at most 30 m", "expected a time, found `30 m` (a length)"),
        ("takes at most 30", "missing unit after `30`; expected a time"),
        ("takes at most way", "expected a time, found `way` (a length)"),
        ("takes at most ok", "expected a time, found `ok` (true or false)"),
        ("uses at most 3 s of way", "expected a length (the dimension of `way`), found `3 s` (a time)"),
        ("uses at most 3 degC of heat", "expected a temperature difference, found `3 degC` (a temperature)"),
        ("uses at most 3 of zone", "`uses` requires a number, but `zone` is a text"),
        ("tries at most 3 s", "expected a number, found `3 s` (a time)"),
        ("runs at least 3 per 1 m", "expected a time, found `1 m` (a length)"),
        ("takes at most 3 s in at least 3 s of runs", "expected a percentage, found `3 s` (a time)"),
        ("takes at most 3 s goal 3 m", "expected a goal of the same dimension as the bound, found `3 m` (a length)"),
        ("takes at most 3 s over last 3 m", "expected a time, found `3 m` (a length)"),
        ("takes at most 3 s if fast else 4 m", "expected a time, found `4 m` (a length)"),
    ],
)
def test_bounds_of_the_wrong_sort(clauses: str, message: str) -> None:
    found = resolved(SIGNALS.replace("keeps {condition}", clauses))
    assert [problem.diagnostic.message for problem in problems_of(found)] == [message]


def test_contexts_in_contexts() -> None:
    chain = "".join(f"context c{n} : c{n + 1}\n" for n in range(60)) + "context c60 : true\n"
    found = resolved(chain)
    assert {problem.diagnostic.rule for problem in problems_of(found)} == {"nested-too-deep"}
    assert found.contexts["c30"] is not None
    assert found.contexts["c0"] is None
    found = resolved("context a : b or true\ncontext b : a\ncontext c : b or true\n")
    assert [problem.diagnostic.message for problem in problems_of(found)] == [
        "the context `a` refers to itself",
        "the context `b` refers to itself",
    ]


def test_more_than_any_number() -> None:
    found = resolved(
        'QualityReq rq1 "t"\n    takes at most 1e999 s\n    tries at most 1e999\n    runs at least 1 per 1e308 h\n'
    )
    assert [(problem.diagnostic.rule, problem.diagnostic.message) for problem in problems_of(found)] == [
        ("invalid-literal", "`1e999 s` exceeds the range of numbers"),
        ("invalid-literal", "`1e999` exceeds the range of numbers"),
        ("invalid-literal", "`1e308 h` exceeds the range of numbers"),
    ]


# ---- classic descriptions --------------------------------------------------------------------------------------------


def classic(text: str) -> list[tuple[str, str, object]]:
    """What a description demands: verbs, texts, and bounds or conditions."""
    description = text.replace('"', "'")
    found = resolved(
        "signal speed : m/s from {speed}\nBehaviorTree Main\n    ->\n        B\n"
        f'        A (satisfies QualityReq ID = "rq1" description = "{description}")\n'
    )
    assert not problems_of(found)
    requirement = found.all["rq1"]
    assert requirement.action == ("fail" if requirement.claims else None)
    assert requirement.classic is bool(requirement.claims)
    assert where(found, "rq1") == ["A - in Main"]
    return [(claim.verb, claim.text, claim.limit or claim.condition) for claim in requirement.claims]


def test_descriptions_that_are_clauses() -> None:
    ((verb, text, limit),) = classic("Quickly. SuccessIf takes at most 30 s.")
    assert (verb, text) == ("takes", "takes at most 30 s")
    assert isinstance(limit, Limit)
    assert (limit.relation, limit.value.text) == ("<=", "30 s")
    ((verb, text, limit),) = classic("FailureIf takes more than 30 s")
    assert isinstance(limit, Limit)
    assert (verb, text, limit.relation) == ("takes", "takes more than 30 s", "<=")
    assert [verb for verb, _, _ in classic("SuccessIf: keeps speed < 1 m/s FailureIf keeps speed > 3 m/s")] == [
        "keeps",
        "never",
    ]


def test_descriptions_that_are_scripts() -> None:
    assert classic("SuccessIf battery > 20 FailureIf stuck") == [
        ("keeps", "SuccessIf battery > 20", ClassicScript("battery > 20")),
        ("never", "FailureIf stuck", ClassicScript("stuck")),
    ]


@pytest.mark.parametrize(
    "text",
    [
        "The robot is quick",
        "SuccessIf the moving shall take at most 30 sec.",
        "SuccessIf keeps sped < 1 m/s",  # not a signal
        "SuccessIf keeps speed < 1 s",
        "SuccessIf never happens",
        "FailureIf takes between 1 s and 2 s",
        "FailureIf takes at least 3 s in at least 3 % of runs",
    ],
)
def test_descriptions_that_stay_prose(text: str) -> None:
    assert classic(text) == []


def test_clauses_beside_a_description_count_alone() -> None:
    found = resolved('QualityReq rq1 "SuccessIf takes at most 3 s" takes at most 5 s\n')
    assert [claim.text for claim in found.all["rq1"].claims] == ["takes at most 5 s"]
