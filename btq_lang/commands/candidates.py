"""The missions that logs may belong to."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence

from btq_lang.btcpp.as_built import as_built
from btq_lang.btcpp.export import xml_name
from btq_lang.btcpp.side_file import side_path, xml_path
from btq_lang.commands.disk import Disk
from btq_lang.commands.files import Files
from btq_lang.evidence.identity import Candidate
from btq_lang.evidence.readers.side import SideFile, side_file_at, side_files_beside
from btq_lang.workspace.loader import find_project


def candidates(requested: Sequence[str], logs: Sequence[str], problems: list[str]) -> Sequence[Candidate]:
    """The missions that logs may belong to: the requested ones, else those of side files beside the logs and of this
    folder's project.
    """
    sides = {side.mission: side for side in side_files_beside(logs)}
    there = [mission for mission in sides if os.path.isfile(mission)]
    found = (
        [] if requested else [each for side in sides.values() if side.mission not in there for each in _restored(side)]
    )
    groups, unreadable = Files().groups(requested or [*there, find_project(".").project.root])
    problems += map(str, unreadable)
    for group in groups:
        for path in group.given:
            side = sides.get(path) or side_file_at(side_path(xml_name(path)))
            if path.endswith(".xml") and side is not None and (built := [*_restored(side)]):
                found += built
            elif requested or path not in group.workspace.included_files:
                nodes = side.nodes if side is not None and side.mission == path else None
                found.append(Candidate(group.workspace, path, _name(path), nodes))
    if not found and not problems:
        problems.append("no mission found; name one with --mission FILE, a .btq file or XML")
    return found


def _restored(side: SideFile) -> Iterator[Candidate]:
    """The mission as built, if only the XML and the side file are available."""
    built = as_built(xml_path(side.path), Disk())
    if built is not None:
        yield Candidate(built.workspace, built.path, _name(side.mission), side.nodes)


def _name(path: str) -> str:
    return os.path.splitext(os.path.basename(path))[0]
