"""Run-time evidence: a verdict for each requirement, from logs of what robots did.

One invariant: what a log does not show is unknown, with the reason; nothing is guessed, and no clause is left out.

    readers/       a module a format: files to sessions
    model.py       what a log holds: the tree that ran, transitions, activations, samples
    runs.py        transitions to activations and runs
    identity.py    which node of a log is which written node
    named_runs.py  the same for a log without a tree, run by run
    signals.py, history.py   values of signals at a moment, and what nodes did in the open run
    observed.py, conditions.py   what was observed during an activation or a run, and whether conditions held
    guards.py      what the nodes that a build adds around others did
    verbs/         a module a verb: the judgement of an activation or a run
    limits.py, over_run.py   shared by verbs: measures compared with bounds, and when events happened
    scopes.py      which activations count
    outline.py   the clauses of a mission and where they are, so that a later text is known again
    clause.py, evaluate.py   a clause, and all clauses of a mission, judged while a log is read
    edges.py, margins.py, rejudging.py   the counts for every bound, and a clause judged again with an edited one
    tally.py, recent.py, odds.py   judgements counted, over all runs or the last ones, and confidence limits
    explain.py, explain_run.py   what led to a violation
    distribution.py, timeline.py   a histogram of values and a timeline of a run, for the page
    coverage.py, ticks.py   which nodes ran, how long they took, and how long they blocked the tree
    store/         what was found in each log, kept and summarised
    compare/       two versions in a store compared
    verdicts.py    the report, as data
    sentences.py   a clause's result, and what to look at, in a sentence
    judging.py, parallel.py   one log judged by itself, by one of several processes, and all of them added up
    watching.py    a running robot: verdicts as they fall
    verifying.py, notes.py, signal_sources.py   all of it in one call, and notes beside the verdicts
    events.py      the violations as messages of a bag
    table.py, json_document.py, csv_rows.py, junit.py, markdown.py   the writers
    written_verdicts.py   reads what json_document.py has written; `trace/` draws the HTML page
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from importlib import import_module
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from btq_lang.evidence.identity import Candidate
    from btq_lang.evidence.model import Series
    from btq_lang.evidence.store.sets import Keeping
    from btq_lang.evidence.verdicts import Report
    from btq_lang.workspace.project_evidence import SignalSource

FORMATS: Final = ("table", "json", "csv", "junit", "markdown")
_MODULES: Final = {"json": "json_document", "csv": "csv_rows"}  # named otherwise


def verify(
    logs: Sequence[str],
    missions: Sequence[Candidate],
    samples: Mapping[str, Series],
    shown: Callable[[str], str],
    sources: Sequence[SignalSource] = (),
    of_files: Mapping[str, Series] | None = None,
    *,
    with_timelines: bool = False,
    with_measures: bool = False,
    jobs: int = 1,
    keeping: Keeping | None = None,
    progress: Callable[[int, int], None] = lambda files, runs: None,
) -> Report:
    """Judge missions by logs.

    Args:
        logs: the files; one that cannot be read is a problem of the report, and the others are judged.
        samples: samples of signals, by the signal's name or its entry.
        shown: gives a path as people read it.
        sources: where further samples come from, with lower priority; topics are read from the bags among the logs.
        of_files: the samples of those sources that are files.
        progress: called with how many logs have been read, and how many runs have been judged.
        with_timelines: include the run of the worst violation of each clause.
        with_measures: include what is needed to judge clauses with other bounds.
        keeping: where what is found in each log is kept; None: nowhere.
        jobs: how many processes judge logs; the report is the same.
    """
    from btq_lang.evidence.judging import Judging, Means, judge
    from btq_lang.evidence.readers import samples_of_bags

    of_bags, remarks, bags = samples_of_bags(logs, sources)
    of = samples, sources, of_files or {}, of_bags
    means = Means(missions, *of, remarks, shown, with_timelines, keeping, with_measures=with_measures)
    judging = Judging(means)
    wanted = [log for log in logs if log not in bags]
    if jobs > 1 and len(wanted) > 1:
        from btq_lang.evidence.parallel import judge_all

        for number, found in enumerate(judge_all(wanted, means, jobs), start=1):
            judging.add(found)
            progress(number, judging.runs)
    else:
        for number, log in enumerate(wanted):
            of_log = partial(_progress, progress, number, judging.runs)
            judging.add(judge(log, means, of_log))
    return judging.report()


def _progress(progress: Callable[[int, int], None], files: int, runs: int, run: int) -> None:
    progress(files, runs + run)


def write(report: Report, form: str, *, colour: bool = False, verbose: bool = False, width: int | None = None) -> str:
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
