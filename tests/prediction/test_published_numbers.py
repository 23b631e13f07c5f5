"""Probabilities that others published of fetching and carrying, which runs must meet within four standard deviations.

In the tutorial of AS2FM a robot navigates with 0.7, picks with 0.6, and places always.
"""

from __future__ import annotations

from fractions import Fraction
from math import sqrt

import pytest
from test_drawn_runs import mission_of, with_settings

from btq_lang.workspace.config import Project
from btq_lang.workspace.workspace import Workspace

NAVIGATE, PICK = Fraction(7, 10), Fraction(6, 10)
SKILLS = """
[simulate.skills]
Navigate = { takes = ["1 s", "3 s"], succeeds = "70 %" }
Pick = { takes = "2 s", succeeds = "60 %" }
Place = { takes = "1 s" }
"""
LEAVES = "Action Navigate\nAction Pick\nAction Place\n"
FETCH = ("Navigate", "Pick", "Navigate", "Place")
RUNS = 4_000


def with_memory(attempts: int) -> Fraction:
    """That all four succeed in their order, where only the one that failed is tried again."""
    sure = Fraction(1)
    chances = [NAVIGATE, PICK, NAVIGATE, sure]
    left = {0: sure}  # how likely it is that so many failures have been
    for chance in chances:
        after: dict[int, Fraction] = {}
        for failures, likely in left.items():
            for more in range(attempts - failures):
                part = likely * (1 - chance) ** more * chance
                after[failures + more] = after.get(failures + more, Fraction(0)) + part
        left = after
    return sum(left.values(), Fraction(0))


def succeeded(tree: str) -> int:
    text = f"Root Fetch\n{LEAVES}BehaviorTree Fetch\n{tree}"
    mission = with_settings(mission_of(Workspace.of({"m.btq": text}, Project()), "m.btq"), SKILLS)
    return sum(mission.loaded.run(1, number).end == "succeeds" for number in range(1, RUNS + 1))


def assert_near(number: int, probability: Fraction) -> None:
    deviation = sqrt(RUNS * probability * (1 - probability))
    assert abs(number - RUNS * probability) <= 4 * deviation, (number / RUNS, float(probability))


def sequence(kind: str, indent: int) -> str:
    return " " * indent + f"{kind}\n" + "".join(f"{' ' * (indent + 4)}{leaf}\n" for leaf in FETCH)


def test_the_published_numbers() -> None:
    known = [".294", ".588", ".78498", ".895524", ".9516486", ".97838496", ".990579786", ".9959720988"]
    assert [with_memory(attempts) for attempts in range(1, 9)] == [Fraction(f"0{each}") for each in known]


@pytest.mark.parametrize("attempts", range(1, 9))
def test_retrying_what_remembers(attempts: int) -> None:
    tree = f"    Retry (num_attempts = {attempts})\n{sequence('SequenceWithMemory', 8)}"
    assert_near(succeeded(tree), with_memory(attempts))


def test_retrying_from_the_start() -> None:
    tree = f"    Retry (num_attempts = 5)\n{sequence('Sequence', 8)}"
    assert_near(succeeded(tree), 1 - (1 - Fraction(294, 1000)) ** 5)
