"""What is judged over a run, and windows: hand-made runs, and what they come to.

The mission: Task runs Move, then Pick; Alarm runs beside it, and Use is a subtree that is used twice.
"""

from __future__ import annotations

from typing import Any

import pytest
from evidence_logs import START, Verify, btlog, rows, samples
from test_verbs import count

MISSION = """
Root Main
BehaviorTree Main
    ||
        -> Task
            Action Move
            Action Pick
        Action Alarm
        SubTree Use First
        SubTree Use Second
BehaviorTree Use
    ->
        Action Grip
        Action Put
Action Move
Action Pick
Action Alarm
Action Grip
Action Put
"""
XML = (
    '<root BTCPP_format="4"><BehaviorTree ID="Main" _fullpath=""><Parallel name="Parallel" _uid="1">'
    '<Sequence name="Task" _uid="2"><Move name="Move" _uid="3"/><Pick name="Pick" _uid="4"/></Sequence>'
    '<Alarm name="Alarm" _uid="5"/><SubTree ID="Use" _fullpath="First" _uid="6"/>'
    '<SubTree ID="Use" _fullpath="Second" _uid="10"/></Parallel></BehaviorTree>'
    '<BehaviorTree ID="Use" _fullpath="First"><Sequence name="Sequence" _uid="7"><Grip name="Grip" _uid="8"/>'
    '<Put name="Put" _uid="9"/></Sequence></BehaviorTree>'
    '<BehaviorTree ID="Use" _fullpath="Second"><Sequence name="Sequence" _uid="11"><Grip name="Grip" _uid="12"/>'
    '<Put name="Put" _uid="13"/></Sequence></BehaviorTree></root>'
)
LEVEL = "signal battery : % from {battery_level}"
LOW = f"{LEVEL}\ncontext low : battery < 20 %"


def clause(verify: Verify, demand: str, runs: str, csv: str | None = None, before: str = LOW) -> dict[str, Any]:
    return verify.clause(demand, runs, csv, mission=MISSION, xml=XML, before=before)


def come_to(verify: Verify, demand: str, runs: str, csv: str | None = None) -> str:
    return count(clause(verify, demand, runs, csv))


TWICE = "0 1R 2R 3R 10 3F 20 3I 3R 30 3S 4R 50 4S 2S 1S"  # Move from 0 to 10 and from 20 to 30, Pick from 30 to 50
CUT = "0 1R 2R 3R 10 3F 20 3I 3R 30 3S 4R 50 5I"  # the same, and the log ends
STOPPED = "0 1R 2R 3R 10 3F 20 3I 3R 30 3I 2I 1I"
UNWRITTEN = "0 1R 2R 3R 10 3F 20 3I 3R 50 2F 1F"  # Move was halted at some time before 50
BACK = "40 1R 2R 3R 60 3S 4R 50 4S 2S 1S"  # the clock was set back
IDLE_RUN = "0 1R 5R 50 5S 1S"  # Move does not start


@pytest.mark.parametrize(
    ("demand", "runs", "expected"),
    [
        ("Move tries at most 2", TWICE, "satisfied 0/1"),
        ("Move tries at most 1", TWICE, "violated 1/1"),
        ("Move tries less than 2", TWICE, "violated 1/1"),
        ("Move tries less than 3", TWICE, "satisfied 0/1"),
        ("Move tries at most 1", STOPPED, "violated 1/1"),
        ("Move tries at most 2", STOPPED, "satisfied 0/1"),
        ("Move tries at most 1", CUT, "violated 1/1"),
        ("Move tries at most 2", CUT, "never exercised 0/0 |1"),
        ("Move tries at least 2", CUT, "never exercised 0/0 |1"),
        ("Move tries at least 3", TWICE, "violated 1/1"),
        ("Move tries at least 3", STOPPED, "never exercised 0/0"),
        ("Move tries between 1 and 2", TWICE, "satisfied 0/1"),
        ("Move tries between 3 and 4", TWICE, "violated 1/1"),
        ("Move tries at most 2", IDLE_RUN, "never exercised 0/0"),
        ("Move tries at least 1", IDLE_RUN, "violated 1/1"),
        ("Move tries at most 2", BACK, "unknown 0/0 ?1"),
        # An activation of Task has both; Pick has none; two activations of Task have one each.
        ("Move tries at most 1 per Task", TWICE, "violated 1/1"),
        ("Move tries at most 1 per Pick", TWICE, "never exercised 0/0"),
        ("Move tries at most 1 per Task", "0 1R 2R 3R 10 3F 2F 20 2R 3R 30 3S 2S 1S", "satisfied 0/2"),
        ("Move tries at most 1 per Task", UNWRITTEN, "violated 1/1"),
        # SKIPPED is not an activation, and an earlier one counts where it started.
        ("Move tries at most 1 per Alarm", "0 1R 3R 10 5R 20 3S 3R 30 5S 40 3S 1S", "satisfied 0/1"),
        ("Move tries at most 1 per Alarm", "0 1R 3R 10 5R 20 3S 3R 30 3S 3R 40 5S 1S", "violated 1/1"),
        # An activation that had ended by 40 may have been over before the second start.
        ("Move tries at most 1 per Pick", "0 1R 2R 4R 10 3R 20 3S 3R 30 3S 40 2F 1F", "unknown 0/0 ?1"),
        ("Move tries at most 2 per Pick", "0 1R 2R 4R 10 3R 20 3S 3R 30 3S 40 2F 1F", "satisfied 0/1"),
        # The instances of a subtree: each by itself.
        ("Grip tries at most 1", "0 1R 8S 12S 10 1S", "satisfied 0/2"),
        ("Grip tries at most 1", "0 1R 8S 8S 12S 10 1S", "violated 1/2"),
        ("First/Grip tries at most 1", "0 1R 8S 12S 12S 10 1S", "satisfied 0/1"),
        ("Grip tries at most 1 per Put", "0 1R 9R 8S 12S 10 9S 1S", "satisfied 0/1"),
    ],
)
def test_tries(demand: str, runs: str, expected: str, verify: Verify) -> None:
    assert come_to(verify, demand, runs) == expected


@pytest.mark.parametrize(
    ("demand", "runs", "expected"),
    [
        ("Move runs every 20 ms", TWICE, "violated 1/2"),  # 30 ms from the last start to the end of the run
        ("Move runs every 30 ms", TWICE, "satisfied 0/2"),
        ("Move runs every 19 ms", TWICE, "violated 2/2"),
        ("Move runs every 30 ms", CUT, "satisfied 0/1 |1"),
        ("Move runs every 29 ms", CUT, "violated 1/2"),
        ("Move runs every 10 ms", STOPPED, "violated 1/2"),
        ("Move runs every 10 ms", IDLE_RUN, "never exercised 0/0"),
        ("Move runs every 90 ms", BACK, "unknown 0/0 ?1"),
        ("Move runs every 30 ms\nwhile node Pick", TWICE, "never exercised 0/0"),
        ("Move runs every 15 ms\nwhile node Alarm", "0 1R 5R 3S 10 3I 3S 20 3I 3S 30 5S 40 1S", "satisfied 0/3"),
        ("Move runs every 15 ms\nwhile node Alarm", "0 1R 3S 5R 10 3I 3S 30 5S 40 3I 3S 1S", "violated 1/1"),
        ("Move runs every 15 ms\nwhile low", "0 1R 3S 10 3I 3S 30 3I 3S 50 1S", "violated 1/2"),  # low from 5 to 45
        ("Move runs every 20 ms\nwhile low", "0 1R 3S 10 3I 3S 30 3I 3S 50 1S", "satisfied 0/2"),
        ("Grip runs every 10 ms", "0 1R 8S 12S 10 8I 8S 20 1S", "violated 1/3"),
    ],
)
def test_runs_every(demand: str, runs: str, expected: str, verify: Verify) -> None:
    assert come_to(verify, demand, runs, samples("battery", {-1: 50, 5: 10, 45: 50})) == expected


@pytest.mark.parametrize(
    ("demand", "runs", "expected"),
    [
        # Starts at 0 and 20, the run ends at 50: the window after the last start has none.
        ("Move runs at least 1 per 20 ms", TWICE, "violated 1/1"),
        ("Move runs at least 1 per 30 ms", TWICE, "satisfied 0/1"),
        ("Move runs at least 2 per 30 ms", TWICE, "violated 1/1"),
        ("Move runs at least 1 per 51 ms", TWICE, "never exercised 0/0"),
        ("Move runs at most 1 per 20 ms", TWICE, "satisfied 0/1"),
        ("Move runs at most 1 per 21 ms", TWICE, "violated 1/1"),
        ("Move runs less than 2 per 21 ms", TWICE, "violated 1/1"),
        ("Move runs between 1 and 2 per 30 ms", TWICE, "satisfied 0/1"),
        ("Move runs at least 1 per 20 ms", CUT, "violated 1/1"),
        ("Move runs at least 1 per 30 ms", CUT, "never exercised 0/0 |1"),
        ("Move runs at least 1 per 20 ms", IDLE_RUN, "violated 1/1"),
        ("Move runs at most 1 per 20 ms", IDLE_RUN, "never exercised 0/1"),
        ("Move runs at least 1 per 10 ms", "0 1R 3S 10 3I 3S 20 3I 3S 30 1S", "satisfied 0/1"),
        ("Move runs at least 1 per 10 ms", "0 1R 3S 10 3S 20 3S 31 1S", "violated 1/1"),
        (
            "Move runs at least 1 per 10 ms\nwhile node Alarm",
            "0 1R 11R 20 5I 5R 3S 30 3I 3S 39 5S 90 1S",
            "satisfied 0/1",
        ),
        ("Move runs at least 1 per 10 ms\nwhile node Alarm", "0 1R 5R 11 3S 20 5S 90 1S", "violated 1/1"),
        (
            "Move runs at least 1 per 10 ms\nwhile node Alarm",
            "0 1R 5R 3S 10 5S 50 5I 5R 3S 60 5S 90 1S",
            "satisfied 0/2",
        ),
    ],
)
def test_runs_per(demand: str, runs: str, expected: str, verify: Verify) -> None:
    assert come_to(verify, demand, runs) == expected


@pytest.mark.parametrize(
    ("demand", "runs", "expected"),
    [
        ("Pick starts within 0 ms after Move succeeds", TWICE, "satisfied 0/1"),
        ("Pick starts within 20 ms after Move finishes", TWICE, "satisfied 0/2"),
        ("Pick starts within 19 ms after Move fails", TWICE, "violated 1/1"),
        ("Move starts within 5 ms after mission starts", TWICE, "satisfied 0/1"),
        ("Alarm starts within 50 ms after Move fails", TWICE, "violated 1/1"),  # the run ends after 40 ms
        ("Alarm starts within 40 ms after Move fails", TWICE, "violated 1/1"),
        ("Alarm starts within 39 ms after Move fails", TWICE, "violated 1/1"),
        ("Alarm starts within 40 ms after Move fails", CUT, "never exercised 0/0 |1"),
        ("Alarm starts within 39 ms after Move fails", CUT, "violated 1/1"),
        ("Alarm starts within 39 ms after Move halts", TWICE, "never exercised 0/0"),
        ("Alarm starts within 39 ms after Move succeeds", BACK, "unknown 0/0 ?1"),
        ("Put starts within 5 ms after Grip succeeds", "0 1R 8S 12S 5 13I 13S 10 9I 9S 20 1S", "violated 1/2"),
        ("Put starts within 9 ms after Pick succeeds", "0 1R 4S 5 13I 13S 10 9I 9S 20 1S", "violated 1/2"),
        ("Pick starts within 20 ms after Move halts", "0 1R 2R 3R 50 2F 1F", "unknown 0/0 ?1"),
        # The battery is low from 5 to 25, and from 40.
        ("Pick starts within 25 ms after when low", TWICE, "violated 1/2"),
        ("Pick starts within 24 ms after when low", TWICE, "violated 2/2"),
        ("Alarm starts within 9 ms after when low", "0 1R 11R 10 5I 5S 42 5I 5S 50 1S", "satisfied 0/2"),
        ("Pick starts within 5 ms after when node Pick", TWICE, "satisfied 0/1"),
        ("Pick starts within 20 ms after Move fails or Move succeeds", TWICE, "satisfied 0/2"),
        ("Pick starts within 20 ms after Move succeeds or Move finishes", TWICE, "satisfied 0/2"),  # not three
        ("Pick starts within 19 ms after Alarm starts or Move fails or when low", TWICE, "violated 3/3"),
        ("Pick ends within 20 ms after Move succeeds", TWICE, "never exercised 0/0"),  # it did not run then
        ("Pick ends within 20 ms after Pick starts", TWICE, "satisfied 0/1"),
        ("Pick ends within 19 ms after Pick starts", TWICE, "violated 1/1"),
        ("Pick ends within 10 ms after when low", TWICE, "satisfied 0/1"),
        ("Pick ends within 9 ms after when low", TWICE, "violated 1/1"),
        ("Pick ends within 9 ms after when low", CUT, "violated 1/1"),
        ("Pick ends within 10 ms after when low", CUT, "never exercised 0/0 |1"),
        ("Move ends within 10 ms after Move starts", STOPPED, "satisfied 0/2"),
        ("Move ends within 10 ms after Move starts", UNWRITTEN, "unknown 0/1 ?1"),
        ("Move ends within 30 ms after Move starts", UNWRITTEN, "satisfied 0/2"),
        ("Task ends within 20 ms after Move succeeds", TWICE, "satisfied 0/1"),
    ],
)
def test_starts_and_ends(demand: str, runs: str, expected: str, verify: Verify) -> None:
    assert come_to(verify, demand, runs, samples("battery", {-1: 50, 5: 10, 25: 50, 40: 10})) == expected


@pytest.mark.parametrize(
    ("demand", "runs", "expected"),
    [
        ("Pick follows Move succeeds", TWICE, "satisfied 0/1"),
        ("Pick follows Alarm succeeds", TWICE, "violated 1/1"),
        ("Move follows Move fails", TWICE, "violated 1/2"),
        ("Move follows mission starts", TWICE, "violated 1/2"),
        ("Move follows Task starts", "0 1R 3R 2R 10 3F 2F 20 2R 3R 30 3S 2S 1S", "satisfied 0/2"),
        # One event is enough for one start.
        ("Pick follows Move succeeds", "0 1R 2R 3S 4S 10 4S 2S 1S", "violated 1/2"),
        ("Pick follows Move succeeds", "0 1R 2R 4R 3S 10 4S 4S 2S 1S", "violated 1/2"),
        ("Pick follows Move succeeds", "0 1R 2R 3S 4S 10 3S 4S 2S 1S", "satisfied 0/2"),
        # It has to be in the same run.
        ("Pick follows Move succeeds", "0 1R 3S 10 1S 20 1R 4S 30 1S", "violated 1/1"),
        ("Put follows Grip succeeds", "0 1R 8S 9S 12S 13S 10 1S", "satisfied 0/2"),
        ("Put follows Grip succeeds", "0 1R 8S 9S 13S 10 1S", "violated 1/2"),
        ("Pick follows when low", TWICE, "satisfied 0/1"),
        ("Move follows when low", TWICE, "violated 1/2"),
        ("Pick follows Move succeeds", BACK, "unknown 0/0 ?1"),
        ("Pick follows Move halts", "0 1R 2R 3R 20 2F 2R 4S 50 2F 1F", "satisfied 0/1"),
        ("Pick follows Move halts", "0 1R 2R 3R 10 4I 4S 20 2F 1F", "unknown 0/0 ?1"),
        ("Pick follows Move succeeds\nwhen low", TWICE, "never exercised 0/0"),
        ("Pick follows Move halts\nwhen not low", "0 1R 2R 3R 10 4I 4S 20 2F 1F", "never exercised 0/0"),
        ("Pick follows Move succeeds", CUT, "never exercised 0/0 |1"),
        ("Pick follows Alarm succeeds", CUT, "violated 1/1"),
        ("Pick follows Alarm succeeds\nwhen not low", TWICE, "violated 1/1"),
        # Any of several events is enough.
        ("Pick follows Alarm succeeds or Move succeeds", TWICE, "satisfied 0/1"),
        ("Pick follows Alarm succeeds or Move halts", TWICE, "violated 1/1"),
        ("Move follows mission starts or Move fails", TWICE, "satisfied 0/2"),
        ("Move follows Alarm starts or when low", TWICE, "violated 1/2"),
        ("Put follows Alarm succeeds or Grip succeeds", "0 1R 8S 9S 13S 10 1S", "violated 1/2"),
    ],
)
def test_follows(demand: str, runs: str, expected: str, verify: Verify) -> None:
    assert come_to(verify, demand, runs, samples("battery", {-1: 50, 5: 10, 25: 50})) == expected


@pytest.mark.parametrize(
    ("demand", "runs", "expected"),
    [
        ("each Move fails is followed by Pick starts within 20 ms", TWICE, "satisfied 0/1"),
        ("each Move fails is followed by Pick starts within 19 ms", TWICE, "violated 1/1"),
        ("each Move finishes is followed by Pick starts within 0 ms if low else 20 ms", TWICE, "violated 1/2"),
        ("each Move halts is followed by Pick starts", TWICE, "never exercised 0/0"),
        # One answer is enough for all events before it, in the order of the rows.
        ("each Move starts is followed by Pick starts", TWICE, "satisfied 0/2"),
        ("each Move succeeds is followed by Pick starts within 0 ms", TWICE, "satisfied 0/1"),
        ("each Pick starts is followed by Move succeeds within 1 s", TWICE, "violated 1/1"),
        ("each Move finishes is followed by Move succeeds", TWICE, "violated 1/2"),
        ("each Move fails is followed by Move finishes within 20 ms", TWICE, "satisfied 0/1"),
        ("each Move starts is followed by Move starts", TWICE, "violated 1/2"),
        (
            "each Move fails or Pick starts is followed by Pick succeeds or Move starts within 20 ms",
            TWICE,
            "satisfied 0/2",
        ),
        # Without an answer the run's end breaks it, and the log's end leaves it out.
        ("each Move fails is followed by Alarm starts", TWICE, "violated 1/1"),
        ("each Move fails is followed by Alarm starts within 1 min", TWICE, "violated 1/1"),
        ("each Move fails is followed by Alarm starts within 40 ms", CUT, "never exercised 0/0 |1"),
        ("each Move fails is followed by Alarm starts within 39 ms", CUT, "violated 1/1"),
        ("each Move fails is followed by Alarm starts", CUT, "never exercised 0/0 |1"),
        ("each Move starts is followed by Pick halts", UNWRITTEN, "violated 2/2"),
        ("each Move starts is followed by Move halts within 29 ms", UNWRITTEN, "unknown 0/0 ?2"),
        ("each Move starts is followed by Move halts within 50 ms", UNWRITTEN, "satisfied 0/2"),
        ("each Move fails is followed by Pick starts within 20 ms", BACK, "never exercised 0/0"),
        ("each Move starts is followed by Pick starts within 20 ms", BACK, "unknown 0/0 ?1"),
        # Nodes of two uses of a subtree.
        ("each Grip succeeds is followed by Put succeeds", "0 1R 8S 12S 10 9S 20 1S", "violated 1/2"),
        ("each Grip succeeds is followed by Pick succeeds", "0 1R 8S 12S 10 4S 20 1S", "satisfied 0/2"),
        # A condition: low from 5 to 25.
        ("each Move starts is followed by low within 5 ms", TWICE, "satisfied 0/2"),
        ("each Move starts is followed by low within 4 ms", TWICE, "violated 1/2"),
        ("each Move starts is followed by when low within 5 ms", TWICE, "violated 1/2"),  # it is low already at 20
        ("each Move finishes is followed by not low within 0 ms", TWICE, "violated 1/2"),
        ("each Pick starts is followed by low within 20 ms", TWICE, "violated 1/1"),
        ("each Pick starts is followed by low within 21 ms", TWICE, "never exercised 0/0"),  # the run ends before
        ("each Pick starts is followed by low", TWICE, "violated 1/1"),
        ("each Pick starts is followed by low", CUT, "never exercised 0/0 |1"),
        ("each mission finishes is followed by not low", TWICE, "satisfied 0/1"),
        ("each when low is followed by node Pick within 25 ms", TWICE, "satisfied 0/1"),
        ("each when low is followed by Pick starts within 24 ms", TWICE, "violated 1/1"),
        ("each Move starts is followed by Pick starts within 15 ms\nwhen low", TWICE, "satisfied 0/1"),
        ("each Move starts is followed by Pick starts\nwhile low", TWICE, "never exercised 0/0"),
        ("each Move fails is followed by Pick starts\nin at least 50 % of runs", TWICE, "satisfied 0/1"),
        (
            "each Move starts is followed by Pick starts within 20 ms\nin at least 50 % of occurrences",
            TWICE,
            "satisfied 1/2",
        ),
        (
            "each Move starts is followed by Pick starts within 20 ms\nin at least 51 % of occurrences",
            TWICE,
            "violated 1/2",
        ),
    ],
)
def test_followed(demand: str, runs: str, expected: str, verify: Verify) -> None:
    assert come_to(verify, demand, runs, samples("battery", {-1: 50, 5: 10, 25: 50})) == expected


def test_what_is_counted_are_occurrences(verify: Verify) -> None:
    found = clause(verify, "each Move starts is followed by Pick starts within 20 ms", TWICE)
    assert (found["unit"], found["path"], found["counted"]) == ("occurrences", "Move::3, Pick::4", 2)
    printed = verify.text("run.btlog", "--mission", "main.btq")
    assert "1 of 2 occurrences" in printed


@pytest.mark.parametrize(
    ("csv", "expected", "why"),
    [
        ({}, "unknown 0/0 ?2", "no samples of `battery`"),
        ({15: 50}, "violated 1/1 ?1", ""),  # unknown from 0 to 9
        ({-1: 10, 15: 50}, "violated 1/2", ""),
        ({-1: 10}, "satisfied 0/2", ""),
        ({-1: 50}, "violated 2/2", ""),
    ],
)
def test_a_condition_that_follows_is_measured(csv: dict[float, float], expected: str, why: str, verify: Verify) -> None:
    level = f"{LEVEL} initially 10 %\ncontext low : battery < 20 %"
    demand = "each Move starts is followed by battery < 20 % within 9 ms"
    found = clause(verify, demand, TWICE, samples("battery", csv) if csv else None, level)
    assert (count(found), found["why"]) == (expected, why)


@pytest.mark.parametrize(
    ("demand", "runs", "expected"),
    [
        ("from Move starts to Pick succeeds takes at most 50 ms", TWICE, "satisfied 0/2"),
        ("from Move starts to Pick succeeds takes at most 49 ms", TWICE, "violated 1/2"),
        ("from Move starts to Pick succeeds takes at most 29 ms", TWICE, "violated 2/2"),
        ("from Move starts to Pick succeeds takes at least 40 ms", TWICE, "violated 1/2"),
        ("from Move starts to Pick succeeds takes between 30 ms and 50 ms", TWICE, "satisfied 0/2"),
        ("from Move starts to Move starts takes at most 20 ms", TWICE, "violated 1/2"),  # and to none
        ("from Move fails to Move succeeds takes at most 20 ms", TWICE, "satisfied 0/1"),
        ("from mission starts to mission finishes takes at most 50 ms", TWICE, "satisfied 0/1"),
        ("from Alarm starts to Pick succeeds takes at most 50 ms", TWICE, "never exercised 0/0"),
        ("from Move starts to Alarm starts takes at most 1 min", TWICE, "violated 2/2"),  # the run ended without it
        ("from Move starts to Alarm starts takes at least 1 ms", TWICE, "never exercised 0/0"),
        ("from Move starts to Pick succeeds takes at most 50 ms", CUT, "never exercised 0/0 |2"),
        ("from Move starts to Pick succeeds takes at most 49 ms", CUT, "violated 1/1 |1"),
        ("from Move starts to Pick succeeds takes at most 50 ms", BACK, "unknown 0/0 ?1"),
        ("from Move starts to Move halts takes at most 50 ms", UNWRITTEN, "satisfied 0/2"),
        # That had happened by 50, but perhaps before Pick started, and not again.
        ("from Pick starts to Move halts takes at most 1 s", "0 1R 2R 3R 10 4R 20 4S 50 2F 1F", "unknown 0/0 ?1"),
        ("from Move starts to Move halts takes at most 29 ms", UNWRITTEN, "unknown 0/0 ?2"),
        ("from Pick succeeds to Move halts takes at most 99 ms", "0 1R 2R 3R 10 4S 50 2F 1F", "unknown 0/0 ?1"),
        # Each use of a subtree by itself; the nodes of two uses together with one outside.
        ("from Grip starts to Put succeeds takes at most 10 ms", "0 1R 8S 12S 10 9S 20 13S 1S", "violated 1/2"),
        ("from Grip starts to Put succeeds takes at most 20 ms", "0 1R 8S 12S 10 9S 20 13S 1S", "satisfied 0/2"),
        ("from Grip starts to Pick succeeds takes at most 9 ms", "0 1R 8S 5 12I 12S 10 4I 4S 20 1S", "violated 1/2"),
        ("from Alarm starts to Grip succeeds takes at most 5 ms", "0 1R 5S 5 12S 10 8S 20 1S", "satisfied 0/1"),
        ("from Move starts or Pick starts to Move fails or Pick succeeds takes at most 30 ms", TWICE, "satisfied 0/3"),
        ("from Move starts or Pick starts to Move fails or Pick succeeds takes at most 29 ms", TWICE, "violated 1/3"),
        ("from Pick starts or when low to Pick succeeds takes at most 20 ms", TWICE, "violated 1/2"),
        (
            "from Grip starts to Alarm starts or Put succeeds takes at most 10 ms",
            "0 1R 8S 12S 10 9S 20 13S 1S",
            "violated 1/2",
        ),
        (
            "from Pick starts or Grip starts to Put succeeds takes at most 9 ms",
            "0 1R 4R 8S 10 9S 20 13S 4S 1S",
            "violated 2/2",
        ),
        ("from when low to Pick succeeds takes at most 45 ms", TWICE, "satisfied 0/1"),
        ("from when low to when not low takes at most 19 ms", TWICE, "violated 1/1"),
        ("from Move starts to Pick succeeds takes at most 29 ms\nwhen low", TWICE, "violated 1/1"),
        ("from Move starts to Pick succeeds takes at most 29 ms\nwhile low", TWICE, "never exercised 0/0"),
        ("from Move starts to Pick succeeds takes at most 29 ms if low else 50 ms", TWICE, "violated 1/2"),
    ],
)
def test_spans(demand: str, runs: str, expected: str, verify: Verify) -> None:
    assert come_to(verify, demand, runs, samples("battery", {-1: 50, 5: 10, 25: 50})) == expected


@pytest.mark.parametrize(
    ("demand", "runs", "expected"),
    [
        ("sum of Move, Pick takes at most 40 ms", TWICE, "satisfied 0/1"),
        ("sum of Move, Pick takes at most 39 ms", TWICE, "violated 1/1"),
        ("sum of Move, Pick takes at least 41 ms", TWICE, "violated 1/1"),
        ("sum of Move, Pick takes at most 40 ms", CUT, "never exercised 0/0 |1"),
        ("sum of Move, Pick takes at most 39 ms", CUT, "violated 1/1"),
        ("sum of Move, Pick takes at least 40 ms", CUT, "never exercised 0/0 |1"),
        ("sum of Move, Pick takes at most 20 ms", STOPPED, "satisfied 0/1"),
        ("sum of Move, Pick takes at most 40 ms", UNWRITTEN, "satisfied 0/1"),
        ("sum of Move, Pick takes at most 10 ms", UNWRITTEN, "unknown 0/0 ?1"),
        ("sum of Move, Pick takes at most 9 ms", UNWRITTEN, "violated 1/1"),
        ("sum of Move, Pick takes at most 9 ms", IDLE_RUN, "never exercised 0/0"),
        ("sum of Move, Pick takes at most 90 ms", BACK, "unknown 0/0 ?1"),
        ("sum of Grip, Pick takes at most 20 ms", "0 1R 8R 12R 10 8S 12S 20 1S", "satisfied 0/1"),
        ("sum of Grip, Pick takes at most 19 ms", "0 1R 8R 12R 10 8S 12S 20 1S", "violated 1/1"),
        ("sum of Second/Grip, Pick takes at most 19 ms", "0 1R 8R 12R 10 8S 12S 20 1S", "satisfied 0/1"),
        ("sum of Move, Pick takes at most 10 ms\nwhen low", TWICE, "satisfied 0/1"),
        ("sum of Move, Pick takes at most 9 ms\nwhen low", TWICE, "violated 1/1"),
    ],
)
def test_sums(demand: str, runs: str, expected: str, verify: Verify) -> None:
    assert come_to(verify, demand, runs, samples("battery", {-1: 50, 5: 10, 25: 50})) == expected


# ---- contexts, and nodes that run ----


@pytest.mark.parametrize(
    ("demand", "runs", "expected"),
    [
        ("Move takes at most 5 ms\nwhile node Task", TWICE, "violated 2/2"),
        ("Move takes at most 5 ms\nwhile node Pick", TWICE, "never exercised 0/0"),
        ("Move takes at most 5 ms\nwhen node Alarm", "0 1R 3R 10 5R 3S 20 3R 5S 30 3S 1S", "violated 1/1"),
        ("Move takes at most 5 ms\nwhile node Alarm", "0 1R 5R 3R 10 3S 20 3R 25 5S 30 3S 1S", "violated 1/1"),
        (
            "Move takes at most 5 ms\nwhile not node Alarm",
            "0 1R 5R 3R 10 3S 20 3R 25 5S 30 3S 1S",
            "never exercised 0/0",
        ),
        ("Move never node Alarm", "0 1R 5R 10 5S 11 3I 3R 20 3S 1S", "satisfied 0/1"),
        ("Move never node Alarm", "0 1R 5R 10 3R 5S 20 3S 1S", "violated 1/1"),
        ("Move never node Alarm", "0 1R 3R 10 5S 20 3S 1S", "violated 1/1"),
        ("Move keeps node Alarm", "0 1R 5R 3R 20 3S 5S 1S", "satisfied 0/1"),
        ("Move keeps node Alarm", "0 1R 5R 3R 19 5S 20 3S 1S", "violated 1/1"),
        ("Move needs node Alarm", "0 1R 3R 5R 20 3S 5S 1S", "violated 1/1"),
        ("Move leaves node Alarm or battery > 90 %", "0 1R 3R 5R 20 3S 5S 1S", "satisfied 0/1"),
        ("Move needs not node Alarm", BACK, "unknown 0/0 ?1"),
        # Move had ended by 50, and may have before Alarm started.
        ("Alarm never node Move", "0 1R 2R 3R 10 5R 20 5S 50 2F 1F", "unknown 0/0 ?1"),
        ("Alarm takes at most 5 ms\nwhile node Move", "0 1R 2R 3R 10 5R 20 5S 50 2F 1F", "unknown 0/0 ?1"),
        ("Alarm keeps node Move", "0 1R 2R 5R 3R 20 2F 30 5S 1S", "violated 1/1"),
        ("Task keeps node Move", "0 1R 3R 2R 20 2F 30 1S", "unknown 0/0 ?1"),
        ("Grip never node Put", "0 1R 8R 13R 5 8S 10 13S 1S", "satisfied 0/1"),
        ("Grip never node Put", "0 1R 12R 13R 5 12S 10 13S 1S", "violated 1/1"),
        ("Grip never node First/Put", "0 1R 12R 9R 5 12S 10 9S 1S", "violated 1/1"),
        ("Move takes at most 5 ms if node Alarm else 10 ms", "0 1R 5R 3R 10 3S 5S 20 3I 3R 30 3S 1S", "violated 1/2"),
    ],
)
def test_nodes_that_run(demand: str, runs: str, expected: str, verify: Verify) -> None:
    assert come_to(verify, demand, runs, samples("battery", {-1: 50})) == expected


FRESH = f"{LEVEL} fresh within 10 ms\ncontext low : battery < 20 %"


@pytest.mark.parametrize(
    ("demand", "given", "expected", "why"),
    [
        ("Move tries at most 2\nwhen low", {-1: 10, 9: 10, 19: 10}, "satisfied 0/1", ""),
        ("Move tries at most 1\nwhen low", {-1: 10, 15: 10}, "violated 1/1", ""),
        ("Move tries at most 1\nwhen low", {-1: 10}, "unknown 0/0 ?1", "the last sample of `battery` is too old"),
        ("Move tries at most 2\nwhen low", {-1: 10}, "satisfied 0/1", ""),  # whether the second one counts or not
        ("Move runs every 1 s\nwhile low", {}, "unknown 0/0 ?1", "no samples of `battery`"),
        ("Move runs every 1 s\nwhile low", {-1: 10}, "unknown 0/1 ?1", "the last sample of `battery` is too old"),
        ("Move runs every 1 s\nwhen low", {-1: 10}, "unknown 0/0 ?1", "the last sample of `battery` is too old"),
        ("Pick starts within 9 ms after when low", {}, "unknown 0/0 ?1", "no samples of `battery`"),
        ("Pick follows when low", {}, "unknown 0/0 ?1", "no samples of `battery`"),
        ("Pick follows when low", {15: 10}, "unknown 0/0 ?1", "no sample of `battery` before that time"),
        ("Pick follows when low", {-1: 50, 5: 10}, "satisfied 0/1", ""),
        (
            "sum of Move, Pick takes at most 30 ms\nwhen low",
            {-1: 10},
            "unknown 0/0 ?1",
            "the last sample of `battery` is too old",
        ),
        ("sum of Move, Pick takes at most 40 ms\nwhen low", {-1: 10}, "satisfied 0/1", ""),
        ("sum of Move, Pick takes at most 9 ms\nwhen low", {-1: 10}, "violated 1/1", ""),
        (
            "from Pick starts to Pick succeeds takes at most 1 s\nwhen low",
            {},
            "unknown 0/0 ?1",
            "no samples of `battery`",
        ),
        ("from when low to Pick starts takes at most 1 s", {}, "unknown 0/0 ?1", "no samples of `battery`"),
        ("Move tries at most 1 if low else 3", {}, "unknown 0/0 ?1", "no samples of `battery`"),
        ("Move runs every 1 ms if low else 1 s", {}, "unknown 0/0 ?2", "no samples of `battery`"),
        ("Move runs at least 1 if low else 0 per 9 ms", {}, "unknown 0/0 ?1", "no samples of `battery`"),
    ],
)
def test_what_is_not_known_over_a_run(
    demand: str, given: dict[float, object], expected: str, why: str, verify: Verify
) -> None:
    found = clause(verify, demand, TWICE, samples("battery", given), FRESH)
    assert (count(found), found["why"]) == (expected, why)


@pytest.mark.parametrize(
    "demand",
    [
        "Alarm starts within 40 ms after Move fails\nwhen low",
        "Task ends within 50 ms after Task starts\nwhen low",
        "from Move fails to Pick succeeds takes at most 40 ms\nwhen low",
        "Pick follows Move succeeds\nwhen low",
    ],
)
def test_what_the_end_of_the_log_cuts_off_is_left_out_whether_it_counts_or_not(demand: str, verify: Verify) -> None:
    assert come_to(verify, demand, CUT) == "never exercised 0/0 |1"


def test_what_the_end_of_the_log_cuts_off_may_have_broken_the_clause(verify: Verify) -> None:
    demand = "Move tries at most 1\nwhen low"
    found = clause(verify, demand, CUT, samples("battery", {-1: 10}), FRESH)
    assert (count(found), found["why"]) == ("unknown 0/0 ?1", "the last sample of `battery` is too old")


def test_a_span_from_a_node_that_is_not_in_the_tree(verify: Verify) -> None:
    mission = f"{MISSION}BehaviorTree Other\n    Action Spare\nAction Spare\n"
    demand = "from Spare finishes to Pick starts takes at most 1 ms"
    found = verify.clause(demand, TWICE, None, mission=mission, xml=XML, before=LOW)
    assert count(found) == "never exercised 0/0"


# ---- what is reported ----


@pytest.mark.parametrize(
    ("demand", "why", "measured", "bound", "at"),
    [
        ("Move tries at most 1", "started 2 times", "2", "1", 0.02),
        ("Move tries less than 2 per Task", "started 2 times", "2", "2", 0.02),
        ("Move tries at least 3", "started 2 times", "2", "3", 0.05),
        ("Pick tries at least 2 times", "started 1 time", "1", "2 times", 0.05),
        ("Move runs every 25 ms", "had not run again after 30 ms", "30 ms", "25 ms", 0.05),
        ("Pick runs at least 1 per 20 ms", "ran 0 times in 20 ms", "0", "1", 0.02),
        ("Move runs at most 1 per 21 ms", "ran 2 times in 21 ms", "2", "1", 0.021),
        ("Pick starts within 19 ms after Move fails", "started after 20 ms", "20 ms", "19 ms", 0.03),
        ("Alarm starts within 9 ms after Move fails", "had not started after 40 ms", "40 ms", "9 ms", 0.019),
        ("Pick ends within 19 ms after Pick starts", "ended after 20 ms", "20 ms", "19 ms", 0.05),
        ("Pick ends within 5 ms after Pick starts", "ended after 20 ms", "20 ms", "5 ms", 0.05),
        ("Pick follows Alarm succeeds", "`Alarm succeeds` did not happen before it in the run", None, None, 0.03),
        ("from Move starts to Pick succeeds takes at most 49 ms", "took 50 ms", "50 ms", "49 ms", 0.05),
        (
            "from Pick starts to Alarm starts takes at most 9 ms",
            "had not come to an end after 20 ms",
            "20 ms",
            "9 ms",
            0.05,
        ),
        (
            "from Pick starts to Alarm starts takes at most 1 s",
            "its last event did not happen before the run ended",
            None,
            None,
            0.05,
        ),
        ("sum of Move, Pick takes at most 0.039 s", "took 40 ms together", "40 ms", "0.039 s", 0.05),
    ],
)
def test_what_happened_in_words(
    demand: str, why: str, measured: str | None, bound: str | None, at: float, verify: Verify
) -> None:
    (found,) = clause(verify, demand, TWICE)["violations"]
    assert (found["why"], found["measured"], found["bound"], found["at"]) == (why, measured, bound, at)


def test_a_rate_is_exceeded_by_the_start_that_is_one_too_many(verify: Verify) -> None:
    """In the first window that has it, which ends 1 µs after it."""
    runs = "0 1R 2R 3R 5 3F 20 3R 25 3F 30 3R 40 3S 2S 50 1S"
    (found,) = clause(verify, "Move runs at most 1 per 15 ms", runs)["violations"]
    assert found["at"] == 0.030001


def test_a_start_that_lacks_the_event_since_the_last_one(verify: Verify) -> None:
    (found,) = clause(verify, "Move follows mission starts", TWICE)["violations"]
    assert (found["why"], found["at"]) == ("`mission starts` did not happen since its last start", 0.02)


def test_the_goal_and_the_window_are_shown_with_the_clause(verify: Verify) -> None:
    demand = "Move takes at most 30 ms\nin at least 90 % of runs\nover last 5 runs\ngoal 10 ms"
    found = clause(verify, demand, TWICE)
    assert found["text"] == "Move takes at most 30 ms in at least 90 % of runs over last 5 runs goal 10 ms"
    assert found["verdict"] == "satisfied"


@pytest.mark.parametrize(
    ("demand", "runs", "remarked"),
    [
        # Move succeeds, fails and succeeds again and is never reset: it may have succeeded twice.
        ("Move tries at most 9", "0 1R 5R 3S 10 3F 20 3S 30 5S 5I 1S", True),
        ("Move runs every 1 s", "0 1R 5R 3S 10 3F 20 3S 30 5S 5I 1S", True),
        ("Move takes at most 1 s", "0 1R 5R 3S 10 3F 20 3S 30 5S 5I 1S", False),
        ("Pick tries at most 9", "0 1R 5R 3S 4S 10 3F 20 3S 30 5S 5I 1S", True),  # below the same parent
        ("Alarm tries at most 9", "0 1R 5R 3S 10 3F 20 3S 30 5S 5I 1S", False),  # it takes a while, so it has rows
        ("Move tries at most 9", "0 1R 5R 3S 3I 10 3F 3I 20 3S 30 5S 5I 1S", False),
        ("Move tries at most 9", "0 1R 5R 3S 10 3F 20 3S 30 5S 1S", False),  # whatever was reset has no row
    ],
)
def test_starts_without_a_row_are_remarked(demand: str, runs: str, remarked: bool, verify: Verify) -> None:
    path = clause(verify, demand, runs)["path"]
    (source,) = verify.json("run.btlog", "--mission", "main.btq")["sources"]
    expected = [f"{path} is not reset between its starts, so rq may count too few of them"]
    assert source["remarks"] == (expected if remarked else [])


# ---- windows ----


def several(*runs: str) -> str:
    """Runs that begin every 10 ms, each with activations of Move, by their results."""
    found: list[str] = []
    for run, results in enumerate(runs):
        found.append(f"{10 * run} 1R")
        for number, result in enumerate(results):
            begin = 10 * run + 3 * number
            found.append(f"{begin} 3R {begin + 1} 3{result}")
        found.append(f"{10 * run + 9} 1S")
    return " ".join(found)


@pytest.mark.parametrize(
    ("demand", "runs", "expected"),
    [
        ("over last 2 activations", ["F", "S", "S"], "satisfied 0/2"),
        ("over last 3 activations", ["F", "S", "S"], "violated 1/3"),
        ("over last 2 activations", ["FSS"], "satisfied 0/2"),
        ("over last 3 activations", ["SFS", "SF"], "violated 1/3"),
        ("over last 2 runs", ["F", "SS", "SS"], "satisfied 0/4"),
        ("over last 2 runs", ["S", "FS", "", "S"], "violated 1/3"),  # of the runs in which it was judged
        ("in at least 90 % of runs\nover last 2 runs", ["F", "SS", "SS"], "satisfied 0/2"),
        ("in at least 90 % of runs\nover last 3 activations", ["F", "SS", "SS"], "satisfied 0/2"),
        ("in at least 50 % of activations\nover last 2 runs", ["FFF", "SF", "S"], "satisfied 1/3"),
        ("over last 20 ms", ["F", "S", "S", "S"], "satisfied 0/2"),  # the last run ends at 39
        ("over last 28 ms", ["S", "F", "S", "S"], "violated 1/3"),
        ("over last 1 h", ["F", "S", "S", "S"], "violated 1/4"),
    ],
)
def test_windows(demand: str, runs: list[str], expected: str, verify: Verify) -> None:
    assert come_to(verify, f"Move succeeds\n{demand}", several(*runs)) == expected


@pytest.mark.parametrize(
    ("window", "expected"),
    [
        ("over last 10 ms", "violated 1/1"),  # both runs end in it
        ("over last 9 ms", "never exercised 0/0"),
    ],
)
def test_what_ends_in_a_window_counts_whenever_it_was_broken(window: str, expected: str, verify: Verify) -> None:
    runs = "0 1R 3R 30 3S 1S 35 1R 40 1S"
    demand = f"Move keeps battery >= 20 %\n{window}"
    assert come_to(verify, demand, runs, samples("battery", {-1: 50, 5: 10, 8: 50})) == expected


@pytest.mark.parametrize(
    ("number", "expected"), [(1, "violated 1/1"), (2, "violated 1/2"), (3, "violated 1/3"), (4, "violated 1/3")]
)
def test_the_last_of_a_run_is_that_of_all_uses_of_a_subtree(number: int, expected: str, verify: Verify) -> None:
    """Though the second one's come later in the tree: Put of the first one is late at 80."""
    first, second = "60 8S 80 9I 9R 90 9S 7S", "10 12S 11 13R 15 13S 11S 20 11R 12R 30 12S 31 13R 35 13S 11S"
    demand = f"Put starts within 5 ms after Grip succeeds\nover last {number} activations"
    assert come_to(verify, demand, f"0 1R 7R 8R 11R 12R {second} {first} 100 1S") == expected


def test_what_is_last_is_told_by_its_time(verify: Verify) -> None:
    """And not by the order of the logs."""
    mission = f"QualityReq rq : safety\n    Move succeeds\n    over last 2 runs\n{MISSION}"
    (verify.folder / "main.btq").write_text(mission, encoding="utf-8")
    (verify.folder / "a.btlog").write_bytes(btlog(XML, rows(several("S", "S")), START + 1_000_000))
    (verify.folder / "b.btlog").write_bytes(btlog(XML, rows(several("F", "F", "F"))))
    (requirement,) = verify.json("a.btlog", "b.btlog", "--mission", "main.btq")["requirements"]
    assert count(requirement["clauses"][0]) == "satisfied 0/2"
    assert requirement["clauses"][0]["violations"] == []


@pytest.mark.parametrize(
    ("window", "runs", "more"),
    [
        ("over last 9 runs", 3, 2),  # 5 of 5 decide it
        ("over last 5 runs", 5, None),
        ("over last 4 runs", 3, None),  # 4 of 4 do not
    ],
)
def test_a_window_may_be_too_short_to_decide(window: str, runs: int, more: int | None, verify: Verify) -> None:
    found = clause(
        verify, f"Move succeeds\nin at least 50 % of runs\nconfidence 95 %\n{window}", several(*["S"] * runs)
    )
    assert (found["verdict"], found["more"]) == ("undecided" if runs < 5 else "satisfied", more)


def test_more_runs_replace_what_is_in_the_window(verify: Verify) -> None:
    demand = "Move succeeds\nin at least 50 % of runs\nconfidence 95 %\nover last 5 runs"
    found = clause(verify, demand, several("F", "S", "S", "S", "S"))
    assert (found["verdict"], found["counted"], found["more"]) == ("undecided", 5, 5)


def test_a_window_of_time_has_what_ended_in_it(verify: Verify) -> None:
    """However early the sample was that came closest to the bound."""
    demand = "Move keeps battery >= 5 %\nin at least 90 % of activations\nover last 25 ms"
    assert come_to(verify, demand, "0 1R 3R 30 3S 1S", samples("battery", {-1: 5, 2: 50})) == "satisfied 0/1"


@pytest.mark.parametrize(
    ("demand", "unit"),
    [
        ("Move tries at most 1", "runs"),
        ("Grip tries at most 1", "activations"),  # each use of the subtree by itself
        ("Move tries at most 1 per Task", "activations"),
        ("sum of Move takes at most 1 ms", "runs"),
        ("Move runs every 1 ms", "activations"),
    ],
)
def test_what_is_counted(demand: str, unit: str, verify: Verify) -> None:
    assert clause(verify, demand, TWICE)["unit"] == unit
