"""What a scenario says, with its words resolved: what nodes do, when the world changes, and what is expected.

One invariant: nothing in here has to be looked up again, and nodes are numbers of the tree that runs.
"""

from __future__ import annotations

from typing import TypeAlias

from btq_lang.requirements.applied import Applied
from btq_lang.requirements.model import Condition, ResolvedRequirement, ResolvedSignal
from btq_lang.simulator.skills import GivenSkill
from btq_lang.util.record import Record


class Set(Record):
    """A signal or an entry gets a value.

    Attributes:
        signal: its name, if it is a signal without an entry.
        key: of the entry on the root blackboard; empty if it has none.
        value: numbers of a signal in its unit.
        line: that says so; 0: a signal gets it.
    """

    signal: str
    key: str
    value: float | int | str | bool
    line: int = 0


class Halt(Record):
    """The program halts the tree."""


class WatchedEvent(Record):
    """An event of nodes.

    Attributes:
        word: starts, succeeds, fails, finishes or halts.
        uids: the nodes.
        values: which values their ports have at the start.
        number: of its occurrences, the one that counts, from 1.
    """

    word: str
    uids: frozenset[int]
    values: tuple[tuple[str, str], ...] = ()
    number: int = 1


class PlannedChange(Record):
    """What changes during a run, once.

    Attributes:
        trigger: milliseconds since the start, an event, or a condition that is true.
        line: that says so.
    """

    trigger: int | WatchedEvent | Condition
    effect: Set | GivenSkill | Halt
    line: int = 0


class ExpectedClaims(Record):
    """A claim, as a requirement that all runs must satisfy."""

    requirement: ResolvedRequirement
    applied: tuple[Applied, ...]


class ExpectedValues(Record):
    """The values of a port of all activations of some nodes, in the order of their starts.

    Attributes:
        port: None: the one input port of each.
    """

    uids: frozenset[int]
    values: tuple[str, ...]
    pairs: tuple[tuple[str, str], ...]
    port: str | None


class ExpectedEnd(Record):
    """A condition at the end of the run."""

    condition: Condition


class WantedEnd(Record):
    """How the run ends: `fails`, `is halted` or `does not end`."""

    end: str


class WantedVerdict(Record):
    """The verdict of a requirement."""

    name: str
    verdict: str


Expected: TypeAlias = ExpectedClaims | ExpectedValues | ExpectedEnd | WantedEnd | WantedVerdict


class Expectation(Record):
    """A line of a scenario; `text`: as typed, without `expect`."""

    text: str
    line: int
    expected: Expected


class Plan(Record):
    """A scenario.

    Attributes:
        entries: those that the program sets before it creates the tree, and the first values of signals.
        read: the signals and entries whose values are needed.
    """

    givens: tuple[GivenSkill, ...]
    entries: tuple[Set, ...]
    changes: tuple[PlannedChange, ...]
    expectations: tuple[Expectation, ...]
    read: tuple[ResolvedSignal, ...]
