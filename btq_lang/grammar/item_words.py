"""The words that items begin with, and what was meant by a misspelt one.

One invariant: every include that the parser reads, well spelt or not, is in a text of which `may_include` says so.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Final

from btq_lang.syntax.tokens import CATEGORIES
from btq_lang.util.spelling import near

ITEM_WORDS: Final = (
    *("BehaviorTree", "Root", "TreeNodesModel", "QualityReq", "include", "signal", "context", "apply"),
    *("quality", "qualities", "xml"),
    *sorted(CATEGORIES),
)


def item_word_meant(word: str) -> str:
    """The item word that is nearest to another one; empty if none is near."""
    return _meant(word)


def read_as(word: str) -> str:
    """The item word that another one is read as; empty for none: a model may be meant for a node of the tree above, and
    what is to be an include must be found in texts that nobody parses."""
    meant = _meant(word)
    return "" if meant in CATEGORIES or (meant == "include" and not may_include(word)) else meant


def may_include(text: str) -> bool:
    """Whether there may be an include in a text: most have none, and need not be parsed to know what others mean.

    One slip in the word leaves one of its ends whole.
    """
    folded = text.casefold()
    return "inc" in folded or "ude" in folded


@lru_cache(1_000)
def _meant(word: str) -> str:
    likely = near(word, ITEM_WORDS, limit=1)
    return likely[0] if likely else ""
