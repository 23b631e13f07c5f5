"""The records of options: argparse fills them field by field, by name."""

from __future__ import annotations

import argparse

import pytest

from btq_lang.cli import _command
from btq_lang.commands.arguments import build_parser

COMMANDS = next(action for action in build_parser()._actions if isinstance(action, argparse._SubParsersAction)).choices
UNREAD = {"graph": {"color"}}  # taken as by other commands, and a drawing has colours of its own


@pytest.mark.parametrize("name", [name for name in COMMANDS if name != "lsp"])
def test_a_command_reads_every_option_that_it_takes(name: str) -> None:
    _, record = _command(name)
    taken = {action.dest for action in COMMANDS[name]._actions} - {"help", "config"}
    assert taken - UNREAD.get(name, set()) == set(record.__match_args__)
