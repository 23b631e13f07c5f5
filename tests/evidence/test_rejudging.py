"""Clauses judged again after an edit of their bounds or odds: as if the logs had been read again."""

from __future__ import annotations

import json
import random
import re
from pathlib import Path

import pytest
from check_asserts import workspace_of
from evidence_logs import MAIN, MAIN_XML, btlog, rows, samples
from random_runs import Case, case
from seeds import seeds

from btq_lang.evidence import margins
from btq_lang.evidence.edges import edge_of
from btq_lang.evidence.evaluate import MissionEvaluation
from btq_lang.evidence.identity import Candidate, join
from btq_lang.evidence.json_document import WrittenMission, read_verdicts, render
from btq_lang.evidence.judging import Means
from btq_lang.evidence.margins import Margins
from btq_lang.evidence.model import LogSession
from btq_lang.evidence.outline import demands, outline
from btq_lang.evidence.readers.samples import read
from btq_lang.evidence.rejudging import shown_now
from btq_lang.evidence.verdicts import ClauseVerdict, MissionVerdicts, VerdictReport
from btq_lang.evidence.verifying import verify
from btq_lang.util.record import replace

KEPT, VIOLATED = 0, 1


def judged(made: Case, mission: Candidate) -> MissionVerdicts:
    """The verdicts on all sessions, each judged by itself."""
    joined = join([mission], made.joined.tree)
    assert joined is not None
    evaluation = MissionEvaluation(mission, with_measures=True)
    runs = 0
    for number, session in enumerate(made.sessions):
        one = MissionEvaluation(mission, with_measures=True)
        read = one.read(LogSession(made.joined.tree, iter(session)), joined, made.series, 1, f"log {number}")
        evaluation.findings.add(one.findings, runs)
        runs += read
    return evaluation.result()


def written(found: MissionVerdicts) -> WrittenMission:
    """The verdicts as a program reads them from the file."""
    (mission,) = read_verdicts(render(VerdictReport((found,), (), ())))
    return mission


def edited(text: str, chance: random.Random) -> str:
    """The text with other bounds and odds in its requirements."""

    def other(match: re.Match[str]) -> str:
        number = float(match["number"]) * chance.choice((0.2, 0.5, 0.9, 1, 1.1, 2, 5))
        if match["unit"] == "%":
            number = min(max(number, 1), 99)
        shown = f"{number:.3g}" if match["unit"].strip() else f"{round(number)}"
        return f"{match['before']}{shown}{match['unit']}"

    bounds = r"(?P<before>(?:at most|at least|within|every|[<>]=?) )(?P<number>[0-9.]+)(?P<unit> ?(?:ms|s|%|m/s|m|))"
    bound = re.compile(bounds + r"(?![\w.])")
    lines = text.splitlines(keepends=True)
    is_clause = re.compile(r"    (?!while|when|over|confidence)[a-zA-Z]|apply")
    return "".join(bound.sub(other, line) if is_clause.match(line) else line for line in lines)


def counts(clause: ClauseVerdict) -> tuple[object, ...]:
    interval = tuple(round(each, 9) for each in clause.interval) if clause.interval is not None else None
    worst = (clause.worst.si, clause.worst.text) if clause.worst is not None else None
    return (
        clause.verdict,
        clause.counted,
        clause.violated,
        clause.unknown,
        clause.cut_off,
        worst,
        interval,
        clause.more,
    )


def test_a_clause_with_an_edited_bound_is_judged_as_if_the_logs_were_read_again() -> None:
    again = 0
    for seed in seeds(60):
        made = case(seed)
        before = written(judged(made, made.mission))
        text = edited(made.text, random.Random(seed))
        mission = Candidate(workspace_of({"main.btq": text}), "main.btq", "main", None)
        if outline(mission.requirements) != before.outline:
            continue  # a context has changed
        truth: dict[tuple[str, str], list[tuple[object, ...]]] = {}
        for requirement in judged(made, mission).requirements:
            for clause in requirement.clauses:
                truth.setdefault((requirement.id, clause.text), []).append(counts(clause))
        old = {id(clause) for requirement in before.requirements for clause in requirement.clauses}
        for shown in shown_now(mission.requirements, before.requirements):
            if shown.verdict is not None:
                name, claim = shown.demand.requirement.name, shown.demand.claim.text
                same = [
                    found
                    for (id_, text), each in truth.items()
                    for found in each
                    if id_ == name and text.startswith(claim)
                ]
                assert counts(shown.verdict) in same, f"seed {seed}: {name} {claim}"
                assert shown.least == shown.verdict.violated
                again += id(shown.verdict) not in old
    assert again > 30, again


def test_there_are_no_more_steps_than_are_kept() -> None:
    """A bound inside of a step of several judgements: the counts are between those with all and with none of them."""
    claim = "Move takes at most 3 s"
    mission = Candidate(
        workspace_of({"main.btq": f"QualityReq rq : safety\n    {claim}\nBehaviorTree Main\n    Action Move\n"}),
        "main.btq",
        "main",
        None,
    )
    (demand,) = demands(mission.requirements)
    edge = edge_of(demand.claim, demand.subject, demand.requirement)
    assert edge is not None
    found = Margins(of_runs=False)
    for number in range(10_000):
        found.add(KEPT, VIOLATED, [number / 1000])
        found.end_run(number + 1)
    found = Margins.read(json.loads(json.dumps(found.written())))
    assert len(found.written()["steps"]) <= margins.MOST_STEPS
    for bound in (-1.0, 0.0, 2.0, 4.9995, 9.999, 11.0):
        least, most = found.counts(bound, edge)
        truth = sum(number / 1000 > bound for number in range(10_000))
        assert least.violated <= truth <= most.violated
        assert most.violated - least.violated <= 20
        assert least.kept + least.violated == most.kept + most.violated == 10_000
    assert found.worst(3.0, edge) == (9.999, 10_000)


@pytest.mark.parametrize(
    ("before", "after", "seen"),
    [
        ("in at least 90 % of activations", "in at least 40 % of activations", ("satisfied", 2, 1)),
        ("in at least 40 % of activations", "in at least 90 % of activations", ("violated", 2, 1)),
        ("in at least 90 % of activations", "", ("violated", 2, 1)),
        ("", "in at least 90 % of activations\n    confidence 95 %", ("undecided", 2, 1)),
        ("in at least 90 % of activations", "in at least 90 % of runs", None),
        ("", "while node Move", None),
    ],
)
def test_edited_odds_and_scopes(before: str, after: str, seen: tuple[object, ...] | None, tmp_path: Path) -> None:
    texts = [f"QualityReq rq : safety\n    Move succeeds\n    {each}\n{MAIN}" for each in (before, after)]
    old, new = (Candidate(workspace_of({"main.btq": text}), "main.btq", "main", None) for text in texts)
    (tmp_path / "run.btlog").write_bytes(btlog(MAIN_XML, rows("0 1R 2R 20 2S 3R 60 3S 1S 1I 100 1R 2R 140 2F 1F")))
    log = [str(tmp_path / "run.btlog")]
    (mission,) = verify(log, Means([old], with_measures=True)).missions
    (shown,) = shown_now(new.requirements, written(mission).requirements)
    verdict = shown.verdict
    assert (None if verdict is None else (verdict.verdict, verdict.counted, verdict.violated)) == seen


TWICE = "0 1R 2R 20 2F 2R 60 2S 80 3R 90 3S 1S 1I 100 1R 2R 140 2S 145 3R 150 3S 1S"
BATTERY = "signal battery : % from {level}\n"


@pytest.mark.parametrize(
    ("demand", "bounds"),
    [
        # Move succeeds at 60 and 140; Pick succeeds at 90 and 150, its row comes at 80 and 145.
        ("each Move succeeds is followed by Pick succeeds within {} ms", (29, 30, 31, 9, 10, 100)),
        ("each Move finishes is followed by Pick succeeds within {} ms", (5, 30, 69, 70, 71)),
        # In the second run Move does not fail, and in the first one it has not succeeded again 41 ms before the end.
        ("each Move fails is followed by Move fails within {} ms", (5, 69, 70, 71)),
        ("each Move succeeds is followed by Pick succeeds within {} ms\n    in at least 40 % of occurrences", (5, 20)),
        ("each Move succeeds is followed by Pick succeeds within {} ms\n    in at least 60 % of runs", (5, 20, 40)),
        ("mission keeps battery >= {} %\n    from Move succeeds until Pick succeeds", (5, 14, 15, 16, 40)),
        ("mission never battery < {} %\n    from Move fails until Move succeeds", (5, 50, 51)),
        ("Move keeps battery > {} %\n    from when battery < 60 % until Pick succeeds", (5, 15, 16, 50)),
    ],
)
def test_edited_bounds_of_answers_and_spans(demand: str, bounds: tuple[float, ...], tmp_path: Path) -> None:
    (tmp_path / "run.btlog").write_bytes(btlog(MAIN_XML, rows(TWICE)))
    (tmp_path / "samples.csv").write_text(samples("battery", {-1: 50, 70: 15, 95: 90, 120: 30, 142: 80}))
    means = Means([], {"battery": read(str(tmp_path / "samples.csv"))["battery"]}, with_measures=True)

    def mission_of(bound: float) -> Candidate:
        text = f"{BATTERY}QualityReq rq : safety\n    {demand.format(bound)}\n{MAIN}"
        return Candidate(workspace_of({"main.btq": text}), "main.btq", "main", None)

    def judged_by(bound: float) -> MissionVerdicts:
        (found,) = verify([str(tmp_path / "run.btlog")], replace(means, missions=[mission_of(bound)])).missions
        return found

    first, *others = bounds
    before = written(judged_by(first))
    for bound in others:
        (shown,) = shown_now(mission_of(bound).requirements, before.requirements)
        ((clause,),) = (requirement.clauses for requirement in judged_by(bound).requirements)
        assert shown.verdict is not None
        assert counts(shown.verdict) == counts(clause), bound
        assert clause.counted


@pytest.mark.parametrize(
    "demand",
    [
        "each Move succeeds is followed by when battery > {} % within 5 ms",  # its time is what is bounded
        "each Move fails is followed by when battery > 99 % within {} ms",  # the run ends before, so it may not count
        "each Move succeeds is followed by Pick succeeds within {} ms\n    while battery > 5 %",  # up to the deadline
    ],
)
def test_what_a_bound_does_not_decide_alone_is_judged_by_logs(demand: str, tmp_path: Path) -> None:
    (tmp_path / "run.btlog").write_bytes(btlog(MAIN_XML, rows(TWICE)))
    texts = [f"{BATTERY}QualityReq rq : safety\n    {demand.format(bound)}\n{MAIN}" for bound in (20, 30)]
    old, new = (Candidate(workspace_of({"main.btq": text}), "main.btq", "main", None) for text in texts)
    (mission,) = verify([str(tmp_path / "run.btlog")], Means([old], with_measures=True)).missions
    (shown,) = shown_now(new.requirements, written(mission).requirements)
    assert shown.verdict is None
