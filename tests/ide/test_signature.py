"""Signature help: the ports of the node in whose brackets one types."""

from __future__ import annotations

import pytest
from feature_asserts import check_signature

MODEL = "Action Pick\n    input from : string\n    input speed : double = 0.5\nBehaviorTree Main\n    "


@pytest.mark.parametrize(
    ("line", "label"),
    [
        ("Pick ($0", "Pick («input from : string», input speed : double = 0.5)"),
        ("Pick ($0)", "Pick («input from : string», input speed : double = 0.5)"),
        ("Pick (from = a $0", "Pick (input from : string, «input speed : double = 0.5»)"),
        ("Pick (speed = $0", "Pick (input from : string, «input speed : double = 0.5»)"),
        ("Pick (speed = 1 $0", "Pick («input from : string», input speed : double = 0.5)"),
        ("Pick (wrong = $0", "Pick (input from : string, input speed : double = 0.5)"),
        ("Action Pick Near (\n        $0", "Pick («input from : string», input speed : double = 0.5)"),
        ("Timeout ($0", "Timeout («input msec : unsigned int»)"),
        ("SubTree Dock (to$0", "Dock («input to : string»)"),
        ("Pick $0", None),
        ("Unknown ($0", None),
        ("Pick (from = a) satisfies slow($0", None),
    ],
)
def test_signature(line: str, label: str | None) -> None:
    check_signature(f"BehaviorTree Dock\n    input to : string\n    Wait\n{MODEL}{line}", label)
