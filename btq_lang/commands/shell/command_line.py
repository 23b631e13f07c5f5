"""The model of a command line for completion scripts: commands, with their options and the values to offer."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.util.record import Record


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
