"""`btq build`: write missions as XML that BehaviorTree.CPP loads."""

from __future__ import annotations

import sys
from argparse import Namespace

from btq_lang.commands.output import is_coloured, show
from btq_lang.projects.build_files import BuildOptions, BuildResult, build_files
from btq_lang.projects.files import STDIN, Files, usage_problem, write_stdout
from btq_lang.projects.options import refuse


def run(options: Namespace) -> int:
    """Build once, or again and again with `--watch`."""
    refuse(_usage_problem(options))
    wanted = BuildOptions(
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
        is_coloured=is_coloured(options, sys.stdout.isatty()),
    )
    files = Files()

    def build() -> BuildResult:
        result = build_files(wanted, files)
        show(result.messages)
        if result.text is not None:
            write_stdout(result.text)
        return result

    built = build()
    if options.watch:
        from btq_lang.commands.watch_mode import run_on_changes

        run_on_changes(lambda: build().watched, options.paths, built.watched)
    return built.code


def _usage_problem(options: Namespace) -> str | None:
    if options.watch and STDIN in options.paths:
        return "--watch cannot watch standard input"
    if STDIN in options.paths and (len(options.paths) > 1 or options.output or options.check):
        return "btq builds standard input to standard output; give no other path, no -o and no --check"
    return usage_problem(options.paths)
