"""What the README and the documents say is run."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from btq_lang.checks import check
from btq_lang.diagnostics.rules import Severity
from btq_lang.workspace.workspace import Workspace

ROOT = Path(__file__).resolve().parents[2]
DOCUMENTS = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md")), *sorted((ROOT / "examples").glob("**/*.md"))]
README = (ROOT / "README.md").read_text(encoding="utf-8")


def blocks(language: str, text: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)


def test_ci_runs_the_readmes_command_and_nothing_else() -> None:
    command = blocks("sh", README)[-1].strip()
    lines = (ROOT / ".ci" / "run").read_text(encoding="utf-8").splitlines()
    assert lines[-1] == command
    assert "pytest" not in "".join(lines[:-1])


def test_the_python_of_the_readme() -> None:
    (program,) = blocks("python", README)
    run = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=True)
    lines = run.stdout.splitlines()
    assert lines[0] == "Laboratory R-> "
    assert lines[-4:] == ["BehaviorTree Main", "    Retry (num_attempts = 3)", "        Action Dock", ""]


@pytest.mark.parametrize(
    "block",
    [block for document in DOCUMENTS for block in blocks("btq", document.read_text(encoding="utf-8"))],
    ids=lambda block: block.split("\n", 1)[0],
)
def test_every_mission_in_a_document_checks_clean(block: str) -> None:
    found = check(Workspace.of({"block.btq": block}), "block.btq")
    assert [(each.rule, each.message) for each in found if each.effective_severity is not Severity.HINT] == []


@pytest.mark.parametrize(
    "document", [ROOT / "README.md", *ROOT.glob("docs/*.md"), *ROOT.glob("*.md")], ids=lambda p: p.name
)
def test_links_between_documents_lead_somewhere(document: Path) -> None:
    for target in re.findall(r"\]\(([^)#:]+)[)#]", document.read_text(encoding="utf-8")):
        assert (document.parent / target).exists(), target


def test_the_changelog_counts_the_rules() -> None:
    pages = list((ROOT / "btq_lang" / "diagnostics" / "rules").glob("*.md"))
    (number,) = re.findall(r"`btq check`: (\d+) rules", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"))
    assert int(number) == len(pages)
