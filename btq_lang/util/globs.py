"""Patterns of paths, as .gitignore writes the simple ones.

`*` and `?` match within one name, `**` over any number of folders.  A pattern with a `/` before its end counts from the
project's folder, another matches at any depth; one that ends with `/` matches folders only.  Every string is a pattern:
there are no character classes and no `!`, so nothing can be malformed.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

_PARTS = r"/\*\*/|^\*\*/|/\*\*$|\*\*|\*|\?|[^*?/]+|/"  # compiled when it is used: most projects exclude nothing
_MEANINGS = {"/**/": "/(?:.*/)?", "**/": "(?:.*/)?", "/**": "/.+", "**": ".*", "*": "[^/]*", "?": "[^/]"}


def glob_matcher(patterns: Iterable[str]) -> re.Pattern[str] | None:
    """One expression whose `fullmatch` tells whether a path matches any pattern; None for no patterns.

    The path is relative to the project's folder, has `/` between its names, and ends with `/` where it is a folder.
    """
    expressions = [_expression(pattern) for pattern in patterns if pattern.strip("/")]
    return re.compile("|".join(expressions), re.DOTALL) if expressions else None


def _expression(pattern: str) -> str:
    anchored = "/" in pattern.rstrip("/")
    body = "".join(_MEANINGS.get(part) or re.escape(part) for part in re.findall(_PARTS, pattern.strip("/")))
    return ("" if anchored else "(?:.*/)?") + body + ("/" if pattern.endswith("/") else "/?")
