"""What stays of a file that nobody works in, in little room: its text, and the names in it.

One invariant: what is unpacked is what was packed, for every string.  Of a hundred files that are held so that an edit
elsewhere can be checked, texts and names were more than all else.
"""

from __future__ import annotations

from collections.abc import Set
from zlib import compress, decompress

from btq_lang.name_kinds import Kind

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from typing import Any

    from btq_lang.facts import Name


def packed_text(text: str) -> bytes:
    """A text in a fifth of its room, in four microseconds a kilobyte; a lone half of a pair is kept as it is."""
    return compress(text.encode("utf-8", "surrogatepass"), _FASTEST)


def unpacked_text(packed: bytes) -> str:
    return decompress(packed).decode("utf-8", "surrogatepass")


def packed_names(names: frozenset[Name] | PackedNames) -> frozenset[Name] | PackedNames:
    """The same names, where it can be in little room: a twentieth of what a set of them takes."""
    if isinstance(names, PackedNames) or any(_END in name for _, name in names):
        return names
    return PackedNames(names)


class PackedNames(Set["Name"]):
    """Names as one text for each kind, each name between two signs that are in none of them."""

    __slots__ = ("_lists", "_size")

    def __init__(self, names: frozenset[Name]) -> None:
        by_kind: dict[Kind, list[str]] = {}
        for kind, name in names:
            by_kind.setdefault(kind, []).append(name)
        self._lists = {kind: f"{_END}{_END.join(found)}{_END}" for kind, found in by_kind.items()}
        self._size = len(names)

    @classmethod
    def _from_iterable(cls, names: Iterable[Name]) -> frozenset[Name]:  # type: ignore[override]  # a set like others
        return frozenset(names)

    def of(self, kind: Kind) -> tuple[str, ...]:
        """The names of a kind: a completion asks every file for them."""
        found = self._lists.get(kind)
        return tuple(found[1:-1].split(_END)) if found is not None else ()

    def __contains__(self, key: Any) -> bool:
        kind, name = key
        return f"{_END}{name}{_END}" in self._lists.get(kind, "")

    def __iter__(self) -> Iterator[Name]:
        return ((kind, name) for kind in self._lists for name in self.of(kind))

    def __len__(self) -> int:
        return self._size


_END = "\0"
_FASTEST = 1
