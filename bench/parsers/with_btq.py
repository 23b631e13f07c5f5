"""btq itself, in the form that is installed: pure Python, or compiled by mypyc."""

from __future__ import annotations

from collections.abc import Callable

import btq_lang
from btq_lang import lexer
from btq_lang.parser import Parsed, parse

VERSION = btq_lang.__version__
FORM = "pure" if str(lexer.__file__).endswith(".py") else "compiled"


def load() -> Callable[[str], object]:
    return parse


def count(parsed: Parsed) -> int:
    assert not parsed.diagnostics, f"the mission has a syntax error: {parsed.diagnostics[0]}"
    return sum(1 for tree in parsed.trees for _ in tree.walk())
