"""The reader of XML: what the engine reads is read, in a time and a space that grow with the file and no faster."""

from __future__ import annotations

import time
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree
from xml_elements import elements

from btq_lang.btcpp.document import Attribute, Comment, Document, Element, Text, escape, write
from btq_lang.btcpp.reader import MAX_DEPTH, Read, read
from btq_lang.util.text import LineIndex, Span

STRICT = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False, huge_tree=False, encoding="utf-8")


def strict_elements(data: bytes) -> list[object]:
    """The same by lxml."""
    found: list[object] = []
    root = etree.fromstring(data, STRICT)
    around = [*root.itersiblings(preceding=True)][::-1], [*root.itersiblings()]
    found += [comment.text for comment in around[0] if comment.tag is etree.Comment]
    stack: list[tuple[str, object]] = [("node", root)]
    while stack:
        kind, node = stack.pop()
        if kind == "text":
            found.append(("text", node))
            continue
        if node.tag is etree.Comment:
            found.append(node.text)
            inner: list[tuple[str, object]] = []
        else:
            found.append((node.tag, list(node.items())))
            inner = [("text", node.text)] if node.text and node.text.strip() else []
            inner += [("node", child) for child in node]
        behind = [("text", node.tail)] if node.tail and node.tail.strip() else []
        stack += reversed(inner + behind)
    return found + [comment.text for comment in around[1] if comment.tag is etree.Comment]


def problems(done: Read, text: str) -> list[str]:
    lines = LineIndex(text)
    return [
        f"{lines.position(each.span.start).line + 1}:{lines.position(each.span.start).column + 1} "
        f"{each.effective_severity.value} {each.rule}: {each.message}"
        for each in done.problems
    ]


def test_every_file_of_the_corpus_as_lxml_reads_it(shared: Path) -> None:
    count = 0
    for path in sorted((shared / "corpus" / "dev").iterdir()):
        data = path.read_bytes()
        done = read(data.decode())
        assert done.problems == ()
        assert done.document is not None
        assert elements(done.document) == strict_elements(data), path.name
        count += 1
    assert count > 400


def test_what_the_engine_reads_and_others_refuse_is_told_with_the_line(shared: Path) -> None:
    for path in sorted((shared / "corpus" / "malformed" / "engine-accepts").iterdir()):
        text = path.read_bytes().decode()
        done = read(text)
        assert done.document is not None, path.name
        assert [each.rule for each in done.problems] == ["xml-not-well-formed"]
        with pytest.raises(etree.XMLSyntaxError) as refused:
            etree.fromstring(text.encode(), STRICT)
        assert LineIndex(text).position(done.problems[0].span.start).line + 1 == refused.value.lineno


def test_what_the_engine_refuses_is_an_error(shared: Path) -> None:
    for path in sorted((shared / "corpus" / "malformed" / "engine-rejects").iterdir()):
        done = read(path.read_text(encoding="utf-8"))
        assert done.document is None
        assert [each.rule for each in done.problems] == ["xml-syntax"]


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("", "1:1 error xml-syntax: this file is empty"),
        ("  \n", "1:1 error xml-syntax: this file is empty"),
        ("<!-- x -->", "1:1 error xml-syntax: this file contains no element"),
        ("nothing", "1:1 error xml-syntax: this file contains no element"),
        ('<a x="\0"/>', "1:7 error xml-syntax: unexpected NUL character: the engine stops reading here"),
        ("<a", "1:1 error xml-syntax: missing > for <a"),
        ("<a>", "1:1 error xml-syntax: <a> is never closed"),
        ("<a><b></a>", "1:7 error xml-syntax: expected </b>, found </a>"),
        ("<a>\n</b>", "2:1 error xml-syntax: expected </a>, found </b>"),
        ("<a>x < y</a>", "1:6 error xml-syntax: unexpected `<`: no tag begins here"),
        ("<a>1 < 2</a>", "1:6 error xml-syntax: unexpected `<`: no tag begins here"),
        ("<a b/>", "1:4 error xml-syntax: missing value in quotes for the attribute `b`"),
        ("<a b=c/>", "1:4 error xml-syntax: missing value in quotes for the attribute `b`"),
        ('<a b="1/>', '1:6 error xml-syntax: missing closing " for the value of `b`'),
        ('<a b="1" 2="x"/>', "1:10 error xml-syntax: expected an attribute or the end of <a>, found `2`"),
        ('<a b="1" c="2" b="3"/>', "1:16 error xml-syntax: duplicate attribute `b` in <a>"),
        ("<a><!-- x</a>", "1:4 error xml-syntax: missing --> for this comment"),
        ("<a><![CDATA[ x</a>", "1:4 error xml-syntax: missing ]]> for this CDATA section"),
        ("<!DOCTYPE a", "1:1 error xml-syntax: missing > for this declaration"),
        ("<?xml", "1:1 error xml-syntax: missing ?> for this declaration"),
        ("<a><?b ?></a>", "1:4 error xml-syntax: a processing instruction after other content"),
        ("<!-- x --><?xml version='1.0'?><a/>", "1:11 error xml-syntax: an XML declaration after other content"),
        ("<a/>text", "1:5 error xml-syntax: unexpected text after the document element"),
    ],
)
def test_what_no_reader_can_make_sense_of(text: str, problem: str) -> None:
    done = read(text)
    assert (done.document, problems(done, text)) == (None, [problem])


@pytest.mark.parametrize(
    ("text", "note"),
    [
        ("<a><b></a>", "close <b> first: write </b>, or /> where it has no children"),
        ("<a><b></c>", "write </b>"),
    ],
)
def test_a_closing_tag_of_another_element(text: str, note: str) -> None:
    (problem,) = read(text).problems
    assert problem.notes == (note,)
    assert [(each.place.span.start, each.message) for each in problem.related] == [(3, "<b> opens here")]


def test_an_attribute_again_leads_to_the_first_of_its_name() -> None:
    (problem,) = read('<a b="1" c="2" b="3"/>').problems
    assert problem.span == Span(15, 16)
    assert [(each.place.span, each.message) for each in problem.related] == [(Span(3, 4), "its first value is here")]


@pytest.mark.parametrize(
    ("text", "found", "note"),
    [
        ('<a b="<"/>', [("a", [("b", "<")])], "write `<` in a value as `&lt;`"),
        ('<a b="& &c;"/>', [("a", [("b", "& &c;")])], "write `&` as `&amp;`"),
        ("<a><!-- -- --></a>", [("a", []), " -- "], "write `- -` in comments"),
        ('<a b="1"c="2"/>', [("a", [("b", "1"), ("c", "2")])], "put a space between attributes"),
        ("text<a/>", [("a", [])], "remove the text before the document element"),
        ("<a/><b/>", [("a", [])], "one element contains the whole file: remove the text after it"),
        ("< a/>", [("a", [])], "put no space between `<` and the name"),
        ('<?xml version="2.0"?><a/>', [("a", [])], 'write version="1.0"'),
    ],
)
def test_what_only_the_engine_reads(text: str, found: list[object], note: str) -> None:
    done = read(text)
    assert done.document is not None
    assert elements(done.document) == found
    assert [(each.rule, each.notes) for each in done.problems] == [("xml-not-well-formed", (note,))]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("<root><a:b/></root>", "Namespace prefix a on b is not defined"),
        ('<root><a x:y="1"/></root>', "Namespace prefix x for y on a is not defined"),
        ('<root xml:id="1 2"/>', "xml:id : attribute value 1 2 is not an NCName"),
        ("<?a:b c?><root/>", "colons are forbidden from PI names 'a:b'"),
        ('<root xmlns:a="u"><a:b a:c="d: e"/><!-- a:b --></root>', None),
        ('<root a="b:c"/>', None),
    ],
)
def test_prefixes_that_other_tools_refuse(text: str, said: str | None) -> None:
    told = [] if said is None else [f"the engine reads this, but no other XML tool does: {said}"]
    assert [each.message for each in read(text).problems] == told


def test_the_place_of_a_prefix_that_other_tools_refuse_is_one_character() -> None:
    """Where they stop reading: all that they say of it."""
    text = "<a><x:b/></a>"
    (problem,) = read(text).problems
    assert (problem.span.start, problem.span.end) == (text.index("/"), text.index("/") + 1)


def test_what_is_passed_over_and_what_is_kept() -> None:
    text = '\ufeff<?xml version="1.0" encoding="latin1"?>\n<!DOCTYPE a SYSTEM "file:///etc/passwd">\n<a>t&#252;<![CDATA[<u>]]></a>\n'
    done = read(text)
    assert done.document is not None
    assert elements(done.document) == [("a", []), ("text", "tü"), ("text", "<u>")]
    assert done.problems == ()


def test_a_section_of_characters_may_be_empty_or_have_one() -> None:
    done = read("<a><![CDATA[]]><b/><![CDATA[<]]></a>")
    assert done.document is not None
    assert elements(done.document) == [("a", []), ("b", []), ("text", "<")]


def test_entities_of_a_doctype_are_not_expanded() -> None:
    lol = '<!DOCTYPE a [<!ENTITY x "ha"><!ENTITY y "&x;&x;">]><a b="&y;">&y;</a>'
    done = read(lol)
    assert done.document is not None
    assert done.document.root.get("b") == "&y;"


def test_where_things_stand() -> None:
    text = "<a>\n  <b  x = \"1&lt;\"\n y='2'><!-- c --></b>\n  t\n</a>"
    done = read(text)
    assert done.document is not None
    a = done.document.root
    b, t = a.children
    assert isinstance(b, Element)
    assert isinstance(t, Text)
    assert text[b.start : b.end] == "<b  x = \"1&lt;\"\n y='2'>"
    assert text[b.start : b.close] == "<b  x = \"1&lt;\"\n y='2'><!-- c --></b>"
    assert [text[b.place(each)[0] :].startswith(each.name) for each in b.attributes] == [True, True]
    assert [text[b.place(each)[1] :].startswith(each.raw) for each in b.attributes] == [True, True]
    assert text[a.start : a.close] == text
    assert text[t.start :].startswith(t.text)


def test_values_as_the_engine_reads_them() -> None:
    done = read('<a b="&#10;&#x41;&quot;&apos;&unknown;&#xD800;&#0;&#x110000;\t\r\n"/>')
    assert done.document is not None
    assert done.document.root.get("b") == "\nA\"'&unknown;&#xD800;&#0;&#x110000;\t\r\n"


def test_as_deep_as_the_engine_goes_and_no_deeper() -> None:
    assert read("<a>" * MAX_DEPTH + "<a/>" + "</a>" * MAX_DEPTH).document is not None
    done = read("<a>" * 100_000)
    assert [each.rule for each in done.problems] == ["nested-too-deep"]


@pytest.mark.parametrize(
    "hostile",
    [
        '<a b="' * 100_000,
        "<a " + "b " * 200_000,
        "<a" + " " * 400_000,
        "<a " + 'b="1"' * 100_000,
        "<a>" + "<!--" * 100_000,
        "<a>" + "</" * 100_000,
        "<a>" + "&#1" * 200_000 + "</a>",
        "<a b='" + "&" * 400_000 + "'/>",
        "<" * 400_000,
        "<!" * 200_000,
        "<a " + " ".join(f'b{number}="1"' for number in range(40_000)) + "/>",
    ],
    ids=range(11),
)
def test_hostile_files_are_read_once(hostile: str) -> None:
    """Twice the size takes about twice the time: a tenth of a quadratic reader's would be minutes here."""
    begin = time.process_time()
    read(hostile)
    assert time.process_time() - begin < 20


names = st.from_regex(r"[A-Za-z_][A-Za-z0-9_.-]{0,5}", fullmatch=True)
values = st.text(st.characters(exclude_categories=("Cs", "Cc"), include_characters="\n\t"), max_size=8)
comments = values.filter(lambda text: "--" not in text and not text.endswith("-")).map(Comment)
made = st.recursive(
    st.builds(
        Element,
        names,
        st.dictionaries(names, values, max_size=3).map(
            lambda pairs: [Attribute(name, escape(value)) for name, value in pairs.items()]
        ),
    ),
    lambda inner: st.builds(Element, names, st.just(()), st.lists(inner | comments, max_size=3)),
    max_leaves=8,
)


@given(made)
def test_what_is_written_is_read_again(element: Element) -> None:
    text = write(Document([element]))
    done = read(text)
    assert done.problems == ()
    assert done.document is not None
    assert elements(done.document) == elements(Document([element])) == strict_elements(text.encode())


@given(st.text(st.sampled_from("<>/=\"'!-?[]& abé\n"), max_size=40))
def test_every_text_is_answered(text: str) -> None:
    done = read(text)
    assert (done.document is None) == any(each.effective_severity.value == "error" for each in done.problems)
    assert all(0 <= each.span.start <= each.span.end <= len(text) for each in done.problems)
