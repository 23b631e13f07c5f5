"""Whether the nodes, signals and units in `[simulate]` of a project file are those of its missions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from btq_lang.requirements import nodes
from btq_lang.requirements.simulation import Problem, SettingsReader
from btq_lang.util.record import Record
from btq_lang.util.toml_places import find_key
from btq_lang.workspace import inputs
from btq_lang.workspace.config import keys_above
from btq_lang.workspace.loader import FoundProject, LoadProblem, read

if TYPE_CHECKING:
    from btq_lang.workspace.project_simulation import SimulationSettings
    from btq_lang.workspace.workspace import Workspace


class CheckedNames(Record):
    """What is wrong with settings.

    Attributes:
        problems: in some mission.
        unknown: names that no mission has.
    """

    problems: tuple[Problem, ...]
    unknown: tuple[Problem, ...]


def checked_names(settings: SimulationSettings, groups: Iterable[tuple[Workspace, Iterable[str]]]) -> CheckedNames:
    """What is wrong with settings in a project; what may be in a file that was not read is known.

    Args:
        groups: workspaces with the paths of missions in them.
    """
    problems: dict[Problem, None] = {}
    unknown: dict[tuple[str, ...], str] = {}
    known: set[tuple[str, ...]] = set()
    is_complete = True
    for workspace, paths in groups:
        store = workspace.store
        for path in paths:
            if store.ask(inputs.is_included, path) or not store.ask(nodes.has_nodes, path):
                continue
            reader = SettingsReader(store, path)
            for skill in settings.skills:
                reader.skill(skill)
            for signal in settings.world:
                reader.signal(signal)
            problems.update(dict.fromkeys(reader.problems))
            for message, keys in reader.unknown:
                unknown[keys] = max(message, unknown.get(keys, ""), key=len)  # one that knows a similar name
            known |= reader.known
            is_complete &= store.ask(nodes.knows_all_nodes, path)
    nowhere = [(message, keys) for keys, message in unknown.items() if keys not in known]
    return CheckedNames(tuple(problems), tuple(nowhere) if is_complete else ())


def at_their_keys(home: FoundProject, problems: Iterable[Problem], overlay: Mapping[str, str]) -> list[LoadProblem]:
    """The problems of a project file, each at the place of its key."""
    path = home.path or ""
    text = overlay[path] if path in overlay else read(path)[0] or ""
    above = (*keys_above(path), "simulate")
    return [LoadProblem(path, message, find_key(text, (*above, *keys))) for message, keys in problems]
