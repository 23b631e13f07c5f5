"""A placed figure: positions of all its boxes, notes and lines.

One invariant: nothing overlaps, and every text is inside what it belongs to.  Units are CSS pixels.  Notes are attached
to a leaf in the direction in which children would follow, and beside an inner node, so that its children stay below.
"""

from __future__ import annotations

from typing import Final, TypeAlias

from btq_lang.graph.figure import Box, Figure, MeasuredClause, Note
from btq_lang.graph.layout import Size, layout
from btq_lang.graph.widths import shortened, width, wrapped
from btq_lang.util.record import Record

TITLE: Final = 13  # sizes of letters
SMALL: Final = 11
LEADING: Final = 16  # from line to line
MARGIN: Final = 12

Line: TypeAlias = "tuple[tuple[int, int], ...]"


class Rectangle(Record):
    """Left, top, width and height."""

    x: int
    y: int
    w: int
    h: int

    @property
    def middle(self) -> tuple[int, int]:
        return self.x + self.w // 2, self.y + self.h // 2


class PlacedNote(Record):
    """A note.

    Attributes:
        lines: its texts, broken to fit, the title first, each with the height of its base line.
        sparklines: of what its clauses measured.
    """

    note: Note
    area: Rectangle
    lines: tuple[tuple[int, str], ...]
    sparklines: tuple[tuple[Rectangle, MeasuredClause], ...]


class PlacedBox(Record):
    """A box, its texts, broken to fit, and its notes.

    Attributes:
        edge: the line from its parent; none at the top.
        ties: the lines that connect its notes.
    """

    box: Box
    area: Rectangle
    lines: tuple[str, ...]
    notes: tuple[PlacedNote, ...]
    edge: Line
    ties: Line


class Drawing(Record):
    """A placed figure with its width and height."""

    title: str
    width: int
    height: int
    boxes: tuple[PlacedBox, ...]


def place(figure: Figure, direction: str = "down") -> Drawing:
    """Place everything in a figure that grows `down` or `right`."""
    down = direction == "down"
    inner = {box.parent for box in figure.boxes}
    parts = [_Part(box, number in inner, down) for number, box in enumerate(figure.boxes)]
    sizes = [Size(part.w, part.h, part.across) if down else Size(part.h, part.w, part.across) for part in parts]
    parents = [box.parent for box in figure.boxes]
    places = layout(sizes, parents, _GAP if down else _GAP // 2, _LEVEL_GAP)
    corners = [(x, y) if down else (y, x) for x, y in places]
    placed: list[PlacedBox] = []
    for part, (x, y), parent in zip(parts, corners, parents, strict=True):
        placed.append(part.placed(x + MARGIN, y + MARGIN, placed[parent] if parent is not None else None))
    right = max((x + part.w for part, (x, _) in zip(parts, corners, strict=True)), default=0)
    bottom = max((y + part.h for part, (_, y) in zip(parts, corners, strict=True)), default=0)
    return Drawing(figure.title, right + 2 * MARGIN, bottom + 2 * MARGIN, tuple(placed))


def note_lines(note: Note) -> tuple[str, ...]:
    """The title and the clauses; of a quality whose name is too wide the last part, the most specific."""
    return tuple(line for lines, _ in _sections(note) for line in lines)


def _sections(note: Note) -> list[tuple[tuple[str, ...], MeasuredClause | None]]:
    """The lines of a note, broken to fit; those of what a clause measured with its sparkline below them."""
    title = note.title
    if note.kind == "quality" and width(title, SMALL, bold=True) > _NOTE_ROOM:
        title = title.rpartition(".")[2]
    own = (shortened(title, SMALL, _NOTE_ROOM), *_wrapped(note.lines))
    return [(own, None), *((_wrapped(measured.lines), measured) for measured in note.measured)]


def _wrapped(lines: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(part for line in lines for part in wrapped(line, SMALL, _NOTE_ROOM, _NOTE_MOST))


class _Part:
    """A box with its notes, before it is placed.

    Attributes:
        w, h: of all of it.
        across: where its anchor is: the middle of the box.
    """

    def __init__(self, box: Box, is_inner: bool, down: bool) -> None:
        self._box = box
        self._down = down
        self._lines = (shortened(box.title, TITLE, _ROOM), *(shortened(line, SMALL, _ROOM) for line in box.lines))
        self._w, self._h = _box_size(box, self._lines)
        self._note_w = max(map(_note_width, box.notes), default=0)
        heights = [_note_height(note) for note in box.notes]
        notes_h = sum(heights) + _NOTE_GAP * (len(heights) - 1) if heights else 0
        self._heights = heights
        # To the right of the box: for leaves of trees that grow right, and inner nodes of trees that grow down.
        self._beside = bool(heights) and (is_inner if down else not is_inner)
        if self._beside:
            self.w = self._w + _TIE + self._note_w
            self.h = max(self._h, notes_h)
        elif heights:
            self.w = max(self._w, self._note_w + (0 if down else _INDENT))
            self.h = self._h + _TIE + notes_h
        else:
            self.w, self.h = self._w, self._h
        self._box_x = 0 if self._beside or not down else (self.w - self._w) // 2
        self._box_y = 0 if not self._beside or down else (self.h - self._h) // 2
        self.across = self._box_x + self._w // 2 if down else self._box_y + self._h // 2

    def placed(self, x: int, y: int, parent: PlacedBox | None) -> PlacedBox:
        area = Rectangle(x + self._box_x, y + self._box_y, self._w, self._h)
        notes: list[PlacedNote] = []
        if self._beside:
            left, top = area.x + area.w + _TIE, y
        elif self._down:
            left, top = x + (self.w - self._note_w) // 2, area.y + area.h + _TIE
        else:
            left, top = x + _INDENT, area.y + area.h + _TIE
        for note, height in zip(self._box.notes, self._heights, strict=True):
            notes.append(_placed_note(note, Rectangle(left, top, self._note_w, height)))
            top += height + _NOTE_GAP
        return PlacedBox(self._box, area, self._lines, tuple(notes), self._edge(area, parent), self._ties(area, notes))

    def _edge(self, area: Rectangle, parent: PlacedBox | None) -> Line:
        """The line from the parent: along, across in the gap before this layer, along."""
        if parent is None:
            return ()
        if self._down:
            (own, _), (above, _) = area.middle, parent.area.middle
            start, end, turn = parent.area.y + parent.area.h, area.y, area.y - self._box_y
        else:
            (_, own), (_, above) = area.middle, parent.area.middle
            start, end, turn = parent.area.x + parent.area.w, area.x, area.x - self._box_x
        turn -= _LEVEL_GAP // 2
        line: Line = ((own, start), (own, end))
        if abs(own - above) > 1:  # positions are rounded
            line = ((above, start), (above, turn), (own, turn), (own, end))
        return line if self._down else tuple((y, x) for x, y in line)

    def _ties(self, area: Rectangle, notes: list[PlacedNote]) -> Line:
        if not notes:
            return ()
        first = notes[0].area
        if self._beside:
            y = max(first.y, min(area.middle[1], first.y + first.h)) if len(notes) == 1 else area.middle[1]
            return (area.x + area.w, y), (first.x, y)
        x = area.middle[0] if self._down else min(first.x + _INDENT, area.x + area.w - _INDENT // 2)
        return (x, area.y + area.h), (x, first.y)


def _box_size(box: Box, lines: tuple[str, ...]) -> tuple[int, int]:
    widths = [width(lines[0], TITLE, bold=True), *(width(line, SMALL) for line in lines[1:])]
    w, h = max(widths) + _PAD[box.outline], len(lines) * LEADING + 10
    if box.outline == "condition":
        w, h = w + w // 6, h + 6 * len(lines)
    return max(w + w % 2, _LEAST), h + h % 2


def _note_width(note: Note) -> int:
    lines = note_lines(note)
    least = _NOTE_ROOM if note.measured else 0
    return max(least, width(lines[0], SMALL, bold=True), *(width(line, SMALL) for line in lines)) + 2 * _NOTE_PAD


def _note_height(note: Note) -> int:
    sparklines = sum(measured.has_values for measured in note.measured)
    return len(note_lines(note)) * LEADING + sparklines * _SPARK + _NOTE_PAD


def _placed_note(note: Note, area: Rectangle) -> PlacedNote:
    lines: list[tuple[int, str]] = []
    sparklines: list[tuple[Rectangle, MeasuredClause]] = []
    top = area.y
    for texts, measured in _sections(note):
        lines += [(top + 15 + number * LEADING, text) for number, text in enumerate(texts)]
        top += len(texts) * LEADING
        if measured is not None and measured.has_values:
            inner = Rectangle(area.x + _NOTE_PAD, top + 6, area.w - 2 * _NOTE_PAD, _SPARK - 6)
            sparklines.append((inner, measured))
            top += _SPARK
    return PlacedNote(note, area, tuple(lines), tuple(sparklines))


_GAP: Final = 20  # between siblings
_LEVEL_GAP: Final = 32
_TIE: Final = 14  # between a box and its notes
_INDENT: Final = 16
_LEAST: Final = 36
_ROOM: Final = 220  # for the texts of a box
_PAD: Final = {"control": 16, "action": 20, "condition": 30, "decorator": 34, "subtree": 34, "unknown": 20}
_NOTE_ROOM: Final = 190
_NOTE_MOST: Final = 3  # lines of one clause
_NOTE_PAD: Final = 8
_NOTE_GAP: Final = 6
_SPARK: Final = 36  # a sparkline with the gap above it
