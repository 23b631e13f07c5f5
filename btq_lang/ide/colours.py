"""The semantic tokens of a file as an editor takes them, made of parts that are kept with its items.

One invariant: `data` is the same whatever was kept.  An edit makes anew the parts that it touches; of the others
nothing changes but the number of lines before them.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from itertools import compress, count
from operator import is_, is_not, ne
from typing import TypeVar

from btq_lang.ide.semantic_tokens import groups, known_of, stretch_of
from btq_lang.ide.stretches import Known, Stretch, encoded
from btq_lang.syntax.tree import Entry
from btq_lang.util.record import Record
from btq_lang.util.text import LINE_END, Encoding
from btq_lang.workspace.workspace import Workspace

T = TypeVar("T")


class Part(Record):
    """The tokens of a stretch.

    Attributes:
        size: how many integers they are, five a token.
        first: the first one: how many lines of the stretch stand before its first token.
        shown: the others as JSON has them, each behind its comma.
        rest: how many lines the stretch has from its last token on, or all in all.
    """

    size: int
    first: int
    shown: str
    rest: int


class Kept:
    """A part, and what it holds for.

    Attributes:
        items: those of the stretch.
        names: what was asked of the rest of the workspace; `answers`: what that said; `world`: all that it could say.
    """

    __slots__ = ("answers", "encoding", "items", "names", "part", "world")

    def __init__(self, stretch: Stretch, encoding: Encoding, known: Known, part: Part) -> None:
        self.items = tuple([entry.item for entry in stretch.entries])
        self.encoding = encoding
        self.names = frozenset(known.asked)
        self.answers = known.answers(self.names)
        self.world = known.world
        self.part = part

    def holds(self, entries: Sequence[Entry], encoding: Encoding, known: Known) -> bool:
        """Whether the part would be made again as it is."""
        items = self.items
        if self.encoding != encoding or len(items) != len(entries):
            return False
        if len(items) > 1 and not all(map(is_, items, [entry.item for entry in entries])):
            return False  # of one it is known, for these are the facts of the first
        if self.world is not known.world:
            if self.world == known.world:
                known.world = self.world  # so that those behind it need not be compared name by name
            elif self.answers != known.answers(self.names):
                return False
            else:
                self.world = known.world
        return True


class Colours(Record):
    """The tokens of a file: parts with at least one, and the first integer of each, lines since the token before."""

    parts: tuple[Part, ...]
    firsts: tuple[int, ...]

    @property
    def data(self) -> list[int]:
        """Five integers a token."""
        data: list[int] = json.loads(self.as_json)
        return data

    @property
    def as_json(self) -> str:
        """The same, as JSON has a list of it."""
        return _as_json(self, 0, len(self.parts))


class Change(Record):
    """An edit of `data`: from where, how many integers go, and what comes for them; what it counts is there before
    any other edit is made."""

    start: int
    gone: int
    come: list[int]


def colours(workspace: Workspace, path: str, encoding: Encoding) -> Colours:
    """The semantic tokens of a file."""
    parts: list[Part] = []
    firsts: list[int] = []
    lines = 0
    for part in _parts(workspace, path, encoding):
        if part.size:
            parts.append(part)
            firsts.append(lines + part.first)
            lines = part.rest
        else:
            lines += part.rest
    return Colours(tuple(parts), tuple(firsts))


def making(workspace: Workspace, path: str, encoding: Encoding) -> Iterator[None]:
    """Make the parts of a file before they are asked for: of a large one that takes longer than anybody waits, so
    whoever does it may do something else between two steps."""
    for done, _ in enumerate(_parts(workspace, path, encoding), 1):
        if done % _A_STEP == 0:
            yield


def _parts(workspace: Workspace, path: str, encoding: Encoding) -> Iterator[Part]:
    """The parts of a file's stretches, made anew where what is kept does not hold."""
    file = workspace.files[path]
    known = known_of(workspace, path)
    facts = file.facts
    entries = file.parsed.entries
    for begin, end in groups(file.parsed):
        first = facts[id(entries[begin].item)] if end else None
        kept = first.colours if first is not None else None
        if isinstance(kept, Kept) and kept.holds(entries[begin:end], encoding, known):
            yield kept.part
            continue
        stretch = stretch_of(file.parsed, len(file.text), begin, end)
        part = _made(file.text, stretch, known, encoding)
        if first is not None:
            first.colours = Kept(stretch, encoding, known, part)
        yield part


def _made(whole: str, stretch: Stretch, known: Known, encoding: Encoding) -> Part:
    known.asked = set()
    text = whole[stretch.start : stretch.end]
    lines = len(LINE_END.findall(text)) if "\r" in text else text.count("\n")
    made = encoded(text, stretch, known, encoding)
    if not made.tokens:
        return Part(0, 0, "", lines)
    first = made.tokens[0].partition(",")[0]
    return Part(5 * len(made.tokens), int(first), ",".join(made.tokens)[len(first) :], lines - made.line)


def delta(before: Colours, after: Colours) -> list[Change]:
    """What to replace in the data of `before` to have that of `after`, in the order of the text.  A part that is the
    same object is no further looked at, however many have changed before and behind it."""
    places = {id(part): index for index, part in enumerate(before.parts)}
    size, other_size = len(before.parts), len(after.parts)
    changes: list[Change] = []
    place = index = integers = 0
    while place < size or index < other_size:
        start, other_start = place, index
        while index < other_size:  # to the next part that is the same, with as many lines before it
            place = places.get(id(after.parts[index]), -1)
            if place >= start and before.firsts[place] == after.firsts[index]:
                break
            index += 1
        else:
            place = size
        if place > start or index > other_start:
            gone, come = _as_json(before, start, place), _as_json(after, other_start, index)
            changed = difference(json.loads(gone), json.loads(come)) if gone != come else None
            if changed is not None:
                changes.append(Change(integers + changed.start, changed.gone, changed.come))
            integers += _size(before, start, place)
        same = _same(before, place, after, index)
        integers += _size(before, place, place + same)
        place += same
        index += same
    return changes


def _same(first: Colours, start: int, second: Colours, other_start: int) -> int:
    """How many parts are the same from two of them on, with as many lines before them."""
    parts = _alike(first.parts[start:], second.parts[other_start:], is_not)
    return min(parts, _alike(first.firsts[start:], second.firsts[other_start:], ne))


def difference(before: Sequence[int], after: Sequence[int]) -> Change | None:
    """The one change that makes the second of the first, from token to token; None: they are the same."""
    shorter = min(len(before), len(after))
    start = _alike(before, after, ne)
    if start == len(before) == len(after):
        return None
    start -= start % 5
    end = min(_alike(before[::-1], after[::-1], ne), shorter - start)
    end -= end % 5
    return Change(start, len(before) - end - start, list(after[start : len(after) - end]))


def _alike(first: Sequence[T], second: Sequence[T], differ: Callable[[T, T], bool]) -> int:
    """How many are the same from the start on."""
    return next(compress(count(), map(differ, first, second)), min(len(first), len(second)))


def _size(colours: Colours, start: int, end: int) -> int:
    return sum([part.size for part in colours.parts[start:end]])


def _as_json(colours: Colours, start: int, end: int) -> str:
    parts = zip(colours.firsts[start:end], colours.parts[start:end], strict=True)
    return f"[{','.join([f'{first}{part.shown}' for first, part in parts])}]"


_A_STEP = 20  # stretches, of some 20 nodes each: a few milliseconds
