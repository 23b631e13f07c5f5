"""Applying fixes: which of them can be applied together, and the resulting texts.

In a module of its own because a plain check applies none and does not import it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from btq_lang.diagnostics.model import Diagnostic, Fix
from btq_lang.util.text import Edit, apply_edits
from btq_lang.workspace.workspace import Workspace


def fixed(workspace: Workspace, findings: Mapping[str, Sequence[Diagnostic]]) -> tuple[dict[str, str], int]:
    """The texts of files after their safe fixes, and the number of applied ones.

    Of overlapping fixes only the first is applied; a second round may apply the next.

    Args:
        findings: the diagnostics of each file that may be changed; a fix that would change another file is left out.
    """
    edits: dict[str, list[Edit]] = {path: [] for path in findings}
    count = 0
    for path, diagnostics in findings.items():
        for diagnostic in diagnostics:
            fix = next((fix for fix in diagnostic.fixes if fix.safe), None)
            if fix is not None and _fits(fix, path, edits):
                count += 1
                for change in fix.changes:
                    edits[change.place.path or path].append(Edit(change.place.span, change.text))
    texts = {path: apply_edits(workspace.files[path].source, changes) for path, changes in edits.items() if changes}
    return texts, count


def _fits(fix: Fix, path: str, edits: Mapping[str, list[Edit]]) -> bool:
    for change in fix.changes:
        others = edits.get(change.place.path or path)
        if others is None or any(edit.span.touches(change.place.span) for edit in others):
            return False
    return True
