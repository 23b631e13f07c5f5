"""The mission that a built XML file was made of, as the side file beside it holds it, for whoever compares.

One invariant: nothing is written, and what the XML says now counts where somebody has changed it.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Protocol

from btq_lang.btcpp.by_hand import ByHand
from btq_lang.btcpp.importing import import_xml
from btq_lang.btcpp.marks import is_generated
from btq_lang.btcpp.restoring import restored
from btq_lang.btcpp.side_file import side_path
from btq_lang.parser import parse
from btq_lang.syntax.tree import Include
from btq_lang.util.record import Record
from btq_lang.workspace.config import Project, include_candidates
from btq_lang.workspace.file import File
from btq_lang.workspace.loader import absolute, shown
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:

    class Source(Protocol):
        """Where files come from: the disk, or a revision."""

        def is_file(self, path: str) -> bool:
            """Whether there is such a file."""

        def text(self, path: str) -> str | None:
            """What it says; None where it cannot be read."""

        def project(self, path: str) -> Project:
            """The project of a file."""

        def workspace(self, path: str, known: dict[str, str]) -> Workspace | None:
            """A file with all that it includes, where the known texts count instead of those there."""


class Built(Record):
    """The mission of an XML file.

    Attributes:
        workspace: the mission with all that it includes, and the XML that somebody has changed by hand.
        path: of the mission in there, where no file needs to be.
        shown: how its paths are shown: those that stand in the side file behind that one's.
        by_hand: what was changed in what enforces, in which XML.
    """

    workspace: Workspace
    path: str
    shown: Callable[[str], str]
    by_hand: tuple[tuple[str, ByHand], ...]


def as_built(path: str, source: Source, called: Callable[[str], str] = shown) -> Built | None:
    """The mission of an XML file; None: there is no side file, or it is of something else.

    Args:
        path: of the XML.
        source: where it and its side file are read.
        called: how people call a file of that.
    """
    side = side_path(path)
    if path == side or not path.endswith(".xml") or not source.is_file(side):
        return None
    made = _made(path, source)
    if made is None or made.source == path:
        return None
    target = f"{os.path.splitext(path)[0]}.btq"
    known: dict[str, str] = {}
    sources: dict[str, str] = {}
    by_hand: list[tuple[str, ByHand]] = []
    waiting = [(made, path, target)]
    for made, xml, place in waiting:
        folder = os.path.dirname(xml)
        by_hand += ((xml, each) for each in made.by_hand)
        for name, text in (
            (place, made.text),
            *((absolute(os.path.join(folder, each)), it) for each, it in made.others),
        ):
            known[name] = text
            sources[name] = made.source
        for built, included in _missing(made, xml, place, source):
            below = _made(built, source) if included not in known else None
            if below is not None:
                waiting.append((below, built, included))
    workspace = source.workspace(target, known)
    if workspace is None:
        return None
    changed = {xml: File(xml, source.text(xml) or "") for xml, _ in by_hand}
    return Built(
        Workspace({**changed, **workspace.files}, workspace.project),
        target,
        lambda each: f"{called(sources[each])}:{shown(each)}" if each in sources else called(each),
        tuple(by_hand),
    )


class _Made(Record):
    """What an XML file was made of.

    Attributes:
        text: the mission.
        others: of a bundle, the files it includes: their paths, seen from the mission, and texts.
        includes: what the XML includes, in order.
        source: the file that says all that: the side file, or the XML.
        by_hand: what was changed in what enforces.
    """

    text: str
    others: tuple[tuple[str, str], ...]
    includes: tuple[str | None, ...]
    source: str
    by_hand: tuple[ByHand, ...] = ()


def _made(path: str, source: Source) -> _Made | None:
    """What an XML file was made of, by its side file or, where it has nothing to say beyond its XML, by that."""
    side = side_path(path)
    xml = source.text(path)
    said = source.text(side) if source.is_file(side) else None
    if xml is None:
        return None
    done = import_xml(xml, for_people=False)
    if not done.is_complete:
        return None
    includes = tuple(_includes(done.text))
    mission = restored(xml, done.text, said) if said is not None else None
    if mission is not None:
        return _Made(mission.text, mission.others, includes, side, mission.by_hand)
    return _Made(done.text if is_generated(xml) else xml, (), includes, path)


def _missing(made: _Made, xml: str, place: str, source: Source) -> Iterator[tuple[str, str]]:
    """The XML of what a mission includes and what is not there, built into another folder, and where it would be."""
    includes = tuple(_includes(made.text)) if place.endswith(".btq") else ()
    if len(includes) != len(made.includes):
        return
    project = source.project(place)
    for said, named in zip(includes, made.includes, strict=True):
        if said is None or named is None:
            continue
        places = include_candidates(project, place, said)
        built = absolute(os.path.join(os.path.dirname(xml), named))
        if not any(map(source.is_file, places)) and source.is_file(built):
            yield built, places[0]


def _includes(text: str) -> Iterator[str | None]:
    """The paths that a mission includes; None of a package's."""
    for entry in parse(text).entries:
        if isinstance(entry.item, Include):
            is_packaged = any(pair.key.text == "ros_pkg" for pair in entry.item.attributes)
            yield None if is_packaged or entry.item.path is None else entry.item.path.text
