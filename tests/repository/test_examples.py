"""The examples and every ```btq block of the documentation: whole files in which nothing is wrong.

The files are found, not listed: a new example is tested by being there.
"""

from __future__ import annotations

import json
import re
from collections import Counter
from pathlib import Path

import pytest
from in_process import run_btq

from btq_lang.checks import check
from btq_lang.diagnostics.rules import Severity
from btq_lang.formatter import format_text
from btq_lang.parser import parse
from btq_lang.projects.external_files import ExternalFiles
from btq_lang.workspace.file import File
from btq_lang.workspace.loader import find_project, load
from btq_lang.workspace.workspace import Workspace

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = sorted(path for path in (ROOT / "examples").rglob("*") if path.suffix in (".btq", ".qualitybtcpp"))
PAGES = sorted([*(ROOT / "docs").glob("*.md"), *(ROOT / "examples").rglob("*.md")])
README = ROOT / "README.md"
FOLDERS = sorted(path for path in (ROOT / "examples").iterdir() if path.is_dir())

_MISSIONS = {"hospital": 2, "published": 3}  # others have one
_BLOCK = re.compile(r"^```btq\n(.*?)^```$", re.DOTALL | re.MULTILINE)


def blocks(pages: list[Path]) -> list[tuple[str, str]]:
    """Every ```btq block of pages: where it begins, and its text."""
    found = []
    for page in pages:
        text = page.read_text("utf-8")
        for match in _BLOCK.finditer(text):
            line = text.count("\n", 0, match.start()) + 1
            found.append((f"{page.relative_to(ROOT)}:{line}", match[1]))
    return found


def files_and_blocks() -> list[object]:
    files = [(str(path.relative_to(ROOT)), path.read_text("utf-8")) for path in EXAMPLES]
    return [pytest.param(text, id=place) for place, text in [*files, *blocks([*PAGES, README])]]


def test_examples_are_found() -> None:
    assert [folder.name for folder in FOLDERS] == [
        "classic",
        "hospital",
        "inspection",
        "laboratory",
        "navigation",
        "paper",
        "pick-and-place",
        "published",
    ]
    for folder in FOLDERS:
        assert (folder / "README.md").is_file()
        assert [path for path in EXAMPLES if folder in path.parents]


@pytest.mark.parametrize("text", files_and_blocks())
def test_parses(text: str) -> None:
    parsed = parse(text)
    assert [diagnostic.message for diagnostic in parsed.diagnostics] == []
    assert "".join(token.text for token in parsed.tokens) == text


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda folder: folder.name)
def test_checks_clean(folder: Path) -> None:
    """No finding at all; in classic files hints may say what the short form says better."""
    found = find_project(str(folder))
    if found.project.imports:
        found = ExternalFiles({}).read(found)
    loaded = load([str(folder)], found.project, includes)
    assert (found.problems, loaded.problems, loaded.damaged) == ((), (), ())
    workspace = Workspace.of(loaded.texts, found.project)
    allowed = {Severity.HINT} if folder.name == "classic" else set()
    assert [
        f"{path}: {diagnostic.rule}: {diagnostic.message}"
        for path in loaded.given
        for diagnostic in check(workspace, path)
        if diagnostic.effective_severity not in allowed
    ] == []


def includes(path: str, text: str) -> list[str]:
    return [include.path.text for include in File(path, text).includes if include.path]


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda folder: folder.name)
def test_scenarios_pass(folder: Path) -> None:
    """Each mission of a folder has two to five scenarios."""
    code, out, err = run_btq("test", str(folder), "--format", "json", cwd=folder)
    assert (code, err) == (0, "")
    results = json.loads(out)["scenarios"]
    assert [each["title"] for each in results if each["outcome"] != "passed"] == []
    numbers = Counter(each["file"] for each in results)
    assert len(numbers) == _MISSIONS.get(folder.name, 1)
    assert all(2 <= number <= 5 for number in numbers.values())


@pytest.mark.parametrize("text", [pytest.param(text, id=place) for place, text in blocks([*PAGES, README])])
def test_block_checks_clean(text: str) -> None:
    workspace = Workspace.of({"block.btq": text})
    assert [f"{diagnostic.rule}: {diagnostic.message}" for diagnostic in check(workspace, "block.btq")] == []


@pytest.mark.parametrize("path", [path for path in EXAMPLES if path.suffix == ".btq"], ids=lambda path: path.name)
def test_is_formatted(path: Path) -> None:
    text = path.read_text("utf-8")
    assert format_text(text).text == text


@pytest.mark.parametrize("text", [pytest.param(text, id=place) for place, text in blocks(PAGES)])
def test_block_is_formatted(text: str) -> None:
    assert format_text(text).text == text


def test_no_suppressions() -> None:
    assert [path.name for path in EXAMPLES if "btq:" in path.read_text("utf-8")] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_lead_somewhere(page: Path) -> None:
    links = re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", page.read_text("utf-8"))
    assert [link for link in links if not (page.parent / link).exists()] == []
