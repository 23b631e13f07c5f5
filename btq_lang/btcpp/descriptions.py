"""What a `_description` says of the qualities and requirements of a node, for those who look at the tree in Groot.

One invariant: what the user wrote stands first, unchanged, and the rest behind a mark by which an import cuts it off.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from btq_lang.btcpp.document import escape
from btq_lang.btcpp.marks import marked_description
from btq_lang.btcpp.source import Source
from btq_lang.lexer import tokens
from btq_lang.symbols import Kind
from btq_lang.syntax import Entry, NodeClause, QualityPath, ReqRef, Requirement, Satisfices, Satisfies
from btq_lang.tokens import COMMENT
from btq_lang.workspace import File

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from typing import Final


def description(source: Source, entry: Entry, clauses: tuple[NodeClause, ...], own: str | None) -> str | None:
    """The value of a `_description`, as it is spelt; None where the clauses say nothing about qualities.

    Args:
        own: what the user wrote, as it is spelt.
    """
    lines = tuple(dict.fromkeys(line for clause in clauses for line in _lines(source, entry, clause)))
    return marked_description(own, map(escape, lines)) if lines else None


def requirement_line(
    file: File, entry: Entry, requirement: Requirement, quality: QualityPath | None = None, arguments: str = ""
) -> str:
    """A requirement in one line: `rq1 (time-behaviour): Reach it in time; takes at most 30 s; on violation fail`.

    Args:
        quality: the one that encloses it, where it names none itself.
        arguments: what a use of it gives to its parameters, with the brackets.
    """
    path = requirement.quality or quality
    name = requirement.name.text if requirement.name is not None else ""
    name += arguments
    head = f"{name} ({path.names[-1].text})" if path is not None else name
    said = [requirement.text.text] if requirement.text is not None else []
    said += [_source_text(file, entry.start + clause.start, entry.start + clause.end) for clause in requirement.clauses]
    return _on_one_line(f"{head}: {'; '.join(said)}" if said else head)


def _lines(source: Source, entry: Entry, clause: NodeClause) -> Iterator[str]:
    if isinstance(clause, Satisfices):
        for quality in clause.qualities:
            yield f"satisfices {'.'.join(name.text for name in quality.path.names)}"
            for requirement in quality.requirements:
                yield _requirement(source, entry, requirement, quality.path)
    elif isinstance(clause, Satisfies):
        for use in clause.uses:
            yield _reference(source, entry, use) if isinstance(use, ReqRef) else _requirement(source, entry, use, None)


def _reference(source: Source, entry: Entry, reference: ReqRef) -> str:
    if not reference.arguments:
        return _defined(source, reference.name.text)
    start = entry.start + reference.name.end
    end = source.file.text.find(")", entry.start + reference.arguments[-1].name.end) + 1
    return _defined(source, reference.name.text, _source_text(source.file, start, max(start, end)))


def _requirement(source: Source, entry: Entry, requirement: Requirement, quality: QualityPath | None) -> str:
    """A requirement that stands at a node: its definition, or a classic reference to one."""
    if requirement.is_reference and requirement.name is not None:
        return _defined(source, requirement.name.text)
    return requirement_line(source.file, entry, requirement, quality)


def _defined(source: Source, name: str, arguments: str = "") -> str:
    definition = source.scope.find(Kind.REQUIREMENT, name)
    target = definition.symbol.target if definition is not None else None
    if definition is None or not isinstance(target, Requirement):
        return _on_one_line(name + arguments)
    return requirement_line(source.workspace.files[definition.path], definition.entry, target, None, arguments)


def _source_text(file: File, start: int, end: int) -> str:
    """What stands between two places of a file, without comments, which brackets may hold."""
    text = file.text[start:end]
    if "#" in text or "//" in text or "/*" in text:
        text = "".join(token.text if token.kind != COMMENT else " " for token in tokens(text))
    return text


def _on_one_line(text: str) -> str:
    return _BLANKS.sub(" ", text).strip()


_BLANKS: Final = re.compile(r"[ \t\r\n]+")
