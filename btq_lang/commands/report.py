"""`btq report`: what a store has, as one page."""

from __future__ import annotations

import sys
from argparse import Namespace

from btq_lang.commands.output import page_problem, write_output
from btq_lang.commands.stored import NO_STORE, store_of_project


def run(options: Namespace) -> int:
    """Write the page; returns the exit code."""
    store = options.store or store_of_project()
    problem = page_problem(options.output)
    if problem or store is None:
        print(f"btq report: {problem or NO_STORE}", file=sys.stderr)
        return 2
    from btq_lang.evidence.report.overview import overview
    from btq_lang.evidence.report.page import render
    from btq_lang.evidence.store.engine import NoEngine, asked

    try:
        found = overview(asked(store), store, options.by or ("label", "robot"))
    except NoEngine as error:
        print(f"btq report: {error}", file=sys.stderr)
        return 2
    return write_output("report", options.output, render(found)) or int(found.is_worse)
