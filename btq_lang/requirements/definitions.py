"""The definitions of requirements, each a query by its name."""

from __future__ import annotations

from btq_lang.catalog.name_kinds import Kind
from btq_lang.requirements.clauses import parameter_of, with_clauses
from btq_lang.requirements.model import ResolvedParameter, ResolvedRequirement
from btq_lang.requirements.reader import Problems, Reader
from btq_lang.syntax import tree as syntax
from btq_lang.util.record import replace
from btq_lang.workspace import inputs
from btq_lang.workspace.item_index import Facts
from btq_lang.workspace.queries import Store
from btq_lang.workspace.resolved import tree_nodes
from btq_lang.workspace.workspace import Workspace


def requirement(store: Store[Workspace], viewpoint: str, name: str) -> tuple[ResolvedRequirement | None, Problems]:
    """The requirement with a name, with parameters, and what is wrong with its definition; None if it is not
    defined."""
    item = store.ask(inputs.definition, viewpoint, Kind.REQUIREMENT, name)
    if item is None:
        return None, ()
    symbol = inputs.symbol(item[1], Kind.REQUIREMENT, name)
    written = symbol.target
    assert isinstance(written, syntax.Requirement), "its kind says so"
    reader = Reader(store, viewpoint, *item)
    parameters: dict[str, ResolvedParameter] = {}
    for parameter_node in written.parameters:
        parameter = parameter_of(reader, parameter_node)
        parameters.setdefault(parameter.name, parameter)
    reader.parameters = parameters
    quality = _quality(store, viewpoint, *item, written)
    title = written.text.text if written.text is not None else None
    place = reader.place(symbol.span)
    resolved = ResolvedRequirement(name, place, quality, title, False, tuple(parameters.values()), ())
    if written.further:
        resolved = replace(resolved, further_qualities=tuple(each.text for each in written.further))
    resolved = with_clauses(reader, resolved, written.clauses)
    if written.is_text and written.text is not None:
        from btq_lang.requirements.classic import with_constraints  # only requirements without clauses need it

        resolved = with_constraints(reader, resolved, written.text)
    return resolved, reader.problems


def _quality(
    store: Store[Workspace], viewpoint: str, path: str, facts: Facts, written: syntax.Requirement
) -> str | None:
    """The quality that a requirement names, or that encloses it."""
    if written.quality is not None:
        return written.quality.text
    if not isinstance(facts.item, syntax.Tree):
        return None
    return store.ask(tree_nodes, viewpoint, path, facts).qualities.get(id(written))
