"""The rows of Nav2's nodes: that they agree with its model files and with its code."""

from __future__ import annotations

import re

import pytest
from nav2_clone import files, read

from btq_lang.catalog.nav2 import DISTRIBUTIONS
from btq_lang.catalog.nav2.nodes import NODES, nodes_of
from btq_lang.commands.explain_nav2 import models_of

# What the classes of leaves derive from that end within the tick.
SYNCHRONOUS = ("BT::ActionNodeBase", "BT::SyncActionNode")


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
def test_rows_agree_with_the_models(distribution: str) -> None:
    models, rows = models_of(distribution), nodes_of(distribution)
    assert {name for name, model in models.items() if model.category.raw in ("Control", "Decorator")} <= rows.keys()
    for name in models.keys() & rows.keys():
        assert rows[name].category == models[name].category.raw
        declared = {port.id.text: port for port in models[name].ports if port.id is not None}
        for row in rows[name].ports:
            port = declared[row.name]
            assert port.type is not None
            assert port.text is not None
            assert (row.type, row.doc, row.direction) == (port.type.text, port.text.text, port.direction.raw)
            assert row.default == (port.default.text if port.default is not None else None)


def test_every_row_is_of_an_existing_node() -> None:
    assert {*NODES} <= {name for each in DISTRIBUTIONS for name in models_of(each)}


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
def test_actions_within_a_tick_are_those_that_use_no_server(distribution: str) -> None:
    bases: dict[str, str] = {}
    for text in files(distribution).values():
        bases.update(re.findall(r"class\s+(\w+)\s*:\s*public\s+([\w:]+)", text))
    models, rows = models_of(distribution), nodes_of(distribution)
    found = {
        node.name
        for node in read(distribution).nodes
        if node.category == "Action" and bases[node.class_name.rpartition("::")[2]] in SYNCHRONOUS
    }
    actions = {name for name in models.keys() & rows.keys() if rows[name].category == "Action"}
    assert found == actions
    waiting = {name for name in actions if rows[name].flow == "waits"}
    assert waiting == ({"CheckStopStatus"} if distribution == "lyrical" else set())
