"""`[[factory]]` of the project file: what is read, and what is reported with its place."""

from __future__ import annotations

import pytest

from btq_lang.workspace.config import parse_project
from btq_lang.workspace.factories import Factory

WHOLE = """\
[[factory]]
name = "nav"
load = ["trees/*.xml", "package://docking/trees/*.xml"]
main = "Navigate"
nodes = ["models.xml"]

[[factory]]
name = "arm"
main = ["Pick", "Place"]
nav2 = "params.yaml"
"""


def test_every_key() -> None:
    project, problems = parse_project(WHOLE)
    assert problems == ()
    assert project.factories == (
        Factory("nav", ("trees/*.xml", "package://docking/trees/*.xml"), ("Navigate",), ("models.xml",)),
        Factory("arm", main=("Pick", "Place"), nav2="params.yaml"),
    )


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("factory = 1", ["1:1: `factory` must be a list of tables: `[[factory]]`"]),
        ("[factory]", ["1:2: `factory` must be a list of tables: `[[factory]]`"]),
        (
            "[[factory]]\nlaod = []",
            ["2:1: unknown key `factory.laod`; did you mean `load`?", "1:3: a factory needs a `name`"],
        ),
        ('[[factory]]\nname = "a"\nnav2 = ["p.yaml"]', ["3:1: `factory.nav2` must be the name of a file"]),
        ('[[factory]]\nname = "a"\nnav2 = ""', ["3:1: `factory.nav2` must be the name of a file"]),
        ('[[factory]]\nname = "a"\nnav2 = []', ["3:1: `factory.nav2` must be the name of a file"]),
        ('[[factory]]\nname = "a"\nload = "x"', ["3:1: `factory.load` must be a list of strings"]),
        ('[[factory]]\nname = ["a"]', ["2:1: `factory.name` must be a string"]),
        ("[[factory]]\nname = []", ["2:1: `factory.name` must be a string"]),
        ('[[factory]]\nname = ""', ["1:3: a factory needs a `name`"]),
        ('[[factory]]\nname = "a"\nmain = ""', ["3:1: `factory.main` must be a tree or a list of trees"]),
        ('[[factory]]\nname = "a"\nmain = 3', ["3:1: `factory.main` must be a tree or a list of trees"]),
        (
            '[[factory]]\nname = "a"\n[[factory]]\nname = "b"\nmain = [""]',
            ["5:1: `factory.main` must be a tree or a list of trees"],
        ),
        ('[[factory]]\nname = "a"\n\n[[factory]]\nname = "a"', ["5:8: duplicate factory `a`"]),
    ],
)
def test_problems_and_their_places(text: str, expected: list[str]) -> None:
    problems = parse_project(text)[1]
    places = [(each.position, each.message) for each in problems]
    assert [f"{at.line + 1}:{at.column + 1}: {message}" for at, message in places if at is not None] == expected


def test_what_is_right_holds_beside_what_is_wrong() -> None:
    project, _ = parse_project('[[factory]]\nname = "a"\nload = 1\nmain = "Main"\n[[factory]]\n[[factory]]\nname = "b"')
    assert project.factories == (Factory("a", main=("Main",)), Factory("b"))
