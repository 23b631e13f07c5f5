"""Code actions: the fixes of diagnostics, all safe ones at once, and refactorings of what stands at a place."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from btq_lang.checks import check
from btq_lang.diagnostics import Diagnostic, Fix
from btq_lang.features.refactor import refactorings
from btq_lang.features.short_form import short_form
from btq_lang.fixes import fixed
from btq_lang.record import Record
from btq_lang.rules import UNREADABLE
from btq_lang.scan import string_end
from btq_lang.text import Edit, Position, Span
from btq_lang.tokens import COMMENT, STRING
from btq_lang.workspace import Workspace

QUICK_FIX, REFACTOR, FIX_ALL = "quickfix", "refactor", "source.fixAll"


class Action(Record):
    """Something that can be done.

    Attributes:
        kind: as LSP has them, dots between: quickfix, refactor.extract, refactor.inline, refactor.rewrite,
            source.fixAll.
        edits: what it changes, by file.
        diagnostic: what it mends.
        preferred: it is what is most likely wanted.
    """

    title: str
    kind: str
    edits: Mapping[str, tuple[Edit, ...]]
    diagnostic: Diagnostic | None = None
    preferred: bool = False


def code_actions(
    workspace: Workspace, path: str, span: Span, only: Sequence[str] = (), found: Sequence[Diagnostic] | None = None
) -> tuple[Action, ...]:
    """What can be done at a stretch of a file.

    Args:
        only: kinds that are wanted, with all below them; none: everything.
        found: the diagnostics of the file, if somebody has them already.
    """

    def wanted(kind: str) -> bool:
        return not only or any(kind == one or kind.startswith(f"{one}.") or one.startswith(f"{kind}.") for one in only)

    diagnostics = tuple(check(workspace, path) if found is None else found)
    actions: list[Action] = []
    if wanted(QUICK_FIX):
        here = [one for one in diagnostics if one.span.start <= span.end and span.start <= one.span.end]
        for diagnostic in here:
            actions += _fixes(workspace, path, diagnostic)
        actions += _silencing(workspace, path, here)
    if wanted(REFACTOR):
        for made in (*refactorings(workspace, path, span.start), *short_form(workspace, path, span.start, diagnostics)):
            if wanted(made.kind):
                actions.append(Action(made.title, made.kind, made.edits))
    if wanted(FIX_ALL):
        actions += _fix_all(workspace, path, diagnostics)
    return tuple(actions)


def _fixes(workspace: Workspace, path: str, diagnostic: Diagnostic) -> Iterator[Action]:
    for fix in diagnostic.fixes:
        edits = edits_of(fix, path)
        if all(workspace.files[target].origin is None for target in edits):
            yield Action(fix.title, QUICK_FIX, edits, diagnostic, fix.safe)


def edits_of(fix: Fix, path: str) -> dict[str, tuple[Edit, ...]]:
    """What a fix of a diagnostic changes, by file."""
    edits: dict[str, tuple[Edit, ...]] = {}
    for change in fix.changes:
        target = change.place.path or path
        edits[target] = (*edits.get(target, ()), Edit(change.place.span, change.text))
    return edits


def _silencing(workspace: Workspace, path: str, found: Sequence[Diagnostic]) -> Iterator[Action]:
    """A comment at the end of the line that silences a rule there, where one can be written and is heeded."""
    file = workspace.files[path]
    for diagnostic in found:
        line = file.lines.position(diagnostic.span.start).line
        end = file.lines.offset(Position(line, len(file.lines.line(line))))
        inside = any(
            token.start < end <= token.end and _runs_on(token.text, token.kind) for token in file.parsed.tokens
        )
        if diagnostic.rule in UNREADABLE or inside:
            continue
        comment = f"  # btq: ignore[{diagnostic.rule}]"
        title = f"Silence `{diagnostic.rule}` on this line"
        yield Action(title, QUICK_FIX, {path: (Edit(Span(end, end), comment),)}, diagnostic)


def _runs_on(text: str, kind: int) -> bool:
    """Whether nothing can be written behind a token on its line: a comment, or a text that goes on or is not closed."""
    if kind == STRING and string_end(text, 1, text[0]) < 0:
        return True
    return kind == COMMENT or ("\n" in text.strip() or "\r" in text.strip())


def _fix_all(workspace: Workspace, path: str, diagnostics: Sequence[Diagnostic]) -> Iterator[Action]:
    texts, count = fixed(workspace, {path: diagnostics})
    if path in texts:
        whole = Span(0, len(workspace.files[path].text))
        title = f"Apply {count} safe fix{'es' if count > 1 else ''}"
        yield Action(title, f"{FIX_ALL}.btq", {path: (Edit(whole, texts[path]),)})
