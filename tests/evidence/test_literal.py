"""Random runs: `btq_lang.evidence` says of them what the literal judge says."""

from __future__ import annotations

import random

import pytest
from literal_hunt import NOT_COMPARED, Hunt

CASES = 300


@pytest.fixture(scope="module")
def hunt(request: pytest.FixtureRequest) -> Hunt:
    """Cases that were judged twice: the same ones in the usual run, so that what failed fails again."""
    is_thorough = request.config.getoption("--hypothesis-profile") == "thorough"
    seed = random.randrange(10**6) if is_thorough else 1
    capture = request.config.pluginmanager.getplugin("capturemanager")
    with capture.global_and_fixture_disabled():
        print(f"\nrandom runs: python tests/evidence/literal_hunt.py --cases {CASES} --seed {seed} makes the same")
    made = Hunt()
    for each in range(seed, seed + CASES):
        made.judge(each)
    return made


def test_both_say_the_same(hunt: Hunt) -> None:
    assert hunt.differences == []


def test_what_is_not_compared_occurs(hunt: Hunt) -> None:
    assert set(hunt.left_out) == NOT_COMPARED


@pytest.mark.parametrize("verb", ["takes", "succeeds", "needs", "keeps", "never", "leaves", "uses"])
def test_every_verdict_occurs(hunt: Hunt, verb: str) -> None:
    verdicts = ("never exercised", "satisfied", "undecided", "unknown", "violated")
    assert [each for each in verdicts if not hunt.compared[f"{verb}: {each}"]] == []
