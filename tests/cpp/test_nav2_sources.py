"""The nodes of every branch of Nav2, held against what was counted by hand and against Nav2's own list of them.

That list is kept by hand and is wrong in some branches; where exactly is written here.
"""

from __future__ import annotations

import re
from collections import Counter

import pytest
from nav2_clone import COUNTS, files, read
from nav2_differences import differences
from nav2_sources import PALETTE

from btq_lang.catalog.cpp_classes import BASES
from btq_lang.catalog.kinds import CATEGORIES
from btq_lang.cpp.nodes import read_nodes

BRANCHES = (*COUNTS, "main")  # where the nodes are those of Lyrical
SMOOTHER = ["SmoothPath.server_name", "SmoothPath.server_timeout"]
OF_HUMBLE = [*SMOOTHER, "Spin.is_recovery", "TruncatePathLocal.input_path"]
WOULD_HELP = [f"WouldA{server}RecoveryHelp.error_codes_to_check" for server in ("Controller", "Planner", "Smoother")]
NOT_LISTED = {  # ports and nodes that are in the code and not in the list
    "humble": ["ComputeAndTrackRoute", "ComputeRoute", "GetPoseFromPath", *OF_HUMBLE],
    "iron": ["GetPoseFromPath", *OF_HUMBLE, "FollowPath.server_name", "SmoothPath.error_code_id", *WOULD_HELP],
    "kilted": [
        "AssistedTeleop.error_msg",
        *(f"ComputeAndTrackRoute.{port}" for port in ("server_name", "server_timeout", "execution_duration")),
        *(
            f"{node}.{port}"
            for node in ("ComputeRoute", "DockRobot", "UndockRobot")
            for port in ("server_name", "server_timeout")
        ),
        *SMOOTHER,
        "RemoveInCollisionGoals.server_timeout",
        "WouldARouteRecoveryHelp.error_codes_to_check",
        *WOULD_HELP,
    ],
}
INVENTED = {"iron": ["FollowPath.service_name"], "kilted": ["ComputeAndTrackRoute.execution_time"]}
# The second argument of two is a description, which the list takes for a default.
WRONG_DEFAULTS = dict.fromkeys(("humble", "iron", "kilted"), ("FollowPath.controller_id", "SmoothPath.smoother_id"))
DEFAULTS_NOT_GIVEN = {"humble": 55, "iron": 55, "kilted": 67}
# The list has a tag that the engine does not know.
WRONG_DIRECTIONS = dict.fromkeys(("lyrical", "main"), ("PersistentSequence.current_child_idx",))
UNREAD = {
    "jazzy": ["GoalReached.global_frame", "RemovePassedGoals.global_frame"],
    "kilted": ["Spin.disable_collision_checks"],
}


@pytest.mark.parametrize("branch", BRANCHES)
def test_all_nodes_and_ports_are_seen(branch: str) -> None:
    found = read(branch)
    categories = Counter(node.category for node in found.nodes)
    counted = (*(categories[each] for each in CATEGORIES[:4]), sum(len(node.ports) for node in found.nodes))
    assert counted == COUNTS["lyrical" if branch == "main" else branch]
    assert found.unseen == ()
    assert [node.name for node in found.nodes if not node.complete or node.undeclared] == []
    unread = [f"{node.name}.{port.name}" for node in found.nodes for port in node.unread]
    assert unread == UNREAD.get(branch, [])


@pytest.mark.parametrize("branch", BRANCHES)
def test_the_list_differs_only_there(branch: str) -> None:
    found: dict[str, list[str]] = {}
    for each in differences(read(branch).nodes, files(branch)[PALETTE]):
        found.setdefault(each.kind, []).append(each.name)
        assert each.why
    no_default = len(found.pop("no default", ()))
    assert no_default == DEFAULTS_NOT_GIVEN.get(branch, 0)
    expected = {
        "not listed": NOT_LISTED.get(branch),
        "only listed": INVENTED.get(branch),
        "default": WRONG_DEFAULTS.get(branch),
        "direction": WRONG_DIRECTIONS.get(branch),
    }
    assert {kind: sorted(names) for kind, names in found.items()} == {
        kind: sorted(names) for kind, names in expected.items() if names
    }


@pytest.mark.parametrize("branch", ["humble", "iron", "jazzy", "kilted", "lyrical"])
@pytest.mark.parametrize("base", BASES)
def test_the_ports_of_base_classes_are_those_of_the_headers(branch: str, base: str) -> None:
    sources = files(branch)
    text = f'struct A : nav2_behavior_tree::{base}<M> {{}};\nvoid f() {{ factory.registerNodeType<A>("A"); }}\n'
    header = next(path for path, text in sources.items() if re.search(rf"class {base}\b[^;{{]*{{", text))

    def ports(files: dict[str, str]) -> list[tuple[str, ...]]:
        (node,) = read_nodes(files, (branch,)).nodes
        return [(port.direction, port.name, port.type, port.text) for port in node.ports]

    assert ports({"a.cpp": text}) == ports({"a.cpp": text, header: sources[header]})
