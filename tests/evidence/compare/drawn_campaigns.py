"""Campaigns that are drawn, as a store has them: a tree of 75 nodes, a root, 15 sequences and 59 leaves.

A run goes through the tree twice. Each leaf has a duration of its own, between 20 ms and 20 s, alike on a logarithmic
scale, and two ways to do what it does, the longer of which takes 1.2 to 1.5 times as long: an activation takes each
half of the time, and with 20 % the second one of a run takes the way of the first. Then it takes more or less by 5 %,
and all of a run by 5 % (standard deviations of the logarithm). One leaf in six fails in 5 % of its activations, which
stops nothing.
"""

from __future__ import annotations

import csv
import random
from collections.abc import Sequence
from math import exp, log
from pathlib import Path
from typing import NamedTuple

from btq_lang.evidence.store import engine
from btq_lang.evidence.store.rows import file_of
from btq_lang.evidence.store.tables import ROWS

SEQUENCES = 15
LEAVES = 59
ROUNDS = 2


class Activation(NamedTuple):
    """What a node did; times in µs."""

    uid: int
    node: str
    is_leaf: bool
    begin: int
    end: int
    outcome: str


class Tree:
    """Leaves with their durations, drawn."""

    def __init__(self, chance: random.Random) -> None:
        self.lengths = [exp(chance.uniform(log(0.02), log(20))) for _ in range(LEAVES)]
        self.ways = [chance.uniform(1.2, 1.5) for _ in range(LEAVES)]

    def run(self, chance: random.Random, slower: int | None = None, factor: float = 1.2) -> list[Activation]:
        """A run; one of the leaves may take longer by a factor."""
        pace = exp(chance.gauss(0, 0.05))
        was_long: dict[int, bool] = {}
        found: list[Activation] = []
        now = 0
        for _ in range(ROUNDS):
            for sequence in range(SEQUENCES):
                begin = now
                for leaf in range(sequence, LEAVES, SEQUENCES):
                    is_long = was_long.get(leaf) if chance.random() < 0.2 else None
                    was_long[leaf] = is_long = chance.random() < 0.5 if is_long is None else is_long
                    seconds = (
                        self.lengths[leaf] * pace * exp(chance.gauss(0, 0.05)) * (self.ways[leaf] if is_long else 1)
                    )
                    end = now + round(seconds * 1e6 * (factor if leaf == slower else 1)) + 20
                    outcome = "failed" if leaf % 6 == 0 and chance.random() < 0.05 else "succeeded"
                    found.append(Activation(100 + leaf, f"Leaf{leaf}", True, now, end, outcome))
                    now = end
                found.append(Activation(10 + sequence, f"Sequence{sequence}", False, begin, now + 10, "succeeded"))
                now += 20
        return [*found, Activation(1, "Root", False, 0, now, "succeeded")]


def keep(store: Path, label: str, runs: Sequence[Sequence[Activation]], robot: str = "") -> None:
    """Keep runs as one log, without requirements."""
    folder = store / f"{len([*store.glob('*')]):064x}"
    folder.mkdir(parents=True)
    tables: dict[str, list[tuple[object, ...]]] = {name: [] for name in ROWS}
    of = ("main", robot)
    start = 1_795_209_740_000_000
    for number, run in enumerate(runs, start=1):
        root = run[-1]
        tables["runs"].append((*of, number, start, start + root.end, "succeeded", len(run), 0, 0, None, "", 75, 75))
        for each in run:
            begin, end = start + each.begin, start + each.end
            row = (each.uid, each.node, each.node, "", each.is_leaf, begin, end, each.outcome, "exact", begin)
            tables["activations"].append((*of, number, *row))
        start += root.end + 1_000_000
    for name, rows in tables.items():
        with open(file_of(str(folder), name), "w", encoding="utf-8", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows(rows)
    engine.write_parquet(str(folder), {"log": folder.name, "label": label, "source": "log"})
