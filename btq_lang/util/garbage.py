"""Without collecting garbage where there is none: what a parse makes stays, and looking through it again and again is
a fifth of its time.

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
