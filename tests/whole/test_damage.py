"""A share of the damaged missions that `damage.py` makes by the hundred thousand."""

from __future__ import annotations

import pytest
from damage import run
from seeds import SEED, share_of

CASES = 4_000
PARTS = 8


@pytest.mark.parametrize("part", range(PARTS))
def test_nothing_raises(part: int) -> None:
    assert run(24 + SEED, share_of(range(part, CASES, PARTS), 8)) == []  # what fails is shown with how to do it again
