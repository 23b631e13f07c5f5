"""How often a command that reads many files, or large ones, looks for garbage.

One invariant: what Python does by itself is as before when the command ends.  Of what a command makes nearly all stays
until its end, and Python would look through it again and again, for a fifth of the time of a check of 1 000 files.
"""

from __future__ import annotations

import gc

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import Final


def collecting_seldom(work: Callable[[], int]) -> int:
    """Do the work of a command and give its exit code."""
    usual = gc.get_threshold()
    gc.set_threshold(*_SELDOM)
    try:
        return work()
    finally:
        gc.set_threshold(*usual)


_SELDOM: Final = (20_000, 50, 10)
