"""What holds for every mission: compared with itself there is no difference, and one edit gives just that change."""

from __future__ import annotations

import copy
import random
from collections.abc import Callable
from dataclasses import dataclass, field

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from missions import Spelling, mission
from seeds import seeds

from btq_lang.diff import Change, compare
from btq_lang.formatter import format_text
from btq_lang.workspace.workspace import Workspace

INNER = ("->", "?", "R->")
LEAVES = ("Pick", "Place", "MoveBase")


def compare_texts(old: str, new: str) -> tuple[Change, ...]:
    return compare(Workspace.of({"m.btq": old}), ("m.btq",), Workspace.of({"m.btq": new}), ("m.btq",))


# ---- with itself ----


@pytest.mark.parametrize("spelling", ["short", "classic"])
@pytest.mark.parametrize("seed", seeds(3))
def test_a_mission_and_itself(seed: int, spelling: Spelling) -> None:
    text = mission(300, seed, spelling)
    assert compare_texts(text, text) == ()
    assert compare_texts(text, format_text(text).text) == ()


def test_two_missions_that_have_nothing_in_common() -> None:
    old, new = mission(200, 1, "short"), mission(200, 2, "short")
    there, back = compare_texts(old, new), compare_texts(new, old)
    for thing in ("tree", "requirement"):
        counts = [[change.what for change in changes if change.thing == thing] for changes in (there, back)]
        assert counts[0].count("added") == counts[1].count("removed")
        assert counts[0].count("removed") == counts[1].count("added")


# ---- one edit ----


@dataclass
class Made:
    """A node of a mission made up here."""

    kind: str
    label: str = ""
    station: str = ""
    children: list[Made] = field(default_factory=list)

    def lines(self, depth: int) -> str:
        values = f" (station = {self.station})" if self.station else ""
        label = f" {self.label}" if self.label else ""
        own = f"{'    ' * depth}{self.kind}{label}{values}\n"
        return own + "".join(child.lines(depth + 1) for child in self.children)

    def below(self) -> list[Made]:
        return [self, *(each for child in self.children for each in child.below())]


leaves = st.builds(Made, st.sampled_from(LEAVES), st.just(""), st.sampled_from(["", "a", "b", "c"]))
nodes = st.recursive(
    leaves,
    lambda below: st.builds(
        Made,
        st.sampled_from(INNER),
        st.sampled_from(["", "", "Work", "Rest"]),
        st.just(""),
        st.lists(below, min_size=1),
    ),
    max_leaves=25,
)
missions = st.lists(nodes.filter(lambda node: bool(node.children)), min_size=1, max_size=3)


def text_of(trees: list[Made]) -> str:
    return "".join(f"BehaviorTree T{number}\n{tree.lines(1)}" for number, tree in enumerate(trees))


def parents(trees: list[Made]) -> list[Made]:
    return [each for tree in trees for each in tree.below() if each.children]


def add(trees: list[Made], chance: random.Random) -> tuple[str, str]:
    parent = chance.choice(parents(trees))
    parent.children.insert(chance.randrange(len(parent.children) + 1), Made("Charge"))
    return "added", "Charge"


def remove(trees: list[Made], chance: random.Random) -> tuple[str, str]:
    parent = chance.choice(parents(trees))
    gone = parent.children.pop(chance.randrange(len(parent.children)))
    return "removed", gone.label or gone.kind


def change(trees: list[Made], chance: random.Random) -> tuple[str, str]:
    node = chance.choice([each for tree in trees for each in tree.below() if not each.children])
    node.station = "elsewhere"
    return "changed", node.kind


def rename(trees: list[Made], chance: random.Random) -> tuple[str, str]:
    node = chance.choice([each for tree in trees for each in tree.below()])
    node.label = "Renamed"
    return "changed", "Renamed"


def wrap(trees: list[Made], chance: random.Random) -> tuple[str, str]:
    parent = chance.choice(parents(trees))
    at = chance.randrange(len(parent.children))
    parent.children[at] = Made("Inverter", children=[parent.children[at]])
    return "added", "Inverter"


def replace_kind(trees: list[Made], chance: random.Random) -> tuple[str, str]:
    node = chance.choice(parents(trees))
    node.kind = "R?"
    return "changed", node.label or "R?"


@pytest.mark.parametrize("edit", [add, remove, change, rename, wrap, replace_kind], ids=lambda edit: edit.__name__)
@settings(max_examples=40)  # each parses two missions
@given(trees=missions, seed=st.integers(0, 1_000))
def test_one_edit_is_told_as_just_that(
    edit: Callable[[list[Made], random.Random], tuple[str, str]], trees: list[Made], seed: int
) -> None:
    edited = copy.deepcopy(trees)
    what, name = edit(edited, random.Random(seed))
    changes = compare_texts(text_of(trees), text_of(edited))
    assert [(each.what, each.thing, each.name.rpartition("/")[2]) for each in changes] == [(what, "node", name)]


@settings(max_examples=40)  # each parses two missions
@given(trees=missions, seed=st.integers(0, 1_000))
def test_a_wrapper_that_is_taken_away_is_all_that_is_gone(trees: list[Made], seed: int) -> None:
    edited = copy.deepcopy(trees)
    wrap(edited, random.Random(seed))
    (change,) = compare_texts(text_of(edited), text_of(trees))
    assert (change.what, change.name.rpartition("/")[2], len(change.around)) == ("removed", "Inverter", 1)


@settings(max_examples=40)  # each parses two missions
@given(trees=missions, seed=st.integers(0, 1_000))
def test_a_node_that_is_known_again_and_stands_elsewhere_has_moved(trees: list[Made], seed: int) -> None:
    chance = random.Random(seed)
    homes = parents(trees)
    home = chance.choice(homes)
    home.children.insert(chance.randrange(len(home.children) + 1), Made("Charge", "Marked"))
    edited = copy.deepcopy(trees)
    home = next(each for each in parents(edited) if any(child.label == "Marked" for child in each.children))
    at = next(number for number, child in enumerate(home.children) if child.label == "Marked")
    marked = home.children.pop(at)
    target = chance.choice([each for each in parents(edited) if each is not home] or [home])
    target.children.insert(chance.randrange(len(target.children) + 1), marked)
    old, new = text_of(trees), text_of(edited)
    moved = {(each.what, each.name.rpartition("/")[2]) for each in compare_texts(old, new)}
    # Of nodes that changed sides, or of subtrees that are alike, it is unknown which has moved; nothing else has.
    assert {what for what, _ in moved} == ({"moved"} if old != new else set())
    assert target is home or ("moved", "Marked") in moved
