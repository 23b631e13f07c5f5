"""Nav2 as a project that names its C++ sources: what is found in its trees and in its code, each looked up there."""

from __future__ import annotations

import re
from pathlib import Path
from subprocess import run

import pytest
from in_process import run_btq
from nav2_clone import clone, files
from nav2_sources import PALETTE

TREES = "nav2_bt_navigator/behavior_trees/"
OF_NODES = (
    "unknown-node",
    "unknown-port",
    "missing-port",
    "category-mismatch",
    "entry-with-two-types",
    "unused-port-in-cpp",
    "undeclared-port-in-cpp",
    "unseen-in-cpp",
)
FOUND = {  # no other code of that branch names these ports
    "jazzy": [
        "remove_passed_goals_action.hpp:59: unused-port-in-cpp",
        "goal_reached_condition.hpp:87: unused-port-in-cpp",
    ],
    "kilted": ["spin_action.hpp:75: unused-port-in-cpp"],
}


@pytest.mark.parametrize("branch", ["humble", "iron", "jazzy", "kilted", "lyrical", "main"])
def test_what_is_found(branch: str, tmp_path: Path) -> None:
    git = ["git", "-C", str(clone())]
    listed = run([*git, "ls-tree", "--name-only", branch, TREES], capture_output=True, check=True, text=True).stdout
    trees = [name for name in listed.split() if name.endswith(".xml")]
    texts = {path: text for path, text in files(branch).items() if path != PALETTE}
    for name in trees:
        texts[name] = run([*git, "show", f"{branch}:{name}"], capture_output=True, check=True, text=True).stdout
    texts["btq.toml"] = 'nodes = ["**/*.cpp", "**/*.hpp"]\n'
    for path, text in texts.items():
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text(text, encoding="utf-8")
    _, out, err = run_btq("check", "--output-format", "concise", cwd=tmp_path)
    assert err == ""
    found = re.findall(r"^(?:.*/)?([^/:]+):(\d+):\d+: \w+\[([\w-]+)\]", out, re.MULTILINE)
    assert [f"{file}:{line}: {rule}" for file, line, rule in found if rule in OF_NODES] == FOUND.get(branch, [])
    assert len(trees) > 4
