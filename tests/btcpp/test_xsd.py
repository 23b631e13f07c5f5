"""The XSD of a project's nodes: what it accepts and refuses, by a validator of other people."""

from __future__ import annotations

from pathlib import Path

import pytest
from lxml import etree

from btq_lang.btcpp.opening import file_of
from btq_lang.btcpp.xsd import xsd
from btq_lang.catalog.nodes import BUILTINS
from btq_lang.catalog.versions import VERSIONS
from btq_lang.projects.building import build
from btq_lang.projects.opening import open_workspace
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace

EXAMPLES = Path(__file__).parents[2] / "examples"
SKILLS = """\
Action MoveBase "Drive the base"
    input station : string "where to"
    input careful : bool = false
    output arrived : bool
Condition Ready
    input level : double
Decorator Guarded
    input limit : int
Control Both
Action "Move Base"
Action Charge
"""
PALETTE = """\
<root BTCPP_format="4"><TreeNodesModel>
  <Action ID="Lift"><input_port default="1" name="height" type="double"/></Action>
  <Action ID="MoveBase"><input_port name="speed"/></Action>
  <Condition ID="Charge"/>
</TreeNodesModel></root>
"""
PALETTE_OF_ALL = """\
<Action ID="A" editable="true">
  <description>d</description><inout_port name="p">text</inout_port><MetadataFields><Metadata a="b"/></MetadataFields>
</Action>
<SubTree ID="T"/>
"""
WORKSPACE = Workspace(
    {"skills.btq": file_of("skills.btq", SKILLS), "palette.xml": file_of("palette.xml", PALETTE)}, Project()
)


def validator(*workspaces: Workspace, version: str = "4.10", unknown: frozenset[str] = frozenset()) -> etree.XMLSchema:
    return etree.XMLSchema(etree.fromstring(xsd(workspaces, version, unknown).encode()))


SCHEMA = validator(WORKSPACE)


def problem(text: str, schema: etree.XMLSchema = SCHEMA) -> str | None:
    """The first sentence about the first problem."""
    if schema.validate(etree.fromstring(text)):
        return None
    return f"{schema.error_log[0].message.partition('. ')[0].partition('.  ')[0].rstrip('.')}."


def tree(inside: str) -> str:
    return f'<root BTCPP_format="4"><BehaviorTree ID="Main">{inside}</BehaviorTree></root>'


@pytest.mark.parametrize(
    "text",
    [
        tree('<MoveBase station="a" careful="true" arrived="{there}" speed="1" name="x" _skipIf="a == 1"/>'),
        tree('<MoveBase careful="{ careful }"/>'),
        tree('<MoveBase careful="{=}" arrived="whatever"/>'),
        tree('<Action ID="MoveBase" station="a" _while="b"/>'),
        tree('<Action ID="Move Base"/>'),
        tree('<Action ID="Charge"/>'),
        tree('<Condition ID="Charge"/>'),
        tree('<Charge any="1"/>'),
        tree('<Both><Ready level="1"/><!-- a comment --><Guarded limit="3"><Lift height="2"/></Guarded></Both>'),
        tree('<Control ID="Both"><AlwaysSuccess/></Control>'),
        tree('<Decorator ID="Guarded" limit="1"><AlwaysSuccess/></Decorator>'),
        tree('<SubTree ID="Elsewhere" any="{port}" _autoremap="true"/>'),
        tree('<Timeout msec="{limit}"><Script code="a := 1"/></Timeout>'),
        tree('<Precondition if="a" else="SKIPPED"><AlwaysFailure/></Precondition>'),
        tree("<IfThenElse><AlwaysSuccess/><AlwaysSuccess/></IfThenElse>"),
        '<root BTCPP_format="4" main_tree_to_execute="M"><include path="a.xml"/><include ros_pkg="p" path="b"/></root>',
        '<root xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="btq.xsd"/>',
        f"<root><TreeNodesModel>{PALETTE_OF_ALL}</TreeNodesModel></root>",
        '<root><BehaviorTree ID="T" _description="d" port="default"><AlwaysSuccess/></BehaviorTree></root>',
    ],
)
def test_what_is_right_is_valid(text: str) -> None:
    assert problem(text) is None


@pytest.mark.parametrize(
    ("inside", "expected"),
    [
        ("<MoveBsae/>", "Element 'MoveBsae': This element is not expected."),
        ("<Sequnce><Charge/></Sequnce>", "Element 'Sequnce': This element is not expected."),
        ('<Action ID="MoveBsae"/>', "Element 'Action', attribute 'ID': [facet 'enumeration'] The value 'MoveBsae' is"),
        ('<Condition ID="MoveBase"/>', "Element 'Condition', attribute 'ID': [facet 'enumeration'] The value 'MoveBa"),
        ('<Action station="a"/>', "Element 'Action': The attribute 'ID' is required but missing."),
        ('<SubTree any="1"/>', "Element 'SubTree': The attribute 'ID' is required but missing."),
        ('<MoveBase statoin="a"/>', "Element 'MoveBase', attribute 'statoin': The attribute 'statoin' is not allowed."),
        ('<MoveBase ID="a"/>', "Element 'MoveBase', attribute 'ID': The attribute 'ID' is not allowed."),
        ('<MoveBase _skipif="a"/>', "Element 'MoveBase', attribute '_skipif': The attribute '_skipif' is not allowed."),
        ("<Timeout><Ready/></Timeout>", "Element 'Timeout': The attribute 'msec' is required but missing."),
        ('<Timeout msec="5" sec="1"><Ready/></Timeout>', "Element 'Timeout', attribute 'sec': The attribute 'sec' is"),
        ('<MoveBase careful="yes"/>', "Element 'MoveBase', attribute 'careful': 'yes' is not a valid value"),
        ('<MoveBase careful="{}"/>', "Element 'MoveBase', attribute 'careful': '{}' is not a valid value"),
        (
            '<Precondition if="a" else="IDLE"><Ready/></Precondition>',
            "Element 'Precondition', attribute 'else': 'IDLE' is not a valid value",
        ),
        ('<SubTree ID="T" _autoremap="{a}"/>', "Element 'SubTree', attribute '_autoremap': [facet 'enumeration'] The"),
        ("<Ready><Charge/></Ready>", "Element 'Ready': Element content is not allowed, because the content type is em"),
        ('<Timeout msec="5"/>', "Element 'Timeout': Missing child element(s)."),
        ("<Guarded/>", "Element 'Guarded': Missing child element(s)."),
        ("<Guarded><Ready/><Ready/></Guarded>", "Element 'Ready': This element is not expected."),
        ("<Both/>", "Element 'Both': Missing child element(s)."),
        ("<IfThenElse><Ready/></IfThenElse>", "Element 'IfThenElse': Missing child element(s)."),
        (f"<IfThenElse>{'<Ready/>' * 4}</IfThenElse>", "Element 'Ready': This element is not expected."),
        (f"<Switch2>{'<Ready/>' * 2}</Switch2>", "Element 'Switch2': Missing child element(s)."),
        ("", "Element 'BehaviorTree': Missing child element(s)."),
        ("<Ready/><Ready/>", "Element 'Ready': This element is not expected."),
    ],
)
def test_what_is_wrong_is_refused(inside: str, expected: str) -> None:
    found = problem(tree(inside))
    assert found is not None
    assert found[: len(expected)] == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (
            "<Sequence><AlwaysSuccess/></Sequence>",
            "Element 'Sequence': No matching global declaration available for th",
        ),
        ('<root main_tree="a"/>', "Element 'root', attribute 'main_tree': The attribute 'main_tree' is not allowed."),
        ("<root><Ready/></root>", "Element 'Ready': This element is not expected."),
        ("<root><TreeNodesModel><Lift/></TreeNodesModel></root>", "Element 'Lift': This element is not expected."),
        ("<root><TreeNodesModel><Action/></TreeNodesModel></root>", "Element 'Action': The attribute 'ID' is required"),
        (
            '<root><TreeNodesModel><Action ID="A"><input_port/></Action></TreeNodesModel></root>',
            "Element 'input_port': The attribute 'name' is required but missing.",
        ),
    ],
)
def test_what_is_wrong_around_trees_is_refused(text: str, expected: str) -> None:
    found = problem(text)
    assert found is not None
    assert found[: len(expected)] == expected


def test_nodes_of_the_version() -> None:
    attempt = tree("<TryCatch><AlwaysSuccess/><AlwaysSuccess/></TryCatch>")
    found = {version: problem(attempt, validator(WORKSPACE, version=version)) for version in VERSIONS}
    refused = "Element 'TryCatch': This element is not expected."
    assert found == {"4.6": refused, "4.8": refused, "4.10": None}


def test_every_node_of_the_engine_is_there() -> None:
    for kind in BUILTINS.values():
        ports = "".join(f' {port.name}="{{a}}"' for port in kind.ports if port.name[0] != "_")
        id_ = ' ID="T"' if kind.category == "SubTree" else ""
        assert problem(tree(f"<{kind.tag}{id_}{ports}>{'<Ready/>' * kind.children[0]}</{kind.tag}>")) is None, kind.tag


def test_nodes_without_a_model_take_what_they_like_unless_the_checks_call_them_unknown() -> None:
    used = tree('<Sequence><Dock speed="1"/><Wait><Ready/></Wait><Action ID="Un dock"/></Sequence>')
    workspace = Workspace({"main.xml": file_of("main.xml", used)}, Project())
    assert problem(used.replace("speed", "depth"), validator(workspace)) is None
    assert problem(used, validator(workspace, unknown=frozenset(("Dock",)))) == (
        "Element 'Dock': This element is not expected."
    )
    declared = Workspace(
        {"main.xml": file_of("main.xml", used), "dock.btq": file_of("dock.btq", "Action Dock")}, Project()
    )
    assert problem(used, validator(declared, unknown=frozenset(("Dock",)))) is None


def test_names_and_texts_that_xml_cannot_have() -> None:
    text = (
        'Action "3rd" "a\x01b"\nAction "a\x02"\nBehaviorTree "b\x03"\n    Action "3rd" ("a:b" = 1)\n    "x y" (c = 1)\n'
    )
    workspace = Workspace({"main.btq": file_of("main.btq", text)}, Project())
    schema = validator(workspace)
    assert problem(tree('<Action ID="3rd" b="1"/>'), schema) is None
    assert "&lt;3rd" not in xsd([workspace], "4.10", ())
    assert 'name="3rd"' not in xsd([workspace], "4.10", ())


def test_the_text_of_a_node() -> None:
    text = xsd([WORKSPACE], "4.10", ())
    begin = text.index('      <xs:element name="MoveBase">')
    assert (
        text[begin : text.index("      </xs:element>\n", begin)]
        == """\
      <xs:element name="MoveBase">
        <xs:annotation>
          <xs:documentation>Drive the base</xs:documentation>
        </xs:annotation>
        <xs:complexType>
          <xs:attribute name="speed" type="xs:string"/>
          <xs:attribute name="station" type="xs:string">
            <xs:annotation>
              <xs:documentation>where to</xs:documentation>
            </xs:annotation>
          </xs:attribute>
          <xs:attribute name="careful">
            <xs:simpleType>
              <xs:union>
                <xs:simpleType>
                  <xs:restriction base="xs:string">
                    <xs:enumeration value="true"/>
                    <xs:enumeration value="false"/>
                    <xs:enumeration value="1"/>
                    <xs:enumeration value="0"/>
                    <xs:enumeration value="True"/>
                    <xs:enumeration value="TRUE"/>
                    <xs:enumeration value="False"/>
                    <xs:enumeration value="FALSE"/>
                  </xs:restriction>
                </xs:simpleType>
                <xs:simpleType>
                  <xs:restriction base="xs:string">
                    <xs:pattern value="\\{[\\s\\S]+\\}"/>
                  </xs:restriction>
                </xs:simpleType>
              </xs:union>
            </xs:simpleType>
          </xs:attribute>
          <xs:attribute name="arrived" type="xs:string"/>
          <xs:attributeGroup ref="node"/>
        </xs:complexType>
"""
    )


def test_the_same_files_give_the_same_text() -> None:
    other = Workspace(dict(reversed([*WORKSPACE.files.items()])), Project())
    assert xsd([other], "4.10", ()) == xsd([WORKSPACE], "4.10", ())


@pytest.mark.parametrize("example", sorted(path.name for path in EXAMPLES.iterdir()))
def test_what_a_build_writes_is_valid(example: str) -> None:
    workspace = open_workspace(str(EXAMPLES / example))
    schema = validator(workspace)
    written = {
        name: text
        for path in workspace.files
        for name, text in build(workspace, path).files.items()
        if name.endswith(".xml")
    }
    assert written
    assert {name: problem(text.partition("?>")[2], schema) for name, text in written.items()} == dict.fromkeys(written)
