"""The 38 requirements of three published missions are in examples/published, and each is understood as a whole."""

from __future__ import annotations

from pathlib import Path

import pytest

from btq_lang.projects.opening import open_workspace
from btq_lang.requirements.resolve import requirements

FOLDER = Path(__file__).resolve().parents[2] / "examples" / "published"
# What people verify: from one run to another, and what people feel.
BY_PEOPLE = {"every_two_hours", "easy_to_use"}


@pytest.mark.parametrize(
    ("name", "count"),
    [("round.btq", 16), ("pipeline.btq", 10), ("inspection.btq", 13)],  # one wish for sensors is two requirements
)
def test_each_requirement_demands_something(name: str, count: int) -> None:
    path = (FOLDER / name).as_posix()
    resolved = requirements(open_workspace(str(FOLDER)), path).all
    assert len(resolved) == count
    assert {each.name for each in resolved.values() if not each.claims} == BY_PEOPLE & resolved.keys()
    assert {each.name: each.unread for each in resolved.values() if each.unread} == {}
