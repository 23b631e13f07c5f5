"""Streams of random numbers: uniform, independent, and the same in every process."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterable
from itertools import pairwise, product
from math import sqrt

import pytest

from btq_lang.prediction.streams import Stream

DRAWS = 20_000
WAYS: dict[str, Callable[[int], float]] = {
    "run": lambda number: Stream(1, "Pick", number).activation(0).next(),
    "activation": lambda number: Stream(1, "Pick", 0).activation(number).next(),
    "seed": lambda number: Stream(number, "Pick", 0).activation(0).next(),
    "skill": lambda number: Stream(1, f"Main/{number}", 0).activation(0).next(),
}


def within_4_sigma(count: int, trials: int, p: float) -> bool:
    return abs(count - trials * p) <= 4 * sqrt(trials * p * (1 - p))


def successive() -> list[float]:
    stream = Stream(1, "Pick", 0).activation(0)
    return [stream.next() for _ in range(DRAWS)]


def series(way: str) -> list[float]:
    return successive() if way == "next" else [WAYS[way](number) for number in range(DRAWS)]


def are_equidistributed(values: Iterable[float], cells: int) -> bool:
    counts = [0] * cells
    for value in values:
        counts[int(value * cells)] += 1
    return all(within_4_sigma(count, sum(counts), 1 / cells) for count in counts)


@pytest.mark.parametrize("way", ["next", *WAYS])
def test_the_numbers_are_uniform_whatever_changes(way: str) -> None:
    values = series(way)
    assert min(values) > 0
    assert max(values) < 1
    assert len(set(values)) == DRAWS
    assert are_equidistributed(values, 20)


@pytest.mark.parametrize("way", ["next", *WAYS])
def test_neighbors_are_independent(way: str) -> None:
    """Pairs of neighbors fill the cells of a square alike."""
    cells = [(4 * int(first * 4) + int(second * 4)) / 16 for first, second in pairwise(series(way))]
    assert are_equidistributed(cells, 16)


def test_streams_are_independent_of_each_other() -> None:
    """Of two runs, of two skills and of two activations, number by number."""
    starts = [Stream(1, skill, run).activation(number) for skill, run, number in product("AB", (0, 1), (0, 1))]
    rows = [[stream.next() for stream in starts] for _ in range(5_000)]
    for left in range(len(starts)):
        for right in range(left):
            both = sum(row[left] < 0.5 and row[right] < 0.5 for row in rows)
            assert within_4_sigma(both, len(rows), 0.25)


def test_an_activation_does_not_shift_another() -> None:
    run = Stream(7, "Main/Pick", 3)
    expected = run.activation(1).next()
    run.activation(0).next()
    assert run.activation(1).next() == expected


@pytest.mark.parametrize("hash_seed", ["0", "1"])
def test_every_process_draws_the_same(hash_seed: str) -> None:
    program = "from btq_lang.prediction.streams import Stream; print(Stream(1, 'Pick', 8).activation(2).next())"
    run = subprocess.run(
        [sys.executable, "-c", program],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, "PYTHONHASHSEED": hash_seed},
    )
    assert float(run.stdout) == Stream(1, "Pick", 8).activation(2).next() == 0.8320384422079744
