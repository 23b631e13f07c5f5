"""The lines of btq.toml that say what skills do, for those of which nothing is known."""

from __future__ import annotations

import re
from collections.abc import Collection
from typing import Final

from btq_lang.requirements.simulation import is_condition, is_skill
from btq_lang.scenarios.mission import ScenarioMission


def template(mission: ScenarioMission, have: Collection[int]) -> str:
    """The table `[simulate.skills]`, with a line for each kind of skill that nothing is known of.

    Its values are empty, and mistakes until they are filled in: no number is made up.

    Args:
        have: the numbers of the nodes of which something is declared or measured.

    Returns:
        An empty text if there are no others.
    """
    lacking = [
        (is_condition(node), mission.tree.nodes[uid].kind)
        for uid, node in sorted(mission.written.items())
        if uid not in have and is_skill(node)
    ]
    if not lacking:
        return ""
    lines = ["[simulate.skills]"]
    for of_conditions, comment, value in _PARTS:
        names = dict.fromkeys(kind for of_condition, kind in lacking if of_condition is of_conditions)
        lines += [comment] if names else []
        lines += [f"{name if _BARE.fullmatch(name) else _quoted(name)} = {value}" for name in names]
    return "\n".join(lines) + "\n"


def _quoted(name: str) -> str:
    escaped = name.replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'


_BARE: Final = re.compile(r"[A-Za-z0-9_-]+")
_PARTS: Final = (
    (
        True,
        '# Necessary: what a condition answers, as `is = "battery >= 95 %"`, or `fails = "1 per 8 h", for = "2 s"`.',
        '{ is = "" }',
    ),
    (
        False,
        '# An action without a line succeeds at once: `takes = "6 s"`, `["12 s", "20 s"]` or\n'
        '# `{ median = "18 s", p95 = "27 s" }`, `succeeds = "97 %"`.',
        '{ takes = "", succeeds = "" }',
    ),
)
