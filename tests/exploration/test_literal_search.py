"""The search against the slow one, on drawn trees."""

from __future__ import annotations

from random import Random

import pytest
from drawn_trees import drawn
from literal_search import Change, TooMany, search
from seeds import seeds

from btq_lang.btcpp.reader import read
from btq_lang.exploration.answers import full_runs
from btq_lang.exploration.leaves import LeafKind
from btq_lang.exploration.opened import Opened
from btq_lang.exploration.outcomes import Happened
from btq_lang.exploration.resuming import last_count
from btq_lang.exploration.search import Search, SearchBudget
from btq_lang.exploration.witness import replay
from btq_lang.simulator.errors import EngineError, NotModelled
from btq_lang.simulator.nodes import SimulatedNode
from btq_lang.simulator.programs import KnownProgram
from btq_lang.simulator.versions import Dialect

KINDS = {
    "Act": LeafKind(is_action=True, is_declared=True, reads=("in",), writes=(("out", "int"),)),
    "Cond": LeafKind(is_condition=True, is_declared=True, writes=(("out", "double"),)),
}
MOST = 60


def opened(xml: str, version: str) -> Opened:
    document = read(xml).document
    assert document is not None
    return Opened([document], "Main", KnownProgram(Dialect(version)), KINDS)


class Seen:
    """Writes down all changes; of a pair, ends the search when the first comes before the second."""

    def __init__(self, tree: Opened, pair: tuple[Change, Change] | None = None) -> None:
        self.tree = tree
        self.pair = pair
        self.changes: set[Change] = set()

    def begin(self) -> object:
        return False

    def changed(self, node: SimulatedNode, before: int, after: int) -> None:
        change = (node.uid, before, after)
        self.changes.add(change)
        if self.pair is not None:
            if change == self.pair[0] and not self.tree.snapshots.watched:
                raise Happened
            if change == self.pair[1]:
                self.tree.snapshots.watched = True

    def unset_read(self, node: SimulatedNode, key: str) -> None:
        pass


@pytest.mark.parametrize("seed", seeds(500))
def test_same_states_changes_and_ends(seed: int) -> None:
    random = Random(seed)
    xml, version = drawn(random), random.choice(("4.6", "4.10"))
    try:
        tree = opened(xml, version)
    except (EngineError, NotModelled):
        return
    leaves = random.choice((frozenset[int](), full_runs(tree), frozenset(node.uid for node in tree.custom)))
    try:
        found = search(lambda: opened(xml, version), leaves, MOST)
    except TooMany:
        return
    watch = Seen(tree)
    tree.begin(watch, leaves)
    result = Search(tree.snapshots, SearchBudget(10 * MOST)).run()
    assert watch.changes == found.changes
    assert {(end.result, end.message) for end in result.ends} == found.ends
    assert result.states == found.states
    for end, ways in result.ends.items():
        last = replay(tree, None, leaves, ways)[-1]
        assert last.result == ("", "", "succeeds", "fails", "is skipped", "", "throws", "is not known")[end.result]
    if found.changes:
        changes = sorted(found.changes)
        pair = random.choice(changes), random.choice(changes)
        asked = Seen(tree, pair)
        tree.begin(asked, leaves)
        answer = Search(tree.snapshots, SearchBudget(10 * MOST)).run()
        orders = search(lambda: opened(xml, version), leaves, 10 * MOST, pair).orders
        assert (answer.way is not None) == (pair in orders)
        if answer.way is not None:
            assert replay(tree, Seen(tree, pair), leaves, answer.way)[-1].result == ""


@pytest.mark.parametrize("seed", seeds(300))
def test_all_that_happens_also_happens_with_any_number_of_attempts(seed: int) -> None:
    random = Random(seed)
    xml, version = drawn(random), random.choice(("4.6", "4.10"))
    try:
        tree = opened(xml, version)
    except (EngineError, NotModelled):
        return
    counted, uncounted = Seen(tree), Seen(tree)
    tree.begin(counted, full_runs(tree))
    exact = Search(tree.snapshots, SearchBudget(1_000)).run()
    tree.begin(uncounted, full_runs(tree))
    rough = Search(tree.snapshots, SearchBudget(1_000), counts=False).run()
    if rough.is_closed:
        assert counted.changes <= uncounted.changes
        assert {(end.result, end.message) for end in exact.ends} <= {(end.result, end.message) for end in rough.ends}
        changes = sorted(counted.changes)
        for pair in [(random.choice(changes), random.choice(changes)) for _ in changes[:5]]:
            ways = []
            for counts in (True, False):
                tree.begin(Seen(tree, pair), full_runs(tree))
                ways.append(Search(tree.snapshots, SearchBudget(1_000), counts=counts).run().way)
            assert ways[0] is None or ways[1] is not None, pair
    if not any(map(last_count, tree.machine.nodes)) and exact.is_closed:
        assert (rough.states, rough.is_closed) == (exact.states, True)
