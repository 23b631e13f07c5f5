"""Nodes in the C++ of public repositories: BehaviorTree.CPP's own examples, and two robots.

Truth is a plain search for what is registered with a literal name; names that the code makes in other ways are listed.
"""

from __future__ import annotations

import re

import pytest
from public_clones import texts_of

from btq_lang.cpp.nodes import read_nodes

pytest.importorskip("tree_sitter_cpp", reason="the C++ grammar is not installed: pip install -e '.[cpp]'")

REGISTERED = re.compile(
    r'register(?:Node(?:Type)?|Simple(?:Action|Condition|Decorator)|Builder)\s*(?:<[^;{}]*?>)?\s*\(\s*"([^"]+)"'
)
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)


@pytest.mark.parametrize(
    ("repository", "commit", "folders", "others", "counts"),
    [
        # `ThinkRuntimePort` is the name in a manifest that is given to registerBuilder.
        ("BehaviorTree+BehaviorTree.CPP", "879522c7", ("examples", "sample_nodes"), {"ThinkRuntimePort"}, (37, 33)),
        ("DIII-SDU-Group+III-Drone-Mission", "ed6c2fd9", (), set(), (24, 73)),
        (  # the others by RegisterRosAction of BehaviorTree.ROS2
            "memristor+mep3",
            "ce97ea61",
            (),
            {"FollowPath", "JointPosition", "Move", "Navigate", "Pump", "Rotate", "Translate"},
            (16, 53),
        ),
    ],
)
def test_all_that_is_registered_is_seen(
    repository: str, commit: str, folders: tuple[str, ...], others: set[str], counts: tuple[int, int]
) -> None:
    texts = texts_of(repository, commit, (".cpp", ".hpp", ".h", ".cc"), folders)
    found = read_nodes(texts)
    named = {name for text in texts.values() for name in REGISTERED.findall(COMMENT.sub("", text))}
    assert {node.name for node in found.nodes} == named | others
    assert others.isdisjoint(named)
    assert (len(found.nodes), sum(len(node.ports) for node in found.nodes)) == counts
