"""The mission that a built XML file was made of, as the side file beside it holds it, for whoever compares.

One invariant: nothing is written, and what the XML says now counts where somebody has changed it.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator

from btq_lang.btcpp.importing import import_xml
from btq_lang.btcpp.marks import is_generated
from btq_lang.btcpp.restoring import restored
from btq_lang.btcpp.side_file import side_path
from btq_lang.commands.files import Files, Group
from btq_lang.loader import absolute, find_project, read, shown
from btq_lang.parser import parse
from btq_lang.project import include_candidates
from btq_lang.record import Record
from btq_lang.syntax import Include


def as_built(path: str) -> tuple[Group, str, Callable[[str], str]] | None:
    """The mission of an XML file; None: there is no side file, or it is of something else.

    Returns:
        The mission with all that it includes, its path in there, where no file needs to be, and how its paths are
        shown: those that stand in the side file behind that one's.
    """
    side = side_path(path)
    if path == side or not path.endswith(".xml") or not os.path.isfile(side):
        return None
    made = _made(path)
    if made is None or made.source == path:
        return None
    target = f"{os.path.splitext(path)[0]}.btq"
    files = Files()
    sources: dict[str, str] = {}
    waiting = [(made, path, target)]
    for made, xml, place in waiting:
        folder = os.path.dirname(xml)
        for name, text in (
            (place, made.text),
            *((absolute(os.path.join(folder, each)), it) for each, it in made.others),
        ):
            files.overlay[name] = text
            sources[name] = made.source
        for built, included in _missing(made, xml, place):
            below = _made(built) if included not in files.overlay else None
            if below is not None:
                waiting.append((below, built, included))
    groups, problems = files.groups(files.overlay)
    group = next((group for group in groups if target in group.given), None)
    if problems or group is None:
        return None
    return group, target, lambda each: f"{shown(sources[each])}:{shown(each)}" if each in sources else shown(each)


class _Made(Record):
    """What an XML file was made of.

    Attributes:
        text: the mission.
        others: of a bundle, the files it includes: their paths, seen from the mission, and texts.
        includes: what the XML includes, in order.
        source: the file that says all that: the side file, or the XML.
    """

    text: str
    others: tuple[tuple[str, str], ...]
    includes: tuple[str | None, ...]
    source: str


def _made(path: str) -> _Made | None:
    """What an XML file was made of, by its side file or, where it has nothing to say beyond its XML, by that."""
    side = side_path(path)
    xml, _ = read(path)
    said = read(side)[0] if os.path.isfile(side) else None
    if xml is None:
        return None
    done = import_xml(xml, for_people=False)
    if not done.is_complete:
        return None
    includes = tuple(_includes(done.text))
    mission = restored(xml, done.text, said) if said is not None else None
    if mission is not None:
        return _Made(mission.text, mission.others, includes, side)
    return _Made(done.text if is_generated(xml) else xml, (), includes, path)


def _missing(made: _Made, xml: str, place: str) -> Iterator[tuple[str, str]]:
    """The XML of what a mission includes and what is not there, built into another folder, and where it would be."""
    includes = tuple(_includes(made.text)) if place.endswith(".btq") else ()
    if len(includes) != len(made.includes):
        return
    project = find_project(place).project
    for said, named in zip(includes, made.includes, strict=True):
        if said is None or named is None:
            continue
        places = include_candidates(project, place, said)
        built = absolute(os.path.join(os.path.dirname(xml), named))
        if not any(map(os.path.isfile, places)) and os.path.isfile(built):
            yield built, places[0]


def _includes(text: str) -> Iterator[str | None]:
    """The paths that a mission includes; None of a package's."""
    for entry in parse(text).entries:
        if isinstance(entry.item, Include):
            is_packaged = any(pair.key.text == "ros_pkg" for pair in entry.item.attributes)
            yield None if is_packaged or entry.item.path is None else entry.item.path.text
