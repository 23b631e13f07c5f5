"""Names of qualities that are unknown, of another edition, or ambiguous; none is an error, as a quality model is open.
Also what is attached with the wrong word: a requirement with `satisfices`, or a quality with `satisfies`."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.qualities import EDITIONS, QualityMatch, fold, successors
from btq_lang.checks import lookups
from btq_lang.checks.view import View, near_names, quality_named
from btq_lang.diagnostics.model import Diagnostic, Fix, Tag, replace_fix
from btq_lang.diagnostics.rules import Severity
from btq_lang.syntax.tree import Qualities, Requirement, Satisfices, Satisfies, Tree, written
from btq_lang.util.spelling import did_you_mean
from btq_lang.util.text import Span
from btq_lang.workspace import inputs
from btq_lang.workspace.symbols import Use


def quality_name(view: View) -> Iterator[Diagnostic]:
    """An unknown edition; and qualities that no file in scope declares and that are unknown to the standard, an alias,
    of another edition, or ambiguous."""
    if isinstance(view.item, Qualities) and view.item.edition is not None:
        edition = view.item.edition
        if edition.text not in EDITIONS:
            message = f"unknown quality model `{edition.text}`"
            fixes = tuple(replace_fix(f"Replace it with `{name}`", edition.span, name) for name in EDITIONS)
            yield Diagnostic("unknown-quality", edition.span, message, fixes=fixes)
    for use in view.uses(Kind.QUALITY):
        match = view.ask(quality_named, use.name) if use.name else None
        if match is not None and match.kind == "unknown":
            yield from _unknown(view, use, match)
        elif match is not None and match.kind in ("alias", "other-edition"):
            yield _old(view, use, match)
        elif match is not None and match.kind == "ambiguous":
            yield _ambiguous(view, use, match)


def _unknown(view: View, use: Use, match: QualityMatch) -> Iterator[Diagnostic]:
    if (meaning := view.ask(lookups.meaning, Kind.REQUIREMENT, use.name)) is not None:
        takes_arguments = isinstance(meaning.target, Requirement) and bool(meaning.target.parameters)
        yield other_word(view, use, "unknown-quality", requirement=True, safe=not takes_arguments)
        return
    own = tuple(written(name) for name in view.ask(near_names, Kind.QUALITY, use.name))
    meant = tuple(dict.fromkeys((*own, *match.near)))[:3]
    if not meant and not view.ask(inputs.is_complete):
        return  # it may be declared on a line that could not be read
    message = f"unknown quality `{use.name}`{did_you_mean(meant)}"
    fixes = tuple(replace_fix(f"Replace `{use.name}` with `{name}`", _whole(view, use), name) for name in meant)
    notes = () if meant else (f"declare your own quality with a line `quality {written(_last(use))}`",)
    yield Diagnostic("unknown-quality", use.span, message, notes=notes, fixes=fixes)


def _old(view: View, use: Use, match: QualityMatch) -> Diagnostic:
    is_alias = match.kind == "alias"
    if not match.safe:
        message = f"{view.ask(lookups.edition)} does not define `{use.name}`"
    elif is_alias:
        message = f"`{use.name}` is an alias of `{match.candidates[0].id}`"
    else:
        message = f"`{use.name}` is called `{match.candidates[0].id}` in {view.ask(lookups.edition)}"
    # "`x` is another word for y" adds nothing to such a message.
    notes = (match.explanation,) if match.explanation and not (is_alias and match.safe) else ()
    meant = [candidate.id for candidate in match.candidates[:3]]
    fixes = tuple(replace_fix(f"Replace it with `{id_}`", _whole(view, use), id_, safe=match.safe) for id_ in meant)
    tags = () if is_alias else (Tag.DEPRECATED,)
    return Diagnostic("old-quality-name", use.span, message, notes=notes, fixes=fixes, tags=tags)


def _ambiguous(view: View, use: Use, match: QualityMatch) -> Diagnostic:
    # The old name of a characteristic, `usability`, is read as what the characteristic is called now.
    usual = match.candidates[0].id if match.candidates[0].id in successors(fold(use.name)) else None
    message = f"ambiguous quality name `{use.name}`" + (f"; btq reads it as `{usual}`" if usual else "")
    fixes = tuple(
        replace_fix(f"Replace it with `{candidate.id}`: {candidate.name}", _whole(view, use), candidate.id)
        for candidate in match.candidates[:4]
    )
    notes = (match.explanation,) if match.explanation else ()
    severity = Severity.INFO if usual else None
    return Diagnostic("ambiguous-quality", use.span, message, notes=notes, fixes=fixes, severity=severity)


def other_word(view: View, use: Use, rule: str, *, requirement: bool, safe: bool = True) -> Diagnostic:
    """The diagnostic for a requirement in the place of a quality, or the other way round.

    Args:
        requirement: whether the name is that of a requirement.
        safe: whether the name would be right after the other word.
    """
    kind, other_kind = ("requirement", "quality") if requirement else ("quality", "requirement")
    word, other = _WORDS if requirement else _WORDS[::-1]
    span = _alone(view, use, word)
    fixes: tuple[Fix, ...] = (replace_fix(f"Replace `{word}` with `{other}`", span, other, safe=safe),) if span else ()
    message = f"`{use.name}` is a {kind}, not a {other_kind}"
    notes = ("`satisfices` names qualities, `satisfies` names requirements",)
    return Diagnostic(rule, use.span, message, notes=notes, fixes=fixes)


def _whole(view: View, use: Use) -> Span:
    """The span to replace; for `performance <time-behavior>` it includes the `>`, which is not part of the name."""
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
