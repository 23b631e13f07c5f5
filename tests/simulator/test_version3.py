"""What version 3 of the engine does otherwise than version 4; each was seen in runs of 3.8.7 or read in its sources."""

from __future__ import annotations

import pytest
from simulated import Skills, ticked

from btq_lang.simulator.errors import NotModelled
from btq_lang.simulator.versions import Dialect

OLD = Dialect("3.8.7")
TWO: Skills = {"a": [[0, "S", {}]], "b": [[9, "S", {}]]}


@pytest.mark.parametrize(
    ("tree", "skills", "entries", "letters"),
    [
        ('<Repeat num_cycles="3"><AlwaysSuccess/></Repeat>', {}, {}, "SSSSSS"),
        ('<RetryUntilSuccessful num_attempts="0"><AlwaysSuccess/></RetryUntilSuccessful>', {}, {}, "FFFFFF"),
        ("<SequenceStar><AlwaysSuccess/><AlwaysSuccess/></SequenceStar>", {}, {}, "SSSSSS"),
        # It goes on at the child that failed, but from the first one when it was halted.
        (
            '<SequenceStar><Act name="a"/><Act name="b"/></SequenceStar>',
            {"a": [[1, "S", {}]], "b": [[0, "F", {}], [0, "S", {}]]},
            {},
            "RFSRFS",
        ),
        (
            '<ReactiveSequence><Cond name="c"/><SequenceStar><Act name="a"/><Act name="b"/></SequenceStar>'
            "</ReactiveSequence>",
            {"a": [[1, "S", {}]], "b": [[1, "S", {}]], "c": [[0, "S", {}], [0, "S", {}], [0, "F", {}]]},
            {},
            "RRFRRF",
        ),
        (
            '<Parallel success_threshold="2"><Act name="a"/><Act name="b"/><AlwaysSuccess/></Parallel>',
            TWO,
            {},
            "SSSSSS",
        ),
        ('<Parallel success_threshold="-1"><Act name="a"/><Act name="b"/></Parallel>', TWO, {}, "RRRRRR"),
        ('<Parallel success_threshold="1"><Act name="b"/><AlwaysFailure/></Parallel>', TWO, {}, "FFFFFF"),
        (
            '<Parallel success_threshold="1" failure_threshold="2"><Act name="b"/><AlwaysFailure/></Parallel>',
            TWO,
            {},
            "RRRRRR",
        ),
        (
            '<Parallel success_threshold="2"><AlwaysSuccess/></Parallel>',
            {},
            {},
            " Number of children is less than threshold. Can never succeed.",
        ),
        ("<Parallel><AlwaysSuccess/></Parallel>", {}, {}, " Missing parameter [success_threshold] in ParallelNode"),
        ("<WhileDoElse><AlwaysSuccess/><AlwaysSuccess/></WhileDoElse>", {}, {}, " WhileDoElse must have 3 children"),
        (
            '<Switch2 variable="{x}" case_1="1" case_2="1.0"><AlwaysFailure/><AlwaysSuccess/><AlwaysFailure/>'
            "</Switch2>",
            {},
            {"x": "1.0"},
            "SSSSSS",
        ),
        (
            '<Sequence _skipIf="true"><AlwaysSuccess/></Sequence>',
            {},
            {},
            ' Possible typo? In the XML, you tried to remap port "_skipIf" in node [Sequence / Sequence], '
            "but the manifest of this node does not contain a port with this name.",
        ),
    ],
)
def test_what_the_root_returns(tree: str, skills: Skills, entries: dict[str, str], letters: str) -> None:
    assert ticked(tree, OLD, skills, entries) == letters


@pytest.mark.parametrize(
    ("type_", "first", "second", "letters"),
    [
        ("String", "1", "1.0", "FFFFFF"),
        ("Int", "01", "1", "SSSSSS"),
        ("Double", "1.00000001", "1", "SSSSSS"),
        ("Bool", "1", "true", "SSSSSS"),
        ("Int", "one", "one", "FFFFFF"),
    ],
)
def test_checks_of_entries(type_: str, first: str, second: str, letters: str) -> None:
    check = f'<BlackboardCheck{type_} value_A="{{x}}" value_B="{second}"><AlwaysSuccess/></BlackboardCheck{type_}>'
    assert ticked(check, OLD, {}, {"x": first}) == letters


def test_a_check_halts_its_child() -> None:
    tree = (
        '<Parallel success_threshold="2"><BlackboardCheckString value_A="{x}" value_B="1"><Act name="b"/>'
        '</BlackboardCheckString><Sequence><Act name="a"/><SetBlackboard output_key="x" value="2"/></Sequence>'
        "</Parallel>"
    )
    assert ticked(tree, OLD, {"a": [[1, "S", {}]], "b": [[9, "S", {}]]}, {"x": "1"}) == "RRFFFF"


@pytest.mark.parametrize(
    ("subtree", "letters"),
    [
        ('<SubTree ID="Sub" x="y"/>', "SSSSSS"),
        ('<SubTree ID="Sub" x="{y}"/>', "FFFFFF"),
        ('<SubTree ID="Sub"/>', "FFFFFF"),
        ('<SubTree ID="Sub" __shared_blackboard="true"/>', "FFFFFF"),
        ('<SubTreePlus ID="Sub" x="{y}"/>', "SSSSSS"),
        ('<SubTreePlus ID="Sub" x="7"/>', "SSSSSS"),
        ('<SubTreePlus ID="Sub" x="y"/>', "FFFFFF"),
        ('<SubTreePlus ID="Sub" __autoremap="true"/>', "FFFFFF"),
    ],
)
def test_entries_of_subtrees(subtree: str, letters: str) -> None:
    check = '<BlackboardCheckString value_A="{x}" value_B="7"><AlwaysSuccess/></BlackboardCheckString>'
    trees = f'{subtree}</BehaviorTree><BehaviorTree ID="Sub">{check}'
    assert ticked(trees, OLD, {}, {"x": "1", "y": "7"}) == letters


def test_what_is_not_modelled() -> None:
    with pytest.raises(NotModelled, match="what Timeout does with its children is unknown"):
        ticked('<Timeout msec="10"><AlwaysSuccess/></Timeout>', OLD, {})
