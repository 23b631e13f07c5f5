"""Which node of a log is which written node: builds of today, other builds, older texts, other missions."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path
from typing import Any

import pytest
from evidence_logs import MAIN, MAIN_XML, START, Verify, btlog, rows
from json_schema import violations

from btq_lang.cli import main
from btq_lang.commands.candidates import candidates
from btq_lang.evidence.identity import join
from btq_lang.evidence.readers import btlog as btlog_reader

SCHEMA = json.loads((Path(__file__).parents[2] / "btq_lang/evidence/verdicts.schema.json").read_text(encoding="utf-8"))
DEMAND = "QualityReq rq : safety\n    Carry/Move takes at most 10 ms\n    on violation fail\n"
MISSION = (
    DEMAND
    + "Root Main\nBehaviorTree Main\n    ->\n        Action Undock\n        SubTree Carry\n        SubTree Carry Back\n"
    "BehaviorTree Carry\n    ->\n        Action Move\n        Action Pick\nAction Undock\nAction Move\nAction Pick\n"
)
OTHER = MAIN.replace("Main", "Other").replace("Move", "Wash").replace("Pick", "Rinse")


def log_of(verify: Verify, mission: str, text: str, *options: str) -> None:
    """Write a log of what a build makes of a mission."""
    (verify.folder / "run.btlog").write_bytes(btlog(verify.build(mission, *options), rows(text)))


def identity(verify: Verify, *missions: str) -> tuple[str, int, int]:
    """How the nodes of the log are found, how many, and of how many."""
    given = [word for mission in missions or ("main.btq",) for word in ("--mission", mission)]
    (source,) = verify.json("run.btlog", *given)["sources"]
    return source["identity"], source["joined"], source["nodes"]


# With guards: 1 Sequence, 2 Undock, 3 Carry, 4 Sequence, 5 Timeout, 6 Move, 7 Pick, 8 Back, 9 Sequence, 10 Timeout …
GUARDED = "0 1R 2S 3R 4R 5R 6R 8 6S 5S 7S 4S 3S 8R 9R 10R 11R 20 11S 10S 12S 9S 8S 1S"
PLAIN = "0 1R 2S 3R 4R 5R 8 5S 6S 4S 3S 7R 8R 9R 20 9S 10S 8S 7S 1S"


def test_a_log_of_the_build_of_today(verify: Verify) -> None:
    (verify.folder / "main.btq").write_text(MISSION, encoding="utf-8")
    log_of(verify, MISSION, GUARDED)
    assert identity(verify) == ("as built now", 12, 12)
    assert main(["build", "main.btq"]) == 0
    assert identity(verify) == ("side file matches", 12, 12)


def test_a_log_of_a_build_without_guards(verify: Verify) -> None:
    (verify.folder / "main.btq").write_text(MISSION, encoding="utf-8")
    log_of(verify, MISSION, PLAIN, "--no-enforce")
    assert identity(verify) == ("as built now with --no-enforce", 10, 10)


def test_instances_are_judged_apart_and_counted_together(verify: Verify) -> None:
    """`Carry/Move` means both instances: of the tree, not of the SubTree node of that name."""
    (verify.folder / "main.btq").write_text(MISSION.replace("Carry/Move", "Move"), encoding="utf-8")
    log_of(verify, MISSION.replace("Carry/Move", "Move"), PLAIN, "--no-enforce")
    (clause,) = verify.json("run.btlog", "--mission", "main.btq")["requirements"][0]["clauses"]
    assert clause["path"] == "Carry::3/Move::5, Back/Move::9"
    assert (clause["counted"], [each["path"] for each in clause["violations"]]) == (2, ["Back/Move::9"])


def test_a_log_of_an_older_text(verify: Verify) -> None:
    """Nodes are found by their path; one that the log does not have is unknown."""
    (verify.folder / "main.btq").write_text(
        MISSION.replace("        Action Pick\n", "        Action Wave\n        Action Pick\n").replace(
            "Action Undock\nAc", "Action Wave\nAction Undock\nAc"
        )
        + "QualityReq new : safety\n    Wave takes at most 1 s\n",
        encoding="utf-8",
    )
    log_of(verify, MISSION, PLAIN, "--no-enforce")
    assert identity(verify) == ("built from another version", 10, 10)
    rq, new = (each["clauses"][0] for each in verify.json("run.btlog", "--mission", "main.btq")["requirements"])
    assert (rq["verdict"], rq["counted"]) == ("violated", 2)
    assert (new["verdict"], new["why"]) == (
        "unknown",
        "`Carry::3/Wave::7` was not found in a log of another version of the mission",
    )


def test_nodes_of_one_path_are_not_told_apart(verify: Verify) -> None:
    """Two drives without names, of which the older text has one more: which is which is unknown."""
    twice = MISSION.replace("Action Undock\n        Sub", "Action Undock\n        Action Undock\n        Sub", 1)
    demand = "QualityReq rq : safety\n    every Undock takes at most 10 ms\n"
    (verify.folder / "main.btq").write_text(demand + twice.removeprefix(DEMAND), encoding="utf-8")
    log_of(verify, MISSION, PLAIN, "--no-enforce")
    assert identity(verify) == ("built from another version", 9, 10)
    first, second = verify.json("run.btlog", "--mission", "main.btq")["requirements"][0]["clauses"]
    assert (first["verdict"], second["verdict"]) == ("unknown", "unknown")


def test_a_log_with_one_node_more_is_of_the_mission(verify: Verify) -> None:
    """Nodes of one path are not told apart, and yet they show which mission it is."""
    text = "QualityReq rq : safety\n    mission succeeds\nRoot Main\nBehaviorTree Main\n    ->\n"
    text += "        Action Move\n" * 3 + "Action Move\n"
    (verify.folder / "main.btq").write_text(text, encoding="utf-8")
    log_of(
        verify,
        text.replace("        Action Move\n", "        Action Move\n        Action Move\n", 1),
        "0 1R 2S 3S 4S 5S 1S",
    )
    assert identity(verify) == ("built from another version", 1, 5)
    (requirement,) = verify.json("run.btlog", "--mission", "main.btq")["requirements"]
    assert (requirement["verdict"], requirement["clauses"][0]["counted"]) == ("satisfied", 1)


def test_missions_with_the_same_nodes_are_named(verify: Verify) -> None:
    """As after a copy of the file whose bounds are others."""
    for name in ("main.btq", "ed/main.btq"):
        (verify.folder / name).parent.mkdir(exist_ok=True)
        (verify.folder / name).write_text(f"{DEMAND.replace('Carry/', '')}{MAIN}", encoding="utf-8")
    (verify.folder / "run.btlog").write_bytes(btlog(MAIN_XML, rows("0 1R 2S 3S 1S")))
    (source,) = verify.json("run.btlog")["sources"]
    assert source["remarks"] == ["judged by ed/main.btq; the same nodes are in main.btq: choose with --mission"]
    (source,) = verify.json("run.btlog", "--mission", "main.btq")["sources"]
    assert source["remarks"] == []


def test_the_first_line_says_that_only_some_nodes_were_found(verify: Verify) -> None:
    (verify.folder / "main.btq").write_text(MISSION.replace("Action Undock", "Action Leave"), encoding="utf-8")
    log_of(verify, MISSION, PLAIN, "--no-enforce")
    first = verify.text("run.btlog", "--mission", "main.btq").splitlines()[0]
    assert first.endswith("mission main (9 of 10 nodes joined: built from another version)")


def test_a_log_of_another_mission_is_counted_and_left_alone(verify: Verify) -> None:
    (verify.folder / "main.btq").write_text(f"{DEMAND.replace('Carry/', '')}{MAIN}", encoding="utf-8")
    (verify.folder / "other.btq").write_text(OTHER, encoding="utf-8")
    (verify.folder / "a.btlog").write_bytes(btlog(MAIN_XML, rows("0 1R 2S 3S 1S")))
    other = MAIN_XML.replace("Main", "Other").replace("Move", "Wash").replace("Pick", "Rinse")
    (verify.folder / "b.btlog").write_bytes(btlog(other, rows("0 1R 2S 3S 1S 5 1R 2F 1F")))
    found = verify.json("a.btlog", "b.btlog", "--mission", "main.btq")
    assert (found["runs"], verify.code) == (1, 0)
    assert [(each["file"], each["mission"], each["runs"]) for each in found["sources"]] == [
        ("a.btlog", "main", 1),
        ("b.btlog", None, 2),
    ]
    assert verify.errors == "btq verify: b.btlog: 2 runs of another mission, not judged\n"
    both = verify.json("a.btlog", "b.btlog")  # all missions of the project
    assert [(each["file"], each["mission"]) for each in both["sources"]] == [("a.btlog", "main"), ("b.btlog", "other")]
    verify.text("b.btlog", "--mission", "main.btq")
    assert (verify.code, verify.errors.splitlines()[1]) == (
        2,
        "btq verify: no log matches main.btq: main has 1 of the 3 nodes in the log; "
        "the first that it does not have is `Wash::2`",
    )


# ---- what guards did ----

LIMIT = "Move takes at most 20 ms\non violation fail"
# What a build makes of it: 1 Sequence, 2 Timeout, 3 Move, 4 Pick.
LIMITED = MAIN_XML.replace(
    '<Move name="Move" _uid="2"/>', '<Timeout name="rq_limit" _uid="2"><Move name="Move" _uid="3"/></Timeout>'
).replace('Pick" _uid="3"', 'Pick" _uid="4"')


@pytest.mark.parametrize(
    ("runs", "expected", "why"),
    [
        # The engine's timer starts before the node does, so what a Timeout stops has lasted a little less than that.
        ("0 1R 2R 0.1 3R 20 3I 2F 2I 1F", "violated", "stopped by its own guard after 20 ms"),
        ("0 1R 2R 0.1 3R 20 2F 2I 1F", "violated", "stopped by its own guard after 20 ms"),  # no row to IDLE
        ("0 1R 2R 0.1 3R 10 3I 2I 1I", "never exercised", ""),  # stopped by something else
        ("0 1R 2R 0.1 3R 10 3F 2F 1F", "satisfied", ""),
        ("0 1R 2R 0.1 3R 10 3S 2S 4S 1S", "satisfied", ""),
        # The guard left no row in the run in which the node was halted, and failed in the next one.
        ("0 1R 3R 10 3I 1F 15 1R 2R 3R 20 3F 2F 1F", "satisfied", ""),
    ],
)
def test_what_its_own_guard_stops_is_violated(runs: str, expected: str, why: str, verify: Verify) -> None:
    found = verify.clause(LIMIT, runs, xml=LIMITED)
    assert (found["verdict"], "".join(each["why"] for each in found["violations"])) == (expected, why)


def test_a_sum_is_not_what_a_guard_has_stopped(verify: Verify) -> None:
    """It stood around the node for another clause of the requirement."""
    limits = "sum of Move, Pick takes at most 90 ms\n    Move takes at most 20 ms\n    on violation fail"
    uid = several(verify, f"QualityReq rq : safety\n    {limits}\n", "")
    move, limit = uid["Move"], uid["rq_limit"]
    log = btlog(
        (verify.folder / "tree.xml").read_text(encoding="utf-8"), rows(f"0 1R {limit}R {move}R 20 {move}I {limit}F 1F")
    )
    (verify.folder / "run.btlog").write_bytes(log)
    (found,) = verify.json("run.btlog", "--mission", "main.btq")["requirements"]
    assert [(each["verdict"], each["counted"]) for each in found["clauses"]] == [("satisfied", 1), ("violated", 1)]


def several(verify: Verify, requirements: str, before: str) -> dict[str, int]:
    """A mission with requirements; the uid of each named node of its build."""
    mission = f"{before}\n{requirements}{MAIN}"
    (verify.folder / "main.btq").write_text(mission, encoding="utf-8")
    xml = verify.build(mission)
    (verify.folder / "tree.xml").write_text(xml, encoding="utf-8")
    return {name: int(uid) for name, uid in re.findall(r'name="(\w+)" _uid="(\d+)"', xml)}


def verdicts(verify: Verify, runs: str) -> dict[str, str]:
    """The verdict of each requirement, with what there is to say of its first violation."""
    xml = (verify.folder / "tree.xml").read_text(encoding="utf-8")
    (verify.folder / "run.btlog").write_bytes(btlog(xml, rows(runs)))
    found = verify.json("run.btlog", "--mission", "main.btq")
    clauses = {each["id"]: each["clauses"][0] for each in found["requirements"]}
    return {
        name: ": ".join([each["verdict"], *(violation["why"] for violation in each["violations"])])
        for name, each in clauses.items()
    }


SPEED = "signal speed : m/s from {speed}"
CALM = "QualityReq calm : safety\n    Move keeps speed < 1 m/s\n    on violation fail\n"
SWIFT = "QualityReq swift : safety\n    Move takes at most 20 ms\n    on violation fail\n"


def test_the_guard_of_another_requirement_does_not_count(verify: Verify) -> None:
    """One is inside the other: where the inner one stops the node, the outer one fails as well."""
    uid = several(verify, CALM + SWIFT, SPEED)
    outer, check, inner, move = uid["calm_keeps"], uid["calm_guard"], uid["swift_limit"], uid["Move"]
    begin = f"0 1R {outer}R {check}S {inner}R {move}R"
    late = f"{begin} 20 {move}I {inner}F {inner}I {check}I {outer}F 1F"
    assert verdicts(verify, late) == {
        "calm": "unknown",  # there are no samples
        "swift": "violated: stopped by its own guard after 20 ms",
    }
    fast = f"{begin} 9 {check}F {move}I {inner}I {check}I {outer}F 1F"
    assert verdicts(verify, fast) == {
        "calm": "violated: stopped by its own guard after 9 ms",
        "swift": "never exercised",
    }


def test_a_refused_start_counts_for_what_is_needed_and_for_success(verify: Verify) -> None:
    demands = "QualityReq needy : safety\n    Move needs speed < 1 m/s\n    on violation fail\n"
    demands += "QualityReq works : reliability\n    Move succeeds\n"
    demands += "QualityReq swift : safety\n    Move takes at most 20 ms\n"
    uid = several(verify, demands, SPEED)
    around, check, move = uid["needy_needs"], uid["needy_check"], uid["Move"]
    assert verdicts(verify, f"0 1R {around}R {check}S {move}S {around}S 1S") == {
        "needy": "unknown",  # there are no samples
        "works": "satisfied",
        "swift": "satisfied",
    }
    assert verdicts(verify, f"0 1R {around}R {check}F {check}I {around}F 1F") == {
        "needy": "violated: its start was refused by its guard at needy_check",
        "works": "violated: its start was refused by needy",
        "swift": "never exercised",
    }


def test_what_the_order_refuses_breaks_the_order_and_fails(verify: Verify) -> None:
    demands = "QualityReq ordered : safety\n    Pick follows Move succeeds\n    on violation fail\n"
    demands += "QualityReq works : reliability\n    Pick succeeds\n"
    uid = several(verify, demands, SPEED)
    around, check, move = uid["ordered_follows"], uid["ordered_check"], uid["Move"]
    assert verdicts(verify, f"0 1R {move}S {around}R {check}F {around}F 1F") == {
        "ordered": "violated: its start was refused by its guard at ordered_check",
        "works": "violated: its start was refused by ordered",
    }
    assert verdicts(verify, f"0 1R {move}S {around}R {check}S {uid['Pick']}S {around}S 1S") == {
        "ordered": "satisfied",
        "works": "satisfied",
    }


def test_a_start_that_is_refused_for_its_number_breaks_the_number(verify: Verify) -> None:
    uid = several(verify, "QualityReq rare : safety\n    Move tries at most 1\n    on violation fail\n", SPEED)
    around, check, move = uid["rare_tries"], uid["rare_check"], uid["Move"]
    once = f"0 1R {around}R {check}S {move}R 5 {move}F {around}F"
    assert verdicts(verify, f"{once} 1F") == {"rare": "satisfied"}
    assert verdicts(verify, f"{once} 9 {around}R {check}F {around}F 1F") == {
        "rare": "violated: started 1 time, and its guard at rare_check refused 1 more"
    }


def test_what_is_stopped_for_its_use_is_violated(verify: Verify) -> None:
    demand = "QualityReq saving : energy\n    Move uses at most 5 Wh of energy\n    on violation fail\n"
    uid = several(verify, demand, "signal energy : Wh from {energy} counter initially 0 Wh")
    move, node = uid["Move"], uid["saving_uses_node"]
    around = [uid[name] for name in ("saving_values", "saving_used", "saving_uses")]
    before = " ".join(f"{each}R" for each in (1, *around, node, move))
    after = " ".join(f"{each}F" for each in (*reversed(around), 1))
    assert verdicts(verify, f"0 {before} 9 {uid['saving_guard']}F {move}I {node}I {after}") == {
        "saving": "violated: stopped by its own guard after 9 ms"
    }


# ---- a tree of other people ----

DEMANDS = """\
QualityReq steady : performance-efficiency.time-behaviour
    NavigateWithReplanning/FollowPath/FollowPath takes at most 545 ms
QualityReq planned : reliability
    FallbackComputePathToPose/ComputePathToPose succeeds in at least 80 % of activations
QualityReq arrives : reliability
    mission succeeds in at least 90 % of runs
"""


@pytest.mark.parametrize("name", ["nav", "nav_noidle"])
def test_the_tree_of_nav2(name: str, verify: Verify, shared: Path) -> None:
    """An imported mission, whose control nodes do not reset their children; through both readers, with truth."""
    shutil.copy(shared / "logs" / "nav.xml", verify.folder / "nav.xml")
    assert main(["import", "nav.xml"]) == 0
    mission = (verify.folder / "nav.btq").read_text(encoding="utf-8")
    (verify.folder / "nav.btq").write_text(f"{DEMANDS}{mission}", encoding="utf-8")
    found = []
    for suffix in (".btlog", ".db3"):
        shutil.copy(shared / "logs" / f"{name}{suffix}", verify.folder)
        found.append(verify.json(f"{name}{suffix}", "--mission", "nav.btq"))
        (source,) = found[-1]["sources"]
        assert (source["runs"], source["identity"], source["joined"]) == (40, "as built now", 38)
    truth = [json.loads(line) for line in (shared / "logs" / f"{name}.truth.jsonl").read_text().splitlines()]
    skills = [(each["uid"], each["run"] + 1, each["ms"], each["status"]) for each in truth if "node" in each]
    for each in found:
        clause = {each["id"]: each["clauses"][0] for each in each["requirements"]}
        steady, planned, arrives = clause["steady"], clause["planned"], clause["arrives"]
        late = [run for uid, run, ms, _ in skills if uid == 22 and ms > 545]
        assert [violation["run"] for violation in steady["violations"]] == late
        results = [status for uid, *_, status in skills if uid == 17 and status != "HALTED"]
        assert (planned["counted"], planned["violated"]) == (len(results), results.count("FAILURE"))
        failed = [each["run"] + 1 for each in truth if each.get("result") == "FAILURE"]
        assert (arrives["counted"], [violation["run"] for violation in arrives["violations"]]) == (40, failed)


@pytest.mark.parametrize(
    "options", [("--bundle",), ("--target", "4.6"), ("--target", "4.6", "--bundle", "--no-enforce")]
)
def test_logs_of_other_builds(options: tuple[str, ...], verify: Verify) -> None:
    """All nodes are found, also where a build for another version of the engine has others."""
    text = MISSION.replace("Carry/Move takes at most 10 ms", "every Move keeps speed < 1 m/s")
    (verify.folder / "main.btq").write_text(f"{SPEED}\n{text}", encoding="utf-8")
    xml = verify.build(f"{SPEED}\n{text}", *options)
    (verify.folder / "run.btlog").write_bytes(btlog(xml, rows("0 1R 1S")))
    how, joined, nodes = identity(verify)
    assert joined == nodes == len(re.findall("_uid=", xml))
    assert how.startswith("as built")


# ---- another tree of the mission runs ----

TREES = (
    "QualityReq of_main : safety\n    Undock takes at most 10 ms\n"
    "QualityReq of_carry : safety\n    Move takes at most 10 ms\n"
    "QualityReq of_all : safety\n    mission succeeds\n"
    "QualityReq after : safety\n    Move starts within 5 ms after mission starts\n"
    "QualityReq below : safety\n    Lift takes at most 10 ms\n"
    "Root Main\nBehaviorTree Main\n    ->\n        Action Undock\n        SubTree Carry\n"
    "BehaviorTree Carry\n    ->\n        Action Move\n        SubTree Arm\n"
    "BehaviorTree Arm\n    ->\n        Action Lift\n"
    "Action Undock\nAction Move\nAction Lift\n"
)
CARRY = "0 1R 2R 20 2S 3R 4R 5S 4S 3S 1S 2I 5I 4I 3I 1I 50 1R 2R 54 2F 1F 2I 1I"
JUDGED = {
    "of_main": ("never exercised", 0),
    "of_carry": ("violated", 2),
    "of_all": ("never exercised", 0),
    "after": ("never exercised", 0),
    "below": ("satisfied", 1),
}


def judged(found: dict[str, Any]) -> dict[str, tuple[str, int]]:
    return {
        each["id"]: (each["verdict"], sum(one["counted"] for one in each["clauses"])) for each in found["requirements"]
    }


@pytest.mark.parametrize("root", ["Root Main\n", ""])
def test_the_log_says_which_tree_ran(verify: Verify, root: str) -> None:
    """`createTree("Carry")`: its nodes are numbered from its own root, those of the subtree in it too."""
    text = TREES.replace("Root Main\n", root)
    (verify.folder / "main.btq").write_text(text, encoding="utf-8")
    log_of(verify, TREES.replace("Root Main", "Root Carry"), CARRY, "--no-enforce")
    assert identity(verify) == ("tree Carry, as built now", 5, 5)
    assert judged(verify.json("run.btlog", "--mission", "main.btq")) == JUDGED


def test_a_log_with_guards_of_another_tree(verify: Verify) -> None:
    """It is found among the builds of that tree, with its guards, for any version of the engine."""
    text = TREES.replace("Move takes at most 10 ms\n", "Move takes at most 10 ms\n    on violation fail\n")
    (verify.folder / "main.btq").write_text(text, encoding="utf-8")
    log_of(verify, text.replace("Root Main", "Root Carry"), "0 1R 2R 3R 10 3I 2F 1F 2I 1I")
    assert identity(verify) == ("tree Carry, as built now", 6, 6)
    found = verify.json("run.btlog", "--mission", "main.btq")
    assert judged(found)["of_carry"] == ("violated", 1)


def test_an_older_text_of_another_tree(verify: Verify) -> None:
    (verify.folder / "main.btq").write_text(TREES.replace("Action Lift", "Action Raise"), encoding="utf-8")
    log_of(verify, TREES.replace("Root Main", "Root Carry"), CARRY, "--no-enforce")
    assert identity(verify) == ("tree Carry, built from another version", 4, 5)


def test_a_tree_that_is_the_main_one_of_another_mission(verify: Verify) -> None:
    """The mission whose main tree it is comes first, also if another one includes it."""
    carry = "BehaviorTree Carry\n    ->\n        Action Move\nAction Move\n"
    demand = "QualityReq rq : safety\n    Move takes at most 10 ms\n"
    (verify.folder / "carry.btq").write_text(f"Root Carry\n{demand}{carry}", encoding="utf-8")
    (verify.folder / "all.btq").write_text(
        'include "carry.btq"\nRoot All\nBehaviorTree All\n    ->\n        SubTree Carry\n', encoding="utf-8"
    )
    log_of(verify, f"Root Carry\n{carry}", "0 1R 2R 20 2S 1S")
    given = ("run.btlog", "--mission", "all.btq", "--mission", "carry.btq")
    assert [(each["mission"], each["identity"]) for each in verify.json(*given)["sources"]] == [
        ("carry", "as built now")
    ]
    assert identity(verify, "all.btq") == ("tree Carry, as built now", 2, 2)


def test_logs_of_several_trees_are_added_up(verify: Verify) -> None:
    (verify.folder / "main.btq").write_text(TREES, encoding="utf-8")
    log_of(verify, TREES.replace("Root Main", "Root Carry"), CARRY, "--no-enforce")
    of_main = btlog(verify.build(TREES), rows("0 1R 2R 5 2S 3R 4R 5R 9 5S 6R 7R 8S 7S 6S 4S 3S 1S"), START + 10**9)
    (verify.folder / "all.btlog").write_bytes(of_main)
    found = verify.json("run.btlog", "all.btlog", "--mission", "main.btq")
    assert judged(found) == {
        "of_main": ("satisfied", 1),
        "of_carry": ("violated", 3),
        "of_all": ("satisfied", 1),
        "after": ("satisfied", 1),
        "below": ("satisfied", 2),
    }


# ---- nodes that are not joined ----


def unjoined(verify: Verify) -> list[str]:
    document = verify.json("run.btlog", "--mission", "main.btq")
    assert list(violations(document, SCHEMA)) == []
    (source,) = document["sources"]
    found: list[str] = source.get("unjoined", [])
    return found


def test_nodes_that_are_not_joined_are_named(verify: Verify) -> None:
    text = MISSION.replace("Carry/Move takes at most 10 ms\n    on violation fail", "Leave takes at most 10 ms")
    (verify.folder / "main.btq").write_text(text.replace("Undock", "Leave"), encoding="utf-8")
    log_of(verify, MISSION, PLAIN, "--no-enforce")
    assert unjoined(verify) == ["node 2 is `Undock` in the log and `Leave` in the mission"]
    (requirement,) = verify.json("run.btlog", "--mission", "main.btq")["requirements"]
    assert requirement["clauses"][0]["why"] == (
        "`Leave::2` was not found in a log of another version of the mission: "
        "node 2 is `Undock` in the log and `Leave` in the mission"
    )


def test_nodes_that_one_side_lacks_are_named(verify: Verify) -> None:
    older = MISSION.replace("Action Undock\n        Sub", "Action Undock\n        Action Wave\n        Sub")
    (verify.folder / "main.btq").write_text(MISSION, encoding="utf-8")
    log_of(verify, f"{older}Action Wave\n", "0 1R 2S 3S 4S 1S", "--no-enforce")
    assert unjoined(verify) == ["node 3 is `Wave` in the log and not in the mission"]
    (verify.folder / "main.btq").write_text(f"{older}Action Wave\n", encoding="utf-8")
    shutil.rmtree(verify.folder / "built", ignore_errors=True)
    log_of(verify, MISSION, PLAIN, "--no-enforce")
    assert unjoined(verify) == ["`Wave::3` was not found in a log of another version of the mission"]


def test_a_table_names_five_of_them(verify: Verify) -> None:
    actions = "".join(f"        Action A{number}\n" for number in range(16))
    models = "".join(f"Action {name}{number}\n" for name in "AB" for number in range(16))
    text = f"Root Main\nBehaviorTree Main\n    ->\n{actions}{models}"
    changed = text
    for number in range(3, 10):
        changed = changed.replace(f"        Action A{number}\n", f"        Action B{number}\n")
    changed += "QualityReq rq : safety\n    mission succeeds\n"
    (verify.folder / "main.btq").write_text(changed, encoding="utf-8")
    log_of(verify, text, "0 1R 2S 1F")
    lines = verify.text("run.btlog", "--mission", "main.btq").splitlines()
    named = "; ".join(f"node {n} is `A{n - 2}` in the log and `B{n - 2}` in the mission" for n in range(5, 10))
    assert lines[1] == f"  not joined: {named}; 2 more"
    assert len(unjoined(verify)) == 7


def test_guards_that_the_mission_lacks_are_not_joined(verify: Verify) -> None:
    """A log of a build with a requirement that the mission has no more."""
    (verify.folder / "main.btq").write_text(MISSION.removeprefix(DEMAND), encoding="utf-8")
    log_of(verify, MISSION, GUARDED)
    assert identity(verify) == ("built from another version", 10, 12)
    assert unjoined(verify) == [
        f"node {uid} is `{path}/rq_limit` in the log and not in the mission"
        for uid, path in ((5, "Carry"), (10, "Back"))
    ]
    mission = candidates(["main.btq"], [], [])
    (session,) = btlog_reader.read("run.btlog")
    joined = join(mission, session.tree)
    assert joined is not None
    assert joined.unjoined() == {5, 10}


def test_a_start_that_is_refused_by_what_must_hold_meanwhile(verify: Verify) -> None:
    """The condition fails before the node starts, and a second time while it runs."""
    uid = several(verify, CALM + "QualityReq works : reliability\n    Move succeeds\n", SPEED)
    outer, check, move = uid["calm_keeps"], uid["calm_guard"], uid["Move"]
    assert verdicts(verify, f"0 1R {outer}R {check}F {check}I {outer}F 1F") == {
        "calm": "violated: its start was refused by its guard at calm_guard",
        "works": "violated: its start was refused by calm",
    }
    stopped = f"0 1R {outer}R {check}S {move}R 5 {check}F {move}I {check}I {outer}F 1F"
    assert verdicts(verify, stopped) == {
        "calm": "violated: stopped by its own guard after 5 ms",
        "works": "never exercised",
    }
    assert verdicts(verify, f"0 1R {outer}R {check}F") == {  # the log ends
        "calm": "violated: its start was refused by its guard at calm_guard",
        "works": "violated: its start was refused by calm",
    }


def test_what_a_guard_finds_at_the_end_is_so(verify: Verify) -> None:
    """Although no sample shows it, and only where it looked: it does not after a failure."""
    uid = several(verify, "QualityReq calm : safety\n    Move leaves speed < 1 m/s\n    on violation fail\n", SPEED)
    around, check, move = uid["calm_leaves"], uid["calm_check"], uid["Move"]
    assert verdicts(verify, f"0 1R {around}R {move}R 5 {move}S {check}F {around}F 1F") == {
        "calm": "violated: its guard at calm_check did not accept its success"
    }
    assert verdicts(verify, f"0 1R {around}R {move}R 5 {move}S {check}S {around}S 1S") == {"calm": "unknown"}
    assert verdicts(verify, f"0 1R {around}R {move}R 5 {move}F {around}F 1F") == {"calm": "never exercised"}
    assert verdicts(verify, f"0 1R {around}R {move}R 5 {move}S") == {"calm": "unknown"}  # the log ends


def test_a_mission_succeeds_if_its_root_does(verify: Verify) -> None:
    """Also where the guard of another requirement stands around the written root."""
    demands = "QualityReq swift : safety\n    mission takes at most 20 ms\n    on violation fail\n"
    demands += "QualityReq works : reliability\n    mission succeeds\n"
    several(verify, demands, SPEED)
    assert verdicts(verify, "0 1R 2R 3R 20 3I 2I 1F 1I 30 1R 2R 3R 35 3S 4S 2S 1S") == {
        "swift": "violated: stopped by its own guard after 20 ms",
        "works": "violated: failed",
    }
    (mission,) = verify.json("run.btlog", "--mission", "main.btq")["missions"]
    assert (mission["outcomes"], mission["ended_by"]) == ({"succeeded": 1, "failed": 1}, {"swift": 1})
    printed = verify.text("run.btlog", "--mission", "main.btq")
    assert "runs: 1 succeeded, 1 failed (1 by the guard of swift)" in printed


@pytest.mark.parametrize(
    ("demand", "expected"),
    [
        ("Move takes at most 40 ms", "unknown: it was stopped by rq_limit, which the mission does not have"),
        ("Move takes at most 10 ms", "violated: "),
        ("Move succeeds", "unknown: it was stopped by rq_limit, which the mission does not have"),
        ("Move needs speed < 1 m/s", "unknown: no samples of `speed`"),
        ("Pick takes at most 40 ms", "never exercised: it did not start in any run"),
    ],
)
def test_what_an_unknown_wrapper_stopped_is_unknown(demand: str, expected: str, verify: Verify) -> None:
    """The log is of a build with a requirement that the mission does not have any more."""
    found = verify.clause(demand, "0 1R 2R 3R 20 3I 2F 2I 1F", xml=LIMITED, before=SPEED)
    assert f"{found['verdict']}: {found['why']}" == expected
