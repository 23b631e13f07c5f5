"""`btq trace`: which requirements hold for which nodes, how they are enforced, and what is missing."""

from __future__ import annotations

import sys
from argparse import Namespace

from btq_lang.commands.output import form_of, form_problem, is_coloured, tell, terminal_width, write_output
from btq_lang.projects.files import Files, no_mission_below, usage_problem
from btq_lang.projects.options import refuse
from btq_lang.trace import FORMATS
from btq_lang.trace.missions import trace_tables
from btq_lang.trace.wording import incomplete


def run(options: Namespace) -> int:
    """Write the overview; for missions with errors, of all valid parts."""
    refuse(usage_problem(options.paths) or form_problem(options, FORMATS))
    from btq_lang.commands.given_evidence import verdicts_for  # it imports the readers of logs

    groups, problems = Files().groups(options.paths, options.stdin_filename)
    tell(problems)
    refuse(no_mission_below(options.paths, groups))
    if problems:
        return 2
    wrong: list[str] = []
    verdicts_of = verdicts_for(options.evidence, groups, wrong)
    for each in wrong:
        print(f"btq trace: {each}", file=sys.stderr)
    parts = [(group.workspace, group.given) for group in groups]
    table = trace_tables(parts, options.bundle, verdicts_of=verdicts_of)
    to_terminal = options.output is None and sys.stdout.isatty()
    colour = is_coloured(options, to_terminal)
    form = form_of(options, FORMATS)
    text = table.write(form, colour=colour, width=terminal_width() if to_terminal else 120)
    write_output(options.output, text, form)
    if wrong:
        return 2
    if why := incomplete(table.overview):
        print(f"btq trace: {why}", file=sys.stderr)
    return int(table.errors > 0)
