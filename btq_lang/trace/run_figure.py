"""The drawing of a run: what its nodes did, where it broke clauses, and signals below it, on one axis of time.

One invariant: all that is drawn is placed in percent of the run, so it fits into any window; every fact in it is also
in a text, and colour is never the only sign.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from html import escape
from typing import TYPE_CHECKING, Final

from btq_lang.catalog.units import Unit, parse_unit
from btq_lang.evidence.verdicts import OUTCOMES
from btq_lang.evidence.wording import duration, quantity, timestamp
from btq_lang.render.axis import round_values
from btq_lang.trace.page_parts import coded
from btq_lang.util.grouping import grouped
from btq_lang.util.record import Record
from btq_lang.util.text import counted

if TYPE_CHECKING:
    from btq_lang.evidence.model import SampleValue
    from btq_lang.evidence.verdicts import SignalLine, Timeline, Violation


class Breach(Record):
    """A violation in the run; key: of the requirement's row on the page, empty if it has none."""

    requirement: str
    key: str
    violation: Violation


def run_figure(timeline: Timeline, breaches: Sequence[Breach]) -> Iterator[str]:
    """The lines of the figure.

    Args:
        breaches: in this run.
    """
    length = timeline.length or _LEAST
    name = f"Run {timeline.run} of {timeline.source}"
    yield f'<figure class="run" id="run-{timeline.run}"><figcaption><h3>{escape(name)}</h3>'
    yield f" <small>from {timestamp(timeline.start)}, {duration(length)}</small></figcaption>"
    yield '<p class="legend"><span class="key S">succeeded</span> <span class="key F">failed</span>'
    yield '<span class="key H">halted</span> <span class="key O">interrupted</span>'
    yield '<span class="key breach">\N{HEAVY MULTIPLICATION X} broke a clause</span></p>'
    if timeline.left_out:
        yield f"<p>{counted(timeline.left_out, 'activation')} more are not drawn.</p>"
    if more := len(breaches) - _BREACHES:
        yield f"<p>{counted(more, 'violation')} more in this run are not marked.</p>" if more > 0 else ""
    marks = grouped((each.violation.path, each) for each in breaches[:_BREACHES])
    times = round_values(0, length, _TIMES, is_time=True)
    grid = f' style="--grid: {_share(times[1], length)}"' if len(times) > 1 else ""
    yield f'<table class="timeline"{grid}><caption>{escape(name)}: activations of nodes by time</caption><tbody>'
    for (path, depth), bars in grouped(((bar.path, bar.depth), bar) for bar in timeline.bars).items():
        own = marks.pop(path, [])
        inset = f"padding-left: {min(depth, _DEEPEST) * 0.8 + 0.4:g}rem"
        yield f'<tr><th scope="row" style="{inset}">{escape(path)}</th><td>'
        for bar in bars:
            at = f"left: {_share(bar.begin, length)}; width: {_share(bar.end - bar.begin, length)}"
            after = f" after {bar.took}," if bar.took else ""
            title = f"{OUTCOMES[bar.outcome]}{after} {duration(bar.end)} after the start of the run"
            yield f'<span class="bar {bar.outcome}" style="{at}" title="{title}"></span>'
        yield from (_line(each, length) for each in own)
        yield "</td></tr>"
        yield from (_breach(each, length, inset) for each in own)
    for each in (each for others in marks.values() for each in others):  # of nodes that are not drawn
        yield _breach(each, length, "")
    yield "</tbody>"
    if timeline.signals:
        yield '<tbody class="signals">'
        for line in timeline.signals:
            yield from _signal(line, length)
        yield "</tbody>"
    yield f'<tfoot><tr><th scope="row">time in the run</th><td>{_axis(times, length)}</td></tr></tfoot>'
    yield "</table></figure>"


def _share(seconds: float, length: float) -> str:
    return f"{seconds / length:.3%}"


# ---- the axis ----


def _axis(times: Sequence[float], length: float) -> str:
    """The numbers of the axis, of which small windows show every second one."""
    unit = _unit(times[1] if len(times) > 1 else length)
    labels = []
    for place, time in enumerate(times):
        kinds = [*(["minor"] if place % 2 else []), *(["end"] if time > length * _END else [])]
        of = f' class="{" ".join(kinds)}"' if kinds else ""
        labels.append(f'<span{of} style="left: {_share(time, length)}">{quantity(time, unit) if time else 0}</span>')
    return "".join(labels)


def _unit(step: float) -> Unit:
    symbol = next(symbol for least, symbol in _UNITS if step >= least)
    unit = parse_unit(symbol)
    assert unit is not None, "a unit of the table"
    return unit


# ---- violations ----


def _moment(breach: Breach) -> float:
    """When the clause was broken: where a duration passed its bound, else when that was decided."""
    return breach.violation.at if breach.violation.passed is None else breach.violation.passed


def _line(breach: Breach, length: float) -> str:
    return f'<span class="at" style="left: {_share(_moment(breach), length)}"></span>'


def _breach(breach: Breach, length: float, inset: str) -> str:
    """The row that says what happened at the line."""
    violation, at = breach.violation, _moment(breach) / length
    text = f"bound {violation.bound} passed"
    if violation.passed is None:
        text = f"{violation.why}, bound {violation.bound}" if violation.bound else violation.why
    text += f" ({duration(_moment(breach))} after the start)"
    side = f"margin-left: {at:.3%}" if at <= _MIDDLE else f"margin-right: {1 - at:.3%}; text-align: right"
    name = escape(breach.requirement)
    link = f'<a href="#{breach.key}">{name}</a>' if breach.key else name
    head = f'<th scope="row" style="{inset}">\N{HEAVY MULTIPLICATION X} {link}</th>'
    return f'<tr class="breach">{head}<td>{_line(breach, length)}<p style="{side}">{coded(text)}</p></td></tr>'


# ---- signals ----


def _signal(line: SignalLine, length: float) -> Iterator[str]:
    """The row of a signal: a stepped line for numbers, bands with their values for all else."""
    values = [value for _, value in line.points if value is not None]
    ends = [time for time, _ in line.points[1:]] + [length]
    if line.sort != "number":
        left_out = f" <small>{counted(line.left_out, 'later change')} not drawn</small>" if line.left_out else ""
        yield f'<tr><th scope="row">{escape(line.name)}{left_out}</th><td>'
        for (time, value), end in zip(line.points, ends, strict=True):
            if value is not None:
                yield _band(_text(value), time, end, length)
        yield "</td></tr>"
        return
    numbers = [float(value) for value in values]
    extent = " to ".join(dict.fromkeys(quantity(each, line.unit) for each in (min(numbers), max(numbers))))
    bounds = "".join(f"; bound {value.text} of {name}" for name, value in line.bounds)
    yield f'<tr class="number"><th scope="row">{escape(line.name)} <small>{escape(extent + bounds)}</small></th><td>'
    every = [*numbers, *(value.si for _, value in line.bounds)]
    low, high = min(every), max(every)

    def up(value: float) -> float:
        return round(_TALL - _PAD - (value - low) / (high - low or 1.0) * (_TALL - 2 * _PAD), 1)

    first, last = (quantity(each, line.unit) for each in (numbers[0], numbers[-1]))
    label = f"{line.name} from {first} to {last}, between {quantity(min(numbers), line.unit)} and"
    label += f" {quantity(max(numbers), line.unit)}"
    yield f'<svg viewBox="0 0 {_BROAD} {_TALL}" preserveAspectRatio="none" role="img" aria-label="{escape(label)}">'
    yield from (f'<path class="bound" d="M0 {up(value.si):g}H{_BROAD}"/>' for _, value in line.bounds)
    yield f'<path class="line" d="{_steps(line, ends, length, up)}"/></svg>'
    for kind, value in (("top", high), ("bottom", low)) if high > low else (("top", high),):
        yield f'<span class="{kind}">{escape(quantity(value, line.unit))}</span>'
    for place, bound in enumerate(dict.fromkeys(each for _, each in line.bounds)):
        at = f"top: {up(bound.si) / _TALL:.1%}; right: {place * _APART}rem"
        yield f'<span class="bound" style="{at}">{escape(bound.text)}</span>'
    yield "</td></tr>"


def _steps(line: SignalLine, ends: Sequence[float], length: float, up: Callable[[float], float]) -> str:
    """The path of a line whose values hold until the next, broken where none is known."""
    parts: list[str] = []
    is_drawn = False
    for (time, value), end in zip(line.points, ends, strict=True):
        if value is not None:
            x, y = round(time / length * _BROAD, 1), up(float(value))
            parts.append(f"{f'V{y:g}' if is_drawn else f'M{x:g} {y:g}'}H{round(end / length * _BROAD, 1):g}")
        is_drawn = value is not None
    return "".join(parts)


def _band(text: str, begin: float, end: float, length: float) -> str:
    at = f"left: {_share(begin, length)}; width: {_share(end - begin, length)}"
    title = f"{text} from {duration(begin)} to {duration(end)} after the start of the run"
    return f'<span class="band" style="{at}" title="{escape(title)}">{escape(text)}</span>'


def _text(value: SampleValue) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


_LEAST: Final = 1e-6  # s, of a run that took no time
_TIMES: Final = 9  # numbers of the axis
_END: Final = 0.94  # of the run: numbers after that are left of their place
_MIDDLE: Final = 0.5
_UNITS: Final = ((3600.0, "h"), (60.0, "min"), (1.0, "s"), (1e-3, "ms"), (0.0, "us"))
_DEEPEST: Final = 12  # levels that are indented
_BREACHES: Final = 20  # that are marked
_BROAD: Final = 1000  # of the drawing of a signal, in units of its own
_TALL: Final = 100
_PAD: Final = 6
_APART: Final = 4  # rem from the name of a bound to the next

RUN_STYLE: Final = """\
.run { content-visibility: visible; }
.timeline { border: 1px solid var(--line); border-collapse: separate; border-spacing: 0; }
.timeline caption { position: absolute; left: -99rem; }
.timeline th { width: 16rem; padding: .1rem .4rem; font: .8rem ui-monospace, Menlo, Consolas, monospace; }
.timeline td { position: relative; overflow: clip; padding: 0; height: 1.35rem; background-size: var(--grid, 100%) 100%;
  background-image: linear-gradient(to right, var(--line) 1px, transparent 1px); }
.bar { position: absolute; top: .2rem; bottom: .2rem; min-width: 2px; border-radius: 2px; background: var(--enforced); }
.bar.F { background: var(--missing); outline: 1.5px solid var(--ink); }
.bar.H { background: repeating-linear-gradient(45deg, var(--reviewed) 0 4px, var(--ground) 4px 7px); }
.bar.O { background: none; border: 1.5px dashed var(--soft); }
.timeline .at { position: absolute; top: 0; bottom: 0; width: 3px; margin-left: -1px; background: var(--missing);
  outline: 1px solid var(--ground); }
.breach th, .breach td { border-bottom-color: var(--missing); }
.breach th, .breach p, .key.breach { color: var(--missing); font-weight: 600; }
.breach p { margin: 0; padding: .1rem .4rem; font-size: .8rem; }
.signals tr:first-child > * { border-top: 2px solid var(--line); }
.timeline .number td { height: 4.5rem; }
.signals svg { position: absolute; inset: 0; width: 100%; height: 100%; }
.signals path { fill: none; vector-effect: non-scaling-stroke; }
.signals .line { stroke: var(--monitored); stroke-width: 1.75; }
.signals path.bound { stroke: var(--missing); stroke-width: 1.5; stroke-dasharray: 6 4; }
.number span { position: absolute; left: 0; padding: 0 .25rem; font-size: .7rem; line-height: 1.2;
  color: var(--soft); background: var(--ground); opacity: .85; }
.number .top { top: 0; } .number .bottom { bottom: 0; }
.number span.bound { left: auto; transform: translateY(-50%); color: var(--missing); opacity: 1; }
.band { position: absolute; top: .15rem; bottom: .15rem; overflow: hidden; white-space: nowrap; text-overflow: ellipsis;
  padding: 0 .25rem; font-size: .75rem; line-height: 1.1rem; border: 1px solid var(--monitored); border-radius: 2px;
  background: var(--raised); }
.timeline tfoot > tr > * { position: sticky; bottom: 0; height: 1.6rem; border-bottom: 0; color: var(--soft);
  background-color: var(--ground); border-top: 1px solid var(--soft); }
.timeline tfoot span { position: absolute; top: .15rem; font-size: .8rem; white-space: nowrap;
  transform: translateX(-50%); }
.timeline tfoot span:first-child { transform: none; padding-left: .2rem; }
.timeline tfoot .end { transform: translateX(-100%); }
.key.S { border: 0; background: var(--enforced); color: var(--ground); }
.key.F { border: 2px solid var(--ink); background: var(--missing); color: var(--ground); }
.key.H { border: 1.5px solid var(--reviewed); } .key.O { border: 1.5px dashed var(--soft); }
.key.breach { white-space: nowrap; border: 0; border-left: 3px solid var(--missing); border-radius: 0; }
@media (max-width: 700px) { .timeline, .timeline tbody, .timeline tfoot, .timeline tr, .timeline th, .timeline td {
    display: block; width: auto; }
  .timeline th { border-bottom: 0; } .timeline .breach td { height: auto; min-height: 1.35rem; }
  .timeline .minor { display: none; } .timeline tfoot th { display: none; } }
"""
