"""The slow search: every tick of every history is run anew from the start, with every choice, and nothing remembered.

It shares the free leaves with the package, and neither its search nor its snapshots.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence

from btq_lang.exploration.opened import Opened
from btq_lang.exploration.values import FreeValue
from btq_lang.simulator.errors import EngineError, NotModelled
from btq_lang.simulator.nodes import RUNNING, SimulatedNode
from btq_lang.simulator.ticking import execute_tick
from btq_lang.simulator.timers import NEVER, fire

Change = tuple[int, int, int]  # the number of a node, its status before and after


class TooMany(Exception):
    """There are more states than were to be searched."""


class Told:
    """Choices: first those told, then always the first possibility."""

    def __init__(self, told: Sequence[int]) -> None:
        self.told = list(told)
        self.counts: list[int] = []

    def choose(self, count: int) -> int:
        if count == 1:
            return 0
        self.counts.append(count)
        at = len(self.counts) - 1
        if at == len(self.told):
            self.told.append(0)
        return self.told[at]

    def others(self) -> Iterator[list[int]]:
        """What to tell instead, where this run had a choice after what it was told first."""
        for at, count in enumerate(self.counts):
            for other in range(self.told[at] + 1, count):
                yield [*self.told[:at], other]


class Changes:
    """Writes down the changes of one tick."""

    def __init__(self) -> None:
        self.all: list[Change] = []

    def begin(self) -> object:
        return None

    def changed(self, node: SimulatedNode, before: int, after: int) -> None:
        self.all.append((node.uid, before, after))

    def unset_read(self, node: SimulatedNode, key: str) -> None:
        pass


class Found:
    """All that a slow search has seen."""

    def __init__(self) -> None:
        self.changes: set[Change] = set()
        self.ends: set[tuple[int, str]] = set()
        self.states = 0
        self.orders: set[tuple[Change, Change]] = set()  # the second one had not happened when the first one did


def search(
    opened: Callable[[], Opened], may_run: Collection[int], most: int, pair: tuple[Change, Change] | None = None
) -> Found:
    """Search all states; of a pair of changes, whether the first can happen before the second.

    Raises:
        TooMany: more than `most`.
    """
    found = Found()
    histories: list[tuple[list[list[int]], bool]] = [([], False)]
    seen: set[object] = set()
    for history, had_second in histories:
        found.states += 1
        waiting: list[list[int]] = [[]]
        while waiting:
            tree = opened()
            changes = Changes()
            tree.begin(changes, may_run)
            for way in history:
                _tick(tree, Told(way))
            changes.all = []
            told = Told(waiting.pop())
            first = len(told.told)
            result, message = _tick(tree, told)
            waiting += [other for other in told.others() if len(other) > first]
            found.changes.update(changes.all)
            has_second = had_second
            for change in changes.all:
                if pair is not None:
                    if change == pair[0] and not has_second:
                        found.orders.add(pair)
                    has_second = has_second or change == pair[1]
            if result != RUNNING:
                found.ends.add((result, message))
                continue
            state = (_state(tree), has_second)
            if state not in seen:
                seen.add(state)
                histories.append(([*history, told.told], has_second))
                if len(histories) > most:
                    raise TooMany
    return found


def _tick(tree: Opened, told: Told) -> tuple[int, str]:
    tree.snapshots.choices = told  # type: ignore[assignment]  # it chooses likewise
    tree.machine.is_woken = False
    try:
        for node in reversed(tree.machine.timed):
            if node.due != NEVER and told.choose(2):
                fire(tree.machine, node)
        return execute_tick(tree.machine, tree.machine.root), ""
    except EngineError as error:
        return 6, str(error)
    except NotModelled as error:
        return 7, str(error)


def _state(tree: Opened) -> object:
    """What the next tick depends on; values of entries are named by the first entry that has them."""
    board = tree.machine.root.board.root
    names: dict[int, str] = {}
    entries: list[object] = []
    for key in sorted(board.entries):
        value = board.entries[key].value
        if isinstance(value, FreeValue):
            domain = tree.snapshots.domains[value.number]
            name = names.setdefault(value.number, key)
            entries.append((key, repr(domain.fixed)) if domain.fixed is not None else (key, name, repr(domain)))
        else:
            entries.append((key, repr(value)))
    return tuple(node.memory() for node in tree.machine.nodes), tuple(entries)
