"""The ports of Nav2's nodes, from the models of a distribution."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

from btq_lang.catalog.kinds import PortKind
from btq_lang.catalog.nav2 import FILES
from btq_lang.parser import parse
from btq_lang.syntax.tree import Model, Models
from btq_lang.util.record import replace
from btq_lang.workspace.loader import read
from btq_lang.workspace.port_types import as_kind


@cache
def ports_in(distribution: str) -> Mapping[str, tuple[PortKind, ...]]:
    """The ports of each node of Nav2 in a distribution, by its name; an empty default is left out."""
    text, problem = read(FILES[distribution])
    assert text is not None, problem
    return {
        model.name.text: tuple([replace(port, default=port.default or None) for port in map(as_kind, model.ports)])
        for entry in parse(text).entries
        if isinstance(entry.item, Models)
        for model in entry.item.models
        if isinstance(model, Model) and model.name is not None
    }
