"""Lark: LALR(1) with its contextual lexer; INDENT and DEDENT come from its own `Indenter`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import ClassVar

import lark
from lark.indenter import Indenter

VERSION = lark.__version__


class _Indenter(Indenter):  # type: ignore[misc,unused-ignore]  # a class of unknown type, where Lark is missing
    NL_type = "_NL"
    OPEN_PAREN_types: ClassVar = ["LPAR"]
    CLOSE_PAREN_types: ClassVar = ["RPAR"]
    INDENT_type = "_INDENT"
    DEDENT_type = "_DEDENT"
    tab_len = 8


def load() -> Callable[[str], object]:
    grammar = (Path(__file__).parent / "classic.lark").read_text(encoding="utf-8")
    parse: Callable[[str], object] = lark.Lark(
        grammar, parser="lalr", postlex=_Indenter(), maybe_placeholders=False
    ).parse
    return parse


def count(tree: lark.Tree[lark.Token]) -> int:
    return sum(1 for _ in tree.find_data("node"))
