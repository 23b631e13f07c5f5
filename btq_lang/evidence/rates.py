"""A failure rate: how often a node failed in the time in which it might have, in all runs together."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

from btq_lang.evidence.amounts import Amounts
from btq_lang.evidence.poisson import lower_number, upper_number
from btq_lang.evidence.verdicts import SATISFIED, UNDECIDED, UNKNOWN, VIOLATED, Pooled, Verdict
from btq_lang.evidence.wording import measured, share
from btq_lang.requirements.model import time_for_one

if TYPE_CHECKING:
    from btq_lang.catalog.units import Unit
    from btq_lang.evidence.verbs import Judgement


class PoolBound(NamedTuple):
    """A rate that is demanded: so many in a time.

    Attributes:
        relation: as of a bound; `value`, and of two the `upper` one.
        seconds, unit: of the time.
    """

    relation: str
    value: float
    upper: float | None
    seconds: float
    unit: Unit

    @property
    def enough(self) -> float:
        """The time in seconds from which on the rate is compared by its value: before, not even one failure fits in."""
        return time_for_one(self.value if self.upper is None else self.upper, self.seconds)

    @property
    def columns(self) -> tuple[float | None, ...]:
        """The lower and the upper bound, whether a value equal to each violates it, and the time, for a table."""
        low = self.value if self.relation in (">=", ">", "between") else None
        high = self.value if self.relation in ("<=", "<") else self.upper
        return low, high, float(self.relation in ("<", ">")), self.seconds

    @classmethod
    def of_columns(cls, low: float | None, high: float | None, strict: float, seconds: float, unit: Unit) -> PoolBound:
        """The bound that has these columns."""
        if low is not None and high is not None:
            return cls("between", low, high, seconds, unit)
        relation = ("<" if low is None else ">") + ("" if strict else "=")
        value = low if low is not None else high
        assert value is not None, "a rate has a bound"
        return cls(relation, value, None, seconds, unit)


class Rate:
    """The failures and the exposure so far.

    Attributes:
        demanded: what is demanded of them.
        amounts: of all runs.
    """

    def __init__(self, demanded: PoolBound, confidence: float | None) -> None:
        self.amounts = Amounts(0, 0, 0, 0)
        self.demanded: Final = demanded
        self._confidence: Final = confidence

    def see(self, judgement: Judgement) -> None:
        """Add what a run adds."""
        if judgement.amounts is not None:
            self.add(judgement.amounts)

    def add_all(self, other: Rate) -> None:
        """Add what other runs add."""
        self.add(other.amounts)

    def add(self, amounts: Amounts) -> None:
        """Add what one or several runs add."""
        self.amounts = Amounts(*(one + other for one, other in zip(self.amounts, amounts, strict=True)))

    def emptied(self) -> Rate:
        """One that demands the same, without what was added."""
        return Rate(self.demanded, self._confidence)

    def verdict(self) -> Verdict:
        """By the largest and by the smallest rate that it may be; unknown where these differ."""
        least, most, exposure, longest = self.amounts
        verdicts = {self._verdict(most, exposure), self._verdict(least, longest)}
        return verdicts.pop() if len(verdicts) == 1 else UNKNOWN

    def _verdict(self, number: int, exposure: int) -> Verdict:
        """The verdict on a number in an exposure in µs."""
        demanded, exposed = self.demanded, exposure / 1e6 / self.demanded.seconds if self.demanded.seconds else 0.0
        if self._confidence is None:
            is_enough = exposure / 1e6 >= demanded.enough
            return UNKNOWN if not is_enough else SATISFIED if self._is_kept(number, number, exposed) else VIOLATED
        low, high = lower_number(number, self._confidence), upper_number(number, self._confidence)
        if self._is_kept(low, high, exposed):
            return SATISFIED
        most = demanded.upper if demanded.upper is not None else demanded.value
        is_above = demanded.relation not in (">=", ">") and low > most * exposed
        is_below = demanded.relation not in ("<=", "<") and high < demanded.value * exposed
        return VIOLATED if is_above or is_below else UNDECIDED

    def _is_kept(self, low: float, high: float, exposed: float) -> bool:
        """Whether all numbers between two keep the bound in an exposure."""
        relation, least, upper = self.demanded.relation, self.demanded.value * exposed, self.demanded.upper
        if upper is not None:
            return low >= least and high <= upper * exposed
        return {"<=": high <= least, "<": high < least, ">=": low >= least, ">": low > least}[relation]

    def shown(self) -> Pooled:
        """What is known of the rate."""
        least, most, exposure, longest = self.amounts
        confidence = self._confidence
        low = lower_number(least, confidence) if confidence is not None else float(least)
        high = upper_number(most, confidence) if confidence is not None else float(most)
        more = self._missing() if self.verdict() in (UNDECIDED, UNKNOWN) else None
        return Pooled(
            self._text(low, high, more),
            low / (longest / 1e6) if longest else None,
            high / (exposure / 1e6) if exposure else None,
            more,
        )

    def _missing(self) -> float | None:
        """How much longer, in seconds, decides it if it does not happen again; None: no time does, or none is known."""
        demanded, exposed = self.demanded, self.amounts.exposure / 1e6
        if self._confidence is None:
            return max(demanded.enough - exposed, 0.0) or None
        if demanded.relation not in ("<=", "<") or demanded.value <= 0:
            return None
        return max(upper_number(self.amounts.most, self._confidence) / demanded.value * demanded.seconds - exposed, 0.0)

    def _text(self, low: float, high: float, more: float | None) -> str:
        least, most, exposure, longest = self.amounts
        demanded = self.demanded
        number = str(least) if least == most else f"{least} to {most}"
        times = [measured(time / 1e6, demanded.unit) for time in dict.fromkeys((exposure, longest))]
        parts = [f"{number} in {' to '.join(times)}"]
        period = measured(demanded.seconds, demanded.unit)
        verdict = self.verdict()
        if self._confidence is not None and verdict in (SATISFIED, VIOLATED) and exposure:
            is_most = (verdict == SATISFIED) == (demanded.relation in ("<=", "<", "between"))
            rate = (high / exposure if is_most else low / longest) * 1e6 * demanded.seconds
            words = "at most" if is_most else "at least"
            parts.append(f"{words} {rate:.3g} per {period} with confidence {share(self._confidence)}")
        if more is not None:
            missing = measured(more, demanded.unit)
            parts.append(
                f"{missing} more without another decide it"
                if self._confidence is not None
                else f"{missing} more are needed"
            )
        return ", ".join(parts)
