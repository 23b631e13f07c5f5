"""The changes of the engine's releases for trees that load in an earlier one too: one row a change.

What a release refuses, and what it reads otherwise, are rows of `versions`; the nodes that it adds or removes say so
themselves.  Determined in the sources of the releases, and seen in those before and after each change by
`tests/engine/test_engine_steps.py`.
"""

from __future__ import annotations

from typing import Final

from btq_lang.catalog.versions import BehaviorChange

_IN_TURN: Final = ("Sequence", "AsyncSequence", "SequenceWithMemory", "Fallback", "AsyncFallback")
_LOOPS: Final = ("LoopInt", "LoopBool", "LoopDouble", "LoopString")
_SWITCHES: Final = tuple(f"Switch{cases}" for cases in range(2, 7))
_WITHOUT_CYCLE: Final = (
    ("Repeat", "num_cycles", "succeeded", "succeeds"),
    ("RetryUntilSuccessful", "num_attempts", "failed", "fails"),
)
_WATCHES: Final = ("SkipUnlessUpdated", "WaitValueUpdate")
_NUMBER: Final = r"-?\d+(\.\d*)?([eE][-+]?\d+)?"


def _cases(since: str, effect: str, value: str, after: str = "") -> tuple[BehaviorChange, ...]:
    instead = "write the cases and the variable in one form"
    ports = (f"case_{number}" for number in range(1, 7))
    return tuple(BehaviorChange(since, _SWITCHES, effect, instead, port, value, after=after) for port in ports)


# Releases of the line 4.8, so that a file for that line meets it without moving on.
NO_DELAY: Final = BehaviorChange(
    "4.8.3",
    ("Delay",),
    "does not wait: 4.8.3 and 4.8.4 do not read `delay_msec`",
    "put a Sleep before the child",
    until="4.9",
)
# Up to 4.6 it is a trap, so that a file for these meets it without moving on.
COPY_IS_UPDATE: Final = BehaviorChange(
    "4.7",
    ("SetBlackboard",),
    "is an update where it copies an entry; before, no node noticed that",
    "look at what waits for the update",
    "value",
    r"\{.*\}",
    when="watched",
)

ENGINE_CHANGES: Final = (
    BehaviorChange(
        "3.8.6",
        ("ReactiveSequence", "ReactiveFallback"),
        "resets the children before the one that runs too: they begin again, and halt it from 3.8.7 on; before, they "
        "did not",
        "let only the last child take several ticks",
        when="restarts",
    ),
    BehaviorChange(
        "4.0",
        ("Repeat", "RetryUntilSuccessful"),
        "returns RUNNING between two cycles; before, all cycles of a child that completes at once were one tick",
        "write a node of your own for what must be done in one tick",
        when="completes at once",
    ),
    *(
        BehaviorChange(
            "4.1",
            (node,),
            f"is skipped if it has no cycle; before, it {then}",
            f"write Always{'Success' if then == 'succeeded' else 'Failure'} in its place",
            port,
            "0",
            until="4.7",
        )
        for node, port, then, _ in _WITHOUT_CYCLE
    ),
    *(
        BehaviorChange(
            "4.7",
            (node,),
            f"{now} if it has no cycle; before, it was skipped",
            "remove it, or write `_skipIf` on it",
            port,
            "0",
            after="4.1",
        )
        for node, port, _, now in _WITHOUT_CYCLE
    ),
    *_cases("4.5.1", "compares numbers as numbers, so that `5` is also `5.0`; before, only their texts", _NUMBER),
    *_cases(
        "4.10",
        "compares a case such as `5abc` as text; before, only its number at the beginning",
        rf"(?!{_NUMBER}$)-?\d.*",
        after="4.5.1",
    ),
    BehaviorChange(
        "4.7",
        _IN_TURN,
        "is skipped if all its children are skipped in the end, also where one has run before that; before, a Sequence "
        "then succeeded, and a Fallback failed",
        "end it with a child that is never skipped: `AlwaysSuccess`, or `AlwaysFailure` in a Fallback",
        when="skipped in the end",
    ),
    BehaviorChange(
        "4.7",
        ("Precondition",),
        "checks `if` only before its child starts; before, at every tick, and it halted the child",
        "put a ScriptCondition before the child, in a ReactiveSequence",
        when="runs on",
    ),
    BehaviorChange(
        "4.7",
        _LOOPS,
        "goes through a list at each start; before, only at the first, for it then was empty",
        "look at what starts it again",
        "queue",
        r"[^{].*",
    ),
    BehaviorChange(
        "4.9.1",
        _LOOPS,
        "goes through a list that a script has written at each start; before, only at the first, for it then was empty",
        "look at what starts it again",
        "queue",
        r"\{.*\}",
        when="queue of a script",
    ),
    NO_DELAY,
    COPY_IS_UPDATE,
    BehaviorChange(
        "4.9",
        ("Delay",),
        "waits for `delay_msec`, which 4.8.3 and 4.8.4 do not read",
        "remove it where nothing should wait",
        after="4.8.3",
    ),
    BehaviorChange(
        "4.9",
        _WATCHES,
        "halts its child when it is halted; before, the child stayed RUNNING, and went on from there",
        "put what should go on beside it, not below it",
        when="runs on",
    ),
)
