"""What a run adds to a failure rate."""

from __future__ import annotations

from typing import NamedTuple


class Amounts(NamedTuple):
    """What a run adds to a rate.

    Attributes:
        least, most: how often it happened, of which some may not count.
        exposure, longest: the time in which it might have, in µs, of which some may not count.
    """

    least: int
    most: int
    exposure: int
    longest: int

    def joined(self, other: Amounts) -> Amounts:
        """What it may be if it is one of the two."""
        return Amounts(
            min(self.least, other.least),
            max(self.most, other.most),
            min(self.exposure, other.exposure),
            max(self.longest, other.longest),
        )
