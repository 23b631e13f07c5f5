"""btq, with the list of all tokens, comments and blanks included, which it makes only when asked: formatting asks."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from parsers import with_btq
from parsers.with_btq import VERSION, count

__all__ = ["VERSION", "count", "load"]


def load() -> Callable[[str], Any]:
    parse = with_btq.load()

    def parse_with_tokens(text: str) -> Any:
        parsed = parse(text)
        assert parsed.tokens
        return parsed

    return parse_with_tokens
