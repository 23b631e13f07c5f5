"""The semantic tokens of a file as an editor takes them, made of parts that are kept with its items.

One invariant: `data` is `encode` of the file's semantic tokens, whatever was kept.  An edit makes anew the parts
that it touches; of the others nothing changes but the number of lines before them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from operator import is_

from btq_lang.features.semantic_tokens import Known, Stretch, encode, stretches, tokens_of_stretch
from btq_lang.file import File
from btq_lang.record import Record
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

    def __init__(self, items: tuple[object, ...], encoding: Encoding, known: Known, part: Part) -> None:
        self.items = items
        self.encoding = encoding
        self.names = frozenset(known.asked)
        self.answers = known.answers(self.names)
        self.world = known.world
        self.part = part

    def holds(self, items: tuple[object, ...], encoding: Encoding, known: Known) -> bool:
        """Whether the part would be made again as it is."""
        if self.encoding != encoding or len(self.items) != len(items) or not all(map(is_, self.items, items)):
            return False
        if self.world != known.world:
            if self.answers != known.answers(self.names):
                return False
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


def colours(workspace: Workspace, path: str, encoding: Encoding) -> Colours:
    """The semantic tokens of a file."""
    file = workspace.files[path]
    known = Known(workspace, path)
    parts: list[Part] = []
    firsts: list[int] = []
    lines = 0
    for stretch in stretches(file.parsed, len(file.text)):
        part = _part(file, stretch, known, encoding)
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
    file = workspace.files[path]
    known = Known(workspace, path)
    for done, stretch in enumerate(stretches(file.parsed, len(file.text)), 1):
        _part(file, stretch, known, encoding)
        if done % _A_STEP == 0:
            yield


def _part(file: File, stretch: Stretch, known: Known, encoding: Encoding) -> Part:
    """The part of a stretch, made anew where what is kept does not hold."""
    items = tuple([entry.item for entry in stretch.entries])
    facts = file.facts[id(items[0])] if items else None
    kept = facts.colours if facts is not None else None
    if isinstance(kept, Kept) and kept.holds(items, encoding, known):
        return kept.part
    known.asked = set()
    text = file.text[stretch.start : stretch.end]
    data = encode(tokens_of_stretch(file, stretch, known), text, encoding)
    rest = len(LINE_END.findall(text)) - sum(data[::5])
    part = Part(tuple(data), rest, "".join([f",{number}" for number in data[1:]]))
    if facts is not None:
        facts.colours = Kept(items, encoding, known, part)
    return part


def delta(before: Colours, after: Colours) -> tuple[int, int, list[int]] | None:
    """What to replace in the data of `before` to have that of `after`: from where, how many integers, and by what;
    None: nothing."""
    shorter = min(len(before.parts), len(after.parts))
    start = 0
    while start < shorter and _is_same(before, start, after, start):
        start += 1
    end = 0
    while end < shorter - start and _is_same(before, -1 - end, after, -1 - end):
        end += 1
    changed = difference(_joined(before, start, len(before.parts) - end), _joined(after, start, len(after.parts) - end))
    if changed is None:
        return None
    at, gone, come = changed
    return sum([len(part.data) for part in before.parts[:start]]) + at, gone, come


def difference(before: Sequence[int], after: Sequence[int]) -> tuple[int, int, list[int]] | None:
    """As `delta`, of the integers themselves."""
    if list(before) == list(after):
        return None
    start = 0
    shorter = min(len(before), len(after))
    while start < shorter and before[start] == after[start]:
        start += 1
    start -= start % 5
    end = 0
    while end < shorter - start and before[-1 - end] == after[-1 - end]:
        end += 1
    end -= end % 5
    return start, len(before) - end - start, list(after[start : len(after) - end])


_A_STEP = 10  # stretches, of some 20 nodes each: 10 to 30 ms


def _is_same(before: Colours, index: int, after: Colours, other: int) -> bool:
    return before.parts[index] is after.parts[other] and before.firsts[index] == after.firsts[other]


def _joined(colours: Colours, start: int, end: int) -> list[int]:
    data: list[int] = []
    for first, part in zip(colours.firsts[start:end], colours.parts[start:end], strict=True):
        data.append(first)
        data += part.data[1:]
    return data
