"""XML as .btq: each form, in the words of the language."""

from __future__ import annotations

import re
from pathlib import Path
from textwrap import dedent

import pytest
from hypothesis import given
from hypothesis import strategies as st
from xml_elements import elements

from btq_lang.btcpp.document import Attribute, Document, Element, XmlComment, XmlText, escape, write
from btq_lang.btcpp.export import export
from btq_lang.btcpp.importing import import_xml
from btq_lang.btcpp.reader import read
from btq_lang.formatter import format_text
from btq_lang.parser import parse
from btq_lang.util.text import LineIndex, Span
from btq_lang.workspace.workspace import Workspace


def assert_import(xml: str, btq: str, *changes: str, keep_v3: bool = True) -> None:
    """XML and the .btq file made of it; `changes` as `line:column message`.  What was not changed comes back."""
    xml, btq = dedent(xml).lstrip("\n"), dedent(btq).lstrip("\n")
    done = import_xml(xml, keep_v3)
    lines = LineIndex(xml)
    found = []
    for change in done.changes:
        line, column = lines.position(change.span.start)
        found.append(f"{line + 1}:{column + 1} {change.message}")
    assert done.text == btq
    assert found == list(changes)
    assert parse(btq).diagnostics == ()
    assert format_text(btq).text == btq
    if not changes:
        assert_comes_back(xml, btq)


def assert_comes_back(xml: str, btq: str) -> None:
    done = export(Workspace.of({"main.btq": btq}), "main.btq", verbatim=True)
    assert (done.problems, done.repairs) == ((), ())
    original, back = read(xml).document, read(write(done.document)).document
    assert original is not None
    assert back is not None
    assert elements(back) == elements(original)
    assert raws(back) == raws(original)


def raws(document: Document) -> list[str]:
    """Every value as the engine reads it."""
    found: list[str] = []
    stack: list[Element] = [document.root]
    while stack:
        element = stack.pop()
        found += [each.value.replace("\r\n", "\n") for each in element.attributes]
        stack += element.elements
    return found


def assert_node(xml: str, btq: str, *changes: str) -> None:
    """One node of a tree."""
    assert_import(
        f'<root><BehaviorTree ID="T">{xml}</BehaviorTree></root>', f"Root ()\n\nBehaviorTree T\n{btq}", *changes
    )


def test_the_root_in_all_its_forms() -> None:
    tree = '<BehaviorTree ID="T"><A/></BehaviorTree>'
    block = "\n\nBehaviorTree T\n    A\n"
    assert_import(f'<root BTCPP_format="4" main_tree_to_execute="T">{tree}</root>', f"Root T{block}")
    assert_import(f'<root main_tree_to_execute="T" BTCPP_format="4">{tree}</root>', f"Root T (BTCPP_format = 4){block}")
    assert_import(f'<root main_tree_to_execute="T">{tree}</root>', f"Root T (){block}")
    assert_import(f'<root BTCPP_format="4">{tree}</root>', f"Root (BTCPP_format = 4){block}")
    assert_import(
        f'<root BTCPP_format="4" project_name="p" main_tree_to_execute="T">{tree}</root>',
        f'Root (BTCPP_format = 4 project_name = "p" main_tree_to_execute = "T"){block}',
    )
    assert_import("<root/>", "Root ()\n")


def test_kinds() -> None:
    assert_import(
        """
        <root>
          <BehaviorTree ID="a b">
            <Sequence name="all">
              <MoveBase goal="{goal}" speed="0.5" to="dock" name="late"/>
              <Action ID="MoveBase" name="my move" x="-1" y="+1" z=""/>
              <Action x="1" ID="MoveBase"/>
              <SubTree ID="a b" name="again" _autoremap="true"/>
              <Script code="x := 1"/>
              <Script/>
              <ScriptCondition/>
              <Retry/>
              <Decorator ID="Retry"><Sequence ID="odd"/></Decorator>
              <satisfies/>
              <xml/>
              <keeps/>
              <été/>
              <a.b/>
            </Sequence>
          </BehaviorTree>
          <BehaviorTree><input a="2"/></BehaviorTree>
        </root>
        """,
        """
        Root ()

        BehaviorTree "a b"
            -> all
                MoveBase (goal = {goal} speed = 0.5 to = "dock" name = "late")
                Action MoveBase "my move" (x = -1 y = "+1" z = "")
                Action (x = 1 ID = "MoveBase")
                SubTree "a b" again (_autoremap = "true")
                Script (code = "x := 1")
                "Script"
                "ScriptCondition"
                "Retry"
                Decorator "Retry"
                    -> (ID = "odd")
                "satisfies"
                "xml"
                "keeps"
                été
                "a.b"

        BehaviorTree
            "input" (a = 2)
        """,
    )


def test_values_keep_how_they_are_spelt() -> None:
    assert_node('<A a="x&#10;y&#9;z" b="x\ny\tz"/>', '    A (a = "x\\ny\\tz" b = "x\ny\tz")\n')
    assert_node("<A a='say \"hi\"' b='it&apos;s' c='\"&apos;'/>", '    A (a = \'say "hi"\' b = "it\'s" c = "\\"\'")\n')
    assert_node('<A a="C:\\new" b="&lt;&amp;&gt;" c="{a&amp;b}"/>', '    A (a = "C:\\\\new" b = "<&>" c = "{a&b}")\n')
    assert_node('<A a="{" b="{}" c="{{x}}" d="{a b}"/>', '    A (a = "{" b = {} c = "{{x}}" d = {a b})\n')
    assert_node('<A a="1e3" b="1." c="0x10" d="1;2" e="-"/>', '    A (a = 1e3 b = "1." c = "0x10" d = "1;2" e = "-")\n')
    assert_node('<A a="x&#13;y"/>', '    A (a = "x\\ny")\n', "1:34 a carriage return in `a` is written as a line end")


def test_a_line_that_is_too_long_is_broken_as_the_formatter_breaks_it() -> None:
    for length in range(60, 100):
        assert_node(f'<A a="{"x" * length}" b="1"/>', broken(length))


def broken(length: int) -> str:
    line = f'    A (a = "{"x" * length}" b = 1)\n'
    return line if len(line) <= 101 else f'    A (\n        a = "{"x" * length}"\n        b = 1\n    )\n'


def test_comments_stand_where_they_stood() -> None:
    assert_import(
        """
        <!-- before -->
        <root> <!-- first -->
          <!-- of the tree -->
          <BehaviorTree ID="T"> <!-- behind T -->
            <!-- above -->
            <Sequence> <!-- behind it -->
              <!--tight--><A/> <!-- behind A --> <!-- and again -->
              <!-- two
                   lines -->
              <B/>
              <C> <!-- alone in C --> </C>
              <!--\tlast */ -->
            </Sequence>
            <!-- last -->
          </BehaviorTree>
          <!---->
        </root>
        <!-- after -->
        """,
        """
        # before

        Root ()
            # first
            # of the tree
            BehaviorTree T  # behind T
                # above
                ->  # behind it
                    #tight
                    A  # behind A
                    # and again
                    /* two
                   lines */
                    B
                    C
                        # alone in C
                    #\tlast */
                # last

            #
        # after
        """,
    )


def test_models() -> None:
    assert_import(
        """
        <root BTCPP_format="4">
          <include path="a.xml"/>
          <include path="b.xml" ros_pkg="p"/>
          <TreeNodesModel>
            <Action ID="MoveBase" editable="true">
              <description>Drives</description>
              <input_port name="goal" type="std::string" default="dock">where to</input_port>
              <input_port name="a b"/>
              <output_port name="all" type="std::vector&lt;int&gt;" required="true"/>
              <inout_port default="1" name="x"/>
              <!-- of no engine -->
              <bidirectional_port name="y"/>
              <MetadataFields><Metadata color="red"/><Metadata size="2"/></MetadataFields>
              <MetadataFields/>
            </Action>
            <SubTree ID="S"/>
            <MetadataFields/>
            <Action ID="Dock">
              <MetadataFields by="hand"><Metadata color="red"/></MetadataFields>
            </Action>
          </TreeNodesModel>
          <Unknown a="1"><b/></Unknown>
        </root>
        """,
        """
        Root (BTCPP_format = 4)

        include "a.xml"
        include "b.xml" (ros_pkg = "p")

        TreeNodesModel
            Action MoveBase (editable = "true") "Drives"
                input goal : std::string = "dock" "where to"
                input (name = "a b")
                output all : "std::vector<int>" (required = "true")
                inout = 1 (name = "x")
                # of no engine
                xml '<bidirectional_port name="y"/>'
                metadata (color = "red")
                metadata (size = 2)
                xml "<MetadataFields/>"
            SubTree S
            xml "<MetadataFields/>"
            Action Dock
                xml '<MetadataFields by="hand"><Metadata color="red"/></MetadataFields>'

        xml '<Unknown a="1"><b/></Unknown>'
        """,
    )


def test_what_stands_elsewhere_or_nowhere_is_told() -> None:
    assert_import(
        """
        <root>
          <include ros_pkg="p" path="a.xml"/>
          text
          <BehaviorTree x="1" ID="T">stray<A/></BehaviorTree>
        </root>
        """,
        """
        Root ()

        include "a.xml" (ros_pkg = "p")

        BehaviorTree T (x = 1)
            A
        """,
        "2:24 `path` is moved before the other attributes of <include>",
        "3:3 text that the engine ignores is left out: text",
        "4:23 `ID` is moved before the other attributes of <BehaviorTree>",
        "4:30 text that the engine ignores is left out: stray",
    )


def test_few_of_very_many_lost_texts_are_told() -> None:
    sections = "<![CDATA[x]]>" * 1000
    done = import_xml(f'<root><BehaviorTree ID="T"><Sequence>{sections}<Pick/></Sequence></BehaviorTree></root>', True)
    assert len(done.diagnostics) == len(done.changes) == 101
    assert done.diagnostics[-1].message == "the engine ignores this text and everything after it"
    assert done.changes[-1].message == "text that the engine ignores is left out from here on"
    assert done.text == "Root ()\n\nBehaviorTree T\n    ->\n        Pick\n"


@pytest.mark.parametrize(
    "inside",
    ['<Sequence _btq="r">' * 490 + "{}" + "</Sequence>" * 490, "{}" + '<Script _btq="r"/>' * 20000],
    ids=["deep", "wide"],
)
def test_marks_of_a_build_in_any_number_are_taken_out(inside: str) -> None:
    xml = '<root BTCPP_format="4"><BehaviorTree ID="T"><Sequence>{}</Sequence></BehaviorTree></root>'
    done = import_xml(xml.replace("{}", inside.replace("{}", "<Pick/>")))
    assert done.text == "Root ()\n".replace("()", "(BTCPP_format = 4)") + "\nBehaviorTree T\n    ->\n        Pick\n"


def test_a_file_with_the_mark_of_a_build_alone_comes_without_it() -> None:
    tree = '<root BTCPP_format="4"><BehaviorTree ID="T"><Pick/></BehaviorTree></root>'
    done = import_xml(f"<!-- Generated by btq from main.btq; edit that file. -->{tree}")
    assert (done.text, done.changes) == (import_xml(tree).text, ())


def test_what_a_build_has_put_in_is_taken_out() -> None:
    assert_import(
        """
        <!-- Generated by btq from main.btq; edit that file. -->
        <root BTCPP_format="4" main_tree_to_execute="T">
          <BehaviorTree ID="T">
            <A _description="mine&#10;[btq]&#10;rq1"/>
            <B _description="[btq]&#10;rq1"/>
          </BehaviorTree>
        </root>
        """,
        """
        Root T

        BehaviorTree T
            A (_description = "mine")
            B
        """,
        "4:8 removed what `btq build` added: 2 descriptions",
    )


def test_the_example_of_the_document() -> None:
    document = (Path(__file__).parents[2] / "docs" / "import.md").read_text(encoding="utf-8")
    xml, btq = re.findall(r"^```(?:xml|text)\n(.*?)^```$", document, re.DOTALL | re.MULTILINE)
    assert_import(xml, btq, keep_v3=False)


V3 = """
    <root main_tree_to_execute="T">
      <BehaviorTree ID="T">
        <SequenceStar>
          <Control ID="SequenceStar" name="s"><A x="1"/></Control>
          <RetryUntilSuccesful num_attempts="3"><A/></RetryUntilSuccesful>
          <Parallel success_threshold="2" failure_threshold="1"><A/><A/></Parallel>
          <SubTree ID="S" name="n" in="key" out="{key}" none="" __shared_blackboard="true"/>
          <SubTree ID="S" __shared_blackboard="false"/>
          <SubTreePlus ID="S" in="literal" __autoremap="1"/>
          <BlackboardCheckInt value_A="{a}" value_B="1" return_on_mismatch="FAILURE"><A/></BlackboardCheckInt>
        </SequenceStar>
      </BehaviorTree>
      <TreeNodesModel>
        <SubTree ID="S">
          <input_port name="__shared_blackboard" default="false"/>
          <input_port name="in"/>
        </SubTree>
      </TreeNodesModel>
    </root>
    """


def test_version_3_says_it_as_version_4_does() -> None:
    assert_import(
        V3,
        """
        Root T

        BehaviorTree T
            M->
                Control SequenceWithMemory s
                    A (x = 1)
                RetryUntilSuccessful (num_attempts = 3)
                    A
                || (success_count = 2 failure_count = 1)
                    A
                    A
                SubTree S n (in = {key} out = {key} none = "" _autoremap = "true")
                SubTree S
                SubTree S (in = "literal" _autoremap = 1)
                BlackboardCheckInt (value_A = {a} value_B = 1 return_on_mismatch = "FAILURE")
                    A

        TreeNodesModel
            SubTree S
                input in
        """,
        '1:2 BTCPP_format="4" is added',
        "3:6 SequenceStar is now SequenceWithMemory",
        "4:16 SequenceStar is now SequenceWithMemory",
        "5:8 RetryUntilSuccesful is now RetryUntilSuccessful",
        "6:17 success_threshold of Parallel is now success_count",
        "6:39 failure_threshold of Parallel is now failure_count",
        '7:32 in="key" of a SubTree names an entry: now "{key}"',
        "7:53 `none` of a SubTree names no entry: kept unchanged",
        '7:61 __shared_blackboard is now _autoremap="true"',
        "8:23 __shared_blackboard is left out: version 4 shares only what is mapped",
        "9:8 SubTreePlus is now SubTree",
        "9:40 __autoremap is now _autoremap",
        "10:8 BlackboardCheckInt was a node of version 3: write a Precondition with a script: kept unchanged",
        "15:7 the port __shared_blackboard of a SubTree's model is left out: version 4 would require it",
        keep_v3=False,
    )


def test_entries_that_version_3_knows_without_braces_get_them() -> None:
    assert_import(
        """
        <root main_tree_to_execute="T">
          <BehaviorTree ID="T">
            <Sequence>
              <Action ID="Find" dock="dock" start="here" rest="="/>
              <Find dock="{dock}" start="${pose}" name="${n}"/>
              <SubTreePlus ID="T" a="${dock}" b="dock"/>
            </Sequence>
          </BehaviorTree>
          <TreeNodesModel>
            <Action ID="Find">
              <output_port name="dock"/>
              <output_port name="rest"/>
              <input_port name="start"/>
            </Action>
          </TreeNodesModel>
        </root>
        """,
        """
        Root T

        BehaviorTree T
            ->
                Action Find (dock = {dock} start = "here" rest = "=")
                Find (dock = {dock} start = {pose} name = "${n}")
                SubTree T (a = {dock} b = "dock")

        TreeNodesModel
            Action Find
                output dock
                output rest
                input start
        """,
        '1:2 BTCPP_format="4" is added',
        '4:25 dock="dock" names the entry of an output: now "{dock}"',
        '5:27 start="${pose}" names an entry: now "{pose}"',
        "6:8 SubTreePlus is now SubTree",
        '6:27 a="${dock}" names an entry: now "{dock}"',
        keep_v3=False,
    )


@pytest.mark.parametrize(
    "root",
    [
        '<root BTCPP_format="4"><BehaviorTree ID="T"><SubTree ID="S" a="b"/></BehaviorTree></root>',
        '<root><BehaviorTree ID="T"><A _skipIf="x"/><SubTree ID="S" a="b"/></BehaviorTree></root>',
        '<root><BehaviorTree ID="T"><Script code="x:=1"/><SubTree ID="S" a="b"/></BehaviorTree></root>',
        '<root><BehaviorTree ID="T"><SubTree ID="S" a="b" _autoremap="1"/></BehaviorTree></root>',
    ],
)
def test_what_says_something_new_is_version_4(root: str) -> None:
    assert import_xml(root).changes == ()


OLD_NODES = (
    *("Sequence", "Fallback", "Parallel", "ReactiveSequence", "ReactiveFallback", "IfThenElse", "WhileDoElse"),
    *("Switch2", "Switch3", "Switch4", "Switch5", "Switch6", "Inverter", "ForceSuccess", "ForceFailure"),
    *("KeepRunningUntilFailure", "Repeat", "RetryUntilSuccessful", "Timeout", "Delay", "AlwaysSuccess"),
    *("AlwaysFailure", "SetBlackboard", "SubTree"),
)


@pytest.mark.parametrize("node", OLD_NODES)
def test_a_node_that_version_3_has_already_says_nothing_new(node: str) -> None:
    """So an old word beside it counts; the version is a property of the root's tag, without its brackets."""
    plain = f'<root main_tree_to_execute="T"><BehaviorTree ID="T"><{node}/></BehaviorTree></root>'
    assert import_xml(plain).changes == ()
    xml = plain.replace(f"<{node}/>", f"<SequenceStar><{node}/></SequenceStar>")
    change, *_ = import_xml(xml).changes
    assert change.message == 'BTCPP_format="4" is added'
    assert xml[change.span.start : change.span.end] == 'root main_tree_to_execute="T"'


def test_what_is_translated_is_named_with_its_place() -> None:
    node = '<SequenceStar><SubTree ID="S" __shared_blackboard="true" a="b"/></SequenceStar>'
    xml = f'<root><BehaviorTree ID="T">{node}</BehaviorTree></root>'
    assert [xml[change.span.start : change.span.end] for change in import_xml(xml).changes] == [
        "root",
        "SequenceStar",
        '__shared_blackboard="true"',
        'a="b"',
    ]


def test_version_3_is_kept_if_asked() -> None:
    done = import_xml(V3, keep_v3=True)
    assert done.changes == ()
    assert done.text.startswith("Root T ()\n\nBehaviorTree T\n    SequenceStar\n        Control SequenceStar s\n")


@pytest.mark.parametrize(("xml", "rule"), [("<Sequence/>", "xml-root"), ("<root>", "xml-syntax"), ("", "xml-syntax")])
def test_what_is_no_mission(xml: str, rule: str) -> None:
    done = import_xml(xml)
    assert (done.text, done.is_complete, [each.rule for each in done.diagnostics]) == ("", False, [rule])


def test_each_word_knows_where_it_comes_from() -> None:
    xml = '<root><BehaviorTree ID="T"><!-- c --><Action ID="Pick" name="p" tube="&lt;1" s="abc"/></BehaviorTree></root>'
    done = import_xml(xml, for_people=False)
    btq = done.text

    def origin(word: str) -> str:
        start = btq.index(word)
        span = done.places.origin(Span(start, start + len(word)))
        return xml[span.start : span.end]

    assert origin("BehaviorTree") == "BehaviorTree"
    assert origin("# c") == "<!-- c -->"
    assert origin("Action") == "Action"
    assert origin("Pick") == "Pick"
    assert origin("Pick p") == 'Pick" name="p'
    assert origin("tube") == "tube"
    assert origin('"<1"') == "&lt;1"
    assert origin('"abc"') == "abc"
    assert origin("bc") == "bc"
    assert origin("tube = ") == "tube"


names = st.sampled_from(
    [
        *(
            "Sequence",
            "Fallback",
            "MoveBase",
            "Script",
            "Retry",
            "SubTree",
            "Action",
            "Control",
            "xml",
            "input",
            "tags",
        ),
        *(
            "BehaviorTree",
            "Root",
            "a.b",
            "a-b",
            "keeps",
            "ScriptAction",
            "Switch2",
            "Test",
            "include",
            "é",
            "QualityReq",
        ),
    ]
)
keys = st.sampled_from(["ID", "name", "goal", "parameters", "satisfies", "_skipIf", "a.b", "x-y", "tags", "Quality"])
values = st.one_of(
    st.sampled_from(["6", "-1", "{a}", "{=}", "s", "30 s", "true", "", "R?", "->", "a\nb", "\\n", "\\", "satisfies"]),
    st.text(st.characters(exclude_categories=("Cs", "Cc"), include_characters="\n\t"), max_size=8),
    st.text("x ", min_size=20, max_size=80),
)
attributes = st.dictionaries(keys, values, max_size=4).map(
    lambda pairs: [Attribute(key, escape(value)) for key, value in pairs.items()]
)
comments = st.builds(
    XmlComment,
    st.text(st.characters(exclude_categories=("Cs", "Cc"), include_characters="\n\t"), max_size=12).filter(
        lambda text: "--" not in text and not text.endswith("-") and "*/" not in text
    ),
    st.booleans(),
)


def nodes(inner: st.SearchStrategy[Element]) -> st.SearchStrategy[Element]:
    return st.builds(Element, names, attributes, st.lists(inner | comments, max_size=4))


node = st.recursive(st.builds(Element, names, attributes), nodes, max_leaves=10)
tree = st.builds(
    lambda contents: Element("BehaviorTree", [Attribute("ID", "T")], contents),
    st.lists(node | comments, max_size=4),
)
port = st.builds(
    lambda tag, found, text: Element(tag, found, [XmlText(text)] if text.strip() else []),
    st.sampled_from(["input_port", "output_port", "inout_port", "port"]),
    st.dictionaries(st.sampled_from(["name", "type", "default", "x"]), values, max_size=4).map(
        lambda pairs: [Attribute(key, escape(value)) for key, value in pairs.items()]
    ),
    st.text(st.characters(exclude_categories=("Cs", "Cc"), include_characters="\n"), max_size=8),
)
metadata = st.builds(
    lambda fields: Element("MetadataFields", (), [Element("Metadata", each) for each in fields]),
    st.lists(attributes, max_size=2),
)
model = st.builds(
    lambda tag, parts: Element(tag, [Attribute("ID", "M")], parts),
    st.sampled_from(["Action", "SubTree", "Other"]),
    st.lists(port | metadata | comments, max_size=3),
)
models = st.builds(lambda parts: Element("TreeNodesModel", (), parts), st.lists(model | comments, max_size=3))
documents = st.builds(
    lambda before, given, contents, behind: Document([*before, Element("root", given, contents), *behind]),
    st.lists(comments, max_size=2),
    st.dictionaries(st.sampled_from(["BTCPP_format", "main_tree_to_execute", "x"]), values, max_size=3).map(
        lambda pairs: [Attribute(key, escape(value)) for key, value in pairs.items()]
    ),
    st.lists(st.one_of(tree, models, comments, node), max_size=4),
    st.lists(comments, max_size=2),
)


@given(documents)
def test_every_document_comes_back(document: Document) -> None:
    xml = write(document)
    assert read(xml).problems == ()
    done = import_xml(xml, keep_v3=True)
    assert [change.message for change in done.changes] == []
    assert [
        each for each in parse(done.text).diagnostics if each.rule not in ("string-over-items", "nested-too-deep")
    ] == []
    assert format_text(done.text).text == done.text
    assert_comes_back(xml, done.text)
