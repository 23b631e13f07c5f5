"""`tries … per P` where the node never starts while P runs; and all that may run the two at the same time."""

from __future__ import annotations

from typing import Final

import pytest
from check_asserts import MAIN, problems, show

MISSION: Final = """\
Root Main
QualityReq few : reliability "Few attempts"
    {claim}
Action Find
Action Open
Control Both
BehaviorTree Main
    {top}
        Find
        Retry (num_attempts = 3)
            {body}
BehaviorTree Water
    ->
        Open
"""


def found(claim: str, top: str = "->", body: str = "SubTree Water", more: str = "") -> list[str]:
    text = MISSION.format(claim=claim, top=top, body=body) + more
    return show(text, problems(text, "impossible-bound"))


@pytest.mark.parametrize("bound", ["at most", "at least"])
def test_a_node_that_ends_before(bound: str) -> None:
    claim = f"Open tries {bound} 3 per Find"
    message = "`Open` never starts while `Find` runs, so nothing is counted"
    assert found(claim) == [f"3:5 warning impossible-bound «{claim}» {message}"]


def test_what_to_write() -> None:
    text = MISSION.format(claim="Open tries at most 3 per Find", top="->", body="SubTree Water")
    (problem,) = problems(text, "impossible-bound")
    assert problem.notes == ("after `per` goes a node that runs the other one, such as its tree: `per Water`",)
    assert [each.message for each in problem.related] == ["named by `per`"]


def test_the_other_way_round() -> None:
    claim = "Water tries at most 3 per Open"
    message = "`Water` never starts while `Open` runs, so nothing is counted"
    assert found(claim) == [f"3:5 warning impossible-bound «{claim}» {message}"]


@pytest.mark.parametrize("holder", ["Water", "Main", "Retry", "Open", "mission"])
def test_a_node_above(holder: str) -> None:
    assert found(f"Open tries at most 3 per {holder}") == []


@pytest.mark.parametrize("top", ["Parallel", "R->", "R?", "WhileDoElse", "Both", "Unknown"])
def test_a_node_that_may_run_at_the_same_time(top: str) -> None:
    assert found("Open tries at most 3 per Find", top) == []


@pytest.mark.parametrize("top", ["?", "SequenceWithMemory", "AsyncSequence", "IfThenElse"])
def test_nodes_one_after_the_other(top: str) -> None:
    assert len(found("Open tries at most 3 per Find", top)) == 1


@pytest.mark.parametrize("body", ["SubTree Other", "Water", "xml '<SubTree ID=\"Water\"/>'"])
def test_what_is_unknown(body: str) -> None:
    assert found("Open tries at most 3 per Find", body=body) == []


def test_another_tree_with_both() -> None:
    both = "BehaviorTree More\n    Parallel\n        {}\n        SubTree Water\n"
    assert found("Main/Find tries at most 3 per Open", more=both.format("SubTree Main")) == []
    assert len(found("Main/Find tries at most 3 per Open", more=both.format("Other"))) == 1


def test_a_file_that_another_one_includes() -> None:
    text = MISSION.format(claim="Open tries at most 3 per Find", top="->", body="SubTree Water")
    assert problems(text, "impossible-bound", more=f'include "{MAIN}"\n') == []
