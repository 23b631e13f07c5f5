"""Side files: what they say, that they keep their schema, and the way back."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path
from typing import Any

import pytest
from build_command import Btq
from json_schema import violations
from missions import mission

from btq_lang.btcpp.as_built import as_built
from btq_lang.btcpp.document import write
from btq_lang.btcpp.export import export
from btq_lang.btcpp.importing import import_xml
from btq_lang.btcpp.restoring import LostClauses, restored
from btq_lang.btcpp.side_file import BuiltFile, is_side_file, side_file, side_path
from btq_lang.catalog.name_kinds import Kind
from btq_lang.cli import main
from btq_lang.projects.opening import Disk
from btq_lang.workspace.workspace import Workspace

Capsys = pytest.CaptureFixture[str]
ROOT = Path(__file__).resolve().parents[2]
SCHEMA = json.loads((ROOT / "btq_lang" / "btcpp" / "qreq.schema.json").read_text(encoding="utf-8"))

MISSION = """\
signal speed : m/s from {speed} # how fast
QualityReq slow(limit : m/s = 0.25 m/s) : safety "Slowly"
    keeps speed <= limit
apply slow(limit = 36 m/h) to Part/Move
QualityReq quick : time-behaviour
    takes at most 0.5 min
    on violation fail
Root Main
BehaviorTree Main
    satisfices safety
    ->
        SubTree Part
        SubTree Part Twice
            satisfies quick
        xml "<AlwaysSuccess/>"
BehaviorTree Part
    ->
        Move satisfices ergonomics
        Pick Again
"""


def built(text: str, **others: str) -> tuple[str, str | None]:
    """The XML and the side file of a mission, `main.btq`, which may include others."""
    workspace = Workspace.of({"main.btq": text, **{f"{name}.btq": other for name, other in others.items()}})
    exports = [export(workspace, path) for path in workspace.closure("main.btq")]
    xml = write(exports[-1].document)
    elements = {key: element for each in exports for key, element in each.elements.items()}
    documents = tuple(each.document for each in exports)
    return xml, side_file(workspace, BuiltFile("main.btq", "main.xml", xml, documents, elements))


def said(text: str, **others: str) -> dict[str, Any]:
    _, side = built(text, **others)
    assert side is not None
    data: dict[str, Any] = json.loads(side)
    assert list(violations(data, SCHEMA)) == []
    return data


def test_a_context_is_said_once_and_named_elsewhere() -> None:
    data = said(
        "signal speed : m/s from {speed}\ncontext slow : speed < 1 m/s\ncontext calm : slow or not slow\n"
        "QualityReq r(limit : m/s)\n    keeps speed < limit\n    while calm\n    on violation fail\n"
        "apply r(limit = 1 m/s if calm else 2 m/s) to Move\nBehaviorTree Main\n    Action Move\n"
    )
    slow = {"is": "incontext", "name": "slow"}
    calm = {"is": "incontext", "name": "calm"}
    value = {"is": "value", "text": "1 m/s", "si": 1.0, "unit": "m/s"}
    read = {"is": "read", "signal": "speed"}
    assert data["version"] == 2
    assert data["contexts"] == [
        {"name": "slow", "condition": {"is": "compare", "operators": ["<"], "operands": [read, value]}},
        {"name": "calm", "condition": {"is": "any", "conditions": [slow, {"is": "not", "condition": slow}]}},
    ]
    (requirement,) = data["requirements"]
    assert requirement["scopes"] == [{"is": "scope", "word": "while", "condition": calm, "text": "while calm"}]
    (applied,) = data["applied"]
    assert applied["arguments"]["limit"]["cases"][0] == {"is": "case", "value": value, "condition": calm}


def test_side_files_of_version_1_are_read() -> None:
    """As they were written before contexts were named: an import gives the mission back, as it was and changed."""
    mission = MISSION.replace("# how fast", "# how fast\ncontext slow_now : speed < 1 m/s")
    xml, side = built(mission.replace("keeps speed <= limit", "keeps speed <= limit\n    while slow_now"))
    assert side is not None
    new = json.loads(side)
    context = {each["name"]: each["condition"] for each in new.pop("contexts")}["slow_now"]
    named = '{"is": "incontext", "name": "slow_now"}'
    old = json.dumps({**new, "version": 1})
    assert old.count(named) == 1
    old = old.replace(named, json.dumps({"is": "incontext", "name": "slow_now", "condition": context}))
    assert restored(xml, import_xml(xml).text, old) == restored(xml, import_xml(xml).text, side)
    changed = xml.replace('name="Again"', 'name="Anew"')
    restoring = restored(changed, import_xml(changed).text, old)
    assert restoring == restored(changed, import_xml(changed).text, side)
    assert restoring is not None
    assert "context slow_now" in restoring.text
    assert restored(xml, import_xml(xml).text, old.replace('"version": 1', '"version": 3')) is None


def test_what_a_side_file_says() -> None:
    data = said(MISSION)
    assert data["main_tree"] == "Main"
    assert data["mission"] == {"file": "main.btq", "text": MISSION}
    assert data["nodes"] == [
        {"uid": 1, "path": "Sequence::1", "file": "main.btq", "line": 11},
        {"uid": 2, "path": "Part::2", "file": "main.btq", "line": 12},
        {"uid": 3, "path": "Part::2/Sequence::3", "file": "main.btq", "line": 17},
        {"uid": 4, "path": "Part::2/Move::4", "file": "main.btq", "line": 18},
        {"uid": 5, "path": "Part::2/Again", "file": "main.btq", "line": 19},
        {"uid": 6, "path": "Twice", "file": "main.btq", "line": 13},
        {"uid": 7, "path": "Twice/Sequence::7", "file": "main.btq", "line": 17},
        {"uid": 8, "path": "Twice/Move::8", "file": "main.btq", "line": 18},
        {"uid": 9, "path": "Twice/Again", "file": "main.btq", "line": 19},
        {"uid": 10, "path": "AlwaysSuccess::10"},
    ]
    assert data["concerns"] == [
        {"qualities": ["safety"], "nodes": [1]},
        {"qualities": ["ergonomics"], "nodes": [4, 8]},
    ]
    limit = {"is": "value", "text": "36 m/h", "si": 0.01, "unit": "m/h"}
    assert data["applied"] == [
        {
            "requirement": "slow",
            "how": "apply",
            "arguments": {"limit": limit},
            "claims": [
                {
                    "is": "claim",
                    "verb": "keeps",
                    "text": "keeps speed <= limit",
                    "condition": {
                        "is": "compare",
                        "operators": ["<="],
                        "operands": [{"is": "read", "signal": "speed"}, limit],
                    },
                }
            ],
            "nodes": [4, 8],
        },
        {"requirement": "quick", "how": "satisfies", "nodes": [6]},
    ]
    quick = next(each for each in data["requirements"] if each["id"] == "quick")
    assert quick == {
        "id": "quick",
        "quality": "time-behaviour",
        "classic": False,
        "claims": [
            {
                "is": "claim",
                "verb": "takes",
                "text": "takes at most 0.5 min",
                "limit": {
                    "is": "limit",
                    "relation": "<=",
                    "value": {"is": "value", "text": "0.5 min", "si": 30.0, "unit": "min"},
                },
            }
        ],
        "on_violation": "fail",
        "file": "main.btq",
        "line": 5,
    }


def test_a_path_through_a_subtree_means_its_instance() -> None:
    data = said(MISSION.replace("apply slow(limit = 36 m/h) to Part/Move", "apply slow to Twice/Move"))
    assert data["applied"][0]["nodes"] == [8]


def test_behind_a_tree_that_is_not_there_nobody_knows_the_numbers() -> None:
    data = said(
        "Root A\nBehaviorTree A\n    ->\n        SubTree Gone\n        Pick Up satisfices safety\n        Pick\n"
    )
    assert [(each["uid"], each["path"]) for each in data["nodes"]] == [
        (1, "Sequence::1"),
        (2, "Gone::2"),
        (None, "Up"),
        (None, "Pick::?"),
    ]
    assert data["concerns"] == [{"qualities": ["safety"], "nodes": [None]}]


def test_a_mission_that_says_no_more_than_its_xml_has_none() -> None:
    assert built("# a comment\nBehaviorTree Main\n    Pick\n")[1] is None


def test_what_satisfies_a_requirement_about_other_nodes_is_named() -> None:
    requirement = 'QualityReq calm : safety "Calmly"\n    Pick takes at most 30 s\n'
    text = f"{requirement}BehaviorTree Main\n    ->\n        Move satisfies calm\n        Pick\n"
    _, side = built(text)
    assert side is not None
    assert json.loads(side)["traces"] == [{"requirement": "calm", "nodes": [2]}]


def test_included_files_are_named() -> None:
    data = said('include "part.btq"\nRoot A\nBehaviorTree A\n    SubTree P\n', part="BehaviorTree P\n    X tags a\n")
    assert data["files"] == ["part.btq", "main.btq"]
    assert data["nodes"][1] == {"uid": 2, "path": "P::1/X::2", "file": "part.btq", "line": 2}


@pytest.mark.parametrize("spelling", ["classic", "short"])
def test_side_files_of_missions_made_up_keep_the_schema_and_lead_back(spelling: Any) -> None:
    text = mission(200, 3, spelling)
    xml, side = built(text)
    assert side is not None
    assert list(violations(json.loads(side), SCHEMA)) == []
    again = restored(xml, import_xml(xml).text, side)
    assert again is not None
    assert (again.text, again.is_whole) == (text, True)


@pytest.mark.parametrize("example", ["classic", "hospital", "inspection", "laboratory", "navigation", "pick-and-place"])
def test_an_example_is_built_and_imported(btq: Btq, capsys: Capsys, example: str) -> None:
    shutil.copytree(ROOT / "examples" / example, btq.folder / "there")
    assert btq.build("there", "-o", "out")[0] == 0
    for xml in sorted((btq.folder / "out").rglob("*.xml")):
        place = xml.relative_to(btq.folder / "out").with_suffix("")
        sources = (btq.folder / "there").rglob(f"{place.name}.*")
        (source,) = (each for each in sources if each.suffix in (".btq", ".qualitybtcpp"))
        if xml.with_suffix(".qreq.json").exists():
            assert main(["import", str(xml), "-o", "back"]) == 0
            assert btq.read(f"back/{place.name}.btq") == source.read_text(encoding="utf-8")
            assert list(violations(json.loads(xml.with_suffix(".qreq.json").read_text("utf-8")), SCHEMA)) == []
            xml.write_text(xml.read_text("utf-8").replace("  </BehaviorTree>", "  <Late/></BehaviorTree>"), "utf-8")
            capsys.readouterr()
            assert main(["import", str(xml), "-o", "back", "--force"]) == 0
            assert "by hand" not in capsys.readouterr().err


def test_of_xml_that_was_edited_the_rest_comes_back() -> None:
    xml, side = built(MISSION)
    assert side is not None
    edited = xml.replace('<Pick name="Again"/>', '<Pick name="Again" x="1"/>').replace("<Move ", "<Drive ")
    again = restored(edited, import_xml(edited).text, side)
    assert again is not None
    assert (again.is_whole, again.lost) == (False, (LostClauses("satisfices ergonomics", None, 18),))
    now, then = (Workspace.of({"main.btq": text}) for text in (again.text, MISSION))
    assert now.files["main.btq"].parsed.diagnostics == ()
    for kind in (Kind.SIGNAL, Kind.REQUIREMENT, Kind.TREE):
        assert now.scope("main.btq").names(kind) == then.scope("main.btq").names(kind)
    assert "signal speed : m/s from {speed} # how fast\n" in again.text
    assert "    keeps speed <= limit\n" in again.text
    assert "apply slow(limit = 36 m/h) to Part/Move\n" in again.text
    assert "    satisfices safety\n    ->\n" in again.text
    assert "SubTree Part Twice satisfies quick\n" in again.text
    assert "Pick Again (x = 1)\n" in again.text


def test_a_mission_is_restored_with_what_it_includes(btq: Btq) -> None:
    part = "BehaviorTree P\n    Go satisfices safety\n"
    btq.write(part=part, main='include "part.btq"\nRoot A\nBehaviorTree A\n    SubTree P satisfices safety\n')
    main_text = btq.read("main.btq")
    assert btq.build("main.btq", "-o", "out")[0] == 0
    assert as_built(str(btq.folder / "out" / "part.btq"), Disk()) is None
    built = as_built(str(btq.folder / "out" / "main.xml"), Disk())
    assert built is not None
    texts = {Path(path).relative_to(btq.folder).as_posix(): file.text for path, file in built.workspace.files.items()}
    assert texts == {"out/main.btq": main_text, "out/part.btq": part}
    assert built.path == str(btq.folder / "out" / "main.btq")
    assert {built.shown(path) for path in built.workspace.files} == {
        "out/main.qreq.json:out/main.btq",
        "out/part.qreq.json:out/part.btq",
    }
    assert built.manual_edits == ()


def test_clauses_over_several_lines_come_back_on_one() -> None:
    text = (
        "BehaviorTree A\n    Pick (\n        satisfices Quality = safety\n        (QualityReq ID = q\n"
        '         description = "d" # why\n        ), Quality = x)\n'
    )
    xml, side = built(text)
    assert side is not None
    again = restored(xml + "\n", import_xml(xml).text, side)
    assert again is not None
    assert Workspace.of({"main.btq": again.text}).files["main.btq"].parsed.diagnostics == ()
    assert " ".join(again.text.split()).endswith(
        'Pick satisfices Quality = safety (QualityReq ID = q description = "d" /* why */ ), Quality = x TreeNodesModel'
        " Action Pick"
    )


@pytest.mark.parametrize(
    "side", ["", "{", "[]", "null", '{"format": "btq-requirements"}', '{"format": "x", "version": 1}', "[" * 100_000]
)
def test_what_is_no_side_file_is_none(side: str) -> None:
    assert restored("<root/>", "", side) is None


BUNDLED = {
    "main.btq": 'include "shared/a.btq"\ninclude "old.xml"\nRoot M\nBehaviorTree M\n    SubTree P satisfies quick\n',
    "shared/a.btq": (
        'include "deep/b.btq"\ncontext near : speed < 1 m/s\nBehaviorTree P\n    ->\n        Pick tags x\n        Go\n'
    ),
    "shared/deep/b.btq": "signal speed : m/s\nQualityReq quick : time-behaviour\n    takes at most 1 s\n",
    "old.xml": '<root BTCPP_format="4"><BehaviorTree ID="Old"><Go/></BehaviorTree></root>\n',
}


def bundled(folder: Path, btq: Btq) -> Path:
    for name, text in BUNDLED.items():
        (folder / "my" / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / "my" / name).write_text(text)
    assert btq.build("my/main.btq", "--bundle", "-o", "out")[0] == 0
    side = folder / "out" / "main.qreq.json"
    assert list(violations(json.loads(side.read_text()), SCHEMA)) == []
    return side


def below(folder: Path) -> dict[str, str]:
    return {each.relative_to(folder).as_posix(): each.read_text() for each in folder.rglob("*.*") if each.is_file()}


def test_of_a_bundle_every_file_comes_back(btq: Btq) -> None:
    bundled(btq.folder, btq)
    assert main(["import", "out/main.xml", "-o", "back"]) == 0
    assert below(btq.folder / "back") == BUNDLED
    assert main(["check", "back"]) == 0


def test_files_of_a_bundle_are_written_over_if_asked(btq: Btq) -> None:
    bundled(btq.folder, btq)
    mine = btq.folder / "back" / "shared" / "a.btq"
    mine.parent.mkdir(parents=True)
    mine.write_text("mine")
    assert main(["import", "out/main.xml", "-o", "back"]) == 2
    assert below(btq.folder / "back") == {"shared/a.btq": "mine"}
    assert main(["import", "out/main.xml", "-o", "back", "--force"]) == 0
    assert below(btq.folder / "back") == BUNDLED


@pytest.mark.parametrize(
    "name",
    [
        "../../x.btq",
        "a/../../x.btq",
        "/x.btq",
        "C:/x.btq",
        "..\\x.btq",
        "link/x.btq",
        "a.sh",
        ".btq/../../x.btq",
        "main.btq",
    ],
)
def test_no_file_of_a_bundle_goes_elsewhere(btq: Btq, name: str) -> None:
    side = bundled(btq.folder, btq)
    data = json.loads(side.read_text())
    data["sources"][0]["file"] = name
    side.write_text(json.dumps(data))
    (btq.folder / "elsewhere").mkdir()
    (btq.folder / "back").mkdir()
    (btq.folder / "back" / "link").symlink_to(btq.folder / "elsewhere", target_is_directory=True)
    known = below(btq.folder)
    assert main(["import", "out/main.xml", "-o", "back", "--force"]) == 2
    assert below(btq.folder) == known


def test_a_mission_that_includes_what_stands_above_it_keeps_its_folder(btq: Btq) -> None:
    texts = {
        "missions/m.btq": 'include "../shared/a.btq"\nBehaviorTree M\n    SubTree A tags x\n',
        "shared/a.btq": "BehaviorTree A\n    Go\n",
    }
    for name, text in texts.items():
        (btq.folder / "my" / name).parent.mkdir(parents=True)
        (btq.folder / "my" / name).write_text(text)
    assert btq.build("my/missions/m.btq", "--bundle", "-o", "out")[0] == 0
    assert main(["import", "out/missions/m.xml", "-o", "back"]) == 0
    assert below(btq.folder / "back") == texts


def test_bundles_that_hold_different_files_of_one_name_are_not_mixed(btq: Btq, capsys: Capsys) -> None:
    for folder in ("one", "two"):
        (btq.folder / folder).mkdir()
        (btq.folder / folder / "a.btq").write_text(f"BehaviorTree A\n    Go {folder}\n")
        text = 'include "a.btq"\nBehaviorTree M\n    SubTree A tags x\n'
        (btq.folder / folder / f"{folder}.btq").write_text(text)
        assert btq.build(f"{folder}/{folder}.btq", "--bundle", "-o", "out")[0] == 0
    capsys.readouterr()
    assert main(["import", "out/one.xml", "out/two.xml", "-o", "back"]) == 2
    assert (
        "btq: out/one.xml: not imported: the bundle out/two.xml contains another version of back/a.btq\n"
        in capsys.readouterr().err
    )
    assert below(btq.folder / "back") == {}


def test_of_a_bundle_that_was_edited_what_all_files_said_comes_back(btq: Btq) -> None:
    bundled(btq.folder, btq)
    xml = btq.folder / "out" / "main.xml"
    xml.write_text(xml.read_text().replace("<Pick", "<Take"))
    assert main(["import", "out/main.xml", "-o", "back"]) == 0
    text = btq.read("back/main.btq")
    for said in ("context near : speed < 1 m/s\n", "signal speed : m/s\n", "takes at most 1 s\n", "satisfies quick\n"):
        assert said in text
    assert sorted(below(btq.folder / "back")) == ["main.btq"]


def test_what_is_lost_comes_first_and_what_a_build_put_there_in_one_line(btq: Btq, capsys: Capsys) -> None:
    (btq.folder / "main.btq").write_text(MISSION)
    assert btq.build("main.btq", "-o", "out")[0] == 0
    xml, side = btq.folder / "out" / "main.xml", btq.folder / "out" / "main.qreq.json"
    xml.write_text(xml.read_text().replace("<Move", "<Drive"))
    assert main(["import", "out/main.xml"]) == 0
    summary = "out/main.xml:5:27: removed what `btq build` added: {}\n1 file imported with 1 change\n"
    put = "1 node that enforces requirements, 3 descriptions"
    lost = "its node no longer exists: satisfices ergonomics (line 18 of the mission as built)"
    after = "Next: btq check out/main.btq\n"
    assert capsys.readouterr().err == f"out/main.xml: {lost}\n{summary.format(put)}{after}"
    side.write_text("{}")
    assert main(["import", "out/main.xml", "--force"]) == 0
    lost = "the requirements or qualities of 3 nodes are lost: "
    no = "out/main.qreq.json belongs to another build; put the one of this build there to keep them"
    assert capsys.readouterr().err == f"out/main.xml: {lost}{no}\n{summary.format(put)}{after}"
    side.unlink()
    assert main(["import", "out/main.xml", "--force"]) == 0
    no = "put out/main.qreq.json beside the XML to keep them"
    assert capsys.readouterr().err == f"out/main.xml: {lost}{no}\n{summary.format(put)}{after}"


def test_manual_edits_of_guards_are_reported(btq: Btq, capsys: Capsys) -> None:
    (btq.folder / "main.btq").write_text(
        "QualityReq quick\n    takes at most 30 s\n    on violation fail\nBehaviorTree M\n    ->\n"
        "        Go satisfies quick\n        Stay (_skipIf = off) satisfies quick\n        Go satisfies quick\n"
    )
    assert btq.build("main.btq")[0] == 0
    xml = btq.folder / "main.xml"
    built = xml.read_text()

    def told(edited: str) -> list[str]:
        xml.write_text(edited)
        capsys.readouterr()
        assert main(["import", "main.xml", "-o", "back", "--force"]) == 0
        return [line for line in capsys.readouterr().err.splitlines() if "by hand" in line]

    then = "by hand: the next build restores it; change the requirement that it enforces instead"
    at = {name: built[: built.index(f'<Timeout name="{name}')].count("\n") + 1 for name in ("quick_limit", "quick_2")}
    assert told(built.replace('"30000"', '"40000"', 1)) == [
        f"main.xml:{at['quick_limit']}:8: `quick_limit` was changed {then}"
    ]
    without = re.sub(r' *<Timeout name="quick_2.*?(<Stay[^>]*>).*?</Timeout>', r"\1", built, flags=re.DOTALL)
    assert told(without) == [f"main.xml:{at['quick_2']}:2: `quick_2_limit` was removed {then}"]
    # Nodes that move or go with all that is around them, and other spellings, are no such change.
    guarded = re.findall(r" *<Timeout.*?</Timeout>\n", built, re.DOTALL)
    assert told(built.replace(guarded[0], "")) == []
    assert told(built.replace("".join(guarded), "".join(guarded[::-1]))) == []
    assert told(built.replace('name="quick_limit" msec="30000"', "msec='30000'\n name='quick&#95;limit'")) == []
    assert told(built.replace('_skipIf="off"', '_skipIf="on"')) == []


def test_what_a_mission_includes_is_to_be_imported_too(btq: Btq, capsys: Capsys) -> None:
    (btq.folder / "my" / "shared").mkdir(parents=True)
    (btq.folder / "my" / "main.btq").write_text('include "shared/a.btq"\nBehaviorTree M\n    SubTree A tags x\n')
    (btq.folder / "my" / "shared" / "a.btq").write_text("BehaviorTree A\n    Go\n")
    assert btq.build("my/main.btq", "-o", "out")[0] == 0
    capsys.readouterr()
    next_ = "Next: btq check {}/main.btq\n"
    assert main(["import", "out/main.xml"]) == 0
    also = "To import an included file: btq import out/shared/a.xml\n"
    assert capsys.readouterr().err == f"1 file imported\n{also}{next_.format('out')}"
    assert main(["import", "out/main.xml", "-o", "back"]) == 0
    also = "To import an included file: btq import out/shared/a.xml -o back/shared\n"
    assert capsys.readouterr().err == f"1 file imported\n{also}{next_.format('back')}"
    assert main(["import", "out/shared/a.xml", "-o", "back/shared"]) == 0
    assert main(["check", "back"]) == 0
    capsys.readouterr()
    assert main(["import", "--force", "out/main.xml", "-o", "back"]) == 0
    assert capsys.readouterr().err == f"1 file imported\n{next_.format('back')}"


def test_places_and_marks() -> None:
    assert side_path("a/b.xml") == "a/b.qreq.json"
    _, side = built(MISSION)
    assert side is not None
    assert is_side_file(side)
    assert not is_side_file('{"format": "something"}')


def test_the_schema_refuses() -> None:
    assert list(violations({"uid": "1", "x": 2}, SCHEMA["properties"]["nodes"]["items"], "$", SCHEMA["$defs"])) == [
        "$: no path",
        "$.uid: '1' is no ['integer', 'null']",
        "$: unknown x",
    ]
