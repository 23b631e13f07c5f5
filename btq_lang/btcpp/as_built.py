"""The mission that a built XML file was made of, restored from its side file, so that it can be compared.

One invariant: nothing is written, and where the XML was edited after the build, the edited XML counts.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Protocol

from btq_lang.btcpp.importing import import_xml
from btq_lang.btcpp.manual_edits import ManualEdit
from btq_lang.btcpp.marks import is_generated
from btq_lang.btcpp.restoring import Restored, restored
from btq_lang.btcpp.side_file import side_path
from btq_lang.parser import parse
from btq_lang.syntax.tree import Include
from btq_lang.util.record import Record
from btq_lang.workspace.config import include_candidates
from btq_lang.workspace.file import File, is_of_package
from btq_lang.workspace.loader import absolute, find_project, shown
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:

    class Source(Protocol):
        """Where files are read: the disk, or a revision."""

        def is_file(self, path: str) -> bool:
            """Whether the file exists."""

        def text(self, path: str) -> str | None:
            """The text of a file; None if it cannot be read."""

        def workspace(self, path: str, known: dict[str, str]) -> Workspace | None:
            """A file with all that it includes; the known texts replace those of the source."""


class BuiltMission(Record):
    """The mission of an XML file.

    Attributes:
        workspace: the mission with all that it includes, and the XML files that were edited by hand.
        path: of the mission in the workspace; the file need not exist.
        shown: its paths as they are shown: that of the side file, then those recorded in it.
        manual_edits: the manual edits of generated nodes, with their XML file.
    """

    workspace: Workspace
    path: str
    shown: Callable[[str], str]
    manual_edits: tuple[tuple[str, ManualEdit], ...]


def as_built(path: str, source: Source, called: Callable[[str], str] = shown) -> BuiltMission | None:
    """The mission of an XML file; None if it has no side file, or one that belongs to another file; `called` gives the
    name under which a file of the source is shown."""
    side = side_path(path)
    if path == side or not path.endswith(".xml") or not source.is_file(side):
        return None
    origin = _origin_of(path, source)
    if origin is None or origin[-1] == path:
        return None
    target = f"{os.path.splitext(path)[0]}.btq"
    texts: dict[str, str] = {}
    sources: dict[str, str] = {}
    manual_edits: list[tuple[str, ManualEdit]] = []
    waiting = [(origin, path, target)]
    for (mission, includes, recorded_in), xml, place in waiting:
        folder = os.path.dirname(xml)
        manual_edits += ((xml, each) for each in mission.manual_edits)
        others = {absolute(os.path.join(folder, each)): text for each, text in mission.others}
        texts |= {place: mission.text, **others}
        sources |= dict.fromkeys((place, *others), recorded_in)
        for built, included in _missing(mission.text, includes, xml, place, source):
            below = _origin_of(built, source) if included not in texts else None
            if below is not None:
                waiting.append((below, built, included))
    workspace = source.workspace(target, texts)
    if workspace is None:
        return None
    changed = {xml: File(xml, source.text(xml) or "") for xml, _ in manual_edits}
    return BuiltMission(
        Workspace({**changed, **workspace.files}, workspace.project),
        target,
        lambda each: f"{called(sources[each])}:{shown(each)}" if each in sources else called(each),
        tuple(manual_edits),
    )


def _origin_of(path: str, source: Source) -> tuple[Restored, tuple[str | None, ...], str] | None:
    """What an XML file was made of, the paths that it includes, and the file that says this: its side file or, if it
    needs none, the XML itself."""
    side = side_path(path)
    xml = source.text(path)
    side_text = source.text(side) if source.is_file(side) else None
    if xml is None:
        return None
    imported = import_xml(xml, for_people=False)
    if not imported.is_complete:
        return None
    includes = tuple(_includes(imported.text))
    mission = restored(xml, imported.text, side_text) if side_text is not None else None
    if mission is not None:
        return mission, includes, side
    return Restored(imported.text if is_generated(xml) else xml, True, path), includes, path


def _missing(
    text: str, of_xml: tuple[str | None, ...], xml: str, place: str, source: Source
) -> Iterator[tuple[str, str]]:
    """The included XML files that are missing because they were built elsewhere, with their expected paths."""
    includes = tuple(_includes(text)) if place.endswith(".btq") else ()
    if len(includes) != len(of_xml):
        return
    project = find_project(place).project
    for source_name, xml_name in zip(includes, of_xml, strict=True):
        if source_name is None or xml_name is None:
            continue
        places = include_candidates(project, place, source_name)
        built = absolute(os.path.join(os.path.dirname(xml), xml_name))
        if not any(map(source.is_file, places)) and source.is_file(built):
            yield built, places[0]


def _includes(text: str) -> Iterator[str | None]:
    """The paths that a mission includes; None for a file of a package."""
    for entry in parse(text).entries:
        if isinstance(entry.item, Include):
            path = entry.item.path
            yield None if path is None or is_of_package(entry.item) else path.text
