"""Some thousands of the damaged missions that `damage.py` makes by the hundred thousand: a minute of them."""

from __future__ import annotations

import random

import pytest
from damage import run

CASES, PARTS = 4_000, 4


@pytest.fixture(scope="session")
def seed(request: pytest.FixtureRequest) -> int:
    """The same one in the usual run, so that what failed fails again; the thorough one looks for new missions."""
    is_thorough = request.config.getoption("--hypothesis-profile") == "thorough"
    chosen = random.randrange(10**6) if is_thorough else 24
    capture = request.config.pluginmanager.getplugin("capturemanager")
    with capture.global_and_fixture_disabled():
        print(f"\ndamaged missions: python tests/damage.py --cases {CASES} --seed {chosen} makes the same")
    return chosen


@pytest.mark.parametrize("part", range(PARTS))
def test_nothing_raises(seed: int, part: int) -> None:
    assert run(seed, range(part, CASES, PARTS)) == []  # what fails is shown with how to do it again
