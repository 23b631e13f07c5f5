"""`btq compare`: what changed between two labels or robots of a store."""

from __future__ import annotations

import csv
import json
import random
from collections.abc import Sequence
from math import comb
from pathlib import Path

import pytest
from in_process import run_btq
from json_schema import violations
from seeds import share_of

from btq_lang.evidence.compare.chance import Shuffles, exact, holm, is_too_few, shuffles_for
from btq_lang.evidence.compare.comparison import compare
from btq_lang.evidence.compare.lines import remarks
from btq_lang.evidence.store import engine
from btq_lang.evidence.store.rows import file_of
from btq_lang.evidence.store.tables import ROWS

SCHEMA = json.loads(
    (Path(__file__).parents[3] / "btq_lang/evidence/compare/comparison.schema.json").read_text(encoding="utf-8")
)
Run = tuple[float, float, bool]  # seconds of Move, seconds of Dock, whether Dock succeeded

TABLE = (
    "main: 60 runs of v1 (2026-11-20 08:01–09:00 UTC), 50 runs of v2 (2026-11-21 08:01–08:50 UTC),"
    " durations compared by runs\n"
    "\n"
    "  newly violated  quick Be quick  was satisfied; violated in 0 of 60 → 10 of 50, p = 0.00044\n"
    "  less reliable   Dock            failed in 5 of 60 runs → 28 of 50, p < 0.0001\n"
    "  slower          Move            mean 10.1 s → 11.6 s (+1.53 s, +15.3 %; 95 % interval +1.34 s to +1.73 s)"
    " over 60 and 50 runs, p < 0.0001\n"
    "                                  and in requirement quick\n"
    "\n"
    "3 of 4 comparisons differ by more than chance explains\n"
)
MARKDOWN = (
    "### main: 60 runs of v1 (2026-11-20 08:01–09:00 UTC), 50 runs of v2 (2026-11-21 08:01–08:50 UTC),"
    " durations compared by runs\n"
    "\n"
    "| Finding | Of | Change |\n"
    "|---|---|---|\n"
    "| **newly violated** | `quick Be quick` | was satisfied; violated in 0 of 60 → 10 of 50, p = 0.00044 |\n"
    "| **less reliable** | `Dock` | failed in 5 of 60 runs → 28 of 50, p &lt; 0.0001 |\n"
    "| **slower** | `Move` | mean 10.1 s → 11.6 s (+1.53 s, +15.3 %; 95 % interval +1.34 s to +1.73 s)"
    " over 60 and 50 runs, p &lt; 0.0001<br>and in requirement quick |\n"
    "\n"
    "* 3 of 4 comparisons differ by more than chance explains\n"
)
CHOICE = "choose one of table, json, markdown with --format, or another file name"
FEW = (
    "main: 2 runs of a (2026-11-20 08:01–08:02 UTC), 2 runs of b (2026-11-20 08:01–08:02 UTC),"
    " durations compared by runs\n"
    "\n"
    "what differs most where chance may explain it:\n"
    "  Dock  failed in 0 of 2 runs → 2 of 2, p = 1, alone 0.33\n"
    "  Move  mean 10 s → 11 s (+1 s, +10 %) over 2 and 2 runs, p = 1, alone 0.34\n"
    "\n"
    "0 of 3 comparisons differ by more than chance explains\n"
    "means: not testable with 2 runs\n"
    "too few to show any change: Dock, Move\n"
)
START = 1_795_161_600_000_000  # 2026-11-20 08:00, in µs
DAY = 86_400_000_000  # µs


def keep(
    store: Path,
    label: str,
    runs: Sequence[Run],
    robot: str = "",
    bound: float = 12,
    mission: str = "main",
    requirement: str = "quick",
    start: int = START,
) -> None:
    """Keep runs of a mission of two nodes, a run a minute, as one log, judged by a requirement with a bound in s."""
    folder = store / f"{len([*store.glob('*')]):064x}"
    folder.mkdir(parents=True)
    tables: dict[str, list[tuple[object, ...]]] = {name: [] for name in ROWS}
    of = (mission, robot)
    clause = (requirement, "Be quick", f"Move takes at most {bound:g} s", "Move", "", "activations", "s")
    tables["clauses"].append((*of, 0, *clause, *[None] * 7, True, 0, "", *[None] * 11))
    for number, (move, dock, succeeded) in enumerate(runs, start=1):
        begin = start + number * 60_000_000
        middle, end = begin + round(move * 1e6), begin + round((move + dock) * 1e6)
        outcome = "succeeded" if succeeded else "failed"
        tables["runs"].append((*of, number, begin, end, outcome, 2, 0, 0, None, "", 3, 3))
        of_move = (2, "Move::2", "Move", "Move", True, begin, middle, "succeeded", "exact", begin)
        of_dock = (3, "Dock::3", "Dock", "Dock", True, middle, end, outcome, "exact", middle)
        tables["activations"] += [(*of, number, *of_move), (*of, number, *of_dock)]
        verdict, at = ("violated", middle) if move > bound else ("satisfied", None)
        tables["verdicts"].append((0, number, "Move::2", begin, middle, verdict, True, at, move, bound, *[None] * 6))
    for name, found in tables.items():
        with open(file_of(str(folder), name), "w", encoding="utf-8", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows(found)
    engine.write_parquet(str(folder), {"log": folder.name, "label": label, "source": "log"})


def drawn(chance: random.Random, number: int, move: float = 10.0, fails: float = 0.05) -> list[Run]:
    return [
        (min(chance.gauss(move, 0.5), 11.9) if move < 11 else chance.gauss(move, 0.5), 5.0, chance.random() >= fails)
        for _ in range(number)
    ]


@pytest.fixture
def changed(tmp_path: Path) -> Path:
    """A folder with a store of two labels: the later one is slower, and docks less often."""
    chance = random.Random(1)
    keep(tmp_path / "kept", "v1", drawn(chance, 60))
    keep(tmp_path / "kept", "v2", drawn(chance, 50, 11.5, 0.5), start=START + DAY)
    return tmp_path


def test_what_got_worse(changed: Path) -> None:
    assert run_btq("compare", "kept", "--by", "label", "v1", "v2", cwd=changed) == (1, TABLE, "")


@pytest.mark.parametrize("line", [("v1", "v2"), ("--by", "label", "v1", "v2"), ("v1", "--by", "label", "v2")])
def test_the_store_of_the_project(line: tuple[str, ...], changed: Path) -> None:
    (changed / "btq.toml").write_text('[evidence]\nstore = "kept"\n', encoding="utf-8")
    assert run_btq("compare", *line, cwd=changed) == (1, TABLE, "")


def test_without_a_store(changed: Path) -> None:
    what = "no store given; name one, which btq verify LOG … --store DIR makes,"
    message = f"btq compare: {what} or set `store` in [evidence] of btq.toml\n"
    assert run_btq("compare", "v1", "v2", cwd=changed) == (2, "", message)


def test_back_to_the_version_that_was_better(changed: Path) -> None:
    code, output, errors = run_btq("compare", "kept", "v2", "v1", cwd=changed)
    assert (code, errors) == (0, "")
    assert [line.split("  ")[1] for line in output.splitlines() if line.startswith("  ") and line[2] != " "] == [
        "more reliable",
        "faster",
        "no longer violated",
    ]
    assert "  no longer violated  quick Be quick  is satisfied; violated in 10 of 50 → 0 of 60, p = 0.00044\n" in output


def test_a_single_violation_may_be_chance(tmp_path: Path) -> None:
    keep(tmp_path / "kept", "a", [(10, 5, True)] * 50)
    keep(tmp_path / "kept", "b", [(10, 5, True)] * 49 + [(13, 5, True)])
    code, output, errors = run_btq("compare", "kept", "a", "b", cwd=tmp_path)
    assert (code, errors) == (0, "")
    assert output.splitlines()[1:4] == [
        "",
        "what differs most where chance may explain it:",
        "  newly violated  quick Be quick  was satisfied; violated in 0 of 50 → 1 of 50, p = 1",
    ]


def test_an_edited_bound_is_no_change_of_the_robot(tmp_path: Path) -> None:
    """The verdicts of both sides are named, and what was measured is compared under the later clause."""
    keep(tmp_path / "kept", "a", [(10, 5, True), (11, 5, True)] * 30, bound=12)
    keep(tmp_path / "kept", "b", [(10, 5, True), (11, 5, True)] * 30, bound=10.5)
    code, output, errors = run_btq("compare", "kept", "a", "b", cwd=tmp_path)
    assert (code, errors) == (0, "")
    assert output == (
        "main: 60 runs of a (2026-11-20 08:01–09:00 UTC), 60 runs of b (2026-11-20 08:01–09:00 UTC),"
        " durations compared by runs\n"
        "\n"
        "0 of 2 comparisons differ by more than chance explains\n"
        "the bound of quick at Move was changed from Move takes at most 12 s (0 of 60 violated) to"
        " Move takes at most 10.5 s (30 of 60 violated), so this says nothing about the robots\n"
    )
    _, output, _ = run_btq("compare", "kept", "b", "a", "--format", "json", cwd=tmp_path)
    document = json.loads(output)
    assert list(violations(document, SCHEMA)) == []
    (found,) = document["missions"]
    texts = {"before": "Move takes at most 10.5 s", "after": "Move takes at most 12 s"}
    of = {"requirement": "quick", "node": "Move"}
    assert found["edited"] == [{**of, **texts, "violated": [30, 0], "counted": [60, 60]}]
    assert (found["newly"], found["no_longer"]) == ([], [])
    (move,) = (each for each in found["changes"] if each["node"] == "Move")
    assert (move["what"], [each["clause"] for each in move["same"]]) == ("mean", ["Move takes at most 12 s"])


def test_a_microsecond_is_no_change(tmp_path: Path) -> None:
    """Logs have no finer times."""
    found = []
    for label, moves in (("a", 10.0), ("b", 10.000001), ("c", 10.000003)):
        keep(tmp_path / "kept", label, [(moves, 5, True)] * 30)
        compared = compare(engine.asked(str(tmp_path / "kept")), "label", ("a", label), 0) if label != "a" else ()
        found += [{each.finding for each in mission.changes if each.node == "Move"} for mission in compared]
    assert found == [{""}, {"slower"}]


@pytest.mark.parametrize(
    ("least", "code", "word"),
    [("5 %", 1, "slower"), ("4.9%", 1, "slower"), ("5.1", 0, "less than 5.1 %"), (" 0 ", 1, "slower")],
)
def test_what_is_smaller_than_asked_for_is_no_change(least: str, code: int, word: str, tmp_path: Path) -> None:
    keep(tmp_path / "kept", "a", [(10.0, 5, True)] * 30)
    keep(tmp_path / "kept", "b", [(10.5, 5, True)] * 30)
    found, output, errors = run_btq("compare", "kept", "a", "b", "--at-least", least, cwd=tmp_path)
    assert (found, errors, word in output) == (code, "", True)
    if not code:
        assert "less than 5.1 %, so no change (--at-least): Move (+5 %)" in output.splitlines()
        assert run_btq("compare", "kept", "a", "b", cwd=tmp_path)[0] == 1


@pytest.mark.parametrize("least", ["x", "", "-3", "nan", "5 % %", "5 s", "1e3"])
def test_what_is_no_percentage(least: str, changed: Path) -> None:
    message = f"btq compare: --at-least {least}: expected a percentage, such as 5 %\n"
    assert run_btq("compare", "kept", "v1", "v2", f"--at-least={least}", cwd=changed) == (2, "", message)


def test_what_only_one_side_ran(tmp_path: Path) -> None:
    runs = [(10.0, 5.0, True)] * 2
    keep(tmp_path / "kept", "a", runs, requirement="first")
    keep(tmp_path / "kept", "b", runs)
    keep(tmp_path / "kept", "b", runs, requirement="third")
    keep(tmp_path / "kept", "a", runs, mission="other")
    code, output, errors = run_btq("compare", "kept", "a", "b", cwd=tmp_path)
    assert (code, errors) == (0, "")
    assert output == (
        "main: 2 runs of a (2026-11-20 08:01–08:02 UTC), 4 runs of b (2026-11-20 08:01–08:02 UTC),"
        " durations compared by runs\n"
        "\n"
        "0 of 2 comparisons differ by more than chance explains\n"
        "not compared: requirement only in a: first\n"
        "not compared: requirements only in b: quick, third\n"
        "means: not testable with 2 and 4 runs\n"
        "too few to show any change: Dock, Move\n"
        "\n"
        "other: 2 runs of a, none of b, not compared\n"
    )
    _, output, _ = run_btq("compare", "kept", "a", "b", "--format", "json", cwd=tmp_path)
    document = json.loads(output)
    assert list(violations(document, SCHEMA)) == []
    first, second = document["missions"]
    assert first["only"] == [["first"], ["quick", "third"]]
    assert (second["mission"], second["runs"], second["changes"]) == ("other", [2, 0], [])
    page = tmp_path / "report.html"
    assert run_btq("report", "kept", "-o", str(page), cwd=tmp_path) == (0, "", "")
    assert "<p>other: 2 runs of a, none of b, not compared</p>" in page.read_text(encoding="utf-8")


def test_json_is_as_its_schema_says(changed: Path) -> None:
    code, output, errors = run_btq("compare", "kept", "v1", "v2", "--format", "json", cwd=changed)
    assert (code, errors) == (1, "")
    found = json.loads(output)
    assert list(violations(found, SCHEMA)) == []
    (mission,) = found["missions"]
    assert (found["sides"], mission["runs"], mission["over"], mission["group"]) == (["v1", "v2"], [60, 50], "runs", 1)
    turned = {"before": "satisfied", "after": "violated", "violated": [0, 10], "counted": [60, 50]}
    (newly,) = mission["newly"]
    others = {"may_be_chance": False, "pooled": None, "clause": "", "node": ""}
    assert newly == {"id": "quick", "title": "Be quick", **turned, "p": newly["p"], **others}
    assert newly["p"] == pytest.approx(0.00044, rel=0.01)
    assert mission["no_longer"] == []
    clause = {"requirement": "quick", "clause": "Move takes at most 12 s", "node": "Move"}
    assert [(each["node"], each["what"], each["finding"], each["same"]) for each in mission["changes"]] == [
        ("Dock", "mean", "", []),
        ("Move", "mean", "slower", [clause]),
        ("Dock", "failures", "less reliable", []),
        ("Move", "failures", "less reliable", []),
    ]
    move = mission["changes"][1]
    assert (move["units"], move["counts"], move["failed"]) == ([60, 50], [60, 50], None)
    assert move["interval"] == pytest.approx([1.34, 1.73], abs=0.005)


def test_markdown(changed: Path) -> None:
    assert run_btq("compare", "kept", "v1", "v2", "-o", "x.md", cwd=changed) == (1, "", "")
    assert (changed / "x.md").read_text(encoding="utf-8") == MARKDOWN


def test_few_runs_say_so(tmp_path: Path) -> None:
    keep(tmp_path / "kept", "a", [(10, 5, True)] * 2)
    keep(tmp_path / "kept", "b", [(11, 5, False)] * 2)
    assert run_btq("compare", "kept", "a", "b", cwd=tmp_path) == (0, FEW, "")


def test_robots_are_shuffled_where_a_label_has_several(tmp_path: Path) -> None:
    """Runs of one robot are alike: 200 runs of two slow robots and of two quick ones are four observations."""
    chance = random.Random(2)
    for label, robot, move in (("a", "r1", 9), ("a", "r2", 10), ("b", "r3", 10.5), ("b", "r4", 10.7)):
        keep(tmp_path / "kept", label, drawn(chance, 50, move, 0.0), robot)
    (found,) = compare(engine.asked(str(tmp_path / "kept")), "label", ("a", "b"))
    assert (found.over, found.robots, found.runs) == ("robots", (2, 2), (100, 100))
    assert [each.finding for each in found.changes if each.finding] == []
    assert "means: not testable with 2 robots" in remarks(found, ("a", "b"))
    (alone,) = compare(engine.asked(str(tmp_path / "kept")), "robot", ("r1", "r4"))
    assert {each.node for each in alone.changes if each.finding == "slower"} == {"Move"}
    assert alone.over == "runs"


def keep_robots(store: Path, label: str, chance: random.Random, slower: float = 0.0) -> None:
    """Keep 25 runs of each of three robots, of which each is slower, and fails more often, than the one before."""
    for number in range(3):
        keep(store, label, drawn(chance, 25, 8 + number + slower, 0.1 + 0.2 * number), f"r{number}")


def test_runs_of_each_robot_are_shuffled_where_the_same_robots_ran_both(tmp_path: Path) -> None:
    chance = random.Random(5)
    keep_robots(tmp_path / "kept", "a", chance)
    keep_robots(tmp_path / "kept", "b", chance, 0.5)
    (found,) = compare(engine.asked(str(tmp_path / "kept")), "label", ("a", "b"))
    assert (found.over, found.robots, found.runs) == ("runs of each robot", (3, 3), (75, 75))
    assert {(each.node, each.finding) for each in found.changes if each.finding} == {("Move", "slower")}
    keep(tmp_path / "kept", "b", drawn(chance, 25, 12.0, 0.5), "r3")
    (found,) = compare(engine.asked(str(tmp_path / "kept")), "label", ("a", "b"))
    assert (found.over, found.robots) == ("runs of each robot", (3, 4))


def test_a_version_compared_with_itself_on_robots_of_different_speed(tmp_path: Path) -> None:
    for seed in share_of(range(12), 4):
        chance = random.Random(seed)
        keep_robots(tmp_path / str(seed), "a", chance)
        keep_robots(tmp_path / str(seed), "b", chance)
        (found,) = compare(engine.asked(str(tmp_path / str(seed))), "label", ("a", "b"))
        assert [each for each in found.changes if each.finding in ("slower", "faster")] == []


def test_failures_are_compared_within_each_robot(tmp_path: Path) -> None:
    """A robot that fails half of the time runs more with the second version: neither is less reliable."""
    chance = random.Random(4)
    for label, shares in (("a", (120, 40)), ("b", (40, 120))):
        for robot, runs, fails in zip(("good", "bad"), shares, (0.01, 0.5), strict=True):
            keep(tmp_path / "kept", label, drawn(chance, runs, fails=fails), robot)
    (found,) = compare(engine.asked(str(tmp_path / "kept")), "label", ("a", "b"))
    (dock,) = (each for each in found.changes if (each.node, each.what) == ("Dock", "failures"))
    assert (dock.counts, dock.finding) == ((160, 160), "")
    assert dock.failed is not None
    before, after = dock.failed
    assert exact([((before, 160), (after, 160))]) < 0.001


def test_robots_that_ran_several_versions(tmp_path: Path) -> None:
    """Their runs are of several labels unless one is taken, and the report says so."""
    runs = [(10.0, 5.0, True)] * 2
    for label, robot in (("v1", "r1"), ("v1", "r2"), ("v2", "r2"), ("v3", "r3"), ("v2", "r2")):
        keep(tmp_path / "kept", label, runs, robot)
    line = (
        "several labels are compared at once: r1 ran v1 (2); r2 ran v1 (2), v2 (4); --label LABEL takes the runs of one"
    )
    code, output, errors = run_btq("compare", "kept", "--by", "robot", "r1", "r2", cwd=tmp_path)
    assert (code, errors, line in output.splitlines()) == (0, "", True)
    code, output, errors = run_btq("compare", "kept", "--by", "robot", "r1", "r2", "--label", "v1", cwd=tmp_path)
    assert (code, errors, "several labels" in output) == (0, "", False)
    assert output.startswith("main: 2 runs of r1 (2026-11-20 08:01–08:02 UTC), 2 runs of r2 (")
    _, output, _ = run_btq("compare", "kept", "--by", "robot", "r1", "r2", "--format", "json", cwd=tmp_path)
    document = json.loads(output)
    assert list(violations(document, SCHEMA)) == []
    assert document["missions"][0]["labels"] == [{"v1": 2}, {"v1": 2, "v2": 4}]
    refused = run_btq("compare", "kept", "--by", "robot", "r1", "r2", "--label", "v2", cwd=tmp_path)
    assert refused == (2, "", "btq compare: no run has the robot r1; there are r2 with the label v2\n")


def test_many_runs_are_shuffled_in_groups(tmp_path: Path) -> None:
    chance = random.Random(3)
    keep(tmp_path / "kept", "a", drawn(chance, 600, 10.0))
    keep(tmp_path / "kept", "b", drawn(chance, 900, 10.1))
    (found,) = compare(engine.asked(str(tmp_path / "kept")), "label", ("a", "b"), 0.005)
    assert (found.group, found.changes[1].units) == (3, (200, 300))
    assert {(each.node, each.what) for each in found.changes if each.finding == "slower"} == {("Move", "mean")}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("kept", "v1", "v3"), "no run has the label v3; there are v1, v2"),
        (("kept", "v1"), "one label given; compare two, as in btq compare kept A B"),
        (("kept", "v1", "v2", "--label", "v1"), "--label goes with --by robot"),
        (("kept", "v1", "v1"), "both sides are v1"),
        (("gone", "v1", "v2"), "gone: no verdicts are kept there; keep some with btq verify LOG --store gone"),
        (("kept", "v1", "v2", "-o", "x.pdf"), "cannot write .pdf; " + CHOICE),
        (("kept", "v1", "v2", "-o", "x.svg"), "cannot write .svg; " + CHOICE),
    ],
)
def test_what_cannot_be_compared(arguments: tuple[str, ...], message: str, changed: Path) -> None:
    assert run_btq("compare", *arguments, cwd=changed) == (2, "", f"btq compare: {message}\n")


@pytest.mark.parametrize("first", [(0, 5), (3, 10), (1, 40), (20, 20)])
@pytest.mark.parametrize("second", [(4, 5), (3, 12), (9, 30)])
def test_fisher_is_the_sum_of_all_tables_that_are_as_unlikely(first: tuple[int, int], second: tuple[int, int]) -> None:
    (failed, n), (other, m) = first, second
    both = failed + other
    ways = [comb(n, each) * comb(m, both - each) for each in range(max(0, both - m), min(both, n) + 1)]
    observed = comb(n, failed) * comb(m, other)
    expected = sum(each for each in ways if each <= observed) / comb(n + m, both)
    assert exact([(first, second)]) == pytest.approx(expected, rel=1e-9)


def test_the_exact_test_of_several_robots() -> None:
    """By hand: of each robot, in 1 of 2 ways, or in 2, 8 or 2 of 12, the failure or two are on the first side."""
    one, three = ((1, 1), (0, 1)), ((2, 3), (0, 1))
    assert exact([one]) == pytest.approx(1)
    assert exact([one, one]) == pytest.approx(1 / 2)  # 1, 2, 1 of 4 ways for 0, 1, 2
    assert exact([three]) == pytest.approx(1)  # 1 of the first and the other, or both of the first: 3 of 6 ways each
    assert exact([one] * 10) == pytest.approx(2 / 1024)
    assert exact([((3, 3), (0, 3)), ((2, 2), (0, 2))]) == pytest.approx(2 / (20 * 6))
    assert exact([((4, 5), (0, 0)), ((3, 3), (0, 3))]) == pytest.approx(2 / 20)  # a robot that ran one side only


def test_robots_of_different_reliability_in_unequal_shares_explain_nothing() -> None:
    """Two robots fail in 50 % and in 1 % of runs, with both versions; pooled, nearly all splits seem to differ."""
    chance = random.Random(3)
    found = pooled = 0

    def failed(rate: float, runs: int) -> int:
        return sum(chance.random() < rate for _ in range(runs))

    for _ in range(1000):
        one, other = (failed(0.5, 60), failed(0.5, 20)), (failed(0.01, 20), failed(0.01, 60))
        found += exact([((one[0], 60), (one[1], 20)), ((other[0], 20), (other[1], 60))]) <= 0.05
        pooled += exact([((one[0] + other[0], 80), (one[1] + other[1], 80))]) <= 0.05
    assert (found, pooled) == (44, 966)


def test_shuffles_agree_with_fisher_where_each_run_fails_or_not() -> None:
    scores = [failed - 0.3 for failed in [True] * 7 + [False] * 33 + [True] * 17 + [False] * 23]
    assert sum(scores) == pytest.approx(0)
    side = [""] * 40
    assert Shuffles(side, side).probability(scores, 10_000) == pytest.approx(exact([((7, 40), (17, 40))]), rel=0.15)


def test_holm() -> None:
    assert holm([0.01, 0.04, 0.03, 0.5]) == pytest.approx([0.04, 0.09, 0.09, 0.5])
    assert holm([]) == []


def test_as_many_shuffles_as_comparisons_need() -> None:
    assert [shuffles_for(number) for number in (12, 250, 1000)] == [10_000, 10_000, 40_000]


def test_how_few_units_show_nothing() -> None:
    assert [is_too_few([(size, size)], 1) for size in (3, 4)] == [True, False]  # 2 of 20 ways, 2 of 70
    assert [is_too_few([(size, size)], 12) for size in (5, 6)] == [True, False]  # of 252, of 924
    assert [is_too_few(sizes, 1) for sizes in ([(3, 3)] * 2, [(1, 18)], [(1, 19)], [(4, 0)])] == [
        False,
        True,
        False,
        True,
    ]


def test_the_table_of_the_page() -> None:
    page = (Path(__file__).parents[3] / "docs" / "evidence-store.md").read_text(encoding="utf-8")
    assert f"$ btq compare evidence v1 v2\n{TABLE}```" in page
