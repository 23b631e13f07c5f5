"""Whether the engine can be made to hold a clause: what it needs, or why it is not enforced.

One invariant: a build, an overview, an editor and a check ask here, so they say the same.  It is imported by checks of
small files, so it knows neither elements nor files; what is to stand around nodes is for `enforcement`.
"""

from __future__ import annotations

from btq_lang.btcpp.around import may_be_skipped
from btq_lang.btcpp.conditions import NoScript, first_value_script, signal_script
from btq_lang.btcpp.guards import Guarded, NotEnforced, guarded
from btq_lang.record import Record
from btq_lang.requirements.budgets import Budgets
from btq_lang.requirements.model import Applied, Claim, Mission, Requirement, Signal, SourceNode, Span, Target
from btq_lang.requirements.spans import node_of

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from collections.abc import Callable, Container
    from typing import Final

    from btq_lang.requirements import Requirements
    from btq_lang.workspace import Workspace


class Looks(Record):
    """How to look at nodes.

    Attributes:
        waits: whether a node can be RUNNING.
        is_skipped: whether it may be skipped from within.
        of_span: the node whose time a span is; None: there is none.
    """

    waits: Callable[[SourceNode], bool]
    is_skipped: Callable[[SourceNode], bool]
    of_span: Callable[[Span], SourceNode | None]


class Elsewhere(NotEnforced):
    """A node stands in a file that is not written together with the clause's."""

    def __init__(self, node: SourceNode) -> None:
        super().__init__()
        self.node: Final = node


class NoBeginning(NotEnforced):
    """Nobody can say which tree is the mission."""


class Judge:
    """Whoever judges the clauses that some files see."""

    def __init__(
        self,
        looks: Looks,
        begins: Callable[[], bool],
        mission: Callable[[], SourceNode | None],
        *,
        files: Container[str] | None,
        is_shared: bool,
    ) -> None:
        """
        Args:
            begins: whether the mission begins in the files; it is asked only where that matters, as `mission` is.
            mission: its root.
            files: those that are written together; None: all.
            is_shared: they are a part of several missions.
        """
        self._looks: Final = looks
        self._begins: Final = begins
        self._mission: Final = mission
        self._files: Final = files
        self._is_shared: Final = is_shared

    def why_not(self, applied: Applied, claim: Claim) -> str | None:
        """Why the engine does not hold a clause that it is asked to; None: it does, or nobody can say where the mission
        begins, and that is told of the mission."""
        try:
            self.needs(applied.requirement, claim, self.node(applied, claim), "_", "@_")
        except NoBeginning:
            return None
        except NotEnforced as reason:
            return str(reason)
        return None

    def node(self, applied: Applied, claim: Claim) -> SourceNode:
        """What the engine holds to a clause.

        Raises:
            NotEnforced: there is no such node.
        """
        requirement, subject = applied.requirement, applied.subject
        if requirement.odds is not None:
            raise NotEnforced("odds are judged over many runs")
        if requirement.window is not None:
            raise NotEnforced("a window is looked at in the logs of many runs")
        if isinstance(subject, Target) and subject.through:
            raise NotEnforced("its path names some instances of a node only")
        if isinstance(subject, Span) and claim.verb == "takes" and (node := self._looks.of_span(subject)) is not None:
            return node
        if not isinstance(subject, Target | Mission):
            raise NotEnforced("it is about the time between nodes, and nothing stands around that")
        if subject.node is None:
            raise NoBeginning("nobody can say which tree is the mission")
        return subject.node

    def needs(
        self, requirement: Requirement, claim: Claim, node: SourceNode, name: str, stop: str
    ) -> tuple[Guarded, dict[str, str]]:
        """What a clause needs, and the first values of what its scripts read.

        Args:
            name, stop: as of `guarded`.

        Raises:
            NotEnforced: the engine cannot do it.
        """
        made = guarded(requirement, claim, node, name, stop, self._is_shared)
        if claim.verb in ("takes", "succeeds") and claim.limit is not None and not self._looks.waits(node):
            raise NotEnforced(f"{node.shown} completes within one tick")
        for each in dict.fromkeys(each for each, _ in made.wrappers):
            if self._files is not None and each.path not in self._files:
                raise Elsewhere(each)
            _can_stand_around(each, self._looks.is_skipped(each))
        first: dict[str, str] = {}
        for signal in made.signals:
            first |= _first_value(signal)
        if (first or made.cells or made.stop) and not self._is_shared:
            if not self._begins():
                raise NoBeginning("nobody can say which tree is the mission, and where it begins")
            if made.stop is not None:
                mission = self._mission()
                assert mission is not None, "there is a mission that begins"
                _can_stand_around(mission, self._looks.is_skipped(mission))
        return made, first


def first_looks(found: Requirements) -> Looks:
    """Those of who has looked at nothing yet."""
    budgets = Budgets(found)
    return Looks(
        lambda node: budgets.composed(node).waits,
        lambda node: budgets.composed(node).skip is not None,
        lambda span: node_of(span, budgets),
    )


def where_else(workspace: Workspace, node: SourceNode) -> str:
    """Why nothing is put around a node of another file where each file is written by itself."""
    if workspace.files[node.path].origin is not None:
        return f"{node.shown} stands in an XML file, which is not built; with --bundle it is enforced"
    return f"{node.shown} stands in an included file, which other missions may include; with --bundle it is enforced"


def _can_stand_around(node: SourceNode, is_skipped_inside: bool) -> None:
    """Whether the tree stays as it is with something around a node.

    Raises:
        NotEnforced: it does not.
    """
    if is_skipped_inside:
        raise NotEnforced(f"{node.shown} may be skipped from within, and what stands around it could not be")
    names = [pair.key.text for pair in node.node.attributes]
    if may_be_skipped(names) and (said := next((name for name in names if name in _POSTCONDITIONS), None)):
        raise NotEnforced(f"{node.shown} may be skipped and has `{said}`")
    # Nobody resets the condition of these: when it is asked again, an action says what it said before, and `_failureIf`
    # is not looked at.  With something around it, it would be reset.
    asks = node.parent if node.parent is not None and node.parent.tag in ("IfThenElse", "WhileDoElse") else None
    is_asked_anew = node.category in _ASKED_ANEW and "_failureIf" not in names and "_successIf" not in names
    if asks is not None and node.index == 0 and not is_asked_anew:
        raise NotEnforced(f"{node.shown} is the condition of {asks.shown}, which would ask it in another way")


def _first_value(signal: Signal) -> dict[str, str]:
    if signal.initially is None:
        return {}
    try:
        return {signal_script(signal): first_value_script(signal)}
    except NoScript as reason:
        raise NotEnforced(str(reason)) from reason


_ASKED_ANEW: Final = frozenset(("Condition", "Control", "Decorator"))
_POSTCONDITIONS: Final = ("_onSuccess", "_onFailure", "_post")
