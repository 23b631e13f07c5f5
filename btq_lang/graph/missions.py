"""The trees of a mission as figures: the shape and the text of each node.

One invariant: one box for each written node.  A SubTree node is a box; its tree is a separate figure.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Final, TypeAlias

from btq_lang.graph import draw
from btq_lang.graph.figure import Box, Figure, MeasuredClause, Note, Outline
from btq_lang.requirements.applied import Applied
from btq_lang.requirements.model import DurationSum, Interval, ResolvedClaim, ResolvedEachEvent
from btq_lang.requirements.resolve import Requirements, requirements
from btq_lang.syntax.tree import Node, NodeClause, QualityPath, Satisfices
from btq_lang.util.grouping import grouped
from btq_lang.workspace.node_names import is_placeholder
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace

MeasuredBy: TypeAlias = Callable[[Applied], tuple[MeasuredClause, ...]]


def draw_tree(
    workspace: Workspace, path: str, form: str = "svg", *, qualities: bool = False, direction: str = "down"
) -> str:
    """The trees of a file as a picture.

        >>> from btq_lang import Workspace, draw_tree
        >>> workspace = Workspace.of({"main.btq": "BehaviorTree Main\\n    Dock\\n"})
        >>> draw_tree(workspace, "main.btq")[:4]
        '<svg'

    Args:
        path: of the file in the workspace.
        form: `svg`, `dot` or `mermaid`.
        qualities: draw qualities and requirements beside their nodes.
        direction: the position of the children, `down` or `right`.

    Raises:
        KeyError: there is no such file.
        ValueError: the file has no trees, or there is no such form or direction.
    """
    drawn = figures(workspace, path, qualities)
    if not drawn:
        raise ValueError(f"{path} has no trees to draw")
    return draw(drawn, form, direction)


def figures(
    workspace: Workspace, path: str, with_qualities: bool = False, measured_by: MeasuredBy = lambda applied: ()
) -> tuple[Figure, ...]:
    """A figure for each tree of a file, in the order of its text; with or without qualities and requirements.

    Args:
        measured_by: what logs show of a requirement at what it applies to.

    Raises:
        KeyError: there is no such file.
    """
    resolved = requirements(workspace, path)
    notes = _notes(resolved, measured_by) if with_qualities else {}
    keyed_nodes = keyed(workspace, path)
    keys = {id(node): key for key, node in keyed_nodes}
    return tuple(figure(nodes, keys, notes) for nodes in by_tree(node for _, node in keyed_nodes))


def keyed(workspace: Workspace, path: str) -> tuple[tuple[str, ResolvedNode], ...]:
    """The nodes of a file, in the order of its text, with the keys that their boxes have in `figures`.

    Raises:
        KeyError: there is no such file.
    """
    nodes = (node for node in requirements(workspace, path).nodes.all if node.path == path)
    return tuple((f"n{number}", node) for number, node in enumerate(nodes))


def by_tree(nodes: Iterable[ResolvedNode]) -> Iterator[tuple[ResolvedNode, ...]]:
    """Nodes in the order of their text, grouped by tree."""
    return map(tuple, grouped((id(node.item), node) for node in nodes).values())


def figure(
    nodes: tuple[ResolvedNode, ...],
    keys: Mapping[int, str],
    notes: Mapping[int, tuple[Note, ...]],
    links: Mapping[str, str] | None = None,
) -> Figure:
    """The figure of a tree.

    Args:
        nodes: all of the tree's, parents before their children.
        keys: of all nodes, by `id(node)`.
        notes: of nodes that have some, by `id(node)`.
        links: targets of SubTree nodes, by the name of the tree.
    """
    indices = {id(node): number for number, node in enumerate(nodes)}
    boxes = [
        Box(
            keys[id(node)],
            indices[id(node.parent)] if node.parent is not None else None,
            _OUTLINES.get(node.category or "", "unknown"),
            _title(node),
            _lines(node),
            _text(node),
            notes.get(id(node), ()),
            (links or {}).get(node.node.id.text, "") if node.category == "SubTree" and node.node.id else "",
        )
        for node in nodes
    ]
    return Figure(nodes[0].tree or "", tuple(boxes))


def concerns(node: ResolvedNode) -> Iterator[tuple[str, QualityPath]]:
    """The qualities that a node, or its tree, satisfices: their names joined by dots, and their syntax."""
    for clause in clauses_of(node):
        if isinstance(clause, Satisfices):
            for quality in clause.qualities:
                yield quality.path.text, quality.path


def clauses_of(node: ResolvedNode) -> tuple[NodeClause, ...]:
    """The clauses of a node; for the top node of a tree, those of the tree as well."""
    tree = node.item
    if node.parent is None and sum(isinstance(each, Node) for each in tree.children) == 1:
        return (*tree.clauses, *node.node.clauses)
    return node.node.clauses


def clauses_in_words(applied: Applied) -> tuple[str, ...]:
    """The clauses that hold for a subject, as typed, but without the subject where that is a node; the title of a
    requirement without clauses.
    """
    requirement = applied.requirement
    is_of_several = isinstance(applied.subject, Interval | DurationSum | ResolvedEachEvent)
    lines = [claim.text if is_of_several else _predicate(claim) for claim in requirement.claims]
    lines += [scope.text for scope in (*requirement.scopes, *requirement.assumptions)]
    lines += [requirement.span.text] if requirement.span is not None else []
    if requirement.odds is not None:
        lines.append(requirement.odds.text)
    if requirement.action is not None and not requirement.classic:
        lines.append(f"on violation {requirement.action}")
    return tuple(lines) or ((" ".join(requirement.title.split()),) if requirement.title else ())


def _predicate(claim: ResolvedClaim) -> str:
    """`takes at most 30 s` of `BatteryCheck/MoveBase takes at most 30 s`."""
    _, verb, after = f" {claim.text} ".partition(f" {claim.head} ")
    return (verb + after).strip() if claim.subject is not None and verb else claim.text


def requirement_note(
    key: str, applied: Applied, measured: tuple[MeasuredClause, ...], state: str = "", in_words: str = ""
) -> Note:
    """The note of a requirement at what it applies to; with what logs show of it, it has its title, too.

    Args:
        key, state: as of `Note`; in_words: the state.
    """
    requirement = applied.requirement
    name, clauses = f"{requirement.name}{applied.argument_list}", clauses_in_words(applied)
    title = " ".join((requirement.title or "").split())
    lines = (title, *clauses) if measured and title and title not in clauses else clauses
    text = "; ".join((name, *lines, *(each.text for each in measured), *([in_words] if in_words else [])))
    return Note("requirement", key, name, lines, text, state, measured=measured)


def _notes(resolved: Requirements, measured_by: MeasuredBy) -> dict[int, tuple[Note, ...]]:
    notes: dict[int, list[Note]] = {}
    for node in resolved.nodes.all:
        for name, _ in concerns(node):
            notes.setdefault(id(node), []).append(Note("quality", name, name, text=f"satisfices {name}"))
    for applied in resolved.applied:
        note = requirement_note(applied.requirement.name, applied, measured_by(applied))
        for node in applied.nodes:
            notes.setdefault(id(node), []).append(note)
    for trace in resolved.traces:
        notes.setdefault(id(trace.node), []).append(Note("requirement", trace.requirement, trace.requirement))
    return {key: tuple(dict.fromkeys(each)) for key, each in notes.items()}


def _title(node: ResolvedNode) -> str:
    """The symbol of a control node, the kind of others; for a placeholder, its name."""
    if is_placeholder(node.node) and node.node.name is not None:
        return node.node.name.text
    if node.kind is not None:
        return node.kind.symbols[0] if node.kind.symbols else node.kind.tag
    return node.node.head.text


def _lines(node: ResolvedNode) -> tuple[str, ...]:
    """The instance name, and for a built-in node the values of its ports."""
    lines = []
    name = node.node.name
    if name is not None and name.text != _title(node):
        lines.append(name.text)
    if node.kind is not None:
        pairs = [pair for pair in node.node.attributes if node.kind.port(pair.key.text) is not None]
        lines += [f"{pair.key.text} = {pair.value.text}" for pair in pairs if pair.value is not None]
    return tuple(" ".join(line.split()) for line in lines)


def _text(node: ResolvedNode) -> str:
    head = node.node.head.text
    name = node.node.name
    shown = head if name is None or name.text == head else f"{head} {name.text}"
    values = [f"{pair.key.text} = {pair.value.text}" for pair in node.node.attributes if pair.value is not None]
    return f"{shown} ({', '.join(values)})" if values else shown


_OUTLINES: Final[Mapping[str, Outline]] = {
    "Action": "action",
    "Condition": "condition",
    "Control": "control",
    "Decorator": "decorator",
    "SubTree": "subtree",
}
