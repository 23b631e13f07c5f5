"""What rules call impossible, against all that happens in drawn trees."""

from __future__ import annotations

from collections import defaultdict
from random import Random
from typing import Final

import pytest
from drawn_trees import drawn
from seeds import seeds

from btq_lang.btcpp.opening import file_of
from btq_lang.checks import check
from btq_lang.checks.results import result
from btq_lang.checks.view import View
from btq_lang.exploration.answers import full_runs
from btq_lang.exploration.missions import ExploredMission, NotExplored
from btq_lang.exploration.search import Search, SearchBudget
from btq_lang.simulator.nodes import FAILURE, RUNNING, SUCCESS, SimulatedNode
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace

MODELS = (
    '<TreeNodesModel><Action ID="Act"><input_port name="in"/><output_port name="out" type="int"/></Action>'
    '<Condition ID="Cond"><output_port name="out" type="double"/></Condition></TreeNodesModel></root>'
)
# As `checks.statuses` has them.
STATUSES = {SUCCESS: 1, FAILURE: 2, RUNNING: 8}


class Seen:
    """Writes down the statuses that nodes have."""

    def __init__(self) -> None:
        self.statuses: Final[dict[int, set[int]]] = defaultdict(set)

    def begin(self) -> object:
        return None

    def changed(self, node: SimulatedNode, before: int, after: int) -> None:
        if after in STATUSES and (after != RUNNING or not node.children):  # parents run before it is known what comes
            self.statuses[node.uid].add(STATUSES[after])

    def unset_read(self, node: SimulatedNode, key: str) -> None:
        pass


@pytest.mark.parametrize("seed", seeds(600))
def test_nothing_happens_that_a_rule_calls_impossible(seed: int) -> None:
    random = Random(seed)
    xml, version = drawn(random).replace("</root>", MODELS), random.choice(("4.6", "4.10"))
    workspace = Workspace({"t.xml": file_of("t.xml", xml)}, Project(engines=(version,)))
    try:
        mission = ExploredMission(workspace, "t.xml", "Main")
        opened = mission.open()
    except NotExplored:
        return
    seen = Seen()
    opened.begin(seen, full_runs(opened))
    Search(opened.snapshots, SearchBudget(1_000)).run()
    file = workspace.files["t.xml"]
    views = [View(workspace.store, "t.xml", facts) for facts in file.facts.values()]
    possible = {id(node.node): result(view, node.node).ever for view in views for node in view.nodes}
    found = {each.span.start for each in check(workspace, "t.xml") if each.rule == "unreachable-child"}
    for uid, statuses in seen.statuses.items():
        node = mission.written(uid)
        if node is not None:
            assert sum(statuses) & ~possible[id(node.node)] == 0, node.shown
            assert file.on_disk(file.span_of(node.place)).start not in found
