"""What earlier builds have left: XML made from missions that are gone, which a robot would still load."""

from __future__ import annotations

import glob
import os
from collections.abc import Iterable

from btq_lang.btcpp.marks import is_generated
from btq_lang.btcpp.side_file import is_side_file, side_path
from btq_lang.workspace.file import SUFFIXES
from btq_lang.workspace.loader import read


def left_over(folders: Iterable[str]) -> list[str]:
    """The files that a build has made, in some folders, and beside which their mission stands no more.

    Only the folders themselves are looked into; where `-o` writes to, no mission stands beside what it made.
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
