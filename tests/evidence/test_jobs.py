"""Logs judged by themselves and added up, in one process and in several."""

from __future__ import annotations

import os
import pickle
import shutil
from concurrent.futures import process
from pathlib import Path

import pytest
from in_process import run_btq
from random_runs import Case, case
from seeds import seeds, share_of

from btq_lang.evidence import judging
from btq_lang.evidence.evaluate import LogFindings, MissionEvaluation
from btq_lang.evidence.judging import JudgedLog, Means, judge
from btq_lang.evidence.model import LogSession
from btq_lang.evidence.verdicts import MissionVerdicts
from btq_lang.util import processes
from btq_lang.util.record import replace

HERE = Path(__file__).parent


def together(made: Case) -> MissionVerdicts:
    """All sessions judged one after the other."""
    evaluation = MissionEvaluation(made.mission, with_timelines=True)
    runs = 0
    for number, rows in enumerate(made.sessions):
        session = LogSession(made.joined.tree, iter(rows))
        runs += evaluation.read(session, made.joined, made.series, runs + 1, f"log {number}")
    return evaluation.result()


def added(made: Case) -> MissionVerdicts:
    """Each session judged by itself, as if by a process of its own, and all added up."""
    evaluation = MissionEvaluation(made.mission, with_timelines=True)
    runs = 0
    for number, rows in enumerate(made.sessions):
        one = MissionEvaluation(made.mission, with_timelines=True)
        read = one.read(LogSession(made.joined.tree, iter(rows)), made.joined, made.series, 1, f"log {number}")
        findings: LogFindings = pickle.loads(pickle.dumps(one.findings))
        evaluation.findings.add(findings, runs)
        runs += read
    return evaluation.result()


def without_remarks(found: MissionVerdicts) -> MissionVerdicts:
    """Whether a node ever waits is a remark of the sessions judged so far."""
    return replace(found, sources=tuple(replace(each, remarks=()) for each in found.sources))


def test_sessions_that_are_added_up_have_the_verdicts_of_all() -> None:
    several = 0
    for seed in share_of(seeds(200), 2):
        made = case(seed)
        several += len(made.sessions) > 1
        assert without_remarks(added(made)) == without_remarks(together(made)), f"seed {seed}"
    assert several > 10


@pytest.fixture
def logs(shared: Path, tmp_path: Path) -> Path:
    """A folder with a mission, five logs, one of them cut, and one that is none."""
    data = (shared / "logs" / "lab.btlog").read_bytes()
    shutil.copy(HERE / "lab.btq", tmp_path)
    shutil.copy(shared / "logs" / "lab.db3", tmp_path)
    for number, size in enumerate((len(data), len(data) // 2, len(data) // 3, len(data) // 5)):
        (tmp_path / f"{number}.btlog").write_bytes(data[:size])
    (tmp_path / "2a.btlog").write_bytes(b"no log")
    return tmp_path


@pytest.mark.parametrize("form", ["table", "json", "csv", "junit", "markdown", "html"])
def test_several_processes_print_what_one_does(form: str, logs: Path) -> None:
    one = run_btq("verify", ".", "--mission", "lab.btq", "--format", form, cwd=logs)
    assert one[0] == 2
    assert one[1].strip()
    assert one[2].endswith("btq verify: 2a.btlog: " + one[2].rpartition("2a.btlog: ")[2])
    assert run_btq("verify", ".", "--mission", "lab.btq", "--format", form, "--jobs", "3", cwd=logs) == one


def test_processes_that_share_no_memory(logs: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(processes, "START", "spawn")
    one = run_btq("verify", "0.btlog", "1.btlog", "--mission", "lab.btq", cwd=logs)
    assert one[0] == 1
    assert run_btq("verify", "0.btlog", "1.btlog", "--mission", "lab.btq", "--jobs", "2", cwd=logs) == one


def test_where_there_are_no_processes_one_does_it_all(logs: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As in a browser, where Python finds that it has no semaphores."""
    one = run_btq("verify", "0.btlog", "1.btlog", "--mission", "lab.btq", cwd=logs)
    monkeypatch.setattr(process, "_system_limits_checked", True)
    monkeypatch.setattr(process, "_system_limited", "no semaphores")
    assert run_btq("verify", "0.btlog", "1.btlog", "--mission", "lab.btq", "--jobs", "2", cwd=logs) == one


def dies(log: str, means: Means) -> JudgedLog:
    if log.endswith("1.btlog"):
        os._exit(9)
    return judge(log, means)


def test_a_process_that_is_ended_is_a_problem(logs: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(judging, "judge", dies)
    code, _, errors = run_btq("verify", "0.btlog", "1.btlog", "--mission", "lab.btq", "--jobs", "2", cwd=logs)
    problem = "btq verify: a process that judges logs was ended from outside, perhaps for lack of memory\n"
    assert (code, errors[-len(problem) :]) == (2, problem)


def test_a_number_of_processes_is_expected(tmp_path: Path) -> None:
    assert run_btq("verify", "a.btlog", "--jobs", "0", cwd=tmp_path) == (
        2,
        "",
        "btq verify: --jobs 0: expected a number of processes\n",
    )
