"""A campaign of simulated variants, a folder each: `btq verify --label-by folder`, then `btq compare`."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import fleet
import pytest
from in_process import run_btq

from btq_lang.evidence.store import engine

VARIANTS: dict[str, tuple[dict[str, float], dict[str, float]]] = {
    "base": ({}, {}),
    "same": ({}, {}),
    "slow": ({"Follow": 6.6}, {}),  # seconds
    "clumsy": ({}, {"Pick": 0.6}),  # how often it fails
}


@pytest.fixture(scope="module")
def campaign(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the store of four variants, each of two logs with 60 runs."""
    folder = tmp_path_factory.mktemp("campaign")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(fleet, "VERSIONS", VARIANTS)
        patch.setattr(fleet, "MISSION", fleet.MISSION.replace("tries at most 6", "tries at most 60"))
        fleet.write_logs(folder, 1, [*VARIANTS], 2, 60)
    for variant in VARIANTS:
        (folder / "logs" / variant / "r001").rename(folder / variant)
    assert verify(folder, *VARIANTS) == 1
    return folder


def verify(folder: Path, *logs: str) -> int:
    asked = ("--mission", "fetch.btq", "--store", "kept", "--label-by", "folder", "-o", "verdicts.json")
    code, output, errors = run_btq("verify", *logs, *asked, cwd=folder)
    assert (output, errors) == ("", "")
    return code


def labels(folder: Path) -> list[tuple[str, str, int]]:
    """The logs of the store, their labels and how many runs each has."""
    asked = engine.asked(str(folder / "kept"))
    rows = asked("SELECT source, label, COUNT(*) AS number FROM runs GROUP BY ALL ORDER BY ALL")
    return [(row["source"], row["label"], row["number"]) for row in rows]


def compared(folder: Path, variant: str) -> tuple[int, list[str], set[tuple[str, str]]]:
    """The exit code, what is newly violated, and what is found at which nodes, from `base` to a variant."""
    code, output, errors = run_btq("compare", "kept", "base", variant, "--format", "json", cwd=folder)
    assert errors == ""
    (mission,) = json.loads(output)["missions"]
    assert mission["runs"] == [120, 120]
    found = {(each["finding"], each["node"]) for each in mission["changes"] if each["finding"]}
    return code, [each["id"] for each in mission["newly"]], found


def test_the_folders_are_the_labels(campaign: Path) -> None:
    assert labels(campaign) == [
        (f"{variant}/{day}.btlog", variant, 60) for variant in sorted(VARIANTS) for day in ("01", "02")
    ]


def test_a_variant_that_differs_in_nothing(campaign: Path) -> None:
    assert compared(campaign, "same") == (0, [], set())


def test_a_slower_node_is_one_line_with_what_waits_for_it(campaign: Path) -> None:
    code, output, errors = run_btq("compare", "kept", "base", "slow", cwd=campaign)
    assert (code, errors) == (1, "")
    assert output.splitlines()[2:6] == [
        "  newly violated  quick Follow a path in time  was satisfied; violated in 0 of 366 → 79 of 393, p < 0.0001",
        "                                               and slower: mean 6.07 s → 6.7 s (+634 ms, +10.5 %;"
        " 95 % interval +481 ms to +788 ms) over 120 and 120 runs, p < 0.0001",
        "  slower          Drive (1 of 2)/Follow        mean 5.97 s → 6.75 s (+775 ms, +13 %;"
        " 95 % interval +574 ms to +976 ms) over 120 and 120 runs, p < 0.0001",
        "                                               and 6 nodes above it: Drive (1 of 2)/Sequence;"
        " Drive (1 of 2)/drive; Drive (1 of 2); Sequence (2 of 4); shelf; 1 more",
    ]
    assert output.splitlines()[6] == ""


def test_a_node_that_fails_more_often_and_what_waits_for_it(campaign: Path) -> None:
    code, output, errors = run_btq("compare", "kept", "base", "clumsy", cwd=campaign)
    assert (code, errors) == (1, "")
    lines = output.split("\n\n")[1].splitlines()
    assert [line[:60].split("  ")[1:3] for line in lines if line[2] != " "] == [
        ["less reliable", "Pick"],
        ["less reliable", "Look"],
        ["slower", ""],
        ["slower", ""],
        ["higher", ""],
    ]


def test_logs_outside_of_folders_and_in_nested_ones(campaign: Path, tmp_path: Path) -> None:
    """The nearest folder names the label, also where it is the one that the command is run in."""
    folder = tmp_path / "home"
    (folder / "slow" / "monday").mkdir(parents=True)
    shutil.copy(campaign / "fetch.btq", folder)
    shutil.copy(campaign / "base" / "01.btlog", folder / "loose.btlog")
    shutil.copy(campaign / "slow" / "01.btlog", folder / "slow" / "monday")
    shutil.copy(campaign / "slow" / "02.btlog", folder / "slow")
    assert verify(folder, "loose.btlog", "slow") == 1
    assert labels(folder) == [
        ("loose.btlog", "home", 60),
        ("slow/02.btlog", "slow", 60),
        ("slow/monday/01.btlog", "monday", 60),
    ]
