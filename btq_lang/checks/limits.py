"""Bounds that can never be broken, can never be kept, or that the engine cannot monitor."""

from __future__ import annotations

from collections.abc import Iterator
from math import prod
from typing import Final

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.units import Dimension
from btq_lang.catalog.verbs import VERBS
from btq_lang.checks.demanded import Demanded, PlacedDiagnostic, diagnostic_at, seconds
from btq_lang.checks.qualifiers import SPLIT
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Place, Related
from btq_lang.diagnostics.rules import Severity
from btq_lang.requirements.budget_parts import port_count, port_seconds
from btq_lang.requirements.model import (
    Compare,
    NodeTarget,
    Quantity,
    ResolvedClaim,
    ResolvedRequirement,
    ResolvedTable,
    SignalRead,
)
from btq_lang.syntax.tree import Goal
from btq_lang.syntax.tree import Requirement as WrittenRequirement
from btq_lang.util.text import Span
from btq_lang.workspace import inputs
from btq_lang.workspace.resolved import ResolvedNode


def limit_too_small(demanded: Demanded) -> Iterator[PlacedDiagnostic]:
    """A limit below one millisecond: the engine counts whole milliseconds, and 0 means no limit."""
    for applied, claim, _, place in demanded.claims:
        most = claim.highest if VERBS[claim.verb].limits and applied.requirement.is_enforceable else None
        if most is None or most[0] >= 0.001:
            continue
        message = (
            f"the engine cannot enforce `{most[1]}`: it counts whole milliseconds, and 0 disables the limit; "
            "write at least 1 ms"
        )
        yield diagnostic_at(place, "limit-too-small", message)


def limit_on_synchronous_node(demanded: Demanded) -> Iterator[PlacedDiagnostic]:
    """A limit on a node that completes within one tick: the time is not checked while it runs."""
    for applied, claim, node, place in demanded.claims:
        most = claim.highest if VERBS[claim.verb].limits and applied.requirement.is_enforceable else None
        if most is None or demanded.budgets.composed(node).waits:
            continue
        message = f"{node.shown} completes within one tick, so the engine cannot stop it after `{most[1]}`"
        notes = (
            "`btq verify` can only check it in the logs afterwards; "
            "remove `on violation`, or limit a node that returns RUNNING",
        )
        related = (Related(node.place, "never returns RUNNING"),)
        yield diagnostic_at(place, "limit-on-synchronous-node", message, related=related, notes=notes)


def dead_bound(demanded: Demanded) -> Iterator[PlacedDiagnostic]:
    """A bound that is never reached, as a Timeout around the node is shorter.  If the Timeout never succeeds, that is
    reported instead."""
    for _, claim, node, place in demanded.claims:
        most = claim.highest if VERBS[claim.verb].limits else None
        timeout = _tightest_timeout(node) if most is not None else None
        if most is None or timeout is None or most[0] <= timeout[1]:
            continue
        above, limit = timeout
        success = demanded.budgets.of(above.children[0]).success if above.children else None
        if success is not None and success.low > limit:
            continue
        message = f"`{most[1]}` is never reached: a {above.tag} halts {node.shown} after {seconds(limit)}"
        related = (Related(above.place, above.tag),)
        yield diagnostic_at(place, "dead-bound", message, related=related)


def outbid_bound(demanded: Demanded) -> Iterator[PlacedDiagnostic]:
    """A bound without effect: the same requirement has a tighter one of the same kind for the same node."""
    kinds: dict[tuple[object, ...], list[tuple[ResolvedClaim, _Limit, Place]]] = {}
    notes: dict[object, tuple[str, ...]] = {}  # of a requirement
    for applied, claim, node, place in demanded.claims:
        if claim.limit is not None and ResolvedTable in (type(claim.limit.value), type(claim.limit.upper)):
            continue  # each of its values is for another situation
        if qualifier := _qualifier(applied.requirement):
            notes[applied.requirement.name] = (f"`{qualifier}` holds for all its claims; {SPLIT}",)
        is_counted = VERBS[claim.verb].operand == "count"
        for limit in [((claim.per,), claim.lowest, claim.highest)] if is_counted else _limits(claim):
            kinds.setdefault((id(node), applied.requirement.name, claim.verb, limit[0]), []).append(
                (claim, limit, place)
            )
    for (_, requirement, *_), group in kinds.items():
        lows = [(low[0], low[1], claim, place) for claim, (_, low, _), place in group if low is not None]
        highs = [(high[0], high[1], claim, place) for claim, (_, _, high), place in group if high is not None]
        for word, bounds in (("least", lows), ("most", highs)):
            pick = max if word == "least" else min
            tight = pick(bounds, key=lambda bound: bound[0], default=None)
            for bound in bounds:
                # Two equal ones that are written differently may differ: `at most 30 s`, `less than 30 s`.
                if tight is None or (bound[0] == tight[0] and bound[2].text != tight[2].text):
                    continue
                if bound[2].place == tight[2].place:  # the same claim, which may apply to the node in several ways
                    continue
                message = f"the same requirement already demands at {word} `{tight[1]}`, so `{bound[1]}` has no effect"
                tighter = tight[3]
                if tighter.path == bound[3].path and tighter.anchor is bound[3].anchor:
                    tighter = Place(tighter.span)  # without its item, which would be hashed for each of many claims
                related = (Related(tighter, "tighter bound"),) if tight[3].span != bound[3].span else ()
                yield diagnostic_at(bound[3], "dead-bound", message, related, notes.get(requirement, ()))


def _qualifier(requirement: ResolvedRequirement) -> str:
    """A clause that limits or weighs all claims, as typed; empty without one."""
    qualifiers = (*requirement.scopes, *requirement.assumptions, requirement.span, requirement.odds)
    return next((qualifier.text for qualifier in qualifiers if qualifier is not None), "")


def goal_beyond_bound(view: View, requirement: ResolvedRequirement) -> Iterator[PlacedDiagnostic]:
    """A goal that is worse than what the requirement allows: a run that violates the bound would reach it."""
    goal = requirement.goal
    if not isinstance(goal, Quantity) or requirement.place.path != view.path:
        return
    clause = _goal_clause(view, requirement.name)
    if clause is None:
        return
    dimension = goal.unit.dimension
    for claim in requirement.claims:
        most, least = claim.highest, claim.lowest
        if _dimension(claim) != dimension:
            continue
        if most is not None and goal.si > most[0]:
            message = f"the goal `{goal.text}` is worse than the bound, which is at most `{most[1]}`"
        elif least is not None and most is None and goal.si < least[0]:
            message = f"the goal `{goal.text}` is worse than the bound, which is at least `{least[1]}`"
        else:
            continue
        place = Place(Span(clause.start, clause.end), requirement.place.path, requirement.place.anchor)
        related = (Related(claim.place, "bound"),)
        yield diagnostic_at(place, "goal-beyond-bound", message, related=related)


def attempts_mismatch(demanded: Demanded) -> Iterator[PlacedDiagnostic]:
    """`tries at most` and the number of attempts of Retry and Repeat do not match."""
    for _, claim, node, place in demanded.claims:
        most = claim.highest if claim.verb in ("tries", "starts per") else None
        loops = _loops(node, claim.per.node) if most is not None and isinstance(claim.per, NodeTarget) else []
        if most is None or not loops:
            continue
        count = prod(times for _, times in loops)
        related = tuple(Related(loop.place, f"{times} times") for loop, times in loops)
        allowed = int(most[0])
        if count > allowed:
            message = f"{node.shown} may be tried {count} times, but the requirement allows {allowed}"
            yield diagnostic_at(place, "attempts-mismatch", message, related=related)
        elif count < allowed:
            message = f"{node.shown} is tried at most {count} times and never reaches the {allowed} allowed attempts"
            yield diagnostic_at(place, "attempts-mismatch", message, related=related, severity=Severity.HINT)


def contradicting_bounds(demanded: Demanded) -> Iterator[PlacedDiagnostic]:
    """Two bounds on one node that cannot both hold, or one that cannot hold by itself."""
    least: dict[tuple[object, ...], tuple[float, str, Place]] = {}
    most: dict[tuple[object, ...], tuple[float, str, Place]] = {}
    for applied, claim, node, place in demanded.claims:
        if applied.requirement.odds is not None:
            continue
        scopes = *(scope.text for scope in applied.requirement.scopes), applied.requirement.span
        for what, low, high in _limits(claim):
            key = id(node), what, scopes
            earlier_most, earlier_least = most.get(key), least.get(key)
            if low is not None and (key not in least or low[0] > least[key][0]):
                least[key] = (*low, place)
            if high is not None and (key not in most or high[0] < most[key][0]):
                most[key] = (*high, place)
            if key not in least or key not in most or least[key][0] <= most[key][0]:
                continue
            if earlier_least is not None and earlier_most is not None and earlier_least[0] > earlier_most[0]:
                continue  # reported
            other = least[key] if high is not None and most[key][2] is place else most[key]
            related = () if other[2] is place else (Related(other[2], "other bound"),)
            message = f"{node.shown} cannot keep both bounds: at least `{least[key][1]}` and at most `{most[key][1]}`"
            yield diagnostic_at(place, "contradicting-bounds", message, related=related)


_Limit = tuple[tuple[object, ...], tuple[float, str] | None, tuple[float, str] | None]


def _limits(claim: ResolvedClaim) -> Iterator[_Limit]:
    """What a claim bounds, with its lower and its upper limit."""
    if VERBS[claim.verb].limits:
        # Every value of a table would have to contradict: the most lenient one is compared with the other bound.
        yield ("duration",), claim.lowest, claim.highest
    elif claim.signal is not None:
        yield (claim.verb, claim.signal.name), claim.lowest, claim.highest
    elif claim.limit is None and claim.head != "never" and isinstance(claim.condition, Compare):
        # the condition of `never` is what must not hold, and a share of time has a limit
        yield from _compared(claim.verb, claim.condition)


def _compared(verb: str, condition: Compare) -> Iterator[_Limit]:
    pairs = zip(condition.operators, condition.operands, condition.operands[1:], strict=False)
    for operator, left, right in pairs:
        if isinstance(left, SignalRead) and isinstance(right, Quantity):
            read, bound = left, right
        elif isinstance(left, Quantity) and isinstance(right, SignalRead):
            read, bound = right, left
            operator = {"<": ">", "<=": ">=", ">": "<", ">=": "<="}.get(operator, operator)
        else:
            continue
        value = bound.si, bound.text
        if operator in ("<", "<="):
            yield (verb, read.signal.name), None, value
        elif operator in (">", ">="):
            yield (verb, read.signal.name), value, None


def _tightest_timeout(node: ResolvedNode) -> tuple[ResolvedNode, float] | None:
    """The Timeout around a node in its tree that ends first."""
    timeouts = [
        (ancestor, limit)
        for ancestor in node.ancestors()
        if ancestor.flow == "timeout" and (limit := port_seconds(ancestor))
    ]
    return min(timeouts, key=lambda timeout: timeout[1], default=None)


def _loops(node: ResolvedNode, top: ResolvedNode) -> list[tuple[ResolvedNode, int]]:
    """The loops between a node and one above it in the same tree, with their counts; empty if one is unknown."""
    loops: list[tuple[ResolvedNode, int]] = []
    for ancestor in node.ancestors() if node is not top else ():
        if ancestor.flow in ("retry", "repeat"):
            count = port_count(ancestor, "count")
            if count is None or count < 1:
                return []
            loops.append((ancestor, count))
        if ancestor is top:
            return loops
    return []


def _goal_clause(view: View, name: str) -> Goal | None:
    """The clause with a requirement's goal."""
    definition = view.ask(inputs.definition, Kind.REQUIREMENT, name)
    target = inputs.symbol(definition[1], Kind.REQUIREMENT, name).target if definition is not None else None
    clauses = target.clauses if isinstance(target, WrittenRequirement) else ()
    return next((clause for clause in clauses if isinstance(clause, Goal)), None)


def _dimension(claim: ResolvedClaim) -> Dimension | None:
    """The dimension of a claim's limit; None if uncertain."""
    value = claim.limit.value if claim.limit is not None else None
    value = value.cases[0].value if isinstance(value, ResolvedTable) else value
    return value.unit.dimension if isinstance(value, Quantity) else None


_WITHOUT_LIMITS: Final = ("never", "keeps of time", "never of time")  # what may, or need not, hold all the time
