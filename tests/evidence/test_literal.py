"""Random runs: `btq_lang.evidence` says of them what the literal judge says."""

from __future__ import annotations

import pytest
from literal_hunt import Hunt
from seeds import SEED

from btq_lang.catalog.verbs import VERBS

CASES = 300
USUAL = 600  # the first of those in which every verb comes to every verdict


@pytest.fixture(scope="module")
def hunt(request: pytest.FixtureRequest) -> Hunt:
    """Cases that were judged twice: always the same ones, and with another `BTQ_SEED` others as well."""
    seeds = [USUAL, *([USUAL + SEED * CASES] if SEED else ())]
    made = Hunt()
    for seed in seeds:
        capture = request.config.pluginmanager.getplugin("capturemanager")
        with capture.global_and_fixture_disabled():
            print(f"\nrandom runs: python tests/evidence/literal_hunt.py --cases {CASES} --seed {seed} makes the same")
        for each in range(seed, seed + CASES):
            made.judge(each)
    return made


def test_both_say_the_same(hunt: Hunt) -> None:
    assert hunt.differences == []


@pytest.mark.parametrize("verb", [*VERBS, "from … to", "sum of"])
def test_every_verdict_occurs(hunt: Hunt, verb: str) -> None:
    verdicts = ("never exercised", "satisfied", "undecided", "unknown", "violated")
    assert [each for each in verdicts if not hunt.compared[f"{verb}: {each}"]] == []
