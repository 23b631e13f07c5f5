"""`btq verify --store DIR` without logs: the verdicts of all runs that are kept, counted by an engine."""

from __future__ import annotations

import json
import re
import shutil
import sys
from collections import Counter
from collections.abc import Iterable
from pathlib import Path

import pytest
from evidence_logs import MAIN, MAIN_XML, START, btlog, rows
from in_process import run_btq
from json_schema import violations
from random_runs import Case, case
from seeds import seeds, share_of

from btq_lang.evidence.evaluate import MissionEvaluation
from btq_lang.evidence.model import LogSession
from btq_lang.evidence.store import engine
from btq_lang.evidence.store.engine import asked_by
from btq_lang.evidence.store.rows import Rows
from btq_lang.evidence.store.summary import summary
from btq_lang.evidence.verdicts import ClauseVerdict, MissionVerdicts

EVIDENCE = Path(__file__).parents[1]
SCHEMA = json.loads((EVIDENCE.parents[1] / "btq_lang/evidence/verdicts.schema.json").read_text(encoding="utf-8"))


def judged_and_kept(made: Case, store: Path) -> MissionVerdicts:
    """What is found in the sessions of a case, which are kept as logs."""
    evaluation = MissionEvaluation(made.mission)
    runs = 0
    for number, transitions in enumerate(made.sessions):
        folder = store / f"{number:064x}"
        folder.mkdir()
        with Rows(str(folder)) as written:
            one = MissionEvaluation(made.mission, listeners=[written.part(made.mission.name, "")])
            read = one.read(LogSession(made.joined.tree, iter(transitions)), made.joined, made.series, 1, "log")
            one.end()
        engine.write_parquet(str(folder), {"log": folder.name, "label": "", "source": f"log {number}"})
        evaluation.findings.add(one.findings, runs)
        runs += read
    return evaluation.result()


def compared(clause: ClauseVerdict) -> tuple[object, ...]:
    """What a summary says as `btq verify` does; the reason is one of those of all logs.

    Limits at every look are not those of one look, and what they say is undecided more often.
    """
    counts = (clause.counted, clause.violated, clause.unknown, clause.cut_off, clause.unit)
    text = re.sub(r" \(\d+\)$", "", clause.text)  # a clause that a node has twice has a number
    if clause.limits != "window" and clause.confidence is not None:
        return (text, clause.verdict == "never exercised", *counts, clause.confidence)
    interval = clause.interval if clause.limits == "window" else None
    return (text, clause.verdict, *counts, interval, clause.confidence, clause.more, bool(clause.why))


def in_order(clauses: Iterable[ClauseVerdict]) -> list[ClauseVerdict]:
    return sorted(clauses, key=lambda each: repr(compared(each)))


def test_a_summary_counts_as_the_judge_does(tmp_path: Path) -> None:
    seen: Counter[str] = Counter()
    for seed in share_of(seeds(120), 4):
        made = case(seed)
        store = tmp_path / str(seed)
        store.mkdir()
        judged = judged_and_kept(made, store)
        found = summary(engine.asked(str(store)), "kept").missions
        assert len(found) == (judged.runs > 0)
        if not found:
            continue
        (kept,) = found
        assert kept.outcomes == judged.outcomes, f"seed {seed}"
        of_judged = {each.id: in_order(each.clauses) for each in judged.requirements}
        for name in [name for name, clauses in of_judged.items() if all(each.why == MISTAKE for each in clauses)]:
            del of_judged[name]  # of a claim with a mistake a store keeps nothing
        of_kept = {each.id: in_order(each.clauses) for each in kept.requirements}
        assert of_kept.keys() == of_judged.keys(), f"seed {seed}"
        for name, clauses in of_judged.items():
            assert [*map(compared, of_kept[name])] == [*map(compared, clauses)], f"seed {seed}, {name}"
            for one, other in zip(clauses, of_kept[name], strict=True):
                assert other.verdict in (one.verdict, "undecided", "unknown")
                seen.update((other.verdict,))
        shutil.rmtree(store)
    assert seen.keys() >= {"violated", "satisfied", "undecided", "unknown", "never exercised"}


MISTAKE = "it has a mistake; run btq check"
MISSION = "QualityReq quick : safety\n    Move takes at most 15 ms\n" + MAIN
SLOW, QUICK = "1R 2R 20 2S 3R 25 3S 1S 26 2I 3I 1I", "1R 2R 12 2S 3R 25 3S 1S 26 2I 3I 1I"


@pytest.fixture
def kept(tmp_path: Path) -> Path:
    """A folder with a store of three logs of two versions and two robots."""
    (tmp_path / "main.btq").write_text(MISSION, encoding="utf-8")
    for number, (log, label, robot) in enumerate(((SLOW, "v1", "red"), (QUICK, "v2", "red"), (QUICK, "v2", "blue"))):
        path = tmp_path / f"{number}.btlog"
        path.write_bytes(btlog(MAIN_XML, rows(log), START + number * 60_000_000))
        asked = ("--mission", "main.btq", "--store", "kept", "--label", label, "--robot", robot)
        assert run_btq("verify", path.name, *asked, cwd=tmp_path)[0] == (label == "v1")
    return tmp_path


def test_the_verdicts_of_all_that_is_kept(kept: Path) -> None:
    assert run_btq("verify", "--store", "kept", cwd=kept) == (
        1,
        "3 runs in kept, 2026-11-20 21:22–21:24 UTC, mission main (3 logs)\n"
        "\n"
        "  violated         quick  Move takes at most 15 ms  1 of 3 activations, worst 20 ms in run 1\n"
        "                   Move::2: took 20 ms, bound 15 ms (run 1 of 0.btlog, 20 ms after its start at"
        " 2026-11-20 21:22:20.000 UTC)\n"
        "\n"
        "runs: 3 succeeded\n",
        "",
    )


def test_the_runs_that_broke_a_clause_are_those_of_their_log(tmp_path: Path) -> None:
    """Of the runs of other logs, whose numbers mean nothing without the log, there is only how many they are."""
    mission = "QualityReq sure : reliability\n    mission succeeds in at least 99 % of runs confidence 95 %\n" + MAIN
    (tmp_path / "main.btq").write_text(mission, encoding="utf-8")
    failed = "1R 2R 20 2F 1F 26 2I 3I 1I"
    for number in range(2):
        path = tmp_path / f"{number}.btlog"
        path.write_bytes(btlog(MAIN_XML, rows(" ".join([failed, SLOW, failed, failed])), START + number * 60_000_000))
    run_btq("verify", "0.btlog", "1.btlog", "--mission", "main.btq", "--store", "kept", cwd=tmp_path)
    output = run_btq("verify", "--store", "kept", cwd=tmp_path)[1]
    (line,) = (line for line in output.splitlines() if "broke it" in line)
    assert line.strip() == (
        "Sequence::1: 6 of 8 runs broke it (run 1 of 0.btlog, 20 ms after its start at 2026-11-20 21:22:20.000 UTC;"
        " also runs 3, 4 and 3 more)"
    )


def test_the_verdicts_of_each_label(kept: Path) -> None:
    code, output, errors = run_btq("verify", "--store", "kept", "--by", "label", "--by", "robot", cwd=kept)
    assert (code, errors) == (1, "")
    assert [line for line in output.splitlines() if "activation" in line or "mission" in line] == [
        "1 run in kept, 2026-11-20 21:22 UTC, mission main, label v1, robot red (1 log)",
        "  violated         quick  Move takes at most 15 ms  1 of 1 activation, worst 20 ms in run 1",
        "1 run in kept, 2026-11-20 21:24 UTC, mission main, label v2, robot blue (1 log)",
        "  satisfied        quick  Move takes at most 15 ms  held so far in 1 activation, worst 12 ms",
        "1 run in kept, 2026-11-20 21:23 UTC, mission main, label v2, robot red (1 log)",
        "  satisfied        quick  Move takes at most 15 ms  held so far in 1 activation, worst 12 ms",
    ]


@pytest.mark.parametrize("form", ["json", "csv", "junit", "markdown"])
def test_every_format_has_a_summary(form: str, kept: Path) -> None:
    code, output, errors = run_btq("verify", "--store", "kept", "--by", "label", "--format", form, cwd=kept)
    assert (code, errors) == (1, "")
    assert output.count("main, label v2") > 0
    if form == "json":
        found = json.loads(output)
        assert list(violations(found, SCHEMA)) == []
        assert [each["clauses"][0]["worst"]["run"] for each in found["requirements"]] == [1, None]


def test_the_summary_of_the_laboratory_is_what_its_logs_say(shared: Path, tmp_path: Path) -> None:
    shutil.copy(shared / "logs" / "lab.btlog", tmp_path)
    shutil.copy(shared / "logs" / "lab.battery.csv", tmp_path)
    shutil.copy(EVIDENCE / "lab.btq", tmp_path)
    mission = ("--mission", "lab.btq", "--signals", "lab.battery.csv", "--format", "json")
    _, judged, _ = run_btq("verify", "lab.btlog", *mission, "--store", "kept", cwd=tmp_path)
    code, summed, errors = run_btq("verify", "--store", "kept", "--format", "json", cwd=tmp_path)
    assert (code, errors) == (1, "")
    log, store = json.loads(judged), json.loads(summed)
    assert list(violations(store, SCHEMA)) == []
    for one, other in zip(log["requirements"], store["requirements"], strict=True):
        for clause, kept in zip(one["clauses"], other["clauses"], strict=True):
            clause.pop("by_run", None)  # only drawings ask a store for it
            differing = {name for name in clause if clause[name] != kept[name]}
            # A store's limits hold at every look, those of a log for one.
            of_limits = {"interval", "limits", "more"} if clause["limits"] else set()
            # It does not keep what was not counted.
            assert differing <= {"path", "violations", "worst", "failed", "idle", *of_limits}
            assert re.sub(r" \(\d of \d\)", "", kept["path"]) == re.sub(r"::\d+", "", clause["path"])
            if clause["worst"] is not None:
                assert kept["worst"]["text"] == clause["worst"]["text"]
            worst = max(clause["violations"], key=lambda each: each["run"], default=None)
            assert (worst is None) == (not kept["violations"])
    assert store["missions"][0]["outcomes"] == log["missions"][0]["outcomes"]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--store", "gone"), "gone: no verdicts are kept there; keep some with btq verify LOG --store gone"),
        (
            ("--store", "kept", "--label", "x"),
            "--label goes with logs; without any, --store DIR prints what is kept there",
        ),
        (
            ("--store", "kept", "--mission", "main.btq"),
            "--mission goes with logs; without any, --store DIR prints what is kept there",
        ),
        (("--by", "label"), "--by goes with --store DIR"),
        (("0.btlog", "--store", "kept", "--by", "label"), "--by goes with --store DIR and no log"),
        (("--store", "kept", "-o", "x.html"), "a page is made of logs; choose another format for a store"),
    ],
)
def test_what_a_summary_cannot_be_asked(options: tuple[str, ...], message: str, kept: Path) -> None:
    assert run_btq("verify", *options, cwd=kept) == (2, "", f"btq verify: {message}\n")


def test_the_store_of_the_project(kept: Path) -> None:
    (kept / "btq.toml").write_text('[evidence]\nstore = "kept"\n', encoding="utf-8")
    (kept / "below").mkdir()
    shutil.copy(kept / "0.btlog", kept / "below" / "new.btlog")
    with (kept / "below" / "new.btlog").open("ab") as file:
        file.write(bytes(8))
    whole = run_btq("verify", "--store", "kept", cwd=kept)
    assert run_btq("verify", cwd=kept) == whole
    assert run_btq("verify", "--by", "label", cwd=kept) == run_btq(
        "verify", "--store", "kept", "--by", "label", cwd=kept
    )
    assert run_btq("verify", cwd=kept / "below")[1].startswith(f"3 runs in {kept / 'kept'}, ")
    assert run_btq("verify", "new.btlog", "--no-store", cwd=kept / "below")[0] == 1
    assert run_btq("verify", cwd=kept) == whole
    assert run_btq("verify", "new.btlog", "--label", "v3", cwd=kept / "below")[0] == 1
    assert run_btq("verify", cwd=kept)[1].startswith("4 runs in kept, ")
    assert "label v3" in run_btq("verify", "--by", "label", cwd=kept)[1]


def test_logs_of_the_project_are_kept_in_its_store(kept: Path) -> None:
    (kept / "btq.toml").write_text('[evidence]\nlogs = ["[01].btlog"]\nstore = "own"\n', encoding="utf-8")
    assert "runs: 2 succeeded" in run_btq("verify", "--label", "v9", cwd=kept)[1]
    found = run_btq("verify", "--by", "label", cwd=kept)[1]
    assert found.startswith("2 runs in own, 2026-11-20 21:22–21:23 UTC, mission main, label v9 (2 logs)\n")
    assert run_btq("verify", "--no-store", "--label", "x", cwd=kept) == (
        2,
        "",
        "btq verify: --label goes with a store; leave out --no-store\n",
    )


def test_a_damaged_file_is_named(kept: Path) -> None:
    path = next((kept / "kept").glob("*/verdicts.parquet"))
    whole = path.read_bytes()
    path.write_bytes(whole[:100])
    code, output, errors = run_btq("verify", "--store", "kept", cwd=kept)
    assert (code, output) == (2, "")
    assert errors.startswith(f"btq verify: {path.relative_to(kept)}: ")
    assert errors.count("\n") == 1
    path.write_bytes(whole)
    assert run_btq("verify", "--store", "kept", cwd=kept)[0] == 1


def test_what_a_killed_writer_leaves_is_not_counted(kept: Path) -> None:
    whole = next((kept / "kept").glob("[0-9a-f]*"))
    shutil.copytree(whole, kept / "kept" / ".draft-0")
    shutil.copytree(whole, kept / "kept" / f".old-{whole.name}-{'0' * 32}")
    assert run_btq("verify", "--store", "kept", cwd=kept)[1].startswith("3 runs in kept")


def test_the_question_of_the_page(kept: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    page = (EVIDENCE.parents[1] / "docs" / "evidence-store.md").read_text(encoding="utf-8")
    (program,) = re.findall(r"^```python\n(.*?)^```$", page, re.DOTALL | re.MULTILINE)
    (kept / "kept").rename(kept / "evidence")
    monkeypatch.chdir(kept)
    scope: dict[str, list[tuple[str, str, float]]] = {}
    exec(program, scope)
    assert scope["rows"] == [
        ("v1", "Move::2", 0.02),
        ("v2", "Pick::3", 0.013),
        ("v2", "Move::2", 0.012),
        ("v1", "Pick::3", 0.005),
    ]


@pytest.mark.parametrize("parts", [(), ("label",), ("label", "robot")])
def test_a_second_engine_says_the_same(parts: tuple[str, ...], kept: Path, polars: str) -> None:
    store = str(kept / "kept")
    assert summary(asked_by(polars, store), store, parts) == summary(engine.asked(store), store, parts)


def test_a_second_engine_counts_windows_and_odds_alike(tmp_path: Path, polars: str) -> None:
    for seed in share_of(seeds(20), 4):
        store = tmp_path / str(seed)
        store.mkdir()
        judged_and_kept(case(seed), store)
        name = str(store)
        assert summary(asked_by(polars, name), name) == summary(engine.asked(name), name), f"seed {seed}"


def test_without_ibis_the_extra_is_named(kept: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "ibis", None)
    message = "btq verify: other engines are asked with ibis; install it with pip install 'btq-lang[fleet]'\n"
    assert run_btq("verify", "--store", "kept", "--engine", "polars://", cwd=kept) == (2, "", message)
