"""Every change of a status, held against runs of the real engine."""

from __future__ import annotations

from pathlib import Path

import pytest
from against_truth import DIALECTS, cases, first_difference


@pytest.mark.parametrize("name", DIALECTS)
def test_random_trees_run_as_in_the_engine(name: str, shared: Path) -> None:
    every = list(cases(shared / "engine" / f"{name}.jsonl.gz"))
    differences = {case["seed"]: first_difference(case, DIALECTS[name]) for case in every}
    assert {seed: difference for seed, difference in differences.items() if difference} == {}
    assert len(every) in (500, 998, 999)
