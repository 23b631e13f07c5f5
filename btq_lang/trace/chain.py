"""The chain of an overview: hazards, requirements, those that refine them, and the requirements of other tools.

One invariant: each link is in both of its ends, so that writers follow it in either direction.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence

from btq_lang.requirements.verifying import NO_FILE, RequirementKey
from btq_lang.trace.overview import At, ExternalRow, Overview, VerificationRow
from btq_lang.util.grouping import grouped
from btq_lang.util.record import replace
from btq_lang.workspace.config import Project


def chained(
    overview: Overview,
    projects: Iterable[Project],
    shown: Callable[[str], str],
    scenarios: Mapping[RequirementKey, Sequence[VerificationRow]],
) -> Overview:
    """An overview with the links between its requirements, and with the requirements of other tools that these name.

    Args:
        projects: of the missions.
        shown: gives a path as people read it.
        scenarios: those that verify each requirement.
    """
    projects = list(projects)
    refining = grouped((name, row.key) for row in overview.requirements for name in row.refines)
    mitigating = grouped((name, row.key) for row in overview.requirements for name in row.mitigates)
    own = {row.name for row in overview.requirements} | {row.name for row in overview.hazards}
    imported = {
        id_: external
        for project in reversed(projects)
        if project.external_requirements is not None
        for id_, external in project.external_requirements.by_id.items()
        if id_ not in own and (id_ in refining or id_ in mitigating or (NO_FILE, id_) in scenarios)
    }
    return replace(
        overview,
        requirements=tuple(replace(row, refined_by=tuple(refining.get(row.name, ()))) for row in overview.requirements),
        external=tuple(
            ExternalRow(
                f"x{number}",
                requirement.id,
                requirement.title,
                requirement.status,
                requirement.url,
                At(shown(requirement.path), requirement.line, 1),
                tuple(dict.fromkeys((*refining.get(requirement.id, ()), *mitigating.get(requirement.id, ())))),
                tuple(scenarios.get((NO_FILE, requirement.id), ())),
            )
            for number, requirement in enumerate(imported.values(), 1)
        ),
        wants_sources=any(project.requirements.requires_source for project in projects if project.requirements),
    )
