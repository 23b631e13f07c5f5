"""What is attached with the wrong word: a requirement with `satisfices`, or a quality with `satisfies`."""

from __future__ import annotations

from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Fix, replace_fix
from btq_lang.syntax.tree import Satisfices, Satisfies, Tree
from btq_lang.util.text import Span
from btq_lang.workspace.symbols import Use

_WORDS = ("satisfices", "satisfies")


def other_word(view: View, use: Use, rule: str, *, requirement: bool, safe: bool = True) -> Diagnostic:
    """The name of a requirement is in the place of a quality's, or the other way round.

    Args:
        requirement: whether it is one.
        safe: whether the name would be right after the other word.
    """
    is_, is_not = ("requirement", "quality") if requirement else ("quality", "requirement")
    word, other = _WORDS if requirement else _WORDS[::-1]
    span = _alone(view, use, word)
    fixes: tuple[Fix, ...] = (replace_fix(f"Replace `{word}` with `{other}`", span, other, safe=safe),) if span else ()
    message = f"`{use.name}` is a {is_}, not a {is_not}"
    notes = ("`satisfices` names qualities, `satisfies` names requirements",)
    return Diagnostic(rule, use.span, message, notes=notes, fixes=fixes)


def _alone(view: View, use: Use, word: str) -> Span | None:
    """The word of the clause that contains only this name."""
    clauses = use.node.clauses if use.node is not None else view.item.clauses if isinstance(view.item, Tree) else ()
    for clause in clauses:
        if isinstance(clause, Satisfices | Satisfies) and clause.start < use.span.start and clause.end == use.span.end:
            before = view.text[clause.start : use.span.start]
            return Span(clause.start, clause.start + len(word)) if before.strip() == word else None
    return None
