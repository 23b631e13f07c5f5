"""`btq verify LOG` where no mission is known: the log's own tree, its runs, and what each node did."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from evidence_bags import names_of, text, tree_log, write_bag
from evidence_logs import MAIN_XML, START, Verify, btlog, rows, write_db3
from json_schema import violations

import btq_lang.evidence
from btq_lang.commands.verify_options import FORMATS

TWO_RUNS = "0 1R 2R 5 2S 3S 1S 2I 3I 1I 20 1R 2R 30 2F 1F 2I 1I"
OTHER_XML = MAIN_XML.replace("Pick", "Drop")
NO_MISSION = "no mission found; name one with --mission FILE, a .btq file or XML, or make one with btq import LOG"
NOTE = f"nothing is judged: {NO_MISSION}"


def test_runs_outcomes_and_nodes(verify: Verify) -> None:
    (verify.folder / "run.btlog").write_bytes(btlog(MAIN_XML, rows(TWO_RUNS)))
    assert verify.text("run.btlog").splitlines() == [
        "2 runs in run.btlog, 2026-11-20 21:22 UTC, mission Main (the tree in the log, 3 of 3 nodes)",
        f"  note: {NOTE}",
        "",
        "  no requirement to judge",
        "",
        "  node          starts  succeeded  failed  halted   p50    p95  tick p95  tick max",
        "  Sequence::1        2          1       1       0  5 ms  10 ms",
        "  Move::2            2          1       1       0  5 ms  10 ms      0 ms      0 ms",
        "  Pick::3            1          1       0       0  0 ms   0 ms      0 ms      0 ms",
        "",
        "runs: 1 succeeded, 1 failed · failures began at Move::2 (1)",
        "nodes: exercised 3 of 3 · slowest: Move::2 p50 5 ms, p95 10 ms",
    ]
    assert (verify.code, verify.errors) == (0, "")


@pytest.mark.parametrize("form", [each for each in FORMATS if each != "table"])
def test_every_format(form: str, verify: Verify) -> None:
    (verify.folder / "run.btlog").write_bytes(btlog(MAIN_XML, rows(TWO_RUNS)))
    found = verify.text("run.btlog", "--format", form)
    assert (verify.code, verify.errors) == (0, f"btq verify: {NOTE}\n")
    if form == "markdown":
        assert "| `Move::2` | 2 | 1 | 1 | 0 | 5 ms | 10 ms | 0 ms | 0 ms |" in found
    elif form == "html":
        assert (
            '<th scope="row">Move::2</th><td>2</td><td>1</td><td>1</td><td>0</td><td data-value="0.005">5 ms</td>'
            in found
        )
        assert "2 starts, 1 failed" in found  # in the box of the tree
    elif form == "json":
        schema = Path(btq_lang.evidence.__file__).with_name("verdicts.schema.json").read_text(encoding="utf-8")
        document = json.loads(found)
        assert list(violations(document, json.loads(schema))) == []
        (mission,) = document["missions"]
        assert (mission["name"], mission["file"], mission["runs"]) == ("Main", "run.btlog/Main.btq", 2)
        assert document["remarks"] == [NOTE]


def test_a_killed_robots_open_run_is_a_column(verify: Verify) -> None:
    (verify.folder / "run.btlog").write_bytes(btlog(MAIN_XML, rows("0 1R 2R")))
    lines = verify.text("run.btlog").splitlines()
    assert lines[5:7] == [
        "  node          starts  succeeded  failed  halted  interrupted  p50  p95  tick p95  tick max",
        "  Sequence::1        1          0       0       0            1",
    ]


def test_logs_are_grouped_by_their_trees(verify: Verify) -> None:
    write_db3(verify.folder / "a.db3", MAIN_XML, [rows(TWO_RUNS)])
    (verify.folder / "b.btlog").write_bytes(btlog(OTHER_XML, rows("0 1R 2R 6 2S 3S 1S")))
    (verify.folder / "c.btlog").write_bytes(btlog(MAIN_XML, rows("0 1R 2R 7 2S 3S 1S")))
    for more in ((), ("--jobs", "2")):
        found = verify.json(".", *more)
        assert [(each["name"], each["file"], each["runs"]) for each in found["missions"]] == [
            ("Main", "a.db3/Main.btq", 3),
            ("Main 2", "b.btlog/Main 2.btq", 1),
        ]
        assert [(each["file"], each["mission"]) for each in found["sources"]] == [
            ("a.db3", "Main"),
            ("c.btlog", "Main"),
            ("b.btlog", "Main 2"),
        ]


def test_a_tree_that_cannot_be_built_is_reported_too(verify: Verify) -> None:
    """Two nodes with one name are refused where a mission is built, and yet they ran."""
    xml = MAIN_XML.replace("</Sequence>", '<Retry name="Pick" _uid="4"/></Sequence>')
    (verify.folder / "run.btlog").write_bytes(btlog(xml, rows("0 1R 2R 6 2S 3S 4R 9 4S 1S")))
    (source,) = verify.json("run.btlog")["sources"]
    assert (verify.code, source["identity"], source["joined"], source["nodes"]) == (0, "the tree in the log", 4, 4)


def test_strict_demands_a_mission(verify: Verify) -> None:
    (verify.folder / "run.btlog").write_bytes(btlog(MAIN_XML, rows(TWO_RUNS)))
    verify.text("run.btlog", "--strict")
    told = f"btq verify: --strict: {NO_MISSION}\n"
    assert (verify.code, verify.errors) == (2, told)


def test_the_log_of_another_mission(verify: Verify) -> None:
    (verify.folder / "run.btlog").write_bytes(btlog(MAIN_XML, rows(TWO_RUNS)))
    (verify.folder / "main.btq").write_text("Root Other\nBehaviorTree Other\n    Action Fly\n", encoding="utf-8")
    verify.text("run.btlog")
    assert (verify.code, verify.errors) == (
        2,
        "btq verify: run.btlog: 2 runs of another mission, not judged\n"
        "btq verify: no log matches a known mission; name the mission with --mission FILE;"
        " btq import run.btlog writes its tree as one\n",
    )


def test_a_log_that_cannot_be_read(verify: Verify) -> None:
    (verify.folder / "cut.btlog").write_bytes(b"BTCPP4-FileLogger2")
    verify.text("cut.btlog")
    assert (verify.code, verify.errors) == (2, "btq verify: cut.btlog: the file ends before its tree\n")


def test_kept_in_a_store(verify: Verify) -> None:
    (verify.folder / "run.btlog").write_bytes(btlog(MAIN_XML, rows(TWO_RUNS)))
    verify.text("run.btlog", "--store", "kept", "--label", "v1")
    assert (verify.code, verify.json("--store", "kept")["missions"][0]["name"]) == (0, "Main")


# ---- bags ----


def test_a_bag_with_its_tree(verify: Verify) -> None:
    messages = [text("/tree", START - 10**6, MAIN_XML), *tree_log(rows(TWO_RUNS), names_of(MAIN_XML))]
    write_bag(verify.folder / "bag", messages)
    (source,) = verify.json("bag")["sources"]
    assert (verify.code, source["identity"], source["runs"]) == (0, "the tree in the log", 2)


def test_a_bag_without_a_tree(verify: Verify) -> None:
    write_bag(verify.folder / "bag", tree_log(rows(TWO_RUNS), names_of(MAIN_XML)))
    verify.text("bag")
    why = f"{NO_MISSION}; bag has no tree"
    assert (verify.code, verify.errors) == (2, f"btq verify: {why}\n")


def test_trees_whose_ids_have_blanks(verify: Verify) -> None:
    for number, kind in enumerate(("Pick", "Drop", "Hold")):
        xml = MAIN_XML.replace('ID="Main"', 'ID="Main Tree"').replace("Pick", kind)
        (verify.folder / f"{number}.btlog").write_bytes(btlog(xml, rows(TWO_RUNS)))
    names = [each["name"] for each in verify.json(".")["missions"]]
    assert names == ["Main Tree", "Main Tree 2", "Main Tree 3"]


@pytest.mark.parametrize("name", ["bag.xml", "tree.xml"])
def test_a_bag_beside_its_tree(name: str, verify: Verify) -> None:
    write_bag(verify.folder / "bag", tree_log(rows(TWO_RUNS), names_of(MAIN_XML)))
    plain = '<root BTCPP_format="4"><BehaviorTree ID="Main"><Sequence><Move/><Pick/></Sequence></BehaviorTree></root>'
    (verify.folder / name).write_text(plain, encoding="utf-8")
    (verify.folder / "package.xml").write_text("<package><name>x</name></package>", encoding="utf-8")
    (verify.folder / "other.xml").write_text(plain.replace("Move", "Fly"), encoding="utf-8")
    (source,) = verify.json("bag")["sources"]
    assert (verify.code, source["mission"], source["joined"]) == (0, name.removesuffix(".xml"), 3)


# ---- logs of real engines ----


def test_the_log_of_a_real_robot(shared: Path, verify: Verify) -> None:
    found = verify.json(str(shared / "field/verdicts/robot/f46.btlog"))
    (mission,) = found["missions"]
    assert (verify.code, mission["name"], mission["runs"], len(mission["nodes"])) == (0, "Fetch", 70, 75)
    assert mission["outcomes"] == {"succeeded": 46, "failed": 4, "halted": 20}


@pytest.mark.parametrize(
    ("log", "name", "runs", "nodes"),
    [
        ("field/verdicts/robot/a4.10.btlog", "A", 20, 8),
        ("field/verdicts/robot/f46.db3", "Fetch", 67, 75),
        ("field/verdicts/robot/k4.6.3.db3", "Patrol", 1, 20),
        ("field/verdicts/hand/cov.btlog", "Main", 2, 8),
        ("field/verdicts/engine/g1i.btlog", "Main", 1, 33),
        ("logs/lab.btlog", "mainTree", 200, 19),
        ("logs/lab_sessions.db3", "mainTree", 20, 19),
        ("logs/nav_noidle.db3", "NavigateToPoseWReplanningAndRecovery", 40, 38),
    ],
)
def test_logs_of_real_engines(log: str, name: str, runs: int, nodes: int, shared: Path, verify: Verify) -> None:
    found = verify.json(str(shared / log))
    assert verify.code == 0
    assert [(each["name"], each["runs"], len(each["nodes"])) for each in found["missions"]] == [(name, runs, nodes)]
    assert {each["identity"] for each in found["sources"]} == {"the tree in the log"}
