"""The diagnostics of a file: those of each item, with offsets from its start, and these starts.

One invariant: the diagnostics of an item are one object as long as they are equal, however far the item moves.  So
after an edit, offsets of items that only moved are not recomputed until they are needed.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from btq_lang.diagnostics.model import Diagnostic, Place, relocated

if TYPE_CHECKING:
    from btq_lang.workspace.workspace import Workspace


class Reported:
    """The diagnostics of an item.

    Attributes:
        diagnostics: in the order of the text, counted from the start of the item.
        items: the item, then the others that places count from, each after its file; empty if everything counts from
            the start of a file.
        fixed: the related places that do, after their files.
        written: a cache for their writer.
    """

    __slots__ = ("diagnostics", "fixed", "items", "written")

    def __init__(self, diagnostics: Iterable[Diagnostic], *item: tuple[str, object]) -> None:
        """item: its file and itself."""
        self.diagnostics = in_order(diagnostics)
        related = [each.place for diagnostic in self.diagnostics for each in diagnostic.related]
        changed = [
            change.place for diagnostic in self.diagnostics for fix in diagnostic.fixes for change in fix.changes
        ]
        anchors = {id(place.anchor): place for place in (*related, *changed)}.values()
        others = [
            (place.path, place.anchor) for place in anchors if place.path is not None and place.anchor is not None
        ]
        self.items = (*item, *others)
        self.fixed = tuple(
            [(place.path, place.span) for place in related if place.path is not None and place.anchor is None]
        )
        self.written: Any = None

    def __eq__(self, other: object) -> bool:
        """Whether both have equal diagnostics of the very same item."""
        return isinstance(other, Reported) and (
            self.diagnostics == other.diagnostics and all(map(_is_same, self.items, other.items))
        )

    __hash__ = None  # type: ignore[assignment]  # it is never hashed

    def starts(self, workspace: Workspace) -> list[int]:
        """The starts of the items."""
        files = workspace.files
        return [files[path].start_of(item) for path, item in self.items]

    def counted_from(self) -> list[int]:
        """The index of the item that the span of each diagnostic counts from, followed by those of its related places;
        -1 for one that counts from the start of its file.
        """
        numbers = {id(item): number for number, (_, item) in enumerate(self.items)}
        indices: list[int] = []
        for diagnostic in self.diagnostics:
            places = [each.place for each in diagnostic.related]
            own = [0 if place.path is None else -1 for place in places]
            indices += (0, *(numbers.get(id(place.anchor), number) for place, number in zip(places, own, strict=True)))
        return indices

    def placed(self, starts: Sequence[int]) -> list[Diagnostic]:
        """The diagnostics, with every place counted from the start of its file; `starts`: of the items."""
        of_item = dict(zip([id(item) for _, item in self.items], starts, strict=True))
        return [_placed(each, starts[0] if starts else 0, of_item) for each in self.diagnostics]


class FileFindings:
    """The diagnostics of a file.

    Attributes:
        of_items: the diagnostics of each item that has any, in the order of the text, with the starts of the items that
            they count from.
    """

    def __init__(self, of_items: list[tuple[Reported, list[int]]]) -> None:
        self.of_items = of_items
        self._diagnostics: tuple[Diagnostic, ...] | None = None

    @classmethod
    def placed(cls, diagnostics: Iterable[Diagnostic]) -> FileFindings:
        """The diagnostics of a file that count from its start already."""
        reported = Reported(diagnostics)
        return cls([(reported, [])] if reported.diagnostics else [])

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """All diagnostics in the order of the text, counted from the start of the file."""
        if self._diagnostics is None:
            placed = (each for reported, starts in self.of_items for each in reported.placed(starts))
            self._diagnostics = in_order(placed)
        return self._diagnostics


def in_order(diagnostics: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    """In the order of the text, and at one place in that of their rules."""
    return tuple(sorted(diagnostics, key=lambda each: (each.span, each.rule)))


def _is_same(one: tuple[str, object], other: tuple[str, object]) -> bool:
    return one[0] == other[0] and one[1] is other[1]


def _placed(diagnostic: Diagnostic, by: int, starts: dict[int, int]) -> Diagnostic:
    def absolute(place: Place) -> Place:
        if place.path is None:
            return Place(place.span.shifted(by)) if place.anchor is None else place
        return Place(place.span.shifted(starts[id(place.anchor)]), place.path) if place.anchor is not None else place

    return relocated(diagnostic, diagnostic.span.shifted(by), absolute)
