"""The mean of what a clause measures, over all activations that count.

With a confidence, the one-sided limits of Student's t decide: the mean and t·s/√n, where s is the standard deviation of
the sample (NIST/SEMATECH e-Handbook of Statistical Methods, 1.3.5.2).  A measure of which only limits are known counts
as the middle between them, and half their distance widens the mean and the deviation.
"""

from __future__ import annotations

from math import isclose, sqrt
from typing import TYPE_CHECKING, Final

from btq_lang.evidence.student import quantile
from btq_lang.evidence.verdicts import SATISFIED, UNDECIDED, UNKNOWN, VIOLATED, Pooled, Verdict
from btq_lang.evidence.wording import measured, share

if TYPE_CHECKING:
    from btq_lang.evidence.rates import PoolBound
    from btq_lang.evidence.verbs import Judgement


class Mean:
    """The sums so far.

    Attributes:
        demanded: of the mean, without a time.
        sums: how many values, the sum of the values less the bound, that of the squares of these, and both sums of half
            the distances between limits.
    """

    def __init__(self, demanded: PoolBound, confidence: float | None) -> None:
        self.demanded: Final = demanded
        self.sums = (0.0, 0.0, 0.0, 0.0, 0.0)
        self._confidence: Final = confidence

    def see(self, judgement: Judgement) -> None:
        """Add what an activation measures."""
        if judgement.measure is None:
            return
        least = judgement.measure.si
        most = judgement.most.si if judgement.most is not None else least
        beyond, half = (least + most) / 2 - self.demanded.value, abs(most - least) / 2
        self.add((1.0, beyond, beyond * beyond, half, half * half))

    def add_all(self, other: Mean) -> None:
        """Add what other activations measure."""
        self.add(other.sums)

    def add(self, sums: tuple[float, ...]) -> None:
        """Add the sums of one or several activations."""
        self.sums = tuple(one + other for one, other in zip(self.sums, sums, strict=True))  # type: ignore[assignment]  # as many

    def emptied(self) -> Mean:
        """One that demands the same, without what was added."""
        return Mean(self.demanded, self._confidence)

    def verdict(self) -> Verdict:
        """By the mean, or with a confidence by its limits."""
        if self._confidence is not None and self.sums[0] < 2:
            return UNDECIDED
        low, high = self._limits()
        relation, value, upper, *_ = self.demanded
        most = upper if upper is not None else value
        is_high = relation not in (">=", ">") and (low > most or (relation == "<" and low >= most))
        is_low = relation not in ("<=", "<") and (high < value or (relation == ">" and high <= value))
        if is_high or is_low:
            return VIOLATED
        is_kept_above = relation in (">=", ">") or high < most or (high == most and relation != "<")
        is_kept_below = relation in ("<=", "<") or low > value or (low == value and relation != ">")
        if is_kept_above and is_kept_below:
            return SATISFIED
        return UNKNOWN if self._confidence is None else UNDECIDED

    def _limits(self) -> tuple[float, float]:
        """The limits of the mean: of what values with known limits may come to, and with the confidence."""
        number, total, squares, halves, squared_halves = self.sums
        mean, width = self.demanded.value + total / number, halves / number
        if self._confidence is not None and number >= 2:
            deviation = sqrt(max(squares - total * total / number, 0.0) / (number - 1))
            deviation += sqrt(squared_halves / (number - 1))
            width += quantile(self._confidence, int(number) - 1) * deviation / sqrt(number)
        return self._rounded(mean - width), self._rounded(mean + width)

    def _rounded(self, end: float) -> float:
        """A limit; a bound in its place if they differ only by the rounding of sums."""
        bounds = (self.demanded.value, self.demanded.upper)
        return next((each for each in bounds if each is not None and isclose(end, each, rel_tol=_SAME)), end)

    def shown(self) -> Pooled:
        """What is known of the mean."""
        low, high = self._limits()
        return Pooled(self._text(low, high), low, high, None)

    def _text(self, low: float, high: float) -> str:
        number, total, _, halves, _ = self.sums
        mean, half = self.demanded.value + total / number, halves / number
        ends = [self._shown(end) for end in dict.fromkeys((mean - half, mean + half))]
        text = f"mean {' to '.join(dict.fromkeys(ends))} of {int(number)}"
        if self._confidence is None:
            return text
        if number < 2:
            return f"{text}, at least 2 are needed"
        confidence, verdict = share(self._confidence), self.verdict()
        if verdict == UNDECIDED:
            return f"{text}, {self._shown(low)} to {self._shown(high)} with confidence {confidence} each"
        is_most = (verdict == SATISFIED) == (self.demanded.relation in ("<=", "<", "between"))
        limit = f"at most {self._shown(high)}" if is_most else f"at least {self._shown(low)}"
        return f"{text}, {limit} with confidence {confidence}"

    def _shown(self, si: float) -> str:
        return measured(si, self.demanded.unit, self.demanded.value)


_SAME: Final = 1e-12  # of a bound
