"""Pauses the garbage collector: the objects of a parse are kept, and scanning them repeatedly takes a fifth of its
time.

One invariant: afterwards collection is enabled or disabled as before.  In a module of its own because the compiled
parser imports it, and nothing else from its neighbours.
"""

from __future__ import annotations

import gc


class NotCollecting:
    """`with NotCollecting():` disables the collector inside."""

    __slots__ = ("_was_collecting",)

    def __enter__(self) -> None:
        self._was_collecting = gc.isenabled()
        gc.disable()

    def __exit__(self, *_: object) -> None:
        if self._was_collecting:
            gc.enable()
