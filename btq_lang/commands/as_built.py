"""The mission that a built XML file was made of, as the side file beside it holds it, for whoever compares.

One invariant: nothing is written, and what the XML says now counts where somebody has changed it.
"""

from __future__ import annotations

import os
from collections.abc import Callable

from btq_lang.btcpp.importing import import_xml
from btq_lang.btcpp.restoring import restored
from btq_lang.btcpp.side_file import side_path
from btq_lang.commands.files import Files, Group
from btq_lang.loader import absolute, read, shown


def as_built(path: str) -> tuple[Group, str, Callable[[str], str]] | None:
    """The mission of an XML file; None: there is no side file, or it is of something else.

    Returns:
        The mission with all that it includes, its path in there, where no file needs to be, and how its paths are
        shown: those that stand in the side file behind that one's.
    """
    side = side_path(path)
    if path == side or not path.endswith(".xml") or not os.path.isfile(side):
        return None
    (xml, _), (said, _) = read(path), read(side)
    if xml is None or said is None:
        return None
    done = import_xml(xml, for_people=False)
    mission = restored(xml, done.text, said) if done.is_complete else None
    if mission is None:
        return None
    target = f"{os.path.splitext(path)[0]}.btq"
    files = Files()
    files.overlay[target] = mission.text
    for name, text in mission.others:
        files.overlay[absolute(os.path.join(os.path.dirname(path), name))] = text
    groups, problems = files.groups(files.overlay)
    group = next((group for group in groups if target in group.given), None)
    if problems or group is None:
        return None
    return group, target, lambda each: f"{shown(side)}:{shown(each)}" if each in files.overlay else shown(each)
