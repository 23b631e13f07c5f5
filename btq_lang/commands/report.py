"""`btq report`: what a store has, as one page."""

from __future__ import annotations

from collections.abc import Sequence

from btq_lang.commands.output import page_problem, write_output
from btq_lang.commands.stored import NO_STORE, meanings_here, store_of_project
from btq_lang.projects.messages import CommandOutput
from btq_lang.projects.options import Refused
from btq_lang.util.record import Record


class ReportOptions(Record):
    """The options of `btq report`.

    Attributes:
        by: what has columns or rows of its own, `label` or `robot`; none: both.
        sides: the two labels to compare; None: the last two.
    """

    store: str | None
    by: Sequence[str]
    sides: Sequence[str] | None
    output: str | None


def run(options: ReportOptions, messages: CommandOutput) -> int:
    """Write the page."""
    store = options.store or store_of_project()
    problem = page_problem(options.output)
    if problem or store is None:
        raise Refused(problem or NO_STORE)
    from btq_lang.evidence.compare.comparison import UnknownSide
    from btq_lang.evidence.report.overview import overview
    from btq_lang.evidence.report.page import render
    from btq_lang.evidence.store.engine import NoEngine, asked

    try:
        page = overview(asked(store), store, options.by or ("label", "robot"), options.sides or (), meanings_here())
    except (NoEngine, UnknownSide) as error:
        raise Refused(error) from error
    write_output(messages, options.output, render(page))
    return int(page.is_worse)
