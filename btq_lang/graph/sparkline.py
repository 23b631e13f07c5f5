"""A sparkline: the values of a clause, run by run, with its bounds.

One invariant: all that it draws is in its title in words, and colour is never the only sign: a run that violates the
clause has a cross.
"""

from __future__ import annotations

from collections.abc import Iterator
from html import escape
from itertools import groupby

from btq_lang.graph.figure import MeasuredClause
from btq_lang.graph.placing import Rectangle


def sparkline(measured: MeasuredClause, at: Rectangle) -> Iterator[str]:
    """The elements of a sparkline of at least one value that fills a rectangle."""
    numbers = [value for value, _ in measured.values if value is not None]
    low, high = min((*numbers, *measured.bounds)), max((*numbers, *measured.bounds))
    step = at.w / max(len(measured.values) - 1, 1)

    def down(value: float) -> float:
        return round(at.y + (at.h - (value - low) / (high - low) * at.h if high > low else at.h / 2), 1)

    points = [
        (round(at.x + place * step, 1), down(value), is_broken) if value is not None else None
        for place, (value, is_broken) in enumerate(measured.values)
    ]
    yield f'<g class="sparkline"><title>{escape(measured.text)}</title>'
    yield from (f'<path class="limit" d="M{at.x} {down(bound)}h{at.w}"/>' for bound in measured.bounds)
    for is_known, stretch in groupby(points, key=lambda point: point is not None):
        if is_known:
            yield f'<path class="value" d="M{"L".join(f"{x} {y}" for x, y, _ in filter(None, stretch))}"/>'
    shown = [point for point in points if point is not None]
    for x, y, is_broken in shown:
        if is_broken:
            yield f'<path class="broken" d="M{x - 3:g} {y - 3:g}l6 6m0 -6l-6 6"/>'
    x, y, is_broken = shown[-1]
    if not is_broken:
        yield f'<path class="last" d="M{x} {y}h0"/>'
    yield "</g>"
