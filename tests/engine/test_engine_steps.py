"""What `btq check --target` says of the engine's own versions is what 4.6 and 4.10 do."""

from __future__ import annotations

from collections.abc import Callable

from engine_loader import Answer, Engine

from btq_lang.catalog.engine_changes import ENGINE_CHANGES
from btq_lang.catalog.versions import at_least

ROOT = '<root BTCPP_format="4"><BehaviorTree ID="Main">{}</BehaviorTree></root>'
# `go` is true until the second tick.
BESIDE = (
    '<Sequence><Script code="go := true"/><Parallel success_count="2" failure_count="1">{}<Sequence>'
    '<Action ID="Two" name="two"/><Script code="go := false"/></Sequence></Parallel></Sequence>'
)
PARTS = {"two": ["RUNNING", "SUCCESS"], "long": ["RUNNING", "RUNNING", "RUNNING", "RUNNING", "SUCCESS"]}
ONE, LONG = "<AlwaysSuccess/>", '<Action ID="Long" name="long"/>'
WHILE = LONG.replace("/>", ' _while="go"/>')


def ended(answer: Answer) -> object:
    return answer.status


def ticked(answer: Answer) -> object:
    return answer.ticks


def halted(answer: Answer) -> object:
    return "IDLE" in answer.statuses("long")


# By the row's first release, its first node and its port: the tree, what to look at, and that in 4.6 and in 4.10.
SEEN: dict[tuple[str, str, str], tuple[str, Callable[[Answer], object], object, object]] = {
    ("4.7", "Repeat", "num_cycles"): (f'<Repeat num_cycles="0">{ONE}</Repeat>', ended, "SKIPPED", "SUCCESS"),
    ("4.7", "RetryUntilSuccessful", "num_attempts"): (
        f'<RetryUntilSuccessful num_attempts="0">{ONE}</RetryUntilSuccessful>',
        ended,
        "SKIPPED",
        "FAILURE",
    ),
    ("4.7", "Sequence", ""): (
        BESIDE.format(f"<Inverter><Sequence>{WHILE}</Sequence></Inverter>"),
        ended,
        "FAILURE",
        "RUNNING",
    ),
    ("4.7", "Precondition", ""): (
        BESIDE.format(f'<Precondition if="go">{LONG}</Precondition>'),
        ended,
        "FAILURE",
        "SUCCESS",
    ),
    ("4.7", "LoopInt", "queue"): (
        f'<Repeat num_cycles="2"><LoopInt queue="1;2" value="{{v}}">{ONE}</LoopInt></Repeat>',
        ticked,
        3,
        5,
    ),
    ("4.9", "SkipUnlessUpdated", ""): (
        '<Sequence><Script code="e := 1"/>'
        + BESIDE.format(f'<SkipUnlessUpdated entry="e" _while="go">{LONG}</SkipUnlessUpdated>')
        + "</Sequence>",
        halted,
        False,
        True,
    ),
    **{
        ("4.10", "Switch2", f"case_{case}"): (
            '<Switch6 variable="5" {}>{}</Switch6>'.format(
                " ".join(f'case_{each}="{"5abc" if each == case else "x"}"' for each in range(1, 7)),
                "".join(ONE if each == case else "<AlwaysFailure/>" for each in range(1, 8)),
            ),
            ended,
            "SUCCESS",
            "FAILURE",
        )
        for case in range(1, 7)
    },
}
# Between two versions that are not installed here: 4.8.3 and 4.9.
NOT_SEEN = {("4.8.3", "Delay", ""), ("4.9", "Delay", "")}


def test_each_row_is_what_the_engine_does(engine: Engine) -> None:
    for row, (tree, look, before, after) in SEEN.items():
        answer = engine.run_one(ROOT.format(tree), parts=PARTS, ticks=6)
        assert look(answer) == (after if at_least(engine.version, row[0]) else before), (row, answer)


def test_every_row_between_the_two_is_seen() -> None:
    rows = {(row.since, row.nodes[0], row.port) for row in ENGINE_CHANGES if at_least(row.since, "4.6.3")}
    assert rows == SEEN.keys() | NOT_SEEN
