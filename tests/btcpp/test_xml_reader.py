"""The reader of XML: what the engine reads is read, in a time and a space that grow with the file and no faster."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree
from xml_elements import elements
from xml_judges import judged_by

from btq_lang.btcpp.document import Attribute, Document, Element, XmlComment, XmlText, escape, write
from btq_lang.btcpp.reader import MAX_DEPTH, XmlRead, read
from btq_lang.util.text import LineIndex, Span

STRICT = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False, huge_tree=False, encoding="utf-8")


@pytest.fixture(autouse=True, scope="module", params=["lxml", "expat"])
def judge(request: pytest.FixtureRequest) -> Iterator[None]:
    with judged_by(request.param):
        yield


def strict_elements(data: bytes) -> list[object]:
    """The same by lxml."""
    found: list[object] = []
    root = etree.fromstring(data, STRICT)
    around = [*root.itersiblings(preceding=True)][::-1], [*root.itersiblings()]
    found += [comment.text for comment in around[0] if comment.tag is etree.Comment]
    stack: list[tuple[str, Any]] = [("node", root)]
    while stack:
        kind, node = stack.pop()
        if kind == "text":
            found.append(("text", node))
            continue
        if node.tag is etree.Comment:
            found.append(node.text)
            inner: list[tuple[str, Any]] = []
        else:
            found.append((node.tag, list(node.items())))
            inner = [("text", node.text)] if node.text and node.text.strip() else []
            inner += [("node", child) for child in node]
        behind = [("text", node.tail)] if node.tail and node.tail.strip() else []
        stack += reversed(inner + behind)
    return found + [comment.text for comment in around[1] if comment.tag is etree.Comment]


def problems(done: XmlRead, text: str) -> list[str]:
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


REFUSED = [
    ('<a b="<"/>', "1:7 `<` in a value", "write `<` in a value as `&lt;`"),
    ('<a\n  b="1" c="x && y"/>', "2:14 `&` does not begin a reference", "write `&` as `&amp;`"),
    ("<a>&amp</a>", "1:4 `&` does not begin a reference", "write `&` as `&amp;`"),
    ("<a>&#X41;</a>", "1:4 `&` does not begin a reference", "write `&` as `&amp;`"),
    (
        '<a b="&c;"/>',
        "1:7 the entity `c` is not defined",
        "only &lt; &gt; &amp; &quot; &apos; and numbers are known: write `&` as `&amp;`",
    ),
    ("<a>&#0;</a>", "1:4 `&#0;` is not a character of XML", "XML does not allow a character like this: remove it"),
    (
        "<a>&#xD800;</a>",
        "1:4 `&#xD800;` is not a character of XML",
        "XML does not allow a character like this: remove it",
    ),
    (
        f"<a>&#{'9' * 5_000};</a>",
        f"1:4 `&#{'9' * 5_000};` is not a character of XML",
        "XML does not allow a character like this: remove it",
    ),
    ("<a>\x01</a>", "1:4 the character U+0001", "XML does not allow a character like this: remove it"),
    ("<a><!-- \uffff --></a>", "1:9 the character U+FFFF", "XML does not allow a character like this: remove it"),
    ("<a><![CDATA[\x02]]></a>", "1:13 the character U+0002", "XML does not allow a character like this: remove it"),
    ('<a\vb="1"/>', "1:3 the character U+000B", "XML does not allow a character like this: remove it"),
    ('<a b\f="1"/>', "1:5 the character U+000C", "XML does not allow a character like this: remove it"),
    ("<a>]]></a>", "1:4 `]]>` in a text", "write `]]>` in a text as `]]&gt;`"),
    ("<a><!-- -- --></a>", "1:9 `--` in a comment", "write `- -` in comments"),
    ("<a><!-- x ---></a>", "1:11 `--` in a comment", "write `- -` in comments"),
    ('<a b="1"c="2"/>', "1:9 no space between attributes", "put a space between attributes"),
    ('<a></a b="1">', "1:8 an attribute in an end tag", "remove it"),
    ("< a/>", "1:2 a space before the name of a tag", "put no space between `<` and the name"),
    ("<a×b/>", "1:3 `×` in a name", "write letters, digits, `_`, `-` and `.`"),
    ("<·a/>", "1:2 `·` in a name", "write letters, digits, `_`, `-` and `.`"),
    ("<a\u2028/>", "1:3 U+2028 in a name", "write letters, digits, `_`, `-` and `.`"),
    ("text<a/>", "1:1 text before the document element", "remove the text before the document element"),
    (
        "<![CDATA[x]]><a/>",
        "1:1 a CDATA section before the document element",
        "remove the text before the document element",
    ),
    (
        "<a/>\n<b/>",
        "2:1 a tag after the document element",
        "one element contains the whole file: remove the text after it",
    ),
    (
        "<a/></b>",
        "1:5 a tag after the document element",
        "one element contains the whole file: remove the text after it",
    ),
    ('<?xml version="2.0"?><a/>', "1:16 unsupported version `2.0`", 'write version="1.0"'),
    ("<?xml?><a/>", "1:1 malformed XML declaration", 'write <?xml version="1.0" encoding="UTF-8"?>'),
    (
        '<?xml version="1.0" encoding="utf 8"?><a/>',
        "1:1 malformed XML declaration",
        'write <?xml version="1.0" encoding="UTF-8"?>',
    ),
    (
        '\n<?xml version="1.0"?><a/>',
        "2:3 an XML declaration after other content",
        "put the declaration first in the file, without a space before it",
    ),
    ("<??><a/>", "1:1 a processing instruction without a name", "remove it"),
    ("<?b+c?><a/>", "1:4 `+` in a name", "write letters, digits, `_`, `-` and `.`"),
    ("<!doctype a><a/>", "1:1 unexpected declaration", "the engine does not read it: remove it"),
    ("<a><!b></a>", "1:4 unexpected declaration", "the engine does not read it: remove it"),
    (
        '<!DOCTYPE a [<!ENTITY x "<b>">]><a>&x;</a>',
        "1:1 malformed declarations in a DOCTYPE",
        "the engine does not read them: remove them",
    ),
    (
        '<!DOCTYPE a [<!-- ]" --><!ENTITY x "1">]>\n<a b="&x;<"/>',
        "2:10 `<` in a value",
        "write `<` in a value as `&lt;`",
    ),
]


@pytest.mark.parametrize(("text", "said", "note"), REFUSED, ids=range(len(REFUSED)))
def test_what_only_the_engine_reads(text: str, said: str, note: str) -> None:
    place, _, message = said.partition(" ")
    done = read(text)
    assert done.document is not None
    assert problems(done, text) == [
        f"{place} warning xml-not-well-formed: the engine reads this, but no other XML tool does: {message}"
    ]
    assert done.problems[0].notes == (note,)


def test_values_that_only_the_engine_reads() -> None:
    done = read('<a b="<" c="& &d;"><!-- -- --></a>')
    assert done.document is not None
    assert elements(done.document) == [("a", [("b", "<"), ("c", "& &d;")]), " -- "]


@pytest.mark.parametrize(
    "text",
    [
        '<?xml version="1.1"?><a/>',
        '<?xml version="1.0" encoding="latin1" standalone="yes"?><a>ü</a>',
        "<?xml-stylesheet a?><!-- b --><a/>\n<!-- c -->",
        '<!DOCTYPE a PUBLIC "-//a//b" "c.dtd"><a>&d;</a>',
        '<!DOCTYPE a [<!ENTITY x "1">]><a b="&x;"/>',
        "<a>&#10;&lt;]]&gt;\x7f</a>",
        "<größe/>",
        '<a\u0370\u2070 \U00010400="1"/>',  # letters of XML's fifth edition, which expat does not know
        "<a>" * 300 + "</a>" * 300,  # deeper than lxml goes
    ],
)
def test_what_other_tools_read_too(text: str) -> None:
    assert read(text).problems == ()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("<root><a:b/></root>", "1:8 the prefix of `a:b` is not declared"),
        ('<root><a x:y="1"/></root>', "1:10 the prefix of `x:y` is not declared"),
        ('<root><a xmlns:x="u"/><x:b/></root>', "1:24 the prefix of `x:b` is not declared"),
        ('<root xml:id="1 2"/>', "1:15 the value of `xml:id` is not a name"),
        ("<?a:b c?><root/>", "1:3 misplaced `:` in `a:b`"),
        ("<root><a:/></root>", "1:8 misplaced `:` in `a:`"),
        ('<root xmlns:a="u" a:b:c="1"/>', "1:19 misplaced `:` in `a:b:c`"),
        ('<root xmlns:a=""/>', "1:16 `xmlns:a` declares no namespace"),
        ('<root xmlns:a="b c"/>', "1:16 the value of `xmlns:a` is not a URI"),
        ('<root xmlns:xml="a"/>', "1:7 `xml` and `xmlns` are declared by XML itself"),
        (
            '<root xmlns:a="u" xmlns:b="u" a:c="1" b:c="2"/>',
            "1:39 duplicate attribute `c` in <root>: two prefixes mean the same",
        ),
        ('<root><a:b c="<"/></root>', "1:8 the prefix of `a:b` is not declared"),
        ('<root><b c="<"/><a:b/></root>', "1:13 `<` in a value"),
        ("<root><a:b/></root><c/>", "1:8 the prefix of `a:b` is not declared"),
        ('<root xmlns:a="u"><a:b a:c="d: e"/><!-- a:b --></root>', None),
        ('<root xmlns="u" xml:lang="x" a="b:c"/>', None),
    ],
)
def test_prefixes_that_other_tools_refuse(text: str, said: str | None) -> None:
    place, _, message = (said or "").partition(" ")
    told = f"{place} warning xml-not-well-formed: the engine reads this, but no other XML tool does: {message}"
    assert problems(read(text), text) == ([told] if said is not None else [])


def test_a_prefix_that_is_not_declared_is_marked() -> None:
    (problem,) = read("<a><x:b/></a>").problems
    assert (problem.span, problem.notes) == (
        Span(4, 5),
        ('write xmlns:x="…" in an element around it, or remove the prefix',),
    )


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
    done = read('<!DOCTYPE a [<!ENTITY x "ha"><!ENTITY y "&x;&x;">]><a b="&y;">&y;</a>')
    assert done.document is not None
    assert (done.document.root.get("b"), done.problems) == ("&y;", ())


@pytest.mark.parametrize("where", ["<a>&x9;</a>", '<a b="&x9;"/>'])
def test_entities_that_grow_without_end_are_refused(where: str) -> None:
    """A billion laughs: ten gigabytes, were they expanded."""
    grown = "".join(f'<!ENTITY x{number} "{f"&x{number - 1};" * 10}">' for number in range(1, 10))
    text = f'<!DOCTYPE a [<!ENTITY x0 "ha ha ha ">{grown}]>{where}'
    begin = time.process_time()
    assert [each.message for each in read(text).problems] == [
        "the engine reads this, but no other XML tool does: malformed declarations in a DOCTYPE"
    ]
    assert time.process_time() - begin < 20


def test_where_things_stand() -> None:
    text = "<a>\n  <b  x = \"1&lt;\"\n y='2'><!-- c --></b>\n  t\n</a>"
    done = read(text)
    assert done.document is not None
    a = done.document.root
    b, t = a.children
    assert isinstance(b, Element)
    assert isinstance(t, XmlText)
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
comments = values.filter(lambda text: "--" not in text and not text.endswith("-")).map(XmlComment)
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
