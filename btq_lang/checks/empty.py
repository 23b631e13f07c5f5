"""Empty texts where a name is required, or where a reader expects a text."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.diagnostics.rules import Severity
from btq_lang.syntax import tree as syntax


def empty_text(view: View) -> Iterator[Diagnostic]:
    """An empty name, to which nothing can refer; or an empty text for readers."""
    if view.is_xml or not any(sign in view.text for sign in _EMPTY):
        return
    searched: object = view.item
    if isinstance(view.item, syntax.Tree):
        searched = (view.item.clauses, *[resolved.node.clauses for resolved in view.seen.demanding])
    for part in syntax.walk(searched):
        for field, what in _NAMES.get(type(part), {}).items():
            value = getattr(part, field)
            for word in value if isinstance(value, tuple) else (value,):
                if word is not None and word.raw in _EMPTY and not _is_without_content(part, what):
                    severity = Severity.HINT if what in _FOR_PEOPLE else None
                    yield Diagnostic("empty-text", word.span, f"{what} is empty", severity=severity)


def _is_without_content(part: object, what: str) -> bool:
    """Whether it is the title of a requirement that demands nothing, which is reported."""
    return what == _TITLE and isinstance(part, syntax.Requirement) and not part.clauses


_EMPTY: Final = ('""', "''", "{}")
_TITLE, _REASON = "this title", "this reason"
_FOR_PEOPLE: Final = (_TITLE, _REASON)
# Which fields of the syntax are names or such texts.
_NAMES: Final[dict[type, dict[str, str]]] = {
    syntax.Tags: {"names": "this tag"},
    syntax.QualityPath: {"names": "the quality's name"},
    syntax.QualityDecl: {"name": "the quality's name"},
    syntax.Requirement: {"name": "the requirement's ID", "text": _TITLE},
    syntax.Because: {"text": _REASON},
    syntax.Model: {"name": "the node's ID"},
    syntax.Port: {"type": "the port's type"},
    syntax.Signal: {"source": "the blackboard entry"},
    syntax.Root: {"name": "the main tree's name"},
}
