"""Every way in which a computation can go that asks for choices: it runs again and again, with other choices."""

from __future__ import annotations

from collections.abc import Sequence


class Choices:
    """The choices of one run after another, in a fixed order: first 0 everywhere, then the last one is raised first.

    Attributes:
        log: what was chosen in this run; besides numbers, whatever the computation adds.
    """

    def __init__(self, given: Sequence[int] = ()) -> None:
        """Choices whose first ones are given."""
        self.log: list[object] = []
        self._chosen = list(given)
        self._counts: list[int] = [0] * len(given)  # a given choice is not raised
        self._position = 0

    def choose(self, count: int) -> int:
        """A number below `count`, which is added to the log; with one possibility, nothing is."""
        if count == 1:
            return 0
        chosen = self.pick(count)
        self.log.append(chosen)
        return chosen

    def pick(self, count: int) -> int:
        """A number below `count`, which is not added to the log."""
        if count == 1:
            return 0
        if self._position == len(self._chosen):
            self._chosen.append(0)
            self._counts.append(count)
        self._position += 1
        return self._chosen[self._position - 1]

    def next_run(self) -> bool:
        """Begin another run; False: there is none."""
        del self._chosen[self._position :], self._counts[self._position :]
        while self._chosen and self._chosen[-1] + 1 >= self._counts[-1]:
            self._chosen.pop()
            self._counts.pop()
        self._position = 0
        self.log = []
        if not self._chosen:
            return False
        self._chosen[-1] += 1
        return True
