"""Run-time evidence: a verdict for each requirement, from logs of what robots did.

One invariant: what a log does not show is unknown, with the reason; nothing is guessed, and no clause is left out.

    readers/       a module a format: files to sessions
    model.py       what a log holds: the tree that ran, transitions, activations, samples
    runs.py, begins.py   transitions to activations and runs, and when nodes began
    identity.py    which node of a log is which written node
    meanings.py    which verdicts are on requirements that meant something else
    named_runs.py  the same for a log without a tree, run by run
    signals.py, history.py   values of signals at a moment, and what nodes did in the open run
    observed.py, conditions.py   what was observed during an activation or a run, whether conditions held, and measures
    guards.py      what the nodes that a build adds around others did
    verbs.py, run_verbs.py, visits.py, use.py   a function a verb: the judgement of an activation or of a run; what is
                   used up
    kept_spans.py  keeps and never from an event until another one
    over_run.py    what a clause judged over a run reads: what its nodes did, and when events happened
    time_shares.py, exposure.py   a share of the time in which a node is active, and what a run adds to a failure rate
    scopes.py      which activations count
    outline.py     the clauses of a mission and their places, which identify them in a later text
    clause_findings.py   the counts of a clause, also in a sliding window, and its verdict
    clause_nodes.py   the nodes of a log that a clause holds for
    clause.py, evaluate.py   a clause, and all clauses of a mission, judged while a log is read
    edges.py, margins.py, rejudging.py   the counts for every bound, and a clause judged again with an edited one
    tally.py, odds.py   judgements counted, and confidence limits
    pools.py, rates.py, amounts.py, means.py   what all runs come to together: a failure rate, a mean
    poisson.py, student.py   the confidence limits of these
    explain.py, explain_run.py   what led to a violation
    distribution.py, timeline.py   a histogram of values, and a run with its signals, for the page
    coverage.py    which nodes ran, how long they took and blocked the tree, and which contexts held
    store/         the findings of each log, kept and summarised
    compare/       two versions in a store compared
    report/        the overview of a store as a page
    verdicts.py    the report, as data
    sentences.py, wording.py   a clause's result, and what to look at, in a sentence; measures and times in words
    judging.py     one log judged by itself, or many in several processes, and all of them added up
    watching.py    a running robot: verdicts as they fall
    repeats.py     logs that are given under two names, and runs that several logs hold
    own_trees.py, node_rows.py   logs whose mission is unknown, and what each node did
    folding.py     remarks on very many logs in a few lines
    one_run.py     one run of a log, step by step
    verifying.py, notes.py, signal_sources.py   all of it in one call, and notes beside the verdicts
    boxes.py       verdicts for the boxes of a drawing
    events.py      the violations as messages of a bag
    table.py, json_document.py, csv_rows.py, junit.py, markdown.py   the writers; JSON is also read
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from btq_lang.evidence.verdicts import VerdictReport

FORMATS: Final = ("table", "json", "csv", "junit", "markdown")
_MODULES: Final = {"json": "json_document", "csv": "csv_rows"}  # named otherwise


def write(
    report: VerdictReport, form: str, *, colour: bool = False, verbose: bool = False, width: int | None = None
) -> str:
    """Write the verdicts in one of FORMATS.

    Args:
        colour: ANSI colours, for `table`.
        verbose: for `table`: show more violations of each clause.
        width: for `table`: the columns of the terminal; None: lines are not broken.

    Raises:
        ValueError: there is no such format.
    """
    if form not in FORMATS:
        raise ValueError(f"unknown format {form!r}; expected one of {', '.join(FORMATS)}")
    options = {"colour": colour, "verbose": verbose, "width": width} if form == "table" else {}
    text: str = import_module(f"{__name__}.{_MODULES.get(form, form)}").render(report, **options)
    return text
