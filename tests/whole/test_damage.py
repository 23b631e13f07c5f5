"""Some thousands of the damaged missions that `damage.py` makes by the hundred thousand: a minute or two of them.

Which they are, conftest.py says at the end of the run.
"""

from __future__ import annotations

import pytest
from damage import run
from damage_seed import CASES, seed_of

PARTS = 8


@pytest.mark.parametrize("part", range(PARTS))
def test_nothing_raises(request: pytest.FixtureRequest, part: int) -> None:
    seed = seed_of(request.config)
    assert run(seed, range(part, CASES, PARTS)) == []  # what fails is shown with how to do it again
