"""The runs that violate a clause, as tables: the first ones, and the others folded; all, if its odds allow them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from html import escape
from typing import TYPE_CHECKING, Final

from btq_lang.evidence.sentences import reason
from btq_lang.evidence.verdicts import VIOLATED
from btq_lang.evidence.wording import clock_time, duration
from btq_lang.trace.page_parts import coded
from btq_lang.util.text import counted

if TYPE_CHECKING:
    from btq_lang.evidence.verdicts import ClauseVerdict, Violation


def violating_runs(requirement: str, clause: ClauseVerdict, medians: Mapping[str, float]) -> Iterator[str]:
    """A row for each violation that is kept.

    Args:
        requirement: its name.
        medians: how long nodes take, in seconds by path.
    """
    drawn = clause.timeline.run if clause.timeline is not None else None
    rows = [_row(clause, each, drawn, medians) for each in clause.violations]
    caption = f"Runs that violate {requirement}: {clause.text}"
    shown = _SHOWN if clause.verdict == VIOLATED else 0
    if shown:
        yield from _table(caption, rows[:shown])
    if more := rows[shown:]:
        number = counted(len(more), "more violation" if shown else "violation")
        yield f"<details><summary>{number} of {escape(requirement)}</summary>"
        yield from _table(f"{caption}, continued" if shown else caption, more)
        yield "</details>"
    if (rest := clause.violated - len(rows)) > 0:
        yield f"<p>{counted(rest, 'violation')} more of {escape(requirement)} not listed.</p>"


def _table(caption: str, rows: list[str]) -> Iterator[str]:
    yield f'<table class="violating"><caption>{escape(caption)}</caption><thead><tr>'
    yield "".join(f'<th scope="col">{head}</th>' for head in _HEADS)
    yield "</tr></thead><tbody>"
    yield from rows
    yield "</tbody></table>"


def _row(clause: ClauseVerdict, violation: Violation, drawn: int | None, medians: Mapping[str, float]) -> str:
    run = f"{violation.run} of {violation.source}"
    link = f'<a href="#run-{violation.run}">{escape(run)}</a>' if violation.run == drawn else escape(run)
    after = f"{duration(violation.at)} after the start at {clock_time(violation.start)}".removesuffix(" at ")
    why = f"{clause.of or violation.path}: {reason(violation, medians)}"
    cells = (after, violation.measured or "\N{EN DASH}", why)
    row = "".join(f'<td data-of="{head}">{coded(cell)}</td>' for head, cell in zip(_HEADS[1:], cells, strict=True))
    return f'<tr><th scope="row" data-of="Run">{link}</th>{row}</tr>'


_SHOWN: Final = 10
_HEADS: Final = ("Run", "Time", "Measured", "Why")

VIOLATING_STYLE: Final = """\
.violating { margin: 1rem 0 .5rem; }
.violating caption { color: var(--ink); font-weight: 600; }
.violating th, .violating td { padding: .25rem .6rem; }
.violating thead th:nth-child(1) { width: 18%; } .violating thead th:nth-child(2) { width: 28%; }
.violating thead th:nth-child(3) { width: 8rem; }
@media (max-width: 700px) { .violating, .violating caption, .violating tbody, .violating tr, .violating tbody th,
  .violating td { display: block; } .violating thead { display: none; }
  .violating tr { border-bottom: 1px solid var(--line); } .violating tbody th, .violating td { border: 0; }
  .violating [data-of]::before { content: attr(data-of) ": "; color: var(--soft); } }
"""
