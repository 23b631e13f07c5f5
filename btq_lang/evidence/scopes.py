"""`while C` and `when C`: which activations count, and for `keeps` and `never` which part of their time.

One invariant: an activation in an unknown scope is unknown, whatever its judgement.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from btq_lang.catalog.verbs import VERBS
from btq_lang.evidence.conditions import truth
from btq_lang.evidence.model import UNKNOWN_END
from btq_lang.evidence.signals import UnknownValue
from btq_lang.requirements.model import All, Any, Negation, ResolvedClaim, ResolvedScope
from btq_lang.util.record import replace

if TYPE_CHECKING:
    from btq_lang.evidence.observed import Observed


def within(claim: ResolvedClaim, scopes: Sequence[ResolvedScope]) -> ResolvedClaim:
    """The claim with `while C` folded into its condition, which is then about a whole activation."""
    for scope in scopes:
        condition = claim.condition
        if scope.word == "while" and condition is not None and claim.verb == "keeps":
            claim = replace(claim, condition=Any((Negation(scope), condition)))
        elif scope.word == "while" and condition is not None and claim.verb == "never":
            claim = replace(claim, condition=Negation(Any((Negation(scope), Negation(condition)))))
        elif scope.word == "while" and condition is not None and claim.verb == "never for":
            claim = replace(claim, condition=All((scope, condition)))
    return claim


def in_scope(scopes: Sequence[ResolvedScope], verb: str, observed: Observed) -> bool | UnknownValue:
    """Whether an observed activation, or time between two events, is in scope."""
    if not scopes:
        return True
    observed = observed.in_scope
    result: bool | UnknownValue = True
    for scope in scopes:
        if scope.word == "while" and VERBS[verb].operand == "rate":  # it is time that counts, not activations
            continue
        moments = [observed.begin] if scope.word == "when" else observed.moments(scope.condition)
        answers = [truth(scope.condition, observed, moment) for moment in moments]
        is_some_enough = scope.word == "while" and VERBS[verb].judged == "while it runs"  # a part of its time is enough
        if not observed.is_end_known:  # except at its start, it may have been halted already
            answers[1:] = [UnknownValue(UNKNOWN_END) if answer is is_some_enough else answer for answer in answers[1:]]
        unknown = next((answer for answer in answers if isinstance(answer, UnknownValue)), None)
        if is_some_enough:
            if True in answers:
                continue
            counts = unknown or False
        else:
            counts = False if False in answers else unknown or True
        if counts is False:
            return False
        result = counts if isinstance(counts, UnknownValue) else result
    return result
