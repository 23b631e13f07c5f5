"""A share of the damaged missions that `damage.py` makes by the hundred thousand, another one each day; in the thorough
profile some thousands that are new each day."""

from __future__ import annotations

import pytest
from by_day import NUMBER, of_the_day, takes_all
from damage import run

CASES = 4_000
PARTS = 8


@pytest.mark.parametrize("part", range(PARTS))
def test_nothing_raises(part: int) -> None:
    seed = NUMBER if takes_all() else 24
    assert run(seed, of_the_day(range(part, CASES, PARTS), 8)) == []  # what fails is shown with how to do it again
