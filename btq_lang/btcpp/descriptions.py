"""The qualities and requirements of a node in its `_description`, for readers of the tree in Groot.

One invariant: the user's own text comes first, unchanged, and the rest follows a mark, at which an import cuts.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Final

from btq_lang.btcpp.document import escape
from btq_lang.btcpp.marks import marked_description
from btq_lang.btcpp.source import ExportSource
from btq_lang.catalog.name_kinds import Kind
from btq_lang.lexer import tokens
from btq_lang.syntax.tokens import COMMENT
from btq_lang.syntax.tree import (
    Apply,
    Approval,
    Entry,
    NodeClause,
    QualityPath,
    ReqRef,
    Requirement,
    Satisfices,
    Satisfies,
)
from btq_lang.workspace.file import File
from btq_lang.workspace.symbols import names_subject


def description(
    source: ExportSource, entry: Entry, clauses: tuple[NodeClause, ...], own: str | None, others: tuple[str, ...] = ()
) -> str | None:
    """The value of a `_description`, escaped; None if the node has no qualities or requirements.

    Args:
        own: the user's own text, escaped.
        others: lines on what holds for the node and is written elsewhere.
    """
    lines = tuple(dict.fromkeys((*(line for clause in clauses for line in _lines(source, entry, clause)), *others)))
    return marked_description(own, map(escape, lines)) if lines else None


def lines_from_elsewhere(source: ExportSource) -> Mapping[int, tuple[str, ...]]:
    """The lines that `apply` and claims with a subject of their own add to nodes, by `id(node)`."""
    files = [source.workspace.files[path] for path in source.scope.paths]
    if not any(_concerns_nodes(entry.item) for file in files for entry in file.parsed.entries):
        return {}
    from btq_lang.requirements.resolve import requirements  # few missions need it, and it resolves all requirements

    lines_by_node: dict[int, tuple[str, ...]] = {}
    for applied in requirements(source.workspace, source.path).applied:
        node = applied.node
        if node is not None and applied.how != "satisfies":
            line = _defined(source, applied.requirement.name, applied.argument_list)
            lines_by_node[id(node.node)] = (*lines_by_node.get(id(node.node), ()), line)
    return lines_by_node


def _concerns_nodes(item: object) -> bool:
    return isinstance(item, Apply) or names_subject(item)


def requirement_line(
    file: File, entry: Entry, requirement: Requirement, quality: QualityPath | None = None, arguments: str = ""
) -> str:
    """A requirement in one line: `rq1 (time-behaviour): Reach it in time; takes at most 30 s; on violation fail`.

    Args:
        quality: the enclosing one, if it does not name one itself.
        arguments: the arguments of its use, with the brackets.
    """
    paths = requirement.qualities or (() if quality is None else (quality,))
    name = requirement.name.text if requirement.name is not None else ""
    name += arguments
    head = f"{name} ({', '.join(path.names[-1].text for path in paths)})" if paths else name
    parts = [requirement.text.text] if requirement.text is not None else []
    parts += [
        _source_text(file, entry.start + clause.start, entry.start + clause.end)
        for clause in requirement.clauses
        if not isinstance(clause, Approval)  # which would change what is built
    ]
    return _on_one_line(f"{head}: {'; '.join(parts)}" if parts else head)


def _lines(source: ExportSource, entry: Entry, clause: NodeClause) -> Iterator[str]:
    if isinstance(clause, Satisfices):
        for quality in clause.qualities:
            yield f"satisfices {quality.path.text}"
            for requirement in quality.requirements:
                yield _requirement(source, entry, requirement, quality.path)
    elif isinstance(clause, Satisfies):
        for use in clause.uses:
            yield _reference(source, entry, use) if isinstance(use, ReqRef) else _requirement(source, entry, use, None)


def _reference(source: ExportSource, entry: Entry, reference: ReqRef) -> str:
    if not reference.arguments:
        return _defined(source, reference.name.text)
    start = entry.start + reference.name.end
    end = source.file.text.find(")", entry.start + reference.arguments[-1].name.end) + 1
    return _defined(source, reference.name.text, _source_text(source.file, start, max(start, end)))


def _requirement(source: ExportSource, entry: Entry, requirement: Requirement, quality: QualityPath | None) -> str:
    """A requirement written at a node: its definition, or a classic reference to one."""
    if requirement.is_reference and requirement.name is not None:
        return _defined(source, requirement.name.text)
    return requirement_line(source.file, entry, requirement, quality)


def _defined(source: ExportSource, name: str, arguments: str = "") -> str:
    definition = source.scope.find(Kind.REQUIREMENT, name)
    target = definition.symbol.target if definition is not None else None
    if definition is None or not isinstance(target, Requirement):
        return _on_one_line(name + arguments)
    return requirement_line(source.workspace.files[definition.path], definition.entry, target, None, arguments)


def _source_text(file: File, start: int, end: int) -> str:
    """The text between two offsets of a file, without comments, which brackets may hold."""
    text = file.text[start:end]
    if "#" in text or "//" in text or "/*" in text:
        text = "".join(token.text if token.kind != COMMENT else " " for token in tokens(text))
    return text


def _on_one_line(text: str) -> str:
    return _BLANKS.sub(" ", text).strip()


_BLANKS: Final = re.compile(r"[ \t\r\n]+")
