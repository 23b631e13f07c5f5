"""The missions that benchmarks read: always the same, of the size asked for, and without a syntax error."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator
from xml.etree import ElementTree

import ceilings
import missions
import pytest
from missions import Spelling, mission, plan
from seeds import seeds

from btq_lang.parser import parse
from btq_lang.syntax.tree import Node, Tree

SPELLINGS: tuple[Spelling, ...] = ("classic", "short")


# Figures are compared across machines and Pythons: after a change here the published ones are another mission's.
@pytest.mark.parametrize(
    ("spelling", "digest"),
    [
        ("classic", "926355683804190f7c3a2cff01b68071ab82aadfe33c4600f48e2101dc8a593e"),
        ("short", "42d764345c5f41146dcfa9443e832dec4a076fd0585499eff4631f5f96afdff3"),
    ],
)
def test_the_default_mission_never_changes(spelling: Spelling, digest: str) -> None:
    assert hashlib.sha256(mission(spelling=spelling).encode()).hexdigest() == digest


def test_another_seed_is_another_mission() -> None:
    assert mission(100, 1) != mission(100, 2)


@pytest.mark.parametrize("nodes", missions.SIZES)
def test_a_plan_has_the_nodes_asked_for(nodes: int) -> None:
    assert sum(1 for _ in plan(nodes).steps()) == nodes


@pytest.mark.parametrize("seed", seeds(20))
@pytest.mark.parametrize("spelling", SPELLINGS)
def test_every_seed_parses_without_a_diagnostic(seed: int, spelling: Spelling) -> None:
    parsed = parse(mission(150, seed, spelling))
    assert parsed.diagnostics == ()
    assert sum(1 for tree in parsed.trees for _ in tree.walk()) == 150


def test_the_default_mission_is_as_described() -> None:
    text = mission()
    parsed = parse(text)
    nodes = [node for tree in parsed.trees for node in tree.walk()]
    assert parsed.diagnostics == ()
    assert len(nodes) == 10_000
    assert sum(1 for node in nodes if node.clauses) == 1_500
    assert max(_depth(node) for tree in parsed.trees for node in _tops(tree)) == 12
    assert 990_000 < len(text) < 1_030_000
    assert len(parsed.trees) == 550


def test_both_spellings_are_the_same_trees() -> None:
    classic, short = (parse(mission(500, 3, spelling)).trees for spelling in SPELLINGS)
    assert [[_shape(node) for node in _tops(tree)] for tree in classic] == [
        [_shape(node) for node in _tops(tree)] for tree in short
    ]


def test_the_ceilings_are_the_same_trees() -> None:
    made = plan(500, 3)
    shapes = [_shape(node) for tree in parse(missions.write(made, "classic")).trees for node in _tops(tree)]
    objects = [tree["top"] for tree in json.loads(ceilings.as_json(made))["trees"]]
    assert [_object_shape(top) for top in objects] == shapes
    root = ElementTree.fromstring(ceilings.as_xml(made))
    assert [_element_shape(tree[0]) for tree in root] == shapes


def test_a_mission_smaller_than_a_tree_is_refused() -> None:
    with pytest.raises(ValueError, match="at least 6 nodes"):
        mission(5)


def _tops(tree: Tree) -> Iterator[Node]:
    return (child for child in tree.children if isinstance(child, Node))


def _depth(node: Node) -> int:
    return 1 + max((_depth(child) for child in node.nodes), default=0)


def _shape(node: Node) -> list[object]:
    return [_shape(child) for child in node.nodes]


def _object_shape(step: dict[str, list[dict[str, list[object]]]]) -> list[object]:
    return [_object_shape(child) for child in step.get("children", ())]  # type: ignore[arg-type]  # JSON has no types


def _element_shape(element: ElementTree.Element) -> list[object]:
    return [_element_shape(child) for child in element]
