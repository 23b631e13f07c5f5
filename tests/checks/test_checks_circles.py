"""Trees that run each other in circles, and long chains of them: every check answers, after an edit, too."""

from __future__ import annotations

import sys
from collections import Counter

import pytest
from kept_checks import Kept

from btq_lang.checks import check
from btq_lang.workspace.workspace import Workspace


def chain(count: int, last: str) -> str:
    """So many trees, each of which runs the next one with an entry, and what the last one does."""
    trees = [f"BehaviorTree T{n}\n    SubTree T{n + 1} (a = {{a}})\n" for n in range(count - 1)]
    return "".join((*trees, f"BehaviorTree T{count - 1}\n    {last}\n"))


DECLARED = (
    "SubTree Dock\nRoot Main\nBehaviorTree Main\n    Dock\nBehaviorTree Dock\n    ->\n        Dock\n        Dock\n"
)
LONG = sys.getrecursionlimit() + 100  # longer than a function may call itself
ENDLESS = 'Fallback\n        AlwaysSuccess\n        Script (code = "a := 1")\n'


@pytest.mark.parametrize(
    ("text", "rules"),
    [
        pytest.param(DECLARED, {"recursive-tree": 1, "unknown-node": 1}, id="through a model"),
        pytest.param(chain(1, "SubTree T0"), {"recursive-tree": 1}, id="itself"),
        pytest.param(chain(2, "SubTree T0 (a = {a})"), {"recursive-tree": 1}, id="two"),
        pytest.param(chain(LONG, "SubTree T0 (a = {a})"), {"recursive-tree": 1}, id="many"),
        pytest.param(chain(LONG, ENDLESS), {"unreachable-child": 1}, id="a chain"),
    ],
)
def test_all_is_found_afresh_and_after_an_edit(text: str, rules: dict[str, int]) -> None:
    workspace = Workspace.of({"main.btq": text})
    found = check(workspace, "main.btq")
    assert Counter(each.rule for each in found) == rules
    kept = Kept()
    assert kept.check(workspace, "main.btq").diagnostics == found
    for edited in (text.replace("BehaviorTree T0", "BehaviorTree T"), text + "BehaviorTree Other\n    Sleep\n"):
        workspace = workspace.with_file("main.btq", edited)
        assert kept.check(workspace, "main.btq").diagnostics == check(Workspace.of({"main.btq": edited}), "main.btq")
    assert kept.check(workspace.with_file("main.btq", text), "main.btq").diagnostics == found


def test_other_mistakes_in_a_circle_are_found() -> None:
    text = "BehaviorTree Main\n    Fallback\n        AlwaysSuccess\n        SubTree Main\n"
    found = check(Workspace.of({"main.btq": text}), "main.btq")
    assert [each.rule for each in found] == ["recursive-tree", "unreachable-child"]
