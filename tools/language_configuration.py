"""VS Code's language configuration: comments, brackets, words, and how far Enter indents.

One invariant: a line that must have children, or has a block by its nature, indents the next; a leaf does not.
"""

from __future__ import annotations

import json

import vocabulary as words
from textmate import _any


def openers() -> tuple[str, ...]:
    """Words that a block follows: items, controls and decorators."""
    return (
        "BehaviorTree",
        "Root",
        "QualityReq",
        "scenario",
        words.MODELS,
        "Control",
        "Decorator",
        *words.CONTROLS,
        *words.DECORATORS,
    )


def configuration() -> str:
    """The file `language-configuration.json`."""
    opening = rf"^\s*(?:(?:{_any(openers())})(?![\w-])(?!\s*=)|(?:{_any(words.NODE_SYMBOLS)})(?=[\s(]|$))"
    whole_line = r"(?:[^()#\"']|\"[^\"]*\"|'[^']*'|\([^()]*\))*(?:#.*)?$"
    pairs = [["(", ")"], ["{", "}"]]
    quotes = [{"open": quote, "close": quote, "notIn": ["string", "comment"]} for quote in "\"'"]
    return json.dumps(
        {
            "comments": {"lineComment": "#", "blockComment": ["/*", "*/"]},
            "brackets": pairs,
            "autoClosingPairs": [*({"open": start, "close": end} for start, end in pairs), *quotes],
            "surroundingPairs": [*pairs, ['"', '"'], ["'", "'"]],
            "autoCloseBefore": ")} \n\t,",
            "colorizedBracketPairs": [["(", ")"]],
            "wordPattern": {"pattern": r"[\p{L}_][\p{L}\p{N}_]*(?:-[\p{L}\p{N}_]+)*[?!]?", "flags": "u"},
            "folding": {"offSide": True, "markers": {"start": r"^\s*#\s*region\b", "end": r"^\s*#\s*endregion\b"}},
            "onEnterRules": [
                {"beforeText": opening + whole_line, "action": {"indent": "indent"}},
                {
                    "beforeText": rf"^(?:{_any(words.CATEGORY_WORDS)})(?![\w-])" + whole_line,
                    "action": {"indent": "indent"},
                },
                # A second Enter leaves the block.
                {"beforeText": r"^\s+$", "action": {"indent": "outdent"}},
            ],
        },
        indent=1,
        ensure_ascii=False,
    )
