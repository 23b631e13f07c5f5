"""What to write where a node or a tree lacks its ID, in the words of the file: `SubTree <ID>`, or `ID="…"` in XML."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.syntax.tree import Pair
from btq_lang.util.text import Span


def missing_id(
    view: View, rule: str, span: Span, what: str, word: str, attributes: Iterable[Pair], notes: tuple[str, ...] = ()
) -> Diagnostic:
    """The error of a node or a tree without an ID.

    Args:
        span: where it is reported.
        what: the start of the message, what is missing.
        word: the word with which the node or tree begins.
        attributes: its attributes; one may be meant as the ID.
    """
    if not view.is_xml:
        return Diagnostic(rule, span, f"{what}: write `{word} <ID>`", notes=notes)
    meant = (pair.value.text for pair in attributes if pair.key.text.casefold() in _MEANT and pair.value is not None)
    return Diagnostic(rule, span, f'{what}: write `ID="{next(meant, "…")}"`', notes=notes)


_MEANT: Final = frozenset(("id", "name", "tree", "tree_id", "treeid", "tree_name", "ref", "type"))
