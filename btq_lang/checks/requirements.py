"""Requirements that are unknown, contradictory, unused, empty, or cannot be resolved; claims about nothing; signals and
contexts to which nothing refers.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.verbs import VERBS
from btq_lang.checks import lookups
from btq_lang.checks.chain import in_other_clause, is_external, is_refined, may_be_external, near_external
from btq_lang.checks.includes import NOWHERE, include_fix
from btq_lang.checks.qualifiers import SPLIT
from btq_lang.checks.qualities import other_word
from btq_lang.checks.view import (
    COUNTS,
    SECOND,
    View,
    has_names,
    has_trees,
    is_used,
    misspelt_clause,
    near_names,
    quality_named,
)
from btq_lang.diagnostics.model import Diagnostic, Related, Tag, replace_fix
from btq_lang.grammar.clause_slips import OF_MISSION
from btq_lang.grammar.cursor import shown
from btq_lang.syntax.tree import Assuming, Claim, Context, How, OnViolation, Requirement, Signal, Tree, written
from btq_lang.util.spelling import did_you_mean, near
from btq_lang.workspace import inputs
from btq_lang.workspace.item_index import Facts
from btq_lang.workspace.queries import Store, hub
from btq_lang.workspace.symbols import Symbol, names_subject, same_requirement
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:
    from btq_lang.requirements.model import ResolvedClaim


def unknown_requirement(view: View) -> Iterator[Diagnostic]:
    """A requirement that is named but defined nowhere."""
    for use in view.uses(Kind.REQUIREMENT):
        if view.ask(lookups.is_defined, Kind.REQUIREMENT, use.name):
            continue
        if view.ask(lookups.is_defined, Kind.HAZARD, use.name):
            yield in_other_clause(view, use, "unknown-requirement")
            continue
        if is_refined(view, use) and may_be_external(view, use.name):
            continue
        if is_external(view, use.name):
            message = f"`{use.name}` is a requirement of another tool, and has no clauses that a node could satisfy"
            instead = f"define one with clauses and `refines {written(use.name)}`, and attach that"
            yield Diagnostic("unknown-requirement", use.span, message, notes=(instead,))
            continue
        if not view.ask(inputs.is_complete):
            return
        elsewhere = view.ask(lookups.elsewhere, Kind.REQUIREMENT, use.name)
        quality = view.ask(quality_named, use.name) if not is_refined(view, use) else None
        if not elsewhere and not is_refined(view, use) and (quality is None or quality.kind != "unknown"):
            is_exact = quality is None or quality.kind == "exact"
            yield other_word(view, use, "unknown-requirement", requirement=False, safe=is_exact)
            continue
        fixes = tuple(include_fix(view, path) for path in elsewhere[:3])
        external = near_external(view, use.name) if is_refined(view, use) else ()
        likely = (*view.ask(near_names, Kind.REQUIREMENT, use.name), *external)
        fixes += tuple(replace_fix(f"Replace `{use.name}` with `{name}`", use.span, written(name)) for name in likely)
        message = f"unknown requirement `{use.name}`{NOWHERE if elsewhere or not likely else did_you_mean(likely)}"
        meant = quality.near if quality is not None and not fixes else ()
        notes = tuple(f"if the quality `{name}` is meant, write `satisfices {name}`" for name in meant[:1])
        yield Diagnostic("unknown-requirement", use.span, message, notes=notes, fixes=fixes)


def conflicting_requirement(view: View) -> Iterator[Diagnostic]:
    """Two requirements of one ID with different content; with the same content they are one requirement."""
    for first, second in view.clashes(Kind.REQUIREMENT):
        if _differ(second.symbol, first.symbol):
            related = (Related(first.place, COUNTS), Related(second.place, "other definition"))
            message = f"this file includes a second requirement `{second.symbol.name}` with different content"
            yield Diagnostic("conflicting-requirement", view.head, message, related=related)
    for symbol, other, counts in view.repeated(Kind.REQUIREMENT):
        if _differ(symbol, other.symbol):
            message = f"conflicting definitions of the requirement `{symbol.name}`"
            definition = Related(other.place, COUNTS if counts else SECOND)
            notes = (_other_way(view, symbol),)
            yield Diagnostic("conflicting-requirement", symbol.span, message, related=(definition,), notes=notes)


def unused_requirement(view: View) -> Iterator[Diagnostic]:
    """A requirement at file level that is attached to nothing: by no node, no `apply` and no subject of its own."""
    requirement = view.item
    if not isinstance(requirement, Requirement) or requirement.name is None:
        return
    if names_subject(requirement):
        return
    if not view.ask(has_trees) or view.is_used_elsewhere:
        return  # a file of requirements, or a library: its users may be anywhere
    if not view.defines_here(Kind.REQUIREMENT, requirement.name.text):
        return
    name = requirement.name.text
    if (
        view.ask(is_used, Kind.REQUIREMENT, name)
        or view.ask(is_used, Kind.QUALITY, name)
        or view.ask(_is_misspelt_use, name)
    ):
        return  # a quality or a node of this name, which probably means it, is reported
    if not view.is_read or view.ask(lookups.names_unknown_requirements):
        return  # its user may be on a line that could not be read, or misspell it
    message = f"unused requirement `{name}`: no `satisfies` or `apply` attaches it to a node"
    notes = (f"attach it to a node with `satisfies {written(name)}` or `apply`", *_unused_notes(requirement))
    yield Diagnostic("unused-requirement", requirement.name.span, message, notes=notes, tags=(Tag.UNNECESSARY,))


def _unused_notes(requirement: Requirement) -> Iterator[str]:
    """How to attach a requirement that is about no node."""
    if not any(isinstance(clause, Claim) for clause in requirement.clauses):
        yield OF_MISSION
        return
    yield CLAIMS_OF_MISSION
    if (ways := _ways(requirement)) and "monitor" not in ways:
        yield AS_PROSE


def requirement_without_text(view: View) -> Iterator[Diagnostic]:
    """A requirement with neither a text nor a clause, or with nothing to which its `on violation` or assumption could
    apply."""
    for symbol, requirement in view.requirements:
        idle = _idle_clause(view, requirement)
        if idle is None and not _is_empty(requirement):
            continue
        if view.is_torn(requirement.start, requirement.end):
            continue  # its contents may be on a line that could not be read
        message = f"the requirement `{symbol.name}` demands nothing"
        if idle is not None:
            words = " ".join(view.text[idle.start : idle.end].split())
            message += f" that can be violated, so `{shown(words, most=80)}` has no effect"
        note = "add a clause such as `takes at most 30 s`" + ("" if idle else ", or a title in quotes")
        if isinstance(idle, Assuming):
            note = (
                "an assumption counts for the clauses of its own requirement only: write it in each that relies on it"
            )
        yield Diagnostic("requirement-without-text", symbol.span, message, notes=(note,))


def unused_word(view: View) -> Iterator[Diagnostic]:
    """A signal that no condition, no bound and no `uses` names, or a context that no condition names."""
    kind = Kind.SIGNAL if isinstance(view.item, Signal) else Kind.CONTEXT
    name = view.item.name if isinstance(view.item, Signal | Context) else None
    if name is None or not view.ask(has_trees) or view.is_used_elsewhere:
        return  # a file of signals, or a library: their users may be anywhere
    if not view.defines_here(kind, name.text) or view.ask(lookups.is_asked_for, name.text):
        return
    if view.ask(lookups.is_asked_for_by_scenarios, name.text):
        return
    if not view.ask(_is_meant, name.text) and view.is_read:  # else its user may be on a line that could not be read
        rule, users = ("unused-signal", "clause") if kind is Kind.SIGNAL else ("unused-context", "condition")
        message = f"no {users} uses the {kind.value} `{name.text}`"
        yield Diagnostic(rule, name.span, message, tags=(Tag.UNNECESSARY,))


def _other_way(view: View, symbol: Symbol) -> str:
    """What to write instead of a second definition: only below a node can a reference replace it."""
    if symbol.target is view.item:
        return "keep one definition, or give this requirement another ID"
    return f"write `satisfies {written(symbol.name)}` to refer to it, or use another ID"


def _differ(symbol: Symbol, first: Symbol) -> bool:
    """Whether two definitions contradict each other; another rule reports an empty one."""
    mine, other = symbol.target, first.target
    return (
        isinstance(mine, Requirement)
        and isinstance(other, Requirement)
        and not (_is_empty(mine) or _is_empty(other))
        and not same_requirement(mine, other)
    )


def _idle_clause(view: View, requirement: Requirement) -> OnViolation | Assuming | None:
    """What to do on violation, or an assumption, of a requirement that claims nothing, neither by a clause nor in its
    description; of one that people verify, an assumption tells them something.
    """
    if any(isinstance(clause, Claim) for clause in requirement.clauses) or view.constraints(requirement):
        return None
    ways = _ways(requirement)
    for clause in requirement.clauses:
        if isinstance(clause, OnViolation) and clause.action is not None:
            return clause
        if isinstance(clause, Assuming) and (not ways or "monitor" in ways):
            return clause
    return None


def _ways(requirement: Requirement) -> set[str]:
    """How a requirement is verified."""
    return {way.method.raw for clause in requirement.clauses if isinstance(clause, How) for way in clause.ways}


def _is_empty(requirement: Requirement) -> bool:
    return not requirement.clauses and (requirement.text is None or not requirement.text.text.strip())


def _is_meant(store: Store[Workspace], viewpoint: str, name: str) -> bool:
    """Whether something uses an undeclared name that is similar to this one; another rule reports it."""
    view = View(store, viewpoint)
    names = view.ask(lookups.asked_for_in_vain)
    declared = len(view.ask(inputs.names, Kind.SIGNAL)) + len(view.ask(inputs.names, Kind.CONTEXT))
    if len(names) * declared > _MOST_COMPARED:
        return True  # among so many unknown names there is a similar one to any
    return bool(near(name, names, limit=1))


def _is_misspelt_use(store: Store[Workspace], viewpoint: str, name: str) -> bool:
    return any(name in store.ask(_misspelt_uses, facts) for facts in store.ask(lookups.trees, viewpoint))


def _misspelt_uses(_: Store[Workspace], facts: Facts) -> frozenset[str]:
    nodes = facts.item.walk() if isinstance(facts.item, Tree) else ()
    return frozenset(node.label.text for node in nodes if node.label is not None and misspelt_clause(node))


@hub
def is_measured(store: Store[Workspace], viewpoint: str) -> bool:
    """Whether any requirement in scope has a clause, or a signal or context is declared; else there is nothing to
    resolve."""
    view = View(store, viewpoint)
    if view.ask(has_names, Kind.SIGNAL) or view.ask(has_names, Kind.CONTEXT):
        return True
    names = view.ask(inputs.names, Kind.REQUIREMENT)
    return any(view.ask(_has_clauses, name) for name in names) or view.ask(lookups.has_apply)


def _has_clauses(store: Store[Workspace], viewpoint: str, name: str) -> bool:
    view = View(store, viewpoint)
    meaning = view.ask(lookups.meaning, Kind.REQUIREMENT, name)
    target = meaning.target if meaning is not None else None
    return isinstance(target, Requirement) and bool(
        target.clauses or target.parameters or any(checkable for _, checkable in view.constraints(target))
    )


def unresolved(view: View) -> Iterator[Diagnostic]:
    """The problems in the requirements of an entry that show when they are resolved: units, signals, paths,
    arguments."""
    if not view.ask(is_measured):
        return
    from btq_lang.requirements.resolve import problems_in  # a file without clauses needs none of it

    yield from [problem.diagnostic for problem in view.ask(problems_in, view.path, view.facts)]


def requirement_without_subject(view: View) -> Iterator[Diagnostic]:
    """A claim without a subject in a requirement that has claims with one; if none has one, the requirement is unused
    and another rule reports it.  Also a claim about a span or a sum whose verb applies only to nodes."""
    if not isinstance(view.item, Requirement) or not view.ask(is_measured):
        return
    names = [symbol.name for symbol in view.facts.summary.symbols]
    diagnostics = [
        diagnostic
        for name in names
        if view.defines_here(Kind.REQUIREMENT, name)
        for diagnostic in _without_subject(view, name)
    ]
    if (
        diagnostics and view.is_read and not view.ask(inputs.is_included)
    ):  # last, for both often change with an edit elsewhere
        yield from diagnostics


def _without_subject(view: View, name: str) -> Iterator[Diagnostic]:
    from btq_lang.requirements.definitions import requirement  # as above
    from btq_lang.requirements.model import DurationSum, Interval
    from btq_lang.requirements.nodes import has_nodes

    resolved, _ = view.ask(requirement, name)
    claims = resolved.claims if resolved is not None and view.ask(has_nodes) else ()
    is_about_nothing = all(claim.subject is None for claim in claims)
    for claim in claims:
        if isinstance(claim.subject, Interval | DurationSum) and VERBS[claim.verb].limits != "completion":
            subject = (
                "the time from one event to another" if isinstance(claim.subject, Interval) else "a sum of durations"
            )
            message = f"`{claim.head}` is about a node, not about {subject}, so nothing can check it"
            note = "write `takes` after it, or a node before the verb"
            yield _diagnostic(claim, message, note)
        elif resolved is not None and resolved.span is not None and not VERBS[claim.verb].is_of_moments:
            message = f"`{claim.verb}` is not about the time in `{resolved.span.text}`, so nothing can check it"
            note = "`from … until` is for `keeps` and `never`; of other verbs, `while` and `when` limit what counts"
            if any(VERBS[other.verb].is_of_moments for other in claims):
                note = f"{SPLIT}; {note}"
            yield _diagnostic(claim, message, note)
        elif claim.subject is None and not is_about_nothing and not view.ask(_is_attached, name):
            message = f"missing subject of `{claim.text}`"
            note = "write a node before the verb, or attach the requirement to a node with `satisfies`"
            yield _diagnostic(claim, message, note)


def _diagnostic(claim: ResolvedClaim, message: str, note: str) -> Diagnostic:
    return Diagnostic("requirement-without-subject", claim.place.span, message, notes=(note,))


def _is_attached(store: Store[Workspace], viewpoint: str, name: str) -> bool:
    from btq_lang.requirements.attach import attached_names  # as above

    return name in store.ask(attached_names, viewpoint)


_MOST_COMPARED = 200_000  # pairs of names: some tenths of a second
CLAIMS_OF_MISSION: Final = (
    "at the root node of the main tree its claims are about the whole mission, as with `mission` before the verb"
)
_OF_ITS_OWN: Final = (
    "an assumption counts for the clauses of its own requirement only: write it in each that relies on it"
)
AS_PROSE: Final = "what people verify needs no claim: without it, what the requirement demands is prose in its title"
