"""`btq verify --store`: what is kept of each log, and that it is whole whatever happens to the writers."""

from __future__ import annotations

import os
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import duckdb
import pytest
from evidence_bags import tree_log, write_bag
from evidence_logs import MAIN, MAIN_XML, START, btlog, rows
from in_process import run_btq

from btq_lang.evidence.store import engine, sets
from btq_lang.evidence.store.sets import VERSION

ROOT = Path(__file__).parents[3]
TABLES = ["activations", "clauses", "runs", "verdicts"]
RUN = "1R 2R 20 2S 3R 25 3S 1S 26 2I 3I 1I"
MISSION = "QualityReq quick : safety\n    Move takes at most 15 ms\n" + MAIN


def of(store: Path, table: str, columns: str) -> list[tuple[Any, ...]]:
    """Columns of a table, in the order of the rows."""
    question = f"SELECT {columns} FROM read_parquet('{store}/[0-9a-f]*/{table}.parquet')"
    return duckdb.connect().execute(question).fetchall()


def files(store: Path) -> dict[str, tuple[int, bytes]]:
    """All files of a store, with the time of their last change, and their contents."""
    return {
        str(path.relative_to(store)): (path.stat().st_mtime_ns, path.read_bytes())
        for path in sorted(store.rglob("*"))
        if path.is_file()
    }


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    """A folder with a mission and two logs, of two runs and of one."""
    (tmp_path / "main.btq").write_text(MISSION, encoding="utf-8")
    (tmp_path / "v1").mkdir()
    (tmp_path / "v2").mkdir()
    (tmp_path / "v1" / "a.btlog").write_bytes(btlog(MAIN_XML, rows(f"{RUN} 40 1R 2R 50 2S 3R 55 3F 1F")))
    (tmp_path / "v2" / "b.btlog").write_bytes(btlog(MAIN_XML, rows(RUN), START + 60_000_000))
    return tmp_path


def keep(folder: Path, *arguments: str) -> tuple[int, str, str]:
    return run_btq("verify", *arguments, "--mission", "main.btq", "--store", "kept", cwd=folder)


def test_what_is_kept_of_a_log(robot: Path) -> None:
    code, output, errors = keep(robot, "v1/a.btlog", "--label", "v1.3", "--robot", "r7")
    assert (code, errors) == (1, "")
    assert "1 of 2 activations, worst 20 ms in run 1" in output
    store = robot / "kept"
    log = next(store.iterdir()).name
    assert sorted(files(store)) == [f"{log}/about.json", *(f"{log}/{table}.parquet" for table in TABLES)]
    whose = (log, "v1.3", "main", "r7")
    assert of(store, "runs", "DISTINCT source") == [("v1/a.btlog",)]
    assert of(store, "runs", "* EXCLUDE (tree, source)") == [
        (*whose, 1, START, START + 25_000, "succeeded", 3, 0, 0, None, 3, 3),
        (*whose, 2, START + 40_000, START + 55_000, "failed", 3, 0, 0, "Pick", 3, 3),
    ]
    times = [(START + begin, START + end) for begin, end in ((40_000, 50_000), (50_000, 55_000), (40_000, 55_000))]
    assert of(store, "activations", "*")[3:] == [
        (*whose, 2, 2, "Move::2", "Move", "Move", True, *times[0], "succeeded", "exact", times[0][0]),
        (*whose, 2, 3, "Pick::3", "Pick", "Pick", True, *times[1], "failed", "exact", times[1][0]),
        (*whose, 2, 1, "Sequence::1", "Sequence", "Sequence", False, *times[2], "failed", "exact", times[2][0]),
    ]
    clause = ("quick", "Move takes at most 15 ms", "Move")
    assert of(store, "verdicts", "*") == [
        (
            *whose,
            *clause,
            1,
            "Move::2",
            START,
            START + 20_000,
            "violated",
            True,
            START + 20_000,
            0.02,
            0.015,
            "took {}",
            *[None] * 5,
        ),
        (*whose, *clause, 2, "Move::2", *times[0], "satisfied", True, None, 0.01, 0.015, *[None] * 6),
    ]
    none = (None,) * 7
    assert of(store, "clauses", "* EXCLUDE (title, measures, fingerprint)") == [
        (*whose, 0, *clause, "activations", "ms", *none, True, 0, *[None] * 11),
    ]


def test_what_is_kept_of_a_duration_that_lies_between_limits(robot: Path) -> None:
    (robot / "main.btq").write_text(MISSION.replace("Move", "Pick", 1), encoding="utf-8")
    (robot / "a.btlog").write_bytes(btlog(MAIN_XML, rows("1R 2R 5 2S 10 3R 12 3S 1S")))
    assert keep(robot, "a.btlog")[0] == 0
    store = robot / "kept"
    times = of(store, "activations", "node, earliest_us, start_us, end_us")
    assert times[1] == ("Pick", START + 5_000, START + 10_000, START + 12_000)
    assert of(store, "verdicts", "verdict, measured_si, most_si") == [("satisfied", 0.002, 0.007)]
    assert "held so far in 1 activation; 1 bounded by 7 ms\n" in run_btq("verify", "--store", "kept", cwd=robot)[1]


def test_a_run_that_counts_as_one_has_one_judgement_that_counts(robot: Path) -> None:
    odds = MISSION.replace("15 ms", "15 ms\n    in at least 50 % of runs")
    (robot / "main.btq").write_text(odds, encoding="utf-8")
    twice = "1R 2R 10 2S 2R 30 2S 2R 50 2S 3R 55 3S 1S 56 2I 3I 1I"
    (robot / "a.btlog").write_bytes(btlog(MAIN_XML, rows(f"{twice} 60 1R 2R 70 2S 2R 80 2S 3R 81 3S 1S")))
    assert keep(robot, "a.btlog")[0] == 0
    assert of(robot / "kept", "verdicts", "run, verdict, counted") == [
        (1, "satisfied", False),
        (1, "violated", True),
        (1, "violated", False),
        (2, "satisfied", True),
        (2, "satisfied", False),
    ]


def test_reading_a_log_again_changes_nothing(robot: Path) -> None:
    keep(robot, "v1", "v2", "--label", "x", "--robot", "r7")
    before = files(robot / "kept")
    assert len(before) == 10
    shutil.copy(robot / "v1" / "a.btlog", robot / "copy.btlog")
    keep(robot, "copy.btlog", "v2")  # also under another name, and without the label and the robot, which it keeps
    assert files(robot / "kept") == before


def test_what_is_found_anew_takes_the_place_of_the_old(robot: Path) -> None:
    keep(robot, "v1", "v2", "--label", "x")
    (robot / "main.btq").write_text(MISSION.replace("15 ms", "25 ms"), encoding="utf-8")
    assert keep(robot, "v1")[0] == 0
    found = of(robot / "kept", "verdicts", "label, clause, verdict")
    assert sorted(found) == [
        ("x", "Move takes at most 15 ms", "violated"),  # of b.btlog, which was not read again
        ("x", "Move takes at most 25 ms", "satisfied"),
        ("x", "Move takes at most 25 ms", "satisfied"),
    ]
    keep(robot, "v1", "--label", "y")
    assert sorted(each for (each,) in of(robot / "kept", "runs", "label")) == ["x", "y", "y"]
    assert not [name for name in os.listdir(robot / "kept") if name.startswith(".")]


def test_a_log_that_is_judged_anew_keeps_its_label_and_robot(robot: Path) -> None:
    keep(robot, "v1", "--label", "x", "--robot", "r7")
    (robot / "main.btq").write_text(MISSION.replace("15 ms", "25 ms"), encoding="utf-8")
    assert keep(robot, "v1")[0] == 0
    whose = [("x", "r7", "Move takes at most 25 ms")] * 2
    assert of(robot / "kept", "verdicts", "label, robot, clause") == whose


@pytest.mark.parametrize("jobs", ["1", "2"])
def test_a_note_says_which_labels_and_robots_are_replaced(jobs: str, robot: Path) -> None:
    assert "had the" not in keep(robot, "v1", "--label", "x", "--robot", "r7")[1]
    assert "had the" not in keep(robot, "v2", "--label", "x")[1]
    again = ("v1", "v2", "--label", "y", "--robot", "r8", "--jobs", jobs)
    code, output, errors = keep(robot, *again)
    assert (code, errors) == (1, "")
    notes = [line for line in output.splitlines() if "note:" in line]
    assert notes == ["  note: 2 logs had the label x", "  note: 1 log had the robot r7"]
    assert "had the" not in keep(robot, *again)[1]
    assert keep(robot, "v1", "--label", "z", "-o", "x.json") == (1, "", "btq verify: 1 log had the label y\n")


def test_a_job_keeps_verdicts_and_compares(robot: Path) -> None:
    """The lines of docs/ci.md, in the shell of a build server, which ends at the first error."""
    assert keep(robot, "v2", "--label", "main", "--exit-zero")[0] == 0
    script = """
        btq verify "$LOGS" --mission main.btq --store kept --label "$GITHUB_SHA" --exit-zero -o verdicts.md
        btq compare kept main "$GITHUB_SHA" -o comparison.md
    """

    def job(logs: str, sha: str) -> int:
        path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
        environment = {**os.environ, "PATH": path, "LOGS": logs, "GITHUB_SHA": sha}
        return subprocess.run(["bash", "-ec", script], cwd=robot, env=environment, capture_output=True).returncode

    assert job("v1", "") == 2
    assert job("gone.btlog", "abc") == 2
    assert not (robot / "comparison.md").exists()
    assert job("v1", "abc") == 0
    assert (robot / "comparison.md").read_text(encoding="utf-8").startswith("### main: 1 run of main (")
    assert "violated" in (robot / "verdicts.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", ["", " "])
@pytest.mark.parametrize("option", ["--label", "--robot"])
def test_an_empty_name_changes_nothing(option: str, name: str, robot: Path) -> None:
    keep(robot, "v1", "--label", "x", "--robot", "r7")
    before = files(robot / "kept")
    message = f"btq verify: {option} is empty; give a name, or leave it out to keep what the store has\n"
    assert keep(robot, "v1", option, name) == (2, "", message)
    assert files(robot / "kept") == before


def test_a_folder_names_labels_and_robots(robot: Path) -> None:
    assert keep(robot, "v1", "v2", "--label-by", "folder", "--robot-by", "folder", "--jobs", "2")[0] == 1
    assert sorted(of(robot / "kept", "runs", "label, robot, run")) == [
        ("v1", "v1", 1),
        ("v1", "v1", 2),
        ("v2", "v2", 1),
    ]


def test_the_folder_above_names_labels_where_the_folder_names_robots(robot: Path) -> None:
    for label, name, log in (("v1", "r1", "v1/a.btlog"), ("v2", "r2", "v2/b.btlog")):
        (robot / "logs" / label / name).mkdir(parents=True)
        (robot / log).rename(robot / "logs" / label / name / "01.btlog")
    assert keep(robot, "logs", "--label-by", "folder-above", "--robot-by", "folder")[0] == 1
    assert sorted(of(robot / "kept", "runs", "label, robot, run")) == [
        ("v1", "r1", 1),
        ("v1", "r1", 2),
        ("v2", "r2", 1),
    ]


def test_the_topics_of_a_bag_name_its_robots(robot: Path) -> None:
    names = {1: "Sequence", 2: "Move", 3: "Pick"}
    red = tree_log(rows(RUN), names, topic="/red/behavior_tree_log")
    blue = tree_log(rows(RUN), names, topic="/hall/blue/behavior_tree_log")
    write_bag(robot / "bag", [*red, *blue])
    assert keep(robot, "bag", "v1", "--robot", "mine")[0] == 1
    assert sorted(of(robot / "kept", "runs", "robot, run")) == [("hall/blue", 2), ("mine", 1), ("mine", 2), ("red", 1)]


def test_a_log_that_cannot_be_read_or_has_no_run_of_the_mission_is_not_kept(robot: Path) -> None:
    (robot / "bad.btlog").write_bytes(b"no log")
    (robot / "other.btlog").write_bytes(btlog(MAIN_XML.replace("Move", "Fly").replace("Pick", "Land"), rows(RUN)))
    assert keep(robot, "bad.btlog", "other.btlog", "v2")[0] == 2
    assert len(os.listdir(robot / "kept")) == 1


def test_without_duckdb_the_extra_is_named(robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "duckdb", None)
    message = "btq verify: a store is written and read with duckdb; install it with pip install 'btq-lang[evidence]'\n"
    assert keep(robot, "v1") == (2, "", message)
    assert not (robot / "kept").exists()


@pytest.mark.parametrize("option", ["--label", "--robot"])
def test_a_label_is_for_a_store(option: str, robot: Path) -> None:
    message = f"btq verify: {option} goes with --store DIR\n"
    assert run_btq("verify", "v1", "--mission", "main.btq", option, "x", cwd=robot) == (2, "", message)


def test_a_store_that_cannot_be_written(robot: Path) -> None:
    (robot / "kept").write_text("a file", encoding="utf-8")
    assert keep(robot, "v1", "v2") == (2, "", "btq verify: kept: expected a folder, found a file\n")


def test_a_folder_that_cannot_be_written(robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (robot / "kept").mkdir(0o500)
    if os.access(robot / "kept", os.W_OK):  # root may write everywhere but on a disk that is read only
        monkeypatch.setattr(os, "access", lambda path, mode: False)
    assert keep(robot, "v1", "v2") == (2, "", "btq verify: kept: cannot be written: Permission denied\n")


def test_a_store_that_only_an_engine_knows(robot: Path) -> None:
    message = "s3://fleet/kept: expected a folder; keep verdicts in one and upload it, or give --no-store"
    asked = ("verify", "v1", "--mission", "main.btq", "--store", "s3://fleet/kept")
    assert run_btq(*asked, cwd=robot) == (2, "", f"btq verify: {message}\n")
    assert not (robot / "s3:").exists()


@pytest.mark.parametrize("command", [("verify", "--store", "kept"), ("compare", "kept", "a", "b"), ("report", "kept")])
def test_a_store_that_is_a_file_or_empty(command: tuple[str, ...], robot: Path) -> None:
    said = f"btq {command[0]}: kept: "
    (robot / "kept").write_text("a file", encoding="utf-8")
    assert run_btq(*command, cwd=robot) == (2, "", f"{said}expected a folder, found a file\n")
    (robot / "kept").unlink()
    (robot / "kept").mkdir()
    untold = "no verdicts are kept there; keep some with btq verify LOG --store kept\n"
    assert run_btq(*command, cwd=robot) == (2, "", said + untold)


@pytest.mark.parametrize("size", [0, 300, 1000])  # bytes; of the largest, only DuckDB writes more
def test_a_disk_that_is_full(size: int, robot: Path) -> None:
    resource = pytest.importorskip("resource", reason="Windows has no limits on what a process writes")
    keep(robot, "v1")
    before = files(robot / "kept")
    (robot / "main.btq").write_text(MISSION.replace("15 ms", "14 ms"), encoding="utf-8")
    logs = ("v1/a.btlog", "v2/b.btlog")
    found = subprocess.run(
        [sys.executable, "-m", "btq_lang", "verify", *logs, "--mission", "main.btq", "--store", "kept"],
        cwd=robot,
        # half-written bytecode would break the next start
        env={**os.environ, "PYTHONPATH": str(ROOT), "PYTHONDONTWRITEBYTECODE": "1"},
        capture_output=True,
        text=True,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size)),
    )
    expected = [f"btq verify: {log}: cannot be kept: File too large: kept" for log in logs]
    assert (found.returncode, found.stderr.splitlines()) == (2, expected)
    assert "2 of 3 activations, worst 20 ms in run 1" in found.stdout
    assert files(robot / "kept") == before
    assert len(os.listdir(robot / "kept")) == 1


def test_a_set_of_a_newer_version_is_read_and_not_replaced(robot: Path) -> None:
    keep(robot, "v1", "v2", "--label", "x")
    expected = run_btq("verify", "--store", "kept", cwd=robot)
    (log,) = {log for log, source in of(robot / "kept", "runs", "log, source") if source == "v1/a.btlog"}
    folder = robot / "kept" / log
    for table in TABLES:
        new = f"SELECT *, 1 AS added FROM '{folder}/{table}.parquet'"
        duckdb.connect().execute(f"COPY ({new}) TO '{folder}/new.parquet'")
        (folder / "new.parquet").rename(folder / f"{table}.parquet")
    about = (folder / "about.json").read_text(encoding="utf-8")
    (folder / "about.json").write_text(about.replace(f'"version": {VERSION}', '"version": 9'), encoding="utf-8")
    assert run_btq("verify", "--store", "kept", cwd=robot) == expected
    before = files(robot / "kept")
    code, _, errors = keep(robot, "v1", "v2")
    assert (code, errors) == (
        2,
        f"btq verify: v1/a.btlog: cannot be kept: a newer version of btq has written kept/{log}\n",
    )
    assert files(robot / "kept") == before


def test_a_log_that_is_not_there(robot: Path) -> None:
    message = "btq verify: gone.btlog: cannot be read: No such file or directory\n"
    assert keep(robot, "gone.btlog") == (2, "", message)


def test_an_output_that_is_named_as_a_folder(robot: Path) -> None:
    code, output, errors = keep(robot, "v1", "-o", "verdicts/")
    assert (code, output) == (2, "")
    assert errors == "btq verify: verdicts: cannot be written: Is a directory\n"
    assert not (robot / "verdicts").exists()


def test_a_store_without_labels_has_none_to_compare(robot: Path) -> None:
    keep(robot, "v1")
    message = "btq compare: no run has the label v1; there are no labels\n"
    assert run_btq("compare", "kept", "v1", "v2", cwd=robot) == (2, "", message)


def test_a_set_that_cannot_be_written(robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(engine, "_OPTIONS", "FORMAT parquet, COMPRESSION nothing")
    code, output, errors = keep(robot, "v1")
    assert code == 2
    assert "1 of 2 activations, worst 20 ms in run 1" in output
    assert errors.startswith("btq verify: v1/a.btlog: cannot be kept: Binder Error: ")
    assert os.listdir(robot / "kept") == []


def test_what_killed_writers_leave(robot: Path) -> None:
    keep(robot, "v1", "v2")
    store = robot / "kept"
    before = files(store)
    first, second = sorted(os.listdir(store))
    token = "0" * 32
    (store / first).rename(store / f".old-{first}-{token}")  # killed between the two renames of a replacement
    shutil.copytree(store / second, store / f".old-{second}-{token}")  # killed after them
    for age in (0, 90_000):
        draft = store / f".draft-{age}"
        draft.mkdir()
        (draft / "runs.csv").write_text("1", encoding="utf-8")
        for path in (draft / "runs.csv", draft):
            os.utime(path, (time.time() - age,) * 2)
    sets.prepare(str(store))
    assert sorted(os.listdir(store)) == [".draft-0", first, second]
    assert {name: data for name, data in files(store).items() if "draft" not in name} == before


def logs_of(folder: Path, number: int) -> list[str]:
    """Some logs that all differ."""
    (folder / "main.btq").write_text(MISSION, encoding="utf-8")
    names = [f"{each}.btlog" for each in range(number)]
    for each, name in enumerate(names):
        (folder / name).write_bytes(btlog(MAIN_XML, rows(" ".join([RUN] * 20)), START + each * 60_000_000))
    return names


def writer(folder: Path, logs: list[str]) -> subprocess.Popen[bytes]:
    command = [sys.executable, "-m", "btq_lang", "verify", *logs, "--mission", "main.btq", "--store", "kept"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    null = subprocess.DEVNULL
    return subprocess.Popen(command, cwd=folder, env=environment, stdout=null, stderr=null, start_new_session=True)


@pytest.mark.scheduled
def test_writers_killed_at_any_moment(tmp_path: Path) -> None:
    logs = logs_of(tmp_path, 16)
    chance = random.Random(7)
    started = time.monotonic()
    assert writer(tmp_path, logs).wait() == 1
    whole = time.monotonic() - started
    expected = {name: data for name, (_, data) in files(tmp_path / "kept").items()}
    assert len(expected) == 80
    shutil.rmtree(tmp_path / "kept")
    kept = []
    for turn in range(8):
        bound = "15 ms" if turn % 2 else "14 ms"  # so that sets are replaced, too
        (tmp_path / "main.btq").write_text(MISSION.replace("15 ms", bound), encoding="utf-8")
        process = writer(tmp_path, logs)
        time.sleep(chance.uniform(0.2, 1.0) * whole)  # killed at any moment of its work, not when it is ready for it
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        for folder in (tmp_path / "kept").glob("[0-9a-f]*"):
            assert sorted(each.name for each in folder.iterdir()) == [
                "about.json",
                *(f"{table}.parquet" for table in TABLES),
            ]
            assert duckdb.connect().execute(f"SELECT count(*) FROM '{folder}/verdicts.parquet'").fetchall() == [(20,)]
        kept.append(len([*(tmp_path / "kept").glob("[0-9a-f]*")]) if (tmp_path / "kept").exists() else 0)
    assert any(0 < each < 16 for each in kept), kept
    (tmp_path / "main.btq").write_text(MISSION, encoding="utf-8")
    assert writer(tmp_path, logs).wait() == 1
    found = {name: data for name, (_, data) in files(tmp_path / "kept").items() if not name.startswith(".draft")}
    assert found == expected


def test_two_writers_at_once(tmp_path: Path) -> None:
    logs = logs_of(tmp_path, 12)
    assert writer(tmp_path, logs).wait() == 1
    expected = {name: data for name, (_, data) in files(tmp_path / "kept").items()}
    (tmp_path / "main.btq").write_text(MISSION.replace("15 ms", "14 ms"), encoding="utf-8")
    first, second = writer(tmp_path, logs), writer(tmp_path, logs)  # both replace the same sets
    assert (first.wait(), second.wait()) == (1, 1)
    (tmp_path / "main.btq").write_text(MISSION, encoding="utf-8")
    first, second = writer(tmp_path, logs), writer(tmp_path, logs[::-1])
    assert (first.wait(), second.wait()) == (1, 1)
    assert {name: data for name, (_, data) in files(tmp_path / "kept").items()} == expected


def test_a_set_that_another_writer_replaces_meanwhile(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whenever this writer has put the old set aside, another one has put its own there, three times."""
    logs = logs_of(tmp_path, 1)
    assert writer(tmp_path, logs).wait() == 1
    (tmp_path / "main.btq").write_text(MISSION.replace("15 ms", "14 ms"), encoding="utf-8")
    rename = os.rename
    left = iter(range(3))

    def rename_and_be_late(source: str, target: str) -> None:
        rename(source, target)
        if ".old-" in target and next(left, None) is not None:
            shutil.copytree(target, source)

    monkeypatch.setattr(os, "rename", rename_and_be_late)
    assert run_btq("verify", *logs, "--mission", "main.btq", "--store", "kept", cwd=tmp_path)[0] == 1
    assert next(left, None) is None
    (kept,) = (tmp_path / "kept").iterdir()
    bounds = duckdb.connect().execute(f"SELECT max(bound_si) FROM '{kept}/verdicts.parquet'").fetchall()
    assert bounds == [(0.014,)]
