"""Whether a requirement is approved as it is now.

One invariant: of each person the last approval counts, and one without a fingerprint is for whatever the requirement
means.
"""

from __future__ import annotations

from typing import Literal, TypeAlias

from btq_lang.catalog.name_kinds import Kind
from btq_lang.requirements.definitions import requirement
from btq_lang.requirements.fingerprint import added_since, fingerprint
from btq_lang.requirements.model import ResolvedApproval
from btq_lang.util.record import Record
from btq_lang.workspace import inputs
from btq_lang.workspace.queries import Store, on_circle
from btq_lang.workspace.workspace import Workspace

# open: nobody has approved it; suspect: what it means, or what it refines, has changed since.
State: TypeAlias = Literal["open", "approved", "suspect"]


class ApprovalState(Record):
    """The state of a requirement.

    Attributes:
        fingerprint: of what it means now.
        outdated: the approvals of something else.
        changed: the requirements that it refines and that are suspect.
    """

    state: State
    fingerprint: str = ""
    outdated: tuple[ResolvedApproval, ...] = ()
    changed: tuple[str, ...] = ()


@on_circle(ApprovalState("open"))
def approval_state(store: Store[Workspace], viewpoint: str, name: str) -> ApprovalState:
    """The state of a requirement; open if it is not defined."""
    resolved, _ = store.ask(requirement, viewpoint, name)
    definition = store.ask(inputs.definition, viewpoint, Kind.REQUIREMENT, name)
    if resolved is None or definition is None:
        return ApprovalState("open")
    current = fingerprint(store, definition[0], resolved)
    if not resolved.approvals:
        return ApprovalState("open", current)
    last = {approval.by: approval for approval in resolved.approvals}
    outdated = tuple(each for each in last.values() if each.fingerprint not in (None, current))
    refined = {other: store.ask(approval_state, viewpoint, other) for other in resolved.refines}
    changed = tuple(other for other, state in refined.items() if state.state == "suspect")
    return ApprovalState("suspect" if outdated or changed else "approved", current, outdated, changed)


def added_since_approval(store: Store[Workspace], viewpoint: str, name: str) -> str:
    """The clause or the `apply` that is new since the first outdated approval of a requirement; empty if that is not
    the difference."""
    resolved, _ = store.ask(requirement, viewpoint, name)
    definition = store.ask(inputs.definition, viewpoint, Kind.REQUIREMENT, name)
    outdated = store.ask(approval_state, viewpoint, name).outdated
    if resolved is None or definition is None or not outdated:
        return ""
    return added_since(store, definition[0], resolved, outdated[0].fingerprint or "")
