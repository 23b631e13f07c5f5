"""Judges clauses whose verbs are about one activation of a node; `run_verbs.py` judges the others.

One invariant: an activation is judged when it has ended, None if it does not count.  Odds and windows are unknown here.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from operator import itemgetter
from typing import Final, NamedTuple, TypeAlias

from btq_lang.catalog.verbs import VERBS
from btq_lang.evidence.amounts import Amounts
from btq_lang.evidence.conditions import Measure, bound_at, compared, measure_of, truth
from btq_lang.evidence.model import CLOCK_SET_BACK, ENOUGH, UNKNOWN_BEGIN, UNKNOWN_END, Activation, Moment
from btq_lang.evidence.observed import Observed
from btq_lang.evidence.signals import UnknownValue
from btq_lang.evidence.use import fallen, risen
from btq_lang.evidence.wording import quantity
from btq_lang.requirements.model import Age, Aggregate, Condition, Negation, ResolvedClaim, parts_in, signals_in

Judge: TypeAlias = Callable[[ResolvedClaim, Activation, Observed], "Judgement | None"]


class Judgement(NamedTuple):  # not a Record for the same reason as Measure
    """Whether an activation, or a run, satisfies a clause.

    Attributes:
        holds: None: unknown.
        at: when that was decided.
        sentence: what was observed, where `{}` is the measure, unless it holds; if `holds` is None, the reason.
        since: for a clause judged over a run, when the judged time began.
        starts: for such a clause, the activations that it counts or adds up.
        note: what is unusual about it; a log has each once.
        most: the upper limit of what is measured, if only its limits are known; `measure` is the lower one.
        passed: when a duration became longer than its bound.
        amounts: what a run adds to a rate.
    """

    holds: bool | None
    at: int
    sentence: str
    measure: Measure | None = None
    since: int | None = None
    starts: Sequence[Activation] = ()
    note: str = ""
    most: Measure | None = None
    passed: int | None = None
    amounts: Amounts | None = None


OUT: Final = Judgement(None, 0, "it does not count")


def agreed(late: Judgement | None, early: Judgement | None, activation: Activation) -> Judgement | None:
    """The judgement of an activation whose begin is not known exactly; unknown unless both are the same.

    Args:
        late, early: the judgements if it had begun as late and as early as it may have; None: it does not count, or is
            cut off.
    """
    if late is early:
        return late
    if None in (late, early) and OUT in (late, early):
        return None
    if OUT in (late, early) or late is None or early is None or not is_same(late, early):
        return Judgement(None, activation.end, UNKNOWN_BEGIN)
    if late.amounts is not None and early.amounts is not None:
        return late._replace(amounts=late.amounts.joined(early.amounts))
    return between(late, late.measure, early.most or early.measure)


def in_order(judgement: Judgement | None, late: Judgement | None) -> Judgement | None:
    """The judgement, if it is unknown at the place of the one for the latest begins: a window keeps the last ones."""
    if judgement is None or judgement is OUT or judgement.holds is not None or late is None or late is OUT:
        return judgement
    return judgement._replace(at=late.at)


def between(judgement: Judgement, one: Measure | None, other: Measure | None) -> Judgement:
    """The judgement with a measure between two limits; unchanged without both."""
    if one is None or other is None:
        return judgement
    least, most = sorted((one, other), key=lambda measure: measure.si)
    is_known = most.si - least.si <= abs(least.si) * ENOUGH
    return judgement._replace(measure=least, most=None if is_known else most)


def is_same(one: Judgement, other: Judgement) -> bool:
    """Whether two judgements agree, for all measures between theirs, too."""
    is_on_both_sides = (
        one.measure is not None and other.measure is not None and one.measure.is_upper is not other.measure.is_upper
    )
    return one.holds is other.holds and not (one.holds is False and is_on_both_sides)


# ---- durations and results ----


def takes(claim: ResolvedClaim, activation: Activation, observed: Observed) -> Judgement | None:
    """`takes at most d`: how long an activation lasts."""
    return judged(claim, duration(claim, activation, observed), activation)


def succeeds(claim: ResolvedClaim, activation: Activation, observed: Observed) -> Judgement | None:
    """`succeeds [within d]`: its result, and how long it takes; halted or cut off before, it does not count."""
    outcome, ended_at = activation.outcome, activation.end
    if outcome == "F" or claim.limit is None:
        words = {"S": "succeeded", "F": "failed"}
        return Judgement(outcome == "S", ended_at, words[outcome]) if outcome in words else None
    measure = duration(claim, activation, observed)
    if isinstance(measure, UnknownValue):
        return Judgement(None, ended_at, measure.why)
    if not measure.holds and activation.timing == "latest":
        return Judgement(None, ended_at, UNKNOWN_END, measure)
    if measure.holds and outcome != "S":
        return None
    return Judgement(
        measure.holds, ended_at, "succeeded after {}" if outcome == "S" else "had not succeeded after {}", measure
    )


def uses(claim: ResolvedClaim, activation: Activation, observed: Observed) -> Judgement | None:
    """`uses at most x of k`: how much a level falls, or a counter rises, during an activation."""
    used = _used(claim, activation, observed)
    if isinstance(used, UnknownValue):
        return judged(claim, used, activation)
    amount, note = used
    judgement = judged(claim, compared(claim, amount, observed, activation.started), activation)
    return judgement._replace(note=note) if judgement is not None else None


def judged(claim: ResolvedClaim, measure: Measure | UnknownValue, activation: Activation) -> Judgement | None:
    """The judgement of a measure that grows during an activation.

    An upper bound is violated as soon as it is exceeded, however the activation ends; a lower bound is judged only if
    that has ended by itself.
    """
    assert claim.limit is not None, "it is compared with a bound"
    is_complete = activation.outcome in ("S", "F")
    if isinstance(measure, UnknownValue):
        can_fail = is_complete or claim.limit.relation not in (">=", ">")
        return Judgement(None, activation.end, measure.why) if can_fail else None
    holds = measure.kept(is_complete)
    if holds is None:
        return None
    if not holds and activation.timing == "latest":
        return Judgement(None, activation.end, UNKNOWN_END, measure)
    return Judgement(holds, activation.end, VERBS[claim.verb].said, measure)


def duration(claim: ResolvedClaim, activation: Activation, observed: Observed) -> Measure | UnknownValue:
    """The duration of an activation, compared with the bound of a claim; unknown if either is."""
    if activation.timing == "broken":
        return UnknownValue(CLOCK_SET_BACK)
    return compared(claim, activation.seconds, observed, activation.started)


def _used(claim: ResolvedClaim, activation: Activation, observed: Observed) -> tuple[float, str] | UnknownValue:
    """How much was used, and a note if the signal was recharged or restarted meanwhile."""
    signal, limit = claim.signal, claim.limit
    assert signal is not None, "the clause names what is used"
    assert limit is not None, "and how much at most"
    if activation.timing == "broken":
        return UnknownValue(CLOCK_SET_BACK)
    if signal.behaviour == "gauge":
        return UnknownValue(f"`{signal.name}` is neither a level nor a counter")
    ends: list[float] = []
    for moment in (activation.started, activation.ended):
        value = observed.reading(signal, moment)
        if isinstance(value, UnknownValue):
            return value
        ends.append(float(value))
    values = observed.signals.sampled_values(signal, activation.begin, activation.end)
    if isinstance(values, UnknownValue):
        return values
    bound = bound_at(limit.upper or limit.value, observed, activation.started)
    if isinstance(bound, UnknownValue):
        return bound
    if signal.behaviour == "level":
        amount, number = fallen([ends[0], *values], bound.si)
        return amount, f"`{signal.name}` was recharged meanwhile, and counts on from there" if number else ""
    amount, number = risen([ends[0], *values])
    return amount, f"`{signal.name}` was restarted meanwhile, and counts on from there" if number else ""


def on_average(claim: ResolvedClaim, activation: Activation, observed: Observed) -> Judgement | None:
    """`takes at most d on average`, `uses at most x of k on average`: what an activation that has ended by itself adds
    to the mean, on which all of them decide.
    """
    if activation.outcome not in ("S", "F"):
        return None
    used = _used(claim, activation, observed) if claim.signal is not None else None
    if isinstance(used, UnknownValue):
        return Judgement(None, activation.end, used.why)
    measure = duration(claim, activation, observed)
    if used is not None:
        measure = compared(claim, used[0], observed, activation.started)
    if isinstance(measure, UnknownValue):
        return Judgement(None, activation.end, measure.why)
    return Judgement(True, activation.end, "", measure, note=used[1] if used is not None else "")


# ---- conditions ----


def needs(claim: ResolvedClaim, activation: Activation, observed: Observed) -> Judgement:
    """`needs φ`: a condition at the start of an activation, however it ends."""
    assert claim.condition is not None, "it needs a condition"
    return _of(_result(claim.condition, activation.started, observed), activation.started, claim, observed)


def leaves(claim: ResolvedClaim, activation: Activation, observed: Observed) -> Judgement | None:
    """`leaves φ`: a condition at the end of an activation that succeeded."""
    assert claim.condition is not None, "it leaves a condition"
    if activation.outcome != "S":
        return None
    return _of(_result(claim.condition, activation.ended, observed), activation.ended, claim, observed)


def ends_with(claim: ResolvedClaim, activation: Activation, observed: Observed) -> Judgement | None:
    """`ends with φ`: a condition at the end of an activation that succeeded or failed."""
    assert claim.condition is not None, "it ends with a condition"
    if activation.outcome not in ("S", "F"):
        return None
    return _of(_result(claim.condition, activation.ended, observed), activation.ended, claim, observed)


def keeps(claim: ResolvedClaim, activation: Activation, observed: Observed) -> Judgement:
    """`keeps φ`: a condition from the start of an activation to its end, at each moment at which it may change.

    The first violation decides, else a moment at which it is unknown, else the moment closest to a violation.
    """
    assert claim.condition is not None, "something is kept"
    condition = Negation(claim.condition) if claim.verb == "never" else claim.condition
    unknown: tuple[UnknownValue, Moment] | None = None
    closest: tuple[Measure | bool, Moment] | None = None
    most = float("-inf")
    for moment in observed.moments(condition):
        answer = _result(condition, moment, observed)
        if isinstance(answer, UnknownValue):
            unknown = unknown or (answer, moment)
        elif answer is False or (isinstance(answer, Measure) and not answer.holds):
            if activation.timing != "exact" and moment != observed.begin:
                return Judgement(None, moment[0], "the log does not say whether it was still running")
            answer = _at_worst(condition, answer, moment, observed)
            is_of_all = any(isinstance(part, Aggregate) for part in parts_in(condition))  # known only at the end
            return _of(answer, (activation.end, 0) if is_of_all else moment, claim, observed)
        else:
            excess = answer.excess if isinstance(answer, Measure) else most
            if closest is None or excess > most:
                closest, most = (answer, moment), excess
    result = unknown or closest
    assert result is not None, "the start is one of the moments"
    answer, moment = result
    return _of(answer, moment, claim, observed)


def never_for(claim: ResolvedClaim, activation: Activation, observed: Observed) -> Judgement:
    """`never φ for more than d`: the longest stretch of an activation in which a condition holds.

    Between two moments at which it is known not to hold, it holds at least from one known moment to the next unknown
    one, and at most all the time.
    """
    assert claim.condition is not None, "something is limited"
    if activation.timing == "broken":
        return Judgement(None, activation.end, CLOCK_SET_BACK)
    moments = observed.moments(claim.condition)
    answers = [truth(claim.condition, observed, moment) for moment in moments]
    ends = [*[moment[0] for moment in moments[1:]], activation.end]
    least, most, unknown = (0, activation.begin), 0, ""  # how long it held and when that began; how long it may have
    held_since = open_since = -1
    for (time, _), answer, end in zip(moments, answers, ends, strict=True):
        open_since = -1 if answer is False else open_since if open_since >= 0 else time
        held_since = -1 if answer is not True else held_since if held_since >= 0 else time
        if answer is True:
            least = max(least, (end - held_since, held_since), key=itemgetter(0))
        if answer is not False:
            most = max(most, end - open_since)
        if isinstance(answer, UnknownValue):
            unknown = unknown or answer.why
    measure = compared(claim, least[0] / 1e6, observed, activation.started)
    longest = compared(claim, most / 1e6, observed, activation.started)
    if isinstance(measure, UnknownValue) or isinstance(longest, UnknownValue):
        return Judgement(None, activation.end, measure.why if isinstance(measure, UnknownValue) else "")
    if measure.holds and (not longest.holds or all(isinstance(answer, UnknownValue) for answer in answers)):
        return Judgement(None, activation.end, unknown)
    if not measure.holds and activation.timing != "exact":
        return Judgement(None, activation.end, UNKNOWN_END)
    condition = claim.text.partition("never ")[2].rpartition(" for ")[0]
    sentence = f"`{condition}` {VERBS[claim.verb].said}"
    judgement = Judgement(measure.holds, least[1] + least[0], sentence, since=least[1])
    return between(judgement._replace(measure=measure), measure, longest)


def _result(condition: Condition, moment: Moment, observed: Observed) -> Measure | bool | UnknownValue:
    """Whether a condition holds at a moment, as a measure if it compares a signal with a bound."""
    measure = measure_of(condition, observed, moment)
    return measure if measure is not None else truth(condition, observed, moment)


def _at_worst(condition: Condition, answer: Measure | bool, moment: Moment, observed: Observed) -> Measure | bool:
    """The measure of a violation; of an age when it was largest, before the next sample."""
    age = next((part for part in parts_in(condition) if isinstance(part, Age)), None)
    if age is None or not isinstance(answer, Measure) or answer.name != f"age({age.signal.name})":
        return answer
    later = measure_of(condition, observed, observed.oldest(age.signal, moment))
    return later if later is not None and not later.holds else answer


def _of(result: Measure | bool | UnknownValue, moment: Moment, claim: ResolvedClaim, observed: Observed) -> Judgement:
    """The judgement of a condition evaluated at a moment."""
    time = moment[0]
    if isinstance(result, UnknownValue):
        return Judgement(None, time, result.why)
    sentence = VERBS[claim.verb].said
    if isinstance(result, Measure):
        text = "" if result.holds else sentence.replace("{}", f"`{result.name}` was {{}}")
        return Judgement(result.holds, time, text, result)
    return Judgement(
        result, time, "" if result else f"{sentence.replace('{}', _held(claim))}{_read(claim, moment, observed)}"
    )


def _held(claim: ResolvedClaim) -> str:
    """What was the case, for a violation."""
    condition = claim.text.partition(f"{claim.verb} ")[2]
    return f"`{condition}` {'held' if claim.verb == 'never' else 'did not hold'}"


def _read(claim: ResolvedClaim, moment: Moment, observed: Observed) -> str:
    """The values that a condition read."""
    values: list[str] = []
    for signal in dict.fromkeys(signals_in(claim.condition)):
        value = observed.reading(signal, moment)
        if isinstance(value, str):
            values.append(f'{signal.name} was "{value}"')
        elif not isinstance(value, UnknownValue):
            shown = str(value).lower() if isinstance(value, bool) else quantity(value, signal.unit)
            values.append(f"{signal.name} was {shown}")
    return f": {', '.join(values)}" if values else ""


JUDGES: Final[dict[str, Judge]] = {
    "takes": takes,
    "succeeds": succeeds,
    "uses": uses,
    "needs": needs,
    "leaves": leaves,
    "ends with": ends_with,
    "keeps": keeps,
    "never": keeps,
    "never for": never_for,
    "takes on average": on_average,
    "uses on average": on_average,
}
