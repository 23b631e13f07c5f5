"""SuccessIf and FailureIf in classic descriptions, as claims: they mark a hard constraint (docs/language.md).

One invariant: a constraint that cannot be understood as a whole stays documentation, without a problem: `checks`
reports it.  A claim made of a description has the place of the description.
"""

from __future__ import annotations

from typing import Final

from btq_lang.catalog.verbs import VERBS
from btq_lang.requirements.clauses import with_clauses
from btq_lang.requirements.constraints import Constraint, can_be_checked, clauses_of, constraints, is_script
from btq_lang.requirements.model import (
    ClassicScript,
    Limit,
    Negation,
    Relation,
    ResolvedClaim,
    ResolvedRequirement,
    parts_in,
)
from btq_lang.requirements.reader import Reader
from btq_lang.syntax import tree as syntax
from btq_lang.util.record import replace
from btq_lang.util.text import Span


def with_constraints(reader: Reader, requirement: ResolvedRequirement, text: syntax.Word) -> ResolvedRequirement:
    """A requirement without clauses, with the claims of its description."""
    parts = constraints(text)
    names = frozenset(reader.names("nodes")) if parts else frozenset()
    for constraint in parts:
        if can_be_checked(constraint.text, names.__contains__):
            requirement = _with(reader, requirement, constraint, text.span)
    if not requirement.claims:
        return requirement
    return replace(requirement, classic=True, action=requirement.action or "fail")


def entries_in(part: object) -> tuple[str, ...]:
    """The entries that scripts in a part of the model read, each once, without names in capitals: these are those of
    enumerations, which only the robot's program knows."""
    scripts = [each for each in parts_in(part) if isinstance(each, ClassicScript)]
    if not scripts:
        return ()
    from btq_lang.syntax.script.parser import parse_script  # few missions have one
    from btq_lang.syntax.script.tree import variables

    names = [each.name for script in scripts for each in variables(parse_script(script.code)) if each.reads]
    return tuple(dict.fromkeys(name for name in names if not name.isupper()))


def _with(reader: Reader, requirement: ResolvedRequirement, constraint: Constraint, span: Span) -> ResolvedRequirement:
    if is_script(constraint.text):
        keyword = "FailureIf" if constraint.violates else "SuccessIf"
        text = f"{keyword} {constraint.text}"
        verb = "never" if constraint.violates else "keeps"
        claim = ResolvedClaim(verb, text, reader.place(span), condition=ClassicScript(constraint.text))
        return replace(requirement, claims=(*requirement.claims, claim))
    parsed = clauses_of(constraint.text)
    assert parsed is not None, "what can be checked is a script or has clauses"
    item, text = parsed
    if constraint.violates and not all(isinstance(clause, syntax.Claim) for clause in item.clauses):
        return requirement
    inner = Reader(reader.store, reader.viewpoint, reader.path, reader.facts)
    inner.source = text, span
    resolved = with_clauses(inner, requirement, item.clauses)
    understood = not inner.problems
    added = resolved.claims[len(requirement.claims) :]
    if constraint.violates:
        turned = [_turned(claim) for claim in added]
        added = tuple(claim for claim in turned if claim is not None)
        understood = understood and len(added) == len(turned)
    return replace(resolved, claims=(*requirement.claims, *added)) if understood and added else requirement


def _turned(claim: ResolvedClaim) -> ResolvedClaim | None:
    """The claim that holds where this one does not; None if there is no such clause."""
    if VERBS[claim.verb].operand == "stretch":
        return None
    if claim.condition is not None and claim.verb in ("keeps", "never"):
        return replace(claim, verb="never" if claim.verb == "keeps" else "keeps")
    if claim.condition is not None:
        return replace(claim, condition=Negation(claim.condition))
    if claim.limit is not None and claim.limit.relation in _OPPOSITE and VERBS[claim.verb].operand in _BOUNDS:
        return replace(claim, limit=Limit(_OPPOSITE[claim.limit.relation], claim.limit.value))
    return None


_BOUNDS: Final = ("duration", "use", "count")
_OPPOSITE: Final[dict[str, Relation]] = {"<=": ">", "<": ">=", ">": "<=", ">=": "<"}
