"""Prose after SuccessIf and FailureIf in a requirement's description, where a constraint should be."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.units import Dimension, dimension_name, parse_unit
from btq_lang.checks import lookups
from btq_lang.checks.requirements import is_measured
from btq_lang.checks.strings import in_source
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Fix, replace_fix
from btq_lang.syntax.tree import Requirement, Signal, Word
from btq_lang.util.text import Span
from btq_lang.workspace import inputs
from btq_lang.workspace.queries import Store
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:
    from btq_lang.requirements.constraints import Constraint


def prose_constraint(view: View) -> Iterator[Diagnostic]:
    """A keyword followed by prose, in a requirement without clauses; reported once, where it is defined."""
    for symbol, requirement in view.requirements:
        if requirement.text is None or not requirement.is_text:
            continue
        constraints = _not_checked(view, requirement, symbol.name)
        first = view.ask(lookups.declaration, Kind.REQUIREMENT, symbol.name)
        if not constraints or (first is not None and first.symbol is not symbol):
            continue
        signals = _signals(view)
        proposals = (_as_clause(constraint, signals) for constraint in constraints)
        clauses = tuple(dict.fromkeys(clause for clause in proposals if clause is not None))
        keyword = constraints[0].keyword
        message = f"no tool can check the prose after `{requirement.text.text[keyword.start : keyword.end]}`"
        fixes = _fixes(view, requirement.text, symbol.name, clauses)
        notes = _notes(clauses)
        yield Diagnostic("prose-constraint", in_source(requirement.text, keyword), message, notes=notes, fixes=fixes)


def _not_checked(view: View, requirement: Requirement, name: str) -> list[Constraint]:
    """The constraints that no tool can check: they are neither a script nor clauses."""
    constraints = view.constraints(requirement)
    is_checked = any(checkable for _, checkable in constraints) and view.ask(is_measured)
    if is_checked and view.defines_here(Kind.REQUIREMENT, name) and view.ask(_claims_nothing, name):
        return [constraint for constraint, _ in constraints]
    return [constraint for constraint, checkable in constraints if not checkable]


def _claims_nothing(store: Store[Workspace], viewpoint: str, name: str) -> bool:
    """Whether a requirement, once resolved, claims nothing."""
    from btq_lang.requirements.definitions import requirement  # a file without clauses needs none of it

    resolved, _ = store.ask(requirement, viewpoint, name)
    return resolved is not None and not resolved.claims


def _as_clause(constraint: Constraint, signals: dict[str, Dimension]) -> str | None:
    """The clause that means the same as prose; a condition only needs its verb."""
    from btq_lang.checks.wording import as_clause  # few requirements are prose
    from btq_lang.requirements.constraints import clauses_of

    text = " ".join(constraint.text.split()).rstrip(".")
    if (bound := _TIME_BOUND.fullmatch(text)) is not None and bound["word"] not in signals:
        unit = parse_unit(bound["unit"])
        is_most = (bound["sign"][0] in "<≤") != constraint.violates
        if unit is not None and dimension_name(unit) == "time":
            return f"takes at {'most' if is_most else 'least'} {bound['number']} {unit.symbol}"
    condition = f"{'never' if constraint.violates else 'keeps'} {text}"
    if any(sign in text for sign in "<>=") and clauses_of(condition) is not None:
        return condition
    return as_clause(text, violates=constraint.violates, signals=signals)


def _signals(view: View) -> dict[str, Dimension]:
    """The signals in scope, with what they measure."""
    dimensions: dict[str, Dimension] = {}
    for name in view.ask(inputs.names, Kind.SIGNAL):
        meaning = view.ask(lookups.meaning, Kind.SIGNAL, name)
        signal = meaning.target if meaning is not None else None
        unit = parse_unit(signal.unit.text) if isinstance(signal, Signal) and signal.unit is not None else None
        if unit is not None:
            dimensions[name] = unit.dimension
    return dimensions


def _notes(clauses: tuple[str, ...]) -> tuple[str, ...]:
    if not clauses:
        return ("write a clause: `takes at most 30 s`, or `keeps speed < 0.5 m/s` with `signal speed : m/s`",)
    return (f"write it as a clause: {', '.join(f'`{clause}`' for clause in clauses)}",)


def _fixes(view: View, text: Word, name: str, clauses: tuple[str, ...]) -> tuple[Fix, ...]:
    """The fixes that add the clauses; none if other definitions repeat the text, which would then differ."""
    if not clauses or view.entry.diagnostics or view.ask(lookups.is_repeated, Kind.REQUIREMENT, name):
        return ()
    added = " ".join(clauses)
    return (replace_fix(f"Add `{added}`", Span(text.end, text.end), f" {added}"),)


# The time that a node takes, where no signal has that name.
_TIME_BOUND = re.compile(
    r"(?:the )?(?P<word>(?:execution |elapsed |running )?time|duration|runtime)\s*(?P<sign>[<>]=?|[≤≥])"
    r"\s*(?P<number>[0-9]+(?:\.[0-9]+)?)\s*(?P<unit>[a-z]+)",
    re.IGNORECASE,
)
