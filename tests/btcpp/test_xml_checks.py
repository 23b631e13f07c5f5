"""XML in a workspace: checked as it is, with diagnostics placed in the XML, and included by missions."""

from __future__ import annotations

import pickle

import pytest
from check_asserts import apply, assert_clean, assert_problems, show, workspace_of

from btq_lang.btcpp.export import export
from btq_lang.catalog.name_kinds import Kind
from btq_lang.checks import check
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.diagnostics.rules import Severity
from btq_lang.workspace.config import Project
from btq_lang.workspace.file import File
from btq_lang.workspace.workspace import Workspace

SKILLS = """\
//- main.btq
include "skills.xml"

BehaviorTree Main
    ->
        MoveBase (station = "bench")
        SubTree Pick
{more}
//- skills.xml
<root BTCPP_format="4">
  <BehaviorTree ID="Pick"><AlwaysSuccess/></BehaviorTree>
  <TreeNodesModel>
    <Action ID="MoveBase"><input_port name="station"/></Action>
  </TreeNodesModel>
</root>
"""


def test_an_include_brings_trees_and_models() -> None:
    assert_clean(SKILLS.format(more=""))


def test_what_no_included_xml_has_is_nowhere() -> None:
    text = SKILLS.format(more="        SubTree Pikc\n        MoveBsae\n")
    assert_problems(
        text,
        "main.btq:7:17 error unknown-tree «Pikc» unknown tree `Pikc`; did you mean `Pick`?",
        "main.btq:8:9 warning unknown-node «MoveBsae» unknown node `MoveBsae`; did you mean `MoveBase`?",
    )


def test_the_engine_knows_no_namespaces() -> None:
    text = """
        //- main.xml
        <root BTCPP_format="4" xmlns:x="u">
          <x:include path="a.xml"/>
          <BehaviorTree ID="Main"><x:Go/></BehaviorTree>
          <x:BehaviorTree ID="T"><Go/></x:BehaviorTree>
          <x:notes>of somebody else</x:notes>
        </root>
        """
    ignored = "warning xml-ignored «{0}» the engine ignores <{0}>, because it does not support namespaces; write <{1}>"
    assert_problems(
        text,
        f"2:4 {ignored.format('x:include', 'include')}",
        "3:28 error forbidden-name «x:Go» the engine refuses the node ID `x:Go`: it contains `:`",
        f"4:4 {ignored.format('x:BehaviorTree', 'BehaviorTree')}",
    )
    workspace = workspace_of({"main.xml": text.replace("//- main.xml", "").strip()})
    notes = [note for found in check(workspace, "main.xml") for note in found.notes]
    assert notes == ["it does not support XML namespaces: the prefix is part of the name"]


def test_a_prefix_before_a_node_that_is_known() -> None:
    text = (
        '<root BTCPP_format="4" xmlns:bt="u"><BehaviorTree ID="A"><bt:Sequence><bt:Spin/><bt:Turn/></bt:Sequence>'
        '</BehaviorTree><TreeNodesModel><Action ID="Spin"/></TreeNodesModel></root>'
    )
    refused = "error forbidden-name «bt:{0}» the engine refuses the node ID `bt:{0}`: it contains `:`"
    diagnostics = [each for each in check(workspace_of({"main.xml": text}), "main.xml") if each.rule != "unknown-node"]
    assert [shown.partition(" ")[2] for shown in show(text, diagnostics)] == [
        refused.format("Sequence") + "; did you mean `Sequence`?",
        refused.format("Spin") + "; did you mean `Spin`?",
        refused.format("Turn"),
    ]
    mended = apply({"main.xml": text}, "main.xml", diagnostics[0].fixes[0])["main.xml"]
    assert mended == text.replace("bt:Sequence", "Sequence")


def test_what_could_not_be_read_may_hold_anything() -> None:
    text = SKILLS.format(more="        SubTree Pikc\n").replace("</TreeNodesModel>", "</TreeNodes>")
    told = "expected </TreeNodesModel>, found </TreeNodes>"
    assert_problems(
        text,
        f'main.btq:1:9 error include-with-errors «"skills.xml"» `skills.xml` has 1 error: {told}',
        f"skills.xml:5:3 error xml-syntax «</TreeNodes>» {told}",
    )


def test_related_places_stand_in_the_xml() -> None:
    workspace = workspace_of(
        {
            "a.xml": '<root>\n  <BehaviorTree ID="T"><A/></BehaviorTree>\n</root>',
            "main.btq": 'include "a.xml"\n\nBehaviorTree T\n    A\n',
        }
    )
    (found,) = (each for each in check(workspace, "main.btq") if each.rule == "duplicate-tree")
    place = found.related[0].place
    assert place.path == "a.xml"
    assert workspace.files["a.xml"].source[place.span.start : place.span.end] == "T"
    assert found.fixes == ()


def test_comments_in_xml_silence_rules_for_a_whole_element() -> None:
    node = '<Timeout msec="1" b="{x}" ' + " ".join(f'long{number}="value"' for number in range(12)) + "><A/></Timeout>"
    around = '<root BTCPP_format="4"><BehaviorTree ID="T">\n', "</BehaviorTree></root>"
    xml = f"<!-- btq: ignore[unknown-port] -->\n{node}".join(around)
    assert_clean_xml(xml)
    assert "unknown-port" in {each.rule for each in problems(xml.replace("ignore", "say"))}


def test_a_name_that_a_build_would_mend_is_an_error_in_xml() -> None:
    (found,) = problems('<root BTCPP_format="4"><BehaviorTree ID="a b"><A/></BehaviorTree></root>')
    assert (found.rule, found.effective_severity.value) == ("forbidden-name", "error")
    assert found.message == "the engine refuses the tree ID `a b`: it contains a space"


def test_explicit_forms_are_refused_only_directly_below_a_reactive_sequence() -> None:
    xml = (
        '<root BTCPP_format="4"><BehaviorTree ID="T"><{tag}><Action ID="A"/><SubTree ID="S"/></{tag}></BehaviorTree>'
        '<BehaviorTree ID="S"><B/></BehaviorTree></root>'
    )
    for tag, expected in (("ReactiveSequence", ["explicit-in-reactive"]), ("ReactiveFallback", []), ("Sequence", [])):
        text = xml.replace("{tag}", tag)
        assert [each.rule for each in problems(text) if each.rule == "explicit-in-reactive"] == expected
    old = Project(engines=("4.6",))
    workspace = workspace_of({"a.xml": xml.replace("{tag}", "ReactiveSequence")}, old)
    assert [each.rule for each in check(workspace, "a.xml") if each.rule == "explicit-in-reactive"] == []


def test_what_can_be_no_tag_is_refused_directly_below_a_reactive_sequence() -> None:
    text = "BehaviorTree T\n    R->\n        Ok\n        {node}\n"
    apart = (
        "the name is not a valid XML tag, and the engine accepts no other form here: put it in a Sequence of its own"
    )

    def found(node: str, version: str = "4.10", symbol: str = "R->") -> list[tuple[str, tuple[str, ...]]]:
        files = {"a.btq": text.replace("{node}", node).replace("R->", symbol)}
        workspace = Workspace.of(files, Project(engines=(version,)))
        diagnostics = check(workspace, "a.btq")
        return [(each.message, each.notes) for each in diagnostics if each.rule == "explicit-in-reactive"]

    for node, name in (('Action "3d scan"', "3d scan"), ('"3d-scan"', "3d-scan"), ('Condition "a.b"', "a.b")):
        told = [(f"the engine refuses `{name}` directly below a ReactiveSequence", (apart,))]
        assert found(node) == told
        assert found(node, symbol="R?") == []
        assert found(node, "4.6") == []
        workspace = Workspace.of({"a.btq": text.replace("{node}", node)})
        assert [each.message for each in export(workspace, "a.btq").problems] == [
            f"the engine refuses `{name}` directly in a ReactiveSequence: put it in a Sequence of its own"
        ]
    for node in ("Action Scan", "Scan", '"Größe"', 'SubTree "3d scan"', 'ScriptAction (name = "3d scan")', '"3d scan"'):
        assert found(node) == []  # a forbidden tag is reported as such
    xml = '<root BTCPP_format="4"><BehaviorTree ID="T"><ReactiveSequence><Action ID="3d scan"/></ReactiveSequence>'
    (problem,) = [each for each in problems(f"{xml}</BehaviorTree></root>") if each.rule == "explicit-in-reactive"]
    assert problem.notes == (
        "its message `Unknown node type: Action` refers to the tag: put it in a Sequence of its own",
        '4.6 accepts it: if you run that, set `engine = "4.6"` in btq.toml',
    )


def test_files_of_any_name_that_begin_like_xml_are_xml() -> None:
    xml = '<root BTCPP_format="4"><BehaviorTree ID="T"><A/></BehaviorTree></root>'
    assert workspace_of({"a.tree": f"\n{xml}"}).files["a.tree"].is_foreign
    assert not workspace_of({"a.btq": xml}).files["a.btq"].is_foreign


def test_a_file_of_xml_is_a_value() -> None:
    xml = '<root BTCPP_format="4"><BehaviorTree ID="T"><A x="1"/></BehaviorTree></root>'
    (file, other) = (workspace_of({"a.xml": text}).files["a.xml"] for text in (xml, xml.replace(" x", "  x")))
    assert file.text == other.text
    assert file != other
    again = pickle.loads(pickle.dumps(file))
    assert isinstance(again, File)
    assert again == file
    assert again.is_foreign
    workspace = Workspace({"a.xml": again}, Project())
    assert workspace.scope("a.xml").find(Kind.TREE, "T") is not None
    assert check(workspace, "a.xml") == check(Workspace({"a.xml": file}, Project()), "a.xml")


@pytest.mark.parametrize("xml", ["", "<", "<root>", "<Sequence/>", "<root/>", "<root><a/></root>", "text"])
def test_every_xml_is_answered(xml: str) -> None:
    for each in problems(xml):
        assert 0 <= each.span.start <= each.span.end <= len(xml)


OLD = """\
<root>
  <BehaviorTree ID="A"><SequenceStar><InitNeo4j/><Known/></SequenceStar></BehaviorTree>
  <BehaviorTree ID="B"><Known/></BehaviorTree>
  <TreeNodesModel><Action ID="Known"/></TreeNodesModel>
</root>
"""


def test_notes_on_xml_speak_of_xml() -> None:
    main = ("unknown-main-tree", ('name the main tree with `main_tree_to_execute="…"` of <root>',))
    shortest = '`<Action ID="InitNeo4j"/>` in <TreeNodesModel>'
    node = ("unknown-node", (f"the other nodes of this file have models; to declare this one, write {shortest}",))
    why = "SequenceStar is the name of SequenceWithMemory in version 3, where it begins again after a halt"
    said, *rest = problems(OLD)
    assert said.rule == "version-3-file"
    assert [(each.rule, each.notes) for each in rest] == [main, node]
    mixed = problems(OLD.replace("<Known/></BehaviorTree>", '<Known _skipIf="true"/></BehaviorTree>'))
    assert [(each.rule, each.notes) for each in mixed] == [main, ("not-an-engine-node", (why,)), node]
    new = problems(OLD.replace("<root>", '<root BTCPP_format="4">'))
    assert [(each.rule, each.notes) for each in new] == [main, ("not-an-engine-node", (why,)), node]

    choice = '<Fallback><Sequence><Condition ID="Low"/><Charge/></Sequence><Drive/></Fallback>'
    (found,) = problems(f'<root BTCPP_format="4"><BehaviorTree ID="Main">{choice}</BehaviorTree></root>')
    assert found.notes[0].startswith("`Fallback` resumes the running child; `<ReactiveFallback>` starts with the first")


def problems(xml: str) -> tuple[Diagnostic, ...]:
    return check(workspace_of({"a.xml": xml}), "a.xml")


def assert_clean_xml(xml: str) -> None:
    assert [(each.rule, each.message) for each in problems(xml)] == []


def test_what_only_newer_engines_refuse_says_how_to_name_an_older_one() -> None:
    text = """
        <root BTCPP_format="4" main_tree_to_execute="Fetch it">
          <BehaviorTree ID="Fetch it">
            <Sequence>
              <SubTree ID="Dock" name="a"/>
              <SubTree ID="Dock" name="a"/>
              <SubTree ID="Dock" name=""/>
            </Sequence>
          </BehaviorTree>
          <BehaviorTree ID="Dock">
            <ReactiveSequence><Action ID="Go" name="&#127;"/></ReactiveSequence>
          </BehaviorTree>
        </root>"""
    workspace = workspace_of({"main.xml": text.strip()})
    older = '4.6 accepts it: if you run that, set `engine = "4.6"` in btq.toml'
    assert [(each.rule, older in each.notes) for each in check(workspace, "main.xml")] == [
        ("forbidden-name", True),
        ("duplicate-instance-name", True),
        ("forbidden-name", True),
        ("explicit-in-reactive", True),
        ("forbidden-name", True),
    ]
    pinned = workspace.with_project(Project(engines=("4.6",)))
    assert [(each.rule, each.effective_severity) for each in check(pinned, "main.xml")] == [
        ("duplicate-instance-name", Severity.HINT)
    ]


def test_engines_before_4_9_take_strings_in_double_quotes() -> None:
    text = '<root BTCPP_format="4"><BehaviorTree ID="Main"><Script code="x := &quot;a&quot;"/></BehaviorTree></root>'
    workspace = workspace_of({"main.xml": text})
    (found,) = check(workspace, "main.xml")
    assert (found.rule, found.notes) == (
        "script-error",
        ('4.8 accepts it: if you run that, set `engine = "4.8"` in btq.toml',),
    )
    assert check(workspace.with_project(Project(engines=("4.6", "4.8"))), "main.xml") == ()
    unclosed = workspace_of({"main.xml": text.replace("a&quot;", "a")})
    (found,) = check(unclosed.with_project(Project(engines=("4.6",))), "main.xml")
    assert (found.rule, found.notes) == ("script-error", ())


def test_of_models_that_differ_no_port_is_unknown() -> None:
    assert_problems(
        """
        //- main.xml
        <root BTCPP_format="4">
          <include path="a.xml"/>
          <include path="b.xml"/>
          <BehaviorTree ID="Main">
            <Sequence><Go goal="1" speed="1"/><Go goal="1" sped="1"/></Sequence>
          </BehaviorTree>
        </root>
        //- a.xml
        <root BTCPP_format="4"><TreeNodesModel>
          <Action ID="Go"><input_port name="goal"/></Action>
        </TreeNodesModel></root>
        //- b.xml
        <root BTCPP_format="4"><TreeNodesModel>
          <Action ID="Go"><input_port name="goal"/><input_port name="speed"/></Action>
        </TreeNodesModel></root>
        """,
        "main.xml:3:18 warning duplicate-definition «b.xml» this file includes a second definition of the node model "
        "`Go`",
        "main.xml:5:52 error unknown-port «sped» `Go` has no port `sped`; did you mean `speed`?",
    )


def test_an_input_that_no_node_of_its_kind_has_is_optional_in_xml() -> None:
    text = """
        //- main.xml
        <root BTCPP_format="4">
          <BehaviorTree ID="Main"><Sequence>{}</Sequence></BehaviorTree>
          <TreeNodesModel>
            <Action ID="Go"><input_port name="goal"/><input_port name="server"/></Action>
          </TreeNodesModel>
        </root>
        """
    told = "2:38 warning missing-port «Go» `Go` requires {}"
    assert_problems(text.format("<Go/>"), told.format("values for its ports `goal` and `server`"))
    assert_problems(text.format('<Go/><Go goal="1"/>'), told.format("a value for its port `goal`"))
    assert_problems(text.format("<Go/><Go/>"))
