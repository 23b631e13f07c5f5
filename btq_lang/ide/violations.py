"""Which requirements can be asked whether a run can violate them, and in which missions.

One invariant: nothing is explored here.
"""

from __future__ import annotations

from typing import Final

from btq_lang.exploration.askable import askable_claims
from btq_lang.ide.clause_enforcement import MOST_MISSIONS, missions_of
from btq_lang.ide.meaning import at, definition, subject
from btq_lang.requirements.resolve import requirements
from btq_lang.workspace.file import Definition
from btq_lang.workspace.inputs import everything
from btq_lang.workspace.queries import Store
from btq_lang.workspace.references import What
from btq_lang.workspace.workspace import Workspace

EXPLORE_TITLE: Final = "how can this be violated?"


def askable_names(workspace: Workspace, path: str) -> frozenset[str]:
    """The requirements that a file defines and that can be asked about in one of its missions; of many missions some
    count.
    """
    asked = (workspace.store.ask(_askable, mission) for mission in _missions(workspace, path))
    return frozenset([name for names in asked for name, defined_in in names if defined_in == path])


def askable_missions(workspace: Workspace, path: str, name: str) -> tuple[str, ...]:
    """The missions that demand something of their nodes which a run can violate; of many some.

    Args:
        path: of the file that defines the requirement.
    """
    missions = _missions(workspace, path)
    return tuple([mission for mission in missions if (name, path) in workspace.store.ask(_askable, mission)])


def askable_at(workspace: Workspace, path: str, offset: int) -> Definition | None:
    """The requirement at a place, if it can be asked about."""
    reference = at(workspace, path, offset) if not workspace.files[path].is_foreign else None
    if reference is None or reference.mention.what is not What.REQUIREMENT:
        return None
    place = definition(workspace, path, subject(workspace, reference))
    return place if place is not None and askable_missions(workspace, place.path, place.symbol.name) else None


def _missions(workspace: Workspace, path: str) -> list[str]:
    """Some missions that a file is a part of."""
    return [each for each in missions_of(workspace, path) if workspace.main_tree(each) is not None][:MOST_MISSIONS]


def _askable(store: Store[Workspace], mission: str) -> frozenset[tuple[str, str | None]]:
    """The requirements that can be asked about in a mission, by name and file."""
    applied = requirements(store.ask(everything, mission), mission).applied
    asked = (each.requirement for each in applied if any(askable_claims(each)))
    return frozenset([(requirement.name, requirement.place.path) for requirement in asked])
