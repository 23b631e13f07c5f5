"""unused-signal and unused-context: what their pages do not show."""

from __future__ import annotations

import pytest
from check_asserts import assert_clean, assert_problems, findings

NODE = "BehaviorTree Main\n    Action X satisfies rq1\n"


@pytest.mark.parametrize(
    "clauses",
    [
        "leaves battery > 3 %",
        "leaves max(battery) > 3 %",
        "uses at most 3 % of battery",
        "takes at most 3 s if battery > 50 % else 5 s",
        "takes at most 3 s while battery > 50 %",
        "X starts within 3 s after when battery > 50 %",
    ],
)
def test_every_way_to_ask_for_a_signal(clauses: str) -> None:
    assert_clean(f'signal battery : % from {{b}} level\nQualityReq rq1 "t"\n    {clauses}\n{NODE}')


def test_a_context_is_asked_for_in_another_one_and_in_a_requirement_at_a_node() -> None:
    assert_clean("""
        signal battery : % from {b}
        context low : battery < 20 %
        context empty : low and battery < 3 %
        BehaviorTree Main
            Action X
                satisfies QualityReq rq1 "t"
                    never empty
    """)


def test_a_signal_is_asked_for_as_an_argument() -> None:
    assert_clean("""
        signal speed : m/s from {speed}
        signal allowed : m/s from {allowed}
        QualityReq slow (limit : m/s) "t"
            keeps speed <= limit
        BehaviorTree Main
            Action X satisfies slow (limit = allowed)
    """)


def test_a_signal_is_asked_for_behind_a_keyword_in_a_description() -> None:
    assert_clean("""
        signal speed : m/s from {speed} initially 0 m/s
        BehaviorTree Main
            ->
                Script (code = "@speed := 1.0")
                Action X
                    satisfies QualityReq ID = "rq1" description = "FailureIf keeps speed > 3 m/s"
    """)


def test_one_mistake_is_told_once() -> None:
    """Its user misspells its name, or cannot be read, or subtracts without blanks."""
    assert_problems(
        f'signal battery : % from {{b}}\nQualityReq rq1 "t"\n    leaves batery > 3 %\n{NODE}',
        "3:12 error unknown-signal «batery» unknown signal `batery`; did you mean `battery`?",
    )
    assert_problems(
        f'signal battery : % from {{b}}\nQualityReq rq1 "t"\n    leaves > battery 3 %\n{NODE}',
        "3:12 error syntax-error «>» expected a condition: a signal, a context, a value, …, found `>`",
    )
    assert_problems(
        f'signal a : % from {{a}}\nsignal b : % from {{b}}\nQualityReq rq1 "t"\n    leaves a-b > 3 %\n{NODE}',
        "4:12 hint subtraction-without-blanks «a-b» undefined name `a-b`; write spaces around `-` to subtract",
    )
    assert_problems(  # a bound is one value
        f'signal a : s from {{a}}\nsignal b : s from {{b}}\nQualityReq rq1 "t"\n    takes at most a-b\n{NODE}',
        "4:19 error unknown-signal «a-b» unknown signal `a-b`",
    )


def test_a_file_without_trees_and_one_that_others_include_are_for_others() -> None:
    assert_clean("signal battery : % from {b}\ncontext low : battery < 3 %\n")
    assert_clean("""
        //- main.btq
        include "signals.btq"
        BehaviorTree Main
            ->
                SubTree Dock
        //- signals.btq
        signal battery : % from {b}
        BehaviorTree Dock
            Action X
    """)


@pytest.mark.parametrize("scenarios", ["given battery = 3 %", "when battery < 50 %: mission halts"])
def test_a_signal_is_asked_for_in_a_file_of_scenarios(scenarios: str) -> None:
    mission = "signal battery : % from {b} level\ncontext low : battery < 20 %\nBehaviorTree Main\n    Action X\n"
    steps = f'include "main.btq"\nscenario "s"\n    {scenarios}\n    expect mission succeeds\n'
    unused = "2 hint «low» no condition uses the context `low`"
    assert findings(mission, "unused-signal", "unused-context", steps=steps) == [unused]
    assert findings(mission, "unused-signal", "unused-context", steps=steps.replace("50 %", "50 % and low")) == (
        [unused] if "when" not in scenarios else []
    )
    without = steps.replace(scenarios, "given X succeeds")
    assert findings(mission.replace("context low : battery < 20 %\n", ""), "unused-signal", steps=without) == [
        "1 hint «battery» no clause uses the signal `battery`"
    ]
