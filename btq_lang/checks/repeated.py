"""What one node, or one `apply`, names twice: a requirement, a quality, a tag, nodes."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.checks.clauses import with_blanks
from btq_lang.checks.view import View, quality_named
from btq_lang.diagnostics.model import Diagnostic, Fix, Place, Related, Tag, replace_fix
from btq_lang.syntax import tree as syntax
from btq_lang.util.text import Span


def named_twice(view: View) -> Iterator[Diagnostic]:
    """The second of two places that attach the same requirement, quality or tag to a node."""
    item = view.item
    if isinstance(item, syntax.Apply):
        for elements in (item.uses, item.targets, item.exceptions):
            first: dict[object, Span] = {}
            for part in elements:
                span = part.name.span if isinstance(part, syntax.ReqRef) else Span(part.start, part.end)
                if first.setdefault(syntax.shape(part), span) is not span:
                    yield _repeated(view, span, first[syntax.shape(part)])
    elif isinstance(item, syntax.Tree):
        for clauses in (item.clauses, *[resolved.node.clauses for resolved in view.seen.demanding]):
            if _names_several(clauses) and not view.is_torn(clauses[0].start, clauses[-1].end):
                yield from _in_clauses(view, clauses)


def _names_several(clauses: tuple[syntax.NodeClause, ...]) -> bool:
    """Whether there is more than one name, which is rare."""
    if len(clauses) != 1:
        return len(clauses) > 1
    clause = clauses[0]
    if isinstance(clause, syntax.Satisfices):
        return len(clause.qualities) > 1 or any(quality.requirements for quality in clause.qualities)
    return len(clause.names if isinstance(clause, syntax.Tags) else clause.uses) > 1


def _in_clauses(view: View, clauses: tuple[syntax.NodeClause, ...]) -> Iterator[Diagnostic]:
    first: dict[object, Span] = {}
    for clause in clauses:
        names = [*_names(view, clause)]
        for index, (meaning, span, is_plain) in enumerate(names):
            if first.setdefault(meaning, span) is not span:
                fixes = (_removal(clause, [place for _, place, _ in names], index, view.text),) if is_plain else ()
                yield _repeated(view, span, first[meaning], fixes)


def _repeated(view: View, span: Span, first: Span, fixes: tuple[Fix, ...] = ()) -> Diagnostic:
    message = f"duplicate `{view.text[span.start : span.end]}` has no effect"
    related = (Related(Place(first), "first one"),)
    return Diagnostic("named-twice", span, message, related=related, fixes=fixes, tags=(Tag.UNNECESSARY,))


def _names(view: View, clause: syntax.NodeClause) -> Iterator[tuple[object, Span, bool]]:
    """The names in a clause: what is equal for those that mean the same, the place, and whether it can be removed; if
    not, the user must decide."""
    if isinstance(clause, syntax.Tags):
        yield from ((("tag", name.text), name.span, True) for name in clause.names)
    elif isinstance(clause, syntax.Satisfices):
        for quality in clause.qualities:
            name = quality.path.text
            match = view.ask(quality_named, name)
            quality_id = match.quality.id if match is not None and match.quality is not None else name
            # A quality that encloses requirements may be here for their sake.
            meaning = "quality", quality_id, bool(quality.requirements) and quality.path.span
            yield meaning, quality.path.span, not quality.requirements
            yield from _requirements(quality.requirements)
    else:
        yield from _requirements(clause.uses)


def _requirements(uses: tuple[syntax.ReqRef | syntax.Requirement, ...]) -> Iterator[tuple[object, Span, bool]]:
    """Requirements, of which a definition, or a name with arguments, cannot be removed."""
    for use in uses:
        arguments = use.arguments if isinstance(use, syntax.ReqRef) else ()
        if use.name is not None:
            is_plain = isinstance(use, syntax.ReqRef) and not arguments
            yield ("requirement", use.name.text, syntax.shape(arguments)), use.name.span, is_plain


def _removal(clause: syntax.NodeClause, places: list[Span], index: int, text: str) -> Fix:
    """The fix that removes one of a clause's names, or the clause if it is the only one."""
    span = places[index]
    if len(places) == 1:
        gone = with_blanks(text, clause)
    elif index == 0:
        gone = Span(span.start, places[1].start)
    else:
        gone = Span(places[index - 1].end, span.end)
    return replace_fix(f"Remove `{' '.join(text[gone.start : gone.end].strip(' ,').split())}`", gone, "", safe=True)
