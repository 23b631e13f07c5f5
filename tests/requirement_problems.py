"""What is wrong with the requirements that a file sees."""

from __future__ import annotations

from btq_lang.requirements.paths import Problem
from btq_lang.requirements.resolve import Requirements, problems_in


def problems_of(found: Requirements) -> list[Problem]:
    """What was not understood in any item, in the order of the files and of their text."""
    workspace = found.store.state
    files = [workspace.files[path] for path in workspace.scope(found.viewpoint).paths]
    items = [(file.path, facts) for file in files for facts in file.facts.values()]
    return [problem for item in items for problem in problems_in(found.store, found.viewpoint, *item)]
