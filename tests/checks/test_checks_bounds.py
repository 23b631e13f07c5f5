"""impossible-bound and uses-of-gauge: what their pages do not show."""

from __future__ import annotations

import pytest
from check_asserts import assert_clean, assert_fix, assert_problems, findings, problems

NODE = "BehaviorTree Main\n    Action X satisfies r\n"


@pytest.mark.parametrize(
    ("clause", "found"),
    [
        ("tries at most -1", "3:20 warning impossible-bound «1» expected a whole number of attempts, found `-1`"),
        (
            "tries at most 2.5 times",
            "3:19 warning impossible-bound «2.5 times» expected a whole number of attempts, found `2.5 times`",
        ),
        (
            "tries between 1 and 2.5",
            "3:25 warning impossible-bound «2.5» expected a whole number of attempts, found `2.5`",
        ),
        (
            "runs at least 1.5 per 2 s",
            "3:19 warning impossible-bound «1.5» expected a whole number of starts, found `1.5`",
        ),
        (
            "takes at most -3 s",
            "3:20 warning impossible-bound «3 s» a duration must be longer than zero, found `-3 s`",
        ),
        ("runs every 0 s", "3:16 warning impossible-bound «0 s» a duration must be longer than zero, found `0 s`"),
        ("succeeds within 0 s", "3:21 warning impossible-bound «0 s» a duration must be longer than zero, found `0 s`"),
        (
            "tries at most 0",
            "3:19 warning impossible-bound «0» a node that starts makes at least one attempt, so only a node "
            "that never starts keeps this bound",
        ),
        (
            "mission runs every 5 s",
            "3:5 warning impossible-bound «mission runs every 5 s» a mission starts only once in a run, so "
            "`runs` does not apply to it",
        ),
    ],
)
def test_what_no_run_can_keep(clause: str, found: str) -> None:
    assert_problems(f'QualityReq r "t"\n    X succeeds\n    {clause}\n{NODE}', found)


MISSION = """signal door : bool from {door}
Root Main
BehaviorTree Main
    ->
        Action X
        Action Y
"""
SINGLE_RUN = "each run is judged by itself"
NAMED = "name the node that is meant: `Dock starts within 2 s after Batch succeeds`"


@pytest.mark.parametrize("mission", ["mission", "Main"])
@pytest.mark.parametrize(
    ("clause", "said", "note"),
    [
        ("{} tries at most 3", "a mission starts only once in a run, so `tries` does not apply to it", None),
        ("{} tries at most 3 per X", "a mission starts only once in a run, so `tries` does not apply to it", None),
        ("{} runs at least 1 per 1 h", "a mission starts only once in a run, so `runs` does not apply to it", None),
        ("{} starts within 2 s after X succeeds", "a mission starts before all else in its run, not after it", NAMED),
        ("{} starts within 2 s after when door", "a mission starts before all else in its run, not after it", NAMED),
        ("{} starts within 2 s after {} fails", "a mission starts before all else in its run, not after it", NAMED),
        ("{} follows X succeeds", "a mission starts before all else in its run, not after it", NAMED),
        ("{} follows {} starts", "a mission starts before all else in its run, not after it", NAMED),
        (
            "{} follows when door",
            "a mission starts before all else in its run, not after it",
            "for what must hold when it starts, write `mission needs …`",
        ),
        *(
            (f"X {clause} {{}} {end}", f"nothing happens in a run after `{{}} {end}`", SINGLE_RUN)
            for clause in ("starts within 2 s after", "ends within 2 s after", "follows")
            for end in ("succeeds", "fails", "finishes", "halts")
        ),
        ("X follows Y fails or {} finishes", "nothing happens in a run after `{} finishes`", SINGLE_RUN),
        (
            "from X fails or {} succeeds to X starts takes at most 2 s",
            "nothing happens in a run after `{} succeeds`",
            SINGLE_RUN,
        ),
        ("each {} fails is followed by X starts", "nothing happens in a run after `{} fails`", SINGLE_RUN),
        ("each X fails is followed by {} starts", "nothing happens in a run before `{} starts`", SINGLE_RUN),
        ("every X follows {} finishes", "nothing happens in a run after `{} finishes`", SINGLE_RUN),
        ("{} ends within 2 s after {} fails", "nothing happens in a run after `{} fails`", SINGLE_RUN),
        ("from {} succeeds to X starts takes at most 2 s", "nothing happens in a run after `{} succeeds`", SINGLE_RUN),
        ("from {} fails to {} finishes takes at most 2 s", "nothing happens in a run after `{} fails`", SINGLE_RUN),
        (
            "from X succeeds to {} starts takes at most 2 s",
            "nothing happens in a run before `{} starts`",
            SINGLE_RUN,
        ),
        (
            "X ends within 9 s after {} starts",
            "no other node runs yet at `{} starts`",
            "for the time from there on, write `from mission starts to X finishes takes at most …`",
        ),
    ],
)
def test_what_one_run_never_shows(clause: str, said: str, note: str | None, mission: str) -> None:
    written, said = clause.replace("{}", mission), said.replace("{}", mission)
    text = f'QualityReq r "t"\n    {written}\n{MISSION}'
    (found,) = problems(text, "impossible-bound")
    assert (found.message, text[found.span.start : found.span.end]) == (said, written)
    assert note is None or found.notes == (note,)


@pytest.mark.parametrize("mission", ["mission", "Main"])
@pytest.mark.parametrize(
    "clause",
    [
        "{} takes at most 1 h",
        "{} succeeds within 1 h",
        "{} ends within 2 s after X fails",
        "{} ends within 2 s after when door",
        "{} ends within 1 h after {} starts",
        "X starts within 2 s after {} starts",
        "X follows {} starts",
        "X tries at most 3 per {}",
        "X follows Y succeeds",
        "from {} starts to X succeeds takes at most 2 s",
        "from {} starts to {} finishes takes at most 1 h",
        "from X fails to {} finishes takes at most 2 s",
    ],
)
def test_what_one_run_may_show(clause: str, mission: str) -> None:
    assert problems(f'QualityReq r "t"\n    {clause.replace("{}", mission)}\n{MISSION}', "impossible-bound") == []


@pytest.mark.parametrize("mission", ["mission", "Main"])
@pytest.mark.parametrize(
    ("span", "said"),
    [
        ("from {} fails until X starts", "nothing happens in a run after `{} fails`"),
        ("from X fails until Y starts or {} starts", "nothing happens in a run before `{} starts`"),
        ("from {} starts until {} finishes", None),
    ],
)
def test_a_span_outside_of_a_run(span: str, said: str | None, mission: str) -> None:
    text = f'QualityReq r "t"\n    X never node Y\n    {span.replace("{}", mission)}\n{MISSION}'
    found = [(each.message, each.notes) for each in problems(text, "impossible-bound")]
    assert found == ([(said.replace("{}", mission), (SINGLE_RUN,))] if said is not None else [])


@pytest.mark.parametrize(
    "trees",
    [
        "BehaviorTree Main\n    Action X\nBehaviorTree Other\n    Action Y",  # which of them runs is unknown
        "Root Other\nBehaviorTree Main\n    X\nBehaviorTree Other\n    Repeat (num_cycles = 2)\n        SubTree Main",
    ],
)
def test_a_tree_that_is_no_mission_may_start_again(trees: str) -> None:
    for clause in ("Main tries at most 3", "Main follows Y succeeds", "Y starts within 2 s after Main succeeds"):
        assert problems(f'QualityReq r "t"\n    {clause}\n{trees}\n', "impossible-bound") == []


@pytest.mark.parametrize("root", ['Switch2 (variable = "{v}", case_1 = "a", case_2 = "b")', "Patrol"])
def test_a_root_may_start_with_its_first_child(root: str) -> None:
    text = f"Root Main\nBehaviorTree Main\n    {root}\n        Action X\n        Action Y\n        Action Z\n"
    assert problems(f'QualityReq r "t"\n    X ends within 9 s after mission starts\n{text}', "impossible-bound") == []


@pytest.mark.parametrize(
    ("clauses", "signal"),
    [
        ("tries at most 0 while low", "signal b : % from {b}\ncontext low : b < 3 %\n"),  # not in that situation
        ("uses at most 0 % of b", "signal b : % from {b} level\n"),
        ("uses at most -2.5 % of b", "signal b : % from {b} level\n"),  # it charges
        ("takes at least 0 s", ""),
        ("tries at most 3 times", ""),
    ],
)
def test_what_is_meant_so(clauses: str, signal: str) -> None:
    assert_clean(f'{signal}QualityReq r "t"\n    {clauses}\n{NODE}')


def test_a_limit_is_told_as_one() -> None:
    assert_problems(
        f'QualityReq r "t"\n    takes at most 0 s\n    on violation fail\n{NODE}',
        "2:5 error limit-too-small «takes at most 0 s» the engine cannot enforce `0 s`: it counts whole "
        "milliseconds, and 0 disables the limit; write at least 1 ms",
    )


@pytest.mark.parametrize("clause", ["in at least 98 % of runs", "over last 5 runs", "verified by test"])
def test_a_time_that_the_engine_does_not_limit(clause: str) -> None:
    text = f'QualityReq r "t"\n    takes at most 0 s\n    on violation fail\n    {clause}\n{NODE}'
    assert findings(text, "limit-too-small") == []
    assert [each.message for each in problems(text, "impossible-bound")] == [
        "a duration must be longer than zero, found `0 s`"
    ]


@pytest.mark.parametrize(("bound", "fixed"), [("at most 4.5", "at most 4"), ("at least 1.5", "at least 2")])
def test_a_whole_number_is_offered(bound: str, fixed: str) -> None:
    text = f'QualityReq r "t"\n    tries {bound}\n{NODE}'
    assert_fix(text, f"Write `{fixed[-1]}`", text.replace(bound, fixed))


def test_a_gauge_becomes_a_counter_or_a_level() -> None:
    text = f'signal b : % from {{b}} gauge fresh within 1 s\nQualityReq r "t"\n    uses at most 2 % of b\n{NODE}'
    assert_fix(text, "Declare it as a level", text.replace("gauge", "level"))
    assert_fix(text, "Declare it as a counter", text.replace("gauge", "counter"))
    text = text.replace(" gauge", "")
    assert_fix(text, "Declare it as a level", text.replace("{b}", "{b} level"))


@pytest.mark.parametrize(
    ("rate", "fixed"),
    [
        ("1e-6 per h", "1e-6 per 1 h"),
        ("2 per day", "2 per 1 day"),
        ("1e-6 per h of X", "1e-6 per 1 h of X"),
        ("1e-6/h", "1e-6 per 1 h"),
        ("0.001 / h", "0.001 per 1 h"),
    ],
)
def test_a_rate_per_a_unit_of_time_keeps_its_value(rate: str, fixed: str) -> None:
    text = f"QualityReq r\n    X fails at most {rate}\n    confidence 95 %\nBehaviorTree Main\n    Action X\n"
    (found,) = findings(text, "syntax-error", "unmatched-path", "impossible-bound", "clause-without-odds")
    unit = fixed.partition(" per 1 ")[2].partition(" ")[0]
    assert found.endswith(f"a failure rate is per a time: `per 1 {unit}`")
    assert_fix(text, f"Write `per 1 {unit}`", text.replace(rate, fixed), safe=True)
    assert_clean(text.replace(rate, fixed))


def test_a_node_may_be_called_as_a_unit() -> None:
    text = "QualityReq r\n    X fails at most 2 per h\nBehaviorTree Main\n    Sequence h\n        Action X\n"
    assert_clean(text)


def test_a_part_of_a_failure_is_not_rounded_up() -> None:
    text = "QualityReq r\n    X fails at most 0.5 per run\nBehaviorTree Main\n    Action X\n"
    (found,) = problems(text, "impossible-bound")
    assert found.fixes == ()
    assert found.notes == ("a failure rate is per a time: `fails at most 1 per 200 h`",)
