"""How requirements are said in other notations, and what btq leads to: each fix gives a clause without a mistake."""

from __future__ import annotations

import pytest
from check_asserts import after, findings, problems

MISSION = """\
signal near : bool from {{@near}} initially false
signal speed : m/s from {{@speed}} initially 0 m/s
QualityReq r : safety
    {}
    needs not near
Action Go
Action Dock
BehaviorTree Main
    ->
        Go satisfies r
        Dock
"""


@pytest.mark.parametrize(
    ("clause", "meant"),
    [
        (
            "when near then speed <= 0.1 m/s within 1 s",
            ("each when near is followed by speed <= 0.1 m/s within 1 s",),
        ),
        ("if near then Go starts within 1 s", ("each when near is followed by Go starts within 1 s",)),
        (
            "If near, then speed <= 0.1 m/s",
            ("keeps speed <= 0.1 m/s while near", "each when near is followed by speed <= 0.1 m/s"),
        ),
        ("if near then takes at most 3 s", ("takes at most 3 s while near", "takes at most 3 s when near")),
        (
            "Dock not before Go succeeds",
            ("mission never node Dock from mission starts until Go succeeds", "Dock follows Go succeeds"),
        ),
        ("Go starts within 5 s before Dock starts", ("from Go starts to Dock starts takes at most 5 s",)),
        ("Go ends within 5 s before Dock starts", ("from Go finishes to Dock starts takes at most 5 s",)),
        ("where near", ("assuming near", "while near")),
        ("Go starts at most 0 per run", ("mission never node Go",)),
    ],
)
def test_each_fix_is_a_clause(clause: str, meant: tuple[str, ...]) -> None:
    (found,) = problems(MISSION.format(clause), "syntax-error", "impossible-bound")
    assert [fix.title for fix in found.fixes] == [f"Write `{each}`" for each in meant]
    for each in meant:
        assert problems(MISSION.format(each), "syntax-error", "impossible-bound", "unmatched-path") == []


@pytest.mark.parametrize(
    ("clause", "told"),
    [
        ("When near, the robot shall stop within 1 s", "`each when near is followed by <answer> within 1 s`"),
        ("when near, the robot must stop in 1 s", "`each when near is followed by <answer> within 1 s`"),
        ("mission available at least 97 %", "`mission keeps <signal> in at least 97 % of time`"),
        ('integrity "PL d"', "`integrity` is not in btq; nearest is `priority` with a word, or `source` with"),
        ("assumptions near", "`assumptions` is not in btq; nearest is `assuming` with a condition"),
        ("mission satisfies r", "satisfied by the root node of its main tree: `-> satisfies calm`"),
        ("keeps speed < 1 m/s from Go starts until when near for 5 s", "`until when clear_time >= 5 s`"),
    ],
)
def test_what_is_left_to_choose(clause: str, told: str) -> None:
    (found,) = findings(MISSION.format(clause), "syntax-error")
    assert told in found


@pytest.mark.parametrize("line", ['assumption A "Dry"', "assume dry", "assumptions\n    dry", "Assumption : dry"])
def test_assumptions_are_no_item(line: str) -> None:
    (found,) = problems(f"{line}\nBehaviorTree Main\n    Action Go\n", "syntax-error")
    assert found.notes == ("what is taken for granted is a clause of the requirement: `assuming visibility >= 1 m`",)


@pytest.mark.parametrize(
    ("line", "rule"),
    [("apply r to mission", "unmatched-path"), ("mission satisfies r", "syntax-error"), ("", "unused-requirement")],
)
def test_what_is_about_the_mission_goes_to_its_root(line: str, rule: str) -> None:
    (found,) = problems(f'QualityReq r "Calm"\n{line}\nBehaviorTree Main\n    Action Go\n', rule)
    of_root = "what is about the whole mission is satisfied by the root node of its main tree: `-> satisfies calm`"
    assert found.notes[-1] == of_root


REFINED = """\
QualityReq whole : safety "Stops"
    keeps speed <= 1 m/s{whole}
QualityReq part : safety "Stops soon"
    keeps speed <= 1 m/s{part}
signal speed : m/s from {{@speed}} initially 0 m/s
BehaviorTree Main
    Action Go satisfies whole, part
"""


@pytest.mark.parametrize("line", ["refined by part", "refined: part", "decomposed into part"])
def test_a_requirement_does_not_say_what_refines_it(line: str) -> None:
    (found,) = problems(REFINED.format(whole=f"\n    {line}", part=""), "syntax-error")
    word = line.partition(" ")[0].rstrip(":")
    nearest = "a line `refines` in the other requirement, with the ID of this one"
    assert (found.message, found.fixes) == (f"`{word}` is not in btq; nearest is {nearest}", ())
    assert findings(REFINED.format(whole="", part="\n    refines whole"), "syntax-error", "unknown-requirement") == []


@pytest.mark.parametrize(
    ("way", "method"), [("demonstration", "test"), ("trial", "test"), ("inspection", "review"), ('demo "D-1"', "test")]
)
def test_ways_of_verifying_in_other_words(way: str, method: str) -> None:
    text = REFINED.format(whole=f"\n    verified by {way}", part="")
    (found,) = problems(text, "syntax-error")
    assert found.notes == ('a demonstration or a trial is a `test "D-1"`, an inspection a `review "I-1"`',)
    mended = [after(text, fix) for fix in found.fixes]
    assert mended == [text.replace(way.split()[0], method)]
    assert problems(mended[0], "syntax-error") == []
