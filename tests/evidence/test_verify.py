"""`btq verify` as a person runs it, on logs that the real engine wrote, held against what the simulated skills did."""

from __future__ import annotations

import json
import os
import shutil
import struct
from collections import defaultdict
from pathlib import Path
from typing import Any

import pytest
from in_process import run_btq
from json_schema import violations

HERE = Path(__file__).parent
SCHEMA = json.loads((HERE.parents[1] / "btq_lang" / "evidence" / "verdicts.schema.json").read_text(encoding="utf-8"))
LOGS = ("lab.btlog", "lab.db3")
PICKS, PLACES = (10, 18), (11, 19)  # the uids of the two instances


NO_MISSION = "no mission found; name one with --mission FILE, a .btq file or XML, or make one with btq import LOG"
SPECIAL = "cannot be read: expected a regular file, found a pipe or a device"


@pytest.fixture
def lab(shared: Path, tmp_path: Path) -> Path:
    """A folder with the mission and its logs."""
    for name in (*LOGS, "lab.battery.csv"):
        shutil.copy(shared / "logs" / name, tmp_path)
    shutil.copy(HERE / "lab.btq", tmp_path)
    return tmp_path


def btq(folder: Path, *arguments: str) -> tuple[int, str, str]:
    """How btq ends, and what it prints."""
    return run_btq(*arguments, cwd=folder)


def verdicts(folder: Path, log: str, *more: str) -> dict[str, Any]:
    code, output, errors = btq(folder, "verify", log, "--mission", "lab.btq", "--format", "json", *more)
    assert (code, errors) == (1, "")
    found: dict[str, Any] = json.loads(output)
    assert list(violations(found, SCHEMA)) == []
    return found


@pytest.mark.parametrize("jobs", ["1", "2"])
def test_a_copy_of_a_log_counts_once(jobs: str, lab: Path) -> None:
    """Of a log with the same bytes nothing is read, and of one with nearly the same the runs do not count again."""
    log = (lab / "lab.btlog").read_bytes()
    (lab / "again.btlog").write_bytes(log)
    (lab / "other.btlog").write_bytes(log[:-1] + bytes([log[-1] ^ 1]))
    logs = ("again.btlog", "lab.btlog", "other.btlog")
    code, output, errors = btq(lab, "verify", *logs, "--mission", "lab.btq", "--jobs", jobs)
    assert (code, errors) == (1, "")
    lines = output.splitlines()
    assert [line.partition(",")[0] for line in lines[:4]] == [
        "0 runs in again.btlog",
        "201 runs in other.btlog",  # its last row, of the root, says something else
        "  note: lab.btlog is the same log as again.btlog",
        "  note: again.btlog: 200 of its 200 runs are in other.btlog too",
    ]


class Truth:
    """What the skills did: by uid, run (from 1), milliseconds and status of each activation; and the runs' outcomes."""

    def __init__(self, file: Path) -> None:
        self.activations: dict[int, list[tuple[int, float, str]]] = defaultdict(list)
        self.outcomes: list[str] = []
        for line in file.read_text(encoding="utf-8").splitlines():
            each = json.loads(line)
            if "node" in each:
                self.activations[each["uid"]].append((each["run"] + 1, each["ms"], each["status"]))
            else:
                self.outcomes.append(each["result"])

    def of(self, *uids: int) -> list[tuple[int, float, str]]:
        return sorted(each for uid in uids for each in self.activations[uid])


@pytest.mark.parametrize("log", LOGS)
def test_verdicts_are_what_the_skills_did(log: str, lab: Path, shared: Path) -> None:
    truth = Truth(shared / "logs" / "lab.truth.jsonl")
    found = verdicts(lab, log, "--signals", "lab.battery.csv")
    clause = {each["id"]: each["clauses"][0] for each in found["requirements"]}
    assert found["runs"] == len(truth.outcomes) == 200
    assert {each["id"]: each["verdict"] for each in found["requirements"]} == {
        "in_time": "violated",
        "way_home": "violated",
        "not_too_early": "violated",
        "reliable": "satisfied",
        "placed": "undecided",
        "picked": "satisfied",
        "swift": "satisfied",
        "ordered": "satisfied",
        "reviewed": "open",
    }

    drives = truth.of(4)
    late = [run for run, ms, _ in drives if ms > 280]
    assert (clause["in_time"]["counted"], clause["in_time"]["violated"]) == (len(drives), len(late))
    assert [each["run"] for each in clause["in_time"]["violations"]] == late
    slowest = max(drives, key=lambda each: each[1])
    assert clause["in_time"]["worst"]["run"] == slowest[0]
    assert 0 <= clause["in_time"]["worst"]["si"] - slowest[1] / 1000 < 0.05

    at_end = [json.loads(line) for line in (shared / "logs" / "lab.battery.truth.jsonl").read_text().splitlines()]
    arrived = [(each["run"] + 1, each["battery_at_end"]) for each in at_end if each["status"] == "SUCCESS"]
    assert clause["way_home"]["counted"] == len(arrived)
    broken = [(each["run"], each["measured"]) for each in clause["way_home"]["violations"]]
    assert broken == [(run, f"{battery:g} %") for run, battery in arrived if battery < 15]

    assert clause["reliable"]["counted"] == 200
    assert [each["run"] for each in clause["reliable"]["violations"]] == [
        run for run, outcome in enumerate(truth.outcomes, start=1) if outcome != "SUCCESS"
    ]
    placed = truth.of(*PLACES)
    failed = sorted({run for run, _, status in placed if status != "SUCCESS"})
    assert clause["placed"]["counted"] == len({run for run, *_ in placed})
    assert [each["run"] for each in clause["placed"]["violations"]] == failed
    picks = truth.of(*PICKS)
    assert clause["picked"]["counted"] == len(picks)
    assert clause["picked"]["violated"] == sum(status != "SUCCESS" for *_, status in picks)
    assert clause["picked"]["path"] == "PickPlate/Pick::10, PickTube/Pick::18"
    assert clause["ordered"]["counted"] == len(placed)
    tubes = truth.of(18)  # a path through a SubTree means that instance
    assert (clause["swift"]["counted"], clause["swift"]["path"]) == (len(tubes), "PickTube/Pick::18")


def test_what_is_needed_is_judged_by_the_last_sample_before_the_start(lab: Path, shared: Path) -> None:
    """The battery goes down by 2 with each drive to the charger, so the CSV has the level that Charge starts with."""
    clause = next(
        each["clauses"][0]
        for each in verdicts(lab, "lab.btlog", "--signals", "lab.battery.csv")["requirements"]
        if each["id"] == "not_too_early"
    )
    lines = (shared / "logs" / "lab.battery.csv").read_text().splitlines()[1:]
    levels = [float(line.split(",")[1]) for line in lines]
    # Only a drive to the charger takes 2 away.  Charge follows where that has succeeded: the level then is 100.
    starts = [
        now
        for before, now, then in zip(levels, levels[1:], levels[2:], strict=False)
        if (now, then) == (before - 2, 100)
    ]
    assert (clause["counted"], clause["violated"]) == (25, sum(level >= 17 for level in starts))


def test_both_readers_say_the_same(lab: Path) -> None:
    first, second = (verdicts(lab, log, "--signals", "lab.battery.csv") for log in LOGS)
    assert first["requirements"]
    assert plain(first["requirements"]) == plain(second["requirements"])


def plain(value: Any) -> Any:
    """Without what the two loggers write otherwise: their names, and times, which SqliteLogger makes increase by moving
    them by some µs, and what is rounded of these in the words of a chain."""
    if isinstance(value, dict):
        otherwise = ("source", "start", *(("text",) if "seconds" in value else ()))
        return {key: plain(each) for key, each in value.items() if key not in otherwise}
    if isinstance(value, list):
        return [plain(each) for each in value]
    return round(value, 3) if isinstance(value, float) else value


TABLE = """\
200 runs in lab.btlog, 2026-11-20 21:22–21:24 UTC, mission lab (as built now, 19 of 19 nodes)

  violated         in_time        Reach the charging station in time     MoveToCharger takes at most 280 ms                   4 of 26 activations, worst 331 ms in run 31
                   MoveToCharger: took 331 ms, bound 280 ms; its median is 233 ms (run 31 of lab.btlog, 331 ms after its start at 2026-11-20 21:22:35.757 UTC)
  violated         way_home       Arrive with some battery left          MoveToStation leaves battery >= 15 %                 1 of 169 activations, worst 8 % in run 157, 6 that failed were not counted
                   MoveToStation: `battery` was 8 % at the end, bound 15 %; sampled just before, while MoveToStation ran; MoveToCharger had failed before in this run (run 157 of lab.btlog, 411 ms after its start at 2026-11-20 21:23:38.092 UTC)
  violated         not_too_early  Charge when that is needed             Charge needs battery < 17 %                          2 of 25 activations, worst 17.5 % in run 99
                   Charge::5: `battery` was 17.5 % at the start, bound 17 %; sampled just before, while MoveToCharger ran (run 99 of lab.btlog, 206 ms after its start at 2026-11-20 21:23:11.036 UTC)
  satisfied        reliable       The mission succeeds nearly always     mission succeeds in at least 80 % of runs            186 of 200, at least 89.3 % with confidence 95 %
  satisfied        picked         Picking rarely fails                   every Pick succeeds in at least 90 % of activations  583 of 616, 94.6 %; limits 92.9 % to 96.1 % with confidence 95 % each
  satisfied        swift          The tubes are moved swiftly            PickTube/Pick takes at most 1 s                      held so far in 447 activations, worst 87 ms in run 136
  satisfied        ordered        Nothing is placed that was not picked  PickPlace/Place follows PickPlace/Pick succeeds      held so far in 583 activations
  undecided        placed         What was picked is placed              PickPlace/Place succeeds in at least 99 % of runs    159 of 162; 611 more without a violation decide it
  open             reviewed                                              mission takes at most 1 min                          verified by review

runs: 186 succeeded, 14 failed · failures began at PickPlate/Pick::10 (7), MoveToStation (6), PickPlate/Place::11 (1) · retries 419, at most 3 in run 1
nodes: exercised 19 of 19 · slowest: MoveToCharger p50 233 ms, p95 324 ms
"""  # noqa: E501  # as it is printed


def test_the_table(lab: Path) -> None:
    assert btq(lab, "verify", "lab.btlog", "--mission", "lab.btq", "--signals", "lab.battery.csv") == (1, TABLE, "")


def test_without_samples_what_needs_them_is_unknown(lab: Path) -> None:
    _, output, _ = btq(lab, "verify", "lab.btlog", "--mission", "lab.btq")
    (line,) = (line for line in output.splitlines() if "way_home" in line)
    assert line.startswith("  unknown          way_home")
    result = line.partition("battery >= 15 %")[2].split("  ")
    assert [each.strip() for each in result if each] == [
        "no samples of `battery` (169 of 169 activations)",
        "give them with --signals FILE",
    ]


def test_a_session_for_each_run(shared: Path, lab: Path) -> None:
    shutil.copy(shared / "logs" / "lab_sessions.db3", lab)
    truth = Truth(shared / "logs" / "lab_sessions.truth.jsonl")
    found = verdicts_of_sessions(lab)
    clause = {each["id"]: each["clauses"][0] for each in found["requirements"]}
    (source,) = found["sources"]
    assert (source["runs"], source["first_run"], source["joined"], source["nodes"]) == (20, 1, 19, 19)
    assert [each["run"] for each in clause["reliable"]["violations"]] == [
        run for run, outcome in enumerate(truth.outcomes, start=1) if outcome != "SUCCESS"
    ]
    assert clause["picked"]["counted"] == len(truth.of(*PICKS))


def verdicts_of_sessions(folder: Path) -> dict[str, Any]:
    _, output, errors = btq(folder, "verify", "lab_sessions.db3", "--mission", "lab.btq", "--format", "json")
    assert errors == ""
    found: dict[str, Any] = json.loads(output)
    return found


def test_the_mission_is_found_by_its_side_file(lab: Path, tmp_path: Path) -> None:
    """Seen from another folder, with nothing but the log."""
    assert btq(lab, "build", "lab.btq")[0] == 0
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    _, output, errors = btq(elsewhere, "verify", "../lab.btlog")
    assert errors == ""
    assert output.splitlines()[0].endswith("mission lab (side file matches, 19 of 19 nodes)")


@pytest.mark.parametrize("given", [(), ("--mission", "lab.xml")])
def test_a_robot_has_the_xml_and_the_side_file_alone(given: tuple[str, ...], lab: Path) -> None:
    assert btq(lab, "build", "lab.btq")[0] == 0
    (lab / "lab.btq").unlink()
    code, output, errors = btq(lab, "verify", "lab.btlog", "--signals", "lab.battery.csv", *given)
    assert (code, errors) == (1, "")
    assert output == TABLE.replace("as built now", "side file matches")


def test_runs_are_numbered_over_all_files(lab: Path) -> None:
    """The runs of the second log are an hour later."""
    data = (lab / "lab.btlog").read_bytes()
    start = 23 + struct.unpack_from("<i", data, 19)[0]
    later = struct.pack("<q", struct.unpack_from("<q", data, start)[0] + 3_600_000_000)
    (lab / "later.btlog").write_bytes(data[:start] + later + data[start + 8 :])
    logs = ("lab.btlog", "later.btlog", "lab.db3")
    code, output, _ = btq(lab, "verify", *logs, "--mission", "lab.btq", "--format", "json")
    assert code == 1
    found = json.loads(output)
    assert list(violations(found, SCHEMA)) == []
    assert [(each["file"], each["first_run"], each["runs"]) for each in found["sources"]] == [
        ("lab.btlog", 1, 200),
        ("later.btlog", 201, 200),
        ("lab.db3", 401, 0),
    ]
    late = found["requirements"][0]["clauses"][0]["violations"]
    assert [each["run"] for each in late[4:]] == [each["run"] + 200 for each in late[:4]]
    _, output, _ = btq(lab, "verify", ".")
    known = "mission lab (as built now, 19 of 19 nodes)"
    assert output.splitlines()[:4] == [
        f"200 runs in lab.btlog, 2026-11-20 21:22–21:24 UTC, {known}",
        f"0 runs in lab.db3, {known}",
        f"200 runs in later.btlog, numbered from 201, 2026-11-20 22:22–22:24 UTC, {known}",
        "  note: lab.db3: 200 of its 200 runs are in lab.btlog too, and not counted again",
    ]


def test_a_log_without_rows_to_idle_gives_the_same_verdicts(lab: Path) -> None:
    """As Nav2 writes them on demand; the laboratory halts nothing, so nothing becomes unknown."""
    whole = (lab / "lab.btlog").read_bytes()
    head = 31 + int.from_bytes(whole[19:23], "little")
    rows = [whole[at : at + 9] for at in range(head, len(whole), 9)]
    assert any(row[8] == 0 for row in rows)
    (lab / "noidle.btlog").write_bytes(whole[:head] + b"".join(row for row in rows if row[8] != 0))
    with_idle, without = (verdicts(lab, log, "--signals", "lab.battery.csv") for log in ("lab.btlog", "noidle.btlog"))
    assert plain(without["requirements"]) == plain(with_idle["requirements"])


@pytest.mark.parametrize(
    ("demands", "more", "code"),
    [
        ("MoveToCharger takes at most 1 s", (), 0),
        ("MoveToCharger takes at most 1 s", ("--strict",), 0),
        ("MoveToCharger takes at most 280 ms", (), 1),
        ("MoveToStation leaves battery >= 15 %", (), 0),
        ("MoveToStation leaves battery >= 15 %", ("--strict",), 1),
        ("mission succeeds in at least 94 % of runs confidence 95 %", (), 0),
        ("mission succeeds in at least 94 % of runs confidence 95 %", ("--strict",), 1),
    ],
)
def test_exit_codes(demands: str, more: tuple[str, ...], code: int, lab: Path) -> None:
    text = (lab / "lab.btq").read_text(encoding="utf-8")
    before, _, rest = text.partition("QualityReq in_time")
    tree = rest[rest.index("BehaviorTree mainTree") :]
    (lab / "lab.btq").write_text(f"{before}QualityReq rq : reliability\n    {demands}\n{tree}", encoding="utf-8")
    assert btq(lab, "verify", "lab.btlog", "--mission", "lab.btq", *more)[0] == code


@pytest.mark.parametrize(
    ("arguments", "error"),
    [
        (("none.btlog",), "btq verify: none.btlog: cannot be read: No such file or directory\n"),
        (("",), "btq verify: empty path; `.` is this folder\n"),
        (("folder",), "btq verify: no .btlog, .db3, .btdb or .mcap below folder\n"),
        (("lab.btlog", "--mission", "none.btq"), "btq verify: none.btq: cannot be read: No such file or directory\n"),
        (("lab.btlog", "--signals", "none.csv"), "btq verify: none.csv: cannot be read: No such file or directory\n"),
        (("lab.btlog", "--mission", "folder"), f"btq verify: {NO_MISSION}\n"),
        (("pipe", "--signals", "pipe"), f"btq verify: pipe: {SPECIAL}\n" * 2),
        (("empty.btlog",), "btq verify: no run in any log, so there is nothing to judge\n"),
    ],
)
def test_what_cannot_be_done(arguments: tuple[str, ...], error: str, lab: Path) -> None:
    (lab / "folder").mkdir()
    os.mkfifo(lab / "pipe")
    whole = (lab / "lab.btlog").read_bytes()
    (lab / "empty.btlog").write_bytes(whole[: 31 + int.from_bytes(whole[19:23], "little")])
    code, _, errors = btq(lab, "verify", *arguments)
    assert (code, errors) == (2, error)


def test_what_a_mission_lacks_of_the_log_is_told(lab: Path) -> None:
    (lab / "other.btq").write_text("BehaviorTree Other\n    ->\n        Go\n", encoding="utf-8")
    code, _, errors = btq(lab, "verify", "lab.btlog", "--mission", "other.btq")
    assert (code, errors.splitlines()) == (
        2,
        [
            "btq verify: lab.btlog: 200 runs of another mission, not judged",
            "btq verify: no log matches other.btq: other has 0 of the 19 nodes in the log; "
            "the first that it does not have is `Mission`",
        ],
    )


def test_columns_that_nothing_reads_are_named(lab: Path) -> None:
    text = (lab / "lab.battery.csv").read_text(encoding="utf-8")
    head, _, rows = text.partition("\n")
    (lab / "wrong.csv").write_text(f"{head.replace('battery', 'batery')},zebra\n{rows}", encoding="utf-8")
    given = ("verify", "lab.btlog", "--mission", "lab.btq", "--signals", "wrong.csv")
    _, _, errors = btq(lab, *given, "--format", "csv")
    why = "is ignored, because no signal or entry has this name"
    assert errors.splitlines() == [
        f"btq verify: wrong.csv: column `batery` {why}; did you mean `battery`?",
        f"btq verify: wrong.csv: column `zebra` {why}",
    ]
    _, output, errors = btq(lab, *given)
    assert (output.splitlines()[2], errors) == (f"  note: wrong.csv: column `zebra` {why}", "")


@pytest.mark.parametrize("wrong", ["takes at most 280 sek", "runs at most 5 times"])
def test_a_mission_with_errors_may_lack_clauses(wrong: str, lab: Path) -> None:
    text = (lab / "lab.btq").read_text(encoding="utf-8")
    (lab / "lab.btq").write_text(text.replace("takes at most 280 ms", wrong), encoding="utf-8")
    code, output, errors = btq(lab, "verify", "lab.btlog", "--mission", "lab.btq")
    assert (code, errors) == (2, "btq verify: lab.btq has errors, so clauses may be missing; run btq check\n")
    in_time = next(line for line in output.splitlines() if " in_time " in line)
    assert in_time.startswith("  unknown ")
    assert in_time.endswith("  it has a mistake; run btq check")
    assert "reliable" in output


def test_xml_is_a_mission_too(lab: Path, shared: Path) -> None:
    shutil.copy(shared / "logs" / "lab.xml", lab)
    code, output, errors = btq(lab, "verify", "lab.btlog", "--mission", "lab.xml")
    assert (code, errors) == (0, "")
    assert output.splitlines()[:3] == [
        "200 runs in lab.btlog, 2026-11-20 21:22–21:24 UTC, mission lab (as built now, 19 of 19 nodes)",
        "",
        "  no requirement to judge",
    ]


def test_certainty_that_no_number_of_runs_can_show(lab: Path) -> None:
    text = (lab / "lab.btq").read_text(encoding="utf-8")
    before, _, rest = text.partition("QualityReq in_time")
    demand = "PickTube/Pick takes at most 1 s in at least 100 % of runs confidence 95 %"
    tree = rest[rest.index("BehaviorTree mainTree") :]
    (lab / "lab.btq").write_text(f"{before}QualityReq rq : reliability\n    {demand}\n{tree}", encoding="utf-8")
    _, output, _ = btq(lab, "verify", "lab.btlog", "--mission", "lab.btq")
    (line,) = (line for line in output.splitlines() if "undecided" in line)
    assert line.endswith("; no number of further runs can decide it")


def test_colours_are_for_terminals(lab: Path) -> None:
    _, output, _ = btq(lab, "verify", "lab.btlog", "--mission", "lab.btq", "--color", "always")
    assert "\x1b[1;31mviolated       \x1b[0m  in_time" in output
    assert "\x1b" not in btq(lab, "verify", "lab.btlog", "--mission", "lab.btq")[1]


def test_names_with_braces_are_no_patterns(lab: Path) -> None:
    text = (lab / "lab.btq").read_text(encoding="utf-8")
    (lab / "lab.btq").write_text(text.replace("QualityReq in_time", 'QualityReq "{0} {x}"'), encoding="utf-8")
    code, output, errors = btq(lab, "verify", "lab.btlog", "--mission", "lab.btq")
    assert (code, errors) == (1, "")
    assert "  violated         {0} {x}" in output
