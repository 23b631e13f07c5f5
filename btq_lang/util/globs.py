"""Patterns of paths, as .gitignore writes the simple ones.

`*` and `?` match within one name, `**` over any number of folders.  A pattern with a `/` before its end is relative to
the project's folder, any other matches at any depth; one that ends with `/` matches folders only.  Every string is a
pattern: there are no character classes and no `!`, so no pattern is malformed.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable

_PARTS = r"/\*\*/|^\*\*/|/\*\*$|\*\*|\*|\?|[^*?/]+|/"  # compiled on use: most projects exclude nothing
_MEANINGS = {"/**/": "/(?:.*/)?", "**/": "(?:.*/)?", "/**": "/.+", "**": ".*", "*": "[^/]*", "?": "[^/]"}


def glob_matcher(patterns: Iterable[str]) -> re.Pattern[str] | None:
    """An expression whose `fullmatch` succeeds for paths that match any pattern; None without patterns.

    The path is relative to the project's folder, has `/` between its names, and ends with `/` if it is a folder.
    """
    expressions = [_expression(pattern) for pattern in patterns if pattern.strip("/")]
    return re.compile("|".join(expressions), re.DOTALL) if expressions else None


def path_matcher(patterns: Iterable[str], root: str) -> Callable[[str], bool]:
    """A function that tells whether a pattern matches a path below a folder, or a folder that it is in; a folder's path
    ends with `/`.
    """
    matcher = glob_matcher(patterns)
    above_all = root.rstrip("/") + "/"

    def matches(path: str) -> bool:
        if matcher is None:
            return False
        names = path.removeprefix(above_all).split("/")
        above = ("/".join(names[:number]) + "/" for number in range(1, len(names)))
        return any(map(matcher.fullmatch, (*above, "/".join(names))))

    return matches


def _expression(pattern: str) -> str:
    anchored = "/" in pattern.rstrip("/")
    body = "".join(_MEANINGS.get(part) or re.escape(part) for part in re.findall(_PARTS, pattern.strip("/")))
    return ("" if anchored else "(?:.*/)?") + body + ("/" if pattern.endswith("/") else "/?")
