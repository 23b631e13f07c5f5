"""Looking up node kinds: the engine's node for a word in a file.

One invariant: a quoted kind is the XML tag verbatim, never a symbol or an alias.  It knows neither a file's own models
nor its placeholders: callers that have read the file decide whether an unknown name is a custom node.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Final

from btq_lang.catalog.engine_nodes import ENGINE_NODES
from btq_lang.catalog.kinds import CATEGORIES
from btq_lang.catalog.kinds import NodeKind as NodeKind
from btq_lang.catalog.kinds import PortKind as PortKind
from btq_lang.catalog.versions import at_least
from btq_lang.catalog.words import KNOWN_WORDS as KNOWN_WORDS
from btq_lang.catalog.words import OLD_PORTS as OLD_PORTS
from btq_lang.catalog.words import PLACEHOLDERS as PLACEHOLDERS
from btq_lang.catalog.words import KnownWord as KnownWord
from btq_lang.util.record import replace

if TYPE_CHECKING:
    from btq_lang.catalog.kinds import Flow


def lookup(word: str, quoted: bool = False, child_count: int | None = None) -> NodeKind | None:
    """The built-in that a node's kind names; None for a custom node.

    Args:
        child_count: number of the node's children: it chooses among kinds that share a word, the nearest if none fits.
    """
    if quoted:
        return BUILTINS.get(word)
    kinds = _BY_SPELLING.get(word)
    if kinds is None:
        return None
    return kinds[0] if len(kinds) == 1 else min(kinds, key=lambda kind: abs(kind.children[0] - (child_count or 0)))


def is_by_children(word: str) -> bool:
    """Whether several kinds share a word, and the number of a node's children chooses among them."""
    return len(_BY_SPELLING.get(word, ())) > 1


def xml_tag(word: str, quoted: bool = False, child_count: int | None = None) -> str:
    """The XML tag of a node's kind; for a custom node, its own name."""
    kind = lookup(word, quoted, child_count)
    if kind is not None:
        return kind.tag
    old_word = None if quoted else KNOWN_WORDS.get(word)
    return word if old_word is None else old_word.tag


def spellings(kind: NodeKind) -> tuple[str, ...]:
    """Every way to write a kind, the tag first."""
    return (kind.tag, *kind.symbols, *kind.aliases)


def engine_element(word: str) -> str:
    """The element of the engine's XML whose name differs from a word in capital letters at most; empty if none has."""
    return next((tag for tag in (*_ELEMENTS, *BUILTINS) if tag.casefold() == word.casefold()), "")


def available(kind: NodeKind, version: str) -> bool:
    """Whether that version of the engine has the node."""
    return at_least(version, kind.since)


def inspects_children(tag: str) -> bool:
    """Whether the engine looks up the tags of the children of an element of this tag."""
    kind = BUILTINS.get(tag)
    return kind is not None and kind.inspects_children


def tags_of(flow: Flow) -> frozenset[str]:
    """The tags of the built-ins of a flow, and those that older engines have for them."""
    tags = {kind.tag for kind in ENGINE_NODES if kind.flow == flow}
    return frozenset((*tags, *(old.word for old in KNOWN_WORDS.values() if old.replacement in tags)))


def of_version(port: PortKind, version: str) -> PortKind:
    """A port with the type that a version of the engine gives it."""
    if port.type_before is not None and not at_least(version, port.type_before[0]):
        return replace(port, type=port.type_before[1])
    return port


# By XML tag.
BUILTINS: Final[Mapping[str, NodeKind]] = {kind.tag: kind for kind in ENGINE_NODES}
_ELEMENTS: Final = ("root", "BehaviorTree", "TreeNodesModel", "include", *CATEGORIES)

_BY_SPELLING: Final[dict[str, tuple[NodeKind, ...]]] = {}
for _kind in ENGINE_NODES:
    for _word in spellings(_kind):
        _BY_SPELLING[_word] = (*_BY_SPELLING.get(_word, ()), _kind)
