"""How each clause is held, as far as the requirement itself says it: by people where it names a method of theirs.

What the generated tree enforces is not known here: whoever knows it hands `collect` a function that says it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Final, TypeAlias

from btq_lang.graph.missions import said
from btq_lang.requirements.model import Applied, Requirement
from btq_lang.requirements.resolved import Requirements
from btq_lang.trace.overview import Clause
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:
    # For each of `applied` of a mission's requirements, in its order, its clauses.
    Ways: TypeAlias = Callable[[Workspace, str, Requirements], Sequence[Sequence[Clause]]]


def declared_ways(
    workspace: Workspace, path: str, found: Requirements, because: str = ""
) -> Sequence[Sequence[Clause]]:
    """Each claim monitored, or reviewed where the requirement is verified by people.

    Args:
        because: why no more can be said of those that the engine is to enforce.
    """
    return [_clauses(applied, because) for applied in found.applied]


def is_hard(requirement: Requirement) -> bool:
    """Whether the engine is to enforce a requirement, rather than people to look after it."""
    return requirement.action in ("fail", "halt") and requirement.method not in _BY_PEOPLE


def _clauses(applied: Applied, because: str) -> tuple[Clause, ...]:
    requirement = applied.requirement
    if not requirement.claims:
        return tuple(Clause(text, "reviewed", "it is not measurable") for text in said(applied)[:1])
    if requirement.method in _BY_PEOPLE:
        why = f"verified by {requirement.method}"
        return tuple(Clause(claim.text, "reviewed", why) for claim in requirement.claims)
    asked = is_hard(requirement)
    why = because or f"nothing enforces `on violation {requirement.action}`" if asked else ""
    return tuple(Clause(claim.text, "monitored", why, asked) for claim in requirement.claims)


_BY_PEOPLE: Final = ("review", "analysis", "test")
