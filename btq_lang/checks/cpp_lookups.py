"""What checks look up in C++ that the project names: more inputs of the query store, as in `lookups`."""

from __future__ import annotations

import posixpath
import re

from btq_lang.catalog.name_kinds import Kind
from btq_lang.cpp.entries import SetEntries, set_entries
from btq_lang.workspace.inputs import of_name, of_viewpoint
from btq_lang.workspace.workspace import Workspace


@of_name
def ends_at_once(workspace: Workspace, viewpoint: str, kind: Kind, name: str) -> bool:
    """Whether the C++ of a node shows that it never returns RUNNING."""
    definitions = workspace.scope(viewpoint).all(kind, name)
    nodes = (workspace.files[definition.path].cpp_nodes.get(name) for definition in definitions)
    return any(node.at_once for node in nodes if node is not None)


@of_name
def keeps_its_result(workspace: Workspace, viewpoint: str, kind: Kind, name: str) -> bool:
    """Whether the C++ of a node shows that it starts only after a reset."""
    definitions = workspace.scope(viewpoint).all(kind, name)
    nodes = (workspace.files[definition.path].cpp_nodes.get(name) for definition in definitions)
    return any(node.keeps_result for node in nodes if node is not None)


@of_name
def without(workspace: Workspace, viewpoint: str, kind: Kind, name: str) -> tuple[tuple[str, str], ...] | None:
    """The effect of each input of a node for which there is no value; None if the node is not made of C++."""
    definition = workspace.scope(viewpoint).find(kind, name)
    node = workspace.files[definition.path].cpp_nodes.get(name) if definition is not None else None
    return node.without if node is not None else None


@of_viewpoint
def set_in_cpp(workspace: Workspace, viewpoint: str) -> SetEntries:
    """The entries that C++ with the nodes of a file sets on a blackboard."""
    files = [workspace.files[path] for path in workspace.scope(viewpoint).node_paths]
    return set_entries([file.source for file in files if file.is_cpp])


@of_viewpoint
def registers_all(workspace: Workspace, viewpoint: str) -> bool:
    """Whether C++ that a factory names registers all of its nodes, and loads no libraries of others."""
    factory = workspace.factory
    if factory is None or factory.nav2 or factory.lost:
        return False
    files = [workspace.files[path] for path in factory.cpp_files if path in workspace.files]
    own_packages = {_package(file.path) for file in files if file.names_of(Kind.MODEL) and not _OF_LIBRARY(file.source)}
    return bool(own_packages) and not any(
        _package(file.path) in own_packages and _LOADS_LIBRARIES(file.source) for file in files
    )


@of_name
def is_only_in_trees(workspace: Workspace, viewpoint: str, kind: Kind, name: str) -> bool:
    """Whether only files with trees have a model of a node, and no file of those that `nodes` names."""
    scope = workspace.scope(viewpoint)
    definitions = scope.all(kind, name)
    return bool(definitions) and not any(definition.path in scope.node_paths for definition in definitions)


@of_viewpoint
def is_in_cpp(workspace: Workspace, viewpoint: str, name: str) -> bool:
    """Whether C++ that the project names has a string with this text: its program may create a tree of the name, or
    replace it."""
    return any(file.is_cpp and f'"{name}"' in file.source for file in workspace.files.values())


@of_name
def nav2_base(workspace: Workspace, viewpoint: str, kind: Kind, name: str) -> str:
    """The class of nav2_behavior_tree from which a node of C++ derives; empty if from none."""
    definitions = workspace.scope(viewpoint).all(kind, name)
    nodes = (workspace.files[definition.path].cpp_nodes.get(name) for definition in definitions)
    return next((node.nav2_base for node in nodes if node is not None), "")


@of_viewpoint
def is_cpp(workspace: Workspace, viewpoint: str) -> bool:
    """Whether the file is C++, which registers the nodes that it has models of."""
    return workspace.files[viewpoint].is_cpp


def _package(path: str) -> str:
    """The folder of a package, in which a C++ source is below `src` or `include`."""
    return _BELOW.split(path)[0] if _BELOW.search(path) else posixpath.dirname(path)


_BELOW = re.compile(r"/(?:src|include)/(?!.*/(?:src|include)/)")
_OF_LIBRARY = re.compile(r"\bBT_REGISTER_(?:ROS_)?NODES\b").search
_LOADS_LIBRARIES = re.compile(
    r"\b(?:registerFrom\w*Plugins?|RegisterPlugins|RegisterRosNode|TreeExecutionServer)\b"
).search
