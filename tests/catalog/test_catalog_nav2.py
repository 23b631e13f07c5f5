"""The model files of Nav2's nodes: what they hold, and that they are what the C++ code of Nav2 says."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest
from nav2_clone import COUNTS, clone, read
from nav2_nodes import model_file, ports_module
from nav2_words import NODES, PORTS, REQUIRED, REQUIRED_IN

from btq_lang.catalog.kinds import CATEGORIES
from btq_lang.catalog.nav2 import DISTRIBUTIONS, FILES, ports
from btq_lang.checks import check
from btq_lang.commands.explain_nav2 import models_of
from btq_lang.formatter import format_text
from btq_lang.workspace.workspace import Workspace


def text_of(distribution: str) -> str:
    return Path(FILES[distribution]).read_text(encoding="utf-8")


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
def test_a_file_is_clean_formatted_and_whole(distribution: str) -> None:
    text = text_of(distribution)
    assert check(Workspace.of({"nav2.btq": text}), "nav2.btq") == ()
    assert format_text(text).text == text
    found = models_of(distribution)
    categories = Counter(model.category.raw for model in found.values())
    counted = (*(categories[each] for each in CATEGORIES[:4]), sum(len(model.ports) for model in found.values()))
    assert counted == COUNTS[distribution]


def test_the_ports_of_all_distributions_are_those_of_the_files() -> None:
    assert Path(ports.__file__).read_text(encoding="utf-8") == ports_module()


def test_what_is_said_of_nodes_is_said_of_existing_ones() -> None:
    of_all = [models_of(each) for each in DISTRIBUTIONS]
    ports = {
        name: {port.id.text for each in of_all if name in each for port in each[name].ports if port.id}
        for name in NODES
    }
    assert {*NODES} == {name for each in of_all for name in each}
    assert {*PORTS} == {port for each in ports.values() for port in each}
    of_some = [(node, names) for table in REQUIRED_IN.values() for node, names in table.items()]
    for node, names in (*REQUIRED.items(), *of_some):
        assert ports[node].issuperset(names), node


def test_without_which_inputs_a_node_cannot_do_its_work() -> None:
    required = {
        f"{name}.{port.id.text}": "".join(each[0] for each in DISTRIBUTIONS if _requires(each, name, port.id.text))
        for distribution in DISTRIBUTIONS
        for name, model in models_of(distribution).items()
        for port in model.ports
        if port.id is not None
    }
    expected = {
        "ClearEntireCostmap.service_name": "hijkl",
        "RemoveInCollisionGoals.service_name": "k",  # Kilted drops the name that others take
        "ValidatePath.service_name": "",
        "TransformAvailable.child": "hijkl",  # the code has an empty default, and refuses it
        "FollowPath.path": "hijkl",
        "FollowPath.controller_id": "",
        "FollowPath.server_timeout": "",
        "GoalUpdater.input_goal": "hij",
        "PersistentSequence.current_child_idx": "l",
        "RateController.hz": "",
    }
    assert {port: required[port] for port in expected} == expected


def _requires(distribution: str, name: str, port: str) -> bool:
    model = models_of(distribution).get(name)
    return model is not None and any(each.id and each.id.text == port and each.default is None for each in model.ports)


# ---- against the code ----


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
def test_a_file_is_what_the_tool_writes(distribution: str) -> None:
    assert text_of(distribution) == model_file(clone(), distribution)


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
def test_what_the_code_shows_of_missing_inputs_agrees(distribution: str) -> None:
    required = {
        (name, port)
        for table in (REQUIRED, REQUIRED_IN.get(distribution, {}))
        for name, names in table.items()
        for port in names
    }
    shown = {(node.name, port): what for node in read(distribution).nodes for port, what in node.without}
    assert {port for port, what in shown.items() if what == "fails"} - required == set()
    assert {port for port, what in shown.items() if what == "goes on"} & required == set()
