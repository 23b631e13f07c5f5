"""The programs of behaviortree_ros2 in parameter files of ROS 2: a TreeExecutionServer registers the XML of whole
folders, and creates the tree that a goal names by its ID.

One invariant: a file that is not YAML, or cannot be read, describes no program.
"""

from __future__ import annotations

import os.path
from collections.abc import Iterable, Iterator
from functools import cache, partial
from typing import Final

from btq_lang.nav2.parameters import nodes_with_parameters
from btq_lang.nav2.yaml_reader import YamlMissing, YamlProblem, YamlValue, read_yaml
from btq_lang.util.record import Record
from btq_lang.workspace.loader import package_folder


class TreeServer(Record):
    """A server.

    Attributes:
        folders: those that are here of which it registers the XML.
        packages: the folders of packages whose libraries it loads, likewise.
    """

    folders: tuple[str, ...]
    packages: tuple[str, ...]


class TreePrograms(Record):
    """Servers, and the trees that clients name for goals."""

    servers: tuple[TreeServer, ...] = ()
    targets: tuple[str, ...] = ()


def tree_programs(texts: Iterable[str], root: str) -> TreePrograms:
    """The programs that parameter files describe; root: a folder in the workspace with the packages."""
    find = cache(partial(package_folder, start=root))  # each time, it looks through the workspace
    servers: list[TreeServer] = []
    targets: list[str] = []
    for parameters in _parameters(texts):
        trees = [name.partition("/") for name in _texts(parameters.get(_TREES))]
        places = [f"{package}/{below}" for name, _, below in trees if (package := find(name)) is not None]
        libraries = [name.partition("/")[0] for name in _texts(parameters.get("plugins"))]
        packages = tuple([package for package in map(find, libraries) if package is not None])
        if folders := tuple(filter(os.path.isdir, places)):
            servers.append(TreeServer(folders, packages))
        target = parameters.get(_TARGET)
        targets += [target.text] if target is not None and target.text else []
    return TreePrograms(tuple(servers), tuple(targets))


def _parameters(texts: Iterable[str]) -> Iterator[YamlValue]:
    """The parameters of each node in the files that may describe a program."""
    for text in texts:
        if _TREES in text or _TARGET in text:
            try:
                yield from (parameters for _, parameters in nodes_with_parameters(read_yaml(text)))
            except (YamlMissing, YamlProblem):
                continue


def _texts(value: YamlValue | None) -> list[str]:
    return [item.text for item in value.items if item.text] if value is not None else []


_TREES: Final = "behavior_trees"
_TARGET: Final = "target_tree"
