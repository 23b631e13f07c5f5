"""The query store: under random graphs, circles and edits its answers are those of a store without a cache."""

from __future__ import annotations

from collections.abc import Mapping
from random import Random

import pytest
from seeds import seeds, share_of

from btq_lang.workspace.queries import Cancelled, Store, hub, input_of, on_circle

ON_CIRCLE = 7


class Graph:
    """A state: what each node adds, which nodes it asks, and which one instead of another after an odd sum."""

    def __init__(self, adds: Mapping[int, int], edges: Mapping[int, tuple[int, ...]], detours: Mapping[int, int]):
        self.adds, self.edges, self.detours = adds, edges, detours


@input_of(lambda node: node)
def adds(graph: Graph, node: int) -> int:
    return graph.adds[node]


@input_of(lambda node: node)
def edges(graph: Graph, node: int) -> tuple[int, ...]:
    return graph.edges[node]


@input_of(lambda node: node)
def detour(graph: Graph, node: int) -> int | None:
    return graph.detours.get(node)


RUNS: list[int] = []


@on_circle(ON_CIRCLE)
def total(store: Store[Graph], node: int) -> int:
    """Small numbers, so that many edits do not change them."""
    RUNS.append(node)
    found = store.ask(adds, node)
    asked = store.ask(edges, node)
    for at, other in enumerate(asked):
        instead = store.ask(detour, node)
        if at and instead is not None and found % 2:
            other = instead
        found += store.ask(total, other)
    return min(found, 5)


def afresh(graph: Graph) -> dict[int, int]:
    """The value of `total` for each node, by its definition alone: no detours."""
    reached = {node: set(of) for node, of in graph.edges.items()}
    for middle in graph.edges:
        for node in graph.edges:
            if middle in reached[node]:
                reached[node] |= reached[middle]
    found = {node: ON_CIRCLE for node in graph.edges if node in reached[node]}

    def value(node: int) -> int:
        if node not in found:
            found[node] = min(graph.adds[node] + sum(map(value, graph.edges[node])), 5)
        return found[node]

    return {node: value(node) for node in graph.edges}


def drawn(random: Random, count: int, *, circles: bool, detours: bool) -> Graph:
    return Graph(
        {node: random.randrange(3) for node in range(count)},
        {node: drawn_edges(random, node, count, circles) for node in range(count)},
        {node: random.randrange(node) for node in range(1, count) if detours and random.random() < 0.5},
    )


def drawn_edges(random: Random, node: int, count: int, circles: bool) -> tuple[int, ...]:
    below = count if circles else node
    return tuple(random.randrange(below) for _ in range(random.choice((0, 1, 1, 2, 3)) if below else 0))


def edited(random: Random, graph: Graph, *, circles: bool) -> tuple[Graph, list[int]]:
    nodes = [random.randrange(len(graph.adds)) for _ in range(random.choice((1, 1, 2)))]
    adds, edges = {**graph.adds}, {**graph.edges}
    for node in nodes:
        if random.random() < 0.5:
            adds[node] = random.randrange(3)
        else:
            edges[node] = drawn_edges(random, node, len(graph.adds), circles)
    return Graph(adds, edges, {**graph.detours}), nodes


@pytest.mark.parametrize("seed", share_of(seeds(300), 4))
def test_circles_and_edits(seed: int) -> None:
    random = Random(seed)
    graph = drawn(random, random.choice((2, 4, 8, 30)), circles=True, detours=False)
    store = Store(graph)
    for _ in range(20):
        truth = afresh(graph)
        for node in random.sample(range(len(truth)), random.randrange(1, len(truth) + 1)):
            assert store.ask(total, node) == truth[node]
        if random.random() < 0.2:
            store.pin(total, random.randrange(len(truth)))
            store.sweep(always=True)
        graph, touched = edited(random, graph, circles=True)
        store.advance(graph, touched)


@pytest.mark.parametrize("seed", share_of(seeds(300), 4))
def test_questions_that_depend_on_answers(seed: int) -> None:
    random = Random(seed)
    graph = drawn(random, random.choice((4, 8, 30)), circles=False, detours=True)
    store = Store(graph)
    for _ in range(20):
        for node in random.sample(range(len(graph.adds)), random.randrange(1, len(graph.adds) + 1)):
            assert store.ask(total, node) == Store(graph).ask(total, node) == slowly(graph, node)
        graph, touched = edited(random, graph, circles=False)
        store.advance(graph, touched)


@hub
def most(store: Store[Graph]) -> int:
    """Seldom changes."""
    return max(store.ask(total, node) for node in range(len(store.state.adds)))


def below_most(store: Store[Graph], node: int) -> int:
    RUNS.append(node)
    return store.ask(most) - store.ask(total, node)


@pytest.mark.parametrize("seed", share_of(seeds(100), 4))
def test_what_depends_on_a_hub(seed: int) -> None:
    random = Random(seed)
    graph = drawn(random, random.choice((2, 8, 30)), circles=True, detours=False)
    store = Store(graph)
    for _ in range(20):
        truth = afresh(graph)
        for node in random.sample(range(len(truth)), random.randrange(1, len(truth) + 1)):
            assert store.ask(below_most, node) == max(truth.values()) - truth[node]
        if random.random() < 0.2:
            store.pin(below_most, random.randrange(len(truth)))
            store.sweep(always=True)
        graph, touched = edited(random, graph, circles=True)
        store.advance(graph, touched)


def test_a_hub_that_stays_equal_leaves_its_dependents_valid() -> None:
    edges: dict[int, tuple[int, ...]] = {0: (), 1: (), 2: ()}
    store = Store(Graph({0: 1, 1: 3, 2: 0}, edges, {}))
    assert [store.ask(below_most, node) for node in edges] == [2, 0, 3]
    RUNS.clear()
    store.advance(Graph({0: 2, 1: 3, 2: 0}, edges, {}), [0])
    assert [store.ask(below_most, node) for node in edges] == [1, 0, 3]
    assert RUNS == [0, 0]  # `total` for the hub, and `below_most`
    store.advance(Graph({0: 2, 1: 4, 2: 0}, edges, {}), [1])
    RUNS.clear()
    assert [store.ask(below_most, node) for node in edges] == [2, 0, 4]
    assert RUNS == [1, 0, 1, 2]


@pytest.mark.parametrize("seed", share_of(seeds(100), 4))
def test_no_query_runs_unless_something_that_it_asked_differs(seed: int) -> None:
    random = Random(seed)
    graph = drawn(random, 30, circles=False, detours=False)
    store = Store(graph)
    seen: dict[int, object] = {}  # what each node depended on when it was computed last
    for _ in range(20):
        RUNS.clear()
        truth = afresh(graph)
        for node in graph.edges:
            store.ask(total, node)
        now = {
            node: (graph.adds[node], graph.edges[node], [truth[each] for each in of])
            for node, of in graph.edges.items()
        }
        assert sorted(RUNS) == [node for node in graph.edges if seen.get(node) != now[node]]
        seen.update(now)
        graph, touched = edited(random, graph, circles=False)
        store.advance(graph, touched)


def test_what_differs_only_between_two_questions_invalidates_nothing() -> None:
    edges: dict[int, tuple[int, ...]] = {0: (1, 2), 1: (), 2: ()}
    store = Store(Graph({0: 1, 1: 1, 2: 0}, edges, {}))
    assert store.ask(total, 0) == 2
    RUNS.clear()
    store.advance(Graph({0: 1, 1: 2, 2: 0}, edges, {}), [1])
    store.advance(Graph({0: 1, 1: 1, 2: 1}, edges, {}), [1, 2])
    assert store.ask(total, 0) == 3
    assert RUNS == [2, 0]


@pytest.mark.parametrize("is_circle", [False, True])
def test_no_chain_is_too_long(is_circle: bool) -> None:
    count = 3_000
    chain = {node: (node + 1,) for node in range(count)}
    adds = {**dict.fromkeys(range(count), 0), count: 1}
    graph = Graph(adds, {**chain, count: (700,) if is_circle else ()}, {})
    store = Store(graph)
    assert store.ask(total, 0) == (5 if is_circle else 1)
    assert [store.ask(total, node) for node in (1, 699, 700, 2_000, count)] == [5, 5, 7, 7, 7] if is_circle else [1] * 5
    store.advance(Graph({**graph.adds, count: 2}, {**graph.edges, count: ()}, {}), [count])
    assert store.ask(total, 0) == 2


def test_a_wide_fan_at_the_end_of_a_long_chain() -> None:
    chain = {node: (node + 1,) for node in range(39)}
    fan = {39: tuple(range(40, 540)), **{node: (node + 500,) for node in range(40, 540)}}
    graph = Graph(dict.fromkeys(range(1_040), 0), {**chain, **fan, **dict.fromkeys(range(540, 1040), ())}, {})
    RUNS.clear()
    assert Store(graph).ask(total, 0) == 0
    assert len(RUNS) < 1_100


def test_a_circle_without_an_answer_is_a_mistake_of_its_owner() -> None:
    def naive(store: Store[None], node: int) -> int:
        return store.ask(naive, node)

    with pytest.raises(LookupError, match="naive reaches itself, and declares no answer for that"):
        Store(None).ask(naive, 1)


def test_nothing_is_lost_when_an_answer_is_not_wanted_any_more() -> None:
    graph = Graph({0: 1, 1: 1, 2: 1}, {0: (1, 2), 1: (), 2: ()}, {})
    store = Store(graph)
    left = [3]

    def is_over() -> bool:
        left[0] -= 1
        return left[0] == 0

    store.is_cancelled = is_over
    RUNS.clear()
    with pytest.raises(Cancelled):
        store.ask(total, 0)
    assert RUNS == [0, 1]
    assert store.ask(total, 0) == 3
    assert RUNS == [0, 1, 0, 2]


def test_an_error_in_a_query_leaves_the_store_whole() -> None:
    graph = Graph({0: 0, 1: 0}, {0: (1,), 1: (9,)}, {})
    store = Store(graph)
    with pytest.raises(KeyError):
        store.ask(total, 0)
    store.advance(Graph({0: 0, 1: 2}, {0: (1,), 1: ()}, {}), [1])
    assert store.ask(total, 0) == 2


def test_what_nothing_rests_on_is_forgotten() -> None:
    graph = Graph(dict.fromkeys(range(4), 0), {0: (1,), 1: (), 2: (3,), 3: (2,)}, {})
    store = Store(graph)
    store.pin(total, 0)
    for node in graph.edges:
        store.ask(total, node)
    store.sweep(always=True)
    RUNS.clear()
    for node in graph.edges:
        store.ask(total, node)
    assert sorted(RUNS) == [2, 3]  # a circle, too


def slowly(graph: Graph, node: int) -> int:
    found = graph.adds[node]
    for at, other in enumerate(graph.edges[node]):
        if at and node in graph.detours and found % 2:
            other = graph.detours[node]
        found += slowly(graph, other)
    return min(found, 5)
