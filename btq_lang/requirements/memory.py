"""What was worked out before, kept for as long as it would come out the same.

One invariant: what is taken from a memory is what would be made anew: whoever makes something says what it is made of,
and notes every answer that it asks for elsewhere.  It does not know what is kept.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Sequence
from itertools import compress, count
from typing import TYPE_CHECKING, Any, TypeAlias, TypeVar

from btq_lang.diagnostics.model import Place
from btq_lang.requirements.model import Applied, Argument, Target, Use, Value
from btq_lang.util.record import fields_of
from btq_lang.util.text import Span

if TYPE_CHECKING:
    from btq_lang.requirements.attach import Held, Uses
    from btq_lang.requirements.budgets import _TreeBudgets
    from btq_lang.requirements.model import Requirement
    from btq_lang.requirements.nodes import Nodes
    from btq_lang.requirements.paths import Problem

    T = TypeVar("T")
    Question: TypeAlias = tuple[Any, Hashable]


class Asker:
    """Whoever makes things and asks for others meanwhile.

    Attributes:
        noted: the questions since that was emptied, with their answers.
        news: of questions that begin with one of these the only ones to which the answer may be another one than the
            last time, by what is asked behind it.
    """

    noted: dict[Question, object]
    news: dict[object, frozenset[object]]

    def answer(self, question: Question) -> object:
        """What the answer is now."""
        raise NotImplementedError


class Memory:
    """Tables of what was made, by the object that each of it was made for.

    Attributes:
        nodes: the written nodes.
        requirements: by name, in the order of their definitions.
        problems: what was found wrong, by the table in which that is kept.
        uses: what each entry attaches, in their order; all of it by the requirement; and which are mentioned.
        held: what each requirement holds for, in their order.
        by_tree: what holds for nodes, by the tree that they stand in.
        touched: the trees for whose nodes something else holds than before, by their `id`s; None: nobody knows.
        turn: how often all was asked for.
        budgets: those of the nodes of each tree; and in which turn they were made.
        ways_up: what was found out of how trees run each other, by their names; and what it rests on.
    """

    def __init__(self) -> None:
        self.nodes: Nodes | None = None
        self.uses: tuple[list[Uses], dict[str, tuple[Use, ...]], frozenset[str]] = ([], {}, frozenset())
        self.held: list[Held] = []
        self.by_tree: dict[int, tuple[Applied, ...]] = {}
        self.touched: frozenset[int] | None = None
        self.turn = 0
        self.budgets: tuple[dict[int, _TreeBudgets], int] = {}, 0
        self.ways_up: tuple[dict[str | None, Any], Any] = {}, None
        self.requirements: dict[str, Requirement] = {}
        self.problems: dict[str, tuple[Problem, ...]] = {}
        self._made: dict[str, tuple[tuple[object, ...], Any]] = {}
        self._tables: dict[str, Table] = {}
        self._tables_before: dict[str, Table] = {}

    def begin(self) -> None:
        """All is asked for again; what nobody asks for until the next time is forgotten."""
        self._tables, self._tables_before = {}, self._tables
        self.turn += 1

    def let_go(self) -> None:
        """All is asked that will be: let go of what is not asked for any more, with the workspace that it was found in.
        Of a large file that takes as long as a tenth of what an edit does."""
        self._tables_before = {}

    def end(self) -> None:
        """Nobody asks for any of it any more."""
        for tree in self.nodes.trees if self.nodes is not None else ():
            tree.let_go()

    def once(self, name: str, made_of: tuple[object, ...], make: Callable[[], T]) -> T:
        """What was made before, if that was of these very objects."""
        known = self._made.get(name)
        if known is None or [*map(id, known[0])] != [*map(id, made_of)]:
            known = self._made[name] = made_of, make()
        made: T = known[1]
        return made

    def table(self, name: str, asker: Asker) -> Table:
        """A table to be filled again, from what stands in the one of this name.

        Args:
            asker: who makes what stands in it; meanwhile none of its answers becomes another.
        """
        before = self._tables.get(name) or self._tables_before.get(name)
        table = self._tables[name] = Table(before, asker)
        return table


class Table:
    """What was made for owners, in their order.

    Attributes:
        answers: what was asked for any of it, and perhaps for more.
        others: where something else stands than before; None: there were more owners or fewer.
    """

    __slots__ = (
        "_asked",
        "_asker",
        "_before",
        "_changed",
        "_made",
        "_made_of",
        "_most",
        "_owners",
        "_places",
        "answers",
        "others",
    )

    def __init__(self, before: Table | None, asker: Asker) -> None:
        self.answers: dict[Question, object] = {}
        self.others: list[int] | None = None
        self._owners: Sequence[object] = ()
        self._made_of: Sequence[object] = ()
        self._asked: list[tuple[Question, ...]] = []  # for each of them
        self._made: list[Any] = []
        self._places: dict[int, int] | None = None  # of the owners before, by their `id`s, once somebody asks
        self._asker: Asker | None = asker  # until all is asked for: it knows what knows this table
        self._before: Table | None = before
        self._changed: set[Question] = set()
        self._most: int = before._most if before is not None else 0
        if before is not None and before.answers:
            answers = before.answers
            ask, news = asker.answer, asker.news
            changed = [
                each
                for each, answer in answers.items()
                if (each[0] not in news or each[1] in news[each[0]])
                and (now := ask(each)) is not answer
                and not is_same(now, answer)
            ]
            self.answers = before._in_use() if len(answers) > self._most else answers
            self._most = max(self._most, 2 * len(self.answers))
            self._changed.update(changed)
            for question in changed:
                self.answers.pop(question, None)

    def all(self, owners: Sequence[object], made_of: Sequence[object], make: Callable[[int], T]) -> list[T]:
        """What stands here for each owner: what stood here before, if it would be made of the same and every answer is
        as it was; else it is made.  After most edits the owners are the same ones in the same order, and of thousands
        one is another.

        Args:
            made_of: what else it is made of.
            make: is told which owner it is, counted from 0.
        """
        before, count, asker = self._before, len(owners), self._asker
        assert asker is not None, "all is asked for once"
        self._owners, self._made_of = owners, made_of
        if before is not None and len(before._owners) == count:
            self._asked, self._made = before._asked, before._made  # which nobody asks for these any more
            places: Iterable[int] = self._not_as_before(before)
            self.others = []
        else:
            self._asked, self._made = [()] * count, [None] * count
            places = range(count)
        for at in places:
            was = self._place_before(at)
            if (
                before is not None
                and was is not None
                and is_same(made_of[at], before._made_of[was])
                and self._changed.isdisjoint(before._asked[was])
            ):
                self._asked[at], self._made[at] = before._asked[was], before._made[was]
                continue
            asker.noted = {}
            self._made[at] = make(at)
            self._asked[at] = tuple(asker.noted)
            self.answers.update(asker.noted)
            if self.others is not None:
                self.others.append(at)
        self._before = self._asker = None
        return self._made

    @property
    def is_as_before(self) -> bool:
        """Whether the same stands here, and as much."""
        return self.others is not None and not self.others

    def before(self, at: int) -> Any:
        """What was made for an owner before, of whatever; None if nothing was."""
        was = self._place_before(at)
        return self._before._made[was] if self._before is not None and was is not None else None

    def _place_before(self, at: int) -> int | None:
        """Where an owner stood before.  Of as many hardly one has moved, and what is not found is made."""
        before, owner = self._before, self._owners[at]
        if before is None:
            return None
        if len(before._owners) == len(self._owners):
            return at if before._owners[at] is owner else None
        if self._places is None:
            self._places = {id(each): place for place, each in enumerate(before._owners)}
        return self._places.get(id(owner))

    def _not_as_before(self, before: Table) -> list[int]:
        """Where another owner stands than before, or one that is made of something else."""
        from operator import is_not  # only an edit asks

        found: set[int] = set()
        for now, then in ((self._owners, before._owners), (self._made_of, before._made_of)):
            if now is not then:
                found.update(compress(count(), map(is_not, now, then)))
        if changed := self._changed:
            found.update([at for at, asked in enumerate(before._asked) if asked and not changed.isdisjoint(asked)])
        return sorted(found)

    def _in_use(self) -> dict[Question, object]:
        """The answers that anything here rests on."""
        return {question: self.answers[question] for asked in self._asked for question in asked}


def is_same(now: Any, before: Any) -> bool:
    """Whether one may stand for the other: what they are made of says the same, and all places in them are places in
    the very same items and nodes, for in another one nobody finds them any more."""
    if now is before:
        return True
    kind = type(now)
    if kind is not type(before):
        return False
    if kind is tuple:
        return len(now) == len(before) and all(map(is_same, now, before))
    if kind in _LIGHT:
        return all(is_same(getattr(now, field), getattr(before, field)) for field in fields_of(now))
    return kind in _PLAIN and bool(now == before)


_LIGHT = (Use, Applied, Target, Argument, Place)  # made anew where what they say is as before
_PLAIN = (str, int, frozenset, Span, Value)
