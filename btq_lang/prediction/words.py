"""What the judgements of drawn runs say about the demand: whether it will hold.

One invariant: a share is compared by an interval that counts both that runs were drawn and that skills were measured in
a limited number of runs.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final, TypeAlias

from btq_lang.evidence.odds import beta_cdf, root
from btq_lang.evidence.verdicts import (
    NEVER,
    OPEN,
    SATISFIED,
    UNDECIDED,
    UNKNOWN,
    VIOLATED,
    ClauseVerdict,
    Verdict,
)
from btq_lang.prediction.report import PredictedClause, Word
from btq_lang.util.record import Record

Shares: TypeAlias = Sequence[tuple[int, int]]  # what holds, of what was counted


class Uncertainty(Record):
    """How well the skills are known.

    Attributes:
        runs: in which they were measured; 0: none was measured.
        shares: of a clause, what holds with skills that might have been measured as well, each in other runs.
    """

    runs: int
    shares: Shares = ()


def predicted_clause(clause: ClauseVerdict, odds: float | None, unknown: str, measure: Uncertainty) -> PredictedClause:
    """What is predicted of a clause.

    Args:
        odds: the share that is demanded; None: it must always hold.
        unknown: why some runs could not be judged; empty: all could.
    """
    held = clause.counted - clause.violated
    share = held / clause.counted if clause.counted and clause.pooled is None else None
    interval = interval_of(held, clause.counted, measure) if share is not None and odds is not None else None
    word = _word(clause, odds, interval, bool(unknown))
    why = clause.why
    if word == "unknown" and unknown:
        why = unknown
    first = clause.violations[0].run if clause.violations else None
    run = clause.worst.run if clause.worst is not None and odds is None else first
    return PredictedClause(
        clause.text,
        clause.path,
        clause.of,
        word,
        why,
        clause.unit,
        held,
        clause.counted,
        clause.unknown,
        share,
        interval,
        clause.pooled.text if clause.pooled is not None else "",
        clause.worst.text if clause.worst is not None else "",
        run,
        None,
    )


def _word(clause: ClauseVerdict, odds: float | None, interval: tuple[float, float] | None, is_cut: bool) -> Word:
    if odds is None or clause.pooled is not None:
        if clause.verdict == VIOLATED:
            return "will miss"
        return "unknown" if is_cut else _WORDS[clause.verdict]
    if is_cut or clause.verdict in (UNKNOWN, OPEN) or clause.unknown:
        return "unknown"
    if interval is None:
        return "never run"
    low, high = interval
    return "will hold" if low >= odds else "will miss" if high < odds else "too close to say"


def interval_of(held: int, counted: int, measure: Uncertainty) -> tuple[float, float]:
    """The limits of a share, with 95 %: Clopper's and Pearson's, of as many runs as would leave as much unknown.

    The variance is that of drawing, and that between shares with skills that might have been measured as well, of which
    what drawing explains is taken away.  Where all of these agree, the runs count in which skills were measured.
    """
    share = held / counted
    own = share * (1 - share)
    number = float(counted if not measure.runs else min(counted, measure.runs))
    if len(measure.shares) > 1:
        shares = [(k / n, n) for k, n in measure.shares if n]
        mean = sum(each for each, _ in shares) / max(len(shares), 1)
        between = sum((each - mean) ** 2 for each, _ in shares) / max(len(shares) - 1, 1)
        drawn = sum(mean * (1 - mean) / n for _, n in shares) / max(len(shares), 1)
        variance = max(between - drawn, 0.0) + own / counted
        number = min(own / variance, counted) if variance > 0 else number
    return _limit(share * number, number), 1 - _limit((1 - share) * number, number)


def _limit(held: float, number: float) -> float:
    """The lower limit, one-sided with 97.5 %."""
    if held <= 0:
        return 0.0
    return root(lambda p: beta_cdf(p, held, number - held + 1) - _TAIL)


_TAIL: Final = 0.025
_WORDS: Final[Mapping[Verdict, Word]] = {
    VIOLATED: "will miss",
    UNKNOWN: "unknown",
    UNDECIDED: "too close to say",
    SATISFIED: "will hold",
    NEVER: "never run",
    OPEN: "unknown",
}
