"""Logs of other people, by hand and by the engine, on which a verdict is easily wrong: what must be said of each."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import pytest
from evidence_logs import Verify


@pytest.fixture
def field(shared: Path, verify: Verify) -> Verify:
    """`btq verify` in a folder with all of them."""
    if not (shared / "field" / "verdicts").is_dir():
        pytest.skip("the shared inputs have no field/verdicts")
    for folder in ("hand", "engine"):
        for file in (shared / "field" / "verdicts" / folder).iterdir():
            shutil.copyfile(file, verify.folder / file.name)
    return verify


def clauses(field: Verify, line: str) -> list[tuple[str, str, int, int]]:
    """The requirement, verdict, violated and counted of each clause."""
    found = field.json(*line.split())
    return [
        (each["id"], clause["verdict"], clause["violated"], clause["counted"])
        for each in found["requirements"]
        for clause in each["clauses"]
    ]


def worst(field: Verify, line: str) -> dict[str, Any]:
    found = field.json(*line.split())
    return {
        f"{each['id']} {clause['path'].rpartition('/')[2]}": clause["worst"] and clause["worst"]["text"]
        for each in found["requirements"]
        for clause in each["clauses"]
    }


@pytest.mark.parametrize("mission", ["nosig.btq", "nosigf.btq"])
def test_nothing_is_satisfied_without_a_sample(mission: str, field: Verify) -> None:
    line = f"nosig.btlog --mission {mission} --strict"
    assert clauses(field, line) == [(name, "unknown", 0, 0) for name in ("q1", "q2", "q3")]
    assert set(worst(field, line).values()) == {None}
    assert field.code == 1


def test_every_requirement_is_there(field: Verify) -> None:
    found = field.json("nosig.btlog", "--mission", "rev.btq", "--strict")["requirements"]
    verdicts = {each["id"]: each["verdict"] for each in found}
    assert verdicts == {"q1": "satisfied", "q2": "open", "q3": "open", "q4": "open"}
    assert field.code == 1


def test_use_adds_up(field: Verify) -> None:
    line = "reset.btlog --mission reset.btq --signals reset.csv"
    assert clauses(field, line) == [("k2", "violated", 1, 1), ("k3", "violated", 1, 1)]
    assert worst(field, line) == {"k2 Sequence::1": "90 Wh", "k3 Sequence::1": "95 %"}


def test_a_leaf_that_blocks_the_tree_takes_its_time(field: Verify) -> None:
    assert worst(field, "e1.btlog --mission e1.btq")["quick Blocks"] == "413 ms"
    assert clauses(field, "e2.btlog --mission e2.btq") == [
        ("q", "violated", 1, 1),
        ("q", "violated", 1, 1),
        ("q", "satisfied", 0, 1),
        ("two", "violated", 1, 1),
        ("tot", "violated", 1, 1),
    ]
    assert worst(field, "e2.btlog --mission e2.btq") == {
        "q B1": "250 ms",
        "q B2": "254 ms",
        "q W": "50.8 ms",
        "two B1, B2": "504 ms",
        "tot B1, B2": "504 ms",
    }


def test_what_a_guard_refused_or_stopped_is_violated(field: Verify) -> None:
    found = field.json("g1i.btlog", "--mission", "g1.btq")["requirements"]
    assert {each["id"]: each["clauses"][0]["violations"][0]["why"] for each in found} == {
        "k": "its start was refused by its guard at k_guard",
        "n": "its start was refused by its guard at n_guard",
        "d": "its start was refused by its guard at d_check",
        "l": "its guard at l_check did not accept its success",
        "u": "stopped by its own guard after 138 ms",
    }
    assert {each["verdict"] for each in found} == {"violated"}
    assert worst(field, "h1.btlog --mission h1.btq") == {"clear Lift": None, "wait Pause": "250.1 ms"}


def test_refused_tries_violate_their_runs(field: Verify) -> None:
    assert ("pat", "violated", 2, 2) in clauses(field, "e6.btlog --mission e6.btq")
    assert worst(field, "e6.btlog --mission e6.btq")["pat Y"] == "3"


def test_what_is_not_counted_is_said(field: Verify) -> None:
    """A run breaks `succeeds` if one try fails, and `leaves` is about runs that succeeded."""
    verdicts = clauses(field, "ev.btlog --mission ev.btq --signals ev.csv")
    assert verdicts == [("e1", "violated", 3, 3), ("e2", "satisfied", 0, 3), ("e3", "satisfied", 0, 1)]
    printed = field.text("ev.btlog", "--mission", "ev.btq", "--signals", "ev.csv")
    assert "held so far in 1 activation, worst 40 m in run 1, 2 that failed were not counted" in printed


def test_reactions_are_judged_as_they_are_written(field: Verify) -> None:
    found = {name: clauses(field, f"resp{name}.btlog --mission resp.btq --signals resp{name}.csv") for name in "AB"}
    assert {name: {each[0]: each[1] for each in found[name]} for name in found} == {
        "A": {"r1": "violated", "r2": "satisfied", "r3": "never exercised", "r4": "violated"},
        "B": {"r1": "satisfied", "r2": "violated", "r3": "violated", "r4": "violated"},
    }
    printed = field.text("respA.btlog", "--mission", "resp.btq", "--signals", "respA.csv")
    assert "it was not running when person < 0.5 m (1 time)" in printed


def test_a_node_that_did_not_start_in_some_run_is_said_to(field: Verify) -> None:
    assert clauses(field, "cov.btlog --mission cov.btq")[:2] == [("c1", "violated", 1, 2), ("c1", "satisfied", 0, 1)]
    assert "held so far in 1 activation, not started in 1 run" in field.text("cov.btlog", "--mission", "cov.btq")


@pytest.fixture
def robot(shared: Path, field: Verify) -> Verify:
    for file in (shared / "field" / "verdicts" / "robot").iterdir():
        if file.is_file():
            shutil.copyfile(file, field.folder / file.name)
    return field


def test_only_nodes_that_block_the_tree_are_called_that(robot: Verify) -> None:
    ticks = {
        node["path"]: node["tick_worst"]
        for line in ("a4.10.btlog --mission a.btq", "f46.btlog --mission fetch.btq")
        for node in robot.json(*line.split())["missions"][0]["nodes"]
    }
    assert {ticks[path] for path in ("Late", "Two", "Three")} == {None}
    assert max(each for each in ticks.values() if each is not None) < 0.02


def test_two_loggers_count_once(robot: Verify) -> None:
    given = ("--mission", "fetch.btq", "--signals", "f46.csv")
    alone, both = (robot.json(*logs, *given)["requirements"] for logs in (["f46.btlog"], ["f46.btlog", "f46.db3"]))
    assert alone == both
    (clause,) = next(each for each in both if each["id"] == "q05")["clauses"]
    assert (clause["verdict"], clause["counted"] - clause["violated"], clause["counted"]) == ("undecided", 148, 186)


def test_a_log_alone_and_a_killed_robot(robot: Verify) -> None:
    for file in robot.folder.iterdir():
        if file.suffix in (".btq", ".xml"):
            file.unlink()
    assert robot.json("f46.btlog")["runs"] == 70
    assert robot.code == 0
    found = robot.json("k4.6.3.db3")
    assert (found["runs"], found["missions"][0]["outcomes"]) == (1, {"interrupted": 1})
