"""Where the report of `btq check` goes, and in which format."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Mapping
from itertools import chain

from btq_lang.commands.output import FOR_PEOPLE, is_coloured, mission_problem, terminal_width, write_output
from btq_lang.projects.files import STDIN
from btq_lang.projects.messages import CommandOutput
from btq_lang.projects.options import CheckOptions
from btq_lang.render import Report, render, with_paths
from btq_lang.util.text import counted
from btq_lang.workspace.loader import absolute, shown


def form_of(options: CheckOptions, environment: Mapping[str, str]) -> str:
    """The requested format; else one that a code host reads by itself there, else `full`.

    GitHub reads annotations in the output of a job; GitLab does not, but reads a file that the job names.
    """
    if options.output_format or options.statistics:
        return options.output_format or "full"
    if environment.get("GITHUB_ACTIONS") == "true" and not options.output_file:
        return "github"
    if environment.get("GITLAB_CI") == "true" and options.output_file:
        return "gitlab"
    return "full"


def report_problem(options: CheckOptions) -> str | None:
    """The usage error in what is to be written, and where."""
    if options.diff and (options.statistics or options.output_file):
        other = "--statistics" if options.statistics else "--output-file"
        return f"--diff shows changes instead of findings; leave out {other}"
    if options.statistics:
        from btq_lang.render.rule_counts import FORMATS

        if options.output_format and options.output_format not in FORMATS:
            return f"--statistics cannot be written as {options.output_format}; choose one of {', '.join(FORMATS)}"
    if options.output_file is not None:
        return mission_problem("--output-file", options.output_file, options.output_format)
    return None


def write_report(report: Report, options: CheckOptions, mended: int, messages: CommandOutput) -> None:
    """Write the report where the options say, with the number of applied fixes.

    Raises:
        Refused: the file cannot be written.
    """
    form = form_of(options, os.environ)
    # With --fix, standard output has the new text of standard input, so the report goes to standard error.
    stream = sys.stderr if options.fix and STDIN in options.paths else sys.stdout
    width = terminal_width() if stream.isatty() and not options.output_file else 120
    colour = options.color == "always" if options.output_file else is_coloured(options.color, stream.isatty())
    pieces = _pieces(_with_shown_paths(report, form), form, options.statistics, colour, width)
    is_shown = mended and form in FOR_PEOPLE and not options.quiet
    last = f"Fixed {counted(mended, 'problem')}\n" if is_shown else ""
    if options.output_file or (form not in FOR_PEOPLE and stream is sys.stdout):
        write_output(messages, options.output_file, "".join((*pieces, last)), form)
    else:
        for piece in chain(pieces, (last,)):
            messages.add(piece, "remark" if stream is sys.stderr else "result")


def _pieces(report: Report, form: str, is_counted: bool, colour: bool, width: int) -> Iterator[str]:
    if is_counted:
        from btq_lang.render import rule_counts

        return rule_counts.render(form, report)
    return render(form, report, colour=colour, width=width)


def _with_shown_paths(report: Report, form: str) -> Report:
    """The report with paths relative to the current folder, or, for GitLab, to its checkout."""
    checkout = os.environ.get("CI_PROJECT_DIR") if form == "gitlab" else None
    if not checkout:
        return with_paths(report, shown)
    inside = absolute(checkout).rstrip("/") + "/"
    return with_paths(report, lambda path: path.removeprefix(inside))
