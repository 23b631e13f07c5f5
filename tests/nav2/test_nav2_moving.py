"""The trees that Nav2 ships, moved on to the next distribution: all that is found in them."""

from __future__ import annotations

import tarfile
from collections import Counter
from functools import cache
from io import BytesIO
from itertools import pairwise
from pathlib import Path
from subprocess import run

import pytest
from nav2_clone import clone

from btq_lang.btcpp.opening import file_of
from btq_lang.catalog.nav2 import DISTRIBUTIONS, PACKAGED
from btq_lang.checks import check_each
from btq_lang.commands.target import with_target
from btq_lang.workspace.config import Project
from btq_lang.workspace.file import File
from btq_lang.workspace.workspace import Workspace

EMPTY = (
    "target-differs: from Lyrical on `{}` finds an empty path in `{{path}}` at the start of each goal, no longer that "
    "of the last goal"
)
FRAME = (
    "target-differs: from Jazzy on `{}` without `{}` has the frame that bt_navigator is configured with, no longer `{}`"
)
FOUND = {
    "iron": {},
    "jazzy": {
        "target-breaks: `SequenceStar` is not built into BehaviorTree.CPP 4.6–4.10": 1,
        FRAME.format("DistanceController", "global_frame", "map"): 1,
        FRAME.format("DistanceController", "robot_base_frame", "base_link"): 1,
        FRAME.format("RemovePassedGoals", "robot_base_frame", "base_link"): 1,
    },
    "kilted": {
        "target-differs: from Kilted on `BackUp` writes its error where nobody collects it: results have "
        "only entries that end in `_error_code`": 1,
        "target-differs: from Kilted on `IsPathValid` ends the goal with an exception if there is no "
        "answer in time; before, it failed": 3,
        "target-differs: from Kilted on `RemovePassedGoals` keeps the status of waypoints only if it gets "
        "it: without, they stay pending to the end": 1,
    },
    "lyrical": {
        "target-breaks: Nav2 has no `IsPathValid` in Lyrical: it is called `ValidatePath`": 5,
        "target-differs: from Lyrical on `ClearEntireCostmap` fails if the service answers that it has "
        "not succeeded; before, it succeeded": 29,
        "target-differs: from Lyrical on `RoundRobin` does not begin again after its last child: it then "
        "fails, even if that child has succeeded": 7,
        EMPTY.format("FollowPath"): 12,
        EMPTY.format("PathExpiringTimer"): 1,
        EMPTY.format("PathLongerOnApproach"): 1,
    },
}


@cache
def shipped(branch: str) -> dict[str, File]:
    command = ["git", "-C", str(clone()), "archive", branch, "--", "nav2_bt_navigator/behavior_trees"]
    found = {}
    with tarfile.open(fileobj=BytesIO(run(command, capture_output=True, check=True).stdout)) as archive:
        for member in archive:
            content = archive.extractfile(member) if member.name.endswith(".xml") else None
            if content is not None:
                found[member.name] = file_of(member.name, content.read().decode())
    return found


def moved(branch: str, target: str) -> dict[str, int]:
    """What is found of the two rules in the trees of a branch, and how often."""
    nodes = PACKAGED[f"nav2-{branch}"]
    files = shipped(branch)
    own = {**files, nodes: file_of(nodes, Path(nodes).read_text(encoding="utf-8"))}
    workspace = with_target(Workspace(own, Project(node_files=(nodes,))), f"nav2-{target}")
    found = [each for diagnostics in check_each(workspace, files) for each in diagnostics]
    return dict(Counter(f"{each.rule}: {each.message}" for each in found if each.rule.startswith("target-")))


@pytest.mark.parametrize(("branch", "target"), [*pairwise(DISTRIBUTIONS)])
def test_every_finding_on_each_step(branch: str, target: str) -> None:
    assert moved(branch, target) == FOUND[target]


def test_the_whole_way_is_that_of_all_steps() -> None:
    """Of the trees that Humble has already, so each in smaller numbers; Lyrical lacks IsPathValid."""
    steps = {**FOUND["jazzy"], **FOUND["kilted"], **FOUND["lyrical"]}
    found = moved("humble", "lyrical")
    assert found.keys() < steps.keys()
    back_up, gone, _ = FOUND["kilted"]
    assert steps.keys() - found.keys() == {back_up, gone}
    assert all(number <= steps[each] for each, number in found.items())
