"""Nav2's own parameters on every branch: nothing is wrong with them there, and what is on the next one has names."""

from __future__ import annotations

import tarfile
from collections import Counter
from io import BytesIO
from pathlib import Path
from subprocess import run

import pytest
from nav2_clone import clone
from nav2_robot import findings_in

from btq_lang.catalog.nav2 import DISTRIBUTIONS
from btq_lang.nav2.parameters import read_parameters

FOLDER = "nav2_bringup/params"
PARAMETERS = f"{FOLDER}/nav2_params.yaml"


@pytest.fixture(scope="module", params=DISTRIBUTIONS)
def branch(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[str, Path]:
    """A branch, and a folder with its trees and parameters."""
    folder = tmp_path_factory.mktemp(request.param)
    command = ["git", "-C", str(clone()), "archive", request.param, "nav2_bt_navigator", FOLDER]
    with tarfile.open(fileobj=BytesIO(run(command, capture_output=True, check=True).stdout)) as archive:
        archive.extractall(folder, filter="data")
    return request.param, folder


def test_the_parameters_tell_the_distribution_and_are_right_there(branch: tuple[str, Path]) -> None:
    distribution, folder = branch
    text = (folder / PARAMETERS).read_text()
    assert read_parameters(text).distribution == distribution
    assert findings_in(folder, text) == findings_in(folder, text, distribution) == []


def test_its_other_parameters(branch: tuple[str, Path]) -> None:
    """Those for several robots on the branch of Humble are for Iron: bt_navigator cannot load four of the libraries."""
    distribution, folder = branch
    found = Counter(
        (path.name, each.rule)
        for path in sorted((folder / FOLDER).glob("*.yaml"))
        for _, each in findings_in(folder, path.read_text(), distribution)
    )
    wrong = {("nav2_multirobot_params_all.yaml", rule): 4 for rule in ("nav2-parameter", "unknown-library")}
    assert found == (wrong if distribution == "humble" else {})


def test_what_is_wrong_with_them_on_the_next_branch(branch: tuple[str, Path]) -> None:
    distribution, folder = branch
    if distribution == DISTRIBUTIONS[-1]:
        return
    after = DISTRIBUTIONS[DISTRIBUTIONS.index(distribution) + 1]
    found = [each for _, each in findings_in(folder, (folder / PARAMETERS).read_text(), after)]
    counts = Counter(each.rule for each in found)
    names = {each.message for each in found if each.rule == "nav2-parameter"}
    assert (dict(counts), names) == EXPECTED[distribution]


_CLASS = "the class of this navigator is called `nav2_bt_navigator::{}Navigator` in Jazzy"
_UNREAD = "Nav2 does not read `{}` in {}"
# How often each rule is broken, and the messages about parameters.
EXPECTED = {
    "humble": ({}, set()),  # its trees have none of the nodes that Iron adds
    "iron": (
        {"library-loaded-twice": 1, "nav2-parameter": 2},
        {_CLASS.format("NavigateToPose"), _CLASS.format("NavigateThroughPoses")},
    ),
    "jazzy": (
        {"nav2-parameter": 2},
        {
            "bt_navigator refuses to start with `error_code_names` in Kilted",
            _UNREAD.format("action_server_result_timeout", "Kilted"),
        },
    ),
    # All trees of Kilted are called `MainTree`, so Lyrical reads one of its files.
    "kilted": (
        {"nav2-parameter": 1, "skipped-tree-file": 14},
        {_UNREAD.format("service_introspection_mode", "Lyrical")},
    ),
}
