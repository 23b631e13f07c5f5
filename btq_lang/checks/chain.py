"""The chain from hazards to requirements: hazards that are not declared, requirements that refine themselves, and IDs
that a hazard and a requirement share.
"""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.catalog.name_kinds import Kind
from btq_lang.checks import lookups
from btq_lang.checks.includes import NOWHERE, include_fix
from btq_lang.checks.view import View, near_names
from btq_lang.diagnostics.model import Diagnostic, Fix, replace_fix
from btq_lang.syntax.tree import Mitigates, Refines, Requirement, Word, written
from btq_lang.util.reach import reached
from btq_lang.util.spelling import did_you_mean, near
from btq_lang.workspace import inputs
from btq_lang.workspace.queries import Store
from btq_lang.workspace.symbols import Use
from btq_lang.workspace.workspace import Workspace


def unknown_hazard(view: View) -> Iterator[Diagnostic]:
    """A hazard that is mitigated but declared nowhere."""
    for use in view.uses(Kind.HAZARD):
        if view.ask(lookups.is_defined, Kind.HAZARD, use.name):
            continue
        if view.ask(lookups.is_defined, Kind.REQUIREMENT, use.name):
            yield in_other_clause(view, use, "unknown-hazard")
            continue
        if may_be_external(view, use.name):
            continue
        if not view.ask(inputs.is_complete):
            return
        elsewhere = view.ask(lookups.elsewhere, Kind.HAZARD, use.name)
        fixes = tuple(include_fix(view, path) for path in elsewhere[:3])
        likely = (*view.ask(near_names, Kind.HAZARD, use.name), *near_external(view, use.name))
        fixes += tuple(replace_fix(f"Replace `{use.name}` with `{name}`", use.span, written(name)) for name in likely)
        message = f"unknown hazard `{use.name}`{NOWHERE if elsewhere or not likely else did_you_mean(likely)}"
        notes = () if fixes else (f'declare it: `hazard {written(use.name)} "what may go wrong"`',)
        yield Diagnostic("unknown-hazard", use.span, message, notes=notes, fixes=fixes)


def is_external(view: View, name: str) -> bool:
    """Whether another tool keeps a requirement or a hazard of this ID."""
    imported = view.project.external_requirements
    return imported is not None and name in imported.by_id


def may_be_external(view: View, name: str) -> bool:
    """Whether another tool keeps it, or may keep it in a file that could not be read."""
    imported = view.project.external_requirements
    return is_external(view, name) or (imported is not None and not imported.is_complete)


def near_external(view: View, name: str) -> tuple[str, ...]:
    """The ID of another tool that is spelt nearly so."""
    imported = view.project.external_requirements
    return tuple(near(name, imported.by_id, 1)) if imported is not None else ()


def in_other_clause(view: View, use: Use, rule: str) -> Diagnostic:
    """The diagnostic for a requirement after `mitigates`, or a hazard after `refines` or `satisfies`."""
    is_hazard = rule != "unknown-hazard"
    message = f"`{use.name}` is a {'hazard, not a requirement' if is_hazard else 'requirement, not a hazard'}"
    fixes: tuple[Fix, ...] = ()
    for _, requirement in view.requirements:
        for clause in requirement.clauses:
            if isinstance(clause, Refines | Mitigates) and [name.span for name in clause.names] == [use.span]:
                head, other = ("refines", "mitigates") if is_hazard else ("mitigates", "refines")
                span = Word(use.span.start, clause.start, head).span
                fixes = (replace_fix(f"Replace `{head}` with `{other}`", span, other),)
    notes = ("`mitigates` names hazards, `refines` and `satisfies` name requirements",)
    return Diagnostic(rule, use.span, message, notes=notes, fixes=fixes)


def cyclic_refinement(view: View) -> Iterator[Diagnostic]:
    """A requirement that refines itself, directly or through others."""
    for symbol, requirement in view.requirements:
        for word in _refined(requirement):
            if word.text == symbol.name:
                message = f"the requirement `{symbol.name}` refines itself"
            elif symbol.name in view.ask(all_refined, word.text):
                message = f"the requirement `{symbol.name}` refines itself through `{word.text}`"
            else:
                continue
            yield Diagnostic("cyclic-refinement", word.span, message)


def all_refined(store: Store[Workspace], viewpoint: str, name: str) -> frozenset[str]:
    """A requirement, and those that it refines, directly or through others."""
    return frozenset(reached([name], lambda each: store.ask(refined, viewpoint, each)))


def refined(store: Store[Workspace], viewpoint: str, name: str) -> tuple[str, ...]:
    """The requirements that one refines directly."""
    meaning = store.ask(lookups.meaning, viewpoint, Kind.REQUIREMENT, name)
    target = meaning.target if meaning is not None else None
    return tuple(word.text for word in _refined(target)) if isinstance(target, Requirement) else ()


def _refined(requirement: Requirement) -> Iterator[Word]:
    for clause in requirement.clauses:
        if isinstance(clause, Refines):
            yield from clause.names


def is_refined(view: View, use: Use) -> bool:
    """Whether a requirement is named after `refines`."""
    return any(word.span == use.span for _, requirement in view.requirements for word in _refined(requirement))


def shared_id(view: View) -> Iterator[Diagnostic]:
    """A hazard with the ID of a requirement."""
    for symbol in view.facts.summary.symbols:
        if symbol.kind is Kind.HAZARD and view.ask(lookups.is_defined, Kind.REQUIREMENT, symbol.name):
            message = f"the hazard and the requirement `{symbol.name}` cannot share an ID"
            related = view.declared_at(Kind.REQUIREMENT, symbol.name, "the requirement")
            yield Diagnostic("duplicate-definition", symbol.span, message, related=related)
