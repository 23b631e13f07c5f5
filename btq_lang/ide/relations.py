"""From a requirement to the nodes that refer to it, and from a name to the declaration of its type."""

from __future__ import annotations

from btq_lang.catalog.name_kinds import Kind
from btq_lang.ide.meaning import at, definition, everywhere, own_quality, quality_of, subject
from btq_lang.ide.navigation import Target, goto_definition
from btq_lang.util.text import Span
from btq_lang.workspace.file import Definition
from btq_lang.workspace.references import What
from btq_lang.workspace.workspace import Workspace


def goto_implementation(workspace: Workspace, path: str, offset: int) -> tuple[Target, ...]:
    """The nodes that refer to the requirement at a place; for everything else, the definition."""
    found = at(workspace, path, offset)
    wanted = subject(workspace, found) if found is not None else None
    if found is None or wanted is None or wanted.what is not What.REQUIREMENT:
        return goto_definition(workspace, path, offset)
    targets = {}
    for one in everywhere(workspace, wanted):
        node = one.mention.node
        if node is not None and one.entry is not None:
            name = node.head.span.shifted(one.entry.start)
            whole = Span(node.start, node.block_end).shifted(one.entry.start)
            targets[one.path, name] = Target(one.path, whole, name, found.span)
    return tuple(targets.values())


def goto_type(workspace: Workspace, path: str, offset: int) -> tuple[Target, ...]:
    """The model or the tree of a named node; the declaration of a requirement's custom quality."""
    found = at(workspace, path, offset)
    if found is None:
        return ()
    place: Definition | None = None
    wanted = subject(workspace, found)
    if wanted.what is What.INSTANCE:
        node = next((one.mention.node for one in everywhere(workspace, wanted) if one.mention.node is not None), None)
        if node is not None and node.id is not None:
            scope = workspace.scope(path)
            place = scope.find(Kind.MODEL, node.id.text) or scope.find(Kind.TREE, node.id.text)
    elif wanted.what is What.REQUIREMENT and (requirement := definition(workspace, path, wanted)) is not None:
        quality = quality_of(requirement)
        place = own_quality(workspace, requirement.path, quality.names[-1].text) if quality is not None else None
    if place is None:
        return ()
    return (Target(place.path, place.whole, place.span, found.span),)
