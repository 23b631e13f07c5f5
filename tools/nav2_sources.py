"""The sources of Nav2's nodes, from a clone of navigation2 that has the branches of the distributions."""

from __future__ import annotations

import tarfile
from io import BytesIO
from pathlib import Path
from subprocess import run
from typing import Final

PALETTE: Final = "nav2_behavior_tree/nav2_tree_nodes.xml"  # Nav2's own list of its nodes


def sources(clone: Path, branch: str) -> dict[str, str]:
    """The C++ files with nodes of a branch, without tests, and `PALETTE`: texts by path."""
    folders = ["nav2_behavior_tree"]
    if branch not in ("humble", "iron"):
        folders.append("nav2_docking/opennav_docking_bt")
    command = ["git", "-C", str(clone), "archive", branch, "--", *folders]
    found = {}
    with tarfile.open(fileobj=BytesIO(run(command, capture_output=True, check=True).stdout)) as archive:
        for member in archive:
            is_source = member.name.endswith((".hpp", ".cpp")) and "/test/" not in member.name
            content = archive.extractfile(member) if is_source or member.name == PALETTE else None
            if content is not None:
                found[member.name] = content.read().decode()
    return found
