"""btq: quality-aware behavior trees.

    import btq_lang as btq

    parsed = btq.parse(text)                        # a tree for every string, and what is wrong with it
    workspace = btq.open_workspace("missions")      # files, what they include, and their project
    found = btq.check(workspace, path)              # the diagnostics of one of its files
    tidy = btq.format_text(text).text               # what `btq format` writes

Names are imported when they are first used, so that `import btq_lang` costs little.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from btq_lang.btcpp.opening import open_workspace
    from btq_lang.checks import check
    from btq_lang.diagnostics import Diagnostic
    from btq_lang.formatter import format_text
    from btq_lang.parser import Parsed, parse
    from btq_lang.syntax import Node, Requirement, Tree
    from btq_lang.text import LineIndex, Span
    from btq_lang.version import __version__
    from btq_lang.workspace import Workspace

__all__ = [
    "Diagnostic",
    "LineIndex",
    "Node",
    "Parsed",
    "Requirement",
    "Span",
    "Tree",
    "Workspace",
    "__version__",
    "check",
    "format_text",
    "open_workspace",
    "parse",
]

_HOMES = {
    "Diagnostic": "diagnostics",
    "LineIndex": "text",
    "Node": "syntax",
    "Parsed": "parser",
    "Requirement": "syntax",
    "Span": "text",
    "Tree": "syntax",
    "Workspace": "workspace",
    "__version__": "version",
    "check": "checks",
    "format_text": "formatter",
    "open_workspace": "btcpp.opening",
    "parse": "parser",
}


def __getattr__(name: str) -> object:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module

    value: object = getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """The public names, whether they are imported yet or not: shells complete them."""
    return list(__all__)
