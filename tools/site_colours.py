"""Missions in colours on the documentation site: a lexer for Pygments, with the words that the editors' grammars have.

One invariant: a word's colour is told by the word and its line alone.
"""

from __future__ import annotations

from typing import ClassVar

import vocabulary as words
from pygments.lexer import RegexLexer
from pygments.lexer import words as one_of
from pygments.lexers import LEXERS
from pygments.token import Comment, Keyword, Name, Number, Operator, String

__all__ = ["BtqLexer"]  # Pygments takes all of them for lexers

_NODES = words.longest_first((*words.CONTROLS, *words.DECORATORS, *words.LEAVES))
_CLAUSES = words.longest_first((*words.REQUIREMENT_WORDS, *words.SIGNAL_WORDS, *words.LOGIC, *words.PORT_WORDS))


def register() -> None:
    """Make ```btq blocks known to Pygments."""
    LEXERS["BtqLexer"] = ("site_colours", "btq", ("btq",), ("*.btq", "*.qualitybtcpp"), ())


class BtqLexer(RegexLexer):  # type: ignore[misc]  # Pygments has no types
    name = "btq"
    aliases: ClassVar = ["btq"]
    tokens: ClassVar = {
        "root": [
            (r"(?:(?<=[\s(),])|^)(?:#|//).*", Comment.Single),
            (r"/\*(?:.|\n)*?\*/", Comment.Multiline),
            (r'"(?:\\.|[^"\\])*"|\'(?:\\.|[^\'\\])*\'', String),
            (r"\{[^{}\n]*\}", Name.Variable),
            (one_of(words.NODE_SYMBOLS, prefix=r"(?<!\S)", suffix=r"(?!\S)"), Keyword),
            (r"[-+]?\d[\d.]*(?:e[-+]?\d+)?(?:\s?(?:%|(?:[A-Za-zµ°]+)(?:[*/^][A-Za-z\d]+)*(?=[\s,)]|$)))?", Number),
            (r"[A-Za-z_][\w-]*(?=\s*=(?!=))", Name.Attribute),
            (one_of((*words.ITEMS, words.MODELS), suffix=r"(?![\w-])"), Keyword.Declaration),
            (one_of((*words.CATEGORY_WORDS, *_NODES), suffix=r"(?![\w-])"), Keyword),
            (one_of(words.CLAUSE_WORDS, suffix=r"(?![\w-])"), Keyword.Declaration),
            (one_of(words.OUTCOME_WORDS, prefix=r"(?<=violation )", suffix=r"(?![\w-])"), Name.Constant),
            (one_of(_CLAUSES, suffix=r"(?![\w-])"), Keyword.Type),
            (r"[^\W\d][\w-]*[?!]?", Name),
            (r"[<>=!]=?", Operator),
        ]
    }
