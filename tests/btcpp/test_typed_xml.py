"""The tag at a place of XML that is being typed: `$0` is the place."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from btq_lang.btcpp.opening import file_of
from btq_lang.btcpp.typed_xml import typed_tag, without

ROOT = '<root BTCPP_format="4"><BehaviorTree ID="T">'


def read(text: str) -> tuple[str, str, str, str, tuple[str, ...]] | None:
    """What is typed at the place, the word there, the tag, the attribute of a value, and the open elements."""
    offset = text.index("$0")
    xml = text.replace("$0", "")
    tag = typed_tag(xml, offset)
    if tag is None:
        return None
    assert tag.span.start <= tag.word.start <= offset <= max(tag.word.end, offset)
    return tag.part, xml[tag.word.start : tag.word.end], tag.name, tag.key, tag.parents


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("<$0", ("tag", "", "", "", ())),
        ("<ro$0ot>", ("tag", "root", "root", "", ())),
        ("<root><$0\n</root>", ("tag", "", "", "", ("root",))),
        ("<root><A/><B><C></C><D $0", ("attribute", "", "D", "", ("root", "B"))),
        ('<root><A x="1" y$0="2"/>', ("attribute", "y", "A", "", ("root",))),
        ('<root><A x="1$02"/>', ("value", "12", "A", "x", ("root",))),
        ('<root><A x="1"$0/>', None),
        ('<root><A x="1" $0/>', ("attribute", "", "A", "", ("root",))),
        ("<root><A x=$0", None),
        ("<root><A x= $0", None),
        ('<root><A x="a$0\n  <B y="1"/>', ("value", "a", "A", "x", ("root",))),
        ('<root><A x="a$0/></root>', ("value", "a", "A", "x", ("root",))),
        ("<root><A x='say \"$0no\"'/>", ("value", 'say "no"', "A", "x", ("root",))),
        ('<A x="a < $0b &amp; c"/>', ("value", "a < b &amp; c", "A", "x", ())),
        ("<root><A></$0", ("end", "", "", "", ("root", "A"))),
        ("<root><A></A$0>", ("end", "A", "A", "", ("root", "A"))),
        ("<root><A></A x$0>", None),
        ("<root><A /$0>", None),
        ("<root>te$0xt", None),
        ("<root>$0", None),
        ("$0<root>", None),
        ("<!-- <A $0 -->", None),
        ("<!-- <A $0", None),
        ("<![CDATA[ <A $0", None),
        ('<?xml $0version="1.0"?>', None),
        ("<root><A><B></A><$0", ("tag", "", "", "", ("root",))),
        ("<root></A><$0", ("tag", "", "", "", ("root",))),
    ],
)
def test_what_is_typed(text: str, found: tuple[str, str, str, str, tuple[str, ...]] | None) -> None:
    assert read(text) == found


@pytest.mark.parametrize(
    ("text", "number"),
    [
        (f"{ROOT}<Seq$0</BehaviorTree></root>", 0),
        (f"{ROOT}<Seq$0><B/></BehaviorTree></root>", 1),
        (f"{ROOT}<Seq$0></Seq></BehaviorTree></root>", 2),
        (f'{ROOT}<A x="1" y="$0/></BehaviorTree></root>', 0),
        (f'{ROOT}<A y="$0"><B/></A></BehaviorTree></root>', 0),
        (f'{ROOT}<A y="$0"><B/></BehaviorTree></root>', 1),
        (f"{ROOT}<A><B/><C $0", 2),
    ],
)
def test_the_text_without_it_is_sound(text: str, number: int) -> None:
    """The first of the ways that is."""
    xml = text.replace("$0", "")
    tag = typed_tag(xml, text.index("$0"))
    assert tag is not None
    files = [file_of("t.xml", each) for each in without(xml, tag)]
    assert next(index for index, file in enumerate(files) if file.is_foreign and file.is_understood) == number


PIECES = st.sampled_from(
    ("<", ">", "/", "=", '"', "'", " ", "\n", "A", "x", "<!--", "-->", "&", "<![CDATA[", "]]>", "🤖")
)


@given(st.lists(PIECES, max_size=30).map("".join), st.data())
def test_every_string_has_a_reading(text: str, data: st.DataObject) -> None:
    offset = data.draw(st.integers(0, len(text)))
    tag = typed_tag(text, offset)
    if tag is not None:
        assert tag.span.start < tag.word.start <= offset <= tag.word.end <= len(text)
        assert len(list(without(text, tag))) == 3
