"""Where samples of signals come from: `--signals`, the table of the project file with topics and files, the log."""

from __future__ import annotations

import json
import sys

import duckdb
import numpy
import pytest
from evidence_bags import LOG, STORE, Message, names_of, number, stamp, stamped, tree_log, write_bag
from evidence_logs import MAIN, MAIN_XML, START, Verify, btlog, rows, samples, write_db3

NAMES = names_of(MAIN_XML)
MISSION = "signal battery : % from {level}\nQualityReq rq : safety\n    every Move needs battery > 20 %\n" + MAIN
# Two runs, one at 0 ms, one at 100 ms, each with Move at its start.
RUNS = rows("0 1R 2R 8 2S 3S 1S 2I 3I 1I 100 1R 2R 108 2S 3S 1S 2I 3I 1I")
CHANGES = tree_log(RUNS, NAMES)
MS = 1000


@pytest.fixture
def robot(verify: Verify) -> Verify:
    """A folder with a mission that needs some battery left."""
    (verify.folder / "main.btq").write_text(MISSION, encoding="utf-8")
    return verify


def source(robot: Verify, table: str, messages: list[Message]) -> None:
    """A bag with messages, and a table for the battery."""
    (robot.folder / "btq.toml").write_text(f"[evidence.signals]\nbattery = {{ {table} }}\n", encoding="utf-8")
    write_bag(robot.folder / "bag", messages)


def levels(robot: Verify, *arguments: str) -> tuple[int, list[tuple[int, str]]]:
    """In how many activations the battery was known, and the runs in which it was too low, with what it was."""
    clause = robot.json(*(arguments or ("bag",)))["requirements"][0]["clauses"][0]
    return clause["counted"], [(each["run"], each["why"]) for each in clause["violations"]]


def remarks(robot: Verify) -> list[str]:
    """What is said of the bag."""
    found: list[str] = robot.json("bag")["sources"][0]["remarks"]
    return found


# ---- topics ----


def test_a_topic_without_stamps_counts_at_its_reception(robot: Verify) -> None:
    messages = [number("/charge", START - 5 * MS, 0.5), number("/charge", START + 50 * MS, 0.125)]
    source(robot, 'topic = "/charge", field = "data", scale = 100', [*CHANGES, *messages])
    assert levels(robot) == (2, [(2, "`battery` was 12.5 % at the start")])
    assert remarks(robot) == []


def test_a_stamp_counts_before_the_reception(robot: Verify) -> None:
    """The second sample was taken after the start of the second run, and received before that."""
    messages = [
        stamped("/charge", START - 5 * MS, 50, START - 4 * MS),
        stamped("/charge", START + 101 * MS, 10, START + 99 * MS),
    ]
    source(robot, 'topic = "/charge", field = "point.x"', [*CHANGES, *messages])
    assert levels(robot) == (2, [])


def test_scale_then_offset_then_the_unit(robot: Verify) -> None:
    table = 'topic = "/charge", field = "data", scale = -2, offset = 0.5, unit = "1"'
    (robot.folder / "main.btq").write_text(MISSION.replace(": %", ": 1").replace("> 20 %", "> 0.2"), encoding="utf-8")
    source(robot, table, [*CHANGES, number("/charge", START - 1, 0.2)])
    assert levels(robot) == (2, [(1, "`battery` was 0.1 at the start"), (2, "`battery` was 0.1 at the start")])


def test_an_element_of_an_array(robot: Verify) -> None:
    joints = STORE.types["sensor_msgs/msg/JointState"]
    header = STORE.types["std_msgs/msg/Header"](stamp=stamp(STORE, START - 1), frame_id="")
    message = joints(header, ["a", "b"], numpy.array([30.0, 7.0]), numpy.array([]), numpy.array([]))
    source(robot, 'topic = "/joints", field = "position[1]"', [*CHANGES, ("/joints", (START - 1) * 1000, message)])
    assert levels(robot) == (2, [(1, "`battery` was 7 % at the start"), (2, "`battery` was 7 % at the start")])


def test_each_robot_has_its_own_topics(robot: Verify) -> None:
    logs = [*tree_log(RUNS, NAMES, topic=f"/one{LOG}"), *tree_log(RUNS, NAMES, topic=f"/two{LOG}")]
    messages = [number("/one/charge", START - 1, 50), number("/charge", START - 1, 5)]
    source(robot, 'topic = "/charge", field = "data"', [*logs, *messages])
    assert levels(robot) == (4, [(3, "`battery` was 5 % at the start"), (4, "`battery` was 5 % at the start")])


def test_simulated_time_is_joined_by_reception(robot: Verify) -> None:
    messages = [
        stamped("/charge", 10_000_000, 50, START - 5 * MS),
        stamped("/charge", 10_050_000, 10, START + 50 * MS),
    ]
    source(robot, 'topic = "/charge", field = "point.x"', [*CHANGES, *messages])
    assert levels(robot) == (2, [(2, "`battery` was 10 % at the start")])
    assert remarks(robot) == [
        "/charge: its stamps are on another clock than the tree's log, so samples count at their times of reception"
    ]


def test_a_clock_of_another_rate_is_joined_by_reception(robot: Verify) -> None:
    """The simulation begins at today's time and is a tenth as fast: it is 20 s late after 22 s."""
    changes = tree_log([*RUNS, *((time + 22_000_000, uid, status) for time, uid, status in RUNS)], NAMES)
    messages = [
        stamped("/charge", START - 500, 50, START - 5 * MS),
        stamped("/charge", START + 2_190_000, 10, START + 21_900_000),
    ]
    source(robot, 'topic = "/charge", field = "point.x"', [*changes, *messages])
    assert levels(robot) == (4, [(3, "`battery` was 10 % at the start"), (4, "`battery` was 10 % at the start")])


def test_a_bag_recorded_in_simulated_time(robot: Verify) -> None:
    """Its times of reception are simulated too, at half the rate: the messages of the log say where they belong."""
    changes = [(topic, (received - START * 1000) // 2 + 10**10, message) for topic, received, message in CHANGES]
    for each in ("number", "stamped"):
        made = number if each == "number" else stamped
        messages = [made("/charge", 10_000_000 - 5 * MS, 50), made("/charge", 10_000_000 + 40 * MS, 10)]
        field = "data" if each == "number" else "point.x"
        (robot.folder / "btq.toml").write_text(
            f'[evidence.signals]\nbattery = {{ topic = "/charge", field = "{field}" }}\n', encoding="utf-8"
        )
        write_bag(robot.folder / each, [*changes, *messages])
        assert levels(robot, each) == (2, [(2, "`battery` was 10 % at the start")])
        (said,) = robot.json(each)["sources"][0]["remarks"]
        assert said.endswith("on another clock than the tree's log, so samples count at their times of reception")


def test_clocks_that_nothing_joins_are_an_error(robot: Verify) -> None:
    changes = [(topic, 0, message) for topic, _, message in CHANGES]
    messages = [stamped("/charge", 10_000_000 + each, 50, 0) for each in range(2)]
    source(robot, 'topic = "/charge", field = "point.x"', [*changes, *messages])
    robot.text("bag")
    assert (robot.code, robot.errors.splitlines()[0]) == (
        2,
        "btq verify: bag: /charge: its stamps are on another clock than the tree's log, and there are no times of"
        " reception to join them by",
    )


def test_a_bag_of_topics_beside_a_log_of_the_engine(robot: Verify) -> None:
    (robot.folder / "run.btlog").write_bytes(btlog(MAIN_XML, RUNS))
    source(
        robot,
        'topic = "/charge", field = "data"',
        [number("/charge", START - 1, 50), number("/charge", START + 50 * MS, 5)],
    )
    assert levels(robot, "run.btlog", "bag") == (2, [(2, "`battery` was 5 % at the start")])
    assert robot.errors == ""


@pytest.mark.parametrize(
    ("field", "error"),
    [
        ("pint.x", "/charge: no field `pint` for `battery`; did you mean `point`?"),
        ("point.w", "/charge: no field `w` for `battery`; it has x, y, z"),
        ("point", "/charge: `point` is not a number, a bool or a text"),
        ("point.x.y", "/charge: no field `y` for `battery`"),
        ("header[0]", "/charge: `header[0]` needs a list"),
    ],
)
def test_fields_that_are_not_there(field: str, error: str, robot: Verify) -> None:
    source(robot, f'topic = "/charge", field = "{field}"', [*CHANGES, stamped("/charge", START, 50)])
    robot.text("bag")
    assert (robot.code, robot.errors.splitlines()[0]) == (2, f"btq verify: bag: {error}")


def test_a_topic_that_is_not_there(robot: Verify) -> None:
    source(robot, 'topic = "/charge", field = "data"', CHANGES)
    assert levels(robot) == (0, [])
    assert remarks(robot) == ["no topic /charge, where the samples of `battery` should be"]


# ---- files ----


def test_a_column_of_a_file(robot: Verify) -> None:
    (robot.folder / "power").mkdir()
    lines = ["level,when", f"0.5,{START / 1e6 - 1:.6f}", f"0.1,{START / 1e6 + 0.05:.6f}"]
    (robot.folder / "power" / "b.csv").write_text("\n".join(lines), encoding="utf-8")
    (robot.folder / "run.btlog").write_bytes(btlog(MAIN_XML, RUNS))
    table = 'battery = { file = "power/b.csv", time = "when", column = "level", scale = 100, unit = "%" }'
    (robot.folder / "btq.toml").write_text(f"[evidence.signals]\n{table}\n", encoding="utf-8")
    assert levels(robot, "run.btlog") == (2, [(2, "`battery` was 10 % at the start")])


def test_signals_count_before_the_table_and_the_table_before_the_log(robot: Verify) -> None:
    """Also where one names the signal, and the other one its entry."""
    write_db3(robot.folder / "run.db3", MAIN_XML, [RUNS], {0: json.dumps({"level": 3})})
    assert levels(robot, "run.db3") == (2, [(run, "`battery` was 3 % at the start") for run in (1, 2)])
    (robot.folder / "b.csv").write_text(f"t,battery\n{START / 1e6 - 1},2\n", encoding="utf-8")
    table = '[evidence.signals]\nbattery = { file = "b.csv", column = "battery" }\n'
    (robot.folder / "btq.toml").write_text(table, encoding="utf-8")
    assert levels(robot, "run.db3") == (2, [(run, "`battery` was 2 % at the start") for run in (1, 2)])
    (robot.folder / "given.csv").write_text(f"t,level\n{START / 1e6 - 1},1\n", encoding="utf-8")
    assert levels(robot, "run.db3", "--signals", "given.csv") == (
        2,
        [(run, "`battery` was 1 % at the start") for run in (1, 2)],
    )


@pytest.mark.parametrize(
    ("table", "error"),
    [
        ('battery = { file = "b.csv", column = "levl" }', "b.csv: no column `levl`; did you mean `level`?"),
        ('battery = { file = "b.csv", column = "x" }', "b.csv: no column `x`; it has level, other"),
        ('battery = { file = "b.csv", column = "x", time = "y" }', "b.csv: no column `y`; it has t, level, other"),
        ('battery = { file = "c.csv", column = "x" }', "c.csv: cannot be read: No such file or directory"),
        (
            'battery = { topic = "/x", field = "y", unit = "V" }',
            "btq.toml: [evidence.signals]: `battery` is in %, which is a percentage,"
            " and its source in V, which is a voltage",
        ),
        (
            'batery = { topic = "/x", field = "y" }',
            "btq.toml: [evidence.signals]: no mission has a signal `batery`; did you mean `battery`?",
        ),
        (
            'docked = { topic = "/x", field = "y", scale = 2 }',
            "btq.toml: [evidence.signals]: `docked` is a bool, so it takes no unit, scale or offset",
        ),
    ],
)
def test_sources_that_do_not_fit(table: str, error: str, robot: Verify) -> None:
    (robot.folder / "main.btq").write_text(f"signal docked : bool\n{MISSION}", encoding="utf-8")
    (robot.folder / "b.csv").write_text("t,level,other\n1,2,3\n", encoding="utf-8")
    (robot.folder / "run.btlog").write_bytes(btlog(MAIN_XML, RUNS))
    (robot.folder / "btq.toml").write_text(f"[evidence.signals]\n{table}\n", encoding="utf-8")
    robot.text("run.btlog")
    assert (robot.code, robot.errors) == (2, f"btq verify: {error}\n")


def test_a_parquet_file(robot: Verify) -> None:
    """Times as points in time or in seconds; a value that is missing, or has no finite number, is not a sample."""
    (robot.folder / "run.btlog").write_bytes(btlog(MAIN_XML, RUNS))
    early, late = START / 1e6 - 1, START / 1e6 + 0.05
    values = f"({early}, 50::DECIMAL(5,2)), ({late - 0.01}, NULL), ({late}, 10::DECIMAL(5,2))"
    for name, time in (("seconds", "t"), ("moments", "make_timestamp((t * 1e6)::BIGINT)")):
        duckdb.sql(
            f"COPY (SELECT {time} AS t, battery, [1] AS other FROM (VALUES {values}) AS v(t, battery))"
            f" TO '{robot.folder / name}.parquet' (FORMAT parquet)"
        )
        assert levels(robot, "run.btlog", "--signals", f"{name}.parquet") == (
            2,
            [(2, "`battery` was 10 % at the start")],
        )
    (robot.folder / "b.parquet").write_bytes(b"PAR1 and no more")
    robot.text("run.btlog", "--signals", "b.parquet")
    assert robot.code == 2
    assert robot.errors.startswith("btq verify: b.parquet: ")


def test_without_duckdb_a_line_says_what_to_install(robot: Verify, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "duckdb", None)
    (robot.folder / "run.btlog").write_bytes(btlog(MAIN_XML, RUNS))
    (robot.folder / "b.parquet").write_bytes(b"PAR1")
    robot.text("run.btlog", "--signals", "b.parquet")
    assert (robot.code, robot.errors) == (
        2,
        "btq verify: b.parquet: Parquet is read with duckdb; install it with pip install 'btq-lang[evidence]'\n",
    )


# ---- klein's blackboard beside a log ----


def blackboard(robot: Verify, *lines: object, header: object = None) -> None:
    """A log, and what klein recorded beside it."""
    first = {"klein_blackboard": 1, "first_timestamp": START, "tree_id": "Main"} if header is None else header
    (robot.folder / "run.btlog").write_bytes(btlog(MAIN_XML, RUNS))
    text = "".join(f"{json.dumps(line)}\n" for line in (first, *lines))
    (robot.folder / "run.bb.jsonl").write_text(text, encoding="utf-8")


def entry(ms: float, value: object, board: str = "Main", key: str = "level") -> dict[str, object]:
    return {"t": round(ms * 1000), "board": board, "key": key, "value": value}


def test_the_entries_that_klein_recorded(robot: Verify) -> None:
    blackboard(robot, entry(0, 50), entry(0, {"x": 1}, key="pose"), entry(50, 7))
    assert levels(robot, "run.btlog") == (2, [(2, "`battery` was 7 % at the start")])
    assert robot.json("run.btlog")["sources"][0]["remarks"] == []


def test_an_entry_that_was_removed_has_no_value(robot: Verify) -> None:
    removed = {"t": 50_000, "board": "Main", "key": "level", "removed": True}
    blackboard(robot, entry(0, 50), removed)
    clause = robot.json("run.btlog")["requirements"][0]["clauses"][0]
    assert (clause["counted"], clause["unknown"], clause["why"]) == (1, 1, "`battery` was not on the blackboard")


def test_the_main_tree_counts_before_subtrees(robot: Verify) -> None:
    blackboard(robot, entry(0, 50), entry(0, 5, "Sub::3"))
    assert levels(robot, "run.btlog") == (2, [])
    blackboard(robot, entry(0, 5, "Sub::3"))
    assert levels(robot, "run.btlog")[0] == 2
    blackboard(robot, entry(0, 5, "Sub::3"), entry(0, 50, "Sub::7"))  # which of them is meant is not known
    assert levels(robot, "run.btlog") == (0, [])


@pytest.mark.parametrize(
    ("header", "lines", "remark"),
    [
        ({"klein_blackboard": 2}, [], "run.bb.jsonl: expected a first line with `klein_blackboard` 1; left out"),
        ([], [], "run.bb.jsonl: expected a first line with `klein_blackboard` 1; left out"),
        (
            {"klein_blackboard": 1, "first_timestamp": "noon"},
            [],
            "run.bb.jsonl: expected `first_timestamp` in the first line; left out",
        ),
        (
            None,
            [3, {"t": True, "board": "Main", "key": "level", "value": 1}, {"t": 1, "board": "Main", "key": "level"}],
            "run.bb.jsonl: lines that cannot be read, left out: 3",
        ),
    ],
)
def test_what_klein_did_not_write(header: object, lines: list[object], remark: str, robot: Verify) -> None:
    blackboard(robot, *lines, header=header)
    assert robot.json("run.btlog")["sources"][0]["remarks"] == [remark]


@pytest.mark.parametrize(
    ("times", "period"),
    [
        ((0, 61), "1970-01-01 00:00–00:01 UTC"),
        ((START / 1e6 + 3600, START / 1e6 + 90000), "2026-11-20 22:22–2026-11-21 22:22 UTC"),
        ((START / 1e3, START / 1e3 + 1000), "times that no calendar has"),
    ],
)
def test_samples_of_another_time_than_the_runs(times: tuple[float, float], period: str, robot: Verify) -> None:
    """As where the times are counted from the start of the robot, in another zone, or in ms."""
    (robot.folder / "run.btlog").write_bytes(btlog(MAIN_XML, RUNS))
    lines = ["t,battery", *[f"{time},50" for time in times]]
    (robot.folder / "b.csv").write_text("\n".join(lines), encoding="utf-8")
    remark = (
        f"b.csv: its samples are from {period}, and the runs from 2026-11-20 21:22 UTC;"
        " expected times in seconds since the epoch"
    )
    told = f"btq verify: {remark}\n"
    assert robot.json("run.btlog", "--signals", "b.csv")["remarks"] == [remark]
    assert robot.errors == told
    assert robot.text("run.btlog", "--signals", "b.csv").splitlines()[1] == f"  note: {remark}"
    assert robot.errors == ""
    table = '[evidence.signals]\nbattery = { file = "b.csv", column = "battery" }\n'
    (robot.folder / "btq.toml").write_text(table, encoding="utf-8")
    robot.text("run.btlog", "--format", "csv")
    assert robot.errors == told
    (robot.folder / "b.csv").write_text("\n".join([*lines, f"{START / 1e6},50"]), encoding="utf-8")
    robot.text("run.btlog", "--format", "csv")
    assert robot.errors == ""


def test_the_samples_of_a_file_count_for_every_robot(robot: Verify) -> None:
    """And before those of its own topic, which count for it alone."""
    own = [number(f"/robot{each}/charge", START - 1, value) for each, value in ((1, 10), (2, 90))]
    logs = [tree_log(RUNS, NAMES, topic=f"/robot{each}{LOG}") for each in (1, 2)]
    source(robot, 'topic = "/charge", field = "data"', [*own, *logs[0], *logs[1]])
    low = [(run, "`battery` was 10 % at the start") for run in (1, 2, 3, 4)]
    assert levels(robot) == (4, low[:2])
    (robot.folder / "one.csv").write_text(samples("battery", {-1: 10}), encoding="utf-8")
    assert levels(robot, "bag", "--signals", "one.csv") == (4, low)


# ---- logs of the project ----


@pytest.mark.parametrize("table", ['[evidence]\nlog = ["logs"]\n', '[evidence]\nlogs = "logs"\n'])
def test_a_mistake_in_the_project_is_told_first(table: str, robot: Verify) -> None:
    (robot.folder / "btq.toml").write_text(table, encoding="utf-8")
    robot.text()
    problem = (
        "unknown key `evidence.log`; did you mean `logs`?"
        if "log = " in table
        else "`evidence.logs` must be a list of paths"
    )
    assert (robot.code, robot.errors) == (2, f"btq verify: btq.toml:2:1: {problem}\n")


def test_the_logs_of_the_project(robot: Verify) -> None:
    robot.text()
    assert (robot.code, robot.errors) == (
        2,
        "btq verify: no log given; name one, or set `logs` in [evidence] of btq.toml\n",
    )
    (robot.folder / "logs" / "monday").mkdir(parents=True)
    (robot.folder / "logs" / "monday" / "run.btlog").write_bytes(btlog(MAIN_XML, RUNS))
    write_bag(robot.folder / "bags" / "one", CHANGES)
    (robot.folder / "btq.toml").write_text('[evidence]\nlogs = ["logs/**/*.btlog", "bags/*"]\n', encoding="utf-8")
    files = [each["file"] for each in robot.json()["sources"]]
    assert files == ["logs/monday/run.btlog", "bags/one"]
    (robot.folder / "btq.toml").write_text('[evidence]\nlogs = ["old/*.btlog"]\n', encoding="utf-8")
    robot.text()
    assert (robot.code, robot.errors.splitlines()[0]) == (
        2,
        "btq verify: old/*.btlog: cannot be read: No such file or directory",
    )
