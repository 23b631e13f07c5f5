"""Signals and contexts to which nothing in the mission refers."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.catalog.name_kinds import Kind
from btq_lang.checks import lookups
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Tag
from btq_lang.syntax.tree import Context, Signal, Word
from btq_lang.util.spelling import near
from btq_lang.workspace.queries import Store
from btq_lang.workspace.workspace import Workspace


def unused_signal(view: View) -> Iterator[Diagnostic]:
    """A signal that no condition, no bound and no `uses` names."""
    if isinstance(view.item, Signal):
        yield from _unused(view, Kind.SIGNAL, view.item.name, "unused-signal", "no clause uses the signal")


def unused_context(view: View) -> Iterator[Diagnostic]:
    """A context that no condition names."""
    if isinstance(view.item, Context):
        yield from _unused(view, Kind.CONTEXT, view.item.name, "unused-context", "no condition uses the context")


def _unused(view: View, kind: Kind, name: Word | None, rule: str, message: str) -> Iterator[Diagnostic]:
    if name is None or not view.has_trees or view.is_used_elsewhere:
        return  # a file of signals, or a library: their users may be anywhere
    if not view.defines_here(kind, name.text) or view.look_up(lookups.is_asked_for, name.text):
        return
    if not view.ask(_is_meant, name.text) and view.is_read:  # else its user may be on a line that could not be read
        yield Diagnostic(rule, name.span, f"{message} `{name.text}`", tags=(Tag.UNNECESSARY,))


def _is_meant(store: Store[Workspace], viewpoint: str, name: str) -> bool:
    """Whether something uses an undeclared name that looks like this one, which is reported already."""
    view = View(store, viewpoint)
    asked = view.look_up(lookups.asked_for_in_vain)
    declared = len(view.names(Kind.SIGNAL)) + len(view.names(Kind.CONTEXT))
    if len(asked) * declared > _MOST_COMPARED:
        return True  # among so many unknown names there is a similar one to any
    return bool(near(name, asked, limit=1))


_MOST_COMPARED = 200_000  # pairs of names: some tenths of a second
