"""Conditions of requirements and contexts."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from btq_lang.catalog.name_kinds import Kind
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, replace_fix
from btq_lang.syntax.tokens import NAME
from btq_lang.syntax.tree import Clause, Context, Operand, ReqRef, Requirement, Tree, walk
from btq_lang.workspace.symbols import requirements_at


def subtraction_without_blanks(view: View) -> Iterator[Diagnostic]:
    """`full-empty`, one name, where only `full` and `empty` are known: a subtraction needs blanks."""
    for operand in _operands(view):
        word = operand.word
        if word.kind != NAME or "-" not in word.text or _is_known(view, word.text):
            continue
        for at, character in enumerate(word.text):
            left, right = word.text[:at], word.text[at + 1 :]
            if character == "-" and _is_known(view, left) and _is_known(view, right):
                yield Diagnostic(
                    "subtraction-without-blanks",
                    word.span,
                    f"undefined name `{word.text}`; write spaces around `-` to subtract",
                    notes=("without spaces `-` is part of the name",),
                    fixes=(replace_fix(f"Write `{left} - {right}`", word.span, f"{left} - {right}", safe=True),),
                )
                break


def _operands(view: View) -> Iterator[Operand]:
    item = view.item
    if isinstance(item, Tree):
        clauses = (item.clauses, *[seen.node.clauses for seen in view.seen.demanding])
        roots: Iterable[Requirement | ReqRef | Context] = (
            requirement for each in clauses for requirement in requirements_at(each)
        )
    elif isinstance(item, Requirement | Context):
        roots = (item,)
    else:
        return
    text = view.text
    for root in roots:
        # Other parts of a requirement are words: its name, its quality, its text.
        parts: tuple[object, ...] = root.arguments if isinstance(root, ReqRef) else ()
        clauses_of: tuple[Clause | Context, ...] = (root,) if isinstance(root, Context) else ()
        if isinstance(root, Requirement):
            parts, clauses_of = root.parameters, root.clauses
        # Nearly all clauses are without a `-`, and need not be searched word by word.
        minus = [each for each in clauses_of if "-" in text[each.start : each.end]]
        for part in walk((*parts, *minus)):
            if isinstance(part, Operand):
                yield part


def _is_known(view: View, name: str) -> bool:
    if any(view.find(kind, name) for kind in (Kind.SIGNAL, Kind.CONTEXT)):
        return True
    item = view.item
    return isinstance(item, Requirement) and any(parameter.name.text == name for parameter in item.parameters)
