"""SVG, written by hand: a standalone document, or a part of a page.

One invariant: the same figures give the same bytes, and texts are escaped.  A document has its own background, light or
dark like the reader's system; in a page, the page's style sheet paints it (`STYLE` has the shapes of the classes,
`LIGHT` and `DARK` their colours).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from html import escape
from itertools import groupby
from typing import Final

from btq_lang.graph.figure import Figure, MeasuredClause
from btq_lang.graph.placing import LEADING, MARGIN, SMALL, TITLE, Drawing, Line, PlacedBox, PlacedNote, Rectangle, place
from btq_lang.graph.widths import width

# Selectors, properties, and colours on light and dark background; text has a contrast of at least 4.5.
_COLOURS: Final = (
    (".ground", "fill", "#ffffff", "#16191d"),
    (".edge, .tie", "stroke", "#6b7580", "#8f9aa6"),
    (".box .outline", "stroke", "#3b4754", "#aeb9c4"),
    (".box .outline", "fill", "#ffffff", "#20252b"),
    (".box.control .outline", "fill", "#e6ebf2", "#2e3742"),
    (".box.decorator .outline", "fill", "#eeeaf6", "#352f45"),
    (".box.subtree .outline", "fill", "#e8f1fa", "#233445"),
    (".box.condition .outline", "fill", "#fdf8e6", "#37331f"),
    ("text", "fill", "#14181c", "#eef1f4"),
    ("text.caption", "fill", "#14181c", "#eef1f4"),
    (".note .outline", "fill", "#fff4e2", "#3d2d15"),
    (".note .outline", "stroke", "#a8650f", "#e0a55a"),
    (".note.quality .outline", "fill", "#e7f5ec", "#183625"),
    (".note.quality .outline", "stroke", "#2f7d4f", "#6cc592"),
    (".note.violated .outline", "stroke", "#b3261e", "#ff8f85"),
    (".sparkline .value", "stroke", "#3b4754", "#aeb9c4"),
    (".sparkline .last", "stroke", "#14181c", "#eef1f4"),
    (".sparkline .limit, .sparkline .broken", "stroke", "#b3261e", "#ff8f85"),
)
STYLE: Final = """\
text { font-family: "Helvetica Neue", Helvetica, Arial, "Liberation Sans", sans-serif; text-anchor: middle; }
text.title, text.caption { font-weight: bold; }
text.caption { text-anchor: start; }
.note text { text-anchor: start; }
.edge, .tie { fill: none; stroke-width: 1.2; }
.tie { stroke-dasharray: 2 3; }
.box .outline { stroke-width: 1.4; }
.box.unknown .outline { stroke-dasharray: 5 3; }
.note .outline { stroke-width: 1.2; }
.note.monitored .outline, .note.quality .outline { stroke-dasharray: 6 3; }
.note.enforced .outline { stroke-width: 2.4; }
.note.reviewed .outline { stroke-dasharray: 1.5 2.5; }
.note.violated .outline { stroke-width: 2.4; }
.sparkline path { fill: none; stroke-width: 1.2; }
.sparkline .limit { stroke-dasharray: 5 3; }
.sparkline .broken { stroke-width: 1.8; }
.sparkline .last { stroke-width: 5; stroke-linecap: round; }
"""


def colours(dark: bool) -> str:
    """The colours of the classes, as rules of a style sheet."""
    return "".join(f"{part} {{ {what}: {dark_ if dark else light}; }}\n" for part, what, light, dark_ in _COLOURS)


def render(figures: Sequence[Figure], direction: str) -> str:
    """Figures below each other, each with its title, as a standalone document."""
    drawings = [place(figure, direction) for figure in figures]
    title = ", ".join(drawing.title for drawing in drawings)
    widths = [max(each.width, width(each.title, TITLE, bold=True) + 2 * MARGIN) for each in drawings]
    total = max(widths, default=2 * MARGIN)
    height = sum(drawing.height + _CAPTION for drawing in drawings)
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{total}" height="{height}" viewBox="0 0 {total} {height}"'
        ' role="img" aria-labelledby="title">',
        f'<title id="title">{escape(title)}</title>',
        f"<style>\n{STYLE}{colours(False)}@media (prefers-color-scheme: dark) {{\n{colours(True)}}}\n</style>",
        f'<rect class="ground" width="{total}" height="{height}"/>',
    ]
    top = 0
    for drawing in drawings:
        caption = escape(drawing.title)
        lines.append(f'<text class="caption" font-size="{TITLE}" x="{MARGIN}" y="{top + 20}">{caption}</text>')
        lines.append(f'<g transform="translate(0 {top + _CAPTION})">')
        lines += _drawn(drawing)
        lines.append("</g>")
        top += drawing.height + _CAPTION
    return "\n".join((*lines, "</svg>")) + "\n"


def part(drawing: Drawing, label: str) -> str:
    """A drawing for a page, which has the style sheet and may shrink it to 70 %; `label`: for screen readers."""
    lines = [
        f'<svg class="tree" width="{drawing.width}" height="{drawing.height}"'
        f' viewBox="0 0 {drawing.width} {drawing.height}" style="min-width: {drawing.width * 7 // 10}px"'
        f' role="group" aria-label="{escape(label)}">',
        *_drawn(drawing),
        "</svg>",
    ]
    return "\n".join(lines)


def _drawn(drawing: Drawing) -> Iterator[str]:
    """The elements of a drawing, lines below boxes."""
    for box in drawing.boxes:
        if box.edge:
            yield f'<path class="edge" d="{_path(box.edge)}"/>'
        if box.ties:
            yield f'<path class="tie" d="{_path(box.ties)}"/>'
    for box in drawing.boxes:
        above = drawing.boxes[box.box.parent].box.key if box.box.parent is not None else ""
        yield from _box(box, above)
        for note in box.notes:
            yield from _note(note)


def _box(placed: PlacedBox, above: str) -> Iterator[str]:
    box, area = placed.box, placed.area
    x = area.middle[0]
    names = " ".join(dict.fromkeys(note.note.key for note in placed.notes))
    data = f' data-notes="{escape(names)}"' if names else ""
    if box.name:  # a page folds by it
        data += f' data-name="{escape(box.name)}" data-parent="{escape(above)}" data-hidden="{box.hidden}"'
    state = f" {box.state}" if box.state else ""
    yield f'<g class="box {box.outline}{state}" id="{escape(box.key)}"{data}>'
    if box.link:  # which has the title, its name to a screen reader
        yield f'<a href="{escape(box.link)}">'
    yield f"<title>{escape(box.text or box.title)}</title>"
    yield _outline(box.outline, area)
    top = area.y + (area.h - len(placed.lines) * LEADING) // 2 + 12
    for number, line in enumerate(placed.lines):
        kind, size = ("title", TITLE) if number == 0 else ("small", SMALL)
        yield f'<text class="{kind}" font-size="{size}" x="{x}" y="{top + number * LEADING}">{escape(line)}</text>'
    yield from ("</a>", "</g>") if box.link else ("</g>",)


def _note(placed: PlacedNote) -> Iterator[str]:
    note, area = placed.note, placed.area
    states = " ".join(filter(None, (note.kind, note.state, *dict.fromkeys(each.verdict for each in note.measured))))
    yield f'<g class="note {states}" data-note="{escape(note.key)}">'
    if note.link:
        yield f'<a href="{escape(note.link)}">'
    yield f"<title>{escape(note.text or note.title)}</title>"
    radius, left = 3, area.x + 8
    if note.kind == "quality" and len(placed.lines) == 1:
        radius, left = area.h // 2, area.x + (area.w - width(placed.lines[0][1], SMALL, bold=True)) // 2
    yield f'<rect class="outline" x="{area.x}" y="{area.y}" width="{area.w}" height="{area.h}" rx="{radius}"/>'
    for number, (y, line) in enumerate(placed.lines):
        kind = "title" if number == 0 else "small"
        yield f'<text class="{kind}" font-size="{SMALL}" x="{left}" y="{y}">{escape(line)}</text>'
    for inside, measured in placed.sparklines:
        yield from sparkline(measured, inside)
    yield from ("</a>", "</g>") if note.link else ("</g>",)


def _outline(outline: str, area: Rectangle) -> str:
    x, y, w, h = area.x, area.y, area.w, area.h
    if outline == "condition":
        return f'<ellipse class="outline" cx="{x + w // 2}" cy="{y + h // 2}" rx="{w // 2}" ry="{h // 2}"/>'
    if outline == "decorator":
        tip = 12
        points = ((x, y + h // 2), (x + tip, y), (x + w - tip, y), (x + w, y + h // 2), (x + w - tip, y + h))
        corners = " ".join(f"{a},{b}" for a, b in (*points, (x + tip, y + h)))
        return f'<polygon class="outline" points="{corners}"/>'
    if outline == "subtree":
        left, right = x + 6, x + w - 6
        bars = f"M{left} {y}V{y + h}M{right} {y}V{y + h}"
        return f'<path class="outline" d="M{x} {y}H{x + w}V{y + h}H{x}Z{bars}"/>'
    return f'<rect class="outline" x="{x}" y="{y}" width="{w}" height="{h}" rx="{2 if outline == "action" else 0}"/>'


def _path(line: Line) -> str:
    return "M" + "L".join(f"{x} {y}" for x, y in line)


def sparkline(measured: MeasuredClause, area: Rectangle) -> Iterator[str]:
    """The elements of a sparkline of at least one value that fills a rectangle."""
    numbers = [value for value, _ in measured.values if value is not None]
    low, high = min((*numbers, *measured.bounds)), max((*numbers, *measured.bounds))
    step = area.w / max(len(measured.values) - 1, 1)

    def down(value: float) -> float:
        return round(area.y + (area.h - (value - low) / (high - low) * area.h if high > low else area.h / 2), 1)

    points = [
        (round(area.x + place * step, 1), down(value), is_broken) if value is not None else None
        for place, (value, is_broken) in enumerate(measured.values)
    ]
    yield f'<g class="sparkline"><title>{escape(measured.text)}</title>'
    yield from (f'<path class="limit" d="M{area.x} {down(bound)}h{area.w}"/>' for bound in measured.bounds)
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


_CAPTION: Final = 28
