"""The trees that nodes of Nav2 name for the goals that they send; what bt_navigator loads for them says the factory."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.catalog.nav2 import TREE_OF_GOAL, ports_of
from btq_lang.checks import lookups
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.util.record import replace


def tree_of_goal(view: View) -> Iterator[Diagnostic]:
    """A tree that bt_navigator does not find, or skips or refuses."""
    goals = view.look_up(lookups.goals)
    for seen in view.seen.given if goals else ():
        if seen.id is None or TREE_OF_GOAL not in (ports_of(seen.id.text) or ()):
            continue
        for pair in seen.node.attributes:
            if pair.key.text == TREE_OF_GOAL and pair.value is not None:
                yield from (replace(each, span=pair.value.span) for name, each in goals if name == pair.value.text)
