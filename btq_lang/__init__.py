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
    from btq_lang.btcpp.importing import Imported as Imported
    from btq_lang.btcpp.importing import import_xml as import_xml
    from btq_lang.checks import check as check
    from btq_lang.diagnostics.model import Diagnostic as Diagnostic
    from btq_lang.diff.changes import Change as Change
    from btq_lang.diff.comparison import diff_missions as diff_missions
    from btq_lang.evidence.verifying import Verification as Verification
    from btq_lang.evidence.verifying import verify_logs as verify_logs
    from btq_lang.formatter import format_text as format_text
    from btq_lang.graph.missions import draw_tree as draw_tree
    from btq_lang.parser import Parsed as Parsed
    from btq_lang.parser import parse as parse
    from btq_lang.projects.building import Built as Built
    from btq_lang.projects.building import build as build
    from btq_lang.projects.opening import open_workspace as open_workspace
    from btq_lang.syntax.tree import Node as Node
    from btq_lang.syntax.tree import Requirement as Requirement
    from btq_lang.syntax.tree import Tree as Tree
    from btq_lang.trace.missions import TraceTable as TraceTable
    from btq_lang.trace.missions import trace_table as trace_table
    from btq_lang.util.text import LineIndex as LineIndex
    from btq_lang.util.text import Span as Span
    from btq_lang.util.version import __version__ as __version__
    from btq_lang.workspace.workspace import Workspace as Workspace

_HOMES = {
    "Built": "projects.building",
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
    "build": "projects.building",
    "check": "checks",
    "diff_missions": "diff.comparison",
    "draw_tree": "graph.missions",
    "format_text": "formatter",
    "import_xml": "btcpp.importing",
    "open_workspace": "projects.opening",
    "parse": "parser",
    "trace_table": "trace.missions",
    "verify_logs": "evidence.verifying",
}
__all__ = [*_HOMES]


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
