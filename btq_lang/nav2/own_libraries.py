"""Libraries that a team builds, by its CMake files: which C++ each is made of, and so which nodes it registers.

One invariant: a command that is not understood adds nothing, so a library may have more nodes than are known here.
"""

from __future__ import annotations

import os.path
import re
from collections.abc import Iterable, Iterator
from typing import Final

from btq_lang.util.record import Record
from btq_lang.workspace.file import CPP_SUFFIXES
from btq_lang.workspace.loader import matching, read
from btq_lang.workspace.workspace import Workspace


class OwnLibraries(Record):
    """The libraries whose sources the project names.

    Attributes:
        of_node: by the ID of a node, the libraries that register it.
        whole: those of which every source was read.
    """

    of_node: dict[str, frozenset[str]]
    whole: frozenset[str]


def own_libraries(workspaces: Iterable[Workspace]) -> OwnLibraries:
    """The libraries that are made of the C++ in some workspaces."""
    files = {path: file for workspace in workspaces for path, file in workspace.files.items() if file.is_cpp}
    targets: dict[str, frozenset[str]] = {}
    for folder in {above for path in files for above in _folders(path)}:
        targets.update(_targets(folder))
    of_node: dict[str, set[str]] = {}
    for library, sources in targets.items():
        for path in sources & files.keys():
            for node in files[path].cpp_nodes:
                of_node.setdefault(node, set()).add(library)
    whole = frozenset(library for library, sources in targets.items() if sources and sources <= files.keys())
    return OwnLibraries({node: frozenset(libraries) for node, libraries in of_node.items()}, whole)


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
    for command, given in _COMMAND.findall(text):
        words = [each for word in _WORD.findall(given) for each in expanded(word.strip('"'))]
        match command.lower(), words:
            case "project", [name, *_]:
                values["PROJECT_NAME"] = [name]
            case "set", [name, *value]:
                values[name] = value
            case "list", ["APPEND", name, *value]:
                values[name] = [*values.get(name, []), *value]
            case "file", ["GLOB" | "GLOB_RECURSE" as kind, name, *found]:
                below = "**/" if kind == "GLOB_RECURSE" else ""
                values[name] = [path for each in found for path in _matching(folder, each, below)]
            case "add_library", [_, "STATIC" | "OBJECT" | "INTERFACE" | "IMPORTED" | "ALIAS", *_]:
                continue  # no program loads these
            case "target_sources", [name, *_] if name not in targets:
                continue
            case (("add_library" | "ament_auto_add_library" | "target_sources"), [name, *sources]):
                paths = (os.path.normpath(os.path.join(folder, each)) for each in sources if _is_source(each))
                targets.setdefault(name, set()).update(path.replace(os.sep, "/") for path in paths)
    return {name: frozenset(sources) for name, sources in targets.items()}


def _matching(folder: str, pattern: str, below: str) -> tuple[str, ...]:
    """The files that a pattern of CMake matches, which in folders below counts for the last part alone."""
    inside = os.path.relpath(os.path.join(folder, pattern), folder).replace(os.sep, "/")
    above, _, last = inside.rpartition("/")
    return matching(folder, f"{above}{'/' * bool(above)}{below}{last}")


def _is_source(word: str) -> bool:
    """Whether it is a C++ source, or something whose sources are not known: a library with that is not whole."""
    return "$" in word or (word.endswith(CPP_SUFFIXES) and not word.endswith((".h", ".hh", ".hpp", ".hxx")))


_COMMENT: Final = re.compile("#.*")
_COMMAND: Final = re.compile(r"\b(\w+)\s*\(([^()]*)\)")
_WORD: Final = re.compile(r'"[^"]*"|[^\s"]+')
_VARIABLE: Final = re.compile(r"\$\{(\w+)\}")
