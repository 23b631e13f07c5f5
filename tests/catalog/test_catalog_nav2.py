"""The model files of Nav2's nodes: what they hold, and that they are what the C++ code of Nav2 says."""

from __future__ import annotations

import os
import sys
from collections import Counter
from functools import cache
from pathlib import Path

import pytest

from btq_lang.catalog.kinds import CATEGORIES
from btq_lang.catalog.nav2 import DISTRIBUTIONS, PACKAGED
from btq_lang.checks import check
from btq_lang.cpp.model import CppNode
from btq_lang.formatter import format_text
from btq_lang.parser import parse
from btq_lang.syntax.tree import Model, Models
from btq_lang.workspace.workspace import Workspace

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))

from nav2_nodes import model_file  # noqa: E402  # the tools are scripts, no package
from nav2_sources import PALETTE, sources  # noqa: E402
from nav2_words import NODES, PORTS, REQUIRED, REQUIRED_IN  # noqa: E402

COUNTS = {  # actions, conditions, controls, decorators, ports
    "humble": (32, 12, 3, 7, 170),
    "iron": (30, 16, 3, 7, 163),
    "jazzy": (38, 17, 3, 7, 234),
    "kilted": (41, 19, 3, 7, 274),
    "lyrical": (49, 19, 6, 7, 327),
}


def text_of(distribution: str) -> str:
    return Path(PACKAGED[f"nav2-{distribution}"]).read_text(encoding="utf-8")


def models(distribution: str) -> dict[str, Model]:
    (entry,) = parse(text_of(distribution)).entries
    assert isinstance(entry.item, Models)
    return {model.name.text: model for model in entry.item.models if model.name is not None}


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
def test_a_file_is_clean_formatted_and_whole(distribution: str) -> None:
    text = text_of(distribution)
    assert check(Workspace.of({"nav2.btq": text}), "nav2.btq") == ()
    assert format_text(text).text == text
    found = models(distribution)
    categories = Counter(model.category.raw for model in found.values())
    counted = (*(categories[each] for each in CATEGORIES[:4]), sum(len(model.ports) for model in found.values()))
    assert counted == COUNTS[distribution]


def test_what_is_said_of_nodes_is_said_of_existing_ones() -> None:
    of_all = [models(each) for each in DISTRIBUTIONS]
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
        for name, model in models(distribution).items()
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
    model = models(distribution).get(name)
    return model is not None and any(each.id and each.id.text == port and each.default is None for each in model.ports)


# ---- against the code ----


@cache
def in_code(distribution: str) -> tuple[CppNode, ...]:
    from btq_lang.cpp.nodes import read_nodes

    files = {path: text for path, text in sources(clone(), distribution).items() if path != PALETTE}
    return read_nodes(files).nodes


def clone() -> Path:
    pytest.importorskip("tree_sitter_cpp", reason="the C++ grammar is not installed: pip install -e '.[cpp]'")
    folder = os.environ.get("BTQ_NAV2")
    if not folder:
        pytest.skip("no clone of navigation2: set BTQ_NAV2 to one that has the branches humble to lyrical")
    return Path(folder)


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
    shown = {(node.name, port): what for node in in_code(distribution) for port, what in node.without}
    assert {port for port, what in shown.items() if what == "fails"} - required == set()
    assert {port for port, what in shown.items() if what == "goes on"} & required == set()
