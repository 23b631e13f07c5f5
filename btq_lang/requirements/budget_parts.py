"""How long a node takes, its ports that say so, and what the rules of all flows are made of."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import fsum, inf
from typing import Final

from btq_lang.catalog.kinds import Role
from btq_lang.catalog.units import to_si
from btq_lang.requirements.durations import ANY, ZERO, Range, hull, plus, times, total, without_end
from btq_lang.syntax.quantities import parse_quantity
from btq_lang.syntax.tokens import QUANTITY
from btq_lang.syntax.tree import Word
from btq_lang.util.record import Record, replace
from btq_lang.workspace.resolved import ResolvedNode


class Budget(Record):
    """How long a node takes.

    Attributes:
        success, failure: of an activation that succeeds or fails; None if none does.
        skip: until it is skipped.
        waits: whether it may return RUNNING, so that it can be interrupted.
        probability: at least this, that all holds on which the ranges depend (by the union bound).
        endless: whether it may run for ever, without an outcome.
    """

    success: Range | None
    failure: Range | None
    skip: Range | None = None
    waits: bool = True
    probability: float = 1.0
    endless: bool = False

    @property
    def completes(self) -> Range | None:
        """Of an activation that succeeds or fails."""
        return hull(self.success, self.failure)

    @property
    def anything(self) -> Range | None:
        """Of any activation, however it ends."""
        return hull(self.success, self.failure, self.skip)

    @property
    def running(self) -> Range:
        """How long it may run until it is interrupted, or while it is running."""
        longest = self.anything
        return ANY if self.endless or longest is None else replace(longest, low=0.0)

    @property
    def is_bounded(self) -> bool:
        """Whether there is a bound on how long it may run."""
        longest = None if self.endless else self.anything
        return longest is not None and longest.high < inf


def mapped(budget: Budget, change: Callable[[Range | None], Range | None]) -> Budget:
    """The budget with changed ranges; an absent skip stays absent."""
    success = change(budget.success)
    failure = success if budget.failure is budget.success else change(budget.failure)
    skip = change(budget.skip) if budget.skip is not None else None
    return Budget(success, failure, skip, budget.waits, budget.probability, budget.endless)


def opened(budget: Budget) -> Budget:
    """The budget of a node with the same outcomes, each at any time."""
    return mapped(budget, lambda each: ANY if each is not None else None)


def inverted(budget: Budget) -> Budget:
    """The same with success and failure exchanged."""
    return replace(budget, success=budget.failure, failure=budget.success)


UNKNOWN: Final = Budget(ANY, ANY, ANY, endless=True)  # of a node that may do anything and take any time


def without_limit(children: Sequence[Budget]) -> Budget:
    """The budget of a node that may tick its children again without limit."""
    return replace(UNKNOWN, probability=likelihood([child.probability for child in children], None))


def port_seconds(node: ResolvedNode) -> float | None:
    """The literal milliseconds of its time, in seconds; None if that is not a literal number."""
    word, _ = port_of(node, "time")
    if word is None:
        return None
    quantity = parse_quantity(word.text) if word.kind == QUANTITY else None
    if quantity is not None:
        seconds = to_si(quantity[0], quantity[1])
        return max(round(seconds * 1000), 0) / 1000 if seconds < inf else None
    return int(word.text) / 1000 if word.text.isdecimal() and len(word.text) < 12 else None


def port_range(node: ResolvedNode) -> Range:
    """How long it waits by its time; any time, if that is not a literal number."""
    seconds = port_seconds(node)
    return ANY if seconds is None else Range(seconds, seconds)


def port_count(node: ResolvedNode, role: Role) -> int | None:
    """The literal integer of the port, or its default; None if that is not an integer."""
    word, text = port_of(node, role)
    if word is not None:
        text = word.text
    return int(text) if text.removeprefix("-").isdecimal() and len(text) < 12 else None


def port_of(node: ResolvedNode, role: Role) -> tuple[Word | None, str]:
    """The value of the port, and its default."""
    port = node.behavior.port_for(role) if node.behavior is not None else None
    return (None, "") if port is None else (node.node.attribute(port.name), port.default or "")


def combined(children: Sequence[Budget], success: Range | None, failure: Range | None, skip: Range | None) -> Budget:
    """The budget of a node with these ranges.  Its children decide whether it waits, how likely its ranges hold, and
    whether it is endless."""
    waits = any(child.waits for child in children)
    likely = likelihood([child.probability for child in children])
    return Budget(success, failure, skip, waits, likely, endless=any(child.endless for child in children))


def likelihood(probabilities: Sequence[float], count: int | None = 1) -> float:
    """The least probability that all of these hold, each `count` times, by the union bound.  Without a count it is 0,
    unless all of them are certain."""
    if all(probability == 1.0 for probability in probabilities):
        return 1.0
    if count is None or count < 0:
        return 0.0
    return max(0.0, 1.0 - count * fsum([1.0 - probability for probability in probabilities]))


def in_order(
    parts: Sequence[tuple[Range | None, Range | None, Range | None]],
) -> tuple[Range | None, Range | None, Range | None]:
    """One after the other, as long as each goes on: the ranges of going on, of ending, and of skipping all."""
    passed: Range | None = ZERO
    ended: Range | None = None
    for go, end, skip in parts:
        ended = hull(ended, plus(passed, end))
        passed = plus(passed, hull(go, skip))
    return passed, ended, total(skip for _, _, skip in parts)


def end_after(go: Range | None, end: Range | None, count: float) -> Range | None:
    """`end` after at most `count` times `go`."""
    if go is None or end is None or count == 0:
        return end
    if count == inf:
        return without_end(end) if go.high > 0.0 else end
    return hull(end, plus(times(int(count), go), end))
