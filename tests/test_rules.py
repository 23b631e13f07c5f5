"""Every rule's page is its test: the diagnostics that its examples announce are exactly those that are found.

`tests/README.md` explains the markers.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from check_asserts import MARKER, assert_marked

from btq_lang import rules
from btq_lang.rules import RULES, page

PAGES = Path(rules.__file__).parent
BLOCK = re.compile(r"^```(?P<language>btq|xml)\n(?P<text>.*?)^```$", re.DOTALL | re.MULTILINE)


def blocks() -> list[tuple[str, str, str]]:
    found = []
    for rule in RULES:
        path = PAGES / f"{rule}.md"
        if path.exists():
            for match in BLOCK.finditer(path.read_text(encoding="utf-8")):
                found.append((rule, match["language"], match["text"]))
    return found


def test_there_is_a_page_for_every_rule_and_a_rule_for_every_page() -> None:
    assert {path.stem for path in PAGES.glob("*.md")} == set(RULES)


@pytest.mark.parametrize("rule", RULES)
def test_a_page_shows_its_rule_at_work_and_a_clean_file(rule: str) -> None:
    text = page(rule)
    assert text.startswith(f"# {rule}\n")
    assert re.findall(r"^## .*$", text, re.MULTILINE) == ["## Why", "## Instead"]
    examples = [match["text"] for match in BLOCK.finditer(text)]
    rules_shown = {marker["rule"] for example in examples for marker in MARKER.finditer(example)}
    assert rule in rules_shown
    assert any(not MARKER.search(example) for example in examples)


@pytest.mark.parametrize(("rule", "language", "block"), blocks())
def test_the_examples_of_a_page(rule: str, language: str, block: str) -> None:
    """The announced diagnostics and no others; each of their fixes mends, a safe one adds nothing."""
    assert_marked(block, f"main.{language}")
