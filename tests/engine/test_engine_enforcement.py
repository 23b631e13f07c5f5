"""What a build puts around nodes, at work: a node that breaks the bound makes the tree fail, and one that keeps it
leaves the tree as it is without.

Each case is ticked in four ways: the plain tree and the tree with guards, with parts that break the bound and with
parts that keep it.  Broken, the plain tree succeeds, so that what fails is the guard and nothing else.

A machine that is busy with other things makes everything take longer, so a bound in time is kept by parts that take no
time at all, or a small part of it, and broken by parts that take at least ten times as long.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pytest
from engine_loader import Answer, Engine, job

from btq_lang.btcpp.document import write
from btq_lang.btcpp.enforcement import enforced
from btq_lang.btcpp.export import export
from btq_lang.btcpp.outputs import bundle
from btq_lang.checks import check
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.workspace.workspace import Workspace

Parts = Mapping[str, Sequence[Any]]

MOVE_THEN_REST = """
Root Main
BehaviorTree Main
    ->
        Move
        Rest
"""

# The failure of Move is swallowed: only what halts the mission is seen at its root.
SWALLOWED = """
Root Main
BehaviorTree Main
    ->
        Fallback
            Move
            Plan_B
        Rest
"""


def step(status: str, **write: object) -> dict[str, object]:
    return {"status": status, "write": write}


def plain(text: str) -> str:
    return write(export(Workspace.of({"main.btq": text}), "main.btq").document)


def guarded(text: str) -> str:
    """The XML with what its requirements add; each of their clauses is said to be enforced."""
    workspace = Workspace.of({"main.btq": text})
    assert problems(workspace) == []
    done = enforced(workspace, "main.btq", export(workspace, "main.btq"))
    clauses = [held for applied in done.clauses for held in applied]
    assert {held.way for held in clauses} == {"enforced"}
    assert all(held.why == "" or held.why.startswith(("as a limit on", "the mission ends if")) for held in clauses)
    return write(done.export.document)


def problems(workspace: Workspace) -> list[Diagnostic]:
    return [each for file in workspace.files.values() for each in file.parsed.diagnostics]


def run(engine: Engine, xml: str, parts: Parts, **what: Any) -> Answer:
    return run_all(engine, [(xml, what)], parts)[0]


def run_all(engine: Engine, xmls: Sequence[tuple[str, Mapping[str, Any]]], parts: Parts) -> list[Answer]:
    """What some trees do with the same parts; a part of which nothing is said takes two ticks."""
    answers = engine.run(job(xml, parts=parts, **{"ticks": 10_000, "seconds": 60, **what}) for xml, what in xmls)
    assert {(answer.stage, answer.crashed, answer.error) for answer in answers} == {("done", 0, "")}
    return answers


def without_and_with(engine: Engine, text: str, parts: Parts, tick_ms: int, **what: Any) -> list[Answer]:
    """What a tree does without its guards and with them; only guards can mind how long it takes."""
    return run_all(engine, [(plain(text), what), (guarded(text), {**what, "tick_ms": tick_ms})], parts)


def assert_fails(engine: Engine, text: str, parts: Parts, tick_ms: int = 1, **what: Any) -> Answer:
    """The tree fails because of its guards, and of nothing else."""
    before, after = without_and_with(engine, text, parts, tick_ms, **what)
    assert (before.status, after.status) == ("SUCCESS", "FAILURE")
    return after


def assert_unchanged(
    engine: Engine, text: str, parts: Parts, names: Sequence[str] = ("Move",), tick_ms: int = 0, **what: Any
) -> Answer:
    """The tree ends as it does without its guards, in the same tick, and its nodes go through the same."""
    before, after = without_and_with(engine, text, parts, tick_ms, **what)
    assert (after.status, after.ticks) == (before.status, before.ticks)
    for name in names:
        assert after.statuses(name) == before.statuses(name)
    return after


SPEED = "signal speed : m/s from {speed} initially 0 m/s\n"
BATTERY = "signal battery : % from {battery} level initially 80 %\n"
ENERGY = "signal energy : Wh from {energy} counter initially 0 Wh\n"
PEOPLE = "signal people : person from {people} initially 0 person\ncontext near : people > 0 person\n"

SLOW: Parts = {"Move": ["RUNNING"] * 5_000 + ["SUCCESS"]}  # with a millisecond between ticks
QUICK: Parts = {"Move": ["RUNNING", "SUCCESS"]}

# Clauses of Move, with the signals they need, parts that break them and parts that keep them.
CASES: dict[str, tuple[str, str, Parts, Parts]] = {
    "takes": ("", "takes at most 200 ms", SLOW, QUICK),
    "less": ("", "takes less than 200 ms", SLOW, QUICK),
    "succeeds": ("", "succeeds within 200 ms", SLOW, QUICK),
    "takes_table": (
        PEOPLE,
        "takes at most 10 min if near else 200 ms",
        SLOW,
        QUICK,
    ),
    "takes_table_other_case": (
        PEOPLE.replace("initially 0", "initially 1"),
        "takes at most 200 ms if near, 1 h if not near else 2 h",
        SLOW,
        QUICK,
    ),
    "takes_when": (PEOPLE.replace("initially 0", "initially 1"), "takes at most 200 ms\n    when near", SLOW, QUICK),
    "needs": (
        BATTERY,
        "needs battery >= 20 %",
        {"First": [step("SUCCESS", battery=19.0)]},
        {"First": [step("SUCCESS", battery=20.0)]},
    ),
    "needs_when": (
        BATTERY + PEOPLE,
        "needs battery >= 20 %\n    when near",
        {"First": [step("SUCCESS", battery=19.0, people=1.0)]},
        {"First": [step("SUCCESS", battery=19.0)]},
    ),
    "keeps": (
        SPEED,
        "keeps speed <= 900 m/h",
        {"Move": ["RUNNING", step("RUNNING", speed=0.26), "RUNNING", "SUCCESS"]},
        {"Move": ["RUNNING", step("RUNNING", speed=0.24), "RUNNING", "SUCCESS"]},
    ),
    "keeps_chain": (
        SPEED,
        "keeps -1 m/s < speed <= 2 m/s",
        {"Move": ["RUNNING", step("RUNNING", speed=-1.0), "RUNNING", "SUCCESS"]},
        {"Move": ["RUNNING", step("RUNNING", speed=2.0), "RUNNING", "SUCCESS"]},
    ),
    "keeps_while": (
        SPEED + PEOPLE,
        "keeps speed <= 0.25 m/s\n    while near",
        {"Move": [step("RUNNING", speed=1.0), step("RUNNING", people=2.0), "RUNNING", "SUCCESS"]},
        {"Move": [step("RUNNING", speed=1.0), step("RUNNING", people=0.0), "RUNNING", "SUCCESS"]},
    ),
    "keeps_when": (
        SPEED + PEOPLE.replace("initially 0", "initially 1"),
        "keeps speed <= 0.25 m/s\n    when near",
        {"Move": [step("RUNNING", people=0.0), step("RUNNING", speed=1.0), "RUNNING", "SUCCESS"]},
        {"First": [step("SUCCESS", people=0.0)], "Move": [step("RUNNING", people=1.0, speed=1.0), "SUCCESS"]},
    ),
    "keeps_choice": (
        SPEED + PEOPLE,
        "keeps speed <= (900 m/h if near else 1 m/s)",
        {"Move": [step("RUNNING", speed=1.0), step("RUNNING", people=2.0), "RUNNING", "SUCCESS"]},
        {"Move": [step("RUNNING", speed=1.0), step("RUNNING", people=1.0, speed=0.25), "RUNNING", "SUCCESS"]},
    ),
    "keeps_other_units": (
        "signal heat : degC from {heat} initially 20 degC\nsignal limit : K from {limit} initially 300 K\n",
        "keeps heat < limit",
        {"Move": ["RUNNING", step("RUNNING", heat=26.9), "RUNNING", "SUCCESS"]},
        {"Move": ["RUNNING", step("RUNNING", heat=26.8), "RUNNING", "SUCCESS"]},
    ),
    "keeps_sum": (
        SPEED + "signal wind : km/h from {wind} initially 3.6 km/h\n",
        "keeps speed - wind * 2 >= -3 m/s",
        {"Move": ["RUNNING", step("RUNNING", speed=-1.1), "RUNNING", "SUCCESS"]},
        {"Move": ["RUNNING", step("RUNNING", speed=-0.9), "RUNNING", "SUCCESS"]},
    ),
    "never": (
        'signal door : bool from {door} initially false\nsignal mode : text from {mode} initially "idle"\n',
        'never door or mode == "lost"',
        {"Move": ["RUNNING", step("RUNNING", mode="lost"), "RUNNING", "SUCCESS"]},
        {"Move": ["RUNNING", step("RUNNING", mode="found"), "RUNNING", "SUCCESS"]},
    ),
    "never_bool": (
        "signal door : bool from {door} initially false\n",
        "never door",
        {"Move": ["RUNNING", step("RUNNING", door=True), "RUNNING", "SUCCESS"]},
        {"Move": ["RUNNING", step("RUNNING", door=False), "RUNNING", "SUCCESS"]},
    ),
    "leaves": (
        BATTERY,
        "leaves battery >= 3 %",
        {"Move": [step("RUNNING", battery=2.0), "SUCCESS"]},
        {"Move": [step("RUNNING", battery=2.0), step("SUCCESS", battery=3.0)]},
    ),
    "ends_with": (
        BATTERY,
        "ends with battery >= 3 %",
        {"Move": [step("RUNNING", battery=2.0), "SUCCESS"]},
        {"Move": [step("RUNNING", battery=2.0), step("SUCCESS", battery=3.0)]},
    ),
    "leaves_when": (
        BATTERY + PEOPLE,
        "leaves battery >= 3 %\n    when near",
        {"First": [step("SUCCESS", people=1.0)], "Move": [step("SUCCESS", battery=2.0, people=0.0)]},
        {"Move": [step("SUCCESS", battery=2.0, people=1.0)]},
    ),
    "uses_of_counter": (
        ENERGY,
        "uses at most 0.02 kWh of energy",
        {
            "First": [step("SUCCESS", energy=100.0)],
            "Move": ["RUNNING", step("RUNNING", energy=121.0), "RUNNING", "SUCCESS"],
        },
        {
            "First": [step("SUCCESS", energy=100.0)],
            "Move": ["RUNNING", step("RUNNING", energy=120.0), "RUNNING", "SUCCESS"],
        },
    ),
    "uses_of_level_in_the_last_tick": (
        BATTERY,
        "uses less than 5 % of battery",
        {"Move": ["RUNNING", step("SUCCESS", battery=75.0)]},
        {"Move": ["RUNNING", step("SUCCESS", battery=75.5)]},
    ),
    "uses_when": (
        BATTERY + PEOPLE,
        "uses less than 5 % of battery\n    when near",
        {
            "First": [step("SUCCESS", people=1.0)],
            "Move": ["RUNNING", step("RUNNING", battery=70.0), "RUNNING", "SUCCESS"],
        },
        {"Move": ["RUNNING", step("RUNNING", battery=70.0), "RUNNING", "SUCCESS"]},
    ),
    "needs_table": (
        BATTERY + PEOPLE,
        "uses at most 5 % if near else 10 % of battery",
        {"Move": ["RUNNING", step("RUNNING", battery=69.0), "RUNNING", "SUCCESS"]},
        {"Move": ["RUNNING", step("RUNNING", battery=71.0), "RUNNING", "SUCCESS"]},
    ),
}


def mission(case: str, action: str, tree: str) -> str:
    signals, clause, _, _ = CASES[case]
    text = f"{signals}QualityReq rq1\n    Move {clause}\n    on violation {action}\n{tree}"
    return text.replace("    ->\n", "    ->\n        First\n", 1)


@pytest.mark.parametrize("case", CASES)
def test_a_broken_bound_is_a_failure_and_a_kept_one_nothing(engine: Engine, case: str) -> None:
    _, _, broken, kept = CASES[case]
    text = mission(case, "fail", MOVE_THEN_REST)
    answer = assert_fails(engine, text, broken)
    assert answer.statuses("Rest") == []
    assert_unchanged(engine, text, kept)


@pytest.mark.parametrize("case", CASES)
def test_a_broken_bound_halts_the_mission_whoever_swallows_failures(engine: Engine, case: str) -> None:
    _, _, broken, kept = CASES[case]
    assert run(engine, guarded(mission(case, "fail", SWALLOWED)), broken, tick_ms=1).status == "SUCCESS"
    text = mission(case, "halt", SWALLOWED)
    answer = assert_fails(engine, text, {**broken, "Rest": ["RUNNING"] * 9 + ["SUCCESS"]})
    assert "SUCCESS" not in answer.statuses("Rest")
    assert_unchanged(engine, text, kept)


@pytest.mark.parametrize("case", CASES)
def test_what_breaks_in_the_last_tick_makes_the_mission_fail(engine: Engine, case: str) -> None:
    _, _, broken, _ = CASES[case]
    assert_fails(engine, mission(case, "halt", SWALLOWED), {**broken, "Rest": ["SUCCESS"], "Plan_B": ["SUCCESS"]})


def test_a_node_that_is_late_is_halted(engine: Engine) -> None:
    answer = run(engine, guarded(mission("takes", "fail", MOVE_THEN_REST)), SLOW, tick_ms=1)
    assert answer.statuses("Move") == ["RUNNING", "IDLE"]


# ---- halting for the right reason ----


def test_a_node_that_fails_in_time_halts_no_mission(engine: Engine) -> None:
    text = f"QualityReq rq1\n    Move takes at most 10 s\n    on violation halt\n{SWALLOWED}"
    assert_unchanged(engine, text, {"Move": ["RUNNING", "FAILURE"]})


def test_a_tighter_limit_of_another_requirement_is_not_this_one(engine: Engine) -> None:
    text = "QualityReq rq1\n    Move takes at most 10 s\n    on violation halt\n"
    text += f"QualityReq rq2\n    Move takes at most 200 ms\n    on violation fail\n{SWALLOWED}"
    answer = run(engine, guarded(text), SLOW, tick_ms=1)
    assert (answer.status, answer.statuses("Move")) == ("SUCCESS", ["RUNNING", "IDLE"])


def test_who_must_succeed_and_fails_halts_the_mission(engine: Engine) -> None:
    for clause in ("succeeds", "succeeds within 10 s"):
        text = f"QualityReq rq1\n    Move {clause}\n    on violation halt\n{SWALLOWED}"
        assert_fails(engine, text, {"Move": ["RUNNING", "FAILURE"]})
        assert_unchanged(engine, text, QUICK)


@pytest.mark.parametrize(("battery", "status"), [(3.0, "SUCCESS"), (2.0, "FAILURE")])
def test_what_a_failure_ends_with_halts_the_mission(engine: Engine, battery: float, status: str) -> None:
    text = f"{BATTERY}QualityReq r\n    Move ends with battery >= 3 %\n    on violation halt\n{SWALLOWED}"
    parts = {"Move": ["RUNNING", step("FAILURE", battery=battery)]}
    before, after = without_and_with(engine, text, parts, 1)
    assert (before.status, after.status) == ("SUCCESS", status)


def test_a_bound_on_the_mission(engine: Engine) -> None:
    for action in ("fail", "halt"):
        text = f"QualityReq rq1\n    mission takes at most 200 ms\n    on violation {action}\n{SWALLOWED}"
        assert_fails(engine, text, SLOW)
        assert_unchanged(engine, text.replace("200 ms", "20 s"), QUICK)


# ---- from one node to another ----


TRIP = """
Root Main
BehaviorTree Main
    ->
        Fallback
            -> Trip
                -> Grasp
                    Pick
                    Lift
                Move
                Place
            Plan_B
        Rest
"""
# None of them takes long, all together do.
LONG_TRIP = TRIP.replace("                Move", "                Repeat (num_cycles = 1000)\n                    Move")


@pytest.mark.parametrize("span", ["Pick starts to Place succeeds", "Pick starts to Place finishes"])
@pytest.mark.parametrize("action", ["fail", "halt"])
def test_a_way_from_one_node_to_another_that_is_a_sequence(engine: Engine, span: str, action: str) -> None:
    text = f"QualityReq rq1\n    from {span} takes at most 500 ms\n    on violation {action}\n"
    plan = "Plan_B" if action == "halt" else "AlwaysFailure"
    answer = assert_fails(engine, text + TRIP.replace("Plan_B", plan), SLOW)
    assert (answer.statuses("Move"), answer.statuses("Place")) == (["RUNNING", "IDLE"], [])
    answer = assert_fails(engine, text + LONG_TRIP.replace("Plan_B", plan), {}, tick_ms=5)
    assert answer.statuses("Pick") == ["RUNNING", "SUCCESS", "IDLE"]
    assert "SUCCESS" in answer.statuses("Move")
    assert answer.statuses("Place") == []
    loose = text.replace("500 ms", "1 h")
    answer = assert_unchanged(engine, loose + LONG_TRIP, {}, ["Pick", "Lift", "Move", "Place"], tick_ms=1)
    assert answer.ticks > 1_000  # milliseconds, of which the tighter limit has half
    assert_unchanged(engine, text + TRIP, {}, ["Pick", "Lift", "Move", "Place"])


def test_a_way_from_one_node_to_another_begins_anew_with_its_sequence(engine: Engine) -> None:
    tree = TRIP.replace("            -> Trip", "            Retry (num_attempts = 800)\n             -> Trip")
    parts: Parts = {"Place": [["FAILURE"]] * 799 + [["SUCCESS"]]}
    text = f"QualityReq rq1\n    from Pick starts to Place succeeds takes at most 1 s\n    on violation halt\n{tree}"
    answer = assert_unchanged(engine, text, parts, ["Pick", "Lift", "Move", "Place"], tick_ms=1)
    assert answer.ticks > 2_000  # milliseconds, of which each attempt has a few


# ---- counters and flags ----


PICKS = """
Root Main
BehaviorTree Main
    ->
        -> Shelf
            Retry (num_attempts = 5)
                Pick
        -> Drawer
            Look
            Place
"""
FOUR_TRIES: Parts = {"Pick": [["RUNNING", "FAILURE"]] * 3 + [["RUNNING", "SUCCESS"]]}


@pytest.mark.parametrize("per", ["", " per Shelf", " per Main"])
@pytest.mark.parametrize("action", ["fail", "halt"])
def test_tries_are_counted(engine: Engine, per: str, action: str) -> None:
    text = f"QualityReq rq1\n    Pick tries at most 3{per}\n    on violation {action}\n{PICKS}"
    answer = assert_fails(engine, text, FOUR_TRIES)
    assert answer.statuses("Pick").count("RUNNING") == 3
    assert_unchanged(engine, text.replace("at most 3", "less than 5"), FOUR_TRIES, ["Pick"])


@pytest.mark.parametrize("per", ["run", "Shelf", "Main"])
@pytest.mark.parametrize("action", ["fail", "halt"])
def test_starts_and_successes_are_counted(engine: Engine, per: str, action: str) -> None:
    text = f"QualityReq rq1\n    Pick starts at most 3 per {per}\n    on violation {action}\n{PICKS}"
    answer = assert_fails(engine, text, FOUR_TRIES)
    assert answer.statuses("Pick").count("RUNNING") == 3
    assert_unchanged(engine, text.replace("at most 3", "less than 5"), FOUR_TRIES, ["Pick"])
    tree = PICKS.replace("Retry (num_attempts = 5)", "Repeat (num_cycles = 5)")
    for verb in ("succeeds", "finishes") if action == "halt" else ("succeeds",):
        text = f"QualityReq rq1\n    Pick {verb} at most 3 per {per}\n    on violation {action}\n{tree}"
        answer = assert_fails(engine, text, {})
        assert answer.statuses("Pick").count("SUCCESS") == 4
        assert_unchanged(engine, text.replace("at most 3", "less than 6"), {}, ["Pick"])


@pytest.mark.parametrize("per", ["run", "Shelf", "Main"])
@pytest.mark.parametrize("verb", ["fails", "finishes"])
def test_failures_are_counted_and_halt_the_mission(engine: Engine, per: str, verb: str) -> None:
    text = f"QualityReq rq1\n    Pick {verb} at most 2 per {per}\n    on violation halt\n{PICKS}"
    answer = assert_fails(engine, text, FOUR_TRIES)
    assert answer.statuses("Pick").count("FAILURE") == 3
    assert_unchanged(engine, text.replace("at most 2", "less than 5"), FOUR_TRIES, ["Pick"])


def test_results_are_counted_anew_for_each_activation(engine: Engine) -> None:
    tree = PICKS.replace("Retry (num_attempts = 5)", "Repeat (num_cycles = 2)")
    tree = tree.replace("        -> Shelf\n", "        Repeat (num_cycles = 3)\n          -> Shelf\n")
    text = f"QualityReq rq1\n    Pick succeeds at most 2 per Shelf\n    on violation fail\n{tree}"
    assert_unchanged(engine, text, {}, ["Pick"])
    assert_fails(engine, text.replace("per Shelf", "per run"), {})


def test_tries_are_counted_anew_for_each_activation(engine: Engine) -> None:
    tree = PICKS.replace("        -> Shelf\n", "        Repeat (num_cycles = 3)\n          -> Shelf\n")
    text = f"QualityReq rq1\n    Pick tries at most 2 per Shelf\n    on violation fail\n{tree}"
    parts: Parts = {"Pick": [["FAILURE"], ["SUCCESS"]] * 3}
    assert_unchanged(engine, text, parts, ["Pick"])
    assert_fails(engine, text.replace(" per Shelf", ""), parts)


@pytest.mark.parametrize("action", ["fail", "halt"])
@pytest.mark.parametrize(
    ("event", "broken", "kept"),
    [
        ("Look succeeds", {"Look": ["FAILURE"]}, {"Look": ["RUNNING", "SUCCESS"]}),
        ("Look fails", {"Look": ["SUCCESS"]}, {"Look": ["RUNNING", "FAILURE"]}),
        ("Look finishes", {"Pick": ["SUCCESS"]}, {"Pick": ["FAILURE"]}),
        ("Look starts", {"Pick": ["SUCCESS"]}, {"Pick": ["FAILURE"]}),
        ("Look fails or Pick succeeds", {"Look": ["SUCCESS"]}, {"Look": ["FAILURE"]}),
        ("Look fails or Look succeeds", {"Pick": ["SUCCESS"]}, {"Look": ["RUNNING", "SUCCESS"]}),
        ("Look fails or Look starts", {"Pick": ["SUCCESS"]}, {}),
    ],
)
def test_order(engine: Engine, action: str, event: str, broken: Parts, kept: Parts) -> None:
    tree = """
Root Main
BehaviorTree Main
    ->
        ?
            Pick
            Look
            AlwaysSuccess
        Place
"""
    text = f"QualityReq rq1\n    Place follows {event}\n    on violation {action}\n{tree}"
    assert_fails(engine, text, {"Pick": ["FAILURE"], **broken})
    assert_unchanged(engine, text, {"Pick": ["FAILURE"], **kept}, ["Place"])


@pytest.mark.parametrize("action", ["fail", "halt"])
@pytest.mark.parametrize(
    ("subject", "span", "broken", "kept"),
    [
        # The speed is too high while Carry runs, after Pick and before Place.
        ("Work", "from Pick succeeds until Place starts", {}, {"Pick": ["FAILURE"]}),
        ("Carry", "from Pick finishes until Place succeeds", {}, {"Carry": ["SUCCESS"]}),
        ("Work", "from Place fails or Pick starts until Place succeeds", {}, {"Carry": ["SUCCESS"]}),
        ("mission", "from mission starts until Pick fails", {}, {"Pick": ["FAILURE"]}),
        ("mission", "from Carry starts until mission finishes", {}, {"Carry": ["SUCCESS"]}),
        ("Work", "from Place starts until Pick starts", {"Place": [step("RUNNING", speed=2.0), "SUCCESS"]}, {}),
    ],
)
def test_from_an_event_until_another(
    engine: Engine, action: str, subject: str, span: str, broken: Parts, kept: Parts
) -> None:
    tree = """
Root Main
BehaviorTree Main
    R->
        -> Work
            ForceSuccess
                Pick
            Carry
            Place
"""
    text = f"{SPEED}QualityReq rq1\n    {subject} keeps speed <= 1 m/s\n    {span}\n    on violation {action}\n{tree}"
    carries: Parts = {"Carry": [step("RUNNING", speed=2.0), "RUNNING", step("SUCCESS", speed=0.0)]}
    assert_fails(engine, text, {**carries, **broken})
    assert_unchanged(engine, text, {**carries, **kept}, ["Carry", "Place"])


def test_each_start_needs_an_event_of_its_own(engine: Engine) -> None:
    tree = "Root Main\nBehaviorTree Main\n    ->\n        Look\n        Place\n        Place again\n"
    text = f"QualityReq rq1\n    again follows Look succeeds\n    on violation fail\n{tree}"
    assert_unchanged(engine, text, {}, ["again"])
    twice = text.replace("        Place again", "        Repeat (num_cycles = 2)\n            Place again")
    assert_fails(engine, twice, {})


def test_the_start_of_the_mission_is_an_event(engine: Engine) -> None:
    text = f"QualityReq rq1\n    Pick follows mission starts\n    on violation fail\n{PICKS}"
    assert_unchanged(engine, text, {}, ["Pick"])
    assert_fails(engine, text, FOUR_TRIES)


def test_events_and_counters_cross_trees(engine: Engine) -> None:
    tree = """
Root Main
BehaviorTree Main
    ->
        Look
        SubTree Part one
        SubTree Part two
BehaviorTree Part
    ->
        Place
"""
    order = f"QualityReq rq1\n    Place follows Look succeeds\n    on violation fail\n{tree}"
    assert_fails(engine, order, {})
    assert_unchanged(engine, order.replace("        SubTree Part two\n", ""), {}, ["Place"])
    tries = f"QualityReq rq1\n    Place tries at most 1 per Main\n    on violation fail\n{tree}"
    assert_fails(engine, tries, {})
    assert_unchanged(engine, tries.replace("at most 1", "at most 2"), {}, ["Place"])


# ---- where things stand ----


def test_trees_that_share_entries_and_run_at_once_do_not_share_those_of_guards(engine: Engine) -> None:
    text = ENERGY + "QualityReq rq1\n    Move uses at most 10 Wh of energy\n    on violation fail\n"
    text += """
Root Main
BehaviorTree Main
    Parallel
        -> Early
            SubTree Part one (_autoremap = true)
        -> Late
            Wait
            SubTree Part two (_autoremap = true)
BehaviorTree Part
    ->
        Move
"""
    parts: Parts = {
        "one/Move::7": ["RUNNING"],
        "Wait": [step("RUNNING", energy=6.0), step("SUCCESS", energy=6.0)],
        "Move": ["RUNNING", step("RUNNING", energy=12.0), "RUNNING", "SUCCESS"],
    }
    assert_fails(engine, text, parts)  # the first one has used 12 Wh, whatever the second one began with


def test_what_may_be_skipped_stays_skipped(engine: Engine) -> None:
    text = f"""
{SPEED}QualityReq rq1
    takes at most 200 ms
    needs speed <= 1 m/s
    keeps speed <= 1 m/s
    leaves speed <= 1 m/s
    on violation halt
Root Main
BehaviorTree Main
    ?
        -> Only
            Action Move (_skipIf = "@off == 1") satisfies rq1
        Plan_B
"""
    for off in (0, 1):
        assert_unchanged(engine, text, QUICK, ["Plan_B"], blackboard={"off": off})
    assert run(engine, guarded(text), QUICK, blackboard={"off": 1}).statuses("Plan_B") != []


def test_what_runs_only_while_a_condition_holds_is_halted_and_skipped(engine: Engine) -> None:
    text = f"""
{SPEED}QualityReq rq1
    keeps speed <= 1 m/s
    on violation fail
Root Main
BehaviorTree Main
    ->
        Move (_while = "go == 1" _failureIf = "go == 7") satisfies rq1
        Rest
"""
    parts: Parts = {"Move": ["RUNNING", step("RUNNING", go=0), "RUNNING", "SUCCESS"]}
    assert_unchanged(engine, text, parts, ["Move", "Rest"], blackboard={"go": 1})
    for xml in (plain(text), guarded(text)):
        assert run(engine, xml, parts, blackboard={"go": 7}).status == "FAILURE"


@pytest.mark.parametrize("ready", ["SUCCESS", "FAILURE"])
def test_children_keep_their_places(engine: Engine, ready: str) -> None:
    text = f"""
{SPEED}QualityReq rq1
    takes at most 10 s
    needs speed <= 1 m/s
    keeps speed <= 1 m/s
    leaves speed <= 1 m/s
    on violation halt
apply rq1 to Then, Else
Root Main
BehaviorTree Main
    R->
        IfThenElse
            Condition Ready
            Action Move Then
            SubTree Part Else
BehaviorTree Part
    Rest
"""
    parts: Parts = {"Ready": [ready]}
    assert_unchanged(engine, text, parts, ["Then", "Else"])


def test_several_requirements_on_a_node(engine: Engine) -> None:
    text = f"""
{SPEED}{BATTERY}QualityReq rq1
    takes at most 200 ms
    on violation fail
QualityReq rq2
    needs battery >= 50 %
    keeps speed <= 1 m/s
    on violation fail
QualityReq rq3
    keeps speed <= 2 m/s
    leaves battery >= 70 %
    on violation fail
apply rq1, rq2, rq3 to Move
Root Main
BehaviorTree Main
    ->
        First
        Move
"""
    assert_unchanged(engine, text, QUICK)
    assert_fails(engine, text, SLOW)
    assert_fails(engine, text, {"First": [step("SUCCESS", battery=40.0)], "Move": [step("SUCCESS", battery=80.0)]})
    assert_fails(engine, text, {"Move": ["RUNNING", step("RUNNING", speed=1.5), "RUNNING", "SUCCESS"]})
    assert_fails(engine, text, {"Move": ["RUNNING", step("SUCCESS", battery=60.0)]})


# ---- signals without a first value ----


def test_a_signal_that_somebody_writes_first_needs_no_first_value(engine: Engine) -> None:
    text = "signal speed : m/s from {speed}\nQualityReq rq1\n    Move keeps speed <= 1 m/s\n    on violation fail\n"
    text += "Root Main\nBehaviorTree Main\n    ->\n        First\n        Move\n"
    workspace = Workspace.of({"main.btq": text})
    done = enforced(workspace, "main.btq", export(workspace, "main.btq"))
    assert done.clauses[0][0].why == "the mission ends if a guard reads `speed` before anything writes it"
    xml = write(done.export.document)
    written: Parts = {"First": [step("SUCCESS", speed=0.5)]}
    assert run(engine, xml, written).status == "SUCCESS"
    answer = engine.run_one(xml, ticks=9)
    assert answer.stage == "tick"
    assert "Variable not found: @speed" in answer.error


FIRST = (
    'signal speed : m/s from {speed} initially 0 m/s\nsignal mode : text from {mode} initially "idle"\n'
    "signal door : bool from {door} initially false\n"
    'QualityReq rq1\n    Move needs speed <= 1 m/s and not door and mode == "idle"\n    on violation fail\n'
)


@pytest.mark.parametrize("known", [{"speed": 2.0}, {"mode": "lost"}, {"door": True}])
def test_a_first_value_is_none_where_somebody_has_written_one(engine: Engine, known: dict[str, object]) -> None:
    text = f"{FIRST}{MOVE_THEN_REST}"
    assert run(engine, guarded(text), {}).status == "SUCCESS"
    assert run(engine, guarded(text), {}, blackboard={"speed": 1.0}).status == "SUCCESS"
    assert run(engine, guarded(text), {}, blackboard=known).status == "FAILURE"


def test_when_the_tree_runs_again_the_last_values_count(engine: Engine) -> None:
    text = FIRST + "Root Main\nBehaviorTree Main\n    ->\n        Move\n        Measure\n"
    xml = guarded(text)
    begins, ends = '<Sequence name="btq_init"', "</Sequence>\n  </BehaviorTree>"
    assert (xml.count(begins), xml.count(ends)) == (1, 1)
    again = xml.replace(begins, f'<Repeat num_cycles="3">{begins}').replace(ends, "</Sequence></Repeat></BehaviorTree>")
    parts: Parts = {"Measure": [[step("SUCCESS", speed=0.5)], [step("SUCCESS", speed=1.5)]]}
    answer = run(engine, again, parts)
    assert (answer.status, answer.statuses("Measure").count("SUCCESS")) == ("FAILURE", 2)
    assert run(engine, again, {}).status == "SUCCESS"


# ---- values that nobody writes meanwhile ----

SENSED = "signal speed : m/s from {speed} initially 0 m/s\nQualityReq q\n    Move keeps speed <= 1 m/s\n"
SENSED += (
    "    on violation halt\nCondition Sense\n    output speed : double\nAction Move\nRoot Main\nBehaviorTree Main\n"
)


@pytest.mark.parametrize(
    ("tree", "fires"),
    [
        ("->\n    {}\n    Move", False),
        ("IfThenElse\n    {}\n    Move", False),
        ("->\n    Move\n    {}", False),
        ("R->\n    {}\n    Move", True),
        ("R->\n    {}\n    ->\n        AlwaysSuccess\n        Move", True),
        ("||\n    Repeat (num_cycles = 5)\n        {}\n    Move", True),
    ],
)
def test_a_guard_sees_only_what_is_written_meanwhile(engine: Engine, tree: str, fires: bool) -> None:
    lines = tree.replace("{}", "Sense (speed = {@speed})").split("\n")
    text = SENSED + "".join(f"    {line}\n" for line in lines)
    found = [each.rule for each in check(Workspace.of({"main.btq": text}), "main.btq")]
    assert found == ([] if fires else ["guard-never-renewed"])
    # Whoever is asked again says that the robot has become too fast.
    slow, fast = ({"status": "SUCCESS", "output": {"speed": speed}} for speed in (0.5, 9.0))
    parts: Parts = {"Sense": [[slow], [fast]], "Move": ["RUNNING"] * 3 + ["SUCCESS"]}
    answer = run(engine, guarded(text), parts)
    assert answer.status == ("FAILURE" if fires else "SUCCESS")


def test_in_a_loop_such_a_guard_decides_at_the_start(engine: Engine) -> None:
    lines = ["Repeat (num_cycles = 2)", "    ->", "        Sense (speed = {@speed})", "        Move"]
    text = SENSED + "".join(f"    {line}\n" for line in lines)
    slow, fast = ({"status": "SUCCESS", "output": {"speed": speed}} for speed in (0.5, 9.0))
    answer = run(engine, guarded(text), {"Sense": [[slow], [fast]], "Move": ["RUNNING", "SUCCESS"]})
    assert (answer.status, answer.statuses("Sense").count("SUCCESS")) == ("FAILURE", 2)
    assert answer.statuses("Move") == ["RUNNING", "SUCCESS", "IDLE"]  # it was not started again


# ---- several files ----


PARTS = {
    "shared.btq": "signal speed : m/s from {speed} initially 0 m/s\nQualityReq safe\n    keeps speed <= 1 m/s\n"
    "    on violation halt\n",
    "skills.btq": 'include "shared.btq"\nBehaviorTree Drive\n    Move satisfies safe\n',
    "main.btq": 'include "skills.btq"\nRoot Main\nBehaviorTree Main\n    ->\n        Fallback\n'
    "            SubTree Drive (speed = {speed})\n            Plan_B\n        Rest\n",
}


@pytest.mark.parametrize("bundled", [False, True], ids=["files", "bundle"])
def test_an_included_file_halts_the_mission(engine: Engine, bundled: bool, tmp_path: Path) -> None:
    workspace = Workspace.of(PARTS)
    for path in ("main.btq",) if bundled else PARTS:
        done = bundle(workspace, path) if bundled else export(workspace, path)
        xml = write(enforced(workspace, path, done, bundled).export.document)
        (tmp_path / path).with_suffix(".xml").write_text(xml, encoding="utf-8")
    slow: Parts = {"Move": ["RUNNING", step("RUNNING", speed=0.9), "RUNNING", "SUCCESS"]}
    fast: Parts = {"Move": ["RUNNING", step("RUNNING", speed=1.1), "RUNNING", "SUCCESS"], "Rest": ["RUNNING"] * 5}
    broken, kept = engine.run(job(tmp_path / "main.xml", parts=parts, ticks=50) for parts in (fast, slow))
    assert (broken.stage, broken.status) == ("done", "FAILURE")
    assert "SUCCESS" not in broken.statuses("Rest")
    assert (kept.stage, kept.status) == ("done", "SUCCESS")


# ---- classic files ----


def test_a_script_in_a_description_is_enforced(engine: Engine) -> None:
    tree = 'Root Main\nBehaviorTree Main\n    ->\n        First\n        Move (satisfies QualityReq ID = "rq1"'
    for word, kept, broken in (("SuccessIf", 30, 10), ("FailureIf", 10, 30)):
        text = f'{tree} description = "{word} battery > 20")\n        Rest\n'
        parts: Parts = {"Move": ["RUNNING", step("RUNNING", battery=broken), "RUNNING", "SUCCESS"]}
        assert_fails(engine, text, parts, blackboard={"battery": kept})
        assert_unchanged(engine, text, QUICK, blackboard={"battery": kept})
