"""When Python looks for garbage.

One invariant: what Python does by itself is as before afterwards, but in a server.  Of what btq makes nearly all stays
until the command ends, and Python would look through it again and again: for a fifth of the time of a parse, half that
of reading XML, and a fifth of a check of 1 000 files.
"""

from __future__ import annotations

import gc
from collections.abc import Callable
from typing import Final


class NotCollecting:
    """`with NotCollecting():` nothing made inside is garbage, so none is looked for."""

    __slots__ = ("_was_collecting",)

    def __enter__(self) -> None:
        self._was_collecting = gc.isenabled()
        gc.disable()

    def __exit__(self, *_: object) -> None:
        if self._was_collecting:
            gc.enable()


def collecting_seldom(work: Callable[[], int]) -> int:
    """Do the work of a command and give its exit code; large enough, it makes garbage too."""
    usual = gc.get_threshold()
    gc.set_threshold(*_SELDOM)
    try:
        return work()
    finally:
        gc.set_threshold(*usual)


def keep_what_is_there() -> None:
    """What a server has read stays: looking through all of it would halt every answer that comes meanwhile, a quarter
    of a second for 10 000 nodes.  With it stays what is garbage by then: some hundred objects."""
    gc.freeze()
    gc.set_threshold(*_IN_PAUSES)


def collect_in_pause() -> None:
    """For a server that has nothing to do: what the last edits have left goes now, and not while somebody waits."""
    young, older, oldest = gc.get_count()
    if young > _ENOUGH:
        gc.collect(0 if older <= _OFTEN else 1 if oldest <= _NOW_AND_THEN else 2)


_SELDOM: Final = (20_000, 50, 10)
_IN_PAUSES: Final = (100_000, 50, 10)  # not reached in 900 keys that nobody paused between
_ENOUGH: Final = 4_000  # objects, of some 50 edits: what is found of fewer would be looked at too often
_OFTEN: Final = 20  # pauses, after which what was in use in one of them may be garbage
_NOW_AND_THEN: Final = (
    5  # times as many pauses, after which all is looked through that came since the server has settled
)
