"""Trees of Nav2 as scenarios: its control nodes run, and the engine is that of the distribution."""

from __future__ import annotations

from pathlib import Path

import pytest
from in_process import run_btq

TREE = """\
<root {version}main_tree_to_execute="Navigate">
  <BehaviorTree ID="Navigate">
    <RecoveryNode number_of_retries="2" name="Recover">
      <PipelineSequence>
        <RateController hz="1.0">
          <ComputePathToPose goal="{{goal}}" path="{{path}}"/>
        </RateController>
        <FollowPath path="{{path}}"/>
      </PipelineSequence>
      <{sequence}>
        <Spin/>
        <Wait/>
      </{sequence}>
    </RecoveryNode>
  </BehaviorTree>
</root>
"""
CASES = """\
include "navigate.xml"

scenario "The controller fails once"
    given FollowPath fails after 2.5 s once, then succeeds after 4 s
    given Spin takes 3 s
    given Wait takes 1 s
    expect mission succeeds
    expect mission takes between 10.5 s and 10.6 s
    expect Spin tries at most 1

scenario "The path is computed each second"
    given FollowPath takes 3.5 s
    expect ComputePathToPose tries between 4 and 4

scenario "The controller fails again and again"
    given FollowPath fails after 1 s
    expect mission fails
"""


@pytest.mark.parametrize(
    ("nodes", "version", "sequence"),
    [
        ("humble", "", "SequenceStar"),
        ("jazzy", 'BTCPP_format="4" ', "SequenceWithMemory"),
        ("", 'BTCPP_format="4" ', "SequenceWithMemory"),
    ],
)
def test_recoveries(nodes: str, version: str, sequence: str, tmp_path: Path) -> None:
    if nodes:
        (tmp_path / "btq.toml").write_text(f'nodes = ["nav2-{nodes}"]\n', encoding="utf-8")
    (tmp_path / "navigate.xml").write_text(TREE.format(version=version, sequence=sequence), encoding="utf-8")
    (tmp_path / "cases.btq").write_text(CASES, encoding="utf-8")
    code, out, err = run_btq("test", "cases.btq", cwd=tmp_path)
    assert (code, err) == (0, ""), out
