"""Trees that no file of a project defines, because another package or the program itself provides them."""

from __future__ import annotations

from pathlib import Path

import pytest
from in_process import run_btq

XML = """\
<root BTCPP_format="4" main_tree_to_execute="Fetch Object">
  <BehaviorTree ID="Fetch Object">
    <Sequence>
      <SubTree ID="Move to Waypoint" waypoint="home"/>
      <SubTree ID="Open Gripper"/>
      <SubTree ID="Opn Gripper"/>
      <Script code=" name := 'a' "/>
    </Sequence>
  </BehaviorTree>
  <BehaviorTree ID="Open Gripper"><AlwaysSuccess/></BehaviorTree>
</root>
"""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    (tmp_path / "fetch.xml").write_text(XML)
    return tmp_path


def found(project: Path, settings: str, *words: str) -> list[str]:
    (project / "btq.toml").write_text(settings)
    _, out, _ = run_btq("check", "--output-format", "concise", *words, cwd=project)
    return out.splitlines()[:-1]


MISSPELT = "fetch.xml:6:20: error[unknown-tree] unknown tree `Opn Gripper`; did you mean `Open Gripper`?"


def test_named_trees_of_another_package(project: Path) -> None:
    at = "fetch.xml:4:20: error[unknown-tree]"
    nowhere = f"{at} unknown tree `Move to Waypoint`; no file of the project defines it"
    assert found(project, 'engine = "4.6"\n') == [nowhere, MISSPELT]
    assert found(project, 'engine = "4.6"\nexternal = ["Move to Waypoint"]\n') == [MISSPELT]


def test_names_that_need_not_be_there(project: Path) -> None:
    settings = 'engine = "4.6"\nexternal = [\n    "Move to Waypoint", "Gone",\n    "Open Gripper",\n]\n'
    unused = [
        "btq.toml:3:25: hint[unknown-tree] `Gone` need not be in `external`: no SubTree of the project runs it",
        "btq.toml:4:5: hint[unknown-tree] `Open Gripper` need not be in `external`: a file of the project defines it",
    ]
    assert found(project, settings) == [*unused, MISSPELT]
    assert found(project, settings, "fetch.xml") == found(project, settings, "--severity", "error") == [MISSPELT]
    assert found(project, f'ignore = ["unknown-tree"]\n{settings}') == []


def test_all_trees_of_moveit_pro(project: Path) -> None:
    message = "unknown tree `Opn Gripper`; did you mean `Open Gripper`?"
    assert found(project, 'engine = "moveit-pro"\n') == [f"fetch.xml:6:20: hint[unknown-tree] {message}"]


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ('"moveit"', "unknown engine version `moveit`;"),
        ('"moveit_pro"', "unknown engine version `moveit_pro`; did you mean `moveit-pro`?"),
    ],
)
def test_another_name_of_a_program(project: Path, value: str, message: str) -> None:
    (project / "btq.toml").write_text(f"engine = {value}\n")
    _, _, err = run_btq("check", cwd=project)
    assert f"btq.toml:1:10: {message}" in err
