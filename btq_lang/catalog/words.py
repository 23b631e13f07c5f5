"""Words that look like node kinds but are not the engine's: of the published language, and of older engines.

One invariant: no word here is a tag, a symbol or an alias of `nodes.BUILTINS`.  A node with such a name is
taken for its replacement of today if it has one, else for a custom node.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from btq_lang.catalog.versions import VERSION_3
from btq_lang.util.record import Record

if TYPE_CHECKING:
    from btq_lang.catalog.kinds import Category


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
KNOWN_WORDS: Final = {known.word: known for known in _WORDS}

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
