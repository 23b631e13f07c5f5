"""Runs that several logs of a store hold: each counts once in a label, whenever the logs were read."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest
from evidence_logs import MAIN, MAIN_XML, START, Row, btlog, rows, write_db3
from in_process import run_btq

from btq_lang.evidence.store import engine
from btq_lang.evidence.store.engine import asked_by
from btq_lang.evidence.store.summary import summary

MISSION = "QualityReq rq : safety\n    Move takes at most 100 ms\n" + MAIN
RUNS = rows(  # three runs: succeeded, failed, succeeded
    "1R 2R 80 2S 3R 140 3S 1S 2I 3I 1I 200 1R 2R 350 2F 1F 2I 1I 400 1R 2R 470 2S 3R 505 3S 1S 2I 3I 1I"
)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "main.btq").write_text(MISSION, encoding="utf-8")
    return tmp_path


def keep(folder: Path, name: str, transitions: Sequence[Row], *more: str, start: int = START) -> None:
    """Judge a log by itself and keep what is found; the label is `v1` unless another one is given."""
    if name.endswith(".db3"):
        write_db3(folder / name, MAIN_XML, [transitions], start=start)
    else:
        (folder / name).write_bytes(btlog(MAIN_XML, transitions, start))
    label = () if "--label" in more else ("--label", "v1")
    code, _, errors = run_btq("verify", name, "--mission", "main.btq", "--store", "kept", *label, *more, cwd=folder)
    assert (code in (0, 1), errors) == (True, "")


def counts(folder: Path) -> tuple[int, int, Sequence[str]]:
    """How many runs and activations of all labels count, and what is said of the others."""
    (mission,) = summary(engine.asked(str(folder / "kept")), "kept").missions
    ((clause,),) = (each.clauses for each in mission.requirements)
    return mission.runs, clause.counted, mission.sources[0].remarks


NOTED = ("{} of 1 log also in others of the same label, and not counted again",)


@pytest.mark.parametrize(
    ("other", "left_out"),
    [
        pytest.param(RUNS[:12], "2 runs", id="a prefix"),
        pytest.param([row for row in RUNS if row[1:] != (3, 1)], "3 runs", id="rows in the middle are missing"),
        pytest.param(RUNS[:19], "3 runs", id="rows at the end are missing"),
        pytest.param([(time // 1000 * 1000 + 1000, *rest) for time, *rest in RUNS], "3 runs", id="times in ms"),
    ],
)
@pytest.mark.parametrize("first", ["full.btlog", "other.db3"])
def test_a_run_of_two_logs_counts_once(folder: Path, first: str, other: list[Row], left_out: str, polars: str) -> None:
    logs = {"full.btlog": [(time + 7, uid, status) for time, uid, status in RUNS], "other.db3": other}
    for name in sorted(logs, key=lambda each: each != first):
        keep(folder, name, logs[name])
    assert counts(folder) == (3, 3, tuple(each.format(left_out) for each in NOTED))
    store = str(folder / "kept")
    assert summary(asked_by(polars, store), store) == summary(engine.asked(store), store)


@pytest.mark.parametrize(
    ("start", "transitions", "more"),
    [
        pytest.param(START + 600_000, RUNS, (), id="the runs after these"),
        pytest.param(START, [(time + time // 50, *rest) for time, *rest in RUNS], (), id="a clone"),
        pytest.param(START, RUNS[:-1], ("--label", "v2"), id="another label"),
        pytest.param(START, RUNS[:-1], ("--robot", "r2"), id="another robot"),
    ],
)
def test_other_runs_count(folder: Path, start: int, transitions: list[Row], more: tuple[str, ...]) -> None:
    keep(folder, "one.btlog", RUNS, "--robot", "r1")
    keep(folder, "two.btlog", transitions, *more, start=start)
    assert counts(folder) == (6, 6, ())


def test_logs_that_are_read_together_are_all_kept(folder: Path) -> None:
    """A set is what is found in its log, whatever is read beside it."""
    keep(folder, "a.btlog", RUNS)
    keep(folder, "b.db3", RUNS[:12])
    kept = {path.name: (path / "about.json").read_bytes() for path in (folder / "kept").iterdir()}
    given = ("a.btlog", "b.db3", "--mission", "main.btq", "--label", "v1")
    _, output, _ = run_btq("verify", *given, "--store", "kept", cwd=folder)
    assert "b.db3: 2 of its 2 runs are in a.btlog too" in output
    assert {path.name: (path / "about.json").read_bytes() for path in (folder / "kept").iterdir()} == kept
    _, output, _ = run_btq("verify", *given, "--store", "new", cwd=folder)
    assert {path.name for path in (folder / "new").iterdir()} == kept.keys()


def test_two_labels_are_compared_without_what_is_there_twice(folder: Path) -> None:
    keep(folder, "a.btlog", RUNS)
    keep(folder, "a.db3", RUNS[:19])
    keep(folder, "b.btlog", RUNS, "--label", "v2", start=START + 10**9)
    _, output, _ = run_btq("compare", "kept", "v1", "v2", cwd=folder)
    assert output.startswith("main: 3 runs of v1 (2026-11-20 21:22 UTC), 3 runs of v2 (")


def test_two_loggers_of_a_robot(tmp_path: Path, shared: Path) -> None:
    """What one wrote is read today, what the other one wrote tomorrow."""
    robot = shared / "field" / "verdicts" / "robot"
    means = ("--mission", str(robot / "fetch.btq"), "--signals", str(robot / "f46.csv"), "--label", "v1")
    found = []
    for log in ("f46.btlog", "f46.db3"):
        run_btq("verify", str(robot / log), *means, "--store", "kept", cwd=tmp_path)
        store = str(tmp_path / "kept")
        (mission,) = summary(engine.asked(store), store).missions
        found.append((mission.runs, mission.outcomes, mission.requirements))
    assert found[1] == found[0]
