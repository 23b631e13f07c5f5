"""Completion scripts for bash, fish, zsh and PowerShell, generated from the argparse parser, so that they have every
option.

One invariant: a script is self-contained: completion starts no process, not even btq.  What the commands do, and where
a shell expects its script, is unknown here.
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterable, Iterator, Mapping
from importlib import import_module

from btq_lang.util.record import Record

SHELLS = ("bash", "zsh", "fish", "powershell")


def completion_script(
    shell: str, parser: argparse.ArgumentParser, choices: Mapping[str, Iterable[str]] | None = None
) -> str:
    """The completion script of a shell for the commands, options and values of a parser.

    Args:
        choices: the values to offer for arguments without choices in the parser, by `dest`.

    Raises:
        ValueError: the shell is not in SHELLS.
    """
    if shell not in SHELLS:
        raise ValueError(f"no completion for {shell!r}; expected one of {', '.join(SHELLS)}")
    script: str = import_module(f"{__name__}.{shell}").script(tuple(_commands(parser, parser.prog, choices or {})))
    return script


def _commands(parser: argparse.ArgumentParser, line: str, choices: Mapping[str, Iterable[str]]) -> Iterator[Command]:
    """The parser as a command, then the commands below it.

    argparse has no public access to its actions; argcomplete and shtab read the same attributes.
    """
    options: list[Option] = []
    commands: list[tuple[str, str]] = []
    arguments: list[str] = []
    takes_files = False
    below: list[Command] = []
    for action in parser._actions:
        if action.help == argparse.SUPPRESS:
            continue
        if isinstance(action, argparse._SubParsersAction):
            helps = {listed.dest: _help(listed, parser) for listed in action._choices_actions}
            for name, command in action.choices.items():
                commands.append((name, helps.get(name, "")))
                below += _commands(command, f"{line} {name}", choices)
            continue
        values = tuple(filter(_is_plain, map(str, action.choices or choices.get(action.dest, ()))))
        if action.option_strings:
            options.append(Option(tuple(action.option_strings), _help(action, parser), action.nargs != 0, values))
        elif values:
            arguments += values
        else:
            takes_files = True
    yield Command(line, tuple(options), tuple(commands), tuple(arguments), takes_files)
    yield from below


def _help(action: argparse.Action, parser: argparse.ArgumentParser) -> str:
    return " ".join(((action.help or "") % {**vars(action), "prog": parser.prog}).split())


def _is_plain(word: str) -> bool:
    """Whether all shells read a word literally; other words are not offered."""
    return re.fullmatch(r"[\w.@%+,/-]+", word) is not None


class Option(Record):
    """An option of a command.

    Attributes:
        names: all its spellings, `-q` and `--quiet`.
        help: its help, in one line.
        takes_value: the next word belongs to it.
        choices: the values to offer; empty for files and arbitrary values.
    """

    names: tuple[str, ...]
    help: str
    takes_value: bool
    choices: tuple[str, ...]


class Command(Record):
    """The program itself, or one of its commands.

    Attributes:
        line: the words that call it: `btq`, `btq check`.
        commands: the names of the commands below it, with their help.
        choices: the arguments to offer, unless they are files.
        takes_files: an argument may be a file.
    """

    line: str
    options: tuple[Option, ...]
    commands: tuple[tuple[str, str], ...]
    choices: tuple[str, ...]
    takes_files: bool


def valued_options(commands: tuple[Command, ...]) -> Iterator[tuple[list[str], tuple[str, ...]]]:
    """The command lines that end with an option that takes a value, and the values to offer there."""
    for command in commands:
        for option in command.options:
            if option.takes_value:
                yield [f"{command.line} {name}" for name in option.names], option.choices
