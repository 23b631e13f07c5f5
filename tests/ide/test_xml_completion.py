"""What is proposed in XML, and what accepting it makes of the text: `$0` is the cursor."""

from __future__ import annotations

import pytest

from btq_lang.btcpp.opening import file_of
from btq_lang.ide.completion import complete
from btq_lang.ide.proposals import Proposal
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace

OTHER = """\
<root BTCPP_format="4">
  <BehaviorTree ID="Other"><Custom/></BehaviorTree>
  <TreeNodesModel>
    <Action ID="Pick">
      <input_port name="from" type="std::string"/>
      <input_port name="force" type="double" default="1.5">newtons</input_port>
      <output_port name="held" type="bool"/>
    </Action>
  </TreeNodesModel>
</root>
"""
MAIN = """\
<root BTCPP_format="4">
  <include path="other.xml"/>
  <BehaviorTree ID="Main">
    <Sequence>
      <Script code="tries := 1"/>
      HERE
      <Pick from="{shelf}" held="{ok}"/>
    </Sequence>
  </BehaviorTree>
  <BehaviorTree ID="Dock"><Fallback><Pick from="{station}"/></Fallback></BehaviorTree>
  <TreeNodesModel>
    <SubTree ID="Dock"><input_port name="station"/></SubTree>
  </TreeNodesModel>
</root>
"""


def completed(here: str, text: str = MAIN) -> tuple[str, tuple[Proposal, ...], tuple[int, int]]:
    """The XML with a text at its place, what is proposed at the cursor, and the span that it replaces."""
    text = text.replace("HERE", here)
    offset = text.index("$0")
    xml = text.replace("$0", "")
    texts = {"main.xml": xml, "other.xml": OTHER}
    workspace = Workspace({path: file_of(path, each) for path, each in texts.items()}, Project())
    found = complete(workspace, "main.xml", offset)
    assert found.span.start <= offset <= found.span.end
    return xml, found.proposals, (found.span.start, found.span.end)


def labels(here: str, text: str = MAIN) -> list[str]:
    return [one.label for one in completed(here, text)[1]]


@pytest.mark.parametrize("here", ["<$0", "<Slee$0/>", "<Repeat><$0</Repeat>"])
def test_nodes_are_those_of_the_version_that_the_file_is_for(here: str) -> None:
    old = MAIN.replace('BTCPP_format="4"', 'BTCPP_format="3"').replace('<Script code="tries := 1"/>', "")
    assert {"Sleep", "TryCatch"} <= {*labels(here)}
    assert {"Sleep", "TryCatch"}.isdisjoint(labels(here, old))


@pytest.mark.parametrize(
    ("here", "offered", "absent"),
    [
        (
            "<$0",
            ("Pick", "Custom", "Sequence", "RetryUntilSuccessful", "SubTree", "Action"),
            ("->", "Retry", "input_port"),
        ),
        ("<Se$0", ("Pick", "Sequence"), ("Se",)),
        ("<Cust$0/>", ("Custom",), ("Cust",)),
        ("<Repeat><$0</Repeat>", ("Pick",), ()),
        ("<Pick $0/>", ("from", "force", "held", "name", "_skipIf"), ("_autoremap", "ID", "_description")),
        ('<Pick from="{shelf}" $0/>', ("force", "held"), ("from",)),
        ("<SubTree $0/>", ("ID", "_autoremap"), ()),
        ('<SubTree ID="Dock" $0/>', ("station", "_autoremap"), ("ID",)),
        ('<SubTree ID="$0"/>', ("Main", "Dock", "Other"), ("Pick",)),
        ('<Action ID="$0"/>', ("Pick", "Custom"), ("Main",)),
        ('<Pick from="$0"/>', ("{=}", "{shelf}", "{tries}", "{ok}"), ("{station}", "{}")),
        ('<Pick force="$0"/>', ("1.5",), ("true",)),
        ('<Pick from="{$0"/>', ("=", "shelf", "tries", "ok"), ("station", "from")),
        ('<Pick from="{sh$0}"/>', ("shelf",), ("sh",)),
        ('<Pick _skipIf="tries &gt; 3 &amp;&amp; o$0"/>', ("tries", "shelf", "ok", "true"), ("o", "=")),
        ('<SubTree ID="Dock" _autoremap="$0"/>', ("true", "false"), ()),
        ('<Precondition if="true" else="$0"/>', ("SUCCESS", "FAILURE"), ()),
        ("<Timeout></$0", ("Timeout",), ("Sequence",)),
    ],
)
def test_what_is_offered(here: str, offered: tuple[str, ...], absent: tuple[str, ...]) -> None:
    found = labels(here)
    assert [each for each in offered if each not in found] == []
    assert set(found).isdisjoint(absent)
    assert len(set(found)) == len(found)


@pytest.mark.parametrize(
    "here", ['<Pick name="$0"/>', "text$0", "<!-- $0 -->", '<Pick from="x"$0/>', "<Pick from=$0", "<Pick /$0>"]
)
def test_where_nothing_is(here: str) -> None:
    assert labels(here) == []


@pytest.mark.parametrize(
    ("text", "offered"),
    [
        ("<$0", ["root"]),
        ("<root $0></root>", ["BTCPP_format", "main_tree_to_execute"]),
        ('<root main_tree_to_execute="$0"><BehaviorTree ID="A"><B/></BehaviorTree></root>', ["A", "Other"]),
        ("<root><$0</root>", ["BehaviorTree", "include", "TreeNodesModel"]),
        ("<root><TreeNodesModel><$0", ["Action", "Condition", "Control", "Decorator", "SubTree"]),
        ("<root><TreeNodesModel><Action $0", ["ID"]),
        ('<root><TreeNodesModel><Action ID="A"><$0', ["input_port", "output_port", "inout_port"]),
        ("<root><TreeNodesModel><Action ID='A'><input_port $0", ["name", "type", "default"]),
        ('<root><include path="$0"/></root>', ["other.xml"]),
    ],
)
def test_the_frame_of_a_document(text: str, offered: list[str]) -> None:
    assert labels("", text) == offered


@pytest.mark.parametrize(
    ("here", "label", "plain", "snippet"),
    [
        ("<Pi$0", "Pick", "<Pick", '<Pick from="${1:{=\\}}"'),
        (
            "<Retr$0/>",
            "RetryUntilSuccessful",
            "<RetryUntilSuccessful/>",
            '<RetryUntilSuccessful num_attempts="${1:1}"/>',
        ),
        ("<Slee$0/>", "Sleep", "<Sleep/>", '<Sleep msec="${1:1000}"/>'),
        ("<Sub$0/>", "SubTree", "<SubTree/>", '<SubTree ID="$1"/>'),
        ("<Pick $0/>", "force", '<Pick force=""/>', '<Pick force="${0:1}"/>'),
        ("<Pick for$0='2'/>", "force", "<Pick force='2'/>", None),
        ('<Pick from="{s$0"/>', "shelf", '<Pick from="{shelf}"/>', None),
        ('<Pick from="{s$0}"/>', "shelf", '<Pick from="{shelf}"/>', None),
        ('<SubTree ID="Do$0"/>', "Dock", '<SubTree ID="Dock"/>', None),
        ('<SubTree ID="Do$0', "Dock", '<SubTree ID="Dock', None),
        ("<Timeout></T$0", "Timeout", "<Timeout></Timeout>", None),
        ("<Timeout></T$0>", "Timeout", "<Timeout></Timeout>", None),
    ],
)
def test_what_accepting_makes(here: str, label: str, plain: str, snippet: str | None) -> None:
    xml, found, (start, end) = completed(here)
    one = next(one for one in found if one.label == label)
    before, after = MAIN.split("HERE")
    assert xml[:start] + one.insert + xml[end:] == before + plain + after
    assert (None if one.snippet is None else xml[:start] + one.snippet + xml[end:]) == (
        None if snippet is None else before + snippet + after
    )


def test_the_types_and_defaults_of_ports_are_shown() -> None:
    _, found, _ = completed("<Pick $0/>")
    details = {one.label: one.detail for one in found if one.kind == "port"}
    assert details == {"from": "input : std::string", "force": "input : double = 1.5", "held": "output : bool"}


def test_xml_that_is_written_from_the_top() -> None:
    """Nothing is closed yet, and the names before it are known."""
    text = '<root BTCPP_format="4">\n<BehaviorTree ID="Main">\n<Sequence>\n<Script code="a := 1"/>'
    assert labels("", f'{text}\n<SetBlackboard value="{{$0') == ["=", "a"]


def test_xml_that_no_include_leads_to() -> None:
    """What another file of the project has is found without one."""
    texts = {"main.xml": '<root><BehaviorTree ID="A"><SubTree ID=""/></BehaviorTree></root>', "other.xml": OTHER}
    workspace = Workspace({path: file_of(path, each) for path, each in texts.items()}, Project())
    found = complete(workspace, "main.xml", texts["main.xml"].index('""') + 1)
    assert [(one.label, one.include) for one in found.proposals] == [("A", ""), ("Other", "")]
