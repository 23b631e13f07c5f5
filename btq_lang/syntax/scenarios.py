"""Scenarios: what nodes do and what the world is like in a run, and what the mission is expected to do then.

One invariant: as in `tree`, to which these classes belong, offsets count from the start of the item.
"""

from __future__ import annotations

from typing import Final, TypeAlias

from btq_lang.syntax.clauses import Claim, Condition, Event, Path
from btq_lang.syntax.words import Pair, Word
from btq_lang.util.record import Part


class NodePattern(Part):
    """`every Dock`, `Deliver/MoveTo (station = "A")`: all nodes that match, while their ports have these values.

    Attributes:
        every: the ID or kind after `every`; None with a path.
    """

    every: Word | None
    path: Path | None
    pairs: tuple[Pair, ...] = ()

    @property
    def last(self) -> Word | None:
        """The last name: that of the nodes themselves."""
        return self.path.names[-1] if self.path is not None else self.every


class Aspect(Part):
    """One thing that is given of an activation.

    Attributes:
        word: `succeeds`, `fails`, `skips`, `does` (does not end), `takes`, `after` or `answers`.
        duration: of `takes` and `after`.
        answers: `true` and `false`, of the first tick of a condition, its second …
    """

    word: Word
    duration: Word | None = None
    answers: tuple[Word, ...] = ()


class Behavior(Part):
    """`fails twice`, `succeeds after 3 s and writes tubes = 2`.

    Attributes:
        times: in how many activations: `once`, `twice` or a number; None: in one, or if it is the last, in all further.
        writes: the entries that a node writes when it ends.
    """

    aspects: tuple[Aspect, ...]
    times: Word | None = None
    writes: tuple[Pair, ...] = ()


class NodesDo(Part):
    """`MoveTo fails twice, then succeeds after 3 s`: behaviors of successive activations."""

    nodes: NodePattern
    behaviors: tuple[Behavior, ...]


class Assignment(Part):
    """`battery = 80 %`, `{goal} = "A"`: a value of a signal, by its name, or of an entry, in braces."""

    target: Word
    value: Word | None


class Given(Part):
    """`given MoveTo takes 20 s`, `given battery = 80 %`."""

    fact: NodesDo | Assignment | None


class Elapsed(Part):
    """`30 s have passed` since the start of the run."""

    duration: Word


class EventTrigger(Part):
    """`Dock (station = "A") fails for the 2 time`.

    Attributes:
        pairs: the values that ports of the node have.
        number: `2` or `second`; None: the first time.
    """

    event: Event
    pairs: tuple[Pair, ...] = ()
    number: Word | None = None

    @property
    def nth(self) -> int:
        """The number as one, from 1."""
        if self.number is None:
            return 1
        return _ORDINALS.get(self.number.raw) or int(float(self.number.raw))


_ORDINALS: Final = {"first": 1, "second": 2, "third": 3}


class HaltMission(Part):
    """`mission halts`: the program halts the tree."""


class When(Part):
    """`when 30 s have passed: person_near = true`: something changes during the run."""

    trigger: Elapsed | EventTrigger | Condition | None
    effect: NodesDo | Assignment | HaltMission | None


class ExpectedRuns(Part):
    """`MoveTo (location) runs "A", "E"`: the values of a port of all activations, in order, no more and no less.

    Attributes:
        port: in brackets after the nodes, without a value; None: the one input port of the node's model.
    """

    nodes: NodePattern
    port: Word | None
    values: tuple[Word, ...]


class Finally(Part):
    """`finally {done} == true`: a condition at the end of the run."""

    condition: Condition | None


class NeverEnds(Part):
    """`mission does not end`."""


class ExpectedOutcome(Part):
    """`mission fails`, `mission halts`: how the run ends."""

    word: Word


class ExpectedVerdict(Part):
    """`in_time violated`: the verdict of a requirement; words: empty for `satisfied`."""

    name: Word
    words: tuple[Word, ...] = ()


class Expect(Part):
    """`expect never node Grasp`."""

    expectation: Claim | ExpectedRuns | Finally | NeverEnds | ExpectedOutcome | ExpectedVerdict | None


Step: TypeAlias = Given | When | Expect


class Scenario(Part):
    """`scenario "The station is closed" of Deliver verifies rq1`, and its steps.

    Attributes:
        tree: None: the main tree.
        verifies: requirements.
    """

    title: Word | None
    tree: Word | None
    verifies: tuple[Word, ...]
    steps: tuple[Step, ...]
