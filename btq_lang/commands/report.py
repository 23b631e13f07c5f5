"""`btq report`: what a store has, as one page."""

from __future__ import annotations

from argparse import Namespace

from btq_lang.commands.output import page_problem, write_output
from btq_lang.commands.stored import NO_STORE, store_of_project
from btq_lang.projects.options import Refused


def run(options: Namespace) -> int:
    """Write the page; returns the exit code."""
    store = options.store or store_of_project()
    problem = page_problem(options.output)
    if problem or store is None:
        raise Refused(problem or NO_STORE)
    from btq_lang.evidence.compare.comparison import UnknownSide
    from btq_lang.evidence.report.overview import overview
    from btq_lang.evidence.report.page import render
    from btq_lang.evidence.store.engine import NoEngine, asked

    try:
        page = overview(asked(store), store, options.by or ("label", "robot"), options.sides or ())
    except (NoEngine, UnknownSide) as error:
        raise Refused(error) from error
    write_output(options.output, render(page))
    return int(page.is_worse)
