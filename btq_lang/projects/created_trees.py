"""Trees of XML that C++ around it creates, as far as a string tells, also where no project file names that C++.

One invariant: C++ is read only if XML has several trees and does not name the main one.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Final

from btq_lang.catalog.name_kinds import Kind
from btq_lang.workspace.config import Project
from btq_lang.workspace.file import CPP_SUFFIXES
from btq_lang.workspace.loader import collect, read
from btq_lang.workspace.workspace import Workspace


def created_trees(workspace: Workspace, paths: Iterable[str], pools: Iterable[str], project: Project) -> frozenset[str]:
    """The trees of some files that the C++ of some folders names, if it creates trees by name."""
    asked_for = {
        name
        for path in paths
        if path in workspace.foreign and workspace.main_tree(path) is None
        for name in workspace.files[path].names.by_kind[Kind.TREE]
    }
    if not asked_for:
        return frozenset()
    texts = [read(path)[0] or "" for pool in pools for path in collect([pool], project, CPP_SUFFIXES)[0]]
    strings = {name for text in texts for name in _STRING(text)} if any(map(_CREATES, texts)) else ()
    return frozenset(asked_for.intersection(strings))


_CREATES: Final = re.compile(r"\bcreateTree\s*\(").search
_STRING: Final = re.compile(r'"([^"\\\n]+)"').findall
