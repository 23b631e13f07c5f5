"""A thousand logs are reported in a few lines."""

from __future__ import annotations

import pytest
from evidence_logs import MAIN, MAIN_XML, START, Verify, btlog, rows

DEMAND = "QualityReq rq : safety\n    Move takes at most 6 ms\n"
RUN = "0 1R 2R 5 2S 3S 1S"


@pytest.fixture
def many(verify: Verify) -> Verify:
    """A folder with a mission and forty logs of it, of which nine are cut, each elsewhere."""
    (verify.folder / "main.btq").write_text(f"{DEMAND}{MAIN}", encoding="utf-8")
    for number in range(40):
        log = btlog(MAIN_XML, rows(RUN), START + number * 10**6)
        (verify.folder / f"{number:02}.btlog").write_bytes(log[: -(number % 10) or None] if number < 10 else log)
    return verify


def test_the_table_has_one_line_for_all(many: Verify) -> None:
    cut = "01.btlog: cut off: the last 8 bytes are not a whole transition and are left out"
    assert many.text(".").splitlines() == [
        "40 runs in 40 logs, 00.btlog to 39.btlog, 2026-11-20 21:22 UTC, mission main (as built now, 3 of 3 nodes)",
        f"  note: {cut} (and 7 more like this)",
        "",
        "  satisfied        rq  Move takes at most 6 ms  held so far in 40 activations, worst 5 ms in run 1",
        "",
        "runs: 31 succeeded, 9 interrupted",
        "nodes: exercised 3 of 3 · slowest: Move::2 p50 5 ms, p95 5 ms",
    ]
    assert (many.code, many.errors) == (0, "")


def test_programs_are_given_all(many: Verify) -> None:
    found = many.json(".")
    assert len(found["sources"]) == 40
    assert sum(bool(each["remarks"]) for each in found["sources"]) == 8


def test_other_formats_name_the_first_and_the_last(many: Verify) -> None:
    assert "40 runs in `40 logs, 00.btlog to 39.btlog`: 31 succeeded" in many.text(".", "--format", "markdown")
    assert "<p>40 runs in 40 logs, 00.btlog to 39.btlog: 31 succeeded" in many.text(".", "--format", "html")


def test_few_logs_are_listed_one_by_one(many: Verify) -> None:
    lines = many.text(*(f"{number}.btlog" for number in range(10, 15))).splitlines()
    assert [line.partition(",")[0] for line in lines[:5]] == [f"1 run in {number}.btlog" for number in range(10, 15)]


def test_copies(many: Verify) -> None:
    for number in range(10):
        (many.folder / f"copy{number}.btlog").write_bytes((many.folder / "20.btlog").read_bytes())
    lines = many.text(".").splitlines()
    copied = "  note: copy0.btlog is the same log as 20.btlog, so it is not counted (and 9 more like this)"
    assert lines[2:4] == [copied, ""]


def test_errors(many: Verify) -> None:
    for number in range(40, 50):
        (many.folder / f"{number}.btlog").write_bytes(b"BTCPP4-FileLogger2"[: number - 39])
    many.text(".")
    assert many.code == 2
    assert many.errors.startswith("btq verify: 40.btlog: expected a BehaviorTree.CPP log (.btlog from FileLogger2, ")
    assert many.errors.endswith(" (and 9 more like this)\n")


def test_logs_of_other_missions(many: Verify) -> None:
    (many.folder / "main.btq").write_text("Root Other\nBehaviorTree Other\n    Action Fly\n", encoding="utf-8")
    many.text(".")
    assert many.errors.splitlines() == [
        "btq verify: 00.btlog: 1 run of another mission, not judged (and 39 more like this)",
        "btq verify: no log matches a known mission; name the mission with --mission FILE;"
        " btq import 00.btlog writes its tree as one",
    ]
