"""`btq build`: write missions as XML that BehaviorTree.CPP loads."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from btq_lang.commands.output import is_coloured
from btq_lang.projects.build_files import BuildOptions, BuildResult, build_files
from btq_lang.projects.files import STDIN, Files, usage_problem
from btq_lang.projects.messages import CommandOutput
from btq_lang.projects.options import refuse
from btq_lang.util.record import Record


class BuildCommandOptions(Record):
    """The options of `btq build`; `BuildOptions` explains them."""

    paths: Sequence[str]
    stdin_filename: str | None
    target: str | None
    output: str | None
    bundle: bool
    no_enforce: bool
    verbatim: bool
    check: bool
    force: bool
    verbose: bool
    watch: bool
    color: str


def run(options: BuildCommandOptions, messages: CommandOutput) -> int:
    """Build once, or again and again with `--watch`."""
    refuse(_usage_problem(options))
    build_options = BuildOptions(
        options.paths,
        options.stdin_filename,
        options.target,
        options.output,
        is_bundled=options.bundle,
        is_enforced=not options.no_enforce,
        is_verbatim=options.verbatim,
        is_check=options.check,
        is_forced=options.force,
        is_verbose=options.verbose,
        is_coloured=is_coloured(options.color, sys.stdout.isatty()),
    )
    files = Files()

    def build() -> BuildResult:
        result = build_files(build_options, files)
        messages.extend(result.messages)
        return result

    result = build()
    if options.watch:
        from btq_lang.commands.watch_mode import run_on_changes

        run_on_changes(lambda: build().watched, options.paths, result.watched)
    return result.code


def _usage_problem(options: BuildCommandOptions) -> str | None:
    if STDIN in options.paths and (len(options.paths) > 1 or options.output or options.check):
        return "btq builds standard input to standard output; give no other path, no -o and no --check"
    return usage_problem(options.paths, options.watch)
