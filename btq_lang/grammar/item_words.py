"""The words that begin items, and corrections of misspelt ones.

One invariant: `may_include` is true for every text in which the parser finds an include, misspelt or not.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Final

from btq_lang.syntax.tokens import CATEGORIES
from btq_lang.util.spelling import near

ITEM_WORDS: Final = (
    *("BehaviorTree", "Root", "TreeNodesModel", "QualityReq", "include", "signal", "context", "apply"),
    *("quality", "qualities", "hazard", "given", "scenario", "xml"),
    *sorted(CATEGORIES),
)


@lru_cache(1_000)
def item_word_meant(word: str) -> str:
    """The item word nearest to another word; empty if none is near."""
    if word.removesuffix("Node") in CATEGORIES:
        return word.removesuffix("Node")  # the classes of C++
    likely = near(word, ITEM_WORDS, limit=1)
    return likely[0] if likely else ""


def read_as(word: str) -> str:
    """The item word that a misspelt one is read as, or empty: a model may be meant as a node of the tree above, and an
    include must be found without parsing the text.
    """
    meant = item_word_meant(word)
    return "" if meant in CATEGORIES or (meant == "include" and not may_include(word)) else meant


def may_include(text: str) -> bool:
    """Whether a text may contain an include: most contain none, and need not be parsed to resolve names in others.

    A single mistake in the word leaves its beginning or its end intact.
    """
    folded = text.casefold()
    return "inc" in folded or "ude" in folded
