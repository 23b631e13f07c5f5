"""`btq trace`: which requirements hold for which nodes, how they are enforced, and what is missing."""

from __future__ import annotations

import sys
from argparse import Namespace

from btq_lang.commands.files import Files, no_mission_below, usage_problem
from btq_lang.commands.output import form_of, form_problem, is_coloured, tell, terminal_width, write_output
from btq_lang.trace import FORMATS
from btq_lang.trace.missions import trace_tables


def run(options: Namespace) -> int:
    """Write the overview; for missions with errors, of all valid parts."""
    if problem := usage_problem(options.paths) or form_problem(options, FORMATS):
        print(f"btq trace: {problem}", file=sys.stderr)
        return 2
    groups, problems = Files().groups(options.paths, options.stdin_filename)
    tell(problems)
    if empty := no_mission_below(options.paths, groups):
        print(f"btq trace: {empty}", file=sys.stderr)
    if problems or empty:
        return 2
    table = trace_tables([(group.workspace, group.given) for group in groups], options.bundle)
    to_terminal = options.output is None and sys.stdout.isatty()
    colour = is_coloured(options, to_terminal)
    text = table.write(form_of(options, FORMATS), colour=colour, width=terminal_width() if to_terminal else 120)
    if code := write_output("trace", options.output, text):
        return code
    if table.errors:
        what = "an error" if table.errors == 1 else f"{table.errors} errors"
        print(f"btq trace: the missions have {what}, so the overview may be incomplete; run btq check", file=sys.stderr)
    return int(table.errors > 0)
