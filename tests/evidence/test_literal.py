"""Random runs: `btq_lang.evidence` says of them what the literal judge says."""

from __future__ import annotations

import pytest
from literal_hunt import Hunt
from seeds import SEED

from btq_lang.catalog.verbs import VERBS

CASES = 150
USUAL = 600
# With these every verb comes to every verdict: each one has a verdict that no other case below has.
RARE = (
    *(272, 773, 1386),  # from … until, sums, never
    *(302, 325, 1977, 2040),  # shares of time
    *(15, 357, 777, 1940),  # counts
    *(515, 518, 1265, 2663, 4470),  # means
    *(445, 543, 1656),  # failure rates
    *(329,),  # visits
)
# In these the two judges once differed.
DIFFERED = (
    *(841, 978, 1754, 28, 191, 2490, 4261, 4303),
    *(165, 538, 957, 1318, 1344, 1712, 1734, 1769, 2044, 2245, 2894, 2912, 2986, 3175, 3342, 3619, 4198, 5138, 5291),
    *(11072, 5576, 5773, 6032, 6146, 6202, 6517, 6967, 8781, 9318, 9404, 9819, 9922, 9976, 20143, 20744, 22573, 22938),
)


@pytest.fixture(scope="module")
def hunt(request: pytest.FixtureRequest) -> Hunt:
    """Cases that were judged twice: always the same ones, and with another `BTQ_SEED` others as well."""
    seeds = [USUAL, *([USUAL + SEED * CASES] if SEED else ())]
    made = Hunt()
    for each in (*RARE, *DIFFERED):
        made.judge(each)
    for seed in seeds:
        capture = request.config.pluginmanager.getplugin("capturemanager")
        with capture.global_and_fixture_disabled():
            print(f"\nrandom runs: python tests/evidence/literal_hunt.py --cases {CASES} --seed {seed} makes the same")
        for each in range(seed, seed + CASES):
            made.judge(each)
    return made


def test_both_say_the_same(hunt: Hunt) -> None:
    assert hunt.differences == []


@pytest.mark.parametrize("verb", [*VERBS, "from … to", "sum of", "from … until"])
def test_every_verdict_occurs(hunt: Hunt, verb: str) -> None:
    verdicts = ("never exercised", "satisfied", "undecided", "unknown", "violated")
    assert [each for each in verdicts if not hunt.compared[f"{verb}: {each}"]] == []
