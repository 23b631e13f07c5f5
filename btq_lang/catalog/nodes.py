"""Looking up node kinds: the engine's node for a word in a file, and words that only look like one.

One invariant: a quoted kind is the XML tag verbatim, never a symbol or an alias, and no `KnownWord` is a tag, a symbol
or an alias: a node with such a name is taken for its replacement if it has one, else for a custom node.  It knows
neither a file's own models nor its placeholders: callers that have read the file decide whether an unknown name is a
custom node.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Final

from btq_lang.catalog.engine_nodes import ENGINE_NODES
from btq_lang.catalog.kinds import CATEGORIES
from btq_lang.catalog.kinds import NodeKind as NodeKind
from btq_lang.catalog.kinds import PortKind as PortKind
from btq_lang.catalog.versions import VERSION_3, at_least
from btq_lang.util.record import Record, replace

if TYPE_CHECKING:
    from btq_lang.catalog.kinds import Category, Flow


class KnownWord(Record):
    """A word that is not a node of the engine.

    Attributes:
        tag: its XML tag.
        why: what it is, or what replaced it, as a sentence.
        replacement: the built-in to write in its place, if there is one that needs no other change; else None.
        until: the last version of the engine that has it; None if none is known that has.
    """

    word: str
    category: Category
    tag: str
    why: str
    replacement: str | None = None
    until: str | None = None


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


def _custom(word: str, category: Category, why: str) -> KnownWord:
    return KnownWord(word, category, word, why)


def _old(word: str, category: Category, why: str, replacement: str | None = None, until: str = VERSION_3) -> KnownWord:
    return KnownWord(word, category, word, why, replacement, until)


_WORDS: Final = (
    # The published language's own.
    KnownWord(
        "Test",
        "Action",
        "TestNode",
        "TestNode is the engine's substitution placeholder and is not registered: register an action TestNode",
    ),
    _custom(
        "ThreadedAction", "Action", "ThreadedAction is a C++ base class, not a node: write the name of your own action"
    ),
    _custom("CoroAction", "Action", "CoroAction is a C++ base class, not a node: write the name of your own action"),
    _old("ManualSelector", "Control", "ManualSelector was a node of version 3; version 4 does not build it"),
    _custom("ConsumeQueue", "Decorator", "ConsumeQueue is a C++ template that a program must register; see LoopDouble"),
    _custom("PopFromQueue", "Action", "PopFromQueue is a C++ template that a program must register; see LoopDouble"),
    # C++ names that people take for nodes.
    _custom("QueueSize", "Action", "QueueSize is a C++ template that a program must register"),
    _custom(
        "StatefulAction", "Action", "StatefulAction is a C++ base class, not a node: write the name of your own action"
    ),
    _custom("SyncAction", "Action", "SyncAction is a C++ base class, not a node: write the name of your own action"),
    # Older engines'.
    _old(
        "SequenceStar",
        "Control",
        "SequenceStar is the name of SequenceWithMemory in version 3, where it begins again after a halt",
        "SequenceWithMemory",
    ),
    _old("FallbackStar", "Control", "FallbackStar is the name of Fallback in version 2", "Fallback", "2.5"),
    _old(
        "RetryUntilSuccesful",
        "Decorator",
        "RetryUntilSuccesful is the misspelling of RetryUntilSuccessful up to version 3.6.0",
        "RetryUntilSuccessful",
        "3.6",
    ),
    _old(
        "SubTreePlus", "SubTree", "SubTreePlus is the name of SubTree in version 3; its __autoremap is now _autoremap"
    ),
    *(
        _old(
            f"BlackboardCheck{kind}",
            "Decorator",
            f"BlackboardCheck{kind} was a node of version 3: write a Precondition with a script",
        )
        for kind in ("Int", "Double", "String", "Bool")
    ),
)

# By word.
KNOWN_WORDS: Final = {entry.word: entry for entry in _WORDS}

# Version 3's names of ports: (tag, port) to the port of today.
OLD_PORTS: Final = {
    ("Parallel", "success_threshold"): "success_count",
    ("Parallel", "failure_threshold"): "failure_count",
}

# Unquoted and without `code`, these mean a custom node of this category: classic files have no other way.
PLACEHOLDERS: Final[dict[str, Category]] = {
    "ScriptAction": "Action",
    "Script": "Action",
    "ScriptCondition": "Condition",
}
# What other libraries and textbooks call the engine's nodes.
ELSEWHERE: Final = {"Selector": ("Fallback",)}

# By XML tag.
BUILTINS: Final[Mapping[str, NodeKind]] = {kind.tag: kind for kind in ENGINE_NODES}
_ELEMENTS: Final = ("root", "BehaviorTree", "TreeNodesModel", "include", *CATEGORIES)

_BY_SPELLING: Final[dict[str, tuple[NodeKind, ...]]] = {}
for _kind in ENGINE_NODES:
    for _word in spellings(_kind):
        _BY_SPELLING[_word] = (*_BY_SPELLING.get(_word, ()), _kind)
