"""A safe fix changes nothing of a mission but what its finding is about: `safe_fixes.py` says what that is."""

from __future__ import annotations

import pytest
from damage import case
from rule_pages import blocks
from safe_fixes import count, unwanted
from seeds import SEED, share_of

CASES = 5_000


@pytest.mark.parametrize(("language", "block"), [each[1:] for each in blocks() if each[1] in ("btq", "xml")])
def test_the_fixes_of_the_pages(language: str, block: str) -> None:
    if not block.startswith("//- "):
        assert list(unwanted(block, f"main.{language}")) == []


def test_the_fixes_of_damaged_missions() -> None:
    texts = [case(1 + SEED, number).text for number in share_of(range(CASES), 20)]
    assert sum(map(count, texts)) > 20
    assert [change for text in texts for change in unwanted(text)] == []


@pytest.mark.scheduled
def test_the_fixes_of_all_damaged_missions() -> None:
    assert [change for number in range(CASES) for change in unwanted(case(2 + SEED, number).text)] == []
