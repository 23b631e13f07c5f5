"""Files that a command line of `btq check` names, and that are not missions: project files, and what is not checked."""

from __future__ import annotations

import os
from collections.abc import Iterable

from btq_lang.workspace.file import SIDE_SUFFIX, SUFFIXES, XML_SUFFIXES, YAML_SUFFIXES, is_xml
from btq_lang.workspace.loader import LoadProblem, absolute, find_project, is_project_file, read

CHECKED = (*SUFFIXES, *XML_SUFFIXES, *YAML_SUFFIXES)


def sorted_out(paths: Iterable[str]) -> tuple[tuple[str, ...], tuple[LoadProblem, ...]]:
    """The project files among some paths, and why others are not checked; the rest are missions."""
    named = tuple(map(absolute, paths))
    reasons = ((path, _reason(path)) for path in named)
    problems = tuple(LoadProblem(path, reason) for path, reason in reasons if reason is not None)
    refused = {each.path for each in problems}
    return tuple(path for path in named if is_project_file(path) and path not in refused), problems


def _reason(path: str) -> str | None:
    """Why a file is not checked, if it is neither a project file nor a mission."""
    text, problem = read(path)
    if text is None or is_xml(path, text):
        return problem.message if problem is not None else None
    if is_project_file(path):
        counts = find_project(path).path
        if counts == path:
            return None
        is_beside = counts is not None and os.path.dirname(counts) == os.path.dirname(path)
        return (
            "is not read, because btq.toml beside it is" if is_beside else "has no [tool.btq], where btq reads settings"
        )
    if path.endswith(SIDE_SUFFIX):
        return f"is what a build writes; check {os.path.basename(path).removesuffix(SIDE_SUFFIX)}.xml beside it"
    return f"cannot be checked; expected a folder, btq.toml, or a file that ends in {', '.join(CHECKED)}"
