"""What the tests of the checks assert, and how they write down what they expect: `tests/README.md` has it on one page.

`assert_problems(text, *problems)` says exactly what is wrong with some files, `assert_marked(text)` finds what is
expected in comments of the files themselves.  Both also hold every diagnostic against what is promised of all.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from textwrap import dedent

from btq_lang.btcpp.opening import file_of
from btq_lang.catalog.nav2 import PACKAGED
from btq_lang.checks import check
from btq_lang.commands.target import with_target
from btq_lang.diagnostics.model import Diagnostic, Fix
from btq_lang.diagnostics.rules import RULES
from btq_lang.projects.cpp_files import CppFiles
from btq_lang.util.record import replace
from btq_lang.util.text import Edit, LineIndex, apply_edits
from btq_lang.workspace.config import Project
from btq_lang.workspace.external_requirements import RequirementSettings
from btq_lang.workspace.file import CPP_SUFFIXES
from btq_lang.workspace.workspace import Workspace

MAIN = "main.btq"
MARKER = re.compile(r"(?P<where>next-line |file )?(?P<severity>error|warning|info|hint): \[(?P<rule>[\w-]+)\]")
COMMENT_WITH_MARKERS = re.compile(r"(?:#|<!--|//)\s*(?=(?:next-line |file )?(?:error|warning|info|hint): \[).*")

NODES = re.compile(
    r'^(?:#|<!--) (nodes = \["(?P<nodes>[\w-]+)"\]|engine = "(?P<engine>[\d.]+)") in btq.toml'
    r"(, and(?:: btq check --target| the target is) (?P<target>[\w.-]+))?(?: -->)?$",
    re.MULTILINE,
)

Announced = Counter[tuple[str, int, str, str]]  # (file, line, severity, rule)


def assert_problems(text: str, *problems: str, project: Project | None = None) -> None:
    """All that is wrong with some files, in order: `3:9 error unknown-node «Rety» unknown node `Rety``.

    Args:
        text: one file, or several that each begin with `//- path`; then each problem begins with `path:`.  A common
            indentation and the line end before it are not part of it.
    """
    files = split_files(text)
    workspace = workspace_of(files, project)
    found: list[str] = []
    for path in files:
        diagnostics = check(workspace, path)
        assert_sound(workspace, path, diagnostics)
        assert_fixes_mend(workspace, path, diagnostics)
        found += [f"{path}:{shown}" if len(files) > 1 else shown for shown in show(files[path], diagnostics)]
    assert found == list(problems)


def assert_clean(text: str, project: Project | None = None) -> None:
    """Nothing at all is wrong with some files."""
    assert_problems(text, project=project)


def assert_marked(text: str, name: str = "main.btq") -> None:
    """The diagnostics of some files are exactly those that comments in them announce.

    Args:
        name: what a single file is called; a name with .xml makes it one.
    """
    files = split_files(text, name)
    workspace = workspace_of(files)
    if given := NODES.search(text):
        nodes = (PACKAGED[given["nodes"]],) if given["nodes"] else ()
        engines = (given["engine"],) if given["engine"] else workspace.project.engines
        project = replace(workspace.project, node_files=nodes, engines=engines)
        target = given["target"] or given["nodes"] or given["engine"]
        workspace = with_target(workspace.with_project(project), target)
    if text.startswith('# approval = "required" in btq.toml'):
        settings = RequirementSettings(requires_approval=True)
        workspace = workspace.with_project(replace(workspace.project, requirements=settings))
    expected: Announced = Counter()
    found: Announced = Counter()
    for path, content in files.items():
        marks = announced(path, content)
        anywhere = {(severity, name) for _, line, severity, name in marks if line == -1}
        expected += marks
        diagnostics = check(workspace, path)
        assert_sound(workspace, path, diagnostics)
        assert_fixes_mend(workspace, path, diagnostics)
        for diagnostic in diagnostics:
            severity = diagnostic.effective_severity.value
            line = LineIndex(content).position(diagnostic.span.start).line
            found[path, -1 if (severity, diagnostic.rule) in anywhere else line, severity, diagnostic.rule] += 1
    assert found == expected


def assert_fix(text: str, title: str, fixed: str, *, safe: bool = False) -> None:
    """The first of some files has a diagnostic with a fix of this title, and applying it makes this of the files."""
    files = split_files(text)
    workspace = workspace_of(files)
    path = next(iter(files))
    fixes = [fix for diagnostic in check(workspace, path) for fix in diagnostic.fixes]
    assert title in [fix.title for fix in fixes]
    fix = next(fix for fix in fixes if fix.title == title)
    assert apply(files, path, fix) == split_files(fixed)
    assert fix.safe is safe


def assert_sound(workspace: Workspace, path: str, diagnostics: Sequence[Diagnostic], *, are_fewer: bool = True) -> None:
    """What holds for all diagnostics of whatever file: their places lie in their files, and after a safe fix its
    diagnostic is gone and there are fewer of them.  (What the parser's fixes do to torn files its own tests say.)

    Args:
        are_fewer: false where an item may be there twice: two that say the same do so no more when one is mended.
    """
    syntax = workspace.files[path].parsed.diagnostics
    texts = {other: file.source for other, file in workspace.files.items()}
    before = Counter(diagnostic.rule for diagnostic in diagnostics)
    assert list(diagnostics) == sorted(diagnostics, key=lambda diagnostic: (diagnostic.span, diagnostic.rule))
    for diagnostic in diagnostics:
        assert diagnostic.rule in RULES
        assert diagnostic.message
        places = [(diagnostic.span, path)]
        places += [(related.place.span, related.place.path or path) for related in diagnostic.related]
        places += [(change.place.span, change.place.path or path) for fix in diagnostic.fixes for change in fix.changes]
        for span, where in places:
            assert 0 <= span.start <= span.end <= len(texts[where])
        for fix in diagnostic.fixes:
            if fix.safe and diagnostic not in syntax:
                left = rules_after(workspace, path, fix)
                assert left[diagnostic.rule] < before[diagnostic.rule], fix.title
                # `no-models` is about a number of nodes: one more that is written out may be the last it takes.
                total, was = left.total() - left["no-models"], before.total() - before["no-models"]
                assert not are_fewer or total < was, fix.title


def assert_fixes_mend(workspace: Workspace, path: str, diagnostics: Sequence[Diagnostic]) -> None:
    """What holds for files that are right but for a few things: a fix that is not safe removes its diagnostic, too, and
    one that is safe adds none."""
    before = Counter(diagnostic.rule for diagnostic in diagnostics)
    for diagnostic in diagnostics:
        assert len({fix.title for fix in diagnostic.fixes}) == len(diagnostic.fixes)
        for fix in diagnostic.fixes:
            left = rules_after(workspace, path, fix)
            assert left[diagnostic.rule] < before[diagnostic.rule], fix.title
            assert not fix.safe or left < before, fix.title


def rules_after(workspace: Workspace, path: str, fix: Fix) -> Counter[str]:
    """How often each rule is broken in a file after a fix."""
    texts = apply({other: file.source for other, file in workspace.files.items()}, path, fix)
    return Counter(found.rule for found in check(workspace_of(texts, workspace.project), path))


def apply(files: Mapping[str, str], path: str, fix: Fix) -> dict[str, str]:
    """The files after a fix for a diagnostic of the one at `path`."""
    texts = dict(files)
    for target in {change.place.path or path for change in fix.changes}:
        changes = [change for change in fix.changes if (change.place.path or path) == target]
        texts[target] = apply_edits(texts[target], [Edit(change.place.span, change.text) for change in changes])
    return texts


def problems(text: str, *rules: str, project: Project | None = None, **others: str) -> list[Diagnostic]:
    """The diagnostics of some rules in a text, main.btq; `others` are files beside it, by names without `.btq`.  For
    texts in which other rules find something, too."""
    workspace = Workspace.of({**{f"{name}.btq": other for name, other in others.items()}, MAIN: text}, project)
    return [diagnostic for diagnostic in check(workspace, MAIN) if diagnostic.rule in rules]


def findings(text: str, *rules: str, project: Project | None = None, **others: str) -> list[str]:
    """As `problems`, each as `line severity «the text it points at» message`, lines counted from 1."""
    lines = LineIndex(text)
    return [
        f"{lines.position(found.span.start).line + 1} {found.effective_severity.value} "
        f"«{text[found.span.start : found.span.end]}» {found.message}"
        for found in problems(text, *rules, project=project, **others)
    ]


def fixes(text: str, *rules: str, project: Project | None = None, **others: str) -> list[tuple[str, bool, str]]:
    """Title, safety and resulting text of every fix that the rules offer."""
    found = problems(text, *rules, project=project, **others)
    return [(fix.title, fix.safe, after(text, fix)) for diagnostic in found for fix in diagnostic.fixes]


def after(text: str, fix: Fix) -> str:
    """The text after a fix that changes nothing but it."""
    (changed,) = apply({MAIN: text}, MAIN, fix).values()
    return changed


def show(text: str, diagnostics: Sequence[Diagnostic]) -> list[str]:
    """One line a diagnostic; lines and columns count from 1."""
    lines = LineIndex(text)
    shown = []
    for diagnostic in diagnostics:
        line, column = lines.position(diagnostic.span.start)
        pointed = text[diagnostic.span.start : diagnostic.span.end].replace("\n", "\\n")
        severity = diagnostic.effective_severity.value
        shown.append(f"{line + 1}:{column + 1} {severity} {diagnostic.rule} «{pointed}» {diagnostic.message}")
    return shown


def workspace_of(files: Mapping[str, str], project: Project | None = None) -> Workspace:
    """The workspace of some texts by path, those of XML and C++ files read as the loader reads them."""
    cpp = {path: text for path, text in files.items() if path.endswith(CPP_SUFFIXES)}
    read = CppFiles().files(cpp)[1] if cpp else {}
    known = {path: read[path] if path in read else file_of(path, text) for path, text in files.items()}
    project = project or Project()
    return Workspace(known, replace(project, node_files=tuple(dict.fromkeys((*project.node_files, *read)))))


def split_files(text: str, name: str = "main.btq") -> dict[str, str]:
    """The files of a fixture: one, or several that each begin with `//- path`."""
    text = dedent(text[1:]) if text.startswith("\n") else text
    if not text.startswith("//- "):
        return {name: text}
    files: dict[str, str] = {}
    for part in re.split(r"^//- ", text, flags=re.MULTILINE)[1:]:
        path, _, content = part.partition("\n")
        files[path.strip()] = content
    return files


def announced(path: str, text: str) -> Announced:
    """(file, line, severity, rule) of every marker; line -1: anywhere in the file."""
    found: Announced = Counter()
    for number, line in enumerate(text.split("\n")):
        comment = COMMENT_WITH_MARKERS.search(line)
        for marker in MARKER.finditer(comment[0]) if comment else ():
            at = {"next-line ": number + 1, "file ": -1, None: number}[marker["where"]]
            found[path, at, marker["severity"], marker["rule"]] += 1
    return found
