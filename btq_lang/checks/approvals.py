"""Approvals of an earlier meaning of a requirement, and requirements without one in projects that want approvals."""

from __future__ import annotations

import shlex
from collections.abc import Iterator
from typing import TYPE_CHECKING

from btq_lang.catalog.name_kinds import Kind
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.syntax.tree import Approval, Refines, Requirement, written
from btq_lang.workspace.symbols import Symbol

if TYPE_CHECKING:
    from btq_lang.requirements.approval import ApprovalState


def approval_outdated(view: View) -> Iterator[Diagnostic]:
    """An approval of a requirement that means something else now, or that refines one that does."""
    for symbol, requirement in view.requirements:
        if not any(isinstance(clause, Approval) for clause in requirement.clauses):
            continue
        if view.defines_here(Kind.REQUIREMENT, symbol.name):
            from btq_lang.requirements.approval import approval_state  # few files have approvals

            yield from _outdated(view, symbol, requirement, view.ask(approval_state, symbol.name))


def _outdated(view: View, symbol: Symbol, requirement: Requirement, state: ApprovalState) -> Iterator[Diagnostic]:
    again = f"if it is still right, `btq approve {written(symbol.name)} --by NAME` approves it as it is"
    for approval in state.outdated:
        message = f"`{symbol.name}` has changed since {approval.by} approved it on {approval.on}"
        yield Diagnostic("approval-outdated", approval.place.span, message, notes=(_what_changed(view, symbol), again))
    for name in [name for clause in requirement.clauses if isinstance(clause, Refines) for name in clause.names]:
        if name.text in state.changed:
            message = (
                f"`{symbol.name}` was approved, but `{name.text}`, which it refines, has changed since its approval"
            )
            yield Diagnostic("approval-outdated", name.span, message)


def _what_changed(view: View, symbol: Symbol) -> str:
    """What is known of the difference: a fingerprint tells what was added, but not what was changed or removed."""
    from btq_lang.requirements.approval import added_since_approval

    added = view.ask(added_since_approval, symbol.name)
    if added:
        return f"`{added}` was added since then"
    return "`btq diff` shows what has changed between two versions of a file"


def approval_missing(view: View) -> Iterator[Diagnostic]:
    """A requirement without an approval, or with one that nothing outdates, in a project that requires approvals."""
    settings = view.project.requirements
    if settings is None or not settings.requires_approval:
        return
    for symbol, requirement in view.requirements:
        if not any(isinstance(clause, Approval) for clause in requirement.clauses):
            message = f"`{symbol.name}` is not approved"
            notes = (f"`btq approve {written(symbol.name)} --by NAME` approves it",)
            yield Diagnostic("approval-missing", symbol.span, message, notes=notes)
        elif view.defines_here(Kind.REQUIREMENT, symbol.name):
            yield from _unmarked(view, symbol)


def _unmarked(view: View, symbol: Symbol) -> Iterator[Diagnostic]:
    from btq_lang.requirements.approval import approval_state  # as above

    for approval in view.ask(approval_state, symbol.name).unmarked:
        message = f"the approval of `{symbol.name}` by {approval.by} has no fingerprint, so no change is noticed"
        arguments = f"--by {shlex.quote(approval.by)} --date {shlex.quote(approval.on)}"
        notes = (f"if it is of what is written now, `btq approve {written(symbol.name)} {arguments}` adds it",)
        yield Diagnostic("approval-missing", approval.place.span, message, notes=notes)
