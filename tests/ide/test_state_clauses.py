"""Completion in clauses about states."""

from __future__ import annotations

import pytest
from feature_asserts import check_offers

BEFORE = "signal battery : % from {level} level\ncontext calm : battery > 50 %\nQualityReq r : safety\n    "


@pytest.mark.parametrize(
    ("clause", "labels", "absent"),
    [
        ("ends ", ("with", "within"), ("battery",)),
        ("ends with ", ("calm", "battery"), ("probability >=",)),
        ("ends with battery ", ("and", ">="), ("of runs",)),
        ("ends with (", ("battery",), ("station =",)),
    ],
)
def test_what_may_follow(clause: str, labels: tuple[str, ...], absent: tuple[str, ...]) -> None:
    check_offers(f"{BEFORE}{clause}$0", *labels, absent=absent)
