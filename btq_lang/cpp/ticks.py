"""Whether a class is seen to end within the tick that starts it.

One invariant: only the engine says so, which throws if a SyncActionNode returns RUNNING, or each `return` of a `tick`
that no class of the engine continues at a later tick.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from btq_lang.cpp.grammar import contents, field, text_of, walk
from btq_lang.cpp.sources import Bound, Sources

if TYPE_CHECKING:
    from tree_sitter import Node


def ends_within_tick(sources: Sources, bound: Bound) -> bool:
    """Whether the nodes of a class never return RUNNING."""
    above = list(sources.ancestry(bound))
    outside = {each.name.rpartition("::")[2] for each in above if each.class_ is None}
    if outside != {"ActionNodeBase"}:
        return outside == {"SyncActionNode"}
    for each in above:
        bodies = sources.methods(each, "tick")
        if bodies or (each.class_ is not None and "tick" in each.class_.promised):
            return len(bodies) == 1 and _answers(bodies[0][0])
    return False


def _answers(tick: Node) -> bool:
    returns = [each for each in walk(tick, _FUNCTIONS) if each.type == "return_statement"]
    return bool(returns) and all(len(contents(each)) == 1 and _is_answer(contents(each)[0]) for each in returns)


def _is_answer(value: Node) -> bool:
    """Whether an expression is SUCCESS or FAILURE, or a choice between them."""
    if value.type == "parenthesized_expression":
        return _is_answer(contents(value)[0])
    if value.type == "conditional_expression":
        branches = (field(value, "consequence"), field(value, "alternative"))
        return all(each is not None and _is_answer(each) for each in branches)
    return text_of(value).rpartition("::")[2] in ("SUCCESS", "FAILURE")


_FUNCTIONS: Final = frozenset(("lambda_expression",))
