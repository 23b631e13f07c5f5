"""Children on the line of their parent: `Inverter Dark`, where the language reads a label, and `Sequence Go, Turn`.

One invariant: only a node that must have children and has none below it is said to have one on its line.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from typing import Final

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nodes import lookup
from btq_lang.checks import lookups
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Fix, FixEdit, Place
from btq_lang.grammar.cursor import QUOTES
from btq_lang.grammar.nodes import CHILD
from btq_lang.syntax.scan import line_end, line_start
from btq_lang.syntax.suggestions import CHILDREN
from btq_lang.syntax.tokens import NAME, NODE_CLAUSES
from btq_lang.syntax.tree import Node, Tree, is_name
from btq_lang.util.record import replace
from btq_lang.util.text import Span
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
    fixes = () if has_own_ports or node.clauses else _on_lines(view, node, (node.label.start,))
    if tag:
        title = f"Write `{tag}`, and `{node.label.raw}` on a line of its own"
        fixes = tuple([Fix(title, (FixEdit(Place(node.head.span), tag), *fix.changes)) for fix in fixes])
    return notes, fixes


def has_bare_label(view: View, node: Node) -> bool:
    """Whether a node has no children, and after its kind a word that may be meant as one."""
    return node.label is not None and node.label.kind == NAME and not (node.children or view.is_xml)


def on_own_lines(view: View, reported: Iterable[Diagnostic]) -> Iterator[Diagnostic]:
    """What the parser has reported of an item, with what it took for labels and is a child."""
    for diagnostic in reported:
        yield (
            _on_own_line(view, diagnostic)
            if isinstance(view.item, Tree) and diagnostic.notes[:1] in _REPORTED
            else diagnostic
        )


def _on_own_line(view: View, reported: Diagnostic) -> Diagnostic:
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
        if node.label is not None or not is_name(word) or (node.children and not _is_node(view, word)):
            return reported
        fixes = () if node.children else _on_lines(view, node, (offset,))
        return replace(reported, message=CHILD, notes=(), fixes=fixes)
    names = _NAMES.match(text, node.head.end, end)
    words = [*_NAME.finditer(text, node.head.end, names.end(1))] if names is not None else []
    if node.children or not words or not NODE_CLAUSES.isdisjoint(word[0] for word in words):
        return reported
    return replace(reported, message=CHILDREN, notes=(), fixes=_on_lines(view, node, [word.start() for word in words]))


def _is_node(view: View, word: str) -> bool:
    return (
        lookup(word) is not None
        or view.ask(lookups.is_defined, Kind.MODEL, word)
        or view.ask(lookups.is_defined, Kind.TREE, word)
    )


def _on_lines(view: View, node: Node, starts: Sequence[int]) -> tuple[Fix, ...]:
    """The fix that begins lines of their own at some words after a node's kind, one step deeper."""
    text = view.text
    line = line_start(text, 0, node.start)
    margin = text[line : node.start]
    step = "\t" if margin.startswith("\t") else "    "
    gaps = [Span(line + len(text[line:start].rstrip(" \t,")), start) for start in starts]
    changes = [FixEdit(Place(gap), f"\n{margin}{step}") for gap in gaps]
    title = "Put it on a line of its own" if len(starts) == 1 else "Put them on lines of their own"
    return () if margin.strip() else (Fix(title, tuple(changes)),)


_REPORTED: Final = ((CHILD,), (CHILDREN,), (QUOTES,))
_NAME: Final = re.compile(r"[^\W\d]\w*")
_NAMES: Final = re.compile(r"((?:[ \t,]+[^\W\d]\w*)+)[ \t]*(?=#|\r?\n|\Z|\r)")
