"""Scenarios of trees of Nav2: how one ends, and why."""

from __future__ import annotations

import json
from pathlib import Path

from in_process import run_btq


def ran(folder: Path, tree: str, *steps: str, nodes: str = "jazzy") -> tuple[str, str, str]:
    """The outcome of a scenario, how it ends, and why.

    Args:
        tree: its XML.
        nodes: the distribution; it counts if the folder has no btq.toml yet.
    """
    if not (folder / "btq.toml").exists():
        (folder / "btq.toml").write_text(f'nodes = ["nav2-{nodes}"]\n', encoding="utf-8")
    version = "" if nodes in ("humble", "iron") else 'BTCPP_format="4" '
    root = f'<root {version}main_tree_to_execute="Main"><BehaviorTree ID="Main">{tree}</BehaviorTree></root>\n'
    (folder / "main.xml").write_text(root, encoding="utf-8")
    lines = "".join(f"    {step}\n" for step in steps)
    (folder / "cases.btq").write_text(f'include "main.xml"\n\nscenario "S"\n{lines}', encoding="utf-8")
    _, out, err = run_btq("test", "cases.btq", "--format", "json", cwd=folder)
    assert err == ""
    (result,) = json.loads(out)["scenarios"]
    whys = [result["why"], *(each["why"] for each in result["expectations"])]
    return result["outcome"], result["ended"], next(filter(None, whys), "")
