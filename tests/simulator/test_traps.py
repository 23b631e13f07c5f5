"""What the engine does where people expect something else; each was seen in runs of 4.6.2 and 4.10.0."""

from __future__ import annotations

import pytest
from simulated import Skills, ticked

from btq_lang.simulator.versions import Dialect

OLD, NEW = Dialect("4.6"), Dialect("4.10")
FAILS: Skills = {"a": [[0, "F", {}]], "b": [[0, "F", {}]]}
FAILS_ONCE: Skills = {"a": [[0, "F", {}], [0, "S", {}]], "b": [[0, "S", {}]]}
LONG: Skills = {"a": [[2, "S", {}]], "b": [[2, "S", {}]]}
IDLE_SET = (
    "you are not allowed to set manually the status to IDLE. "
    "If you know what you are doing (?) use resetStatus() instead."
)


@pytest.mark.parametrize(
    ("tree", "skills", "old", "new"),
    [
        ('<IfThenElse><Act name="a"/><Act name="b"/></IfThenElse>', FAILS_ONCE, "FFFFFF", "FFFFFF"),
        ('<Sleep msec="150 s"/>', {}, "RRSRRS", "RRSRRS"),
        ('<IfThenElse><Cond name="a"/><Act name="b"/></IfThenElse>', FAILS_ONCE, "FSFSFS", "FSFSFS"),
        ('<ReactiveSequence><Act name="a"/><Act name="b"/></ReactiveSequence>', LONG, "RRRRRR", "RRRRRR"),
        (
            '<Parallel success_count="2"><AlwaysSuccess/><RunOnce _skipIf="true"><AlwaysFailure/></RunOnce></Parallel>',
            {},
            "RRRRRR",
            "RRRRRR",
        ),
        ('<Parallel><AlwaysSuccess _skipIf="true"/></Parallel>', {}, "SSSSSS", "SSSSSS"),
        ('<ParallelAll><AlwaysSuccess _skipIf="true"/></ParallelAll>', {}, "KKKKKK", "KKKKKK"),
        ('<Parallel failure_count="0"><Act name="a"/></Parallel>', LONG, "FFFFFF", "FFFFFF"),
        ('<ParallelAll max_failures="0"><AlwaysSuccess/></ParallelAll>', {}, "FFFFFF", "FFFFFF"),
        ('<Repeat num_cycles="0"><AlwaysSuccess/></Repeat>', {}, "KKKKKK", "SSSSSS"),
        ('<RetryUntilSuccessful num_attempts="0"><AlwaysSuccess/></RetryUntilSuccessful>', {}, "KKKKKK", "FFFFFF"),
        ("<AsyncSequence><AlwaysSuccess/><AlwaysSuccess/></AsyncSequence>", {}, "RSRSRS", "RSRSRS"),
        ('<Sequence><Act name="a" _skipIf="false"/></Sequence>', {"a": [[1, "K", {}]]}, "RSRSRS", "RKRKRK"),
        ('<LoopInt queue="1;2" value="{i}"><AlwaysSuccess/></LoopInt>', {}, "RRSSSS", "RRSRRS"),
        ('<KeepRunningUntilFailure><AlwaysSuccess _skipIf="true"/></KeepRunningUntilFailure>', {}, "RRRRRR", "RRRRRR"),
        ('<RunOnce><Cond name="a"/></RunOnce>', FAILS, "FKKKKK", "FKKKKK"),
        ('<RunOnce then_skip="false"><Cond name="a"/></RunOnce>', FAILS, "FFFFFF", "FFFFFF"),
    ],
)
def test_what_the_root_returns(tree: str, skills: Skills, old: str, new: str) -> None:
    assert (ticked(tree, OLD, skills), ticked(tree, NEW, skills)) == (old, new)


@pytest.mark.parametrize(
    ("tree", "entries", "old", "new"),
    [
        (
            '<WhileDoElse><AlwaysSuccess _skipIf="true"/><AlwaysSuccess/></WhileDoElse>',
            {},
            f" Node [WhileDoElse]: {IDLE_SET}",
            f" Node [WhileDoElse]: {IDLE_SET}",
        ),
        (
            '<IfThenElse><AlwaysSuccess _skipIf="true"/><AlwaysSuccess/></IfThenElse>',
            {},
            " Something unexpected happened in IfThenElseNode",
            " Exception in node 'IfThenElse::1' [IfThenElse]: Something unexpected happened in IfThenElseNode",
        ),
        (
            '<Parallel success_count="3"><AlwaysSuccess/></Parallel>',
            {},
            " Number of children is less than threshold. Can never succeed.",
            " Exception in node 'Parallel::1' [Parallel]: "
            "Number of children is less than threshold. Can never succeed.",
        ),
        (
            '<ScriptCondition code="(x == 1) || (y == 1)"/>',
            {"x": 1.0},
            " Error in script [(x == 1) || (y == 1)]\nVariable not found: y",
            " Exception in node 'ScriptCondition::1' [ScriptCondition]: "
            "Error in script [(x == 1) || (y == 1)]\nVariable not found: y",
        ),
        ('<ScriptCondition code="x == 1 ? x : y"/>', {"x": 1.0}, "SSSSSS", "SSSSSS"),
    ],
)
def test_what_is_thrown(tree: str, entries: dict[str, float], old: str, new: str) -> None:
    assert (ticked(tree, OLD, {}, entries), ticked(tree, NEW, {}, entries)) == (old, new)
