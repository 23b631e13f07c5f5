"""Quality names: unknown, of another edition, or with several meanings.  None is an error: a model is open.  Also what
is attached with the wrong word: a requirement with `satisfices`, or a quality with `satisfies`."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.qualities import EDITIONS, QualityMatch, fold, successors
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Fix, Tag, replace_fix
from btq_lang.diagnostics.rules import Severity
from btq_lang.syntax.tree import Qualities, Requirement, Satisfices, Satisfies, Tree, written
from btq_lang.util.spelling import did_you_mean
from btq_lang.util.text import Span
from btq_lang.workspace.symbols import Use


def unknown_quality(view: View) -> Iterator[Diagnostic]:
    """A name that is neither the standard's nor declared in a file, and an unknown edition."""
    if isinstance(view.item, Qualities) and view.item.edition is not None:
        edition = view.item.edition
        if edition.text not in EDITIONS:
            message = f"unknown quality model `{edition.text}`"
            fixes = tuple(replace_fix(f"Replace it with `{name}`", edition.span, name) for name in EDITIONS)
            yield Diagnostic("unknown-quality", edition.span, message, fixes=fixes)
    for use, match in _matches(view):
        if match.kind != "unknown":
            continue
        if (meaning := view.find(Kind.REQUIREMENT, use.name)) is not None:
            takes_arguments = isinstance(meaning.target, Requirement) and bool(meaning.target.parameters)
            yield other_word(view, use, "unknown-quality", requirement=True, safe=not takes_arguments)
            continue
        own = tuple(written(name) for name in view.near(use.name, Kind.QUALITY))
        meant = tuple(dict.fromkeys((*own, *match.near)))[:3]
        if not meant and not view.is_complete:
            continue  # it may be declared on a line that could not be read
        yield Diagnostic(
            "unknown-quality",
            use.span,
            f"unknown quality `{use.name}`{did_you_mean(meant)}",
            notes=() if meant else (f"declare your own quality with a line `quality {written(_last(use))}`",),
            fixes=tuple(replace_fix(f"Replace `{use.name}` with `{name}`", _whole(view, use), name) for name in meant),
        )


def old_quality_name(view: View) -> Iterator[Diagnostic]:
    """An alias, or a name of another edition."""
    for use, match in _matches(view):
        if match.kind not in ("alias", "other-edition"):
            continue
        is_alias = match.kind == "alias"
        if match.safe:
            new = match.candidates[0].id
            message = f"`{use.name}` is an alias of `{new}`"
            if not is_alias:
                message = f"`{use.name}` is called `{new}` in {view.edition}"
        else:
            message = f"{view.edition} does not define `{use.name}`"
        # "`x` is another word for y" adds nothing to such a message.
        notes = (match.explanation,) if match.explanation and not (is_alias and match.safe) else ()
        yield Diagnostic(
            "old-quality-name",
            use.span,
            message,
            notes=notes,
            fixes=tuple(
                replace_fix(f"Replace it with `{candidate.id}`", _whole(view, use), candidate.id, safe=match.safe)
                for candidate in match.candidates[:3]
            ),
            tags=() if is_alias else (Tag.DEPRECATED,),
        )


def ambiguous_quality(view: View) -> Iterator[Diagnostic]:
    """A name with several meanings."""
    for use, match in _matches(view):
        if match.kind != "ambiguous":
            continue
        # The old name of a characteristic, `usability`, is read as what the characteristic is called now.
        usual = match.candidates[0].id if match.candidates[0].id in successors(fold(use.name)) else None
        yield Diagnostic(
            "ambiguous-quality",
            use.span,
            f"ambiguous quality name `{use.name}`" + (f"; btq reads it as `{usual}`" if usual else ""),
            notes=(match.explanation,) if match.explanation else (),
            fixes=tuple(
                replace_fix(f"Replace it with `{candidate.id}`: {candidate.name}", _whole(view, use), candidate.id)
                for candidate in match.candidates[:4]
            ),
            severity=Severity.INFO if usual else None,
        )


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


def _matches(view: View) -> Iterator[tuple[Use, QualityMatch]]:
    """Each quality named in an entry, except those that the files in scope declare themselves."""
    for use in view.uses(Kind.QUALITY):
        if use.name and (match := view.quality(use.name)) is not None:
            yield use, match


def _whole(view: View, use: Use) -> Span:
    """The span to replace: for `performance <time-behavior>` with the `>`, which is not a part of the name."""
    text = view.text
    end = use.span.end
    if "<" in text[use.span.start : end]:
        closing = text.find(">", end)
        if closing >= 0 and not text[end:closing].strip():
            return Span(use.span.start, closing + 1)
    return use.span


def _last(use: Use) -> str:
    return use.name.rpartition(".")[2]


_WORDS = ("satisfices", "satisfies")


def _alone(view: View, use: Use, word: str) -> Span | None:
    """The word of the clause that contains only this name."""
    clauses = use.node.clauses if use.node is not None else view.item.clauses if isinstance(view.item, Tree) else ()
    for clause in clauses:
        if isinstance(clause, Satisfices | Satisfies) and clause.start < use.span.start and clause.end == use.span.end:
            before = view.text[clause.start : use.span.start]
            return Span(clause.start, clause.start + len(word)) if before.strip() == word else None
    return None
