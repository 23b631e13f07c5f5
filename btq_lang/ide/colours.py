"""Semantic tokens, the type of each word for colouring, as LSP 3.16 encodes them: five integers a token, in parts that
are cached with the items of a file.

One invariant: `data` does not depend on the cache.  An edit recomputes the parts that it touches; of the others, only
the number of lines before them changes.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from itertools import pairwise
from operator import is_, is_not

from btq_lang.catalog.name_kinds import Kind
from btq_lang.ide.stretches import Encoded, Known, Stretch, encoded
from btq_lang.parser import Parsed
from btq_lang.syntax.tree import Entry
from btq_lang.util.record import Record
from btq_lang.util.text import LINE_END, Encoding, Span, alike
from btq_lang.workspace.workspace import Workspace


class Part(Record):
    """The encoded tokens of a stretch.

    Attributes:
        size: number of integers, five a token.
        first: the first integer: how many lines of the stretch precede its first token.
        shown: the other integers in JSON, each after its comma.
        rest: number of lines from the last token on; without tokens, of all lines.
    """

    size: int
    first: int
    shown: str
    rest: int


class Kept:
    """A cached part, and what it depends on.

    Attributes:
        items: those of the stretch.
        names: looked up in the rest of the workspace; `answers`: the results; `world`: all that they could depend on.
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
        """Whether the part is still valid."""
        items = self.items
        if self.encoding != encoding or len(items) != len(entries):
            return False
        if len(items) > 1 and not all(map(is_, items, [entry.item for entry in entries])):
            return False  # of an equal item, the facts may be known of the first only
        if self.world is not known.world:
            if self.world == known.world:
                known.world = self.world  # so that later parts need not compare name by name
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
        """The integers, five a token."""
        data: list[int] = json.loads(self.as_json)
        return data

    @property
    def as_json(self) -> str:
        """`data` as a JSON list."""
        return _as_json(self, 0, len(self.parts))


class Change(Record):
    """An edit of `data`: its start, the number of integers to delete, and those to insert; offsets count before any
    other edit."""

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
    """Compute the parts of a file in advance: for a large file that takes noticeable time, so the caller may do
    something else between two steps."""
    for done, _ in enumerate(_parts(workspace, path, encoding), 1):
        if done % _A_STEP == 0:
            yield


def _parts(workspace: Workspace, path: str, encoding: Encoding) -> Iterator[Part]:
    """The parts of a file's stretches; those that are no longer valid are recomputed."""
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
    return part_of(encoded(text, stretch, known, encoding), lines)


def part_of(made: Encoded, lines: int) -> Part:
    """The part of encoded tokens, in a text of so many lines."""
    if not made.tokens:
        return Part(0, 0, "", lines)
    first = made.tokens[0].partition(",")[0]
    return Part(5 * len(made.tokens), int(first), ",".join(made.tokens)[len(first) :], lines - made.line)


def delta(before: Colours, after: Colours) -> list[Change]:
    """The edits that turn the data of `before` into that of `after`, in the order of the text.  Parts that are the same
    object are not compared further, however many changed around them."""
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
    """The number of parts that are the same from two of them on, with as many lines before them."""
    parts = alike(first.parts[start:], second.parts[other_start:], is_not)
    return min(parts, alike(first.firsts[start:], second.firsts[other_start:]))


def difference(before: Sequence[int], after: Sequence[int]) -> Change | None:
    """The one change that turns the first into the second, in whole tokens; None if they are equal."""
    shorter = min(len(before), len(after))
    start = alike(before, after)
    if start == len(before) == len(after):
        return None
    start -= start % 5
    end = min(alike(before[::-1], after[::-1]), shorter - start)
    end -= end % 5
    return Change(start, len(before) - end - start, list(after[start : len(after) - end]))


def _size(colours: Colours, start: int, end: int) -> int:
    return sum([part.size for part in colours.parts[start:end]])


def _as_json(colours: Colours, start: int, end: int) -> str:
    parts = zip(colours.firsts[start:end], colours.parts[start:end], strict=True)
    return f"[{','.join([f'{first}{part.shown}' for first, part in parts])}]"


def encoded_within(workspace: Workspace, path: str, within: Span, encoding: Encoding) -> list[int]:
    """The tokens on the lines that a span touches; computed without those before them."""
    file = workspace.files[path]
    known = known_of(workspace, path)
    first, last = (file.lines.position(offset).line for offset in within)
    data: list[int] = []
    at = 0
    for begin, end in groups(file.parsed):
        stretch = stretch_of(file.parsed, len(file.text), begin, end)
        if stretch.start > within.end or stretch.end < within.start:
            continue
        line = file.lines.position(stretch.start).line
        for token in encoded(file.text[stretch.start : stretch.end], stretch, known, encoding).tokens:
            down, *others = json.loads(f"[{token}]")
            line += down
            if first <= line <= last:
                data += (line - at, *others)
                at = line
    return data


def known_of(workspace: Workspace, path: str) -> Known:
    """What a file's workspace knows of names."""
    scope = workspace.scope(path)
    return Known((workspace.edition(path), scope.names(Kind.TREE), scope.names(Kind.QUALITY)))


def groups(parsed: Parsed) -> list[tuple[int, int]]:
    """The entries of each stretch of a file: the indices of the first and after the last.  Joined, the stretches are
    the file; there are none before the first item."""
    entries = parsed.entries
    begins = [index for index, start in enumerate(parsed.starts) if start is not None or index == 0]
    found = [*pairwise((*begins, len(entries)))]
    return found if entries and not entries[0].start else [(0, 0), *found]


def stretch_of(parsed: Parsed, size: int, begin: int, end: int) -> Stretch:
    """The stretch of these entries."""
    entries = parsed.entries
    start = entries[begin].start if end else 0
    return Stretch(start, entries[end].start if end < len(entries) else size, entries[begin:end])


_A_STEP = 20  # stretches, of some 20 nodes each: a few milliseconds
