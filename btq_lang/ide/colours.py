"""Semantic tokens, the type of each word for colouring, as LSP 3.16 encodes them: five integers a token, in parts that
the query store keeps.

One invariant: `data` does not depend on the cache.  An edit recomputes the parts that it touches; of the others, only
the number of lines before them changes.
"""

from __future__ import annotations

import json
from bisect import bisect_right
from collections.abc import Iterator, Sequence
from itertools import pairwise

from btq_lang.ide.stretches import encoded
from btq_lang.util.record import Record
from btq_lang.util.text import LINE_END, Encoding, Span, alike
from btq_lang.workspace import inputs
from btq_lang.workspace.item_index import Facts
from btq_lang.workspace.queries import Store
from btq_lang.workspace.workspace import Workspace


class EncodedTokens(Record):
    """The encoded tokens of an item and of the text after it.

    Attributes:
        first: the first integer: how many line ends precede the first token.
        others: the other integers in JSON, each after its comma; empty without tokens.
        rest: how many line ends follow the start of the last token, if there is one.
    """

    first: int
    others: str
    rest: int


class Colours(Record):
    """The tokens of a file.

    Attributes:
        parts: of each item that has any, the first integer, which counts the lines since the token before; what tells
            the item from others with equal tokens; and the other integers, as in `Part`.
    """

    parts: tuple[tuple[int, int, str], ...]

    @property
    def data(self) -> list[int]:
        """The integers, five a token."""
        data: list[int] = json.loads(self.as_json)
        return data

    @property
    def as_json(self) -> str:
        """`data` as a JSON list."""
        return f"[{','.join([f'{first}{others}' for first, _, others in self.parts])}]"


class TokenEdit(Record):
    """An edit of `data`: its start, the number of integers to delete, and those to insert; offsets count before any
    other edit."""

    start: int
    delete_count: int
    data: list[int]


def colours(workspace: Workspace, path: str, encoding: Encoding) -> Colours:
    """The semantic tokens of a file, kept from one edit to the next until `forget`."""
    workspace.store.pin(_parts, path, encoding)
    parts: list[tuple[int, int, str]] = []
    lines = 0
    for item, part in zip(workspace.store.ask(_items, path), workspace.store.ask(_parts, path, encoding), strict=True):
        if part.others:
            parts.append((lines + part.first, id(item), part.others))
            lines = 0
        lines += part.rest
    return Colours(tuple(parts))


def forget(workspace: Workspace, path: str, encoding: Encoding) -> None:
    """Stop keeping the tokens of a file."""
    workspace.store.unpin(_parts, path, encoding)


def making(workspace: Workspace, path: str, encoding: Encoding) -> Iterator[None]:
    """Compute the parts of a file in advance: for a large file that takes noticeable time, so the caller may do
    something else between two steps."""
    for count, item in enumerate(workspace.store.ask(_items, path), 1):
        workspace.store.ask(_part, path, encoding, item)
        if count % _A_STEP == 0:
            yield


def _parts(store: Store[Workspace], path: str, encoding: Encoding) -> tuple[EncodedTokens, ...]:
    """The parts of the items of a file."""
    return tuple([store.ask(_part, path, encoding, item) for item in store.ask(_items, path)])


def _part(store: Store[Workspace], path: str, encoding: Encoding, item: Facts | None) -> EncodedTokens:
    text = store.ask(inputs.text, path, item) if item is not None else store.ask(_beginning, path)
    tokens, line = encoded(store, path, item, text, encoding)
    return part_of(tokens, (len(LINE_END.findall(text)) if "\r" in text else text.count("\n")) - line)


def part_of(tokens: list[str], rest: int) -> EncodedTokens:
    """The part of some tokens, of which the start of the last one precedes so many line ends."""
    first, _, others = ",".join(tokens).partition(",")
    return EncodedTokens(int(first), f",{others}", rest) if tokens else EncodedTokens(0, "", rest)


@inputs.of_viewpoint
def _items(workspace: Workspace, path: str) -> tuple[Facts | None, ...]:
    """The items of a file; the text before the first one counts as one, too."""
    return (None, *workspace.files[path].facts.values())


@inputs.of_viewpoint
def _beginning(workspace: Workspace, path: str) -> str:
    """The text before the first item."""
    file = workspace.files[path]
    return file.text[: file.parsed.entries[0].start] if file.parsed.entries else file.text


def delta(before: Colours, after: Colours) -> list[TokenEdit]:
    """The edits that turn the data of `before` into that of `after`, in the order of the text: one at most between two
    parts that are the same."""
    places = {part: place for place, part in enumerate(before.parts)}
    same = [(-1, -1)]  # the places of a part before and after
    for other, part in enumerate(after.parts):
        if (place := places.get(part, -1)) > same[-1][0]:
            same.append((place, other))
    changes: list[TokenEdit] = []
    offset = 0
    for (start, other_start), (end, other_end) in pairwise((*same, (len(before.parts), len(after.parts)))):
        removed, added = Colours(before.parts[start + 1 : end]), Colours(after.parts[other_start + 1 : other_end])
        if (removed.parts or added.parts) and (change := difference(removed.data, added.data)):
            changes.append(TokenEdit(offset + change.start, change.delete_count, change.data))
        offset += sum([others.count(",") + 1 for _, _, others in before.parts[start + 1 : end + 1]])
    return changes


def difference(before: Sequence[int], after: Sequence[int]) -> TokenEdit | None:
    """The one change that turns the first into the second, in whole tokens; None if they are equal."""
    shorter = min(len(before), len(after))
    start = alike(before, after)
    if start == len(before) == len(after):
        return None
    start -= start % 5
    end = min(alike(before[::-1], after[::-1]), shorter - start)
    end -= end % 5
    return TokenEdit(start, len(before) - end - start, list(after[start : len(after) - end]))


def encoded_within(workspace: Workspace, path: str, within: Span, encoding: Encoding) -> list[int]:
    """The tokens on the lines that a span touches; computed without those of items before them."""
    file = workspace.files[path]
    first, last = (file.lines.position(offset).line for offset in within)
    items = workspace.store.ask(_items, path)
    starts = [0, *(entry.start for entry in file.parsed.entries)]
    data: list[int] = []
    previous = 0
    for index in range(bisect_right(starts, within.start) - 1, bisect_right(starts, within.end)):
        part = workspace.store.ask(_part, path, encoding, items[index])
        line = file.lines.position(starts[index]).line
        integers = iter(Colours(((part.first, 0, part.others),) if part.others else ()).data)
        for down, *others in zip(*[integers] * 5, strict=True):
            line += down
            if first <= line <= last:
                data += (line - previous, *others)
                previous = line
    return data


_A_STEP = 20  # items, of some 20 nodes each: a few milliseconds
