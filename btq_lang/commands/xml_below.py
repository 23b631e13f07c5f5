"""Which XML files below a folder are missions, of the many that are not.

One invariant: a file that somebody has written for the engine is among them, unless git ignores it.
"""

from __future__ import annotations

import os
from collections.abc import Hashable, Iterable

from btq_lang.btcpp.marks import is_built_of, is_generated
from btq_lang.btcpp.recognition import is_mission, may_be_mission
from btq_lang.commands.ignored import ignored
from btq_lang.workspace.file import SUFFIXES
from btq_lang.workspace.loader import absolute, head, read, stamp


class XmlBelow:
    """Looks at files, and remembers those that are not the engine's until they change."""

    def __init__(self) -> None:
        self._others: dict[str, Hashable] = {}

    def missions(self, top: str, paths: Iterable[str]) -> tuple[str, ...]:
        """All but the XML files that are not the engine's, that git ignores, or that were built from a .btq file that
        is there.

        Args:
            top: the folder that contains the paths; if git ignores it as a whole, it was named on purpose.
            paths: its files in this language and its XML.
        """
        paths = tuple(paths)
        sources = {os.path.basename(path) for path in paths if path.endswith(SUFFIXES)}
        xml = [path for path in paths if not path.endswith(SUFFIXES) and self._is_written(path, sources)]
        left_out = ignored((top, *xml), {}) if xml else frozenset()
        kept = {path for path in xml if top in left_out or path not in left_out}
        return tuple(path for path in paths if path in kept or path.endswith(SUFFIXES))

    def _is_written(self, path: str, sources: set[str]) -> bool:
        """Whether an XML file is a mission that no build has made of a file that is there."""
        now = stamp(path)
        if self._others.get(path) == now:
            return False
        text = read(path)[0] or "" if may_be_mission(head(path)) else ""
        if not is_mission(text):
            self._others[path] = now
            return False
        return not (is_built_of(text, sources) or _is_built(path, text))


def _is_built(path: str, text: str) -> bool:
    """Whether the side file of built XML names a mission that is there."""
    if not is_generated(text):
        return False
    import json

    from btq_lang.btcpp.side_file import is_side_file, side_path  # little XML is built

    side = read(side_path(path))[0] if os.path.isfile(side_path(path)) else None
    if side is None or not is_side_file(side):
        return False
    try:
        mission = json.loads(side)["mission"]["file"]
    except (ValueError, LookupError, TypeError):
        return False
    return isinstance(mission, str) and os.path.isfile(absolute(os.path.join(os.path.dirname(path), mission)))
