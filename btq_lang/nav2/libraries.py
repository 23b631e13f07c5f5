"""Libraries of nodes that bt_navigator loads: which, what is wrong with those that parameters name, and which nodes the
libraries register that a team builds, by its CMake files.

One invariant: a command of CMake that is not understood adds nothing, so a library may have more nodes than are known
here.
"""

from __future__ import annotations

import os.path
import re
from collections.abc import Collection, Iterable, Iterator
from typing import Final

from btq_lang.catalog.nav2.libraries import LIBRARIES
from btq_lang.diagnostics.model import Diagnostic, Place, Related
from btq_lang.nav2.parameters import Parameters, ParameterText
from btq_lang.util.record import Record
from btq_lang.util.spelling import did_you_mean, distance, near
from btq_lang.util.text import Span
from btq_lang.workspace.file import CPP_SUFFIXES
from btq_lang.workspace.loader import matching, read
from btq_lang.workspace.workspace import Workspace

NAMES: Final = "plugin_lib_names"


class Libraries:
    """The libraries that bt_navigator loads in a distribution.

    Args:
        own: those that the team builds.

    Attributes:
        nodes: that the libraries with known nodes register.
        are_of_nav2: whether all libraries are Nav2's.
        are_all_known: whether the nodes of all libraries are known.
    """

    def __init__(self, parameters: Parameters, distribution: str, own: OwnLibraries) -> None:
        self._letter = distribution[0]
        self._shown = distribution.capitalize()
        self._named = parameters.texts(NAMES)
        usual = {name for name, (_, _, loaded) in LIBRARIES.items() if self._letter in loaded}
        self._built_in = usual if self._named is None or self._letter not in _REPLACING else set()
        loaded = self._built_in | {library.text for library in self._named or ()}
        of_nav2 = {node for name in loaded if self._exists(name) for node in LIBRARIES[name][0]}
        self._own = own.of_node
        self.nodes = of_nav2 | {node for node, libraries in own.of_node.items() if libraries & loaded}
        others = [library.text for library in self._named or () if not self._exists(library.text)]
        self.are_of_nav2 = not others
        self.are_all_known = own.whole.issuperset(others)

    def library_of(self, node: str) -> str | None:
        """The library that registers a node: one of Nav2 in this distribution, or one of the team."""
        of_nav2 = (name for name, (nodes, _, _) in LIBRARIES.items() if node in nodes and self._exists(name))
        return next(iter((*sorted(self._own.get(node, ())), *of_nav2)), None)

    def findings(self) -> Iterator[Diagnostic]:
        """What is wrong with the libraries that the parameters name."""
        named = self._named or ()
        yield from self._loaded_by_nav2([library for library in named if library.text in self._built_in])
        first: dict[str, Span] = {}
        for library in named:
            if library.text in first and library.text not in self._built_in:
                related = (Related(Place(first[library.text]), "first one"),)
                message = f"`{library.text}` is named twice, so its nodes are registered twice"
                yield Diagnostic("library-loaded-twice", library.span, message, related, (_REFUSED,))
            elif not self._exists(library.text) and (meant := self._suggestion(library.text)) is not None:
                message = f"Nav2 has no library `{library.text}` in {self._shown}{meant}"
                yield Diagnostic("unknown-library", library.span, message, notes=(_REFUSED,))
            first.setdefault(library.text, library.span)

    def _loaded_by_nav2(self, named: list[ParameterText]) -> Iterator[Diagnostic]:
        """The libraries that Nav2 loads without a name: one finding, as a file of another distribution names all."""
        if not named:
            return
        first, *others = named
        more = f" and {len(others)} more of the named libraries" if others else ""
        message = f"Nav2 loads `{first.text}`{more} by itself in {self._shown}, so nodes are registered twice"
        related = tuple(Related(Place(library.span), "this one too") for library in others[:_SHOWN])
        yield Diagnostic("library-loaded-twice", first.span, message, related, (_REFUSED,))

    def _suggestion(self, name: str) -> str | None:
        """The end of a message about a library that Nav2 lacks in this distribution; None if it is a team's own."""
        existing = [library for library in LIBRARIES if self._exists(library)]
        if name in LIBRARIES and name.startswith(_BESIDE):
            return None
        if name not in LIBRARIES:
            likely = [
                library for library in existing if distance(name, library, 1) <= 1
            ]  # own ones are often named alike
            return did_you_mean(likely) if likely else None
        successors = [library for node in LIBRARIES[name][0] if (library := self.library_of(node)) is not None]
        return did_you_mean(successors[:1] or near(name, existing, 1))

    def _exists(self, name: str) -> bool:
        return name in LIBRARIES and self._letter in LIBRARIES[name][1]


class OwnLibraries(Record):
    """The libraries whose sources the project names.

    Attributes:
        of_node: by the ID of a node, the libraries that register it.
        whole: the libraries whose sources were all read.
    """

    of_node: dict[str, frozenset[str]]
    whole: frozenset[str]


def own_libraries(workspaces: Iterable[Workspace]) -> OwnLibraries:
    """The libraries that are made of the C++ in some workspaces."""
    files = {path: file for workspace in workspaces for path, file in workspace.files.items() if file.is_cpp}
    targets = _targets_around(files)
    of_node: dict[str, set[str]] = {}
    for library, sources in targets.items():
        for path in sources & files.keys():
            for node in files[path].cpp_nodes:
                of_node.setdefault(node, set()).add(library)
    whole = frozenset(library for library, sources in targets.items() if sources and sources <= files.keys())
    return OwnLibraries({node: frozenset(libraries) for node, libraries in of_node.items()}, whole)


def unloaded_sources(paths: Iterable[str], loaded: Collection[str]) -> frozenset[str]:
    """The C++ sources that are only in libraries that are not loaded."""
    targets = _targets_around(paths)
    in_loaded = {
        path for library, sources in targets.items() if library in loaded or "$" in library for path in sources
    }
    in_any: set[str] = set().union(*targets.values())
    return frozenset(in_any.intersection(paths) - in_loaded)


def _targets_around(paths: Iterable[str]) -> dict[str, frozenset[str]]:
    """The libraries of the packages of some sources, each with its own sources."""
    targets: dict[str, frozenset[str]] = {}
    for folder in {above for path in paths for above in _folders(path)}:
        targets.update(_targets(folder))
    return targets


def _folders(path: str) -> Iterator[str]:
    """The folders around a source, up to that of its package."""
    while (path := os.path.dirname(path)) != os.path.dirname(path):
        yield path
        if os.path.isfile(f"{path}/package.xml"):
            return


def _targets(folder: str) -> dict[str, frozenset[str]]:
    """The libraries of the CMakeLists.txt in a folder, each with its C++ sources."""
    text = _COMMENT.sub("", read(f"{folder}/CMakeLists.txt")[0] or "")
    values: dict[str, list[str]] = {}
    targets: dict[str, set[str]] = {}

    def expanded(word: str) -> list[str]:
        if (whole := _VARIABLE.fullmatch(word)) is not None:
            return values.get(whole[1], [word])
        return [_VARIABLE.sub(lambda match: " ".join(values.get(match[1], [match[0]])), word)]

    values["CMAKE_CURRENT_SOURCE_DIR"] = values["PROJECT_SOURCE_DIR"] = [folder]
    for command, arguments in _COMMAND.findall(text):
        words = [part for word in _WORD.findall(arguments) for part in expanded(word.strip('"'))]
        match command.lower(), words:
            case "project", [name, *_]:
                values["PROJECT_NAME"] = [name]
            case "set", [name, *value]:
                values[name] = value
            case "list", ["APPEND", name, *value]:
                values[name] = [*values.get(name, []), *value]
            case "file", ["GLOB" | "GLOB_RECURSE" as kind, name, *patterns]:
                below = "**/" if kind == "GLOB_RECURSE" else ""
                values[name] = [path for pattern in patterns for path in _matching(folder, pattern, below)]
            case "add_library", [_, "STATIC" | "OBJECT" | "INTERFACE" | "IMPORTED" | "ALIAS", *_]:
                continue  # no program loads these
            case "target_sources", [name, *_] if name not in targets:
                continue
            case (("add_library" | "ament_auto_add_library" | "target_sources"), [name, *sources]):
                paths = (os.path.normpath(os.path.join(folder, source)) for source in sources if _is_source(source))
                targets.setdefault(name, set()).update(path.replace(os.sep, "/") for path in paths)
    return {name: frozenset(sources) for name, sources in targets.items()}


def _matching(folder: str, pattern: str, below: str) -> tuple[str, ...]:
    """The files that a pattern of CMake matches; in folders below, its last part alone counts."""
    inside = os.path.relpath(os.path.join(folder, pattern), folder).replace(os.sep, "/")
    above, _, last = inside.rpartition("/")
    return matching(folder, f"{above}{'/' * bool(above)}{below}{last}")


def _is_source(word: str) -> bool:
    """Whether a word is a C++ source, or a variable whose sources are unknown: a library with one is not whole."""
    return "$" in word or (word.endswith(CPP_SUFFIXES) and not word.endswith((".h", ".hh", ".hpp", ".hxx")))


_REPLACING: Final = "hi"  # the distributions in which the named libraries take the place of Nav2's own
_BESIDE: Final = "opennav_"  # packages that became a part of Nav2 after Humble
_SHOWN: Final = 3  # of many that are equally wrong
_REFUSED: Final = "bt_navigator refuses to configure"
_COMMENT: Final = re.compile("#.*")
_COMMAND: Final = re.compile(r"\b(\w+)\s*\(([^()]*)\)")
_WORD: Final = re.compile(r'"[^"]*"|[^\s"]+')
_VARIABLE: Final = re.compile(r"\$\{(\w+)\}")
