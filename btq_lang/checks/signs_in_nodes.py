"""Nodes with a sign between kind and name, as in YAML and Python: `Sequence: Rows`, `Home = DriveTo (…)`.

One invariant: only a line with the name of a known node is reworded; the parser reports the others as attributes.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Final

from btq_lang.checks.misplaced_children import is_node
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, write_fix
from btq_lang.grammar.node_mistakes import BARE
from btq_lang.syntax.scan import line_start
from btq_lang.syntax.tree import Tree
from btq_lang.util.record import replace
from btq_lang.util.text import Span


def without_signs(view: View, reported: Iterable[Diagnostic]) -> Iterator[Diagnostic]:
    """The parser's diagnostics of an item, reworded where the parser took a node for an attribute."""
    for diagnostic in reported:
        is_first = diagnostic.message == BARE and isinstance(view.item, Tree)
        yield _reworded(view, diagnostic) if is_first else diagnostic


def _reworded(view: View, reported: Diagnostic) -> Diagnostic:
    start = reported.span.start
    line = _NODE.match(view.text, start)
    if line is None or view.text[line_start(view.text, 0, start) : start].strip():
        return reported
    first, sign, second = line["first"], line["sign"], line["second"]
    span = Span(line.start(), line.end())
    if is_node(view, first):
        fix = write_fix(f"{first} {second}", span)
        notes = ("a node is written `kind name`",)
        return replace(
            reported, span=Span(*line.span("sign")), message=f"unexpected `{sign}`", notes=notes, fixes=(fix,)
        )
    if is_node(view, second):
        brackets = " (…)" if view.text[line.end() : line.end() + 2].strip().startswith("(") else ""
        message = f"a node's name goes after its kind: `{second} {first}{brackets}`"
        return replace(reported, span=span, message=message, notes=(), fixes=(write_fix(f"{second} {first}", span),))
    return reported


_NODE: Final = re.compile(
    r"(?P<first>[^\W\d]\w*)[ \t]*(?P<sign>[:=])[ \t]*(?P<second>[^\W\d]\w*)(?=[ \t]*(?:[(#\r\n]|\Z|satisf|tags\b))"
)
