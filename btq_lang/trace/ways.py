"""How each clause is covered, as far as the requirement itself declares it: by people if it names such a method.

What the generated tree enforces is unknown here: callers that know it pass `collect` a function that returns it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, TypeAlias

from btq_lang.btcpp.enforceability import way_instead
from btq_lang.graph.missions import clauses_in_words
from btq_lang.requirements.applied import Applied
from btq_lang.requirements.resolve import Requirements
from btq_lang.trace.overview import Clause
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:
    # Gives the clauses of each of a mission's `applied` requirements, in their order.
    Ways: TypeAlias = Callable[[Workspace, str, Requirements], Sequence[Sequence[Clause]]]


def declared_ways(
    workspace: Workspace, path: str, resolved: Requirements, because: str = ""
) -> Sequence[Sequence[Clause]]:
    """Every claim as monitored, or as reviewed if people verify the requirement, and without claims its title.

    Args:
        because: the reason to give for claims that the engine must enforce.
    """
    return [_clauses(applied, because) for applied in resolved.applied]


def _clauses(applied: Applied, because: str) -> tuple[Clause, ...]:
    requirement = applied.requirement
    if not requirement.claims:
        titles = clauses_in_words(applied)[:1]
        return tuple(
            Clause(text, "reviewed", "it is prose, which people verify", is_measurable=False) for text in titles
        )
    is_demanded = way_instead(requirement) is None
    not_enforced = because or f"nothing enforces `on violation {requirement.action}`"
    way, why = way_instead(requirement) or ("monitored", not_enforced)
    return tuple(Clause(claim.text, way, why, is_demanded) for claim in requirement.claims)
