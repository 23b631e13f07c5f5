"""Random requirements about states, beside those of `random_runs`: they draw from a sequence of their own, so that the
missions, trees and logs of a seed are the same with and without them.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence


def of_states(
    chance: random.Random,
    labels: Sequence[str],
    condition: Callable[[random.Random], str],
    claim: Callable[[random.Random], str],
) -> list[str]:
    """A requirement or two about states, and perhaps one of any kind with an assumption.

    Args:
        labels: of nodes.
        condition, claim: draw one.
    """
    found = [_requirement(chance, f"s{number}", labels, condition) for number in range(chance.choice([1, 2]))]
    if chance.random() < 0.4:
        found.append(f"QualityReq assumed : safety\n    {claim(chance)}\n    assuming {_state(chance, condition)}")
        found[-1] += (
            f"\n    in at least 50 % of {chance.choice(['activations', 'runs'])}" if chance.random() < 0.3 else ""
        )
    return found


def _requirement(
    chance: random.Random, name: str, labels: Sequence[str], condition: Callable[[random.Random], str]
) -> str:
    subject = chance.choice([*labels, *labels, "mission", "Part"])
    state = _state(chance, condition)
    claim = chance.choice(
        [f"ends with {state}", f"keeps {state}", f"never {state} for more than {chance.randint(1, 12) / 4:g} s"]
    )
    lines = [f"QualityReq {name} : reliability", f"{subject} {claim}"]
    words = ("while", "when", "assuming")
    lines += [f"{word} {_state(chance, condition)}" for word in words if chance.random() < 0.15]
    if chance.random() < 0.3:
        of = chance.choice(["activations", "runs"])
        lines.append(f"in at least {chance.choice(['50 %', '80 %'])} of {of}")
        lines += [f"confidence {chance.choice(['60 %', '90 %'])}"] if chance.random() < 0.7 else []
    return "\n    ".join(lines)


def _state(chance: random.Random, condition: Callable[[random.Random], str]) -> str:
    return condition(chance) if chance.random() < 0.7 else _measured(chance, condition)


def _measured(chance: random.Random, condition: Callable[[random.Random], str]) -> str:
    """A signal compared with what depends on the situation, or its age with a time."""
    signal = chance.choice(["speed", "near", "state"])
    if chance.random() < 0.5:
        sign = chance.choice(["<=", "<=", "<", ">"])
        old = f"age({signal}) {sign} {chance.randint(0, 12) / 4:g} s"
        return old if chance.random() < 0.6 else f"({condition(chance)} or {old})"
    low, high = (chance.randint(0, 20) * 5 for _ in range(2))
    return f"battery >= ({low} % if {condition(chance)} else {high} %)"
