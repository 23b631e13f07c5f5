"""The drawings of the page, and its style sheet.

One invariant: every fact in a drawing is also in a text, and colour is never the only sign.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from html import escape
from typing import Final

from btq_lang.evidence.report.trends import Steps, Values
from btq_lang.evidence.wording import moment


def bars(values: Values, steps: Steps, labels: Sequence[tuple[str, int]], shown: Callable[[float], str]) -> str:
    """A measure over time, a bar for each step; a dotted line where the first run of a label began.

    Args:
        shown: gives a value as people read it.
    """
    known = [(place, value) for place, value in enumerate(values) if value is not None]
    if not known:
        return ""
    (first, begin), (last, end) = known[0], known[-1]
    highest = max(value for _, value in known)
    if not highest:
        return f"<small>always {escape(shown(0.0))}</small>"
    said = f"{shown(begin)} from {_date(steps, first)}, {shown(end)} from {_date(steps, last)}"
    wide = _WIDE / len(values)
    label = f"by {steps.name}: {said}, at most {shown(highest)}"
    parts = [f'<svg class="trend" viewBox="0 0 {_WIDE} {_HIGH}" role="img" aria-label="{escape(label)}">']
    for name, start in labels:
        x = (start - steps.origin) / steps.length * wide
        title = f"{name or NO_NAME} begins"
        parts.append(f'<path class="label" d="M{x:.1f} 0V{_HIGH}"><title>{escape(title)}</title></path>')
    for place, value in known:
        high = max(value / highest * _HIGH, 1)
        parts.append(
            f'<rect x="{place * wide + wide / 10:.1f}" y="{_HIGH - high:.1f}" width="{wide * 0.8:.1f}"'
            f' height="{high:.1f}"><title>{escape(f"{_date(steps, place)}: {shown(value)}")}</title></rect>'
        )
    return "".join(parts) + f"</svg><small>at most {escape(shown(highest))}</small>"


def _date(steps: Steps, place: int) -> str:
    """When a step begins, as exactly as its length asks for."""
    time = steps.begin(place)
    begin = moment(time)
    if begin is None:
        return f"{time} µs"
    return f"{begin:%Y-%m-%d %H:%M}" if steps.name in ("minute", "hour") else f"{begin:%Y-%m-%d}"


NO_NAME: Final = "(none)"
_WIDE: Final = 200  # pixels
_HIGH: Final = 36

REPORT_STYLE: Final = """\
main { max-width: 90rem; padding-bottom: 3rem; }
h3 { display: block; margin-top: 1.5rem; }
.tiles { display: flex; flex-wrap: wrap; gap: .75rem; list-style: none; padding: 0; margin: .75rem 0; }
.tiles li { flex: 1 1 9rem; padding: .5rem .8rem; background: var(--raised); border: 1px solid var(--line);
  border-radius: 6px; border-left: 5px solid var(--enforced); }
.tiles li.bad { border-left-color: var(--missing); }
.tiles strong { display: block; font-size: 1.6rem; line-height: 1.2; }
.tiles .bad strong { color: var(--missing); }
.tiles strong::after { content: " \\2714"; font-size: 1rem; color: var(--enforced); }
.tiles .bad strong::after { content: " \\2716"; color: var(--missing); }
.worse { font-weight: 700; color: var(--missing); white-space: nowrap; }
.worse::before { content: "\\2716\\00A0"; }
@media (min-width: 701px) { .changes th { width: 12rem; } .changes td:last-child { width: 40%; }
  .parts tbody th { width: 26%; } .robots tbody th { width: 12%; } thead th { white-space: nowrap; } }
td small { display: block; }
.last { background: var(--raised); }
.trend { display: block; width: 12.5rem; max-width: 100%; height: 2.25rem; border-bottom: 1px solid var(--soft); }
.trend rect { fill: var(--monitored); }
.trend .label { stroke: var(--ink); stroke-dasharray: 2 2; }
.share { display: block; height: .35rem; margin-top: .2rem; background: var(--missing); border-radius: 2px; }
details { margin: .5rem 0; } summary { color: var(--accent); cursor: pointer; }
tr:target > th, tr:target > td { background: var(--chosen); }
@media (max-width: 700px) { header, main { padding-left: .8rem; padding-right: .8rem; }
  main table, main tbody, main tr, main th, main td { display: block; }
  main thead { display: none; } main caption { display: block; }
  main tr { border-bottom: 1px solid var(--line); padding: .3rem 0; }
  main tbody th, main tbody td { border: 0; padding: .15rem .3rem; }
  .parts tbody th, .robots tbody th { font-weight: 600; }
  main td[data-of]::before { content: attr(data-of) ": "; color: var(--soft); }
  .tiles li { flex: 1 1 40%; } }
@media print { .tiles li, .last { background: none; } }
"""
