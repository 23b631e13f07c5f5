"""The fixes that give nodes another parent: a new Sequence, the node before them, or the parent of theirs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from btq_lang.catalog.kinds import CHILDREN
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Fix, FixEdit, Place
from btq_lang.lexer import tokens
from btq_lang.syntax.scan import line_start
from btq_lang.syntax.tree import Node, Verbatim
from btq_lang.util.text import LINE_END, Span
from btq_lang.workspace.resolved import ResolvedNode


def sequence_above(view: View, children: Sequence[Node | Verbatim]) -> tuple[Fix, ...]:
    """The fix that writes `->` above children of one parent; none where their lines cannot be indented as they are."""
    margin, step, starts = _lines(view, children)
    if not starts:
        return ()
    above = FixEdit(Place(Span(starts[0], starts[0])), f"{margin}->\n{step}")
    return (Fix("Put them below a Sequence `->`", (above, *_indented(starts[1:], step))),)


def below(view: View, parent: Node, siblings: Sequence[Node | Verbatim]) -> tuple[Fix, ...]:
    """The fix that indents the nodes after a parent without children, so that they are its children."""
    _, step, starts = _lines(view, siblings)
    title = f"Indent {'it' if len(siblings) == 1 else 'them'} below `{parent.head.text}`"
    return (Fix(title, tuple(_indented(starts, step))),) if starts else ()


def dedented(view: View, resolved: ResolvedNode, children: Sequence[Node | Verbatim]) -> tuple[Fix, ...]:
    """The fix that dedents some children of a node to its level; none if its parent takes no more."""
    parent = resolved.parent
    category = parent.stated_category if parent is not None else None
    if parent is None or (
        category and (parent.behavior.children if parent.behavior else CHILDREN[category])[1] is not None
    ):
        return ()
    margin, _, starts = _lines(view, children)
    outer = view.text[line_start(view.text, 0, resolved.node.start) : resolved.node.start]
    if not margin.startswith(outer) or not all(view.text.startswith(margin, start) for start in starts):
        return ()
    changes = [FixEdit(Place(Span(start + len(outer), start + len(margin))), "") for start in starts]
    title = f"Dedent {'it' if len(children) == 1 else 'them'} to the level of `{resolved.node.head.text}`"
    return (Fix(title, tuple(changes)),) if changes else ()


def _indented(starts: Sequence[int], step: str) -> list[FixEdit]:
    return [FixEdit(Place(Span(start, start)), step) for start in starts]


def _lines(view: View, children: Sequence[Node | Verbatim]) -> tuple[str, str, list[int]]:
    """The margin of some children and a step more, and where their lines begin; no lines if those cannot be moved."""
    if view.is_xml or view.entry.diagnostics or not children:
        return "", "", []
    text = view.text
    first, end = line_start(text, 0, children[0].start), max(map(_end, children))
    margin = text[first : children[0].start]
    if margin.strip() or any(LINE_END.search(token.text.strip()) for token in tokens(text[first:end])):
        return "", "", []  # a string or a comment over several lines
    starts = [first, *[match.end() for match in LINE_END.finditer(text, first, end)]]
    filled = [start for start in starts if text[start:end].partition("\n")[0].strip()]
    return margin, "\t" if margin.startswith("\t") else "    ", filled


def _end(child: Node | Verbatim) -> int:
    """Where a node and all that is below it ends."""
    below = [part for node in child.walk() for part in (node, *node.children)] if isinstance(child, Node) else []
    return max(part.end for part in (child, *below))


TOO_FAR: Final = "what is below it may be indented too far"
