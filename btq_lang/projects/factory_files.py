"""Which files the factories of a project register: the patterns of the project file, and the projects of Groot2."""

from __future__ import annotations

import os
from collections.abc import Callable, Container, Iterable, Iterator
from typing import TYPE_CHECKING, Final, Protocol

from btq_lang.btcpp.recognition import included_in
from btq_lang.catalog.nav2 import PACKAGED
from btq_lang.util.record import replace
from btq_lang.workspace.factories import Factory
from btq_lang.workspace.file import CPP_SUFFIXES, GROOT_SUFFIX, SUFFIXES, File
from btq_lang.workspace.loader import absolute, matching, package_folder, read, without_tests

if TYPE_CHECKING:

    class Known(Protocol):
        """Knows which XML files are missions."""

        def is_mission(self, path: str) -> bool:
            """Whether an XML file is the engine's."""

        def source_of(self, path: str) -> str | None:
            """The mission that an XML file was built of, if it exists."""


PACKAGE: Final = "package://"


def resolved(
    factory: Factory, root: str, xml: Known, find: Callable[[str, str], tuple[str, ...]] = matching
) -> Factory:
    """A factory with its files, and with the patterns that match none, as their package may not be here.

    XML that was built of an existing mission counts as that mission; XML that is not the engine's is left out.
    """
    lost: dict[str, None] = {}

    def matched(pattern: str) -> tuple[str, ...]:
        paths = (cpp_in_folder if pattern.endswith(CPP_SUFFIXES) else in_folder)(pattern, root, find)
        if not paths:
            lost[pattern] = None
        return paths

    def files(patterns: tuple[str, ...]) -> Iterator[str]:
        for pattern in patterns:
            if pattern in PACKAGED:
                yield PACKAGED[pattern]
                continue
            for path in matched(pattern) if not pattern.endswith(CPP_SUFFIXES) else ():
                if path.endswith(SUFFIXES):
                    if not _has_only_scenarios(path):
                        yield path
                elif (source := xml.source_of(path)) is not None or xml.is_mission(path):
                    yield source or path

    loaded = tuple(dict.fromkeys(files(factory.load)))
    nodes = tuple(path for path in dict.fromkeys(files(factory.nodes)) if path not in loaded)
    cpp = dict.fromkeys(
        path for pattern in factory.nodes if pattern.endswith(CPP_SUFFIXES) for path in matched(pattern)
    )
    return replace(factory, files=loaded, node_files=nodes, cpp_files=tuple(cpp), lost=tuple(lost))


def _has_only_scenarios(path: str) -> bool:
    """Whether a mission is a file of scenarios, which no program loads."""
    return File(path, read(path)[0] or "").has_only_scenarios


def in_folder(pattern: str, root: str, find: Callable[[str, str], tuple[str, ...]]) -> tuple[str, ...]:
    """The files that a pattern matches below a folder, or in a package."""
    folder, inside = _place(pattern, root)
    return find(folder, inside) if folder is not None else ()


def cpp_in_folder(pattern: str, root: str, find: Callable[[str, str], tuple[str, ...]]) -> tuple[str, ...]:
    """As `in_folder`, for C++: `**` leaves out folders of tests, and those that are left out everywhere."""
    paths = in_folder(pattern, root, find)
    above = _place(pattern, root)[0]
    return without_tests(paths, above, pattern.split("/")) if "**" in pattern and above is not None else paths


def groot_projects(pools: Iterable[Iterable[str]], wanted: Container[str]) -> Iterator[Factory]:
    """The projects of Groot2 in some pools that register one of the wanted files, or are one, as factories."""
    for path in dict.fromkeys(path for pool in pools for path in pool if path.endswith(GROOT_SUFFIX)):
        folder = os.path.dirname(path)
        included = (absolute(os.path.join(folder, name)) for name in included_in(read(path)[0] or ""))
        if path in wanted or any(each in wanted for each in included):
            yield Factory(os.path.basename(path), files=(path,))


def _place(pattern: str, root: str) -> tuple[str | None, str]:
    """The folder that a pattern is relative to, None if it is in a package that is not here, and the rest of it."""
    if not pattern.startswith(PACKAGE):
        return root, pattern
    package, _, inside = pattern.removeprefix(PACKAGE).partition("/")
    return package_folder(package, root), inside
