"""Servers of trees in parameter files, and the trees that clients name."""

from __future__ import annotations

from pathlib import Path

import pytest

from btq_lang.projects.tree_servers import TreePrograms, TreeServer, tree_programs

pytest.importorskip("yaml", reason="PyYAML is not installed: pip install -e '.[nav2]'")


def test_servers_and_targets(tmp_path: Path) -> None:
    (tmp_path / "src/robot/trees/deep").mkdir(parents=True)
    (tmp_path / "src/robot/package.xml").write_text("<package><name>robot</name></package>")
    robot = f"{tmp_path.as_posix()}/src/robot"
    server = "s:\n  ros__parameters:\n    behavior_trees: [robot/trees, robot/trees/deep, robot/lost, lost/trees]\n"
    client = "ns:\n  c:\n    ros__parameters:\n      target_tree: Dock\n"
    texts = (server, f"{server}    plugins: [robot/plugins, lost/plugins]\n", client, "behavior_trees: [", "a: 1")
    folders = (f"{robot}/trees", f"{robot}/trees/deep")
    servers = (TreeServer(folders, ()), TreeServer(folders, (robot,)))
    assert tree_programs(texts, f"{tmp_path.as_posix()}/src") == TreePrograms(servers, ("Dock",))
    assert tree_programs((server.replace("robot/", "lost/"),), str(tmp_path)) == TreePrograms()
