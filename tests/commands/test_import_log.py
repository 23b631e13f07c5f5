"""`btq import LOG`: the tree that ran, as it was written."""

from __future__ import annotations

import sqlite3
from pathlib import Path
from xml.etree import ElementTree

import pytest
from evidence_bags import names_of, text, tree_log, write_bag
from evidence_logs import MAIN_XML, START, btlog, rows, write_db3
from in_process import run_btq

RUN = rows("0 1R 2R 5 2S 3S 1S 2I 3I 1I")
WRITTEN = """\
<root BTCPP_format="4" main_tree_to_execute="Main">
  <BehaviorTree ID="Main">
    <Sequence name="all &lt;of&gt; it">
      <SubTree ID="Fetch" name="First" tube="1"/>
      <SubTree ID="Fetch" tube="{second}"/>
      <Move station="dock"/>
    </Sequence>
  </BehaviorTree>
  <BehaviorTree ID="Fetch">
    <Fallback>
      <Grip name="Take" tube="{tube}" _skipIf="done == 1"/>
      <SubTree ID="Inner" name="Deep"/>
    </Fallback>
  </BehaviorTree>
  <BehaviorTree ID="Inner">
    <AlwaysSuccess/>
  </BehaviorTree>
  <TreeNodesModel>
    <Action ID="Move">
      <input_port name="speed" type="double" default="0.5"/>
      <input_port name="station" type="std::string"/>
    </Action>
  </TreeNodesModel>
</root>
"""
# As the engine's loggers have it: a tree for each use, numbers, names, defaults, and models of its own nodes.
LOGGED = """\
<root BTCPP_format="4">
  <BehaviorTree ID="Main" _fullpath="">
    <Sequence name="all &lt;of&gt; it" _uid="1">
      <SubTree ID="Fetch" _fullpath="First" _uid="2" tube="1"/>
      <SubTree ID="Fetch" _fullpath="Fetch::7" _uid="7" tube="{second}"/>
      <Move name="Move" _uid="12" speed="0.5" station="dock"/>
    </Sequence>
  </BehaviorTree>
  <BehaviorTree ID="Fetch" _fullpath="First">
    <Fallback name="Fallback" _uid="3">
      <Grip name="Take" _uid="4" tube="{tube}" _skipIf="done == 1"/>
      <SubTree ID="Inner" _fullpath="First/Deep" _uid="5"/>
    </Fallback>
  </BehaviorTree>
  <BehaviorTree ID="Inner" _fullpath="First/Deep">
    <AlwaysSuccess name="AlwaysSuccess" _uid="6"/>
  </BehaviorTree>
  <BehaviorTree ID="Fetch" _fullpath="Fetch::7">
    <Fallback name="Fallback" _uid="8">
      <Grip name="Take" _uid="9" tube="{tube}" _skipIf="done == 1"/>
      <SubTree ID="Inner" _fullpath="Fetch::7/Deep" _uid="10"/>
    </Fallback>
  </BehaviorTree>
  <BehaviorTree ID="Inner" _fullpath="Fetch::7/Deep">
    <AlwaysSuccess name="AlwaysSuccess" _uid="11"/>
  </BehaviorTree>
  <TreeNodesModel>
    <Action ID="AlwaysSuccess"/>
    <Control ID="Fallback"/>
    <Action ID="Move">
      <input_port name="speed" type="double" default="0.5"/>
      <input_port name="station" type="std::string"/>
    </Action>
  </TreeNodesModel>
</root>
"""


def test_the_tree_as_xml(tmp_path: Path) -> None:
    (tmp_path / "run.btlog").write_bytes(btlog(LOGGED, []))
    code, out, errors = run_btq("import", "run.btlog", "--xml", cwd=tmp_path)
    assert (code, out, errors) == (0, "", "1 file imported\nNext: btq check run.xml\n")
    assert (tmp_path / "run.xml").read_text(encoding="utf-8") == f'<?xml version="1.0" encoding="UTF-8"?>\n{WRITTEN}'


def test_the_tree_as_a_mission_is_that_of_its_xml(tmp_path: Path) -> None:
    (tmp_path / "run.btlog").write_bytes(btlog(LOGGED, []))
    (tmp_path / "written.xml").write_text(WRITTEN, encoding="utf-8")
    code, _, errors = run_btq("import", "run.btlog", "written.xml", "-o", "made", cwd=tmp_path)
    assert (code, errors) == (0, "2 files imported\n")
    assert (tmp_path / "made/run.btq").read_text() == (tmp_path / "made/written.btq").read_text()


@pytest.mark.parametrize("form", ["btlog", "db3", "bag"])
def test_the_log_belongs_to_what_is_imported(form: str, tmp_path: Path) -> None:
    name = {"bag": "run"}.get(form, f"run.{form}")
    if form == "btlog":
        (tmp_path / name).write_bytes(btlog(MAIN_XML, RUN))
    elif form == "db3":
        write_db3(tmp_path / name, MAIN_XML, [RUN])
    else:
        write_bag(tmp_path / name, [text("/tree", START, MAIN_XML), *tree_log(RUN, names_of(MAIN_XML))])
    assert run_btq("import", name, cwd=tmp_path)[0] == 0
    assert (tmp_path / "run.btq").read_text(encoding="utf-8") == (
        "Root Main\n\nBehaviorTree Main\n    ->\n        Move\n        Pick\n"
    )
    code, out, _ = run_btq("verify", name, "--mission", "run.btq", cwd=tmp_path)
    assert (code, "mission run (as built now, 3 of 3 nodes)" in out) == (0, True)


def test_of_several_trees_the_last(tmp_path: Path) -> None:
    write_db3(tmp_path / "run.db3", MAIN_XML, [RUN, RUN])
    database = sqlite3.connect(tmp_path / "run.db3")
    database.execute("UPDATE Definitions SET xml_tree = replace(xml_tree, 'Pick', 'Drop') WHERE session_id = 2")
    database.commit()
    database.close()
    code, _, errors = run_btq("import", "run.db3", cwd=tmp_path)
    assert (code, errors.splitlines()[0]) == (0, "run.db3: it has 2 trees, of which the last is imported")
    assert "Drop" in (tmp_path / "run.btq").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("file", "data", "options", "why"),
    [
        ("cut.btlog", b"BTCPP4-FileLogger2", (), "cut.btlog: not imported: the file ends before its tree"),
        ("none.btlog", None, (), "none.btlog: not imported: cannot be read: No such file or directory"),
        ("a.xml", b"<root/>", ("--xml",), "a.xml: not imported: --xml is for logs"),
    ],
)
def test_what_cannot_be_imported(
    file: str, data: bytes | None, options: tuple[str, ...], why: str, tmp_path: Path
) -> None:
    if data is not None:
        (tmp_path / file).write_bytes(data)
    assert run_btq("import", file, *options, cwd=tmp_path) == (2, "", f"btq: {why}\n0 files imported\n")
    assert sorted(each.name for each in tmp_path.iterdir()) == ([file] if data is not None else [])


def test_a_bag_without_a_tree(tmp_path: Path) -> None:
    write_bag(tmp_path / "bag", tree_log(RUN, names_of(MAIN_XML)))
    assert run_btq("import", "bag", cwd=tmp_path)[2] == "btq: bag: not imported: it has no tree\n0 files imported\n"


def test_a_folder_that_is_no_bag(tmp_path: Path) -> None:
    (tmp_path / "trees").mkdir()
    assert run_btq("import", "trees", cwd=tmp_path)[0] == 2
    assert [each.name for each in tmp_path.iterdir()] == ["trees"]


def test_existing_files_are_not_overwritten(tmp_path: Path) -> None:
    (tmp_path / "run.btlog").write_bytes(btlog(MAIN_XML, RUN))
    (tmp_path / "run.xml").write_text("mine", encoding="utf-8")
    assert run_btq("import", "run.btlog", "--xml", cwd=tmp_path)[0] == 2
    assert (tmp_path / "run.xml").read_text(encoding="utf-8") == "mine"
    assert run_btq("import", "run.btlog", "--xml", "--force", cwd=tmp_path)[0] == 0


def test_the_tree_of_a_real_robot_is_its_xml(shared: Path, tmp_path: Path) -> None:
    robot = shared / "field/verdicts/robot"
    assert run_btq("import", str(robot / "f46.btlog"), "--xml", "-o", ".", cwd=tmp_path)[0] == 0
    made, written = (trees_of(each) for each in (tmp_path / "f46.xml", robot / "fetch.xml"))
    assert made == written
    code, out, _ = run_btq("verify", str(robot / "f46.btlog"), "--mission", "f46.xml", cwd=tmp_path)
    assert (code, "mission f46 (as built now, 75 of 75 nodes)" in out) == (0, True)


def trees_of(xml: Path) -> dict[str, str]:
    """The trees of a file, by ID, without descriptions, which no log has, and without values that are defaults."""
    root = ElementTree.parse(xml).getroot()
    for element in root.iter():
        defaults = (("then_skip", "true"), ("if_empty", "SUCCESS"), ("ms", "50"))
        attributes = sorted(each for each in element.attrib.items() if each not in defaults)
        element.attrib = {key: value for key, value in attributes if key != "_description"}
        element.text = element.tail = None
    return {tree.attrib["ID"]: ElementTree.tostring(tree, encoding="unicode") for tree in root.iter("BehaviorTree")}
