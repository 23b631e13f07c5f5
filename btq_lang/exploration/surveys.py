"""The standard questions, all answered by one search: what never happens, and what may happen that should not.

One invariant: what never happens is only said when every state was seen.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from typing import Final

from btq_lang.checks import check
from btq_lang.diagnostics.model import Diagnostic, Place
from btq_lang.exploration.answers import full_runs, without_counts
from btq_lang.exploration.missions import ExploredMission
from btq_lang.exploration.opened import Opened
from btq_lang.exploration.outcomes import THROWN, UNKNOWN
from btq_lang.exploration.reasons import Reason, reasons
from btq_lang.exploration.search import Search, SearchBudget
from btq_lang.exploration.witness import Tick, replay
from btq_lang.simulator.nodes import FAILURE, IDLE, RUNNING, SUCCESS, SimulatedNode
from btq_lang.util.record import Record
from btq_lang.util.text import Span
from btq_lang.workspace.loader import shown
from btq_lang.workspace.resolved import ResolvedNode


class SurveyFinding(Record):
    """Something that a mission should perhaps not do.

    Attributes:
        kind: never-runs, never-ends, reads-unset, shared-server, cannot-succeed, cannot-fail, cannot-end or throws.
        text: in words.
        uid: of the node; 0: the whole mission.
        rule: of `btq check`, if that reports the same of this node; empty if not.
        witness: a shortest run in which it happens; empty for what never does.
    """

    kind: str
    text: str
    uid: int = 0
    witness: tuple[Tick, ...] = ()
    rule: str = ""


class Survey(Record):
    """The answers to the standard questions.

    Attributes:
        states: how many were seen.
        is_closed: all.
        unknown: what is not known of the tree, so that not all was seen.
        is_counted: attempts and cycles were counted; else the states are those with any number of them, in which no
            more happens than in those that were counted.
    """

    states: int
    is_closed: bool
    findings: tuple[SurveyFinding, ...]
    unknown: tuple[str, ...] = ()
    is_counted: bool = True


def surveyed(mission: ExploredMission, budget: SearchBudget) -> Survey:
    """Answer the standard questions.

    Raises:
        NotExplored: the tree cannot be explored.
    """
    opened = mission.open()
    watch = _Watch()
    running = full_runs(opened)
    opened.begin(watch, running)
    search = Search(opened.snapshots, budget).run()
    rules = _Rules(mission)
    findings = [*_thrown(opened, search, running), *_unset(opened, watch, rules)]
    findings += _shared(mission, opened, search, rules)
    unknown = tuple([end.message for end in search.ends if end.result == UNKNOWN])
    all_seen: tuple[Search, _Watch] | None = (search, watch)
    if not search.is_closed:
        all_seen = None if unknown else _without_counts(opened, running, budget)
    if all_seen is None:
        return Survey(search.states, False, tuple(findings), unknown)
    rough, seen = all_seen
    is_closed = rough is search or _happens(mission, opened, *all_seen) == _happens(mission, opened, search, watch)
    never = [finding for finding in _never(opened, seen, rules) if mission.place(finding.uid) is not None]
    findings += [*_missing_ends(mission, opened, *all_seen), *never]  # without nodes that only enforce requirements
    states = rough.states if is_closed else search.states
    return Survey(states, is_closed, tuple(findings), unknown, rough is search or not is_closed)


class _Watch:
    """Writes down what happens, wherever in a search."""

    def __init__(self) -> None:
        self.results: Final[set[tuple[int, int]]] = set()  # numbers of nodes, with the statuses that they had
        self.unset: Final[dict[tuple[int, str], None]] = {}

    @property
    def ran(self) -> set[int]:
        """The nodes that ran."""
        return {uid for uid, _ in self.results}

    @property
    def ended(self) -> set[int]:
        """The nodes that ended."""
        return {uid for uid, status in self.results if status != RUNNING}

    def begin(self) -> object:
        return None

    def changed(self, node: SimulatedNode, before: int, after: int) -> None:
        if after != IDLE:
            self.results.add((node.uid, after))

    def unset_read(self, node: SimulatedNode, key: str) -> None:
        self.unset[node.uid, key] = None


def _without_counts(opened: Opened, running: frozenset[int], budget: SearchBudget) -> tuple[Search, _Watch] | None:
    """All states with any number of attempts, and what happens in them; None: they are too many."""
    watch = _Watch()
    search = without_counts(opened, watch, running, budget)
    return None if search is None else (search, watch)


def _happens(mission: ExploredMission, opened: Opened, search: Search, watch: _Watch) -> object:
    """All that a survey looks at."""
    ends = {(end.result, end.message) for end in search.ends}
    servers = [position for position, node in enumerate(opened.machine.nodes) if mission.server(node)]
    together = {(one, other) for one in servers for other in servers if search.are_together(one, other)}
    return watch.ran, watch.ended, set(watch.unset), ends, together


class _Rules:
    """What `btq check` reports of the nodes of a mission."""

    def __init__(self, mission: ExploredMission) -> None:
        self._mission: Final = mission
        self._of_file: Final[dict[str, Sequence[Diagnostic]]] = {}

    def at(self, uid: int, rule: str, named: str = "") -> str:
        """A rule, if it reports something of a node itself that has a name in its message; else nothing."""
        node, workspace = self._mission.written(uid), self._mission.workspace
        if node is None:
            return ""
        if node.path not in self._of_file:
            self._of_file[node.path] = check(workspace, node.path)
        file, end = workspace.files[node.path], next((child.start for child in node.node.children), node.node.end)
        own = file.on_disk(file.span_of(Place(Span(node.node.start, end), node.path, node.item)))
        is_reported = any(
            each.rule == rule and own.touches(each.span) and named in each.message for each in self._of_file[node.path]
        )
        return rule if is_reported else ""


def _thrown(opened: Opened, search: Search, running: frozenset[int]) -> Iterator[SurveyFinding]:
    """Exceptions of the engine."""
    for end, ways in list(search.ends.items()):
        if end.result == THROWN:
            yield SurveyFinding(
                "throws", f"the engine can throw: {end.message}", 0, replay(opened, None, running, ways)
            )


def _unset(opened: Opened, watch: _Watch, rules: _Rules) -> Iterator[SurveyFinding]:
    paths = {node.uid: node.path for node in opened.machine.nodes}
    for uid, key in sorted(watch.unset):
        rule = rules.at(uid, "unset-entry", f"`{key}`")
        yield SurveyFinding("reads-unset", f"{paths[uid]} can read {{{key}}} before it has a value", uid, rule=rule)


def _shared(mission: ExploredMission, opened: Opened, search: Search, rules: _Rules) -> Iterator[SurveyFinding]:
    """Two leaves that call one action server at once."""
    callers: dict[str, list[tuple[int, SimulatedNode]]] = defaultdict(list)
    for position, node in enumerate(opened.machine.nodes):
        if server := mission.server(node):
            callers[server].append((position, node))
    for server, nodes in callers.items():
        for index, (first, node) in enumerate(nodes):
            for second, other in nodes[index + 1 :]:
                if search.are_together(first, second):
                    text = f"{node.path} and {other.path} can call the server `{server}` at the same time"
                    rule = rules.at(other.uid, "shared-server") or rules.at(node.uid, "shared-server")
                    yield SurveyFinding("shared-server", text, other.uid, rule=rule)


def _missing_ends(mission: ExploredMission, opened: Opened, search: Search, watch: _Watch) -> Iterator[SurveyFinding]:
    """How the tree cannot end, and how those that it calls cannot although nodes in them can, with the reasons."""
    results = {end.result for end in search.ends}
    root = opened.machine.root
    subject = _called(mission.tree, mission.call())
    if not results & _WORDS.keys():
        yield SurveyFinding("cannot-end", f"{subject} cannot end")
        return
    named: set[tuple[ResolvedNode | None, int]] = set()  # a tree may run many times
    for result in (result for result in _WORDS if result not in results):
        causes = reasons(root, result, watch.results)
        named |= {(mission.written(node.uid), missing) for node, missing in causes}
        yield _cannot(subject, result, causes)
    for node in opened.machine.nodes:
        subtree = mission.written(node.uid)
        ends = [result for result in _WORDS if (node.uid, result) in watch.results]
        if subtree is None or not subtree.is_subtree or subtree.id is None or len(ends) != 1:
            continue
        result = FAILURE if ends == [SUCCESS] else SUCCESS
        causes = reasons(node, result, watch.results)
        written = {(mission.written(cause.uid), missing) for cause, missing in causes}
        if not written <= named:
            named |= written
            yield _cannot(_called(subtree.id.text, mission.place(node.uid)), result, causes)


def _called(tree: str, place: tuple[str, int] | None) -> str:
    """A tree and where it is called; None: it is the mission."""
    return "the mission" if place is None else f"the tree {tree}, called at {shown(place[0])}:{place[1]},"


def _cannot(subject: str, result: int, causes: Sequence[Reason]) -> SurveyFinding:
    """That a tree cannot have a result."""
    names = [f"{node.path} never {_WORDS[missing]}s" for node, missing in causes[:_MOST_NAMED]]
    more = [f"nor do {len(causes) - _MOST_NAMED} others"] if len(causes) > _MOST_NAMED else []
    reason = f": {', '.join([*names, *more])}" if names else ""
    word = _WORDS[result]
    return SurveyFinding(f"cannot-{word}", f"{subject} cannot {word}{reason}", causes[0][0].uid if causes else 0)


def _never(opened: Opened, watch: _Watch, rules: _Rules) -> Iterator[SurveyFinding]:
    """Nodes that never run, the topmost ones only, and nodes that never end."""
    ran, ended = watch.ran, watch.ended
    stack = [opened.machine.root]
    while stack:
        node = stack.pop()
        if node.uid not in ran:
            rule = rules.at(node.uid, "unreachable-child")
            yield SurveyFinding("never-runs", f"{node.path} never runs", node.uid, rule=rule)
            continue
        if node.uid not in ended and node is not opened.machine.root:
            yield SurveyFinding("never-ends", f"{node.path} never ends", node.uid)
        stack += reversed(node.children)


_WORDS: Final = {SUCCESS: "succeed", FAILURE: "fail"}
_MOST_NAMED: Final = 3  # reasons, in one line
