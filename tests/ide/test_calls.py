"""Call hierarchy: which tree runs which."""

from __future__ import annotations

import pytest
from feature_asserts import check_calls

FILES = """//- main.btq
include "lib.btq"
BehaviorTree Main
    ->
        SubTree Dock
        SubTree Carry
        SubTree Dock
//- lib.btq
BehaviorTree Carry
    SubTree Dock
BehaviorTree Dock
    Pick
"""


@pytest.mark.parametrize(
    ("marked", "name", "callers", "called"),
    [
        ("BehaviorTree $0Main", "Main", [], ["Dock ×2", "Carry ×1"]),
        ("BehaviorTree Car$0ry", "Carry", ["Main ×1"], ["Dock ×1"]),
        ("BehaviorTree Dock$0", "Dock", ["Carry ×1", "Main ×2"], []),
        ("SubTree Ca$0rry", "Carry", ["Main ×1"], ["Dock ×1"]),
        ("Pi$0ck", None, [], []),
    ],
)
def test_calls(marked: str, name: str | None, callers: list[str], called: list[str]) -> None:
    check_calls(FILES.replace(marked.replace("$0", ""), marked, 1), name, callers, called)


def test_items_in_a_root() -> None:
    check_calls(
        "Root Main\n    BehaviorTree Main\n        SubTree Dock\n    BehaviorTree Do$0ck\n        Pick\n",
        "Dock",
        ["Main ×1"],
    )
