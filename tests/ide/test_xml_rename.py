"""Renaming in XML and in missions at once: what is renamed in each file, or why nothing is."""

from __future__ import annotations

import random
from collections import Counter
from pathlib import Path

import pytest
from seeds import SEED, share_of

from btq_lang.btcpp.opening import file_of, with_source
from btq_lang.checks import check
from btq_lang.ide.navigation import find_references
from btq_lang.ide.rename import RenameRefusal, prepare_rename, rename
from btq_lang.util.text import apply_edits
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace

XML = """\
<root BTCPP_format="4" main_tree_to_execute="Main">
  <BehaviorTree ID="Main">
    <Sequence name="all &amp; more">
      <SubTree ID="Dock" station="{shelf}"/>
      <Pick from="{shelf}" note="a &lt; b"><!-- <Pick> --></Pick>
      <Action ID="Pick" from="{@hand}"/>
      <Script code="tries := 1; shelf := 'x'; ok := tries &lt; 3 &amp;&amp; tries &gt; 0"/>
    </Sequence>
  </BehaviorTree>
  <BehaviorTree ID="Dock"><Fallback><Pick from='{station}'/></Fallback></BehaviorTree>
  <TreeNodesModel>
    <Action ID="Pick"><input_port name="from">from where</input_port></Action>
    <SubTree ID="Dock"><input_port name="station"/></SubTree>
  </TreeNodesModel>
</root>
"""
MISSION = """\
include "trees.xml"

BehaviorTree Start
    ->
        SubTree Dock (station = {x})
        Pick (from = {=})
"""


def workspace_of(**texts: str) -> Workspace:
    files = {name.replace("_", "."): text for name, text in texts.items()}
    return Workspace({path: file_of(path, text) for path, text in files.items()}, Project())


def renamed(workspace: Workspace, word: str, name: str) -> dict[str, str] | str:
    """The texts after a rename of the word in `trees.xml` that is marked with `|`, or why there is none."""
    source = workspace.files["trees.xml"].source
    offset = source.index(word.replace("|", "")) + word.index("|")
    at = workspace.files["trees.xml"].from_disk(offset)
    assert at is not None
    done = rename(workspace, "trees.xml", at, name)
    if isinstance(done, RenameRefusal):
        return done.reason
    for edits in done.edits.values():
        assert list(edits) == sorted(edits, key=lambda edit: edit.span)
    return {path: apply_edits(workspace.files[path].source, edits) for path, edits in done.edits.items()}


@pytest.mark.parametrize(
    ("word", "name", "xml", "mission"),
    [
        ('ID="D|ock"', "Park", XML.replace("Dock", "Park"), MISSION.replace("Dock", "Park")),
        ('ID="D|ock"', "Park+1", XML.replace("Dock", "Park+1"), MISSION.replace("Dock", '"Park+1"')),
        (
            "<P|ick",
            "Grab",
            XML.replace("Pick", "Grab").replace("<!-- <Grab>", "<!-- <Pick>"),
            MISSION.replace("Pick", "Grab"),
        ),
        (
            'name="fr|om"',
            "source",
            XML.replace(" from=", " source=").replace('"from"', '"source"'),
            MISSION.replace("from = {=}", "source = {from}"),
        ),
        (
            "station='|'".replace("='|'", "|"),
            "place",
            XML.replace("station", "place"),
            MISSION.replace("station", "place"),
        ),
        ("{she|lf}", "rack", XML.replace("shelf", "rack"), None),
        ("tri|es", "count", XML.replace("tries", "count"), None),
        ("{@ha|nd}", "arm", XML.replace("hand", "arm"), None),
        ("all &amp; mo|re", "one & <two>", XML.replace("all &amp; more", "one &amp; &lt;two&gt;"), None),
        ('ID="Ma|in"', "First", XML.replace("Main", "First"), None),
    ],
)
def test_what_is_renamed(word: str, name: str, xml: str, mission: str | None) -> None:
    workspace = workspace_of(trees_xml=XML, main_btq=MISSION)
    texts = renamed(workspace, word, name)
    assert texts == {"trees.xml": xml, **({"main.btq": mission} if mission else {})}
    before = [each.rule for path in workspace.files for each in check(workspace, path)]
    for path, text in texts.items():
        workspace = with_source(workspace, path, text)
    assert [each.rule for path in workspace.files for each in check(workspace, path)] == before


def test_a_name_is_renamed_in_xml_from_a_mission() -> None:
    workspace = workspace_of(trees_xml=XML, main_btq=MISSION)
    done = rename(workspace, "main.btq", MISSION.index("Dock"), "Park")
    assert not isinstance(done, RenameRefusal)
    assert apply_edits(XML, done.edits["trees.xml"]) == XML.replace("Dock", "Park")


@pytest.mark.parametrize(
    ("word", "name", "reason"),
    [
        ("<Seq|uence", "Dock", "cannot rename `Sequence`: the engine defines it"),
        ('ID="D|ock"', "Main", "`Main` is already in use: trees.xml, line 1"),
        ('ID="D|ock"', "Sequence", "`Sequence` is a built-in node"),
        ("<P|ick", "1Pick", "`1Pick` cannot be written in trees.xml, which cannot be read then"),
        ("{she|lf}", "far away", "the name of an entry must not contain braces, quotes, spaces, `@` or `=`"),
        ("{she|lf}", "ok", "`ok` is already in use: trees.xml, line 7"),
    ],
)
def test_why_nothing_is_renamed(word: str, name: str, reason: str) -> None:
    assert renamed(workspace_of(trees_xml=XML, main_btq=MISSION), word, name) == reason


@pytest.mark.parametrize(
    ("other", "reason"),
    [
        ("<!-- Generated by btq from a.btq; edit that file. -->\n", "which a build wrote"),
        ("<root><BehaviorTree", "which cannot be read"),
    ],
)
def test_xml_that_is_not_edited(other: str, reason: str) -> None:
    """As it is all or nothing, a name in such a file keeps its name everywhere."""
    other += '<root><BehaviorTree ID="Other"><SubTree ID="Dock"/></BehaviorTree></root>'
    text = XML.replace("<BehaviorTree", '<include path="other.xml"/><BehaviorTree', 1)
    workspace = workspace_of(trees_xml=text, other_xml=other)
    found = renamed(workspace, 'ID="D|ock"', "Park")
    assert found == f"cannot rename `Dock`: other.xml, {reason}, may also use it"
    assert isinstance(
        prepare_rename(workspace, "trees.xml", workspace.files["trees.xml"].text.index("Dock")), RenameRefusal
    )


def test_names_of_published_files(shared: Path) -> None:
    """After a rename in real trees each word that meant the thing means it, nothing new is found, and renaming
    back restores the file."""
    chance = random.Random(SEED)
    done = 0
    for path in share_of(chance.sample(sorted((shared / "corpus").rglob("*.xml")), 40), 2):
        file = file_of("trees.xml", path.read_bytes().decode(errors="replace").removeprefix("\ufeff"))
        if not (file.is_foreign and file.is_understood):
            continue
        workspace = Workspace({"trees.xml": file}, Project())
        mentions = [(entry, each) for entry in file.parsed.entries for each in file.mentions_of(entry)]
        for entry, mention in chance.sample(mentions, min(len(mentions), 4)):
            at = mention.span.start + entry.start
            result = rename(workspace, "trees.xml", at, "another_1")
            if isinstance(result, RenameRefusal):
                continue
            done += 1
            after = with_source(workspace, "trees.xml", apply_edits(file.source, result.edits["trees.xml"]))
            before, now = (Counter(one.rule for one in check(each, "trees.xml")) for each in (workspace, after))
            assert now <= before, (path, mention)
            start = after.files["trees.xml"].text.index("another_1")
            assert len(find_references(after, "trees.xml", start)) == len(find_references(workspace, "trees.xml", at))
            back = rename(after, "trees.xml", start, mention.name)
            if isinstance(back, RenameRefusal):
                assert back.reason.startswith(("the engine refuses", "the name of an entry must")), (path, mention)
                continue
            assert apply_edits(after.files["trees.xml"].source, back.edits["trees.xml"]) == file.source, (path, mention)
    assert done > 15
