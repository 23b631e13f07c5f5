"""The factories that a parameter file of Nav2 describes, and the findings in it.

bt_navigator has a factory for each navigator, so a tree that one of them creates by default, or for a goal that names
it, sees what is read for that tree and nothing else.
"""

from __future__ import annotations

import os.path
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from btq_lang.catalog.nav2 import FILES, distribution_among
from btq_lang.diagnostics.model import Diagnostic, Place
from btq_lang.nav2.findings import NavigatorTree, findings, wrong_goals
from btq_lang.nav2.libraries import NAMES
from btq_lang.nav2.loaded import Load, Loads, goals_in
from btq_lang.nav2.names import distribution_unknown, file_findings
from btq_lang.nav2.parameters import Parameters, read_parameters
from btq_lang.nav2.yaml_reader import YamlMissing, YamlProblem
from btq_lang.util.record import Record, replace
from btq_lang.util.text import Span
from btq_lang.workspace.config import configured
from btq_lang.workspace.loader import LoadProblem, absolute, read

if TYPE_CHECKING:
    from typing import TypeAlias

    from btq_lang.workspace.config import Project
    from btq_lang.workspace.factories import Factory
    from btq_lang.workspace.workspace import Workspace

    _Finding: TypeAlias = tuple[str | None, Diagnostic]  # None: in the parameter file


class ParameterSources(Record):
    """Where parameter files and what they name are read.

    Attributes:
        known: returns the text of an open file.
        source_of: returns the mission that XML was built of, which counts in its place.
        workspace_of: returns the workspace of a factory.
        senders: the other programs of the project, which may send goals.
    """

    known: Callable[[str], str | None]
    source_of: Callable[[str], str | None]
    workspace_of: Callable[[Factory], Workspace]
    senders: tuple[Factory, ...] = ()


class ParameterFile(Record):
    """A parameter file and what it loads.

    Attributes:
        project: that names it, or in whose files it is looked at.
        project_file: of that project.
        parameters: of bt_navigator; None: the file is not YAML, which is the `problem`.
        factory: that names it; its files are those that goals name.
        sources: where it and what it names are read.
        distribution: named in the project, or else the only one that the parameters can be for.
        factories: one for each tree that is created, with what is read for it.
        goals: what is wrong with trees that nodes name for goals, by this name.
    """

    path: str
    text: str
    project: Project
    project_file: str | None
    factory: Factory
    sources: ParameterSources
    parameters: Parameters | None
    distribution: str | None
    factories: tuple[tuple[Load, Factory], ...] = ()
    goals: tuple[tuple[str, Diagnostic], ...] = ()
    problem: Diagnostic | None = None

    @property
    def distinct(self) -> list[Factory]:
        """The factories with files, without those that register the same ones: Lyrical reads one folder for both
        navigators."""
        by_files: dict[tuple[frozenset[str], bool], Factory] = {}
        for _, factory in self.factories:
            if factory.files:
                by_files.setdefault((frozenset(factory.files), factory.has_gaps), factory)
        return [*by_files.values()]

    @property
    def used(self) -> frozenset[str]:
        """The files that its findings depend on, without the project file."""
        loads = [load for load, _ in self.factories]
        places = [place for load in loads for place in (*load.refused, *(skipped.place for skipped in load.skipped))]
        places += [goal for load in loads for goal in load.goals]
        named = [place.path for place in places if place.path is not None]
        return frozenset((self.path, *named, *(path for load in loads for path in load.files)))

    def factory_of(self, load: Load) -> Factory:
        """The factory for one of the trees that are created."""
        parameters, distribution, nodes = self.parameters, self.distribution, self.factory.node_files
        if distribution is not None and distribution_among(nodes) is None:
            nodes = (*nodes, FILES[distribution])
        return replace(
            self.factory,
            name=f"{self.factory.name} ({load.label})",
            files=tuple(dict.fromkeys(self.sources.source_of(path) or path for path in load.files)),
            node_files=nodes,
            nav2=self.path,
            has_gaps=distribution is None or not load.is_whole or bool(load.refused),
            entries=parameters.entries(distribution) if parameters is not None and distribution is not None else (),
            period=parameters.period if parameters is not None else self.factory.period,
            libraries=tuple(each.text for each in (parameters.texts(NAMES) if parameters is not None else None) or ()),
        )


def parameter_file(
    factory: Factory, project: Project, project_file: str | None, sources: ParameterSources
) -> tuple[ParameterFile | None, LoadProblem | None]:
    """The parameter file of a factory, or why it could not be read; the files of the factory are those that
    goals name."""
    path = absolute(os.path.join(project.root, factory.nav2))
    open_text = sources.known(path)
    text, problem = (open_text, None) if open_text is not None else read(path)
    if text is None:
        return None, problem
    distribution = distribution_among((*factory.node_files, *project.node_files))
    empty = ParameterFile(path, text, project, project_file, factory, sources, None, distribution)
    try:
        parameters = read_parameters(text)
    except YamlMissing:
        return None, LoadProblem(path, "needs PyYAML to be read: pip install 'btq-lang[nav2]'")
    except YamlProblem as error:
        offset = min(error.offset, len(text))
        return replace(empty, problem=Diagnostic("yaml-syntax", Span(offset, offset), error.message)), problem
    whole = replace(empty, parameters=parameters)
    return in_distribution(whole, distribution or parameters.distribution), problem


def in_distribution(file: ParameterFile, distribution: str | None) -> ParameterFile:
    """A parameter file with the trees that a distribution loads by it."""
    parameters, sources = file.parameters, file.sources
    if parameters is None:
        return file
    loads = Loads(parameters, distribution, file.project.root, lambda each: sources.known(each) or read(each)[0])
    file = replace(file, distribution=distribution)
    loaded = [*loads.by_default(), *map(loads.of_file, file.factory.files)]
    if distribution is not None:
        loaded += _for_goals(file, parameters, loads, [*sources.senders, *map(file.factory_of, loaded)])
    whole = replace(file, factories=tuple((load, file.factory_of(load)) for load in loaded))
    if distribution is None or not any(load.goals for load in loaded):
        return whole
    goals = tuple(dict.fromkeys(wrong_goals(parameters, distribution, _loaded(whole, sources.workspace_of))))
    factories = tuple((load, replace(factory, goals=goals)) for load, factory in whole.factories)
    return replace(whole, goals=goals, factories=factories)


def _for_goals(file: ParameterFile, parameters: Parameters, loads: Loads, senders: list[Factory]) -> Iterator[Load]:
    """The trees that goals name, also those that only the tree of another goal names."""
    loads_of_goals: dict[tuple[str, bool], Load] = {}
    places: dict[tuple[str, bool], dict[Place, None]] = {}
    for goal in parameters.goals:
        places.setdefault((goal.text, True), {})[Place(goal.span)] = None
    walked: set[frozenset[str]] = set()
    while True:
        for factory in senders:
            if frozenset(factory.files) not in walked:
                walked.add(frozenset(factory.files))
                for name, place in goals_in(file.sources.workspace_of(factory)):
                    places.setdefault((name, False), {})[place] = None
        new = {goal: loads.of_goal(*goal) for goal in places if goal not in loads_of_goals}
        if not new:
            break
        loads_of_goals.update(new)
        senders = [*map(file.factory_of, new.values())]
    return (replace(load, goals=tuple(places[goal])) for goal, load in loads_of_goals.items())


def findings_of(
    file: ParameterFile, workspace_of: Callable[[Factory], Workspace], moved: ParameterFile | None = None
) -> Iterator[tuple[str, Diagnostic]]:
    """The findings in a parameter file and in what it loads, each with its file.

    What is wrong with trees that nodes name for goals is found by the checks of these nodes, but for that of `moved`.

    Args:
        workspace_of: returns the workspace of a factory.
        moved: the file in the distribution that its robot moves to.
    """
    findings_today = [*_own_findings(file, workspace_of)]
    new: list[_Finding] = []
    if moved is not None and file.distribution is not None:
        new = [*_new_in_target(findings_today, moved, workspace_of)]
    for path, diagnostic in (*((None, each) for path, each in findings_today if path is None), *new):
        yield from ((path or file.path, each) for each in configured(file.project, path or file.path, (diagnostic,)))


def _new_in_target(
    findings_today: list[_Finding], moved: ParameterFile, workspace_of: Callable[[Factory], Workspace]
) -> Iterator[_Finding]:
    """The findings about what only the target refuses, or reads otherwise than the distribution of the parameters."""
    from btq_lang.checks.target_changes import is_severe, of_target  # few checks have a target

    severe_today = {_key(finding) for finding in findings_today if is_severe(finding[1])}
    for path, diagnostic in _own_findings(moved, workspace_of):
        if is_severe(diagnostic) and _key((path, diagnostic)) not in severe_today:
            yield path, of_target(diagnostic, (moved.distribution or "").capitalize())


def _key(finding: _Finding) -> tuple[object, ...]:
    """The same value for equal findings of two distributions; nodes without library share a place."""
    path, diagnostic = finding
    return path, diagnostic.rule, diagnostic.span, diagnostic.related[:1] if diagnostic.rule == "unloaded-node" else ()


def _own_findings(file: ParameterFile, workspace_of: Callable[[Factory], Workspace]) -> Iterator[_Finding]:
    if file.problem is not None:
        yield None, file.problem
    if file.parameters is not None and file.distribution is None:
        of_file = [*file_findings(file.parameters)]
        yield from ((None, each) for each in of_file or [distribution_unknown(file.parameters)])
    elif file.parameters is not None and file.distribution is not None:
        yield from findings(file.parameters, file.distribution, _loaded(file, workspace_of))


def _loaded(file: ParameterFile, workspace_of: Callable[[Factory], Workspace]) -> list[NavigatorTree]:
    return [NavigatorTree(load, workspace_of(factory)) for load, factory in file.factories]
