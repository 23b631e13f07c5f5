"""Each verb that is judged from logs: hand-made runs, and what they come to."""

from __future__ import annotations

import re
from collections import Counter
from typing import Any

import pytest
from evidence_logs import MAIN, START, Verify, samples

from btq_lang.catalog.verbs import VERBS
from btq_lang.checks import check
from btq_lang.evidence.signals import Signals
from btq_lang.parser import parse
from btq_lang.requirements.resolve import requirements
from btq_lang.syntax.tree import Claim
from btq_lang.syntax.tree import Requirement as RequirementItem
from btq_lang.workspace.workspace import Workspace

LEVEL = "signal battery : % from {battery_level} level"
FRESH = f"{LEVEL} fresh within 10 ms"
LONG = "0 1R 2R 30 2S 3S 1S"  # Move takes 30 ms
HALTED = "0 1R 2R 30 2I 1I"
FAILED = "0 1R 2R 30 2F 1F"
OPEN = "0 1R 2R 30 3I"
UNWRITTEN = "0 1R 2R 30 1F"  # Move was halted at some time before
BACK = "40 1R 2R 10 2S 1S"
BACK_HALTED = "40 1R 2R 10 2I 1I"


def count(clause: dict[str, Any]) -> str:
    """`violated 1/2`: its verdict, how many of how many, then unknown and cut off ones where there are any."""
    found = f"{clause['verdict']} {clause['violated']}/{clause['counted']}"
    found += f" ?{clause['unknown']}" if clause["unknown"] else ""
    return found + (f" |{clause['cut_off']}" if clause["cut_off"] else "")


@pytest.mark.parametrize(
    ("demand", "runs", "expected"),
    [
        ("Move takes at most 30 ms", LONG, "satisfied 0/1"),
        ("Move takes at most 29 ms", LONG, "violated 1/1"),
        ("Move takes less than 30 ms", LONG, "violated 1/1"),
        ("Move takes at most 30 ms", FAILED, "satisfied 0/1"),
        ("Move takes at most 30 ms", HALTED, "never exercised 0/0"),
        ("Move takes at most 29 ms", HALTED, "violated 1/1"),
        ("Move takes at most 30 ms", OPEN, "never exercised 0/0 |1"),
        ("Move takes at most 29 ms", OPEN, "violated 1/1"),
        ("Move takes at most 30 ms", UNWRITTEN, "never exercised 0/0"),
        ("Move takes at most 29 ms", UNWRITTEN, "unknown 0/0 ?1"),
        ("Move takes at most 99 ms", BACK, "unknown 0/0 ?1"),
        ("Move takes at least 30 ms", LONG, "satisfied 0/1"),
        ("Move takes more than 30 ms", LONG, "violated 1/1"),
        ("Move takes at least 31 ms", FAILED, "violated 1/1"),
        ("Move takes at least 31 ms", HALTED, "never exercised 0/0"),
        ("Move takes at least 30 ms", HALTED, "never exercised 0/0"),
        ("Move takes at least 30 ms", BACK_HALTED, "never exercised 0/0"),
        ("Move takes at least 30 ms", OPEN, "never exercised 0/0 |1"),
        ("Move takes between 10 ms and 30 ms", LONG, "satisfied 0/1"),
        ("Move takes between 10 ms and 20 ms", LONG, "violated 1/1"),
        ("Move takes between 40 ms and 50 ms", LONG, "violated 1/1"),
        ("Move takes between 29 ms and 90 ms", OPEN, "never exercised 0/0 |1"),
        ("Pick takes at most 1 ms", LONG, "satisfied 0/1"),
        ("Pick takes at most 1 ms", HALTED, "never exercised 0/0"),
        ("mission takes at most 20 ms", LONG, "violated 1/1"),
        ("Move takes at most 30 ms", f"{LONG} 50 1R 2R 90 2S 1S", "violated 1/2"),
    ],
)
def test_takes(demand: str, runs: str, expected: str, verify: Verify) -> None:
    assert count(verify.clause(demand, runs)) == expected


@pytest.mark.parametrize(
    ("demand", "runs", "expected"),
    [
        ("Move succeeds", LONG, "satisfied 0/1"),
        ("Move succeeds", FAILED, "violated 1/1"),
        ("Move succeeds", HALTED, "never exercised 0/0"),
        ("Move succeeds", OPEN, "never exercised 0/0 |1"),
        ("Move succeeds", BACK, "satisfied 0/1"),
        ("Move succeeds within 30 ms", LONG, "satisfied 0/1"),
        ("Move succeeds within 29 ms", LONG, "violated 1/1"),
        ("Move succeeds within 90 ms", FAILED, "violated 1/1"),
        ("Move succeeds within 29 ms", HALTED, "violated 1/1"),
        ("Move succeeds within 30 ms", HALTED, "never exercised 0/0"),
        ("Move succeeds within 29 ms", OPEN, "violated 1/1"),
        ("Move succeeds within 30 ms", OPEN, "never exercised 0/0 |1"),
        ("Move succeeds within 29 ms", UNWRITTEN, "unknown 0/0 ?1"),
        ("Move succeeds within 30 ms", UNWRITTEN, "never exercised 0/0"),
        ("mission succeeds", LONG, "satisfied 0/1"),
        ("mission succeeds", f"{LONG} 50 1R 2F 1F", "violated 1/2"),
    ],
)
def test_succeeds(demand: str, runs: str, expected: str, verify: Verify) -> None:
    assert count(verify.clause(demand, runs)) == expected


# The battery at the start of Move, meanwhile, at its end, and after it.
SAMPLES = {-5: 50, 10: 30, 20: 5, 25: 30, 31: 1}


@pytest.mark.parametrize(
    ("demand", "runs", "expected"),
    [
        ("Move needs battery >= 50 %", LONG, "satisfied 0/1"),
        ("Move needs battery > 50 %", LONG, "violated 1/1"),
        ("Move needs battery > 50 %", HALTED, "violated 1/1"),
        ("Move needs battery > 50 %", OPEN, "violated 1/1"),
        ("Move needs battery >= 50 %", OPEN, "never exercised 0/0 |1"),
        ("Move needs 20 % < battery and battery < 60 %", LONG, "satisfied 0/1"),
        ("Move needs 20 % < battery < 40 %", LONG, "violated 1/1"),
        ("Move needs not battery < 20 %", LONG, "satisfied 0/1"),
        ("Pick needs battery == 30 %", LONG, "satisfied 0/1"),
        ("Move leaves battery >= 30 %", LONG, "satisfied 0/1"),
        ("Move leaves battery >= 31 %", LONG, "violated 1/1"),
        ("Move leaves battery >= 31 %", FAILED, "never exercised 0/0"),
        ("Move leaves battery >= 31 %", HALTED, "never exercised 0/0"),
        ("Move leaves battery >= 31 %", OPEN, "never exercised 0/0 |1"),
        ("Move ends with battery >= 30 %", LONG, "satisfied 0/1"),
        ("Move ends with battery >= 31 %", LONG, "violated 1/1"),
        ("Move ends with battery >= 31 %", FAILED, "violated 1/1"),
        ("Move ends with battery >= 30 %", FAILED, "satisfied 0/1"),
        ("Move ends with battery >= 31 %", HALTED, "never exercised 0/0"),
        ("Move ends with battery >= 31 %", UNWRITTEN, "never exercised 0/0"),
        ("Move ends with battery >= 31 %", OPEN, "never exercised 0/0 |1"),
        ("mission ends with battery >= 31 %", FAILED, "violated 1/1"),
        ("Move keeps battery >= 5 %", LONG, "satisfied 0/1"),
        ("Move keeps battery >= 6 %", LONG, "violated 1/1"),
        ("Move keeps battery >= 6 %", HALTED, "violated 1/1"),
        ("Move keeps battery >= 6 %", UNWRITTEN, "unknown 0/0 ?1"),
        ("Move keeps battery >= 6 %", OPEN, "violated 1/1"),
        ("Move keeps battery >= 5 %", OPEN, "never exercised 0/0 |1"),
        ("Move keeps battery < 50 %", LONG, "violated 1/1"),
        ("Move keeps battery >= (40 % if battery > 45 % else 5 %)", LONG, "satisfied 0/1"),
        ("Move keeps battery >= (40 % if battery > 20 % else 5 %)", LONG, "violated 1/1"),
        ("Move never battery < 5 %", LONG, "satisfied 0/1"),
        ("Move never battery < 6 %", LONG, "violated 1/1"),
        ("Move never battery < 40 % for more than 20 ms", LONG, "satisfied 0/1"),
        ("Move never battery < 40 % for more than 19 ms", LONG, "violated 1/1"),
        ("Move never battery < 20 % for more than 5 ms", LONG, "satisfied 0/1"),
        ("Move never battery < 20 % for more than 4 ms", LONG, "violated 1/1"),
        ("Move never battery < 40 % for more than 19 ms", HALTED, "violated 1/1"),
        ("Move never battery < 40 % for more than 20 ms", HALTED, "satisfied 0/1"),
        ("Move never battery < 40 % for more than 19 ms", UNWRITTEN, "unknown 0/0 ?1"),
        ("Move never battery < 40 % for more than 19 ms", OPEN, "violated 1/1"),
        ("Move never battery < 40 % for more than 20 ms", OPEN, "never exercised 0/0 |1"),
        ("Move never battery < 40 % for more than 15 ms\n while battery > 20 %", LONG, "satisfied 0/1"),
        ("Move never battery < 40 % for more than 9 ms if battery < 10 % else 25 ms", LONG, "satisfied 0/1"),
        ("Move takes at most 29 ms if battery < 40 % else 31 ms", LONG, "satisfied 0/1"),
        ("Move takes at most 29 ms if battery > 40 % else 31 ms", LONG, "violated 1/1"),
    ],
)
def test_conditions(demand: str, runs: str, expected: str, verify: Verify) -> None:
    assert count(verify.clause(demand, runs, samples("battery", SAMPLES), before=LEVEL)) == expected


@pytest.mark.parametrize(
    ("demand", "given", "expected", "why"),
    [
        ("Move needs battery > 1 %", {}, "unknown 0/0 ?1", "no samples of `battery`"),
        ("Move needs battery > 1 %", {1: 50}, "unknown 0/0 ?1", "no sample of `battery` before that time"),
        ("Move needs battery > 1 %", {-10: 50}, "satisfied 0/1", ""),
        ("Move needs battery > 1 %", {-11: 50}, "unknown 0/0 ?1", "the last sample of `battery` is too old"),
        ("Move keeps battery > 1 %", {-1: 50, 9: 50, 19: 50, 29: 50}, "satisfied 0/1", ""),
        (
            "Move keeps battery > 1 %",
            {-1: 50, 9: 50, 29: 50},
            "unknown 0/0 ?1",
            "the last sample of `battery` is too old",
        ),
        ("Move keeps battery > 1 %", {-1: 50, 9: 50, 29: 0}, "violated 1/1", ""),
        (
            "Move needs battery > 1 %",
            {-1: "full"},
            "unknown 0/0 ?1",
            "a sample of `battery` is `full`, which is not a number",
        ),
        # What is unknown does not matter where the rest decides it.
        ("Move needs battery > 1 % or 2 > 1", {}, "satisfied 0/1", ""),
        ("Move needs battery > 1 % and 1 > 2", {}, "violated 1/1", ""),
    ],
)
def test_samples_that_are_missing_or_old(
    demand: str, given: dict[float, object], expected: str, why: str, verify: Verify
) -> None:
    found = verify.clause(demand, LONG, samples("battery", given), before=FRESH)
    assert (count(found), found["why"]) == (expected, why)


ENERGY = "signal energy : Wh from {energy} counter fresh within 25 ms"


@pytest.mark.parametrize(
    ("demand", "runs", "expected"),
    [
        # From 50 % to 5 %, recharged to 30 %: for a bound of more than 50 % that would be noise.
        ("Move uses at most 45 % of battery", LONG, "satisfied 0/1"),
        ("Move uses at most 44 % of battery", LONG, "violated 1/1"),
        ("Move uses less than 45 % of battery", LONG, "violated 1/1"),
        ("Move uses at least 40 % of battery", LONG, "satisfied 0/1"),
        ("Move uses at least 51 % of battery", LONG, "violated 1/1"),
        ("Move uses between 30 % and 40 % of battery", LONG, "violated 1/1"),
        ("Move uses between 10 % and 60 % of battery", LONG, "satisfied 0/1"),
        ("Move uses at most 45 % of battery", FAILED, "satisfied 0/1"),
        ("Move uses at most 45 % of battery", HALTED, "never exercised 0/0"),
        ("Move uses at most 44 % of battery", HALTED, "violated 1/1"),
        ("Move uses at most 45 % of battery", OPEN, "never exercised 0/0 |1"),
        ("Move uses at most 44 % of battery", OPEN, "violated 1/1"),
        ("Move uses at most 44 % of battery", UNWRITTEN, "unknown 0/0 ?1"),
        ("Move uses at most 99 % of battery", BACK, "unknown 0/0 ?1"),
        ("Move uses at most 1 Wh of energy", LONG, "unknown 0/0 ?1"),  # the last sample is too old at the end
        ("Move uses at most 1 Wh of energy", "0 1R 2R 20 2S 1S", "satisfied 0/1"),
        ("Move uses at most 0.4 Wh of energy", "0 1R 2R 20 2S 1S", "violated 1/1"),
        ("Pick uses at most 0 Wh of energy", "0 1R 3S 20 1S", "satisfied 0/1"),
        ("Move uses at most 19 % if battery > 40 % else 90 % of battery", LONG, "violated 1/1"),
    ],
)
def test_uses(demand: str, runs: str, expected: str, verify: Verify) -> None:
    times = {**{time: (level, "") for time, level in SAMPLES.items()}, 0: ("", 2.0), 2: ("", 2.5)}
    lines = [f"{(START + round(ms * 1000)) / 1e6:.6f},{level},{energy}" for ms, (level, energy) in times.items()]
    csv = "\n".join(["t,battery,energy", *lines, ""])
    assert count(verify.clause(demand, runs, csv, before=f"{LEVEL}\n{ENERGY}")) == expected


@pytest.mark.parametrize(
    ("condition", "expected"),
    [
        # The samples of Move: 50 % as it starts, then 30 %, 5 % and 30 %; the sample after its end does not count.
        ("max(battery) <= 50 %", "satisfied 0/1"),
        ("max(battery) < 50 %", "violated 1/1"),
        ("min(battery) >= 5 %", "satisfied 0/1"),
        ("min(battery) > 5 %", "violated 1/1"),
        ("mean(battery) == 28.75 %", "satisfied 0/1"),
        ("p95(battery) == 50 %", "satisfied 0/1"),
        ("change(battery) == -20 %", "satisfied 0/1"),
        ("15.9 % < stddev(battery) < 16 %", "satisfied 0/1"),
        ("count(battery) == 3", "satisfied 0/1"),
        ("max(battery) - min(battery) == 45 %", "satisfied 0/1"),
    ],
)
@pytest.mark.parametrize("verb", ["leaves", "keeps", "needs"])
def test_summaries_of_samples(verb: str, condition: str, expected: str, verify: Verify) -> None:
    demand = f"Move {verb} {condition}"
    assert count(verify.clause(demand, LONG, samples("battery", SAMPLES), before=LEVEL)) == expected


@pytest.mark.parametrize("condition", ["mean(battery) == 40 %", "count(battery) == 1", "min(battery) == 30 %"])
def test_the_last_sample_of_a_time_counts(condition: str, verify: Verify) -> None:
    given = samples("battery", {-5: 50, 10: 5, 10.0004: 30})  # two in the same µs
    assert count(verify.clause(f"Move leaves {condition}", LONG, given, before=LEVEL)) == "satisfied 0/1"


@pytest.mark.parametrize(
    ("demand", "given", "expected", "why"),
    [
        ("Move leaves max(battery) < 9 %", {}, "unknown 0/0 ?1", "no samples of `battery`"),
        ("Move leaves max(battery) < 9 %", {40: 1}, "unknown 0/0 ?1", "no sample of `battery` meanwhile"),
        ("Move leaves max(battery) < 9 %", {5: 1, 15: 1, 25: 1}, "satisfied 0/1", ""),
        ("Move leaves max(battery) < 9 %", {5: 1, 25: 1}, "unknown 0/0 ?1", "the last sample of `battery` is too old"),
        ("Move leaves max(battery) < 9 %", {5: 1, 15: 1}, "unknown 0/0 ?1", "the last sample of `battery` is too old"),
        ("Move leaves count(battery) > 1", {}, "unknown 0/0 ?1", "no samples of `battery`"),
        ("Move leaves count(battery) == 2", {0: 1, 30: 1, 31: 1}, "satisfied 0/1", ""),
        (
            "Move leaves p95(battery) < 9 %",
            {5: "x"},
            "unknown 0/0 ?1",
            "a sample of `battery` is `x`, which is not a number",
        ),
    ],
)
def test_summaries_of_samples_that_are_missing_or_old(
    demand: str, given: dict[float, object], expected: str, why: str, verify: Verify
) -> None:
    found = verify.clause(demand, LONG, samples("battery", given), before=FRESH)
    assert (count(found), found["why"]) == (expected, why)


def test_a_summary_is_known_at_the_end(verify: Verify) -> None:
    """So an activation that ended at some time before neither breaks nor keeps it, unless nothing changed meanwhile."""
    given = samples("battery", SAMPLES)
    found = verify.clause("Move keeps max(battery) < 50 %", UNWRITTEN, given, before=LEVEL)
    assert (count(found), found["why"]) == ("unknown 0/0 ?1", "the log does not say when it was halted")
    found = verify.clause("Move keeps min(battery) < 40 %", UNWRITTEN, given, before=LEVEL)
    assert (count(found), found["why"]) == ("unknown 0/0 ?1", "the log does not say when it was halted")
    steady = verify.clause("Move keeps max(battery) < 50 %", UNWRITTEN, samples("battery", {-5: 50}), before=LEVEL)
    assert count(steady) == "violated 1/1"
    (broken,) = verify.clause("Move never max(battery) > 40 %", LONG, given, before=LEVEL)["violations"]
    assert (broken["at"], broken["why"], broken["bound"]) == (0.03, "`max(battery)` was 50 %", "40 %")


def test_what_a_signal_has_initially_is_no_measurement(verify: Verify) -> None:
    first = f"{LEVEL} initially 80 %"
    for demand in ("needs battery == 80 %", "keeps battery >= 1 %", "never battery < 1 %", "leaves battery >= 1 %"):
        assert count(verify.clause(f"Move {demand}", LONG, before=first)) == "unknown 0/0 ?1"
    assert count(verify.clause("Move uses at most 1 % of battery", LONG, before=first)) == "unknown 0/0 ?1"
    late = samples("battery", {500: 50})
    assert count(verify.clause("Move needs battery == 80 %", LONG, late, before=first)) == "unknown 0/0 ?1"
    assert count(verify.clause("Move needs battery == 80 %", LONG, samples("battery", {-1: 5}), before=first)) == (
        "violated 1/1"
    )
    grows_old = verify.clause(
        "Move keeps battery > 20 %", LONG, samples("battery", {5: 50}), before=f"{FRESH} initially 80 %"
    )
    assert count(grows_old) == "unknown 0/0 ?1"


@pytest.mark.parametrize(
    ("demand", "without", "later"),
    [
        ("Move takes at most 1 s\nwhen battery > 70 %", "unknown 0/0 ?1", "satisfied 0/1"),
        ("Move takes at most 1 s\nwhen battery < 70 %", "unknown 0/0 ?1", "never exercised 0/0"),
        ("Move takes at most 1 s if battery > 70 % else 1 ms", "unknown 0/0 ?1", "satisfied 0/1"),
        ("Pick follows when battery > 70 %", "unknown 0/0 ?1", "satisfied 0/1"),
        # What is demanded is not read from it, in a named context neither, and a scope is.
        ("Move keeps full\nwhile battery > 70 %", "unknown 0/0 ?1", "unknown 0/0 ?1"),
        ("Move keeps full\nwhile battery < 70 %", "unknown 0/0 ?1", "never exercised 0/0"),
    ],
)
def test_what_a_signal_has_initially_says_what_a_requirement_is_about(
    demand: str, without: str, later: str, verify: Verify
) -> None:
    """Before its first sample, and only in a log with samples of the signal."""
    first = f"{LEVEL} initially 80 %\ncontext full : battery > 70 %"
    assert count(verify.clause(demand, LONG, before=first)) == without
    assert count(verify.clause(demand, LONG, samples("battery", {500: 50}), before=first)) == later


def test_a_node_begins_after_its_elder_sibling_has_ended(verify: Verify) -> None:
    """Also where they have one time, and the row between may be of another thread."""
    assert count(verify.clause("Pick takes at most 1 s\nwhen node Move", LONG)) == "never exercised 0/0"


@pytest.mark.parametrize(
    ("signal", "given", "demand", "expected"),
    [
        ("door : bool", {-1: "true"}, "Move needs door", "satisfied 0/1"),
        ("door : bool", {-1: 0}, "Move needs door", "violated 1/1"),
        ("door : bool", {-1: 0}, "Move needs door == false", "satisfied 0/1"),
        ("mode : text", {-1: "slow"}, 'Move needs mode == "slow"', "satisfied 0/1"),
        ("mode : text", {-1: "fast"}, 'Move needs mode == "slow"', "violated 1/1"),
        ("speed : km/h", {-1: 3.6}, "Move needs speed <= 1 m/s", "satisfied 0/1"),
        ("speed : km/h", {-1: 3.7}, "Move needs speed <= 1 m/s", "violated 1/1"),
        ("heat : degC", {-1: 20}, "Move needs heat == 293.15 K", "satisfied 0/1"),
        ("speed : m/s", {-1: 2}, "Move needs 2 * speed - 1 m/s == 3 m/s", "satisfied 0/1"),
    ],
)
def test_samples_of_all_sorts(
    signal: str, given: dict[float, object], demand: str, expected: str, verify: Verify
) -> None:
    name = signal.partition(" ")[0]
    found = verify.clause(demand, LONG, samples(name, given), before=f"signal {signal} from {{{name}}}")
    assert count(found) == expected


def test_a_column_may_have_the_name_of_the_entry(verify: Verify) -> None:
    found = verify.clause("Move needs battery > 40 %", LONG, samples("battery_level", SAMPLES), before=LEVEL)
    assert count(found) == "satisfied 0/1"


@pytest.mark.parametrize(
    ("demand", "expected"),
    [
        ("Move takes at most 1 ms\nwhen battery >= 50 %", "violated 1/1"),
        ("Move takes at most 1 ms\nwhen battery < 50 %", "never exercised 0/0"),
        ("Move takes at most 1 ms\nwhile battery >= 5 %", "violated 1/1"),
        ("Move takes at most 1 ms\nwhile battery >= 6 %", "never exercised 0/0"),
        ("Move keeps battery >= 6 %\nwhile battery >= 10 %", "satisfied 0/1"),
        ("Move keeps battery >= 6 %\nwhile battery < 40 %", "violated 1/1"),
        ("Move keeps battery >= 6 %\nwhile battery > 90 %", "never exercised 0/0"),
        ("Move never battery < 6 %\nwhile battery >= 10 %", "satisfied 0/1"),
        ("Move never battery < 6 %\nwhile battery < 10 %", "violated 1/1"),
        ("Move takes at most 1 ms\nwhen low", "never exercised 0/0"),
        ("Move takes at most 1 ms\nwhen not low", "violated 1/1"),
        ("Move takes at most 1 ms\nwhen other > 1 %", "unknown 0/0 ?1"),
    ],
)
def test_scopes(demand: str, expected: str, verify: Verify) -> None:
    before = f"{LEVEL}\nsignal other : % from {{other}}\ncontext low : battery < 20 %"
    assert count(verify.clause(demand, LONG, samples("battery", SAMPLES), before=before)) == expected


def test_a_context_is_read_once_at_a_moment(verify: Verify, monkeypatch: pytest.MonkeyPatch) -> None:
    read: list[tuple[Any, ...]] = []
    reading = Signals.reading

    def noted(*asked: Any) -> object:
        read.append(asked)
        return reading(*asked)

    monkeypatch.setattr(Signals, "reading", noted)
    doubled = "".join(f"context c{at} : c{at - 1} and c{at - 1}\n" for at in range(1, 41))
    before = f"{LEVEL}\ncontext c0 : battery < 90 %\n{doubled}"
    clause = verify.clause("Move needs c40\nwhile c39", LONG, samples("battery", SAMPLES), before=before)
    assert count(clause) == "satisfied 0/1"
    by_moment = Counter(asked[2] for asked in read)
    assert max(by_moment.values()) == 3  # for the clause, for its scope, and to count the runs in which contexts held


@pytest.mark.parametrize(
    ("demand", "worst", "violations"),
    [
        ("Move keeps battery >= 6 %\nwhile battery >= 10 %", "30 %", []),
        ("Move keeps battery >= 6 %\nwhile battery < 40 %", "5 %", [("5 %", "`battery` was 5 %")]),
        ("Move never battery < 6 %\nwhile battery >= 10 %", "30 %", []),
        ("Move never battery < 6 %\nwhile low\nwhile node Move", "5 %", [("5 %", "`battery` was 5 %")]),
    ],
)
def test_what_counts_is_measured_while_it_counts(
    demand: str, worst: str, violations: list[tuple[str, str]], verify: Verify
) -> None:
    before = f"{LEVEL}\ncontext low : battery < 20 %"
    found = verify.clause(demand, LONG, samples("battery", SAMPLES), before=before)
    assert found["worst"]["text"] == worst
    assert [(each["measured"], each["why"]) for each in found["violations"]] == violations


@pytest.mark.parametrize(
    ("demand", "expected"),
    [
        ("Move succeeds within 1 ms\nwhile battery >= 30 %", "unknown 0/0 ?1"),
        ("Move needs battery > 50 %\nwhile battery >= 30 %", "unknown 0/0 ?1"),
        ("Move needs battery > 50 %\nwhile battery >= 5 %", "violated 1/1"),
        ("Move needs battery > 50 %\nwhile battery < 50 %", "never exercised 0/0"),
        ("Move keeps battery < 99 %\nwhile battery < 50 %", "unknown 0/0 ?1"),
        ("Move keeps battery < 99 %\nwhile battery >= 50 %", "satisfied 0/1"),
        ("Move keeps battery < 99 %\nwhile battery < 5 %", "never exercised 0/0"),
    ],
)
def test_a_scope_may_end_after_a_halt_that_was_not_logged(demand: str, expected: str, verify: Verify) -> None:
    assert count(verify.clause(demand, UNWRITTEN, samples("battery", SAMPLES), before=LEVEL)) == expected


@pytest.mark.parametrize(
    "demand",
    ["needs battery >= 1 %", "keeps battery >= 1 %", "leaves battery >= 1 %", "succeeds", "takes at most 99 ms"],
)
def test_what_is_cut_off_is_left_out_of_each_clause(demand: str, verify: Verify) -> None:
    """Also of one that was decided when it began, unless it was broken then."""
    found = verify.clause(f"Move {demand}", f"{LONG} 50 1R 2R 90 3I", samples("battery", SAMPLES), before=LEVEL)
    assert count(found) == "satisfied 0/1 |1"


@pytest.mark.parametrize(
    ("demand", "expected"),
    [
        ("Move succeeds\nwhile battery >= 5 %", "never exercised 0/0 |1"),
        ("Move succeeds\nwhile battery >= 6 %", "never exercised 0/0"),
        ("Move succeeds\nwhen battery < 50 %", "never exercised 0/0"),
    ],
)
def test_what_does_not_count_is_not_cut_off(demand: str, expected: str, verify: Verify) -> None:
    assert count(verify.clause(demand, OPEN, samples("battery", SAMPLES), before=LEVEL)) == expected


# ---- odds ----

GOOD, BAD, IDLE_RUN = "1R 2S 1S", "1R 2F 1F", "1R 3S 1S"


def several(*runs: str) -> str:
    return " ".join(f"{10 * at} {run}" for at, run in enumerate(runs))


@pytest.mark.parametrize(
    ("odds", "runs", "expected"),
    [
        ("in at least 75 % of runs", [GOOD, GOOD, GOOD, BAD], "satisfied 1/4"),
        ("in at least 76 % of runs", [GOOD, GOOD, GOOD, BAD], "violated 1/4"),
        ("with probability > 75 % of runs", [GOOD, GOOD, GOOD, BAD], "violated 1/4"),
        ("in at least 75 % of runs", [GOOD, "1R 2S 2I 2F 1F", GOOD, GOOD], "satisfied 1/4"),
        ("in at least 75 % of activations", [GOOD, "1R 2S 2I 2F 1F"], "violated 1/3"),
        ("in at least 50 % of runs", [GOOD, IDLE_RUN, IDLE_RUN], "satisfied 0/1"),
        ("in at least 50 % of runs", [IDLE_RUN], "never exercised 0/0"),
        ("in at least 50 % of runs\nconfidence 95 %", [GOOD] * 4, "undecided 0/4"),
        ("in at least 50 % of runs\nconfidence 95 %", [GOOD] * 5, "satisfied 0/5"),
        ("in at least 50 % of runs\nconfidence 95 %", [BAD] * 5, "violated 5/5"),
    ],
)
def test_odds(odds: str, runs: list[str], expected: str, verify: Verify) -> None:
    assert count(verify.clause(f"Move succeeds\n{odds}", several(*runs))) == expected


def test_what_is_undecided_says_how_many_more_decide(verify: Verify) -> None:
    found = verify.clause("Move succeeds\nin at least 50 % of runs\nconfidence 95 %", several(*[GOOD] * 3))
    assert (found["verdict"], found["more"], found["confidence"]) == ("undecided", 2, 0.95)
    assert found["interval"] == [pytest.approx(0.05 ** (1 / 3)), 1.0]
    all_ = verify.clause("Move succeeds\nin at least 100 % of runs\nconfidence 95 %", several(*[GOOD] * 3))
    assert (all_["verdict"], all_["more"]) == ("undecided", None)


@pytest.mark.parametrize(
    ("odds", "expected"),
    [
        ("in at least 50 % of runs", "satisfied 0/2 ?1"),  # 2 of 3, whatever the third was
        ("in at least 90 % of runs", "unknown 0/2 ?1"),
        ("in at least 90 % of runs\nconfidence 95 %", "undecided 0/2 ?1"),
    ],
)
def test_what_is_unknown_counts_as_both(odds: str, expected: str, verify: Verify) -> None:
    given = samples("battery", {5: 50})
    found = verify.clause(f"Move needs battery > 1 %\n{odds}", several(GOOD, GOOD, GOOD), given, before=LEVEL)
    assert count(found) == expected


@pytest.mark.parametrize(
    ("odds", "runs", "expected", "result"),
    [
        # 0 of 1 is within the limits of 90 %, as 1 of 1 is; 0 of 2 is below them.
        (
            "in at least 90 % of runs\nconfidence 95 %",
            [GOOD],
            "undecided 0/0 ?1",
            "0 of 0, 1 unknown (no samples of `battery`); 45 more without a violation decide it",
        ),
        (
            "in at least 90 % of runs\nconfidence 95 %",
            [GOOD, GOOD],
            "unknown 0/0 ?2",
            "no samples of `battery` (2 of 2 runs)",
        ),
        ("in at least 90 % of runs", [GOOD], "unknown 0/0 ?1", "no samples of `battery` (1 of 1 runs)"),
        ("with probability > 100 % of runs", [GOOD], "violated 0/0 ?1", "0 of 0, 1 unknown"),
    ],
)
def test_what_is_all_unknown_counts_as_both(
    odds: str, runs: list[str], expected: str, result: str, verify: Verify
) -> None:
    found = verify.clause(f"Move needs battery > 1 %\n{odds}", several(*runs), before=LEVEL)
    assert count(found) == expected
    assert f"  {result}" in verify.text("run.btlog", "--mission", "main.btq")


@pytest.mark.parametrize("form", ["table", "junit", "csv", "markdown", "html"])
def test_odds_that_nothing_can_reach(form: str, verify: Verify) -> None:
    """Too few hold, and yet none broke the clause."""
    found = verify.clause("Move succeeds\nwith probability > 100 % of runs", several(GOOD, GOOD))
    assert (count(found), found["violations"]) == ("violated 0/2", [])
    printed = verify.text("run.btlog", "--mission", "main.btq", "--format", form, "--verbose")
    assert "Move::2: no share can be as large as the requirement asks" in printed


# ---- what is reported of a violation ----


def test_a_violation_says_where_and_by_how_much(verify: Verify) -> None:
    found = verify.clause("Move takes at most 0.03 s", f"{LONG} 50 1R 53 2R 90.2 2S 1S")
    assert found["worst"] == {"si": pytest.approx(0.0402), "text": "40.2 ms", "run": 2}
    assert found["violations"] == [
        {
            "run": 2,
            "source": "run.btlog",
            "path": "Move::2",
            "start": "2026-11-20T21:22:20.050000Z",
            "at": pytest.approx(0.0402),
            "measured": "40.2 ms",
            "bound": "0.03 s",
            "why": "took 40.2 ms",
            "chain": [
                {
                    "kind": "self",
                    "path": "Move::2",
                    "text": "it ran 40.2 ms",
                    "seconds": pytest.approx(0.0402),
                    "activations": 1,
                    "failed": 0,
                }
            ],
        }
    ]


def test_a_measure_has_as_many_digits_as_show_that_it_is_beyond_the_bound(verify: Verify) -> None:
    (found,) = verify.clause("Move takes at most 30 ms", "0 1R 2R 30.004 2S 3S 1S")["violations"]
    assert (found["measured"], found["bound"]) == ("30.004 ms", "30 ms")


@pytest.mark.parametrize(
    ("bound", "text"), [("1 h", "30 ms"), ("0.0300001 s", "30 ms"), ("40 ms", "30 ms"), ("1 us", "30000 us")]
)
def test_a_short_time_is_not_told_in_a_long_unit(bound: str, text: str, verify: Verify) -> None:
    assert verify.clause(f"Move takes at most {bound}", LONG)["worst"]["text"] == text


@pytest.mark.parametrize(
    ("demand", "why", "measured", "at"),
    [
        ("Move takes at most 29999 us", "took 30000 us", "30000 us", 0.03),  # as many digits as the bound needs
        ("Move succeeds within 10 ms", "succeeded after 30 ms", "30 ms", 0.03),
        ("Move needs battery > 60 %", "`battery` was 50 % at the start", "50 %", 0.0),
        ("Move leaves battery > 60 %", "`battery` was 30 % at the end", "30 %", 0.03),
        ("Move keeps battery > 10 %", "`battery` was 5 %", "5 %", 0.02),
        ("Move never battery < 10 %", "`battery` was 5 %", "5 %", 0.02),
        (
            "Move needs battery > 60 % or 1 > 2",
            "`battery > 60 % or 1 > 2` did not hold at the start: battery was 50 %",
            None,
            0.0,
        ),
    ],
)
def test_what_happened_in_words(demand: str, why: str, measured: str | None, at: float, verify: Verify) -> None:
    (found,) = verify.clause(demand, LONG, samples("battery", SAMPLES), before=LEVEL)["violations"]
    assert (found["why"], found["measured"], found["at"]) == (why, measured, at)


# ---- the table of verbs ----


@pytest.mark.parametrize("word", VERBS)
def test_the_example_of_a_verb_is_a_clause_with_it(word: str) -> None:
    parsed = parse(f"QualityReq a\n    {VERBS[word].example}\n")
    assert [each.message for each in parsed.diagnostics] == []
    (requirement,) = (entry.item for entry in parsed.entries if isinstance(entry.item, RequirementItem))
    clause, *_ = requirement.clauses
    assert isinstance(clause, Claim)
    assert clause.row == word.removesuffix(" of time").removesuffix(" on average")


@pytest.mark.parametrize(
    ("bound", "expected"), [("19 ms", "violated 1/1"), ("25 ms", "unknown 0/0 ?1"), ("30 ms", "satisfied 0/1")]
)
def test_a_stretch_that_is_unknown_between(bound: str, expected: str, verify: Verify) -> None:
    """It held from the start to 5 ms and from 10 ms to 30 ms; between, the sample is too old."""
    demand = f"Move never battery < 60 % for more than {bound}"
    assert count(verify.clause(demand, LONG, samples("battery", SAMPLES), before=FRESH)) == expected


@pytest.mark.parametrize(
    ("demand", "given", "runs", "expected", "why"),
    [
        ("keeps age(battery) <= 15 ms", SAMPLES, LONG, "satisfied 0/1", ""),
        ("keeps age(battery) <= 9 ms", SAMPLES, LONG, "violated 1/1", "`age(battery)` was 15 ms"),
        ("keeps age(battery) <= 9 ms", {-1: 50}, LONG, "violated 1/1", "`age(battery)` was 31 ms"),
        ("keeps age(battery) <= 29 ms", {31: 50}, LONG, "violated 1/1", "`age(battery)` was 30 ms"),
        ("keeps age(battery) <= 30 ms", {31: 50}, LONG, "satisfied 0/1", ""),
        ("keeps age(battery) <= 9 ms", SAMPLES, OPEN, "violated 1/1", "`age(battery)` was 15 ms"),
        ("keeps age(battery) <= 20 ms", SAMPLES, OPEN, "never exercised 0/0 |1", ""),
        ("keeps age(battery) <= 9 ms", SAMPLES, UNWRITTEN, "unknown 0/0 ?1", ""),
        ("needs age(battery) <= 4 ms", SAMPLES, LONG, "violated 1/1", "`age(battery)` was 5 ms at the start"),
        ("ends with age(battery) < 6 ms", SAMPLES, LONG, "satisfied 0/1", ""),
        (
            "never age(battery) > 5 ms for more than 4 ms",
            SAMPLES,
            LONG,
            "violated 1/1",
            "`age(battery) > 5 ms` held for 10 ms",
        ),
        ("keeps age(battery) <= 10 ms\n while battery < 40 %", SAMPLES, LONG, "satisfied 0/1", ""),
    ],
)
def test_ages(demand: str, given: dict[int, int], runs: str, expected: str, why: str, verify: Verify) -> None:
    found = verify.clause(f"Move {demand}", runs, samples("battery", given), before=LEVEL)
    assert (count(found), [each["why"] for each in found["violations"]]) == (expected, [why] if why else [])


def test_the_age_of_a_signal_without_samples_is_unknown(verify: Verify) -> None:
    found = verify.clause("Move keeps age(battery) <= 9 ms", LONG, before=LEVEL)
    assert (found["verdict"], found["why"]) == ("unknown", "no samples of `battery`")


@pytest.mark.parametrize(
    ("demand", "runs", "expected", "not_applicable"),
    [
        ("Move takes at most 29 ms\n assuming battery >= 5 %", LONG, "violated 1/1", 0),
        ("Move takes at most 29 ms\n assuming battery > 5 %", LONG, "never exercised 0/0", 1),
        ("Move takes at most 29 ms\n assuming battery > 5 %", OPEN, "never exercised 0/0", 1),
        ("Move takes at most 29 ms\n assuming battery > 5 %", UNWRITTEN, "unknown 0/0 ?1", 0),
        ("Move takes at most 90 ms\n assuming battery > 40 %", f"{LONG} 50 1R 2R 90 2S 1S", "never exercised 0/0", 2),
        ("Move takes at most 29 ms\n assuming battery >= 5 %\n in at least 50 % of runs", LONG, "violated 1/1", 0),
        ("Move needs battery >= 5 %\n when battery > 60 %\n assuming battery > 5 %", LONG, "never exercised 0/0", 0),
        ("mission succeeds\n assuming battery >= 5 %", FAILED, "violated 1/1", 0),
        ("mission succeeds\n assuming battery > 5 %", FAILED, "never exercised 0/0", 1),
        ("Move tries at most 0\n assuming battery >= 5 %", LONG, "violated 1/1", 0),
        ("Move tries at most 0\n assuming battery > 5 %", LONG, "never exercised 0/0", 1),
        (
            "from Move starts to Pick succeeds takes at most 9 ms\n assuming battery > 5 %",
            LONG,
            "never exercised 0/0",
            1,
        ),
    ],
)
def test_assumptions(demand: str, runs: str, expected: str, not_applicable: int, verify: Verify) -> None:
    given = samples("battery", {-5: 50, 10: 30, 20: 5, 25: 30})
    found = verify.clause(demand, runs, given, before=LEVEL)
    assert (count(found), found.get("not_applicable")) == (expected, not_applicable)
    if not_applicable:
        assert found["why"] == f"its assumption did not hold ({not_applicable} time{'s' * (not_applicable > 1)})"


def test_what_is_not_applicable_is_counted_apart(verify: Verify) -> None:
    runs = f"{LONG} 50 1R 2R 90 2S 3S 1S"
    given = samples("battery", {-5: 5, 40: 30})
    verify.clause("Move takes at most 90 ms\n assuming battery > 5 %", runs, given, before=LEVEL)
    output = verify.text("run.btlog", "--mission", "main.btq", "--signals", "samples.csv")
    assert "held so far in 1 activation, worst 40 ms in run 2, 1 not applicable" in output


def test_an_unknown_assumption_is_unknown(verify: Verify) -> None:
    found = verify.clause("Move takes at most 29 ms\n assuming battery > 5 %", LONG, before=LEVEL)
    assert (found["verdict"], found["why"]) == ("unknown", "no samples of `battery`")


TOO_SHORT = "the run ended before the time was over"
SIGNALS = (
    "signal battery : % from {battery}\nsignal energy : Wh from {energy} counter\nsignal speed : m/s from {speed}\n"
    "signal rear_is_clear : bool from {rear_is_clear}\nsignal lamp_on : bool from {lamp_on}\n"
    "signal humans_near : bool from {humans_near}\nsignal gripper_empty : bool from {gripper_empty}\n"
)


@pytest.mark.parametrize("word", VERBS)
def test_every_verb_is_judged(word: str, verify: Verify) -> None:
    example = re.sub("Batch|PickTray|SlotFree|Recover|HallA|HallB|Dock", "Pick", VERBS[word].example)
    demand = example if VERBS[word].operand == "answer" else f"Move {example}"
    found = verify.clause(demand, LONG, samples("battery", {-1: 50}), before=SIGNALS)
    lacks = {"needs": "no samples of `rear_is_clear`", "never": "no samples of `lamp_on`"}
    lacks["never for"] = "no samples of `lamp_on`"
    lacks["ends with"] = "no samples of `gripper_empty`"
    lacks["uses on average"] = "no samples of `energy`"
    lacks["never of time"] = "no samples of `humans_near`"
    lacks["uses"] = "no samples of `energy`"
    nothing = (
        "it was not running when Pick succeeds (1 time)"
        if word == "ends"
        else "nothing that it is about happened in any run"
    )
    assert found["why"] in (lacks.get(word, ""), nothing, TOO_SHORT)


@pytest.mark.parametrize(
    ("demand", "why"),
    [
        (
            "from Move starts to Pick succeeds succeeds within 1 s",
            "`succeeds` cannot be judged of the time from one event to another",
        ),
        ("sum of Move, Pick succeeds within 1 s", "`succeeds` cannot be judged of a sum of durations"),
        ("takes at most 1 s", "the clause applies to no node"),
        ("Move uses at most 1 m/s of speed", "`speed` is neither a level nor a counter"),
    ],
)
def test_what_cannot_be_judged_is_unknown_with_the_reason(demand: str, why: str, verify: Verify) -> None:
    found = verify.clause(demand, LONG, before=SIGNALS)
    assert (found["verdict"], found["why"]) == ("unknown", why)


def test_the_missions_of_these_tests_are_sound() -> None:
    workspace = Workspace.of({"main.btq": f"{LEVEL}\nQualityReq rq : safety\n    Move needs battery > 1 %\n{MAIN}"})
    assert [each.rule for each in check(workspace, "main.btq") if each.effective_severity.value == "error"] == []
    assert len(requirements(workspace, "main.btq").applied) == 1


@pytest.mark.parametrize(
    ("demand", "zone", "why"),
    [
        ('Move never zone == "isolation"', "isolation", '`zone == "isolation"` held: zone was "isolation"'),
        ('Move keeps zone != "isolation"', "isolation", '`zone != "isolation"` did not hold: zone was "isolation"'),
        (
            'Move never zone == "isolation" and battery < 60 %',
            "isolation",
            '`zone == "isolation" and battery < 60 %` held: zone was "isolation", battery was 50 %',
        ),
    ],
)
def test_a_condition_that_measures_nothing_is_told_with_what_it_read(
    demand: str, zone: str, why: str, verify: Verify
) -> None:
    csv = f"t,zone,battery\n{START / 1e6 - 1:.6f},{zone},50\n"
    found = verify.clause(demand, LONG, csv, before=f"signal zone : text from {{zone}}\n{LEVEL}")
    assert [each["why"] for each in found["violations"]] == [why]


def test_a_clock_that_was_set_forward_is_asked_about(verify: Verify) -> None:
    hour = 3_600_000
    often = " ".join(f"{at} 1R 2R {at + 20} 2S 1S 1I" for at in range(0, 500, 100))
    verify.clause("Move takes at most 2 s", f"{often} 600 1R 2R {600 + 2 * hour} 2S 1S")
    remarks = verify.json("run.btlog", "--mission", "main.btq")["sources"][0]["remarks"]
    assert remarks == [
        f"{path} took 2 h once, and half of the times at most 20 ms: was the clock set forward?"
        for path in ("Sequence::1", "Move::2")
    ]


LATE = "the samples of `battery`, mostly one each 20 ms, end 600 ms before the log does"


@pytest.mark.parametrize(
    ("signal", "last", "remark"),
    [
        (LEVEL, 400, f"{LATE}; without `fresh within` the last one counts until the end"),
        (LEVEL, 900, None),
        (f"{LEVEL} fresh within 700 ms", 400, None),
        (
            f"{LEVEL} fresh within 500 ms",
            400,
            LATE,
        ),
    ],
)
def test_samples_that_end_before_the_log(signal: str, last: int, remark: str | None, verify: Verify) -> None:
    csv = samples("battery", dict.fromkeys(range(0, last + 1, 20), 50))
    verify.clause("Pick takes at most 2 s", "0 1R 2R 1000 2S 3S 1S", csv, before=signal)
    (source,) = verify.json("run.btlog", "--mission", "main.btq", "--signals", "samples.csv")["sources"]
    assert source["remarks"] == ([remark] if remark else [])
