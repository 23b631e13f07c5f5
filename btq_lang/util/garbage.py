"""Pauses of the garbage collector: what a parse makes stays, and to look through it again and again takes a fifth of
the time of a parse.

One invariant: whether Python collects by itself is as before afterwards.
"""

from __future__ import annotations

import gc


class NotCollecting:
    """`with NotCollecting():` Python looks for no garbage inside."""

    __slots__ = ("_was_collecting",)

    def __enter__(self) -> None:
        self._was_collecting = gc.isenabled()
        gc.disable()

    def __exit__(self, *_: object) -> None:
        if self._was_collecting:
            gc.enable()
