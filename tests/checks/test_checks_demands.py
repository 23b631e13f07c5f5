"""What the rules about demands report beyond their pages: messages, places, and exceptions."""

from __future__ import annotations

from math import ceil

import pytest
from check_asserts import assert_clean, assert_problems, findings, problems

from btq_lang.evidence.poisson import upper_number


def mission(tree: str, *requirements: str) -> str:
    """A file with these requirements, each `id clauses`, and a tree `Main`."""
    rules = ""
    for each in requirements:
        name, _, clauses = each.partition(" ")
        rules += f'QualityReq {name} "t"\n' + "".join(f"    {clause.strip()}\n" for clause in clauses.split("|"))
    lines = "".join(f"    {line}\n" for line in tree.split("\n"))
    return f"{rules}BehaviorTree Main\n{lines}"


# ---- budgets --------------------------------------------------------------------------------------------------------

TREE = "-> Work\n    Action A\n    Retry (num_attempts = 3)\n        Action B\n    SubTree Sub"


def budget(limit: str, *others: str) -> list[str]:
    text = mission(TREE, f"main Work {limit}", "a A takes at most 5 s", "b B takes at most 4 s", *others)
    return findings(text + "BehaviorTree Sub\n    Action C\n", "budget-exceeded")


def test_the_sum_is_shown_with_each_share() -> None:
    assert budget("takes at most 20 s", "c C takes at most 3500 ms") == [
        "2 warning «Work takes at most 20 s» `-> Work` may take 20.5 s, more than `20 s` allows: "
        "`A` 5 s + `Retry` 12 s + `Sub` 3.5 s"
    ]
    assert budget("takes at most 20.5 s", "c C takes at most 3500 ms") == []
    text = mission("Retry (num_attempts = 3)\n    Action B", "main Main takes at most 10 s", "b B takes at most 4 s")
    (found,) = problems(text, "budget-exceeded")
    assert found.message == "`Retry` may take 12 s, more than `10 s` allows: 3 × `B` 4 s"
    assert [related.message for related in found.related] == ["up to 4 s, 3 times"]


def test_the_time_from_one_node_to_another_is_that_of_its_sequence() -> None:
    for tree, expected in (
        (
            "->\n    Action A\n    Action B",
            [
                "2 warning «from A starts to B succeeds takes at most 5 s» "
                "`->` may take 7 s, more than `5 s` allows: `A` 4 s + `B` 3 s"
            ],
        ),
        ("?\n    Action A\n    Action B", []),
    ):
        text = mission(
            tree, "way from A starts to B succeeds takes at most 5 s", "a A takes at most 4 s", "b B takes at most 3 s"
        )
        assert findings(text, "budget-exceeded") == expected


def test_a_step_without_a_bound_counts_as_none() -> None:
    assert budget("takes at most 17 s") == []
    assert budget("takes at most 1 s") == [
        "2 warning «Work takes at most 1 s» `-> Work` may take 17 s, more than `1 s` allows: "
        "`A` 5 s + `Retry` 12 s, not counting steps without a bound"
    ]


NO_BOUND = ", not counting steps without a bound"


@pytest.mark.parametrize(
    ("tree", "may_take"),
    [
        ("->\n    Action A\n    Action X", "`->` may take 60 s, more than `30 s` allows: `A` 60 s"),
        ("->\n    Action X\n    Action A", "`->` may take 60 s, more than `30 s` allows: `A` 60 s"),
        ("->\n    Action Y\n    Action A", "`->` may take 65 s, more than `30 s` allows: `Y` 5 s + `A` 60 s"),
        ("->\n    ->\n        Action A\n        Action X", "`->` may take 60 s, more than `30 s` allows: `->` 60 s"),
        ("?\n    Action X\n    Action A", "`?` may take 60 s, more than `30 s` allows: `A` 60 s"),
        ("All||\n    Action X\n    Action A", "`All||` may take 60 s, more than `30 s` allows: `A` 60 s"),
        ("||\n    Action X\n    Action A", "`||` may take 60 s, more than `30 s` allows: `A` 60 s"),
        ("R->\n    Condition X\n    Action A\n    SubTree Nobody", None),  # A is begun again and again
        ("|| (success_count = 2)\n    Action X\n    Action Z\n    Action A", None),  # X and Z are enough
        ("Repeat (num_cycles = -1)\n    ->\n        Action A\n        Action X", None),  # it has no end anyway
        ("->\n    Repeat (num_cycles = -1)\n        Action X\n    Action A", None),  # A is never reached
        ("->\n    ForceFailure\n        Action X\n    Action A", None),
        ("?\n    ForceSuccess\n        Action X\n    Action A", None),
        ("->\n    Custom\n        Action A\n    Action X", None),  # it is unknown whether it runs A
        ("->\n    Timeout (msec = 20 s)\n        Action A\n    Action X", None),  # reported as a bound never reached
        ("->\n    Action W\n    Action X", None),  # that is demanded in some situations only
        ("->\n    Action O\n    Action X", None),  # it is seldom late
    ],
)
def test_a_child_that_may_take_longer_than_its_parent(tree: str, may_take: str | None) -> None:
    bounds = ("a A takes at most 60 s", "y Y takes at least 5 s")
    others = ("w W takes at most 60 s|when W", "o O takes at most 60 s|in at least 90 % of activations")
    text = mission(tree, "main Main takes at most 30 s", *(each for each in (*bounds, *others) if each[2] in tree))
    expected = [f"2 warning «Main takes at most 30 s» {may_take}{NO_BOUND}"] if may_take else []
    assert findings(text, "budget-exceeded") == expected


def test_what_can_never_hold_is_told_with_odds_too() -> None:
    """A failure may come at once, so only a success is sure to take that long."""
    odds = "|in at least 90 % of activations"
    assert budget(f"takes at most 20 s{odds}", "c C takes at least 30 s") == []
    assert budget(f"succeeds within 20 s{odds}", "c C takes at least 30 s") == [
        "2 warning «Work succeeds within 20 s» `-> Work` takes at least 30 s, so it always violates `20 s`"
    ]


@pytest.mark.parametrize(
    "limit",
    [
        "takes at most 20 s|in at least 90 % of activations",  # the worst case is not what it is about
        "takes at least 1 s",
        "takes at most limit",
    ],
)
def test_what_no_budget_is_held_against(limit: str) -> None:
    assert budget(limit, "c C takes at most 3500 ms") == []


def test_success_alone_counts_for_succeeds() -> None:
    tree = "?\n    Action A\n    Action B"
    bounds = ("a A takes at most 5 s", "b B takes at most 9 s")
    assert findings(mission(tree, "main Main succeeds within 12 s", *bounds), "budget-exceeded") == [
        "2 warning «Main succeeds within 12 s» `?` may take 14 s, more than `12 s` allows: `A` 5 s + `B` 9 s"
    ]


def test_timeouts() -> None:
    text = mission("Timeout (msec = 4 s)\n    ->\n        Action A", "a A takes at least 5 s")
    assert findings(text, "timeout-never-succeeds", "dead-bound") == [
        "4 warning «Timeout» `Timeout` can never succeed: `->` takes at least 5 s"
    ]
    text = mission("Timeout (msec = {limit})\n    Action A", "a A takes at most 5 s")
    assert findings(text, "timeout-never-succeeds", "dead-bound") == []
    text = mission("Timeout (msec = 4000)\n    Timeout (msec = 3 s)\n        Action A", "a A takes at most 5 s")
    assert findings(text, "dead-bound") == [
        "2 warning «A takes at most 5 s» `5 s` is never reached: a Timeout halts `A` after 3 s"
    ]


# ---- limits ---------------------------------------------------------------------------------------------------------


def test_synchronous_nodes() -> None:
    rules = ("limit-on-synchronous-node",)
    tree = "->\n    -> Checks\n        Condition C\n        Script (code = x)\n    Action A"
    told = "completes within one tick, so the engine cannot stop it after `5 s`"
    for subject, found in (
        ("C", f"«C takes at most 5 s» `C` {told}"),
        ("Checks", f"«Checks takes at most 5 s» `-> Checks` {told}"),
    ):
        text = mission(tree, f"q {subject} takes at most 5 s|on violation halt")
        assert findings(text, *rules) == [f"2 warning {found}"]
    for clauses in (
        "A takes at most 5 s|on violation halt",
        "C takes at most 5 s",
        "C takes at least 5 s|on violation fail",
    ):
        assert findings(mission(tree, f"q {clauses}"), *rules) == []


def test_small_limits() -> None:
    for limit, found in (("0.9 ms", 1), ("1 ms", 0), ("1 s if x else 2 s", 0)):
        text = "signal x : bool initially true\n" + mission(
            "Action A", f"q A succeeds within {limit}|on violation fail"
        )
        assert len(findings(text, "limit-too-small")) == found
    assert findings(mission("Action A", "q A takes at most 0 s"), "limit-too-small") == []


def test_attempts() -> None:
    tree = "-> Work\n    Repeat (num_cycles = 2)\n        Retry (num_attempts = 3)\n            Action A"
    assert findings(mission(tree, "q A tries at most 3 per Work"), "attempts-mismatch") == [
        "2 warning «A tries at most 3 per Work» `A` may be tried 6 times, but the requirement allows 3"
    ]
    assert findings(mission(tree, "q A tries at most 6 per Work"), "attempts-mismatch") == []
    assert findings(mission(tree.replace("3)", "{n})"), "q A tries at most 1 per Work"), "attempts-mismatch") == []


@pytest.mark.parametrize(
    ("first", "second", "message"),
    [
        (
            "A takes at least 5 s",
            "A takes at most 4 s",
            "`A` cannot keep both bounds: at least `5 s` and at most `4 s`",
        ),
        (
            "A takes between 5 s and 3 s",
            "A succeeds",
            "`A` cannot keep both bounds: at least `5 s` and at most `3 s`",
        ),
        ("A keeps n <= 3", "A keeps 5 < n", "`A` cannot keep both bounds: at least `5` and at most `3`"),
        (
            "A uses at least 2 of n",
            "A uses at most 1 of n",
            "`A` cannot keep both bounds: at least `2` and at most `1`",
        ),
    ],
)
def test_contradictions(first: str, second: str, message: str) -> None:
    text = "signal n : 1 from {n} initially 0\n" + mission("Action A", f"q {first}", f"r {second}")
    assert [found.message for found in problems(text, "contradicting-bounds")] == [message]


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ("A takes at least 5 s", "A takes at most 5 s"),
        ("A takes at least 5 s", "B takes at most 4 s"),
        ("A takes at least 5 s|while fast", "A takes at most 4 s"),
        ("A takes at least 5 s", "A takes at most 4 s|in at least 10 % of activations"),
        ("A takes at least 5 s", "A takes at most 4 s if fast else 6 s"),
        ("A keeps n <= 3", "A leaves 5 < n"),
    ],
)
def test_what_can_both_hold(first: str, second: str) -> None:
    text = "signal n : 1 from {n} initially 0\ncontext fast : n > 3\n"
    text += mission("->\n    Action A\n    Action B", f"q {first}", f"r {second}")
    assert findings(text, "contradicting-bounds") == []


# ---- odds -----------------------------------------------------------------------------------------------------------


def test_odds() -> None:
    tree = "-> Work\n    Action A\n    Repeat (num_cycles = 2)\n        Action B"
    steps = (
        "a A takes at most 2 s|in at least 99 % of activations",
        "b B takes at most 3 s|in at least 98 % of activations",
    )
    text = mission(tree, "q Work takes at most 9 s|in at least 96 % of activations", *steps)
    (found,) = problems(text, "odds-beyond-children")
    assert found.message == (
        "`-> Work` must meet `Work takes at most 9 s` in 96 % of activations, but the requirements of the nodes below "
        "it guarantee only 95 %"
    )
    assert [related.message for related in found.related] == ["fails in up to 1 %", "fails in up to 4 %"]
    for clauses in (
        "takes at most 9 s|in at least 95 % of activations",
        "takes at most 9 s|in at least 99 % of runs",
        "takes at most 7 s|in at least 99 % of activations",
        "takes at most 9 s",  # hard, with time to spare for a step that is late
    ):
        assert findings(mission(tree, f"q Work {clauses}", *steps), "odds-beyond-children") == []


@pytest.mark.parametrize(
    ("root", "subject", "called"),
    [("->", "mission", "`mission`"), ("->", "Main", "`Main`"), ("-> Work", "Main", "`-> Work`")],
)
def test_success_without_odds_is_for_always_and_the_node_is_called_as_people_do(
    root: str, subject: str, called: str
) -> None:
    text = mission(f"{root}\n    Action A", f"q {subject} succeeds", "a A succeeds|in at least 99 % of activations")
    (found,) = problems(text, "odds-beyond-children")
    assert found.message == (
        f"{called} must meet `{subject} succeeds` in 100 % of activations, but the requirements of the nodes below it "
        "guarantee only 99 %"
    )


@pytest.mark.parametrize(
    ("tree", "ensured"),
    [
        ("->\n    Action A\n    Action X", "90 %, even if every other step succeeds"),
        ("->\n    Action X\n    ->\n        Action A\n        Action X", "90 %, even if every other step succeeds"),
        ("->\n    Action A\n    Action A\n    Action X", "80 %, even if every other step succeeds"),
        (
            "Repeat (num_cycles = 2)\n    ->\n        Action A\n        SubTree Nobody",
            "80 %, even if every other step succeeds",
        ),
        ("||\n    Action A\n    Action X", "90 %, even if every other step succeeds"),
        ("->\n    Action A\n    Action A", "80 %"),
        ("->\n    Action X\n    Action X", None),
        ("?\n    Action A\n    Action X", None),  # X may succeed where A does not
        ("|| (success_count = 1)\n    Action A\n    Action X", None),
        ("->\n    Action A (_skipIf = never)\n    Action X", None),
        ("->\n    Retry (num_attempts = 2)\n        Action A\n    Action X", None),
        ("->\n    Inverter\n        Action A\n    Action X", None),
        ("->\n    Custom\n        Action A\n    Action X", None),
        ("->\n    Action B\n    Action X", None),
    ],
)
def test_odds_of_a_child_that_are_lower_than_its_parents(tree: str, ensured: str | None) -> None:
    steps = ("a every A succeeds|in at least 90 % of activations", "b every B succeeds|in at least 95 % of activations")
    must = "`Main` must meet `Main succeeds` in 95 % of activations"
    told = [f"{must}, but the requirements of the nodes below it guarantee only {ensured}"] if ensured else []
    text = mission(tree, "q Main succeeds|in at least 95 % of activations", *(s for s in steps if f"n {s[8]}" in tree))
    assert [found.message for found in problems(text, "odds-beyond-children")] == told


def test_windows() -> None:
    def found(odds: str, window: str) -> list[str]:
        text = mission("Action A", f"q A succeeds|in at least {odds} of activations|confidence 95 %|over last {window}")
        return [each.message for each in problems(text, "window-too-small")]

    assert found("99 %", "298 activations") == [
        "298 activations cannot show 99 % with a confidence of 95 %: this requires 299 without a failure"
    ]
    assert found("99 %", "299 activations") == []
    assert found("99 %", "7 d") == []
    assert found("100 %", "9000 activations") == [
        "9000 activations cannot show 100 % with a confidence of 95 %: no window is large enough"
    ]


@pytest.mark.parametrize(("confidence", "number"), [("95 %", 1.0), ("99 %", 1.0), ("80 %", 2.5)])
def test_a_window_that_is_too_short_for_a_failure_rate(confidence: str, number: float) -> None:
    needed = ceil(upper_number(0, float(confidence[:-2]) / 100) / number * 100)

    def found(window: str) -> list[str]:
        text = mission("Action A", f"q A fails at most {number:g} per 100 h|confidence {confidence}|over last {window}")
        return [each.message for each in problems(text, "window-too-small")]

    assert found(f"{needed} h") == []
    assert found(f"{needed - 1} h") == [
        f"`over last {needed - 1} h` cannot show at most {number:g} per 100 h with a confidence of {confidence}: "
        f"this requires {needed} h without a failure"
    ]


@pytest.mark.parametrize(
    ("clauses", "once", "needed"),
    [
        ("A fails at most 1 per 100 h", "100 h", "300 h"),
        ("A fails at most 1e-6 per 10 min", "10000000 min", "29957323 min"),
        ("A fails between 0.1 and 0.5 per 1 h", "2 h", "6 h"),
        ("A fails at most 1 per 100 h|confidence 90 %", None, None),
        ("A fails at most 0 per 100 h", None, None),
        ("A fails at least 1 per 100 h", None, None),
    ],
)
def test_a_failure_rate_without_confidence(clauses: str, once: str | None, needed: str | None) -> None:
    shown = [(each.message, each.notes) for each in problems(mission("Action A", f"q {clauses}"), _WITHOUT)]
    message = f"without `confidence` this failure rate is judged only by its value, once {once} were observed"
    expected = [(message, (f"`confidence 95 %` asks for {needed} without a failure",))]
    assert shown == (expected if once is not None else [])


_WITHOUT = "rate-without-confidence"


# ---- swallowed ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("tree", "reason"),
    [
        ("?\n    {}\n    Action B", "`?` continues with its next child"),
        ("R?\n    -> Inner\n        {}\n    Action B", "`R?` continues with its next child"),
        ("Retry (num_attempts = 2)\n    {}", "`Retry` tries again"),
        ("Inverter\n    {}", "`Inverter` succeeds"),
        ("ForceSuccess\n    {}", "`ForceSuccess` succeeds"),
        ("IfThenElse\n    {}\n    Action B\n    Action C", "`IfThenElse` runs its third child"),
        (
            "|| (failure_count = 2 success_count = 1)\n    {}\n    Action B",
            "`||` continues: it fails only after more than one failure",
        ),
        (
            "All|| (max_failures = -1)\n    {}\n    Action B",
            "`All||` continues: it fails only after more than one failure",
        ),
        ("ForceSuccess\n    SubTree Sub\nBehaviorTree Sub\n    {}", "`ForceSuccess` succeeds"),
    ],
)
def test_where_a_failure_ends(tree: str, reason: str) -> None:
    text = mission("@", "q A takes at most 5 s|on violation fail").replace("    @\n", "")
    lines = tree.replace("{}", "Action A").split("\n")
    at_file = False
    for line in lines:
        at_file = at_file or line.startswith("BehaviorTree")
        text += f"{line}\n" if at_file else f"    {line}\n"
    found = problems(text, "swallowed-failure")
    assert [each.message for each in found] == [f"when `A` fails because of this, {reason}"]
    assert problems(text.replace("fail\n", "halt\n"), "swallowed-failure") == []


@pytest.mark.parametrize(
    "tree",
    [
        "?\n    Action B\n    {}",
        "Retry (num_attempts = 1)\n    {}",
        "IfThenElse\n    {}\n    Action B",
        "IfThenElse\n    Action B\n    {}\n    Action C",
        "||\n    {}\n    Action B",
        "|| (failure_count = 2)\n    {}\n    Action B",  # all must succeed, so one failure is enough
        "Decorator Mine\n    {}",  # it is unknown
        "TryCatch\n    {}\n    Action B",
    ],
)
def test_failures_that_reach_the_root(tree: str) -> None:
    text = mission(tree.replace("{}", "Action A"), "q A takes at most 5 s|on violation fail")
    assert findings(text, "swallowed-failure") == []


def test_what_cannot_be_enforced_fails_nothing() -> None:
    for clauses in (
        "A takes at least 5 s|on violation fail",
        "A runs at least 1 per 5 s|on violation fail",
        "A takes at most 5 s",
        "A takes at most 5 s|on violation fail|in at least 98 % of runs",
        "A takes at most 5 s|on violation fail|over last 5 runs",
        "A takes at most 5 s|on violation fail|verified by review",
        "A takes at most 5 s|on violation fail|verified by test",
    ):
        assert findings(mission("Inverter\n    Action A", f"q {clauses}"), "swallowed-failure") == []


def test_one_way_up_is_enough() -> None:
    text = mission(
        "->\n    SubTree Sub\n    ForceSuccess\n        SubTree Sub", "q A takes at most 5 s|on violation fail"
    )
    assert findings(text + "BehaviorTree Sub\n    Action A\n", "swallowed-failure") == []


# ---- signals --------------------------------------------------------------------------------------------------------

GUARD = 'signal n : 1 from {level}{initially}\nQualityReq q "t"\n    A keeps n <= 3\n    on violation halt\n'


@pytest.mark.parametrize(
    "writer",
    [
        "Condition S (out = {level})",
        "Condition S (out = {@level})",
        "Condition S (level = {=})",
        'Script (code = "@level := 1.0")',
        'Condition S (_onSuccess = "level := 1.0")',
        "SetBlackboard (value = 3 output_key = level)",
        "SubTree Sub (x = {level})",
    ],
)
def test_what_writes_a_signal(writer: str) -> None:
    text = GUARD.replace("{initially}", " initially 0") + "BehaviorTree Main\n    ->\n        {}\n        Action A\n"
    text += "BehaviorTree Sub\n    Action B\n"
    assert findings(text.replace("{}", writer), "signal-never-written") == []
    assert findings(text.replace("{}", "Condition C"), "signal-never-written") == [
        "1 hint «n» no port and no script writes `level`, the entry of `n`"
    ]


@pytest.mark.parametrize(
    ("port", "node", "note"),
    [
        ("output level : double", "S", "connect the output `level` of `S`: `level = {@level}`"),
        ("output n", 'S "name"', "connect the output `n` of `S`: `n = {@level}`"),
        ("output n", "S (n = {other})", None),
        ("input n", "S", None),
        ("output m", "S", None),
    ],
)
def test_an_output_that_is_not_connected_to_a_signal(port: str, node: str, note: str | None) -> None:
    text = GUARD.replace("{initially}", " initially 0") + f"Condition S\n    {port}\n"
    text += f"BehaviorTree Main\n    ->\n        {node}\n        Action A\n"
    (found,) = problems(text, "signal-never-written")
    assert found.notes == (note or "ignore this if the robot's program writes it",)
    assert found.effective_severity.value == ("warning" if note else "hint")
    assert [related.message for related in found.related] == (
        [f"writes `{port.split()[1]}` nowhere"] if note is not None else []
    )


def test_an_input_writes_nothing() -> None:
    text = GUARD.replace("{initially}", " initially 0") + "Condition S\n    input x : double\n"
    text += "BehaviorTree Main\n    ->\n        S (x = {level})\n        Action A\n"
    assert len(findings(text, "signal-never-written")) == 1


def test_a_first_value() -> None:
    tree = "BehaviorTree Main\n    ->\n        Condition S (out = {level})\n        Action A\n"
    message = "`n` has no initial value: the mission ends if a guard reads it before anything writes it"
    assert findings(GUARD.replace("{initially}", "") + tree, "signal-may-be-unset") == [f"1 warning «n» {message}"]
    assert findings(GUARD.replace("{initially}", "").replace("halt", "warn") + tree, "signal-may-be-unset") == []
    reviewed = GUARD.replace("{initially}", "").replace("halt", "halt\n    verified by review")
    assert findings(reviewed + tree, "signal-may-be-unset") == []
    through = GUARD.replace("{initially}", "").replace("A keeps n <= 3", "A takes at most 3 s\n    A needs high")
    assert findings(through + "context high : n > 3\n" + tree, "signal-may-be-unset") == [f"1 warning «n» {message}"]


HARD = 'BehaviorTree Main\n    ->\n        {}\n        A (satisfies QualityReq ID = "q" description = "{said}")\n'


@pytest.mark.parametrize("said", ["SuccessIf level > 20", "FailureIf level < 20 && true"])
def test_an_entry_of_a_description(said: str) -> None:
    text = HARD.replace("{said}", said)
    message = "nothing in the mission writes `level`: it ends if a guard reads it before anything writes it"
    told = [f'4 warning «"{said}"» {message}']
    assert findings(text.replace("{}", "B"), "signal-may-be-unset") == told
    assert findings(text.replace("{}", 'Script (code = "other := 1")'), "signal-may-be-unset") == told
    for writer in ('Script (code = "level := 1")', "B (out = {level})", "Script (code = '@level := 1')"):
        assert findings(text.replace("{}", writer), "signal-may-be-unset") == []


def test_an_entry_of_a_description_that_enforces_nothing() -> None:
    text = HARD.replace("{}", "B").replace("{said}", "SuccessIf level > 20")
    assert findings(text.replace('"q"', '"q" verified by review'), "signal-may-be-unset") == []
    assert findings(HARD.replace("{}", "B").replace("{said}", "the level is above 20"), "signal-may-be-unset") == []


# ---- places ---------------------------------------------------------------------------------------------------------


def test_what_a_file_attaches_is_told_where_it_attaches_it() -> None:
    assert_problems(
        """
        //- main.btq
        include "rules.btq"
        apply quick(limit = 60 s) to A
        BehaviorTree Main
            Timeout (msec = 30 s)
                Action A
        //- rules.btq
        QualityReq quick(limit : s = 5 s) "t"
            takes at most limit
        """,
        "main.btq:2:7 warning dead-bound «quick» `60 s` is never reached: a Timeout halts `A` after 30 s",
    )


@pytest.mark.parametrize(
    ("call", "port", "is_another"),
    [
        ("SubTree Part", "{heat}", True),
        ("SubTree Part (heat = {temperature})", "{heat}", True),
        ("SubTree Part (other = {heat})", "{heat}", False),  # the SubTree node may write it
        ("SubTree Part", "{@heat}", False),
        ("SubTree Part (heat = {heat})", "{heat}", False),
        ("SubTree Part (heat = {=})", "{=}", False),
        ("SubTree Part (_autoremap = true)", "{heat}", False),
        ("SubTree Part (_autoremap = false)", "{heat}", True),
    ],
)
def test_an_entry_of_a_tree_is_not_that_of_the_root(call: str, port: str, is_another: bool) -> None:
    text = (
        "signal hot : bool from {heat} initially false\nQualityReq r\n    Rest keeps not hot\n    on violation fail\n"
        f"Root Main\nBehaviorTree Main\n    ->\n        {call}\n        Rest\n"
        f"BehaviorTree Part\n    Look (heat = {port})\nAction Look\n    output heat : bool\n"
    )
    expected = "1 warning «hot» `hot` reads the root's `heat`, but the tree `Part` writes its own `heat`"
    assert findings(text, "signal-never-written") == ([expected] if is_another else [])


@pytest.mark.parametrize(
    ("clause", "model", "is_told"),
    [
        ("Rest keeps not hot", "Action Look\n    output heat : bool\n", True),
        ("Rest keeps not hot", "", False),  # which may read it
        ("Rest keeps not hot", "Action Look\n    input heat : bool\n", False),
        ("Rest tries at most 3", "Action Look\n    output heat : bool\n", False),  # the signal is unused
    ],
)
def test_nor_where_logs_alone_are_judged(clause: str, model: str, *, is_told: bool) -> None:
    text = (
        f"signal hot : bool from {{heat}} initially false\nQualityReq r\n    {clause}\n"
        "Root Main\nBehaviorTree Main\n    ->\n        SubTree Part\n        Rest\n"
        f"BehaviorTree Part\n    Look (heat = {{heat}})\n{model}"
    )
    expected = "1 hint «hot» `hot` reads the root's `heat`, but the tree `Part` writes its own `heat`"
    assert findings(text, "signal-never-written") == ([expected] if is_told else [])


def test_a_private_entry_of_a_tree_is_not_that_of_the_root_either() -> None:
    text = (
        "signal hot : bool from {_heat} initially false\nQualityReq r\n    Rest keeps not hot\n    on violation fail\n"
        "Root Main\nBehaviorTree Main\n    ->\n        SubTree Part (_autoremap = true)\n        Rest\n"
        "BehaviorTree Part\n    Look (heat = {_heat})\nAction Look\n    output heat : bool\n"
    )
    expected = "1 warning «hot» `hot` reads the root's `_heat`, but the tree `Part` writes its own `_heat`"
    assert findings(text, "signal-never-written") == [expected]


def outbid(*clauses: str) -> str:
    lines = "".join(f"    {clause}\n" for clause in clauses)
    return f'QualityReq rq1 "t"\n{lines}BehaviorTree Main\n    Action X satisfies rq1\n'


@pytest.mark.parametrize(
    ("clauses", "line", "said"),
    [
        (("takes at most 30 s", "takes at most 40 s"), 3, "at most `30 s`, so `40 s`"),
        (("takes at most 1 min", "takes at most 40 s"), 2, "at most `40 s`, so `1 min`"),
        (("tries at most 2", "tries at most 1"), 2, "at most `1`, so `2`"),
        (("takes at least 3 s", "takes at least 4 s"), 2, "at least `4 s`, so `3 s`"),
        (("takes at most 30 s", "takes at most 30 s"), 3, "at most `30 s`, so `30 s`"),
    ],
)
def test_a_bound_that_another_of_the_requirement_outbids(clauses: tuple[str, ...], line: int, said: str) -> None:
    assert_problems(
        outbid(*clauses),
        f"{line}:5 warning dead-bound «{clauses[line - 2]}» the same requirement already demands {said} has no effect",
    )


@pytest.mark.parametrize(
    "clauses",
    [
        ("takes at least 3 s", "takes at most 30 s"),
        ("takes at most 40 s", "succeeds within 50 s"),
        ("takes at most 30 s", "takes less than 30 s"),
    ],
)
def test_bounds_that_both_say_something(clauses: tuple[str, ...]) -> None:
    assert_clean(outbid(*clauses))


def test_a_requirement_that_reaches_a_node_twice_outbids_nothing() -> None:
    assert_clean(outbid("takes at most 30 s") + "apply rq1 to every X\n")
