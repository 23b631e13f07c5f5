"""Answers that others have published."""

from __future__ import annotations

import re
from pathlib import Path

from exploring import Exploring


def as_engine_reads(shared: Path, name: str) -> str:
    """A tree of AS2FM, whose SetBlackboard and BlackboardCheckInt take other spellings."""
    text = (shared / "corpus" / "published" / name).read_text(encoding="utf-8")
    text = re.sub(r'output_key="\{(\w+)\}"', r'output_key="\1"', text)
    return text.replace('return_on_mismatch="1"', 'return_on_mismatch="SUCCESS"')


def test_the_mission_with_a_seeded_mistake(explore: Exploring, shared: Path) -> None:
    explore.mission(as_engine_reads(shared, "as2fm_mission_bug.xml"), "bug.xml")
    explore.mission(as_engine_reads(shared, "as2fm_mission_repaired.xml"), "repaired.xml")
    question = "PerformOnlineCoverage starts after when {mission_failed} == 1"
    code, text = explore.can(question, "bug.xml")
    assert (code, text.splitlines()[0]) == (0, f"  can {question}: yes, in 3 ticks")
    assert explore.can(question, "repaired.xml") == (1, f"  can {question}: no, in all 82 states\n")


def test_leaves_that_are_never_ticked(explore: Exploring, shared: Path) -> None:
    for name, line in (("fallback", 9), ("sequence", 7)):
        file = f"as2fm_bt_test_reactive_{name}.xml"
        explore.mission(as_engine_reads(shared, file), file)
        findings = explore.json(file)["missions"][0]["survey"]["findings"]
        assert [finding["line"] for finding in findings if finding["kind"] == "never-runs"] == [line]
