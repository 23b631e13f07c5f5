"""Which files the factories of a project register: the patterns of the project file, resolved."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

from btq_lang.util.record import replace
from btq_lang.workspace.file import SUFFIXES
from btq_lang.workspace.loader import matching, package_folder

if TYPE_CHECKING:
    from btq_lang.commands.xml_below import XmlBelow
    from btq_lang.workspace.factories import Factory

PACKAGE: Final = "package://"


def resolved(factory: Factory, root: str, xml: XmlBelow) -> Factory:
    """A factory with its files, and with the patterns that match none, as their package may not be here.

    XML that was built of a mission that is there stands for that mission, and other XML than the engine's for nothing.

    Args:
        root: the folder that patterns are relative to.
    """
    lost: dict[str, None] = {}

    def files(patterns: tuple[str, ...]) -> Iterator[str]:
        for pattern in patterns:
            folder, inside = _place(pattern, root)
            found = matching(folder, inside) if folder is not None else ()
            if not found:
                lost[pattern] = None
            for path in found:
                if path.endswith(SUFFIXES):
                    yield path
                elif (source := xml.source_of(path)) is not None or xml.is_mission(path):
                    yield source or path

    loaded = tuple(dict.fromkeys(files(factory.load)))
    nodes = tuple(path for path in dict.fromkeys(files(factory.nodes)) if path not in loaded)
    return replace(factory, files=loaded, node_files=nodes, lost=tuple(lost))


def _place(pattern: str, root: str) -> tuple[str | None, str]:
    """The folder that a pattern is relative to, None if it is in a package that is not here, and the rest of it."""
    if not pattern.startswith(PACKAGE):
        return root, pattern
    package, _, inside = pattern.removeprefix(PACKAGE).partition("/")
    return package_folder(package, root), inside
