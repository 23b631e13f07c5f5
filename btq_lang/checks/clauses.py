"""Clauses of one requirement that are repeated, about nothing, or incomplete; and what one node, or one `apply`, names
twice: a requirement, a quality, a tag, nodes.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from btq_lang.catalog.verbs import POOLED
from btq_lang.checks import lookups
from btq_lang.checks.bounds import is_rate_meant
from btq_lang.checks.qualifiers import SPLIT, is_beside_one
from btq_lang.checks.view import View, quality_named
from btq_lang.diagnostics.model import Diagnostic, Fix, Place, Related, Tag, replace_fix
from btq_lang.syntax import tree as syntax
from btq_lang.syntax.tokens import QUANTITY
from btq_lang.util.text import Span
from btq_lang.workspace.symbols import Symbol

_ONCE: dict[type, str] = {
    syntax.FromUntil: "from when until when it must hold",
    syntax.Average: "that the mean counts",
    syntax.Odds: "how often it must hold",
    syntax.Confidence: "a confidence",
    syntax.Window: "a window",
    syntax.OnViolation: "what happens on violation",
    syntax.Goal: "a goal",
    syntax.How: "how to verify it",
    syntax.Priority: "a priority",
}


def duplicate_clause(view: View) -> Iterator[Diagnostic]:
    """A second clause of a kind where only the first takes effect; an equal one can be removed."""
    for symbol, requirement in view.requirements:
        first: dict[object, syntax.Clause] = {}
        for clause in requirement.clauses:
            if isinstance(clause, syntax.Odds) and not _is_share(clause):
                continue  # `succeeds in 45 s`, which the parser reports
            if type(clause) in _ONCE and (counts := first.setdefault(_kind(clause), clause)) is not clause:
                yield _duplicate(view, symbol, requirement, counts, clause)


def _is_share(odds: syntax.Odds) -> bool:
    return odds.value is None or odds.value.kind != QUANTITY or odds.value.raw.endswith("%")


def clause_without_odds(view: View) -> Iterator[Diagnostic]:
    """A confidence, or a window of runs or activations, in a requirement without a required probability."""
    for _, requirement in view.requirements:
        if any(isinstance(clause, syntax.Odds) and not clause.is_of_time for clause in requirement.clauses):
            continue
        if any(_is_of_all_runs(view, clause) for clause in requirement.clauses):
            continue  # a confidence counts there, too
        if view.is_torn(requirement.start, requirement.end):
            continue  # the odds may be on a line that could not be read
        for clause in requirement.clauses:
            is_confidence = isinstance(clause, syntax.Confidence)
            if is_confidence or (isinstance(clause, syntax.Window) and clause.experiments is not None):
                subject = "a confidence" if is_confidence else "the window"
                message = f"{subject} has no effect here: without a required probability a single violation counts"
                notes = ("state how often it must hold: `in at least 95 % of activations`",)
                yield Diagnostic("clause-without-odds", Span(clause.start, clause.end), message, notes=notes)


def odds_of_what(view: View) -> Iterator[Diagnostic]:
    """A probability that counts the occurrences of an event, in a requirement about activations, or the reverse."""
    for _, requirement in view.requirements:
        subjects = [clause.subject for clause in requirement.clauses if isinstance(clause, syntax.Claim)]
        are_events = {isinstance(subject, syntax.EachEvent) for subject in subjects}
        counted = [clause.experiments for clause in requirement.clauses if isinstance(clause, syntax.Odds)]
        for word in counted:
            if word is None or len(are_events) != 1 or are_events != {word.raw == "activations"}:
                continue
            if word.raw == "activations":
                message, meant = "an event has occurrences, not activations", "occurrences"
            elif word.raw == "occurrences":
                message, meant = "only an event has occurrences: `each … is followed by …`", "activations"
            else:
                continue
            fix = replace_fix(f"Replace `{word.raw}` with `{meant}`", word.span, meant)
            notes = (_OF_SPANS,) if any(isinstance(subject, syntax.Between) for subject in subjects) else ()
            yield Diagnostic("impossible-odds", word.span, message, notes=notes, fixes=(fix,))


def unused_parameter(view: View) -> Iterator[Diagnostic]:
    """A parameter that no clause of its requirement uses, so that its value has no effect."""
    for _, requirement in view.requirements:
        if not requirement.parameters:
            continue
        if view.is_torn(requirement.start, requirement.end):
            continue  # its use may be on a line that could not be read
        used = {word.text for word in syntax.walk(requirement.clauses) if isinstance(word, syntax.Word)}
        for parameter in requirement.parameters:
            if parameter.name.text not in used:
                message = f"no clause uses the parameter `{parameter.name.text}`, so its value has no effect"
                yield Diagnostic("unused-parameter", parameter.name.span, message, tags=(Tag.UNNECESSARY,))


def _is_of_all_runs(view: View, clause: syntax.Clause) -> bool:
    """Whether all runs are judged together because of a clause."""
    if isinstance(clause, syntax.Claim):
        return clause.row in POOLED or is_rate_meant(view, clause)
    return isinstance(clause, syntax.Average)


def _kind(clause: syntax.Clause) -> object:
    """Equal for clauses of which only the first counts; it differs for a share of time and for odds."""
    return type(clause), isinstance(clause, syntax.Odds) and clause.is_of_time


def _duplicate(
    view: View, symbol: Symbol, requirement: syntax.Requirement, counts: syntax.Clause, clause: syntax.Clause
) -> Diagnostic:
    text = view.text
    stated, restated = (" ".join(text[repeated.start : repeated.end].split()) for repeated in (counts, clause))
    removals = [(restated, clause)] if stated == restated else [(restated, clause), (stated, counts)]
    is_of_time = isinstance(clause, syntax.Odds) and clause.is_of_time
    what = "a share of time" if is_of_time else _ONCE[type(clause)]
    message = f"the requirement already states {what}: `{stated}`"
    # If one of several equal definitions lacked it, it would contradict the others.
    is_alone = not view.ask(lookups.is_repeated, symbol.kind, symbol.name)
    is_of_one = stated != restated and any(is_beside_one(text, requirement, each) for each in (counts, clause))
    notes = (f"each holds for all claims of this requirement; {SPLIT}",) if is_of_one else ()
    fixes = tuple(
        replace_fix(f"Remove `{words}`", with_blanks(text, removed), "", safe=is_alone and stated == restated)
        for words, removed in removals
    )
    related = (Related(Place(Span(counts.start, counts.end)), "this one takes effect"),)
    span = Span(clause.start, clause.end)
    return Diagnostic("duplicate-clause", span, message, related=related, notes=notes, fixes=fixes)


def with_blanks(text: str, clause: syntax.Clause | syntax.NodeClause | syntax.Port) -> Span:
    """A clause or port with the blanks that would remain, and with its line if nothing else is on it."""
    start, end = clause.start, clause.end
    while start and text[start - 1] in " \t":
        start -= 1
    is_first = start == 0 or text[start - 1] in "\r\n"
    is_last = text[end : end + 1] in ("", "\r", "\n")
    if is_first and is_last:
        start -= 2 if text[:start].endswith("\r\n") else 1
    elif is_first:
        start = clause.start
        end += len(text[end:]) - len(text[end:].lstrip(" \t"))
    return Span(start, end)


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
    """The names in a clause, each with a key that is equal for names of one meaning, its place, and whether a fix may
    remove it."""
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
    """The same for requirements; a fix removes neither a definition nor a name with arguments."""
    for use in uses:
        arguments = use.arguments if isinstance(use, syntax.ReqRef) else ()
        if use.name is not None:
            is_plain = isinstance(use, syntax.ReqRef) and not arguments
            yield ("requirement", use.name.text, syntax.shape(arguments)), use.name.span, is_plain


def _removal(clause: syntax.NodeClause, places: list[Span], index: int, text: str) -> Fix:
    """The fix that removes one of a clause's names, or the clause if it is the only one."""
    span = places[index]
    if len(places) == 1:
        removed = with_blanks(text, clause)
    elif index == 0:
        removed = Span(span.start, places[1].start)
    else:
        removed = Span(places[index - 1].end, span.end)
    return replace_fix(
        f"Remove `{' '.join(text[removed.start : removed.end].strip(' ,').split())}`", removed, "", safe=True
    )


_OF_SPANS: Final = (
    "of `from … to …`, `of activations` counts each time from a first event to its last one, `of runs` the runs in "
    "which all of them keep the bound"
)
