"""Every rule's page is its test: the diagnostics that its examples announce are exactly those that are found.

`tests/README.md` explains the markers.
"""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import pytest

from btq_lang import rules
from btq_lang.checks import check
from btq_lang.diagnostics import Diagnostic
from btq_lang.rules import RULES, page
from btq_lang.text import Edit, LineIndex, apply_edits
from btq_lang.workspace import Workspace

PAGES = Path(rules.__file__).parent
BLOCK = re.compile(r"^```btq\n(.*?)^```$", re.DOTALL | re.MULTILINE)
MARKER = re.compile(r"(?P<where>next-line |file )?(?P<severity>error|warning|info|hint): \[(?P<rule>[\w-]+)\]")
COMMENT_WITH_MARKERS = re.compile(r"#\s*(?=(?:next-line |file )?(?:error|warning|info|hint): \[).*")


def split_files(block: str) -> dict[str, str]:
    """The files of a block: one, or several that each begin with `//- path`."""
    if not block.startswith("//- "):
        return {"main.btq": block}
    files: dict[str, str] = {}
    for part in re.split(r"^//- ", block, flags=re.MULTILINE)[1:]:
        path, _, text = part.partition("\n")
        files[path.strip()] = text
    return files


def announced(path: str, text: str) -> Counter[tuple[str, int, str, str]]:
    """(file, line, severity, rule) of every marker; line -1: anywhere in the file."""
    found: Counter[tuple[str, int, str, str]] = Counter()
    for number, line in enumerate(text.split("\n")):
        comment = COMMENT_WITH_MARKERS.search(line)
        for marker in MARKER.finditer(comment[0]) if comment else ():
            at = {"next-line ": number + 1, "file ": -1, None: number}[marker["where"]]
            found[path, at, marker["severity"], marker["rule"]] += 1
    return found


def line_of(text: str, diagnostic: Diagnostic) -> int:
    return LineIndex(text).position(diagnostic.span.start).line


def blocks() -> list[tuple[str, str]]:
    found = []
    for rule in RULES:
        path = PAGES / f"{rule}.md"
        if path.exists():
            for match in BLOCK.finditer(path.read_text(encoding="utf-8")):
                found.append((rule, match[1]))
    return found


def test_there_is_a_page_for_every_rule_and_a_rule_for_every_page() -> None:
    assert {path.stem for path in PAGES.glob("*.md")} == set(RULES)


@pytest.mark.parametrize("rule", RULES)
def test_a_page_shows_its_rule_at_work_and_a_clean_file(rule: str) -> None:
    text = page(rule)
    assert text.startswith(f"# {rule}\n")
    examples = [match[1] for match in BLOCK.finditer(text)]
    rules_shown = {marker["rule"] for example in examples for marker in MARKER.finditer(example)}
    assert rule in rules_shown
    assert any(not MARKER.search(example) for example in examples)


@pytest.mark.parametrize(("rule", "block"), blocks())
def test_the_examples_of_a_page(rule: str, block: str) -> None:
    files = split_files(block)
    workspace = Workspace.of(files)
    expected: Counter[tuple[str, int, str, str]] = Counter()
    found: Counter[tuple[str, int, str, str]] = Counter()
    for path, text in files.items():
        marks = announced(path, text)
        anywhere = {(severity, name) for _, line, severity, name in marks if line == -1}
        expected += marks
        for diagnostic in check(workspace, path):
            severity = diagnostic.effective_severity.value
            line = -1 if (severity, diagnostic.rule) in anywhere else line_of(text, diagnostic)
            found[path, line, severity, diagnostic.rule] += 1
    assert found == expected


@pytest.mark.parametrize(("rule", "block"), blocks())
def test_a_safe_fix_removes_its_diagnostic_and_adds_none(rule: str, block: str) -> None:
    files = split_files(block)
    workspace = Workspace.of(files)
    for path in files:
        before = check(workspace, path)
        for diagnostic in before:
            for fix in diagnostic.fixes:
                texts = dict(files)
                for target in {change.place.path or path for change in fix.changes}:
                    changes = [change for change in fix.changes if (change.place.path or path) == target]
                    edits = [Edit(change.place.span, change.text) for change in changes]
                    texts[target] = apply_edits(texts[target], edits)
                after = check(Workspace.of(texts), path)
                left = Counter(found.rule for found in after)
                assert left[diagnostic.rule] < Counter(found.rule for found in before)[diagnostic.rule], fix.title
                if fix.safe:
                    assert left < Counter(found.rule for found in before), fix.title
