"""What can happen to the nodes of a mission, and what of it happened in a run.

One invariant: an outcome is only asked for if the kind of the node, its attributes and the nodes around it allow it.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import Final

from btq_lang.btcpp.document import Element
from btq_lang.btcpp.marks import MARK
from btq_lang.btcpp.wrappers import EVALUATING, LIMITING
from btq_lang.catalog.kinds import NodeKind
from btq_lang.catalog.nodes import BUILTINS
from btq_lang.checks.results import results
from btq_lang.checks.statuses import ANYTHING, FAILURE, GOES_ON, RUNNING, SKIPPED, SUCCESS
from btq_lang.checks.view import View
from btq_lang.evidence.model import Outcome
from btq_lang.evidence.runs import activations
from btq_lang.scenarios.mission import ScenarioMission, position_of
from btq_lang.scenarios.results import OutcomePlace
from btq_lang.scenarios.running import START, ScenarioRun
from btq_lang.simulator.ports import key_of
from btq_lang.util.grouping import grouped


class NodeOutcomes:
    """What can happen in a mission.

    Attributes:
        elements: of the nodes that run, by their numbers.
        children: the numbers of the nodes below each.
        places: of written nodes, by their numbers.
        possible: the outcomes of each place, in the order of the text.
        trees: those that run, by file and name.
    """

    def __init__(self, mission: ScenarioMission) -> None:
        instances = [instance for instance, _ in mission.build.running.all]
        self._mission: Final = mission
        self.elements: Final[dict[int, Element]] = {i.uid: i.element for i in instances if i.uid is not None}
        self._parents: Final = mission.tree.parent
        self.children: Final = grouped((parent, uid) for uid, parent in self._parents.items())
        self._ever: Final = _ever(mission)
        self._is_halted: Final[dict[int, bool]] = {0: False}
        self.places: Final = {uid: self._place(uid) for uid in self.elements if uid in mission.written}
        self.possible: Final = self._possible()
        self.trees: Final = {(node.path, node.tree) for node in mission.written.values()}

    def met(self, run: ScenarioRun) -> frozenset[tuple[OutcomePlace, str]]:
        """The outcomes in a run, each with its place."""
        words: dict[int, set[str]] = {}
        is_cut = run.end == "does not end"  # what runs then is halted only because the simulation ends
        for activation in activations(run.session(self._mission)):
            uid, outcome = activation.uid, activation.outcome
            is_last = is_cut and activation.end == START + run.now * 1000
            is_skip = activation.begin == activation.end and uid in run.skipped  # its parent makes it idle, too
            if outcome in _WORDS and not (outcome == "H" and (is_last or is_skip)):
                words.setdefault(uid, set()).add(_WORDS[outcome])
        for uid in run.skipped:
            words.setdefault(uid, set()).add(_SKIPPED)
        met = {(place, word) for uid, place in self.places.items() for word in self._of_node(uid, words)}
        met |= {(place, word) for uid, place in self.guards.items() for word in self._of_guard(uid, words)}
        return frozenset(met)

    # ---- what can happen ----

    def _possible(self) -> dict[OutcomePlace, tuple[str, ...]]:
        possible: dict[OutcomePlace, dict[str, None]] = {}
        for uid, place in self.places.items():
            words = possible.setdefault(place, {})
            ever = self._ever.get(uid, ANYTHING)
            words |= {word: None for status, word in _OF_STATUS.items() if ever & status}
            if ever & RUNNING and self._may_be_halted(uid):
                words[_HALTED] = None
            words |= {word: None for word, _, _ in self._branches(uid)}
        for place in self.guards.values():
            possible.setdefault(place, dict.fromkeys(_OF_GUARD))
        in_order = sorted(possible, key=lambda place: place.position)
        return {place: tuple(possible[place]) for place in in_order}

    def _may_be_halted(self, uid: int) -> bool:
        """Whether a node can be halted while it runs, by more than the program."""
        if uid not in self._is_halted:
            parent = self._parents[uid]
            below = range(uid, self._mission.tree.last[uid] + 1)  # what runs and is skipped then is halted, too
            by_itself = any(self.elements[each].get("_while") is not None for each in below)
            self._is_halted[uid] = by_itself or self._halts(parent, uid) or self._may_be_halted(parent)
        return self._is_halted[uid]

    def _halts(self, parent: int, child: int) -> bool:
        """Whether a node may halt its child while that runs, when it is not halted itself."""
        kind = self._kind(parent)
        if kind is None:
            return False
        siblings = self.children[parent]
        index = siblings.index(child)
        others = [self._ever.get(each, ANYTHING) for each in siblings if each != child]
        if kind.reactive and kind.flow in GOES_ON:
            return any(each & ~(GOES_ON[kind.flow] | SKIPPED) for each in others[:index])
        if kind.reactive and kind.flow == "choice":
            return index > 0 and bool(others[0] & (FAILURE if index == 1 else SUCCESS))
        if kind.flow == "switch":
            return len(siblings) > 1 and key_of(self.elements[parent].get("variable") or "", "variable") is not None
        if kind.flow in ("parallel", "pipeline", "together"):
            return any(each & (SUCCESS | FAILURE) for each in others)
        return kind.flow == "timeout" or (kind.flow == "pause" and len(siblings) > 1)

    def _kind(self, uid: int) -> NodeKind | None:
        """What is known of what a node does with its children."""
        written = self._mission.written.get(uid)
        if written is not None:
            return written.behavior
        return BUILTINS.get(self.elements[uid].tag) if uid in self.elements else None

    def _branches(self, uid: int) -> Iterator[tuple[str, int, str]]:
        """The branches of a node, each with the node that begins with it and how that must end; empty: at all."""
        kind, children = self._kind(uid), self.children.get(uid, [])
        if kind is None or len(children) < 2:
            return
        if kind.flow == "choice":
            yield "then", children[1], ""
            yield ("else", children[2], "") if len(children) > 2 else ("else", children[0], _WORDS["F"])
        elif kind.flow == "switch":
            for number, child in enumerate(children[:-1], 1):
                yield f'case "{self.elements[uid].get(f"case_{number}") or ""}"', child, ""
            yield "default", children[-1], ""

    # ---- what happened ----

    def _of_node(self, uid: int, words: dict[int, set[str]]) -> Iterator[str]:
        yield from words.get(uid, ())
        if any(_SKIPPED in words.get(wrapper, ()) for wrapper in self._wrappers(uid)):
            yield _SKIPPED
        for branch, child, end in self._branches(uid):
            ends = words.get(child, set())
            if end in ends if end else ends:
                yield branch

    def _of_guard(self, uid: int, words: dict[int, set[str]]) -> Iterator[str]:
        ends = words.get(uid, set())
        child = next(iter(self.children.get(uid, ())), 0)
        if child:  # it fails with the node, too
            stops = _WORDS["F"] in ends and _HALTED in words.get(child, ())
            passes = bool(words.get(child, set()) - {_HALTED})
        else:
            stops = _WORDS["F"] in ends
            passes = bool(ends - {_WORDS["F"], _HALTED})
        yield from (word for word, is_met in zip(_OF_GUARD, (passes, stops), strict=True) if is_met)

    # ---- places ----

    def _wrappers(self, uid: int) -> Iterator[int]:
        """What enforces requirements around a node, the innermost first."""
        while (uid := self._parents[uid]) and self.elements[uid].get(MARK) is not None:
            yield uid

    @cached_property
    def guards(self) -> dict[int, OutcomePlace]:
        """The parts of guards that may stop a node, each with its place."""
        guards: dict[int, OutcomePlace] = {}
        for uid, place in self.places.items():
            for wrapper in self._wrappers(uid):
                for part in (wrapper, *self.children[wrapper]):
                    element = self.elements[part]
                    requirement = element.get(MARK)
                    if requirement not in (None, _ALL) and element.tag in (LIMITING, EVALUATING):
                        name = f"guard {requirement} of {place.node}"
                        guards[part] = OutcomePlace(place.file, place.line, place.column, name)
        return guards

    def _place(self, uid: int) -> OutcomePlace:
        node = self._mission.written[uid]
        position = position_of(self._mission.workspace, node.path, node.item, node.node.head.start)
        return OutcomePlace(*position, self._mission.tree.nodes[uid].name)


def _ever(mission: ScenarioMission) -> dict[int, int]:
    """The results that each written node may have at any tick, by its number."""
    ever: dict[int, int] = {}
    for uid, node in mission.written.items():
        possible = results(View(mission.workspace.store, node.path, node.facts)).get(id(node.node))
        if possible is not None:
            ever[uid] = possible.ever
    return ever


_SKIPPED: Final = "is skipped"
_HALTED: Final = "is halted"
_WORDS: Final[dict[Outcome, str]] = {"S": "succeeds", "F": "fails", "H": _HALTED}
_OF_STATUS: Final = {SUCCESS: _WORDS["S"], FAILURE: _WORDS["F"], SKIPPED: _SKIPPED}
_OF_GUARD: Final = ("lets it pass", "stops it")
_ALL: Final = "*"  # marks what all guards need
