"""Whether a requirement is approved as it is now.

One invariant: of each person the last approval counts; one without a fingerprint, which nothing outdates, is a state of
its own.
"""

from __future__ import annotations

from typing import Literal, TypeAlias

from btq_lang.catalog.name_kinds import Kind
from btq_lang.requirements.definitions import requirement
from btq_lang.requirements.fingerprint import added_since, fingerprint
from btq_lang.requirements.model import ResolvedApproval, ResolvedRequirement
from btq_lang.util.record import Record
from btq_lang.workspace import inputs
from btq_lang.workspace.queries import Store, on_circle
from btq_lang.workspace.workspace import Workspace

# open: not approved; suspect: what it means, or what it refines, has changed since.
State: TypeAlias = Literal["open", "approved", "approved without fingerprint", "suspect"]


class ApprovalState(Record):
    """The state of a requirement.

    Attributes:
        fingerprint: of what it means now.
        outdated: the approvals of something else; unmarked: those without a fingerprint, of which that is not known.
        changed: the requirements that it refines and that are suspect.
    """

    state: State
    fingerprint: str = ""
    outdated: tuple[ResolvedApproval, ...] = ()
    changed: tuple[str, ...] = ()
    unmarked: tuple[ResolvedApproval, ...] = ()


def approval_state(store: Store[Workspace], viewpoint: str, name: str) -> ApprovalState:
    """The state of a requirement; open if it is not defined."""
    resolved, _ = store.ask(requirement, viewpoint, name)
    current = _fingerprint(store, viewpoint, resolved)
    if resolved is None or not resolved.approvals:
        return ApprovalState("open", current)
    outdated = _outdated(resolved, current)
    changed = tuple(other for other in resolved.refines if store.ask(is_suspect, viewpoint, other))
    unmarked = tuple(each for each in _last(resolved) if each.fingerprint is None)
    state: State = "approved without fingerprint" if unmarked else "approved"
    return ApprovalState("suspect" if outdated or changed else state, current, outdated, changed, unmarked)


@on_circle(False)
def is_suspect(store: Store[Workspace], viewpoint: str, name: str) -> bool:
    """Whether a requirement is approved, and what it means, or what it refines, has changed since."""
    resolved, _ = store.ask(requirement, viewpoint, name)
    if resolved is None or not resolved.approvals:
        return False
    is_outdated = bool(_outdated(resolved, _fingerprint(store, viewpoint, resolved)))
    return is_outdated or any(store.ask(is_suspect, viewpoint, other) for other in resolved.refines)


def _fingerprint(store: Store[Workspace], viewpoint: str, resolved: ResolvedRequirement | None) -> str:
    definition = store.ask(inputs.definition, viewpoint, Kind.REQUIREMENT, resolved.name) if resolved else None
    return fingerprint(store, definition[0], resolved) if definition is not None and resolved is not None else ""


def _outdated(resolved: ResolvedRequirement, current: str) -> tuple[ResolvedApproval, ...]:
    return tuple(each for each in _last(resolved) if each.fingerprint not in (None, current))


def _last(resolved: ResolvedRequirement) -> list[ResolvedApproval]:
    """The approvals that count: the last one of each person."""
    return [*{approval.by: approval for approval in resolved.approvals}.values()]


def added_since_approval(store: Store[Workspace], viewpoint: str, name: str) -> str:
    """The clause or the `apply` that is new since the first outdated approval of a requirement; empty if that is not
    the difference."""
    resolved, _ = store.ask(requirement, viewpoint, name)
    definition = store.ask(inputs.definition, viewpoint, Kind.REQUIREMENT, name)
    outdated = store.ask(approval_state, viewpoint, name).outdated
    if resolved is None or definition is None or not outdated:
        return ""
    return added_since(store, definition[0], resolved, outdated[0].fingerprint or "")
