"""The query cache: answers about a workspace, kept from one revision to the next.

There are two kinds of cached functions, and one way to ask: `store.ask(function, *key)`.  The function and its key
identify an answer:

* an *input*, `read(state, *key)`, reads the workspace and asks nothing.  It is declared with a topic; `advance` sets a
  new state and names the topics that may differ, and only inputs of these are read again.
* a *query*, `query(store, *key)`, asks the store for inputs and for other queries, and reads nothing else.

One invariant: an answer is the one that a store without a cache would give, in whatever order queries are asked.

*How.*  An answer knows its dependencies and its dependents.  When an input differs, its dependents are stale,
and theirs are suspect; nothing is computed yet.  When a suspect answer is needed, its dependencies are verified in
their order: if none differs, it is kept; the first that differs makes it stale.  A stale one is recomputed, and if it
equals the old one, that is kept and its dependents stay valid: the wave stops there.  (The "red-green" algorithm of
salsa and rust-analyzer, with the cone of an edit marked from below.)

*Hubs.*  If many answers depend on one that seldom changes, each of them would be suspect after most edits.  So a query
declared a `hub` is settled before the next question, and its dependents become suspect only if it has changed.

*Circles.*  A query that depends on itself gets the answer declared with `on_circle`, and so does every
query on that circle, whichever was asked first.  An answer computed inside an open circle is part of it if it depends
on one that is (Tarjan's strongly connected components).  Deep chains do not overflow Python's stack: at the depth
`_DEEPEST`, the deeper half is evaluated first, from an empty stack.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable
from operator import attrgetter
from typing import Any, Concatenate, Final, Generic, ParamSpec, TypeVar

from btq_lang.util.reach import reached

State = TypeVar("State")
P = ParamSpec("P")
T = TypeVar("T")
Query = TypeVar("Query", bound=Callable[..., object])

_CLEAN, _SUSPECT, _STALE = range(3)
_FEW: Final = 2_000  # answers: sweeping fewer is not worth the time
_DEEPEST: Final = 40  # nested queries; Python allows some twenty calls for each
_ON_CIRCLE: dict[Callable[..., Any], object] = {}
_HUBS: set[Callable[..., Any]] = set()
_TOPICS: dict[Callable[..., Any], Callable[..., Hashable]] = {}


def input_of(
    topic: Callable[..., Hashable],
) -> Callable[[Callable[Concatenate[State, P], T]], Callable[Concatenate[Store[State], P], T]]:
    """Declare an input by the topic that follows from its key.  Type checkers take it for a query, for it is only asked
    for."""

    def declare(read: Callable[Concatenate[State, P], T]) -> Callable[Concatenate[Store[State], P], T]:
        _TOPICS[read] = topic
        return read  # type: ignore[return-value]  # the store calls it with its state

    return declare


def on_circle(answer: object) -> Callable[[Query], Query]:
    """Declare the answer of a query that depends on itself."""

    def declare(query: Query) -> Query:
        _ON_CIRCLE[query] = answer
        return query

    return declare


def hub(query: Query) -> Query:
    """Declare a query whose answer seldom changes, and on which many others depend.

    It must not depend on another hub except directly: a query between them would keep its answer until that hub is
    settled.
    """
    _HUBS.add(query)
    return query


class Cancelled(Exception):  # not an error: a newer request has come
    """The answer is not needed any more."""


class _Answer:
    """A cached answer.

    Attributes:
        key: the function and its arguments.
        dependencies: in the order in which it asked for them.
        dependents: whose dependency it is.
        number: in which order answers were opened; one that is restarted keeps its number.
        low: the lowest number that it reaches while it, or a circle that it is part of, is open; else None.
        is_circular: whether it depends on itself.
    """

    __slots__ = ("dependencies", "dependents", "is_circular", "key", "low", "number", "state", "value")

    def __init__(self, key: tuple[Any, ...]) -> None:
        self.key = key
        self.value: Any = _UNKNOWN
        self.state = _STALE
        self.dependencies: tuple[_Answer, ...] = ()
        self.dependents: set[_Answer] = set()
        self.number = 0
        self.low: int | None = None
        self.is_circular = False


class _TooDeep(Exception):  # used to unwind, not an error
    """The path is too long for Python's stack."""


class Store(Generic[State]):
    """The answers about a state, which is any value that inputs read.

    Attributes:
        is_cancelled: called before every computation; if it returns true, `Cancelled` is raised, and nothing is lost.
    """

    def __init__(self, state: State) -> None:
        self.is_cancelled: Callable[[], bool] = lambda: False
        self._state = state
        self._answers: dict[tuple[Any, ...], _Answer] = {}
        self._inputs: dict[Hashable, list[_Answer]] = {}  # by topic
        self._touched: set[Hashable] = set()  # the topics of inputs that may differ since the last question
        self._pinned: set[tuple[Any, ...]] = set()
        self._size = 0  # after the last sweep
        self._is_edited = False  # since then
        self._dependencies: dict[_Answer, None] | None = None  # of the query that is being computed
        self._path: list[_Answer] = []  # the queries that are open, each asked by the one before it
        self._count = 0  # of numbers
        self._first = 0  # the last number before the current top-level query
        self._start = 0  # the index on the path where Python's calls begin
        self._circles: list[_Answer] = []  # answers of circles, another part of which is open
        self._hubs: list[_Answer] = []  # those that are not clean, and whose dependents are not suspect yet

    # ---- used by queries ----

    def ask(self, query: Callable[Concatenate[Store[State], P], T], /, *key: P.args, **_: P.kwargs) -> T:
        """The answer of a query or of an input.

        Raises:
            LookupError: the query depends on itself, and no answer is declared for that.
        """
        if self._dependencies is None:
            self._read_again()
            while self._hubs:
                if self._hubs[-1].state != _CLEAN:
                    self._settle(self._hubs[-1])
                self._hubs.pop()
        name = (query, *key)
        answer = self._answers.get(name)
        if answer is None:
            answer = _Answer(name)
            if query in _TOPICS:
                answer.value = self._read(name)
                answer.state = _CLEAN
                self._inputs.setdefault(_TOPICS[query](*key), []).append(answer)
            self._answers[name] = answer
        if self._dependencies is not None:
            self._dependencies[answer] = None
        if answer.state != _CLEAN and self._settle(answer):
            return _declared(answer)  # type: ignore[no-any-return]  # its owner declares what the query may return
        return answer.value  # type: ignore[no-any-return]  # it is what the query returns

    # ---- used by the store's owner ----

    @property
    def state(self) -> State:
        """The state that inputs read."""
        return self._state

    @property
    def topics(self) -> tuple[Hashable, ...]:
        """The topics of all inputs."""
        return tuple(self._inputs)

    def advance(self, state: State, topics: Iterable[Hashable]) -> None:
        """Set a new state, read when the next question comes: what differs only until then invalidates nothing."""
        self._state = state
        self._touched.update(topics)

    def pin(self, query: Callable[Concatenate[Store[State], P], object], /, *key: P.args, **_: P.kwargs) -> None:
        """Keep an answer, and all that it depends on, until it is unpinned."""
        self._pinned.add((query, *key))

    def unpin(self, query: Callable[Concatenate[Store[State], P], object], /, *key: P.args, **_: P.kwargs) -> None:
        self._pinned.discard((query, *key))

    def sweep(self, *, always: bool = False) -> None:
        """Forget what no pinned answer depends on, if that has become much, or always; what pinned answers have asked
        for is all in use until the first edit.
        """
        is_in_use = self._pinned and not self._is_edited
        if not always and (is_in_use or len(self._answers) <= max(2 * self._size, _FEW)):
            return
        pinned = [self._answers[key] for key in self._pinned if key in self._answers]
        used = set(reached(pinned, attrgetter("dependencies")))
        kept_answers = {key: answer for key, answer in self._answers.items() if answer in used}
        for answer in self._answers.values():
            if answer in used:
                answer.dependents &= used
            else:  # else answers and their dependents would keep each other alive
                answer.dependencies, answer.dependents = (), set()
        self._answers = kept_answers
        self._hubs = [each for each in self._hubs if each in used]
        kept = {topic: [each for each in inputs if each in used] for topic, inputs in self._inputs.items()}
        self._inputs = {topic: inputs for topic, inputs in kept.items() if inputs}
        self._size = len(self._answers)
        self._is_edited = False

    # ---- how answers are settled ----

    def _read_again(self) -> None:
        """Read the inputs that may differ since the last question."""
        while self._touched:
            self._is_edited = True
            topic = self._touched.pop()
            inputs = self._inputs.pop(topic, ())
            kept = [each for each in inputs if each.dependents]
            for answer in inputs:
                if answer.dependents:
                    self._replace(answer, self._read(answer.key))
                else:
                    del self._answers[answer.key]
            if kept:
                self._inputs[topic] = kept

    def _read(self, key: tuple[Any, ...]) -> object:
        """The present value of an input."""
        read: Callable[..., object] = key[0]
        return read(self._state, *key[1:])

    def _settle(self, answer: _Answer) -> bool:
        """Bring an answer up to date unless it is part of an open circle; return whether it is up to date."""
        if answer.low is None:
            if self._path:
                self._open(answer)
            else:
                self._open_first(answer)
        if answer.low is None:
            return False
        dependent = self._path[-1]
        dependent.is_circular = True
        dependent.low = min(answer.low, dependent.low if dependent.low is not None else answer.low)
        return True

    def _open_first(self, answer: _Answer) -> None:
        """Settle an answer that no query asks for; if a path becomes too long, its far half first."""
        self._first = self._count
        waiting = [(answer, 0)]
        try:
            while waiting:
                answer, self._start = waiting[-1]
                self._close(self._start)
                try:
                    self._open(answer)
                    waiting.pop()
                except _TooDeep:
                    middle = self._start + _DEEPEST // 2
                    waiting.append((self._path[middle], middle))
        finally:
            self._close(0)
            for part in self._circles:  # an exception has left them open
                part.low = None
            self._circles.clear()

    def _close(self, start: int) -> None:
        """Leave a path from an index on."""
        for left in self._path[start:]:
            left.low = None
        del self._path[start:]

    def _open(self, answer: _Answer) -> None:
        """Settle an answer at the end of the path."""
        place = len(self._path)
        if place - self._start == _DEEPEST:
            raise _TooDeep
        if self.is_cancelled():
            raise Cancelled
        if answer.is_circular:  # its parts may no longer form a circle
            answer.state = _STALE
        if answer.number <= self._first:
            self._count += 1
            answer.number = self._count
        answer.low, answer.is_circular = answer.number, False
        self._path.append(answer)
        if answer.state == _SUSPECT:
            self._verify(answer)
        value = answer.value if answer.state == _SUSPECT else self._compute(answer)
        self._path.pop()
        if not answer.is_circular:
            self._replace(answer, value)
            return
        self._circles.append(answer)
        if answer.low < answer.number:
            return
        circle: list[_Answer] = []
        while self._circles and self._circles[-1].number >= answer.number:
            circle.append(self._circles.pop())
        for part in circle:
            self._replace(part, _declared(part))
        for part in circle:  # each has just found that another one differs
            part.state = _CLEAN

    def _verify(self, answer: _Answer) -> None:
        """Check whether the dependencies of an answer are unchanged; else it is stale."""
        for dependency in answer.dependencies:
            if dependency.state != _CLEAN:
                self._settle(dependency)
                if answer.state == _STALE:
                    return

    def _compute(self, answer: _Answer) -> object:
        outer, self._dependencies = self._dependencies, {}
        try:
            value = answer.key[0](self, *answer.key[1:])
            dependencies = self._dependencies
        finally:
            self._dependencies = outer
        before = set(answer.dependencies)
        for dependency in before.difference(dependencies):
            dependency.dependents.discard(answer)
        answer.dependencies = tuple(dependencies)
        for dependency in dependencies:
            dependency.dependents.add(answer)
        return value

    def _replace(self, answer: _Answer, value: object) -> None:
        """Settle an answer; if it changed, its dependents are stale, and theirs suspect."""
        answer.low = None
        answer.state = _CLEAN
        if value is answer.value or value == answer.value:
            return
        answer.value = value
        waiting: list[_Answer] = []
        for dependent in answer.dependents:
            if dependent.state == _CLEAN:
                (self._hubs if dependent.key[0] in _HUBS else waiting).append(dependent)
            dependent.state = _STALE
        while waiting:
            for dependent in waiting.pop().dependents:
                if dependent.state == _CLEAN:
                    dependent.state = _SUSPECT
                    (self._hubs if dependent.key[0] in _HUBS else waiting).append(dependent)


def _declared(answer: _Answer) -> Any:
    if answer.key[0] not in _ON_CIRCLE:
        raise LookupError(f"{answer.key[0].__qualname__} reaches itself, and declares no answer for that")
    return _ON_CIRCLE[answer.key[0]]


_UNKNOWN: Final = object()
