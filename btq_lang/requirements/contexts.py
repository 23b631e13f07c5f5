"""How deeply contexts are nested in one another, and which have a word in common."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from btq_lang.catalog.name_kinds import Kind
from btq_lang.syntax import tree as syntax
from btq_lang.syntax.tokens import NAME
from btq_lang.util.grouping import grouped
from btq_lang.util.spelling import long_words
from btq_lang.workspace import inputs
from btq_lang.workspace.item_index import Facts
from btq_lang.workspace.queries import Store, on_circle
from btq_lang.workspace.workspace import Workspace

IN_CIRCLE: Final = 0


@on_circle(IN_CIRCLE)
def context_depth(store: Store[Workspace], viewpoint: str, name: str) -> int:
    """How deeply contexts are nested in a context, itself included; IN_CIRCLE if it refers to itself."""
    definition = store.ask(inputs.definition, viewpoint, Kind.CONTEXT, name)
    if definition is None:
        return 1
    others = contexts_in(store, viewpoint, written_context(definition[1], name))
    return 1 + max([store.ask(context_depth, viewpoint, other) for other in others], default=0)


def contexts_in(store: Store[Workspace], viewpoint: str, written: syntax.Context) -> Iterator[str]:
    """The contexts that a context names."""
    words = [part.word for part in syntax.walk(written.condition) if isinstance(part, syntax.Operand)]
    for name in [word.text for word in words if word.kind == NAME]:
        if store.ask(inputs.definition, viewpoint, Kind.CONTEXT, name) is not None:
            yield name


def written_context(facts: Facts, name: str) -> syntax.Context:
    """The item that defines a context."""
    written = inputs.symbol(facts, Kind.CONTEXT, name).target
    assert isinstance(written, syntax.Context), "its kind says so"
    return written


def contexts_by_word(store: Store[Workspace], viewpoint: str) -> dict[str, list[str]]:
    """The names of the contexts, by the long words in them."""
    return grouped(
        (word, name) for name in store.ask(inputs.names, viewpoint, Kind.CONTEXT) for word in long_words(name)
    )
