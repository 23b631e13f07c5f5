"""Failure rates on both sides: how many failures, and in how long.

One invariant: where it is not known whether a failure or some time counts, whatever makes the difference smaller does.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from btq_lang.evidence.compare.chance import Exposed, exact_rates, expected_rates
from btq_lang.evidence.compare.model import Key
from btq_lang.util.grouping import grouped
from btq_lang.util.record import Record


class ComparedRate(Record):
    """The failures of a clause about a failure rate.

    Attributes:
        runs: how many of each side add to it.
        failures, seconds: of each side, all together.
        p: how likely such a difference is by chance.
    """

    key: Key
    runs: tuple[int, int]
    failures: tuple[int, int]
    seconds: tuple[float, float]
    p: float


def compared_rates(rows: Iterable[Mapping[str, Any]], sides: tuple[str, str]) -> list[ComparedRate]:
    """The rates that both sides have, as far as anything failed.

    Args:
        rows: the answer to `questions.RATES`.
    """
    rates = []
    for key, of_key in grouped((Key(row["requirement"], row["clause"], row["node"]), row) for row in rows).items():
        by_stratum = grouped((row["stratum"], row) for row in of_key).values()
        strata = [sorted(pair, key=lambda row: sides.index(row["side"])) for pair in by_stratum if len(pair) == 2]
        counts = [row for pair in strata for row in pair]
        if any(row["most"] for row in counts) and all(row["seconds"] > 0 for row in counts):
            rates.append(_compared(key, strata))
    return rates


def _compared(key: Key, strata: Sequence[Sequence[Mapping[str, Any]]]) -> ComparedRate:
    """The rate, by the one of both ways to count what may count that differs less."""
    ways = [
        [(_exposed(first, is_first_more), _exposed(second, not is_first_more)) for first, second in strata]
        for is_first_more in (True, False)
    ]
    p = max(map(exact_rates, ways))
    if len({_is_more(way) for way in ways}) > 1:
        p = 1.0
    (failed, before), (other, after) = (
        (sum(number for number, _ in side), sum(seconds for _, seconds in side)) for side in zip(*ways[0], strict=True)
    )
    # Robots that fail more often may have run more on one side: then all together differ the other way.
    if (other / after > failed / before) != _is_more(ways[0]):
        p = 1.0
    first, second = (sum(int(row["runs"]) for row in side) for side in zip(*strata, strict=True))
    return ComparedRate(key, (first, second), (failed, other), (before, after), p)


def _exposed(row: Mapping[str, Any], is_more: bool) -> Exposed:
    """The failures and the time with the highest rate, or with the lowest."""
    return (int(row["most"]), row["seconds"]) if is_more else (int(row["least"]), row["longest"])


def _is_more(strata: Sequence[tuple[Exposed, Exposed]]) -> bool:
    """Whether the second side fails more often, by stratum."""
    return sum(failed for (failed, _), _ in strata) < expected_rates(strata)
