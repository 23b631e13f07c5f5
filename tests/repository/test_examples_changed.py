"""The examples with one thing changed: what they show is seen to matter, for then it is told."""

from __future__ import annotations

from pathlib import Path

import pytest

from btq_lang.checks import check
from btq_lang.projects.opening import open_workspace

ROOT = Path(__file__).resolve().parents[2]

# A file of an example; what in it becomes what; and what is told of it, there or in a file that includes it.
CHANGES = {
    "a value in another unit": (
        "laboratory/mission.btq",
        ("leaves battery >= 3 %", "leaves battery >= 3 V"),
        "unit-mismatch: cannot compare `battery` (a percentage) with `3 V` (a voltage)",
    ),
    "a value without a unit": (
        "pick-and-place/cell.btq",
        ("apply grip(limit = 8 N)", "apply grip(limit = 8)"),
        "number-without-unit: missing unit after `8`; expected a force",
    ),
    "a window in which the odds cannot be shown": (
        "navigation/navigation.btq",
        ("over last 500 activations", "over last 200 activations"),
        "window-too-small: 200 activations cannot show 99 % with a confidence of 95 %: "
        "this requires 299 without a failure",
    ),
    "a way to a node that is not there": (
        "pick-and-place/cell.btq",
        ("to SortPart succeeds", "to SortParts succeeds"),
        "unmatched-path: unknown node `SortParts`; did you mean `SortPart`?",
    ),
    "two values for one node": (
        "hospital/missions/deliver.btq",
        ("apply locked to ToWard", "apply locked to ToWard\napply slow(limit = 0.2 m/s) to ToWard"),
        "ambiguous-application: `slow` has two values for `MoveBase ToWard`: limit = 0.3 m/s and limit = 0.2 m/s",
    ),
    "a failure that is only the next attempt": (
        "pick-and-place/cell.btq",
        ("on violation halt  # under Retry", "on violation fail  # under Retry"),
        "swallowed-failure: when `CloseGripper` fails because of this, `Retry` tries again",
    ),
}


@pytest.mark.parametrize("change", CHANGES)
def test_a_change_is_told(change: str) -> None:
    name, (old, new), told = CHANGES[change]
    path = str(ROOT / "examples" / name)
    workspace = open_workspace(str(ROOT / "examples" / name.partition("/")[0]))
    text = workspace.files[path].text
    assert text.count(old) == 1
    changed = workspace.with_file(path, text.replace(old, new))
    found = {f"{each.rule}: {each.message}" for file in changed.files for each in check(changed, file)}
    assert found == {told}
