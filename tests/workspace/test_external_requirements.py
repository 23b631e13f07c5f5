"""The table `[requirements]` of a project file: its settings, and what is reported about errors in it."""

from __future__ import annotations

import pytest
from test_config import problems

from btq_lang.workspace.config import parse_project
from btq_lang.workspace.external_requirements import (
    ExternalRequirement,
    ExternalRequirements,
    RequirementSettings,
)

WHOLE = """\
[requirements]
import = ["docs/needs.json", "../reqs.csv", "reqs.reqif"]
approval = "required"
"""


def test_every_key() -> None:
    project, wrong = parse_project(WHOLE, root="/home/robot")
    assert wrong == ()
    assert project.requirements == RequirementSettings(("docs/needs.json", "../reqs.csv", "reqs.reqif"), True)
    assert project.imports == ("/home/robot/docs/needs.json", "/home/reqs.csv", "/home/robot/reqs.reqif")


def test_what_is_right_is_kept() -> None:
    project, _ = parse_project('[requirements]\nimport = ["a.json", "b.xlsx"]', root="/r")
    assert project.imports == ("/r/a.json",)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("requirements = 1", "1:1: `requirements` must be a table"),
        ("[requirements]\nimports = []", "2:1: unknown key `requirements.imports`; did you mean `import`?"),
        ('[requirements]\nimport = "a.json"', "2:1: `requirements.import` must be a list of files"),
        ('[requirements]\nsource = "yes"', '2:1: `requirements.source` must be "optional" or "required"'),
        ("[requirements]\napproval = true", '2:1: `requirements.approval` must be "optional" or "required"'),
        ("[requirements]\nimport = [1]", "2:1: `requirements.import` must be a list of files"),
        (
            '[requirements]\nimport = ["a.json", "b.xlsx"]',
            "2:21: `b.xlsx` is of an unknown format; expected a file that ends in .json, .csv, .reqif",
        ),
    ],
)
def test_problems_and_their_places(text: str, expected: str) -> None:
    assert problems(text) == [expected]


def test_of_several_with_one_id_the_first_counts() -> None:
    first, second, other = (
        ExternalRequirement(id_, title, "", "", "", "a.csv", 1) for id_, title in ("aA", "aB", "bC")
    )
    requirements = ExternalRequirements([first, second, other])
    assert [*requirements.by_id.values()] == [first, other]
    assert requirements == ExternalRequirements([first, other])
    assert requirements != ExternalRequirements([second, other])
