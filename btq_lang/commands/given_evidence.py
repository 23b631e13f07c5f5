"""The verdicts that an overview or a drawing shows with requirements: those of a file or a store, or by logs."""

from __future__ import annotations

import os
from collections.abc import Sequence
from glob import escape, glob
from typing import TYPE_CHECKING

from btq_lang.commands.candidates import candidate, name_of, side_of
from btq_lang.commands.progress import Progress
from btq_lang.commands.stored import store_of
from btq_lang.evidence.json_document import NotVerdicts, read_verdicts
from btq_lang.evidence.judging import Means
from btq_lang.evidence.readers.side import side_files_beside
from btq_lang.evidence.signal_sources import signal_sources
from btq_lang.evidence.store.sets import ABOUT
from btq_lang.evidence.verifying import judged, logs_below
from btq_lang.projects.files import logs_of
from btq_lang.trace.judged import judged_runs
from btq_lang.util.text import counted
from btq_lang.workspace.loader import absolute, find_project, read, shown

if TYPE_CHECKING:
    from btq_lang.evidence.verdicts import MissionVerdicts, RequirementVerdict
    from btq_lang.projects.files import FileGroup
    from btq_lang.trace.collect import BuildsOf, VerdictsOf
    from btq_lang.trace.overview import JudgedRuns
    from btq_lang.workspace.config import Project


def verdicts_for(
    evidence: Sequence[str], groups: Sequence[FileGroup], problems: list[str], runs: list[JudgedRuns] | None = None
) -> VerdictsOf | None:
    """A function from the path of a mission to the verdicts on it; None: there is no evidence.

    Args:
        evidence: files that `btq verify --format json` wrote, stores, and logs; none: the logs of the project, if there
            are any, else its store.
        problems: errors are appended.
        runs: the runs that were judged are appended, of each log or store.
    """
    evidence = evidence_paths(evidence, groups)
    if not evidence:
        return None
    runs = runs if runs is not None else []
    documents = [path for path in evidence if path.endswith(".json")]
    logs = [path for path in evidence if path not in documents]
    stores = [path for path in logs if is_store(path)]
    logs = [path for path in logs if path not in stores]
    by_mission: dict[str, list[RequirementVerdict]] = {}
    missions = {key for group in groups for path in group.given for key in (path, name_of(path))}
    for path in documents:
        _add_document(path, missions, by_mission, problems, runs)
    for store in stores:
        for in_store in _verdicts_in_store(store, problems):
            by_mission.setdefault(in_store.name, []).extend(in_store.requirements)
            runs += judged_runs(in_store.sources) if in_store.name in missions else ()
    if logs:
        for mission in _verdicts_by_logs(logs, groups, problems):
            by_mission.setdefault(mission.file, []).extend(mission.requirements)
            runs += judged_runs(mission.sources)
    if problems and not by_mission:
        return None
    return lambda path: by_mission.get(path) or by_mission.get(name_of(path), [])


def builds_for(evidence: Sequence[str], groups: Sequence[FileGroup], problems: list[str]) -> BuildsOf | None:
    """A function from the path of a mission to the verdicts on it by the labels in stores; None: there are no labels.

    Args:
        evidence, problems: as of `verdicts_for`.
    """
    by_mission: dict[str, list[tuple[str, Sequence[RequirementVerdict]]]] = {}
    for store in filter(is_store, evidence_paths(evidence, groups)):
        for mission, label, verdicts in _verdicts_by_label(store, problems):
            by_mission.setdefault(mission, []).append((label, verdicts))
    has_labels = any(label for builds in by_mission.values() for label, _ in builds)
    return (lambda mission: by_mission.get(name_of(mission), ())) if has_labels else None


def evidence_paths(evidence: Sequence[str], groups: Sequence[FileGroup]) -> Sequence[str]:
    """The paths of the evidence that counts; `evidence`: as of `verdicts_for`."""
    if evidence:
        return evidence
    project = _project(groups)
    logs = [path for path in logs_of(project) if os.path.exists(path)]
    store = store_of(project)
    return logs or ([store] if store is not None and is_store(store) else [])


def _add_document(
    path: str,
    missions: set[str],
    by_mission: dict[str, list[RequirementVerdict]],
    problems: list[str],
    runs: list[JudgedRuns],
) -> None:
    """Add the verdicts of a file, by the path of the mission and, for a file written elsewhere, by its name."""
    text, problem = read(absolute(path))
    if text is None or problem is not None:
        problems.append(str(problem))
        return
    try:
        of_file = {
            key: mission
            for mission in read_verdicts(text)
            for key in ((absolute(mission.file), mission.name) if mission.file else (mission.name,))
        }
    except NotVerdicts as error:
        problems.append(f"{shown(absolute(path))}: {error}; write such a file with btq verify LOG -o verdicts.json")
        return
    if missions.isdisjoint(of_file):
        names = "; ".join(key for key in of_file if not os.path.isabs(key))
        problems.append(f"{shown(absolute(path))}: no verdicts of these missions, only of {names}")
    for key, mission in of_file.items():
        by_mission.setdefault(key, []).extend(mission.requirements)
    asked_for = {id(mission): mission for key, mission in of_file.items() if key in missions}
    for mission in asked_for.values():
        runs += judged_runs(mission.sources)


def _project(groups: Sequence[FileGroup]) -> Project:
    return groups[0].project if groups else find_project(".").project


def is_store(path: str) -> bool:
    """Whether `btq verify --store` keeps verdicts there."""
    return "://" in path or bool(glob(os.path.join(escape(path), "*", ABOUT)))


def _verdicts_in_store(store: str, problems: list[str]) -> Sequence[MissionVerdicts]:
    """The verdicts of the runs in a store."""
    from btq_lang.evidence.store.engine import NoEngine, asked  # which needs DuckDB
    from btq_lang.evidence.store.summary import summary

    try:
        report = summary(asked(store), store, by_run=True)
    except NoEngine as error:
        problems.append(str(error))
        return ()
    return report.missions


def _verdicts_by_label(store: str, problems: list[str]) -> Sequence[tuple[str, str, Sequence[RequirementVerdict]]]:
    """The verdicts of the runs with each label of a store, by the name of the mission, in the order of first runs."""
    from btq_lang.evidence.store.engine import NoEngine, asked  # which needs DuckDB
    from btq_lang.evidence.store.summary import parted

    try:
        parts = sorted(parted(asked(store), store, ("label",)), key=lambda part: part[0]["start_us"] or 0)
    except NoEngine as error:
        problems.append(str(error))
        return ()
    return [(row["mission"], row["label"] or "", mission.requirements) for row, mission in parts]


def _verdicts_by_logs(
    log_paths: Sequence[str], groups: Sequence[FileGroup], problems: list[str]
) -> Sequence[MissionVerdicts]:
    project = _project(groups)
    logs, log_problems = logs_below(log_paths, project)
    sides = {side.mission: side for side in side_files_beside(logs)}
    missions = [
        candidate(group.workspace, path, side_of(path, sides))
        for group in groups
        for path in group.given
        if path not in group.workspace.included_files and not group.workspace.files[path].has_only_scenarios
    ]
    declared = signal_sources(missions, log_problems)
    problems += log_problems
    if log_problems:
        return ()
    with Progress(len(logs), "read") as progress:
        verification = judged(
            logs,
            Means(missions, declared=declared, with_measures=True),
            (),
            progress=lambda files, runs: progress.reached(files, f", {counted(runs, 'run')} judged"),
        )
    problems += verification.report.problems
    return verification.report.missions
