"""Which of the damaged missions a run of the tests makes."""

from __future__ import annotations

from datetime import date

import pytest

CASES = 4_000


def seed_of(config: pytest.Config) -> int:
    """The same in every usual run, so that what failed fails again; the thorough one has another each day."""
    return date.today().toordinal() if config.getoption("--hypothesis-profile") == "thorough" else 24
