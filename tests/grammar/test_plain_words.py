"""Requirements in the words of a person who writes down what a client asks for: each fix gives a clause that can be
read, and each message names the form that is meant.
"""

from __future__ import annotations

import pytest
from check_asserts import after, findings, problems

from btq_lang.grammar.claim_mistakes import PROSE

MISSION = """\
signal distance : m from {@distance} initially 10 m
signal speed : m/s from {@speed} initially 0 m/s
signal jam : bool from {@jam} initially false

QualityReq r : safety "Calm"
    CLAUSE

Action Drive
Action Shake
BehaviorTree Main
    ->
        Drive satisfies r
        Shake
"""
RULES = ("syntax-error", "unit-mismatch", "unknown-signal", "unmatched-path", "impossible-bound")


@pytest.mark.parametrize(
    ("clause", "meant"),
    [
        # two values
        (
            "mission keeps speed <= 0.3 m/s if distance < 10 m else 0.8 m/s",
            "mission keeps speed <= (0.3 m/s if distance < 10 m else 0.8 m/s)",
        ),
        ("keeps speed < 1 m/s if jam, otherwise 2 m/s", "keeps speed < (1 m/s if jam else 2 m/s)"),
        # how often
        ("Drive never starts more than 2 times", "Drive starts at most 2 per run"),
        ("Drive never runs more than twice", "Drive starts at most 2 per run"),
        ("Drive must not fail more often than once per run", "Drive fails at most 1 per run"),
        # tolerances
        ("Drive leaves speed = 0.1 m/s +/- 0.02 m/s", "Drive leaves 0.08 m/s <= speed <= 0.12 m/s"),
        ("Drive leaves speed = 0.1 m/s ± 0.02 m/s", "Drive leaves 0.08 m/s <= speed <= 0.12 m/s"),
        ("keeps speed == 0.1 m/s +- 0.02 m/s", "keeps 0.08 m/s <= speed <= 0.12 m/s"),
        ("mission keeps speed 0.1 m/s ± 20 %", "mission keeps 0.08 m/s <= speed <= 0.12 m/s"),
        ("keeps distance == 1 m ± 5 cm", "keeps -5 cm <= distance - 1 m <= 5 cm"),
        ("keeps speed ± 0.02 m/s", "keeps -0.02 m/s <= speed <= 0.02 m/s"),
        # what ends soon
        (
            "Drive halts within 0.5 s after when distance < 1.5 m",
            "Drive ends within 0.5 s after when distance < 1.5 m",
        ),
        ("Drive stops within 0.5 s after jam", "Drive ends within 0.5 s after when jam"),
        ("Drive must be halted within 1 s after Shake starts", "Drive ends within 1 s after Shake starts"),
        # the robot
        ("The robot shall never exceed 0.8 m/s", "mission keeps speed <= 0.8 m/s"),
        ("the robot must not be faster than 3 km/h", "mission keeps speed <= 3 km/h"),
        ("The robot takes at most 3 min", "mission takes at most 3 min"),
    ],
)
def test_each_fix_is_a_clause(clause: str, meant: str) -> None:
    text = MISSION.replace("CLAUSE", clause)
    (found,) = problems(text, *RULES)
    assert found.message == f"this clause is written `{meant}`"
    assert [after(text, fix) for fix in found.fixes] == [MISSION.replace("CLAUSE", meant)]
    assert findings(MISSION.replace("CLAUSE", meant), *RULES) == []


@pytest.mark.parametrize(
    ("clause", "meant"),
    [
        ("when jam robot stops within 1 s", "each when jam is followed by <answer> within 1 s"),
        ("when jam, the robot shall stop within 1 s", "each when jam is followed by <answer> within 1 s"),
        ("each when jam robot halts within 1 s", "each when jam is followed by <answer> within 1 s"),
        ("robot stops within 1 s after Shake fails", "each Shake fails is followed by <answer> within 1 s"),
        (
            "The robot stops within 2 s after distance < 1 m",
            "each when distance < 1 m is followed by <answer> within 2 s",
        ),
    ],
)
def test_a_robot_that_stops(clause: str, meant: str) -> None:
    (found,) = problems(MISSION.replace("CLAUSE", clause), *RULES)
    assert (found.message, found.fixes) == (f"this clause is written `{meant}`", ())
    assert found.notes == (
        "the answer is an event, as `Stop succeeds`, or a condition, as `speed <= 0.01 m/s`, which one moment meets; "
        "what must stay so is written `never near and speed > 0.01 m/s for more than 1 s`",
    )
    for answer in ("Shake starts", "speed <= 0.01 m/s"):
        assert findings(MISSION.replace("CLAUSE", meant.replace("<answer>", answer)), *RULES) == []
    stays = "mission never jam and speed > 0.01 m/s for more than 1 s"
    assert findings(MISSION.replace("CLAUSE", stays), *RULES) == []


@pytest.mark.parametrize(
    ("clause", "message"),
    [
        ("user stops robot within 2 s", "expected a verb after `user`, found `stops`"),
        ("technician replaces disc within 15 min", "expected a verb after `technician`, found `replaces`"),
        ("The operator presses a button", "expected a verb: takes, succeeds, needs, keeps, …, found `operator`"),
        ("replace disc takes at most 15 min", "a path is written with `/`: `replace/disc`"),
    ],
)
def test_what_people_do_is_prose(clause: str, message: str) -> None:
    (found,) = problems(MISSION.replace("CLAUSE", clause), *RULES)
    assert (found.message, found.notes[-1]) == (message, PROSE)
    mended = MISSION.replace("CLAUSE", 'verified by test "UT-1"').replace("Calm", "Users stop it within 2 s")
    assert findings(mended, *RULES) == []


@pytest.mark.parametrize(
    ("clause", "word"),
    [("Drive taks at most 3 s", "takes"), ("keps speed < 1 m/s", "keeps"), ("suceeds within 3 s", "succeeds")],
)
def test_a_misspelt_verb_is_none(clause: str, word: str) -> None:
    (found,) = problems(MISSION.replace("CLAUSE", clause), "syntax-error")
    assert found.message.endswith(f"did you mean `{word}`?")


def test_an_else_after_a_situation() -> None:
    (found,) = problems(MISSION.replace("CLAUSE", "keeps speed <= 0.3 m/s when jam else 0.8 m/s"), *RULES)
    assert found.notes == ("a choice of values goes in brackets: `keeps speed <= (0.3 m/s if near else 0.8 m/s)`",)


def test_each_without_an_answer() -> None:
    (found,) = problems(MISSION.replace("CLAUSE", "each when jam at most 3 s"), *RULES)
    assert found.message == "expected `is followed by` after `each` and its event"
    assert found.notes == ("write `each when near is followed by speed <= 0.01 m/s within 1 s`",)
