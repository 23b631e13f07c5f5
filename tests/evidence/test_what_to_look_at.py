"""The line below a violated clause, for each verb: what to look at.

The mission is that of `test_run_verbs`: Task runs Move, then Pick; Alarm runs beside it.
"""

from __future__ import annotations

import pytest
from evidence_logs import Verify, samples
from test_run_verbs import LEVEL, STOPPED, TWICE, clause

from btq_lang.catalog.verbs import POOLED, VERBS

LINES: list[tuple[str, str, str, str]] = [  # verb, demand, runs, line
    (
        "takes",
        "Move takes at most 9 ms",
        TWICE,
        "Move::3: took 10 ms, bound 9 ms; its median is 10 ms",
    ),
    (
        "takes",
        "Task takes at most 9 ms",
        TWICE,
        "Task: took 50 ms, bound 9 ms; Move::3 ran 20 ms of it in 2 starts, 1 of them failed",
    ),
    (
        "succeeds",
        "Move succeeds",
        TWICE,
        "Move::3: failed; it ran 10 ms",
    ),
    (
        "succeeds",
        "Pick succeeds",
        "1R 2R 3R 20 3S 25 4F 2F 1F",
        "Pick::4: failed; it ran at most 5 ms",
    ),
    (
        "needs",
        "Move needs battery >= 60 %",
        TWICE,
        "Move::3: `battery` was 50 % at the start, bound 60 %; sampled 1 ms before",
    ),
    (
        "keeps",
        "Move keeps battery >= 60 %",
        TWICE,
        "Move::3: `battery` was 50 %, bound 60 %; sampled 1 ms before",
    ),
    (
        "keeps",
        "Task keeps battery >= 60 % from Move fails until Pick starts",
        TWICE,
        "Task: `battery` was 50 %, bound 60 %; `battery` was sampled 11 ms before",
    ),
    (
        "never",
        "Task never low from Pick starts until Pick finishes",
        TWICE,
        "Task: `battery` was 10 %, bound 20 %; `battery` was sampled just before, while Pick::4 ran",
    ),
    (
        "never",
        "Pick never battery < 20 %",
        TWICE,
        "Pick::4: `battery` was 10 %, bound 20 %;"
        " sampled just before, while Pick::4 ran; Move::3 had failed before in this run",
    ),
    (
        "keeps of time",
        "Move keeps battery >= 60 % in at least 20 % of time",
        TWICE,
        "Move::3: `battery >= 60 %` held in 0 % of the time, bound 20 %;"
        " Move::3 ran 20 ms of it in 2 starts, 1 of them failed",
    ),
    (
        "never of time",
        "Pick never low in at least 90 % of time",
        TWICE,
        "Pick::4: `low` did not hold in 75 % of the time, bound 90 %; Pick::4 ran 20 ms of it",
    ),
    (
        "never for",
        "Pick never battery < 20 % for more than 4 ms",
        TWICE,
        "Pick::4: `battery < 20 %` held for 5 ms, bound 4 ms;"
        " sampled just before, while Pick::4 ran; Move::3 had failed before in this run",
    ),
    (
        "visits",
        "Task visits Move, Alarm",
        TWICE,
        "Task: `Alarm` did not start",
    ),
    (
        "leaves",
        "Move leaves battery >= 60 %",
        TWICE,
        "Move::3: `battery` was 50 % at the end, bound 60 %; sampled 31 ms before",
    ),
    (
        "ends with",
        "Move ends with battery >= 60 %",
        TWICE,
        "Move::3: `battery` was 50 % at the end, bound 60 %; sampled 11 ms before",
    ),
    (
        "uses",
        "Pick uses at most 3 % of battery",
        TWICE,
        "Pick::4: used 40 %, bound 3 %; `battery` went from 50 % to 10 % in 20 ms",
    ),
    (
        "uses",
        "Task uses at most 3 % of battery",
        TWICE,
        "Task: used 40 %, bound 3 %;"
        " `battery` went from 50 % to 10 % in 50 ms; Move::3 ran 20 ms of it in 2 starts, 1 of them failed",
    ),
    (
        "tries",
        "Move tries at most 1",
        TWICE,
        "Move::3: started 2 times, bound 1; 1 failed, 1 succeeded",
    ),
    (
        "tries",
        "Task tries at most 1",
        "0 1R 2R 3R 10 3F 2F 20 2R 3R 30 3F 2F 1F",
        "Task: started 2 times, bound 1; 2 failed; Move::3 failed in 2 of its 2 starts",
    ),
    ("succeeds per", "Move succeeds at least 2 per run", TWICE, "Move::3: succeeded 1 time, bound 2; 1 succeeded"),
    (
        "starts per",
        "Move starts at most 1 per run",
        TWICE,
        "Move::3: started 2 times, bound 1; 1 failed, 1 succeeded",
    ),
    ("fails per", "Move fails at most 0 per run", TWICE, "Move::3: failed 1 time, bound 0; 1 failed"),
    ("takes on average", "Move takes at most 9 ms on average", TWICE, "Move::3: mean 10 ms of 2"),
    ("uses on average", "Pick uses at most 3 % of battery on average", TWICE, "Pick::4: mean 40 % of 1"),
    ("fails per time", "Move fails at most 0 per 50 ms", TWICE, "Move::3: 1 in 50 ms"),
    (
        "finishes per",
        "Move finishes at most 1 per Task",
        TWICE,
        "Move::3: finished 2 times, bound 1; 1 failed, 1 succeeded",
    ),
    (
        "tries",
        "Move tries at most 1",
        STOPPED,
        "Move::3: started 2 times, bound 1; 1 failed, 1 halted",
    ),
    (
        "tries",
        "Alarm tries at least 1",
        TWICE,
        "Alarm::5: started 0 times, bound 1; Move::3 ran 20 ms of it in 2 starts, 1 of them failed",
    ),
    (
        "runs",
        "Move runs every 25 ms",
        TWICE,
        "Move::3: had not run again after 30 ms, bound 25 ms; Pick::4 ran 20 ms of it",
    ),
    (
        "runs",
        "Move runs at least 2 per 25 ms",
        TWICE,
        "Move::3: ran 0 times in 25 ms, bound 2; Pick::4 ran 15 ms of it",
    ),
    (
        "runs",
        "Pick runs at least 1 per 20 ms",
        TWICE,
        "Pick::4: ran 0 times in 20 ms, bound 1; Move::3 ran 10 ms of it, and failed",
    ),
    (
        "runs",
        "Move runs at most 1 per 21 ms",
        TWICE,
        "Move::3: ran 2 times in 21 ms, bound 1; 1 failed, 1 succeeded",
    ),
    (
        "starts",
        "Pick starts within 19 ms after Move fails",
        TWICE,
        "Pick::4: started after 20 ms, bound 19 ms; Move::3 ran 10 ms of it",
    ),
    (
        "starts",
        "Alarm starts within 9 ms after Move succeeds",
        TWICE,
        "Alarm::5: had not started after 20 ms, bound 9 ms; Pick::4 ran 9 ms of it",
    ),
    (
        "ends",
        "Pick ends within 19 ms after Pick starts",
        TWICE,
        "Pick::4: ended after 20 ms, bound 19 ms; its median is 20 ms",
    ),
    (
        "ends",
        "Task ends within 19 ms after Pick starts",
        TWICE,
        "Task: ended after 20 ms, bound 19 ms; Pick::4 ran 20 ms of it",
    ),
    (
        "follows",
        "Pick follows Alarm succeeds",
        TWICE,
        "Pick::4: `Alarm succeeds` did not happen before it in the run; Alarm::5 had not started in the run",
    ),
    (
        "follows",
        "Move follows mission starts",
        TWICE,
        "Move::3: `mission starts` did not happen since its last start; Parallel::1 had started 20 ms before",
    ),
    (
        "follows",
        "Pick follows Move halts",
        TWICE,
        "Pick::4: `Move halts` did not happen before it in the run; Move::3 had succeeded just before",
    ),
    (
        "follows",
        "Pick follows when low",
        TWICE,
        "Pick::4: `when low` did not happen before it in the run; `battery` was sampled 31 ms before",
    ),
    (
        "followed",
        "each Move fails is followed by Pick starts within 9 ms",
        TWICE,
        "each Move fails: was followed after 20 ms, bound 9 ms; Move::3 ran 10 ms of it",
    ),
    (
        "followed",
        "each Pick starts is followed by Move starts",
        TWICE,
        "each Pick starts: had not been followed when the run ended; Move::3 had succeeded 20 ms before",
    ),
    (
        "followed",
        "each Pick starts is followed by Alarm starts or Move fails within 1 s",
        TWICE,
        "each Pick starts: had not been followed when the run ended; Alarm::5 had not started in the run",
    ),
    (
        "followed",
        "each Move starts is followed by low within 30 ms",
        TWICE,
        "each Move starts: was followed after 45 ms, bound 30 ms; "
        "Move::3 ran 20 ms of it in 2 starts, 1 of them failed",
    ),
    (
        "followed",
        "each Move starts is followed by battery > 60 %",
        TWICE,
        "each Move starts: had not been followed when the run ended;"
        " `battery` was sampled 5 ms before, while Pick::4 ran",
    ),
    (
        "from",
        "from Move starts to Pick succeeds takes at most 49 ms",
        TWICE,
        "from Move starts to Pick succeeds: took 50 ms, bound 49 ms;"
        " Move::3 ran 20 ms of it in 2 starts, 1 of them failed",
    ),
    (
        "from",
        "from Pick starts to Alarm starts takes at most 1 s",
        TWICE,
        "from Pick starts to Alarm starts: its last event did not happen before the run ended;"
        " Alarm::5 had not started in the run",
    ),
    (
        "from",
        "from Pick starts to Alarm starts takes at most 9 ms",
        TWICE,
        "from Pick starts to Alarm starts: had not come to an end after 20 ms, bound 9 ms; Pick::4 ran 20 ms of it",
    ),
    (
        "sum",
        "sum of Move, Pick takes at most 0.039 s",
        TWICE,
        "sum of Move, Pick: took 40 ms together, bound 0.039 s; Move::3 ran 20 ms of it in 2 starts, 1 of them failed",
    ),
]


@pytest.mark.parametrize(("verb", "demand", "runs", "line"), LINES)
def test_the_line_below_a_violated_clause(verb: str, demand: str, runs: str, line: str, verify: Verify) -> None:
    given = samples("battery", {-1: 50, 35: 45, 45: 10})
    assert f" {verb.split()[0]} " in f" {demand} "
    assert clause(verify, demand, runs, given, f"{LEVEL} level\ncontext low : battery < 20 %")["verdict"] == "violated"
    output = verify.text("run.btlog", "--mission", "main.btq", "--signals", "samples.csv")
    below, *_ = output.partition("\n\n")[2].splitlines()[1:]
    if verb in POOLED:  # of all runs together
        assert below.strip() == line
        return
    before, at, after = below.strip().partition(" (run 1 of run.btlog, ")
    assert (before, at != "", after.endswith(" after its start at 2026-11-20 21:22:20.000 UTC)")) == (line, True, True)


def test_every_verb_has_a_line() -> None:
    assert {verb for verb, *_ in LINES} == {*VERBS, "from", "sum"}
