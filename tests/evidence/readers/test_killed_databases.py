"""Databases whose writer was killed, or goes on: what was committed is read, and nothing beside it is touched."""

from __future__ import annotations

import os
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from evidence_bags import names_of, tree_log, write_bag
from evidence_logs import MAIN, MAIN_XML, START, Verify, rows, sessions_of, write_db3

from btq_lang.evidence.readers import sqlite
from btq_lang.evidence.runs import activations

TWO_RUNS = "0 1R 2R 5 2S 3S 1S 2I 3I 1I 20 1R 2R 30 2F 1F 2I 1I"
AN_OPEN_RUN = "0 1R 2R 5 2S 3S 1S 2I 3I 1I 20 1R 2R"
ROLLED_BACK = "its writer was killed in the middle of a transaction, which is left out"
LOSE_ALL = "UPDATE Transitions SET state = 3, extra_data = printf('%3000d', 1)"
WRITER = """\
import os, signal, sqlite3, sys
path, mode, end, change = sys.argv[1:]
log = sqlite3.connect(path, isolation_level=None)
log.execute(f"PRAGMA journal_mode = {mode}")
log.execute("PRAGMA wal_autocheckpoint = 0")
log.execute("CREATE TABLE another (x)")
if end == "in a transaction":
    log.execute("PRAGMA cache_size = 2")
    log.execute("PRAGMA cache_spill = 1")
    log.execute("BEGIN")
    log.execute(change)
os.kill(os.getpid(), signal.SIGKILL)
"""

AS_NOBODY = """\
import os, sys
from btq_lang.evidence.readers import read
from btq_lang.evidence.runs import activations

def outcomes(log):
    return [each.outcome for session in read(log) for each in activations(session) if each.uid == 1]

outcomes(sys.argv[1])  # so that all modules are imported, which nobody else may read
if os.geteuid() == 0:
    os.seteuid(65534)
print(outcomes(sys.argv[2]))
"""


@pytest.fixture
def temporary(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """The folder for temporary files, which is empty again at the end."""
    folder = tmp_path / "temporary"
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    yield folder
    assert [*folder.iterdir()] == []


def killed(log: Path, mode: str, end: str = "in a transaction", runs: str = TWO_RUNS) -> None:
    """A database whose writer is killed, in a transaction of which a part is in the file, or after it."""
    write_db3(log, MAIN_XML, [rows(runs)])
    kill_writer(log, mode, end, LOSE_ALL)


def kill_writer(log: Path, mode: str, end: str, change: str) -> None:
    """Kill a process in a change of a database, of which a part is in the file, or after another transaction."""
    done = subprocess.run([sys.executable, "-c", WRITER, str(log), mode, end, change], check=False)
    assert done.returncode == -signal.SIGKILL


def outcomes(log: Path) -> list[str]:
    """How the runs in a log ended."""
    return [each.outcome for session in sessions_of(log) for each in activations(session) if each.uid == 1]


def contents(folder: Path) -> dict[str, tuple[bytes, int]]:
    """The files of a folder, and when they were written."""
    return {each.name: (each.read_bytes(), each.stat().st_mtime_ns) for each in folder.iterdir() if each.is_file()}


@pytest.mark.parametrize("end", ["in a transaction", "after it"])
@pytest.mark.parametrize("mode", ["delete", "truncate", "persist", "wal"])
def test_what_was_committed_is_read(mode: str, end: str, temporary: Path) -> None:
    log = temporary.parent / "run.db3"
    killed(log, mode, end)
    (temporary.parent / "run.db3-shm").unlink(missing_ok=True)  # who copies a log leaves it behind
    before = contents(temporary.parent)
    found = [([row[2] for row in session.transitions], session.remarks) for session in sessions_of(log)]
    is_rolled_back = mode != "wal" and end == "in a transaction"
    assert found == [([status for *_, status in rows(TWO_RUNS)], [ROLLED_BACK] * is_rolled_back)]
    assert contents(temporary.parent) == before


def test_a_link_to_a_database(temporary: Path) -> None:
    (temporary.parent / "logs").mkdir()
    killed(temporary.parent / "logs" / "run.db3", "delete")
    (temporary.parent / "run.db3").symlink_to(temporary.parent / "logs" / "run.db3")
    assert outcomes(temporary.parent / "run.db3") == ["S", "F"]


@pytest.mark.parametrize("mode", ["delete", "wal"])
def test_the_run_that_was_open_is_interrupted(mode: str, temporary: Path) -> None:
    killed(temporary.parent / "run.db3", mode, runs=AN_OPEN_RUN)
    assert outcomes(temporary.parent / "run.db3") == ["S", "O"]


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="no users")
@pytest.mark.parametrize("mode", ["delete", "wal", "wal without index", "wal without log"])
def test_a_folder_that_cannot_be_written(mode: str) -> None:
    with tempfile.TemporaryDirectory() as name:  # another user could not enter the folder of the test
        folder, temporary = Path(name) / "logs", Path(name) / "temporary"
        folder.mkdir()
        temporary.mkdir()
        write_db3(Path(name) / "whole.db3", MAIN_XML, [rows(TWO_RUNS)])
        killed(folder / "run.db3", mode.split()[0])
        if mode == "wal without log":
            database = sqlite3.connect(folder / "run.db3")
            database.execute("PRAGMA wal_checkpoint(TRUNCATE)")
            database.close()
        elif mode == "wal without index":
            (folder / "run.db3-shm").unlink()
        before = contents(folder)
        for path in (*folder.iterdir(), folder):
            path.chmod(0o555)
        Path(name).chmod(0o755)
        temporary.chmod(0o777)
        arguments = [str(Path(name) / "whole.db3"), str(folder / "run.db3")]
        environment = {**os.environ, "TMPDIR": str(temporary)}
        done = subprocess.run(
            [sys.executable, "-c", AS_NOBODY, *arguments], env=environment, capture_output=True, text=True
        )
        assert (done.stdout, done.stderr) == ("['S', 'F']\n", "")
        assert contents(folder) == before
        assert [*temporary.iterdir()] == []
        folder.chmod(0o755)


@pytest.mark.parametrize("mode", ["delete", "wal"])
def test_a_database_that_is_being_written_is_not_copied(
    mode: str, temporary: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    log = temporary.parent / "run.db3"
    write_db3(log, MAIN_XML, [rows(TWO_RUNS)])
    robot = sqlite3.connect(log, isolation_level=None)
    robot.execute(f"PRAGMA journal_mode = {mode}")
    robot.execute("BEGIN")
    robot.execute("INSERT INTO Transitions VALUES (?, 1, 1, 0, 1, '')", (START + 10**6,))
    assert sorted(each.name for each in temporary.parent.glob("run.db3?*"))  # its journal, or log, is there
    monkeypatch.setattr(sqlite, "copyfile", lambda *paths: pytest.fail("copied"))
    assert outcomes(log) == ["S", "F"]
    robot.execute("COMMIT")
    assert outcomes(log) == ["S", "F", "O"]
    robot.close()


@pytest.fixture
def judge(verify: Verify) -> Verify:
    """The same with a mission."""
    (verify.folder / "main.btq").write_text(MAIN, encoding="utf-8")
    return verify


def test_a_database_that_its_writer_locks_is_not_copied(
    judge: Verify, temporary: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_db3(judge.folder / "run.db3", MAIN_XML, [rows(TWO_RUNS)])
    robot = sqlite3.connect(judge.folder / "run.db3", isolation_level=None)
    robot.execute("BEGIN EXCLUSIVE")
    robot.execute("INSERT INTO Transitions VALUES (?, 1, 1, 0, 1, '')", (START + 10**6,))
    connect: Callable[..., sqlite3.Connection] = sqlite3.connect
    monkeypatch.setattr(sqlite3, "connect", lambda *given, **named: connect(*given, **named, timeout=0.01))
    judge.text("run.db3")
    told = "btq verify: run.db3: the database cannot be read: database is locked\n"
    assert (judge.code, judge.errors) == (2, told)
    robot.close()


def test_a_database_that_is_written_while_it_is_copied(
    judge: Verify, temporary: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    killed(judge.folder / "run.db3", "delete")
    copy = shutil.copyfile

    def restarted(source: str, target: str) -> None:
        copy(source, target)
        sqlite3.connect(judge.folder / "run.db3").execute("SELECT count(*) FROM Transitions").fetchall()

    monkeypatch.setattr(sqlite, "copyfile", restarted)
    judge.text("run.db3")
    told = "btq verify: run.db3: it was written while it was copied; read it again\n"
    assert (judge.code, judge.errors) == (2, told)


def test_no_room_for_a_copy(judge: Verify, temporary: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    killed(judge.folder / "run.db3", "delete")

    def full(source: str, target: str) -> None:
        raise OSError(28, "No space left on device", target)

    monkeypatch.setattr(sqlite, "copyfile", full)
    judge.text("run.db3")
    why = "it needs a temporary copy, which cannot be made: No space left on device; TMPDIR says where"
    assert (judge.code, judge.errors) == (2, f"btq verify: run.db3: {why}\n")


def test_a_journal_beside_a_damaged_database(judge: Verify, temporary: Path) -> None:
    log = judge.folder / "run.db3"
    killed(log, "delete")
    data = log.read_bytes()
    log.write_bytes(data[:100] + b"\xff" * 2000 + data[2100:])
    journal = Path(f"{log}-journal")
    journal.write_bytes(b"\xff" * journal.stat().st_size)  # SQLite takes it for one that has nothing to restore
    judge.text("run.db3")
    assert judge.code == 2
    assert judge.errors.startswith("btq verify: run.db3: the database cannot be read: ")


def test_databases_that_differ_in_their_logs_alone_are_no_copies(judge: Verify) -> None:
    killed(judge.folder / "a.db3", "wal", "after it", runs=AN_OPEN_RUN)
    shutil.copy(judge.folder / "a.db3", judge.folder / "b.db3")
    shutil.copy(judge.folder / "a.db3", judge.folder / "c.db3")
    shutil.copy(judge.folder / "a.db3-wal", judge.folder / "c.db3-wal")
    found = judge.json("a.db3", "b.db3", "c.db3")
    assert found["remarks"] == [
        "c.db3 is the same log as a.db3, so it is not counted",
        "b.db3: 2 of its 2 runs are in a.db3 too, and not counted again",
    ]


@pytest.mark.parametrize("path", ["bag", "bag/bag.db3"])
@pytest.mark.parametrize("mode", ["delete", "wal"])
def test_a_recording_whose_recorder_was_killed(mode: str, path: str, judge: Verify, temporary: Path) -> None:
    write_bag(judge.folder / "bag", tree_log(rows(TWO_RUNS), names_of(MAIN_XML)), "sqlite3")
    kill_writer(judge.folder / "bag" / "bag.db3", mode, "in a transaction", "UPDATE messages SET data = zeroblob(3000)")
    before = contents(judge.folder / "bag")
    found = judge.json(path)
    assert (judge.errors, found["missions"][0]["outcomes"]) == ("", {"succeeded": 1, "failed": 1})
    assert found["sources"][0]["remarks"] == ([ROLLED_BACK] if mode == "delete" else [])
    if mode == "delete":  # SQLite writes the index of a log
        assert contents(judge.folder / "bag") == before


def test_the_killed_robot(shared: Path) -> None:
    assert outcomes(shared / "field/verdicts/robot/k4.6.3.db3") == ["O"]
