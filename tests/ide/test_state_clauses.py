"""Completion in clauses about states."""

from __future__ import annotations

import pytest
from feature_asserts import check_hover, check_offers

BEFORE = "signal battery : % from {level} level\ncontext calm : battery > 50 %\nQualityReq r : safety\n    "


@pytest.mark.parametrize(
    ("clause", "labels", "absent"),
    [
        ("ends ", ("with", "within"), ("battery",)),
        ("ends with ", ("calm", "battery"), ("probability >=",)),
        ("ends with battery ", ("and", ">="), ("of runs",)),
        ("never calm ", ("and", "for more than"), ("if",)),
        ("never calm for ", ("more than",), ("calm",)),
        ("never calm for more than 30 s ", ("if",), ("<=",)),
        ("keeps battery >= (", ("battery",), ("if",)),
        ("keeps battery >= (30 % ", ("if",), ("takes",)),
        ("keeps battery >= (30 % if ", ("calm", "battery"), ("else",)),
        ("keeps battery >= (30 % if calm ", ("and", "else"), ("if",)),
        ("keeps battery >= (30 % if calm else ", ("battery",), ("calm",)),
        ("takes at most 3 s if (calm ", ("and",), ("else", "if")),
        ("assuming ", ("calm", "battery"), ("takes",)),
        ("assuming calm ", ("and",), ("if",)),
        ("ends with (", ("battery",), ("station =",)),
    ],
)
def test_what_may_follow(clause: str, labels: tuple[str, ...], absent: tuple[str, ...]) -> None:
    check_offers(f"{BEFORE}{clause}$0", *labels, absent=absent)


def test_what_is_shown_at_never() -> None:
    longer = "longer at a stretch while the node runs"
    check_hover(
        f"{BEFORE}<hover>ne$0ver</hover> calm for more than 30 s",
        f"""
        **never for** (claim) · `never lamp_on for more than 30 s`

        Violated when it is true for {longer}.
        """,
    )
