"""Who watches a search for what was asked.

One invariant: what a watch remembers is part of the state, so that a search tells apart what differs in it only.
Conditions are looked at whenever a status changes.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import Final

from btq_lang.exploration.outcomes import Happened
from btq_lang.exploration.questions import Asked, Holds, Order, Question, ReadsUnset
from btq_lang.exploration.snapshots import Snapshots
from btq_lang.requirements.entries import key_of
from btq_lang.simulator.blackboard import Unknown, Value
from btq_lang.simulator.errors import EngineError
from btq_lang.simulator.nodes import FAILURE, IDLE, RUNNING, SUCCESS, SimulatedNode
from btq_lang.simulator.scripts import as_number, compared
from btq_lang.syntax.tokens import BRACED, NAME, STRING
from btq_lang.syntax.tree import (
    AnyEvent,
    Binary,
    Comparison,
    Condition,
    Event,
    Negative,
    NodeRuns,
    Not,
    Operand,
    Path,
)


class Unasked(Exception):
    """A question cannot be asked of a tree; the message says why."""


class Asking:
    """Watches for what a question asks.

    Attributes:
        tracked: the nodes of whose statuses it asks at any time, by number.
    """

    def __init__(
        self, question: Question, snapshots: Snapshots, uids: Callable[[Path | None], Collection[int]]
    ) -> None:
        """Resolve the question.

        Args:
            uids: the numbers of the nodes that a path names, of the root for None; raises Unasked if there are none.

        Raises:
            Unasked: it names what the tree does not have.
        """
        self._snapshots: Final = snapshots
        self._uids: Final = uids
        self._asked: Final[Asked] = question.asked
        self._nodes: Final = {node.uid: node for node in snapshots.machine.nodes}
        self._unset: Final = frozenset(uids(question.asked.path)) if isinstance(question.asked, ReadsUnset) else ()
        self.tracked: Final[dict[int, SimulatedNode]] = {}
        self._tests = 0
        asked = question.asked
        events = [each for each in (asked.event, asked.other) if each is not None] if isinstance(asked, Order) else []
        self._events: Final = [self._event(event) for event in events]
        self._condition: Final = self._test(asked.condition) if isinstance(asked, Holds) else None

    def begin(self) -> object:
        """Nothing has happened: the other event, and the conditions that were true when they were looked at."""
        return False, frozenset()

    def changed(self, node: SimulatedNode, before: int, after: int) -> None:
        """Whether that is what was asked."""
        if self._condition is not None:
            if self._condition():
                raise Happened
            return
        if not self._events:
            return
        has_other, held = self._snapshots.watched
        first = self._events[0]
        occurs, held = first.occurs(node, before, after, held)
        if len(self._events) == 1:
            self._snapshots.watched = False, held
            if occurs:
                raise Happened
            return
        other_occurs, held = self._events[1].occurs(node, before, after, held)
        assert isinstance(self._asked, Order)
        if occurs and has_other == (self._asked.word == "after"):
            raise Happened
        self._snapshots.watched = has_other or other_occurs, held

    def unset_read(self, node: SimulatedNode, key: str) -> None:
        """Whether that is what was asked."""
        if isinstance(self._asked, ReadsUnset) and node.uid in self._unset and key == self._asked.key:
            raise Happened

    # ---- conditions ----

    def _event(self, event: Event | AnyEvent) -> _Watched:
        atoms = [atom for atom in event.atoms if atom is not None]
        statuses = [(frozenset(self._uids(atom.path)), atom.happening) for atom in atoms if atom.condition is None]
        tests: list[tuple[int, _Test]] = []
        for atom in atoms:
            if atom.condition is not None:
                self._tests += 1
                tests.append((self._tests, self._test(atom.condition)))
        return _Watched(statuses, tests)

    def _test(self, condition: Condition) -> _Test:
        """A function that says whether a condition holds now."""
        if isinstance(condition, NodeRuns):
            nodes = [self._nodes[uid] for uid in sorted(self._uids(condition.path))]
            self.tracked.update({node.uid: node for node in nodes})
            return lambda: any(node.status == RUNNING for node in nodes)
        if isinstance(condition, Not):
            operand = self._test(condition.operand)
            return lambda: not operand()
        if isinstance(condition, Binary) and condition.operator in ("and", "or"):
            left, right = self._test(condition.left), self._test(condition.right)
            if condition.operator == "and":
                return lambda: left() and right()
            return lambda: left() or right()
        if isinstance(condition, Comparison):
            values = [self._value(each) for each in condition.operands]
            steps = list(zip(values, condition.operators, values[1:], strict=False))
            return lambda: all(_holds(left(), operator, right()) for left, operator, right in steps)
        value = self._value(condition)
        return lambda: _is_true(value())

    def _value(self, operand: Condition) -> Callable[[], Value | None]:
        if isinstance(operand, Negative):
            inner = self._value(operand.operand)
            return lambda: None if (value := inner()) is None else -as_number(value)
        if not isinstance(operand, Operand):
            raise Unasked("a question compares entries with values, and does not calculate")
        word = operand.word
        if word.kind == BRACED:
            key = key_of(word)
            root = self._snapshots.machine.root.board.root
            return lambda: entry.value if (entry := root.entry(key)) is not None else None
        if word.kind == STRING:
            return lambda: word.text
        if word.kind == NAME:
            if word.raw in ("true", "false"):
                return lambda: int(word.raw == "true")
            raise Unasked(f"the values of signals are not known here; write {{{word.raw}}} for an entry")
        try:
            number = float(word.raw)
        except ValueError:
            raise Unasked(f"`{word.raw}` has a unit, and entries have none") from None
        return lambda: number


_Test = Callable[[], bool]


class _Watched:
    """An event: changes of the statuses of nodes, or conditions that become true."""

    def __init__(self, statuses: list[tuple[frozenset[int], str]], tests: list[tuple[int, _Test]]) -> None:
        self._statuses: Final = statuses
        self._tests: Final = tests

    def occurs(self, node: SimulatedNode, before: int, after: int, held: frozenset[int]) -> tuple[bool, frozenset[int]]:
        """Whether it occurs at a change; and the conditions that hold, of this event and others."""
        is_now = any(node.uid in uids and happens(word, before, after) for uids, word in self._statuses)
        for number, test in self._tests:
            if test():
                is_now = is_now or number not in held
                held |= {number}
            else:
                held -= {number}
        return is_now, held


def happens(word: str, before: int, after: int) -> bool:
    """Whether a change of a status is what a word says."""
    if word == "starts":
        return after != IDLE and before != RUNNING
    if word == "halts":
        return after == IDLE and before == RUNNING
    if word == "finishes":
        return after in (SUCCESS, FAILURE)
    return after == (SUCCESS if word == "succeeds" else FAILURE)


def _holds(left: Value | None, operator: str, right: Value | None) -> bool:
    """Whether a comparison holds; not with an entry that has no value, or one of another kind."""
    if left is None or right is None:
        return False
    try:
        return compared(left, operator, right)
    except EngineError:
        return operator == "!="


def _is_true(value: Value | None) -> bool:
    if value is None:
        return False
    return bool(value) if isinstance(value, Unknown) else value not in (0, "", "false")
