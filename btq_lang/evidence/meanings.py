"""Verdicts on requirements whose meaning has changed since, which are suspect.

One invariant: of what is unknown, nothing is said: of verdicts without a fingerprint, and of requirements that are not
there.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Set
from typing import TYPE_CHECKING, Final, TypeAlias

from btq_lang.requirements.approval import approval_state
from btq_lang.util.grouping import grouped

if TYPE_CHECKING:
    from btq_lang.requirements.resolve import Requirements
    from btq_lang.workspace.workspace import Workspace

# The fingerprints of what requirements mean now, by the names of missions and requirements; of missions with the same
# name those of each.
Meanings: TypeAlias = Mapping[tuple[str, str], Set[str]]
NO_MEANINGS: Final[Meanings] = {}
SUSPECT: Final = "suspect: judged before the requirement was changed"


def fingerprints(workspace: Workspace, resolved: Requirements) -> dict[str, str]:
    """What requirements mean, by name.

    Those in XML are left out: they were written elsewhere, perhaps in other words.
    """
    paths = {name: requirement.place.path for name, requirement in resolved.all.items()}
    return {
        name: resolved.store.ask(approval_state, resolved.viewpoint, name).fingerprint
        for name, path in paths.items()
        if path is not None and not workspace.files[path].is_foreign
    }


def meanings_of(missions: Iterable[tuple[str, Mapping[str, str]]]) -> Meanings:
    """What the requirements of missions mean, given the name and the fingerprints of each."""
    meanings = (
        ((mission, name), meaning) for mission, by_requirement in missions for name, meaning in by_requirement.items()
    )
    return {key: frozenset(same_named) for key, same_named in grouped(meanings).items()}


def is_suspect(then: Iterable[str], now: Set[str] | None) -> bool:
    """Whether a requirement means something else than it did when it was judged.

    Args:
        then: the fingerprints with which it was judged.
        now: those that it may have now; None: unknown.
    """
    return now is not None and any(fingerprint not in now for fingerprint in then)
