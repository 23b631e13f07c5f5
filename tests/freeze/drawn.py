"""Missions drawn from the strategies of `mission_strategies.py`, without hypothesis.

Hypothesis draws otherwise in another version, and when the constants of the code that is loaded are others.  So the
frozen commit's strategies are read with a stand-in for the few that they are made of: the same number gives the same
text, whatever is installed and whatever became of the code.
"""

from __future__ import annotations

import random
import re
from collections.abc import Callable, Sequence
from functools import cache
from types import SimpleNamespace
from typing import Any

import frozen

HARD = ("fail", "fail", "halt", "warn")
Draw = Callable[[random.Random], Any]


def mission(number: int) -> str:
    """A sound mission with clauses."""
    return str(_strategies().missions()(random.Random(f"mission {number}")))


def odd_mission(number: int) -> str:
    """A mission with names that nobody should use."""
    return str(_strategies().odd_missions()(random.Random(f"odd mission {number}")))


def judged_mission(number: int) -> str:
    """A mission with requirements of every verb, soft ones, or hard ones where the number is odd."""
    text = str(_random_runs().mission(random.Random(f"judged {number}")))
    chance = random.Random(f"hard {number}")
    if number % 2:
        hard = re.sub(r"(?m)^QualityReq .*$", lambda head: f"{head[0]}\n    on violation {chance.choice(HARD)}", text)
        return re.sub(r"(?m)^    (?:in at least|with probability|confidence|over last) .*\n", "", hard)
    return text


@cache
def _strategies() -> SimpleNamespace:
    return frozen.module("mission_strategies.py", hypothesis=_HYPOTHESIS, btq_lang=SimpleNamespace(quote=_quote))


@cache
def _random_runs() -> SimpleNamespace:
    """Only what draws texts is used of it."""
    return frozen.module("random_runs.py")


def _quote(text: str) -> str:
    for character, escape in (("\\", "\\\\"), ('"', '\\"'), ("\t", "\\t")):
        text = text.replace(character, escape)
    return f'"{text}"'


def _lists(elements: Draw, *, max_size: int, unique: bool = False) -> Draw:
    def draw(chance: random.Random) -> list[Any]:
        found = [elements(chance) for _ in range(chance.randint(0, max_size))]
        return list(dict.fromkeys(found)) if unique else found

    return draw


def _sampled(values: Sequence[Any]) -> Draw:
    return lambda chance: chance.choice(values)


def _composite(make: Callable[..., Any]) -> Callable[..., Draw]:
    return lambda *arguments: lambda chance: make(lambda strategy: strategy(chance), *arguments)


def _text(letters: Draw, *, max_size: int) -> Draw:
    return lambda chance: "".join(_lists(letters, max_size=max_size)(chance))


_HYPOTHESIS = SimpleNamespace(
    HealthCheck=None,
    Phase=None,
    given=None,
    settings=None,
    strategies=SimpleNamespace(
        booleans=lambda: _sampled((False, True)),
        composite=_composite,
        integers=lambda low, high: lambda chance: chance.randint(low, high),
        lists=_lists,
        sampled_from=_sampled,
        text=_text,
    ),
)
