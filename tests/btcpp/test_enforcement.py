"""What requirements add to the XML: what an import removes, what is reported, and where nothing can be added.

What it looks like is in `golden/enforce_*`, and what it does in `engine/test_engine_enforcement.py`.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from build_command import GUESSED, Btq
from hypothesis import given
from hypothesis import strategies as st
from missions import mission

from btq_lang.btcpp.conditions import NoScript, condition_script, real
from btq_lang.btcpp.document import write
from btq_lang.btcpp.enforcement import clause_enforcements, enforced
from btq_lang.btcpp.export import export
from btq_lang.btcpp.importing import import_xml
from btq_lang.btcpp.keys import Keys
from btq_lang.btcpp.outputs import bundle
from btq_lang.projects.opening import open_workspace
from btq_lang.requirements.resolve import requirements
from btq_lang.syntax.script.check import check_script
from btq_lang.syntax.script.parser import parse_script
from btq_lang.trace.missions import trace_table
from btq_lang.workspace.workspace import Workspace

ROOT = Path(__file__).resolve().parents[2]
GOLDEN = sorted((ROOT / "tests" / "btcpp" / "golden").glob("enforce_*.btq"))
EXAMPLES = sorted(folder for folder in (ROOT / "examples").iterdir() if folder.is_dir())

FAIL = "    on violation fail\n"
TAIL = "Root Main\nBehaviorTree Main\n    ->\n        Move\n        Rest\n"


def xml_of(workspace: Workspace, path: str, bundled: bool = False) -> str:
    done = bundle(workspace, path) if bundled else export(workspace, path)
    return write(enforced(workspace, path, done, bundled).export.document)


def states(workspace: Workspace, path: str, bundled: bool = False) -> list[str]:
    applied = clause_enforcements(workspace, path, bundled)
    return [
        f"{each.requirement}: {each.way}{f': {each.why}' if each.why else ''}"
        for clauses in applied
        for each in clauses
    ]


# ---- the way back ----


def assert_comes_back(workspace: Workspace, path: str) -> None:
    """An import of the built XML gives the same as an import of the plain tree."""
    plain = import_xml(write(export(workspace, path).document))
    again = import_xml(xml_of(workspace, path))
    assert again.text == plain.text
    assert again.is_complete


@pytest.mark.parametrize("path", GOLDEN, ids=lambda path: path.stem)
def test_what_was_added_is_taken_out_again(path: Path) -> None:
    workspace = Workspace.of({"main.btq": path.read_text(encoding="utf-8")})
    assert "_btq=" in xml_of(workspace, "main.btq")
    assert_comes_back(workspace, "main.btq")


@pytest.mark.parametrize("folder", EXAMPLES, ids=lambda folder: folder.name)
def test_examples_come_back(folder: Path) -> None:
    workspace = open_workspace(str(folder))
    for path in workspace.files:
        assert_comes_back(workspace, path)


@given(
    clauses=st.lists(
        st.sampled_from(
            [
                "takes at most 5 s",
                "needs on",
                "keeps on",
                "leaves on",
                "succeeds",
                "tries at most 2",
                "uses at most 1 s of t",
            ]
        ),
        min_size=1,
        max_size=4,
    ),
    action=st.sampled_from(["fail", "halt"]),
    seed=st.integers(0, 50),
)
def test_every_mission_comes_back(clauses: list[str], action: str, seed: int) -> None:
    text = mission(20, seed, "short")
    head = "signal on : bool from {on} initially true\nsignal t : s from {t} counter initially 0 s\n"
    head += "QualityReq added\n" + "".join(f"    {clause}\n" for clause in clauses) + f"    on violation {action}\n"
    kinds = sorted({kind for kind in ("Sequence", "Fallback", "MoveBase", "SubTree", "Retry") if kind in text})
    apply = "".join(f"apply added to every {kind}\n" for kind in kinds)
    workspace = Workspace.of({"main.btq": head + apply + text})
    assert_comes_back(workspace, "main.btq")


def test_a_node_that_somebody_has_put_beside_is_kept() -> None:
    text = f"signal on : bool from {{on}}\nQualityReq r\n    Move takes at most 5 s\n    Move needs on\n{FAIL}{TAIL}"
    xml = xml_of(Workspace.of({"main.btq": text}), "main.btq")
    changed = xml.replace("</Timeout>", "</Timeout>\n<Say/>")
    assert changed != xml
    again = import_xml(changed).text
    assert again == (
        "Root Main\n\nBehaviorTree Main\n    ->\n        -> r_2_needs\n            Move\n            Say\n"
        "        Rest\n"
        "\nTreeNodesModel\n    Action Move\n    Action Rest\n"
    )


def test_a_wrapper_that_has_lost_its_node_is_nothing() -> None:
    text = f"QualityReq r\n    Move leaves on\n    on violation fail\nsignal on : bool from {{on}}\n{TAIL}"
    xml = xml_of(Workspace.of({"main.btq": text}), "main.btq")
    lines = [line for line in xml.splitlines() if "<Move" not in line]
    assert "    ->\n        Rest\n" in import_xml("\n".join(lines)).text


# ---- several files ----


SHARED = "signal on : bool from {on} initially true\nQualityReq safe\n    keeps on\n    on violation halt\n"
SKILLS = 'include "shared.btq"\nBehaviorTree Skill\n    ->\n        Grip satisfies safe\n        Look\n'
MAIN = (
    'include "skills.btq"\napply safe to Look, Drive\n'
    "Root Main\nBehaviorTree Main\n    ->\n        Drive\n        SubTree Skill\n"
)
FILES = {"shared.btq": SHARED, "skills.btq": SKILLS, "main.btq": MAIN}
ELSEWHERE = "`Look` is in an included file, which other missions may include; --bundle enforces it"


def test_an_included_file_holds_what_it_asks_for_itself() -> None:
    workspace = Workspace.of(FILES)
    assert states(workspace, "skills.btq") == ["safe: enforced"]
    assert states(workspace, "main.btq") == ["safe: enforced", f"safe: monitored: {ELSEWHERE}", "safe: enforced"]
    skills, main = xml_of(workspace, "skills.btq"), xml_of(workspace, "main.btq")
    assert skills.count('_onFailure="@safe_stop := true"') == 1
    assert "btq_init" not in skills
    assert main.count('_onFailure="@safe_stop := true"') == 1
    assert '<WasEntryUpdated entry="@on" _onFailure="@on := true" _btq="*"/>' in main
    assert '<Script name="btq_start" code="@safe_stop := false" _skipIf="@safe_stop := false; true" _btq="*"/>' in main


def test_what_no_bundle_enforces_either_has_that_reason() -> None:
    texts = {
        "skills.btq": "BehaviorTree Skill\n    Condition Look\n",
        "main.btq": 'include "skills.btq"\nQualityReq quick\n    Look takes at most 5 s\n    on violation fail\n'
        "Root Main\nBehaviorTree Main\n    SubTree Skill\n",
    }
    told = ["quick: monitored: `Look` completes within one tick"]
    assert states(Workspace.of(texts), "main.btq") == states(Workspace.of(texts), "main.btq", bundled=True) == told


def test_a_mission_begins_with_what_included_files_need() -> None:
    workspace = Workspace.of(FILES | {"main.btq": MAIN.replace("apply safe to Look, Drive\n", "")})
    main = xml_of(workspace, "main.btq")
    assert '<WasEntryUpdated entry="@on" _onFailure="@on := true" _btq="*"/>' in main
    assert '<Script name="btq_start" code="@safe_stop := false" _skipIf="@safe_stop := false; true" _btq="*"/>' in main
    assert "safe_guard" not in main
    assert "btq_stop" in main


def test_a_bundle_holds_all() -> None:
    workspace = Workspace.of(FILES)
    assert states(workspace, "main.btq", bundled=True) == ["safe: enforced"] * 3
    xml = xml_of(workspace, "main.btq", bundled=True)
    assert xml.count('_onFailure="@safe_stop := true"') == 3
    assert xml.count('name="btq_init"') == 1


def test_included_xml_is_not_built(tmp_path: Path) -> None:
    xml = '<root BTCPP_format="4"><BehaviorTree ID="Part"><Grip/></BehaviorTree></root>'
    text = f'include "part.xml"\nQualityReq r\n    Grip takes at most 5 s\n{FAIL}'
    (tmp_path / "part.xml").write_text(xml, encoding="utf-8")
    main = tmp_path / "main.btq"
    main.write_text(f"{text}Root Main\nBehaviorTree Main\n    SubTree Part\n", encoding="utf-8")
    workspace = open_workspace(str(main))
    assert states(workspace, str(main)) == [
        "r: monitored: `Grip` is in an XML file, which the build does not change; --bundle enforces it"
    ]
    assert states(workspace, str(main), bundled=True) == ["r: enforced"]
    assert '<Timeout name="r_limit" msec="5000" _btq="r">' in xml_of(workspace, str(main), bundled=True)


def test_counters_of_included_files_keep_apart() -> None:
    part = "BehaviorTree {0}\n    Pick {0}Pick satisfies once\n"
    common = "QualityReq once\n    tries at most 1\n    on violation fail\n"
    files = {
        "common.btq": common,
        "a.btq": 'include "common.btq"\n' + part.format("A"),
        "b.btq": 'include "common.btq"\n' + part.format("B"),
        "main.btq": 'include "a.btq"\ninclude "b.btq"\nRoot Main\n'
        "BehaviorTree Main\n    ->\n        SubTree A\n        SubTree B\n",
    }
    workspace = Workspace.of(files)
    assert '"((@once_A_count + 1.0) &lt;= 1.0)"' in xml_of(workspace, "a.btq")
    assert '"((@once_B_count + 1.0) &lt;= 1.0)"' in xml_of(workspace, "b.btq")
    assert 'code="@once_A_count := 0.0; @once_B_count := 0.0"' in xml_of(workspace, "main.btq")


# ---- why not ----

TOO_LONG = "its script would be longer than 10000 characters; compute it in a node, and declare a signal for its output"


@pytest.mark.parametrize(
    ("clauses", "why"),
    [
        ("takes at most 0.1 ms", "a Timeout cannot be set to `0.1 ms`"),
        ("takes at most 60 d", "a Timeout cannot be set to `60 d`"),
        ("takes at most 5 s\n    over last 3 runs", "a window is evaluated in the logs of many runs"),
        ("tries at most 2\n    when on", "its scope, `when on`, is evaluated only in logs"),
        ("needs nowhere", "`nowhere` has no blackboard entry"),
        (
            'keeps mode == "it\'s"',
            "a string in a script cannot contain single quotes, and before 4.9 only ASCII characters",
        ),
        (
            'keeps mode == "größe"',
            "a string in a script cannot contain single quotes, and before 4.9 only ASCII characters",
        ),
        ("keeps far <= 1 m", "it contains an infinite number"),
        ("leaves large", TOO_LONG),
        ("needs nearly_as_large and nearly_as_large\n    when nearly_as_large", TOO_LONG),
        ("runs every 1 s", "BehaviorTree.CPP has no node that makes another one start in time"),
        ("starts within 1 s after Rest starts", "BehaviorTree.CPP has no node that makes another one start in time"),
        ("follows when on", "the engine runs no script at this event"),
        ("follows Rest fails or when on", "the engine runs no script at this event"),
    ],
)
def test_reasons(clauses: str, why: str) -> None:
    contexts = "context c0 : on\n" + "".join(f"context c{n} : c{n - 1} or c{n - 1}\n" for n in range(1, 40))
    text = (
        "signal on : bool from {on} initially true\nsignal nowhere : bool\nsignal mode : text from {mode}\n"
        f"signal far : mm from {{far}} initially 1e308 m\n{contexts}context large : c39\ncontext nearly_as_large : c8\n"
        f"QualityReq r\n    {clauses}\n    on violation fail\napply r to Move\n{TAIL}"
    )
    assert states(Workspace.of({"main.btq": text}), "main.btq") == [f"r: monitored: {why}"]


def test_a_guard_minds_no_age_and_says_so() -> None:
    text = (
        "signal speed : m/s from {speed} fresh within 1 s initially 0 m/s\n"
        "signal near : bool from {near} fresh within 1 s initially false\n"
        f"QualityReq q\n    Move keeps speed <= 1 m/s\n    Move needs not near and speed == 0 m/s\n{FAIL}{TAIL}"
    )
    assert states(Workspace.of({"main.btq": text}), "main.btq") == [
        "q: enforced: guards read the latest value of `speed`, whatever its age",
        "q: enforced: guards read the latest value of `near`, `speed`, whatever its age",
    ]


def test_a_node_that_is_skipped_from_within_stays_so() -> None:
    text = "QualityReq r\n    takes at most 5 s\n    on violation fail\napply r to Some\nRoot Main\nBehaviorTree Main\n"
    text += '    ?\n        -> Some\n            Move (_skipIf = "off")\n        Rest\n'
    assert states(Workspace.of({"main.btq": text}), "main.btq") == [
        "r: monitored: a node below `-> Some` may skip it, and with a guard around it the tree would behave differently"
    ]


def test_what_is_never_reset_stays_so() -> None:
    text = f"QualityReq r\n    takes at most 5 s\n{FAIL}apply r to Asked, Then\nRoot Main\nBehaviorTree Main\n"
    text += "    IfThenElse\n        Move Asked\n        Move Then\n"
    assert states(Workspace.of({"main.btq": text}), "main.btq") == [
        "r: monitored: `Move Asked` is the condition of `IfThenElse`, "
        "which would evaluate it differently with a guard around it",
        "r: enforced",
    ]


def test_a_path_through_subtrees_names_some_instances_only() -> None:
    text = "QualityReq r\n    one/Move takes at most 5 s\n    on violation fail\nRoot Main\nBehaviorTree Main\n    ->\n"
    text += "        SubTree Part one\n        SubTree Part two\nBehaviorTree Part\n    ->\n        Move\n"
    assert states(Workspace.of({"main.btq": text}), "main.btq") == [
        "r: monitored: its path names only some instances of a node"
    ]


def test_what_a_description_demands() -> None:
    text = (
        'Root Main\nBehaviorTree Main\n    -> (Quality = x)\n        Move (satisfies QualityReq ID = "rq1"'
        ' description = "SuccessIf battery > 20 FailureIf (a + b) == 3; c := 1")\n'
    )
    workspace = Workspace.of({"main.btq": text})
    found = states(workspace, "main.btq")
    assert found == [
        "rq1: enforced: the mission ends if a guard reads `battery` before anything writes it",
        "rq1: monitored: its script is not a single expression that all versions of the engine evaluate alike",
    ]
    assert 'code="(battery &gt; 20)"' in xml_of(workspace, "main.btq")


@pytest.mark.parametrize(
    ("script", "read"),
    [
        ("battery > 20 && @speed < reserve || battery > 90", "`battery`, `@speed`, `reserve`"),
        ("mode == CHARGING && level > 3", "`mode`, `level`"),  # a name of an enumeration
        ("true", ""),
    ],
)
@pytest.mark.parametrize("word", ["SuccessIf", "FailureIf"])
def test_a_description_reads_entries_that_must_be_written_first(word: str, script: str, read: str) -> None:
    text = (
        'Root Main\nBehaviorTree Main\n    -> (Quality = x)\n        Move (satisfies QualityReq ID = "rq1"'
        f' description = "{word} {script}")\n'
    )
    said = f": the mission ends if a guard reads {read} before anything writes it" if read else ""
    assert states(Workspace.of({"main.btq": text}), "main.btq") == [f"rq1: enforced{said}"]


@pytest.mark.parametrize("script", ["(a := 3) > 2", "(a = 3) > 2", "(a += 1) > 2"])
def test_a_description_that_changes_an_entry_is_not_enforced(script: str) -> None:
    text = (
        'Root Main\nBehaviorTree Main\n    -> (Quality = x)\n        Move (satisfies QualityReq ID = "rq1"'
        f' description = "SuccessIf {script}")\n'
    )
    assert states(Workspace.of({"main.btq": text}), "main.btq") == ["rq1: monitored: its script changes an entry"]


# ---- scripts and names ----


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.0, "0.0"), (3.0, "3.0"), (-2.5, "(-2.5)"), (1e-7, "0.0000001"), (1e20, "100000000000000000000.0")],
)
def test_numbers(value: float, text: str) -> None:
    assert real(value) == text


def test_a_number_without_end() -> None:
    with pytest.raises(NoScript, match="it contains an infinite number"):
        real(float("inf"))


def test_every_script_is_one_that_all_engines_read_alike() -> None:
    for path in GOLDEN:
        workspace = Workspace.of({"main.btq": path.read_text(encoding="utf-8")})
        for applied in requirements(workspace, "main.btq").applied:
            for claim in applied.requirement.claims:
                try:
                    script = condition_script(claim.condition, lambda table, unit: "x") if claim.condition else "0.0"
                except NoScript:
                    continue
                assert check_script(parse_script(script), expects_value=True) == ()


def test_names() -> None:
    keys = Keys()
    assert keys.next("rq-1") == "rq_1"
    keys.take("rq_1")
    assert [keys.next("rq_1"), keys.next("rq-1"), keys.next("2 go")] == ["rq_1_2", "rq_1_2", "_2_go"]
    assert [keys.stop("rq-1"), keys.stop("rq_1"), keys.stop("rq-1")] == ["@rq_1_stop", "@rq_1_2_stop", "@rq_1_stop"]


# ---- the command ----


SEEN = GUESSED.format("Move (Action), Rest (Action)")
QUICK = f"QualityReq quick\n    Move takes at most 5 s\n{FAIL}QualityReq calm\n    Rest takes at most 2 s\n{TAIL}"
LIKELY = QUICK.replace("    on violation", "    in at least 98 % of runs\n    on violation")


def test_a_build_tells_what_it_enforces(btq: Btq) -> None:
    btq.write(mission=QUICK)
    counted = "clauses of requirements: 1 enforced, 1 monitored\n"
    assert btq.build("mission.btq") == (0, "wrote mission.xml\nwrote mission.qreq.json\n", counted + SEEN)
    assert btq.build("mission.btq", "--verbose")[2] == (
        "mission.btq:2:5: enforced: quick, `Move takes at most 5 s` at `Move`\n"
        f"mission.btq:5:5: monitored: calm, `Rest takes at most 2 s` at `Rest`\n{counted}{SEEN}"
        "2 files unchanged\n"
    )
    assert "<!-- Nodes with _btq enforce requirements: at tick rate, so they are no safety function. -->" in btq.read(
        "mission.xml"
    )
    btq.write(mission=LIKELY)
    assert btq.build("mission.btq")[2] == (
        "mission.btq:2:5: not enforced, monitored: quick, `Move takes at most 5 s` at `Move`: a probability "
        f"is evaluated in the logs of many runs\nclauses of requirements: 2 monitored\n{SEEN}"
    )


def test_a_build_tells_what_is_about_no_node(btq: Btq) -> None:
    loose = f"signal force : N initially 0 N\n{QUICK}".replace("5 s\n", "5 s\n    never force >= 50 N\n")
    btq.write(mission=loose)
    assert btq.build("mission.btq")[2] == (
        "mission.btq:4:5: not checked: quick, `never force >= 50 N` applies to no node\n"
        f"clauses of requirements: 1 enforced, 1 monitored, 1 without a node\n{SEEN}"
    )
    side: Any = json.loads(btq.read("mission.qreq.json"))
    assert [each.get("clauses_without_nodes") for each in side["requirements"]] == [["never force >= 50 N"], None]
    ways = [(clause["clause"], clause["held"]) for applied in side["applied"] for clause in applied["clauses"]]
    assert ways == [("Move takes at most 5 s", "enforced"), ("Rest takes at most 2 s", "monitored")]


def test_what_one_mission_leaves_about_no_node_another_may_attach(btq: Btq) -> None:
    rules = "QualityReq quick\n    Move takes at most 5 s\n    succeeds\nBehaviorTree Go\n    Move\n"
    main = 'include "rules.btq"\nRoot Main\nBehaviorTree Main\n    ->\n        SubTree Go\n        Rest{}\n'
    btq.write(rules=rules, mission=main.format(" satisfies quick"))
    assert btq.build("mission.btq")[2] == f"clauses of requirements: 2 monitored\n{SEEN}"
    btq.write(mission=main.format(""))
    assert btq.build("mission.btq")[2] == (
        "rules.btq:3:5: not checked: quick, `succeeds` applies to no node\n"
        f"clauses of requirements: 1 monitored, 1 without a node\n{SEEN}2 files unchanged\n"
    )


def test_a_build_names_trees_and_the_mission_as_the_claim_does(btq: Btq) -> None:
    claims = "".join(f"    {subject} takes at most 5 s\n" for subject in ("SubTree/Go", "mission", "Go/Move"))
    trees = "BehaviorTree Main\n    ->\n        SubTree Go\n        Rest\nBehaviorTree Go\n    R->\n        Move\n"
    btq.write(mission=f"QualityReq quick\n{claims}{FAIL}Root Main\n{trees}")
    assert btq.build("mission.btq", "--verbose")[2] == (
        "mission.btq:2:5: enforced: quick, `SubTree/Go takes at most 5 s` at `Go`\n"
        "mission.btq:3:5: enforced: quick, `mission takes at most 5 s` at `mission`\n"
        "mission.btq:4:5: enforced: quick, `Go/Move takes at most 5 s` at `Move`\n"
        f"clauses of requirements: 3 enforced\n{SEEN}"
    )


def test_a_plain_tree_can_be_had(btq: Btq) -> None:
    btq.write(mission=QUICK)
    for option, told in (("--no-enforce", SEEN), ("--verbatim", "")):
        assert btq.build("mission.btq", option, "--force")[2] == told
        assert "_btq" not in btq.read("mission.xml")
    assert btq.build("mission.btq", "--no-enforce", "--force")[0] == 0
    side: Any = json.loads(btq.read("mission.qreq.json"))
    assert [node["path"] for node in side["nodes"]] == ["Sequence::1", "Move::2", "Rest::3"]
    assert all("clauses" not in applied for applied in side["applied"])


def test_the_side_file_counts_what_was_added(btq: Btq) -> None:
    btq.write(mission=QUICK)
    btq.build("mission.btq")
    side: Any = json.loads(btq.read("mission.qreq.json"))
    assert side["nodes"] == [
        {"uid": 1, "path": "Sequence::1", "file": "mission.btq", "line": 8},
        {"uid": 2, "path": "quick_limit", "enforces": "quick"},
        {"uid": 3, "path": "Move::3", "file": "mission.btq", "line": 9},
        {"uid": 4, "path": "Rest::4", "file": "mission.btq", "line": 10},
    ]
    assert [(each["nodes"], each["clauses"]) for each in side["applied"]] == [
        ([3], [{"clause": "Move takes at most 5 s", "held": "enforced"}]),
        ([4], [{"clause": "Rest takes at most 2 s", "held": "monitored"}]),
    ]


def test_a_build_tells_what_people_verify_and_counts_as_the_overview_does(btq: Btq) -> None:
    shown = f'{QUICK}QualityReq seen "Prose"\n'.replace("2 s\n", '2 s\n    verified by test "TC-1", review\n')
    btq.write(mission=shown.replace("Rest\n", "Rest satisfies seen\n"))
    counts = "1 enforced, 1 by people"
    assert btq.build("mission.btq", "--verbose")[2] == (
        "mission.btq:2:5: enforced: quick, `Move takes at most 5 s` at `Move`\n"
        "mission.btq:5:5: by test TC-1 and review: calm, `Rest takes at most 2 s` at `Rest`\n"
        f"clauses of requirements: {counts}\n{SEEN}"
    )
    overview = trace_table(Workspace.of({"mission.btq": btq.read("mission.btq")}), "mission.btq")
    assert f"3 requirements (2 clauses: {counts})" in overview.write()
