"""Which of many inputs a run of the tests takes, and the seeds of what it draws: always the same ones, other ones with
another `BTQ_SEED`; `--hypothesis-profile=thorough` takes all inputs.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from itertools import islice
from typing import TypeVar

from hypothesis import settings

T = TypeVar("T")
SEED = int(os.environ.get("BTQ_SEED") or 0)


def share_of(every: Iterable[T], share: int) -> list[T]:
    """One in so many of the inputs."""
    return list(every if takes_all() else islice(every, SEED % share, None, share))


def seeds(count: int) -> range:
    """So many seeds; no two values of `BTQ_SEED` have the same ones."""
    return range(SEED * count, (SEED + 1) * count)


def takes_all() -> bool:
    return settings.default is settings.get_profile("thorough")
