"""Which entries Nav2's nodes need to be created, and which servers they call: the table against every branch's code."""

from __future__ import annotations

import re
from subprocess import run

import pytest
from nav2_clone import clone, files, read
from test_nav2_reading import called_from, definitions, port_names

from btq_lang.catalog.nav2 import DISTRIBUTIONS
from btq_lang.catalog.nav2.creation import CREATED_WITH, SERVERS, created_with
from btq_lang.commands.explain_nav2 import models_of

TAKES = re.compile(r'blackboard->\s*(?:template )?get<[^;()]*>\(\s*"(\w+)"\)')
INCLUDES = "nav2_behavior_tree/include/nav2_behavior_tree"
BASES = {
    "BtActionNode": "bt_action_node.hpp",
    "BtServiceNode": "bt_service_node.hpp",
    "BtCancelActionNode": "bt_cancel_action_node.hpp",
}


def test_the_tables_are_of_existing_nodes() -> None:
    assert CREATED_WITH.keys() | SERVERS.keys() <= {name for each in DISTRIBUTIONS for name in models_of(each)}


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
def test_the_entries_are_those_that_constructors_take(distribution: str) -> None:
    texts = files(distribution)
    bases = {base: _taken_by_base(distribution, base, header) for base, header in BASES.items()}
    derived: dict[str, str] = {}
    functions: dict[str, dict[str, str]] = {}
    for path, text in texts.items():
        derived.update(re.findall(r"class\s+(\w+)\s*:\s*public\s+(?:\w+::)*(\w+)", text))
        for owner, name, body in definitions(text) if path.endswith(".cpp") else ():
            functions.setdefault(owner, {})[name] = body
    checked = 0
    for node in read(distribution).nodes:
        owner = node.class_name.rpartition("::")[2]
        bodies = functions.get(owner, {})
        taken = {entry for body in called_from(bodies, owner) for entry in TAKES.findall(body)}
        taken |= bases.get(derived.get(owner, ""), set())
        assert {*created_with(distribution, node.name, port_names(distribution, node.name))} == taken, node.name
        checked += bool(taken)
    assert checked > 40


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
def test_the_servers_are_those_of_the_registrations(distribution: str) -> None:
    names = {node.class_name.rpartition("::")[2]: node.name for node in read(distribution).nodes}
    named = re.compile(r'make_unique<(?:\w+::)*(\w+)>\(\s*name,\s*"(\w+)"')
    pairs = [
        pair for path, text in files(distribution).items() if path.endswith(".cpp") for pair in named.findall(text)
    ]
    found = {names[owner]: server for owner, server in pairs if not names[owner].startswith("Cancel")}
    assert found == {name: server for name, server in SERVERS.items() if name in models_of(distribution)}


def _taken_by_base(distribution: str, base: str, header: str) -> set[str]:
    command = ["git", "-C", str(clone()), "show", f"{distribution}:{INCLUDES}/{header}"]
    text = run(command, capture_output=True, check=True, text=True).stdout
    bodies = dict(re.findall(r"\n  (?:\w+ )*(\w+)\([^;{]*?(\{.*?\n  \})", text, re.DOTALL))
    return {entry for body in called_from(bodies, base) for entry in TAKES.findall(body)}
