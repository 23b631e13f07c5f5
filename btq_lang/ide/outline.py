"""The outline of a file, and the search for names in all files."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.syntax import tree as syntax
from btq_lang.util.record import Record
from btq_lang.util.text import Placed, Span
from btq_lang.workspace import inputs
from btq_lang.workspace.node_names import meaning_of
from btq_lang.workspace.symbols import requirements_at
from btq_lang.workspace.workspace import Workspace


class Outline(Record):
    """An entry in the outline of a file.

    Attributes:
        kind: mission, include, tree, control, decorator, action, condition, subtree, node (of unknown kind), port,
            model, requirement, hazard, scenario, signal, context, quality or apply.
        detail: a short text beside the name.
        span: all of it, with its block; `name_span`: the word to select.
    """

    name: str
    kind: str
    detail: str
    span: Span
    name_span: Span
    children: tuple[Outline, ...] = ()


class Match(Record):
    """A name in the project."""

    name: str
    kind: str
    path: str
    span: Span
    container: str


def document_symbols(workspace: Workspace, path: str) -> tuple[Outline, ...]:
    """The outline of a file: its items, the nodes of its trees with their qualities, and the ports of its models.

    The items in the block of a Root are its children.
    """
    symbols: list[Outline] = []
    root: tuple[int, Outline] | None = None
    inside: list[Outline] = []
    for entry in workspace.files[path].parsed.entries:
        for outline in _item(workspace, path, entry):
            if entry.in_root and root is not None:
                inside.append(outline)
                continue
            if isinstance(entry.item, syntax.Root):
                root = len(symbols), outline
            symbols.append(outline)
    if root is not None and inside:
        index, mission = root
        whole = Span(mission.span.start, max(mission.span.end, inside[-1].span.end))
        symbols[index] = Outline(mission.name, mission.kind, mission.detail, whole, mission.name_span, tuple(inside))
    return tuple(symbols)


def workspace_symbols(workspace: Workspace, query: str, limit: int = 500) -> tuple[Match, ...]:
    """The names in all files whose letters contain those of the query in order, whatever their case; the shortest and
    those that begin with it first."""
    wanted = query.casefold()
    matches: list[Match] = []
    for path, file in workspace.files.items():
        for definition in file.defined:
            if _contains(definition.symbol.name, wanted):
                kind = definition.symbol.kind.value.removeprefix("node ")
                matches.append(Match(definition.symbol.name, kind, path, definition.span, path))
        for scenario in file.of_type(syntax.Scenario):
            if scenario.title is not None and _contains(scenario.title.text, wanted):
                span = scenario.title.span.shifted(file.start_of(scenario))
                matches.append(Match(scenario.title.text, "scenario", path, span, path))
        for tree in file.of_type(syntax.Tree) if wanted else ():
            for node in tree.walk():
                name = node.name
                if name is not None and _contains(name.text, wanted):
                    span, within = name.span.shifted(file.start_of(tree)), tree.name.text if tree.name else ""
                    matches.append(Match(name.text, _category(workspace, path, node), path, span, within))

    def rank(match: Match) -> tuple[bool, int, str, str, int]:
        folded = match.name.casefold()
        return not folded.startswith(wanted), len(folded), folded, match.path, match.span.start

    return tuple(sorted(matches, key=rank)[:limit])


def _contains(name: str, wanted: str) -> bool:
    letters = iter(name.casefold())
    return all(letter in letters for letter in wanted)


def _item(workspace: Workspace, path: str, entry: syntax.Entry) -> Iterator[Outline]:
    item = entry.item
    by = entry.start
    if isinstance(item, syntax.Tree):
        ports = _ports(item.ports, by)
        nodes = tuple(_node(workspace, path, child, by) for child in item.children if isinstance(child, syntax.Node))
        name = item.name.text if item.name else "BehaviorTree"
        name_span = _placed(item.name, Span(item.start, item.end), by)
        span = Span(item.start, item.block_end).shifted(by)
        yield Outline(name, "tree", clauses_detail(item.clauses), span, name_span, (*ports, *nodes))
    elif isinstance(item, syntax.Model):
        yield _model(item, by)
    elif isinstance(item, syntax.Models):
        for model in item.models:
            if isinstance(model, syntax.Model):
                yield _model(model, by)
    elif isinstance(item, syntax.Requirement):
        yield _named(item.name, "requirement", requirement_detail(item), item, by)
    elif isinstance(item, syntax.Hazard):
        yield _named(item.name, "hazard", " ".join(item.text.text.split()) if item.text else "", item, by)
    elif isinstance(item, syntax.Scenario):
        yield _named(item.title, "scenario", item.tree.text if item.tree else "", item, by)
    elif isinstance(item, syntax.Signal):
        yield _named(item.name, "signal", item.unit.text if item.unit else "", item, by)
    elif isinstance(item, syntax.Context):
        yield _named(item.name, "context", "", item, by)
    elif isinstance(item, syntax.QualityDecl):
        parent = item.parent.text if item.parent else ""
        yield _named(item.name, "quality", parent, item, by)
    elif isinstance(item, syntax.Root):
        yield _named(item.name, "mission", "", item, by)
    elif isinstance(item, syntax.Include):
        yield _named(item.path, "include", "", item, by)
    elif isinstance(item, syntax.Apply) and item.uses:
        name = ", ".join(use.name.text for use in item.uses)
        span = Span(item.start, item.end).shifted(by)
        yield Outline(f"apply {name}", "apply", "", span, item.uses[0].name.span.shifted(by))


def _node(workspace: Workspace, path: str, node: syntax.Node, by: int) -> Outline:
    children = tuple(_node(workspace, path, child, by) for child in node.nodes)
    span = Span(node.start, node.block_end).shifted(by)
    kind = _category(workspace, path, node)
    return Outline(node.called, kind, clauses_detail(node.clauses), span, node.head.span.shifted(by), children)


def _category(workspace: Workspace, path: str, node: syntax.Node) -> str:
    meaning = meaning_of(node, lambda name: workspace.store.ask(inputs.declared, path, name))
    return meaning.category.lower() if meaning.category is not None else "node"


def clauses_detail(clauses: tuple[syntax.NodeClause, ...]) -> str:
    """What is attached to a node, on one line: `satisfices safety; satisfies rq1, rq2; tags heavy`."""
    qualities: list[str] = []
    tags: list[str] = []
    for clause in clauses:
        if isinstance(clause, syntax.Satisfices):
            qualities += (quality.path.text for quality in clause.qualities)
        elif isinstance(clause, syntax.Tags):
            tags += (name.text for name in clause.names)
    requirements = [one.name.text for one in requirements_at(clauses) if one.name is not None]
    parts = (("satisfices", qualities), ("satisfies", requirements), ("tags", tags))
    return "; ".join(f"{word} {', '.join(names)}" for word, names in parts if names)


def requirement_detail(requirement: syntax.Requirement) -> str:
    """A requirement's quality and text, on one line."""
    quality = " and ".join(quality.text for quality in requirement.qualities)
    text = " ".join(requirement.text.text.split()) if requirement.text else ""
    return ": ".join(filter(None, (quality, text)))


def _model(model: syntax.Model, by: int) -> Outline:
    ends = [model.end, *(part.end for part in model.body)]
    name = model.name.text if model.name else model.category.text
    detail = model.text.text if model.text else ""
    span = Span(model.start, max(ends)).shifted(by)
    name_span = _placed(model.name, model.category.span, by)
    return Outline(name, model.category.raw.lower(), detail, span, name_span, _ports(model.ports, by))


def _ports(ports: tuple[syntax.Port, ...], by: int) -> tuple[Outline, ...]:
    details = [f"{port.direction.text} : {port.type.text}" if port.type else port.direction.text for port in ports]
    return tuple(_named(port.name, "port", detail, port, by) for port, detail in zip(ports, details, strict=True))


def _named(word: syntax.Word | None, kind: str, detail: str, item: Placed, by: int) -> Outline:
    whole = Span(item.start, max(item.end, word.end if word is not None else 0))
    return Outline(
        word.text if word is not None and word.text else kind, kind, detail, whole.shifted(by), _placed(word, whole, by)
    )


def _placed(word: syntax.Word | None, otherwise: Span, by: int) -> Span:
    return (word.span if word is not None else Span(otherwise.start, otherwise.start)).shifted(by)
