"""Writes one logical line: the gaps between its words, and the physical lines that its brackets span; and aligns
trailing comments.

One invariant: the lexer splits the new text into the same tokens.  It reads `6` at a line's end and `s` on the next as
two words, and `-` differently after a line end; so a line end inside an attribute stays, except where the words on both
sides are the same either way, and a new one is inserted only before a name or a string.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Final

from btq_lang.formatter.lines import Piece
from btq_lang.formatter.marks import Marks
from btq_lang.syntax.tokens import CLOSE, COMMENT, NAME, OPEN, OPERATOR
from btq_lang.util.record import Record
from btq_lang.util.text import LineIndex


class FormatOptions(Record):
    """The maximal width of lines, and how many blanks a level has (at least one)."""

    columns: int = 100
    indent: int = 4


class PhysicalLine:
    """A physical line without its line end; its strings and comments may have some.

    Attributes:
        code: with its indentation, perhaps after a blank line.
        comment: the comments after the code, and the gap that would be before them if code followed.
        at: where the first of them begins in the file.
    """

    __slots__ = ("at", "code", "comment")

    def __init__(self, code: str) -> None:
        self.code = code
        self.comment = ""
        self.at = 0

    @property
    def text(self) -> str:
        return f"{self.code}  {self.comment.lstrip(' ')}" if self.comment else self.code


def laid_out(pieces: Sequence[Piece], level: int, marks: Marks, options: FormatOptions) -> list[PhysicalLine]:
    """The rows of a logical line."""
    writer = _Writer(pieces, level * options.indent, marks, options)
    for index in range(len(pieces)):
        writer.write(index)
    return writer.rows


def fits(pieces: Iterable[Piece], column: int, marks: Marks, options: FormatOptions) -> bool:
    """Whether pieces, written on one line from a column on, fit the width; comments do not count."""
    before: Piece | None = None
    for piece in pieces:
        if piece.kind != COMMENT:
            first, *others = (_gap(before, piece, marks) + piece.text).split("\n")
            column += len(first)
            for line in others:  # of a string
                if column > options.columns:
                    return False
                column = len(line)
            if column > options.columns:
                return False
            before = piece
    return True


def align(old: str, rows: Iterable[PhysicalLine]) -> None:
    """Align the comments of rows that follow each other, if they were in the same column of the old text.

    Aligning again changes nothing: the column is always two blanks after the longest code of these rows.
    """
    lines = LineIndex(old)
    run: list[PhysicalLine] = []
    shared = -1  # the column of its comments
    for row in (*rows, PhysicalLine("")):
        column = _column(old, row.at, lines.position(row.at).column) if row.comment else -1
        if column != shared or "\n" in row.code or any("\n" in above.comment for above in run[-1:]):
            ends = [len(aligned.code) - aligned.code.rfind("\n") for aligned in run]
            for aligned, end in zip(run, ends, strict=True):
                aligned.code += " " * (max(ends) - end)
            run, shared = [], column
        if row.comment:
            run.append(row)


class _Group:
    """Open brackets.

    Attributes:
        spread: each of their elements has its own line.
        indent: the indentation of the line that opens them.
        has_lines: a line has begun inside them.
        loose: the current element is broken, because it is too long for one line.
    """

    __slots__ = ("has_lines", "indent", "loose", "spread")

    def __init__(self, spread: bool, indent: int) -> None:
        self.spread: Final = spread
        self.indent: Final = indent
        self.has_lines = False
        self.loose = False


class _Writer:
    """Writes a logical line piece by piece."""

    def __init__(self, pieces: Sequence[Piece], indent: int, marks: Marks, options: FormatOptions) -> None:
        self.pieces: Final = pieces
        self.marks: Final = marks
        self.options: Final = options
        self.closing: Final = _closing(pieces)
        self.groups: Final[list[_Group]] = []
        self.rows: Final = [PhysicalLine(" " * indent)]
        self.indent = indent  # of the current row
        self.next_word = -1  # the first piece after the current comments that is not a comment

    def write(self, index: int) -> None:
        piece = self.pieces[index]
        before = self.pieces[index - 1] if index else None
        indent = None if before is None else self.new_line(index, before)
        if indent is not None:
            group = self.groups[-1]
            is_blank = piece.blank and group.has_lines and piece.kind != CLOSE
            self.rows.append(PhysicalLine("\n" * is_blank + " " * indent))
            self.indent = indent
            group.has_lines = True
        row = self.rows[-1]
        gap = "" if indent is not None else _gap(before, piece, self.marks)
        if piece.kind != COMMENT:
            row.code += row.comment + gap + piece.text
            row.comment = ""
        elif row.comment:
            row.comment += gap + piece.text
        elif before is None or indent is not None or before.kind == COMMENT:
            row.code += gap + piece.text  # the row begins with comments
        else:
            row.comment = gap + piece.text
            row.at = piece.start
        if piece.kind == OPEN:
            self.groups.append(_Group(self.spreads(index), self.indent))
        elif piece.kind == CLOSE:
            self.groups.pop()
        elif indent is not None and piece.start in self.marks.elements:
            self.groups[-1].loose = not self.fits(self.rest_of_element(index), indent)

    # ---- line ends ----

    def new_line(self, index: int, before: Piece) -> int | None:
        """The indentation of the line that begins with this piece; None if none does."""
        piece = self.pieces[index]
        if not self.groups:
            return None
        group = self.groups[-1]
        if piece.kind == CLOSE:
            return group.indent if group.spread or before.is_line_comment else None
        inner = group.indent + self.options.indent
        if not group.spread:
            return inner if before.is_line_comment or self.stays_broken(before, piece) else None
        if self.begins_element(index):
            return inner
        if (
            before.is_line_comment
            or (group.loose and piece.start in self.marks.breaks)
            or self.stays_broken(before, piece)
        ):
            return inner + self.options.indent
        return None

    def begins_element(self, index: int) -> bool:
        """Whether an element begins here, or a comment on its own lines before one or after the last."""
        piece = self.pieces[index]
        if piece.kind == COMMENT and not piece.broken:
            return False
        if self.next_word < index:
            rest = range(index, len(self.pieces))
            self.next_word = next(following for following in rest if self.pieces[following].kind != COMMENT)
        word = self.pieces[self.next_word]
        return word.start in self.marks.elements or (piece.kind == COMMENT and word.kind == CLOSE)

    def stays_broken(self, before: Piece, piece: Piece) -> bool:
        """Whether the author's line end before a piece stays: not if both words belong together."""
        return (
            piece.broken
            and _gap(before, piece, self.marks) != ""
            and not _is(piece, OPERATOR, "=")
            and not _is(before, OPERATOR, "=")
            and not _is(before, NAME, "QualityReq")
            and piece.start not in self.marks.attributes
        )

    def spreads(self, index: int) -> bool:
        """Whether the elements of the brackets that open here have their own lines."""
        start, close = self.pieces[index].start, self.closing[index]
        if close == index + 1 or (start not in self.marks.attributes and start not in self.marks.arguments):
            return False
        if any(piece.broken for piece in self.pieces[index + 1 : close + 1]):
            return True
        if start not in self.marks.attributes:
            return False
        code = self.rows[-1].code
        column = len(code) - code.rfind("\n") - 2  # of the bracket, which is already written
        if not self.fits(self.pieces[index : close + 1], column):
            return True
        return not self.fits(self.rest_of_element(index), column) and self.fits(
            self.rest_of_element(close), self.indent
        )

    def rest_of_element(self, index: int) -> Iterator[Piece]:
        """The pieces from this one to the end of the element, or of the line outside brackets."""
        yield self.pieces[index]
        depth = int(self.pieces[index].kind == OPEN)
        for following in range(index + 1, len(self.pieces)):
            piece = self.pieces[following]
            if piece.kind == OPEN:
                depth += 1
            elif depth == 0 and (piece.kind == CLOSE or (self.groups and piece.start in self.marks.elements)):
                return
            elif piece.kind == CLOSE:
                depth -= 1
            yield piece

    def fits(self, pieces: Iterable[Piece], column: int) -> bool:
        return fits(pieces, column, self.marks, self.options)


def _gap(before: Piece | None, piece: Piece, marks: Marks) -> str:
    """The text between two pieces on one line."""
    if before is None or before.kind == OPEN or piece.kind == CLOSE or _is(piece, OPERATOR, ","):
        return ""
    return "" if piece.start in marks.tight and before.kind != COMMENT else " "


def _is(piece: Piece, kind: int, text: str) -> bool:
    return piece.kind == kind and piece.text == text


def _closing(pieces: Sequence[Piece]) -> dict[int, int]:
    """The index of the closing bracket for each opening one."""
    closing: dict[int, int] = {}
    open_brackets: list[int] = []
    for index, piece in enumerate(pieces):
        if piece.kind == OPEN:
            open_brackets.append(index)
        elif piece.kind == CLOSE:
            closing[open_brackets.pop()] = index
    return closing


def _column(text: str, offset: int, length: int) -> int:
    """The column of an offset, `length` characters after the start of its line; a tab goes to the next multiple of four
    columns, as for comment lines.
    """
    return len(text[offset - length : offset].lstrip("\ufeff").expandtabs(4))
