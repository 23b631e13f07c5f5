"""Code actions: fixes of diagnostics, all safe ones at once, removal of what is unused, refactorings of a place."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from btq_lang.btcpp.marks import is_generated
from btq_lang.btcpp.opening import with_source
from btq_lang.checks import check
from btq_lang.checks.silencing import at_line_end, before_element, line_to_silence
from btq_lang.diagnostics.model import Diagnostic, Fix
from btq_lang.ide.meaning import entry_at
from btq_lang.ide.refactor import Action, refactorings
from btq_lang.ide.short_form import short_form
from btq_lang.ide.unused import UNUSED, needless_includes, removal, without
from btq_lang.util.spelling import did_you_mean, near
from btq_lang.util.text import Edit, Span
from btq_lang.workspace.fixes import fixed
from btq_lang.workspace.workspace import Workspace

QUICK_FIX, REFACTOR, FIX_ALL, ORGANIZE = "quickfix", "refactor", "source.fixAll.btq", "source.organizeImports.btq"


def code_actions(
    workspace: Workspace,
    path: str,
    span: Span,
    only: Sequence[str] = (),
    diagnostics: Sequence[Diagnostic] | None = None,
) -> tuple[Action, ...]:
    """The code actions for a span of a file; of XML those that mend it.

    Args:
        span: counted from the start of the file on the disk, as are all edits.
        only: the kinds to return, with all their subkinds; none: every kind.
        diagnostics: those of the file; None: they are computed.
    """

    def wanted(kind: str) -> bool:
        return not only or any(one in ("", kind) or kind.startswith(f"{one}.") for one in only)

    is_foreign = workspace.files[path].is_foreign
    diagnostics = tuple(check(workspace, path) if diagnostics is None else diagnostics)
    actions: list[Action] = []
    if wanted(QUICK_FIX):
        touching = [one for one in diagnostics if one.span.touches(span)]
        for diagnostic in touching:
            actions += _fixes(workspace, path, diagnostic)
            actions += () if is_foreign else _removal(workspace, path, diagnostic)
        for include in () if is_foreign else needless_includes(workspace, path):
            if include.span.touches(span):
                title = f"Remove the {include.why} include `{include.name}`"
                actions.append(Action(title, QUICK_FIX, {path: without(workspace.files[path], [include.span])}))
        actions += _silencing(workspace, path, touching)
    if not is_foreign and (not only or any(one == "" or one.split(".")[0] == REFACTOR for one in only)):
        for refactoring in (
            *refactorings(workspace, path, span.start),
            *short_form(workspace, path, span.start, diagnostics),
        ):
            actions += [refactoring] if wanted(refactoring.kind) else []
    if wanted(FIX_ALL):
        actions += _fix_all(workspace, path, diagnostics)
    if not is_foreign and wanted(ORGANIZE) and (needless := needless_includes(workspace, path)):
        title = f"Remove {len(needless)} duplicate or unused include{'s' if len(needless) > 1 else ''}"
        edits = without(workspace.files[path], [include.span for include in needless])
        actions.append(Action(title, ORGANIZE, {path: edits}))
    return tuple(actions)


def _fixes(workspace: Workspace, path: str, diagnostic: Diagnostic) -> Iterator[Action]:
    obvious = _obvious(diagnostic, workspace.files[path].source)
    for fix in diagnostic.fixes:
        yield Action(fix.title, QUICK_FIX, edits_of(fix, path), diagnostic, fix is obvious)


def _obvious(diagnostic: Diagnostic, text: str) -> Fix | None:
    """The one fix that needs no choice: a safe one, or the only similar name for a misspelt word, if it is offered
    first."""
    safe = [fix for fix in diagnostic.fixes if fix.safe]
    respelt = [fix for fix in diagnostic.fixes if _respells(fix, diagnostic, text)]
    return next(iter(safe), respelt[0] if len(respelt) == 1 and respelt[0] is diagnostic.fixes[0] else None)


def _respells(fix: Fix, diagnostic: Diagnostic, text: str) -> bool:
    """Whether a fix replaces a word by a similar name, or by the one that the message suggests."""
    places = [(change.place.path, text[slice(*change.place.span)], change.text) for change in fix.changes]
    if len(set(places)) != 1 or places[0][0] is not None:  # the end tag of an element has its name too
        return False
    word, name = (each.strip(_QUOTES) for each in places[0][1:])
    if not word or not (name[:1].isalpha() or name[:1] == "_"):
        return False  # a number that is replaced by another is not misspelt
    return bool(near(word, (name,))) or diagnostic.message.endswith(did_you_mean((name,)))


def _removal(workspace: Workspace, path: str, diagnostic: Diagnostic) -> Iterator[Action]:
    """The removal of an item that a rule reports as unused."""
    unused = UNUSED.get(diagnostic.rule)
    entry = entry_at(workspace, path, diagnostic.span.start)
    if unused is not None and entry is not None:
        file = workspace.files[path]
        title = f"Remove the {unused} `{file.text[diagnostic.span.start : diagnostic.span.end].strip(_QUOTES)}`"
        yield Action(title, QUICK_FIX, {path: removal(file, entry)}, diagnostic)


def edits_of(fix: Fix, path: str) -> dict[str, tuple[Edit, ...]]:
    """The edits of a fix, by file."""
    edits: dict[str, tuple[Edit, ...]] = {}
    for change in fix.changes:
        target = change.place.path or path
        edits[target] = (*edits.get(target, ()), Edit(change.place.span, change.text))
    return edits


def _silencing(workspace: Workspace, path: str, diagnostics: Sequence[Diagnostic]) -> Iterator[Action]:
    """A comment that silences a rule, at the end of the line or before the XML's element, if it can be written and has
    an effect."""
    file = workspace.files[path]
    if is_generated(file.source):
        return
    comment, where = (at_line_end, "on this line") if not file.is_foreign else (before_element, "at this element")
    for diagnostic in diagnostics:
        line = line_to_silence(file, diagnostic)
        edit = comment(file, line, (diagnostic.rule,)) if line is not None else None
        if edit is not None:
            yield Action(f"Silence `{diagnostic.rule}` {where}", QUICK_FIX, {path: (edit,)}, diagnostic)


def _fix_all(workspace: Workspace, path: str, diagnostics: Sequence[Diagnostic]) -> Iterator[Action]:
    """All safe fixes at once; fixes that overlap with others come in further rounds."""
    before = workspace.files[path].source
    total = 0
    while True:
        wanted = sum(any(fix.safe for fix in diagnostic.fixes) for diagnostic in diagnostics)
        texts, count = fixed(workspace, {path: diagnostics})
        if path not in texts:
            break
        total += count
        workspace = with_source(workspace, path, texts[path])
        if count == wanted:
            break
        diagnostics = check(workspace, path)
    if total:
        title = f"Apply {total} safe fix{'es' if total > 1 else ''}"
        yield Action(title, FIX_ALL, {path: (Edit(Span(0, len(before)), workspace.files[path].source),)})


_QUOTES = " \t\"'"
