"""A line on standard error that shows the progress of long work, for people at a terminal."""

from __future__ import annotations

import sys
from time import monotonic

_PATIENCE = 0.5  # seconds before progress is shown
_PAUSE = 0.1  # seconds between two updates


class Progress:
    """Counts steps; shows nothing without a terminal or if the work ends soon."""

    def __init__(self, total: int, verb: str, what: str = "files") -> None:
        self._total = total
        self._verb = verb
        self._what = what
        self._done = 0
        self._shown = False
        self._next = monotonic() + _PATIENCE

    def __enter__(self) -> Progress:
        return self

    def __exit__(self, *_: object) -> None:
        if self._shown:
            sys.stderr.write("\r\x1b[K")
            sys.stderr.flush()

    def step(self) -> None:
        """Count one more step."""
        self.reached(self._done + 1)

    def reached(self, steps: int, more: str = "") -> None:
        """Set the number of steps done."""
        self._done = steps
        if self._done < self._total and monotonic() >= self._next and sys.stderr.isatty():
            self._next = monotonic() + _PAUSE
            self._shown = True
            sys.stderr.write(f"\r\x1b[K{self._verb} {self._done} of {self._total} {self._what}{more}")
            sys.stderr.flush()
