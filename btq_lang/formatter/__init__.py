"""The formatter: lays a text out in the one style of the project.

One invariant: the meaning of a file does not change.  The formatted text has the tree of the original, up to offsets
and the order of clauses in the blocks of requirements, and every comment at the element where it was; formatting it
again changes nothing.  Spelling is the author's: the formatter knows the positions of words, not their meaning.

    lines.py     the logical lines of a file and the comments between them
    clauses.py   the blocks of requirements, in their order
    layout.py    one logical line: gaps and physical lines; aligned comments
    marks.py     what only the tree says of a token

A text with a syntax error is refused as a whole and returned unchanged.  Indentation is structure, and brackets join
lines: the parser's recovery guesses what the lines around a mistake belong to, and formatting would write that guess
into the file.

The style:

* four blanks a level; in brackets four more than the line that opens them, and `)` below that line's start;
* brackets stay on their line if they are on one and it fits 100 columns; else each attribute has its own line, and
  one that is still too long is broken before the description and the clauses of its requirements;
* inside an attribute or a condition the author's line ends stay, except where they split a unit: around `=`,
  before `,` and so on;
* one blank between words, none inside brackets, paths and units, one between a number and its unit, two before a
  comment after code; such comments on consecutive lines stay aligned if they are;
* each clause in the block of a requirement has a line of its own, in one order: what is demanded, `while` and `when`,
  `assuming`, odds, confidence, window, `on violation`, `goal`, `because`, `verified by`; clauses after the
  requirement's head stay there if they fit the line;
* at most one blank line anywhere, none at the start of the file or of a block; one before and after every item that
  has a block; no blanks at the end of a line;
* the line ends that the file has: `\\r\\n` where its first one is that, else `\\n`, in strings and comments too, where
  they are equivalent (docs/language.md).
"""

from __future__ import annotations

import re
from collections.abc import Container, Iterable, Iterator, Sequence
from itertools import chain, pairwise
from typing import Final

from btq_lang.diagnostics.model import Diagnostic
from btq_lang.diagnostics.rules import Severity
from btq_lang.formatter.clauses import sections
from btq_lang.formatter.layout import FormatOptions, PhysicalLine, align, laid_out
from btq_lang.formatter.lines import CommentLines, LogicalLine, logical_lines
from btq_lang.formatter.marks import Marks
from btq_lang.parser import Parsed, parse
from btq_lang.util.record import Part, Record
from btq_lang.util.text import LINE_END, Edit, Span, alike

__all__ = ["DEFAULTS", "FormatOptions", "Formatted", "format_range", "format_text"]

DEFAULTS = FormatOptions()


class Formatted(Record):
    """The result of formatting a text.

    Attributes:
        text: the new text; the old one if it was refused.
        edits: that turn the old text into it: in order, not overlapping, none if nothing changes.
        refused: the first syntax error of a text that was refused; its span counts from the start of the text.
    """

    text: str
    edits: tuple[Edit, ...] = ()
    refused: Diagnostic | None = None


def format_text(text: str, options: FormatOptions = DEFAULTS) -> Formatted:
    """Format a file; if it has a syntax error, the result has the error and the text unchanged.

        >>> from btq_lang import format_text
        >>> format_text("BehaviorTree   Main\\n  Dock( a=1 )\\n").text
        'BehaviorTree Main\\n    Dock (a = 1)\\n'

    Args:
        text: any string.
        options: such as the width of a line.
    """
    parsed = parse(text)
    if error := refused(parsed):
        return Formatted(text, refused=error)
    stretches = _stretches(parsed, options)
    return Formatted("".join(stretch.text for stretch in stretches), _edits(text, stretches))


def format_range(text: str, start: int, end: int, options: FormatOptions = DEFAULTS) -> tuple[Edit, ...]:
    """The edits that format the lines between two offsets; none if the text has a syntax error.

    If another line of the same top-level block has a different indentation than formatting would give it, the whole
    block is formatted: a block with half its lines in new columns and half in old ones would be another tree.
    """
    parsed = parse(text)
    if refused(parsed):
        return ()
    if _OLD_LINE_END.search(text):  # a new `\n` after an old `\r` would be one line end, not two
        start, end = 0, len(text)
    start = min(start, len(text) - 1)  # the end of the text belongs to its last line
    chosen: list[_Stretch] = []
    for block in _blocks(_stretches(parsed, options)):
        inside = [stretch for stretch in block if stretch.start < max(end, start + 1) and start < stretch.end]
        moved_inside = sum(stretch.is_moved for stretch in inside)
        moved = sum(stretch.is_moved for stretch in block)
        chosen += block if inside and moved > moved_inside else inside
    return _edits(text, chosen)


def refused(parsed: Parsed) -> Diagnostic | None:
    """The first syntax error of a text, which prevents its formatting; None if it has none."""
    errors = (problem for problem in parsed.diagnostics if problem.effective_severity is Severity.ERROR)
    return min(errors, key=lambda problem: problem.span, default=None)


# ---- the whole file -------------------------------------------------------------------------------------------------


class _Stretch(Part):
    """The new text between two offsets; `is_moved`: one of its lines gets another indentation."""

    level: int
    is_moved: bool
    text: str


def _stretches(parsed: Parsed, options: FormatOptions) -> list[_Stretch]:
    """The whole file, stretch by stretch."""
    marks = Marks(parsed)
    parts = tuple(sections(logical_lines(parsed.text, parsed.tokens, marks.atoms), marks, options))
    items = {entry.start + entry.item.start for entry in parsed.entries}
    _part_items([line for _, lines in parts for line in lines], items)
    written = [[part for line in lines for part in _parts_of(line, marks, options)] for _, lines in parts]
    above = -1  # the level of the part above
    for part in chain.from_iterable(written):
        if part.blank and part.level <= above:
            part.rows[0].code = "\n" + part.rows[0].code
        above = part.level
    align(parsed.text, [row for part in chain.from_iterable(written) for row in part.rows])
    line_end = _line_end(parsed.text)
    return [
        _Stretch(
            *span,
            lines[0].level,
            any(part.is_moved for part in inside),
            "".join(f"{row.text}\n" for part in inside for row in part.rows).replace("\n", line_end),
        )
        for (span, lines), inside in zip(parts, written, strict=True)
    ]


def _line_end(text: str) -> str:
    """The line end that the file is written with."""
    first = LINE_END.search(text)
    return "\r\n" if first is not None and first[0] == "\r\n" else "\n"


def _part_items(lines: Sequence[LogicalLine], items: Container[int]) -> None:
    """Put a blank line before and after each item with a block, above the comments that precede the item."""
    previous: LogicalLine | None = None
    was_block = False
    for line, below in pairwise(lines):
        if line.words[0].start not in items:
            continue
        is_block = below.level > line.level
        if previous is not None and (
            line.level < previous.level or (line.level == previous.level and (is_block or was_block))
        ):
            gaps: list[CommentLines | LogicalLine] = [*line.lead, line]
            gaps[0].blank = gaps[0].blank or not any(gap.blank for gap in gaps)
        previous, was_block = line, is_block


class _Part(Record):
    """A logical line or a comment line, as rows; `blank`: a blank line precedes it, unless it opens a block."""

    level: int
    blank: bool
    is_moved: bool
    rows: list[PhysicalLine]


def _parts_of(line: LogicalLine, marks: Marks, options: FormatOptions) -> Iterator[_Part]:
    """A line with the comment lines above and below it."""
    for remark in line.lead:
        yield _remark(remark, options)
    if line.pieces:
        moved = line.blanks != " " * (line.level * options.indent)
        yield _Part(line.level, line.blank, moved, laid_out(line.pieces, line.level, marks, options))
    for remark in line.tail:
        yield _remark(remark, options)


def _remark(remark: CommentLines, options: FormatOptions) -> _Part:
    indent = " " * (remark.depth * options.indent)
    return _Part(remark.depth, remark.blank, remark.blanks != indent, [PhysicalLine(indent + remark.text)])


# ---- edits ----------------------------------------------------------------------------------------------------------


def _blocks(stretches: Iterable[_Stretch]) -> Iterator[list[_Stretch]]:
    """The stretches, grouped by top-level line."""
    block: list[_Stretch] = []
    for stretch in stretches:
        if stretch.level == 0 and block:
            yield block
            block = []
        block.append(stretch)
    yield block


def _edits(text: str, stretches: Iterable[_Stretch]) -> tuple[Edit, ...]:
    """The edits of the stretches that change: one for each gap between words, where the words keep their order."""
    edits: list[Edit] = []
    for stretch in stretches:
        old, new = text[stretch.start : stretch.end], stretch.text
        if old == new:
            continue
        if _BLANKS.sub("", old) != _BLANKS.sub("", new):
            edits.append(_edit(stretch.start, old, new))
            continue
        position = new_position = 0
        while position < len(old) or new_position < len(new):
            end, new_end = _end(_BLANKS, old, position), _end(_BLANKS, new, new_position)
            if old[position:end] != new[new_position:new_end]:
                edits.append(_edit(stretch.start + position, old[position:end], new[new_position:new_end]))
            same = min(_end(_WORD, old, end) - end, _end(_WORD, new, new_end) - new_end)
            position, new_position = end + same, new_end + same
    return tuple(edits)


def _edit(offset: int, old: str, new: str) -> Edit:
    """Replace the one text by the other, but for what both begin with."""
    same = alike(old, new)
    return Edit(Span(offset + same, offset + len(old)), new[same:])


def _end(pattern: re.Pattern[str], text: str, offset: int) -> int:
    match = pattern.match(text, offset)
    return match.end() if match else offset


_OLD_LINE_END: Final = re.compile(r"\r(?!\n)")
_BLANKS: Final = re.compile(r"[ \t\r\n\ufeff]+")
_WORD: Final = re.compile(r"[^ \t\r\n\ufeff]+")
