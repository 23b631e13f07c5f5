"""`btq import`: BehaviorTree.CPP XML, and the trees in logs, as .btq files."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from btq_lang.commands.output import is_coloured
from btq_lang.projects.files import STDIN
from btq_lang.projects.import_files import ImportOptions, import_files
from btq_lang.projects.messages import CommandOutput
from btq_lang.util.record import Record


class ImportCommandOptions(Record):
    """The options of `btq import`; `ImportOptions` explains them."""

    files: Sequence[str]
    output: str | None
    xml: bool
    keep_v3: bool
    force: bool
    color: str


def run(options: ImportCommandOptions, messages: CommandOutput) -> int:
    """Import each file."""
    import_options = ImportOptions(
        options.files,
        options.output,
        is_xml=options.xml,
        keeps_v3=options.keep_v3,
        is_forced=options.force,
        stdin=sys.stdin.buffer.read() if STDIN in options.files else b"",
        is_coloured=is_coloured(options.color, sys.stderr.isatty()),
    )
    result = import_files(import_options)
    messages.extend(result.messages)
    return result.code
