"""One cause, one comparison: what a node and those above it have in common.

One invariant: the side of a run never decides what is compared; it only explains what was found.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Final

from btq_lang.evidence.compare import failures
from btq_lang.evidence.compare.chance import LEVEL, exact
from btq_lang.evidence.compare.measures import difference, probability, rest
from btq_lang.evidence.compare.model import ComparedNumber, Key, is_time
from btq_lang.util.grouping import grouped
from btq_lang.util.record import replace

if TYPE_CHECKING:
    from btq_lang.evidence.compare.measures import Measure, Values
    from btq_lang.evidence.compare.mission_numbers import Numbers


def chains(durations: Mapping[Key, Measure], leaves: Collection[Key]) -> list[list[Key]]:
    """Nodes and clauses that the same completions close and that last as long, the innermost node first.

    A node joins what is inside of it: in nearly all units it begins no later, ends no earlier, has as many values, and
    lasts at most 10 ms or 2 % longer.  Of several, it joins the one that ends last, as a Sequence does its last child.

    Args:
        leaves: nodes without others inside.
    """
    lengths = {key: sum(values.mean for values in durations[key].values()) for key in durations}
    numbers = {key: frozenset((unit, values.number) for unit, values in durations[key].items()) for key in durations}
    chained: list[list[Key]] = []
    for keys in grouped((numbers[key], key) for key in durations).values():
        joined: list[list[Key]] = []
        for key in sorted(keys, key=lambda key: (bool(key.requirement), lengths[key])):
            measure = durations[key]
            inner = [
                chain
                for chain in joined
                if key not in leaves
                and (
                    _closes(measure, durations[chain[0]])
                    # A clause may begin with a row in a node.
                    or (key.requirement and _closes(durations[chain[0]], measure))
                )
            ]
            if inner:
                max(inner, key=lambda chain: sum(values.end for values in durations[chain[0]].values())).append(key)
            else:
                joined.append([key])
        chained += joined
    return chained


def with_causes(changes: Sequence[ComparedNumber], numbers: Numbers, at_least: float) -> list[ComparedNumber]:
    """The changes, each with what explains it: a change in the same direction inside of it.

    Without that change, the rest of the difference is too small to count, or chance may explain it.

    Args:
        at_least: as in `compare`.
    """
    alike = grouped(
        (change.direction, change) for change in changes if change.is_at_least(at_least) and _reaches_above(change)
    )
    groups = [group for group in alike.values() if len(group) > 1 and any(change.finding for change in group)]
    if not groups:
        return list(changes)
    inside = numbers.inside(list(dict.fromkeys(change.key for group in groups for change in group)))
    failed = [change.key for group in groups for change in group if change.what == "failures"]
    time_left, failures_left = _time_left(numbers, at_least), _failures_left(failed, numbers)
    causes = {
        id(change): cause.key
        for group in groups
        for change, cause in _explained(group, inside, failures_left if group[0].what == "failures" else time_left)
    }
    return [replace(change, cause=causes.get(id(change))) for change in changes]


def _reaches_above(change: ComparedNumber) -> bool:
    """Whether what happens in a node happens in those above it, too."""
    return change.what == "failures" or (change.what == "mean" and is_time(change.unit))


def _explained(
    changes: Sequence[ComparedNumber],
    inside: Mapping[Key, Collection[Key]],
    is_rest_chance: Callable[[Key, Sequence[Key]], bool],
) -> Iterator[tuple[ComparedNumber, ComparedNumber]]:
    """Changes in one direction that others explain, each with the largest of these."""
    causes: list[ComparedNumber] = []
    for change in sorted(
        changes, key=lambda change: (not change.finding, len(inside[change.key]), bool(change.requirement))
    ):
        within = [cause for cause in causes if cause.key in inside[change.key]]
        # What is inside of another one is part of it.
        parts = [
            part
            for place, part in enumerate(within)
            if not any(part.key in inside[other.key] for other in within[place + 1 :])
        ]
        if parts and is_rest_chance(change.key, [part.key for part in parts]):
            yield change, max(parts, key=lambda part: abs(part.difference))
        elif change.finding:
            causes.append(change)


def _time_left(numbers: Numbers, at_least: float) -> Callable[[Key, Sequence[Key]], bool]:
    """Whether some parts explain most of the difference of a node, and the rest is too small or may be chance."""

    def is_chance(key: Key, parts: Sequence[Key]) -> bool:
        whole = difference(rest(numbers.measures[key], ()), numbers.sides)
        remaining = rest(numbers.measures[key], [numbers.measures[part] for part in parts])
        rest_means = difference(remaining, numbers.sides)
        size = abs(rest_means.after - rest_means.before)
        if size > abs(whole.after - whole.before) / 2:  # chance may explain it, but the parts do not
            return False
        if size < at_least * abs(whole.before):
            return True
        return probability(remaining, numbers.units, numbers.shuffles, rest_means.after > rest_means.before) > LEVEL

    return is_chance


def _failures_left(keys: Sequence[Key], numbers: Numbers) -> Callable[[Key, Sequence[Key]], bool]:
    """Whether some parts explain most of the difference in how often a node fails, and the rest may be chance."""
    places = {key: place for place, key in enumerate(keys)}
    rows = numbers.failed_together(keys) if keys else ()

    def is_chance(key: Key, parts: Sequence[Key]) -> bool:
        whole, remaining = (
            failures.rest(rows, places[key], {places[part] for part in removed}, numbers.sides)
            for removed in ((), parts)
        )
        return abs(failures.difference(remaining)) <= abs(failures.difference(whole)) / 2 and exact(remaining) > LEVEL

    return is_chance


def _closes(outer: Measure, inner: Measure) -> bool:
    """Whether one is around the other, and no longer, in nearly all units of each side."""
    sides = grouped((unit.side, _is_around(outer[unit], inner[unit])) for unit in outer)
    return all(are_around.count(False) <= _PAUSED * len(are_around) for are_around in sides.values())


def _is_around(outer: Values, inner: Values) -> bool:
    return (
        abs(outer.mean - inner.mean) <= max(_SECONDS, _SHARE * outer.mean)
        and outer.end >= inner.end - _ROUNDING
        and outer.end - outer.mean * 1e6 <= inner.end - inner.mean * 1e6 + _ROUNDING
    )


_SECONDS: Final = 0.01
_SHARE: Final = 0.02
_PAUSED: Final = 0.05  # of units, in which the machine may have paused between the rows of one tick
_ROUNDING: Final = 2.0  # µs
