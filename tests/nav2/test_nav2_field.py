"""Parameters and trees of public reports about Nav2, each in a folder of its own: what must be said of each."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from in_process import run_btq

EXPECTED = {
    "c1_4541": [
        "p.yaml:4:5: warning[nav2-parameter] Nav2 has no parameter `default_bt_xml` in Humble; did you mean "
        "`default_nav_through_poses_bt_xml` or `default_nav_to_pose_bt_xml`?",
        "p.yaml:5:5: warning[nav2-parameter] Nav2 does not read `navigators` in Humble",
        "p.yaml:7:7: warning[nav2-parameter] Nav2 does not read `navigate_to_pose.plugin` in Humble",
        "p.yaml:9:7: warning[nav2-parameter] Nav2 does not read `navigate_through_poses.plugin` in Humble",
        "t.xml:5:67: warning[misspelt-entry] nothing writes `selected_planer`, which is read here; did you mean "
        "`selected_planner`?",
    ],
    "c12_3633": [
        "p.yaml:6:7: warning[nav2-parameter] Nav2 does not read `error_code_names` below `navigate_to_pose`: "
        "write it one level up",
    ],
    "c19_rel": [
        "p.yaml:3:33: warning[missing-nav2-tree] cannot find the tree `follow_point.xml`: a relative path counts "
        "from the folder in which bt_navigator runs",
    ],
    "sub_noremap": [
        "t.xml:9:20: error[isolated-node] `DriveOnHeading` cannot be created in the tree `Sub`: this SubTree does not "
        "pass `node`, `wait_for_service_timeout`, `bt_loop_duration`",
    ],
    "persistent-sequence": [
        "t.xml:3:6: error[missing-port] `PersistentSequence` requires a value for its port `current_child_idx`",
    ],
    "two-follow-path": [
        "t.xml:7:10: warning[shared-server] `FollowPath` calls the server `follow_path`, as another child of "
        "`Parallel` does",
    ],
    "emptyxml": [
        "p.yaml:4:33: hint[missing-nav2-tree] this parameter is empty and names no tree; a launch file may set it",
    ],
}


@pytest.mark.parametrize("name", EXPECTED)
def test_what_is_said(shared: Path, tmp_path: Path, name: str) -> None:
    report = shared / "field" / "nav2" / name
    if not report.is_dir():
        pytest.skip("the shared inputs have no such report")
    shutil.copytree(report, tmp_path, dirs_exist_ok=True)
    _, out, _ = run_btq("check", "--output-format", "concise", cwd=tmp_path)
    assert out.splitlines()[:-1] == EXPECTED[name]
