"""The blocks of requirements: one clause a line, in one order.

One invariant: a clause keeps its words, and its comments above, after and below it move with it.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from typing import TypeAlias

from btq_lang.formatter.layout import FormatOptions, fits
from btq_lang.formatter.lines import LogicalLine
from btq_lang.formatter.marks import Clauses, Marks
from btq_lang.syntax.tokens import NAME
from btq_lang.util.text import Span

Section: TypeAlias = tuple[
    Span, tuple[LogicalLine, ...]
]  # lines written together, and the span of the file they come from


def sections(lines: Sequence[LogicalLine], marks: Marks, options: FormatOptions) -> Iterator[Section]:
    """The lines in order: each is a section of its own, but the block of a requirement is one section.

    The clauses of a block are sorted if the requirement has no more than one claim: with two of them, a reader may
    relate what follows a claim to that claim.  Clauses after a head that is too long go into the block.
    """
    starts = [line.pieces[0].start for line in lines[:-1]]
    # Of several requirements in one line, only the last may have a block.
    in_order = sorted(marks.clauses, key=lambda clauses: clauses.start)
    by_line = {bisect_right(starts, clauses.start) - 1: clauses for clauses in in_order}
    index = 0
    while index < len(lines):
        head = lines[index]
        clauses = by_line.get(index)
        index += 1
        block: list[LogicalLine] = []
        if clauses is not None and max(clauses.ranks) >= head.end:
            while lines[index].level > head.level:
                block.append(lines[index])
                index += 1
        start, middle, end = head.start, head.end, block[-1].end if block else head.end
        if clauses is not None and _is_too_long(head, clauses, marks, options):
            head, trailing = _parted(head, clauses)
            yield Span(start, end), (head, *_arranged([trailing, *block], clauses))
        else:
            yield Span(start, middle), (head,)
            if clauses is not None and block:
                yield Span(middle, end), _arranged(block, clauses)


def _is_too_long(head: LogicalLine, clauses: Clauses, marks: Marks, options: FormatOptions) -> bool:
    """Whether a line ends in clauses that do not fit it, of a requirement that would own a block below the line."""
    words = head.words
    first, last = words[0], words[-1]
    return (
        (first.start == clauses.start or (first.kind == NAME and first.text == "satisfies"))
        and any(start <= last.start < end for start, end in clauses.spans)
        and not fits(words, head.level * options.indent, marks, options)
    )


def _parted(head: LogicalLine, clauses: Clauses) -> tuple[LogicalLine, LogicalLine]:
    """A head without its trailing clauses, and those as a line of its block; a comment at the end stays with
    the head.
    """
    pieces = head.pieces
    begin = next(index for index, piece in enumerate(pieces) if piece.start in clauses.ranks)
    end = pieces.index(head.words[-1]) + 1
    short = LogicalLine(head.level, head.blanks, head.blank, [*pieces[:begin], *pieces[end:]])
    short.lead = head.lead
    trailing = LogicalLine(head.level + 1, head.blanks, False, pieces[begin:end])
    trailing.tail = head.tail
    return short, trailing


def _arranged(block: Sequence[LogicalLine], clauses: Clauses) -> tuple[LogicalLine, ...]:
    """A line for each clause of a block, in order."""
    lines = [part for line in block for part in _cut(line, clauses)]
    last = lines[-1]
    kept = max((index + 1 for index, remark in enumerate(last.tail) if remark.depth > last.level), default=0)
    below = last.tail[kept:]  # comments at the end of the block stay there
    last.tail = last.tail[:kept]
    if clauses.claims <= 1:
        lines.sort(key=lambda line: clauses.ranks[next(p.start for p in line.pieces if p.start in clauses.ranks)])
    lines[-1].tail += below
    return tuple(lines)


def _cut(line: LogicalLine, clauses: Clauses) -> list[LogicalLine]:
    """A line for each clause of a line."""
    begins = [index for index, piece in enumerate(line.pieces) if piece.start in clauses.ranks]
    begins[0] = 0  # a comment before the first clause is the clause's
    pieces = [line.pieces[begin:end] for begin, end in zip(begins, [*begins[1:], None], strict=True)]
    parts = [LogicalLine(line.level, line.blanks, line.blank, pieces[0])]
    parts += [LogicalLine(line.level, line.blanks, False, others) for others in pieces[1:]]
    parts[0].lead, parts[-1].tail = line.lead, line.tail
    return parts
