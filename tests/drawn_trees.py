"""Random trees of up to twelve nodes."""

from __future__ import annotations

from collections.abc import Sequence
from random import Random

CONTROLS = (
    *("Sequence", "Fallback", "ReactiveSequence", "ReactiveFallback", "SequenceWithMemory", "AsyncSequence"),
    *("IfThenElse", "WhileDoElse", "ParallelAll", "Switch2", "TryCatch", "Parallel"),
)
CHILDREN = {"Switch2": (3, 3), "IfThenElse": (2, 3), "WhileDoElse": (2, 3), "TryCatch": (2, 3)}
DECORATORS = (
    *("Inverter", "ForceSuccess", "ForceFailure", "KeepRunningUntilFailure", "RunOnce"),
    *('RetryUntilSuccessful num_attempts="2"', 'Repeat num_cycles="2"', 'Timeout msec="100"', 'Delay delay_msec="100"'),
    'Precondition if="x &gt; 2" else="FAILURE"',
)
LEAVES = (
    *("Act", "Act", "Cond", "Do", 'Act out="{x}"', 'Cond out="{y}"', 'Do a="{z}"', 'Act in="{y}"'),
    *('Script code="x := 1"', 'Script code="y := x"', 'ScriptCondition code="x &gt; 2"'),
    *("AlwaysSuccess", "AlwaysFailure"),
    *('ScriptCondition code="x == y"', 'ScriptCondition code="y &lt; 5 &amp;&amp; y &gt; 1"', 'Sleep msec="5"'),
    *('SetBlackboard value="{x}" output_key="y"', 'Act _skipIf="x == 1"', 'Act _while="y != 3"'),
)


def drawn(
    random: Random,
    controls: Sequence[str] = CONTROLS,
    decorators: Sequence[str] = DECORATORS,
    leaves: Sequence[str] = LEAVES,
) -> str:
    """The XML of a tree of some kinds of nodes."""
    left = random.randint(2, 12)

    def node(depth: int) -> str:
        nonlocal left
        left -= 1
        if left <= 0 or depth > 4 or (depth and random.random() < 0.35):
            return f"<{random.choice(leaves)}/>"
        if random.random() < 0.35:
            start = random.choice(decorators)
            return f"<{start}>{node(depth + 1)}</{start.split()[0]}>"
        tag = random.choice(controls)
        name = tag.split()[0]
        number = random.randint(*CHILDREN.get(name, (1, 3)))
        ports = ' variable="{x}" case_1="1" case_2="4"' if tag == "Switch2" else ""
        return f"<{tag}{ports}>{''.join(node(depth + 1) for _ in range(number))}</{name}>"

    return f'<root BTCPP_format="4"><BehaviorTree ID="Main">{node(0)}</BehaviorTree></root>'
