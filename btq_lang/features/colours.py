"""The semantic tokens of a file as an editor takes them, made of parts that are kept with its items.

One invariant: `data` is `encode` of the file's semantic tokens, whatever was kept.  An edit makes anew the parts
that it touches; of the others nothing changes but the number of lines before them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import compress, count
from operator import is_, ne

from btq_lang.features.semantic_tokens import Known, Stretch, encode, stretches, tokens_of_stretch
from btq_lang.file import File
from btq_lang.record import Record
from btq_lang.syntax import Entry
from btq_lang.text import LINE_END, Encoding
from btq_lang.workspace import Workspace


class Part(Record):
    """The tokens of a stretch.

    Attributes:
        data: five integers a token, from the first line of the stretch on.
        rest: how many lines the stretch has from its last token on, or all in all.
        shown: `data` as JSON has it, but for its first integer.
    """

    data: tuple[int, ...]
    rest: int
    shown: str


class Kept:
    """A part, and what it holds for.

    Attributes:
        items: those of the stretch.
        names: what was asked of the rest of the workspace; `answers`: what that said; `world`: all that it could say.
    """

    __slots__ = ("answers", "encoding", "items", "names", "part", "world")

    def __init__(self, entries: tuple[Entry, ...], encoding: Encoding, known: Known, part: Part) -> None:
        self.items = tuple([entry.item for entry in entries])
        self.encoding = encoding
        self.names = frozenset(known.asked)
        self.answers = known.answers(self.names)
        self.world = known.world
        self.part = part

    def holds(self, entries: tuple[Entry, ...], encoding: Encoding, known: Known) -> bool:
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
        return _joined(self, 0, len(self.parts))

    @property
    def as_json(self) -> str:
        """The same, as JSON has a list of it."""
        return f"[{','.join([f'{first}{part.shown}' for first, part in zip(self.firsts, self.parts, strict=True)])}]"


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
        if part.data:
            parts.append(part)
            firsts.append(lines + part.data[0])
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
    known = Known(workspace, path)
    facts = file.facts
    for stretch in stretches(file.parsed, len(file.text)):
        first = facts[id(stretch.entries[0].item)] if stretch.entries else None
        kept = first.colours if first is not None else None
        if isinstance(kept, Kept) and kept.holds(stretch.entries, encoding, known):
            yield kept.part
            continue
        part = _made(file, stretch, known, encoding)
        if first is not None:
            first.colours = Kept(stretch.entries, encoding, known, part)
        yield part


def _made(file: File, stretch: Stretch, known: Known, encoding: Encoding) -> Part:
    known.asked = set()
    text = file.text[stretch.start : stretch.end]
    data = encode(tokens_of_stretch(file.text, stretch, known), text, encoding)
    rest = len(LINE_END.findall(text)) - sum(data[::5])
    return Part(tuple(data), rest, "".join([f",{number}" for number in data[1:]]))


def delta(before: Colours, after: Colours) -> list[Change]:
    """What to replace in the data of `before` to have that of `after`, in the order of the text.  A part that is the
    same object is no further looked at, however many have changed before and behind it."""
    places = {id(part): index for index, part in enumerate(before.parts)}
    changes: list[Change] = []
    done = other_done = integers = 0
    for index, part in enumerate((*after.parts, None)):
        place = places.get(id(part), -1) if part is not None else len(before.parts)
        if place < done or (part is not None and before.firsts[place] != after.firsts[index]):
            continue  # it is new, or other lines stand before it
        if place > done or index > other_done:
            gone, come = _joined(before, done, place), _joined(after, other_done, index)
            changed = difference(gone, come)
            if changed is not None:
                changes.append(Change(integers + changed.start, changed.gone, changed.come))
            integers += len(gone)
        if part is not None:
            integers += len(part.data)
            done, other_done = place + 1, index + 1
    return changes


def difference(before: Sequence[int], after: Sequence[int]) -> Change | None:
    """The one change that makes the second of the first, from token to token; None: they are the same."""
    shorter = min(len(before), len(after))
    start = _alike(before, after)
    if start == len(before) == len(after):
        return None
    start -= start % 5
    end = min(_alike(before[::-1], after[::-1]), shorter - start)
    end -= end % 5
    return Change(start, len(before) - end - start, list(after[start : len(after) - end]))


def _alike(first: Sequence[int], second: Sequence[int]) -> int:
    """How many integers are the same from the start on."""
    return next(compress(count(), map(ne, first, second)), min(len(first), len(second)))


_A_STEP = 10  # stretches, of some 20 nodes each: 10 to 30 ms


def _joined(colours: Colours, start: int, end: int) -> list[int]:
    data: list[int] = []
    for first, part in zip(colours.firsts[start:end], colours.parts[start:end], strict=True):
        data.append(first)
        data += part.data[1:]
    return data
