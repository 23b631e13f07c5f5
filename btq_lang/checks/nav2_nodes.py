"""Which nodes of trees are Nav2's, and not a team's own of the same name."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nav2 import FILES
from btq_lang.checks import lookups
from btq_lang.checks.view import View
from btq_lang.workspace.resolved import ResolvedNode


def of_nav2(view: View, distribution: str, nodes: Iterable[ResolvedNode]) -> Iterator[tuple[ResolvedNode, str, str]]:
    """Those nodes that are Nav2's, each with its ID and the name of its tree."""
    for resolved in nodes:
        name = of_distribution(view, resolved, distribution)
        if name is not None and resolved.tree is not None:
            yield resolved, name, resolved.tree


def of_distribution(view: View, resolved: ResolvedNode, distribution: str) -> str | None:
    """The ID of a node of Nav2; None for another one."""
    if resolved.of_model is None or resolved.id is None:
        return None
    model = view.ask(lookups.declaration, Kind.MODEL, resolved.id.text)
    return resolved.id.text if model is not None and model.path == FILES[distribution] else None
