"""A word of the published language that a mission declares as a node of its own means that node."""

from __future__ import annotations

import pytest

from btq_lang.btcpp.document import write
from btq_lang.btcpp.export import export
from btq_lang.btcpp.importing import import_xml
from btq_lang.btcpp.outputs import bundle
from btq_lang.btcpp.restoring import restored
from btq_lang.btcpp.side_file import BuiltFile, side_file
from btq_lang.checks import check
from btq_lang.workspace.workspace import Workspace

MODEL = "Action Test\n    input level : int\n"
TREE = 'BehaviorTree Main\n    ->\n        Test (level = "1")\n        Action Test (level = "2")\n'


def xml_of(files: dict[str, str], path: str = "main.btq") -> str:
    return write(export(Workspace.of(files), path).document)


def test_without_a_model_it_is_the_word_of_the_published_language() -> None:
    xml = xml_of({"main.btq": TREE})
    assert '<TestNode level="1"/>' in xml
    assert '<Action ID="TestNode" level="2"/>' in xml
    assert '<Action ID="TestNode">' in xml


@pytest.mark.parametrize("category", ["Action", "Condition"])
def test_a_declared_node_wins(category: str) -> None:
    text = MODEL.replace("Action", category) + TREE.replace("Action", category)
    assert check(Workspace.of({"main.btq": text}), "main.btq") == ()
    xml = xml_of({"main.btq": text})
    assert '<Test level="1"/>' in xml
    assert f'<{category} ID="Test" level="2"/>' in xml
    assert xml.count(f'<{category} ID="Test">') == 1
    assert "TestNode" not in xml


@pytest.mark.parametrize("declaring", ["models.btq", "main.btq"])
def test_wherever_the_mission_declares_it(declaring: str) -> None:
    files = {
        "main.btq": 'include "models.btq"\ninclude "part.btq"\nRoot Main\n' + TREE,
        "part.btq": 'BehaviorTree Part\n    Test (level = "3")\n',
        "models.btq": "Action Other\n",
    }
    files[declaring] += MODEL
    assert all("TestNode" not in xml_of(files, path) for path in files)
    assert "TestNode" not in write(bundle(Workspace.of(files), "main.btq").document)


def test_an_edited_build_gives_back_what_is_said_of_it() -> None:
    text = MODEL + TREE.replace("Action Test", "Action Test Second") + "            satisfies quick\n"
    text += 'QualityReq quick : time-behaviour "Soon"\n    takes at most 1 s\n'
    workspace = Workspace.of({"main.btq": text})
    done = export(workspace, "main.btq")
    xml = write(done.document)
    side = side_file(workspace, BuiltFile("main.btq", "main.xml", xml, (done.document,), done.elements))
    assert side is not None
    edited = xml.replace('level="2"', 'level="3"')
    found = restored(edited, import_xml(edited).text, side)
    assert found is not None
    assert found.lost == ()
    assert "satisfies quick" in found.text
