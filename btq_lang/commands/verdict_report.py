"""Writes a report of `btq verify` as the command line asks for it."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Sequence
from typing import TYPE_CHECKING

from btq_lang.commands.output import form_of, is_coloured, terminal_width, write_output
from btq_lang.commands.verdict_formats import FORMATS, write
from btq_lang.evidence.verdicts import SATISFIED, VIOLATED

if TYPE_CHECKING:
    from btq_lang.evidence.identity import Candidate
    from btq_lang.evidence.verdicts import Report


def print_report(options: Namespace, report: Report, missions: Sequence[Candidate]) -> int:
    """Write the verdicts as a command line asks for them; returns the exit code.

    Args:
        missions: as of `write`.
    """
    to_terminal = options.output is None and sys.stdout.isatty()
    text = write(
        report,
        missions,
        form_of(options, FORMATS),
        colour=is_coloured(options, to_terminal),
        verbose=options.verbose,
        width=terminal_width() if to_terminal else None,
    )
    if code := write_output("verify", options.output, text):
        return code
    wrong = report.verdicts - {SATISFIED} if options.strict else report.verdicts & {VIOLATED}
    return int(bool(wrong))
