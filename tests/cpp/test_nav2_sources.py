"""The nodes of every branch of Nav2, held against what was counted by hand and against Nav2's own list of them.

That list is kept by hand and is wrong in some branches; where exactly is written here.
"""

from __future__ import annotations

from collections import Counter

import pytest
from lxml import etree
from nav2_clone import COUNTS, files, read
from nav2_sources import PALETTE
from nav2_words import OF_MESSAGES

from btq_lang.catalog.kinds import CATEGORIES
from btq_lang.cpp.model import CppPort

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


def listed(branch: str) -> dict[str, tuple[str, dict[str, etree._Element]]]:
    """The nodes in Nav2's list, each with its tag and its ports."""
    models = etree.fromstring(files(branch)[PALETTE].encode()).find("TreeNodesModel")
    return {
        model.get("ID"): (model.tag, {port.get("name"): port for port in model.iterchildren(tag=etree.Element)})
        for model in models.iterchildren(tag=etree.Element)
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
def test_names_categories_and_directions_are_those_of_the_list(branch: str) -> None:
    in_code = {node.name: node for node in read(branch).nodes}
    in_list = listed(branch)
    missing = sorted(in_code.keys() - in_list.keys())
    both = sorted(in_code.keys() & in_list.keys())
    ports = {name: {port.name: port for port in in_code[name].ports} for name in both}
    missing += [f"{name}.{port}" for name in both for port in ports[name] if port not in in_list[name][1]]
    assert sorted(missing) == sorted(NOT_LISTED.get(branch, []))
    invented = [f"{name}.{port}" for name in both for port in in_list[name][1] if port not in ports[name]]
    assert [*sorted(in_list.keys() - in_code.keys()), *invented] == INVENTED.get(branch, [])
    assert [name for name in both if in_code[name].category != in_list[name][0]] == []
    wrong = [
        f"{name}.{port.name}"
        for name in both
        for port in ports[name].values()
        if port.name in in_list[name][1] and in_list[name][1][port.name].tag != f"{port.direction}_port"
    ]
    assert tuple(wrong) == WRONG_DIRECTIONS.get(branch, ())


@pytest.mark.parametrize("branch", BRANCHES)
def test_defaults_and_types_are_those_of_the_list(branch: str) -> None:
    in_list = listed(branch)
    pairs = [
        (f"{node.name}.{port.name}", port, in_list[node.name][1][port.name])
        for node in read(branch).nodes
        for port in node.ports
        if node.name in in_list and port.name in in_list[node.name][1]
    ]
    not_given = [name for name, port, listed in pairs if listed.get("default") is None and port.default is not None]
    assert len(not_given) == DEFAULTS_NOT_GIVEN.get(branch, 0)
    wrong = [name for name, port, listed in pairs if not _is_default(port, listed.get("default"))]
    assert tuple(wrong) == WRONG_DEFAULTS.get(branch, ())
    assert [name for name, port, listed in pairs if not _is_type(port.type, listed.get("type"))] == []


def _is_default(port: CppPort, listed: str | None) -> bool:
    """Whether a default of the list, which has the quotes of the code and no `std::`, is that of a port."""
    if listed is None or listed == port.written.removeprefix("std::"):
        return True
    if port.default is None:
        return False
    try:
        return float(listed) == float(port.default)
    except ValueError:
        return listed.strip('"') == port.default


def _is_type(written: str, listed: str | None) -> bool:
    def short(type_: str) -> str:
        return type_.replace("std::", "").replace("_t", "").replace(" ", "")

    return listed is None or short(OF_MESSAGES.get(written, written)) == short(listed)
