"""Status changes to activations and runs: the logs of the real engine, and what such logs have beside the usual."""

from __future__ import annotations

import json
import re
from collections import defaultdict
from itertools import pairwise
from pathlib import Path

import pytest
from evidence_logs import MAIN_XML, START, btlog, rows, sessions_of, write_db3
from hypothesis import given
from hypothesis import strategies as st

from btq_lang.evidence.model import GAP, PAUSE, Activation, LoggedTree, LogSession
from btq_lang.evidence.runs import activations

FILES = ("lab.btlog", "lab.db3", "lab_sessions.db3", "nav.btlog", "nav.db3", "nav_noidle.btlog", "nav_noidle.db3")
OUTCOMES = {"SUCCESS": "S", "FAILURE": "F", "HALTED": "H"}
UNWRITTEN = "halts without a row of their own, so only the latest possible end is known"
TICKS = 0.05  # s: a tick, or a pause of the machine, between what a skill did and its row


def runs_of(path: Path) -> tuple[list[list[Activation]], list[str]]:
    """The activations of each run, the root's last; and what is to be said of the file."""
    found: list[list[Activation]] = [[]]
    remarks: list[str] = []
    for session in sessions_of(path):
        for each in activations(session):
            found[-1].append(each)
            if each.uid == 1:
                found.append([])
        remarks += session.remarks
    assert found.pop() == []
    return found, remarks


@pytest.mark.parametrize("name", FILES)
def test_every_activation_and_run_is_what_the_skills_did(name: str, shared: Path) -> None:
    skills: dict[tuple[int, int], list[tuple[str, float]]] = defaultdict(list)
    outcomes: list[tuple[str, float]] = []
    for line in (shared / "logs" / f"{name.partition('.')[0]}.truth.jsonl").read_text(encoding="utf-8").splitlines():
        each = json.loads(line)
        if "node" in each:
            skills[each["run"], each["uid"]].append((OUTCOMES[each["status"]], each["ms"] / 1000))
        else:
            outcomes.append((OUTCOMES[each["result"]], each["ms"] / 1000))
    found, _ = runs_of(shared / "logs" / name)
    assert [run[-1].outcome for run in found] == [outcome for outcome, _ in outcomes]
    for run, (_, seconds) in zip(found, outcomes, strict=True):
        assert abs(run[-1].seconds - seconds) < 0.001
    logged: dict[tuple[int, int], list[Activation]] = defaultdict(list)
    uids = {uid for _, uid in skills}
    for number, run in enumerate(found):
        for activation in run:
            if activation.uid in uids:
                logged[number, activation.uid].append(activation)
    assert {key: [each.outcome for each in value] for key, value in logged.items()} == {
        key: [outcome for outcome, _ in value] for key, value in skills.items()
    }
    for key, value in skills.items():
        for activation, (_, seconds) in zip(logged[key], value, strict=True):
            if activation.timing == "exact":
                assert 0 <= activation.seconds - seconds < TICKS
            else:  # it was halted, and nothing in the log says when
                assert activation.seconds >= seconds


def test_a_log_without_rows_to_idle_says_so_once(shared: Path) -> None:
    _, remarks = runs_of(shared / "logs" / "nav_noidle.btlog")
    (remark,) = remarks
    assert remark == f"{UNWRITTEN}: 37, the first at 2026-11-24T04:28:14.486703Z"
    assert runs_of(shared / "logs" / "nav.btlog")[1] == []


def made(text: str, folder: Path) -> tuple[list[str], list[str]]:
    """What comes of rows, the same through both readers: uid, begin, end (ms) and outcome of each activation, with `?`
    where the end is known only at the latest, `!` where the clock was set back; and the remarks."""
    (folder / "made.btlog").write_bytes(btlog(MAIN_XML, rows(text)))
    write_db3(folder / "made.db3", MAIN_XML, [rows(text)])
    both = []
    for name in ("made.btlog", "made.db3"):
        sessions = sessions_of(folder / name)
        session = next(sessions)
        marks = {"exact": "", "latest": "?", "broken": "!"}
        both.append(
            [
                f"{each.uid} {(each.begin - START) // 1000}-{(each.end - START) // 1000} {each.outcome}"
                f"{marks[each.timing]}"
                for each in activations(session)
            ]
        )
        remarks = [remark.rpartition(", the first")[0] for remark in session.remarks]
    assert both[0] == both[1]
    return both[0], remarks


@pytest.mark.parametrize(
    ("text", "activations"),
    [
        pytest.param("0 1R 2R 5 2S 3R 9 3F 2I 3I 1F 1I", ["2 0-5 S", "3 5-9 F", "1 0-9 F"], id="as usual"),
        pytest.param("0 1R 2R 5 2I 1I", ["2 0-5 H", "1 0-5 H"], id="halted"),
        pytest.param("0 1R 2S 3S 1S 2I 3I 1I", ["2 0-0 S", "3 0-0 S", "1 0-0 S"], id="synchronous"),
        pytest.param("0 1R 2R 5 2S 2R 8 2F 1F", ["2 0-5 S", "2 5-8 F", "1 0-8 F"], id="started again without a reset"),
        pytest.param("0 1R 2R 5 2I 2S 3S 1S", ["2 0-5 S", "3 5-5 S", "1 0-5 S"], id="IDLE, then its own result"),
        pytest.param(
            "0 1R 2R 5 2I 8 2S 1S", ["2 0-5 H", "2 8-8 S", "1 0-8 S"], id="IDLE, and a result of another tick"
        ),
        pytest.param("0 1R 2S 5 3R 9 3S 1I 1S", ["2 0-0 S", "3 0-9 S", "1 0-9 S"], id="so does the root"),
        pytest.param("0 2R 1R 5 2S 1S", ["2 0-5 S", "1 0-5 S"], id="children first"),
        pytest.param("0 2S 3R 4 1R 5 3S 1S", ["2 0-0 S", "3 0-5 S", "1 0-5 S"], id="children first, the row later"),
        pytest.param("0 2R 5 2S 1S", ["2 0-5 S", "1 0-5 S"], id="a result alone"),
        pytest.param("0 1R 2R 5 2S 1S 7 1R 2R 9 2F 1F", ["2 0-5 S", "1 0-5 S", "2 7-9 F", "1 7-9 F"], id="two runs"),
        pytest.param("0 1R 2R 5 1F 1I", ["2 0-5 H?", "1 0-5 F"], id="an ancestor ends"),
        pytest.param("0 1R 2R 5 2R 9 2S 1S", ["2 0-5 H?", "2 5-9 S", "1 0-9 S"], id="RUNNING on an open node"),
        pytest.param("0 1R 2R 5 2S 3R", ["2 0-5 S", "3 5-5 O", "1 0-5 O"], id="cut off"),
        pytest.param("0 1R 2R 5 2S 9 1R 2R 12 2S 1S", ["2 0-5 S", "1 0-5 O", "2 9-12 S", "1 9-12 S"], id="interrupted"),
        pytest.param("1 2I 3I 1I 5 1R 2S 1S", ["2 5-5 S", "1 5-5 S"], id="resets"),
        pytest.param("0 2R 5 2S 1I", ["2 0-5 S", "1 0-5 O"], id="a run without a row of the root"),
        pytest.param("", [], id="nothing"),
    ],
)
def test_what_logs_have_beside_the_usual(text: str, activations: list[str], tmp_path: Path) -> None:
    assert made(text, tmp_path)[0] == activations


def test_rows_of_nodes_that_the_tree_lacks_are_reported_once(tmp_path: Path) -> None:
    found, remarks = made("0 1R 2R 3 7R 8S 5 2S 1S", tmp_path)
    left_out = "rows with an unknown node or status, left out: 2"
    assert (found, remarks) == (["2 0-5 S", "1 0-5 S"], [left_out])


def test_durations_across_a_clock_that_was_set_back_are_unknown(tmp_path: Path) -> None:
    (tmp_path / "a.btlog").write_bytes(btlog(MAIN_XML, [*rows("9 1R 2R"), *rows("5 2S 6 3R 8 3S 1S")]))
    sessions = sessions_of(tmp_path / "a.btlog")
    session = next(sessions)
    found = [(each.uid, each.outcome, each.timing) for each in activations(session)]
    assert found == [(2, "S", "broken"), (3, "S", "exact"), (1, "S", "broken")]
    assert session.remarks == [
        "rows earlier than the row before them, so durations across them are unknown: 1, "
        "the first at 2026-11-20T21:22:20.005000Z"
    ]


# 1 has the children 2 and 4, 2 has the child 3.
TREE = LoggedTree([(uid, "N", f"N::{uid}", parent) for uid, parent in enumerate((0, 1, 2, 1), 1)])
ANY_ROWS = st.lists(st.tuples(st.integers(0, 3000), st.integers(1, 4), st.integers(0, 3)), max_size=40)


@given(ANY_ROWS)
def test_whatever_rows_there_are(steps: list[tuple[int, int, int]]) -> None:
    """Each result is one activation, those of a node follow each other, and those of a run are within it."""
    time = 0
    transitions = []
    for step, uid, status in steps:
        time += step
        transitions.append((time, uid, status))
    found = [*activations(LogSession(TREE, iter(transitions)))]
    for uid in TREE.nodes:
        own = [each for each in found if each.uid == uid]
        results = [status for _, each, status in transitions if each == uid and status in (2, 3)]
        assert [each.outcome for each in own if each.outcome in ("S", "F")] == ["IRSF"[status] for status in results]
        assert all(before.end <= after.begin for before, after in pairwise(own))
    assert all(each.begin <= each.end for each in found)
    waiting: list[Activation] = []
    for each in found:
        waiting.append(each)
        if each.uid == 1:
            assert all(each.begin <= inside.begin and inside.end <= each.end for inside in waiting)
            waiting.clear()
    assert waiting == []


def seen(text: str) -> str:
    """The activations of a running robot, in ms; `G` in the text is a gap, `P` a pause."""
    found: list[tuple[int, int, int]] = []
    for piece in re.split("([GP])", text):
        at = found[-1][0] if found else 0
        found += [(at, GAP if piece == "G" else PAUSE, 0)] if piece in ("G", "P") else rows(piece)
    session = LogSession(LoggedTree([(1, "Sequence", "S", 0), (2, "A", "A", 1), (3, "B", "B", 1)]), iter(found))
    kinds = [
        f"{each.uid}{each.outcome} {each.begin / 1000:g}..{each.end / 1000:g} {each.timing}"
        for each in activations(session)
    ]
    assert session.remarks == []
    return ", ".join(kinds)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("G 5 2S 3R 8 3S 1S 1I", "2S 5..5 late, 3S 5..8 exact, 1S 5..8 late"),
        ("G 5 2I 1I 6 1R 2R 8 2S 1S", "2S 6..8 exact, 1S 6..8 exact"),
        ("G 5 2R 6 1R 8 2S 1S", "2S 5..8 exact, 1S 5..8 exact"),  # children first
        ("G 5 1R 6 2S 1S", "2S 5..6 exact, 1S 5..6 exact"),
        ("G 5 1F", "1F 5..5 late"),
        ("G 5 2R", "2O 5..5 exact, 1O 5..5 late"),
        ("1R 2R 3 G 9 3R", "2O 0..0 exact, 1O 0..0 lost, 3O 9..9 exact, 1O 9..9 late"),
        ("1R 2R G 9 2S 1S", "2O 0..0 exact, 1O 0..0 lost, 2S 9..9 late, 1S 9..9 late"),
        ("G 1 2R 2 G 9 1R", "2O 1..1 exact, 1O 1..1 part, 1O 9..9 exact"),
        ("1R 1S 1I G G 9 1R 1S", "1S 0..0 exact, 1S 9..9 exact"),
        ("1R 5 1I P 9 1R", "1H 0..5 exact, 1O 9..9 exact"),
    ],
)
def test_what_was_not_seen_is_neither_begin_nor_end(text: str, expected: str) -> None:
    assert seen(text) == expected
