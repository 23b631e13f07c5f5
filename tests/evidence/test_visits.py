"""`visits`: hand-made runs, and what they come to; the mission is that of `test_run_verbs`."""

from __future__ import annotations

import pytest
from check_asserts import workspace_of
from evidence_logs import Verify, samples
from test_run_verbs import BACK, CUT, STOPPED, TWICE, clause, come_to
from test_verbs import count

from btq_lang.checks import check

UNTIL_ALARM = "0 1R 2R 3R 10 3S 4R 20 4S 2S 30 5S 1S"  # Move, then Pick, then Alarm


@pytest.mark.parametrize(
    ("demand", "runs", "expected"),
    [
        ("mission visits Move, Pick", TWICE, "satisfied 0/1"),
        ("Task visits Move, Pick in order", TWICE, "satisfied 0/1"),
        ("Task visits Pick, Move in order", TWICE, "violated 1/1"),
        ("mission visits Move, Pick, Alarm", TWICE, "violated 1/1"),
        ("mission visits Move, Pick, Alarm in order", UNTIL_ALARM, "satisfied 0/1"),
        ("Task visits Move, Alarm", UNTIL_ALARM, "violated 1/1"),  # Alarm ends after Task
        ("mission visits Move, Pick", CUT, "never exercised 0/0 |1"),
        ("mission visits Move, Pick", STOPPED, "never exercised 0/0"),
        ("Task visits Move, Pick", STOPPED, "never exercised 0/0"),  # halted
        ("mission visits Move, Pick in order", BACK, "unknown 0/0 ?1"),
        ("mission visits Move, Pick\n while not low", TWICE, "unknown 0/0 ?1"),
        ("mission visits First/Grip, Second/Grip", "0 1R 6R 7R 8R 9 8S 10 9S 7S 6S 1S", "violated 1/1"),
    ],
)
def test_visits(demand: str, runs: str, expected: str, verify: Verify) -> None:
    assert come_to(verify, demand, runs) == expected


@pytest.mark.parametrize(
    ("demand", "runs", "why"),
    [
        ("mission visits Move, Alarm", TWICE, "`Alarm` did not start"),
        ("mission visits Move, Pick", "0 1R 2R 3R 10 3F 20 3I 3R 30 3F 2F 1F", "`Move` did not succeed in 2 starts"),
        ("Task visits Pick, Move in order", TWICE, "`Move` succeeded before `Pick`"),
    ],
)
def test_why_it_is_violated(demand: str, runs: str, why: str, verify: Verify) -> None:
    found = clause(verify, demand, runs)
    assert [each["why"] for each in found["violations"]] == [why]


ROUND = """
signal next : text from {next}
Root Main
BehaviorTree Main
    ->
        MoveTo ToA (place = "A")
        MoveTo ToNext (place = "{next}")
Action MoveTo
    input place : string
"""
ROUND_XML = (
    '<root BTCPP_format="4"><BehaviorTree ID="Main" _fullpath=""><Sequence name="Sequence" _uid="1">'
    '<MoveTo name="ToA" _uid="2" place="A"/><MoveTo name="ToNext" _uid="3" place="{next}"/>'
    "</Sequence></BehaviorTree></root>"
)
BOTH = "0 1R 2R 10 2S 3R 20 3S 1S"


@pytest.mark.parametrize(
    ("visits", "place", "expected"),
    [
        ('MoveTo (place = "A"), MoveTo (place = "B")', "B", "satisfied 0/1"),
        ('MoveTo (place = "B"), MoveTo (place = "A") in order', "B", "violated 1/1"),
        ('MoveTo (place = "A"), MoveTo (place = "B")', "C", "violated 1/1"),
        ('MoveTo (place = "A"), MoveTo (place = "B")', None, "unknown 0/0 ?1"),
        ('MoveTo (place = "A"), ToNext', None, "satisfied 0/1"),
        ('ToNext, MoveTo (place = "A") in order', "A", "violated 1/1"),
    ],
)
def test_values_of_ports(visits: str, place: str | None, expected: str, verify: Verify) -> None:
    csv = samples("next", {-1: place}) if place is not None else None
    assert count(verify.clause(f"mission visits {visits}", BOTH, csv, mission=ROUND, xml=ROUND_XML)) == expected


@pytest.mark.parametrize(
    ("visits", "message", "fixes"),
    [
        ("A, ToNext", "unknown node `A`; it is the value of a port", ['MoveTo (place = "A")']),
        ('MoveTo (place = "A"), MoveTo (speed = 3)', "no node `MoveTo` has these values: `MoveTo (speed = 3)`", []),
        ("ToA, ToNxt", "unknown node `ToNxt`; did you mean `ToNext`?", ["ToNext"]),
    ],
)
def test_what_is_no_node(visits: str, message: str, fixes: list[str]) -> None:
    workspace = workspace_of({"main.btq": f"QualityReq r : safety\n    mission visits {visits}\n{ROUND}"})
    (found,) = [each for each in check(workspace, "main.btq") if each.rule == "unmatched-path"]
    assert (found.message, [each.changes[0].text for each in found.fixes]) == (message, fixes)
