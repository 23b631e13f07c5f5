"""The missions that logs may belong to."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from glob import escape, glob
from typing import TYPE_CHECKING

from btq_lang.btcpp.as_built import as_built
from btq_lang.btcpp.export import xml_name
from btq_lang.btcpp.side_file import side_path, xml_path
from btq_lang.evidence.identity import Candidate
from btq_lang.evidence.own_trees import NO_MISSION, OwnTree, OwnTrees
from btq_lang.evidence.readers import NotALog, trees
from btq_lang.evidence.readers.side import SideFile, side_file_at, side_files_beside
from btq_lang.projects.files import Files
from btq_lang.projects.opening import Disk
from btq_lang.projects.scenario_files import with_scenario_files
from btq_lang.workspace.loader import absolute, find_project, is_project_file, shown

if TYPE_CHECKING:
    from btq_lang.workspace.workspace import Workspace


def candidates(requested: Sequence[str], logs: Sequence[str], problems: list[str]) -> Sequence[Candidate]:
    """The missions that logs may belong to: the requested ones, else those of side files beside the logs and of this
    folder's project, else the trees in the logs.
    """
    sides = {side.mission: side for side in side_files_beside(logs)}
    existing = [mission for mission in sides if os.path.isfile(mission)]
    missions = (
        []
        if requested
        else [
            mission for side in sides.values() if side.mission not in existing for mission in _missions_as_built(side)
        ]
    )
    home = find_project(".")
    files = Files()
    groups, unreadable = files.groups(requested or [*existing, home.project.root])
    # A mission of a broken project elsewhere was not requested.
    elsewhere = {problem.path for problem in unreadable if is_project_file(problem.path) and problem.path != home.path}
    broken = elsewhere if not requested else set()
    problems += [str(problem) for problem in unreadable if problem.path not in broken]
    for group in with_scenario_files(files, groups):
        for path in group.given if group.project_file not in broken else ():
            if group.workspace.files[path].has_only_scenarios:
                continue
            side = side_of(path, sides)
            if path.endswith(".xml") and side is not None and (built := [*_missions_as_built(side)]):
                missions += built
            elif requested or path not in group.workspace.included_files:
                missions.append(candidate(group.workspace, path, side))
    if not missions and not problems and not requested:
        return _of_logs(logs, problems)
    if not missions and not problems:
        problems.append(NO_MISSION)
    return missions


def strict_problem(is_strict: bool, missions: Sequence[Candidate]) -> list[str]:
    """The reason why not every requirement can be satisfied: there is no mission."""
    has_mission = any(not isinstance(mission, OwnTree) for mission in missions)
    return [] if has_mission or not is_strict else [f"--strict: {NO_MISSION}"]


def _of_logs(logs: Sequence[str], problems: list[str]) -> Sequence[Candidate]:
    """The trees in logs as missions; for logs without a tree, the XML beside them."""
    own_trees = OwnTrees()
    treeless: list[str] = []
    for log in logs:
        try:
            own_trees.add(logged_trees := trees(log), log)
        except (NotALog, OSError):
            continue  # judging it reports that
        treeless += [] if logged_trees else [log]
    beside = dict.fromkeys(path for log in treeless for path in _xml_beside(log))
    groups, unreadable = Files().groups([*beside]) if beside else ((), ())
    problems += map(str, unreadable)
    others = [candidate(group.workspace, path, None) for group in groups for path in group.given]
    if treeless and not others and not own_trees.missions and not problems:
        problems.append(f"{NO_MISSION}; {shown(treeless[0])} has no tree")
    return [*own_trees.missions, *others]


def _xml_beside(log: str) -> Sequence[str]:
    """The XML file beside a log that has its name, else all."""
    folder, name = os.path.split(absolute(log))
    same_named = os.path.join(folder, f"{os.path.splitext(name)[0]}.xml")
    return [same_named] if os.path.isfile(same_named) else sorted(glob(os.path.join(escape(folder), "*.xml")))


def side_of(path: str, sides: Mapping[str, SideFile]) -> SideFile | None:
    """The side file of a mission: one of those beside the logs, else the one beside the mission."""
    return sides.get(path) or side_file_at(side_path(xml_name(path)))


def candidate(workspace: Workspace, path: str, side: SideFile | None) -> Candidate:
    """A mission, with the nodes of its side file if that is its own."""
    return Candidate(workspace, path, name_of(path), side.nodes if side is not None and side.mission == path else None)


def name_of(path: str) -> str:
    """The name of a mission: that of its file without the suffix."""
    return os.path.splitext(os.path.basename(path))[0]


def _missions_as_built(side: SideFile) -> Iterator[Candidate]:
    """The mission as built, if only the XML and the side file are available."""
    built = as_built(xml_path(side.path), Disk())
    if built is not None:
        yield Candidate(built.workspace, built.path, name_of(side.mission), side.nodes)
