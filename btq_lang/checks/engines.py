"""The versions of the engine that a file must hold for, as the query store keeps them."""

from __future__ import annotations

from btq_lang.catalog.versions import VERSION_3, VERSIONS, is_before_4
from btq_lang.checks import lookups
from btq_lang.workspace import inputs
from btq_lang.workspace.engine_version import written_for
from btq_lang.workspace.queries import Store
from btq_lang.workspace.workspace import Workspace


def engines_of(store: Store[Workspace], viewpoint: str) -> tuple[str, ...]:
    """The versions that a file must hold for, oldest first."""
    project = store.ask(inputs.project)
    return project.engines if project.original_engines else store.ask(declared_engines, viewpoint) or VERSIONS


def declared_engines(store: Store[Workspace], viewpoint: str) -> tuple[str, ...]:
    """The versions that a file is written for, by its own words and its project; empty if nothing says so."""
    distribution, signs = store.ask(lookups.distribution, viewpoint), store.ask(lookups.signs, viewpoint)
    return written_for(store.ask(inputs.project), distribution, signs)


def is_for_version_3(store: Store[Workspace], viewpoint: str) -> bool:
    """Whether a file is written for version 3."""
    engines = store.ask(declared_engines, viewpoint)
    return bool(engines) and is_before_4(engines[-1])


def is_for_version_4(store: Store[Workspace], viewpoint: str) -> bool:
    """Whether something says that a file is written for version 4."""
    engines = store.ask(declared_engines, viewpoint)
    return bool(engines) and not is_before_4(engines[-1])


def old_words(store: Store[Workspace], viewpoint: str) -> tuple[str, ...]:
    """The words of an XML file that only version 3 of the engine understands; empty if its project names that
    version."""
    signs = store.ask(lookups.signs, viewpoint)
    if signs is None or not signs.old:
        return ()
    project = store.ask(inputs.project)
    of_project = written_for(project, store.ask(lookups.distribution, viewpoint), None)
    return () if is_before_4(of_project[-1]) else signs.old


def is_newer_than_engine(store: Store[Workspace], viewpoint: str) -> bool:
    """Whether an XML file says that it is for version 4, and its project that the engine is version 3."""
    signs = store.ask(lookups.signs, viewpoint)
    if signs is None or not (signs.is_new or signs.format not in ("", VERSION_3[:1])):
        return False
    return is_before_4(store.ask(engines_of, viewpoint)[-1])
