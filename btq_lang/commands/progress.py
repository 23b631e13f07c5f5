"""A line on standard error that says how far a long piece of work is, for people at a terminal."""

from __future__ import annotations

import sys
from time import monotonic

_PATIENCE = 0.5  # seconds before a person wonders
_PAUSE = 0.1  # seconds between two updates


class Progress:
    """Counts steps; shows nothing where nobody looks and where the work is done soon."""

    def __init__(self, total: int, verb: str) -> None:
        self._total = total
        self._verb = verb
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
        """One more is done."""
        self.reached(self._done + 1)

    def reached(self, done: int, more: str = "") -> None:
        """So many are done.

        Args:
            more: what else there is to say.
        """
        self._done = done
        if self._done < self._total and monotonic() >= self._next and sys.stderr.isatty():
            self._next = monotonic() + _PAUSE
            self._shown = True
            sys.stderr.write(f"\r\x1b[K{self._verb} {self._done} of {self._total} files{more}")
            sys.stderr.flush()
