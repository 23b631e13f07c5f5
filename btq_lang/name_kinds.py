"""What a name can name.

It stands alone because the summaries made of it (`symbols.py`) are compiled, where `enum` is the standard library's.
"""

from __future__ import annotations

from btq_lang.enumeration import Enum


class Kind(Enum):
    """What a name can name."""

    TREE = "tree"
    MODEL = "node model"
    REQUIREMENT = "requirement"
    SIGNAL = "signal"
    CONTEXT = "context"
    QUALITY = "quality"
