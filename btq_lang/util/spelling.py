"""Near names: what an unknown word was probably meant to be.

One invariant: the answer depends on the word and on the set of candidates, never on their order.  It does not know what
the candidates are: a caller that wants names of one kind passes only those.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import lru_cache
from typing import Final


def near(word: str, candidates: Iterable[str], limit: int = 3) -> tuple[str, ...]:
    """The candidates nearest to `word`, best first: at most `limit`, without wild guesses.

    One edit is allowed for every three letters of the word, three in all, and at most one more than the best candidate
    needs.  A candidate that differs in case alone leaves no room for any other; the word itself is never an answer.
    """
    folded, letters = word.casefold(), _letters(word)
    cutoff = min(len(folded) // 3, 3)
    same_letters: list[tuple[int, str]] = []
    ranked: list[tuple[int, int, str]] = []
    for candidate in set(candidates):
        # This rejects most candidates cheaply: an edit mends at most one letter that only one of the two has.
        others = _letters(candidate)
        if (letters & ~others).bit_count() > cutoff or (others & ~letters).bit_count() > cutoff or candidate == word:
            continue
        other = candidate.casefold()
        if other == folded:
            same_letters.append((distance(word, candidate), candidate))
        elif abs(len(other) - len(folded)) <= cutoff and (edits := distance(folded, other, cutoff)) <= cutoff:
            ranked.append((edits, distance(word, candidate), candidate))
    if same_letters:
        return tuple(name for _, name in sorted(same_letters))[:limit]
    ranked.sort()
    return tuple(name for edits, _, name in ranked if edits <= ranked[0][0] + 1)[:limit]


def long_words(name: str) -> set[str]:
    """The words of more than three letters in a name of several: `person` and `near` of `person_near`."""
    return {word for word in re.split("[_-]", name.casefold()) if len(word) > 3}


def without_digits(word: str) -> str:
    """The rest of a numbered name: names that differ in it alone are a series, not a misspelling."""
    return "".join(letter for letter in word if not letter.isdigit())


def did_you_mean(names: Iterable[str]) -> str:
    """`; did you mean …?` for the end of a message; empty without names."""
    shown = [f"`{name}`" for name in names]
    if not shown:
        return ""
    return f"; did you mean {' or '.join(filter(None, (', '.join(shown[:-1]), shown[-1])))}?"


def distance(a: str, b: str, enough: int | None = None) -> int:
    """The number of letters to insert, delete, replace or swap with their neighbour to turn `a` into `b`.

    This is the optimal string alignment form of the Damerau-Levenshtein distance: no piece is edited twice.

    Args:
        enough: stop counting when the distance is surely larger; the result is then some larger number.
    """
    # Common prefixes and suffixes cost nothing; names in one file often have long ones: `requirement_17`.
    start = 0
    for left, right in zip(a, b, strict=False):
        if left != right:
            break
        start += 1
    end_a, end_b = len(a), len(b)
    while end_a > start < end_b and a[end_a - 1] == b[end_b - 1]:
        end_a -= 1
        end_b -= 1
    a, b = a[start:end_a], b[start:end_b]
    band = max(len(a), len(b)) if enough is None else enough  # cells further off the diagonal need more edits
    before: list[int] = []
    last = list(range(len(b) + 1))
    for i, left in enumerate(a, 1):
        row = [band + 1] * (len(b) + 1)
        row[0] = i
        for j in range(max(1, i - band), min(len(b), i + band) + 1):
            right = b[j - 1]
            edits = min(last[j] + 1, row[j - 1] + 1, last[j - 1] + (left != right))
            if i > 1 and j > 1 and left == b[j - 2] and a[i - 2] == right:
                edits = min(edits, before[j - 2] + 1)
            row[j] = edits
        # A swap reaches back two rows, so two consecutive rows must be too far away.
        if enough is not None and min(row) > enough and min(last) > enough:
            return enough + 1
        before, last = last, row
    return last[-1]


@lru_cache(10_000)
def _letters(word: str) -> int:
    """A bit set of a word's letters, ignoring case; some letters share a bit."""
    bits = 0
    for letter in set(word.casefold()):
        bits |= 1 << ord(letter) % _BITS
    return bits


_BITS: Final = 39  # with so many bits no ASCII letter shares one with a digit
