"""Where in C++ a node is that a file can use."""

from __future__ import annotations

from btq_lang.catalog.name_kinds import Kind
from btq_lang.util.text import Span
from btq_lang.workspace.workspace import Workspace


def cpp_place(workspace: Workspace, path: str, node: str, port: str = "") -> tuple[str, Span] | None:
    """The class of a node, or one of its ports: the path, and the span as `File.on_disk` takes it; None if no C++ in
    the scope of the file registers it."""
    models = workspace.scope(path).all(Kind.MODEL, node)
    registered = (origin.nodes for each in models if (origin := workspace.files[each.path].origin) is not None)
    found = next((nodes[node] for nodes in registered if nodes is not None and node in nodes), None)
    if found is None:
        return None
    place = next((each.place for each in found.ports if each.name == port), None) if port else found.class_place
    if place is None:
        return None
    if place.path not in workspace.files or not workspace.files[place.path].is_cpp:
        place = found.place  # the class is not in a file of this factory
    file = workspace.files[place.path]
    return place.path, file.after_models(place.span_in(file.source_lines))


def cpp_link(workspace: Workspace, path: str, node: str, port: str = "") -> str:
    """A link in Markdown to the same place; empty if there is none."""
    place = cpp_place(workspace, path, node, port)
    if place is None:
        return ""
    from urllib.parse import quote  # few hovers are about C++

    file = workspace.files[place[0]]
    line = file.source_lines.position(file.on_disk(place[1]).start).line + 1
    return f"[{workspace.project.shown(place[0])}:{line}](file://{quote(place[0])}#L{line})"
