"""Patterns that name the XML files of a project as people would."""

from __future__ import annotations

import posixpath
from collections.abc import Collection, Iterator
from functools import cache

from btq_lang.commands.xml_below import XmlBelow
from btq_lang.workspace.loader import matching


def patterns(folder: str, paths: Collection[str], others: Collection[str]) -> Iterator[str]:
    """Patterns for some XML files, relative to a folder and without suffix.

    A folder that has several of the files, and no other XML of the engine, is one pattern; with the folders below it,
    if that is true of them too.

    Args:
        others: the rest of the engine's XML.
    """
    known = XmlBelow()
    taken: set[str] = set()

    @cache
    def matches_no_other(pattern: str) -> bool:
        found = {*matching(folder, f"{pattern}.xml")}.difference(paths)
        return found.isdisjoint(others) and not any(map(known.is_mission, found))

    for path in paths:
        if path in taken:
            continue
        for place in _folders(path, folder):
            start = "" if place == folder else f"{posixpath.relpath(place, folder)}/"
            below = {each for each in paths if each.startswith(f"{place}/")}
            here = {each for each in below if posixpath.dirname(each) == place}
            if start and here and len(here) < len(below) and matches_no_other(f"{start}**/*"):
                taken |= below
                yield f"{start}**/*"
                break
            if path in here and len(here) > 1 and matches_no_other(f"{start}*"):
                taken |= here
                yield f"{start}*"
                break
        else:
            yield posixpath.relpath(path, folder).removesuffix(".xml")


def _folders(path: str, top: str) -> Iterator[str]:
    """The folders that a file is in, from the top."""
    names = posixpath.dirname(posixpath.relpath(path, top)).split("/")
    yield top
    for number in range(1, len(names) + 1) if names != [""] else ():
        yield posixpath.join(top, *names[:number])
