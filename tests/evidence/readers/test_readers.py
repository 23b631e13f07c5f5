"""Readers of logs: complete, truncated, foreign and manipulated files."""

from __future__ import annotations

import json
import sqlite3
import tracemalloc
from pathlib import Path

import pytest
from evidence_logs import MAIN, MAIN_XML, START, Verify, btlog, rows, sessions_of, write_db3

from btq_lang.commands.verdict_report import write
from btq_lang.commands.verify_options import FORMATS
from btq_lang.evidence.identity import Candidate
from btq_lang.evidence.judging import Means
from btq_lang.evidence.runs import activations
from btq_lang.evidence.verifying import verify
from btq_lang.workspace.workspace import Workspace

TWO_RUNS = "0 1R 2R 5 2S 3S 1S 2I 3I 1I 20 1R 2R 30 2F 1F 2I 1I"
DEMANDS = "QualityReq rq : safety\n    Move needs battery > 1 %\n    Move takes at most 6 ms\n"
TEXT = f"signal battery : % from {{battery}}\n{DEMANDS}{MAIN}"
MISSION = Candidate(Workspace.of({"main.btq": TEXT}), "main.btq", "main", None)


FOREIGN = (
    "expected a BehaviorTree.CPP log (.btlog from FileLogger2, .db3 or .btdb from SqliteLogger) or a ROS 2 bag (.mcap,"
    " .db3, or a folder with metadata.yaml)"
)
COLUMNS = "expected a line of column names, separated by commas: the time first, then signals or their entries"
UNNUMBERED = "the nodes of its tree are not numbered 1, 2, 3 … as BehaviorTree.CPP numbers them"


def problems(path: Path) -> tuple[str, ...]:
    """What cannot be read of a log; the rest is judged, and written in every form."""
    report = verify([str(path)], Means([MISSION], shown=lambda each: Path(each).name))
    for form in FORMATS:
        write(report, [MISSION], form, verbose=True)
    return report.problems


@pytest.mark.parametrize(
    ("data", "problem"),
    [
        (b"", "the file is empty"),
        (
            b"t,battery\n1,2\n",
            FOREIGN,
        ),
        (b"BTCPP4-FileLogger2", "the file ends before its tree"),
        (b"BTCPP4-FileLogger2\x02\0\0\0\0", "version 2 of the format; btq reads version 1"),
        (
            b"BTCPP4-FileLogger2\x01\xff\xff\xff\x7f<root/>",
            "its tree and start should take 2147483647 and 8 bytes, and 7 are left",
        ),
        (
            b"BTCPP4-FileLogger2\x01\xff\xff\xff\xff<root/>",
            "its tree and start should take -1 and 8 bytes, and 7 are left",
        ),
        (btlog("<root/>", []), "its tree has no node with `_uid` 1"),
        (btlog("no XML", []), "its tree is not BehaviorTree.CPP XML"),
        (btlog(MAIN_XML.replace('_uid="3"', '_uid="7"'), []), UNNUMBERED),
        (b"SQLite format 3\0", "the database cannot be read: file is not a database"),
    ],
)
def test_what_is_not_a_log(data: bytes, problem: str, tmp_path: Path) -> None:
    (tmp_path / "a").write_bytes(data)
    assert problems(tmp_path / "a") == (f"a: {problem}",)


def test_a_database_of_something_else(tmp_path: Path) -> None:
    database = sqlite3.connect(tmp_path / "bag.db3")
    database.executescript("CREATE TABLE topics (id INTEGER); CREATE TABLE Definitions (id INTEGER)")
    database.close()
    assert problems(tmp_path / "bag.db3") == ("bag.db3: expected the tables of SqliteLogger; missing: Transitions",)


def test_one_bad_log_of_many(verify: Verify) -> None:
    (verify.folder / "main.btq").write_text(TEXT, encoding="utf-8")
    (verify.folder / "good.btlog").write_bytes(btlog(MAIN_XML, rows(TWO_RUNS)))
    (verify.folder / "bad.btlog").write_bytes(b"nothing")
    found = verify.json(".")
    assert verify.code == 2
    assert verify.errors == (f"btq verify: bad.btlog: {FOREIGN}\n")
    assert (found["runs"], found["requirements"][0]["clauses"][1]["violated"]) == (2, 1)


def test_what_is_whole_of_a_cut_log_is_read(verify: Verify) -> None:
    (verify.folder / "main.btq").write_text(TEXT, encoding="utf-8")
    whole = btlog(MAIN_XML, rows(TWO_RUNS))
    (verify.folder / "cut.btlog").write_bytes(whole[:-40])  # 4 rows and a half: the second run has not ended
    lines = verify.text("cut.btlog").splitlines()
    assert lines[:2] == [
        "2 runs in cut.btlog, 2026-11-20 21:22 UTC, mission main (as built now, 3 of 3 nodes)",
        "  note: cut off: the last 5 bytes are not a whole transition and are left out",
    ]
    assert lines[-2:-1] == ["runs: 1 succeeded, 1 interrupted"]
    assert lines[-1].startswith("nodes: exercised 3 of 3 · ")


def test_xml_that_expands_is_not_expanded(tmp_path: Path) -> None:
    bomb = '<!DOCTYPE x [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;">]>'
    xml = bomb + MAIN_XML.replace('name="Move"', 'name="&b;"')
    (tmp_path / "a.btlog").write_bytes(btlog(xml, rows(TWO_RUNS)))
    sessions = sessions_of(tmp_path / "a.btlog")
    assert next(sessions).tree.nodes[2].path == "&b;"


def test_a_tree_in_itself_ends(tmp_path: Path) -> None:
    xml = (
        '<root BTCPP_format="4">'
        '<BehaviorTree ID="A" _fullpath=""><SubTree ID="A" _fullpath="A" _uid="1"/></BehaviorTree>'
        '<BehaviorTree ID="A" _fullpath="A"><SubTree ID="A" _fullpath="A/A" _uid="2"/></BehaviorTree></root>'
    )
    (tmp_path / "a.btlog").write_bytes(btlog(xml, []))
    tree = next(sessions_of(tmp_path / "a.btlog")).tree
    assert [(uid, node.path) for uid, node in tree.nodes.items()] == [(1, "A"), (2, "A/A")]
    assert (tree.parent, tree.last) == ({1: 0, 2: 1}, {1: 2, 2: 2})


def test_a_database_is_read_while_the_robot_writes_it(tmp_path: Path) -> None:
    log = tmp_path / "live.db3"
    write_db3(log, MAIN_XML, [rows(TWO_RUNS)])
    robot = sqlite3.connect(log)
    robot.execute("PRAGMA journal_mode = WAL")
    robot.execute("BEGIN")
    robot.execute("INSERT INTO Transitions VALUES (?, 1, 1, 0, 1, '')", (START + 10**6,))
    sessions = sessions_of(log)
    assert [each.outcome for each in activations(next(sessions)) if each.uid == 1] == ["S", "F"]
    robot.commit()
    robot.close()


def test_entries_beside_the_rows_of_a_database_are_samples(verify: Verify) -> None:
    (verify.folder / "main.btq").write_text(TEXT, encoding="utf-8")
    extra = {
        0: json.dumps({"battery": 50, "x": None, "y": [1]}),
        5: "no JSON",
        6: "[3]",
        7: json.dumps({"battery": float("nan")}),
        8: json.dumps({"battery": 1}),
        9: json.dumps({"battery": 10**400}),
    }
    write_db3(verify.folder / "run.db3", MAIN_XML, [rows(TWO_RUNS)], extra)
    needs = verify.json("run.db3")["requirements"][0]["clauses"][0]
    assert (needs["counted"], needs["violated"]) == (2, 1)
    assert needs["violations"][0]["why"] == "`battery` was 1 % at the start"
    write_db3(verify.folder / "once.db3", MAIN_XML, [rows(TWO_RUNS)], {0: '{"battery": 50}'})
    needs = verify.json("once.db3")["requirements"][0]["clauses"][0]
    assert (needs["counted"], needs["violated"]) == (2, 0)  # a value of the first run holds in the second
    (verify.folder / "samples.csv").write_text(f"t,battery\n{START / 1e6 - 1},20\n", encoding="utf-8")
    needs = verify.json("run.db3", "--signals", "samples.csv")["requirements"][0]["clauses"][0]
    assert (needs["counted"], needs["violated"]) == (2, 0)  # what is given counts before what was logged


@pytest.mark.parametrize("form", ["btlog", "db3"])
def test_a_log_is_never_in_memory_as_a_whole(form: str, tmp_path: Path) -> None:
    peaks = []
    for runs in (1000, 8000):
        log = tmp_path / f"{runs}.{form}"
        transitions = [
            (time + 30_000 * run, uid, status)
            for run in range(runs)
            for time, uid, status in rows("0 1R 2R 5 2S 3S 1S")
        ]
        if form == "btlog":
            log.write_bytes(btlog(MAIN_XML, transitions))
        else:
            write_db3(log, MAIN_XML, [transitions])
        tracemalloc.start()
        for session in sessions_of(log):
            assert sum(each.uid == 1 for each in activations(session)) == runs
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    assert peaks[1] < 1.5 * peaks[0]


def test_rows_that_no_engine_writes_are_left_out_and_reported(verify: Verify) -> None:
    (verify.folder / "main.btq").write_text(TEXT, encoding="utf-8")
    write_db3(verify.folder / "run.db3", MAIN_XML, [[*rows(TWO_RUNS), (31_000, 1, 1), (32_000, 1, 9)]])
    database = sqlite3.connect(verify.folder / "run.db3")
    database.execute("UPDATE Transitions SET state = 'RUNNING' WHERE timestamp > ? AND state = 1", (START + 30_500,))
    database.commit()
    database.close()
    (source,) = verify.json("run.db3")["sources"]
    assert source["runs"] == 2
    assert source["remarks"] == [
        "rows whose time, uid or state is not a whole number, left out: 1",
        "rows with an unknown node or status, left out: 1, the first at 2026-11-20T21:22:20.032000Z",
    ]


# ---- samples ----


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("", COLUMNS),
        ("t\n1\n", COLUMNS),
        ("t;battery\n1;2\n", COLUMNS),
        ("1.5,20\n2.5,19\n", f"line 1: {COLUMNS}, found the number `1.5`; write one above it: `t,battery`"),
        ("t\0,\0b\0\n\0", "expected text in UTF-8, found UTF-16 or no text"),
        ("t,a,a\n", "two columns are named `a`"),
        ("t,battery\n1,2\nnoon,3\n", "line 3: `noon` is not a time in seconds since the epoch"),
        ("t,battery\nnan,2\n", "line 2: `nan` is not a time in seconds since the epoch"),
        ("t,battery\n1e300,2\n", "line 2: `1e+300` is not a time in seconds since the epoch"),
    ],
)
def test_what_is_not_a_table_of_samples(text: str, problem: str, verify: Verify) -> None:
    (verify.folder / "main.btq").write_text(TEXT, encoding="utf-8")
    (verify.folder / "run.btlog").write_bytes(btlog(MAIN_XML, rows(TWO_RUNS)))
    (verify.folder / "samples.csv").write_text(text, encoding="utf-8")
    verify.text("run.btlog", "--signals", "samples.csv")
    assert (verify.code, verify.errors) == (2, f"btq verify: samples.csv: {problem}\n")


def test_samples_need_no_order_and_may_be_missing(verify: Verify) -> None:
    (verify.folder / "main.btq").write_text(TEXT, encoding="utf-8")
    (verify.folder / "run.btlog").write_bytes(btlog(MAIN_XML, rows(TWO_RUNS)))
    lines = [
        "\ufefft , battery , other",
        f"{START / 1e6 + 0.01},1,",
        f"{START / 1e6 - 1},50,x",
        "",
        f"{START / 1e6 + 0.015},,7",
    ]
    (verify.folder / "samples.csv").write_text("\r\n".join(lines), encoding="utf-8")
    needs = verify.json("run.btlog", "--signals", "samples.csv")["requirements"][0]["clauses"][0]
    assert (needs["counted"], [each["run"] for each in needs["violations"]]) == (2, [2])
