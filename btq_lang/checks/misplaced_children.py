"""Misplaced children, and the fixes that move them: on the line of their parent (`Sequence Go, Turn`, or
`Inverter Dark`, in which `Dark` is read as a label), indented too far, or more of them than the parent takes.

One invariant: a word on a node's line is reported as a child only if the node must have children and, unless the word
is the name of a known node, has none below it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from typing import Final

from btq_lang.catalog.kinds import CHILDREN
from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nodes import lookup
from btq_lang.checks import lookups
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Fix, FixEdit, Place
from btq_lang.grammar.cursor import QUOTES
from btq_lang.grammar.node_mistakes import CHILD
from btq_lang.lexer import tokens
from btq_lang.syntax.scan import line_end, line_start
from btq_lang.syntax.suggestions import CHILDREN as CHILDREN_ON_LINES
from btq_lang.syntax.tokens import NAME, NODE_CLAUSES
from btq_lang.syntax.tree import Node, Tree, Verbatim, is_name
from btq_lang.util.record import replace
from btq_lang.util.text import LINE_END, Span
from btq_lang.workspace.resolved import ResolvedNode


def label_as_child(view: View, resolved: ResolvedNode, tag: str = "") -> tuple[tuple[str, ...], tuple[Fix, ...]]:
    """The note and the fix for a node without children whose label is probably its child; empty if it has none.

    Args:
        tag: the built-in that the fix writes in place of the node's kind.
    """
    node = resolved.node
    if not has_bare_label(view, node) or node.label is None:
        return (), ()
    notes = (f"btq reads `{node.label.raw}` as the label of `{node.head.text}`; {CHILD}",)
    has_own_ports = resolved.kind is not None and any(resolved.kind.port(pair.key.text) for pair in node.attributes)
    fixes = () if has_own_ports or node.clauses else _line_break_fixes(view, node, (node.label.start,))
    if tag:
        title = f"Write `{tag}`, and `{node.label.raw}` on a line of its own"
        fixes = tuple([Fix(title, (FixEdit(Place(node.head.span), tag), *fix.changes)) for fix in fixes])
    return notes, fixes


def has_bare_label(view: View, node: Node) -> bool:
    """Whether a node has no children, and after its kind a word that may be meant as one."""
    return node.label is not None and node.label.kind == NAME and not (node.children or view.is_xml)


def reword_diagnostics(view: View, reported: Iterable[Diagnostic]) -> Iterator[Diagnostic]:
    """The parser's diagnostics of an item, reworded where the parser took a child for a label."""
    for diagnostic in reported:
        yield (
            _reworded(view, diagnostic)
            if isinstance(view.item, Tree) and diagnostic.notes[:1] in _REPORTED
            else diagnostic
        )


def _reworded(view: View, reported: Diagnostic) -> Diagnostic:
    text, offset = view.text, reported.span.start
    resolved = view.node_before(offset)
    if resolved is None or resolved.behavior is None or resolved.behavior.children[0] == 0:
        return reported
    end = line_end(text, resolved.node.start)
    if offset > end:
        return reported
    node = resolved.node
    if reported.notes == (CHILD,):
        word = text[offset : reported.span.end]
        if node.label is not None or not is_name(word) or (node.children and not is_node(view, word)):
            return reported
        fixes = () if node.children else _line_break_fixes(view, node, (offset,))
        return replace(reported, message=CHILD, notes=(), fixes=fixes)
    names = _NAMES.match(text, node.head.end, end)
    words = [*_NAME.finditer(text, node.head.end, names.end(1))] if names is not None else []
    if node.children or not words or not NODE_CLAUSES.isdisjoint(word[0] for word in words):
        return reported
    return replace(
        reported,
        message=CHILDREN_ON_LINES,
        notes=(),
        fixes=_line_break_fixes(view, node, [word.start() for word in words]),
    )


def is_node(view: View, word: str) -> bool:
    """Whether a word is a built-in, or the name of a declared node or tree."""
    return (
        lookup(word) is not None
        or view.ask(lookups.is_defined, Kind.MODEL, word)
        or view.ask(lookups.is_defined, Kind.TREE, word)
    )


def _line_break_fixes(view: View, node: Node, starts: Sequence[int]) -> tuple[Fix, ...]:
    """The fix that moves the words at `starts`, which follow a node's kind, each to its own line, indented one level
    deeper.
    """
    text = view.text
    line = line_start(text, 0, node.start)
    margin = text[line : node.start]
    step = "\t" if margin.startswith("\t") else "    "
    gaps = [Span(line + len(text[line:start].rstrip(" \t,")), start) for start in starts]
    changes = [FixEdit(Place(gap), f"\n{margin}{step}") for gap in gaps]
    title = "Put it on a line of its own" if len(starts) == 1 else "Put them on lines of their own"
    return () if margin.strip() else (Fix(title, tuple(changes)),)


def wrap_in_sequence_fixes(view: View, children: Sequence[Node | Verbatim]) -> tuple[Fix, ...]:
    """The fix that writes `->` above children of one parent; none if their lines cannot be indented."""
    margin, step, starts = _movable_lines(view, children)
    if not starts:
        return ()
    above = FixEdit(Place(Span(starts[0], starts[0])), f"{margin}->\n{step}")
    return (Fix("Put them below a Sequence `->`", (above, *_indented(starts[1:], step))),)


def indent_below_fixes(view: View, parent: Node, siblings: Sequence[Node | Verbatim]) -> tuple[Fix, ...]:
    """The fix that indents the nodes after a parent without children, so that they are its children."""
    _, step, starts = _movable_lines(view, siblings)
    title = f"Indent {'it' if len(siblings) == 1 else 'them'} below `{parent.head.text}`"
    return (Fix(title, tuple(_indented(starts, step))),) if starts else ()


def outdented(view: View, resolved: ResolvedNode) -> tuple[Fix, ...]:
    """The fix that indents the line of a node that takes no children and has some: those are its siblings, and the node
    before it is their parent.  None if another line may be the wrong one.
    """
    node, parent = resolved.node, _before(view, resolved)
    if view.is_xml or view.entry.diagnostics or not node.children or most_children(resolved) != 0 or parent is None:
        return ()
    if parent.behavior is None or parent.behavior.children[1] is not None:
        return ()
    margin, meant = _margin(view, node), _margin(view, node.children[0])
    siblings = parent.node.children
    if margin.strip() or not meant.startswith(margin) or (siblings and _margin(view, siblings[-1]) != meant):
        return ()
    start = node.start - len(margin)
    return (Fix(f"Indent it below `{parent.node.head.text}`", (FixEdit(Place(Span(start, node.start)), meant),)),)


def most_children(resolved: ResolvedNode) -> int | None:
    """How many children a node takes; None if any number, or if it is unknown."""
    if resolved.behavior is not None:
        return resolved.behavior.children[1]
    return CHILDREN[resolved.stated_category][1] if resolved.stated_category is not None else None


def _before(view: View, resolved: ResolvedNode) -> ResolvedNode | None:
    """The sibling before a node."""
    before = view.node_before(resolved.node.start)
    while before is not None and before.parent is not resolved.parent:
        before = before.parent
    return before


def _margin(view: View, child: Node | Verbatim) -> str:
    return view.text[line_start(view.text, 0, child.start) : child.start]


def dedent_fixes(view: View, resolved: ResolvedNode, children: Sequence[Node | Verbatim]) -> tuple[Fix, ...]:
    """The fix that dedents some children of a node to its level; none if its parent takes no more, or the node before
    it lacks children.
    """
    parent, before = resolved.parent, _before(view, resolved)
    if parent is None or most_children(parent) is not None:
        return ()
    if before is not None and not before.node.children and before.behavior and before.behavior.children[0]:
        return ()
    margin, _, starts = _movable_lines(view, children)
    outer = _margin(view, resolved.node)
    if not margin.startswith(outer) or not all(view.text.startswith(margin, start) for start in starts):
        return ()
    changes = [FixEdit(Place(Span(start + len(outer), start + len(margin))), "") for start in starts]
    title = f"Dedent {'it' if len(children) == 1 else 'them'} to the level of `{resolved.node.head.text}`"
    return (Fix(title, tuple(changes)),) if changes else ()


def _indented(starts: Sequence[int], step: str) -> list[FixEdit]:
    return [FixEdit(Place(Span(start, start)), step) for start in starts]


def _movable_lines(view: View, children: Sequence[Node | Verbatim]) -> tuple[str, str, list[int]]:
    """The margin of some children, an indentation step, and where their lines begin; no lines if they cannot move."""
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
    """The end offset of a node with all its descendants."""
    descendants = [part for node in child.walk() for part in (node, *node.children)] if isinstance(child, Node) else []
    return max(part.end for part in (child, *descendants))


_REPORTED: Final = ((CHILD,), (CHILDREN_ON_LINES,), (QUOTES,))
_NAME: Final = re.compile(r"[^\W\d]\w*")
_NAMES: Final = re.compile(r"((?:[ \t,]+[^\W\d]\w*)+)[ \t]*(?=#|\r?\n|\Z|\r)")
TOO_FAR: Final = "what is below it may be indented too far"
