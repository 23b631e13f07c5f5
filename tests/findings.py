"""What tests of checks ask for: the findings of some rules in a text, and the text after one of their fixes."""

from __future__ import annotations

from btq_lang.checks import check
from btq_lang.diagnostics import Diagnostic, Fix
from btq_lang.project import Project
from btq_lang.text import Edit, LineIndex, apply_edits
from btq_lang.workspace import Workspace

PATH = "main.btq"


def diagnostics(text: str, *rules: str, project: Project | None = None, **others: str) -> list[Diagnostic]:
    """The diagnostics of these rules in a text; `others` are files beside it, by their names without `.btq`."""
    texts = {f"{name}.btq": other for name, other in others.items()}
    workspace = Workspace.of({**texts, PATH: text}, project)
    return [diagnostic for diagnostic in check(workspace, PATH) if diagnostic.rule in rules]


def findings(text: str, *rules: str, project: Project | None = None, **others: str) -> list[str]:
    """As `diagnostics`, each as `line severity «the text it points at» message`, lines counted from 1."""
    lines = LineIndex(text)
    return [
        f"{lines.position(found.span.start).line + 1} {found.effective_severity.value} "
        f"«{text[found.span.start : found.span.end]}» {found.message}"
        for found in diagnostics(text, *rules, project=project, **others)
    ]


def after(text: str, fix: Fix) -> str:
    """The text after a fix that changes nothing but it."""
    assert all(change.place.path in (None, PATH) for change in fix.changes)
    return apply_edits(text, [Edit(change.place.span, change.text) for change in fix.changes])


def fixes(text: str, *rules: str, project: Project | None = None, **others: str) -> list[tuple[str, bool, str]]:
    """Title, safety and resulting text of every fix that the rules offer."""
    found = diagnostics(text, *rules, project=project, **others)
    return [(fix.title, fix.safe, after(text, fix)) for diagnostic in found for fix in diagnostic.fixes]
