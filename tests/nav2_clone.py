"""A clone of navigation2 that somebody has, and how many nodes and ports were counted in it by hand."""

from __future__ import annotations

import os
from functools import cache
from pathlib import Path

import pytest
from nav2_sources import PALETTE, sources

from btq_lang.cpp.model import CppNodes
from btq_lang.cpp.nodes import read_nodes

COUNTS = {  # actions, conditions, controls, decorators, ports
    "humble": (32, 12, 3, 7, 170),
    "iron": (30, 16, 3, 7, 163),
    "jazzy": (38, 17, 3, 7, 234),
    "kilted": (41, 19, 3, 7, 274),
    "lyrical": (49, 19, 6, 7, 327),
}


def clone() -> Path:
    """The clone that BTQ_NAV2 names."""
    pytest.importorskip("tree_sitter_cpp", reason="the C++ grammar is not installed: pip install -e '.[cpp]'")
    folder = os.environ.get("BTQ_NAV2")
    if not folder:
        pytest.skip("no clone of navigation2: set BTQ_NAV2 to one that has the branches humble to lyrical")
    return Path(folder)


@cache
def files(branch: str) -> dict[str, str]:
    """The sources of the nodes of a branch, and Nav2's own list of them."""
    return sources(clone(), branch)


@cache
def read(branch: str) -> CppNodes:
    """The nodes of a branch."""
    return read_nodes({path: text for path, text in files(branch).items() if path != PALETTE})
