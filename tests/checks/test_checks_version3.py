"""Files for version 3 of the engine: how they are recognized, and that they are checked as version 3 reads them."""

from __future__ import annotations

from pathlib import Path

import pytest
from in_process import run_btq

from btq_lang.btcpp.opening import file_of
from btq_lang.catalog.nav2 import PACKAGED
from btq_lang.checks import check, lookups
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace

IDIOMS = """\
<root main_tree_to_execute="Main">
  <BehaviorTree ID="Main">
    <SequenceStar>
      <Find dock="dock" at="${pose}"/>
      <Parallel success_threshold="1" failure_threshold="1"><Find/></Parallel>
      <BlackboardCheckInt value_A="{a}" value_B="1"><Find/></BlackboardCheckInt>
      <SubTree ID="Go on" name="one" to="dock" __shared_blackboard="true"/>
      <SubTreePlus ID="Go on" name="one" __autoremap="1"/>
      <Sequence ID="x"><Find/></Sequence>
    </SequenceStar>
  </BehaviorTree>
  <BehaviorTree ID="Go on"><Find at="{to}"/></BehaviorTree>
  <TreeNodesModel>
    <Action ID="Find"><output_port name="dock"/><input_port name="at" default="0"/></Action>
    <SubTree ID="Go on"><input_port name="to"/></SubTree>
  </TreeNodesModel>
</root>
"""
SAID = (
    "1:2 warning version-3-file this file is for version 3 of the engine: it has `SequenceStar`, `success_threshold`, "
    "`failure_threshold`, `BlackboardCheckInt` …"
)
PATHS = "8:37 hint duplicate-instance-name two nodes of this tree have the name `one`: logs show the same path for both"


def found(xml: str, project: Project | None = None) -> list[Diagnostic]:
    project = project or Project()
    nodes = {path: file_of(path, Path(path).read_text(encoding="utf-8")) for path in project.node_files}
    return list(check(Workspace({**nodes, "main.xml": file_of("main.xml", xml)}, project), "main.xml"))


def shown(xml: str, project: Project | None = None) -> list[str]:
    def place(each: Diagnostic) -> str:
        before = xml[: each.span.start]
        return f"{before.count(chr(10)) + 1}:{len(before) - before.rfind(chr(10))}"

    return [f"{place(each)} {each.effective_severity.value} {each.rule} {each.message}" for each in found(xml, project)]


def test_a_file_for_version_3_is_said_to_be_one_and_checked_as_one() -> None:
    assert shown(IDIOMS) == [SAID, PATHS]
    said, _ = found(IDIOMS)
    assert said.notes == (
        'if the robot runs version 3, write `engine = "3.8"` or `nodes = ["nav2-humble"]` into btq.toml',
        "`btq check --target 4.10` finds what version 4 refuses or takes otherwise, and `btq import` translates the "
        "file",
    )


@pytest.mark.parametrize(
    "project", [Project(engines=("3.8",)), Project(node_files=(PACKAGED["nav2-humble"],))], ids=["engine", "nodes"]
)
def test_a_project_that_says_so_hears_nothing_of_it(project: Project) -> None:
    assert shown(IDIOMS, project) == [PATHS]


def test_a_project_for_a_version_4_hears_that_it_is_refused() -> None:
    project = Project(engines=("4.8",))
    assert shown(IDIOMS, project) == [
        SAID.replace("warning", "error") + ", but btq.toml names 4.8",
        PATHS,
    ]


@pytest.mark.parametrize("new", ['BTCPP_format="4"', "_skipIf", "Script", "_autoremap"])
def test_a_file_with_something_new_is_for_version_4(new: str) -> None:
    root = f"<root {new}>" if "=" in new else "<root>"
    node = "<Script code='x:=1'/>" if new == "Script" else f"<AlwaysSuccess {new}='true'/>" if new[0] == "_" else "<A/>"
    xml = f'{root}<BehaviorTree ID="Main"><SequenceStar>{node}</SequenceStar></BehaviorTree></root>'
    rules = [each.rule for each in found(xml)]
    assert "not-an-engine-node" in rules
    assert "version-3-file" not in rules


@pytest.mark.parametrize(
    ("root", "rules"),
    [("<root>", []), ('<root BTCPP_format="3">', ["version-3-file"]), ("<root BTCPP_format='5'>", [])],
)
def test_a_file_without_a_word_of_version_3_is_for_it_if_it_says_so(root: str, rules: list[str]) -> None:
    assert [
        each.rule for each in found(f'{root}<BehaviorTree ID="Main"><Sequence><A/></Sequence></BehaviorTree></root>')
    ] == rules


def test_what_version_3_refuses() -> None:
    xml = """\
<root>
  <BehaviorTree ID="Main">
    <Sequence>
      <Script code="x := 1"/>
      <Parallel success_count="1"><Wait _skipIf="x" _description="y"/></Parallel>
      <RetryUntilSuccesful num_attempts="2"><Wait/></RetryUntilSuccesful>
    </Sequence>
  </BehaviorTree>
</root>
"""
    assert shown(xml, Project(engines=("3.8",))) == [
        "4:8 error newer-engine-node `Script` requires BehaviorTree.CPP 4; 3.8 does not have it",
        "5:17 error unknown-port `Parallel` has no port `success_count`",
        "5:41 error unknown-attribute 3.8 takes `_skipIf` for a port, and refuses `Wait`",
        "6:8 warning not-an-engine-node `RetryUntilSuccesful` is not built into BehaviorTree.CPP 4.6–4.10",
    ]


OF_4 = """\
<root{}>
  <BehaviorTree ID="Main">
    <Sequence>
      <Script code="x := 1"/>
      <Parallel success_count="1"><Wait _skipIf="x == 1"/><Spin/></Parallel>
      {}
    </Sequence>
  </BehaviorTree>
</root>
"""


@pytest.mark.parametrize("declared", ["", ' BTCPP_format="4"', " BTCPP_format='5'"])
def test_a_file_for_version_4_in_a_project_of_version_3(declared: str) -> None:
    xml, message = OF_4.format(declared, ""), "1:2 error version-4-file this file is for version 4 of the engine, but"
    assert shown(xml, Project(engines=("3.8",))) == [f"{message} btq.toml names 3.8"]
    ignoring = Project(engines=("3.8",), ignore=("version-4-file",))
    rules = ["newer-engine-node", "unknown-port", "unknown-attribute"]
    assert [line.split()[2] for line in shown(xml, ignoring)] == rules
    one = xml.replace("success_count", "success_threshold").replace(' _skipIf="x == 1"', "")
    assert [line.split()[2] for line in shown(one, Project(engines=("3.8",)))] == ["newer-engine-node"]


def test_a_folder_of_files_that_contradict_the_distribution(tmp_path: Path) -> None:
    (tmp_path / "btq.toml").write_text('nodes = ["nav2-humble"]\n')
    for name in ("a", "b"):
        more = '<FollowPath path="{p}" error_code_id="{e}"/><Spin error_code_id="{e}"/>'
        (tmp_path / f"{name}.xml").write_text(OF_4.format(' BTCPP_format="4"', more))
    _, out, _ = run_btq("check", "--output-format", "concise", cwd=tmp_path)
    message = "1:2: error[version-4-file] this file is for version 4 of the engine, but Humble has 3.8.7"
    assert out.splitlines() == [f"a.xml:{message}", f"b.xml:{message}", "Found 2 errors"]


def test_nothing_is_built_for_version_3(tmp_path: Path) -> None:
    (tmp_path / "btq.toml").write_text('engine = "3.8"\n')
    (tmp_path / "main.btq").write_text("BehaviorTree Main\n    AlwaysSuccess\n")
    code, _, err = run_btq("build", cwd=tmp_path)
    assert (code, err) == (
        2,
        "btq build: btq writes XML for version 4 of the engine, and btq.toml names an older one: choose one with "
        "--target\n",
    )
    assert run_btq("build", "--target", "4.8", cwd=tmp_path)[0] == 0
    code, out, _ = run_btq("schema", "xsd", cwd=tmp_path)
    assert code == 0
    assert 'name="AlwaysSuccess"' in out


def test_what_is_looked_up_is_of_the_version_of_the_file() -> None:
    """Two files of a project that names no version: one is for version 3."""
    loop = (
        '<root {}><BehaviorTree ID="Tray?"><LoopInt queue="{{q}}" value="{{v}}"><Say text="{{q}}"/></LoopInt>'
        '</BehaviorTree><TreeNodesModel><Action ID="Say"><input_port name="text" type="std::string"/></Action>'
        "</TreeNodesModel></root>"
    )
    texts = {"old.xml": loop.format('BTCPP_format="3"'), "new.xml": loop.format('BTCPP_format="4"')}
    workspace = Workspace({path: file_of(path, text) for path, text in texts.items()}, Project())
    views = {path: View(workspace.store, path) for path in texts}
    assert {path: view.target for path, view in views.items()} == {"old.xml": "3.8", "new.xml": "4.10"}
    types, texts_below, taken = {}, {}, {}
    for path, view in views.items():
        types[path] = [type_ for *_, type_ in view.ask(lookups.types_below, "Tray?", "q", view.target)]
        text = view.ask(lookups.text_below, "Tray?", "q", view.target)
        texts_below[path] = text[1:] if text is not None else None
        taken[path] = [name for name, owner in view.ask(lookups.taken_names, "", view.target).items() if "?" in owner]
    queue = "std::shared_ptr<std::deque<int, std::allocator<int> > >"
    assert types == {"old.xml": [queue, "std::string"], "new.xml": ["std::string"]}
    assert texts_below == {"old.xml": ("text", "Say"), "new.xml": ("text", "Say")}
    assert taken == {"old.xml": ["Tray?"], "new.xml": ["Tray"]}
