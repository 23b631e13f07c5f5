"""The path of a node, as a requirement names it."""

from __future__ import annotations

import pytest
from feature_asserts import check_node_path


@pytest.mark.parametrize(
    ("text", "path"),
    [
        ("BehaviorTree Main\n    -> First\n        ->\n            Pick N$0ear\n", "Main/First/Near"),
        ("BehaviorTree 'my tree'\n    Retry (num_attempts = 3)\n        Pi$0ck\n", '"my tree"/Retry/Pick'),
        ("BehaviorTree Main\n    SubTree Do$0ck\n", "Main/Dock"),
        ("BehaviorTree Ma$0in\n    Pick\n", None),
        ("signal v$0 : m/s\n", None),
    ],
)
def test_node_path(text: str, path: str | None) -> None:
    check_node_path(text, path)
