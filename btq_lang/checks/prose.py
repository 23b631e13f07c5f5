"""SuccessIf and FailureIf in a requirement's description: what stands behind them is for people, or for tools."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.units import Dimension, parse_unit
from btq_lang.checks.strings import in_source
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Fix, replace_fix
from btq_lang.syntax.tree import Entry, Requirement, Signal, Word
from btq_lang.util.text import Span

if TYPE_CHECKING:
    from btq_lang.requirements.constraints import Constraint
    from btq_lang.workspace.item_index import Facts
    from btq_lang.workspace.queries import Store
    from btq_lang.workspace.workspace import Workspace


def prose_constraint(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A keyword with prose behind it, in a requirement that has no clause yet: told once, where it is defined."""
    for symbol in view.facts.summary.symbols:
        requirement = symbol.target
        if not isinstance(requirement, Requirement) or requirement.text is None or requirement.clauses:
            continue
        found = _not_checked(view, entry, requirement, symbol.name)
        first = view.declaration(Kind.REQUIREMENT, symbol.name)
        if not found or (first is not None and first.symbol is not symbol):
            continue
        signals = _signals(view)
        proposals = (_as_clause(each, signals) for each in found)
        clauses = tuple(dict.fromkeys(clause for clause in proposals if clause is not None))
        keyword = found[0].keyword
        yield Diagnostic(
            "prose-constraint",
            in_source(requirement.text, keyword),
            f"no tool can check the prose after `{requirement.text.text[keyword.start : keyword.end]}`",
            notes=_notes(clauses),
            fixes=_fixes(view, entry, requirement.text, symbol.name, clauses),
        )


def _not_checked(view: View, entry: Entry, requirement: Requirement, name: str) -> list[Constraint]:
    """What stands behind keywords and is neither a script nor clauses that mean something."""
    found = view.constraints(requirement)
    if any(checkable for _, checkable in found) and name in view.ask(_without_claims, view.facts):
        return [each for each, _ in found]
    return [each for each, checkable in found if not checkable]


def _without_claims(store: Store[Workspace], viewpoint: str, facts: Facts) -> frozenset[str]:
    """The requirements of an item that claim nothing."""
    return frozenset(store.ask(_all_without_claims, viewpoint).get(id(facts.item), ()))


def _all_without_claims(store: Store[Workspace], viewpoint: str) -> dict[int, set[str]]:
    """All of them, by the item."""
    view = View(store, viewpoint)
    found: dict[int, set[str]] = {}
    for requirement in view.requirements.all.values() if view.requirements is not None else ():
        if not requirement.claims:
            found.setdefault(id(requirement.item), set()).add(requirement.name)
    return found


def _as_clause(constraint: Constraint, signals: dict[str, Dimension]) -> str | None:
    """The clause that stands for prose; a condition of a requirement needs but its verb."""
    from btq_lang.checks.wording import as_clause  # few requirements are prose
    from btq_lang.requirements.constraints import clauses_of

    text = " ".join(constraint.text.split()).rstrip(".")
    condition = f"{'never' if constraint.violates else 'keeps'} {text}"
    if any(sign in text for sign in "<>=") and clauses_of(condition) is not None:
        return condition
    return as_clause(text, violates=constraint.violates, signals=signals)


def _signals(view: View) -> dict[str, Dimension]:
    """The signals in scope, with what they measure."""
    found: dict[str, Dimension] = {}
    for name in view.names(Kind.SIGNAL):
        meaning = view.find(Kind.SIGNAL, name)
        signal = meaning.target if meaning is not None else None
        if (
            isinstance(signal, Signal)
            and signal.unit is not None
            and (unit := parse_unit(signal.unit.text)) is not None
        ):
            found[name] = unit.dimension
    return found


def _notes(clauses: tuple[str, ...]) -> tuple[str, ...]:
    if not clauses:
        return ("write a clause: `takes at most 30 s`, or `keeps speed < 0.5 m/s` with `signal speed : m/s`",)
    return (f"write it as a clause: {', '.join(f'`{clause}`' for clause in clauses)}",)


def _fixes(view: View, entry: Entry, text: Word, name: str, clauses: tuple[str, ...]) -> tuple[Fix, ...]:
    """Add the clauses; not where the text is repeated in other places, which would then say something else."""
    if not clauses or entry.diagnostics or view.is_repeated(Kind.REQUIREMENT, name):
        return ()
    added = " ".join(clauses)
    return (replace_fix(f"Add `{added}`", Span(text.end, text.end), f" {added}"),)
