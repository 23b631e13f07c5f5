"""Finds stale output of earlier builds: XML of missions that no longer exist, which a robot would still load."""

from __future__ import annotations

import glob
import os
from collections.abc import Iterable

from btq_lang.btcpp.marks import is_generated
from btq_lang.btcpp.side_file import is_side_file, side_path
from btq_lang.workspace.file import SUFFIXES
from btq_lang.workspace.loader import read


def stale_outputs(folders: Iterable[str]) -> list[str]:
    """The files in some folders that a build made and whose mission is no longer beside them.

    Subfolders are not searched, nor are targets of `-o`, which have no missions beside them.
    """
    found: list[str] = []
    for folder in sorted(set(folders)):
        for xml in sorted(glob.glob(os.path.join(glob.escape(folder), "*.xml"))):
            stem = os.path.splitext(xml)[0]
            if any(os.path.exists(stem + suffix) for suffix in SUFFIXES) or not is_generated(read(xml)[0] or ""):
                continue
            found.append(xml)
            side = side_path(xml)
            if os.path.exists(side) and is_side_file(read(side)[0] or ""):
                found.append(side)
    return found
