"""Which runs of the logs an editor may show, and a run on the picture of a text.

One invariant: a run is drawn only on the trees that it is of: after an edit of them it belongs to an earlier text.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from btq_lang.evidence.outline import outline
from btq_lang.evidence.verdicts import VIOLATED
from btq_lang.evidence.wording import duration
from btq_lang.graph.missions import keyed
from btq_lang.ide.clause_enforcement import missions_of
from btq_lang.requirements.resolve import requirements
from btq_lang.util.record import Record
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:
    from btq_lang.ide.verdicts import ProjectVerdicts


class LoggedRun(Record):
    """Where a run is.

    Attributes:
        mission: the path of its mission.
        log: as the summary names it.
        number: among all runs.
        number_in_log: among those of the log.
    """

    mission: str
    log: str
    number: int
    number_in_log: int


def runs_to_show(workspace: Workspace, path: str, evidence: ProjectVerdicts) -> list[tuple[int, str]]:
    """The runs that people look for, each with what it is: the last one, and the worst of each violated clause."""
    mission = _mission(workspace, path, evidence)
    if mission is None:
        return []
    written = evidence.missions[mission]
    last = max((source for source in written.sources if source.runs), key=lambda source: source.end)
    labels = {last.first_run + last.runs - 1: ["the last one"]}
    for requirement in written.requirements:
        for clause in requirement.clauses:
            if clause.verdict == VIOLATED and clause.violations:
                worst = clause.worst
                run = worst.run if worst is not None and worst.run is not None else clause.violations[0].run
                label = f"the worst of {requirement.id}" + (f", {worst.text}" if worst is not None else "")
                labels.setdefault(run, []).append(label)
    return [(run, "; ".join(dict.fromkeys(words))) for run, words in labels.items()]


def logged_run(workspace: Workspace, path: str, evidence: ProjectVerdicts, number: int) -> LoggedRun | None:
    """Where a run is; None: there is no such run."""
    mission = _mission(workspace, path, evidence)
    for source in evidence.missions[mission].sources if mission is not None else ():
        if source.first_run <= number < source.first_run + source.runs:
            assert mission is not None, "it has sources"
            number_in_log = number - source.first_run + 1
            for left_out in sorted(source.left_out):
                number_in_log += left_out <= number_in_log
            return LoggedRun(mission, source.file, number, number_in_log)
    return None


def run_on_picture(
    workspace: Workspace, path: str, run: LoggedRun, printed: Mapping[str, Any]
) -> dict[str, Any] | None:
    """A run for the page that draws a file's trees: each step with the key of its node, if that is drawn; None if the
    trees have changed since.

    Args:
        found: the run as `btq verify --run` prints it.
    """
    of_mission = requirements(workspace, run.mission)
    if outline(of_mission) != printed["outline"]:
        return None
    numbers = {id(node.node): number for number, node in enumerate(of_mission.nodes.all)}
    keys = {numbers[id(node.node)]: key for key, node in keyed(workspace, path) if id(node.node) in numbers}
    steps = [
        {
            "key": keys.get(step["node"]),
            "state": step["state"],
            "time": step["took"],
            "said": f"{duration(step['at'])}: {step['path']} {_state(step)}",
        }
        for step in printed["steps"]
    ]
    title = f"Run {run.number} of {run.log.rpartition('/')[2]}: {printed['outcome']}"
    return {"title": title, "steps": steps, "leftOut": printed["left_out"]}


def _state(step: Mapping[str, Any]) -> str:
    if step["state"] == "running":
        return "starts"
    return f"{step['state']}, {step['took']}" if step["took"] else str(step["state"])


def _mission(workspace: Workspace, path: str, evidence: ProjectVerdicts) -> str | None:
    """The first mission of a file that there are runs of."""
    return next((each for each in missions_of(workspace, path) if each in evidence.missions), None)
