"""`btq trace`: which requirements hold for which nodes, how they are held, and what is missing."""

from __future__ import annotations

import os
import sys
from argparse import Namespace

from btq_lang.checks import check
from btq_lang.commands.files import Files, Group, usage_problem
from btq_lang.commands.output import write_output
from btq_lang.loader import shown
from btq_lang.render.colour import wants_colour
from btq_lang.rules import Severity
from btq_lang.trace import collect, write


def run(options: Namespace) -> int:
    """Write the overview; of missions with errors what could be understood."""
    if problem := usage_problem(options.paths):
        print(f"btq trace: {problem}", file=sys.stderr)
        return 2
    groups, problems = Files().groups(options.paths, options.stdin_filename)
    for each in problems:
        print(f"btq: {each}", file=sys.stderr)
    if problems:
        return 2
    overview = collect([(group.workspace, group.given) for group in groups], shown=shown)
    to_terminal = options.output is None and sys.stdout.isatty()
    colour = options.color == "always" or (options.color == "auto" and wants_colour(to_terminal, os.environ))
    text = write(overview, options.format, colour=colour, width=_width() if to_terminal else 120)
    if code := write_output("trace", options.output, text):
        return code
    errors = sum(_errors(group) for group in groups)
    if errors:
        what = "an error" if errors == 1 else f"{errors} errors"
        print(f"btq trace: the missions have {what}, so something may be missing: see btq check", file=sys.stderr)
    return int(errors > 0)


def _errors(group: Group) -> int:
    paths = dict.fromkeys(path for each in group.given for path in group.workspace.closure(each))
    found = (each for path in paths for each in check(group.workspace, path))
    return sum(each.effective_severity is Severity.ERROR for each in found)


def _width() -> int:
    try:
        return os.get_terminal_size().columns
    except OSError:
        return 120
