"""`btq completion`: the completion script of a shell; a module of its own, as each command is one."""

from __future__ import annotations

from btq_lang.commands.arguments import build_parser
from btq_lang.commands.shell import completion_script
from btq_lang.diagnostics.rules import RULES
from btq_lang.projects.messages import CommandOutput
from btq_lang.util.record import Record


class CompletionOptions(Record):
    """The options of `btq completion`."""

    shell: str


def run(options: CompletionOptions, messages: CommandOutput) -> int:
    """Print the script."""
    choices = dict.fromkeys(("subject", "select", "ignore"), RULES)
    messages.add(completion_script(options.shell, build_parser(), choices), "result")
    return 0
