"""The versions of the engine that a file must hold for: those of its project, or version 3 if it is written for that.

One invariant: a file that has anything which version 3 does not read is not written for it, whatever else is in it.
"""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.catalog.attributes import OF_VERSION_4, RESERVED_ATTRIBUTES
from btq_lang.catalog.nav2 import ENGINES
from btq_lang.catalog.nodes import KNOWN_WORDS, OLD_PORTS, available
from btq_lang.catalog.versions import VERSION_3, VERSIONS, is_before_4
from btq_lang.checks import lookups
from btq_lang.checks.sorted_nodes import sorted_nodes
from btq_lang.workspace import inputs
from btq_lang.workspace.item_index import Facts
from btq_lang.workspace.queries import Store
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace


def engines_of(store: Store[Workspace], viewpoint: str) -> tuple[str, ...]:
    """The versions that a file must hold for, oldest first."""
    project = inputs.project(store)
    return project.engines if project.written_for or not store.ask(is_for_version_3, viewpoint) else (VERSION_3,)


def is_for_version_3(store: Store[Workspace], viewpoint: str) -> bool:
    """Whether a file is written for version 3, whatever takes it."""
    return _declares_3(store, viewpoint) or bool(store.ask(old_words, viewpoint))


def _declares_3(store: Store[Workspace], viewpoint: str) -> bool:
    """Whether the project says that a file is for version 3: by its engine, or else by its distribution of Nav2."""
    project = inputs.project(store)
    engines = project.written_for or project.engines
    distribution = lookups.distribution(store, viewpoint) if engines == VERSIONS else None
    return is_before_4(engines[-1] if distribution is None else ENGINES[distribution])


def old_words(store: Store[Workspace], viewpoint: str) -> tuple[str, ...]:
    """What in an XML file only version 3 of the engine understands; empty if the file may be for version 4, and if the
    project says what it is for."""
    return () if _declares_3(store, viewpoint) else words_of_3(store, viewpoint) or ()


def words_of_3(store: Store[Workspace], viewpoint: str) -> tuple[str, ...] | None:
    """What in an XML file only version 3 of the engine understands; None if the file is for version 4."""
    declared = lookups.declared_format(store, viewpoint)
    if declared not in ("", "3"):
        return None
    found = [store.ask(_words_in, viewpoint, tree) for tree in lookups.trees(store, viewpoint)]
    words = [word for each in found if each is not None for word in each]
    return None if None in found else tuple(dict.fromkeys(['BTCPP_format="3"'] * (declared == "3") + words))


def _words_in(store: Store[Workspace], viewpoint: str, tree: Facts) -> tuple[str, ...] | None:
    """Those of a tree; None if version 3 does not understand something in it."""
    nodes = store.ask(sorted_nodes, viewpoint, viewpoint, tree)
    keys = {pair.key.text for seen in nodes.marked for pair in seen.node.attributes}
    if OF_VERSION_4.intersection(keys) or any(map(_is_new, nodes.all)):
        return None
    return tuple(dict.fromkeys(word for seen in nodes.all for word in _old(seen)))


def _is_new(seen: ResolvedNode) -> bool:
    is_old_word = seen.id is not None and seen.id.text in KNOWN_WORDS
    return seen.kind is not None and not is_old_word and not available(seen.kind, VERSION_3)


def _old(seen: ResolvedNode) -> Iterator[str]:
    known = KNOWN_WORDS.get(seen.id.text) if seen.id is not None and not seen.is_defined else None
    if known is not None and known.until is not None:
        yield known.tag
    for pair in seen.node.attributes:
        key = pair.key.text
        is_port = seen.kind is not None and (seen.kind.tag, key) in OLD_PORTS
        if is_port or (seen.category == "SubTree" and key.startswith("__") and key in RESERVED_ATTRIBUTES):
            yield key
