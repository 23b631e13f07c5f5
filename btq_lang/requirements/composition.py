"""How long a node takes, given how long its children take: a rule for each flow.

One invariant: every run of the engine is within the ranges, if the children are within theirs.  Four things are left
out: the time between two ticks, that the variable of a switch changes while a case runs, how long a node holds its
child back that its parent has not reset, and that 4.8.3 and 4.8.4 wait in no Delay.  Requirements are for `budgets`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Final

from btq_lang.catalog.kinds import Flow
from btq_lang.requirements import control_budgets, decorator_budgets, nav2_budgets
from btq_lang.requirements.budget_parts import UNKNOWN, Budget, inverted, port_range
from btq_lang.requirements.durations import ANY, ZERO, from_zero, hull
from btq_lang.util.record import replace
from btq_lang.workspace.resolved import ResolvedNode


def compose(node: ResolvedNode, children: Sequence[Budget]) -> Budget:
    """How long a node takes, from its kind, its ports and its children's budgets; SubTrees and custom nodes are not
    known here.

    Args:
        children: one for each, verbatim XML too; their terms are the children themselves.
    """
    if node.flow in _LEAVES:
        return _LEAVES[node.flow]
    if node.flow == "sleeps":
        return Budget(port_range(node), None)
    found: Budget | None = None
    if node.flow in _DECORATORS and len(children) == 1:
        found = _DECORATORS[node.flow](node, children[0])
    elif node.flow in _CONTROLS and children and node.category != "Decorator":
        found = _CONTROLS[node.flow](node, children)
    if found is None:
        return UNKNOWN
    if found.waits or node.behavior is None or node.behavior.execution != "asynchronous":
        return found
    return replace(found, waits=True)


_LEAVES: Final[Mapping[Flow, Budget]] = {
    "succeeds": Budget(ZERO, None, None, False),
    "fails": Budget(None, ZERO, None, False),
    "answers": Budget(ZERO, ZERO, None, False),
    "notices": Budget(ZERO, ZERO, None, False),
    "waits": Budget(ANY, ANY),
}
_CONTROLS: Final[Mapping[Flow, Callable[[ResolvedNode, Sequence[Budget]], Budget | None]]] = {
    "sequence": control_budgets.sequence,
    "fallback": lambda node, children: inverted(control_budgets.sequence(node, [*map(inverted, children)])),
    "parallel": control_budgets.parallel,
    "parallel-all": control_budgets.parallel_all,
    "choice": control_budgets.choice,
    "switch": control_budgets.switch,
    "try": control_budgets.try_and_catch,
    "pipeline": nav2_budgets.pipeline,
    "together": nav2_budgets.together,
    "resume": nav2_budgets.resume,
    "recover": nav2_budgets.recover,
    "rotate": nav2_budgets.rotate,
}
_DECORATORS: Final[Mapping[Flow, Callable[[ResolvedNode, Budget], Budget]]] = {
    "invert": lambda _, child: inverted(child),
    "force-success": lambda _, child: replace(child, success=child.completes, failure=None),
    "force-failure": lambda _, child: replace(child, success=None, failure=child.completes),
    "retry": lambda node, child: inverted(decorator_budgets.repeat(node, inverted(child))),
    "repeat": decorator_budgets.repeat,
    "timeout": decorator_budgets.timeout,
    "delay": decorator_budgets.delay,
    "until-failure": decorator_budgets.until_failure,
    "once": decorator_budgets.once,
    "precondition": decorator_budgets.precondition,
    "for-each": decorator_budgets.for_each,
    "skip-unless-updated": lambda _, child: replace(child, skip=hull(child.skip, ZERO)),
    "wait-until-updated": decorator_budgets.wait_until_updated,
    "pass": lambda _, child: child,
    "throttle": lambda _, child: child,
    "throttle-or-fail": lambda _, child: replace(child, failure=hull(child.failure, from_zero(child.running))),
    "pass-or-succeed": lambda _, child: replace(child, success=hull(child.success, from_zero(child.running))),
    "pass-once": lambda _, child: replace(child, failure=hull(child.failure, ZERO)),
}
