"""The logical lines of a file with the comments between them, each with its level.

One invariant: every token and every comment of the file is in exactly one line, in order, and the lines' spans follow
each other from the start of the file to its end.  The grammar is unknown here; `comments` decides where a comment
belongs.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Final

from btq_lang.syntax.scan import number_end
from btq_lang.syntax.tokens import BLANK, COMMENT, DEDENT, INDENT, NEWLINE, QUANTITY, Token
from btq_lang.util.text import LINE_END
from btq_lang.workspace.comments import block_of


class Piece:
    """A word, a sign or a comment of a line.

    Attributes:
        kind: its token kind.
        start: where it begins in the file.
        text: as it will be written: a quantity with one blank, line ends as `\\n`, no blanks after a comment.
        broken: the author began a line with it, inside brackets or after a multi-line comment.
        blank: the author left a blank line before that.
    """

    __slots__ = ("blank", "broken", "kind", "start", "text")

    def __init__(self, kind: int, start: int, text: str, line_ends: int) -> None:
        self.kind: Final = kind
        self.start: Final = start
        self.text: Final = text
        self.broken: Final = line_ends > 0
        self.blank: Final = line_ends > 1

    @property
    def is_line_comment(self) -> bool:
        return self.kind == COMMENT and not self.text.startswith("/*")


class CommentLines:
    """Comments on a line of their own.

    Attributes:
        blanks: the text before them on that line.
        blank: whether a blank line precedes them.
        depth: their level.
        end: where they end in the file.
    """

    __slots__ = ("blank", "blanks", "depth", "end", "pieces")

    def __init__(self, blanks: str, blank: bool) -> None:
        self.blanks: Final = blanks
        self.blank = blank
        self.depth = 0
        self.end = 0
        self.pieces: list[Piece] = []

    @property
    def text(self) -> str:
        return " ".join(piece.text for piece in self.pieces)


class LogicalLine:
    """A logical line, with all lines that brackets join.

    Attributes:
        level: how many blocks are open around it.
        blanks: the text before it on its physical line.
        blank: whether a blank line precedes it.
        lead: the comment lines above it, at its own level.
        pieces: its words and the comments between and after them; none: the end of the file.
        tail: the comment lines below it that belong to it or to a line above it, not to the next line.
        start, end: its span, with comment lines and with the blank lines above.
    """

    __slots__ = ("blank", "blanks", "end", "lead", "level", "pieces", "start", "tail")

    def __init__(self, level: int, blanks: str, blank: bool, pieces: list[Piece]) -> None:
        self.level: Final = level
        self.blanks: Final = blanks
        self.blank = blank
        self.pieces = pieces
        self.lead: list[CommentLines] = []
        self.tail: list[CommentLines] = []
        self.start = self.end = 0

    @property
    def words(self) -> list[Piece]:
        """The pieces that are not comments."""
        return [piece for piece in self.pieces if piece.kind != COMMENT]


def logical_lines(text: str, tokens: Iterable[Token], atoms: Mapping[int, int]) -> list[LogicalLine]:
    """The lines of a file; the last one is its end.

    Args:
        tokens: all tokens of the text.
        atoms: start and end of what is kept verbatim though it is several tokens: units and types.
    """
    lines: list[LogicalLine] = []
    open_lines: list[LogicalLine] = []  # the previous line and the lines whose blocks contain it
    for remarks, line in _lines_with_comments(text, tokens, atoms):
        for remark in remarks:
            owner = block_of(remark.blanks, open_lines, line.level)
            remark.depth = line.level if owner is None else owner.level + 1
        below = max((index + 1 for index, remark in enumerate(remarks) if remark.depth > line.level), default=0)
        line.lead = remarks[below:]
        line.start = lines[-1].end if lines else 0
        if below:
            lines[-1].tail = remarks[:below]
            line.start = lines[-1].end = _line_end(text, remarks[below - 1].end)
        while open_lines and open_lines[-1].level >= line.level:
            open_lines.pop()
        open_lines.append(line)
        lines.append(line)
    return lines


def _lines_with_comments(
    text: str, tokens: Iterable[Token], atoms: Mapping[int, int]
) -> Iterator[tuple[list[CommentLines], LogicalLine]]:
    """The lines, each with the comment lines above it."""
    remarks: list[CommentLines] = []
    line: LogicalLine | None = None
    level = line_ends = written = 0
    blanks = ""
    for token in tokens:
        kind = token.kind
        if kind == BLANK:
            *above, last = LINE_END.split(token.text)
            line_ends += len(above)
            blanks = last if above else blanks + last.lstrip("\ufeff")
            continue
        if kind in (INDENT, DEDENT):
            level += 1 if kind == INDENT else -1
            continue
        if kind == NEWLINE:
            if line is not None:
                line.end = token.end
                yield remarks, line
            remarks, line, blanks, line_ends = [], None, "", 1
            continue
        if token.start < written:
            continue  # inside an atom
        written = atoms.get(token.start, token.end)
        piece = Piece(kind, token.start, _normalized(kind, text[token.start : written]), line_ends)
        if line is not None:
            line.pieces.append(piece)
        elif kind == COMMENT:
            if line_ends or not remarks:
                remarks.append(CommentLines(blanks, line_ends > 1))
            remarks[-1].pieces.append(piece)
            remarks[-1].end = token.end
        elif remarks and not line_ends:  # after a comment: the line begins there
            before = remarks.pop()
            line = LogicalLine(level, before.blanks, before.blank, [*before.pieces, piece])
        else:
            line = LogicalLine(level, blanks, line_ends > 1, [piece])
        line_ends = 0
    end = LogicalLine(0, "", line_ends > 1, [])
    end.end = len(text)
    yield remarks, end


def _normalized(kind: int, raw: str) -> str:
    if kind == QUANTITY:
        end = number_end(raw, 0)
        return f"{raw[:end]} {raw[end:].strip()}"
    if kind == COMMENT and not raw.startswith("/*"):
        return raw.rstrip(" \t")
    return LINE_END.sub("\n", raw) if "\r" in raw else raw


def _line_end(text: str, offset: int) -> int:
    match = LINE_END.search(text, offset)
    return match.end() if match else len(text)
