"""Runs that several logs hold: each counts once."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest
from evidence_logs import MAIN, MAIN_XML, START, Row, Verify, btlog, rows, write_db3

from btq_lang.evidence import judging, readers
from btq_lang.evidence.json_document import read_verdicts
from btq_lang.ide.runs import logged_run
from btq_lang.ide.verdicts import ProjectVerdicts
from btq_lang.workspace.workspace import Workspace

DEMAND = (
    "QualityReq rq : safety\n    Move takes at most 100 ms\n"
    "QualityReq of_runs : reliability\n    mission succeeds in at least 50 % of runs\n"
)
RUNS = rows(  # three runs: succeeded, failed, succeeded
    "1R 2R 80 2S 3R 140 3S 1S 2I 3I 1I 200 1R 2R 350 2F 1F 2I 1I 400 1R 2R 470 2S 3R 505 3S 1S 2I 3I 1I"
)
FIRST, SECOND = 9, 15  # the rows of one run, and of two


@pytest.fixture
def mission(verify: Verify) -> Verify:
    """The command, with a mission in its folder."""
    (verify.folder / "main.btq").write_text(DEMAND + MAIN, encoding="utf-8")
    return verify


def write(mission: Verify, name: str, transitions: Sequence[Row], start: int = START) -> None:
    if name.endswith(".db3"):
        write_db3(mission.folder / name, MAIN_XML, [transitions], start=start)
    else:
        (mission.folder / name).write_bytes(btlog(MAIN_XML, transitions, start))


def counts(mission: Verify, *logs: str) -> tuple[list[tuple[str, int, list[int]]], int, int]:
    """How many runs of each log count, and which do not; how many activations and runs the clauses counted."""
    found = mission.json(*logs, "--mission", "main.btq")
    sources = [(each["file"], each["runs"], each.get("left_out", [])) for each in found["sources"]]
    counted = [clause["counted"] for each in found["requirements"] for clause in each["clauses"]]
    return sources, counted[0], counted[1]


def without(*numbers: int) -> list[Row]:
    return [row for number, row in enumerate(RUNS) if number not in numbers]


def rounded(text: Sequence[Row]) -> list[Row]:
    return [(time // 1000 * 1000, uid, status) for time, uid, status in text]


def later(by: int, of: Sequence[Row] = RUNS) -> list[Row]:
    return [(time + by, uid, status) for time, uid, status in of]


JITTERED = [(time + 31 * number, uid, status) for number, (time, uid, status) in enumerate(RUNS)]


@pytest.mark.parametrize(
    ("other", "left_out"),
    [
        pytest.param(later(0, RUNS), [1, 2, 3], id="a copy with another start"),
        pytest.param(RUNS[: FIRST + 3], [1, 2], id="a prefix"),
        pytest.param(RUNS[:FIRST], [1], id="a prefix that ends with a run"),
        pytest.param(RUNS[FIRST:], [1, 2], id="a logger that came later"),
        pytest.param(without(3, 11, 19), [1, 2, 3], id="rows in the middle are missing"),
        pytest.param(without(FIRST), [1, 2, 3], id="the first row of a run is missing"),
        pytest.param(without(5, 12), [1, 2, 3], id="the last rows of runs are missing"),
        pytest.param(without(5, 6, 7, 8, 9), [1, 2], id="two runs look like one"),
        pytest.param(without(*range(19, 24)), [1, 2, 3], id="rows at the end are missing"),
        pytest.param(rounded(JITTERED), [1, 2, 3], id="times in ms"),
        pytest.param(later(995), [1, 2, 3], id="nearly a millisecond later"),
        pytest.param(later(1001), [], id="more than a millisecond later"),
        pytest.param(later(600_000), [], id="the runs after these"),
        pytest.param([*RUNS[:11], (348_500, 2, 3), *RUNS[12:]], [1, 3], id="one row of a run is at another time"),
        pytest.param([*RUNS[:11], (350_000, 2, 2), *RUNS[12:]], [1, 3], id="one row of a run has another status"),
    ],
)
@pytest.mark.parametrize("name", ["other.btlog", "other.db3"])
def test_a_run_in_two_logs_counts_once(mission: Verify, name: str, other: list[Row], left_out: list[int]) -> None:
    full = JITTERED if other == rounded(JITTERED) else RUNS
    write(mission, "full.btlog", full)
    write(mission, name, other)
    alone = counts(mission, name)[0][0][1]
    sources, activations, runs = counts(mission, "full.btlog", name)
    assert sources == [("full.btlog", 3, []), (name, alone - len(left_out), left_out)]
    assert (activations, runs) == (3 + alone - len(left_out),) * 2
    if len(other) < len(full):
        assert counts(mission, name, "full.btlog") == (sources[::-1], activations, runs)


def test_the_note_names_the_logs_and_how_many_runs(mission: Verify) -> None:
    write(mission, "full.btlog", RUNS)
    write(mission, "other.db3", RUNS[:SECOND])
    printed = mission.text("full.btlog", "other.db3", "--mission", "main.btq").splitlines()
    assert printed[1:3] == [
        "0 runs in other.db3, mission main (as built now, 3 of 3 nodes)",
        "  note: other.db3: 2 of its 2 runs are in full.btlog too, and not counted again",
    ]


def test_of_runs_that_differ_the_more_complete_counts(mission: Verify) -> None:
    """Each log has a run that the other one has only in part."""
    write(mission, "a.btlog", without(3))
    write(mission, "b.btlog", without(10))
    assert counts(mission, "a.btlog", "b.btlog") == ([("a.btlog", 2, [1]), ("b.btlog", 1, [2, 3])], 3, 3)


def test_runs_that_lack_different_rows_both_count(mission: Verify) -> None:
    write(mission, "a.btlog", RUNS[:3] + RUNS[4:FIRST])
    write(mission, "b.btlog", RUNS[:2] + RUNS[3:FIRST])
    assert counts(mission, "a.btlog", "b.btlog")[0] == [("a.btlog", 1, []), ("b.btlog", 1, [])]


def test_of_many_prefixes_the_whole_log_counts(mission: Verify) -> None:
    names = [f"{size:02}.btlog" for size in range(2, len(RUNS))]
    for size, name in enumerate(names, start=2):
        write(mission, name, RUNS[:size])
    write(mission, "whole.btlog", RUNS)
    sources, activations, runs = counts(mission, *names, "whole.btlog")
    assert sum(number for _, number, _ in sources) == activations == runs == 3


def test_a_robot_that_logs_twice_into_one_file(mission: Verify) -> None:
    write_db3(mission.folder / "run.db3", MAIN_XML, [RUNS, []])
    with sqlite3.connect(mission.folder / "run.db3") as database:
        database.execute(  # a time occurs once
            "INSERT INTO Transitions SELECT timestamp + 500, 2, node_uid, 0, state, '' FROM Transitions LIMIT ?",
            (SECOND,),
        )
    assert counts(mission, "run.db3") == ([("run.db3", 3, [4, 5])], 3, 3)
    assert "note: run.db3: 2 of its 5 runs are there twice, and not counted again" in mission.text(
        "run.db3", "--mission", "main.btq"
    )


def test_clones_that_start_together_are_robots_of_their_own(mission: Verify) -> None:
    """The first rows agree within a millisecond; later ones do not."""
    for number in range(5):
        logged = [(time + (time > 0) * number * 1500, uid, status) for time, uid, status in RUNS]
        write(mission, f"{number}.btlog", logged)
    sources, *_ = counts(mission, *(f"{number}.btlog" for number in range(5)))
    assert sources == [(f"{number}.btlog", 3, []) for number in range(5)]


def test_several_processes_leave_out_the_same(mission: Verify) -> None:
    write(mission, "full.btlog", RUNS)
    write(mission, "a.db3", RUNS[:12])
    write(mission, "b.db3", without(10))
    given = ("full.btlog", "a.db3", "b.db3")
    assert counts(mission, *given, "--jobs", "2") == counts(mission, *given)


def test_where_nothing_overlaps_no_log_is_read_again(mission: Verify, monkeypatch: pytest.MonkeyPatch) -> None:
    read: list[str] = []
    of_log: Callable[..., object] = readers.read

    def counted(path: str, *sources: object) -> object:
        read.append(path)
        return of_log(path, *sources)

    monkeypatch.setattr(judging, "read", counted)
    logs = [f"{number}.btlog" for number in range(4)]
    for number, log in enumerate(logs):
        write(mission, log, RUNS, START + number * 600_000)
    assert counts(mission, *logs)[1:] == (12, 12)
    assert [Path(each).name for each in read] == logs


def test_two_loggers_of_a_robot(verify: Verify, shared: Path) -> None:
    """A log of FileLogger2, and one of SqliteLogger that lost what it had in its queue."""
    folder = shared / "field" / "verdicts" / "robot"
    means = ("--mission", str(folder / "fetch.btq"), "--signals", str(folder / "f46.csv"))
    alone = verify.json(str(folder / "f46.btlog"), *means)
    both = verify.json(str(folder / "f46.btlog"), str(folder / "f46.db3"), *means)
    assert (both["requirements"], both["missions"]) == (alone["requirements"], alone["missions"])
    assert [(each["runs"], each.get("left_out", [])) for each in both["sources"]] == [(70, []), (0, [*range(1, 68)])]
    (grip,) = (each for each in both["requirements"] if each["id"] == "q05")
    (clause,) = grip["clauses"]
    assert (grip["verdict"], clause["counted"], clause["violated"]) == ("undecided", 186, 38)


def test_the_number_of_a_run_in_its_log_counts_those_that_are_left_out(mission: Verify) -> None:
    write(mission, "a.btlog", without(*range(8), 10))
    write(mission, "b.btlog", RUNS[:SECOND])
    found = mission.text("a.btlog", "b.btlog", "--mission", "main.btq", "--format", "json")
    (written,) = read_verdicts(found)
    assert [(each.file, each.runs, each.left_out) for each in written.sources] == [
        ("a.btlog", 1, (1,)),
        ("b.btlog", 2, ()),
    ]
    workspace = Workspace.of({"main.btq": DEMAND + MAIN})
    evidence = ProjectVerdicts("", {"main.btq": written})
    runs = [logged_run(workspace, "main.btq", evidence, number) for number in (1, 2, 3)]
    assert [(run.log, run.number_in_log) for run in runs if run is not None] == [
        ("a.btlog", 2),
        ("b.btlog", 1),
        ("b.btlog", 2),
    ]
