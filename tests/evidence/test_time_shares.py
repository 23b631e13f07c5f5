"""`keeps φ in at least p of time`: hand-made runs, and what they come to.  The mission is that of `test_run_verbs`."""

from __future__ import annotations

import pytest
from evidence_logs import Verify, samples
from test_run_verbs import BACK, CUT, FRESH, IDLE_RUN, STOPPED, TWICE, UNWRITTEN, clause, come_to

HALF = samples("battery", {-1: 50, 5: 10, 25: 50})  # low from 5 to 25: half of the time of Move
ENOUGH, HIGH = "Move keeps battery >= 20 %", "Move keeps battery >= 40 %"


@pytest.mark.parametrize(
    ("demand", "runs", "expected"),
    [
        (f"{ENOUGH}\nin at least 50 % of time", TWICE, "satisfied 0/1"),
        (f"{ENOUGH}\nin at least 50.1 % of time", TWICE, "violated 1/1"),
        (f"{ENOUGH}\nwith probability > 50 % of time", TWICE, "violated 1/1"),
        ("Move never low\nin at least 50 % of time", TWICE, "satisfied 0/1"),
        ("Move never low\nin at least 51 % of time", TWICE, "violated 1/1"),
        ("Move never battery > 40 %\nin at least 51 % of time", TWICE, "violated 1/1"),
        ("mission keeps battery >= 20 %\nin at least 60 % of time", TWICE, "satisfied 0/1"),
        (f"{ENOUGH}\nin at least 50 % of time", STOPPED, "satisfied 0/1"),
        (f"{ENOUGH}\nin at least 90 % of time", CUT, "never exercised 0/0 |1"),  # what comes may make up for it
        (f"{ENOUGH}\nin at least 90 % of time", IDLE_RUN, "never exercised 0/0"),
        (f"{ENOUGH}\nin at least 90 % of time", BACK, "unknown 0/0 ?1"),
        # Move runs from 0 to 10 and then at most from 20 to 50: of 10 to 40 ms, from 5 to 25 ms are good.
        (f"{ENOUGH}\nin at least 30 % of time", UNWRITTEN, "satisfied 0/1"),
        (f"{ENOUGH}\nin at least 40 % of time", UNWRITTEN, "unknown 0/0 ?1"),
        (f"{ENOUGH}\nin at least 90 % of time", UNWRITTEN, "violated 1/1"),
        # Of several runs each is one; `of runs` says how many may break it.
        (f"{ENOUGH}\nin at least 50 % of time", f"{TWICE} 60 1R 3R 70 3S 1S", "satisfied 0/2"),
        (f"{ENOUGH}\nin at least 60 % of time", f"{TWICE} 60 1R 3R 70 3S 1S", "violated 1/2"),
        (
            f"{ENOUGH}\nin at least 60 % of time\nin at least 50 % of runs",
            f"{TWICE} 60 1R 3R 70 3S 1S",
            "satisfied 1/2",
        ),
        # The uses of a subtree are judged by themselves.
        ("Grip keeps battery >= 20 %\nin at least 50 % of time", "0 1R 8R 10 8S 12R 20 12S 1S", "violated 1/2"),
        # Only time with C counts, and only what begins with C.
        (f"{HIGH}\nin at least 60 % of time\nwhile battery >= 20 %", TWICE, "satisfied 0/1"),
        (f"{HIGH}\nin at least 1 % of time\nwhile low", TWICE, "violated 1/1"),
        (f"{HIGH}\nin at least 50 % of time\nwhen low", TWICE, "satisfied 0/1"),  # from 20 to 30
        (f"{HIGH}\nin at least 51 % of time\nwhen low", TWICE, "violated 1/1"),
        (f"{HIGH}\nin at least 51 % of time\nwhile node Pick", TWICE, "never exercised 0/0"),
    ],
)
def test_a_share_of_the_time(demand: str, runs: str, expected: str, verify: Verify) -> None:
    assert come_to(verify, demand, runs, HALF) == expected


@pytest.mark.parametrize(
    ("share", "given", "expected", "why"),
    [
        # Known to be good from 0 to 9 and from 25 to 30, to be bad at no time: of 20 ms, 14 to 20 are good.
        (70, {-1: 50, 25: 50}, "satisfied 0/1", ""),
        (71, {-1: 50, 25: 50}, "unknown 0/0 ?1", "the last sample of `battery` is too old"),
        # Bad from 25 to 30: of 20 ms, 9 to 15 are good.
        (45, {-1: 50, 25: 10}, "satisfied 0/1", ""),
        (75, {-1: 50, 25: 10}, "unknown 0/0 ?1", "the last sample of `battery` is too old"),
        (76, {-1: 50, 25: 10}, "violated 1/1", ""),
        (1, {}, "unknown 0/0 ?1", "no samples of `battery`"),
    ],
)
def test_time_without_a_fresh_sample_counts_both_ways(
    share: int, given: dict[int, int], expected: str, why: str, verify: Verify
) -> None:
    csv = samples("battery", given) if given else None
    demand = f"{ENOUGH}\nin at least {share} % of time"
    found = clause(verify, demand, TWICE, csv, before=FRESH.replace("10 ms", "9.999 ms"))
    assert (f"{found['verdict']} {found['violated']}/{found['counted']}", found["why"]) == (
        expected.removesuffix(" ?1"),
        why,
    )


def test_a_begin_that_is_not_known_counts_both_ways(verify: Verify) -> None:
    """Pick lasts 50 to 90 ms of which 50 are good: from 56 % to all."""
    csv, runs = samples("battery", {-1: 10, 50: 50}), "0 1R 2R 3R 10 3S 50 4R 100 4S 2S 1S"
    assert come_to(verify, "Pick keeps battery >= 20 %\nin at least 55 % of time", runs, csv) == "satisfied 0/1"
    assert come_to(verify, "Pick keeps battery >= 20 %\nin at least 56 % of time", runs, csv) == "unknown 0/0 ?1"


def test_what_happened_in_words(verify: Verify) -> None:
    demand = "Move keeps battery >= 20 % in at least 90 % of time while not node Alarm goal 99 %"
    found = clause(verify, demand, TWICE, HALF)
    assert (found["text"], found["unit"]) == (demand, "runs")
    (violation,) = found["violations"]
    assert (violation["why"], violation["measured"], violation["bound"], violation["at"]) == (
        *("`battery >= 20 %` held in 50 % of the time", "50 %", "90 %", 0.05),
    )
    found = clause(verify, "Move never low in at least 90 % of time", TWICE, HALF)
    assert found["worst"] == {"si": 0.5, "text": "50 %", "run": 1}
    assert found["violations"][0]["why"] == "`low` did not hold in 50 % of the time"
