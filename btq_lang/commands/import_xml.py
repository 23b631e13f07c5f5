"""`btq import`: BehaviorTree.CPP XML, and the trees in logs, as .btq files."""

from __future__ import annotations

import sys
from argparse import Namespace

from btq_lang.commands.output import is_coloured, show
from btq_lang.projects.files import STDIN
from btq_lang.projects.import_files import ImportOptions, import_files


def run(options: Namespace) -> int:
    """Import each file."""
    wanted = ImportOptions(
        options.files,
        options.output,
        is_xml=options.xml,
        keeps_v3=options.keep_v3,
        is_forced=options.force,
        stdin=sys.stdin.buffer.read() if STDIN in options.files else b"",
        is_coloured=is_coloured(options, sys.stderr.isatty()),
    )
    result = import_files(wanted)
    show(result.messages)
    return result.code
