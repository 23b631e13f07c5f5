"""Trees of XML that programs around it create, where no project file names these programs: C++, as far as a string
tells, and servers that parameter files describe.

One invariant: C++ and parameter files are read only if XML has several trees and does not name the main one.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable
from typing import Final

from btq_lang.catalog.name_kinds import Kind
from btq_lang.projects.tree_servers import tree_programs
from btq_lang.util.record import replace
from btq_lang.workspace.file import CPP_SUFFIXES, YAML_SUFFIXES
from btq_lang.workspace.loader import collect, read
from btq_lang.workspace.workspace import Workspace


def with_created_trees(workspace: Workspace, paths: Iterable[str], pools: Collection[str]) -> Workspace:
    """A workspace whose project knows what programs in some folders create: the trees of some files that their C++
    names, if it creates trees by name, and the folders from which a server creates any tree."""
    project = workspace.project
    asked_for = {
        name
        for path in paths
        if path in workspace.foreign and workspace.main_tree(path) is None
        for name in workspace.files[path].names.by_kind[Kind.TREE]
    }
    if not asked_for:
        return workspace

    def texts(suffixes: tuple[str, ...]) -> list[str]:
        return [read(path)[0] or "" for pool in pools for path in collect([pool], project, suffixes)[0]]

    cpp = texts(CPP_SUFFIXES)
    strings = {name for text in cpp for name in _STRING(text)} if any(map(_CREATES, cpp)) else ()
    servers = tree_programs(texts(YAML_SUFFIXES), next(iter(pools))).servers
    served = tuple([folder for server in servers for folder in server.folders])
    return workspace.with_project(replace(project, created=frozenset(asked_for.intersection(strings)), served=served))


_CREATES: Final = re.compile(r"\bcreateTree\s*\(").search
_STRING: Final = re.compile(r'"([^"\\\n]+)"').findall
