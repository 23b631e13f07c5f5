"""The distribution of what a clause measured, as a drawing."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING, Final

from btq_lang.evidence.wording import quantity
from btq_lang.util.text import counted

if TYPE_CHECKING:
    from btq_lang.evidence.verdicts import Histogram


def histogram(found: Histogram) -> str:
    """The steps as bars, with a line for each mark."""
    low = min(found.low, *(mark.si for mark in found.marks.values()))
    high = max(found.low + found.step * len(found.counts), *(mark.si for mark in found.marks.values()))
    span = high - low or 1.0
    ceiling = _TEXT * len(found.marks)

    def across(value: float) -> float:
        return round(_EDGE + (value - low) / span * (_WIDE - 2 * _EDGE), 1)

    values = sum(found.counts)
    first, last = quantity(found.low, found.unit), quantity(found.low + found.step * len(found.counts), found.unit)
    label = f"{counted(values, 'value')} from {first} to {last}; "
    label += ", ".join(f"{kind} {mark.text}" for kind, mark in found.marks.items())
    parts = [f'<svg class="histogram" viewBox="0 0 {_WIDE} {_HIGH}" role="img" aria-label="{escape(label)}">']
    for at, number in enumerate(found.counts):
        if number:
            x, end = across(found.low + at * found.step), across(found.low + (at + 1) * found.step)
            height = max(round(number / max(found.counts) * (_GROUND - ceiling), 1), 1.0)
            wide = min(max(end - x, 1), _WIDEST)
            parts.append(
                f'<rect class="bin" x="{x}" y="{_GROUND - height:g}" width="{wide:.1f}" height="{height:g}">'
                f"<title>{number} from {escape(quantity(found.low + at * found.step, found.unit))}"
                f" to {escape(quantity(found.low + (at + 1) * found.step, found.unit))}</title></rect>"
            )
    parts.append(f'<path class="axis" d="M{_EDGE} {_GROUND}H{_WIDE - _EDGE}"/>')
    for line, (kind, mark) in enumerate(found.marks.items()):
        x, y = across(mark.si), _TEXT * (line + 1) - 2
        anchor = "end" if x > _WIDE / 2 else "start"
        shift = -3 if anchor == "end" else 3
        parts.append(f'<path class="{kind.rpartition(" ")[2]}" d="M{x} {_TEXT * line}V{_GROUND}"/>')
        parts.append(f'<text x="{x + shift:g}" y="{y}" style="text-anchor: {anchor}">{kind} {escape(mark.text)}</text>')
    ends = [(_EDGE, "start", low), (_WIDE - _EDGE, "end", high)]
    for x, anchor, value in ends if high - low > found.step else ends[:1]:  # where all are alike, one number
        text = escape(quantity(value, found.unit))
        parts.append(f'<text x="{x}" y="{_HIGH - 3}" style="text-anchor: {anchor}">{text}</text>')
    return "".join(parts) + "</svg>"


_WIDE: Final = 300  # pixels
_HIGH: Final = 110
_GROUND: Final = 92
_TEXT: Final = 13
_EDGE: Final = 6
_WIDEST: Final = 24  # a bar, where there are few
