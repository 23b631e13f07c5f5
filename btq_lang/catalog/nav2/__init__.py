"""The nodes of Nav2 by distribution of ROS 2: files with models, which `tools/nav2_nodes.py` writes.

nodes       what control nodes, decorators and some leaves do; `ports`, which each node has in any distribution
creation    what nodes need when they are created
changes     what a release changes for trees of an earlier one
navigator   the entries and parameters of bt_navigator; `servers`, the parameters of other nodes
libraries   the libraries that register the nodes

One invariant: only names and paths; a file is read when a project names it.
"""

from __future__ import annotations

import os.path
from collections.abc import Container, Mapping
from typing import Final

DISTRIBUTIONS: Final = ("humble", "iron", "jazzy", "kilted", "lyrical")
# The version of the engine in each.
ENGINES: Final[Mapping[str, str]] = {
    "humble": "3.8.7",
    "iron": "3.8.7",
    "jazzy": "4.9.1",
    "kilted": "4.9",
    "lyrical": "4.10",
}

_FOLDER: Final = os.path.dirname(os.path.abspath(__file__)).replace(os.sep, "/")
# The path of the file of each distribution, and the same by the name that a project uses.
FILES: Final[Mapping[str, str]] = {each: f"{_FOLDER}/{each}.btq" for each in DISTRIBUTIONS}
PACKAGED: Final[Mapping[str, str]] = {f"nav2-{each}": path for each, path in FILES.items()}
# The packages of Nav2 in which its nodes are.
PACKAGES: Final = ("nav2_behavior_tree", "opennav_docking_bt")
# The port of nodes that send goals to bt_navigator: the tree that it runs for one, until Kilted the path of a file.
TREE_OF_GOAL: Final = "behavior_tree"


def ports_of(node: str) -> frozenset[str] | None:
    """The ports that a node of Nav2 has in any distribution; None if Nav2 has no such node."""
    from btq_lang.catalog.nav2.ports import PORTS  # few projects need it

    return frozenset(PORTS[node].split()) if node in PORTS else None


def distribution_among(paths: Container[str]) -> str | None:
    """The distribution whose file is among some."""
    return next((name for name, path in FILES.items() if path in paths), None)


def assumed_distribution(is_old: bool) -> str:
    """The distribution whose nodes are meant where none is named; `is_old`: the engine is that of version 3."""
    return "humble" if is_old else "jazzy"
