"""What changed between two missions, in words, as Markdown and as JSON; and the command, with files and with git."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path
from textwrap import dedent

import pytest
from in_process import run_btq

from btq_lang.diff import as_json, as_markdown, as_text
from btq_lang.diff.comparison import MissionComparison, Side, compared
from btq_lang.diff.matching import common
from btq_lang.workspace.workspace import Workspace

OLD = dedent("""\
    signal battery : % from {level}
    QualityReq rq1 : time-behaviour "In time"
        takes at most 30 s
        on violation fail
    QualityReq rq2 "With some battery left"
        leaves battery >= 3 %
    Action MoveBase
        input station : string
    Root Main
    BehaviorTree Main
        -> Work
            MoveBase ToDesk (station = "desk") satisfies rq1
            Timeout (msec = 2 s)
                Grip
            SubTree Deliver
            Charge
    BehaviorTree Deliver
        ?
            MoveBase (station = "ward") satisfies rq2
            CallForHelp
    """)
NEW = dedent("""\
    signal battery : Ah from {level}
    QualityReq rq1 : time-behaviour "In time"  # comments are no change
        on violation fail
        takes at most 20 s
        goal 10 s
    QualityReq rq2 "With some battery left"
        leaves battery >= 3 %
    Action MoveBase
        input station : string
        input speed : double = 0.5
    Root Main
    BehaviorTree Main
        Sequence Work
            Retry (num_attempts = 3)
                MoveBase ToDesk (station = "desk", speed = 1) satisfies rq1
            SubTree BringIt
            Timeout (msec = 2000)
                R->
                    Grip
                    Look
    BehaviorTree BringIt
        ?
            MoveBase (station = "ward")
            CallForHelp
            Beep
    """)
TEXT = """\
old.btq -> new.btq
~ requirement rq1 changed  new.btq:2
    - takes at most 30 s
    + takes at most 20 s
    + goal 10 s
~ requirement rq2 changed  new.btq:6
    ~ attached to: 1 node -> no node
~ signal battery changed  new.btq:1
    ~ unit: % -> Ah
~ node model MoveBase changed  new.btq:8
    + input speed : double = 0.5
+ node Main/Work/Retry added around ToDesk  new.btq:14
~ node Main/Work/ToDesk changed  new.btq:15
    + speed = 1
> node Main/Work/Timeout moved  new.btq:17
+ node Main/Work/R-> added with 1 node below around Grip  new.btq:18
~ tree Deliver renamed to BringIt  new.btq:21
~ node BringIt/MoveBase changed  new.btq:23
    - satisfies rq2
+ node BringIt/Beep added  new.btq:25
- node Main/Work/Charge removed  old.btq:16

2 requirements changed, 1 signal changed, 1 node model changed, 3 nodes added, 2 nodes changed, 1 node moved, \
1 tree renamed, 1 node removed
"""


def comparison(old: str, new: str) -> MissionComparison:
    sides = (
        Side(name, Workspace.of({name: text}), (name,), str) for name, text in (("old.btq", old), ("new.btq", new))
    )
    return compared(*sides)


def in_words(old: str, new: str) -> str:
    return "".join(f"{line}\n" for line in as_text.render([comparison(old, new)], lambda _, text: text))


def test_what_changed_in_words() -> None:
    assert in_words(OLD, NEW) == TEXT


def test_what_did_not_change_is_not_told() -> None:
    assert in_words(OLD, OLD) == ""


def test_spelling_is_no_change() -> None:
    classic = (
        'Root Main\n    BehaviorTree ID = Main\n        -> (name = "Work")\n            Retry (num_attempts = 3)\n'
    )
    classic += '                ScriptAction (name = "Pick" satisfies QualityReq ID = "rq1" description = "quick")\n'
    short = 'QualityReq rq1 "quick"\nBehaviorTree Main\n    Sequence Work\n'
    short += '        RetryUntilSuccessful (num_attempts = "3")\n            Pick satisfies rq1\n'
    assert in_words(classic, short) == ""


def test_a_requirement_that_was_renamed_everywhere_is_one_change() -> None:
    assert in_words(OLD, OLD.replace("rq1", "reach")).splitlines()[1:-2] == [
        "~ requirement rq1 renamed to reach  new.btq:2"
    ]


def test_a_part_that_became_a_tree_of_its_own() -> None:
    other = "BehaviorTree Other\n    Go\n"
    old = f"BehaviorTree Main\n    ->\n        ?\n            Pick\n            Place\n        Go\n{other}"
    new = f"BehaviorTree Main\n    ->\n        SubTree Take\n        Go\n{other}"
    new += "BehaviorTree Take\n    ?\n        Pick\n        Place\n"
    assert in_words(old, new).splitlines()[1:-2] == [
        "+ node Main/SubTree Take added  new.btq:3",
        "+ tree Take added around ?  new.btq:7",
        "> node Take/? moved from Main/?  new.btq:8",
    ]


def test_the_same_quantity_in_another_unit_is_no_change() -> None:
    mission = dedent("""\
        signal speed : m/s from {{speed}} fresh within {0} initially {1}
        context slow = speed < {1}
        QualityReq rq1(limit : m/s = {1})
            takes at most {0}
            uses at most {2}
            keeps speed <= {1}
            over last {0}
        BehaviorTree Main
            Go satisfies rq1(limit = {1})
        apply rq1(limit = {1}) to Go
        """)
    old = mission.format("90 s", "0.5 m/s", "20 Wh")
    assert in_words(old, mission.format("1.5 min", "50 cm/s", "72 kJ")) == ""
    changed = in_words(old, mission.format("90 min", "0.5 m/s", "20 Wh")).splitlines()
    assert changed[1:5] == [
        "~ requirement rq1 changed  new.btq:3",
        "    - takes at most 90 s",
        "    + takes at most 90 min",
        "    - over last 90 s",
    ]


def test_what_is_applied() -> None:
    old = "QualityReq rq1\n    takes at most 30 s\nBehaviorTree Main\n    Go\n"
    said = "old.btq -> new.btq\n+ apply rq1 to Go added  new.btq:5\n\n1 apply added"
    assert in_words(old, f"{old}apply rq1 to Go\n").rstrip() == said


SAFETY = """\
hazard H1 "Collision"
    severity high
QualityReq r : safety and comfort "R"
    takes at most 3 s
    source "S"
    priority high
BehaviorTree Main
    A satisfies r
"""


def test_hazards_and_clauses_that_demand_nothing() -> None:
    new = SAFETY.replace("severity high", 'severity low\n    because "it is slow"').replace(
        "and comfort", "and usability"
    )
    new = new.replace('source "S"\n    priority high', 'source "T"\n    refines s') + 'hazard H2 "New"\n'
    assert (
        in_words(SAFETY, new)
        == """\
old.btq -> new.btq
~ requirement r changed  new.btq:4
    ~ quality: safety and comfort -> safety and usability
    - source "S"
    + source "T"
    - priority high
    + refines s
~ hazard H1 changed  new.btq:1
    - severity high
    + severity low
    + because "it is slow"
+ hazard H2 added  new.btq:10
    + title: "New"

1 requirement changed, 1 hazard changed, 1 hazard added
"""
    )


def test_scenarios() -> None:
    old = 'given Dock takes 3 s\nscenario "S" of T verifies r\n    given Dock fails\n    given x = 80 %\n    expect r\n'
    new = (
        'given Dock takes 4 s\nscenario "S" of T\n    given x=80%\n    given Dock succeeds\n    expect r\n'
        'scenario "N"\n    expect r\n'
    )
    assert (
        in_words(old, new)
        == """\
old.btq -> new.btq
~ scenario S changed  new.btq:2
    - verifies r
    - given Dock fails
    + given Dock succeeds
+ scenario N added  new.btq:6
    + expect r
+ given Dock takes 4 s added  new.btq:1
- given Dock takes 3 s removed  old.btq:1

1 scenario changed, 1 scenario added, 1 given added, 1 given removed
"""
    )


def test_their_order_is_no_change() -> None:
    reordered = SAFETY.replace('    source "S"\n    priority high\n', '    priority high\n    source "S"\n')
    assert in_words(SAFETY, reordered.replace("safety and comfort", "comfort and safety")) == ""


def test_markdown_for_a_pull_request() -> None:
    new = OLD.replace("30 s", "20 s").replace("        Grip", "        Hold")
    assert list(as_markdown.render([comparison(OLD, new)])) == [
        "### `old.btq -> new.btq`",
        "",
        "1 requirement changed, 1 node changed.",
        "",
        "#### Requirements",
        "",
        "- requirement `rq1` **changed** (`new.btq:2`)",
        "  - removed `takes at most 30 s`",
        "  - added `takes at most 20 s`",
        "",
        "#### Trees",
        "",
        "- node `Main/Work/Hold` **changed** (`new.btq:14`)",
        "  - `kind: Grip -> Hold`",
    ]
    assert list(as_markdown.render([comparison(OLD, OLD)])) == ["The missions are the same."]


@pytest.mark.parametrize(
    ("text", "span"), [("a", "`a`"), ("a`b", "``a`b``"), ("`", "`` ` ``"), ("<b>*x*", "`<b>*x*`"), ("``", "``` `` ```")]
)
def test_what_a_mission_says_is_no_markup(text: str, span: str) -> None:
    assert as_markdown.code(text) == span


def test_json_for_programs() -> None:
    (document,) = as_json.render([comparison(OLD, OLD.replace("        CallForHelp\n", ""))])
    found = json.loads(document)
    assert {key: found[key] for key in ("format", "tool", "summary")} == {
        "format": 1,
        "tool": "btq",
        "summary": {"added": 0, "removed": 1, "moved": 0, "changed": 0, "renamed": 0},
    }
    place = {"path": "old.btq", "range": {"start": {"line": 20, "column": 9}, "end": {"line": 20, "column": 20}}}
    assert found["comparisons"] == [
        {
            "old": "old.btq",
            "new": "new.btq",
            "changes": [
                {
                    "what": "removed",
                    "thing": "node",
                    "name": "Deliver/CallForHelp",
                    "earlier": None,
                    "old": place,
                    "new": None,
                    "details": [],
                    "below": 0,
                    "around": [],
                }
            ],
        }
    ]


def test_longest_common_subsequences() -> None:
    assert common("abcd", "xbyd") == [(1, 1), (3, 3)]
    assert len(common("abcabba", "cbabac")) == 4
    assert common("", "a") == []
    assert [len(common("x" * number, "y" + "x" * number)) for number in (0, 1, 2_000)] == [0, 1, 2_000]


# ---- the command ----


def btq(*arguments: str, cwd: Path, stdin: str = "") -> tuple[int, str, str]:
    return run_btq("diff", *arguments, cwd=cwd, stdin=stdin)


def test_two_files(tmp_path: Path) -> None:
    (tmp_path / "old.btq").write_text(OLD)
    (tmp_path / "new.btq").write_text(NEW)
    assert btq("old.btq", "new.btq", cwd=tmp_path) == (1, TEXT, "")
    assert btq("old.btq", "old.btq", cwd=tmp_path) == (0, "", "")
    code, out, _ = btq("old.btq", os.devnull, cwd=tmp_path)
    assert (code, out.splitlines()[0]) == (1, "old.btq (removed)")


def test_a_file_and_standard_input(tmp_path: Path) -> None:
    (tmp_path / "old.btq").write_text(OLD)
    (tmp_path / "new.btq").write_text(NEW)
    said = TEXT.replace("old.btq", "<stdin>")
    assert btq("-", "new.btq", cwd=tmp_path, stdin=OLD) == (1, said, "")
    assert btq("-", "new.btq", "--stdin-filename", "old.btq", cwd=tmp_path, stdin=OLD) == (1, TEXT, "")
    assert btq("-", "new.btq", "--stdin-filename", "new.btq", cwd=tmp_path, stdin=NEW) == (0, "", "")
    code, out, told = btq("old.btq", "-", cwd=tmp_path, stdin=NEW)
    assert (code, out.splitlines()[0], told) == (1, "old.btq -> <stdin>", "")
    code, out, told = btq(os.devnull, "-", cwd=tmp_path, stdin=NEW)
    assert (code, out.splitlines()[0], told) == (1, "<stdin> (added)", "")


def test_what_standard_input_includes_and_xml_there(tmp_path: Path) -> None:
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib" / "reqs.btq").write_text("QualityReq rq1\n    takes at most 30 s\n")
    main = 'include "reqs.btq"\nBehaviorTree Main\n    Go{} satisfies rq1\n'
    (tmp_path / "lib" / "main.btq").write_text(main.format(""))
    named = ("-", "lib/main.btq", "--stdin-filename", "lib/main.btq")
    assert btq(*named, cwd=tmp_path, stdin=main.format("")) == (0, "", "")
    said = "lib/main.btq -> lib/main.btq\n~ node Main/Go changed  lib/main.btq:3\n"
    said += "    - name: slow\n\n1 node changed\n"
    assert btq(*named, cwd=tmp_path, stdin=main.format(" slow")) == (1, said, "")
    (tmp_path / "go.btq").write_text("Root Main\nBehaviorTree Main\n    Go\n")
    xml = '<root BTCPP_format="4" main_tree_to_execute="Main"><BehaviorTree ID="Main"><Go/></BehaviorTree></root>\n'
    assert btq("-", "go.btq", cwd=tmp_path, stdin=xml) == (0, "", "")


def test_nodes_of_kinds_that_are_words_of_the_language(tmp_path: Path) -> None:
    for kind in ("xml", "BehaviorTree"):
        for name in ("Old", "New"):
            (tmp_path / f"{name}.btq").write_text(f'BehaviorTree Main\n    ->\n        "{kind}" {name}\n        Go\n')
        said = "Old.btq -> New.btq\n~ node Main/New changed  New.btq:3\n    ~ name: Old -> New\n\n1 node changed\n"
        assert btq("Old.btq", "New.btq", cwd=tmp_path) == (1, said, "")


def test_a_change_in_an_included_file_is_one_of_the_mission(tmp_path: Path) -> None:
    for folder, limit in (("a", 30), ("b", 20)):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "main.btq").write_text('include "reqs.btq"\nBehaviorTree Main\n    Go satisfies rq1\n')
        (tmp_path / folder / "reqs.btq").write_text(f"QualityReq rq1\n    takes at most {limit} s\n")
    said = "~ requirement rq1 changed  b/reqs.btq:1\n    - takes at most 30 s\n    + takes at most 20 s\n\n"
    said += "1 requirement changed\n"
    assert btq("a/main.btq", "b/main.btq", cwd=tmp_path) == (1, f"a/main.btq -> b/main.btq\n{said}", "")
    assert btq("a", "b", cwd=tmp_path) == (1, f"a/reqs.btq -> b/reqs.btq\n{said}", "")


def test_two_spellings_of_a_path_include_the_same(tmp_path: Path) -> None:
    (tmp_path / "lib.btq").write_text("BehaviorTree Lib\n    Go\n")
    (tmp_path / "a.btq").write_text('include "lib.btq"\nRoot Main\nBehaviorTree Main\n    SubTree Lib\n')
    (tmp_path / "b.btq").write_text('include "./lib.btq"\nRoot Main\nBehaviorTree Main\n    SubTree Lib\n')
    assert btq("a.btq", "b.btq", cwd=tmp_path) == (0, "", "")


def test_what_a_build_guesses_is_no_change(tmp_path: Path) -> None:
    (tmp_path / "lib.btq").write_text("BehaviorTree Lib\n    ->\n        Go (x = 1)\n        DoorOpen\n")
    (tmp_path / "main.btq").write_text(
        'include "lib.btq"\nRoot Main\nCondition DoorOpen\nBehaviorTree Main\n'
        "    ->\n        SubTree Lib\n        Go (y = {y})\n        DoorOpen\n"
    )
    assert run_btq("build", "main.btq", cwd=tmp_path)[0] == 0
    for name in ("main", "lib"):
        assert btq(f"{name}.btq", f"{name}.xml", cwd=tmp_path) == (0, "", "")
    imported = run_btq("import", "lib.xml", "-o", "back", cwd=tmp_path)
    assert imported == (0, "", "1 file imported\nNext: btq check back/lib.btq\n")


def test_a_mission_and_what_was_built_of_it(tmp_path: Path) -> None:
    (tmp_path / "skills.btq").write_text("BehaviorTree Enough\n    input level : double = 25\n    AlwaysSuccess\n")
    mission = tmp_path / "mission.btq"
    mission.write_text(
        'include "skills.btq"\nQualityReq rq1\n    takes at most 30 s\n'
        "Root Main\nBehaviorTree Main\n    SubTree Enough satisfies rq1\n"
    )
    assert run_btq("build", "mission.btq", cwd=tmp_path)[0] == 0
    assert btq("mission.xml", "mission.btq", cwd=tmp_path) == (0, "", "")
    assert btq("skills.xml", "skills.btq", cwd=tmp_path) == (0, "", "")
    built = mission.read_text()
    mission.write_text(built.replace("30 s", "20 s"))
    code, out, told = btq("mission.btq", "mission.xml", cwd=tmp_path)
    assert (code, out.splitlines()[1], told) == (
        1,
        "~ requirement rq1 changed  mission.qreq.json:mission.btq:2",
        "",
    )
    mission.write_text(built)
    (tmp_path / "mission.qreq.json").unlink()
    code, out, told = btq("mission.btq", "mission.xml", cwd=tmp_path)
    assert (code, out.splitlines()[-1]) == (1, "1 requirement removed, 1 node changed")
    message = "its requirements are missing: `btq build` wrote them to the .qreq.json that was beside it"
    assert told == f"btq: mission.xml: {message}\n"


def test_a_mission_and_what_was_built_of_it_in_another_folder(tmp_path: Path) -> None:
    for name, text in {
        "robot/skills.xml": '<root BTCPP_format="4"><TreeNodesModel><Action ID="Drive"/></TreeNodesModel></root>',
        "robot/common/reqs.btq": 'include "../skills.xml"\nQualityReq rq1\n    takes at most 30 s\n',
        "robot/common/parts.btq": "BehaviorTree Part\n    Drive\n",
        "robot/missions/main.btq": 'include "../common/reqs.btq"\ninclude "../common/parts.btq"\nRoot Main\n'
        "BehaviorTree Main\n    ->\n        Drive satisfies rq1\n        SubTree Part\n        Wave (arm = left)\n",
    }.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    mission, built = "robot/missions/main.btq", "out/missions/main.xml"
    assert run_btq("build", mission, "-o", "out", cwd=tmp_path)[0] == 0
    assert btq(mission, built, cwd=tmp_path) == (0, "", "")
    reqs = tmp_path / "robot" / "common" / "reqs.btq"
    reqs.write_text(reqs.read_text().replace("30 s", "20 s"))
    code, out, told = btq(mission, built, cwd=tmp_path)
    where = "out/common/reqs.qreq.json:out/common/reqs.btq:2"
    assert (code, out.splitlines()[1], told) == (1, f"~ requirement rq1 changed  {where}", "")


def test_manual_edits_of_guards(tmp_path: Path) -> None:
    requirement = "QualityReq rq1\n    takes at most 30 s\n    on violation fail\n"
    tree = "BehaviorTree M\n    Sequence\n        Go satisfies rq1\nTreeNodesModel\n    Action Go\n"
    (tmp_path / "main.btq").write_text(requirement + tree)
    assert run_btq("build", "main.btq", cwd=tmp_path)[0] == 0
    xml = tmp_path / "main.xml"
    assert btq("main.btq", "main.xml", cwd=tmp_path) == (0, "", "")
    xml.write_text(xml.read_text().replace('"30000"', '"40000"'))
    line = xml.read_text()[: xml.read_text().index("<Timeout")].count("\n") + 1
    advice = "changed; the next build restores it; change the requirement that it enforces instead"
    for paths, sign in ((("main.btq", "main.xml"), "+"), (("main.xml", "main.btq"), "-")):
        said = f"~ guard rq1_limit changed  main.xml:{line}\n    {sign} by hand: {advice}\n\n1 guard changed\n"
        assert btq(*paths, cwd=tmp_path) == (1, f"{' -> '.join(paths)}\n{said}", "")
    assert btq("main.xml", "main.xml", cwd=tmp_path) == (0, "", "")


def test_models_that_a_build_made_are_no_change(tmp_path: Path) -> None:
    mission = tmp_path / "main.btq"
    mission.write_text(
        "Root Main\nBehaviorTree Main\n    ->\n        Wave (arm = left)\n        Condition Free\n"
        "        Wave (arm = {arm} times = 3)\n"
    )
    assert run_btq("build", "main.btq", cwd=tmp_path)[0] == 0
    assert not (tmp_path / "main.qreq.json").exists()
    assert btq("main.btq", "main.xml", cwd=tmp_path) == (0, "", "")
    assert btq("main.xml", "main.btq", cwd=tmp_path) == (0, "", "")
    built = tmp_path / "main.xml"
    built.write_text(built.read_text().replace('"times"', '"times" type="int"'))
    code, out, _ = btq("main.btq", "main.xml", cwd=tmp_path)  # somebody has said more of it
    assert (code, out.splitlines()[1], out.splitlines()[-1]) == (
        1,
        "+ node model Wave added  main.xml:12",
        "1 node model added",
    )


def test_a_missing_include_is_told(tmp_path: Path) -> None:
    (tmp_path / "a.btq").write_text('include "skills.btq"\nBehaviorTree Main\n    Go\n')
    (tmp_path / "b.btq").write_text("BehaviorTree Main\n    Go\n")
    code, out, told = btq("a.btq", "b.btq", cwd=tmp_path)
    assert (code, out.splitlines()[1]) == (1, "- include skills.btq removed  a.btq:1")
    assert told == "btq: a.btq: includes `skills.btq`, which does not exist: its content is not compared\n"


def test_a_mission_and_its_xml(tmp_path: Path) -> None:
    (tmp_path / "main.btq").write_text("BehaviorTree Main\n    Timeout (msec = 30 s)\n        AlwaysSuccess\n")
    xml = '<root BTCPP_format="4">\n<BehaviorTree ID="Main">\n<Timeout msec="{}"><AlwaysSuccess/></Timeout>\n'
    (tmp_path / "same.xml").write_text(xml.format(30000) + "</BehaviorTree></root>")
    (tmp_path / "other.xml").write_text(xml.format(20000) + "</BehaviorTree></root>")
    assert btq("main.btq", "same.xml", cwd=tmp_path) == (0, "", "")
    code, out, _ = btq("main.btq", "other.xml", cwd=tmp_path)
    assert (code, out.splitlines()[1:3]) == (
        1,
        ["~ node Main/Timeout changed  other.xml:3", "    ~ msec: 30 s -> 20000"],
    )


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            ("a.btq",),
            "btq diff: expected two missions, found 1; to compare revisions of one: btq diff --git HEAD FILE\n",
        ),
        (
            ("a.btq", "b.btq"),
            "btq diff: a.btq: cannot be read: No such file or directory\n"
            "btq diff: b.btq: cannot be read: No such file or directory\n",
        ),
        ((".", "nix"), "btq diff: nix: cannot be read: No such file or directory\n"),
        (("-", "nix.btq"), "btq diff: nix.btq: cannot be read: No such file or directory\n"),
        (("-", "-"), "btq diff: one of the two can be standard input, not both\n"),
        (("-", "."), "btq diff: standard input is one file, and . is a folder\n"),
        (
            ("--git", "HEAD", "-"),
            "btq diff: standard input has no revisions: git show REV:FILE | btq diff - FILE\n",
        ),
    ],
)
def test_what_cannot_be_compared(arguments: tuple[str, ...], message: str, tmp_path: Path) -> None:
    assert btq(*arguments, cwd=tmp_path) == (2, "", message)


def test_a_file_with_an_error_is_compared_as_far_as_it_is_understood(tmp_path: Path) -> None:
    (tmp_path / "a.btq").write_text("BehaviorTree Main\n    Go\n")
    (tmp_path / "b.btq").write_text("BehaviorTree Main\n    Go\n!!\n")
    code, out, told = btq("a.btq", "b.btq", cwd=tmp_path)
    assert (code, out) == (0, "")
    assert told.startswith("btq: b.btq:3:1: ")
    assert told.endswith("; btq compares the rest\n")


@pytest.fixture
def repository(tmp_path: Path) -> Path:
    """Two commits of a mission and its requirements, and an edit that is not committed."""
    if shutil.which("git") is None:
        pytest.skip("no git on PATH")
    git = ("git", "-c", "user.name=a", "-c", "user.email=a@b", "-c", "init.defaultBranch=main")
    folder = tmp_path / "robot"
    (folder / "missions").mkdir(parents=True)
    main, reqs = folder / "missions" / "main.btq", folder / "reqs.btq"
    subprocess.run([*git, "init", "-q"], cwd=folder, check=True)
    for limit in (30, 20):
        reqs.write_text(f"QualityReq rq1\n    takes at most {limit} s\n")
        main.write_text('include "../reqs.btq"\nBehaviorTree Main\n    Go satisfies rq1\n')
        subprocess.run([*git, "add", "-A"], cwd=folder, check=True)
        subprocess.run([*git, "commit", "-q", "-m", f"at most {limit} s"], cwd=folder, check=True)
    main.write_text('include "../reqs.btq"\nBehaviorTree Main\n    Inverter\n        Go satisfies rq1\n')
    return folder


def test_revisions(repository: Path) -> None:
    added = "+ node Main/Inverter added around Go  missions/main.btq:3\n\n1 node added\n"
    title = "HEAD:missions/main.btq -> missions/main.btq\n"
    assert btq("--git", "HEAD", cwd=repository) == (1, title + added, "")
    assert btq("--git", "HEAD", "missions/main.btq", cwd=repository) == (1, title + added, "")
    changed = "    - takes at most 30 s\n    + takes at most 20 s\n\n1 requirement changed\n"
    assert btq("--git", "HEAD~1..HEAD", cwd=repository) == (
        1,
        f"HEAD~1:reqs.btq -> HEAD:reqs.btq\n~ requirement rq1 changed  HEAD:reqs.btq:1\n{changed}",
        "",
    )
    assert btq("--git", "HEAD~1...HEAD", "main.btq", cwd=repository / "missions") == (
        1,
        "HEAD~1...HEAD:main.btq -> HEAD:main.btq\n"
        f"~ requirement rq1 changed  HEAD:{repository.as_posix()}/reqs.btq:1\n{changed}",
        "",
    )
    assert btq("--git", "HEAD..HEAD", cwd=repository) == (0, "", "")


def test_a_file_that_is_in_neither_revision(repository: Path) -> None:
    said = "btq diff: {}: no such file in {}\n"
    assert btq("--git", "HEAD", "nix.btq", cwd=repository) == (2, "", said.format("nix.btq", "HEAD or here"))
    assert btq("--git", "HEAD", "nix/nix.btq", cwd=repository) == (2, "", said.format("nix/nix.btq", "HEAD or here"))
    told = said.format("nix", "HEAD~1 or HEAD")
    assert btq("--git", "HEAD~1..HEAD", "nix", cwd=repository) == (2, "", told)


def test_a_folder_that_is_in_the_revision_alone(repository: Path) -> None:
    shutil.rmtree(repository / "missions")
    code, out, told = btq("--git", "HEAD", "missions", cwd=repository)
    assert (code, out.splitlines()[0], told) == (1, "HEAD:missions/main.btq (removed)", "")


def test_revisions_that_there_are_not(repository: Path, tmp_path: Path) -> None:
    assert btq("--git", "nosuch", cwd=repository) == (2, "", "btq diff: git does not know the revision `nosuch`\n")
    assert btq("--git", "--output=x", cwd=repository)[0] == 2
    code, _, told = btq("--git", "HEAD", cwd=tmp_path)
    assert code == 2
    assert "not a git repository" in told


def test_the_side_file_of_a_revision_is_read(repository: Path) -> None:
    git = ("git", "-c", "user.name=a", "-c", "user.email=a@b")
    mission = repository / "m.btq"
    for limit in (30, 20):
        mission.write_text(f"QualityReq rq1\n    takes at most {limit} s\nBehaviorTree Main\n    Go satisfies rq1\n")
        assert run_btq("build", "m.btq", cwd=repository)[0] == 0
        if limit == 30:
            subprocess.run([*git, "add", "m.btq", "m.xml", "m.qreq.json"], cwd=repository, check=True)
            subprocess.run([*git, "commit", "-q", "-m", "built"], cwd=repository, check=True)
    changed = "    - takes at most 30 s\n    + takes at most 20 s\n\n1 requirement changed\n"
    assert btq("--git", "HEAD", "m.xml", cwd=repository) == (
        1,
        f"HEAD:m.xml -> m.xml\n~ requirement rq1 changed  m.qreq.json:m.btq:1\n{changed}",
        "",
    )
    subprocess.run([*git, "commit", "-q", "-a", "-m", "built again"], cwd=repository, check=True)
    assert btq("--git", "HEAD~1..HEAD", "m.xml", cwd=repository) == (
        1,
        f"HEAD~1:m.xml -> HEAD:m.xml\n~ requirement rq1 changed  HEAD:m.qreq.json:m.btq:1\n{changed}",
        "",
    )


def test_built_xml_whose_mission_is_in_another_repository(repository: Path) -> None:
    git = ("git", "-c", "user.name=a", "-c", "user.email=a@b")
    lib = "signal s : {} from {{s}}\nBehaviorTree Lib\n    Go{} satisfies QualityReq rq1 takes at most 9 s\n"
    main = 'include "lib.btq"\nRoot Main\nBehaviorTree Main\n    SubTree Lib\n'
    (repository / "built").mkdir()

    def build(unit: str, name: str) -> None:
        (repository / "m.btq").write_text(main)
        (repository / "lib.btq").write_text(lib.format(unit, name))
        assert run_btq("build", "m.btq", "-o", "built", cwd=repository)[0] == 0
        (repository / "m.btq").unlink()
        (repository / "lib.btq").unlink()

    build("m", "")
    subprocess.run([*git, "add", "built"], cwd=repository, check=True)
    subprocess.run([*git, "commit", "-q", "-m", "built"], cwd=repository, check=True)
    assert btq("--git", "HEAD", "built", cwd=repository) == (0, "", "")
    build("m", " Fast")
    said = "HEAD:built/lib.xml -> built/lib.xml\n~ node Lib/Fast changed  built/lib.qreq.json:built/lib.btq:3\n"
    said += "    + name: Fast\n\n1 node changed\n"
    assert btq("--git", "HEAD", "built", cwd=repository) == (1, said, "")
    subprocess.run([*git, "commit", "-q", "-a", "-m", "built again"], cwd=repository, check=True)
    code, out, told = btq("--git", "HEAD~1..HEAD", "built", cwd=repository)
    assert (code, titles(out), told) == (1, ["HEAD~1:built/lib.xml -> HEAD:built/lib.xml"], "")
    build("kg", " Fast")  # which the side file alone says
    said = "HEAD:built/lib.xml -> built/lib.xml\n~ signal s changed  built/lib.qreq.json:built/lib.btq:1\n"
    said += "    ~ unit: m -> kg\n\n1 signal changed\n"
    assert btq("--git", "HEAD", "built", cwd=repository) == (1, said, "")
    (repository / "lib.btq").write_text(lib.format("kg", " Fast"))  # HEAD says it in XML alone
    assert btq("--git", "HEAD", "built", cwd=repository) == (1, said, "")
    subprocess.run([*git, "add", "."], cwd=repository, check=True)
    subprocess.run([*git, "commit", "-q", "-a", "-m", "with its mission"], cwd=repository, check=True)
    build("s", " Slow")
    (repository / "lib.btq").write_text(lib.format("s", " Slow"))
    code, out, told = btq("--git", "HEAD", cwd=repository)
    assert (code, titles(out), told) == (1, ["HEAD:lib.btq -> lib.btq"], "")


INCLUDED = '<root BTCPP_format="4"><BehaviorTree ID="X"><{}/></BehaviorTree></root>\n'


def titles(out: str) -> list[str]:
    """The titles of the files whose changes are listed."""
    return [line for line in out.splitlines() if line[:1].isalpha()]


def test_a_change_of_included_xml_is_seen_from_its_folder(repository: Path) -> None:
    git = ("git", "-c", "user.name=a", "-c", "user.email=a@b")
    subprocess.run([*git, "checkout", "-q", "."], cwd=repository, check=True)
    (repository / "q.btq").write_text('include "b1.xml"\nBehaviorTree Q\n    SubTree X\n')
    (repository / "b1.xml").write_text(INCLUDED.format("Go"))
    (repository / "package.xml").write_text("<package><name>a</name></package>\n")
    subprocess.run([*git, "add", "-A"], cwd=repository, check=True)
    subprocess.run([*git, "commit", "-q", "-m", "xml"], cwd=repository, check=True)
    (repository / "b1.xml").write_text(INCLUDED.format("Stop"))
    (repository / "package.xml").write_text("<package><name>b</name></package>\n")
    code, out, told = btq("--git", "HEAD", cwd=repository)
    assert (code, titles(out), told) == (1, ["HEAD:b1.xml -> b1.xml"], "")
    subprocess.run([*git, "commit", "-q", "-a", "-m", "other xml"], cwd=repository, check=True)
    code, out, told = btq("--git", "HEAD~1..HEAD", cwd=repository)
    assert (code, titles(out), told) == (1, ["HEAD~1:b1.xml -> HEAD:b1.xml"], "")


def test_two_folders_of_xml(tmp_path: Path) -> None:
    for folder, node in (("old", "Go"), ("new", "Stop")):
        (tmp_path / folder / "sub").mkdir(parents=True)
        (tmp_path / folder / "sub" / "x.xml").write_text(INCLUDED.format(node))
        (tmp_path / folder / "same.xml").write_text(INCLUDED.format("Go"))
        (tmp_path / folder / "package.xml").write_text(f"<package><name>{node}</name></package>\n")
    code, out, told = btq("old", "new", cwd=tmp_path)
    assert (code, titles(out), told) == (1, ["old/sub/x.xml -> new/sub/x.xml"], "")


def test_built_xml_is_no_change_of_a_folder(tmp_path: Path) -> None:
    for folder, node in (("old", "Go"), ("new", "Stop")):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "m.btq").write_text(f"BehaviorTree Main\n    {node}\n")
        assert run_btq("build", "m.btq", cwd=tmp_path / folder)[0] == 0
    code, out, told = btq("old", "new", cwd=tmp_path)
    assert (code, titles(out), told) == (1, ["old/m.btq -> new/m.btq"], "")


def test_two_folders_of_built_xml(tmp_path: Path) -> None:
    skills = "BehaviorTree Part\n    Drive\n"
    for folder, limit, node in (("old", 30, "Go"), ("new", 20, "Stop")):
        (tmp_path / folder / "source").mkdir(parents=True)
        texts = {
            "m": f'include "skills.btq"\nRoot M\nBehaviorTree M\n    SubTree Part satisfies rq1\n'
            f"QualityReq rq1\n    takes at most {limit} s\n",
            "n": f"BehaviorTree N\n    {node}\n",
            "skills": skills,
        }
        for name, text in texts.items():
            (tmp_path / folder / "source" / f"{name}.btq").write_text(text)
        assert run_btq("build", "source", "-o", ".", cwd=tmp_path / folder)[0] == 0
        (tmp_path / folder / "source").rename(tmp_path / f"{folder}.source")
    code, out, told = btq("old", "new", cwd=tmp_path)
    assert (code, titles(out), told) == (1, ["old/m.xml -> new/m.xml", "old/n.xml -> new/n.xml"], "")
    assert out.splitlines()[1] == "~ requirement rq1 changed  new/m.qreq.json:new/m.btq:5"
    assert btq("old", "old", cwd=tmp_path) == (0, "", "")
    assert btq("old", "old.source", cwd=tmp_path) == (0, "", "")
    code, out, told = btq("old.source", "new", cwd=tmp_path)
    assert (code, titles(out), told) == (1, ["old.source/m.btq -> new/m.xml", "old.source/n.btq -> new/n.xml"], "")


def test_xml_and_what_was_imported_in_another_folder(tmp_path: Path) -> None:
    (tmp_path / "old").mkdir()
    for name in ("x", "y"):
        (tmp_path / "old" / f"{name}.xml").write_text(INCLUDED.format("Go"))
    assert run_btq("import", "old/x.xml", "old/y.xml", "-o", "new", cwd=tmp_path)[0] == 0
    assert btq("old", "new", cwd=tmp_path) == (0, "", "")
    (tmp_path / "old" / "y.xml").write_text(INCLUDED.format("Stop"))
    (tmp_path / "new" / "y.xml").write_text(INCLUDED.format("Go"))
    code, out, told = btq("old", "new", cwd=tmp_path)
    assert (code, titles(out), told) == (1, ["new/y.btq (added)", "old/y.xml -> new/y.xml"], "")


def test_includes_of_xml_and_of_what_was_imported(tmp_path: Path) -> None:
    for place, tree in (("x", "X"), ("a/x", "A"), ("b/x", "B")):
        (tmp_path / place).parent.mkdir(exist_ok=True)
        (tmp_path / f"{place}.xml").write_text(INCLUDED.format("Go").replace('ID="X"', f'ID="{tree}"'))
    paths = ("x.xml", "a/x.xml", "b/x.xml")
    includes = "".join(f'<include path="{path}"/>' for path in paths)
    tree = '<BehaviorTree ID="Main"><Go/></BehaviorTree>'
    (tmp_path / "main.xml").write_text(f'<root BTCPP_format="4">{includes}{tree}</root>\n')
    assert run_btq("import", "main.xml", *paths, cwd=tmp_path)[0] == 0
    assert btq("main.xml", "main.btq", cwd=tmp_path) == (0, "", "")
    assert btq("main.btq", "main.xml", cwd=tmp_path) == (0, "", "")


def test_of_files_that_become_one_none_is_imported(tmp_path: Path) -> None:
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "x.xml").write_text(INCLUDED.format("Go"))
    (tmp_path / "main.xml").write_text('<root BTCPP_format="4"><include path="a/x.xml"/></root>\n')
    done = run_btq("import", "main.xml", "a/x.xml", "b/x.xml", "-o", "fl", cwd=tmp_path)
    told = "btq: b/x.xml: not imported: a/x.xml would also become fl/x.btq\n0 files imported\n"
    assert done == (2, "", told)
    assert not (tmp_path / "fl").exists()


def test_a_btq_file_is_not_imported(tmp_path: Path) -> None:
    (tmp_path / "x.btq").write_text("BehaviorTree Main\n    Go\n")
    done = run_btq("import", "x.btq", "--force", cwd=tmp_path)
    told = "btq: x.btq: not imported: its name does not end with .xml\n0 files imported\n"
    assert done == (2, "", told)
