"""The ports of a node, whether the engine, a model, or the tree of a SubTree declares them, and where in C++."""

from __future__ import annotations

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nodes import NodeKind, PortKind, lookup, of_version
from btq_lang.checks.engines import engines_of
from btq_lang.syntax.tree import Model, Node, Tree
from btq_lang.util.text import Span
from btq_lang.workspace import inputs
from btq_lang.workspace.node_names import meaning_of
from btq_lang.workspace.port_types import as_kind
from btq_lang.workspace.references import called
from btq_lang.workspace.workspace import Workspace


def port_of(workspace: Workspace, path: str, node: Node, name: str) -> PortKind | None:
    """A port of a node, by its name; None if it is unknown."""
    ports: tuple[PortKind, ...] = ()
    if (tree := called(node)) is not None:
        ports = ports_of_tree(workspace, path, tree.text)
    elif node.id is not None:
        meaning = meaning_of(node, lambda name: workspace.store.ask(inputs.declared, path, name))
        ports = _ports(workspace, path, meaning.kind, node.id.text)
    return next((port for port in ports if port.name == name), None)


def ports_of_kind(
    workspace: Workspace, path: str, name: str, quoted: bool = False, child_count: int | None = None
) -> tuple[PortKind, ...]:
    """The ports of a built-in or of a model in scope."""
    return _ports(workspace, path, builtin_named(workspace, path, name, quoted, child_count), name)


def builtin_named(
    workspace: Workspace, path: str, name: str, quoted: bool = False, child_count: int | None = None
) -> NodeKind | None:
    """The built-in that a word means in a file; None for a node of the program, whatever its name."""
    kind = lookup(name, quoted, child_count)
    return None if kind is None or workspace.store.ask(inputs.declared, path, name)[2] else kind


def _ports(workspace: Workspace, path: str, kind: NodeKind | None, name: str) -> tuple[PortKind, ...]:
    if kind is not None:
        version = workspace.store.ask(engines_of, path)[-1]
        return tuple(of_version(port, version) for port in kind.ports)
    model = workspace.scope(path).target(Kind.MODEL, name)
    return declared_ports(model) if isinstance(model, Model) else ()


def ports_of_tree(workspace: Workspace, path: str, name: str) -> tuple[PortKind, ...]:
    """The ports that a tree declares, in its block or in a model of its own."""
    of_tree, of_model = (declared_ports(workspace.scope(path).target(kind, name)) for kind in (Kind.TREE, Kind.MODEL))
    return of_tree or of_model


def declared_ports(target: object) -> tuple[PortKind, ...]:
    """The ports that a tree or a model itself declares."""
    return tuple([as_kind(port) for port in target.ports]) if isinstance(target, (Tree, Model)) else ()


def signature(port: PortKind) -> str:
    """A port as a model declares it: `input station : string = charger`."""
    default = f" = {port.default or _EMPTY}" if port.default is not None else ""
    return f"{port.direction} {port.name}{f' : {port.type}' if port.type else ''}{default}"


def cpp_place(workspace: Workspace, path: str, node: str, port: str = "") -> tuple[str, Span] | None:
    """The class of a node, or one of its ports: the path, and the span as `File.on_disk` takes it; None if no C++ in
    the scope of the file registers it."""
    models = workspace.scope(path).all(Kind.MODEL, node)
    registered = (workspace.files[model.path].cpp_nodes for model in models)
    registration = next((nodes[node] for nodes in registered if node in nodes), None)
    if registration is None:
        return None
    places = (each.place for each in registration.ports if each.name == port)
    place = next(places, None) if port else registration.class_place
    if place is None:
        return None
    if place.path not in workspace.files or not workspace.files[place.path].is_cpp:
        place = registration.place  # the class is not in a file of this factory
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


_EMPTY = '""'
