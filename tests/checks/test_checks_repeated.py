"""named-twice: what its page does not show."""

from __future__ import annotations

import pytest
from check_asserts import assert_clean, assert_fix, assert_problems

DEMANDS = 'QualityReq a "t"\n    succeeds\nQualityReq b "t"\n    takes at most 3 s\n'


@pytest.mark.parametrize(
    ("node", "title", "fixed"),
    [
        ("X satisfies a, a, b", "Remove `a`", "X satisfies a, b"),
        ("X satisfies a, b, a", "Remove `a`", "X satisfies a, b"),
        ("X satisfies a\n        satisfies a", "Remove `satisfies a`", "X satisfies a"),
        ("X satisfies a\n        satisfies a, b", "Remove `a`", "X satisfies a\n        satisfies b"),
        ("X (satisfies a) satisfies a, b", "Remove `a`", "X (satisfies a) satisfies b"),
        ("X satisfices safety, safety satisfies a, b", "Remove `safety`", "X satisfices safety satisfies a, b"),
        ("X tags q, q satisfies a, b", "Remove `q`", "X tags q satisfies a, b"),
    ],
)
def test_the_second_one_goes(node: str, title: str, fixed: str) -> None:
    tree = "apply a, b to Main/X\nBehaviorTree Main\n    "
    assert_fix(f"{DEMANDS}{tree}{node}\n", title, f"{DEMANDS}{tree}{fixed}\n", safe=True)


def test_two_names_of_one_quality_are_one() -> None:
    assert_problems(
        "BehaviorTree Main\n    X satisfices time-behaviour, performance-efficiency.time-behaviour\n",
        "2:34 hint named-twice «performance-efficiency.time-behaviour» duplicate "
        "`performance-efficiency.time-behaviour` has no effect",
    )


def test_what_is_no_repetition() -> None:
    """Other arguments; a quality that encloses requirements; what an `apply` attaches to all."""
    assert_clean("""
        QualityReq most (limit : s) "t"
            takes at most limit
        QualityReq sure "t"
            succeeds
        apply sure to every X
        BehaviorTree Main
            ->
                X satisfies sure
                X (satisfices Quality = safety (QualityReq ID = "a" description = "t"),
                    Quality = safety (QualityReq ID = "b" description = "t"))
                    satisfies most (limit = 3 s)
    """)
