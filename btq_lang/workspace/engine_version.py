"""The version of the engine that a text is for: the one place that decides it, for every command and for editors.

One invariant: the project's versions count before a text's own signs, and a declaration in the text before its words;
but no text is for a version that refuses its words.  Not known here: how words are found in XML
(`btcpp/version3.py`), and which distribution of Nav2 a file is for.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from btq_lang.catalog.nav2 import ENGINES
from btq_lang.catalog.versions import VERSION_3, VERSIONS, is_before_4

if TYPE_CHECKING:
    from btq_lang.workspace.config import Project
    from btq_lang.workspace.file import Signs


def written_for(project: Project, distribution: str | None, signs: Signs | None) -> tuple[str, ...]:
    """The versions that a text is written for, oldest first; empty if nothing determines them: the text is then read as
    one for version 4.

    Args:
        distribution: the one of Nav2 whose nodes the project names for the text.
        signs: None for a text in this language, which is for version 4 unless its project says otherwise.
    """
    if signs is not None and signs.is_refused:
        return (VERSION_3,)
    engines = project.original_engines or project.engines
    if project.names_all or engines != VERSIONS:
        return engines
    if distribution is not None:
        return (VERSION_3,) if is_before_4(ENGINES[distribution]) else VERSIONS
    if signs is None:
        return VERSIONS
    if signs.format:
        return (VERSION_3,) if signs.format == "3" else VERSIONS
    if signs.is_new:
        return VERSIONS
    return (VERSION_3,) if signs.old else ()
