"""What was worked out before, kept for as long as it would come out the same.

One invariant: what is taken from a memory is what would be made anew: whoever makes something says what it is made of,
and notes every answer that it asks for elsewhere.  It does not know what is kept.
"""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from itertools import repeat

from btq_lang.diagnostics import Place
from btq_lang.requirements.model import Applied, Argument, Target, Use, Value
from btq_lang.text import Span

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from typing import Any, Final, Protocol, TypeAlias, TypeVar

    from btq_lang.requirements.attach import Uses
    from btq_lang.requirements.budgets import _TreeBudgets
    from btq_lang.requirements.nodes import Nodes

    T = TypeVar("T")
    Question: TypeAlias = tuple[Any, Hashable]

    class Asker(Protocol):
        """Whoever makes things and asks for others meanwhile.

        Attributes:
            noted: the questions since that was emptied, with their answers.
        """

        noted: dict[Question, object]

        def answer(self, question: Question) -> object:
            """What the answer is now."""


class Memory:
    """Tables of what was made, by the object that each of it was made for.

    Attributes:
        nodes: the written nodes.
        uses: what each entry attaches, in their order; and all of it by the requirement.
        by_tree: what holds for nodes, by the tree that they stand in.
        budgets: those of the nodes of each tree.
        ways_up: how trees run each other, and what was found out of that alone, by the names of trees.
    """

    def __init__(self) -> None:
        self.nodes: Nodes | None = None
        self.uses: tuple[list[Uses], dict[str, tuple[Use, ...]]] = ([], {})
        self.by_tree: dict[int, tuple[Applied, ...]] = {}
        self.budgets: dict[int, _TreeBudgets] = {}
        self.ways_up: tuple[object, dict[str | None, Any]] = (None, {})
        self._tables: dict[str, Table] = {}
        self._tables_before: dict[str, Table] = {}

    def begin(self) -> None:
        """All is asked for again; what nobody asks for until the next time is forgotten."""
        self._tables, self._tables_before = {}, self._tables

    def table(self, name: str, asker: Asker) -> Table:
        """A table to be filled again, from what stands in the one of this name.

        Args:
            asker: who makes what stands in it; meanwhile none of its answers becomes another.
        """
        table = self._tables[name] = Table(self._tables_before.get(name), asker)
        return table


class Table:
    """What was made in one go.

    Attributes:
        made: by the `id` of its owner: the owner, what it was made of, what was asked meanwhile, and itself.
        answers: what was asked for any of it, and perhaps for more.
    """

    __slots__ = ("_asker", "_changed", "_made_before", "_most", "answers", "made")

    def __init__(self, before: Table | None, asker: Asker) -> None:
        self.made: dict[int, tuple[object, object, tuple[Question, ...], Any]] = {}
        self.answers: dict[Question, object] = {}
        self._asker = asker
        self._made_before = before.made if before is not None else {}
        self._changed: set[Question] = set()
        self._most: int = before._most if before is not None else 0
        if before is not None and before.answers:
            self.answers = before._asked() if len(before.answers) > self._most else before.answers.copy()
            self._most = max(self._most, 2 * len(self.answers))
            for question, answer in before.answers.items():
                if question in self.answers and not is_same(asker.answer(question), answer):
                    self._changed.add(question)
                    del self.answers[question]

    def take(self, owner: object, made_of: object = None) -> Any:
        """What stands here for an owner, if it would be made of the same and every answer is as it was; else None, and
        what is asked from now on is noted for it.

        Args:
            made_of: what else it is made of.
        """
        known = self._made_before.get(id(owner))
        if (
            known is not None
            and known[0] is owner
            and (known[1] is made_of or is_same(made_of, known[1]))
            and (not self._changed or self._changed.isdisjoint(known[2]))
        ):
            self.made[id(owner)] = known
            return known[3]
        self._asker.noted = {}
        return None

    def take_all(self, owners: Sequence[object], made_of: Sequence[object]) -> list[Any]:
        """As `take`, of all owners that the table will have, each with what else it is made of.  None stands for what
        is to be made; before that, `take` must be asked for it.

        After most edits the owners are the same ones in the same order, and of thousands one is another.
        """
        known, changed = self._made_before, self._changed
        rows = known.values() if len(known) == len(owners) else repeat(None)
        found: list[Any] = []
        for owner, part, row in zip(owners, made_of, rows, strict=False):
            if row is None or row[0] is not owner:
                row = known.get(id(owner))
            if (
                row is not None
                and row[0] is owner
                and (row[1] is part or is_same(part, row[1]))
                and (not changed or changed.isdisjoint(row[2]))
            ):
                found.append(row[3])
            else:
                row = _TO_BE_MADE  # it keeps the place, for the order
                found.append(None)
            self.made[id(owner)] = row
        return found

    def put(self, owner: object, made_of: object, made: T) -> T:
        """What is made for an owner stands here from now on."""
        self.made[id(owner)] = owner, made_of, tuple(self._asker.noted), made
        self.answers.update(self._asker.noted)
        return made

    def before(self, owner: object) -> Any:
        """What was made for an owner before, of whatever; None if nothing was."""
        known = self._made_before.get(id(owner))
        return known[3] if known is not None and known[0] is owner else None

    def _asked(self) -> dict[Question, object]:
        """The answers that anything here rests on."""
        return {question: self.answers[question] for each in self.made.values() for question in each[2]}


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
        return all(map(is_same, now._values, before._values))
    return kind in _PLAIN and bool(now == before)


_TO_BE_MADE: Final = (None, None, (), None)
_LIGHT = (Use, Applied, Target, Argument, Place)  # made anew where what they say is as before
_PLAIN = (str, int, frozenset, Span, Value)
