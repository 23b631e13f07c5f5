"""What a tree returns, a letter a tick."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from against_truth import run

from btq_lang.simulator.versions import Dialect

LETTERS = "IRSFK"
Skills = dict[str, list[list[Any]]]


def ticked(
    tree: str, dialect: Dialect, skills: Skills, entries: Mapping[str, float | str] | None = None, ticks: int = 6
) -> str:
    """What the root returns at each tick, every 100 ms; and the message of what was thrown."""
    case = {
        "xml": f'<root BTCPP_format="4"><BehaviorTree ID="Main">{tree}</BehaviorTree></root>',
        "skills": skills,
        "entries": entries or {},
        "ticks": ticks,
        "ms": 100,
    }
    result = run(case, dialect)
    letters = "".join(LETTERS[status] for status in result["root"])
    return letters if result["error"] is None else f"{letters} {result['error']}"
