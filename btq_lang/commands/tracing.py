"""`btq trace`: which requirements hold for which nodes, how they are enforced, and what is missing."""

from __future__ import annotations

import os
import sys
from argparse import Namespace
from collections.abc import Sequence
from typing import TYPE_CHECKING

from btq_lang.btcpp.bundle import bundle
from btq_lang.btcpp.enforcement import enforced
from btq_lang.btcpp.export import export, is_mission
from btq_lang.checks import check
from btq_lang.commands.files import Files, nothing_below, usage_problem
from btq_lang.commands.output import form_of, form_problem, write_output
from btq_lang.garbage import collecting_seldom
from btq_lang.loader import shown
from btq_lang.render.colour import wants_colour
from btq_lang.requirements import Requirements
from btq_lang.rules import Severity
from btq_lang.trace import FORMATS, write
from btq_lang.trace.collect import collect
from btq_lang.trace.overview import Clause, Overview
from btq_lang.trace.ways import declared_ways
from btq_lang.workspace import Workspace

if TYPE_CHECKING:
    from btq_lang.trace.collect import SaidOf


def run(options: Namespace) -> int:
    """Write the overview; of missions with errors what could be understood."""
    return collecting_seldom(lambda: _run(options))


def _run(options: Namespace) -> int:
    if problem := usage_problem(options.paths) or form_problem(options, FORMATS):
        print(f"btq trace: {problem}", file=sys.stderr)
        return 2
    groups, problems = Files().groups(options.paths, options.stdin_filename)
    for each in problems:
        print(f"btq: {each}", file=sys.stderr)
    if nothing := nothing_below(options.paths, groups):
        print(f"btq trace: {nothing}", file=sys.stderr)
    if problems or nothing:
        return 2
    overview, errors = overview_of([(group.workspace, group.given) for group in groups], options.bundle)
    to_terminal = options.output is None and sys.stdout.isatty()
    colour = options.color == "always" or (options.color == "auto" and wants_colour(to_terminal, os.environ))
    text = write(overview, form_of(options, FORMATS), colour=colour, width=_width() if to_terminal else 120)
    if code := write_output("trace", options.output, text):
        return code
    if errors:
        what = "an error" if errors == 1 else f"{errors} errors"
        print(f"btq trace: the missions have {what}, so the overview may be incomplete; run btq check", file=sys.stderr)
    return int(errors > 0)


def overview_of(
    parts: Sequence[tuple[Workspace, Sequence[str]]], bundled: bool = False, said_of: SaidOf | None = None
) -> tuple[Overview, int]:
    """The overview of missions, and how many errors they have; where there are any something may be missing.

    Args:
        parts: workspaces, each with the paths of it that are asked for.
        bundled: they are built with all that they include.
        said_of: what the boxes of nodes show beside, as `collect` takes it.
    """
    errors = {path: number for workspace, given in parts for path, number in _errors(workspace, given)}
    broken = frozenset(path for path, number in errors.items() if number)

    def ways(workspace: Workspace, path: str, found: Requirements) -> Sequence[Sequence[Clause]]:
        if not broken.isdisjoint(workspace.closure(path)):
            return declared_ways(workspace, path, found, "btq build writes nothing for a mission with errors")
        is_built = is_mission(workspace, path)
        return built_ways(workspace, path, found, bundled) if is_built else declared_ways(workspace, path, found)

    return collect(parts, ways, shown, said_of), sum(errors.values())


def built_ways(
    workspace: Workspace, path: str, found: Requirements, bundled: bool = False
) -> Sequence[Sequence[Clause]]:
    """How clauses are held by what `btq build` makes of a mission; where it makes nothing, as they are declared."""
    declared = declared_ways(workspace, path, found)
    done = bundle(workspace, path) if bundled else export(workspace, path)
    if done.problems:
        return declared
    held = enforced(workspace, path, done, bundled).held
    if not held:
        return declared
    # A requirement without measurable clauses has none that is held.
    return [
        tuple(Clause(each.clause, each.way, each.why, each.asked) for each in clauses) or said
        for clauses, said in zip(held, declared, strict=True)
    ]


def _errors(workspace: Workspace, given: Sequence[str]) -> list[tuple[str, int]]:
    """How many errors each file has, those that are included too."""
    paths = dict.fromkeys(path for each in given for path in workspace.closure(each))
    return [(path, sum(each.effective_severity is Severity.ERROR for each in check(workspace, path))) for path in paths]


def _width() -> int:
    try:
        return os.get_terminal_size().columns
    except OSError:
        return 120
