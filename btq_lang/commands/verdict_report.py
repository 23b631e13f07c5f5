"""Writes a report of `btq verify` as the command line asks for it."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Sequence
from typing import TYPE_CHECKING

from btq_lang.commands.output import form_of, is_coloured, terminal_width, write_output
from btq_lang.commands.verdict_events import write_events
from btq_lang.commands.verdict_formats import FORMATS, write
from btq_lang.commands.verdict_summary import write_summary
from btq_lang.evidence.folding import folded
from btq_lang.evidence.notes import foreign_runs
from btq_lang.evidence.verdicts import SATISFIED, VIOLATED
from btq_lang.projects.options import refuse

if TYPE_CHECKING:
    from btq_lang.evidence.identity import Candidate
    from btq_lang.evidence.verdicts import VerdictReport
    from btq_lang.evidence.verifying import Verification


def finish(options: Namespace, found: Verification, missions: Sequence[Candidate], logs: Sequence[str]) -> int:
    """Print what was found; returns the exit code.

    Args:
        missions, logs: that were compared.
    """
    report = found.report
    remarks = report.remarks if form_of(options, FORMATS) != "table" else ()  # the table has them
    for note in folded((*remarks, *foreign_runs(report))):
        print(f"btq verify: {note}", file=sys.stderr)
    code = print_report(options, report, missions)
    if options.events is not None:
        write_events(options.events, report, logs)
    refuse(*folded(found.problems))
    return code


def print_report(options: Namespace, report: VerdictReport, missions: Sequence[Candidate]) -> int:
    """Write the verdicts as a command line asks for them; returns the exit code.

    Args:
        missions: as of `write`.
    """
    if options.summary is not None:
        write_summary(options.summary, report)
        return 0
    to_terminal = options.output is None and sys.stdout.isatty()
    form = form_of(options, FORMATS)
    text = write(
        report,
        missions,
        form,
        colour=is_coloured(options, to_terminal),
        verbose=options.verbose,
        width=terminal_width() if to_terminal else None,
    )
    write_output(options.output, text, form)
    wrong = report.verdicts - {SATISFIED} if options.strict else report.verdicts & {VIOLATED}
    return int(bool(wrong) and not options.exit_zero)
