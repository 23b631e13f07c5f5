"""How long something took is said where the log says it; else between which limits, and never that it took no time."""

from __future__ import annotations

import json

import pytest
from evidence_logs import MAIN, MAIN_XML, Verify, btlog, rows

from btq_lang.evidence.json_document import read_verdicts
from btq_lang.evidence.verdicts import Bounded

MISSION = "QualityReq rq : safety\n    Pick takes at most 1 s\n" + MAIN


@pytest.fixture
def judge(verify: Verify) -> Verify:
    (verify.folder / "main.btq").write_text(MISSION, encoding="utf-8")
    return verify


@pytest.mark.parametrize(
    ("log", "took"),
    [
        pytest.param("1R 2S 5 3R 10 3S 1S", "10 ms", id="its parent goes on to it at once"),
        pytest.param("1R 2R 5 2S 10 3S 1S", "at most 5 ms", id="it leaves one row"),
        pytest.param("1R 2R 5 2S 10 3R 20 3S 1S", "10 ms to 15 ms", id="it leaves two rows"),
        pytest.param("3S 1S", "an unknown time", id="nothing is known before its row"),
        pytest.param("3R 7 3S 1S", "at least 7 ms", id="nothing is known before its rows"),
        pytest.param("1R 2S 3S 1S", "", id="the log shows no time"),
    ],
)
def test_a_step_of_a_run(log: str, took: str, judge: Verify) -> None:
    (judge.folder / "run.btlog").write_bytes(btlog(MAIN_XML, rows(log)))
    found = json.loads(judge.text("run.btlog", "--mission", "main.btq", "--run", "1"))
    (step,) = (each for each in found["steps"] if each["path"] == "Pick::3" and each["state"] == "succeeded")
    assert step["took"] == took


def test_verdicts_that_are_read_again_have_their_limits(judge: Verify) -> None:
    (judge.folder / "run.btlog").write_bytes(btlog(MAIN_XML, rows("1R 2R 5 2S 10 3S 1S")))
    (mission,) = read_verdicts(judge.text("run.btlog", "--mission", "main.btq", "--format", "json"))
    ((clause,),) = (each.clauses for each in mission.requirements)
    assert (clause.worst, clause.bounded) == (None, Bounded(1, 0.005, "5 ms"))
