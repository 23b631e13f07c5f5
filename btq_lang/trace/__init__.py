"""The overview of missions for safety engineers: requirements with quality, nodes, enforcement and places.

One invariant: every fact is in exactly one row with a key, and the same missions give the same overview.

    overview.py    the rows
    collect.py     a workspace as an overview
    chain.py       which requirements refine and mitigate what, also of other tools
    scenario_results.py   what came of scenarios, by results that were given
    metadata.py    hazards, and what requirements say beside their demands
    selection.py   some of the requirements, and what these concern
    ways.py        how clauses are covered
    missions.py    how the built tree covers them, and all of it in one call
    meanings.py    the meaning of quality names
    wording.py     sentences that several writers print
    judged.py      the runs by which requirements are judged
    states.py      the state of a requirement in one word, and its sign
    first_screen.py   what the page opens with; marked_trees.py, its trees
    verdicts.py    verdicts on the page
    run_figure.py  what the nodes of a run did
    table.py, csv_rows.py, json_document.py, needs_json.py, markdown.py, page.py   the writers
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from btq_lang.trace.overview import Overview

# The command line needs them for every command, so no writer is imported here.
FORMATS: Final = ("table", "csv", "json", "markdown", "html", "needs-json")
_MODULES: Final = {
    "csv": "csv_rows",
    "json": "json_document",
    "html": "page",
    "needs-json": "needs_json",
}  # named otherwise


def write(overview: Overview, form: str, *, colour: bool = False, width: int = 120) -> str:
    """Write the overview in one of FORMATS.

    Args:
        colour: ANSI colours, for `table`.
        width: the columns of the terminal, for `table`.

    Raises:
        ValueError: there is no such format.
    """
    if form not in FORMATS:
        raise ValueError(f"unknown format {form!r}; expected one of {', '.join(FORMATS)}")
    options = {"colour": colour, "width": width} if form == "table" else {}
    text: str = import_module(f"{__name__}.{_MODULES.get(form, form)}").render(overview, **options)
    return text
