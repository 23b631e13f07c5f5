"""The clause for a sentence about a bound: "shall take at most 30 sec" is `takes at most 30 s`.

One invariant: there is a result only if the sentence has one number with a unit, one comparison, and no word that could
change its meaning (and, or, if, per, average …).  It looks at no files; signals are arguments.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache

from btq_lang.catalog.units import Dimension, parse_unit
from btq_lang.requirements.terms import TIME


def as_clause(sentence: str, *, violates: bool, signals: Mapping[str, Dimension]) -> str | None:
    """The clause that means the same as a sentence; None if it is not plain.

    Args:
        violates: whether the sentence describes when the requirement is violated, not when it is met.
        signals: with the dimensions of their units.
    """
    sentence = " ".join(sentence.split())
    words = frozenset(_WORD.findall(sentence.lower()))
    match = _bound_pattern().search(sentence)
    if match is None or len(_NUMBER.findall(sentence)) != 1 or words & _QUALIFIERS:
        return None
    comparison = match["comparison"].lower()
    relation = _COMPARISONS[comparison]
    for turned in (match["negation"] is not None, violates):
        relation = _OPPOSITE[relation] if turned else relation
    if match["unit"].lower() in _TRIES:
        counts = match["number"].isdecimal() and relation in ("<=", "<")
        return f"tries {_BOUNDS[relation]} {match['number']}" if counts else None
    unit = parse_unit(match["unit"])
    if unit is None:
        return None
    quantity = f"{match['number']} {unit.symbol}"
    if unit.dimension != TIME:
        return _measured(
            words, relation, quantity, [name for name, dimension in signals.items() if dimension == unit.dimension]
        )
    if comparison == "within":
        return f"succeeds within {quantity}" if relation == "<=" else None
    is_duration = comparison in ("longer than", "shorter than") or words & _DURATIONS
    return f"takes {_BOUNDS[relation]} {quantity}" if is_duration else None


def _measured(words: frozenset[str], relation: str, quantity: str, signals: list[str]) -> str | None:
    """A bound of the one signal that the sentence names."""
    named = [name for name in signals if words.issuperset(_WORD.findall(name.lower()))]
    if len(named) != 1:
        return None
    if words & _USES and relation in ("<=", "<"):
        return f"uses {_BOUNDS[relation]} {quantity} of {named[0]}"
    return f"{'leaves' if words & _AT_THE_END else 'keeps'} {named[0]} {relation} {quantity}"


@cache
def _bound_pattern() -> re.Pattern[str]:
    """`not take longer than 30 sec`, `at least a battery capacity of 3%`"""
    comparisons = "|".join(words.replace(" ", r"\s") for words in sorted(_COMPARISONS, key=len, reverse=True))
    return re.compile(
        r"(?:\b(?P<negation>not|never|no|cannot|without)\s(?:[a-z]+\s){0,3}?)?"
        rf"\b(?P<comparison>{comparisons})\s"
        r"(?:[a-z]+\s){0,4}?"
        r"(?P<number>[0-9]+(?:\.[0-9]+)?)\s?"
        r"(?P<unit>%|[^\W\d_](?:[\w/^*]*\w)?)",
        re.IGNORECASE,
    )


_OPPOSITE = {"<=": ">", "<": ">=", ">=": "<", ">": "<="}
_BOUNDS = {"<=": "at most", "<": "less than", ">=": "at least", ">": "more than"}
_COMPARISONS = {
    **dict.fromkeys(("at most", "at maximum", "maximum of", "up to", "within"), "<="),
    **dict.fromkeys(("less than", "fewer than", "lower than", "smaller than", "shorter than", "below", "under"), "<"),
    **dict.fromkeys(("at least", "at minimum", "minimum of"), ">="),
    **dict.fromkeys(("more than", "longer than", "greater than", "higher than", "larger than", "above"), ">"),
    **dict.fromkeys(("exceed", "exceeds", "exceeded", "exceeding"), ">"),
}
_TRIES = frozenset(("times", "attempts", "tries", "retries"))
# Words by which a sentence may mean more or less than its one comparison.
_QUALIFIERS = frozenset(
    (
        *("and", "or", "but", "if", "when", "whenever", "while", "unless", "except", "until", "after", "before"),
        *("since", "during", "per", "every", "between", "average", "averaged", "mean", "median", "percentile"),
        *("probability", "probably", "usually", "often"),
    )
)
_DURATIONS = frozenset(
    (
        *("take", "takes", "taking", "taken", "took", "last", "lasts", "lasted", "need", "needs", "needed"),
        *("duration", "time", "complete", "completes", "completed", "finish", "finishes", "finished", "done"),
        *("reach", "reaches", "reached", "arrive", "arrives", "arrived", "spend", "spends", "spent"),
    )
)
_USES = frozenset(("use", "uses", "used", "using", "consume", "consumes", "consumed"))
_AT_THE_END = frozenset(("left", "remain", "remains", "remaining", "arrive", "arrives", "arrived"))
# The patterns that are needed for every text; others are compiled on demand.
_WORD = re.compile(r"[^\W_]+")
_NUMBER = re.compile(r"[0-9]+(?:\.[0-9]+)?")
