"""Rates, events and values in the place of a condition, and conditions in the place of an event: each is one mistake,
and what its fixes write can be read.
"""

from __future__ import annotations

import pytest
from check_asserts import after, problems

from btq_lang.grammar.clause_slips import OF_SEASONS
from btq_lang.grammar.conditions import NO_RATE

MISSION = """signal x : m from {@x} initially 0 m
signal y : m from {@y} initially 0 m
signal energy : Wh from {@e} counter initially 0 Wh
signal near : bool from {@n} initially false

QualityReq r
    CLAIM

Action Go "Moves"
    output x : double
    output y : double
    output e : double
    output n : bool

Action Dock

BehaviorTree Main
    ->
        Go (x = {@x}, y = {@y}, e = {@e}, n = {@n})
        Dock
"""
LAST = "of several events a condition comes last, after `when`: `Dock succeeds or when near`"
AMONG = "among events a condition comes last, after `when`: `or when near`"
EVERY = "all nodes of a kind are written `every …`"
MIXED = [
    # a rate in a condition
    ("mission keeps x < 1 m while near at most 3 per 1 h", NO_RATE, []),
    ("mission keeps x < 1 m assuming y at most 3 per 1 h", NO_RATE, []),
    ("mission keeps x at most 2 m per 1 h", NO_RATE, []),
    ("each near at most 1 per 1 h", NO_RATE, []),
    ("each Go fails at most 1 per 1 h is followed by Dock succeeds", NO_RATE, []),
    ("each Go fails at most 1 per 200 h", EVERY, ["every Go fails at most 1 per 200 h"]),
    # events and conditions
    (
        "each Go succeeds is followed by near or Dock succeeds within 3 s",
        LAST,
        ["each Go succeeds is followed by Dock succeeds or when near within 3 s"],
    ),
    ("each Go succeeds is followed by near and Dock succeeds within 3 s", LAST, []),
    (
        "each Go succeeds is followed by x < 1 m or y < 1 m or Dock fails",
        LAST,
        ["each Go succeeds is followed by Dock fails or when x < 1 m or y < 1 m"],
    ),
    (
        "each when near or Go fails is followed by Dock succeeds",
        LAST,
        ["each Go fails or when near is followed by Dock succeeds"],
    ),
    (
        "each Go succeeds is followed by Dock succeeds or x < 1 m within 3 s",
        AMONG.replace("near", "x"),
        ["each Go succeeds is followed by Dock succeeds or when x < 1 m within 3 s"],
    ),
    (
        "each Go fails or near is followed by Dock succeeds",
        AMONG,
        [
            "each Go fails or when near is followed by Dock succeeds",
            "each Go fails or near succeeds is followed by Dock succeeds",
        ],
    ),
    # what is meant to hold soon, on average, or about
    (
        "x < 1 m within 0.5 s after near",
        "this clause is written `each when near is followed by x < 1 m within 0.5 s`",
        ["each when near is followed by x < 1 m within 0.5 s"],
    ),
    (
        "mission keeps x < 1 m within 0.5 s after Go succeeds",
        "this clause is written `each Go succeeds is followed by x < 1 m within 0.5 s`",
        ["each Go succeeds is followed by x < 1 m within 0.5 s"],
    ),
    (
        "energy <= 600 Wh on average",
        "this clause is written `uses at most 600 Wh of energy on average`",
        ["uses at most 600 Wh of energy on average"],
    ),
    (
        "mission keeps x +- 10 mm",
        "a tolerance is written `-10 mm <= x <= 10 mm`",
        ["mission keeps -10 mm <= x <= 10 mm"],
    ),
    (
        "mission keeps x == y +- 10 mm",
        "a tolerance is written `-10 mm <= x - y <= 10 mm`",
        ["mission keeps -10 mm <= x - y <= 10 mm"],
    ),
    ("x +- 10 mm", "this clause is written `keeps -10 mm <= x <= 10 mm`", ["keeps -10 mm <= x <= 10 mm"]),
    # a share of what is in no run
    ("mission available in at least 98 % of nights", OF_SEASONS, []),
]


@pytest.mark.parametrize(("claim", "message", "instead"), MIXED)
def test_a_mixed_claim_is_one_mistake_whose_fixes_can_be_read(claim: str, message: str, instead: list[str]) -> None:
    text = MISSION.replace("CLAIM", claim)
    (found,) = problems(text, "syntax-error")
    assert found.message == message
    mended = [after(text, fix) for fix in found.fixes]
    assert mended == [MISSION.replace("CLAIM", other) for other in instead]
    assert [problems(each, "syntax-error", "unit-mismatch") for each in mended] == [[] for _ in mended]


@pytest.mark.parametrize(
    "claim",
    [
        "mission keeps x + -10 mm < y",
        "each Go succeeds is followed by Dock succeeds or when near within 3 s",
        "each Go succeeds is followed by near succeeds at least 1 per run",
        "every Go fails at most 1 per 200 h",
    ],
)
def test_what_is_meant_is_left(claim: str) -> None:
    assert problems(MISSION.replace("CLAIM", claim), "syntax-error") == []


def test_no_fix_that_is_made_by_itself_leads_to_another_mistake() -> None:
    text = MISSION.replace("CLAIM", "each Go starts at most 1 per 1 h")
    assert [fix.safe for found in problems(text, "syntax-error") for fix in found.fixes] == [False]


def test_a_share_of_nights_cannot_be_said() -> None:
    text = MISSION.replace("CLAIM", "mission keeps x < 1 m\n    in at least 98 % of nights")
    (found,) = problems(text, "syntax-error")
    assert (found.notes, found.fixes) == ((OF_SEASONS,), ())


def test_what_counts_for_the_time_between_events() -> None:
    claim = "from Go succeeds to Dock succeeds takes at most 5 s\n    in at least 95 % of occurrences"
    (found,) = problems(MISSION.replace("CLAIM", claim), "impossible-odds")
    assert found.notes == (
        "of `from … to …`, `of activations` counts each time from a first event to its last one, `of runs` the runs in "
        "which all of them keep the bound",
    )


TWO = """QualityReq r
    mission never CONDITION for more than 3 s

Action Go

BehaviorTree Main
    ->
        Go A
        Go B
"""


@pytest.mark.parametrize(
    ("condition", "mended"),
    [
        ("node Go", ["(node A or node B)", "node A", "node B"]),
        ("not node Go", ["not (node A or node B)", "not node A", "not node B"]),
        ("Go", ["(node A or node B)", "A", "B"]),
    ],
)
def test_a_condition_about_any_of_several_nodes(condition: str, mended: list[str]) -> None:
    text = TWO.replace("CONDITION", condition)
    (found,) = problems(text, "ambiguous-path")
    assert found.notes == ("for any of them, a condition names each: `node A or node B`",)
    texts = [after(text, fix) for fix in found.fixes]
    assert texts == [TWO.replace("CONDITION", other) for other in mended]
    assert [problems(each, "syntax-error", "ambiguous-path") for each in texts] == [[], [], []]


def test_nodes_that_no_path_tells_apart() -> None:
    text = TWO.replace("CONDITION", "node Go").replace("Go A", "Go").replace("Go B", "Go")
    (found,) = problems(text, "ambiguous-path")
    assert found.notes == (
        "for any of them, a condition names each: `node X or node Y`",
        "nodes that no path tells apart need names: `Go X`, `Go Y`",
    )
    assert found.fixes == ()
    named = TWO.replace("CONDITION", "node X or node Y").replace("Go A", "Go X").replace("Go B", "Go Y")
    assert problems(named, "syntax-error", "ambiguous-path", "unmatched-path") == []


EACH = TWO.replace("mission never CONDITION for more than 3 s", "CLAIM")


@pytest.mark.parametrize(
    ("claim", "mended"),
    [
        (
            "each Go fails is followed by A starts",
            ["Go fails", "A fails or B fails", "A fails", "B fails"],
        ),
        ("A follows B fails or Go halts", ["Go halts", "A halts or B halts", "A halts", "B halts"]),
        (
            "from mission starts until Go succeeds\n    mission keeps not node A",
            ["Go succeeds", "A succeeds or B succeeds", "A succeeds", "B succeeds"],
        ),
    ],
)
def test_an_event_of_any_of_several_nodes(claim: str, mended: list[str]) -> None:
    text = EACH.replace("CLAIM", claim)
    (found,) = problems(text, "ambiguous-path")
    event, *others = mended
    assert found.notes == (f"for any of them, an event names each: `{others[0]}`",)
    texts = [after(text, fix) for fix in found.fixes]
    assert texts == [text.replace(event, other) for other in others]
    assert [problems(each, "syntax-error", "ambiguous-path") for each in texts] == [[], [], []]


def test_events_of_nodes_that_no_path_tells_apart() -> None:
    """Each message leads on: the path of `every Go` to one node, then to names, and with them to a clause."""
    unnamed = EACH.replace("Go A", "Go").replace("Go B", "Go")
    text = unnamed.replace("CLAIM", "each every Go fails is followed by Go starts")
    (first,) = problems(text, "syntax-error")
    assert (first.message, first.notes) == (
        "an event is about one node, without `every`",
        ("for any of several nodes write `X fails or Y fails`",),
    )
    (plain,) = [after(text, fix) for fix in first.fixes]
    assert plain == text.replace("every ", "")
    assert [each.notes for each in problems(plain, "ambiguous-path")] == [
        (
            f"for any of them, an event names each: `X {what} or Y {what}`",
            "nodes that no path tells apart need names: `Go X`, `Go Y`",
        )
        for what in ("fails", "starts")
    ]
    claim = "each X fails or Y fails is followed by X starts or Y starts"
    named = EACH.replace("Go A", "Go X").replace("Go B", "Go Y").replace("CLAIM", claim)
    assert problems(named, "syntax-error", "ambiguous-path") == []


def test_a_node_that_is_called_every() -> None:
    text = EACH.replace("Go A", "Go every").replace("CLAIM", "each every fails is followed by B starts")
    assert problems(text, "syntax-error", "ambiguous-path", "unmatched-path") == []
