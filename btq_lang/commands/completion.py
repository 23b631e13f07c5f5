"""`btq completion`: print the completion script of a shell."""

from __future__ import annotations

import sys
from argparse import Namespace

from btq_lang.commands.arguments import build_parser
from btq_lang.commands.shell import completion_script
from btq_lang.diagnostics.rules import RULES


def run(options: Namespace) -> int:
    sys.stdout.write(
        completion_script(options.shell, build_parser(), dict.fromkeys(("subject", "select", "ignore"), RULES))
    )
    return 0
