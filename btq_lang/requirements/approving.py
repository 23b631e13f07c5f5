"""Writing an approval into the text of a file.

One invariant: the new text says what the old one did, and one approval more: that is looked up in it.
"""

from __future__ import annotations

import re

from btq_lang.catalog.name_kinds import Kind
from btq_lang.requirements.approval import approval_state
from btq_lang.requirements.definitions import requirement
from btq_lang.syntax.scan import line_end, line_start
from btq_lang.syntax.tree import Approval, Requirement, quote
from btq_lang.util.text import Edit, Span, apply_edits
from btq_lang.workspace.file import Definition
from btq_lang.workspace.workspace import Workspace


def with_approval(
    workspace: Workspace, definition: Definition, by: str, on: str, *, keeps_date: bool = False
) -> tuple[str, str] | None:
    """The text of a file after one of its requirements was approved as it is, and the date of the approval that this
    replaces, empty without one; None if it cannot be written.

    The last approval by the same person is replaced; if it is of the same meaning and the same date, the text stays.

    Args:
        definition: of the requirement.
        on: the date, as ISO 8601 has it.
        keeps_date: whether the text stays also with another date.
    """
    path, name = definition.path, definition.symbol.name
    written, text = definition.symbol.target, workspace.files[path].text
    assert isinstance(written, Requirement), "its kind says so"
    fingerprint = workspace.store.ask(approval_state, path, name).fingerprint
    earlier = [
        clause for clause in written.clauses if isinstance(clause, Approval) and clause.by and clause.by.text == by
    ]
    last = earlier[-1] if earlier else None
    replaced = last.on.text if last is not None and last.on is not None else ""
    if last is not None and last.of is not None and last.of.text == fingerprint and (keeps_date or replaced == on):
        return text, ""
    clause = f"approved by {quote(by)} on {quote(on)} of {quote(fingerprint)}"
    if last is not None:
        edits = [Edit(Span(last.start, last.end).shifted(definition.entry.start), clause)]
    else:
        edits = [_in_block(text, definition, written, clause), _in_line(definition, written, clause)]
    for edit in edits:
        changed = apply_edits(text, [edit])
        if _is_approved(workspace.with_file(path, changed), path, name, by, fingerprint):
            return changed, replaced
    return None


def _in_block(text: str, definition: Definition, written: Requirement, clause: str) -> Edit:
    """A line of its own below the last clause."""
    end = line_end(text, definition.entry.start + written.end)
    head = line_start(text, 0, definition.entry.start + written.start)
    last = line_start(text, 0, definition.entry.start + written.end)
    blanks = _BLANKS.match(text, last)[0]  # type: ignore[index]  # it matches anything
    if head == last:
        blanks += "\t" if "\t" in blanks or "\n\t" in text else "    "
    newline = "\r\n" if text[end : end + 2] == "\r\n" else "\n"
    return Edit(Span(end, end), f"{newline}{blanks}{clause}")


def _in_line(definition: Definition, written: Requirement, clause: str) -> Edit:
    """After the last clause, on its line: in brackets, and before another requirement."""
    end = definition.entry.start + written.end
    return Edit(Span(end, end), f" {clause}")


def _is_approved(workspace: Workspace, path: str, name: str, by: str, fingerprint: str) -> bool:
    """Whether a requirement has that approval, and the file has no mistakes of syntax but those that it had."""
    store = workspace.store
    resolved, _ = store.ask(requirement, path, name)
    approvals = [(each.by, each.fingerprint) for each in resolved.approvals] if resolved is not None else []
    changed = workspace.scope(path).find(Kind.REQUIREMENT, name)
    if changed is None or changed.entry.diagnostics or (by, fingerprint) not in approvals:
        return False
    return store.ask(approval_state, path, name).fingerprint == fingerprint


_BLANKS = re.compile(r"[ \t]*")
