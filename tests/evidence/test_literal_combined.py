"""Ages of signals, assumptions and several events, each with counts, shares of time, rates and means: what both judges
say of hand-made runs.  Verdicts are as in `test_literal_by_hand`.
"""

from __future__ import annotations

import pytest
from test_literal_by_hand import TWICE, TWO, said

# TWICE: a fails at 50 ms, and succeeds at 100, the second time begun between 50 and 60; b succeeds at 200, begun
# between 100 and 150.  The run lasts from 0 to 200 ms.
# Speed is slow from 0 to 55 and from 170 on; its age is 1 ms at 0, 56 ms just before 55, and 115 ms just before 170.
SPEED = [(-1.0, 0.5), (55.0, 2.0), (170.0, 0.5)]
ALWAYS = "\n    assuming age(speed) <= 116 ms"
NOT_ALL_ALONG = "\n    assuming age(speed) <= 100 ms"  # it is 100 ms at 155
UNKNOWN = "\n    assuming battery >= 20 %"  # no sample
OFF = "never exercised 0/0"


@pytest.mark.parametrize(
    ("log", "demand", "expected"),
    [
        # b lasts from 200 to 300 ms.
        ("0 1R 2R 100 2S 200 3R 400 3S 1S", "b takes at most 300 ms on average", "satisfied 0/1"),
        ("0 1R 2R 100 2S 200 3R 400 3S 1S", "b takes at most 299 ms on average", "unknown 0/1"),
        ("0 1R 2R 100 2S 200 3R 400 3S 1S", "b takes at least 201 ms on average", "unknown 0/1"),
        ("0 1R 2R 100 2S 200 3R 400 3S 1S", "b takes at most 199 ms on average", "violated 0/1"),
        # Once 40 ms, and once from 50 to 100 ms: the mean is between 45 and 70 ms.
        ("0 1R 2R 10 2S 3R 50 3S 1S 1I 1000 1R 2R 1000 2S 1050 3R 1100 3S 1S", "{} 70 ms on average", "satisfied 0/2"),
        ("0 1R 2R 10 2S 3R 50 3S 1S 1I 1000 1R 2R 1000 2S 1050 3R 1100 3S 1S", "{} 69 ms on average", "unknown 0/2"),
        ("0 1R 2R 10 2S 3R 50 3S 1S 1I 1000 1R 2R 1000 2S 1050 3R 1100 3S 1S", "{} 44 ms on average", "violated 0/2"),
    ],
)
def test_an_unknown_mean(log: str, demand: str, expected: str) -> None:
    assert said(demand.format("b takes at most"), log) == expected


@pytest.mark.parametrize(
    ("demand", "expected"),
    [
        # Only assumptions that hold all along make a run count.
        (f"a finishes at least 2 per run{ALWAYS}", "satisfied 0/1"),
        (f"a finishes at least 3 per run{ALWAYS}", "violated 1/1"),
        (f"a finishes at least 3 per run{NOT_ALL_ALONG}", OFF),
        (f"a succeeds at least 2 per run{UNKNOWN}", "unknown 0/0 ?1"),
        (f"a fails at most 0 per run{ALWAYS}", "violated 1/1"),
        (f"a fails at most 0 per run{NOT_ALL_ALONG}", OFF),
        ("a starts at most 1 per run\n    assuming slow", OFF),
        ("a tries at most 1\n    assuming speed <= 2 m/s", "violated 1/1"),
        (f"a tries at most 1{UNKNOWN}", "unknown 0/0 ?1"),
        (f"mission visits a, b in order{ALWAYS}", "satisfied 0/1"),
        (f"mission visits b, a in order{ALWAYS}", "violated 1/1"),
        (f"mission visits b, a in order{NOT_ALL_ALONG}", OFF),
        # Of the activations of a only the second one may start with an age of at most 5 ms, if it does not begin before
        # 55; the first one begins with 1 ms.
        ("a finishes at least 1 per run\n    when age(speed) <= 5 ms", "satisfied 0/1"),
        ("a finishes at least 2 per run\n    when age(speed) <= 5 ms", "unknown 0/0 ?1"),
        # The age reaches 51 ms in the first one, and 54.999 or 45 ms in the second.
        ("a finishes at least 2 per run\n    while age(speed) <= 60 ms", "satisfied 0/1"),
        ("a finishes at least 1 per run\n    while age(speed) <= 30 ms", "violated 1/1"),
        ("a starts at most 1 per run\n    while age(battery) <= 5 ms", "unknown 0/0 ?1"),  # not in the evidence
    ],
)
def test_counts(demand: str, expected: str) -> None:
    assert said(demand, TWICE, TWO, speed=SPEED) == expected


@pytest.mark.parametrize(
    ("demand", "expected"),
    [
        # More than 100 ms from 155 to 170: 7.5 % of the run.
        ("mission keeps age(speed) <= 100 ms in at least 92 % of time", "satisfied 0/1"),
        ("mission keeps age(speed) <= 100 ms in at least 93 % of time", "violated 1/1"),
        ("mission never age(speed) > 100 ms in at least 92 % of time", "satisfied 0/1"),
        ("mission never age(speed) > 100 ms in at least 93 % of time", "violated 1/1"),
        ("mission keeps age(battery) <= 5 ms in at least 50 % of time", "unknown 0/0 ?1"),
        # Slow for 85 of 200 ms, and at an age of at most 30 ms for 59 of 89: up to 29, from 170, but not from 55 to 85.
        (f"mission keeps slow in at least 42 % of time{ALWAYS}", "satisfied 0/1"),
        (f"mission keeps slow in at least 43 % of time{ALWAYS}", "violated 1/1"),
        (f"mission keeps slow in at least 43 % of time{NOT_ALL_ALONG}", OFF),
        (f"mission keeps slow in at least 43 % of time{UNKNOWN}", "unknown 0/0 ?1"),
        ("mission keeps slow in at least 66 % of time\n    while age(speed) <= 30 ms", "satisfied 0/1"),
        ("mission keeps slow in at least 67 % of time\n    while age(speed) <= 30 ms", "violated 1/1"),
        # At an age of at most 30 ms a runs for 29 ms, and from 60 to 85, of 90 ms.  It may run from 50 on, when that is
        # more until 55, and less until 60: 54 of 95 ms, to 59 of 95.
        ("a keeps age(speed) <= 30 ms in at least 56 % of time", "satisfied 0/1"),
        ("a keeps age(speed) <= 30 ms in at least 57 % of time", "unknown 0/0 ?1"),
        ("a keeps age(speed) <= 30 ms in at least 62 % of time", "unknown 0/0 ?1"),
        ("a keeps age(speed) <= 30 ms in at least 63 % of time", "violated 1/1"),
    ],
)
def test_shares_of_time(demand: str, expected: str) -> None:
    assert said(demand, TWICE, TWO, speed=SPEED) == expected


@pytest.mark.parametrize(
    ("demand", "expected"),
    [
        (f"a fails at most 0 per 100 ms{ALWAYS}", "violated 0/1"),
        (f"a fails at most 0 per 100 ms{NOT_ALL_ALONG}", OFF),
        (f"a fails at most 0 per 100 ms{UNKNOWN}", "unknown 0/0 ?1"),
        # At 50 ms, when a fails, the age is 51 ms; it is at most that for 55 + 51 + 30 - 5 ms, and for 50 of a.
        ("a fails at most 0 per 100 ms\n    while age(speed) <= 50 ms", "satisfied 0/1"),
        ("a fails at most 0 per 100 ms\n    while age(speed) <= 52 ms", "violated 0/1"),
        # The first one of 50 ms has an age of 51 ms at its end; the second one lasts 40 to 50 ms.
        ("a takes at most 50 ms on average\n    assuming age(speed) <= 60 ms", "satisfied 0/2"),
        ("a takes at most 45 ms on average\n    assuming age(speed) <= 60 ms", "unknown 0/2"),
        ("a takes at most 44 ms on average\n    assuming age(speed) <= 60 ms", "violated 0/2"),
        ("a takes at most 50 ms on average\n    assuming age(speed) <= 4 ms", OFF),
    ],
)
def test_rates_and_means(demand: str, expected: str) -> None:
    assert said(demand, TWICE, TWO, speed=SPEED) == expected


EITHER = "each a fails or a succeeds is followed by a succeeds or b finishes within"  # 50 ms, and 100 ms


@pytest.mark.parametrize(
    ("demand", "expected"),
    [
        (f"{EITHER} 100 ms{ALWAYS}", "satisfied 0/2"),
        (f"{EITHER} 99 ms{ALWAYS}", "violated 1/2"),
        (f"{EITHER} 99 ms{NOT_ALL_ALONG}", OFF),
        (f"{EITHER} 99 ms{UNKNOWN}", "unknown 0/0 ?2"),
        (f"{EITHER} 99 ms\n    in at least 50 % of occurrences{ALWAYS}", "satisfied 1/2"),
        (f"{EITHER} 99 ms\n    in at least 51 % of occurrences{ALWAYS}", "violated 1/2"),
        (f"{EITHER} 99 ms\n    in at least 50 % of runs{ALWAYS}", "violated 1/1"),
        # a fails 150 ms before b finishes, and the age is 100 ms 45 ms before.
        ("each a fails or when age(speed) > 100 ms is followed by b finishes within 150 ms", "satisfied 0/2"),
        ("each a fails or when age(speed) > 100 ms is followed by b finishes within 149 ms", "violated 1/2"),
        # A sample comes 5 ms after a fails, and 70 ms after it succeeds.
        ("each a fails or a succeeds is followed by age(speed) <= 5 ms within 70 ms", "satisfied 0/2"),
        ("each a fails or a succeeds is followed by age(speed) <= 5 ms within 69 ms", "violated 1/2"),
        ("each a fails or a succeeds is followed by age(speed) <= 5 ms within 4 ms", "violated 2/2"),
        # From 50 to 100 the age is at most 55 ms, from 100 to 200 up to 115 ms.
        ("mission never age(speed) > 60 ms\n    from a fails until a succeeds or b finishes", "satisfied 0/1"),
        (
            "mission never age(speed) > 60 ms\n    from a fails or a succeeds until a succeeds or b finishes",
            "violated 1/2",
        ),
        (
            f"mission never age(speed) > 60 ms\n    from a fails until b finishes or mission fails{ALWAYS}",
            "violated 1/1",
        ),
        (f"mission never age(speed) > 60 ms\n    from a fails until b finishes or mission fails{NOT_ALL_ALONG}", OFF),
    ],
)
def test_several_events(demand: str, expected: str) -> None:
    assert said(demand, TWICE, TWO, speed=SPEED) == expected
