"""ROS 2 bags: the same verdicts as through the engine's own logs, whatever Nav2 omits, mixes or publishes late."""

from __future__ import annotations

import json
import re
import shutil
import sqlite3
import subprocess
import sys
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any, Literal

import lz4.frame  # type: ignore[import-untyped]  # which has no types
import pytest
from evidence_bags import HUMBLE, LOG, STORE, late_ends, names_of, text, tree_log, write_bag
from evidence_logs import MAIN, MAIN_XML, START, Verify, logged, rows
from json_schema import violations
from rosbags.rosbag2 import storage_mcap
from test_identity import DEMANDS

from btq_lang.cli import main
from btq_lang.evidence.model import NamedLog
from btq_lang.evidence.readers import bag, read

zstd = import_module("compression.zstd" if sys.version_info >= (3, 14) else "backports.zstd")  # as rosbags does
SCHEMA = json.loads((Path(__file__).parents[3] / "btq_lang/evidence/verdicts.schema.json").read_text(encoding="utf-8"))
LIMIT = "QualityReq rq : safety\n    Move takes at most 10 ms\n"
NAMES = names_of(MAIN_XML)
TWO_RUNS = "0 1R 2R 8 2S 3S 1S 2I 3I 1I 50 1R 2R 70 2F 1F 2I 1I"


@pytest.fixture
def small(verify: Verify) -> Verify:
    """A folder with a small mission."""
    (verify.folder / "main.btq").write_text(f"{LIMIT}{MAIN}", encoding="utf-8")
    return verify


def clause(found: dict[str, Any]) -> tuple[int, list[int]]:
    """How many activations the only clause has counted, and the runs that violate it."""
    ((each,),) = (requirement["clauses"] for requirement in found["requirements"])
    return each["counted"], [violation["run"] for violation in each["violations"]]


# ---- the tree that Nav2 ships ----


@pytest.fixture
def nav(verify: Verify, shared: Path) -> Verify:
    """A folder with Nav2's mission and demands on it."""
    shutil.copy(shared / "logs" / "nav.xml", verify.folder / "nav.xml")
    assert main(["import", "nav.xml"]) == 0
    mission = (verify.folder / "nav.btq").read_text(encoding="utf-8")
    (verify.folder / "nav.btq").write_text(f"{DEMANDS}{mission}", encoding="utf-8")
    return verify


@pytest.mark.parametrize(
    ("storage", "compression"),
    [
        ("mcap", "none"),
        ("mcap", "storage"),
        ("mcap", "message"),
        ("mcap", "file"),
        ("sqlite3", "none"),
        ("sqlite3", "message"),
        ("sqlite3", "file"),
    ],
)
@pytest.mark.parametrize("log", ["nav", "nav_noidle"])
def test_a_bag_gives_the_verdicts_of_the_log(
    log: str, storage: Any, compression: Any, nav: Verify, shared: Path
) -> None:
    xml, start, transitions = logged(shared / "logs" / f"{log}.btlog")
    write_bag(nav.folder / "bag", tree_log(transitions, names_of(xml), start), storage, compression)
    shutil.copy(shared / "logs" / f"{log}.btlog", nav.folder)
    found, expected = (nav.json(each, "--mission", "nav.btq") for each in ("bag", f"{log}.btlog"))
    (source,) = found["sources"]
    assert (source["file"], source["runs"], source["identity"], source["joined"]) == ("bag", 40, "as built now", 38)
    assert found["requirements"] == json.loads(json.dumps(expected["requirements"]).replace(f"{log}.btlog", "bag"))
    assert nav.errors == ""


def test_the_end_of_a_goal_may_come_with_the_next_one_or_never(nav: Verify, shared: Path) -> None:
    xml, start, transitions = logged(shared / "logs" / "nav.btlog")
    write_bag(nav.folder / "bag", late_ends(tree_log(transitions, names_of(xml), start)))
    arrives = nav.json("bag", "--mission", "nav.btq")["requirements"][-1]["clauses"][0]
    truth = [json.loads(line) for line in (shared / "logs" / "nav.truth.jsonl").read_text().splitlines()]
    outcomes = [each["result"] for each in truth if "node" not in each]
    failed = [run for run, result in enumerate(outcomes[:-1], start=1) if result == "FAILURE"]
    assert (arrives["counted"], arrives["cut_off"]) == (39, 1)  # how the last run ended is not in the bag
    assert [each["run"] for each in arrives["violations"]] == failed


def test_a_bag_without_uids(nav: Verify, shared: Path) -> None:
    """ROS 2 Humble: nodes of the same name cannot be distinguished, so clauses at them are unknown."""
    xml, start, transitions = logged(shared / "logs" / "nav.btlog")
    write_bag(nav.folder / "bag", tree_log(transitions, names_of(xml), start, store=HUMBLE), store=HUMBLE)
    found = nav.json("bag", "--mission", "nav.btq")
    (source,) = found["sources"]
    names = [*names_of(xml).values()]
    unique = sum(names.count(name) == 1 for name in names)
    assert (source["identity"], source["joined"], source["nodes"]) == (
        "by name, for the log has no uids",
        unique,
        len(names),
    )
    steady, _, arrives = found["requirements"]
    assert steady["clauses"][0]["why"] == (
        "`FollowPath::22` has a name that another node has too, and the log has no uids"
    )
    shutil.copy(shared / "logs" / "nav.btlog", nav.folder)
    expected = nav.json("nav.btlog", "--mission", "nav.btq")["requirements"]
    assert arrives == json.loads(json.dumps(expected[-1]).replace("nav.btlog", "bag"))


# ---- what may be in a bag ----


def test_files_of_a_bag_are_read_alone_and_as_a_folder(small: Verify) -> None:
    for storage, suffix in (("mcap", "mcap"), ("sqlite3", "db3")):
        write_bag(small.folder / "logs" / storage, tree_log(rows(TWO_RUNS), NAMES), storage)  # type: ignore[arg-type]  # a name from a list
        assert clause(small.json(f"logs/{storage}/{storage}.{suffix}")) == (2, [2])
    found = small.json("logs")
    assert [(each["file"], each["runs"]) for each in found["sources"]] == [("logs/mcap", 2), ("logs/sqlite3", 0)]
    assert clause(found) == (2, [2])  # they are the same runs


def test_each_topic_is_a_session_of_its_own(small: Verify) -> None:
    one, two = (tree_log(rows(TWO_RUNS), NAMES, topic=f"/robot{number}{LOG}") for number in (1, 2))
    write_bag(small.folder / "bag", [*one, *two])
    found = small.json("bag")
    assert [(each["file"], each["runs"], each["first_run"]) for each in found["sources"]] == [
        ("bag /robot1/behavior_tree_log", 2, 1),
        ("bag /robot2/behavior_tree_log", 2, 3),
    ]
    assert clause(found) == (4, [2, 4])


OTHER = MAIN.replace("Main", "Other").replace("Pick", "Wash")
OTHER_NAMES = {**NAMES, 3: "Wash"}


def test_two_trees_on_one_topic_are_told_apart_run_by_run(small: Verify) -> None:
    """The other tree's first two nodes have the same numbers and names; the late end comes amid the other's run."""
    (small.folder / "other.btq").write_text(f"{LIMIT.replace('10', '30')}{OTHER}", encoding="utf-8")
    good = "0 1R 2R 8 2S 3S 1S 2I 3I 1I"
    late = "0 1R 2R 20 2S 3S 1S 2I 3I 1I"
    messages = [
        message
        for number, (text, names) in enumerate([(good, NAMES), (late, OTHER_NAMES), (late, NAMES), (late, OTHER_NAMES)])
        for message in tree_log(rows(text), names, START + number * 100_000)
    ]
    write_bag(small.folder / "bag", messages)
    found = small.json("bag")
    assert [(each["mission"], each["runs"]) for each in found["sources"]] == [("main", 2), ("other", 2)]
    counted = {each["mission"]: each["clauses"][0] for each in found["requirements"]}
    assert {name: (each["counted"], each["violated"]) for name, each in counted.items()} == {
        "main": (2, 1),
        "other": (2, 0),
    }
    only = small.json("bag", "--mission", "main.btq")
    assert clause(only) == (2, [2])
    assert small.errors == "btq verify: bag: 2 runs of another mission, not judged\n"
    assert [(each["mission"], each["runs"]) for each in only["sources"]] == [("main", 2), (None, 2)]


def test_a_run_that_two_missions_have_is_not_judged(small: Verify) -> None:
    (small.folder / "other.btq").write_text(f"{LIMIT}{OTHER}", encoding="utf-8")
    write_bag(small.folder / "bag", tree_log(rows("0 1R 2R 20 2F 1F 2I 1I"), NAMES))
    small.text("bag")
    assert small.code == 2
    assert small.errors.splitlines()[0] == "btq verify: bag: 1 run of one of several missions, not judged"


def test_a_short_run_beside_runs_of_an_unknown_mission_is_not_judged(small: Verify) -> None:
    """Its nodes are in the mission, and in the unknown one as well."""
    short = "50 1R 2R 70 2F 1F 2I 1I"
    write_bag(small.folder / "bag", tree_log(rows(f"0 1R 2R 8 2S 3S 1S 2I 3I 1I {short}"), OTHER_NAMES))
    small.text("bag")
    assert (small.code, small.errors.splitlines()[:2]) == (
        2,
        [
            "btq verify: bag: 1 run of another mission, not judged",
            "btq verify: bag: 1 run of one of several missions, not judged",
        ],
    )
    write_bag(small.folder / "alone", tree_log(rows(short), OTHER_NAMES))
    assert clause(small.json("alone")) == (1, [1])


def test_the_tree_may_be_in_the_bag(small: Verify) -> None:
    """Then nodes are found as in the engine's logs, also of a build with other options or of an older text."""
    older = MAIN.replace("        Action Pick\n", "        Action Pick\n        Action Pick\n", 1)
    xml = small.build(older)
    names = names_of(xml)
    assert names == {1: "Sequence", 2: "Move", 3: "Pick", 4: "Pick"}
    changes = tree_log(rows("0 1R 2R 20 2S 3S 4S 1S"), names)
    write_bag(small.folder / "without", changes)
    small.text("without")
    assert (small.code, small.errors.splitlines()[0]) == (
        2,
        "btq verify: without: 1 run of another mission, not judged",
    )
    trees = [text("/behavior_tree", START, xml), text("/chatter", START, "<no_uid/>")]
    write_bag(small.folder / "with", [*trees, *changes])
    found = small.json("with")
    assert clause(found) == (1, [1])
    assert (found["sources"][0]["identity"], found["sources"][0]["joined"]) == ("built from another version", 2)


def test_a_bag_without_definitions_of_its_types(small: Verify) -> None:
    """As ROS 2 writes SQLite bags before Iron; here with uids and without."""
    for name, store in (("jazzy", STORE), ("humble", HUMBLE)):
        write_bag(small.folder / name, tree_log(rows(TWO_RUNS), NAMES, store=store), "sqlite3", store=store)
        database = small.folder / name / f"{name}.db3"
        connection = sqlite3.connect(database)
        connection.executescript("DROP TABLE message_definitions; DROP TABLE schema")
        connection.close()
        assert clause(small.json(name)) == (2, [2])


def test_a_bag_may_define_the_types_otherwise(small: Verify) -> None:
    write_bag(small.folder / "bag", tree_log(rows(TWO_RUNS), NAMES))
    whole = (small.folder / "bag" / "bag.mcap").read_bytes()
    for name, other, remark in (
        (b"current_status", b"current_statue", "status changes that are not as Nav2 defines them, left out: 14"),
        (b"event_log", b"event_lag", "status changes that are not as Nav2 defines them, left out: 3"),
    ):
        (small.folder / "other.mcap").write_bytes(whole.replace(name, other))
        (log,) = read(str(small.folder / "other.mcap"))
        assert isinstance(log, NamedLog)
        assert ([*log.times], log.remarks) == ([], [remark])


def test_a_bag_that_was_cut_off(small: Verify) -> None:
    """A recording that was killed has no end and no metadata."""
    write_bag(small.folder / "bag", tree_log(rows(TWO_RUNS), NAMES))
    whole = (small.folder / "bag" / "bag.mcap").read_bytes()
    last = whole.index(b"FAILURE")
    (small.folder / "cut.mcap").write_bytes(whole[: last + 3])
    lines = small.text("cut.mcap").splitlines()
    assert lines[0] == "2 runs in cut.mcap, 2026-11-20 21:22 UTC, mission main (as built now, 3 of 3 nodes)"
    assert lines[1].startswith("  note: cut off: the last ")
    assert lines[1].endswith(" bytes are not a whole record and are left out")


def test_a_packed_chunk_that_was_cut_is_left_out_and_that_is_said(small: Verify) -> None:
    many = " ".join(f"{50 * run} 1R 2R {50 * run + 8} 2S 3S 1S" for run in range(8000))
    write_bag(small.folder / "bag", tree_log(rows(many), NAMES), compression="storage")
    whole = (small.folder / "bag" / "bag.mcap").read_bytes()
    *_, (begin, end) = chunks(whole)
    (small.folder / "cut.mcap").write_bytes(whole[: end - 1])
    cut = small.json("cut.mcap")
    lost = f"cut off: the last {end - 1 - begin} bytes are not a whole record and are left out"
    assert cut["sources"][0]["remarks"] == [lost]
    assert 0 < cut["runs"] < small.json("bag")["runs"] == 8000


def chunks(data: bytes) -> list[tuple[int, int]]:
    """Where the chunks of an MCAP file begin and end, read without btq."""
    found: list[tuple[int, int]] = []
    begin = 8
    while begin < len(data) - 8:
        end = begin + 9 + int.from_bytes(data[begin + 1 : begin + 9], "little")
        if data[begin] == 6:
            found.append((begin, end))
        begin = end
    return found


@pytest.mark.parametrize(
    ("compression", "remark"),
    [
        (
            "storage",
            "the bag is damaged, and what comes after the damage is left out: X compressed bytes decompress to",
        ),
        ("message", "messages that cannot be decoded, left out: 1"),
    ],
)
def test_what_is_packed_is_unpacked_up_to_a_limit(
    compression: Literal["storage", "message"], remark: str, small: Verify, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A few bytes may be gigabytes of blanks."""
    monkeypatch.setattr(bag, "MAX_DECOMPRESSED_SIZE", 100_000)
    logs = tree_log(rows(TWO_RUNS), NAMES)
    write_bag(small.folder / "bag", [*logs, text("/tree", START, " " * 10**6)], "mcap", compression)
    (log,) = read(str(small.folder / "bag"))
    assert isinstance(log, NamedLog)
    (said,) = log.remarks
    assert re.sub(r"\d+ compressed", "X compressed", said).startswith(remark)
    assert (len(log.times) > 0) == (compression == "message")


@pytest.mark.parametrize("pack", [zstd.compress, lz4.frame.compress])
def test_a_chunk_that_unpacks_to_more_than_it_says(pack: Callable[[bytes], bytes]) -> None:
    bag.limit_chunks()
    unpack = storage_mcap.DECOMPRESSORS["zstd" if pack is zstd.compress else "lz4"]
    packed = pack(bytes(10**6))
    assert unpack(packed, 10**6) == bytes(10**6)
    assert unpack(packed + pack(b"ab"), 10**6 + 2) == bytes(10**6) + b"ab"
    with pytest.raises(ValueError, match=f"{len(packed)} compressed bytes decompress to more than 1000 bytes"):
        unpack(packed, 1000)
    with pytest.raises(EOFError, match="the compressed data is truncated"):
        unpack(packed[:-5], 10**6)


@pytest.mark.parametrize("path", ["bag", "bag/bag.db3"])
def test_what_is_still_in_the_log_beside_a_bag_counts(path: str, small: Verify) -> None:
    """As where the recorder was killed, or goes on."""
    write_bag(small.folder / "bag", tree_log(rows(TWO_RUNS), NAMES), "sqlite3")
    writer = sqlite3.connect(small.folder / "bag" / "bag.db3")
    writer.execute("PRAGMA journal_mode = WAL")
    writer.execute("PRAGMA wal_autocheckpoint = 0")
    last = writer.execute("SELECT id, topic_id, timestamp, data FROM messages ORDER BY id DESC LIMIT 1").fetchone()
    writer.execute("DELETE FROM messages WHERE id = ?", last[:1])
    writer.commit()
    writer.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    assert clause(small.json(path)) == (1, [])
    writer.execute("INSERT INTO messages VALUES (?, ?, ?, ?)", last)
    writer.commit()
    assert clause(small.json(path)) == (2, [2])
    writer.close()


def test_bags_that_cannot_be_used(small: Verify) -> None:
    write_bag(small.folder / "chat", [text("/chatter", START, "hello")])
    (small.folder / "empty").mkdir()
    (small.folder / "empty" / "metadata.yaml").write_text("rosbag2_bagfile_information: {version: 99}\n")
    for name, error in (
        (
            "chat",
            "expected a topic of type nav2_msgs/msg/BehaviorTreeLog, such as /behavior_tree_log; the bag has none",
        ),
        ("empty", "the bag cannot be read: Rosbag2 version 99 not supported; please report issue."),
    ):
        small.text(name)
        assert (small.code, small.errors) == (2, f"btq verify: {name}: {error}\n")


def test_without_rosbags_a_line_says_what_to_install(small: Verify) -> None:
    write_bag(small.folder / "bag", tree_log(rows(TWO_RUNS), NAMES))
    hidden = "import sys; sys.modules['rosbags'] = None; from btq_lang.cli import main; sys.exit(main(sys.argv[1:]))"
    run = subprocess.run(
        [sys.executable, "-c", hidden, "verify", "bag"], cwd=small.folder, capture_output=True, text=True
    )
    assert (run.returncode, run.stderr) == (
        2,
        "btq verify: bag: a ROS 2 bag is read with rosbags; install it with pip install 'btq-lang[ros]'\n",
    )


def test_a_bag_of_another_tree_of_the_mission(verify: Verify) -> None:
    """Its nodes are numbered from its own root; the runs of the main tree in the same bag are of that."""
    text = "QualityReq rq : safety\n    Pick takes at most 10 ms\n" + MAIN.replace(
        "Action Pick\nA", "SubTree Hand\nA", 1
    )
    text += "BehaviorTree Hand\n    ->\n        Action Pick\n        Action Hold\nAction Hold\n"
    (verify.folder / "main.btq").write_text(text, encoding="utf-8")
    hand = {1: "Sequence", 2: "Pick", 3: "Hold"}
    of_main = {1: "Sequence", 2: "Move", 3: "Hand", 4: "Sequence", 5: "Pick", 6: "Hold"}
    messages = tree_log(rows("0 1R 2R 20 2S 3R 24 3S 1S 2I 3I 1I"), hand)
    whole = rows("100 1R 2S 3R 4R 5R 104 5S 6S 4S 3S 1S 5I 6I 4I 2I 3I 1I")
    write_bag(verify.folder / "bag", [*messages, *tree_log(whole, of_main)])
    found = verify.json("bag", "--mission", "main.btq")
    assert [(each["runs"], each["identity"]) for each in found["sources"]] == [
        (1, "tree Hand, as built now"),
        (1, "as built now"),
    ]
    assert clause(found) == (2, [1])


def test_a_bag_with_other_names_says_which(small: Verify) -> None:
    write_bag(small.folder / "bag", tree_log(rows(TWO_RUNS), {**NAMES, 3: "Reach"}))
    document = small.json("bag", "--mission", "main.btq")
    assert list(violations(document, SCHEMA)) == []
    (source, _) = document["sources"]
    assert source["unjoined"] == ["node 3 is `Reach` in the log and `Pick` in the mission"]
    assert (small.code, small.errors.splitlines()[-1]) == (
        2,
        "btq verify: no log matches main.btq: node 3 is `Reach` in the log and `Pick` in the mission",
    )
