"""btq, with the list of all tokens, comments and blanks included, which it makes only when asked: formatting asks."""

from __future__ import annotations

from collections.abc import Callable

from parsers.with_btq import FORM, VERSION, count

from btq_lang.parser import Parsed, parse

__all__ = ["FORM", "VERSION", "count", "load"]


def load() -> Callable[[str], object]:
    def parse_with_tokens(text: str) -> Parsed:
        parsed = parse(text)
        assert parsed.tokens
        return parsed

    return parse_with_tokens
