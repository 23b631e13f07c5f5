"""What one node, or one `apply`, names twice: a requirement, a quality, a tag, nodes."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.checks.clauses import with_blanks
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Fix, Place, Related, Tag, replace_fix
from btq_lang.syntax.tree import (
    Apply,
    NodeClause,
    ReqRef,
    Requirement,
    Satisfices,
    Satisfies,
    Tags,
    Tree,
    Word,
    shape,
)
from btq_lang.util.record import Record
from btq_lang.util.text import Span


class _Named(Record):
    """A name in a list.

    Attributes:
        says: equal for names that mean the same.
        clause: that can be fixed; None if the user must decide.
        beside: the places of all names of the clause, and the index of this one.
    """

    says: object
    span: Span
    clause: NodeClause | None = None
    beside: tuple[tuple[Span, ...], int] = ((), 0)


def named_twice(view: View) -> Iterator[Diagnostic]:
    """The second of two places that attach the same requirement, quality or tag to a node."""
    item = view.item
    if isinstance(item, Apply):
        for elements in (item.uses, item.targets, item.exceptions):
            spans = [part.name.span if isinstance(part, ReqRef) else Span(part.start, part.end) for part in elements]
            named = [_Named(shape(part), span) for part, span in zip(elements, spans, strict=True)]
            yield from _repeated(view, named)
    elif isinstance(item, Tree):
        for clauses in (item.clauses, *[seen.node.clauses for seen in view.seen.demanding]):
            if _names_several(clauses) and not view.is_torn(clauses[0].start, clauses[-1].end):
                yield from _repeated(view, [named for clause in clauses for named in _of_clause(view, clause)])


def _names_several(clauses: tuple[NodeClause, ...]) -> bool:
    """Whether there is more than one name, which is rare."""
    if len(clauses) != 1:
        return len(clauses) > 1
    clause = clauses[0]
    if isinstance(clause, Satisfices):
        return len(clause.qualities) > 1 or any(quality.requirements for quality in clause.qualities)
    return len(clause.names if isinstance(clause, Tags) else clause.uses) > 1


def _repeated(view: View, names: list[_Named]) -> Iterator[Diagnostic]:
    first: dict[object, Span] = {}
    for named in names:
        if first.setdefault(named.says, named.span) is named.span:
            continue
        text = view.text
        yield Diagnostic(
            "named-twice",
            named.span,
            f"duplicate `{text[named.span.start : named.span.end]}` has no effect",
            related=(Related(Place(first[named.says]), "first one"),),
            fixes=(_removal(named.clause, *named.beside, text),) if named.clause is not None else (),
            tags=(Tag.UNNECESSARY,),
        )


def _of_clause(view: View, clause: NodeClause) -> Iterator[_Named]:
    words: list[tuple[object, Word | None, Span]] = []
    if isinstance(clause, Tags):
        words = [(("tag", name.text), name, name.span) for name in clause.names]
    elif isinstance(clause, Satisfies):
        words = [_of_requirement(use) for use in clause.uses if use.name is not None]
    elif isinstance(clause, Satisfices):
        for quality in clause.qualities:
            name = quality.path.text
            match = view.quality(name)
            same = match.quality.id if match is not None and match.quality is not None else name
            # A quality that encloses requirements may be here for their sake.
            says: object = ("quality", same, bool(quality.requirements) and quality.path.span)
            words.append((says, None if quality.requirements else quality.path.names[-1], quality.path.span))
            words += [_of_requirement(use) for use in quality.requirements if use.name is not None]
    places = tuple([span for _, _, span in words])
    for index, (says, word, span) in enumerate(words):
        yield _Named(says, span, clause if word is not None else None, (places, index))


def _of_requirement(use: ReqRef | Requirement) -> tuple[object, Word | None, Span]:
    """A name without arguments can be removed; if it is defined in place, or has some, the user must decide."""
    assert use.name is not None, "the caller has looked"
    arguments = use.arguments if isinstance(use, ReqRef) else ()
    is_plain = isinstance(use, ReqRef) and not arguments
    return ("requirement", use.name.text, shape(arguments)), use.name if is_plain else None, use.name.span


def _removal(clause: NodeClause, places: tuple[Span, ...], index: int, text: str) -> Fix:
    """The fix that removes one of a clause's names, or the clause if it is the only one."""
    span = places[index]
    if len(places) == 1:
        gone = with_blanks(text, clause)
    elif index == 0:
        gone = Span(span.start, places[1].start)
    else:
        gone = Span(places[index - 1].end, span.end)
    return replace_fix(f"Remove `{' '.join(text[gone.start : gone.end].strip(' ,').split())}`", gone, "", safe=True)
