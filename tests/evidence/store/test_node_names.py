"""Names of nodes in the store: the same in the trees of two versions, whatever was added in front."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from evidence_logs import START, btlog
from in_process import run_btq

from btq_lang.evidence.model import LoggedTree
from btq_lang.evidence.store.rows import node_names

MOVES = {"v1": ("Move", "Move", "Move"), "v2": ("Beep", "Move", "Move", "Move")}
MORE = {"v1": ("Move", "Move"), "v2": ("Move", "Move", "Move")}
FRONT = {"v1": ("Plan", "Follow"), "v2": ("Plan", "Beep", "Follow")}
SECONDS = {"Move": (1, 2, 9)}  # home is near, the last place far


def compared(folder: Path, versions: dict[str, tuple[str, ...]]) -> dict[str, Any]:
    """The document of a comparison of two versions of a mission, each with 40 runs of all its actions."""
    for place, (label, actions) in enumerate(versions.items()):
        steps = "".join(f"        Action {name}\n" for name in actions)
        declared = "".join(f"Action {name}\n" for name in dict.fromkeys(actions))
        demand = f"QualityReq quick : safety\n    every {actions[-1]} takes at most 60 s\n"
        mission = f"{demand}Root Main\nBehaviorTree Main\n    ->\n{steps}{declared}"
        (folder / "main.btq").write_text(mission, encoding="utf-8")
        nodes = "".join(f'<{name} name="{name}" _uid="{uid}"/>' for uid, name in enumerate(actions, start=2))
        xml = f'<Sequence name="Sequence" _uid="1">{nodes}</Sequence>'
        xml = f'<root BTCPP_format="4"><BehaviorTree ID="Main" _fullpath="">{xml}</BehaviorTree></root>'
        (folder / f"{label}.btlog").write_bytes(btlog(xml, transitions(actions), START + place * 10_000_000_000))
        asked = ("--mission", "main.btq", "--store", "kept", "--label", label)
        assert run_btq("verify", f"{label}.btlog", *asked, cwd=folder)[::2] == (0, "")
    code, document, errors = run_btq("compare", "kept", "v1", "v2", "--format", "json", cwd=folder)
    assert (code, errors) == (1, "")  # all take longer together
    found: dict[str, Any] = json.loads(document)
    return found


def transitions(actions: tuple[str, ...]) -> list[tuple[int, int, int]]:
    """The rows of 40 runs, whose actions take what SECONDS says, else 3 s, and a bit more in each run."""
    found, now = [], 0
    for run in range(40):
        found.append((now, 1, 1))
        times = {name: iter(seconds) for name, seconds in SECONDS.items()}
        for uid, name in enumerate(actions, start=2):
            found.append((now, uid, 1))
            now += round(next(times.get(name, iter([3]))) * 1e6) + run
            found.append((now, uid, 2))
        found.append((now, 1, 2))
        now += 1_000_000
        found += [(now, uid, 0) for uid in (*range(2, len(actions) + 2), 1)]
    return found


def measures(found: dict[str, Any]) -> dict[tuple[str, str], tuple[float, float]]:
    """The means of both sides, by requirement and node."""
    changes = found["missions"][0]["changes"]
    return {
        (key["requirement"], key["node"]): (round(each["before"]), round(each["after"]))
        for each in changes
        if each["what"] == "mean"
        for key in (each, *each["same"])
    }


def test_a_node_in_front_shifts_all_numbers(tmp_path: Path) -> None:
    found = compared(tmp_path, FRONT)
    assert found["missions"][0]["one_sided"] == [0, 1]  # Beep
    assert measures(found) == {("", "Follow"): (3, 3), ("", "Plan"): (3, 3), ("quick", "Follow"): (3, 3)} | {
        ("", "Sequence"): (6, 9)
    }


def test_one_of_several_is_compared_with_the_same_one(tmp_path: Path) -> None:
    found = compared(tmp_path, MOVES)
    assert measures(found) == {
        ("", "Move (1 of 3)"): (1, 1),
        ("", "Move (2 of 3)"): (2, 2),
        ("", "Move (3 of 3)"): (9, 9),
        ("", "Sequence"): (12, 15),
        ("quick", "Move (1 of 3)"): (1, 1),
        ("quick", "Move (2 of 3)"): (2, 2),
        ("quick", "Move (3 of 3)"): (9, 9),
    }


def test_one_of_two_is_not_compared_with_one_of_three(tmp_path: Path) -> None:
    found = compared(tmp_path, MORE)
    assert found["missions"][0]["one_sided"] == [2, 3]
    assert (
        "\nnot compared: 2 nodes active only in v1, 3 nodes active only in v2\n"
        in run_btq("compare", "kept", "v1", "v2", cwd=tmp_path)[1]
    )
    assert measures(found) == {("", "Sequence"): (3, 12)}


def test_names() -> None:
    paths = ["Sequence::1", "Go::2", "Go::2/Move::3", "Go::4", "Go::4/Move::5", "Go::4/Move", "home", "home", "x/y::9"]
    tree = LoggedTree([(uid, "", path, 0 if uid == 1 else 1) for uid, path in enumerate(paths, start=1)])
    assert [*node_names(tree).values()] == [
        "Sequence",
        "Go (1 of 2)",
        "Go (1 of 2)/Move",
        "Go (2 of 2)",
        "Go (2 of 2)/Move (1 of 2)",
        "Go (2 of 2)/Move (2 of 2)",
        "home (1 of 2)",
        "home (2 of 2)",
        "x/y",
    ]
