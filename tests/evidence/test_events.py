"""Violations as a bag: what `rosbags` reads back, on whose clock, and that the file is whole or as it was."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from evidence_bags import LOG, names_of, tree_log, write_bag
from evidence_logs import MAIN, MAIN_XML, START, Verify, btlog, rows
from rosbags.highlevel import AnyReader
from test_identity import DEMANDS

from btq_lang.cli import main

DEMAND = (
    'QualityReq quick : safety "In time"\n    Move takes at most 10 ms\n'
    "QualityReq often : reliability\n    Move succeeds\n    in at least 40 % of runs\n"
    "QualityReq surely : reliability\n    Move succeeds\n    in at least 40 % of runs\n    confidence 95 %\n"
)
RUNS = rows("0 1R 2R 8 2S 3S 1S 2I 3I 1I 50 1R 2R 70 2F 1F 2I 1I")
NAMES = names_of(MAIN_XML)
BROKEN = START + 70_000
WHERE = "20 ms after its start at 2026-11-20 21:22:20.050 UTC)"


@pytest.fixture
def robot(verify: Verify) -> Verify:
    """A folder with a mission and a log of two runs, the second of which violates its requirements."""
    (verify.folder / "main.btq").write_text(f"{DEMAND}{MAIN}", encoding="utf-8")
    (verify.folder / "run.btlog").write_bytes(btlog(MAIN_XML, RUNS))
    return verify


def messages(path: Path) -> list[tuple[str, int, Any]]:
    """What a bag has: topic, time of reception in µs, message."""
    with AnyReader([path]) as bag:
        return [
            (each.topic, received // 1000, bag.deserialize(data, each.msgtype))
            for each, received, data in bag.messages()
        ]


def stamp(message: Any) -> int:
    """The stamp of a message in µs."""
    return int(message.stamp.sec * 1_000_000 + message.stamp.nanosec // 1000)


def test_a_message_says_what_was_violated_and_how_bad_that_is(robot: Verify) -> None:
    table = robot.text("run.btlog", "--events", "out/violations.mcap")
    assert (robot.code, robot.errors, table) == (1, "", robot.text("run.btlog"))
    found = messages(robot.folder / "out" / "violations.mcap")
    assert [(topic, received, stamp(message)) for topic, received, message in found] == [
        ("/rosout", BROKEN, BROKEN)
    ] * 3
    levels = type(found[0][2])
    assert [(each.level, each.name, each.file, each.function, each.msg) for *_, each in found] == [
        (level, name, "main.btq", "Move::2", f"{text} (run 2 of run.btlog, {WHERE}")
        for level, name, text in (
            (
                levels.ERROR,
                "quick",
                "quick In time (violated): Move takes at most 10 ms."
                " Move::2: took 20 ms, bound 10 ms; its median is 8 ms",
            ),
            (
                levels.INFO,
                "often",
                "often (satisfied): Move succeeds in at least 40 % of runs. Move::2: failed; it ran 20 ms",
            ),
            (
                levels.WARN,
                "surely",
                "surely (undecided): Move succeeds in at least 40 % of runs. Move::2: failed; it ran 20 ms",
            ),
        )
    ]


def test_each_violation_has_a_message_at_its_time(verify: Verify, shared: Path) -> None:
    for name in ("nav.xml", "nav.btlog", "nav_noidle.btlog"):
        shutil.copy(shared / "logs" / name, verify.folder / name)
    assert main(["import", "nav.xml"]) == 0
    mission = (verify.folder / "nav.btq").read_text(encoding="utf-8")
    (verify.folder / "nav.btq").write_text(f"{DEMANDS}{mission}", encoding="utf-8")
    given = ("nav.btlog", "nav_noidle.btlog", "--mission", "nav.btq")
    expected = [
        (requirement["id"], violation["path"], f"run {violation['run']} of {violation['source']},", violation["at"])
        for requirement in verify.json(*given, "--events", "one.mcap")["requirements"]
        for clause in requirement["clauses"]
        for violation in clause["violations"]
    ]
    found = messages(verify.folder / "one.mcap")
    times = [received for _, received, _ in found]
    assert len(found) == len(expected) == 40
    assert times == sorted(times) == [stamp(message) for *_, message in found]
    left = [message for *_, message in found]
    for name, path, where, _ in expected:
        left.remove(next(each for each in left if (each.name, each.function) == (name, path) and where in each.msg))
    verify.text(*given, "--events", "two.mcap", "--jobs", "2")
    assert [str(each) for each in messages(verify.folder / "two.mcap")] == [str(each) for each in found]


def test_messages_are_where_the_bag_shows_the_moment(robot: Verify) -> None:
    """The bag is recorded in simulated time, at half the rate: it received the change of 70 ms at 40 ms of its own."""
    simulated = [
        (topic, (received - START * 1000) // 2 + 10**10, each) for topic, received, each in tree_log(RUNS, NAMES)
    ]
    write_bag(robot.folder / "real", tree_log(RUNS, NAMES))
    write_bag(robot.folder / "simulated", simulated)
    for bag, moment in (("real", BROKEN), ("simulated", 10_040_000)):
        robot.text(bag, "--events", "violations.mcap")
        _, received, message = messages(robot.folder / "violations.mcap")[0]
        assert (received, stamp(message)) == (moment, BROKEN)


def test_each_robot_of_a_bag_has_its_own_clock(robot: Verify) -> None:
    (robot.folder / "main.btq").write_text(f"QualityReq quick : safety\n    Move takes at most 10 ms\n{MAIN}")
    both = [
        (topic, received - START * 1000 + begin, each)
        for name, begin in (("one", 10**10), ("two", 2 * 10**10))
        for topic, received, each in tree_log(RUNS, NAMES, topic=f"/{name}{LOG}")
    ]
    write_bag(robot.folder / "bag", both)
    robot.text("bag", "--events", "violations.mcap")
    found = messages(robot.folder / "violations.mcap")
    assert [(received, message.msg.partition("(run ")[2].partition(",")[0]) for _, received, message in found] == [
        (10_080_000, f"2 of bag /one{LOG}"),
        (20_080_000, f"4 of bag /two{LOG}"),
    ]


def test_without_a_violation_the_bag_has_no_message(robot: Verify) -> None:
    (robot.folder / "run.btlog").write_bytes(btlog(MAIN_XML, rows("0 1R 2R 8 2S 3S 1S")))
    robot.text("run.btlog", "--events", "violations.mcap")
    assert (robot.code, messages(robot.folder / "violations.mcap")) == (0, [])


def test_what_is_left_out_is_counted(robot: Verify) -> None:
    (robot.folder / "main.btq").write_text(f"QualityReq quick : safety\n    Move takes at most 10 ms\n{MAIN}")
    run = rows("0 1R 2R 20 2S 3S 1S 2I 3I 1I")
    many = [(time + 30_000 * number, uid, status) for number in range(1002) for time, uid, status in run]
    (robot.folder / "run.btlog").write_bytes(btlog(MAIN_XML, many))
    robot.text("run.btlog", "--events", "violations.mcap")
    assert robot.errors == (
        "btq verify: violations.mcap: left out 2 violations; the file contains only the first thousand of each clause\n"
    )
    assert len(messages(robot.folder / "violations.mcap")) == 1000
    (robot.folder / "run.btlog").write_bytes(btlog(MAIN_XML, run, start=2**31 * 1_000_000))
    robot.text("run.btlog", "--events", "violations.mcap")
    assert robot.errors == (
        "btq verify: violations.mcap: left out 1 violation whose times do not fit in a ROS timestamp\n"
    )
    assert messages(robot.folder / "violations.mcap") == []


def test_the_file_is_whole_or_as_it_was(robot: Verify, monkeypatch: pytest.MonkeyPatch) -> None:
    old = robot.folder / "violations.mcap"
    old.write_bytes(b"old")
    before = sorted(os.listdir(robot.folder))

    replace = os.replace

    def fail(source: Any, target: Any, **rest: Any) -> None:
        if os.path.basename(target) == "violations.mcap" and os.path.dirname(target) == str(robot.folder):
            raise OSError(28, "No space left on device")
        replace(source, target, **rest)

    with monkeypatch.context() as patch:
        patch.setattr("os.replace", fail)
        robot.text("run.btlog", "--events", "violations.mcap")
    assert (robot.code, robot.errors) == (
        2,
        "btq verify: violations.mcap: cannot be written: No space left on device\n",
    )
    assert (old.read_bytes(), sorted(os.listdir(robot.folder))) == (b"old", before)
    robot.text("run.btlog", "--events", "violations.mcap")
    assert len(messages(old)) == 3


@pytest.mark.parametrize(
    ("arguments", "error"),
    [
        (
            ["run.btlog", "--events", "violations.json"],
            "--events violations.json: expected the name of an MCAP file, which ends in .mcap",
        ),
        (["bag/bag.mcap", "--events", "bag/bag.mcap"], "--events bag/bag.mcap is among the logs; choose another place"),
        (["bag", "--events", "bag/new.mcap"], "--events bag/new.mcap is among the logs; choose another place"),
        ([".", "--events", "new.mcap"], "--events new.mcap is among the logs; choose another place"),
        (
            ["--store", "kept", "--events", "new.mcap"],
            "--events goes with logs; without any, --store DIR prints what is kept there",
        ),
    ],
)
def test_a_file_that_would_not_do_is_refused(arguments: list[str], error: str, robot: Verify) -> None:
    write_bag(robot.folder / "bag", tree_log(RUNS, NAMES))
    before = (robot.folder / "bag" / "bag.mcap").read_bytes()
    assert robot.text(*arguments) == ""
    assert (robot.code, robot.errors) == (2, f"btq verify: {error}\n")
    assert (robot.folder / "bag" / "bag.mcap").read_bytes() == before


@pytest.mark.skipif(sys.platform != "linux", reason="other systems have no such file names")
def test_names_that_are_not_utf8_are_written_with_question_marks(robot: Verify) -> None:
    os.rename(robot.folder / "run.btlog", os.fsencode(robot.folder) + b"/r\xff.btlog")
    robot.text(os.fsdecode(b"r\xff.btlog"), "--events", os.fsdecode(b"v\xff.mcap"))
    os.rename(os.fsencode(robot.folder) + b"/v\xff.mcap", os.fsencode(robot.folder) + b"/read.mcap")
    assert "(run 2 of r?.btlog, " in messages(robot.folder / "read.mcap")[0][2].msg


def test_without_rosbags_events_say_what_to_install(robot: Verify) -> None:
    hidden = "import sys; sys.modules['rosbags'] = None; from btq_lang.cli import main; sys.exit(main(sys.argv[1:]))"
    run = subprocess.run(
        [sys.executable, "-c", hidden, "verify", "run.btlog", "--events", "new.mcap"],
        cwd=robot.folder,
        capture_output=True,
        text=True,
    )
    assert (run.returncode, run.stdout, run.stderr) == (
        2,
        "",
        "btq verify: --events is written with rosbags; install it with pip install 'btq-lang[ros]'\n",
    )
