"""btq: quality-aware behavior trees.

    import btq_lang as btq

    parsed = btq.parse(text)                        # a tree for every string, and what is wrong with it
    workspace = btq.open_workspace("missions")      # files, what they include, and their project
    found = btq.check(workspace, path)              # the diagnostics of one of its files
    tidy = btq.format_text(text).text               # what `btq format` writes
    built = btq.build(workspace, path).files        # what `btq build` writes, in memory

Likewise `import_xml`, `trace_table`, `draw_tree`, `diff_missions` and `verify_logs`.  All are typed, and `help` of each
lists its arguments and errors.

Names are imported on first use, so that `import btq_lang` is fast.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from btq_lang.btcpp.importing import Imported, import_xml
    from btq_lang.checks import check
    from btq_lang.commands.building import Built, build
    from btq_lang.commands.opening import open_workspace
    from btq_lang.diagnostics.model import Diagnostic
    from btq_lang.diff.changes import Change
    from btq_lang.diff.comparison import diff_missions
    from btq_lang.evidence.verifying import Verification, verify_logs
    from btq_lang.formatter import format_text
    from btq_lang.graph.missions import draw_tree
    from btq_lang.parser import Parsed, parse
    from btq_lang.syntax.tree import Node, Requirement, Tree
    from btq_lang.trace.missions import TraceTable, trace_table
    from btq_lang.util.text import LineIndex, Span
    from btq_lang.util.version import __version__
    from btq_lang.workspace.workspace import Workspace

__all__ = [
    "Built",
    "Change",
    "Diagnostic",
    "Imported",
    "LineIndex",
    "Node",
    "Parsed",
    "Requirement",
    "Span",
    "TraceTable",
    "Tree",
    "Verification",
    "Workspace",
    "__version__",
    "build",
    "check",
    "diff_missions",
    "draw_tree",
    "format_text",
    "import_xml",
    "open_workspace",
    "parse",
    "trace_table",
    "verify_logs",
]

_HOMES = {
    "Built": "commands.building",
    "Change": "diff.changes",
    "Diagnostic": "diagnostics.model",
    "Imported": "btcpp.importing",
    "LineIndex": "util.text",
    "Node": "syntax.tree",
    "Parsed": "parser",
    "Requirement": "syntax.tree",
    "Span": "util.text",
    "TraceTable": "trace.missions",
    "Tree": "syntax.tree",
    "Verification": "evidence.verifying",
    "Workspace": "workspace.workspace",
    "__version__": "util.version",
    "build": "commands.building",
    "check": "checks",
    "diff_missions": "diff.comparison",
    "draw_tree": "graph.missions",
    "format_text": "formatter",
    "import_xml": "btcpp.importing",
    "open_workspace": "commands.opening",
    "parse": "parser",
    "trace_table": "trace.missions",
    "verify_logs": "evidence.verifying",
}


def __getattr__(name: str) -> object:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module

    value: object = getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """The public names, imported or not: interactive shells complete them."""
    return list(__all__)
