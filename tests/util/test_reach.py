"""What reaches itself, on graphs by chance."""

from __future__ import annotations

import random

from btq_lang.util.reach import knots, reached


def test_knots_are_those_that_reach_each_other() -> None:
    chance = random.Random(1)
    sizes: set[int] = set()
    for _ in range(500):
        names = range(chance.randint(1, 8))
        # One name more than there are keys: what is no key is left out.
        graph = {name: chance.choices(range(len(names) + 1), k=chance.randint(0, 3)) for name in names}
        behind = {name: {*reached(graph[name], {len(names): [], **graph}.__getitem__)} for name in names}
        expected = {
            frozenset(other for other in names if other in behind[name] and name in behind[other])
            for name in names
            if name in behind[name]
        }
        found = [frozenset(knot) for knot in knots(graph)]
        assert len(found) == len(expected)
        assert {*found} == expected, graph
        sizes.update(map(len, found))
    assert sizes == {1, 2, 3, 4, 5, 6, 7, 8}


def test_a_long_circle_is_no_deep_call() -> None:
    count = 10_000
    assert [*knots({number: ((number + 1) % count,) for number in range(count)})] == [{*range(count)}]
