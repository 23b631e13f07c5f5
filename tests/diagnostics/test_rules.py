"""Every rule's page is its test: the diagnostics that its examples announce are exactly those that are found.

`tests/README.md` explains the markers.
"""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import pytest
from check_asserts import MARKER, announced, assert_marked
from nav2_robot import findings_in, make_robot
from rule_logs import RULES_OF_LOGS, assert_marked_by_log
from rule_pages import BLOCK, PAGES, blocks

from btq_lang.diagnostics.rules import RULES, page
from btq_lang.util.text import LineIndex


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
def test_the_examples_of_a_page(rule: str, language: str, block: str, tmp_path: Path) -> None:
    """The announced diagnostics and no others; each of their fixes mends, a safe one adds nothing."""
    if rule in RULES_OF_LOGS:
        assert_marked_by_log(page(rule), block, tmp_path)
    elif language == "yaml":
        make_robot(tmp_path)
        found = Counter(
            (
                "nav2_params.yaml",
                LineIndex(block).position(each.span.start).line,
                each.effective_severity.value,
                each.rule,
            )
            for _, each in findings_in(tmp_path, block)
        )
        assert found == announced("nav2_params.yaml", block)
    else:
        if language == "cpp":
            pytest.importorskip("tree_sitter_cpp", reason="the C++ grammar is not installed: pip install -e '.[cpp]'")
        assert_marked(block, f"main.{language}")
