"""Random numbers that belong to an activation: other activations, skills and runs do not shift them.

So a change of one skill leaves what all others draw as it was.  Source: G. L. Steele, D. Lea, C. H. Flood, Fast
splittable pseudorandom number generators, OOPSLA 2014 (SplitMix64).
"""

from __future__ import annotations

from functools import lru_cache
from hashlib import blake2b
from typing import Final


class Stream:
    """Uniform numbers in the open interval (0, 1), which follow from a seed, a name, a run and an activation."""

    __slots__ = ("_state",)

    def __init__(self, seed: int, skill: str, run: int) -> None:
        """Begin the stream of a run; `skill`: a name, as the path of its node."""
        self._state = _mixed(_hashed(seed, skill) ^ _mixed(run * _STEP & _MASK))

    def activation(self, number: int) -> Stream:
        """The stream of an activation of the run, by its number."""
        stream = object.__new__(Stream)
        stream._state = _mixed(self._state ^ _mixed((number + 1) * _STEP & _MASK))
        return stream

    def copy(self) -> Stream:
        """A stream with the same numbers from here on."""
        other = object.__new__(Stream)
        other._state = self._state
        return other

    def next(self) -> float:
        """The next number."""
        self._state = (self._state + _STEP) & _MASK
        return ((_mixed(self._state) >> _UNUSED) + 0.5) * _SCALE


@lru_cache(1024)
def _hashed(seed: int, skill: str) -> int:
    return int.from_bytes(blake2b(f"{seed}\0{skill}".encode(), digest_size=8).digest(), "little")


def _mixed(bits: int) -> int:
    """A bijection of 64 bits in which each bit of the result depends on all of `bits`."""
    bits = (bits ^ (bits >> 30)) * 0xBF58476D1CE4E5B9 & _MASK
    bits = (bits ^ (bits >> 27)) * 0x94D049BB133111EB & _MASK
    return bits ^ (bits >> 31)


_MASK: Final = (1 << 64) - 1
_STEP: Final = 0x9E3779B97F4A7C15  # odd, near 2 to the 64th by the golden ratio: multiples are far apart
_UNUSED: Final = 12  # bits: with 52 of them and a half no result rounds to 0 or 1
_SCALE: Final = 2.0**-52
