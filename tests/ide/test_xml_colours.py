"""What is coloured in XML: entries and scripts in attributes, as `type.modifier text`."""

from __future__ import annotations

import pytest
from feature_asserts import decoded

from btq_lang.btcpp.opening import file_of
from btq_lang.ide.xml_colours import colours_in_xml, encoded_in_xml
from btq_lang.util.text import Encoding, LineIndex, Span
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace

XML = """\
<root BTCPP_format="4">
  <BehaviorTree ID="Main">
    <Sequence name="{no}">
      <Pick from="{shelf}" name="🤖" to='{@hand}' text="plain {shelf}"/>
      <Script code="tries := 3; ok := tries &gt;= 2 &amp;&amp; name == '🤖'"/>
      <AlwaysSuccess _skipIf="!ok"/>
    </Sequence>
  </BehaviorTree>
</root>
"""
FOUND = [
    ("variable", "shelf"),
    ("variable", "hand"),
    ("variable.modification", "tries"),
    ("operator", ":="),
    ("number", "3"),
    ("variable.modification", "ok"),
    ("operator", ":="),
    ("variable", "tries"),
    ("operator", "&gt;="),
    ("number", "2"),
    ("operator", "&amp;&amp;"),
    ("variable", "name"),
    ("operator", "=="),
    ("string", "'🤖'"),
    ("operator", "!"),
    ("variable", "ok"),
]


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "code-points"])
def test_what_is_coloured(encoding: Encoding) -> None:
    workspace = Workspace({"main.xml": file_of("main.xml", XML)}, Project())
    lines = LineIndex(XML)
    assert shown(colours_in_xml(workspace, "main.xml", encoding).data, lines, encoding) == FOUND
    at = XML.index("<Pick")
    within = Span(at, XML.index("\n", at))
    assert shown(encoded_in_xml(workspace, "main.xml", within, encoding), lines, encoding) == FOUND[:2]


def shown(data: list[int], lines: LineIndex, encoding: Encoding) -> list[tuple[str, str]]:
    return [(named, lines.text[slice(*span)]) for span, named in decoded(data, lines, encoding)]


def test_xml_without_any() -> None:
    workspace = Workspace({"main.xml": file_of("main.xml", "<root/>")}, Project())
    assert colours_in_xml(workspace, "main.xml", "utf-16").data == []
