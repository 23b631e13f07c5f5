"""Classic placeholders: script nodes without code that represent a skill (docs/language.md).

One invariant: only the unquoted words are placeholders.  The published language has no custom nodes, so its files write
skills as `ScriptAction (name = "MoveBase")`.
"""

from __future__ import annotations

from functools import lru_cache

from btq_lang.catalog.nodes import PLACEHOLDERS
from btq_lang.syntax.tree import Node
from btq_lang.util.spelling import near


def is_placeholder(node: Node) -> bool:
    """Whether a script node without code represents a skill; a skill has no port that is a misspelt `code`."""
    return (
        node.kind is not None
        and node.kind.raw in PLACEHOLDERS
        and node.category is None
        and node.name is not None
        and not any(_means_code(pair.key.text) for pair in node.attributes)
    )


@lru_cache(1000)
def _means_code(key: str) -> bool:
    return key == "code" or bool(near(key, ("code",)))
