"""The fix that puts several nodes below one Sequence, where only one node is allowed."""

from __future__ import annotations

from collections.abc import Sequence

from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Change, Fix, Place
from btq_lang.lexer import tokens
from btq_lang.syntax.scan import line_start
from btq_lang.syntax.tree import Node, Verbatim
from btq_lang.util.text import LINE_END, Span


def sequence_above(view: View, children: Sequence[Node | Verbatim]) -> tuple[Fix, ...]:
    """The fix that writes `->` above children of one parent; none where their lines cannot be indented as they are."""
    if view.is_xml or view.entry.diagnostics:
        return ()
    text = view.text
    first, end = line_start(text, 0, children[0].start), max(map(_end, children))
    margin = text[first : children[0].start]
    if margin.strip() or any(LINE_END.search(token.text.strip()) for token in tokens(text[first:end])):
        return ()  # a string or a comment over several lines
    step = "\t" if margin.startswith("\t") else "    "
    starts = [first, *[match.end() for match in LINE_END.finditer(text, first, end)]]
    filled = [start for start in starts if text[start:end].partition("\n")[0].strip()]
    changes = [Change(Place(Span(start, start)), step) for start in filled[1:]]
    return (
        Fix("Put them below a Sequence `->`", (Change(Place(Span(first, first)), f"{margin}->\n{step}"), *changes)),
    )


def _end(child: Node | Verbatim) -> int:
    """Where a node and all that is below it ends."""
    below = [each for node in child.walk() for each in (node, *node.children)] if isinstance(child, Node) else []
    return max(each.end for each in (child, *below))
