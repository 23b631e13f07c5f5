"""What was asked about a file, kept from one edit to the next.

A check asks its view, and what it asked, it rests on: as long as the answers are the same, so is what it found.  There
are two sorts of questions, both written as a function and its arguments:

* a *look-up*, `what(workspace, path, …)`, reads the files and asks nothing.  After an edit it is made again: one that
  begins with a kind and a name only if the edit touches an item that defines this name.
* a *conclusion*, `what(view, …)`, asks other questions and looks at nothing else but the items among its arguments.  It
  is drawn again only when one of its questions has another answer, and when it comes out the same, all that rests on
  it stays.  What is found in an item is such a conclusion.  A *table* is a conclusion about many things at once, a
  mapping: who asks for one of these rests on no more of it than that.

One invariant: after any edits an answer is the one that would be given afresh.  Who looks at the workspace
itself, where nobody can say what he saw, notes `EVERYTHING`; that conclusion is not kept, and such a table is drawn
again after every edit.  It knows no rules.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from heapq import heappop, heappush
from itertools import repeat
from typing import TYPE_CHECKING, Any, Final, TypeAlias, TypeVar

from btq_lang.util.record import Record
from btq_lang.workspace.file import File
from btq_lang.workspace.item_index import Facts, Name
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:
    from btq_lang.checks import Found
    from btq_lang.checks.view import View
    from btq_lang.requirements.memory import Memory
    from btq_lang.workspace.config import Project
    from btq_lang.workspace.findings import Told

    T = TypeVar("T")

Question: TypeAlias = "tuple[Any, ...]"

EVERYTHING: Final[Question] = ()
_OUTSIDE: Final = {EVERYTHING}  # who asks for what no conclusion does
_PARTS: Final[Question] = (None,)  # who asks for tables, which are drawn again as soon as they are stale


class _Answer(Record):
    """An answer.

    Attributes:
        asked: the questions that it rests on; None for a look-up.
        height: more than that of each of these.
    """

    value: object
    asked: set[Question] | None = None
    height: int = 0


class Answers:
    """The answers about one file, and who asked for them.

    Attributes:
        told: of the items of which something was told: what was found, for which project, and what that came to.
        resolved: the requirements in scope, as they were resolved last; they are kept by a mechanism of their own.
    """

    def __init__(self) -> None:
        self.told: dict[Facts, tuple[Found, Project | None, Told]] = {}
        self.resolved: Memory | None = None
        self._workspace: Workspace | None = None
        self._left: Workspace | None = None  # the one before the last edit
        self._path = ""
        self._files: dict[str, File] = {}
        self._answers: dict[Question, _Answer] = {}
        self._askers: dict[Question, set[Question]] = {}
        self._look_ups: set[Question] = set()  # but for those of a name
        self._named: dict[Name, set[Question]] = {}
        self._tables: set[Question] = set()
        self._restless: set[Question] = set()  # tables that rest on everything
        self._stale: set[Question] = set()  # conclusions to be drawn again
        self._outermost: set[Question] = set()  # what no conclusion asks
        self._before: set[Question] = set()  # the same, before the last edit
        self._asked = self._outermost  # what is asked for the conclusion that is being drawn
        self._waiting: list[tuple[int, int, Question]] = []  # stale ones: their heights, a number, themselves
        self._count = 0
        self._is_asking = False
        self._known_of: dict[object, Sequence[str]] = {}  # of which a conclusion was drawn of all
        self._each: dict[object, tuple[dict[object, Any], set[object]]] = {}  # the answers, and which are not kept

    def begin(self, view: View, workspace: Workspace) -> None:
        """The workspace is another one: look again at what may have changed, and draw conclusions of it.

        One that no other conclusion asks for is drawn only when somebody asks: its item may be gone.
        """
        path = view.path
        files = {each: workspace.files[each] for each in workspace.scope(path).paths}
        old = self._workspace
        was_left = self._is_asking  # by an exception
        self._is_asking = True
        if old is None or was_left or old.project != workspace.project or list(files) != list(self._files):
            self._answers, self._askers, self._look_ups, self._named = {}, {}, set(), {}
            self._outermost, self._tables, self._restless = set(), set(), set()
            self._known_of, self._each = {}, {}
            if self.resolved is not None:
                self.resolved.end()
            self.told, self.resolved = {}, None
        touched = {name for each, file in files.items() for name in _touched(self._files.get(each, file), file)}
        self._left = old
        self._workspace, self._path, self._files = workspace, path, files
        self._before, self._outermost = self._outermost, set()
        self._asked = self._outermost
        self._stale = set()
        for question in (*self._look_ups, *(each for name in touched for each in self._named.get(name, ()))):
            value = question[0](workspace, path, *question[1:])
            if not _is_same(value, self._answers[question].value):
                self._answers[question] = _Answer(value)
                self._pass_on(question)
        self._draw_stale(view)
        for question in [*self._restless]:
            self._draw(view, question)
        self._draw_stale(view)

    def _draw_stale(self, view: View) -> None:
        while self._waiting:
            _, _, question = heappop(self._waiting)
            if question in self._stale:
                self._draw(view, question)

    def end(self) -> None:
        """All is asked that will be: forget what nobody has asked for."""
        self._is_asking = False
        self._outermost.discard(EVERYTHING)
        for question in self._outermost - self._before:
            self._askers.setdefault(question, set()).add(EVERYTHING)
        self._leave(self._before - self._outermost, EVERYTHING)

    def let_go(self) -> None:
        """Nobody waits any more: let go of what was there before the last edit."""
        self._left = None
        if self.resolved is not None:
            self.resolved.let_go()

    def look_up(self, question: Question, *, of_name: bool) -> Any:
        """The answer of a look-up.

        Args:
            of_name: its arguments are a kind and a name, and it says nothing but what the items are that define it.
        """
        self._asked.add(question)
        known = self._answers.get(question)
        if known is None:
            known = self._answers[question] = _Answer(question[0](self._workspace, self._path, *question[1:]))
            (self._named.setdefault(question[1:], set()) if of_name else self._look_ups).add(question)
        return known.value

    def look_up_in(self, view: View, table: Callable[[View], Mapping[Any, object]], item: object) -> Any:
        """What a table says of an item."""
        question = table, item
        self._asked.add(question)
        known = self._answers.get(question)
        if known is None or (table,) in self._stale:
            if (table,) not in self._tables:
                self._tables.add((table,))
                self._askers[table,] = {_PARTS}
            value = self.conclude_early(view, (table,)).get(item)
            known = self._answers[question] = _Answer(value, set(), 1 + self._answers[table,].height)
        return known.value

    def conclude(self, view: View, question: Question) -> Any:
        """The answer of a conclusion."""
        self._asked.add(question)
        known = self._answers.get(question)
        return self._draw(view, question) if known is None or question in self._stale else known.value

    def unknown(self, what: object, about: Sequence[str]) -> list[str]:
        """What of it a conclusion must be drawn of if somebody asks; whoever wants to know will ask."""
        answers, stale = self._answers, self._stale
        if self._known_of.get(what) is about:
            others = {question[1] for question in stale if question[0] is what}
            return [each for each in about if each in others] if others else []
        self._known_of[what] = about
        return [each for each in about if (what, each) not in answers or (stale and (what, each) in stale)]

    def conclude_each(self, view: View, what: object, about: Collection[object]) -> list[Any]:
        """The answers of one conclusion about many things, about which nobody else asks it.  After an edit nearly all
        of these are those of before, and to put all questions together again would take longer than the few answers."""
        before, loose = self._each.get(what, ({}, set()))
        found = dict(zip(about, map(before.get, about, repeat(None)), strict=True))
        missing = (found.keys() - before.keys()) | (found.keys() & loose)
        for each in missing:
            self._askers.setdefault((what, each), set()).add(EVERYTHING)
        loose = set()  # of which the answer is not kept
        while missing := missing | {each[1] for each in self._stale if each[0] is what and each[1] in found}:
            for each in [each for each in found if each in missing]:
                found[each] = self._draw(view, (what, each))
                if (what, each) not in self._answers:
                    loose.add(each)
            missing = set()
        self._each[what] = found, loose
        self._leave([(what, each) for each in before.keys() - found.keys()], EVERYTHING)
        return [*found.values()]

    def conclude_early(self, view: View, question: Question) -> Any:
        """The same, for whoever will ask."""
        asked, self._asked = self._asked, self._outermost
        value = self.conclude(view, question)
        self._asked = asked
        return value

    def note_everything(self) -> None:
        """What is asked now rests on more than can be said."""
        self._asked.add(EVERYTHING)

    def watch(self, find: Callable[[], T]) -> tuple[T, bool]:
        """What a part of a conclusion finds, and whether it rests on everything; if so, the conclusion does not rest
        on the part."""
        outer, self._asked = self._asked, set()
        found = find()
        asked, self._asked = self._asked, outer
        if EVERYTHING in asked:
            return found, True
        outer |= asked
        return found, False

    def _draw(self, view: View, question: Question) -> Any:
        """Draw a conclusion.  What it asks for the first time may be about to be drawn again itself; then this is, too,
        if that makes a difference."""
        self._stale.discard(question)
        outer, self._asked = self._asked, set()
        value = question[0](view, *question[1:])
        asked, self._asked = self._asked, outer
        known = self._answers.get(question)
        is_table = question in self._tables
        if is_table and EVERYTHING in asked:
            outer.add(EVERYTHING)
            asked.remove(EVERYTHING)
            self._restless.add(question)
        if EVERYTHING in asked:
            outer.discard(question)
            outer.add(EVERYTHING)
            if known is not None:
                self._pass_on(question)
                self._leave(self._forget(question), question)
            return value
        height = 1 + max([self._answers[each].height for each in asked if each in self._answers], default=0)
        if known is not None and _is_same(value, known.value):
            value = known.value  # with what was found out of it meanwhile
        self._answers[question] = _Answer(value, asked, height)
        if known is not None and value is not known.value:
            self._pass_on(question)
            if is_table:
                self._pass_on_parts(question[0], known.value, value)
        before: set[Question] = (known.asked if known is not None else None) or set()
        for each in asked - before:
            self._askers.setdefault(each, set()).add(question)
        self._leave(before - asked, question)
        return value

    def _pass_on(self, question: Question) -> None:
        """An answer is another one: what rests on it is to be drawn again, the lowest first."""
        for asker in self._askers.get(question, ()):
            if asker not in self._stale and asker in self._answers and asker not in self._restless:
                self._stale.add(asker)
                if self._askers.get(asker) != _OUTSIDE:
                    self._count += 1
                    heappush(self._waiting, (self._answers[asker].height, self._count, asker))

    def _pass_on_parts(self, table: object, before: Any, now: Any) -> None:
        """A table is another one: what it says of some things may be as it was."""
        others = [item for item, value in now.items() if value is not before.get(item)]
        for item in (*others, *(before.keys() - now.keys())):
            question = table, item
            known = self._answers.get(question)
            if known is not None and not _is_same(now.get(item), known.value):
                self._answers[question] = _Answer(now.get(item), set(), known.height)
                self._pass_on(question)

    def _leave(self, questions: Iterable[Question], asker: Question) -> None:
        """Somebody asks these no more; what nobody asks is forgotten."""
        waiting = [(each, asker) for each in questions]
        while waiting:
            question, asker = waiting.pop()
            askers = self._askers.get(question, set())
            askers.discard(asker)
            if not askers and self._askers.pop(question, None) is not None:
                waiting += [(each, question) for each in self._forget(question)]

    def _forget(self, question: Question) -> Iterable[Question]:
        """Forget an answer; what it rests on."""
        self._stale.discard(question)
        known = self._answers.pop(question, None)
        if known is None:
            return ()
        self._known_of.pop(question[0], None)
        if known.asked is None:
            self._look_ups.discard(question)
            if (of_name := self._named.get(question[1:])) is not None:
                of_name.discard(question)
                if not of_name:
                    del self._named[question[1:]]
            return ()
        return known.asked


def _is_same(value: object, before: object) -> bool:
    return value is before or value == before


def _touched(before: File, after: File) -> Iterator[Name]:
    """The names that are defined by items which only one of two states of a file has."""
    if before is not after:
        known, facts = before.facts, after.facts
        for item in known.keys() ^ facts.keys():
            for symbol in (known.get(item) or facts[item]).summary.symbols:
                yield symbol.kind, symbol.name
