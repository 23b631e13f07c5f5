"""Budgets that do not add up: the demands on the children exceed the demand on their parent; odds that the nodes below
do not ensure, and odds that no window is long enough to show."""

from __future__ import annotations

from collections.abc import Iterator
from math import ceil, inf, log

from btq_lang.catalog.units import from_si
from btq_lang.catalog.verbs import VERBS
from btq_lang.checks.demanded import Demanded, PlacedDiagnostic, diagnostic_at, seconds, summed
from btq_lang.diagnostics.model import Related
from btq_lang.requirements.applied import Applied
from btq_lang.requirements.budget_parts import Budget, port_seconds
from btq_lang.requirements.budgets import Budgets
from btq_lang.requirements.durations import DurationTerm, Range, together
from btq_lang.requirements.model import MissionRun, Quantity, ResolvedClaim, ResolvedRequirement, time_for_one
from btq_lang.workspace.resolved import ResolvedNode


def budget_exceeded(demanded: Demanded) -> Iterator[PlacedDiagnostic]:
    """Children that may take longer than their parent is allowed to: in the worst case, or always."""
    for applied, claim, node, place in demanded.claims:
        most = claim.highest if VERBS[claim.verb].limits else None
        if most is None or not (node.children or node.category == "SubTree"):
            continue
        allowed = _held_against(claim, demanded.budgets.composed(node))
        if allowed is None:
            continue
        if allowed.low > most[0]:
            message = f"{node.shown} takes at least {seconds(allowed.low)}, so it always violates `{most[1]}`"
        elif applied.requirement.odds is not None:
            continue
        else:
            is_known = allowed.high < inf
            allowed = allowed if is_known else _held_against(claim, demanded.budgets.composed_of_known(node))
            if allowed is None or allowed.high <= most[0]:
                continue
            rest = "" if is_known else ", not counting steps without a bound"
            what = summed(together(allowed.terms))
            message = f"{node.shown} may take {seconds(allowed.high)}, more than `{most[1]}` allows: {what}{rest}"
        terms = together(allowed.terms)
        related = tuple(Related(term.node.place, _share(term)) for term in terms)
        yield diagnostic_at(place, "budget-exceeded", message, related=related)


def timeout_never_succeeds(demanded: Demanded) -> Iterator[PlacedDiagnostic]:
    """A Timeout shorter than the shortest way to its child's success."""
    for node in demanded.tree.all:
        if node.flow != "timeout":
            continue
        limit = port_seconds(node) if len(node.children) == 1 else None
        if not limit or node.path != demanded.view.path:
            continue
        (child,) = node.children
        success = demanded.budgets.of(child).success
        if success is None or success.low <= limit:
            continue
        related = (Related(child.place, f"takes at least {seconds(success.low)}"),)
        message = f"{node.shown} can never succeed: {child.shown} takes at least {seconds(success.low)}"
        yield diagnostic_at(node.place, "timeout-never-succeeds", message, related=related)


def odds_beyond_children(demanded: Demanded) -> Iterator[PlacedDiagnostic]:
    """A node that must be in time, or succeed, more often than the demands on its children ensure.

    Limits without odds do not matter here: if a step is late now and then, the whole may still be in time.
    """
    for applied, claim, node, place in demanded.claims:
        odds = applied.requirement.odds
        if (odds is not None and odds.experiments == "runs") or not (node.children or node.category == "SubTree"):
            continue
        if odds is None and VERBS[claim.verb].limits != "success":
            continue
        demanded_share = odds.probability if odds is not None else 1.0
        ensured = _ensured(demanded.budgets, claim, node)
        if ensured is None or ensured[0] >= demanded_share - 1e-9:
            continue
        likely, parts, rest = ensured
        message = (
            f"{_called(applied, node)} must meet `{claim.text}` in {_percent(demanded_share)} of activations, but "
            f"the requirements of the nodes below it guarantee only {_percent(likely)}{rest}"
        )
        related = tuple(Related(part.place, f"fails in up to {_percent(share)}") for part, share in parts if share)
        notes = ("the failures of several steps add up (the union bound)",) if len(related) > 1 else ()
        yield diagnostic_at(place, "odds-beyond-children", message, related=related, notes=notes)


def window_without_hours(requirement: ResolvedRequirement) -> Iterator[PlacedDiagnostic]:
    """A window of time that is too short to show a failure rate, even without any failure.

    Without a failure in the time t, the mean number in it is at most -ln(1 - c) with confidence c (Garwood, "Fiducial
    limits for the Poisson distribution", Biometrika 28, 1936; one-sided).
    """
    window, confidence = requirement.window, requirement.confidence
    if window is None or window.seconds is None or confidence is None:
        return
    for claim in requirement.claims:
        most, per = claim.highest, claim.per
        if claim.verb != "fails per time" or most is None or most[0] <= 0 or not isinstance(per, Quantity):
            continue
        needed = -log(1.0 - confidence) / most[0] * per.si
        if needed <= window.seconds:
            continue
        message = (
            f"`{window.text}` cannot show at most {most[1]} per {per.text} with a confidence of "
            f"{_percent(confidence)}: this requires {_time(needed, per)} without a failure"
        )
        related = (Related(claim.place, "failure rate"),)
        yield diagnostic_at(window.place, "window-too-small", message, related=related)


def rate_without_confidence(requirement: ResolvedRequirement) -> Iterator[PlacedDiagnostic]:
    """A failure rate that hours without a failure satisfy, however few they are beside what would show it."""
    if requirement.confidence is not None:
        return
    for claim in requirement.claims:
        most, per = claim.highest, claim.per
        if claim.verb != "fails per time" or most is None or most[0] <= 0 or not isinstance(per, Quantity):
            continue
        enough = _time(time_for_one(most[0], per.si), per)
        message = f"without `confidence` this failure rate is judged only by its value, once {enough} were observed"
        notes = (f"`confidence 95 %` asks for {_time(-log(0.05) / most[0] * per.si, per)} without a failure",)
        yield diagnostic_at(claim.place, "rate-without-confidence", message, notes=notes)


def _time(seconds: float, per: Quantity) -> str:
    """A time in the unit of another one, rounded up."""
    return f"{_rounded_up(from_si(seconds, per.unit))} {per.unit.symbol}"


def _rounded_up(number: float) -> str:
    return str(ceil(number)) if number >= 10 else f"{ceil(number * 100) / 100:g}"


def window_too_small(requirement: ResolvedRequirement) -> Iterator[PlacedDiagnostic]:
    """A window that is too small even without any failure.

    Of n experiments that all succeed, the probability is at least (1 - c)^(1/n) with confidence c (Clopper, Pearson,
    "The use of confidence or fiducial limits", Biometrika 26, 1934; one-sided).
    """
    odds, window, confidence = requirement.odds, requirement.window, requirement.confidence
    if odds is None or window is None or window.count is None or confidence is None:
        return
    needed = ceil(log(1.0 - confidence) / log(odds.probability)) if odds.probability < 1.0 else inf
    if needed <= window.count:
        return
    reason = f"this requires {needed} without a failure" if needed < inf else "no window is large enough"
    message = (
        f"{window.count} {window.experiments} cannot show {_percent(odds.probability)} with a confidence of "
        f"{_percent(confidence)}: {reason}"
    )
    related = (Related(odds.place, "required probability"),)
    yield diagnostic_at(window.place, "window-too-small", message, related=related)


def _held_against(claim: ResolvedClaim, budget: Budget) -> Range | None:
    """The range of durations in a budget that a claim limits: until success, or until completion."""
    return budget.success if VERBS[claim.verb].limits == "success" else budget.completes


def _share(term: DurationTerm) -> str:
    return f"up to {seconds(term.seconds)}" + (f", {term.times} times" if term.times > 1 else "")


def _ensured(
    budgets: Budgets, claim: ResolvedClaim, node: ResolvedNode
) -> tuple[float, list[tuple[ResolvedNode, float]], str] | None:
    """The probability that the demands below a node make a claim true, the share that each child may miss, and a remark
    on what the probability leaves out; None if it is unknown, or if the duration is too long anyway."""
    most = claim.highest
    limit = most[0] if most is not None else inf
    limits = VERBS[claim.verb].limits
    if limits == "success":
        success = budgets.success(node)
        rest = "" if success is not None else ", even if every other step succeeds"
        success = success or budgets.success_of_known(node)
        if success is None or success.seconds > limit:
            return None
        return success.probability, list(success.parts), rest
    if limits == "completion" and most is not None:
        budget = budgets.composed(node)
        if not budget.is_bounded or budget.running.high > limit:
            return None
        shares = [(child, 1.0 - budgets.of(child).probability) for child in node.children]
        return budget.probability, shares, ""
    return None


def _called(applied: Applied, node: ResolvedNode) -> str:
    """The name of a node in a message: the mission, or its tree if it is a root without a name."""
    if isinstance(applied.subject, MissionRun):
        return "`mission`"
    is_unnamed_root = node.parent is None and node.node.name is None and node.tree is not None
    return f"`{node.tree}`" if is_unnamed_root else node.shown


def _percent(share: float) -> str:
    return f"{share * 100:.4g} %"
