"""The literal judge itself: hand-made logs, and what the design says of them; `btq_lang.evidence` must say the same.

Verdicts are as in `violated 1/2 ?1 |1`: how many are violated, of how many that are judged, then the unknown ones, and
those that the log cuts off.
"""

from __future__ import annotations

import sqlite3
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import pytest
from check_asserts import workspace_of
from evidence_logs import START, rows
from literal_begins import Begins
from literal_hunt import Hunt, literal_of
from literal_runs import activations
from literal_verbs import OPEN
from random_runs import as_case

from btq_lang.evidence.identity import Candidate
from btq_lang.evidence.model import LoggedTree, SampleValue

SIGNALS = """
signal speed : m/s from {speed} initially 0 m/s
signal battery : % from {battery} level
signal energy : Wh from {energy} counter
context slow : speed <= 1 m/s
"""
LONG = "0 1R 2R 40 2S 3S 1S"  # b takes no time that is known: from 0 to 40
TWO = "-> n0\n  Action Move a\n  Action Pick b"


def said(demand: str, log: str, tree: str = TWO, **samples: Sequence[tuple[float, float]]) -> str:
    """What both judges say of the first clause of requirement r.

    Args:
        demand: the lines of r, and other requirements after them.
        samples: by signal, ms since the log's start, and a value.
    """
    shown = "\n".join(f"    {line}" for line in tree.split("\n"))
    text = f"Root Main\n{SIGNALS}QualityReq r : safety\n    {demand}\nBehaviorTree Main\n{shown}\n"
    mission = Candidate(workspace_of({"main.btq": text}), "main.btq", "main", None)
    in_micros: dict[str, list[tuple[int, SampleValue]]] = {
        name: [(START + round(ms * 1000), value) for ms, value in values] for name, values in samples.items()
    }
    logged = [(START + time, uid, status) for time, uid, status in rows(log)]
    made = replace(as_case(text, mission), sessions=[logged], samples=in_micros)
    applied = next(each for each in mission.requirements.applied if each.requirement.name == "r")
    judged = literal_of(made).clause(applied, applied.requirement.claims[0])
    hunt = Hunt()
    hunt.judge_case(made, 0)
    assert hunt.differences == []
    number = Counter(str(each) for each in judged.experiments)
    cut_off = sum(each.verdict is OPEN for each in judged.judged)
    found = f"{judged.verdict} {number['False']}/{number['True'] + number['False']}"
    found += f" ?{number['None']}" if number["None"] else ""
    return found + (f" |{cut_off}" if cut_off else "")


LATE = [(20.0, 0.5)]


@pytest.mark.parametrize(
    ("demand", "speed", "expected"),
    [
        ("a needs speed <= 1 m/s", None, "unknown 0/0 ?1"),
        ("a needs speed <= 1 m/s", LATE, "unknown 0/0 ?1"),
        ("a needs slow", LATE, "unknown 0/0 ?1"),
        ("a keeps speed <= 1 m/s", LATE, "unknown 0/0 ?1"),
        ("a keeps speed <= 1 m/s", [(20.0, 2.0)], "violated 1/1"),
        ("a never speed > 1 m/s", None, "unknown 0/0 ?1"),
        ("a never speed > 1 m/s", LATE, "unknown 0/0 ?1"),
        ("a leaves speed <= 1 m/s", None, "unknown 0/0 ?1"),
        ("a leaves speed <= 1 m/s", LATE, "satisfied 0/1"),
        ("a ends with speed <= 1 m/s", None, "unknown 0/0 ?1"),
        ("a ends with speed <= 1 m/s", LATE, "satisfied 0/1"),
        ("a needs max(speed) <= 1 m/s", None, "unknown 0/0 ?1"),
        ("a leaves max(speed) <= 1 m/s", LATE, "satisfied 0/1"),
        ("a leaves min(speed) <= 0 m/s", LATE, "violated 1/1"),  # though it began with `initially 0 m/s`
        ("a takes at most 50 ms\n    when slow", None, "unknown 0/0 ?1"),
        ("a takes at most 50 ms\n    when slow", LATE, "satisfied 0/1"),
        ("a takes at most 50 ms\n    while speed <= 1 m/s", LATE, "satisfied 0/1"),
        ("a takes at most 50 ms\n    when not slow", LATE, "never exercised 0/0"),
        ("a takes at most 50 ms if slow else 5 ms", None, "unknown 0/0 ?1"),
        ("a takes at most 50 ms if slow else 5 ms", LATE, "satisfied 0/1"),
        ("a starts within 50 ms after when slow", LATE, "satisfied 0/1"),
        ("a starts within 50 ms after when slow", None, "unknown 0/0 ?1"),
        # What only may have happened is unknown, whatever the scope was when it may have.
        ("b starts within 50 ms after when battery >= 50 %\n    when slow", [(-1.0, 2.0)], "unknown 0/0 ?1"),
    ],
)
def test_initially_is_no_measurement(demand: str, speed: list[tuple[float, float]] | None, expected: str) -> None:
    assert said(demand, LONG, TWO, **({} if speed is None else {"speed": speed})) == expected


DELAY = "Delay d (delay_msec = 300)\n  Action Move a"
ASYNC = "A-> n0\n  Action Move a\n  Action Pick b"
SWITCH = '-> n0\n  Action Move a\n  Switch2 s (variable = "{v}" case_1 = "x" case_2 = "y")\n' + "".join(
    f"    Action Pick {name}\n" for name in "bcd"
)
BESIDE = "|| n0\n  Action Move a\n  Action Pick b"
REPEAT = "Repeat n0 (num_cycles = 2)\n  Action Move a"
PARALLEL = "|| n0\n  Action Move a\n  -> s\n    Action Look c\n    Action Pick b"
SPAN = "from b starts to mission finishes takes at most"
AROUND = "-> n0\n  Action Move a\n  Inverter i\n    Timeout t (msec = 1000)\n      Action Pick b"


@pytest.mark.parametrize(
    ("tree", "demand", "log", "expected"),
    [
        # A leaf of one row began with its parent, or when its elder sibling ended.
        (TWO, "a takes at most 300 ms", "0 1R 400 2S 500 3S 1S", "violated 1/1"),
        (TWO, "a takes at most 400 ms", "0 1R 400 2S 500 3S 1S", "satisfied 0/1"),
        (TWO, "b takes between 90 ms and 110 ms", "0 1R 400 2S 500 3S 1S", "satisfied 0/1"),
        (TWO, "b takes at least 101 ms", "0 1R 400 2S 500 3S 1S", "violated 1/1"),
        # RUNNING follows the first tick.
        (TWO, "a takes at most 250 ms", "0 1R 200 2R 300 2S 3S 1S", "violated 1/1"),
        # What another thread may have written shows no tick, but what it waited for had ended: b lasts 200 to 300 ms.
        (TWO, "b takes at most 199 ms", "0 1R 2R 100 2S 200 3R 400 3S 1S", "violated 1/1"),
        (TWO, "b takes at most 299 ms", "0 1R 2R 100 2S 200 3R 400 3S 1S", "unknown 0/0 ?1"),
        (TWO, "b takes at most 300 ms", "0 1R 2R 100 2S 200 3R 400 3S 1S", "satisfied 0/1"),
        (BESIDE, "b takes at most 300 ms", "0 1R 2R 100 2S 200 3R 400 3S 1S", "unknown 0/0 ?1"),  # it waits for nothing
        (BESIDE, "b takes at most 400 ms", "0 1R 2R 100 2S 200 3R 400 3S 1S", "satisfied 0/1"),
        # It began after its own last row, whoever wrote that: the second time it lasts 30 to 90 ms.
        (REPEAT, "a takes at most 29 ms", "0 1R 2R 40 2S 2I 100 2R 130 2S 1S", "violated 2/2"),
        (REPEAT, "a takes at most 89 ms", "0 1R 2R 40 2S 2I 100 2R 130 2S 1S", "unknown 0/1 ?1"),
        (REPEAT, "a takes at most 90 ms", "0 1R 2R 40 2S 2I 100 2R 130 2S 1S", "satisfied 0/2"),
        (TWO, "b takes between 200 ms and 250 ms", "0 1R 2R 100 2S 300 3R 400 3S 1S", "unknown 0/0 ?1"),
        (TWO, "b takes less than 350 ms", "0 1R 2R 100 2I 3R 400 3I 1I", "unknown 0/0 ?1"),
        (TWO, "b takes at most 250 ms", "0 1R 2R 100 2S 200 3R 400 1F", "unknown 0/0 ?1"),
        (TWO, "b takes at most 350 ms", "0 1R 2R 100 2S 3R 300 2I", "never exercised 0/0 |1"),
        # All parents between go on within the tick.
        (AROUND, "b takes at most 90 ms", "0 1R 2S 3R 4R 100 5S 4S 3F 1F", "violated 1/1"),
        (AROUND, "b takes at most 90 ms", "0 1R 2S 100 5S 4S 3F 1F", "violated 1/1"),
        (AROUND, "t takes at most 90 ms", "0 1R 2S 100 5S 4S 3F 1F", "violated 1/1"),  # it begins with its child's row
        (SWITCH, "b takes at most 90 ms", "0 1R 2S 100 4R 3R 200 4S 3S 1S", "violated 1/1"),
        (SWITCH, "c takes at most 90 ms", "0 1R 2S 4R 3R 50 4I 150 5S 3S 1S", "unknown 0/0 ?1"),  # 3R follows 4R
        (SWITCH, "s takes at most 90 ms", "0 1R 2S 100 4R 3R 110 4S 3S 1S", "violated 1/1"),
        # Delay waits first; Async nodes pause between children; Repeat pauses between cycles.
        (DELAY, "a takes at most 60 ms", "0 1R 350 2S 1S", "satisfied 0/1"),
        (DELAY, "a takes at most 40 ms", "0 1R 350 2S 1S", "unknown 0/0 ?1"),
        (DELAY, "d takes at most 340 ms", "0 1R 350 2S 1S", "violated 1/1"),
        (ASYNC, "a takes at most 50 ms", "0 1R 100 2S 200 3S 1S", "violated 1/1"),
        (ASYNC, "b takes at most 50 ms", "0 1R 100 2S 200 3S 1S", "unknown 0/0 ?1"),
        (REPEAT, "a takes at most 50 ms", "0 1R 20 2S 2I 100 2S 1S", "unknown 0/1 ?1"),
        # A child of a Parallel starts in its first tick, or was skipped.
        (PARALLEL, "s takes at most 90 ms", "0 1R 2S 100 4S 3R 200 5S 3S 1S", "violated 1/1"),
        (PARALLEL, "c takes at most 90 ms", "0 1R 2S 100 4S 3R 200 5S 3S 1S", "violated 1/1"),
        (PARALLEL, "b takes at most 90 ms", "0 1R 2R 3R 4R 100 4S 200 5S 3S 1S", "unknown 0/0 ?1"),
        # Without a row before nothing is known of the begin.
        ("Action Move a", "a takes at most 1 h", "0 1S", "unknown 0/0 ?1"),
        ("Action Move a", "a takes at most 1 h", "0 1R 10 1S", "unknown 0/0 ?1"),
        # Sums and spans add intervals: 100 and 0 to 50 ms.
        (TWO, "sum of a, b takes at most 150 ms", "0 1R 2R 100 2S 150 3S 1S", "satisfied 0/1"),
        (TWO, "sum of a, b takes at most 149 ms", "0 1R 2R 100 2S 150 3S 1S", "unknown 0/0 ?1"),
        (TWO, "sum of a, b takes at most 99 ms", "0 1R 2R 100 2S 150 3S 1S", "violated 1/1"),
        (TWO, "from a succeeds to b starts takes at most 50 ms", "0 1R 2R 100 2S 150 3R 200 3S 1S", "satisfied 0/1"),
        (TWO, "from a succeeds to b starts takes at most 49 ms", "0 1R 2R 100 2S 150 3R 200 3S 1S", "unknown 0/0 ?1"),
        # Rows tell what came first.
        (TWO, "b starts within 50 ms after a succeeds", "0 1R 2R 100 2S 150 3R 200 3S 1S", "satisfied 0/1"),
        (TWO, "b starts within 49 ms after a succeeds", "0 1R 2R 100 2S 150 3R 200 3S 1S", "unknown 0/0 ?1"),
        (TWO, "b follows a succeeds", "0 1R 2R 100 2S 150 3R 200 3S 1S", "satisfied 0/1"),
        (TWO, "b tries at most 1 per a", "0 1R 2R 100 2S 150 3R 200 3S 1S", "never exercised 0/0"),
        (TWO, f"{SPAN} 110 ms", "0 1R 2R 40 2S 90 3R 100 3S 150 1S", "satisfied 0/1"),
        (TWO, f"{SPAN} 109 ms", "0 1R 2R 40 2S 90 3R 100 3S 150 1S", "unknown 0/0 ?1"),
        (TWO, f"{SPAN} 59 ms", "0 1R 2R 40 2S 90 3R 100 3S 150 1S", "violated 1/1"),
    ],
)
def test_durations_are_intervals(tree: str, demand: str, log: str, expected: str) -> None:
    assert said(demand, log, tree.rstrip()) == expected


@pytest.mark.parametrize(
    ("demand", "battery", "expected"),
    [
        # b began between 30 and 50 ms.
        ("b needs battery >= 50 %", [(-1, 60), (60, 10)], "satisfied 0/1"),
        ("b needs battery >= 50 %", [(-1, 60), (40, 10)], "unknown 0/0 ?1"),
        ("b needs battery >= 50 %", [(-1, 60), (35, 10), (45, 70)], "satisfied 0/1"),  # both ends agree
        ("b keeps battery >= 50 %", [(-1, 10), (40, 60)], "unknown 0/0 ?1"),
        ("b keeps battery >= 50 %", [(-1, 60), (55, 10)], "violated 1/1"),
        ("b takes at most 1 s\n    when battery >= 50 %", [(-1, 10), (40, 60)], "unknown 0/0 ?1"),
        ("b takes at most 1 s\n    while battery >= 50 %", [(-1, 10), (40, 60)], "unknown 0/0 ?1"),
        ("b takes at most 1 s if battery >= 50 % else 1 ms", [(-1, 10), (40, 60)], "unknown 0/0 ?1"),
        ("b uses at most 20 % of battery", [(-1, 60), (40, 50), (70, 35)], "unknown 0/0 ?1"),
        ("b uses at most 5 % of battery", [(-1, 60), (40, 50), (70, 35)], "violated 1/1"),
        ("b starts within 40 ms after when battery < 50 %", [(-1, 60), (5, 40)], "unknown 0/0 ?1"),
        ("b starts within 40 ms after when battery < 50 %", [(-1, 40)], "unknown 0/0 ?1"),
        ("b starts within 60 ms after when battery < 50 %", [(-1, 40)], "satisfied 0/1"),
        ("b starts within 5 ms after when battery < 50 %", [(-1, 60), (35, 40)], "unknown 0/0 ?1"),  # before, or not
        ("b starts within 1 s after b starts\n    when battery < 50 %", [(-1, 60), (40, 40)], "unknown 0/0 ?1"),
        ("b ends within 1 s after b starts\n    when battery < 50 %", [(-1, 60), (20, 40)], "satisfied 0/1"),
        (
            "from b starts to b finishes takes at most 1 s\n    when battery < 50 %",
            [(-1, 60), (40, 40)],
            "unknown 0/0 ?1",
        ),
    ],
)
def test_both_ends_of_a_begin_must_agree(demand: str, battery: list[tuple[float, float]], expected: str) -> None:
    assert said(demand, "0 1R 2R 30 2S 50 3R 80 3S 1S", battery=battery) == expected


FAIL = "\n    on violation fail"
OTHER = "\nQualityReq other : safety\n    "
REFUSED = "0 1R 2R 3F 2F 1F"  # 1 n0 (2 guard (3 check, 4 a), 5 b)
STOPPED = "0 1R 2R 3S 4R 30 3I 3F 4I 2F 1F"
NO_CHECK = "0 1R 2R 40 3S 4F 2F 1F"  # 1 n0 (2 guard (3 a, 4 check), 5 b)


@pytest.mark.parametrize(
    ("demand", "log", "expected"),
    [
        (f"a needs battery >= 50 %{FAIL}", REFUSED, "violated 1/1"),
        (f"a keeps battery >= 50 %{FAIL}", REFUSED, "violated 1/1"),
        (f"a never battery < 50 %{FAIL}", REFUSED, "violated 1/1"),
        (f"a keeps battery >= 50 %{FAIL}", STOPPED, "violated 1/1"),
        (f"a leaves battery >= 50 %{FAIL}", NO_CHECK, "violated 1/1"),
        # A check proves it, also where the log is cut off before its guard's own row.
        (f"a needs battery >= 50 %{FAIL}", "0 1R 2R 3F", "violated 1/1"),
        (f"a keeps battery >= 50 %{FAIL}", "0 1R 2R 3S 4R 30 3F", "violated 1/1"),
        (f"a leaves battery >= 50 %{FAIL}", "0 1R 2R 40 3S 4F", "violated 1/1"),
        (f"a succeeds\n    a keeps battery >= 50 %{FAIL}", STOPPED, "violated 1/1"),
        # A guard that only checks halts nothing: it failed because a did, the second time.
        (f"a needs battery >= 50 %{FAIL}", "0 1R 2R 3S 4R 30 4I 40 3S 4R 50 4F 2F 1F", "unknown 0/0 ?2"),
        # A guard that passes proves nothing.
        (f"a needs battery >= 50 %{FAIL}", "0 1R 2R 3S 40 4S 2S 5S 1S", "unknown 0/0 ?1"),
        # What another requirement's guard refuses is a case of succeeds, and no start otherwise.
        (f"a succeeds{OTHER}a needs battery >= 50 %{FAIL}", REFUSED, "violated 1/1"),
        (f"a succeeds{OTHER}a keeps battery >= 50 %{FAIL}", REFUSED, "violated 1/1"),
        (f"a takes at most 1 s{OTHER}a needs battery >= 50 %{FAIL}", REFUSED, "never exercised 0/0"),
        (f"a follows b succeeds{OTHER}a keeps slow{FAIL}", REFUSED, "never exercised 0/0"),
        # The root's result is that of the mission.
        (f"mission succeeds{OTHER}a keeps battery >= 50 %{FAIL}", STOPPED, "violated 1/1"),
        (f"mission succeeds{OTHER}mission needs battery >= 50 %{FAIL}", "0 1R 2F 1F", "violated 1/1"),
        (f"mission succeeds{OTHER}mission leaves battery >= 50 %{FAIL}", "0 1R 2R 40 3S 4S 2S 5F 1F", "violated 1/1"),
    ],
)
def test_guards_and_verdicts_say_the_same(demand: str, log: str, expected: str) -> None:
    assert said(demand, log) == expected


# 1 init (2 start, 3 Repeat (4 tries (5 check, 6 counted (7 counter, 8 a))))
TRIED = "0 1R 2S 3R 4R 5S 6R 7S 10 8S 6S 4S 4R"


@pytest.mark.parametrize(
    ("log", "expected"),
    [
        (f"{TRIED} 5S 6R 7S 20 8S 6S 4S 3S 1S", "violated 1/1"),  # it is in the log, whatever the guard let pass
        (f"{TRIED} 5F 4F 3F 1F", "violated 1/1"),
        ("0 1R 2S 3R 4R 5F 4F 3F 1F", "violated 1/1"),
        ("0 1R 2S 3R 4R 5S 6R 7S 10 8F 6F 4F 3F 1F", "satisfied 0/1"),
        ("0 1R 2S 3R 1F", "never exercised 0/0"),
    ],
)
def test_a_refused_try_violates_its_run(log: str, expected: str) -> None:
    assert said(f"a tries at most 1{FAIL}", log, REPEAT) == expected


def test_a_guard_around_a_span_violates_it() -> None:
    # 1 Retry (2 guard (3 n0 (4 a, 5 b)))
    log = "0 1R 2R 3R 4R 40 4I 3I 2F 2R 3R 4R 50 4S 60 5S 3S 2S 1S"
    tree = "Retry r (num_attempts = 2)\n" + "\n".join(f"  {line}" for line in TWO.split("\n"))
    assert said(f"from a starts to b finishes takes at most 1 s{FAIL}", log, tree) == "violated 1/2"


TWICE = "0 1R 2R 50 2F 60 2R 100 2S 150 3R 200 3S 1S"


@pytest.mark.parametrize(
    ("demand", "log", "expected"),
    [
        ("each a finishes is followed by b starts within 100 ms", TWICE, "satisfied 0/2"),
        ("each a finishes is followed by b starts within 99 ms", TWICE, "unknown 0/1 ?1"),  # b began from 100 to 150
        ("each a fails or b finishes is followed by a succeeds or mission finishes", TWICE, "satisfied 0/2"),
        ("each b finishes is followed by a starts", TWICE, "violated 1/1"),
        ("each a finishes is followed by slow within 10 ms", TWICE, "violated 1/2"),  # slow until 55, and from 170
        ("each b starts is followed by slow within 19 ms", TWICE, "violated 1/1"),
        ("each b starts is followed by slow within 20 ms", TWICE, "unknown 0/0 ?1"),
        ("each b starts is followed by slow within 70 ms", TWICE, "satisfied 0/1"),
        ("each b finishes is followed by not slow within 1 ms", TWICE, "never exercised 0/0"),
        ("each when slow is followed by a fails or b finishes within 50 ms", TWICE, "satisfied 0/2"),
        ("mission keeps slow\n    from a starts until a finishes", TWICE, "violated 1/2"),
        ("mission keeps not slow\n    from a succeeds until b finishes", TWICE, "violated 1/1"),
        ("mission never slow\n    from a succeeds until b starts", TWICE, "unknown 0/0 ?1"),  # perhaps at once
        ("mission never slow\n    from a succeeds until b finishes", TWICE, "violated 1/1"),
        ("mission never slow\n    from a fails until b starts", TWICE, "violated 1/1"),
        ("b keeps slow\n    from mission starts until mission finishes", TWICE, "violated 1/1"),
        ("a never slow\n    from when not slow until when slow", TWICE, "satisfied 0/1"),
        ("mission never slow\n    from a halts until b starts", "0 1R 2R 100 3S 1S", "unknown 0/0 ?2"),  # or after it
    ],
)
def test_what_follows_and_what_is_kept_between_events(demand: str, log: str, expected: str) -> None:
    speed = [(-1.0, 0.5), (55.0, 2.0), (170.0, 0.5)]
    assert said(demand, log, TWO, speed=speed) == expected


@pytest.mark.parametrize(
    ("demand", "values", "expected"),
    [
        ("a uses at most 89 Wh of energy", [(0, 100), (10, 150), (20, 0), (30, 40)], "violated 1/1"),
        ("a uses at most 90 Wh of energy", [(0, 100), (10, 150), (20, 0), (30, 40)], "satisfied 0/1"),
        ("a uses at most 49 Wh of energy", [(0, 100), (10, 90), (30, 150)], "violated 1/1"),  # noise
        ("a uses at most 50 Wh of energy", [(0, 100), (10, 90), (30, 150)], "satisfied 0/1"),
        ("a uses at most 94 % of battery", [(0, 90), (10, 20), (20, 95), (30, 70)], "violated 1/1"),
        ("a uses at most 96 % of battery", [(0, 90), (10, 20), (20, 95), (30, 70)], "satisfied 0/1"),
        ("a uses at most 10 % of battery", [(0, 90), (10, 86), (20, 90), (30, 81)], "satisfied 0/1"),  # jitter
        ("a uses at most 9 % of battery", [(0, 90), (10, 85), (20, 90), (30, 85)], "violated 1/1"),
        ("a uses at most 50 % of battery", [(0, 60), (5, 20), (10, 45), (20, 40), (30, 70)], "satisfied 0/1"),
        ("a uses at most 39 % of battery", [(0, 60), (5, 20), (10, 45), (20, 40), (30, 70)], "violated 1/1"),
        ("a uses at most 50 % of battery", [(5, 20), (30, 70)], "unknown 0/0 ?1"),
    ],
)
def test_use_adds_up(demand: str, values: list[tuple[float, float]], expected: str) -> None:
    name = "energy" if "energy" in demand else "battery"
    assert said(demand, LONG, TWO, **{name: values}) == expected


@pytest.mark.parametrize(
    ("demand", "log", "expected"),
    [
        ("a ends within 10 ms after b starts", "0 1R 2S 10 3S 1S", "never exercised 0/0"),
        ("mission ends within 9 ms after b starts", "0 1R 2S 10 3S 1S", "violated 1/1"),
        ("b starts within 1 s after a fails", "0 1R 2F 1F", "violated 1/1"),
        ("b starts within 1 s after a fails", "0 1R 2R 10 2F 20 1I", "violated 1/1"),
        ("b starts within 1 s after a succeeds", "0 1R 2S 20 2I", "never exercised 0/0 |1"),
        ("b starts within 1 s after a starts", "0 2R 5 2S", "unknown 0/0 ?1"),  # it may have started long before
        ("sum of a, b takes at most 1 s", "0 1R 1F", "never exercised 0/0"),
        ("b tries at most 1", "0 1R 2F 1F", "never exercised 0/0"),
        ("b tries at least 1", "0 1R 2F 1F", "violated 1/1"),
        ("b tries at most 1", "0 1R 2F 1F 1I 10 1R 2S 3S 1S", "satisfied 0/1"),
    ],
)
def test_what_counts(demand: str, log: str, expected: str) -> None:
    assert said(demand, log) == expected


@pytest.mark.parametrize(("name", "known", "of"), [("lab", 780, 780), ("nav", 790, 821)])
def test_most_single_rows_of_the_engine_have_a_known_begin(name: str, known: int, of: int, shared: Path) -> None:
    database = sqlite3.connect(f"file:{shared}/logs/{name}.db3?mode=ro", uri=True)
    ((xml,),) = database.execute("SELECT xml_tree FROM Definitions")
    logged = database.execute("SELECT timestamp, node_uid, state FROM Transitions ORDER BY timestamp").fetchall()
    database.close()
    tree, subtrees = numbered(xml)
    found = activations(tree, logged)
    Begins(tree, subtrees, {}, logged, found).set()
    single = [each for each in found if each.uid in tree.leaves and each.first == each.last]
    assert (sum(each.earliest == each.latest for each in single), len(single)) == (known, of)


def numbered(xml: str) -> tuple[LoggedTree, set[int]]:
    """The tree of XML, numbered as the engine does, and its SubTree nodes."""
    root = ElementTree.fromstring(xml)
    trees = {each.get("ID"): each[0] for each in root.iter("BehaviorTree")}
    nodes: list[tuple[int, str, str, int]] = []
    subtrees = set()

    def add(element: ElementTree.Element, parent: int) -> None:
        uid = len(nodes) + 1
        nodes.append((uid, element.tag, element.get("name") or f"{element.tag}::{uid}", parent))
        if element.tag == "SubTree":
            subtrees.add(uid)
        for child in [trees[element.get("ID")]] if element.tag == "SubTree" else element:
            add(child, uid)

    add(next(each for each in trees.values() if each.get("_uid") == "1"), 0)
    return LoggedTree(nodes), subtrees


# 1 n0 (2 guard (3 check, 4 a), 5 b); the guard has a row of its own only when it fails, or none.
HALTED = "0 1R 3S 4R 30 4I 3I"


@pytest.mark.parametrize(
    ("log", "expected"),
    [
        # A guard that only looks before a start has refused one each time it fails, and stopped nothing.
        (f"{HALTED} 40 3F 2F 1F", "violated 1/1 ?1"),
        (f"{HALTED} 40 3S 4R 50 4I 3I 60 3F 2F 1F", "violated 1/1 ?2"),
        (f"{HALTED} 40 3F 3I 50 3F 2F 1F", "violated 2/2 ?1"),
        (f"{HALTED} 40 3F", "violated 1/1 ?1"),
    ],
)
def test_each_failure_of_a_check_before_the_start_is_a_refused_start(log: str, expected: str) -> None:
    assert said(f"a needs battery >= 50 %{FAIL}", log) == expected


# 1 init (2 start, 3 n0 (4 tries (5 check, 6 counted (7 counter, 8 a)), 9 per (10 zero, 11 b)))
@pytest.mark.parametrize(
    ("log", "expected"),
    [
        ("0 1R 2S 3R 5F 4F 3F 1F 1I 10 1R 2S 3R 5F 4F 3F 1F", "violated 2/2"),
        ("0 1R 2S 3R 5F 5I 10 5F 4F 3F 1F", "violated 2/2"),
    ],
)
def test_refused_tries_that_no_activation_holds_are_a_case_each(log: str, expected: str) -> None:
    assert said(f"a tries at most 1 per b{FAIL}", log) == expected


def test_a_span_that_its_guard_ends_is_violated_where_the_log_ends_first() -> None:
    # 1 init (2 start, 3 guard (4 check, 5 n0 …
    demand = f"mission never battery < 50 %\n    from a starts until b finishes{FAIL}"
    assert said(demand, "0 1R 2S 3R 4S 5R 30 4F") == "violated 1/1"


@pytest.mark.parametrize(("last", "expected"), [(1, "satisfied 0/1"), (2, "unknown 0/1 ?1")])
def test_a_window_keeps_the_spans_that_end_last(last: int, expected: str) -> None:
    """The first one may have ended before 55 ms, when a started again; the second one is from 100 to 200 ms."""
    demand = "mission keeps battery >= 50 %\n    from a fails or a succeeds until a starts or b finishes"
    battery = [(-1.0, 90.0), (55.0, 10.0), (58.0, 90.0)]
    assert said(f"{demand}\n    over last {last} activations", TWICE, TWO, battery=battery) == expected


USES = (
    "-> n0\n  SubTree Part p\n  SubTree Part q\nBehaviorTree Part\n    -> n1\n      Action Move a\n      Action Pick b"
)


def test_the_nodes_of_a_scope_are_those_of_the_use_of_each_node_of_a_sum() -> None:
    """1 n0 (2 p (3 n1 (4 a, 5 b)), 6 q (7 n1 (8 a, 9 b)))"""
    log = "0 1R 2R 3R 4R 10 4S 5R 30 5S 3S 2S 6R 7R 8R 40 8S 9R 70 9S 7S 6S 1S"
    tree = USES.split("\nBehaviorTree")[0]
    part = USES[len(tree) + 1 :]
    demand = "sum of b takes at most {} ms\n    while node n1" + "\n" + part
    assert (said(demand.format(50), log, tree), said(demand.format(49), log, tree)) == ("satisfied 0/1", "violated 1/1")
