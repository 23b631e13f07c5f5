"""How likely trees succeed and how long they take, with the skills that btq.toml declares: without a run.

One invariant: a number is shown only where it is exact for skills that are independent of each other.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Final

from btq_lang.evidence.identity import without_number
from btq_lang.evidence.wording import duration, share
from btq_lang.ide.meaning import ReferenceAt
from btq_lang.prediction.declared import declared_world
from btq_lang.prediction.exact import Folded, NotExact, TreeFold
from btq_lang.prediction.prepared import prepared
from btq_lang.scenarios.mission import NotRunnable, ScenarioMission, as_program
from btq_lang.simulator.decorators import tick_retry
from btq_lang.simulator.errors import EngineError, NotModelled
from btq_lang.simulator.nodes import SUCCESS, SimulatedNode
from btq_lang.simulator.ports import read_whole
from btq_lang.simulator.timers import tick_timeout
from btq_lang.syntax.tree import Tree
from btq_lang.workspace.project_driver import Driver
from btq_lang.workspace.project_simulation import SimulationSettings
from btq_lang.workspace.queries import Cancelled
from btq_lang.workspace.workspace import Workspace


def trees_with_outlook(workspace: Workspace, path: str) -> Sequence[str]:
    """The names of the trees of a file, if the project declares what some skills do."""
    if not _declares_skills(workspace):
        return ()
    trees = workspace.files[path].of_type(Tree)
    return [*dict.fromkeys(tree.name.text for tree in trees if tree.name is not None)]


def outlook(workspace: Workspace, path: str, tree: str, is_cancelled: Callable[[], bool] = bool) -> str:
    """How likely a tree succeeds and how long it then takes; empty if that is not exact, or none of its skills is
    declared.

    Args:
        is_cancelled: called before each step.

    Raises:
        Cancelled: it returned true.
    """
    folded = _folded(workspace, path, tree, is_cancelled)
    return folded.text() if folded is not None else ""


def what_if(workspace: Workspace, reference: ReferenceAt, is_cancelled: Callable[[], bool] = bool) -> str:
    """What other numbers of attempts of a Retry, or other limits of a Timeout, would give: Markdown; empty if the node
    is another one, or nothing is declared.

    Raises:
        Cancelled: as of `outlook`.
    """
    node, entry = reference.mention.node, reference.entry
    tree = entry.item if entry is not None else None
    if node is None or not isinstance(tree, Tree) or tree.name is None or not _declares_skills(workspace):
        return ""
    folded = _folded(workspace, reference.path, tree.name.text, is_cancelled)
    if folded is None:
        return ""
    written = folded.mission.written
    own = next((each for each in folded.nodes if each.uid in written and written[each.uid].node is node), None)
    return folded.table(own) if own is not None else ""


def _declares_skills(workspace: Workspace) -> bool:
    settings = workspace.project.simulation
    return settings is not None and bool(settings.skills)


class _FoldedTree:
    """A tree as it is built, or without its guards if these cannot be folded.

    Attributes:
        nodes: of the tree.
        obstacle: why it cannot be folded as a whole.
    """

    def __init__(
        self, mission: ScenarioMission, settings: SimulationSettings, is_guarded: bool, is_cancelled: Callable[[], bool]
    ) -> None:
        world = declared_world(settings, mission)
        loaded = prepared(mission, world, world.skills)
        self.mission: Final = mission
        self.nodes: Final[Sequence[SimulatedNode]] = loaded.loaded.nodes
        self.obstacle: NotExact | None = None
        self._skills: Final = loaded.loaded.robot.skills
        self._sources: Final = [each.source for each in loaded.sources]
        self._is_guarded: Final = is_guarded
        self._is_cancelled: Final = is_cancelled
        if self.is_declared:
            try:
                self.fold(self.nodes[0])
            except NotExact as obstacle:
                self.obstacle = obstacle

    @property
    def is_declared(self) -> bool:
        """Whether something is declared of one of its skills."""
        return "declared" in self._sources

    def fold(self, node: SimulatedNode, changed: Mapping[tuple[int, str], int] | None = None) -> Folded:
        """A node; `changed`: other values of ports."""
        return TreeFold(self._skills, changed, self._step).of(node)

    def _step(self) -> None:
        if self._is_cancelled():
            raise Cancelled

    def text(self) -> str:
        """How likely it succeeds, how long it then takes, and who says so."""
        if self.obstacle is not None:
            return ""
        folded = self.fold(self.nodes[0])
        assumed = self._sources.count("ASSUMED")
        notes = ["declared", *([f"{assumed} ASSUMED"] if assumed else [])]
        notes += [] if self._is_guarded else ["without guards"]
        p95 = f", p95 {_p95(folded)}" if folded.success else ""
        return f"succeeds {_success(folded)}{p95} ({', '.join(notes)})"

    def table(self, node: SimulatedNode) -> str:
        """What other numbers of its port would give."""
        port, label, values = _other_values(node)
        if not values:
            return ""
        rows = [f"| {label} | succeeds | p95 | the tree succeeds |", "|---|---|---|---|"]
        try:
            for value in values:
                changed = {(node.uid, port): value}
                own = self.fold(node, changed)
                tree = _success(self.fold(self.nodes[0], changed)) if self.obstacle is None else ""
                shown = str(value) if port == "num_attempts" else duration(value / 1000)
                rows.append(f"| {shown} | {_success(own)} | {_p95(own)} | {tree} |")
        except NotExact as obstacle:
            return f"No exact prediction: {without_number(obstacle.node.path)}: {obstacle.reason}."
        return "\n".join(rows)


def _folded(workspace: Workspace, path: str, tree: str, is_cancelled: Callable[[], bool]) -> _FoldedTree | None:
    """The tree of this name; None: it cannot be loaded, no skill of it is declared, or the project names a driver that
    ticks otherwise than the fold supposes.
    """
    settings = workspace.project.simulation
    if settings is None:
        return None
    program = as_program(workspace, path, tree)
    program.store.is_cancelled = is_cancelled
    folded = None
    try:
        for is_guarded in (True, False):
            mission = ScenarioMission(program, path, tree, is_guarded)
            if mission.program.driver != Driver():
                return None
            folded = _FoldedTree(mission, settings, is_guarded, is_cancelled)
            if folded.obstacle is None or folded.obstacle.node.uid in mission.written:
                break
    except (NotRunnable, EngineError, NotModelled):
        return None
    return folded if folded is not None and folded.is_declared else None


def _success(folded: Folded) -> str:
    return share(float(folded.success))


def _p95(folded: Folded) -> str:
    """How long 95 % of its successes take at most, and how wrong that may be if that is worth saying."""
    takes = folded.takes(SUCCESS)
    if takes is None:
        return ""
    seconds, error = takes.percentile(0.95) / 1000, takes.error / 1000
    note = f" ± {duration(_rounded(error))}" if error > _NOTED * seconds else ""
    return duration(_rounded(seconds)) + note


def _rounded(seconds: float) -> float:
    """A duration with two digits, or as many as there are before the point."""
    return float(f"{seconds:.2g}") if seconds < _WHOLE else float(round(seconds))


def _other_values(node: SimulatedNode) -> tuple[str, str, Sequence[int]]:
    """The port of a node, what it is, and values to compare, its own among them; none of another node."""
    for flow, port, label in ((tick_retry, "num_attempts", "attempts"), (tick_timeout, "msec", "limit")):
        own = read_whole(node, port) if node.rules.flow is flow else None
        if own is not None and own > 0:
            values = range(1, 6) if flow is tick_retry else (own // 2, own * 3 // 4, own * 3 // 2, own * 2)
            return port, label, sorted({own, *(value for value in values if value > 0)})
    return "", "", ()


_WHOLE: Final = 10.0
_NOTED: Final = 0.02
