"""Whether the engine is to enforce a clause, and can be made to: what that takes, or why it is not enforced.

One invariant: build, overview, editor and check all use this module, so they agree.  Checks of small files import it,
so it depends on no export; which nodes of a file get what is for `enforcement`.
"""

from __future__ import annotations

from collections.abc import Callable, Container
from typing import Final, Literal, TypeAlias

from btq_lang.btcpp.conditions import NoScript, first_value_script, signal_script
from btq_lang.btcpp.guards import ClauseGuard, NotEnforced
from btq_lang.btcpp.wrappers import may_be_skipped
from btq_lang.catalog.verbs import VERBS
from btq_lang.requirements.applied import Applied
from btq_lang.requirements.budgets import Budgets
from btq_lang.requirements.model import (
    Interval,
    MissionRun,
    NodeTarget,
    ResolvedClaim,
    ResolvedEachEvent,
    ResolvedRequirement,
    ResolvedSignal,
)
from btq_lang.requirements.spans import node_of
from btq_lang.workspace.queries import Store
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace

# How a clause is covered: by the tree that `btq build` makes, by tools that read logs, or by people.
Way: TypeAlias = Literal["enforced", "monitored", "reviewed"]
WAYS_COUNTED: Final[dict[Way, str]] = {"enforced": "enforced", "monitored": "monitored", "reviewed": "by people"}


def way_instead(requirement: ResolvedRequirement) -> tuple[Way, str] | None:
    """The way in which the clauses of a requirement are checked instead of enforced, and why; None if the engine is to
    enforce them."""
    if requirement.is_verified_by_people:
        return "reviewed", requirement.verification
    return None if requirement.demands_enforcement else ("monitored", "")


class Elsewhere(NotEnforced):
    """A node is in a file that is not written together with the clause's."""

    def __init__(self, node: ResolvedNode) -> None:
        super().__init__()
        self.node: Final = node


class UnknownMission(NotEnforced):
    """The tree that is the mission is unknown."""


class Enforceability:
    """Which of the clauses that some files see the engine can enforce."""

    def __init__(
        self,
        store: Store[Workspace],
        viewpoint: str,
        mission: Callable[[], ResolvedNode | None],
        *,
        files: Container[str] | None,
        is_shared: bool,
    ) -> None:
        """
        Args:
            viewpoint: the file whose scope counts.
            mission: returns the mission's root, if it begins in these files; called only if it matters.
            files: that are written together; None: all.
            is_shared: whether they are a part of several missions.
        """
        self._store: Final = store
        self._viewpoint: Final = viewpoint
        self._budgets: Final = Budgets(store, viewpoint)
        self._mission: Final = mission
        self._files: Final = files
        self._is_shared: Final = is_shared

    def why_not(self, applied: Applied, claim: ResolvedClaim) -> str | None:
        """Why the engine does not enforce a clause that it should; None if it does, or if the mission's root is
        unknown, which is reported of the mission."""
        if (outcome := way_instead(applied.requirement)) is not None:
            return outcome[1]
        try:
            self.needs(applied.requirement, claim, self.node(applied, claim), "_", "@_")
        except UnknownMission:
            return None
        except NotEnforced as reason:
            return str(reason)
        return None

    def node(self, applied: Applied, claim: ResolvedClaim) -> ResolvedNode:
        """The node for which the engine enforces a clause.

        Raises:
            NotEnforced: there is no such node.
        """
        requirement, subject = applied.requirement, applied.subject
        if requirement.odds is not None:
            raise NotEnforced("a probability is evaluated in the logs of many runs")
        if requirement.window is not None:
            raise NotEnforced("a window is evaluated in the logs of many runs")
        if isinstance(subject, ResolvedEachEvent):
            raise NotEnforced(VERBS[claim.verb].why_monitored)
        if requirement.assumptions:
            raise NotEnforced("whether its assumption holds all along is known only at the end")
        if isinstance(subject, NodeTarget) and subject.through:
            raise NotEnforced("its path names only some instances of a node")
        if (
            isinstance(subject, Interval)
            and VERBS[claim.verb].limits == "completion"
            and (node := node_of(subject, self._budgets)) is not None
        ):
            return node
        if not isinstance(subject, NodeTarget | MissionRun):
            raise NotEnforced("it limits the time between nodes, and no node encloses that time")
        if subject.node is None:
            raise UnknownMission("the main tree is unknown; name it with a line `Root <tree>`")
        return subject.node

    def needs(
        self, requirement: ResolvedRequirement, claim: ResolvedClaim, node: ResolvedNode, name: str, stop: str
    ) -> tuple[ClauseGuard, dict[str, str]]:
        """What enforces a clause, and the first values of the signals that its scripts read.

        Raises:
            NotEnforced: the engine cannot do it.
        """
        guard = ClauseGuard(requirement, claim, node, name, stop, self._is_shared)
        if VERBS[claim.verb].limits and claim.limit is not None and not self._budgets.composed(node).waits:
            raise NotEnforced(f"{node.shown} completes within one tick")
        for guarded_node in dict.fromkeys(guarded_node for guarded_node, _ in guard.wrappers):
            if self._files is not None and guarded_node.path not in self._files:
                raise Elsewhere(guarded_node)
            self._check_around(guarded_node)
        first: dict[str, str] = {}
        for signal in guard.signals:
            first |= _first_value(signal)
        if (first or guard.initial_values or guard.stop) and not self._is_shared:
            mission = self._mission()
            if mission is None:
                raise UnknownMission("the main tree is unknown; name it with a line `Root <tree>`")
            if guard.stop is not None:
                self._check_around(mission)
        return guard, first

    def _check_around(self, node: ResolvedNode) -> None:
        """Check that a wrapper around a node does not change the behavior of the tree.

        Raises:
            NotEnforced: it would.
        """
        if self._store.ask(_is_skipped, self._viewpoint, node):
            raise NotEnforced(
                f"a node below {node.shown} may skip it, and with a guard around it the tree would behave differently"
            )
        _check_node(node)


def where_else(node: ResolvedNode, *, is_xml: bool) -> str:
    """Why a node of another file gets no wrapper if each file is written by itself."""
    if is_xml:
        return f"{node.shown} is in an XML file, which the build does not change; --bundle enforces it"
    return f"{node.shown} is in an included file, which other missions may include; --bundle enforces it"


def _is_skipped(store: Store[Workspace], viewpoint: str, node: ResolvedNode) -> bool:
    """Whether something inside a node can make the engine skip it."""
    return Budgets(store, viewpoint).composed(node).skip is not None


def _check_node(node: ResolvedNode) -> None:
    """Check that the node itself allows a guard around it.

    Raises:
        NotEnforced: it does not.
    """
    names = [pair.key.text for pair in node.node.attributes]
    if may_be_skipped(names) and (attribute := next((name for name in names if name in _POSTCONDITIONS), None)):
        skipped = f"{node.shown} may be skipped and has `{attribute}`"
        raise NotEnforced(f"{skipped}, so with a guard around it the tree would behave differently")
    if node.behavior is not None and node.behavior.memory:
        raise NotEnforced(f"a guard around {node.shown} would reset it, and it would forget what it waits for")
    # These nodes never reset their condition: when it is ticked again, an action repeats its result without evaluating
    # `_failureIf`.  A wrapper would reset it.
    chooser = node.parent if node.parent is not None and node.parent.flow == "choice" else None
    is_evaluated = node.category in _EVALUATED_AGAIN and "_failureIf" not in names and "_successIf" not in names
    if chooser is not None and node.index == 0 and not is_evaluated:
        condition = f"{node.shown} is the condition of {chooser.shown}"
        raise NotEnforced(f"{condition}, which would evaluate it differently with a guard around it")


def _first_value(signal: ResolvedSignal) -> dict[str, str]:
    if signal.initially is None:
        return {}
    try:
        return {signal_script(signal): first_value_script(signal)}
    except NoScript as reason:
        raise NotEnforced(str(reason)) from reason


_EVALUATED_AGAIN: Final = frozenset(("Condition", "Control", "Decorator"))
_POSTCONDITIONS: Final = ("_onSuccess", "_onFailure", "_post")
