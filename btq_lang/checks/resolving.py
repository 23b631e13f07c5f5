"""The requirements of a viewpoint, resolved again after each edit of a linked file.

What was resolved before is kept for open files alone, in a memory of its own.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Final
from weakref import WeakKeyDictionary

from btq_lang.catalog.name_kinds import Kind
from btq_lang.checks import lookups
from btq_lang.checks.view import View
from btq_lang.syntax.tree import Requirement

if TYPE_CHECKING:
    from btq_lang.requirements.budgets import Budgets
    from btq_lang.requirements.memory import Memory
    from btq_lang.requirements.resolved import Requirements
    from btq_lang.workspace.queries import Store
    from btq_lang.workspace.workspace import Workspace


class Resolved:
    """The requirements of a viewpoint, and what was found out of them.

    Attributes:
        requirements: None where none has a clause and nothing is declared for one.
        memory: what was resolved before, and what other checks keep beside it.
    """

    def __init__(self, requirements: Requirements | None = None, memory: Memory | None = None) -> None:
        self.requirements = requirements
        self.memory = memory

    @cached_property
    def budgets(self) -> Budgets | None:
        """How long the nodes take if what is demanded of those below them holds."""
        if self.requirements is None or self.memory is None:
            return None
        from btq_lang.requirements.budgets import Budgets  # most files have no use for it, and it is large

        return Budgets(self.requirements, self.memory)


def resolved(store: Store[Workspace], viewpoint: str) -> Resolved:
    """The requirements of a viewpoint."""
    view = View(store, viewpoint)
    if not _has_clauses(view):
        return Resolved()
    from btq_lang.requirements.memory import Memory  # as above
    from btq_lang.requirements.resolve import requirements

    kept = _kept.get(store, {})
    memory = kept.get(viewpoint) or Memory()
    if viewpoint in kept:
        kept[viewpoint] = memory
    return Resolved(requirements(view.workspace, viewpoint, memory), memory)


def keep(store: Store[Workspace], viewpoint: str) -> None:
    """Keep what is resolved from now on."""
    _kept.setdefault(store, {}).setdefault(viewpoint, None)


def let_go(store: Store[Workspace]) -> None:
    """Nobody waits: let go of what was resolved before the last edit."""
    for memory in _kept.get(store, {}).values():
        if memory is not None:
            memory.let_go()


def forget(store: Store[Workspace], viewpoint: str) -> None:
    """Nobody asks from this viewpoint any more."""
    memory = _kept.get(store, {}).pop(viewpoint, None)
    if memory is not None:
        memory.end()


def _has_clauses(view: View) -> bool:
    if view.names(Kind.SIGNAL) or view.names(Kind.CONTEXT):
        return True
    for name in view.names(Kind.REQUIREMENT):
        meaning = view.find(Kind.REQUIREMENT, name)
        requirement = meaning.target if meaning is not None else None
        if isinstance(requirement, Requirement) and (
            requirement.clauses
            or requirement.parameters
            or any(checkable for _, checkable in view.constraints(requirement))
        ):
            return True
    return view.look_up(lookups.has_apply)


_kept: Final[WeakKeyDictionary[Store[Workspace], dict[str, Memory | None]]] = WeakKeyDictionary()
