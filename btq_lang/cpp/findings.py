"""Diagnostics of C++ files: differences between the ports of nodes and their code, and parts that cannot be read.

One invariant: a finding is at the line of C++ that it is about, and a comment `// btq: ignore[rule]` on that line, or
alone on the line above, silences it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Final

from btq_lang.cpp.macros import uncalled
from btq_lang.cpp.model import CppNodes, SourcePosition
from btq_lang.diagnostics.model import Diagnostic, Tag
from btq_lang.util.text import LineIndex, counted


def findings(nodes: CppNodes, texts: Mapping[str, str]) -> dict[str, tuple[Diagnostic, ...]]:
    """The diagnostics of some files, by path; those without any are left out."""
    lines: dict[str, LineIndex] = {}
    of_path: dict[str, list[Diagnostic]] = {}
    for rule, place, message in _rule_findings(nodes):
        index = lines.setdefault(place.path, LineIndex(texts[place.path]))
        if not _is_silenced(index, place.line - 1, rule):
            tags = (Tag.UNNECESSARY,) if rule == UNUSED else ()
            of_path.setdefault(place.path, []).append(Diagnostic(rule, place.span_in(index), message, tags=tags))
    return {path: tuple(sorted(each, key=lambda one: (one.span, one.rule))) for path, each in of_path.items()}


def nothing_registered(texts: Mapping[str, str]) -> str:
    """The message for some files that register no node."""
    advice = "also pass the files that call BT_REGISTER_NODES, registerNodeType, registerBuilder or CreateRosNodePlugin"
    if (macro := next(uncalled(texts), None)) is not None:
        advice = f"the macro `{macro.name}` in {macro.path} registers its argument: also pass the files that use it"
    return f"no node is registered in {counted(len(texts), 'C++ file')}; {advice}"


def _rule_findings(nodes: CppNodes) -> Iterator[tuple[str, SourcePosition, str]]:
    """Each finding: its rule, place and message; nodes that share a base class, and so a place, are named together."""
    names_by_finding: dict[tuple[str, SourcePosition, str], list[str]] = {}
    for node in nodes.nodes:
        for port in node.unread:
            message = f"provides the port `{port.name}`, but its code never names it"
            names_by_finding.setdefault((UNUSED, port.place, message), []).append(node.name)
        for use in node.undeclared:
            message = f"{'writes' if use.writes else 'reads'} the port `{use.port}`, which it does not provide"
            names_by_finding.setdefault((UNDECLARED, use.place, message), []).append(node.name)
    for (rule, place, message), names in names_by_finding.items():
        others = f" (like {counted(len(names) - 1, 'other node')})" if len(names) > 1 else ""
        yield rule, place, f"`{names[0]}`{others} {message}"
    for unseen in nodes.unseen:
        yield UNSEEN, unseen.place, unseen.message


def _is_silenced(lines: LineIndex, line: int, rule: str) -> bool:
    own = _IGNORE.search(lines.line(line))
    above = _IGNORE.match(lines.line(line - 1)) if line else None
    return any(each is not None and (each[1] is None or rule in re.split(r"[\s,]+", each[1])) for each in (own, above))


UNUSED: Final = "unused-port-in-cpp"
UNDECLARED: Final = "undeclared-port-in-cpp"
UNSEEN: Final = "unseen-in-cpp"
_IGNORE: Final = re.compile(r"\s*//\s*btq:\s*ignore(?![\w-])(?:\s*\[([^\]]*)\])?")
