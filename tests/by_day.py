"""Which of many inputs a run of the tests takes: a share of them, every day another one, so that each comes in turn.

All of one day's runs take the same ones, and what failed fails again; `BTQ_DAY` names another day than today, and
`--hypothesis-profile=thorough` takes all.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from datetime import date
from itertools import islice
from typing import TypeVar
from zlib import crc32

from hypothesis import settings

T = TypeVar("T")
# Set once, for a run that goes on after midnight, too: its workers inherit it.
DAY = os.environ.setdefault("BTQ_DAY", date.today().isoformat())
NUMBER = date.fromisoformat(DAY).toordinal()


def of_the_day(every: Iterable[T], share: int) -> list[T]:
    """One in so many of the inputs."""
    return list(every if takes_all() else islice(every, NUMBER % share, None, share))


def is_its_day(name: str) -> bool:
    """Every name has one day of the week, whatever others there are."""
    return takes_all() or crc32(name.encode()) % 7 == NUMBER % 7


def takes_all() -> bool:
    return settings.default is settings.get_profile("thorough")
