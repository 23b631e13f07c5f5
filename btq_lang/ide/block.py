"""Blocks of lines: the text of a node and all below it, at another depth or another place.

One invariant: a multi-line string or comment keeps its blanks, which belong to its text.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from btq_lang.syntax.scan import line_end, line_start
from btq_lang.syntax.tokens import COMMENT, STRING
from btq_lang.syntax.tree import Entry, Node, Tree
from btq_lang.util.record import Record
from btq_lang.util.text import LINE_END, Edit, Span, apply_edits
from btq_lang.workspace.file import File

STEP = "    "


class NodeLines(Record):
    """The lines of a node.

    Attributes:
        span: from its first word to the end of its last line, without the line end.
        blanks: the indentation of its first line.
        begins_its_line: whether no comment precedes its first word.
    """

    span: Span
    blanks: str
    begins_its_line: bool = True


def nodes_at(file: File, entry: Entry, offset: int) -> tuple[Node, ...]:
    """The nodes around an offset, the outermost first: the last is the one on whose own line (or lines, with brackets)
    it is; empty if it is on none."""
    inside = offset - entry.start
    children = entry.item.children if isinstance(entry.item, Tree) else ()
    waiting: list[tuple[Node, ...]] = [(child,) for child in children if isinstance(child, Node)]
    while waiting:
        line = waiting.pop()
        node = line[-1]
        start = line_start(file.text, 0, entry.start + node.start) - entry.start
        if start <= inside <= max(node.end, line_end(file.text, entry.start + node.end) - entry.start):
            return line
        waiting += [(*line, child) for child in node.nodes]
    return ()


def block_of(file: File, entry: Entry, node: Node) -> NodeLines:
    """The lines of a node and all below it."""
    start = entry.start + node.start
    blanks = blanks_before(file.text, start)
    span = Span(start, line_end(file.text, entry.start + node.block_end))
    return NodeLines(span, blanks, start == line_start(file.text, 0, start) + len(blanks))


def moved(file: File, block: NodeLines, blanks: str) -> str:
    """The text of a block, reindented so that its first line has other blanks; the first line's own are left out."""
    start, end = block.span
    inside = (edit for edit in shifts(file, block, blanks) if edit.span.start > start)
    return apply_edits(file.text[start:end], (Edit(edit.span.shifted(-start), edit.text) for edit in inside))


def shifts(file: File, block: NodeLines, blanks: str) -> Iterator[Edit]:
    """The edits that reindent a block in place, its first line too."""
    text = file.text
    first = block.span.start - len(block.blanks)
    for start in (first, *_line_starts(file, block.span)):
        if text.startswith(block.blanks, start) and LINE_END.match(text, start) is None:
            yield Edit(Span(start, start + len(block.blanks)), blanks)


def blanks_before(text: str, start: int) -> str:
    """The indentation of the line with an offset."""
    line = text[line_start(text, 0, start) : start]
    return line[: len(line) - len(line.lstrip(" \t"))]


def deeper(text: str, blanks: str) -> str:
    """The indentation one level below this one; if this one is empty, in the characters of the first indented line."""
    indented = _INDENTED.search(text) if not blanks else None
    return blanks + ("\t" if "\t" in (indented[1] if indented else blanks) else STEP)


def _line_starts(file: File, span: Span) -> list[int]:
    """The starts of the lines in a span, except those that begin inside a text."""
    texts = [
        token
        for token in file.parsed.tokens
        if token.kind in (STRING, COMMENT) and token.start < span.end and token.end > span.start
    ]
    starts = (end.end() for end in LINE_END.finditer(file.text, span.start, span.end))
    return [start for start in starts if not any(token.start < start < token.end for token in texts)]


_INDENTED = re.compile(r"[\r\n]([ \t])[ \t]*[^\s]")
