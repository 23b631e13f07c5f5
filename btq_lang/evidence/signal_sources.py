"""The sources of samples that a project declares, checked against the signals of missions."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Final

from btq_lang.catalog.units import a_dimension
from btq_lang.evidence.readers.samples import NoSamples, read_sources
from btq_lang.util.grouping import grouped
from btq_lang.util.record import Record
from btq_lang.util.spelling import did_you_mean, near
from btq_lang.workspace.loader import find_project, shown

if TYPE_CHECKING:
    from btq_lang.evidence.identity import Candidate
    from btq_lang.evidence.model import SampleSeries
    from btq_lang.requirements.model import ResolvedSignal
    from btq_lang.workspace.config import Project
    from btq_lang.workspace.project_evidence import SignalSource

NO_FILES: Final[Mapping[str, Mapping[str, SampleSeries]]] = {}
NO_PROBLEMS: Final[Mapping[str, str]] = {}


class Declared(Record):
    """What the projects of missions declare of where samples come from.

    Attributes:
        sources: of all projects; topics are read from the bags among the logs.
        of_files: the samples of those that are files, by the path of the mission and by signal.
        broken: why the sources of a mission cannot be used, by its path.
        clashing: the signals that projects read from different topics.
    """

    sources: Sequence[SignalSource] = ()
    of_files: Mapping[str, Mapping[str, SampleSeries]] = NO_FILES
    broken: Mapping[str, str] = NO_PROBLEMS
    clashing: frozenset[str] = frozenset()

    def problem(self, mission: str, of_bag: Iterable[str]) -> str:
        """Why a run of a mission cannot be judged with these samples; empty if it can.

        Args:
            mission: its path.
            of_bag: the signals that a bag has.
        """
        clashing = self.clashing.intersection(of_bag)
        if clashing:
            return f"projects read `{min(clashing)}` from different topics; name the mission with --mission"
        return self.broken.get(mission, "")


def signal_sources(missions: Sequence[Candidate], problems: list[str]) -> Declared:
    """The sources in `[evidence.signals]` of each mission's project, or where that has no evidence of this folder's.

    Args:
        problems: errors are appended, if all missions are of one project; those of several only matter to their runs.
    """
    here_project = find_project(".")
    homes = {mission.path: mission.workspace.project for mission in missions}
    projects = {path: home if home.evidence is not None else here_project.project for path, home in homes.items()}
    by_root = grouped((projects[mission.path].root, mission) for mission in missions)
    of_files: dict[str, Mapping[str, SampleSeries]] = {}
    broken: dict[str, str] = {}
    topics: dict[str, SignalSource] = {}
    sources: list[SignalSource] = []
    clashing: set[str] = set()
    for own in by_root.values():
        project = projects[own[0].path]
        for source in project.evidence.signals if project.evidence is not None else ():
            sources.append(source)
            if source.topic and topics.setdefault(source.signal, source) != source:
                clashing.add(source.signal)
        wrong: list[str] = []
        samples = _read(project, own, wrong)
        of_files.update((mission.path, samples) for mission in own)
        if len(by_root) == 1:
            problems += wrong
        elif wrong:
            broken.update((mission.path, "; ".join(wrong)) for mission in own)
    return Declared(sources, of_files, broken, frozenset(clashing))


def _read(project: Project, missions: Sequence[Candidate], problems: list[str]) -> Mapping[str, SampleSeries]:
    """The samples of the sources of a project that are files; errors are appended."""
    sources = project.evidence.signals if project.evidence is not None else ()
    if not sources:
        return {}
    wrong = dict.fromkeys(problem for source in sources for problem in _wrong(source, missions))
    file = find_project(project.root).path or project.root
    problems += [f"{shown(file)}: [evidence.signals]: {problem}" for problem in wrong]
    try:
        return {} if wrong else read_sources(sources, project.root)
    except NoSamples as error:
        problems.append(str(error))
    except OSError as error:
        problems.append(f"{shown(os.fsdecode(error.filename))}: cannot be read: {error.strerror or error}")
    return {}


def _wrong(source: SignalSource, missions: Sequence[Candidate]) -> Iterator[str]:
    """The errors of a source, given the missions' signals."""
    name = source.signal
    signals = [mission.requirements.signals for mission in missions]
    for signals_of_mission in signals:
        if name in signals_of_mission:
            yield from _wrong_for(source, signals_of_mission[name])
    names = {signal for signals_of_mission in signals for signal in signals_of_mission}
    if names and name not in names and (meant := near(name, names, 1)):
        yield f"no mission has a signal `{name}`{did_you_mean(meant)}"


def _wrong_for(source: SignalSource, signal: ResolvedSignal) -> Iterator[str]:
    if signal.sort != "number":
        if source.unit is not None or source.scale != 1 or source.offset != 0:
            yield f"`{signal.name}` is a {signal.sort}, so it takes no unit, scale or offset"
    elif source.unit is not None and signal.unit is not None and source.unit.dimension != signal.unit.dimension:
        yield (
            f"`{signal.name}` is in {signal.unit.symbol}, which is {a_dimension(signal.unit)}, and its source in"
            f" {source.unit.symbol}, which is {a_dimension(source.unit)}"
        )
