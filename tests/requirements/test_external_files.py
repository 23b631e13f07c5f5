"""Reading the requirements of other tools: what is understood, and what is refused."""

from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from btq_lang.requirements.external import read_external
from btq_lang.requirements.external.fields import ImportProblem
from btq_lang.workspace.external_requirements import ExternalRequirement

NEEDS = """\
{"current_version": "2", "project": "robot",
 "versions": {"1": {"needs": {"REQ_1": {"title": "Old"}}},
  "2": {"needs_amount": 2,
    "needs": {
      "REQ_1": {"id": "REQ_1", "type": "req", "title": "Keep the distance", "links": ["HAZ_1"],
                "content": "At least 0.4 m.", "status": "open", "external_url": "https://x.org/#REQ_1", "REQ_2": {}},
      "HAZ_1": {"title": "Collision", "description": "Collision", "status": null}
}}}}
"""


def read(name: str, text: str) -> list[ExternalRequirement]:
    return read_external(f"/r/{name}", text)


def outline(name: str, text: str) -> list[tuple[str, str, str, str, int]]:
    return [(each.id, each.title, each.text, each.status, each.line) for each in read(name, text)]


def problem(name: str, text: str) -> tuple[int, int, str]:
    with pytest.raises(ImportProblem) as caught:
        read(name, text)
    return caught.value.line, caught.value.column, caught.value.message


# ---- needs.json -----------------------------------------------------------------------------------------------------


def test_needs() -> None:
    assert read("needs.json", NEEDS) == [
        ExternalRequirement(
            *("REQ_1", "Keep the distance", "At least 0.4 m.", "open", "https://x.org/#REQ_1", "/r/needs.json", 5)
        ),
        ExternalRequirement("HAZ_1", "Collision", "", "", "", "/r/needs.json", 7),
    ]


def test_the_only_version_counts_whatever_its_name() -> None:
    assert outline("n.json", '{"current_version": "9", "versions": {"": {"needs": {"A": {"title": "T"}}}}}') == [
        ("A", "T", "", "", 1)
    ]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", (1, 1, "not JSON: expecting value")),
        ('{"a": 1,\n "b" 2}', (2, 6, "not JSON: expecting ':' delimiter")),
        ("[]", (1, 1, "not a needs.json: expected an object with `versions`")),
        ('{"versions": {}}', (1, 1, "`current_version` must name one of the `versions`")),
        ('{"versions": {"1": {}}}', (1, 1, "the version `1` has no object `needs`")),
        ('{"versions": {"1": {"needs": {\n"A": 3}}}}', (2, 1, "the need `A` must be an object")),
        ("[" * 100_000, (1, 1, "nested too deeply")),
        ('{"versions": ' + "9" * 5_000 + "}", (1, 1, "a number has too many digits")),
    ],
)
def test_what_is_no_needs_json(text: str, expected: tuple[int, int, str]) -> None:
    assert problem("needs.json", text) == expected


@given(st.dictionaries(st.text(max_size=4), st.dictionaries(st.sampled_from(("title", "x")), st.text(max_size=4))))
def test_each_need_has_its_line(needs: dict[str, dict[str, str]]) -> None:
    text = json.dumps({"x": needs, "versions": {"y": {}, "v": {"needs": needs}}, "current_version": "v"}, indent=1)
    lines = text.splitlines()
    for requirement in read("n.json", text):
        assert lines[requirement.line - 1].startswith(f"    {json.dumps(requirement.id)}: ")


# ---- CSV ------------------------------------------------------------------------------------------------------------


def test_a_table() -> None:
    text = 'ID,Name,Requirement,Status\nR1,Dist,"At least\n0.4 m",open\n,,,\n R2 ,"-x",,\n'
    assert outline("r.csv", text) == [("R1", "Dist", "At least\n0.4 m", "open", 2), ("R2", "-x", "", "", 5)]


@pytest.mark.parametrize(
    ("url", "kept"),
    [("https://x.org/a?b=1#c", "https://x.org/a?b=1#c"), ("javascript:alert(1)", ""), ("https://x.org/<b>", "")],
)
def test_only_addresses_in_the_web_are_links(url: str, kept: str) -> None:
    assert [each.url for each in read("r.csv", f"id,url\nA,{url}\n")] == [kept]


def test_spreadsheets_separate_otherwise() -> None:
    assert outline("r.csv", "id;text\r\nA;1,5 m\r\n") == [("A", "", "1,5 m", "", 2)]
    assert outline("r.csv", "id\ttext\nA\t1, 2\n") == [("A", "", "1, 2", "", 2)]


def test_rows_of_one_requirement_are_joined() -> None:
    text = "requirement,title,clause,verdict\nr,T,a,\nr,T,b,violated\nr,T,a,satisfied\ns,,'=1,\n"
    assert outline("r.csv", text) == [("r", "T", "a\nb", "violated", 2), ("s", "", "=1", "", 5)]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (
            *(
                "",
                (1, 1, "no column has ids; expected one that is named id, uid, reqif.foreignid, requirement id, "),
            ),
        ),
        (
            "a,b\n1,2\n",
            (1, 1, "no column has ids; expected one that is named id, uid, reqif.foreignid, requirement id, "),
        ),
        ('id,b\n1,2\n3,"4\n', (3, 1, "not CSV: unexpected end of data")),
        ("id\n" + "x" * 200_000, (2, 1, "not CSV: field larger than field limit (131072)")),
    ],
)
def test_what_is_no_table(text: str, expected: tuple[int, int, str]) -> None:
    line, column, message = problem("r.csv", text)
    assert (line, column, message[: len(expected[2])]) == expected


# ---- ReqIF ----------------------------------------------------------------------------------------------------------

NAMES = {"D1": "ReqIF.ForeignID", "D2": "ReqIF.Name", "D3": "ReqIF.Text", "D4": "Status"}


def reqif(*objects: str) -> str:
    definitions = "".join(
        f"<ATTRIBUTE-DEFINITION-{'XHTML' if key == 'D3' else 'ENUMERATION' if key == 'D4' else 'STRING'} "
        f'IDENTIFIER="{key}" LONG-NAME="{name}"><TYPE>{_TYPES[key]}</TYPE>'
        f"</ATTRIBUTE-DEFINITION-{'XHTML' if key == 'D3' else 'ENUMERATION' if key == 'D4' else 'STRING'}>"
        for key, name in NAMES.items()
    )
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        '<REQ-IF xmlns="http://www.omg.org/spec/ReqIF/20110401/reqif.xsd" xmlns:x="http://www.w3.org/1999/xhtml">\n'
        "<CORE-CONTENT><REQ-IF-CONTENT><DATATYPES>"
        '<DATATYPE-DEFINITION-STRING IDENTIFIER="T"/><DATATYPE-DEFINITION-XHTML IDENTIFIER="X"/>'
        '<DATATYPE-DEFINITION-ENUMERATION IDENTIFIER="E"><SPECIFIED-VALUES><ENUM-VALUE IDENTIFIER="E1" '
        'LONG-NAME="approved"><PROPERTIES><EMBEDDED-VALUE KEY="1" OTHER-CONTENT=""/></PROPERTIES></ENUM-VALUE>'
        "</SPECIFIED-VALUES></DATATYPE-DEFINITION-ENUMERATION></DATATYPES>"
        f'<SPEC-TYPES><SPEC-OBJECT-TYPE IDENTIFIER="O"><SPEC-ATTRIBUTES>{definitions}</SPEC-ATTRIBUTES>'
        "</SPEC-OBJECT-TYPE></SPEC-TYPES>\n<SPEC-OBJECTS>\n"
        + "\n".join(objects)
        + "\n</SPEC-OBJECTS></REQ-IF-CONTENT></CORE-CONTENT></REQ-IF>\n"
    )


_TYPES = {
    "D1": "<DATATYPE-DEFINITION-STRING-REF>T</DATATYPE-DEFINITION-STRING-REF>",
    "D2": "<DATATYPE-DEFINITION-STRING-REF>T</DATATYPE-DEFINITION-STRING-REF>",
    "D3": "<DATATYPE-DEFINITION-XHTML-REF>X</DATATYPE-DEFINITION-XHTML-REF>",
    "D4": "<DATATYPE-DEFINITION-ENUMERATION-REF>E</DATATYPE-DEFINITION-ENUMERATION-REF>",
}


def spec_object(identifier: str, *values: str) -> str:
    return (
        f'<SPEC-OBJECT IDENTIFIER="{identifier}"><TYPE><SPEC-OBJECT-TYPE-REF>O</SPEC-OBJECT-TYPE-REF></TYPE>'
        f"<VALUES>{''.join(values)}</VALUES></SPEC-OBJECT>"
    )


def string(key: str, value: str) -> str:
    reference = f"<ATTRIBUTE-DEFINITION-STRING-REF>{key}</ATTRIBUTE-DEFINITION-STRING-REF>"
    return f'<ATTRIBUTE-VALUE-STRING THE-VALUE="{value}"><DEFINITION>{reference}</DEFINITION></ATTRIBUTE-VALUE-STRING>'


XHTML = (
    "<ATTRIBUTE-VALUE-XHTML><DEFINITION><ATTRIBUTE-DEFINITION-XHTML-REF>D3</ATTRIBUTE-DEFINITION-XHTML-REF></DEFINITION>"
    "<THE-VALUE><x:div><x:p>At <x:b>least</x:b>\n 0.4 m &amp; more.</x:p><x:p>Always.</x:p></x:div></THE-VALUE>"
    "</ATTRIBUTE-VALUE-XHTML>"
)
CHOICE = (
    "<ATTRIBUTE-VALUE-ENUMERATION><VALUES><ENUM-VALUE-REF>E1</ENUM-VALUE-REF></VALUES><DEFINITION>"
    "<ATTRIBUTE-DEFINITION-ENUMERATION-REF>D4</ATTRIBUTE-DEFINITION-ENUMERATION-REF></DEFINITION>"
    "</ATTRIBUTE-VALUE-ENUMERATION>"
)


def test_objects_with_ids_of_people() -> None:
    pytest.importorskip("reqif")
    text = reqif(
        spec_object("_1", string("D1", "R-1"), string("D2", "Distance"), XHTML, CHOICE),
        spec_object("_2", string("D2", "A heading")),
        spec_object("_3", string("D1", "R-3")),
    )
    assert outline("r.reqif", text) == [
        ("R-1", "Distance", "At least 0.4 m & more.\nAlways.", "approved", 5),
        ("R-3", "", "", "", 8),
    ]


def test_without_any_identifiers_count() -> None:
    pytest.importorskip("reqif")
    named = spec_object("_2").replace("<SPEC-OBJECT ", '<SPEC-OBJECT LONG-NAME="Named" ')
    assert outline("r.reqif", reqif(spec_object("_1", string("D2", "T")), named)) == [
        ("_1", "T", "", "", 5),
        ("_2", "Named", "", "", 6),
    ]


BOMB = '<!DOCTYPE a [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;">]>\n<a>&b;</a>'


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("<a>\n<b></a>", (2, 6, "not XML: mismatched tag")),
        (BOMB, (1, 1, "a document type, which may declare entities, is not read")),
        (
            '<!DOCTYPE a SYSTEM "http://x.org/a.dtd">\n<a/>',
            (1, 1, "a document type, which may declare entities, is not read"),
        ),
        ("<a>" * 101 + "</a>" * 101, (1, 1, "more than 100 nested elements")),
        ("<a/>", (1, 1, "not ReqIF that the package reqif reads: Expected root tag to be REQ-IF, got: a.")),
    ],
)
def test_what_is_no_reqif(text: str, expected: tuple[int, int, str]) -> None:
    pytest.importorskip("reqif")
    assert problem("r.reqif", text) == expected


def test_without_the_package_it_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "reqif.parser", None)
    why = "needs the package reqif to be read: pip install 'btq-lang[reqif]'"
    assert problem("r.reqif", "<REQ-IF/>") == (1, 1, why)


@given(st.sampled_from(("n.json", "t.csv", "r.reqif")), st.data())
def test_no_text_of_a_stranger_ends_otherwise(name: str, data: st.DataObject) -> None:
    pytest.importorskip("reqif")
    whole = {"n.json": NEEDS, "t.csv": 'id,text\nA,"b\nc"\n', "r.reqif": reqif(spec_object("_1", XHTML, CHOICE))}[name]
    start, end = sorted(data.draw(st.tuples(*[st.integers(0, len(whole))] * 2)))
    text = whole[:start] + data.draw(st.text(max_size=3)) + whole[end:]
    lines = text.count("\n") + text.count("\r") + 1
    try:
        places = [requirement.line for requirement in read(name, text)]
    except ImportProblem as error:
        places = [error.line]
    assert all(1 <= line <= lines for line in places)
